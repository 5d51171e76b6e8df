// Level, height bounds, flags and skip distance of every cell.
#include <algorithm>
#include <cmath>
#include <span>

#include "grid_internal.hpp"
#include "layout.h"
#include "resolve_chords.hpp"
#include "resolve_curve.hpp"

namespace burin::gridding {
namespace {

using resolving::Chord;
using resolving::ChordIndex;
using resolving::Shift;

double rise_of(const ResolvedPattern& pattern, const ResolvedElement& e) {
    const auto& points = pattern.profiles[pattern.styles[e.style].profile].points;
    return (points.back().h - points.front().h) * e.element.height0;
}

// Point location by the nearest step element.
class Ground {
  public:
    explicit Ground(const ResolvedPattern& pattern)
        : pattern_(pattern),
          index_(chords(pattern, tolerance_), pattern.size, pattern.wrap == Wrap::repeat) {}

    struct Answer {
        double level, distance;
    };

    Answer at(Vec2 p) const {
        Answer answer{pattern_.outer_level, 1e300};
        double perpendicular = -1.0;
        if (index_.chords().empty()) return answer;
        index_.visit_rings(p, [&](std::uint32_t k, Shift shift) {
            const Chord& chord = index_.chords()[k];
            const ResolvedElement& e = pattern_.elements[chord.element];
            const Vec2 q = p - shift * pattern_.size;
            double along = 0.0;
            if (resolving::segment_distance(chord.a, chord.b, q, along) > answer.distance + tolerance_)
                return answer.distance;
            // The arc itself, where the chord is near enough to matter.
            const double s = e.element.kind == ElementKind::line ? chord.s0 + along * (chord.s1 - chord.s0)
                                                                 : curve::nearest(e.element, q);
            const Vec2 gap = q - curve::point(e.element, s);
            const double across = cross(curve::tangent(e.element, s), gap), distance = length(gap);
            const double slack = 1e-9 * distance;
            if (distance < answer.distance - slack ||
                (distance <= answer.distance + slack && std::abs(across) > perpendicular)) {
                answer = {pattern_.styles[e.style].level + (across < 0.0 ? 0.0 : rise_of(pattern_, e)),
                          distance};
                perpendicular = std::abs(across);
            }
            return answer.distance;
        });
        return answer;
    }

  private:
    static std::vector<Chord> chords(const ResolvedPattern& pattern, double& tolerance) {
        tolerance = 1e-5 * std::max(pattern.size.x, pattern.size.y);
        std::vector<Chord> result;
        for (std::uint32_t i = 0; i < pattern.elements.size(); ++i) {
            const ResolvedElement& e = pattern.elements[i];
            if (!pattern.styles[e.style].step) continue;
            const int count = curve::chord_count(e.element, tolerance);
            for (int k = 0; k < count; ++k) {
                const double s0 = static_cast<double>(k) / count, s1 = static_cast<double>(k + 1) / count;
                result.push_back(
                    {curve::point(e.element, s0), curve::point(e.element, s1), s0, s1, e.path, i});
            }
        }
        return result;
    }

