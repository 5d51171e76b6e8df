#include "render.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <burin/pack.hpp>

#include "gl/accumulator.hpp"
#include "gl/camera.hpp"

#include "areas.hpp"
#include "coverage.hpp"
#include "parallel.hpp"

namespace burin::reference {
namespace {

constexpr double kMostSlope = 20.0;  // 2.9 degrees

// What the fragment of a triangle needs besides its footprint.
struct Place {
    glm::dvec3 position{0.0}, normal{0.0}, to_eye{0.0};
    glm::dmat3 frame{1.0};  // columns: world directions of one metre along x, y, z of pattern space
    bool patterned = false;
};

// What is met after so many bounces.
struct Level {
    AreasWork areas;
    std::vector<Share> shares;
    std::vector<Scattered> scattered;
    Beam beam;
};

struct Work {
    CoverageWork coverage;
    std::vector<Level> levels;  // from the eye on
    Footprint footprint;
    ReferenceStats stats;
    std::uint64_t seed = 0;
};

// What facets are shaded for: those of one footprint have all but the place in common.
struct Setting {
    const Primitive& primitive;
    const GroovedSurface& surface;
    glm::dmat3 to_pattern;
    Slopes slopes;
    AreasOptions areas;
};

glm::dvec3 of_array(const std::array<float, 3>& a) { return {double(a[0]), double(a[1]), double(a[2])}; }

class Renderer {
  public:
    Renderer(const Asset& asset, const ReferenceOptions& options, const View& view)
        : asset_(asset), options_(options), view_(view),
          map_(asset, projection(view, options.view, 0.0, 0.0), options.view.width, options.view.height),
          light_(direction_of(options.view.light.azimuth, options.view.light.elevation)), surfaces_(asset.materials.size()) {
        for (std::size_t c = 0; c < 3; ++c) background_[int(c)] = double(to_linear(options.view.background[c]));
    }

    Status load() {
        for (std::size_t i = 0; i < asset_.materials.size(); ++i) {
            if (!asset_.materials[i].has_detail) continue;
            const auto unpacked = unpack_textures(asset_.materials[i].textures, asset_.materials[i].detail);
            if (!unpacked) return unpacked.error();
            surfaces_[i] = std::make_unique<GroovedSurface>(unpacked->pattern, unpacked->grid);
        }
        return Done{};
    }

    const CoverageMap& map() const { return map_; }

    glm::dvec3 pixel_color(int x, int y, Work& work) const {
        map_.cover_pixel(x, y, work.coverage);
        glm::dvec3 sum(0.0);
        double covered = 0.0;
        for (const Covered& part : work.coverage.seen) {
            const double share = area_of(work.coverage.plane, part.polygon);
            sum += part_color(part, work) * share;
            covered += share;
        }
        return sum + background_ * std::max(0.0, 1.0 - covered);
    }

  private:
    Place place_of(const ScreenTriangle& triangle, Vec2 pixel) const {
        const Primitive& part = asset_.primitives[triangle.primitive];
        const std::uint32_t* corner = &part.indices[triangle.first];
        glm::dvec3 weights = triangle.weights_at(pixel);
        weights /= weights.x + weights.y + weights.z;
        Place place;
        for (int k = 0; k < 3; ++k) {
            place.position += vertex(part.positions, corner[k]) * weights[k];
            place.normal += vertex(part.normals, corner[k]) * weights[k];
        }
        place.normal = glm::normalize(place.normal);
        place.to_eye = options_.view.camera.orthographic ? -view_.direction : glm::normalize(view_.eye - place.position);
        if (glm::dot(place.normal, place.to_eye) < 0.0 && glm::determinant(glm::dmat3(triangle.weights)) < 0.0) place.normal = -place.normal;
        if (surfaces_[std::size_t(part.material)]) set_frame(part, corner, weights, place);
        return place;
    }

    Vec2 uv_of(const Primitive& part, std::uint32_t i) const { return {double(part.uvs[2 * i]), double(part.uvs[2 * i + 1])}; }

