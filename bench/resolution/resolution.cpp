// Resolution independence: how far the half-height contours of a reconstruction lie from those of the drawing the map
// was made from, beside the same for bilinear interpolation of the map. Prints a Markdown table.
//
//     resolution [--start disturbed|traced|vectorized] [--patterns plate|random|all] [--maps 512,1024] [--bits 16]
//                [--seeds N] [--zoom 8192] [--spots N] [--walls 0..3]
//                [--picture FILE.png:X:Y:SIDE]
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <burin/refine.hpp>

#include "authored.hpp"
#include "contour.hpp"
#include "level_lines.hpp"
#include "picture.hpp"
#include "start.hpp"

namespace burin::bench {
namespace {

struct Options {
    std::string start = "disturbed";
    std::string patterns = "plate";
    std::vector<int> maps{512, 1024};
    int bits = 16, seeds = 4, zoom = 8192, walls = -1;  // walls: one of the four readings, or all
    int spots = 0;  // how many of the worst places are listed
    std::string picture;
};

struct Case {
    std::string name;
    int texels;
    Walls walls;
    Pattern pattern;
};

struct Row {
    double ours = 0, ours999 = 0, ours_max = 0, lost = 0, bilinear = 0, bilinear999 = 0, bilinear_lost = 0, start = 0, rms = 0, seconds = 0;
    Vec2 worst;
    std::vector<LineDistance::Spot> spots;
};

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// FILE.png:X:Y:SIDE
void draw_picture(const std::string& request, const Image& map, const std::vector<Segment>& truth,
                  const std::vector<Segment>& ours, const std::vector<Segment>& paths) {
    const std::size_t c3 = request.rfind(':'), c2 = request.rfind(':', c3 - 1), c1 = request.rfind(':', c2 - 1);
    const Vec2 corner{std::atof(request.substr(c1 + 1).c_str()), std::atof(request.substr(c2 + 1).c_str())};
    write_close_up(request.substr(0, c1), map, corner, std::atoi(request.substr(c3 + 1).c_str()), truth, ours, paths);
}

Row measure(const Case& c, const Options& options, unsigned seed) {
    const Image map = map_of(c.pattern, c.texels, options.bits);
    Row row;
    Pattern ours;
    const std::vector<double> heights = half_heights(c.pattern);
    const auto lines = [&](const Pattern& pattern) { return lines_of(pattern, heights, options.zoom, c.texels); };
    const std::vector<Segment> truth = lines(c.pattern);
    if (options.start == "vectorized" || options.start == "traced") {
        const double before = now();
        ours = vectorized(map, c.pattern, options.start == "vectorized");
        row.seconds = now() - before;
    } else {
        ours = disturbed(c.pattern, c.texels, 0.3, 0.05, seed);
        row.start = distance_between(truth, lines(ours)).rms;
        const double before = now();
        const Result<RefineReport> report = refine_pattern(ours, map);
        row.seconds = now() - before;
        if (!report) {
            std::fprintf(stderr, "resolution: %s\n", report.error().message.c_str());
            std::exit(3);
        }
        row.rms = report->rms_after;
    }
    const std::vector<Segment> our_lines = lines(ours);
    const LineDistance distance = distance_between(truth, our_lines);
    const LineDistance bilinear = distance_between(truth, lines_of(zoomed(map, options.zoom, c.pattern.wrap), heights, c.texels));
    row.ours = distance.rms, row.ours999 = distance.p999, row.ours_max = distance.max, row.lost = distance.lost;
    row.worst = distance.worst;
    row.spots = distance.spots;
    row.bilinear = bilinear.rms, row.bilinear999 = bilinear.p999, row.bilinear_lost = bilinear.lost;
    if (!options.picture.empty()) draw_picture(options.picture, map, truth, our_lines, chords_of(ours, c.texels));
    return row;
}

std::vector<Case> cases_of(const Options& options) {
    struct Reading {
        const char* name;
        Walls walls;
    };
    const Reading readings[] = {{"groove 8, walls 2", {8.0, 2.0}},
                                {"groove 8, walls 0.4", {8.0, 0.4}},
                                {"groove 2, vertical", {2.0, 0.0}},
                                {"groove 0.4, vertical", {0.4, 0.0}}};
    std::vector<Case> cases;
    for (const int texels : options.maps) {
        for (int k = 0; k < 4; ++k) {
            if (options.walls >= 0 && k != options.walls) continue;
            const Reading& reading = readings[k];
            if (options.patterns != "random")
                cases.push_back({std::string("plate, ") + reading.name, texels, reading.walls, plate(texels, reading.walls)});
            for (int seed = 1; seed <= options.seeds && options.patterns != "plate"; ++seed)
                cases.push_back({"random " + std::to_string(seed) + ", " + reading.name, texels, reading.walls,
                                 random_plate(texels, reading.walls, static_cast<unsigned>(seed))});
        }
    }
    return cases;
}

std::vector<int> numbers(const char* text) {
    std::vector<int> out;
    for (const char* p = text; *p;) {
        char* end = nullptr;
        out.push_back(static_cast<int>(std::strtol(p, &end, 10)));
        p = *end == ',' ? end + 1 : end;
        if (end == text) break;
    }
    return out;
}

Options read_options(int argc, char** argv) {
    Options options;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        const char* value = argv[i + 1];
        if (name == "--start") options.start = value;
        else if (name == "--patterns") options.patterns = value;
        else if (name == "--maps") options.maps = numbers(value);
        else if (name == "--bits") options.bits = std::atoi(value);
        else if (name == "--seeds") options.seeds = std::atoi(value);
        else if (name == "--zoom") options.zoom = std::atoi(value);
        else if (name == "--walls") options.walls = std::atoi(value);
        else if (name == "--spots") options.spots = std::atoi(value);
        else if (name == "--picture") options.picture = value;
        else std::fprintf(stderr, "resolution: unknown option %s\n", name.c_str()), std::exit(2);
    }
    return options;
}

int run(const Options& options) {
    std::printf("Distance of half-height contours from the drawing's, in map texels; %d bits, reconstructed at %d, start: %s.\n\n",
                options.bits, options.zoom, options.start.c_str());
    std::printf("| map | pattern | ours RMS | ours 99.9 %% | ours max | lost | bilinear RMS | bilinear 99.9 %% | lost | start RMS | height RMS | s | worst at |\n");
    std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const Case& c : cases_of(options)) {
        const Row r = measure(c, options, 7);
        std::printf("| %d | %s | %.4f | %.3f | %.3f | %.2f %% | %.4f | %.3f | %.2f %% | %.3f | %.5f | %.2f | %.1f, %.1f |\n", c.texels, c.name.c_str(), r.ours,
                    r.ours999, r.ours_max, 100 * r.lost, r.bilinear, r.bilinear999, 100 * r.bilinear_lost, r.start, r.rms, r.seconds, r.worst.x, r.worst.y);
        for (std::size_t i = 0; i < r.spots.size() && i < static_cast<std::size_t>(options.spots); ++i)
            std::printf("    %.0f, %.0f: %.1f %% of the mean square\n", r.spots[i].corner.x, r.spots[i].corner.y, 100 * r.spots[i].share);
        std::fflush(stdout);
    }
    return 0;
}

}  // namespace
}  // namespace burin::bench

int main(int argc, char** argv) { return burin::bench::run(burin::bench::read_options(argc, argv)); }
