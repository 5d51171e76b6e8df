#include <burin/grid.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "grid_internal.hpp"
#include "layout.h"
#include "resolve_curve.hpp"

namespace burin {
namespace {

using namespace gridding;

// Texels of a wide pattern's list.
std::size_t list_texels(std::size_t references) { return (references + BURIN_WIDE_REFS_PER_TEXEL - 1) / BURIN_WIDE_REFS_PER_TEXEL; }

// Bytes of a cell and its list.
std::size_t packed_bytes(std::size_t references, bool wide) { return 8 + (wide ? 16 * list_texels(references) : 2 * references); }

// Lengths and widths of a pattern, from which list lengths at any cell size can be foretold.
struct Feature {
    double length, width;
};

std::vector<Feature> features_of(const ResolvedPattern& pattern) {
    std::vector<Feature> features;
    for (const ResolvedElement& e : pattern.elements) {
        const auto& points = pattern.profiles[pattern.styles[e.style].profile].points;
        double low = 0.0, high = 0.0;
        for (const ProfilePoint& p : points) low = std::min(low, p.b), high = std::max(high, p.b);
        features.push_back(
            {curve::arc_length(e.element), (high - low) * 0.5 * (e.element.width0 + e.element.width1)});
    }
    return features;
}

// Whether references will take 32 bits: pack counts the same, but for elements that it leaves out as too short.
bool is_wide(const ResolvedPattern& pattern) {
    const auto scaled = [](double scale) { return std::abs(scale - 1.0) * BURIN_SCALE_STEPS >= 0.5; };
    std::size_t texels = 0;
    for (const ResolvedElement& e : pattern.elements) {
        const Element& c = e.element;
        const bool has_texel_b =
            c.kind == ElementKind::quadratic || scaled(c.width0) || scaled(c.width1) || scaled(c.height0) || scaled(c.height1);
        texels += 1u + (has_texel_b ? 1u : 0u) + (e.function != kNoFunction ? 1u : 0u);
    }
    return texels > BURIN_MAX_NARROW_ELEMENT_TEXELS;
}

// Where sizes of cells are looked for from: about the mean width; where features are much narrower than the plane between them, as
// upright walls are, a small share of that.
double least_scale(const std::vector<Feature>& features, Vec2 size) {
    double area = 0.0, length = 0.0;
    for (const Feature& f : features) area += f.length * f.width, length += f.length;
    if (!(length > 0.0)) return 0.0;
    constexpr double kShare = 1.0 / 32.0;
    return std::max(area / length, kShare * size.x * size.y / length);
}

// What a size costs: work of a pixel, in elements of a list looked at, bytes of the cells and of all, and texels of lists.
struct Cost {
    double work = 0.0, cell_bytes = 0.0, bytes = 0.0, list_texels = 0.0;
    // A power of the bytes, so that a pattern with more of the same gets the same cells: half the bytes are worth an eighth more
    // work. Below 12 KiB bytes hardly count.
    double total() const { return work * std::pow(bytes + 12288.0, 0.2); }
};

// Elements that a square of side c at a random place meets: a strip of length l and width w meets
// (l w + (l + w) c 4 / pi + c^2) / c^2 squares of a lattice.
double elements_in(const ResolvedPattern& pattern, const std::vector<Feature>& features, double side) {
    double met = 0.0;
    for (const Feature& f : features) met += f.length * f.width + (f.length + f.width) * side * 4.0 / std::numbers::pi + side * side;
    return met / (pattern.size.x * pattern.size.y);
}

// Metres over the plane per metre of fall, along each axis, of a ray between 30 and 60 degrees off the normal.
constexpr double kUsualSlope = 0.7;
// Work, in elements looked at: of a cell, of an element beside which areas are looked for, and what no size of cells changes: what
// lies under the ray is followed, and what shows in the pixel is drawn.
constexpr double kCellWork = 1.7, kAreaWork = 3.0, kFixedWork = 40.0;

// Bytes of a list, by the mean number of its references. References of 32 bits fill whole texels, which adds six bytes on
// average where there are any.
double list_bytes(double listed, bool wide) {
    return wide ? 4.0 * listed + 6.0 * (1.0 - std::exp(-listed)) : 2.0 * listed;
}

// A ray sinks through what lies above the ground, by and large `base_offset`, and looks at every element of a cell's list; a
// pixel that is drawn as areas looks at the lists of all cells over which its rays fall through the relief, and once at each
// element of theirs.
Cost foretell(const ResolvedPattern& pattern, const std::vector<Feature>& features, double cell,
              double margin, bool wide) {
    const double listed = elements_in(pattern, features, cell * (1.0 + 2.0 * margin));
    const double way = kUsualSlope * pattern.depth;
    const double passed = 1.0 + 2.0 * kUsualSlope * pattern.base_offset / cell, spanned = (1.0 + way / cell) * (1.0 + way / cell);
    const double met = elements_in(pattern, features, cell + way);
    const double cells = pattern.size.x * pattern.size.y / (cell * cell), cell_bytes = cells * (8.0 + list_bytes(listed, wide));
    // An element takes two to three texels.
    const double element_bytes = 40.0 * static_cast<double>(features.size());
    return {kFixedWork + (passed + spanned) * (kCellWork + listed) + kAreaWork * met, cell_bytes, cell_bytes + element_bytes,
            cells * list_bytes(listed, wide) / 16.0};
}

struct Limits {
    int low_cols = 1, low_rows = 1;  // fewest cells for which the copy of an element is never in doubt
};

std::string count_text(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", v);
    return text;
}

Status check_options(const GridOptions& options) {
    if (!(options.cell_size >= 0.0) || !std::isfinite(options.cell_size))
        return Error{ErrorCode::invalid_argument,
                     "cell_size is " + count_text(options.cell_size) + "; it must be 0 or more"};
    if (!(options.margin >= 0.0 && options.margin <= 1.0))
        return Error{ErrorCode::invalid_argument,
                     "margin is " + count_text(options.margin) + "; allowed is [0, 1]"};
    if (options.threads < 0) return Error{ErrorCode::invalid_argument, "threads is negative"};
    return Done{};
}

// A copy that acts at distance x of its midpoint is the nearest one for a cell when x + (0.5 + margin) cells
// < 0.5 size.
Result<Limits> find_limits(const ResolvedPattern& pattern, const Chain& chain, double margin) {
    if (pattern.wrap != Wrap::repeat || pattern.elements.empty()) return Limits{};
    const Vec2 extent = farthest_extent(pattern, chain);
    const double free_x = 0.499 - extent.x / pattern.size.x, free_y = 0.499 - extent.y / pattern.size.y;
    const double most = static_cast<double>(BURIN_MAX_TEXTURE_SIDE);
    if (free_x * most < 0.5 + margin || free_y * most < 0.5 + margin)
        return Error{ErrorCode::limit_exceeded,
                     "an element acts " + count_text(std::max(extent.x, extent.y)) +
                         " m from its middle, around half of the repeating tile; shorten it"};
    return Limits{static_cast<int>(std::ceil((0.5 + margin) / free_x)),
                  static_cast<int>(std::ceil((0.5 + margin) / free_y))};
}

Frame frame_of(const ResolvedPattern& pattern, const Limits& limits, double cell, double margin) {
    const auto cells = [&](double size, int low) {
        return std::clamp(static_cast<int>(std::ceil(size / cell - 1e-9)), low, BURIN_MAX_TEXTURE_SIDE);
    };
    const int cols = cells(pattern.size.x, limits.low_cols), rows = cells(pattern.size.y, limits.low_rows);
    return {pattern, cols, rows, margin, {pattern.size.x / cols, pattern.size.y / rows}};
}

double cheapest_size(const ResolvedPattern& pattern, const GridOptions& options, bool wide) {
    const std::vector<Feature> features = features_of(pattern);
    const double largest = std::max(pattern.size.x, pattern.size.y);
    const double width = least_scale(features, pattern.size);
    if (features.empty() || width <= 0.0) return largest;
    const double smallest = largest / BURIN_MAX_TEXTURE_SIDE;
    double best = 0.0, best_cost = 1e300, fallback = largest;
    for (int i = 0; i <= 48; ++i) {
        const double cell = std::clamp(width * std::pow(2.0, 0.125 * i - 0.5), smallest, largest);
        const Cost cost = foretell(pattern, features, cell, options.margin, wide);
        fallback = cell;
        if (options.max_bytes > 0 && cost.cell_bytes > static_cast<double>(options.max_bytes)) continue;
        if (wide && cost.list_texels > BURIN_MAX_LIST_TEXELS) continue;
        if (cost.total() < best_cost) best_cost = cost.total(), best = cell;
    }
    return best > 0.0 ? best : fallback;
}

struct Fullest {
    std::uint32_t cell = 0, count = 0;
};

std::vector<std::uint32_t> count_hits(const std::vector<std::vector<Hit>>& hits, std::size_t cells) {
    std::vector<std::uint32_t> counts(cells, 0);
    for (const auto& list : hits)
        for (const Hit& hit : list) ++counts[hit.cell];
    return counts;
}

Fullest fullest_cell(const std::vector<std::uint32_t>& counts) {
    Fullest fullest;
    for (std::uint32_t k = 0; k < counts.size(); ++k)
        if (counts[k] > fullest.count) fullest = {k, counts[k]};
    return fullest;
}

// Texels that the different lists of a wide pattern fill. Lists count as one where sums over well mixed numbers of their
// elements are equal.
std::size_t count_list_texels(const std::vector<std::vector<Hit>>& hits, const std::vector<std::uint32_t>& counts) {
    std::vector<std::pair<std::uint64_t, std::size_t>> lists(counts.size());  // sum and texels
    for (std::size_t k = 0; k < counts.size(); ++k) lists[k].second = list_texels(counts[k]);
    for (std::size_t e = 0; e < hits.size(); ++e) {
        std::uint64_t mixed = (e + 1) * 0x9e3779b97f4a7c15u;
        mixed = (mixed ^ mixed >> 31) * 0xbf58476d1ce4e5b9u;
        for (const Hit& hit : hits[e]) lists[hit.cell].first += mixed ^ mixed >> 29;
    }
    std::sort(lists.begin(), lists.end());
    lists.erase(std::unique(lists.begin(), lists.end()), lists.end());
    return std::accumulate(lists.begin(), lists.end(), std::size_t{0}, [](std::size_t sum, const auto& list) { return sum + list.second; });
}

// The lists at one cell size, and what they come to.
struct Trial {
    Frame frame;
    std::vector<std::vector<Hit>> hits;
    Fullest fullest;
    std::size_t bytes = 0;        // as grid_bytes
    std::size_t list_texels = 0;  // of a wide pattern
    bool fits() const { return fullest.count <= BURIN_MAX_REFS_PER_CELL; }
    // How many times what is allowed it takes.
    double excess(std::size_t most_bytes) const {
        const double much = most_bytes > 0 ? static_cast<double>(bytes) / static_cast<double>(most_bytes) : 0.0;
        return std::max(much, static_cast<double>(list_texels) / BURIN_MAX_LIST_TEXELS);
    }
};

Trial try_frame(const Frame& frame, const Chain& chain, int threads, bool wide) {
    Trial trial{frame, find_hits(frame, chain, threads), {}, 0, 0};
    const std::vector<std::uint32_t> counts =
        count_hits(trial.hits, static_cast<std::size_t>(frame.cols) * static_cast<std::size_t>(frame.rows));
    trial.fullest = fullest_cell(counts);
    for (const std::uint32_t count : counts) trial.bytes += packed_bytes(count, wide);
    if (wide) trial.list_texels = count_list_texels(trial.hits, counts);
    return trial;
}

// A cell size that was asked for, but would take more cells than there may be.
Status check_fineness(Vec2 size, double cell) {
    const double least = std::max(size.x, size.y) / BURIN_MAX_TEXTURE_SIDE;
    if (cell == 0.0 || cell >= least) return Done{};
    const auto cells = [&](double side) { return count_text(std::ceil(side / cell)); };
    const std::string limit = std::to_string(BURIN_MAX_TEXTURE_SIDE);
    return Error{ErrorCode::invalid_argument, "cell_size is " + count_text(cell) + " m, which takes " + cells(size.x) + " x " +
                                                  cells(size.y) + " cells, limit " + limit + " x " + limit + "; " +
                                                  count_text(1.00001 * least) + " m would work"};
}

Error too_full(const Frame& frame, const Fullest& fullest, double fitting) {
    const int cols = frame.cols;
    std::string message = "cell (" + std::to_string(static_cast<int>(fullest.cell) % cols) + "," +
                          std::to_string(static_cast<int>(fullest.cell) / cols) + ") lists " +
                          std::to_string(fullest.count) + " elements, limit " +
                          std::to_string(BURIN_MAX_REFS_PER_CELL) + "; ";
    message += fitting > 0.0 ? "cell_size " + count_text(fitting) + " would fit"
                             : "no cell size fits, too many elements act at one place";
    return {ErrorCode::limit_exceeded, message};
}

// Larger cells until cells and lists keep to the budget, or no larger cell's list fits. The bytes foretold
// may be too few: they take all places alike.
void keep_to_budget(std::optional<Trial>& trial, double cell, std::size_t budget,
                    const std::function<Trial(double)>& try_size) {
    const Vec2 size = trial->frame.pattern.size;
    const double largest = std::max(size.x, size.y);
    constexpr double kLeastStep = 1.05;
    double most = 2.0;  // less after a step that was too long
    while (trial->excess(budget) > 1.0 && cell < largest && most >= kLeastStep) {
        // Bytes fall with the square of the cell's side at most.
        const double step = std::clamp(std::sqrt(trial->excess(budget)), kLeastStep, most);
        Trial larger = try_size(cell * step);
        if (!larger.fits()) {
            most = std::sqrt(step);
            continue;
        }
        cell *= step;
        if (larger.excess(budget) < trial->excess(budget)) trial.emplace(std::move(larger));
    }
}

}  // namespace

std::size_t grid_bytes(const CellGrid& grid, bool wide) {
    std::size_t bytes = 0;
    for (std::size_t k = 0; k < grid.level.size(); ++k) bytes += packed_bytes(grid.first_ref[k + 1] - grid.first_ref[k], wide);
    return bytes;
}

Result<CellGrid> build_grid(const ResolvedPattern& pattern, const GridOptions& options) {
    if (const Status status = check_options(options); !status.ok()) return status.error();
    if (const Status status = check_fineness(pattern.size, options.cell_size); !status.ok()) return status.error();
    const Chain chain = find_chain(pattern);
    const Result<Limits> limits = find_limits(pattern, chain, options.margin);
    if (!limits.ok()) return limits.error();

    const bool chosen = options.cell_size > 0.0, wide = is_wide(pattern);
    double cell = chosen ? options.cell_size : cheapest_size(pattern, options, wide);
    const auto try_size = [&](double side) {
        return try_frame(frame_of(pattern, *limits, side, options.margin), chain, options.threads, wide);
    };
    std::optional<Trial> trial(try_size(cell));
    Fullest refused;
    std::optional<Frame> refused_frame;
    // Smaller cells until every list fits.
    for (int round = 1; !trial->fits(); ++round) {
        if (!refused_frame) refused = trial->fullest, refused_frame.emplace(trial->frame);
        const bool finest =
            trial->frame.cols == BURIN_MAX_TEXTURE_SIDE && trial->frame.rows == BURIN_MAX_TEXTURE_SIDE;
        if (finest || round == 12) return too_full(*refused_frame, refused, 0.0);
        cell *= 0.75;
        trial.emplace(try_size(cell));
    }
    if (chosen && refused_frame) return too_full(*refused_frame, refused, cell);
    if (!chosen) keep_to_budget(trial, cell, options.max_bytes, try_size);
    return fill_cells(trial->frame, chain, trial->hits);
}

}  // namespace burin
