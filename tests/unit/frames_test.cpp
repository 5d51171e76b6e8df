// Derivatives of meshes whose surface is known.
#include <burin/frames.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace burin {
namespace {

struct Mesh {
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint32_t> indices;
    SurfaceMesh view() const { return {positions, normals, uvs, indices}; }
    void add(std::array<double, 3> p, std::array<double, 3> n, double u, double v) {
        for (std::size_t k = 0; k < 3; ++k) {
            positions.push_back(float(p[k]));
            normals.push_back(float(n[k]));
        }
        uvs.insert(uvs.end(), {float(u), float(v)});
    }
};

void connect(Mesh& mesh, std::uint32_t columns, std::uint32_t rows) {
    for (std::uint32_t j = 0; j < rows; ++j)
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t a = j * (columns + 1) + i, d = a + columns + 1;
            for (const std::uint32_t corner : {a, a + 1, d + 1, a, d + 1, d}) mesh.indices.push_back(corner);
        }
}

// A part of a sphere of 2 m around the equator; u is the longitude and v the latitude, in units of `unit` radians.
Mesh sphere(double unit) {
    Mesh mesh;
    for (int j = 0; j <= 10; ++j)
        for (int i = 0; i <= 20; ++i) {
            const double a = 0.06 * i, b = 0.06 * (j - 2);
            const std::array<double, 3> n{std::cos(b) * std::sin(a), std::sin(b), std::cos(b) * std::cos(a)};
            mesh.add({2 * n[0], 2 * n[1], 2 * n[2]}, n, a / unit, b / unit);
        }
    connect(mesh, 20, 10);
    return mesh;
}

double dot(const std::array<float, 3>& a, const float* b) {
    return double(a[0]) * double(b[0]) + double(a[1]) * double(b[1]) + double(a[2]) * double(b[2]);
}

TEST(Frames, ASphereHasItsCurvatureAndStretch) {
    for (const double unit : {1.0, 0.05}) {
        const Mesh mesh = sphere(unit);
        const std::vector<SurfaceFrame> frames = compute_frames(mesh.view());
        ASSERT_EQ(frames.size(), mesh.positions.size() / 3);
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const SurfaceFrame& f = frames[i];
            const float* n = &mesh.normals[3 * i];
            const double latitude = double(mesh.uvs[2 * i + 1]) * unit, c = std::cos(latitude), first = 2 * unit,
                         second = 2 * unit * unit;
            EXPECT_NEAR(std::sqrt(dot(f.du, f.du.data())), c * first, 0.01 * first);
            EXPECT_NEAR(std::sqrt(dot(f.dv, f.dv.data())), first, 0.01 * first);
            EXPECT_NEAR(dot(f.du, n), 0.0, 1e-5 * first);
            EXPECT_NEAR(dot(f.duu, n), -c * c * second, 0.02 * second);
            EXPECT_NEAR(dot(f.duv, n), 0.0, 0.02 * second);
            EXPECT_NEAR(dot(f.dvv, n), -second, 0.02 * second);
            // Meridians draw together towards the pole: |du| changes along v by -2 sin(latitude).
            EXPECT_NEAR(dot(f.duv, f.du.data()) / (c * first), -std::sin(latitude) * second, 0.06 * second);
        }
    }
}

TEST(Frames, FlatFacesAndCreasesNeedNone) {
    Mesh box;
    for (int side = 0; side < 2; ++side)
        for (int k = 0; k < 4; ++k) {
            const double a = k % 2, b = k / 2;
            box.add(side == 0 ? std::array{a, 0.0, b} : std::array{a, b, 0.0},
                    side == 0 ? std::array{0.0, 1.0, 0.0} : std::array{0.0, 0.0, 1.0}, a, b);
        }
    box.indices = {0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6};
    EXPECT_TRUE(compute_frames(box.view()).empty());
    // The same with the normals of the edge between them: neighbours beyond 60 degrees say nothing.
    Mesh smooth = sphere(1.0);
    for (std::size_t i = 0; i + 2 < smooth.positions.size(); i += 3) smooth.positions[i + 2] = 0.0f;
    for (std::size_t i = 0; i + 2 < smooth.normals.size(); i += 3) {
        smooth.normals[i] = i % 2 == 0 ? 1.0f : 0.0f;
        smooth.normals[i + 1] = 0.0f;
        smooth.normals[i + 2] = i % 2 == 0 ? 0.0f : 1.0f;
    }
    for (const SurfaceFrame& frame : compute_frames(smooth.view()))
        for (const float value : frame.duu) EXPECT_TRUE(std::isfinite(value));
}

TEST(Frames, DegenerateMeshesStayFinite) {
    Mesh mesh;
    for (int k = 0; k < 5; ++k) mesh.add({0.1 * k, 0, 0}, {0, 1, 0}, 0.5, 0.5);
    mesh.indices = {0, 1, 2, 2, 3, 4, 0, 0, 0};
    for (const SurfaceFrame& frame : compute_frames(mesh.view()))
        for (const auto& v : {frame.du, frame.dv, frame.duu, frame.duv, frame.dvv})
            for (const float value : v) EXPECT_TRUE(std::isfinite(value));
    EXPECT_TRUE(compute_frames({}).empty());
}

}  // namespace
}  // namespace burin
