#include "meshes.hpp"

#include <cmath>
#include <numbers>

namespace burin::scenes {

constexpr double kTurn = 2.0 * std::numbers::pi;

Mesh make_sheet(int columns, int rows, const std::function<SurfacePoint3(double, double)>& at) {
    Mesh mesh;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const double u = double(i) / columns, v = double(j) / rows;
            const SurfacePoint3 point = at(u, v);
            for (const double x : point.position) mesh.positions.push_back(float(x));
            for (const double x : point.normal) mesh.normals.push_back(float(x));
            mesh.uvs.push_back(float(u));
            mesh.uvs.push_back(float(v));
        }
    const auto corner = [&](int i, int j) { return std::uint32_t(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            for (const std::uint32_t index : {corner(i, j), corner(i, j + 1), corner(i + 1, j), corner(i + 1, j),
                                              corner(i, j + 1), corner(i + 1, j + 1)})
                mesh.indices.push_back(index);
    return mesh;
}

Mesh make_quad(Vec3 corner, Vec3 across, Vec3 down, Vec2 tile) {
    const Vec3 n = {down[1] * across[2] - down[2] * across[1], down[2] * across[0] - down[0] * across[2],
                    down[0] * across[1] - down[1] * across[0]};
    const double long_n = std::hypot(n[0], n[1], n[2]);
    Mesh mesh = make_sheet(1, 1, [&](double u, double v) {
        SurfacePoint3 point;
        for (std::size_t i = 0; i < 3; ++i) {
            point.position[i] = corner[i] + u * across[i] + v * down[i];
            point.normal[i] = n[i] / long_n;
        }
        return point;
    });
    for (std::size_t i = 0; i < mesh.uvs.size(); i += 2) {
        mesh.uvs[i] *= float(std::hypot(across[0], across[1], across[2]) / tile.x);
        mesh.uvs[i + 1] *= float(std::hypot(down[0], down[1], down[2]) / tile.y);
    }
    return mesh;
}

Mesh make_sides(Vec3 low, Vec3 high, Vec2 tile) {
    const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    Mesh mesh = make_quad({low[0], high[1], high[2]}, {x, 0, 0}, {0, -y, 0}, tile);
    append(mesh, make_quad({high[0], high[1], high[2]}, {0, 0, -z}, {0, -y, 0}, tile));
    append(mesh, make_quad({high[0], high[1], low[2]}, {-x, 0, 0}, {0, -y, 0}, tile));
    append(mesh, make_quad({low[0], high[1], low[2]}, {0, 0, z}, {0, -y, 0}, tile));
    return mesh;
}

Mesh make_rectangle(Vec2 size) {
    return make_sheet(1, 1, [=](double u, double v) {
        return SurfacePoint3{{(u - 0.5) * size.x, 0.0, (v - 0.5) * size.y}, {0, 1, 0}};
    });
}

Mesh make_sphere(double radius, double cap) {
    return make_sheet(96, 64, [=](double u, double v) {
        const double around = u * kTurn, down = cap + v * (std::numbers::pi - 2.0 * cap);
        const std::array<double, 3> n = {std::sin(around) * std::sin(down), std::cos(down), std::cos(around) * std::sin(down)};
        return SurfacePoint3{{n[0] * radius, n[1] * radius, n[2] * radius}, n};
    });
}

Mesh make_column(double top, double bottom, double height, Vec2 repeat) {
    const double slope = (bottom - top) / height, scale = 1.0 / std::hypot(1.0, slope);
    Mesh mesh = make_sheet(64, 8, [=](double u, double v) {
        const double around = u * kTurn, radius = top + (bottom - top) * v;
        return SurfacePoint3{{std::sin(around) * radius, (0.5 - v) * height, std::cos(around) * radius},
                             {std::sin(around) * scale, slope * scale, std::cos(around) * scale}};
    });
    for (std::size_t i = 0; i < mesh.uvs.size(); i += 2) {
        mesh.uvs[i] *= float(repeat.x);
        mesh.uvs[i + 1] *= float(repeat.y);
    }
    return mesh;
}

Mesh make_ring(double inner, double outer, double bend, double tiles_around) {
    Mesh mesh = make_sheet(128, 12, [=](double u, double v) {
        const double around = u * kTurn, radius = inner + (outer - inner) * v;
        // A parabola across the ring: level in the middle, `bend` lower at both rims.
        const double across = 2.0 * v - 1.0, lean = 4.0 * bend * across / (outer - inner);
        const double scale = 1.0 / std::hypot(1.0, lean);
        return SurfacePoint3{{std::sin(around) * radius, -bend * across * across, std::cos(around) * radius},
                             {std::sin(around) * lean * scale, scale, std::cos(around) * lean * scale}};
    });
    for (std::size_t i = 0; i < mesh.uvs.size(); i += 2) mesh.uvs[i] *= float(tiles_around);
    return mesh;
}

Mesh placed(Mesh mesh, double degrees, std::array<double, 3> by) {
    const double c = std::cos(degrees * kTurn / 360.0), s = std::sin(degrees * kTurn / 360.0);
    const auto turn = [&](float* p) {
        const double x = double(p[0]), z = double(p[2]);
        p[0] = float(c * x + s * z);
        p[2] = float(c * z - s * x);
    };
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
        turn(&mesh.positions[i]);
        turn(&mesh.normals[i]);
        for (std::size_t k = 0; k < 3; ++k) mesh.positions[i + k] += float(by[k]);
    }
    return mesh;
}

void append(Mesh& to, const Mesh& mesh) {
    const std::uint32_t base = std::uint32_t(to.positions.size() / 3);
    to.positions.insert(to.positions.end(), mesh.positions.begin(), mesh.positions.end());
    to.normals.insert(to.normals.end(), mesh.normals.begin(), mesh.normals.end());
    to.uvs.insert(to.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
    for (const std::uint32_t index : mesh.indices) to.indices.push_back(base + index);
}

}  // namespace burin::scenes
