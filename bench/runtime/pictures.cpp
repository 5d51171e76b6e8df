// Question: how far are the shader's pictures from 256 samples per pixel of the truth?
#include <algorithm>
#include <cstdio>

#include <burin/image_io.hpp>

#include "image_error.hpp"
#include "questions.hpp"

namespace burin::bench {
namespace {

std::string file_name(std::string name) {
    for (char& letter : name)
        if (letter == ' ' || letter == ':' || letter == '/') letter = '_';
    return name;
}

void save(const Settings& settings, const std::string& name, const RgbaImage& picture, const TruthPicture& truth) {
    if (settings.pictures.empty()) return;
    const std::string path = settings.pictures + "/" + file_name(name) + ".png";
    if (Status written = write_png(path, show_difference(picture, truth)); !written)
        std::fprintf(stderr, "%s\n", written.error().message.c_str());
}

void measure_view(const Settings& settings, const Subject& subject, const PlaneView& view) {
    const TruthPicture truth = draw_truth(subject, view, settings.cache);
    // From far away a map that ends is too small to hold a whole pixel.
    if (std::count(truth.feature.begin(), truth.feature.end(), 1) == 0) return;
    const Asset asset = asset_of(subject, extent_of(view, subject.prepared.resolved));
    std::printf("| %s | %s ", subject.name.c_str(), view.name.c_str());
    for (const Configuration& configuration : configurations(settings)) {
        RenderOptions options = options_of(view, subject.prepared.resolved.size);
        options.backend = settings.backend;
        configuration.apply(options);
        const auto picture = render_asset(asset, options);
        if (!picture) {
            std::printf("| %s | ", picture.error().message.c_str());
            continue;
        }
        const ImageError error = compare_pictures(*picture, truth);
        std::printf("| %.1f | %.4f | %d ", error.psnr, error.ssim, error.bad_pixels);
        save(settings, subject.name + " " + view.name + " " + configuration.name, *picture, truth);
    }
    std::printf("|\n");
    std::fflush(stdout);
}

}  // namespace

void ask_pictures(const Settings& settings) {
    std::printf("\n### Pictures against 256 samples per pixel of the truth\n\n"
                "PSNR in dB and SSIM over the pixels whose footprint meets a feature or a shadow's edge; off: pixels wrong by more\n"
                "than a quarter of the range.\n\n| scene | view |");
    for (const Configuration& configuration : configurations(settings)) std::printf(" %s: PSNR | SSIM | off |", configuration.name);
    std::printf("\n|---|---|");
    for (std::size_t i = 0; i < configurations(settings).size(); ++i) std::printf("--:|--:|--:|");
    std::printf("\n");
    for_each_subject(settings, [&](const Subject& subject) {
        for (const PlaneView& view : standard_views(subject, settings.quick ? 96 : 160, settings.quick ? 72 : 120))
            measure_view(settings, subject, view);
    });
}

}  // namespace burin::bench
