#include "edges.hpp"

#include <algorithm>
#include <cmath>

namespace burin::mesh {

using reference::Brush;
using reference::LocalGeometry;
using reference::Plane;

namespace {

constexpr double kMostBinsPerSide = 1024.0;

double middle_side(const LocalGeometry& geometry) {
    double sum = 0.0;
    for (const Brush& brush : geometry.brushes) sum += std::max(brush.box.high.x - brush.box.low.x, brush.box.high.y - brush.box.low.y);
    return geometry.brushes.empty() ? 1.0 : sum / static_cast<double>(geometry.brushes.size());
}

}  // namespace

BrushBins::BrushBins(const LocalGeometry& geometry, Vec2 size) : geometry_(geometry), size_(size) {
    const double longer = std::max(size.x, size.y);
    side_ = static_cast<std::size_t>(std::clamp(longer / std::max(middle_side(geometry), longer / kMostBinsPerSide), 1.0, kMostBinsPerSide));
    const auto for_each_bin = [&](const Brush& brush, const auto& visit) {
        for (std::size_t j = row(brush.box.low.y); j <= row(brush.box.high.y); ++j)
            for (std::size_t i = column(brush.box.low.x); i <= column(brush.box.high.x); ++i) visit(j * side_ + i);
    };
    first_.assign(side_ * side_ + 1, 0);
    for (const Brush& brush : geometry.brushes) for_each_bin(brush, [&](std::size_t bin) { ++first_[bin + 1]; });
    for (std::size_t bin = 0; bin < side_ * side_; ++bin) first_[bin + 1] += first_[bin];
    brushes_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t b = 0; b < geometry.brushes.size(); ++b) for_each_bin(geometry.brushes[b], [&](std::size_t bin) { brushes_[next[bin]++] = b; });
}

std::size_t BrushBins::column(double x) const {
    return static_cast<std::size_t>(std::clamp(x / size_.x * static_cast<double>(side_), 0.0, static_cast<double>(side_ - 1)));
}

std::size_t BrushBins::row(double y) const {
    return static_cast<std::size_t>(std::clamp(y / size_.y * static_cast<double>(side_), 0.0, static_cast<double>(side_ - 1)));
}

bool BrushBins::is_first(std::size_t bin, std::uint32_t a, std::uint32_t b) const {
    const Box &p = geometry_.brushes[a].box, &q = geometry_.brushes[b].box;
    if (!reference::meet(p, q)) return false;
    return bin == row(std::max(p.low.y, q.low.y)) * side_ + column(std::max(p.low.x, q.low.x));
}

namespace {

struct Chord {
    Vec2 start, way;
    double low = -1e300, high = 1e300;
};

// The line where a plane has the height of another, of any length; false: none.
bool find_fold(const Plane& a, const Plane& b, Vec2 near, double fine, double extent, Chord& out) {
    const Vec2 g = a.g - b.g;
    const double steep = length(g);
    if (steep * extent <= fine) return false;
    const Vec2 n = g * (1.0 / steep);
    out = {near - n * ((a.at(near) - b.at(near)) / steep), normal_of(n)};
    return true;
}

void clip_chord(const LocalGeometry& geometry, reference::Polygon polygon, Chord& chord) {
    for (std::uint32_t i = 0; i < polygon.count && chord.low < chord.high; ++i) {
        const Vec2 a = geometry.plan(polygon, i), way = geometry.plan(polygon, i + 1 < polygon.count ? i + 1 : 0) - a;
        const double side = length(way);
        if (side == 0.0) continue;
        // Inside: at + by s >= 0, a little more so that folds along an edge are found from both sides.
        const double at = cross(way, chord.start - a) / side + geometry.fine, by = cross(way, chord.way) / side;
        if (std::abs(by) < 1e-12) {
            if (at < 0.0) chord.high = chord.low;
        } else if (by > 0.0) {
            chord.low = std::max(chord.low, -at / by);
        } else {
            chord.high = std::min(chord.high, -at / by);
        }
    }
}

// Surfaces of a brush: none to two.
struct Surfaces {
    const Plane* plane[2];
    int count = 0;
    explicit Surfaces(const Brush& brush) {
        if (brush.has_bottom) plane[count++] = &brush.bottom;
        if (brush.has_top) plane[count++] = &brush.top;
    }
};

struct EdgeFinder {
    const LocalGeometry& geometry;
    double level_tolerance;
    std::vector<PlanLine> lines;

    void add(const Chord& chord) {
        if (chord.high - chord.low <= geometry.fine) return;
        lines.push_back({chord.start + chord.way * chord.low, chord.start + chord.way * chord.high, kNoStep});
    }
    void add_borders(const Brush& brush) {
        for (std::uint32_t i = 0; i < brush.polygon.count; ++i)
            lines.push_back({geometry.plan(brush.polygon, i), geometry.plan(brush.polygon, i + 1 < brush.polygon.count ? i + 1 : 0), kNoStep});
    }
    void add_ground_folds(const Brush& brush) {
        const Surfaces surfaces(brush);
        for (int i = 0; i < surfaces.count; ++i) {
            Chord chord;
            if (!find_fold(*surfaces.plane[i], {{0, 0}, brush.level}, middle(brush.box), geometry.fine, extent(brush.box), chord)) continue;
            clip_chord(geometry, brush.polygon, chord);
            add(chord);
        }
    }
    void add_folds(const Brush& a, const Brush& b) {
        if (std::abs(a.level - b.level) > level_tolerance) return;
        const Box shared{{std::max(a.box.low.x, b.box.low.x), std::max(a.box.low.y, b.box.low.y)},
                         {std::min(a.box.high.x, b.box.high.x), std::min(a.box.high.y, b.box.high.y)}};
        const Surfaces of_a(a), of_b(b);
        for (int i = 0; i < of_a.count; ++i)
            for (int k = 0; k < of_b.count; ++k) {
                Chord chord;
                if (!find_fold(*of_a.plane[i], *of_b.plane[k], middle(shared), geometry.fine, extent(shared), chord)) continue;
                clip_chord(geometry, a.polygon, chord);
                clip_chord(geometry, b.polygon, chord);
                add(chord);
            }
    }
    static Vec2 middle(const Box& box) { return lerp(box.low, box.high, 0.5); }
    static double extent(const Box& box) { return length(box.high - box.low); }
};

}  // namespace

std::vector<PlanLine> find_edges(const LocalGeometry& geometry, const BrushBins& bins, double level_tolerance) {
    EdgeFinder finder{geometry, level_tolerance, {}};
    for (const Brush& brush : geometry.brushes) {
        finder.add_borders(brush);
        finder.add_ground_folds(brush);
    }
    bins.for_each_pair([&](std::uint32_t a, std::uint32_t b) { finder.add_folds(geometry.brushes[a], geometry.brushes[b]); });
    return std::move(finder.lines);
}

}  // namespace burin::mesh