    const ResolvedPattern& pattern_;
    double tolerance_ = 0.0;
    ChordIndex index_;
};

void fill_lists(const Frame& frame, const std::vector<std::vector<Hit>>& hits, CellGrid& grid) {
    const std::size_t cells = static_cast<std::size_t>(frame.cols) * static_cast<std::size_t>(frame.rows);
    grid.first_ref.assign(cells + 1, 0);
    for (const auto& list : hits)
        for (const Hit& hit : list) ++grid.first_ref[hit.cell + 1];
    for (std::size_t i = 0; i < cells; ++i) grid.first_ref[i + 1] += grid.first_ref[i];
    grid.refs.resize(grid.first_ref[cells]);
    std::vector<std::uint32_t> next(grid.first_ref.begin(), grid.first_ref.end() - 1);
    for (std::uint32_t e = 0; e < hits.size(); ++e)
        for (const Hit& hit : hits[e]) grid.refs[next[hit.cell]++] = e;
}

void flag_steps(const std::vector<std::vector<Hit>>& hits, CellGrid& grid) {
    grid.flags.assign(grid.first_ref.size() - 1, 0);
    for (const auto& list : hits)
        for (const Hit& hit : list)
            if (hit.path_line) grid.flags[hit.cell] |= BURIN_CELL_FLAG_STEP;
}

// The copy of a listed element that acts in a cell (grid.hpp).
Element copy_at(const Frame& frame, const Element& element, Vec2 centre) {
    if (!frame.repeats()) return element;
    const Vec2 size = frame.pattern.size, gap = centre - lerp(element.p0, element.p2, 0.5);
    return curve::translated(
        element, {size.x * std::floor(gap.x / size.x + 0.5), size.y * std::floor(gap.y / size.y + 0.5)});
}

// Where the walk to a point of a cell begins: clear of every step, so that the side it lies on is beyond the doubt
// of quantized positions and of a reader's floats.
void fill_starts(const Frame& frame, CellGrid& grid) {
    constexpr std::uint32_t kStarts = 1u << BURIN_CELL_SKIP_BITS;
    const double enough = std::min(frame.cell.x, frame.cell.y) / 50.0;
    grid.start.assign(grid.flags.size(), 0);
    std::vector<Element> steps;
    for (std::size_t k = 0; k < grid.flags.size(); ++k) {
        if ((grid.flags[k] & BURIN_CELL_FLAG_STEP) == 0) continue;
        const Vec2 centre = frame.start(k, 0);
        steps.clear();
        for (std::uint32_t r = grid.first_ref[k]; r < grid.first_ref[k + 1]; ++r) {
            const ResolvedElement& e = frame.pattern.elements[grid.refs[r]];
            if (frame.pattern.styles[e.style].step) steps.push_back(copy_at(frame, e.element, centre));
        }
        double farthest = -1.0;
        // The centre comes last: in drawn patterns it lies on one line with corners and with a picture's samples, and
        // a walk through a corner where several lines meet is decided by rounding.
        for (std::uint32_t i = 1; i <= kStarts && farthest < enough; ++i) {
            const std::uint32_t start = i % kStarts;
            const Vec2 p = frame.start(k, start);
            double clear = 1e300;
            for (const Element& e : steps)
                clear = std::min(clear, length(p - curve::point(e, curve::nearest(e, p))));
            if (clear > farthest) farthest = clear, grid.start[k] = static_cast<std::uint8_t>(start);
        }
    }
}

// Cells without a step that share a side, one after the other from `seed`.
std::vector<std::size_t> region_of(const Frame& frame, const CellGrid& grid, std::size_t seed,
                                   std::vector<char>& taken) {
    const std::size_t cols = static_cast<std::size_t>(frame.cols), rows = static_cast<std::size_t>(frame.rows);
    std::vector<std::size_t> region{seed};
    taken[seed] = 1;
    const auto take = [&](std::size_t k) {
        if (taken[k] || (grid.flags[k] & BURIN_CELL_FLAG_STEP) != 0) return;
        taken[k] = 1;
        region.push_back(k);
    };
    for (std::size_t i = 0; i < region.size(); ++i) {
        const std::size_t col = region[i] % cols, row = region[i] / cols;
        if (frame.repeats() || col > 0) take(row * cols + (col + cols - 1) % cols);
        if (frame.repeats() || col + 1 < cols) take(row * cols + (col + 1) % cols);
        if (frame.repeats() || row > 0) take((row + rows - 1) % rows * cols + col);
        if (frame.repeats() || row + 1 < rows) take((row + 1) % rows * cols + col);
    }
    return region;
}

// What most answers say; of equally many, the lowest.
double most_frequent(std::vector<double> answers) {
    std::sort(answers.begin(), answers.end());
    std::size_t most = 0, best = 0;
    for (std::size_t from = 0, to = 0; from < answers.size(); from = to) {
        while (to < answers.size() && answers[to] == answers[from]) ++to;
        if (to - from > most) most = to - from, best = from;
    }
    return answers[best];
}

// No step lies between two cells without STEP that share a side, so their whole region has one level. Places all over it
// are asked: beside a step whose line has a gap, the answer may be that of its other side.
void fill_levels(const Frame& frame, CellGrid& grid) {
    const Ground ground(frame.pattern);
    const auto ask = [&](std::size_t k) { return ground.at(frame.start(k, grid.start[k])).level; };
    grid.level.assign(grid.flags.size(), 0.0);
    std::vector<char> taken(grid.flags.size(), 0);
    for (std::size_t k = 0; k < grid.flags.size(); ++k) {
        if ((grid.flags[k] & BURIN_CELL_FLAG_STEP) != 0) {
            grid.level[k] = ask(k);
        } else if (!taken[k]) {
            constexpr std::size_t kAsked = 64;
            const std::vector<std::size_t> region = region_of(frame, grid, k, taken);
            std::vector<double> answers;
            for (std::size_t i = 0; i < region.size(); i += 1 + region.size() / kAsked)
                answers.push_back(ask(region[i]));
            const double level = most_frequent(std::move(answers));
            for (const std::size_t cell : region) grid.level[cell] = level;
        }
    }
}

void fill_bounds(const Frame& frame, const std::vector<std::vector<Hit>>& hits, CellGrid& grid) {
    grid.highest = grid.lowest = grid.level;
    for (std::size_t e = 0; e < hits.size(); ++e) {
        const ResolvedElement& element = frame.pattern.elements[e];
        const double level = frame.pattern.styles[element.style].level;
        const double rise = frame.pattern.styles[element.style].step ? rise_of(frame.pattern, element) : 0.0;
        for (const Hit& hit : hits[e]) {
            double &high = grid.highest[hit.cell], &low = grid.lowest[hit.cell];
            if (hit.path_line) {
                high = std::max({high, level, level + rise});
                low = std::min({low, level, level + rise});
            }
            if (hit.heights.high > -1e299) high = std::max(high, level + hit.heights.high);
            if (hit.heights.low < 1e299) low = std::min(low, level + hit.heights.low);
        }
    }
}

// Whether the listed elements are one open chain: from the only one that none of them leads to, all are
// reached. A closed loop within one cell is not simple, and must not stand in for a chain beside it.
bool is_open_chain(const Chain& chain, std::span<const std::uint32_t> list) {
    const auto listed = [list](std::uint32_t element) {
        return element != kNoElement && std::binary_search(list.begin(), list.end(), element);
    };
    std::vector<std::uint32_t> followers;
    for (const std::uint32_t ref : list)
        if (listed(chain.next[ref])) followers.push_back(chain.next[ref]);
    std::sort(followers.begin(), followers.end());
    const auto start = std::find_if(list.begin(), list.end(), [&followers](std::uint32_t ref) {
        return !std::binary_search(followers.begin(), followers.end(), ref);
    });
    if (start == list.end()) return list.empty();
    std::size_t reached = 1;
    for (std::uint32_t at = *start; listed(chain.next[at]) && reached < list.size(); at = chain.next[at])
        ++reached;
    return reached == list.size();
}

void flag_isolated(const Chain& chain, const std::vector<std::vector<Hit>>& hits, CellGrid& grid) {
    std::vector<char> special(grid.flags.size(), 0);
    for (const auto& list : hits)
        for (const Hit& hit : list)
            if (hit.end_zone) special[hit.cell] = 1;
    for (std::size_t k = 0; k < grid.flags.size(); ++k) {
        const std::span<const std::uint32_t> refs(grid.refs);
        const auto list = refs.subspan(grid.first_ref[k], grid.first_ref[k + 1] - grid.first_ref[k]);
        if (!special[k] && is_open_chain(chain, list)) grid.flags[k] |= BURIN_CELL_FLAG_ISOLATED;
    }
}

// Chebyshev distance to the nearest cell that lists something, by sweeps until nothing changes.
void fill_skip(const Frame& frame, CellGrid& grid) {
    constexpr int kFar = (1 << BURIN_CELL_SKIP_BITS);
    const int cols = frame.cols, rows = frame.rows;
    std::vector<int> distance(grid.flags.size());
    for (std::size_t k = 0; k < distance.size(); ++k)
        distance[k] = grid.first_ref[k] != grid.first_ref[k + 1] ? 0 : kFar;
    const auto at = [&](int col, int row) -> int {
        const bool out = col < 0 || row < 0 || col >= cols || row >= rows;
        // What lies beyond a clamped map's border is another ground.
        if (out && !frame.repeats()) return 0;
        return distance[static_cast<std::size_t>((row + rows) % rows) * cols + (col + cols) % cols];
    };
    // Distances are at most kFar, so that many rounds of looking at the eight neighbours settle everything.
    for (bool changed = true; changed;) {
        changed = false;
        for (const int order : {0, 1})
            for (int i = 0; i < rows * cols; ++i) {
                const int k = order == 0 ? i : rows * cols - 1 - i;
                const int col = k % cols, row = k / cols;
                int best = distance[k];
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx)
                        best = std::min(best, at(col + dx, row + dy) + 1 - (dx == 0 && dy == 0));
                if (best < distance[k]) distance[k] = best, changed = true;
            }
    }
    const int largest = frame.repeats() ? std::max(0, (std::min(cols, rows) - 1) / 2) : kFar;
    grid.skip.resize(distance.size());
    for (std::size_t k = 0; k < distance.size(); ++k)
        grid.skip[k] = static_cast<std::uint8_t>(std::clamp(std::min(distance[k] - 1, largest), 0, kFar - 1));
}

}  // namespace

CellGrid fill_cells(const Frame& frame, const Chain& chain, const std::vector<std::vector<Hit>>& hits) {
    CellGrid grid;
    grid.cols = frame.cols;
    grid.rows = frame.rows;
    fill_lists(frame, hits, grid);
    flag_steps(hits, grid);
    fill_starts(frame, grid);
    fill_levels(frame, grid);
    fill_bounds(frame, hits, grid);
    flag_isolated(chain, hits, grid);
    fill_skip(frame, grid);
    return grid;
}

}  // namespace burin::gridding

namespace burin {

Vec2 cell_start(std::uint32_t index) {
    const auto along = [index](std::uint32_t factor) {
        const auto at = static_cast<int>((index * factor + BURIN_START_HALF) % BURIN_START_STEPS);
        return (at - BURIN_START_HALF) / BURIN_START_SPREAD;
    };
    return {along(BURIN_START_FACTOR_U), along(BURIN_START_FACTOR_V)};
}

}  // namespace burin
