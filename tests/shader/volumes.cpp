#include "volumes.hpp"

#include <cmath>

namespace burin::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

// How a chart lies in the uv plane: turned, perhaps mirrored, moved.
std::function<Vec2(Vec2)> laid(double degrees, bool mirrored, Vec2 moved, Vec2 size) {
    const double c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
    return [=](Vec2 st) {
        const Vec2 p{st.x * size.x * (mirrored ? -1.0 : 1.0), st.y * size.y};
        return Vec2{c * p.x - s * p.y, s * p.x + c * p.y} + moved;
    };
}

// Two sheets of half a metre that meet at x = 0; the second one leads down by `degrees`.
Body fold(const std::string& name, double degrees, double unit) {
    const double c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
    const Vec2 size{0.5 / unit, 1.0 / unit};
    Body body{name, {}, {}, degrees != 0.0};
    body.patches.push_back({5, 7, [](Vec2 st) { return SurfacePosition{{0.5 * st.x - 0.5, 0, st.y - 0.5}, {0, 1, 0}}; }, laid(0, false, {}, size)});
    body.patches.push_back({5, 7, [=](Vec2 st) { return SurfacePosition{{0.5 * st.x * c, -0.5 * st.x * s, st.y - 0.5}, {s, c, 0}}; },
                            laid(37, true, {1.31, -0.42}, size)});
    body.locate = [=](const Vec3& p) {
        const bool first = p[0] * (1 + c) - p[1] * s < 0;
        const double along = first ? p[0] + 0.5 : p[0] * c - p[1] * s, drop = first ? -p[1] : -(p[0] * s + p[1] * c);
        return BodyPlace{first ? 0u : 1u, {along * 2, p[2] + 0.5}, drop};
    };
    return body;
}

struct Side {
    Vec3 x, y, normal;
};

const std::vector<Side>& box_sides() {
    static const std::vector<Side> sides = [] {
        std::vector<Side> all;
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const double sign : {1.0, -1.0}) {
                Vec3 n{}, x{};
                n[axis] = sign;
                x[(axis + 1) % 3] = 1.0;
                all.push_back({x, cross(x, n), n});  // x right and y down as seen from outside
            }
        return all;
    }();
    return sides;
}

std::size_t side_above(const Vec3& p) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < 6; ++i)
        if (dot(p, box_sides()[i].normal) > dot(p, box_sides()[best].normal)) best = i;
    return best;
}

std::function<Vec2(Vec2)> box_layout(std::size_t i, double size) {
    return laid(90.0 * double(i % 4) + 11.0 * double(i), i % 3 == 1, {0.37 * double(i), 5.21 * double(i)}, {size, size});
}

Body cube(double unit) {
    Body body{"cube", {}, {}, true};
    for (std::size_t i = 0; i < 6; ++i)
        body.patches.push_back({4, 4, [side = box_sides()[i]](Vec2 st) {
                                    return SurfacePosition{side.x * (st.x - 0.5) + side.y * (st.y - 0.5) + side.normal * 0.5, side.normal};
                                }, box_layout(i, 1.0 / unit)});
    body.locate = [](const Vec3& p) {
        const std::size_t i = side_above(p);
        const Side& side = box_sides()[i];
        return BodyPlace{i, {dot(p, side.x) + 0.5, dot(p, side.y) + 0.5}, 0.5 - dot(p, side.normal)};
    };
    return body;
}

// Each of six charts a grid of equal angles.
Body sphere(double unit) {
    Body body{"sphere of six charts", {}, {}, false};
    constexpr double kRadius = 0.6;
    for (std::size_t i = 0; i < 6; ++i)
        body.patches.push_back({96, 96, [side = box_sides()[i]](Vec2 st) {
                                    const double x = std::tan((st.x - 0.5) * kPi / 2), y = std::tan((st.y - 0.5) * kPi / 2);
                                    const Vec3 n = normalized(side.x * x + side.y * y + side.normal);
                                    return SurfacePosition{n * kRadius, n};
                                }, box_layout(i, kRadius * kPi / 2 / unit)});
    body.locate = [](const Vec3& p) {
        const std::size_t i = side_above(p);
        const Side& side = box_sides()[i];
        const double up = dot(p, side.normal);
        const auto share = [&](double x) { return 0.5 + std::atan2(x, up) * 2 / kPi; };
        return BodyPlace{i, {share(dot(p, side.x)), share(dot(p, side.y))}, kRadius - std::sqrt(dot(p, p))};
    };
    return body;
}

