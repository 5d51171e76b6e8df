// Question: does the mean colour stay what it is while the camera goes away?
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <scenes/drawing.hpp>

#include "questions.hpp"
#include "truth_picture.hpp"

namespace burin::bench {
namespace {

double to_linear(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
double luminance(double r, double g, double b) { return 0.2126 * r + 0.7152 * g + 0.0722 * b; }

double mean_of(const RgbaImage& picture) {
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.texels.size(); i += 4)
        sum += luminance(to_linear(picture.texels[i] / 255.0), to_linear(picture.texels[i + 1] / 255.0), to_linear(picture.texels[i + 2] / 255.0));
    return 4.0 * sum / double(picture.texels.size());
}

// Samples at random places of the picture; with the error of their mean.
struct Mean {
    double value = 0.0, error = 0.0;
};
Mean truth_mean(const Subject& subject, const PlaneView& view, const Extent& extent, int count) {
    const TruthScene scene(subject, view, extent);
    scenes::Chance chance(1000);
    std::vector<Vec2> places;
    for (int i = 0; i < count; ++i) places.push_back({chance.uniform() * view.width, chance.uniform() * view.height});
    std::vector<double> seen(places.size());
    testing::in_parallel(places.size(), [&](std::size_t i) {
        const auto color = scene.sample(places[i].x, places[i].y).color;
        seen[i] = luminance(color[0], color[1], color[2]);
    });
    double sum = 0.0, squares = 0.0;
    for (const double value : seen) sum += value, squares += value * value;
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

void measure(const Settings& settings, const Subject& subject) {
    if (subject.prepared.resolved.wrap != Wrap::repeat) {
        std::printf("| %s | one tile only: not asked |\n", subject.name.c_str());
        return;
    }
    const double cell = subject.prepared.resolved.size.x / subject.prepared.textures.grid_width;
    for (const double cells : {1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0}) {
        PlaneView view = standard_views(subject, 64, 48)[1];
        view.pixel = cell * cells;
        view.field_of_view = 2.0;  // every pixel sees the same direction but for a degree
        const Extent extent = extent_of(view, subject.prepared.resolved, 1e5);
        const Mean truth = truth_mean(subject, view, extent, settings.quick ? 5000 : 40000);
        const Asset asset = asset_of(subject, extent);
        std::printf("| %s | %g | %.4f ± %.4f ", subject.name.c_str(), cells, truth.value, truth.error);
        for (const Configuration& configuration : configurations(settings)) {
            const auto picture = render_asset(asset, render_options(settings, subject, view, configuration));
            if (picture) std::printf("| %.3f ", mean_of(*picture) / truth.value);
            else std::printf("| %s ", picture.error().message.c_str());
        }
        std::printf("|\n");
        std::fflush(stdout);
    }
}

}  // namespace

void ask_energy(const Settings& settings) {
    std::printf("\n### Energy\n\nMean linear luminance of a picture while the camera goes away: the truth's, and the shader's over it.\n\n");
    print_head(settings, "scene | cells per pixel | truth", 1, 2, {""});
    for_each_subject(settings, [&](const Subject& subject) { measure(settings, subject); });
}

}  // namespace burin::bench
