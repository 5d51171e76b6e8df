#include "surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace burin::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Normal of a surface x = f(uv) by differences; `outwards` tells its side.
SurfacePosition with_normal(const std::function<Vec3(Vec2)>& f, Vec2 uv, double side) {
    const double e = 1e-5;
    const Vec3 du = f({uv.x + e, uv.y}) - f({uv.x - e, uv.y}), dv = f({uv.x, uv.y + e}) - f({uv.x, uv.y - e});
    return {f(uv), normalized(cross(du, dv)) * side};
}

RoundSurface ellipsoid(const std::string& name, Vec3 radii, double detail) {
    RoundSurface s{name, {25, 12}, int(192 * detail), int(96 * detail), {}, {0.05, 0.15}, {0.95, 0.85}};
    s.at = [radii, span = s.span](Vec2 uv) {
        const double a = 2.0 * kPi * uv.x / span.x, b = kPi * uv.y / span.y;
        const Vec3 p{std::sin(b) * std::sin(a), std::cos(b), std::sin(b) * std::cos(a)};
        return SurfacePosition{{p[0] * radii[0], p[1] * radii[1], p[2] * radii[2]},
                               normalized({p[0] / radii[0], p[1] / radii[1], p[2] / radii[2]})};
    };
    return s;
}

RoundSurface cylinder(double detail) {
    RoundSurface s{"cylinder", {12, 6}, int(96 * detail), int(24 * detail), {}};
    s.at = [span = s.span](Vec2 uv) {
        const double a = 2.0 * kPi * uv.x / span.x;
        const Vec3 n{std::sin(a), 0, std::cos(a)};
        return SurfacePosition{{n[0] * 0.5, 0.75 - 0.25 * uv.y, n[2] * 0.5}, n};
    };
    return s;
}

// Seen from inside: everything is nearer below than above.
RoundSurface bowl(double detail) {
    RoundSurface s = ellipsoid("inside of a sphere", {1, 1, 1}, detail);
    s.at = [outside = s.at](Vec2 uv) {
        SurfacePosition p = outside(uv);
        return SurfacePosition{p.position, p.normal * -1.0};
    };
    return s;
}

RoundSurface torus(double detail) {
    RoundSurface s{"torus", {25, 9}, int(192 * detail), int(72 * detail), {}};
    const auto place = [span = s.span](Vec2 uv) {
        const double a = 2.0 * kPi * uv.x / span.x, b = -2.0 * kPi * uv.y / span.y, ring = 1.0 + 0.36 * std::cos(b);
        return Vec3{ring * std::sin(a), 0.36 * std::sin(b), ring * std::cos(a)};
    };
    s.at = [place](Vec2 uv) { return with_normal(place, uv, -1.0); };
    return s;
}

// A box with two rounded sides, unrolled: flat, a quarter of a cylinder of 0.15 m, flat, and so on.
RoundSurface bevelled_box(double detail) {
    RoundSurface s{"bevelled box", {16, 4}, int(256 * detail), int(16 * detail), {}};
    s.at = [span = s.span](Vec2 uv) {
        const double round = 0.15, half = 0.5, arc = kPi / 2 * round, side = 2 * half + arc;
        const double at = uv.x / span.x * 4.0;
        const int quarter = int(std::floor(at));
        const double way = (at - quarter) * side, bend = std::max(way - 2 * half, 0.0) / round;
        const double x = way < 2 * half ? way - half : half + round * std::sin(bend);
        const double z = half + round * std::cos(bend);
        const double turn = quarter * kPi / 2, c = std::cos(turn), sn = std::sin(turn);
        const Vec3 n{std::sin(bend), 0, std::cos(bend)};
        return SurfacePosition{{x * c + z * sn, 0.5 - 0.25 * uv.y, z * c - x * sn}, {n[0] * c + n[2] * sn, 0, n[2] * c - n[0] * sn}};
    };
    return s;
}

