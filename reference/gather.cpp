#include "gather.hpp"

#include <algorithm>
#include <cmath>

#include "layout.h"

#include "evaluate_prepare.hpp"

namespace burin::reference {
namespace {

struct CellRange {
    int low[2], high[2];  // both included; not yet wrapped
};

CellRange cells_of(const GroovedSurface& surface, const Box& box) {
    const CellGrid& grid = surface.grid();
    const Vec2 size = surface.pattern().size;
    const auto cell = [](double at, double side, int count) {
        return static_cast<int>(std::floor(std::clamp(at / side * count, -1e8, 1e8)));
    };
    CellRange range{{cell(box.low.x, size.x, grid.cols), cell(box.low.y, size.y, grid.rows)},
                    {cell(box.high.x, size.x, grid.cols), cell(box.high.y, size.y, grid.rows)}};
    if (surface.pattern().wrap == Wrap::repeat) return range;
    const int last[2] = {grid.cols - 1, grid.rows - 1};
    for (int axis = 0; axis < 2; ++axis) {
        range.low[axis] = std::max(range.low[axis], 0);
        range.high[axis] = std::min(range.high[axis], last[axis]);
    }
    return range;
}

int wrapped(int i, int count) {
    const int rest = i % count;
    return rest < 0 ? rest + count : rest;
}

// The image that a cell means: the nearest to its centre.
Vec2 image_of(const GroovedSurface& surface, std::uint32_t element, int i, int j) {
    const ResolvedPattern& pattern = surface.pattern();
    if (pattern.wrap == Wrap::clamp) return {0, 0};
    const Element& e = pattern.elements[element].element;
    const Vec2 middle = lerp(e.p0, e.p2, 0.5);
    const Vec2 centre{(i + 0.5) * pattern.size.x / surface.grid().cols, (j + 0.5) * pattern.size.y / surface.grid().rows};
    return {pattern.size.x * std::floor((centre.x - middle.x) / pattern.size.x + 0.5),
            pattern.size.y * std::floor((centre.y - middle.y) / pattern.size.y + 0.5)};
}

// A line's strip may pass the region by although its box does not.
bool strip_meets(const PreparedElement& e, Vec2 shift, const Region& region) {
    if (!region.meets({e.box.low + shift, e.box.high + shift})) return false;
    if (e.kind != ElementKind::line) return true;
    const Vec2 n = normal_of(e.tangent);
    double low, high;
    region.extent(n, low, high);
    const double at = dot(e.p0 + shift, n);
    return at + e.reach >= low && at - e.reach <= high;
}

std::size_t cell_at(const CellGrid& grid, int i, int j) {
    return static_cast<std::size_t>(wrapped(j, grid.rows)) * static_cast<std::size_t>(grid.cols) + static_cast<std::size_t>(wrapped(i, grid.cols));
}

template <typename Visit>
void for_each_cell(const GroovedSurface& surface, const Box& box, const Visit& visit) {
    const CellRange range = cells_of(surface, box);
    for (int j = range.low[1]; j <= range.high[1]; ++j)
        for (int i = range.low[0]; i <= range.high[0]; ++i) visit(i, j, cell_at(surface.grid(), i, j));
}

void bound_heights(const GroovedSurface& surface, Gathered& out) {
    out.lowest = surface.top(), out.highest = -1e300;
    for_each_cell(surface, out.region.box, [&](int, int, std::size_t cell) {
        out.lowest = std::min(out.lowest, surface.grid().lowest[cell]);
        out.highest = std::max(out.highest, surface.grid().highest[cell]);
    });
    if (surface.pattern().wrap == Wrap::repeat) return;
    out.lowest = std::min(out.lowest, surface.pattern().outer_level);
    out.highest = std::max(out.highest, surface.pattern().outer_level);
}

void set_region(const Slopes& slopes, const Start& start, Gathered& out) {
    out.region.sweep[0] = slopes.view * (start.rising ? std::min(start.low - out.highest, 0.0) : std::max(start.high - out.lowest, 0.0));
    out.region.sweep[1] = slopes.lit ? slopes.light * (out.lowest - out.highest) : Vec2{0, 0};
    out.region.bound();
}

}  // namespace

void Region::extent(Vec2 n, double& low, double& high) const {
    low = 1e300, high = -1e300;
    for (const Vec2 p : footprint.corners) {
        low = std::min(low, dot(p, n));
        high = std::max(high, dot(p, n));
    }
    for (const Vec2 by : sweep) {
        low += std::min(0.0, dot(by, n));
        high += std::max(0.0, dot(by, n));
    }
}

void Region::bound() {
    extent({1, 0}, box.low.x, box.high.x);
    extent({0, 1}, box.low.y, box.high.y);
    for (int k = 0; k < 2; ++k) {
        slabs[k].n = normal_of(unit(sweep[k]));
        extent(slabs[k].n, slabs[k].low, slabs[k].high);
    }
}

bool Region::meets(const Box& other) const {
    if (!meet(box, other)) return false;
    const Vec2 centre = lerp(other.low, other.high, 0.5), half = (other.high - other.low) * 0.5;
    for (const Slab& slab : slabs) {
        const double at = dot(centre, slab.n), reach = std::abs(slab.n.x) * half.x + std::abs(slab.n.y) * half.y;
        if (at + reach < slab.low || at - reach > slab.high) return false;
    }
    return true;
}

void gather_grooves(const GroovedSurface& surface, const Footprint& footprint, const Slopes& slopes, Gathered& out) {
    gather_grooves(surface, footprint, slopes, Start{surface.top(), surface.top(), false}, out);
}

void gather_grooves(const GroovedSurface& surface, const Footprint& footprint, const Slopes& slopes, const Start& start, Gathered& out) {
    out.region.footprint.corners.assign(footprint.corners.begin(), footprint.corners.end());
    out.lowest = surface.lowest(), out.highest = surface.top();
    set_region(slopes, start, out);
    // What lies there may be less deep than the whole pattern.
    bound_heights(surface, out);
    set_region(slopes, start, out);
    out.from_top = !start.within && !start.rising && start.low == surface.top() && start.high == surface.top();
    out.view = slopes.view;
    out.instances.clear();
    out.steps = false;
    const auto& elements = surface.truth().prepared().elements;
    for_each_cell(surface, out.region.box, [&](int i, int j, std::size_t cell) {
        out.steps = out.steps || (surface.grid().flags[cell] & BURIN_CELL_FLAG_STEP) != 0;
        for (std::uint32_t k = surface.grid().first_ref[cell]; k < surface.grid().first_ref[cell + 1]; ++k) {
            const std::uint32_t element = surface.grid().refs[k];
            const Vec2 shift = image_of(surface, element, i, j);
            if (strip_meets(elements[element], shift, out.region)) out.instances.push_back({element, shift});
        }
    });
    const auto key = [](const Instance& a) { return std::tuple(a.element, a.shift.x, a.shift.y); };
    std::sort(out.instances.begin(), out.instances.end(), [&](const Instance& a, const Instance& b) { return key(a) < key(b); });
    out.instances.erase(std::unique(out.instances.begin(), out.instances.end(), [&](const Instance& a, const Instance& b) { return key(a) == key(b); }),
                        out.instances.end());
}

bool is_inside_map(const GroovedSurface& surface, const Region& region) {
    return truth::inside_map(surface.truth().prepared(), region.box.low) && truth::inside_map(surface.truth().prepared(), region.box.high);
}

double ground_near(const GroovedSurface& surface, Vec2 p) {
    const ResolvedPattern& pattern = surface.pattern();
    const CellGrid& grid = surface.grid();
    if (!truth::inside_map(surface.truth().prepared(), p)) return pattern.outer_level;
    const CellRange at = cells_of(surface, {p, p});
    const int i = at.low[0], j = at.low[1];
    const std::size_t cell = cell_at(grid, i, j);
    if ((grid.flags[cell] & BURIN_CELL_FLAG_STEP) == 0) return grid.level[cell];
    const Vec2 side{pattern.size.x / grid.cols, pattern.size.y / grid.rows}, place = cell_start(grid.start[cell]);
    const Vec2 start{(i + 0.5 + place.x) * side.x, (j + 0.5 + place.y) * side.y}, way = p - start;
    double level = grid.level[cell], last = 0.0;
    for (std::uint32_t k = grid.first_ref[cell]; k < grid.first_ref[cell + 1]; ++k) {
        const PreparedElement& e = surface.truth().prepared().elements[grid.refs[k]];
        if (!e.step || dot(way, way) == 0.0) continue;
        const Vec2 shift = image_of(surface, grid.refs[k], i, j);
        double u[2];
        const int count = truth::meet_line(e, start - shift, way, u);
        for (int n = 0; n < count; ++n) {
            const double s = dot(truth::point_on(e, u[n]) + shift - start, way) / dot(way, way);
            if (s <= last || s > 1.0) continue;
            last = s;
            level = dot(way, normal_of(truth::tangent_on(e, u[n]))) > 0.0 ? e.right_level : e.left_level;
        }
    }
    return level;
}

}  // namespace burin::reference
