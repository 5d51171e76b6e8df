// Question: what do rays and areas take, and how far are they from the truth, in a whole scene? The figures 10 and 11 of 2010: its atrium
// by 1, 2 and 4 samples in every pixel and by region sampling, here burin's own atrium from its own camera.
//
// The picture to compare with is 256 rays in every pixel by the same shader: what each ray meets is held against the evaluator in double
// precision by `hits`, part by part, so that only the filter is left to judge. Pixels that an edge of the mesh crosses do not count: one
// sample cannot show them, whatever it does with the pattern.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <burin/image_io.hpp>

#include "image_error.hpp"
#include "questions.hpp"
#include "timing.hpp"

namespace burin::bench {
namespace {

// A row of the table: how many samples of a technique a pixel gets, and the frames per second that 2010 had for it on its own machine and
// atrium; 0: not given.
struct Row {
    const char* name;
    int samples;
    double paper;
};

// A way to draw the scene, timed once for all its rows. Another renderer of the same meshes is one more of these.
struct Technique {
    PassTimer::Draw draw;
    std::vector<Row> rows;
};

struct Atrium {
    Asset asset;
    Asset bare;  // without patterns
    RenderOptions options;
};

Result<Atrium> open_atrium(const Settings& settings) {
    auto opened = open_scene(scenes::find_scene("atrium")->make());
    if (!opened) return opened.error();
    Atrium atrium{opened->asset, std::move(opened->asset), opened->options};
    for (MaterialInfo& material : atrium.bare.materials) material.has_detail = false;
    atrium.options.width = settings.quick ? 200 : 400;
    atrium.options.height = settings.quick ? 150 : 300;
    atrium.options.backend = settings.backend;
    return atrium;
}

PassTimer::Draw draw_with(const Asset& asset, RenderOptions options, Antialiasing antialiasing, int rays = 4) {
    options.antialiasing = antialiasing;
    options.rays = rays;
    return [&asset, options](int samples) mutable {
        options.samples = samples;
        return render_asset(asset, options);
    };
}

std::vector<Technique> techniques(const Atrium& atrium) {
    return {
        {draw_with(atrium.asset, atrium.options, Antialiasing::points),
         {{"1 sample", 1, 65.3}, {"2 samples", 2, 29.0}, {"4 samples", 4, 17.24}, {"16 samples", 16, 0.0}}},
        {draw_with(atrium.asset, atrium.options, Antialiasing::regions), {{"areas, 4 rays where features meet", 1, 33.6}}},
        {draw_with(atrium.asset, atrium.options, Antialiasing::regions, 16), {{"areas, 16 rays where features meet", 1, 0.0}}},
    };
}

bool differ(const RgbaImage& a, const RgbaImage& b, std::size_t pixel, int most) {
    for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(int(a.texels[4 * pixel + k]) - int(b.texels[4 * pixel + k])) > most) return true;
    return false;
}

double to_linear(std::uint8_t code) {
    const double value = code / 255.0;
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

// Pixels count where the pattern shows, and no edge of the mesh.
Result<TruthPicture> draw_target(const Atrium& atrium) {
    const auto many = draw_with(atrium.asset, atrium.options, Antialiasing::points)(256);
    const auto bare = draw_with(atrium.bare, atrium.options, Antialiasing::points);
    const auto smooth = bare(64), single = bare(1);
    for (const auto* picture : {&many, &smooth, &single})
        if (!*picture) return picture->error();
    TruthPicture truth{atrium.options.width, atrium.options.height, {}, {}};
    for (std::size_t i = 0; i < many->texels.size() / 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k) truth.linear.push_back(float(to_linear(many->texels[4 * i + k])));
        truth.feature.push_back(!differ(*smooth, *single, i, 1) && differ(*many, *smooth, i, 2));
    }
    return truth;
}

void save(const Settings& settings, std::string name, const RgbaImage& picture, const TruthPicture& truth) {
    if (settings.pictures.empty()) return;
    std::erase(name, ',');
    std::replace(name.begin(), name.end(), ' ', '_');
    if (Status written = write_png(settings.pictures + "/atrium_" + name + ".png", show_difference(picture, truth)); !written)
        std::fprintf(stderr, "%s\n", written.error().message.c_str());
}

void print_row(const Settings& settings, const Technique& technique, const Row& row, double seconds, const TruthPicture& truth) {
    const auto picture = technique.draw(row.samples);
    if (!picture) {
        std::printf("| %s | %s |\n", row.name, picture.error().message.c_str());
        return;
    }
    const ImageError error = compare_pictures(*picture, truth);
    char paper[20] = "";
    if (row.paper > 0.0) std::snprintf(paper, sizeof paper, "%g", row.paper);
    std::printf("| %s | %.0f | %.2f | %.4f | %d | %s |\n", row.name, 1e3 * seconds * row.samples, error.psnr, error.ssim, error.bad_pixels, paper);
    std::fflush(stdout);
    save(settings, row.name, *picture, truth);
}

void print_frames(const Settings& settings, const Atrium& atrium, const TruthPicture& truth) {
    constexpr int kTries = 3;
    std::printf("\n### Atrium\n\n%d x %d pixels, of which %td show a pattern and no edge of the mesh. Processor time of a frame, ms: the median of %d tries that take\n"
                "turns; loading and building programs not counted. Samples beyond four go only where pixels are uneven: the time of 16 is a bound. Errors against 256 rays in every pixel of the same shader. Paper: frames per second.\n\n"
                "| technique | ms | PSNR | SSIM | off | paper fps |\n|---|--:|--:|--:|--:|--:|\n",
                truth.width, truth.height, std::count(truth.feature.begin(), truth.feature.end(), 1), kTries);
    const std::vector<Technique> all = techniques(atrium);
    std::vector<PassTimer> timers;
    for (const Technique& technique : all) timers.emplace_back(technique.draw);
    for (int k = 0; k < kTries; ++k)
        for (PassTimer& timer : timers) timer.try_once();
    for (std::size_t i = 0; i < all.size(); ++i)
        for (const Row& row : all[i].rows) print_row(settings, all[i], row, timers[i].median_seconds(), truth);
}

}  // namespace

void ask_atrium(const Settings& settings) {
    if (!settings.scene.empty() && settings.scene != "atrium") return;
    const auto atrium = open_atrium(settings);
    const auto truth = atrium ? draw_target(*atrium) : Result<TruthPicture>(atrium.error());
    if (!truth) {
        std::printf("\nAtrium: %s\n", truth.error().message.c_str());
        return;
    }
    print_frames(settings, *atrium, *truth);
}

}  // namespace burin::bench