// A side of one chart, whose uv closes by 12.5 tiles, and two lids.
Body drum(double unit) {
    Body body{"drum", {}, {}, true};
    constexpr double kRadius = 0.5, kHalf = 0.3;
    const auto ring = [](double s) { return Vec3{std::sin(2 * kPi * s), 0, std::cos(2 * kPi * s)}; };
    body.patches.push_back({512, 8, [=](Vec2 st) { return SurfacePosition{ring(st.x) * kRadius + Vec3{0, kHalf - 2 * kHalf * st.y, 0}, ring(st.x)}; },
                            laid(0, false, {}, {2 * kPi * kRadius / unit, 2 * kHalf / unit})});
    for (const double up : {1.0, -1.0})
        body.patches.push_back({512, 4, [=](Vec2 st) { return SurfacePosition{ring(st.x * up) * (kRadius * st.y) + Vec3{0, kHalf * up, 0}, {0, up, 0}}; },
                                [=](Vec2 st) {
                                    const Vec3 p = ring(st.x * up) * (kRadius * st.y / unit);
                                    return laid(23, up > 0, {0.3 * up, 9.0 * up}, {1, 1})({p[0], p[2]});
                                }});
    body.locate = [=](const Vec3& p) {
        const double r = std::hypot(p[0], p[2]), turn = std::atan2(p[0], p[2]) / (2 * kPi), up = p[1] < 0 ? -1.0 : 1.0;
        const double side_drop = kRadius - r, lid_drop = kHalf - std::abs(p[1]);
        if (side_drop < lid_drop) return BodyPlace{0, {turn - std::floor(turn), (kHalf - p[1]) / (2 * kHalf)}, side_drop};
        return BodyPlace{up > 0 ? 1u : 2u, {turn * up, r / kRadius}, lid_drop};
    };
    return body;
}

// One chart whose uv closes by 11.3 tiles around the ring and 4.5 around the tube.
Body ring(double unit) {
    Body body{"torus", {}, {}, false};
    constexpr double kRing = 0.45, kTube = 0.18;
    body.patches.push_back({512, 192, [](Vec2 st) {
                                const double a = 2 * kPi * st.x, b = -2 * kPi * st.y;
                                const Vec3 out{std::sin(a), 0, std::cos(a)}, n = out * std::cos(b) + Vec3{0, std::sin(b), 0};
                                return SurfacePosition{out * kRing + n * kTube, n};
                            }, laid(0, false, {}, {2 * kPi * kRing / unit, 2 * kPi * kTube / unit})});
    body.locate = [](const Vec3& p) {
        const double a = std::atan2(p[0], p[2]) / (2 * kPi), over = std::hypot(p[0], p[2]) - kRing, b = -std::atan2(p[1], over) / (2 * kPi);
        return BodyPlace{0, {a - std::floor(a), b - std::floor(b)}, kTube - std::hypot(over, p[1])};
    };
    return body;
}

}  // namespace

std::vector<Body> cut_bodies(double unit) {
    return {fold("sheet cut in two", 0, unit), fold("roof of 50 degrees", 50, unit), fold("valley of 50 degrees", -50, unit), cube(unit), drum(unit), sphere(unit), ring(unit)};
}

CutMesh mesh_of(const Body& body, const ChartOptions& options) {
    CutMesh mesh;
    for (const Patch& patch : body.patches) {
        const auto first = std::uint32_t(mesh.base.positions.size() / 3);
        for (int j = 0; j <= patch.rows; ++j)
            for (int i = 0; i <= patch.columns; ++i) {
                const Vec2 st{double(i) / patch.columns, double(j) / patch.rows}, uv = patch.uv(st);
                const SurfacePosition p = patch.at(st);
                for (std::size_t k = 0; k < 3; ++k) {
                    // Seams close exactly.
                    mesh.base.positions.push_back(float(std::round(p.position[k] * 1e7) * 1e-7));
                    mesh.base.normals.push_back(float(p.normal[k]));
                }
                mesh.base.uvs.insert(mesh.base.uvs.end(), {float(uv.x), float(uv.y)});
            }
        for (int j = 0; j < patch.rows; ++j)
            for (int i = 0; i < patch.columns; ++i) {
                const std::uint32_t a = first + std::uint32_t(j * (patch.columns + 1) + i), d = a + std::uint32_t(patch.columns) + 1;
                for (const std::uint32_t corner : {a, d, a + 1, a + 1, d, d + 1}) mesh.base.indices.push_back(corner);
            }
    }
    const SurfaceMesh view{mesh.base.positions, mesh.base.normals, mesh.base.uvs, mesh.base.indices};
    mesh.base.frames = compute_frames(view);
    mesh.set = find_charts(std::span(&view, 1), options);
    mesh.charts = mesh.set.charts[0];
    return mesh;
}

}  // namespace burin::testing
