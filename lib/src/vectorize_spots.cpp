// Spots: bolts, dots, short slots. What is left of the response after lines were taken out, in parts too small for a
// plateau, becomes a short line each, whose ends carry its profile round.
#include "vectorize_hat.hpp"
#include "vectorize_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <unordered_map>
#include <utility>

namespace burin::vectorizing {
namespace {

constexpr double kLeastShare = 0.8;    // of a part's squares, that its distance from the middle tells
constexpr double kLeastEnergy = 5e-5;   // of the map's, for one spot
constexpr std::uint32_t kMostFlat = 12;  // flat texels at its bottom: what has more is a plateau, unless it is round
constexpr double kMargin = 2.0;         // texels around a part that belong to its spot

struct Part {
    std::vector<Vec2> texels;  // centres, unwrapped
    std::vector<int> index;
    bool flat = false;         // at its bottom, more than kMostFlat texels of it
};

// The smallest box that holds the texels' centres.
Box bounds_of(const Part& part) {
    Box box{part.texels.front(), part.texels.front()};
    for (const Vec2 p : part.texels) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    }
    return box;
}

// The texels of the part that holds texel `first`, in unwrapped coordinates.
Part collect_part(int first, const std::vector<std::uint8_t>& mask, const Lattice& lattice, std::vector<std::uint8_t>& seen) {
    Part part;
    part.texels.push_back(lattice.centre(first));
    part.index.push_back(first);
    seen[first] = 1;
    for (std::size_t k = 0; k < part.texels.size(); ++k)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const Vec2 p = part.texels[k] + Vec2{double(dx), double(dy)};
                const int j = lattice.index(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)));
                if (j < 0 || !mask[j] || seen[j]) continue;
                seen[j] = 1;
                part.texels.push_back(p);
                part.index.push_back(j);
            }
    return part;
}

// The parts of a mask that have a spot's size, next to squares of 2 radius + 1 texels.
std::vector<Part> collect_parts(const std::vector<std::uint8_t>& mask, const std::vector<std::uint8_t>& flat,
                                const Lattice& lattice, std::uint32_t radius) {
    constexpr std::uint32_t kLeastTexels = 3;
    struct Count {
        std::uint32_t texels = 0, flat = 0;
        int first = -1;
    };
    const auto index_of = [&](int x, int y) { return y * lattice.width + x; };
    const Parts all = find_parts(lattice, true, [&](int x, int y) { return mask[index_of(x, y)]; });
    std::vector<Count> counts(all.count);
    for_each_run(all, [&](int y, const Run& run) {
        Count& count = counts[run.part];
        if (count.first < 0) count.first = index_of(run.begin, y);
        count.texels += static_cast<std::uint32_t>(run.end - run.begin);
        for (int x = run.begin; x < run.end; ++x) count.flat += flat[index_of(x, y)];
    });
    std::vector<Part> parts;
    std::vector<std::uint8_t> seen(mask.size(), 0);
    for (const Count& count : counts) {
        const bool is_flat = count.flat > kMostFlat;
        const std::uint32_t most_texels = (is_flat ? 10u : 4u) * radius * radius;
        if (count.texels < kLeastTexels || count.texels > most_texels) continue;
        parts.push_back(collect_part(count.first, mask, lattice, seen));
        parts.back().flat = is_flat;
    }
    return parts;
}

// The texels of a part, and those that touch it, each once.
std::vector<int> texels_around(const Part& part, const Lattice& lattice) {
    std::vector<int> texels;
    for (const int index : part.index)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const int texel = lattice.index(index % lattice.width + dx, index / lattice.width + dy);
                if (texel >= 0) texels.push_back(texel);
            }
    std::sort(texels.begin(), texels.end());
    texels.erase(std::unique(texels.begin(), texels.end()), texels.end());
    return texels;
}