// A flat sheet whose uvs are stretched unevenly and skewed.
RoundSurface stretched_sheet(double detail) {
    RoundSurface s{"stretched sheet", {6, 6}, int(96 * detail), int(96 * detail), {}};
    s.at = [](Vec2 uv) {
        const double x = 0.25 * uv.x + 0.03 * std::sin(uv.x) + 0.08 * uv.y, z = 0.25 * uv.y + 0.02 * std::sin(1.3 * uv.y + 0.4 * uv.x);
        return SurfacePosition{{x, 0, z}, {0, 1, 0}};
    };
    return s;
}

// A cell of one tile over which the drop is linear, with the drop at its corners.
struct Cell {
    Vec2 low, high;
    double drop[4];  // at low, (high.x, low.y), high, (low.x, high.y)
};

class Divider {
  public:
    Divider(const std::function<double(Vec2)>& drop, double tolerance) : drop_(drop), tolerance_(tolerance) {}
    void add(Vec2 low, Vec2 high, int levels) {
        const Vec2 middle = (low + high) * 0.5;
        if (levels == 0 || is_linear(low, high)) {
            cells.push_back({low, high, {drop_(low), drop_({high.x, low.y}), drop_(high), drop_({low.x, high.y})}});
            return;
        }
        add(low, middle, levels - 1);
        add({middle.x, low.y}, {high.x, middle.y}, levels - 1);
        add({low.x, middle.y}, {middle.x, high.y}, levels - 1);
        add(middle, high, levels - 1);
    }
    std::vector<Cell> cells;

  private:
    bool is_linear(Vec2 low, Vec2 high) const {
        double d[5][5];
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 5; ++i) d[j][i] = drop_({low.x + (high.x - low.x) * i / 4, low.y + (high.y - low.y) * j / 4});
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 5; ++i) {
                const double x = i / 4.0, y = j / 4.0;
                const double flat = (1 - y) * ((1 - x) * d[0][0] + x * d[0][4]) + y * ((1 - x) * d[4][0] + x * d[4][4]);
                if (std::abs(d[j][i] - flat) > tolerance_) return false;
            }
        return true;
    }
    const std::function<double(Vec2)>& drop_;
    double tolerance_;
};

void add_cell(const RoundSurface& surface, const Cell& cell, Vec2 tile, Triangles& out) {
    const Vec2 corners[4] = {cell.low, {cell.high.x, cell.low.y}, cell.high, {cell.low.x, cell.high.y}};
    const std::uint32_t a = std::uint32_t(out.positions.size() / 3);
    for (int k = 0; k < 4; ++k) {
        const SurfacePosition at = surface.at(corners[k] + tile);
        const Vec3 p = at.position - at.normal * cell.drop[k];
        for (const double value : p) out.positions.push_back(float(value));
    }
    out.indices.insert(out.indices.end(), {a, a + 1, a + 2, a, a + 2, a + 3});
}

}  // namespace

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3 normalized(const Vec3& a) { return a * (1.0 / std::sqrt(dot(a, a))); }

std::vector<RoundSurface> round_surfaces(double detail) {
    return {cylinder(detail), ellipsoid("sphere", {1, 1, 1}, detail), ellipsoid("stretched sphere", {1.4, 1, 0.8}, detail),
            bowl(detail), torus(detail), bevelled_box(detail), stretched_sheet(detail)};
}

BaseMesh mesh_of(const RoundSurface& surface) {
    BaseMesh mesh;
    for (int j = 0; j <= surface.rows; ++j)
        for (int i = 0; i <= surface.columns; ++i) {
            const Vec2 uv{surface.span.x * i / surface.columns, surface.span.y * j / surface.rows};
            const SurfacePosition at = surface.at(uv);
            for (std::size_t k = 0; k < 3; ++k) {
                mesh.positions.push_back(float(at.position[k]));
                mesh.normals.push_back(float(at.normal[k]));
            }
            mesh.uvs.insert(mesh.uvs.end(), {float(uv.x), float(uv.y)});
        }
    const auto at = [&](int i, int j) { return std::uint32_t(j * (surface.columns + 1) + i); };
    for (int j = 0; j < surface.rows; ++j)
        for (int i = 0; i < surface.columns; ++i)
            mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    mesh.frames = compute_frames({mesh.positions, mesh.normals, mesh.uvs, mesh.indices});
    return mesh;
}

