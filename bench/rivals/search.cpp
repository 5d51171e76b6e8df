#include "search.hpp"

#include <algorithm>
#include <cstdio>

namespace burin::rivals {
namespace {

// A map of twice the size halves the width of what its texels blur: 6 dB at best.
constexpr double kGainOfTwice = 6.0;
// Of triangles neither finer ones nor more samples are tried where a picture takes so many milliseconds.
constexpr double kPatience = 150.0;
constexpr double kWidestEdge = 16.0;  // pixels between vertices

bool same(const RivalSettings& a, const RivalSettings& b) {
    return a.size == b.size && a.samples == b.samples && a.places == b.places && a.steps == b.steps && a.bias == b.bias &&
           a.anisotropy == b.anisotropy && a.wide_heights == b.wide_heights && a.edge == b.edge && a.refinements == b.refinements &&
           a.passes == b.passes;
}

std::vector<int> samples_of(Technique technique) {
    if (technique == Technique::normals) return {1, 4, 16, 32};
    if (technique == Technique::triangles) return {1, 4, 16};
    return {1, 4, 16, 64};
}

std::vector<int> steps_of(Technique technique) {
    if (technique == Technique::cones) return {8, 16, 32, 64};
    return {8, 16, 32, 64, 128};
}

bool marches(Technique technique) { return technique != Technique::normals; }

struct NamedSetting {
    const char* name;
    void (*apply)(RenderOptions&);
};
constexpr NamedSetting kBurin[] = {
    {"default", [](RenderOptions&) {}},
    {"points 1", [](RenderOptions& o) { o.antialiasing = Antialiasing::points, o.samples = 1; }},
    {"points 4", [](RenderOptions& o) { o.antialiasing = Antialiasing::points, o.samples = 4; }},
    {"points 16", [](RenderOptions& o) { o.antialiasing = Antialiasing::points, o.samples = 16; }},
    {"regions 1, 4 rays", [](RenderOptions& o) { o.samples = 1, o.rays = 4; }},
    {"regions 1, 4 rays, one run", [](RenderOptions& o) { o.samples = 1, o.rays = 4, o.one_run = true; }},
    {"regions 1, 16 rays", [](RenderOptions& o) { o.samples = 1, o.rays = 16; }},
    {"regions 2, 4 rays", [](RenderOptions& o) { o.samples = 2, o.rays = 4; }},
};

}  // namespace

Trial Searcher::try_setting(const RivalSettings& settings) {
    for (const Tried& one : tried_)
        if (same(one.settings, settings)) return one.trial;
    auto draw = stage_.rival(settings);
    Tried tried{settings, {}};
    if (draw) tried.trial = stage_.measure(*draw);
    else std::fprintf(stderr, "%s: %s\n", name_of(settings.technique), draw.error().message.c_str());
    tried_.push_back(tried);
    return tried_.back().trial;
}

RivalSettings Searcher::better_of(const RivalSettings& a, const RivalSettings& b) {
    const double of_a = try_setting(a).decibels;
    return try_setting(b).decibels > of_a ? b : a;
}

RivalSettings Searcher::best_quality(double wanted) {
    RivalSettings best;
    best.technique = technique_;
    best.size = std::min(limits_.finest, 4096);
    best.samples = technique_ == Technique::normals ? 32 : technique_ == Technique::triangles ? 4 : 16;
    best.steps = steps_of(technique_).back();
    best.refinements = technique_ == Technique::parallax ? 3 : technique_ == Technique::cones ? 10 : 6;
    best.bias = -2.0f;
    best.edge = stage_.pixel_in_uv();
    best.wide_heights = marches(technique_);
    const auto with = [&](auto change) {
        RivalSettings other = best;
        change(other);
        best = better_of(best, other);
    };
    with([](RivalSettings& s) { s.places = Places::hammersley; });
    with([](RivalSettings& s) { s.bias = -3.0f; });
    with([](RivalSettings& s) { s.bias = -1.0f; });
    if (technique_ == Technique::triangles) {
        for (int k = 0; k < 2 && try_setting(best).milliseconds < kPatience; ++k) with([](RivalSettings& s) { s.edge *= 0.5; });
        if (try_setting(best).milliseconds < kPatience) with([](RivalSettings& s) { s.samples = 16; });
    } else if (technique_ != Technique::normals && try_setting(best).decibels < wanted) {
        with([](RivalSettings& s) { s.samples = 64; });
    }
    // An outline gets as many samples of coverage as there are passes.
    if (technique_ != Technique::triangles && stage_.shows_outline() && try_setting(best).decibels < wanted)
        with([](RivalSettings& s) { s.passes = true; });
    if (limits_.finest > best.size && try_setting(best).decibels < wanted && try_setting(best).decibels > wanted - kGainOfTwice)
        with([&](RivalSettings& s) { s.size = limits_.finest; });
    return best;
}

RivalSettings Searcher::cheapest(RivalSettings settings, double decibels) {
    // From the fewest samples that do, since they cost most; both kinds of places.
    for (const int samples : samples_of(technique_)) {
        if (samples >= settings.samples) break;
        RivalSettings fewer = settings, turned = settings;
        fewer.samples = turned.samples = samples;
        turned.places = settings.places == Places::grid ? Places::hammersley : Places::grid;
        fewer = better_of(fewer, turned);
        if (!holds(fewer, decibels)) continue;
        settings = fewer;
        break;
    }
    while (technique_ == Technique::triangles && settings.edge < kWidestEdge * stage_.pixel_in_uv()) {
        RivalSettings wider = settings;
        wider.edge *= 2.0;
        if (!holds(wider, decibels)) break;
        settings = wider;
    }
    if (marches(technique_)) {
        const std::vector<int> steps = steps_of(technique_);
        for (auto next = steps.rbegin(); next != steps.rend(); ++next) {
            if (*next >= settings.steps) continue;
            RivalSettings fewer = settings;
            fewer.steps = *next;
            if (!holds(fewer, decibels)) break;
            settings = fewer;
        }
    }
    if (technique_ == Technique::cones) {
        RivalSettings rough = settings;
        rough.refinements = 6;
        if (holds(rough, decibels)) settings = rough;
    }
    if (settings.wide_heights) {
        RivalSettings narrow = settings;
        narrow.wide_heights = false;
        if (holds(narrow, decibels)) settings = narrow;
    }
    while (settings.size > limits_.coarsest) {
        RivalSettings smaller = settings;
        smaller.size /= 2;
        if (!holds(smaller, decibels)) break;
        settings = smaller;
    }
    return settings;
}

bool Searcher::too_slow() {
    RivalSettings least;
    least.technique = technique_;
    least.size = limits_.coarsest;
    least.samples = 1;
    least.edge = 2.0 * stage_.pixel_in_uv();
    least.steps = steps_of(technique_).front();
    return try_setting(least).milliseconds > limits_.slowest;
}

Found Searcher::find(double decibels) {
    if (too_slow()) return {false, true, tried_.back()};
    RivalSettings settings = best_quality(decibels);
    const bool reached = holds(settings, decibels);
    if (reached) settings = cheapest(settings, decibels);
    return {reached, false, {settings, try_setting(settings)}};
}

std::function<void(RenderOptions&)> burin_setting(const std::string& name) {
    for (const NamedSetting& setting : kBurin)
        if (name == setting.name) return setting.apply;
    return [](RenderOptions&) {};
}

Result<std::vector<BurinTried>> try_burin(Stage& stage) {
    std::vector<BurinTried> tried;
    for (const NamedSetting& setting : kBurin) {
        auto draw = stage.burin(setting.apply);
        if (!draw) return draw.error();
        tried.push_back({setting.name, stage.measure(*draw)});
    }
    return tried;
}

}  // namespace burin::rivals