// Whether the ground all round a part is at one height: slivers along a wall and the corners of a pit are no spots.
bool on_level_ground(const Part& part, const Image& map, const Lattice& lattice, double contrast) {
    constexpr int kNear = 1, kFar = 3;  // texels from the part
    constexpr double kMostUneven = 0.3;  // of the contrast
    const auto [low, high] = bounds_of(part);
    const int columns = static_cast<int>(high.x - low.x) + 1 + 2 * kFar, rows = static_cast<int>(high.y - low.y) + 1 + 2 * kFar;
    std::vector<std::uint8_t> distance(static_cast<std::size_t>(columns) * rows, kFar + 1);
    for (const Vec2 p : part.texels)
        for (int dy = -kFar; dy <= kFar; ++dy)
            for (int dx = -kFar; dx <= kFar; ++dx) {
                const int column = static_cast<int>(p.x - low.x) + kFar + dx, row = static_cast<int>(p.y - low.y) + kFar + dy;
                std::uint8_t& d = distance[static_cast<std::size_t>(row) * columns + column];
                d = std::min<std::uint8_t>(d, static_cast<std::uint8_t>(std::max(std::abs(dx), std::abs(dy))));
            }
    std::vector<float> around;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const std::uint8_t d = distance[static_cast<std::size_t>(row) * columns + column];
            const int texel = lattice.index(static_cast<int>(std::floor(low.x)) - kFar + column,
                                            static_cast<int>(std::floor(low.y)) - kFar + row);
            if (d > kNear && d <= kFar && texel >= 0) around.push_back(map.texels[texel]);
        }
    std::sort(around.begin(), around.end());
    if (around.size() < 8) return false;
    const std::size_t outliers = around.size() / 20;
    return around[around.size() - 1 - outliers] - around[outliers] < kMostUneven * contrast;
}

// A line with ends that carry a profile round, before it is known to fit.
struct Shape {
    Vec2 centre, along;  // along: of unit length
    double half_length = 0.0;
    Spot kind = Spot::round;

    // What the profile's offset is at p, without its sign.
    double offset(Vec2 p) const {
        const double x = std::max(0.0, std::fabs(dot(p - centre, along)) - half_length);
        const double y = std::fabs(cross(along, p - centre));
        return kind == Spot::round ? std::sqrt(x * x + y * y) : std::max(x, y);  // std::hypot costs as much as all else
    }
};

// Texels around a part with what the response shows there.
struct Field {
    std::vector<Vec2> places;
    std::vector<double> heights;
};

Field look_around(const Part& part, const Image& response, const Lattice& lattice) {
    const auto [low, high] = bounds_of(part);
    Field field;
    for (double y = low.y - kMargin; y <= high.y + kMargin; y += 1.0)
        for (double x = low.x - kMargin; x <= high.x + kMargin; x += 1.0) {
            const int texel = lattice.index(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
            if (texel < 0) continue;
            field.places.push_back({x, y});
            field.heights.push_back(response.texels[texel]);
        }
    return field;
}

// Squares that a section over the shape's offset leaves of the field: means of rings, and lines between them. From `most`
// on they are not all counted.
double left_by(const Shape& shape, const Field& field, double most) {
    constexpr double kRing = 0.5;  // texels
    struct Ring {
        double count = 0.0, offset = 0.0, height = 0.0;
    };
    std::vector<Ring> rings;
    std::vector<double> offsets(field.places.size());
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        offsets[i] = shape.offset(field.places[i]);
        const std::size_t k = static_cast<std::size_t>(offsets[i] / kRing);
        if (k >= rings.size()) rings.resize(k + 1);
        rings[k].count += 1.0, rings[k].offset += offsets[i], rings[k].height += field.heights[i];
    }
    for (Ring& ring : rings) ring.offset /= ring.count, ring.height /= ring.count;
    double left = 0.0;
    for (std::size_t i = 0; i < offsets.size() && left < most; ++i) {
        const std::size_t k = static_cast<std::size_t>(offsets[i] / kRing);
        const bool outwards = offsets[i] > rings[k].offset;
        const bool inside = outwards ? k + 1 < rings.size() && rings[k + 1].count > 0.0 : k > 0 && rings[k - 1].count > 0.0;
        const Ring& next = inside ? rings[outwards ? k + 1 : k - 1] : rings[k];
        const double share = inside ? (offsets[i] - rings[k].offset) / (next.offset - rings[k].offset) : 0.0;
        const double h = field.heights[i] - rings[k].height - share * (next.height - rings[k].height);
        left += h * h;
    }
    return left;
}