    // As the shader has it: the mesh's own directions where it brings them and they go with the triangle.
    void set_frame(const Primitive& part, const std::uint32_t* corner, const glm::dvec3& weights, Place& place) const {
        const glm::dvec3 p0 = vertex(part.positions, corner[0]), p1 = vertex(part.positions, corner[1]) - p0, p2 = vertex(part.positions, corner[2]) - p0;
        const Vec2 a = uv_of(part, corner[1]) - uv_of(part, corner[0]), b = uv_of(part, corner[2]) - uv_of(part, corner[0]);
        const double area = cross(a, b);
        if (area == 0.0) return;
        glm::dvec3 u = (p1 * b.y - p2 * a.y) / area, v = (p2 * a.x - p1 * b.x) / area;
        if (!part.frames.empty()) {
            glm::dvec3 du(0.0), dv(0.0);
            for (int k = 0; k < 3; ++k) {
                du += of_array(part.frames[corner[k]].du) * weights[k];
                dv += of_array(part.frames[corner[k]].dv) * weights[k];
            }
            const double own = glm::dot(place.normal, glm::cross(du, dv)), facing = glm::dot(place.normal, glm::cross(u, v));
            if (own * facing > 0.05 * facing * facing) u = du, v = dv;
        }
        const Vec2 size = surfaces_[std::size_t(part.material)]->pattern().size;
        const glm::dvec3 n = place.normal, x = u / size.x, y = v / size.y;
        place.frame = glm::dmat3(x - n * glm::dot(x, n), y - n * glm::dot(y, n), n);
        place.patterned = std::abs(glm::determinant(place.frame)) > 1e-12 && glm::dot(n, place.to_eye) > 1e-3;
    }

    glm::dvec3 part_color(const Covered& part, Work& work) const {
        const Primitive& primitive = asset_.primitives[part.triangle->primitive];
        const Place place = place_of(*part.triangle, middle_of(work.coverage.plane, part.polygon));
        if (!place.patterned) return plain_color(primitive, place);
        const GroovedSurface& surface = *surfaces_[std::size_t(primitive.material)];
        if (!set_footprint(part, primitive, surface, work)) return plain_color(primitive, place);
        Setting setting{primitive, surface, glm::inverse(place.frame), {}, {}};
        setting.slopes = slopes_of(setting.to_pattern, place);
        setting.areas.tolerance = options_.tolerance;
        setting.areas.width = std::sqrt(area_of(work.footprint) / area_of(work.coverage.plane, part.polygon));
        setting.areas.corners = options_.bounces > 0;
        Level& first = work.levels[0];
        find_areas(surface, work.footprint, setting.slopes, setting.areas, first.areas, first.shares);
        ++work.stats.footprints;
        double seen = 0.0;
        for (const Share& share : first.shares) seen += share.seen;
        const double off = std::abs(seen - 1.0) * area_of(work.coverage.plane, part.polygon);
        work.stats.worst_sum = std::max(work.stats.worst_sum, off);
        work.stats.mean_sum += off;
        return seen > 0.0 ? shares_color(setting, place, 0, work) / seen : background_;
    }

    // Of a mesh without detail.
    glm::dvec3 plain_color(const Primitive& primitive, const Place& place) const {
        glm::dvec3 color = facet_color(paint_of(primitive, nullptr), place.to_eye, place.normal, 1.0);
        if (options_.bounces > 0) color += soft_surround(paint_of(primitive, nullptr), place.normal, light_, place.to_eye, options_.view.light.ambient);
        return color;
    }

    // Sum over the shares of a level, each as far as it is seen.
    glm::dvec3 shares_color(const Setting& setting, const Place& place, std::size_t level, Work& work) const {
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < work.levels[level].shares.size(); ++i) {
            const Share share = work.levels[level].shares[i];
            const glm::dvec3 normal = glm::normalize(glm::transpose(setting.to_pattern) * glm::dvec3(share.normal.x, share.normal.y, share.normal.z));
            const Paint paint = paint_of(setting.primitive, own_material(setting.surface, share));
            const double lit = !setting.slopes.lit ? 0.0 : options_.view.shadows ? share.lit / share.seen : 1.0;
            glm::dvec3 color = facet_color(paint, place.to_eye, normal, lit);
            if (int(level) < options_.bounces) color += light_by_way(setting, place, share, paint, normal, level, work);
            // A lamp that a matt facet happens to see in a smooth one would be a spark.
            sum += (level > 0 ? glm::min(color, glm::dvec3(1.0)) : color) * share.seen;
        }
        return sum;
    }

