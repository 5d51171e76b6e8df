// Shared by the parts of stage vectorize. Lengths are texels, heights map values 0..1, unless a name says otherwise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <burin/geometry.hpp>
#include <burin/image.hpp>
#include <burin/vectorize.hpp>

namespace burin::vectorizing {

// Of a place on the map; without SSE 4.1 std::floor is a call.
inline int floor_of(double x) {
    const int i = static_cast<int>(x);
    return i - (x < i ? 1 : 0);
}

// The map's lattice: neighbours continue over the border when the map tiles, and do not exist there otherwise.
struct Lattice {
    int width = 0;
    int height = 0;
    bool wrap = false;
    int threads = 1;  // that walk over it at a time; no result depends on it

    static int modulo(int a, int n) {
        const int m = a % n;
        return m < 0 ? m + n : m;
    }
    // Index of the texel, or -1 outside of a map that does not tile.
    int index(int x, int y) const {
        if (x >= 0 && y >= 0 && x < width && y < height) return y * width + x;
        return wrap ? modulo(y, height) * width + modulo(x, width) : -1;
    }
    // Index of the nearest texel: border values continue outside of a map that does not tile.
    int nearest(int x, int y) const {
        if (x >= 0 && y >= 0 && x < width && y < height) return y * width + x;
        if (wrap) return modulo(y, height) * width + modulo(x, width);
        x = x < 0 ? 0 : x >= width ? width - 1 : x;
        y = y < 0 ? 0 : y >= height ? height - 1 : y;
        return y * width + x;
    }
    // Index of the texel that p lies in, or the nearest.
    int nearest(Vec2 p) const { return nearest(floor_of(p.x), floor_of(p.y)); }
    int size() const { return width * height; }
    Vec2 centre(int texel) const { return {texel % width + 0.5, texel / width + 0.5}; }
    // The shift by whole tiles that brings p nearest to `target`.
    Vec2 shift_to(Vec2 p, Vec2 target) const {
        if (!wrap) return {0.0, 0.0};
        return {width * std::round((target.x - p.x) / width), height * std::round((target.y - p.y) / height)};
    }
};

// Texels between neighbouring points of a chain beyond which there were others that were dropped.
inline constexpr double kBridge = 3.0;

// Bilinear value at a point of texel space (sample centres at half integers).
inline float sample(const Image& image, const Lattice& lattice, Vec2 p) {
    const double x = p.x - 0.5, y = p.y - 0.5;
    const int x0 = floor_of(x), y0 = floor_of(y);
    const float fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const float* t = image.texels.data();
    const bool inside = x0 >= 0 && y0 >= 0 && x0 + 1 < lattice.width && y0 + 1 < lattice.height;
    const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(y0) * lattice.width + x0;
    const float a = t[inside ? i : lattice.nearest(x0, y0)], b = t[inside ? i + 1 : lattice.nearest(x0 + 1, y0)];
    const float c = t[inside ? i + lattice.width : lattice.nearest(x0, y0 + 1)];
    const float d = t[inside ? i + lattice.width + 1 : lattice.nearest(x0 + 1, y0 + 1)];
    const float top = a + (b - a) * fx, bottom = c + (d - c) * fx;
    return top + (bottom - top) * fy;
}

// The upper one of two middle values; 0 of none.
inline double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

enum class ChainKind : std::uint8_t { groove, ridge, step };

// Dots, bolts, short slots: a short line whose ends carry its profile round them, as an arc or square (the hip).
enum class Spot : std::uint8_t { no, round, square };

// What the end of a chain is tied to; the fit pins such ends.
enum class EndTie : std::uint8_t { free, node, chain, border };

// A traced feature before fitting: ordered sub-texel points in unwrapped coordinates.
struct Chain {
    ChainKind kind = ChainKind::groove;
    std::vector<Vec2> points;
    bool closed = false;
    Spot spot = Spot::no;
    double half_width = 0.0;  // of a line, at half its height; of one that tapers or swells the median
    // Of every point, where the width clearly changes along the line; kept while the lines of a scale are looked for.
    std::vector<double> half_widths;
    double contrast = 0.0;    // height of the line or of the step
    EndTie start_tie = EndTie::free;
    EndTie end_tie = EndTie::free;
    std::uint32_t left_region = 0, right_region = 0;  // index into Regions::level; equal for lines
    Vec2 winding;                                     // p(end) - p(start) of a closed chain: a multiple of the tile

