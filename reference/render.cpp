#include "render.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "gl/accumulator.hpp"
#include "gl/camera.hpp"

#include "beams.hpp"
#include "coverage.hpp"
#include "parallel.hpp"

namespace burin::reference {
namespace {

struct Work {
    CoverageWork coverage;
    BeamWork beams;
    ReferenceStats stats;
};

class Renderer {
  public:
    Renderer(const Scene& scene, const ReferenceOptions& options, const View& view)
        : scene_(scene), options_(options), view_(view),
          map_(scene.asset(), projection(view, options.view, 0.0, 0.0), options.view.width, options.view.height), tracer_(scene, options) {
        for (std::size_t c = 0; c < 3; ++c) background_[int(c)] = double(to_linear(options.view.background[c]));
    }

    const CoverageMap& map() const { return map_; }
    std::size_t levels() const { return tracer_.levels(); }

    glm::dvec3 pixel_color(int x, int y, Work& work) const {
        map_.cover_pixel(x, y, work.coverage);
        glm::dvec3 sum(0.0);
        double covered = 0.0;
        for (const Covered& part : work.coverage.seen) {
            const double share = area_of(work.coverage.plane, part.polygon);
            sum += part_color(part, share, work) * share;
            covered += share;
        }
        return sum + background_ * std::max(0.0, 1.0 - covered);
    }

  private:
    static MeshPoint point_of(const ScreenTriangle& triangle, Vec2 pixel) {
        const glm::dvec3 weights = triangle.weights_at(pixel);
        return {triangle.primitive, triangle.first, weights / (weights.x + weights.y + weights.z)};
    }

    glm::dvec3 toward_eye(const glm::dvec3& p) const {
        return options_.view.camera.orthographic ? -view_.direction : glm::normalize(view_.eye - p);
    }

    glm::dvec3 part_color(const Covered& part, double share, Work& work) const {
        const MeshPoint middle = point_of(*part.triangle, middle_of(work.coverage.plane, part.polygon));
        const bool turned = glm::determinant(glm::dmat3(part.triangle->weights)) < 0.0;
        Place place = scene_.place_at(middle, toward_eye(scene_.position(middle)), turned, false);
        Footprint& footprint = work.beams.levels[0].footprint;
        if (!set_footprint(part, place, work.coverage, footprint)) {
            place = Scene::smooth_place(*place.primitive, place.position, place.normal, place.to_eye);
            if (!set_footprint(part, place, work.coverage, footprint)) return background_;
        }
        Path path;
        path.weight = share;
        path.width = std::sqrt(area_of(footprint) / share);
        tracer_.find_seen(place, 0, path.width, work.beams);
        double seen = 0.0;
        for (const Share& one : work.beams.levels[0].shares) seen += one.seen;
        if (place.surface) count(std::abs(seen - 1.0) * share, work.stats);
        return seen > 0.0 ? tracer_.color_of(place, path, work.beams) / seen : background_;
    }

    static void count(double off, ReferenceStats& stats) {
        ++stats.footprints;
        stats.worst_sum = std::max(stats.worst_sum, off);
        stats.mean_sum += off;
    }

    // The part of the pixel in the plane of the place; false: it has no area there.
    bool set_footprint(const Covered& part, const Place& place, const CoverageWork& coverage, Footprint& footprint) const {
        const Primitive& primitive = *place.primitive;
        const std::uint32_t* corner = &primitive.indices[part.triangle->first];
        footprint.corners.clear();
        for (const Vec2* q = coverage.plane.begin(part.polygon); q != coverage.plane.end(part.polygon); ++q) {
            const MeshPoint point = point_of(*part.triangle, *q);
            footprint.corners.push_back(place.surface ? pattern_point(primitive, corner, point, *place.surface) : smooth_point(point, place));
        }
        const double area = area_of(footprint);
        if (area < 0.0) std::reverse(footprint.corners.begin(), footprint.corners.end());
        return std::abs(area) > 1e-24;
    }

    static Vec2 pattern_point(const Primitive& primitive, const std::uint32_t* corner, const MeshPoint& point, const GroovedSurface& surface) {
        Vec2 uv{0, 0};
        for (int k = 0; k < 3; ++k) uv = uv + Vec2{double(primitive.uvs[2 * corner[k]]), double(primitive.uvs[2 * corner[k] + 1])} * point.weights[k];
        return {uv.x * surface.pattern().size.x, uv.y * surface.pattern().size.y};
    }

