// Question: does a picture cost more when the pattern holds more features, as many of them being seen?
//
// Grooves of random direction, one to each square of a lattice, so that the density stays. With more than 65536 texels of elements
// a pattern is wide; a million grooves are one wide pattern, and a sheet of 4 x 4 materials with a pattern of 62500 each that is not.
#include <cmath>
#include <cstdio>

#include <scenes/drawing.hpp>

#include "questions.hpp"
#include "timing.hpp"

namespace burin::bench {
namespace {

constexpr double kSpacing = 0.01;

scenes::Scene make_lattice(int side, std::uint64_t seed) {
    Pattern p;
    p.size = {side * kSpacing, side * kSpacing};
    p.depth = 0.0012;
    p.profiles = {scenes::trough(0.0010, 0.0004, 0.0010)};
    scenes::Chance chance(seed);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double angle = chance.between(0.0, scenes::kPi);
            const Vec2 middle = Vec2{x + chance.between(0.4, 0.6), y + chance.between(0.4, 0.6)} * kSpacing;
            const Vec2 way = Vec2{std::cos(angle), std::sin(angle)} * (0.35 * kSpacing);
            p.paths.push_back(scenes::polyline({middle - way, middle + way}).path(0));
        }
    scenes::Scene scene;
    scene.parts.push_back({"lattice", std::move(p), {}, {0.8f, 0.8f, 0.8f}, 0.0f, 0.5f});
    return scene;
}

// `tiles` x `tiles` materials side by side, each with a pattern of its own; the subject is the one that lies in the middle.
struct Sheet {
    Subject subject;
    Asset asset;
    double bytes = 0.0;
};

Result<Sheet> make_sheet(int side, int tiles, const PlaneView& view) {
    Sheet sheet;
    for (int tile = 0; tile < tiles * tiles; ++tile) {
        auto subject = prepare_subject("lattice", make_lattice(side, 1 + std::uint64_t(tile)));
        if (!subject) return subject.error();
        // One material alone repeats over all that is seen, several lie side by side.
        const Extent extent = tiles > 1 ? Extent{{0, 0}, {1, 1}} : extent_of(view, subject->prepared.resolved);
        Asset one = asset_of(*subject, extent);
        const double width = side * kSpacing, middle = (tiles - 1) / 2.0;
        for (std::size_t i = 0; tiles > 1 && i < one.primitives[0].positions.size(); i += 3) {
            one.primitives[0].positions[i] += float((tile % tiles - middle) * width);
            one.primitives[0].positions[i + 2] += float((tile / tiles - middle) * width);
        }
        one.primitives[0].material = tile;
        sheet.asset.primitives.push_back(std::move(one.primitives[0]));
        sheet.asset.materials.push_back(std::move(one.materials[0]));
        sheet.bytes += 4.0 * double(subject->prepared.textures.grid.size() + subject->prepared.textures.data.size());
        if (tile == tiles * tiles / 2) sheet.subject = std::move(*subject);
    }
    return sheet;
}

double nanoseconds_of(const Asset& asset, const RenderOptions& options, const Settings& settings) {
    PassTimer timer(asset, options);
    for (int k = 0; k < (settings.quick ? 2 : 5); ++k) timer.try_once();
    return timer.seconds() / (options.width * options.height) * 1e9;
}

}  // namespace

void ask_features(const Settings& settings) {
    std::printf("\n### Cost against the number of features\n\nThe same view, as many grooves seen: processor time and texels fetched of a pixel's ray with its shadow.\n\n"
                "| grooves | materials | MB | cell mm | ns per pixel | over the first | cells | lists | elements | others |\n"
                "|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    struct Row {
        int side, tiles;
    };
    constexpr Row kRows[] = {{10, 1}, {32, 1}, {100, 1}, {250, 1}, {300, 1}, {1000, 1}, {250, 4}};
    double first = 0.0;
    for (const Row& row : kRows) {
        if (settings.quick && row.side * row.tiles > 300) continue;
        PlaneView view;
        view.width = settings.quick ? 256 : 640;
        view.height = settings.quick ? 192 : 480;
        // A place beside the middle, where materials would meet.
        view.focus = Vec2{0.53, 0.53} * (row.side * kSpacing);
        view.pixel = kSpacing * 8.0 / view.height;
        const auto sheet = make_sheet(row.side, row.tiles, view);
        if (!sheet) {
            std::printf("| %d | %d | %s |\n", row.side * row.side * row.tiles * row.tiles, row.tiles * row.tiles, sheet.error().message.c_str());
            continue;
        }
        RenderOptions options = options_of(view, sheet->subject.prepared.resolved.size);
        options.antialiasing = Antialiasing::points;
        options.backend = settings.backend;
        const auto work = count_fetches(sheet->asset, options);
        if (!work) {
            std::printf("| %d | %d | %s |\n", row.side * row.side * row.tiles * row.tiles, row.tiles * row.tiles, work.error().message.c_str());
            continue;
        }
        const double time = nanoseconds_of(sheet->asset, options, settings);
        if (first == 0.0) first = time;
        std::printf("| %d | %d | %.2f | %.2f | %.0f | %.2f | %.2f | %.2f | %.2f | %.2f |\n", row.side * row.side * row.tiles * row.tiles,
                    row.tiles * row.tiles, sheet->bytes / 1e6, row.side * kSpacing * 1e3 / sheet->subject.prepared.textures.grid_width, time, time / first, work->cells, work->lists, work->elements, work->others);
        std::fflush(stdout);
    }
}

}  // namespace burin::bench
