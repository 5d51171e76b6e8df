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

}  // namespace

void ask_cost(const Settings& settings) {
    const auto context = gl::open_context(settings.backend);
    if (!context) return void(std::printf("cost: %s\n", context.error().message.c_str()));
    std::printf("\n### Time and error of a picture\n\n"
                "Processor time of a picture in ms, the least of several, and PSNR in dB as in the table of pictures.\n\n");
    print_head(settings, "scene | view", 2, 0, {"ms", "dB"});
    print_picture_rows(settings, [&](const Picture& picture, const Configuration&, const RenderOptions& options) {
        const auto cost = cost_of(**context, picture.asset, options, picture.truth, settings.quick ? 3 : 7);
        if (cost) std::printf("| %.1f | %.1f ", cost->milliseconds, cost->decibels);
        else std::printf("| %s | ", cost.error().message.c_str());
    });
}

}  // namespace burin::bench
