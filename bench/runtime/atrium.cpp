// Question: what do rays, areas and relief mapping take, and how far are they from the truth, in a whole scene? The figures 10 and 11 of 2010:
// its atrium by relief mapping with and without antialiasing, by 1, 2 and 4 samples in every pixel, and by region sampling; here burin's
// own atrium from its own camera.
//
// The picture to compare with is 256 rays in every pixel by the same shader: what each ray meets is held against the evaluator in double
// precision by `hits`, part by part, so that only the filter is left to judge. Pixels that an edge of the mesh crosses do not count: one
// sample cannot show them, whatever it does with the pattern. The lamp and the soft surround light it for all alike, not the room: burin's
// shade of the room in grooves comes from their profiles, which a map does not know.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <burin/image_io.hpp>
#include <rivals/furnished.hpp>

#include "image_error.hpp"
#include "questions.hpp"

namespace burin::bench {
namespace {

using rivals::RivalSettings, rivals::Technique;

// A row of the table. `paper`: the frames per second that 2010 had for it on its own machine and atrium; 0: not given.
struct Row {
    std::string name, setting;
    double paper = 0.0, bytes = 0.0;
    rivals::Draw draw;
    std::vector<double> milliseconds;
};

struct BurinRow {
    const char* name;
    Antialiasing antialiasing;
    int samples, rays;
    double paper;
};
constexpr BurinRow kBurin[] = {
    {"1 sample", Antialiasing::points, 1, 4, 65.3},
    {"2 samples", Antialiasing::points, 2, 4, 29.0},
    {"4 samples", Antialiasing::points, 4, 4, 17.24},
    {"16 samples", Antialiasing::points, 16, 4, 0.0},
    {"areas, 4 rays where features meet", Antialiasing::regions, 1, 4, 33.6},
    {"areas, 16 rays where features meet", Antialiasing::regions, 1, 16, 0.0},
};

struct RivalRow {
    const char* name;
    Technique technique;
    int samples;
    double paper;
};
constexpr RivalRow kRivals[] = {
    {"relief mapping", Technique::relief, 1, 51.8},
    {"relief mapping with 4x full-screen antialiasing", Technique::relief, 4, 33.1},
    {"relief mapping with 16x full-screen antialiasing", Technique::relief, 16, 0.0},
    {"relaxed cones", Technique::cones, 1, 0.0},
    {"relaxed cones with 4x full-screen antialiasing", Technique::cones, 4, 0.0},
    {"relaxed cones with 16x full-screen antialiasing", Technique::cones, 16, 0.0},
};
constexpr int kTexels = 2048;  // per side of the maps that rivals start from; fewer where those lose nothing

struct Atrium {
    scenes::Scene scene;
    Asset asset;
    Asset bare;  // without patterns
    RenderOptions options;
};

Result<Atrium> open_atrium(const Settings& settings) {
    scenes::Scene scene = scenes::find_scene("atrium")->make();
    scene.view.room = false;
    auto opened = open_scene(scene);
    if (!opened) return opened.error();
    Atrium atrium{std::move(scene), opened->asset, std::move(opened->asset), opened->options};
    for (MaterialInfo& material : atrium.bare.materials) material.has_detail = false;
    atrium.options.width = settings.quick ? 200 : 400;
    atrium.options.height = settings.quick ? 150 : 300;
    atrium.options.backend = settings.backend;
    return atrium;
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
    const auto draw = [&](const Asset& asset, int samples) {
        RenderOptions options = atrium.options;
        options.antialiasing = Antialiasing::points;
        options.samples = samples;
        return render_asset(asset, options);
    };
    const auto many = draw(atrium.asset, 256), smooth = draw(atrium.bare, 64), single = draw(atrium.bare, 1);
    for (const auto* picture : {&many, &smooth, &single})
        if (!*picture) return picture->error();
    TruthPicture truth{atrium.options.width, atrium.options.height, {}, {}};
    for (std::size_t i = 0; i < many->texels.size() / 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k) truth.linear.push_back(float(to_linear(many->texels[4 * i + k])));
        truth.feature.push_back(!differ(*smooth, *single, i, 1) && differ(*many, *smooth, i, 2));
    }
    return truth;
}

Result<std::vector<Row>> burin_rows(const gl::Context& context, const Atrium& atrium) {
    double bytes = 0.0;
    for (const MaterialInfo& material : atrium.asset.materials)
        bytes += 4.0 * double(material.textures.grid.size() + material.textures.data.size());
    std::vector<Row> rows;
    for (const BurinRow& row : kBurin) {
        RenderOptions options = atrium.options;
        options.antialiasing = row.antialiasing;
        options.samples = row.samples;
        options.rays = row.rays;
        auto draw = rivals::prepare_burin(context, atrium.asset, options);
        if (!draw) return draw.error();
        rows.push_back({row.name, "", row.paper, bytes, *draw, {}});
    }
    return rows;
}

std::string text_of(const RivalSettings& settings) {
    char text[80];
    std::snprintf(text, sizeof text, "%d², %d steps, %d halvings, bias %g%s", settings.size, settings.steps, settings.refinements, double(settings.bias),
                  settings.samples > 1 && settings.places == rivals::Places::hammersley ? ", Hammersley" : "");
    return text;
}

// Each with the setting that suits it best.
Result<std::vector<Row>> rival_rows(rivals::FurnishedScene& furnished, const TruthPicture& truth) {
    std::vector<Row> rows;
    for (const RivalRow& row : kRivals) {
        RivalSettings settings;
        settings.technique = row.technique;
        settings.size = kTexels;
        settings.samples = row.samples;
        settings.steps = 64;
        settings.refinements = 8;
        settings.wide_heights = true;
        const bool outlines = row.samples > 1;
        if (const auto first = furnished.draw(settings, outlines); !first) return first.error();
        settings = rivals::tune_rival(settings, [&](const RivalSettings& tried) { return compare_pictures((*furnished.draw(tried, outlines))().image(), truth).psnr; });
        rows.push_back({row.name, text_of(settings), row.paper, furnished.bytes_of(settings).plain, *furnished.draw(settings, outlines), {}});
    }
    return rows;
}

void save(const Settings& settings, std::string name, const RgbaImage& picture, const TruthPicture& truth) {
    if (settings.pictures.empty()) return;
    std::erase(name, ',');
    std::replace(name.begin(), name.end(), ' ', '_');
    if (Status written = write_png(settings.pictures + "/atrium_" + name + ".png", show_difference(picture, truth)); !written)
        std::fprintf(stderr, "%s\n", written.error().message.c_str());
}

void print_row(const Settings& settings, Row& row, const TruthPicture& truth) {
    const RgbaImage picture = row.draw().image();
    const ImageError error = compare_pictures(picture, truth);
    const auto middle = row.milliseconds.begin() + std::ptrdiff_t(row.milliseconds.size() / 2);
    std::nth_element(row.milliseconds.begin(), middle, row.milliseconds.end());
    char paper[20] = "";
    if (row.paper > 0.0) std::snprintf(paper, sizeof paper, "%g", row.paper);
    std::printf("| %s | %s | %.0f | %.2f | %.4f | %d | %.1f | %s |\n", row.name.c_str(), row.setting.c_str(), *middle, error.psnr, error.ssim,
                error.bad_pixels, row.bytes / 1000.0, paper);
    std::fflush(stdout);
    save(settings, row.name, picture, truth);
}

void print_frames(const Settings& settings, const TruthPicture& truth, std::vector<Row>& rows) {
    constexpr int kTries = 3;
    std::printf("\n### Atrium\n\n%d x %d pixels, of which %td show a pattern and no edge of the mesh. Processor time of a frame, ms: the median of %d tries that take\n"
                "turns; loading and building programs not counted. Errors against 256 rays in every pixel of the same shader. kB: of all materials' textures, a\n"
                "rival's with mips. Rivals: maps of one size for every material, at first %d²; the mip bias and places of least error, then as few steps and texels as\n"
                "lose no more than 0.05 dB. Paper: frames per second; relief mapping with maps of 1024², antialiased of 512².\n\n"
                "| technique | setting | ms | PSNR | SSIM | off | kB | paper fps |\n|---|---|--:|--:|--:|--:|--:|--:|\n",
                truth.width, truth.height, std::count(truth.feature.begin(), truth.feature.end(), 1), kTries, kTexels);
    for (int k = 0; k < kTries; ++k)
        for (Row& row : rows) row.milliseconds.push_back(rivals::time_once(row.draw));
    for (Row& row : rows) print_row(settings, row, truth);
}

Status compare_techniques(const Settings& settings, const Atrium& atrium, const TruthPicture& truth) {
    const auto context = gl::open_context(settings.backend);
    if (!context) return context.error();
    auto furnished = rivals::FurnishedScene::prepare(**context, atrium.scene, atrium.asset, atrium.options, kTexels, settings.cache);
    if (!furnished) return furnished.error();
    auto rows = rival_rows(*furnished, truth);
    auto own = burin_rows(**context, atrium);
    if (!rows || !own) return rows ? own.error() : rows.error();
    rows->insert(rows->end(), own->begin(), own->end());
    print_frames(settings, truth, *rows);
    return Done{};
}

}  // namespace

void ask_atrium(const Settings& settings) {
    if (!settings.scene.empty() && settings.scene != "atrium") return;
    const auto atrium = open_atrium(settings);
    const auto truth = atrium ? draw_target(*atrium) : Result<TruthPicture>(atrium.error());
    const Status done = truth ? compare_techniques(settings, *atrium, *truth) : Status(truth.error());
    if (!done) std::printf("\nAtrium: %s\n", done.error().message.c_str());
}

}  // namespace burin::bench
