// Question: what does a pixel fetch, and how often do the shader's loops turn for it?
//
// Counted in the shader itself, for one sample of each pixel in one run: the ray through its middle with its shadow, or its areas with the
// rays that they ask for. A turn of the outer loop fetches a cell, turns of the inner one fetch lists and elements.
#include <cstdio>

#include "questions.hpp"

namespace burin::bench {
namespace {

struct Way {
    const char* name;
    Antialiasing kind;
};
constexpr Way kWays[] = {{"ray", Antialiasing::points}, {"areas", Antialiasing::regions}};

void measure(const Settings& settings, const Subject& subject) {
    for (PlaneView& view : standard_views(subject, settings.quick ? 160 : 320, settings.quick ? 120 : 240)) {
        const Asset asset = asset_of(subject, extent_of(view, subject.prepared.resolved));
        RenderOptions options = options_of(view, subject.prepared.resolved.size);
        options.backend = settings.backend;
        options.rays = 4;
        for (const Way& way : kWays) {
            options.antialiasing = way.kind;
            const auto counts = count_fetches(asset, options);
            if (!counts) {
                std::printf("| %s | %s | %s | %s |\n", subject.name.c_str(), view.name.c_str(), way.name, counts.error().message.c_str());
                continue;
            }
            std::printf("| %s | %s | %s | %.1f | %.1f | %.1f | %.1f | %.1f |\n", subject.name.c_str(), view.name.c_str(), way.name, counts->cells,
                        counts->lists, counts->elements, counts->others, counts->all());
            std::fflush(stdout);
        }
    }
}

}  // namespace

void ask_work(const Settings& settings) {
    std::printf("\n### Fetches and turns per pixel\n\nTexels fetched for one sample with its shadow: cells are turns of the outer loop, lists and elements of the inner one.\n\n"
                "| scene | view | by | cells | lists | elements | others | all |\n|---|---|---|--:|--:|--:|--:|--:|\n");
    for_each_subject(settings, [&](const Subject& subject) { measure(settings, subject); });
}

}  // namespace burin::bench
