#include "cone_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../tests/judge/judge.hpp"

namespace burin::rivals {
namespace {

// Heights in metres with rows along the direction's longer axis, and the ratios found so far.
struct Field {
    int size = 0;
    bool repeat = true;
    double along = 0.0, across = 0.0;  // metres per texel, of columns and of rows
    double reach = 0.0;                // metres over the plane that the widest cone extends
    float outer = 0.0f;                // height around a map that ends
    std::vector<float> heights, ratios;

    float height_at(int row, int column) const {
        const int wrapped = row & (size - 1);
        return repeat || wrapped == row ? heights[std::size_t(wrapped) * std::size_t(size) + std::size_t(column)] : outer;
    }
};

Field field_of(const SurfaceMaps& maps, const MapLevel& level) {
    const std::size_t count = level.heights.size();
    const double range = maps.lowest - maps.highest, scale = range / 65535.0;
    Field field{level.size, maps.repeat, maps.metres.x / level.size, maps.metres.y / level.size, kWidestCone * range,
                float(maps.lowest - maps.outer), std::vector<float>(count), std::vector<float>(count, float(kWidestCone))};
    for (std::size_t i = 0; i < count; ++i) field.heights[i] = float(level.heights[i] * scale);
    return field;
}

void transpose(std::vector<float>& values, int size) {
    constexpr int kTile = 32;
    const std::size_t side = std::size_t(size);
    testing::in_parallel(std::size_t((size + kTile - 1) / kTile), [&](std::size_t block) {
        const std::size_t first = block * kTile, last = std::min(side, first + kTile);
        for (std::size_t x0 = 0; x0 < last; x0 += kTile)
            for (std::size_t y = first; y < last; ++y)
                for (std::size_t x = x0; x < std::min(y, x0 + kTile); ++x) std::swap(values[y * side + x], values[x * side + y]);
    });
}

void transpose(Field& field) {
    transpose(field.heights, field.size);
    transpose(field.ratios, field.size);
    std::swap(field.along, field.across);
}

struct Place {
    float x, height;
};

// Upper hull of the places where the surface falls away, seen from a point that moves towards them from the left.
class Hull {
  public:
    void add(Place p) {
        while (places_.size() > 1 && !turns_right(p, places_.back(), places_[places_.size() - 2])) places_.pop_back();
        places_.push_back(p);
    }
    // Least distance over height above p; slack is taken off the distances.
    float least_ratio(Place p, float slack) const {
        float least = 1e9f;
        for (std::size_t i = places_.size(); i-- > 0;) {
            const float rise = places_[i].height - p.height;
            if (rise <= 0.0f) continue;
            const float ratio = std::max(places_[i].x - p.x - slack, 0.25f * slack) / rise;
            if (ratio > least) break;
            least = ratio;
        }
        return least;
    }
    void clear() { places_.clear(); }

  private:
    static bool turns_right(Place a, Place b, Place c) { return (b.x - a.x) * (c.height - a.height) < (b.height - a.height) * (c.x - a.x); }
    std::vector<Place> places_;  // from right to left
};

// One line of texels, from column 0 of a row on: rows change by `lean` per column.
struct Line {
    int row;
    double lean;
    bool backwards;  // the ray runs from high columns to low ones
};

void narrow_line(Field& field, const Line& line, double steepest, Hull& hull) {
    const int n = field.size;
    const double step = std::hypot(field.along, line.lean * field.across);
    const float fall = float(step / steepest), slack = float(0.5 * std::hypot(field.along, field.across));
    const int ahead = field.repeat ? int(std::ceil(std::min(double(n), field.reach / step))) : 0;
    const std::int64_t lean = std::llround(line.lean * 0x1p32);
    const int mask = n - 1;  // n is a power of two
    hull.clear();
    float beyond = field.repeat ? 1e9f : field.outer;  // height of the place after the one at hand
    for (int k = n - 1 + ahead; k >= 0; --k) {
        const int column = (line.backwards ? n - 1 - k : k) & mask;
        const std::int64_t leaned = k * lean;
        const int row = line.row + int(leaned >> 32);
        // Between two rows, else a slope along its own contour would look like a saw.
        const float part = float(std::uint32_t(leaned)) * 0x1p-32f;
        const float low = field.height_at(row, column), high = field.height_at(row + 1, column);
        const Place place{float(k * step), low + (high - low) * part};
        const int nearest = row + (part >= 0.5f ? 1 : 0);
        if (k < n && (field.repeat || (nearest >= 0 && nearest < n))) {
            float& ratio = field.ratios[std::size_t(nearest & mask) * std::size_t(n) + std::size_t(column)];
            ratio = std::min(ratio, hull.least_ratio(place, slack));
        }
        if (place.height - beyond > fall) hull.add(place);
        beyond = place.height;
    }
}

void narrow_along(Field& field, double lean, double steepest) {
    const int n = field.size;
    // A map that ends has lines that come in over its lower or upper edge.
    const int margin = field.repeat ? 0 : n;
    for (const bool backwards : {false, true})
        testing::in_parallel(std::size_t(n + 2 * margin) / 64 + 1, [&](std::size_t block) {
            Hull hull;
            const int first = int(block) * 64 - margin;
            for (int row = first; row < std::min(first + 64, n + margin); ++row)
                narrow_line(field, {row, backwards ? -lean : lean, backwards}, steepest, hull);
        });
}

}  // namespace

std::vector<std::uint8_t> make_relaxed_cones(const SurfaceMaps& maps, const MapLevel& level, const ConeOptions& options) {
    Field field = field_of(maps, level);
    const int directions = options.directions / 4;
    for (int turn = 0; turn < 2; ++turn) {
        for (int i = 0; i < directions; ++i) {
            // Directions from -45 to 45 degrees; backwards they are the opposite ones.
            const double angle = (double(i) + 0.5) / directions * std::numbers::pi / 2.0 - std::numbers::pi / 4.0;
            narrow_along(field, std::tan(angle), options.steepest);
        }
        transpose(field);
    }
    std::vector<std::uint8_t> cones(field.ratios.size());
    for (std::size_t i = 0; i < cones.size(); ++i)
        cones[i] = std::uint8_t(std::floor(255.0 * std::sqrt(std::clamp(double(field.ratios[i]) / kWidestCone, 0.0, 1.0))));
    return cones;
}

}  // namespace burin::rivals
