#include "furnished.hpp"

#include <algorithm>

namespace burin::rivals {

Result<FurnishedScene> FurnishedScene::prepare(const gl::Context& context, const scenes::Scene& scene, const Asset& asset, const RenderOptions& options,
                                               int finest, const std::string& cache) {
    FurnishedScene furnished(context, asset, options);
    for (std::size_t part = 0; part < scene.parts.size(); ++part) {
        const auto subject = bench::prepare_subject("", scene, part);
        if (!subject) return subject.error();
        furnished.maps_.emplace_back(context, *subject, finest, cache);
    }
    return furnished;
}

Result<Draw> FurnishedScene::draw(const RivalSettings& settings, bool outlines) {
    std::vector<const RivalMaps*> maps;
    std::size_t channels = 0;
    for (SceneMaps& part : maps_) {
        maps.push_back(&part.maps_for(settings));
        channels = std::max(channels, part.surface().channels());
    }
    auto& rival = rivals_[{settings.technique, outlines}];
    if (!rival) {
        auto loaded = Rival::load(*context_, *asset_, options_, settings.technique, channels, outlines);
        if (!loaded) return loaded.error();
        rival = std::make_shared<Rival>(std::move(*loaded));
        // Drivers finish a program when it is first drawn with.
        rival->draw(settings, maps);
    }
    return Draw([rival = rival, maps, settings] { return rival->draw(settings, maps); });
}

MapBytes FurnishedScene::bytes_of(const RivalSettings& settings) const {
    MapBytes sum;
    for (const SceneMaps& part : maps_) {
        const MapBytes own = rivals::bytes_of(settings, part.surface());
        sum.plain += own.plain;
        sum.blocks += own.blocks;
    }
    return sum;
}

RivalSettings tune_rival(RivalSettings settings, const std::function<double(const RivalSettings&)>& decibels_of) {
    constexpr double kLoss = 0.05;
    double best = decibels_of(settings);
    const auto try_other = [&](auto change, double loss) {
        RivalSettings other = settings;
        change(other);
        const double found = decibels_of(other);
        if (found < best - loss) return false;
        settings = other;
        best = std::max(best, found);
        return true;
    };
    for (const float bias : {0.0f, -1.0f, -2.0f, -3.0f, -4.0f}) try_other([&](RivalSettings& s) { s.bias = bias; }, 0.0);
    if (settings.samples > 1) try_other([](RivalSettings& s) { s.places = Places::hammersley; }, 0.0);
    while (settings.steps > 4 && try_other([](RivalSettings& s) { s.steps /= 2; }, kLoss)) {}
    while (settings.refinements > 2 && try_other([](RivalSettings& s) { s.refinements -= 2; }, kLoss)) {}
    while (settings.size > 64 && try_other([](RivalSettings& s) { s.size /= 2; }, kLoss)) {}
    if (settings.wide_heights) try_other([](RivalSettings& s) { s.wide_heights = false; }, kLoss);
    return settings;
}

}  // namespace burin::rivals
