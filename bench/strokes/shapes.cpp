#include "shapes.hpp"

#include <cassert>
#include <cmath>
#include <cstdio>

namespace burin::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;

Point3 on_sphere(Point3 d) { return unit(d) * 0.5; }

Point3 on_torus(double ring, double tube) {
    const double r = 0.35 + 0.15 * std::cos(tube);
    return {r * std::cos(ring), 0.15 * std::sin(tube), -r * std::sin(ring)};
}

}  // namespace

std::size_t Body::place(Point3 p) {
    char line[96];
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
    text_ += line;
    return ++places_;
}

// OBJ has v up.
std::size_t Body::uv(Vec2 t) {
    char line[64];
    std::snprintf(line, sizeof line, "vt %.9g %.9g\n", t.x, 1.0 - t.y);
    text_ += line;
    return ++uvs_;
}

void Body::triangle(std::array<std::size_t, 3> places, std::array<std::size_t, 3> uvs) {
    char line[128];
    std::snprintf(line, sizeof line, "f %zu/%zu %zu/%zu %zu/%zu\n", places[0], uvs[0], places[1], uvs[1], places[2], uvs[2]);
    text_ += line;
}

void Body::sheet(int columns, int rows, const std::function<Point3(double, double)>& at, const std::function<Vec2(double, double)>& lay) {
    const std::size_t p0 = places_ + 1, t0 = uvs_ + 1, wide = static_cast<std::size_t>(columns) + 1;
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x <= columns; ++x) {
            place(at(double(x) / columns, double(y) / rows));
            uv(lay(double(x) / columns, double(y) / rows));
        }
    for (std::size_t y = 0; y < std::size_t(rows); ++y)
        for (std::size_t x = 0; x < std::size_t(columns); ++x) {
            const std::size_t a = y * wide + x, b = a + 1, c = a + wide, d = c + 1;
            triangle({p0 + a, p0 + c, p0 + b}, {t0 + a, t0 + c, t0 + b});
            triangle({p0 + b, p0 + c, p0 + d}, {t0 + b, t0 + c, t0 + d});
        }
}

Model Body::model() const {
    const auto read = read_model_bytes({reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size()}, "");
    assert(read.ok());
    return *read;
}

Body latitude_sphere(int rows) {
    Body body;
    const double most = 80.0 / 180.0 * kPi;
    // sin and cos of the same number close the seam bit by bit.
    body.sheet(
        2 * rows, rows,
        [&](double u, double v) {
            const double around = u < 1.0 ? 2.0 * kPi * u : 0.0, up = most * (1.0 - 2.0 * v);
            return Point3{0.5 * std::cos(up) * std::cos(around), 0.5 * std::sin(up), -0.5 * std::cos(up) * std::sin(around)};
        },
        [](double u, double v) { return Vec2{u, v}; });
    return body;
}

Body cube_sphere(int rows, double stretch) {
    Body body;
    const Point3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double column = 0.0;
    const double total = 3.0 * stretch + 3.0;
    for (int face = 0; face < 6; ++face) {
        const Point3 out = axes[face / 2] * (face % 2 ? -1.0 : 1.0), right = axes[(face / 2 + 1) % 3] * (face % 2 ? -1.0 : 1.0), up = axes[(face / 2 + 2) % 3];
        const double wide = (face % 2 ? 1.0 : stretch) / total;
        body.sheet(
            rows, rows,
            [&](double x, double y) {
                const double a = std::tan((x - 0.5) * 0.5 * kPi), b = std::tan((0.5 - y) * 0.5 * kPi);
                // Corners and edges that faces share come out equal: the largest of the parts is 1, and rounded alike.
                const auto clean = [](double c) { return std::round(c * 1e9) / 1e9; };
                return on_sphere(out + right * clean(a) + up * clean(b));
            },
            [&](double x, double y) { return Vec2{column + wide * (0.06 + 0.88 * x), 0.03 + 0.94 * y / total * 2.0}; });
        column += wide;
    }
    return body;
}

Body torus(int tubes, int charts, double stretch) {
    Body body;
    const auto angle = [](double share) { return 2.0 * kPi * (share >= 1.0 ? share - 1.0 : share); };
    for (int chart = 0; chart < charts; ++chart)
        body.sheet(
            3 * tubes / charts, tubes, [&](double u, double v) { return on_torus(angle((chart + u) / charts), angle(1.0 - v)); },
            [&](double u, double v) {
                if (charts == 1) return Vec2{u * stretch, v};
                const double gap = chart % 2 ? 0.1 : 0.05;
                return Vec2{(chart + gap + (1.0 - 2.0 * gap) * u) / charts, chart % 2 ? 0.05 + 0.9 * v : 0.95 / stretch * v};
            });
    return body;
}

Body two_charts(int rows, double angle) {
    Body body;
    const double c = std::cos(angle), s = std::sin(angle);
    body.sheet(rows, rows, [](double x, double y) { return Point3{x - 1.0, 0.0, 2.0 * y - 1.0}; }, [](double x, double y) { return Vec2{0.05 + 0.2 * x, 0.05 + 0.4 * y}; });
    body.sheet(rows, rows, [](double x, double y) { return Point3{x, 0.0, 2.0 * y - 1.0}; },
               [&](double x, double y) { return Vec2{0.65 + 0.2 * (c * x - s * (2.0 * y - 1.0)), 0.5 + 0.2 * (s * x + c * (2.0 * y - 1.0))}; });
    return body;
}

Stroke circle_on_sphere(Point3 axis, double height, double begin, double turn, int points) {
    const Point3 a = unit(cross(axis, std::abs(axis.x) < 0.8 ? Point3{1, 0, 0} : Point3{0, 1, 0})), b = cross(axis, a);
    Stroke stroke{"circle", {}, turn >= 2.0 * kPi};
    const double radius = std::sqrt(0.25 - height * height);
    for (int i = 0; i < points; ++i) {
        const double at = begin + turn * i / (stroke.closed ? points : points - 1);
        stroke.points.push_back(axis * height + (a * std::cos(at) + b * std::sin(at)) * radius);
    }
    return stroke;
}

Stroke winding(double ring0, double tube0, double rounds, double winds, int points) {
    Stroke stroke{"winding", {}, false};
    for (int i = 0; i < points; ++i) {
        const double share = double(i) / (points - 1);
        stroke.points.push_back(on_torus(ring0 + 2.0 * kPi * rounds * share, tube0 + 2.0 * kPi * winds * share));
    }
    return stroke;
}

Point3 random_direction(std::mt19937& random) {
    const auto next = [&] { return double(random()) / 4294967296.0; };
    const double up = 2.0 * next() - 1.0, around = 2.0 * kPi * next(), flat = std::sqrt(1.0 - up * up);
    return {flat * std::cos(around), up, flat * std::sin(around)};
}

}  // namespace burin::bench
