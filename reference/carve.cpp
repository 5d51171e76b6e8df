#include "carve.hpp"

#include <algorithm>
#include <iterator>

#include "evaluate_prepare.hpp"

namespace burin::reference {

constexpr int kMostCells = 64;  // of the region, along a side

Carver::Carver(LocalGeometry& geometry, const GroovedSurface& surface, const Gathered& gathered, Carving& work)
    : geometry_(geometry), surface_(surface), gathered_(gathered), work_(work) {
    work_.pieces.clear();
    work_.of_face.assign(geometry.faces.size(), {});
    work_.halves.clear();
    work_.first_half.clear();
    for (const Brush& brush : geometry_.brushes) {
        work_.first_half.push_back(static_cast<std::uint32_t>(work_.halves.size()));
        if (brush.has_bottom) work_.halves.push_back({{brush.bottom.g.x, brush.bottom.g.y, -1.0}, -brush.bottom.c});
        if (brush.has_top) work_.halves.push_back({{-brush.top.g.x, -brush.top.g.y, 1.0}, brush.top.c});
        for (std::uint32_t i = 0; i < brush.polygon.count; ++i) {
            const HalfPlane edge = edge_of(geometry_.plan, brush.polygon, i);
            work_.halves.push_back({{edge.n.x, edge.n.y, 0.0}, edge.d});
        }
    }
    work_.first_half.push_back(static_cast<std::uint32_t>(work_.halves.size()));
    sort_brushes();
}

// Cells that the box meets; those at the region's border reach on without end.
template <typename Use>
void Carver::for_each_cell(const Box& box, const Use& use) const {
    const Box& all = gathered_.region.box;
    const auto cell = [](double at, double low, double high, int count) {
        return static_cast<int>(std::clamp((at - low) / (high - low) * count, 0.0, double(count - 1)));
    };
    const int left = cell(box.low.x, all.low.x, all.high.x, columns_), right = cell(box.high.x, all.low.x, all.high.x, columns_);
    const int lower = cell(box.low.y, all.low.y, all.high.y, rows_), upper = cell(box.high.y, all.low.y, all.high.y, rows_);
    for (int row = lower; row <= upper; ++row)
        for (int column = left; column <= right; ++column) use(static_cast<std::size_t>(row * columns_ + column));
}

// Into cells as large as a brush is in the mean, where that makes several.
void Carver::sort_brushes() {
    const Box& all = gathered_.region.box;
    Vec2 sum_of_sides{0, 0};
    for (const Brush& brush : geometry_.brushes)
        sum_of_sides = sum_of_sides + Vec2{std::min(brush.box.high.x, all.high.x) - std::max(brush.box.low.x, all.low.x),
                                           std::min(brush.box.high.y, all.high.y) - std::max(brush.box.low.y, all.low.y)};
    const auto cells = [&](double side, double sum) {
        return static_cast<int>(std::clamp(side * double(geometry_.brushes.size()) / std::max(sum, 1e-300), 1.0, double(kMostCells)));
    };
    columns_ = cells(all.high.x - all.low.x, sum_of_sides.x);
    rows_ = cells(all.high.y - all.low.y, sum_of_sides.y);
    auto& first = work_.first_binned;
    first.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
    for (const Brush& brush : geometry_.brushes) for_each_cell(brush.box, [&](std::size_t cell) { ++first[cell]; });
    std::uint32_t listed = 0;
    for (std::uint32_t& entry : first) listed += entry, entry = listed;
    work_.binned.resize(listed);
    for (std::uint32_t b = 0; b < geometry_.brushes.size(); ++b)
        for_each_cell(geometry_.brushes[b].box, [&](std::size_t cell) { work_.binned[--first[cell]] = b; });
    work_.asked.assign(geometry_.brushes.size(), 0);
    work_.turn = 0;
}

void Carver::find_candidates(const Face& face) {
    ++work_.turn;
    work_.candidates.clear();
    for_each_cell(face.box, [&](std::size_t cell) {
        for (std::uint32_t i = work_.first_binned[cell]; i < work_.first_binned[cell + 1]; ++i) {
            const std::uint32_t b = work_.binned[i];
            const Brush& brush = geometry_.brushes[b];
            if (work_.asked[b] == work_.turn || !meet(brush.box, face.box)) continue;
            work_.asked[b] = work_.turn;
            if (!spares(face, brush)) work_.candidates.push_back(b);
        }
    });
    std::sort(work_.candidates.begin(), work_.candidates.end());
}

Carving::Pieces Carver::pieces_of(std::uint32_t face) {
    Carving::Pieces& pieces = work_.of_face[face];
    if (pieces.carved) return pieces;
    carve(geometry_.faces[face]);
    pieces = {static_cast<std::uint32_t>(work_.pieces.size()), static_cast<std::uint32_t>(work_.kept.size()), true};
    work_.pieces.insert(work_.pieces.end(), work_.kept.begin(), work_.kept.end());
    return pieces;
}

// The ground reaches under everything: it is halved until few brushes are left for each part, or as many as before: long ones, aslant.
void Carver::carve_ground(Polygon polygon, const Face& face, const std::vector<std::uint32_t>& candidates, int depth) {
    if (candidates.size() > 24 && depth < 16) {
        const Part whole = part_of(polygon);
        const Vec2 middle = lerp(whole.box.low, whole.box.high, 0.5), extent = whole.box.high - whole.box.low;
        Polygon parts[2];
        geometry_.points.split(polygon, extent.x > extent.y ? HalfSpace{{1, 0, 0}, middle.x} : HalfSpace{{0, 1, 0}, middle.y}, parts[0], parts[1]);
        std::vector<std::uint32_t> near[2];
        for (int k = 0; k < 2; ++k)
            std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(near[k]),
                         [&, box = part_of(parts[k]).box](std::uint32_t b) { return meet(geometry_.brushes[b].box, box); });
        if (parts[0] && parts[1] && 2 * (near[0].size() + near[1].size()) < 3 * candidates.size()) {
            for (int k = 0; k < 2; ++k) carve_ground(parts[k], face, near[k], depth + 1);
            return;
        }
    }
    // What other parts have left must stay.
    std::vector<Part> others;
    others.swap(work_.kept);
    keep(polygon);
    for (const std::uint32_t b : candidates) remove(face, b, tie(face, geometry_.brushes[b]));
    work_.kept.insert(work_.kept.end(), others.begin(), others.end());
}

