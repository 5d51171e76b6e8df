// Question: how far are the shader's pictures from 256 samples per pixel of the truth?
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

void print_cells(const Settings& settings, const Picture& asked, const Configuration& configuration, const RenderOptions& options) {
    const auto picture = render_asset(asked.asset, options);
    if (!picture) return void(std::printf("| %s | | ", picture.error().message.c_str()));
    const ImageError error = compare_pictures(*picture, asked.truth);
    std::printf("| %.1f | %.4f | %d ", error.psnr, error.ssim, error.bad_pixels);
    save(settings, asked.subject.name + " " + asked.view.name + " " + configuration.name, *picture, asked.truth);
}

}  // namespace

void ask_pictures(const Settings& settings) {
    std::printf("\n### Pictures against 256 samples per pixel of the truth\n\n"
                "PSNR in dB and SSIM over the pixels whose footprint meets a feature or a shadow's edge; off: pixels wrong by more\n"
                "than a quarter of the range.\n\n");
    print_head(settings, "scene | view", 2, 0, {"PSNR", "SSIM", "off"});
    print_picture_rows(settings, [&](const Picture& asked, const Configuration& configuration, const RenderOptions& options) {
        print_cells(settings, asked, configuration, options);
    });
}

}  // namespace burin::bench