    Vec2 smooth_point(const MeshPoint& point, const Place& place) const {
        const Vec3 p = place.pattern_direction(scene_.position(point) - place.position);
        return {p.x, p.y};
    }

    const Scene& scene_;
    const ReferenceOptions& options_;
    const View& view_;
    CoverageMap map_;
    BeamTracer tracer_;
    glm::dvec3 background_{0.0};
};

Status check_options(const Asset& asset, const ReferenceOptions& options) {
    if (Status status = check_render(asset, options.view); !status) return status;
    if (!(options.tolerance > 0.0 && options.tolerance <= 0.1))
        return Error{ErrorCode::invalid_argument, "the tolerance of the reference renderer must be above 0 and at most 0.1"};
    if (options.bounces < 0 || options.bounces > 8) return Error{ErrorCode::invalid_argument, "bounces of the reference renderer must be 0 to 8"};
    if (options.directions < 1 || options.directions > 1024)
        return Error{ErrorCode::invalid_argument, "directions of the reference renderer must be 1 to 1024"};
    if (options.passes < 2 || options.passes > 32) return Error{ErrorCode::invalid_argument, "passes of the reference renderer must be 2 to 32"};
    return Done{};
}

}  // namespace

RgbaImage ReferencePicture::image() const {
    RgbaImage image{width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * 4, 255)};
    for (std::size_t i = 0; i < linear.size() / 3; ++i)
        for (std::size_t c = 0; c < 3; ++c) image.texels[4 * i + c] = gl::to_srgb(linear[3 * i + c]);
    return image;
}

Result<ReferencePicture> render_reference(const Asset& asset, const ReferenceOptions& options) {
    if (Status status = check_options(asset, options); !status) return status.error();
    const View view = place_camera(asset, options.view);
    const auto scene = Scene::make(asset);
    if (!scene) return scene.error();
    const Renderer renderer(*scene, options, view);
    ReferencePicture picture{options.view.width, options.view.height, {}, {}};
    picture.linear.resize(std::size_t(picture.width) * std::size_t(picture.height) * 3);
    const std::size_t tiles = std::size_t(renderer.map().columns()) * std::size_t(renderer.map().rows());
    std::vector<ReferenceStats> stats(tiles);
    std::size_t done = 0;
    std::mutex told;
    for_each_piece(tiles, options.threads, [&](std::size_t tile) {
        thread_local Work work;
        work.stats = {};
        work.beams.levels.resize(renderer.levels());
        AreasWork& areas = work.beams.levels[0].areas;
        areas.by_line = areas.by_area = 0;
        work.beams.cut_off = 0.0;
        const int x0 = int(tile % std::size_t(renderer.map().columns())) * kTileSide, y0 = int(tile / std::size_t(renderer.map().columns())) * kTileSide;
        for (int y = y0; y < std::min(y0 + kTileSide, picture.height); ++y)
            for (int x = x0; x < std::min(x0 + kTileSide, picture.width); ++x) {
                work.beams.seed = (std::uint64_t(y) * std::uint64_t(picture.width) + std::uint64_t(x)) << 20;
                const glm::dvec3 color = renderer.pixel_color(x, y, work);
                for (std::size_t c = 0; c < 3; ++c)
                    picture.linear[(std::size_t(y) * std::size_t(picture.width) + std::size_t(x)) * 3 + c] = float(color[int(c)]);
            }
        work.stats.cut_off = work.beams.cut_off;
        work.stats.by_line = areas.by_line, work.stats.by_area = areas.by_area;
        stats[tile] = work.stats;
        const std::lock_guard lock(told);
        options.progress(double(++done) / double(tiles));
    });
    for (const ReferenceStats& one : stats) {
        picture.stats.footprints += one.footprints;
        picture.stats.by_line += one.by_line;
        picture.stats.by_area += one.by_area;
        picture.stats.worst_sum = std::max(picture.stats.worst_sum, one.worst_sum);
        picture.stats.cut_off += one.cut_off / (double(picture.width) * picture.height);
        picture.stats.mean_sum += one.mean_sum / (double(picture.width) * picture.height);
    }
    return picture;
}

}  // namespace burin::reference
