// Lines that are plateaus after all. A letter of even strokes can be drawn as lines, too; but where the map has plateaus of
// the same levels, most letters of a word are areas, and those that happen to be even would be lines: all become areas. The
// same goes for the narrow land between two pits, which belongs to the plateau that it leads to.
#include "vectorize_candidates.hpp"
#include "vectorize_internal.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace burin::vectorizing {
namespace {

constexpr double kLeastHalfWidth = 1.0;    // of lines, texels
constexpr double kLeastWidth = 2.8;        // of islands, in the mean: narrower ones have no level floor
constexpr double kSameLevel = 0.1;         // of the contrast
constexpr double kMostIslandArea = 100.0;  // in squared half-widths: that of 25 widths of line
constexpr double kLongestBridge = 16.0;    // in half-widths
constexpr double kEnoughSteps = 0.5;       // borders of plateaus of the same levels, of the rims of the lines
constexpr std::int32_t kNoShape = -1;

// Lines that hang together, and the texels that are nearer to their floor than to the ground beside them.
struct Shape {
    double floor = 0.0, ground = 0.0;
    double rim = 0.0;  // both sides of the lines
    std::vector<std::size_t> lines;
    std::vector<int> texels;
    bool is_bridge = false;  // leads to a plateau of the same level
    double contrast() const { return std::fabs(floor - ground); }
    bool is_level_with(double a, double b) const {
        const double most = kSameLevel * contrast();
        return std::fabs(std::min(a, b) - std::min(floor, ground)) < most && std::fabs(std::max(a, b) - std::max(floor, ground)) < most;
    }
};

// The value at a share of the chain's points, by size.
double value_along(const Chain& chain, const Image& map, const Lattice& lattice, double share) {
    std::vector<double> values;
    for (const Vec2 p : chain.points) values.push_back(sample(map, lattice, p));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// What blur has not filled of a narrow line.
double floor_of(const Chain& line, const Image& map, const Lattice& lattice) {
    return value_along(line, map, lattice, line.kind == ChainKind::groove ? 0.2 : 0.8);
}

class ShapeFinder {
  public:
    ShapeFinder(const Image& source, const Image& flattened, const Lattice& lattice, const Regions& regions)
        : source_(source), flattened_(flattened), lattice_(lattice), regions_(regions),
          shape_at_(static_cast<std::size_t>(lattice.size()), kNoShape) {}

    void add(const Chain& line, std::size_t index) {
        const double extent = chain_length(line);
        if (const std::int32_t known = shape_of(line); known != kNoShape) {
            shapes_[known].lines.push_back(index);
            shapes_[known].rim += 2.0 * extent;
            return;
        }
        Shape shape{floor_of(line, source_, lattice_), value_along(line, flattened_, lattice_, 0.5), 2.0 * extent, {index}, {}};
        const bool is_island = flood(line, shape, static_cast<std::size_t>(kMostIslandArea * line.half_width * line.half_width));
        if (!is_island) {
            for (const int texel : shape.texels) shape_at_[texel] = kNoShape;
            shape.texels.clear();
            if (!shape.is_bridge || extent > kLongestBridge * line.half_width) return;
        }
        shape.is_bridge = !is_island;  // an island may touch a plateau of its level, too
        shapes_.push_back(std::move(shape));
    }

    // The shape that most points of a line lie in, or most of what a spot took out of the map: the middle of a spot that
    // was seen in a corner of a shape may lie beside it.
    std::int32_t shape_of(const Chain& line) const {
        std::map<std::int32_t, double> weight;
        const auto add_changes = [&](int texel, Vec2) {
            weight[shape_at_[texel]] += std::fabs(source_.texels[texel] - flattened_.texels[texel]);
        };
        for (const Vec2 p : line.points) {
            if (line.spot == Spot::no)
                weight[shape_at_[lattice_.nearest(p)]] += 1.0;
            else
                for_each_texel_near(p, lattice_, static_cast<int>(std::ceil(line.half_width)), add_changes);
        }
        double sum = 0.0;
        for (const auto& [shape, w] : weight) sum += w;
        for (const auto& [shape, w] : weight)
            if (2.0 * w > sum) return shape;
        return kNoShape;
    }
    const std::vector<Shape>& shapes() const { return shapes_; }

  private:
    // False when there are more texels than `most`.
    bool flood(const Chain& line, Shape& shape, std::size_t most) {
        const auto take = [&](int texel) {
            const double v = source_.texels[texel];
            if (shape_at_[texel] != kNoShape || std::fabs(v - shape.floor) > std::fabs(v - shape.ground)) return;
            shape_at_[texel] = static_cast<std::int32_t>(shapes_.size());
            shape.texels.push_back(texel);
            const double level = regions_.level[regions_.at(texel)];
            shape.is_bridge |= std::fabs(level - shape.floor) < kSameLevel * shape.contrast();
        };
        for (const Vec2 p : line.points) take(lattice_.nearest(p));
        for (std::size_t k = 0; k < shape.texels.size(); ++k) {
            if (shape.texels.size() > most) return false;
            const int x = shape.texels[k] % lattice_.width, y = shape.texels[k] / lattice_.width;
            for (const int j : {lattice_.index(x + 1, y), lattice_.index(x - 1, y), lattice_.index(x, y + 1), lattice_.index(x, y - 1)})
                if (j >= 0) take(j);
        }
        return true;
    }

    const Image& source_;
    const Image& flattened_;
    const Lattice& lattice_;
    const Regions& regions_;
    std::vector<std::int32_t> shape_at_;  // per texel
    std::vector<Shape> shapes_;
};

// Of the box along a direction that the shape fits in.
double box_area(const Shape& shape, Vec2 along, Vec2 origin, const Lattice& lattice) {
    constexpr double kTexel = 0.8;  // what a texel is wider than its centre: from all sides a little less than one
    Box box;
    for (const int texel : shape.texels) {
        const Vec2 centre = lattice.centre(texel);
        const Vec2 d = centre + lattice.shift_to(centre, origin) - origin, p{dot(d, along), cross(along, d)};
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    }
    return (box.high.x - box.low.x + kTexel) * (box.high.y - box.low.y + kTexel);
}

// A slot is one line, whatever is around it; and so is what is narrow.
bool is_line(const Shape& shape, const std::vector<Chain>& lines, const Lattice& lattice) {
    constexpr double kFilled = 0.7;  // a triangle fills half of its box
    const Chain& line = lines[shape.lines.front()];
    if (static_cast<double>(shape.texels.size()) < kLeastWidth * (0.5 * shape.rim + line.half_width)) return true;
    if (shape.lines.size() > 1 || line.closed) return false;
    const Vec2 chord = line.points.back() - line.points.front();
    if (length(chord) <= 0.95 * chain_length(line)) return false;
    return static_cast<double>(shape.texels.size()) > kFilled * box_area(shape, unit(chord), line.points.front(), lattice);
}

// Whether each shape is a plateau.
std::vector<std::uint8_t> find_plateaus(const std::vector<Shape>& shapes, const std::vector<Chain>& lines, const Lattice& lattice,
                                        const Regions& regions) {
    std::vector<std::uint8_t> candidate, plateau;
    for (const Shape& shape : shapes) candidate.push_back(shape.is_bridge || !is_line(shape, lines, lattice));
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        double steps = 0.0, rims = 0.0;
        for (const auto& [pair, border] : regions.borders)
            if (shapes[s].is_level_with(regions.level[pair.first], regions.level[pair.second])) steps += border.length;
        for (std::size_t k = 0; k < shapes.size(); ++k)
            if (candidate[k] && shapes[s].is_level_with(shapes[k].floor, shapes[k].ground)) rims += shapes[k].rim;
        plateau.push_back(candidate[s] && steps > kEnoughSteps * rims);
    }
    return plateau;
}

// Marks the texels that a line may have taken out of the map.
void mark_taken(const Chain& line, const Lattice& lattice, std::vector<std::uint8_t>& taken) {
    const int reach = static_cast<int>(std::ceil(covered_reach(line.half_width))) + 1;
    for_each_place(line, [&](Vec2 p, Vec2, double) {
        for_each_texel_near(p, lattice, reach, [&](int texel, Vec2) { taken[texel] = 1; });
    });
}

// The level texels of a shape are flat, however narrow it is, and so are those of its ground, however narrow a hole.
void mark_flat(const Shape& shape, const Image& source, const Lattice& lattice, std::vector<std::uint8_t>& flat) {
    const int reach = 1 + static_cast<int>(std::ceil(std::sqrt(static_cast<double>(shape.texels.size())) / 4.0));
    for (const int texel : shape.texels) {
        const Vec2 centre = lattice.centre(texel);
        for_each_texel_near(centre, lattice, reach, [&](int i, Vec2) {
            const double off = std::min(std::fabs(source.texels[i] - shape.floor), std::fabs(source.texels[i] - shape.ground));
            if (off < kSameLevel * shape.contrast()) flat[i] = 1;
        });
    }
}

// How far a line lies below (above) the lower (higher) one of its sides, in the mean of its points.
double stands_out(const Chain& line, const Image& map, const Lattice& lattice) {
    const double sign = line.kind == ChainKind::groove ? 1.0 : -1.0, reach = line.half_width + 1.5;
    double sum = 0.0;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
        const Vec2 a = line.points[i > 0 ? i - 1 : 0], b = line.points[std::min(i + 1, line.points.size() - 1)];
        const Vec2 p = line.points[i], n = a == b ? Vec2{1.0, 0.0} : normal_of(unit(b - a));
        const auto height = [&](Vec2 q) { return sign * sample(map, lattice, q); };
        sum += std::min(height(p + n * reach), height(p - n * reach)) - height(p);
    }
    return sum / static_cast<double>(line.points.size());
}