void Carver::carve(const Face& face) {
    work_.kept.clear();
    find_candidates(face);
    if (face.kind == FaceKind::ground && !face.wall && work_.candidates.size() > 24) return carve_ground(face.polygon, face, work_.candidates, 0);
    if (face.kind == FaceKind::ground)
        keep(face.polygon);
    else if (face.kind == FaceKind::add)
        keep(geometry_.points.clip(face.polygon, HalfSpace{{0, 0, -1}, -(face.level + geometry_.fine)}));
    else
        keep_solid(face);
    for (const std::uint32_t b : work_.candidates) {
        if (work_.kept.empty()) break;
        const Brush& brush = geometry_.brushes[b];
        if (face.kind == FaceKind::cut && !brush.cut) continue;
        remove(face, b, tie(face, brush));
    }
    if (face.wall && face.kind != FaceKind::ground) keep_first_wall(face);
}

// Of walls at one place that of the first element stays: behind what stands, and before what is cut, lies no other's.
void Carver::keep_first_wall(const Face& face) {
    Face turned = face;
    turned.normal = face.normal * -1.0;
    const bool cut = face.kind == FaceKind::cut;
    for (const std::uint32_t b : work_.candidates) {
        const Brush& brush = geometry_.brushes[b];
        if (brush.cut == cut && brush.instance < face.instance) remove(turned, b, -geometry_.fine);
    }
}

void Carver::keep(Polygon p) {
    if (p) work_.kept.push_back(part_of(p));
}

bool Carver::overhangs(std::uint32_t instance) const {
    const auto& e = surface_.truth().prepared().elements[gathered_.instances[instance].element];
    return !surface_.profiles()[e.profile].height_field;
}

// Whether the brush is the face's own and bounded by it.
bool Carver::spares(const Face& face, const Brush& brush) const {
    if (face.wall || face.instance != brush.instance) return false;
    return face.kind == FaceKind::cut || !brush.cut || !overhangs(face.instance);
}