// Weighted middle and axes of the field.
Shape fit_axes(const Field& field, double& narrow) {
    Shape shape;
    double total = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < field.places.size(); ++i)
        total += field.heights[i], shape.centre = shape.centre + field.places[i] * field.heights[i];
    shape.centre = shape.centre * (1.0 / total);
    for (std::size_t i = 0; i < field.places.size(); ++i) {
        const Vec2 d = field.places[i] - shape.centre;
        const double w = field.heights[i] / total;
        xx += w * d.x * d.x, xy += w * d.x * d.y, yy += w * d.y * d.y;
    }
    const double middle = 0.5 * (xx + yy), half = std::hypot(0.5 * (xx - yy), xy);
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    shape.along = {std::cos(angle), std::sin(angle)};
    // Of a bar, the variance along it is its squared length over 12.
    narrow = std::sqrt(12.0 * std::max(1e-6, middle - half));
    shape.half_length = 0.5 * (std::sqrt(12.0 * (middle + half)) - narrow);
    return shape;
}

struct Fit {
    Shape shape;
    double left = 1e300;  // squares
};

// The shape of some kinds that leaves least, of those that the axes suggest.
Fit choose_shape(const Shape& found, const Field& field, std::initializer_list<Spot> kinds) {
    Fit best;
    for (const Spot kind : kinds)
        for (const Vec2 along : {found.along, Vec2{1.0, 0.0}, Vec2{0.0, 1.0}})
            for (const double length : {found.half_length, 0.0}) {
                const Shape shape{found.centre, along, length, kind};
                const double most = 0.97 * best.left, left = left_by(shape, field, most);
                if (left < most) best = {shape, left};
            }
    return best;
}

// Moves, turns and stretches the shape for as long as it then leaves less.
void settle(Fit& fit, const Field& field) {
    constexpr double kFirst = 0.4, kLast = 0.04;  // texels
    const auto moved = [](Shape s, int way, double by) {
        if (way < 2) s.centre = s.centre + (way == 0 ? s.along : normal_of(s.along)) * by;
        if (way == 2) s.half_length = std::max(0.0, s.half_length + by);
        if (way == 3) s.along = unit(s.along + normal_of(s.along) * (by / std::max(1.0, s.half_length)));
        return s;
    };
    for (double step = kFirst; step > kLast;) {
        const double before = fit.left;
        for (int way = 0; way < (fit.shape.half_length > 0.0 ? 4 : 2); ++way)
            for (const double by : {-step, step}) {
                const Shape other = moved(fit.shape, way, by);
                if (const double left = left_by(other, field, fit.left); left < fit.left) fit = {other, left};
            }
        if (fit.left == before) step *= 0.5;
    }
}

// Mean square of what is not level at the flat bottom of a shape: the grain, or what JPEG left there.
double ripple_of(const Shape& shape, const Field& field, double half_width) {
    constexpr double kWall = 2.0;  // texels
    double count = 0.0, sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < field.places.size(); ++i) {
        if (shape.offset(field.places[i]) > half_width - kWall) continue;
        const double h = field.heights[i];
        count += 1.0, sum += h, squares += h * h;
    }
    return count > 0.0 ? std::max(0.0, squares - sum * sum / count) / count : 0.0;
}

// What is flat at its bottom is a plateau, whose outline takes elements all round it, unless it is a disc or has two round
// ends beyond doubt: then a spot says all of it.
std::optional<Fit> fit_round(const Shape& found, const Field& field, double half_width, double highest) {
    // Squared texels that the outline may be off, its mean: at first, of a clean map, and more where it is not clean.
    constexpr double kMostAtFirst = 0.5, kMost = 0.006, kMostMore = 0.02;
    const double rim = 6.28318530717959 * half_width + 4.0 * found.half_length, rim_squares = highest * highest * rim;
    Fit fit = choose_shape(found, field, {Spot::round});
    if (fit.left > kMostAtFirst * rim_squares) return std::nullopt;
    settle(fit, field);
    const double ripples = ripple_of(fit.shape, field, half_width) * static_cast<double>(field.places.size());
    const double most = kMost * rim_squares + std::min(4.0 * ripples, kMostMore * rim_squares);
    return fit.left < most ? std::optional(fit) : std::nullopt;
}