// A short line that the map does not show: what was left on the wall of an area of which a part was taken for a line.
bool is_on_wall(const Chain& line, const Image& source, const Lattice& lattice) {
    constexpr double kStandsOut = 0.3;  // of its contrast
    return line.spot == Spot::no && chain_length(line) < 6.0 * line.half_width + 8.0 &&
           stands_out(line, source, lattice) < kStandsOut * line.contrast;
}

// What is left of a plateau that was taken out of the map as lines may look like a line on ground that is at no level of it.
bool is_remnant(const Chain& line, const Image& flattened, const Lattice& lattice, const std::vector<std::uint8_t>& free,
                const std::vector<Shape>& plateaus) {
    const auto freed = std::count_if(line.points.begin(), line.points.end(), [&](Vec2 p) { return free[lattice.nearest(p)] != 0; });
    if (2 * freed < static_cast<std::ptrdiff_t>(line.points.size())) return false;
    const double ground = value_along(line, flattened, lattice, 0.5);
    return std::any_of(plateaus.begin(), plateaus.end(), [&](const Shape& shape) {
        const double margin = kSameLevel * shape.contrast();
        return ground > std::min(shape.floor, shape.ground) + margin && ground < std::max(shape.floor, shape.ground) - margin;
    });
}

// The lines of the plateaus, and what lies in these.
std::vector<std::uint8_t> find_returned(const ShapeFinder& finder, const std::vector<std::uint8_t>& plateau,
                                        const std::vector<Chain>& lines) {
    std::vector<std::uint8_t> returned(lines.size(), 0);
    for (std::size_t s = 0; s < plateau.size(); ++s)
        for (const std::size_t line : finder.shapes()[s].lines) returned[line] |= plateau[s];
    for (std::size_t c = 0; c < lines.size(); ++c) {
        const std::int32_t shape = finder.shape_of(lines[c]);
        returned[c] |= shape != kNoShape && plateau[static_cast<std::size_t>(shape)];
    }
    return returned;
}

}  // namespace

