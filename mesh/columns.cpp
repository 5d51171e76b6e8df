#include "columns.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "parallel.hpp"

namespace burin::mesh {

using reference::Brush;
using reference::Gathered;
using reference::GroovedSurface;
using reference::LocalGeometry;

namespace {

Vec2 middle_of(const Plan& plan, const PlanTriangle& t) {
    return (plan.corners[t.corner[0]] + plan.corners[t.corner[1]] + plan.corners[t.corner[2]]) * (1.0 / 3.0);
}

double twice_area(const Plan& plan, const PlanTriangle& t) {
    const Vec2 a = plan.corners[t.corner[0]];
    return cross(plan.corners[t.corner[1]] - a, plan.corners[t.corner[2]] - a);
}

// The triangles of one region, from one of them.
std::vector<std::uint32_t> region_from(const Plan& plan, std::uint32_t start, std::vector<std::uint8_t>& seen) {
    std::vector<std::uint32_t> region{start};
    seen[start] = 1;
    for (std::size_t i = 0; i < region.size(); ++i) {
        const PlanTriangle& t = plan.triangles[region[i]];
        for (int k = 0; k < 3; ++k) {
            if (t.across[k] == kBorder || t.step[k] != kNoStep || seen[static_cast<std::size_t>(t.across[k])]) continue;
            seen[static_cast<std::size_t>(t.across[k])] = 1;
            region.push_back(static_cast<std::uint32_t>(t.across[k]));
        }
    }
    return region;
}

double level_of(const GroovedSurface& surface, const Plan& plan, const std::vector<std::uint32_t>& region) {
    std::map<double, double> areas;
    for (const std::uint32_t t : region) areas[reference::ground_near(surface, middle_of(plan, plan.triangles[t]))] += twice_area(plan, plan.triangles[t]);
    return std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
}

}  // namespace

std::vector<double> find_levels(const GroovedSurface& surface, const Plan& plan) {
    std::vector<double> levels(plan.triangles.size());
    std::vector<std::uint8_t> seen(plan.triangles.size(), 0);
    for (std::uint32_t t = 0; t < plan.triangles.size(); ++t) {
        if (seen[t]) continue;
        const std::vector<std::uint32_t> region = region_from(plan, t, seen);
        const double level = level_of(surface, plan, region);
        for (const std::uint32_t member : region) levels[member] = level;
    }
    return levels;
}

namespace {

int longest_edge(const Plan& plan, const PlanTriangle& t) {
    int longest = -1;
    double most = -1.0;
    for (int i = 0; i < 3; ++i) {
        if (t.across[i] == kBorder) continue;
        const double side = length(plan.corners[t.corner[(i + 1) % 3]] - plan.corners[t.corner[i]]);
        if (side > most) most = side, longest = i;
    }
    return longest;
}

bool is_thin(const Plan& plan, const PlanTriangle& t, double thin) {
    double most = 0.0;
    for (int i = 0; i < 3; ++i) most = std::max(most, length(plan.corners[t.corner[(i + 1) % 3]] - plan.corners[t.corner[i]]));
    return twice_area(plan, t) <= thin * most;
}

// For each triangle itself, or, where it is too narrow to tell, the one beyond its longest edge: a blade of no width must not
// stand in a groove only since two pieces of it do not quite touch.
std::vector<std::uint32_t> find_stand_ins(const Plan& plan, double thin) {
    std::vector<std::uint32_t> stand_in(plan.triangles.size());
    for (std::uint32_t t = 0; t < plan.triangles.size(); ++t) {
        std::uint32_t at = t;
        for (int turns = 0; turns < 64 && is_thin(plan, plan.triangles[at], thin); ++turns) {
            const int edge = longest_edge(plan, plan.triangles[at]);
            if (edge < 0) break;
            at = static_cast<std::uint32_t>(plan.triangles[at].across[edge]);
        }
        stand_in[t] = at;
    }
    return stand_in;
}

// A solid or cut stretch over one point.
struct Stretch {
    double low, high;
    Boundary at_low, at_high;
};

// Over one triangle, again and again.
class Stack {
  public:
    Stack(const LocalGeometry& geometry, const Gathered& gathered, const BrushBins& bins, const ColumnOptions& options)
        : geometry_(geometry), gathered_(gathered), bins_(bins), options_(options) {}

    void find(Vec2 p, double level, Columns& out) {
        adds_.clear(), cuts_.clear(), left_.clear();
        const Boundary bottom{{{0, 0}, options_.bottom}, {kGround, kWall}}, ground{{{0, 0}, level}, {kGround, kGround}};
        adds_.push_back({options_.bottom, level, bottom, ground});
        for (const std::uint32_t i : bins_.at(p)) {
            const Brush& brush = geometry_.brushes[i];
            if (std::abs(brush.level - level) > options_.level_tolerance || !lies_over(brush, p)) continue;
            take(brush, p, bottom);
            out.brushes.push_back(i);
        }
        unite(adds_);
        unite(cuts_);
        subtract();
        for (const Stretch& stretch : left_) {
            out.boundaries.push_back(stretch.at_low);
            out.boundaries.push_back(stretch.at_high);
        }
        out.first.push_back(static_cast<std::uint32_t>(out.boundaries.size()));
        out.first_brush.push_back(static_cast<std::uint32_t>(out.brushes.size()));
    }