std::optional<Fit> fit_any(const Shape& found, const Field& field, double energy) {
    const Fit fit = choose_shape(found, field, {Spot::round, Spot::square});
    return fit.left < (1.0 - kLeastShare) * energy ? std::optional(fit) : std::nullopt;
}

std::optional<Chain> make_spot(const Part& part, const Image& response, const Lattice& lattice, ChainKind kind,
                               double most_side, double least_energy) {
    const Field field = look_around(part, response, lattice);
    double energy = 0.0, highest = 0.0;
    for (const double h : field.heights) energy += h * h, highest = std::max(highest, h);
    if (energy < least_energy) return std::nullopt;
    double narrow = 0.0;
    const Shape found = fit_axes(field, narrow);
    if (narrow > most_side || found.half_length > 1.5 * most_side) return std::nullopt;
    const std::optional<Fit> fit = part.flat ? fit_round(found, field, 0.5 * narrow, highest) : fit_any(found, field, energy);
    if (!fit) return std::nullopt;
    Chain chain;
    chain.kind = kind;
    chain.spot = fit->shape.kind;
    chain.half_width = 0.5 * narrow;
    chain.contrast = highest;
    const Vec2 reach = fit->shape.along * std::max(fit->shape.half_length, 0.05);
    chain.points = {fit->shape.centre - reach, fit->shape.centre + reach};
    return chain;
}

}  // namespace

std::vector<Chain> trace_spots(Image& map, const Lattice& lattice, ChainKind kind, double radius, double noise,
                               double energy) {
    const int r = square_radius(radius);
    const double least = least_response(noise);
    const Image response = hat_response(map, lattice, kind, r, least);
    const std::vector<std::uint8_t> mask = strong_mask(response, lattice, std::max(4, r / 3), least);
    const float sign = kind == ChainKind::groove ? 1.0f : -1.0f;
    std::vector<Chain> spots;
    for (const Part& part : collect_parts(mask, find_flat(map, lattice, noise), lattice, static_cast<std::uint32_t>(r))) {
        std::optional<Chain> spot = make_spot(part, response, lattice, kind, 1.6 * r, kLeastEnergy * energy);
        if (!spot || !on_level_ground(part, map, lattice, spot->contrast)) continue;
        for (const int texel : texels_around(part, lattice)) map.texels[texel] += sign * response.texels[texel];
        spots.push_back(std::move(*spot));
    }
    return spots;
}

void drop_crumbs(std::vector<Chain>& spots, const std::vector<Chain>& lines, const Lattice& lattice) {
    constexpr double kCrumb = 1.2, kBeside = 2.5;  // half width; beyond a line's wall, texels
    const auto is_crumb = [](const Chain& spot) { return spot.half_width < kCrumb; };
    if (std::none_of(spots.begin(), spots.end(), is_crumb)) return;
    std::unordered_multimap<int, std::pair<Vec2, double>> near;  // by texel: points of lines, and how far they reach
    double furthest = 0.0;
    for (const Chain& line : lines) {
        const double reach = line.half_width + kBeside;
        furthest = std::max(furthest, reach);
        for (std::size_t i = 1; i < line.points.size(); ++i) {
            const Vec2 a = line.points[i - 1], b = line.points[i];
            const int pieces = std::max(1, static_cast<int>(std::lround(length(b - a))));
            for (int piece = 0; piece < pieces; ++piece) {
                const Vec2 p = lerp(a, b, (piece + 0.5) / pieces);
                near.emplace(lattice.nearest(p), std::pair{p, reach});
            }
        }
    }
    std::erase_if(spots, [&](const Chain& spot) {
        const Vec2 middle = lerp(spot.points.front(), spot.points.back(), 0.5);
        const int reach = is_crumb(spot) ? static_cast<int>(std::ceil(furthest)) : -1;
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) {
                const auto [first, last] = near.equal_range(lattice.nearest(middle + Vec2{double(dx), double(dy)}));
                for (auto at = first; at != last; ++at) {
                    const Vec2 p = at->second.first + lattice.shift_to(at->second.first, middle);
                    if (length(p - middle) < at->second.second) return true;
                }
            }
        return false;
    });
}

}  // namespace burin::vectorizing