bool return_islands(const Image& source, Image& flattened, std::vector<Chain>& lines, const Lattice& lattice,
                    const Regions& regions, std::vector<std::uint8_t>& flat, double noise) {
    if (lines.empty()) return false;
    ShapeFinder finder(source, flattened, lattice, regions);
    for (std::size_t c = 0; c < lines.size(); ++c)
        if (lines[c].spot == Spot::no && lines[c].half_width >= kLeastHalfWidth) finder.add(lines[c], c);
    const std::vector<std::uint8_t> plateau = find_plateaus(finder.shapes(), lines, lattice, regions);
    std::vector<Shape> plateaus;
    for (std::size_t s = 0; s < plateau.size(); ++s)
        if (plateau[s]) plateaus.push_back(finder.shapes()[s]);
    std::vector<std::uint8_t> returned = find_returned(finder, plateau, lines);
    for (std::size_t c = 0; c < lines.size(); ++c) returned[c] |= is_on_wall(lines[c], source, lattice);
    if (std::find(returned.begin(), returned.end(), 1) == returned.end()) return false;
    std::vector<std::uint8_t> free(flat.size(), 0), taken(flat.size(), 0);
    for (std::size_t c = 0; c < lines.size(); ++c)
        if (returned[c]) mark_taken(lines[c], lattice, free);
    for (std::size_t c = 0; c < lines.size(); ++c) {
        if (returned[c]) continue;
        returned[c] = is_remnant(lines[c], flattened, lattice, free, plateaus);
        mark_taken(lines[c], lattice, returned[c] ? free : taken);
    }
    for (const Shape& shape : plateaus)
        for (const int texel : shape.texels) taken[texel] = 0;
    for (std::size_t i = 0; i < free.size(); ++i)
        if (free[i] && !taken[i]) flattened.texels[i] = source.texels[i];
    flat = find_flat(flattened, lattice, noise);
    for (const Shape& shape : plateaus) mark_flat(shape, source, lattice, flat);
    std::size_t c = 0;
    std::erase_if(lines, [&](const Chain&) { return returned[c++] != 0; });
    return true;
}

}  // namespace burin::vectorizing
