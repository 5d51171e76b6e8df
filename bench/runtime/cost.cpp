// Question: what does a picture cost with each setting, and how near does it come to the truth for that?
#include <algorithm>
#include <cstdio>
#include <ctime>

#include <gl/prepared_asset.hpp>

#include "image_error.hpp"
#include "questions.hpp"

namespace burin::bench {
namespace {

struct Cost {
    double milliseconds = 1e9;  // of processor time, all threads; the least of the runs
    double decibels = 0.0;
};

// Context, textures and programs are there before.
Result<Cost> cost_of(const gl::Context& context, const Asset& asset, const RenderOptions& options, const TruthPicture& truth, int runs) {
    auto prepared = gl::PreparedAsset::load(context, asset, options);
    if (!prepared) return prepared.error();
    auto drawn = prepared->draw();
    if (!drawn) return drawn.error();
    Cost cost;
    cost.decibels = compare_pictures(drawn->image(), truth).psnr;
    for (int k = 0; k < runs; ++k) {
        const std::clock_t before = std::clock();
        if (drawn = prepared->draw(); !drawn) return drawn.error();
        cost.milliseconds = std::min(cost.milliseconds, double(std::clock() - before) * 1e3 / CLOCKS_PER_SEC);
    }
    return cost;
}

void measure_view(const Settings& settings, const gl::Context& context, const Subject& subject, const PlaneView& view) {
    const TruthPicture truth = draw_truth(subject, view, settings.cache);
    if (std::count(truth.feature.begin(), truth.feature.end(), 1) == 0) return;
    const Asset asset = asset_of(subject, extent_of(view, subject.prepared.resolved));
    std::printf("| %s | %s ", subject.name.c_str(), view.name.c_str());
    for (const Configuration& configuration : configurations(settings)) {
        RenderOptions options = options_of(view, subject.prepared.resolved.size);
        options.backend = settings.backend;
        configuration.apply(options);
        const auto cost = cost_of(context, asset, options, truth, settings.quick ? 3 : 7);
        if (cost) std::printf("| %.1f | %.1f ", cost->milliseconds, cost->decibels);
        else std::printf("| %s | ", cost.error().message.c_str());
    }
    std::printf("|\n");
    std::fflush(stdout);
}

}  // namespace

void ask_cost(const Settings& settings) {
    const auto context = gl::open_context(settings.backend);
    if (!context) return void(std::printf("cost: %s\n", context.error().message.c_str()));
    std::printf("\n### Time and error of a picture\n\nProcessor time of a picture in ms, the least of several, and PSNR in dB as in the table of pictures.\n\n| scene | view |");
    for (const Configuration& configuration : configurations(settings)) std::printf(" %s: ms | dB |", configuration.name);
    std::printf("\n|---|---|");
    for (std::size_t i = 0; i < configurations(settings).size(); ++i) std::printf("--:|--:|");
    std::printf("\n");
    for_each_subject(settings, [&](const Subject& subject) {
        for (const PlaneView& view : standard_views(subject, settings.quick ? 96 : 160, settings.quick ? 72 : 120))
            measure_view(settings, **context, subject, view);
    });
}

}  // namespace burin::bench