// By how much a brush is larger than it is when faces coincide.
double Carver::tie(const Face& face, const Brush& brush) const {
    if (face.wall) return geometry_.fine;
    const bool same_kind = (face.kind == FaceKind::cut) == brush.cut && face.kind != FaceKind::ground;
    return same_kind && brush.instance < face.instance ? geometry_.fine : -geometry_.fine;
}

// What of a cut's face lies in the ground or in additions of others.
void Carver::keep_solid(const Face& face) {
    Polygon below, above;
    geometry_.points.split(face.polygon, HalfSpace{{0, 0, 1}, face.level - geometry_.fine}, below, above);
    keep(below);
    if (!above) return;
    work_.solid.assign(1, part_of(above));
    for (const std::uint32_t b : work_.candidates) {
        if (work_.solid.empty()) break;
        const Brush& brush = geometry_.brushes[b];
        if (brush.cut) continue;
        work_.next.clear();
        for (const Part& p : work_.solid) {
            if (misses(face, p, b, -geometry_.fine))
                work_.next.push_back(p);
            else
                keep(subtract(face, p, b, -geometry_.fine));
        }
        work_.solid.swap(work_.next);
    }
}

// Most parts lie apart from the brush: they stay where they are.
void Carver::remove(const Face& face, std::size_t brush, double grow) {
    work_.next.clear();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < work_.kept.size(); ++i) {
        if (!misses(face, work_.kept[i], brush, grow))
            subtract(face, work_.kept[i], brush, grow);
        else if (kept++ != i)
            work_.kept[kept - 1] = work_.kept[i];
    }
    work_.kept.resize(kept);
    work_.kept.insert(work_.kept.end(), work_.next.begin(), work_.next.end());
}

// Walls stand on borders of brushes. What is added beside one hides it where that lies before it; what is cut takes it where that
// lies behind it, and so does all else with the wall of a cut.
Vec2 Carver::judged_at(const Face& face, const Brush& brush) const {
    if (!face.wall) return {0, 0};
    return plan(face.normal) * (brush.cut || face.kind == FaceKind::cut ? -8.0 * geometry_.fine : 8.0 * geometry_.fine);
}

// A bound of the brush, k of work_.halves, as the face has it. `grow`: by how much top and bottom are moved outwards.
HalfSpace Carver::half_of(const Face& face, std::size_t index, std::uint32_t k, double grow) const {
    const Brush& brush = geometry_.brushes[index];
    HalfSpace half = work_.halves[k];
    half.d += k < work_.first_half[index + 1] - brush.polygon.count ? grow : -dot(plan(half.n), judged_at(face, brush));
    return half;
}

bool Carver::misses(const Face& face, const Part& part, std::size_t index, double grow) const {
    if (!meet(part.box, geometry_.brushes[index].box)) return true;
    for (std::uint32_t k = work_.first_half[index]; k < work_.first_half[index + 1]; ++k)
        if (all_beyond(part.polygon, half_of(face, index, k, grow))) return true;
    return false;
}

// Adds what lies outside of the brush to work_.next; returns what lies inside.
Polygon Carver::subtract(const Face& face, const Part& part, std::size_t index, double grow) {
    Polygon rest = part.polygon;
    for (std::uint32_t k = work_.first_half[index]; k < work_.first_half[index + 1] && rest; ++k) {
        Polygon inside, outside;
        geometry_.points.split(rest, half_of(face, index, k, grow), inside, outside);
        if (outside) work_.next.push_back(part_of(outside));
        rest = inside;
    }
    return rest;
}

Part Carver::part_of(Polygon p) const {
    Part part{p, {}};
    for (const Vec3* q = geometry_.points.begin(p); q != geometry_.points.end(p); ++q) include(part.box, plan(*q));
    return part;
}

bool Carver::all_beyond(Polygon p, const HalfSpace& half) const {
    for (const Vec3* q = geometry_.points.begin(p); q != geometry_.points.end(p); ++q)
        if (beyond(half, *q) < -geometry_.points.thin) return false;
    return true;
}

}  // namespace burin::reference