    double half_width_at(std::size_t point) const { return half_widths.empty() ? half_width : half_widths[point]; }
};

// The map's plateaus. Every texel is of a part; regions are made of parts, and grow by being joined.
struct Regions {
    // Summed height differences from a few texels before a border to a few behind it, and from farther away on both sides:
    // a large map may show its walls softer than a small one.
    struct Border {
        double near = 0.0, far = 0.0;
        int walls = 0;   // places where the map does not rise gently on and on
        int length = 0;

        // A level that soft ground passes: no wall lies there, and the map rises on and on.
        bool is_ramp() const { return 5 * walls < 3 * length; }
        void add(const Border& more, double sign) {
            near += sign * more.near, far += sign * more.far;
            walls += more.walls, length += more.length;
        }
        // The greater of both means, seen upwards from the lower region to the higher one.
        double jump(double gap) const { return std::max(gap < 0 ? -near : near, gap < 0 ? -far : far) / length; }
    };
    // Over the texels of a region.
    struct Sum {
        double value = 0.0, weight = 0.0;
        std::uint32_t area = 0;

        void add(const Sum& more) { value += more.value, weight += more.weight, area += more.area; }
    };

    std::shared_ptr<const std::vector<std::uint32_t>> part;  // per texel
    std::vector<std::uint32_t> region_of;                    // per part
    std::vector<double> level;                               // per region
    std::vector<std::uint32_t> area;                         // texels, per region
    std::vector<Sum> sum;                                    // per region
    std::map<std::pair<std::uint32_t, std::uint32_t>, Border> borders;  // from the lower number to the higher