  private:
    bool lies_over(const Brush& brush, Vec2 p) const {
        if (p.x < brush.box.low.x || p.x > brush.box.high.x || p.y < brush.box.low.y || p.y > brush.box.high.y) return false;
        for (std::uint32_t i = 0; i < brush.polygon.count; ++i) {
            const Vec2 a = geometry_.plan(brush.polygon, i), b = geometry_.plan(brush.polygon, i + 1 < brush.polygon.count ? i + 1 : 0);
            if (cross(b - a, p - a) < 0.0) return false;
        }
        return true;
    }

    void take(const Brush& brush, Vec2 p, const Boundary& bottom) {
        const std::uint32_t element = gathered_.instances[brush.instance].element;
        const Boundary low = brush.has_bottom ? Boundary{brush.bottom, {element, brush.bottom_facet}} : bottom;
        const Boundary high{brush.top, {element, brush.top_facet}};
        std::vector<Stretch>& list = brush.cut ? cuts_ : adds_;
        const double from = brush.has_bottom ? brush.bottom.at(p) : options_.bottom, to = brush.has_top ? brush.top.at(p) : kSky;
        if (to > from) list.push_back({from, to, low, high});
    }

    // Of surfaces that coincide the ground's counts first, then that of the element that comes first.
    void unite(std::vector<Stretch>& list) const {
        const auto element = [](const Boundary& b) { return b.origin.element + 1; };  // the ground: 0
        std::stable_sort(list.begin(), list.end(), [](const Stretch& a, const Stretch& b) { return a.low < b.low; });
        std::size_t kept = 0;
        for (const Stretch& next : list) {
            if (kept > 0 && next.low <= list[kept - 1].high + geometry_.fine) {
                Stretch& last = list[kept - 1];
                const bool same = std::abs(next.high - last.high) <= geometry_.fine;
                if (same ? element(next.at_high) < element(last.at_high) : next.high > last.high) last.high = next.high, last.at_high = next.at_high;
                if (std::abs(next.low - last.low) <= geometry_.fine && element(next.at_low) < element(last.at_low)) last.at_low = next.at_low;
            } else {
                list[kept++] = next;
            }
        }
        list.resize(kept);
    }

    void subtract() {
        for (Stretch solid : adds_) {
            for (const Stretch& cut : cuts_) {
                if (cut.high <= solid.low || cut.low >= solid.high) continue;
                if (cut.low - solid.low > geometry_.fine) left_.push_back({solid.low, cut.low, solid.at_low, cut.at_low});
                solid.low = cut.high, solid.at_low = cut.at_high;
            }
            if (solid.high - solid.low > geometry_.fine) left_.push_back(solid);
        }
    }

    static constexpr double kSky = 1e300;
    const LocalGeometry& geometry_;
    const Gathered& gathered_;
    const BrushBins& bins_;
    const ColumnOptions& options_;
    std::vector<Stretch> adds_, cuts_, left_;
};

// Ranges of one list, given by where they end, behind those of another.
template <typename Item>
void append(const std::vector<Item>& items, const std::vector<std::uint32_t>& ends, std::vector<Item>& all, std::vector<std::uint32_t>& all_ends) {
    const auto before = static_cast<std::uint32_t>(all.size());
    for (const std::uint32_t end : ends) all_ends.push_back(before + end);
    all.insert(all.end(), items.begin(), items.end());
}

}  // namespace

Columns stack_columns(const LocalGeometry& geometry, const Gathered& gathered, const BrushBins& bins, const Plan& plan,
                      const std::vector<double>& levels, const ColumnOptions& options) {
    constexpr std::size_t kPiece = 4096;
    const std::vector<std::uint32_t> stand_in = find_stand_ins(plan, options.thin);
    const std::size_t count = plan.triangles.size(), pieces = (count + kPiece - 1) / kPiece;
    std::vector<Columns> parts(pieces);
    for_each_piece(pieces, options.threads, [&](std::size_t piece) {
        Stack stack(geometry, gathered, bins, options);
        for (std::size_t t = piece * kPiece; t < std::min(count, (piece + 1) * kPiece); ++t)
            stack.find(middle_of(plan, plan.triangles[stand_in[t]]), levels[stand_in[t]], parts[piece]);
    });
    Columns all{{}, {0}, {}, {0}};
    for (const Columns& part : parts) {
        append(part.boundaries, part.first, all.boundaries, all.first);
        append(part.brushes, part.first_brush, all.brushes, all.first_brush);
    }
    return all;
}

}  // namespace burin::mesh
