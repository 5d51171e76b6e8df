#include "stage.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace burin::rivals {
namespace {

// Of all that the samples of a map depend on.
std::string key_of(const bench::Subject& subject) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    const auto add = [&](const void* data, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; ++i) hash = (hash ^ static_cast<const std::uint8_t*>(data)[i]) * 0x100000001b3ull;
    };
    const auto& data = subject.prepared.textures.data;
    add(data.data(), 16 * std::size_t(subject.prepared.textures.sections.lists_begin()));
    const ResolvedPattern& pattern = subject.prepared.resolved;
    const double numbers[] = {1.0, pattern.depth, pattern.base_offset, pattern.outer_level, pattern.size.x, pattern.size.y};
    add(numbers, sizeof numbers);
    char name[32];
    std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(hash));
    return name;
}

bench::Extent cut(const bench::Extent& a, const bench::Extent& b) {
    return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)}, {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
}

double milliseconds_since(std::clock_t before) { return double(std::clock() - before) * 1000.0 / CLOCKS_PER_SEC; }

}  // namespace

MapPaint paint_of(const scenes::Part& part) { return {part.color, part.metallic, part.roughness}; }

bench::Extent seen_extent(const bench::PlaneView& view, Vec2 size, double drop) {
    const bench::PlaneCamera camera = bench::camera_of(view, size);
    bench::Extent seen{{1e9, 1e9}, {-1e9, -1e9}};
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double height : {0.0, -drop}) {
                std::array<double, 3> way;
                for (std::size_t i = 0; i < 3; ++i)
                    way[i] = camera.forward[i] + camera.tangent * (x * camera.aspect * camera.right[i] + y * camera.up[i]);
                // Towards the horizon as far as anything is looked at.
                const double t = (camera.eye[1] - height) / std::max(-way[1], 0.02);
                const Vec2 uv{(camera.eye[0] + way[0] * t) / size.x + 0.5, (camera.eye[2] + way[2] * t) / size.y + 0.5};
                seen.low = {std::min(seen.low.x, uv.x), std::min(seen.low.y, uv.y)};
                seen.high = {std::max(seen.high.x, uv.x), std::max(seen.high.y, uv.y)};
            }
    return seen;
}

SceneMaps::SceneMaps(const gl::Context& context, const bench::Subject& subject, int finest, const std::string& cache)
    : context_(context), cache_(cache), key_(key_of(subject)),
      maps_(map_surface(subject.prepared.resolved, paint_of(subject.part()), finest, cache, key_)) {}

const RivalMaps& SceneMaps::maps_for(const RivalSettings& settings) {
    const bool cones = settings.technique == Technique::cones;
    auto& made = made_[{settings.size, settings.wide_heights, cones}];
    if (!made) {
        const RivalMaps::Wanted wanted{settings.size, settings.wide_heights, cones, cache_, key_};
        made = std::make_unique<RivalMaps>(context_.functions(), maps_, wanted);
    }
    return *made;
}

double time_once(const Draw& draw) {
    const std::clock_t before = std::clock();
    draw();
    return milliseconds_since(before);
}

Result<Draw> prepare_burin(const gl::Context& context, const Asset& asset, const RenderOptions& options) {
    auto prepared = gl::PreparedAsset::load(context, asset, options);
    if (!prepared) return prepared.error();
    auto kept = std::make_shared<gl::PreparedAsset>(std::move(*prepared));
    if (auto first = kept->draw(); !first) return first.error();
    return Draw([kept] { return *kept->draw(); });
}

Stage::Stage(const gl::Context& context, const bench::Subject& subject, SceneMaps& maps, const bench::PlaneView& view, const std::string& cache)
    : context_(context), subject_(subject), maps_(maps), view_(view), truth_(bench::draw_truth(subject, view, cache)),
      asset_(bench::asset_of(subject, bench::extent_of(view, subject.prepared.resolved))),
      options_(bench::options_of(view, subject.prepared.resolved.size)) {}

bool Stage::shows_features() const { return std::count(truth_.feature.begin(), truth_.feature.end(), 1) > 0; }

bool Stage::shows_outline() const {
    const ResolvedPattern& pattern = subject_.prepared.resolved;
    const bench::Extent whole = bench::extent_of(view_, pattern), seen = seen_extent(view_, pattern.size, 0.0);
    return seen.low.x <= whole.low.x || seen.low.y <= whole.low.y || seen.high.x >= whole.high.x || seen.high.y >= whole.high.y;
}

double Stage::pixel_in_uv() const { return view_.pixel / std::max(subject_.prepared.resolved.size.x, subject_.prepared.resolved.size.y); }

Result<Rival*> Stage::rival_of(const RivalSettings& settings) {
    auto& drawn = rivals_[key_of(settings)];
    if (drawn) return &*drawn->rival;
    auto made = std::make_unique<Drawn>(Drawn{asset_, {}});
    if (settings.technique == Technique::triangles) {
        // No further around the window than a ray that enters it can reach.
        const Vec2 size = subject_.prepared.resolved.size;
        const double deep = maps_.surface().lowest, reach = deep / std::tan(0.5 * view_.elevation * 0.0174533);
        bench::Extent around = bench::extent_of(view_, subject_.prepared.resolved);
        around.low = {around.low.x - reach / size.x, around.low.y - reach / size.y};
        around.high = {around.high.x + reach / size.x, around.high.y + reach / size.y};
        made->asset = bench::asset_of(subject_, cut(around, seen_extent(view_, size, deep)));
        made->asset.primitives[0] = subdivide(made->asset.primitives[0], settings.edge);
    }
    auto rival = Rival::load(context_, made->asset, options_, settings.technique, maps_.surface().channels(), shows_outline());
    if (!rival) return rival.error();
    made->rival.emplace(std::move(*rival));
    // Drivers finish a program when it is first drawn with.
    RivalSettings least = settings;
    least.samples = 1;
    made->rival->draw(least, {&maps_.maps_for(settings)});
    drawn = std::move(made);
    return &*drawn->rival;
}

Result<Draw> Stage::rival(const RivalSettings& settings) {
    auto rival = rival_of(settings);
    if (!rival) return rival.error();
    const RivalMaps* maps = &maps_.maps_for(settings);
    const bench::Extent whole = bench::extent_of(view_, subject_.prepared.resolved);
    RivalSettings framed = settings;
    framed.window = {whole.low.x, whole.low.y, whole.high.x, whole.high.y};
    return Draw([drawn = *rival, maps, settings = framed] { return drawn->draw(settings, {maps}); });
}

Result<Draw> Stage::burin(const std::function<void(RenderOptions&)>& apply) {
    RenderOptions options = options_;
    apply(options);
    return prepare_burin(context_, asset_, options);
}

Trial Stage::measure(const Draw& draw) const {
    const std::clock_t before = std::clock();
    const gl::Accumulator drawn = draw();
    const double milliseconds = milliseconds_since(before);
    return {bench::compare_pictures(drawn.image(), truth_).psnr, milliseconds};
}

}  // namespace burin::rivals
