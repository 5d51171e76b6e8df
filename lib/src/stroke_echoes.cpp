#include "stroke_echoes.hpp"

#include <algorithm>
#include <cmath>

namespace burin::stroking {
namespace {

struct Corners {
    std::array<double, 3> share;
    bool inside() const { return share[0] > 0.0 && share[1] > 0.0 && share[2] > 0.0; }
};

Corners corners_of(const Triangle& t, Vec2 p) {
    const double area = cross(t.uv[1] - t.uv[0], t.uv[2] - t.uv[0]);
    const double b = cross(p - t.uv[0], t.uv[2] - t.uv[0]) / area, c = cross(t.uv[1] - t.uv[0], p - t.uv[0]) / area;
    return {{1.0 - b - c, b, c}};
}

Box box_of(const Triangle& t) {
    Box box;
    for (const Vec2 p : t.uv) box = {{std::min(box.low.x, p.x), std::min(box.low.y, p.y)}, {std::max(box.high.x, p.x), std::max(box.high.y, p.y)}};
    return box;
}

}  // namespace

// One tile is divided into cells; what lies in other tiles falls onto it.
EchoFinder::EchoFinder(const Surface& surface) : surface_(surface) {
    side_ = static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(surface.triangles().size())), 1.0, 2048.0));
    cells_.resize(side_ * side_);
    const Vec2 cell = surface.pattern_size() * (1.0 / static_cast<double>(side_));
    for (std::uint32_t i = 0; i < surface.triangles().size(); ++i) {
        if (!has_pattern(surface.triangles()[i])) continue;
        const Box box = box_of(surface.triangles()[i]);
        const auto count = [&](double low, double high, double size) {
            return static_cast<std::size_t>(std::clamp(std::floor(high / size) - std::floor(low / size) + 1.0, 1.0, static_cast<double>(side_)));
        };
        const std::size_t columns = count(box.low.x, box.high.x, cell.x), rows = count(box.low.y, box.high.y, cell.y);
        const std::size_t x0 = cell_of(box.low.x, surface.pattern_size().x), y0 = cell_of(box.low.y, surface.pattern_size().y);
        for (std::size_t y = 0; y < rows; ++y)
            for (std::size_t x = 0; x < columns; ++x) cells_[(y0 + y) % side_ * side_ + (x0 + x) % side_].push_back(i);
    }
}

std::size_t EchoFinder::cell_of(double x, double size) const {
    const double share = x / size - std::floor(x / size);
    return std::min(static_cast<std::size_t>(share * static_cast<double>(side_)), side_ - 1);
}

std::optional<Point3> EchoFinder::elsewhere(Vec2 p, Point3 here, double slack) const {
    const Vec2 size = surface_.pattern_size();
    for (const std::uint32_t i : cells_[cell_of(p.y, size.y) * side_ + cell_of(p.x, size.x)]) {
        const Triangle& t = surface_.triangles()[i];
        const Vec2 middle = (t.uv[0] + t.uv[1] + t.uv[2]) * (1.0 / 3.0);
        Vec2 image = p;
        if (surface_.repeats())
            image = p + Vec2{std::round((middle.x - p.x) / size.x) * size.x, std::round((middle.y - p.y) / size.y) * size.y};
        const Corners at = corners_of(t, image);
        if (!at.inside()) continue;
        const Point3 place = t.p[0] * at.share[0] + t.p[1] * at.share[1] + t.p[2] * at.share[2];
        if (length(place - here) > slack) return place;
    }
    return std::nullopt;
}

std::optional<Point3> EchoFinder::find(const Piece& piece, double width) const {
    for (std::size_t i = 0; i < piece.points.size(); i += 2)
        for (const double side : {-0.45, 0.0, 0.45}) {
            const PiecePoint& at = piece.points[i];
            const Vec2 p = at.p + unit(normal_of(at.along)) * (side * at.width);
            if (const auto place = elsewhere(p, at.place, width)) return place;
        }
    return std::nullopt;
}

}  // namespace burin::stroking