    std::uint32_t at(std::size_t texel) const { return region_of[(*part)[texel]]; }
};

// Texels of a map that have other values, by rising index.
struct ChangedTexel {
    int texel = 0;
    float value = 0.0f;
};
using Changed = std::vector<ChangedTexel>;

// All that was found in a map.
struct Traced {
    Lattice lattice;
    double noise = 0.0;   // see Vectorized
    double damage = 0.0;  // the greater of noise and ringing
    double energy = 0.0;
    bool gentle = false;  // see VectorizeOptions
    std::vector<Chain> lines, steps;
    Changed changed;  // what the map without its lines has otherwise than the map
    Regions regions;
};

// Ramps and vignettes of the map, whose mean is 0: what is gentler than walls and wider than detail.
Image soft_ground(const Image& map, const Lattice& lattice, double noise);

// The map with a margin that mirrors it, and back.
Image mirror_margin(const Image& map, int margin);
Image crop_margin(const Image& map, int margin, const Lattice& lattice);

// Chains traced on a map with a margin, in coordinates of the map: what lies outside is cut off, and a chain that was cut
// runs straight on beyond the border, so that its end is not seen.
std::vector<Chain> clip_chains(const std::vector<Chain>& chains, int margin, const Lattice& lattice);

// Standard deviation of the map's grain, robust against edges.
double estimate_noise(const Image& map, const Lattice& lattice);

// The same of what lies near edges but not on them, where JPEG rings: levels that differ by no more are its work.
double estimate_ringing(const Image& map, const Lattice& lattice);

// Lines narrower than twice `radius` texels are looked for; below `widest`, only those on level ground far to both sides.
struct LineScale {
    double radius = 0.0;
    double widest = 0.0;
};

// What was added to texels of a map to take lines out of it, in order; a texel may come more than once.
struct Change {
    int texel = 0;
    float change = 0.0f;
};
using Erased = std::vector<Change>;

// How far each texel lies below (above) the ground beside it, where that is narrower than twice `radius`.
Image line_response(const Image& map, const Lattice& lattice, ChainKind kind, double radius, double noise);

// The same for the map with `erased` put back into it; the map is left as it was.
Image restored_response(Image& map, const Erased& erased, const Lattice& lattice, ChainKind kind, double radius, double noise);

// Sum of squared responses: how much of the map is grooves (or ridges) narrower than twice the radius.
double line_energy(const Image& response, double noise);

// Grooves or ridges of a scale: centre lines with junctions resolved into long chains. What the chains stand for is
// erased from the map, so that plateaus and lines of the other sign can be looked for in the rest. A chain that explains
// less than a little of `energy`, the map's whole sum of squares, is left out. `response`: line_response of the map;
// `erased`: the lines of this kind erased so far, which are put back where lines are measured, and those erased now.
std::vector<Chain> trace_lines(Image& map, Image response, Erased& erased, const Lattice& lattice, ChainKind kind,
                               const LineScale& scale, double noise, double energy);

// Grooves or ridges too short for a line and too small for a plateau, in what is left of the map without lines; taken
// out of it. Every spot explains more than a little of `energy`.
std::vector<Chain> trace_spots(Image& map, const Lattice& lattice, ChainKind kind, double radius, double noise,
                               double energy);

// Specks beside a line are what was left of it, at its corners and ends.
void drop_crumbs(std::vector<Chain>& spots, const std::vector<Chain>& lines, const Lattice& lattice);

// Joins and ties the ends of all lines of one kind by the response of the map that has them in it: the two below.
// `others`: the lines of the other kind, which may hide where a line goes on.
void tie_lines(std::vector<Chain>& chains, const std::vector<Chain>& others, const Image& response, const Lattice& lattice);

// Turning angle in radians from one direction to another.
inline double turn_between(Vec2 from, Vec2 to) { return std::atan2(cross(from, to), dot(from, to)); }

// How far to its sides a line takes texels.
inline double covered_reach(double half_width) { return 1.5 * half_width + 2.0; }

// Total least squares line through at least one point.
struct LineFit {
    Vec2 mean, direction;  // unit, of either sense
};
LineFit fit_line(const std::vector<Vec2>& points);

// Ends of two chains that continue each other, with the response (see trace_lines) shown or hidden in between, make one
// chain: a line that crosses another at a small angle comes in two pieces, and so does a ridge that a groove cuts.
void join_facing_ends(std::vector<Chain>& chains, const Image& response, const std::vector<std::uint8_t>& hidden,
                      const Lattice& lattice);

// Ends that stop just before, in, or just behind another chain are T ends on it, where the response (see trace_lines)
// shows no gap between the two.
void extend_to_lines(std::vector<Chain>& chains, const Image& response, const Lattice& lattice);

// 1 for texels of flat ground, where the values around differ by no more than the grain explains.
std::vector<std::uint8_t> find_flat(const Image& map, const Lattice& lattice, double noise);

// Plateaus of a map, which is `source` without its lines. Regions whose sum of squares against a neighbour is below
// `least_energy` join it; merge_regions does that with a greater one to regions that exist. measure_regions fills all but `part` for regions that are labelled 0 .. level.size().
struct MergeOptions {
    double noise = 0.0, least_energy = 0.0;
    bool shading = true;  // levels that soft ground passes stay borders
    bool gentle = false;  // see VectorizeOptions
};
Regions segment_regions(const Image& source, const Image& map, const Lattice& lattice, const MergeOptions& options,
                        const std::vector<std::uint8_t>& flat);
void measure_regions(const Image& map, const Lattice& lattice, const std::vector<std::uint8_t>& flat,
                     const std::vector<std::uint32_t>& label, Regions& regions);
void merge_regions(const MergeOptions& options, Regions& regions);

// Lines of the map that are plateaus after all, and short ones that it does not show, are put back into the map without
// lines; `flat` (see find_flat) is that of the new map, and what is level of the plateaus is marked in it. True when there are
// any: then the regions are others.
bool return_islands(const Image& source, Image& flattened, std::vector<Chain>& lines, const Lattice& lattice,
                    const Regions& regions, std::vector<std::uint8_t>& flat, double noise);

// The step contours between regions of the map, but for `changed`.
std::vector<Chain> trace_steps(const Image& map, const Changed& changed, const Lattice& lattice, const Regions& regions);

}  // namespace burin::vectorizing
