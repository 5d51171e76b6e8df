#include "cpp/decode.hpp"

#include <algorithm>
#include <array>
#include <thread>
#include <vector>

#include "cpp/glsl_shim.hpp"
#include "cpp/prefilter.hpp"
#include "cpp/drop_range.hpp"
#include "layout.h"

namespace burin {
namespace glsl {

// The core text with its inputs: the map's constants and the two fetches.
class Core {
  public:
#include "core/types.glsl"
    BurinMap burin_map;
    BurinCharts burin_charts;
    const PackedTextures* textures = nullptr;
    const std::vector<std::uint32_t>* charts = nullptr;

    uvec2 fetch_cell(ivec2 index) const {
        const std::size_t k =
            2 * (std::size_t(index.y) * std::size_t(textures->grid_width) + std::size_t(index.x));
        return k + 2 <= textures->grid.size() ? uvec2(textures->grid[k], textures->grid[k + 1]) : uvec2(0);
    }

    uvec4 fetch_data(int index) const {
        const std::size_t k = 4 * std::size_t(index);
        if (index < 0 || k + 4 > textures->data.size()) return uvec4(0);
        const std::uint32_t* w = &textures->data[k];
        return uvec4(w[0], w[1], w[2], w[3]);
    }

    uvec4 fetch_chart(int index) const {
        const std::size_t k = 4 * std::size_t(index);
        if (charts == nullptr || index < 0 || k + 4 > charts->size()) return uvec4(0);
        const std::uint32_t* w = &(*charts)[k];
        return uvec4(w[0], w[1], w[2], w[3]);
    }

#include "core/fetch.glsl"
#include "core/perturbation.glsl"
#include "core/curve.glsl"
#include "core/domain.glsl"
#include "core/section.glsl"
#include "core/ground.glsl"
#include "core/trace.glsl"
#include "core/chord.glsl"
#include "core/chart.glsl"
#include "core/curvature.glsl"
#include "core/facet.glsl"
#include "core/surface.glsl"
#include "core/residual.glsl"