    // What a facet gets from others and, past them, from the surround.
    glm::dvec3 light_by_way(const Setting& setting, const Place& place, const Share& share, const Paint& paint, const glm::dvec3& normal, std::size_t level,
                            Work& work) const {
        Level& own = work.levels[level];
        own.scattered.clear();
        options_.scatter(paint, normal, place.to_eye, options_.directions, ++work.seed, own.scattered);
        own.beam.corners.clear();
        for (std::uint32_t k = 0; k < share.corners; ++k) own.beam.corners.push_back(own.areas.area.corners[share.first_corner + k]);
        own.beam.normal = share.normal;
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < own.scattered.size(); ++k) {
            const Scattered way = own.scattered[k];
            const glm::dvec3 d = setting.to_pattern * way.direction;
            own.beam.direction = leaned({d.x, d.y, d.z});
            Level& next = work.levels[level + 1];
            const double left = find_hits(setting.surface, own.beam, setting.slopes, setting.areas, next.areas, next.shares);
            glm::dvec3 radiance = surround(way.direction) * left;
            if (!next.shares.empty()) {
                Place there = place;
                there.to_eye = -way.direction;
                radiance += shares_color(setting, there, level + 1, work);
            }
            sum += way.weight * radiance;
        }
        return sum;
    }

    // Level beams are tilted, as low views are.
    static Vec3 leaned(Vec3 d) {
        const double least = std::hypot(d.x, d.y) / kMostSlope;
        if (std::abs(d.z) < least) d.z = d.z < 0.0 ? -least : least;
        return d;
    }

    glm::dvec3 surround(const glm::dvec3& direction) const {
        return options_.surround ? options_.surround(direction) : soft_radiance(direction, options_.view.light.ambient);
    }

    Slopes slopes_of(const glm::dmat3& to_pattern, const Place& place) const {
        const glm::dvec3 eye = to_pattern * place.to_eye, lamp = to_pattern * light_;
        const auto slope = [](const glm::dvec3& away) {
            const Vec2 s{-away.x / std::max(away.z, 1e-9), -away.y / std::max(away.z, 1e-9)};
            const double l = length(s);
            return l > kMostSlope ? s * (kMostSlope / l) : s;
        };
        return {slope(eye), slope(lamp), lamp.z > 0.0};
    }

    bool set_footprint(const Covered& part, const Primitive& primitive, const GroovedSurface& surface, Work& work) const {
        const std::uint32_t* corner = &primitive.indices[part.triangle->first];
        const Vec2 size = surface.pattern().size;
        auto& corners = work.footprint.corners;
        corners.clear();
        for (const Vec2* q = work.coverage.plane.begin(part.polygon); q != work.coverage.plane.end(part.polygon); ++q) {
            const glm::dvec3 weights = part.triangle->weights_at(*q);
            const double sum = weights.x + weights.y + weights.z;
            if (!(sum > 0.0)) return false;
            Vec2 uv{0, 0};
            for (int k = 0; k < 3; ++k) uv = uv + uv_of(primitive, corner[k]) * (weights[k] / sum);
            corners.push_back({uv.x * size.x, uv.y * size.y});
        }
        const double area = area_of(work.footprint);
        if (area < 0.0) std::reverse(corners.begin(), corners.end());
        return std::abs(area) > 1e-24;
    }

    // Null: the glTF material itself.
    static const Material* own_material(const GroovedSurface& surface, const Share& share) {
        if (share.element == kGround) return nullptr;
        const ResolvedPattern& pattern = surface.pattern();
        const Material& material = pattern.materials[pattern.styles[pattern.elements[share.element].style].material];
        return material.overrides ? &material : nullptr;
    }

    Paint paint_of(const Primitive& primitive, const Material* own) const {
        const MaterialInfo& material = asset_.materials[std::size_t(primitive.material)];
        Paint paint;
        const float* color = own ? own->base_color : material.base_color;
        paint.albedo = {double(color[0]), double(color[1]), double(color[2])};
        paint.metal = double(own ? own->metallic : material.metallic);
        paint.rough = double(own ? own->roughness : material.roughness);
        if (!own) paint.glow = {double(material.emissive[0]), double(material.emissive[1]), double(material.emissive[2])};
        return paint;
    }

