// Question: does the picture flicker while the camera moves? The mean change from frame to frame, beside the truth's own.
#include <cmath>
#include <cstdio>

#include "image_error.hpp"
#include "questions.hpp"

namespace burin::bench {
namespace {

using Frame = std::vector<double>;  // sRGB values

Frame values_of(const RgbaImage& picture) {
    Frame frame;
    for (std::size_t i = 0; i < picture.texels.size(); ++i)
        if (i % 4 != 3) frame.push_back(picture.texels[i] / 255.0);
    return frame;
}
Frame values_of(const TruthPicture& picture) {
    Frame frame;
    for (const float value : picture.linear) frame.push_back(to_srgb(double(value)));
    return frame;
}

double difference(const Frame& a, const Frame& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
    return sum / double(a.size());
}

struct Move {
    const char* name;
    PlaneView (*view)(const Subject&, PlaneView, int frame, double share);
};

// From 12 pixels to the width of a feature out to 0.4.
PlaneView zoomed(const Subject& subject, PlaneView view, int, double share) {
    view.pixel = subject.width / (12.0 * std::pow(0.4 / 12.0, share));
    return view;
}
// A third of a pixel a frame, aslant, where a feature is one and a half pixels wide.
PlaneView panned(const Subject& subject, PlaneView view, int frame, double) {
    view.pixel = subject.width / 1.5;
    view.focus = view.focus + Vec2{0.31, 0.13} * (view.pixel * frame);
    return view;
}
constexpr Move kMoves[] = {{"zoom", zoomed}, {"pan", panned}};

void measure(const Settings& settings, const Subject& subject, const Move& move) {
    const int frames = settings.quick ? 16 : 200;
    PlaneView base = standard_views(subject, 48, 36)[1];
    const std::vector<Configuration> settings_asked = configurations(settings);
    const std::size_t rows = settings_asked.size();
    std::vector<double> change(rows + 1, 0.0);
    std::vector<Frame> before(rows + 1);
    for (int k = 0; k < frames; ++k) {
        const PlaneView view = move.view(subject, base, k, double(k) / (frames - 1));
        const Asset asset = asset_of(subject, extent_of(view, subject.prepared.resolved));
        for (std::size_t row = 0; row <= rows; ++row) {
            Frame frame;
            if (row == rows) {
                frame = values_of(draw_truth(subject, view, settings.cache));
            } else {
                const auto picture = render_asset(asset, render_options(settings, subject, view, settings_asked[row]));
                if (!picture) continue;
                frame = values_of(*picture);
            }
            if (k > 0) change[row] += difference(frame, before[row]) / (frames - 1);
            before[row] = std::move(frame);
        }
    }
    std::printf("| %s | %s | %d | %.5f ", subject.name.c_str(), move.name, frames, change[rows]);
    for (std::size_t row = 0; row < rows; ++row) std::printf("| %.2f ", change[row] / change[rows]);
    std::printf("|\n");
    std::fflush(stdout);
}

}  // namespace

void ask_flicker(const Settings& settings) {
    std::printf("\n### Flicker\n\nMean change of sRGB values from frame to frame: the truth's, and the shader's over it.\n\n");
    print_head(settings, "scene | move | frames | truth", 2, 2, {""});
    for_each_subject(settings, [&](const Subject& subject) {
        for (const Move& move : kMoves) measure(settings, subject, move);
    });
}

}  // namespace burin::bench