    // Shading by normal and light alone.
    vec3 burin_facet_color(BurinFacet facet) const { return vec3(facet.normal.z, facet.lit, 1.0f); }
    vec3 burin_shadow_color() const { return vec3(1.0f, 0.0f, 1.0f); }

#include "core/footprint.glsl"
#include "core/stripe.glsl"
#include "core/region.glsl"
#include "core/far.glsl"
    static_assert(BURIN_MAX_CLASSES == Prefilter::kMostClasses);
};

Core make_core(const PackedTextures& textures, const PathDetail& detail, const std::array<float, 2>& range,
               const std::vector<std::uint32_t>* charts = nullptr) {
    Core core;
    core.textures = &textures;
    core.burin_map.size = vec2(float(detail.size_u), float(detail.size_v));
    core.burin_map.depth = float(detail.depth);
    core.burin_map.outer_level = float(detail.base_offset - detail.outer_level);
    core.burin_map.drop_range = vec2(range[0], range[1]);
    core.burin_map.repeats = detail.repeat ? 1 : 0;
    core.burin_map.cells = ivec2(textures.grid_width, textures.grid_height);
    core.burin_map.first_style = int(textures.sections.styles_begin());
    core.burin_map.first_profile = int(textures.sections.profiles_begin());
    core.burin_map.first_material = int(textures.sections.materials_begin());
    core.burin_map.first_list = int(textures.sections.lists_begin());
    core.burin_map.first_function = int(textures.sections.functions_begin());
    core.charts = charts;
    const ChartLayout& layout = detail.charts;
    core.burin_charts.origin = vec2(float(layout.origin[0]), float(layout.origin[1]));
    core.burin_charts.cell = vec2(float(layout.cell[0]), float(layout.cell[1]));
    core.burin_charts.scale = 1.0f;
    core.burin_charts.cells = charts != nullptr ? ivec2(layout.columns, layout.rows) : ivec2(0);
    core.burin_charts.first_cell = int(layout.first_cell());
    core.burin_charts.first_reference = int(layout.first_reference());
    return core;
}

}  // namespace glsl

namespace {

DecodedHit describe(glsl::Core& core, const glsl::Core::BurinHit& found) {
    const glsl::Core::BurinSurface surface = core.burin_surface(found);
    DecodedHit hit;
    hit.met = found.met;
    hit.drop = double(found.t);
    hit.position = {double(found.ray.origin.x + found.ray.slope.x * found.t),
                    double(found.ray.origin.y + found.ray.slope.y * found.t)};
    for (int i = 0; i < 3; ++i) hit.normal[i] = double(surface.normal[i]);
    hit.element = found.mark.element;
    hit.facet = surface.facet;
    hit.material = surface.material;
    return hit;
}

glm::vec3 to_vec3(const std::array<double, 3>& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

}  // namespace

Decoder::Decoder(const PackedTextures& textures, const PathDetail& detail, const std::vector<std::uint32_t>* charts)
    : textures_(textures), detail_(detail), charts_(charts), drop_range_(drop_range(textures, detail)) {}

DecodedHit Decoder::trace(Vec2 origin, Vec2 slope) const {
    glsl::Core core = glsl::make_core(textures_, detail_, drop_range_);
    glsl::Core::BurinRay ray;
    ray.origin = glm::vec2(float(origin.x), float(origin.y));
    ray.slope = glm::vec2(float(slope.x), float(slope.y));
    return describe(core, core.burin_trace(ray, 0.0f, core.burin_map.depth));
}

SurfaceHit Decoder::trace_surface(const SurfacePlace& place, const std::array<double, 3>& direction) const {
    glsl::Core core = glsl::make_core(textures_, detail_, drop_range_, charts_);
    const glm::vec2 size = core.burin_map.size;
    const glm::mat3 frame(to_vec3(place.du) / size.x, to_vec3(place.dv) / size.y, to_vec3(place.normal));
    const glm::mat3 to_local = glm::inverse(frame);
    const auto bend =
        core.burin_bend_at(frame, to_local, to_vec3(place.duu), to_vec3(place.duv), to_vec3(place.dvv));
    const glm::vec3 local = to_local * to_vec3(direction);
    glsl::Core::BurinRay ray;
    ray.origin = glm::vec2(float(place.uv.x), float(place.uv.y)) * size;
    ray.slope = core.burin_slope_of(local);
    const auto found = core.burin_trace_sight(bend, ray.origin, core.burin_eye_sight(bend, ray.origin, ray, local, int(place.chart)));
    SurfaceHit hit;
    static_cast<DecodedHit&>(hit) = describe(core, found.hit);
    hit.way = double(found.way);
    const glm::vec3 normal = core.burin_off_sheet(found.sheet, glm::vec3(float(hit.normal[0]), float(hit.normal[1]), float(hit.normal[2])));
    for (int i = 0; i < 3; ++i) hit.normal[i] = double(normal[i]);
    return hit;
}

double Decoder::height_at(Vec2 p) const {
    glsl::Core core = glsl::make_core(textures_, detail_, drop_range_);
    glsl::Core::BurinRay ray;
    ray.origin = glm::vec2(float(p.x), float(p.y));
    ray.slope = glm::vec2(0.0f, 0.0f);
    return detail_.base_offset - double(core.burin_trace(ray, 0.0f, core.burin_map.depth).t);
}

Image decode_top(const PackedTextures& textures, const PathDetail& detail, int width, int height, int samples,
                 int threads) {
    Image image(width, height);
    const Decoder decoder(textures, detail);
    const double step = 1.0 / samples;
    auto rows = [&](int first, int stride) {
        for (int y = first; y < height; y += stride) {
            for (int x = 0; x < width; ++x) {
                double sum = 0.0;
                for (int k = 0; k < samples * samples; ++k) {
                    const Vec2 p{(x + (k % samples + 0.5) * step) * detail.size_u / width,
                                 (y + (k / samples + 0.5) * step) * detail.size_v / height};
                    sum += height_to_unit(decoder.height_at(p), detail.depth, detail.base_offset);
                }
                image.at(x, y) = float(sum / (samples * samples));
            }
        }
    };
    const int count = threads > 0 ? threads : std::max(1, int(std::thread::hardware_concurrency()));
    std::vector<std::thread> pool;
    for (int i = 1; i < count; ++i) pool.emplace_back(rows, i, count);
    rows(0, count);
    for (std::thread& thread : pool) thread.join();
    return image;
}

}  // namespace burin