SurfacePlace place_on(const BaseMesh& mesh, std::size_t triangle, double b, double c, const std::vector<std::uint32_t>* charts) {
    SurfacePlace place;
    place.normal = {0, 0, 0};
    const double weights[3] = {1.0 - b - c, b, c};
    Vec2 uv[3];
    Vec3 p[3];
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t i = mesh.indices[3 * triangle + k];
        const auto add = [&](Vec3& sum, const float* v) { sum = sum + Vec3{double(v[0]), double(v[1]), double(v[2])} * weights[k]; };
        uv[k] = {double(mesh.uvs[2 * i]), double(mesh.uvs[2 * i + 1])};
        p[k] = {double(mesh.positions[3 * i]), double(mesh.positions[3 * i + 1]), double(mesh.positions[3 * i + 2])};
        place.uv = place.uv + uv[k] * weights[k];
        add(place.normal, &mesh.normals[3 * i]);
        if (mesh.frames.empty()) continue;
        const SurfaceFrame& f = mesh.frames[i];
        add(place.du, f.du.data()), add(place.dv, f.dv.data());
        add(place.duu, f.duu.data()), add(place.duv, f.duv.data()), add(place.dvv, f.dvv.data());
    }
    place.normal = normalized(place.normal);
    const Vec2 u = uv[1] - uv[0], v = uv[2] - uv[0];
    const double area = u.x * v.y - u.y * v.x;
    if (mesh.frames.empty()) {
        place.du = ((p[1] - p[0]) * v.y - (p[2] - p[0]) * u.y) * (1 / area);
        place.dv = ((p[2] - p[0]) * u.x - (p[1] - p[0]) * v.x) * (1 / area);
    }
    place.du = place.du - place.normal * dot(place.du, place.normal);
    place.dv = place.dv - place.normal * dot(place.dv, place.normal);
    if (charts != nullptr) place.chart = 2 * (*charts)[mesh.indices[3 * triangle]] + (area < 0 ? 1 : 0);
    return place;
}

RoundSurface faceted(const RoundSurface& surface) {
    RoundSurface flat = surface;
    flat.at = [surface](Vec2 uv) {
        const double x = uv.x / surface.span.x * surface.columns, y = uv.y / surface.span.y * surface.rows;
        const double i = std::clamp(std::floor(x), 0.0, surface.columns - 1.0), j = std::clamp(std::floor(y), 0.0, surface.rows - 1.0);
        const auto corner = [&](double a, double b) { return surface.at({surface.span.x * (i + a) / surface.columns, surface.span.y * (j + b) / surface.rows}); };
        // The diagonal leads from the first corner to the last: as mesh_of cuts.
        const double u = x - i, v = y - j;
        const SurfacePosition first = corner(0, 0), last = corner(1, 1), third = u > v ? corner(1, 0) : corner(0, 1);
        const double b = std::min(u, v), c = std::abs(u - v);
        return SurfacePosition{first.position * (1 - b - c) + last.position * b + third.position * c,
                               normalized(first.normal * (1 - b - c) + last.normal * b + third.normal * c)};
    };
    return flat;
}

Triangles displace(const RoundSurface& surface, const std::function<double(Vec2)>& drop, double tolerance, int levels) {
    Divider tile(drop, tolerance);
    constexpr int kCells = 16;
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i)
            tile.add({double(i) / kCells, double(j) / kCells}, {double(i + 1) / kCells, double(j + 1) / kCells}, levels);
    Triangles out;
    for (int v = 0; v < int(surface.span.y); ++v)
        for (int u = 0; u < int(surface.span.x); ++u)
            for (const Cell& cell : tile.cells) add_cell(surface, cell, {double(u), double(v)}, out);
    return out;
}

}  // namespace burin::testing
