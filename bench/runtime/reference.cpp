// Question: how far is the reference renderer from the truth, how far is the shader from it, and what does each take?
#include <algorithm>
#include <chrono>
#include <cstdio>

#include <reference/render.hpp>

#include "../../tests/judge/pictures.hpp"
#include "image_error.hpp"
#include "questions.hpp"

namespace burin::bench {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Timed {
    RgbaImage picture;
    double seconds = 0.0;  // the least of the runs
};

template <typename Draw>
Timed time_of(const Draw& draw, int runs) {
    Timed timed;
    for (int i = 0; i < runs; ++i) {
        const auto start = std::chrono::steady_clock::now();
        timed.picture = draw();
        const double seconds = seconds_since(start);
        timed.seconds = i == 0 ? seconds : std::min(timed.seconds, seconds);
    }
    return timed;
}

void measure_view(const Settings& settings, const Subject& subject, const PlaneView& view) {
    const TruthPicture truth = draw_truth(subject, view, settings.cache);
    if (std::count(truth.feature.begin(), truth.feature.end(), 1) == 0) return;
    const Asset asset = asset_of(subject, extent_of(view, subject.prepared.resolved));
    reference::ReferenceOptions options{options_of(view, subject.prepared.resolved.size)};
    options.view.backend = settings.backend;
    reference::ReferenceStats stats;
    const Timed exact = time_of(
        [&] {
            auto picture = reference::render_reference(asset, options);
            stats = picture->stats;
            return picture->image();
        },
        3);
    // The first run builds the program.
    const Timed shader = time_of([&] { return *render_asset(asset, options.view); }, 3);
    const double pixels = double(view.width) * view.height;
    std::printf("| %s | %s | %.1f | %.1f | %.1f | %.2f | %.2f | %ld | %ld | %.0e |\n", subject.name.c_str(), view.name.c_str(),
                compare_pictures(exact.picture, truth).psnr, compare_pictures(shader.picture, truth).psnr, testing::psnr(shader.picture, exact.picture),
                exact.seconds / pixels * 1e6, shader.seconds / pixels * 1e6, stats.by_line, stats.by_area, stats.mean_sum);
    std::fflush(stdout);
    if (!settings.pictures.empty())
        if (Status written = write_png(settings.pictures + "/" + subject.name + "_" + view.name + ".png", show_difference(exact.picture, truth)); !written)
            std::fprintf(stderr, "%s\n", written.error().message.c_str());
}

}  // namespace

void ask_reference(const Settings& settings) {
    std::printf("\n### The reference renderer\n\nPSNR in dB: of the reference and of the shader, as it is by default, against 256 samples per pixel of the\n"
                "truth, over the pixels that meet a feature; and of the shader against the reference, over all of the picture. Microseconds per pixel of\n"
                "the picture, all cores, the least of three. By line, by area: footprints, or parts of them. Off: by how much shares do not sum to 1, mean.\n\n"
                "| scene | view | reference | shader | between | reference us | shader us | by line | by area | off |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for_each_subject(settings, [&](const Subject& subject) {
        for (const PlaneView& view : standard_views(subject, settings.quick ? 96 : 160, settings.quick ? 72 : 120)) measure_view(settings, subject, view);
    });
}

}  // namespace burin::bench