    // A facet's own colour, the lit part and the rest mixed as they are seen.
    glm::dvec3 facet_color(const Paint& paint, const glm::dvec3& to_eye, const glm::dvec3& normal, double lit) const {
        const glm::dvec3 lamp = options_.brdf(paint, normal, light_, to_eye) * options_.view.light.strength;
        if (options_.bounces > 0) return paint.glow + lamp * lit;
        const glm::dvec3 dark = paint.glow + soft_surround(paint, normal, light_, to_eye, options_.view.light.ambient);
        return glm::mix(glm::clamp(dark, 0.0, 1.0), glm::clamp(dark + lamp, 0.0, 1.0), lit);
    }

    const Asset& asset_;
    const ReferenceOptions& options_;
    const View& view_;
    CoverageMap map_;
    glm::dvec3 light_, background_{0.0};
    std::vector<std::unique_ptr<GroovedSurface>> surfaces_;  // per material
};

Status check_options(const Asset& asset, const ReferenceOptions& options) {
    if (Status status = check_render(asset, options.view); !status) return status;
    if (!(options.tolerance > 0.0 && options.tolerance <= 0.1))
        return Error{ErrorCode::invalid_argument, "the tolerance of the reference renderer must be above 0 and at most 0.1"};
    if (options.bounces < 0 || options.bounces > 8) return Error{ErrorCode::invalid_argument, "bounces of the reference renderer must be 0 to 8"};
    if (options.directions < 1 || options.directions > 1024)
        return Error{ErrorCode::invalid_argument, "directions of the reference renderer must be 1 to 1024"};
    if (options.view.environment)
        return Error{ErrorCode::unsupported, "the reference renderer knows no environment yet; the directional light with its soft surround works"};
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
    Renderer renderer(asset, options, view);
    if (Status status = renderer.load(); !status) return status.error();
    ReferencePicture picture{options.view.width, options.view.height, {}, {}};
    picture.linear.resize(std::size_t(picture.width) * std::size_t(picture.height) * 3);
    const std::size_t tiles = std::size_t(renderer.map().columns()) * std::size_t(renderer.map().rows());
    std::vector<ReferenceStats> stats(tiles);
    std::size_t done = 0;
    std::mutex told;
    for_each_piece(tiles, options.threads, [&](std::size_t tile) {
        thread_local Work work;
        work.stats = {};
        work.levels.resize(std::size_t(options.bounces) + 1);
        work.levels[0].areas.by_line = work.levels[0].areas.by_area = 0;
        const int x0 = int(tile % std::size_t(renderer.map().columns())) * kTileSide, y0 = int(tile / std::size_t(renderer.map().columns())) * kTileSide;
        for (int y = y0; y < std::min(y0 + kTileSide, picture.height); ++y)
            for (int x = x0; x < std::min(x0 + kTileSide, picture.width); ++x) {
                work.seed = (std::uint64_t(y) * std::uint64_t(picture.width) + std::uint64_t(x)) << 20;
                const glm::dvec3 color = renderer.pixel_color(x, y, work);
                for (std::size_t c = 0; c < 3; ++c)
                    picture.linear[(std::size_t(y) * std::size_t(picture.width) + std::size_t(x)) * 3 + c] = float(color[int(c)]);
            }
        work.stats.by_line = work.levels[0].areas.by_line, work.stats.by_area = work.levels[0].areas.by_area;
        stats[tile] = work.stats;
        const std::lock_guard lock(told);
        options.progress(double(++done) / double(tiles));
    });
    for (const ReferenceStats& one : stats) {
        picture.stats.footprints += one.footprints;
        picture.stats.by_line += one.by_line;
        picture.stats.by_area += one.by_area;
        picture.stats.worst_sum = std::max(picture.stats.worst_sum, one.worst_sum);
        picture.stats.mean_sum += one.mean_sum / (double(picture.width) * picture.height);
    }
    return picture;
}

}  // namespace burin::reference
