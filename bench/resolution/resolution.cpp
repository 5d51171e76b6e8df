// Resolution independence: how far the half-height contours of a reconstruction lie from those of the drawing the map
// was made from, beside the same for bilinear interpolation of the map. Prints a Markdown table.
//
//     resolution [--start disturbed|traced|vectorized] [--patterns plate|random|all] [--maps 512,1024] [--bits 16]
//                [--seeds N] [--zoom 8192] [--spots N] [--walls 0..3]
//                [--picture FILE.ppm:X:Y:SIDE]
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <burin/fit.hpp>
#include <burin/refine.hpp>

#include "authored.hpp"
#include "contour.hpp"
#include "level_lines.hpp"
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

// Chords of the paths, in map texels.
std::vector<Segment> chords_of(const Pattern& pattern, int texels) {
    constexpr int kChords = 8;
    std::vector<Segment> chords;
    for (const Path& path : pattern.paths)
        for (const Element& e : path.elements)
            for (int k = 0; k < kChords; ++k)
                chords.push_back({point_at(e, double(k) / kChords) * (texels / pattern.size.x),
                                  point_at(e, (k + 1.0) / kChords) * (texels / pattern.size.x)});
    return chords;
}

// The map enlarged, with the true lines green, ours red, and our paths blue.
void write_picture(const std::string& request, const Image& map, const std::vector<Segment>& truth,
                   const std::vector<Segment>& ours, const std::vector<Segment>& paths) {
    constexpr int kEnlarge = 16;
    const std::size_t c3 = request.rfind(':'), c2 = request.rfind(':', c3 - 1), c1 = request.rfind(':', c2 - 1);
    const int x0 = std::atoi(request.substr(c1 + 1).c_str()), y0 = std::atoi(request.substr(c2 + 1).c_str());
    const int side = std::atoi(request.substr(c3 + 1).c_str()), pixels = side * kEnlarge;
    std::vector<unsigned char> rgb(static_cast<std::size_t>(pixels) * pixels * 3);
    for (int y = 0; y < pixels; ++y)
        for (int x = 0; x < pixels; ++x)
            for (int c = 0; c < 3; ++c)
                rgb[(static_cast<std::size_t>(y) * pixels + x) * 3 + c] = static_cast<unsigned char>(
                    60.0f + 180.0f * map.at(std::min(x0 + x / kEnlarge, map.width - 1), std::min(y0 + y / kEnlarge, map.height - 1)));
    const auto draw = [&](const std::vector<Segment>& lines, int r, int g, int b) {
        for (const Segment& s : lines) {
            const int steps = 1 + static_cast<int>(length(s.b - s.a) * kEnlarge);
            for (int k = 0; k <= steps; ++k) {
                const Vec2 p = lerp(s.a, s.b, double(k) / steps);
                const int x = static_cast<int>((p.x - x0) * kEnlarge), y = static_cast<int>((p.y - y0) * kEnlarge);
                if (x < 0 || y < 0 || x >= pixels || y >= pixels) continue;
                unsigned char* t = &rgb[(static_cast<std::size_t>(y) * pixels + x) * 3];
                t[0] = static_cast<unsigned char>(r), t[1] = static_cast<unsigned char>(g), t[2] = static_cast<unsigned char>(b);
            }
        }
    };
    draw(truth, 0, 160, 0);
    draw(paths, 0, 60, 255);
    draw(ours, 220, 0, 0);
    std::ofstream file(request.substr(0, c1), std::ios::binary);
    file << "P6\n" << pixels << " " << pixels << "\n255\n";
    file.write(reinterpret_cast<const char*>(rgb.data()), static_cast<std::streamsize>(rgb.size()));
}

Row measure(const Case& c, const Options& options, unsigned seed) {
    const Image map = map_of(c.pattern, c.texels, options.bits);
    Row row;
    const double begin = now();
    Pattern ours;
    const std::vector<Segment> truth = lines_of(c.pattern, options.zoom, c.texels);
    if (options.start == "vectorized" || options.start == "traced") {
        ours = vectorized(map, c.pattern, options.start == "vectorized");
    } else {
        ours = disturbed(c.pattern, c.texels, 0.3, 0.05, seed);
        row.start = distance_between(truth, lines_of(ours, options.zoom, c.texels)).rms;
        const double before = now();
        const Result<RefineReport> report = refine_pattern(ours, map);
        row.seconds = now() - before;
        if (!report) {
            std::fprintf(stderr, "resolution: %s\n", report.error().message.c_str());
            std::exit(3);
        }
        row.rms = report->rms_after;
    }
    if (options.start != "disturbed") row.seconds = now() - begin;
    const std::vector<Segment> our_lines = lines_of(ours, options.zoom, c.texels);
    const LineDistance distance = distance_between(truth, our_lines);
    const LineDistance bilinear = distance_between(truth, lines_of(map, options.zoom));
    row.ours = distance.rms, row.ours999 = distance.p999, row.ours_max = distance.max, row.lost = distance.lost;
    row.worst = distance.worst;
    row.spots = distance.spots;
    row.bilinear = bilinear.rms, row.bilinear999 = bilinear.p999, row.bilinear_lost = bilinear.lost;
    if (!options.picture.empty()) write_picture(options.picture, map, truth, our_lines, chords_of(ours, c.texels));
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
