// Triangles of a pattern: watertight, where the truth is, and the same for any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <burin/evaluate.hpp>
#include <burin/grid.hpp>
#include <mesh/body.hpp>
#include <scenes/scenes.hpp>

#include "../property/random_pattern.hpp"
#include "../render/part_asset.hpp"
#include "../shader/embree_scene.hpp"

namespace burin::testing {
namespace {

using mesh::mesh_pattern;
using mesh::MeshOptions;
using mesh::TriangleMesh;

TriangleMesh mesh_of(const ResolvedPattern& pattern, const MeshOptions& options) {
    const auto grid = build_grid(pattern);
    EXPECT_TRUE(grid) << grid.error().message;
    auto made = mesh_pattern(pattern, *grid, options);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
}

ResolvedPattern scene_pattern(const char* name) { return *resolve_pattern(scenes::find_scene(name)->make().parts.at(0).pattern); }

EmbreeScene traced(const TriangleMesh& made) {
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
    for (const reference::Vec3& p : made.positions)
        for (const double v : {p.x, p.y, p.z}) positions.push_back(float(v));
    for (const auto& t : made.triangles) indices.insert(indices.end(), t.begin(), t.end());
    return EmbreeScene(positions, indices);
}

struct Outcome {
    int rays = 0, off = 0;
    double mean = 0.0;  // metres along the ray, of those that are not off
    int other = 0;      // of those, on what is of another style: another material, perhaps
};

std::uint32_t style_of(const ResolvedPattern& pattern, std::uint32_t element) {
    return element < pattern.elements.size() ? pattern.elements[element].style : kGround;
}

// Rays from the object surface down, at 10 to 90 degrees, that meet the map itself. Off: by more than what a bent path moves a wall that the
// ray passes.
Outcome compare_rays(const ResolvedPattern& pattern, const TriangleMesh& made, int count, std::uint64_t seed) {
    const Truth truth(pattern);
    const EmbreeScene scene = traced(made);
    Random random(seed);
    Outcome outcome;
    for (int i = 0; i < count; ++i) {
        const Vec2 at{random.between(0.02, 0.98) * pattern.size.x, random.between(0.02, 0.98) * pattern.size.y}, way = random.direction();
        const double slope = 1.0 / std::tan(random.between(10.0, 90.0) * std::numbers::pi / 180.0), run = std::hypot(1.0, slope);
        Ray ray{{at.x, at.y, pattern.base_offset + 1e-5 * pattern.depth}, {way.x * slope, way.y * slope, -1.0}};
        const RayHit right = truth.trace_ray(ray);
        const auto inside = [](double p, double side) { return p > 1e-3 * side && p < (1.0 - 1e-3) * side; };
        if (!right.hit || !inside(right.position[0], pattern.size.x) || !inside(right.position[1], pattern.size.y)) continue;
        const EmbreeHit hit = scene.trace({ray.origin[0], ray.origin[1], ray.origin[2]}, {ray.direction[0], ray.direction[1], ray.direction[2]}, 0.0);
        const double off = std::abs(hit.distance - right.t) * run;
        ++outcome.rays;
        if (off > 16.0 * made.tolerance + 1e-5 * std::max(pattern.size.x, pattern.size.y)) ++outcome.off;
        else outcome.mean += off, outcome.other += style_of(pattern, made.origins[hit.triangle].element) != style_of(pattern, right.element);
    }
    outcome.mean /= std::max(1, outcome.rays - outcome.off);
    return outcome;
}

class EachScene : public ::testing::TestWithParam<const char*> {};

TEST_P(EachScene, IsASolidWhereTheTruthIs) {
    const ResolvedPattern pattern = scene_pattern(GetParam());
    MeshOptions options;
    options.closed = true;
    const TriangleMesh made = mesh_of(pattern, options);
    EXPECT_EQ(mesh::count_open_edges(made), 0u);
    const Outcome outcome = compare_rays(pattern, made, 4000, 7);
    EXPECT_GE(outcome.rays, 3500);
    // A ray beside an edge may meet the other side of it.
    EXPECT_LE(outcome.off, 4);
    EXPECT_LE(outcome.mean, made.tolerance);
    EXPECT_LE(outcome.other, 2);
}

INSTANTIATE_TEST_SUITE_P(Scenes, EachScene,
                         ::testing::Values("parallel_grooves", "crossing", "crossing_protruding", "intersected_end", "isolated_end", "corner", "sunken_square",
                                           "overhang", "letters", "carved_cube", "tapered_cracks", "vinyl_three_profiles"),
                         [](const auto& one) { return std::string(one.param); });

// Steps, curves, caps, joins, scales, near-parallel and tangent lines: whatever a pattern can hold.
TEST(RandomPatterns, AreSolidsWhereTheTruthIs) {
    int rays = 0, off = 0, other = 0;
    for (std::uint64_t seed = 1; seed <= 24; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomPatternOptions options;
        options.wrap = seed % 3 == 0 ? Wrap::clamp : Wrap::repeat;
        const auto pattern = resolve_pattern(random_pattern(seed, options));
        if (!pattern) continue;
        MeshOptions how;
        how.closed = true;
        how.tolerance = 1e-5;
        const TriangleMesh made = mesh_of(*pattern, how);
        EXPECT_EQ(mesh::count_open_edges(made), 0u);
        const Outcome outcome = compare_rays(*pattern, made, 500, seed);
        rays += outcome.rays, off += outcome.off, other += outcome.other;
        EXPECT_LE(outcome.off, outcome.rays / 100);
    }
    EXPECT_GE(rays, 6000);
    EXPECT_LE(off, rays / 1000) << rays << " rays";
    EXPECT_LE(other, rays / 1000) << rays << " rays";
}

double volume_of(const TriangleMesh& made) {
    double six = 0.0;
    for (const auto& t : made.triangles) six += dot(made.positions[t[0]], cross(made.positions[t[1]], made.positions[t[2]]));
    return six / 6.0;
}

TEST(Tile, HasTheVolumeOfItsCrossSection) {
    Pattern pattern;
    pattern.size = {0.2, 0.1};
    pattern.depth = 0.004;
    pattern.profiles = {{{{-0.01, 0.0}, {-0.004, -0.004}, {0.004, -0.004}, {0.01, 0.0}}, {}}};
    pattern.materials.resize(1);
    Path path;
    path.elements = {make_line({0.0, 0.05}, {0.1, 0.05}), make_line({0.1, 0.05}, {0.2, 0.05})};
    path.closed = true;
    pattern.paths = {path};
    const auto resolved = resolve_pattern(pattern);
    ASSERT_TRUE(resolved) << resolved.error().message;
    MeshOptions options;
    options.closed = true;
    options.base = 0.003;
    const TriangleMesh made = mesh_of(*resolved, options);
    EXPECT_NEAR(volume_of(made), 0.2 * (0.1 * 0.007 - 0.004 * 0.5 * (0.02 + 0.008)), 1e-12);
    EXPECT_DOUBLE_EQ(made.lowest, -0.004);
}

TEST(Tile, IsTheSameForAnyNumberOfThreads) {
    const ResolvedPattern pattern = scene_pattern("letters");
    MeshOptions options;
    options.threads = 1;
    const TriangleMesh one = mesh_of(pattern, options);
    options.threads = 5;
    const TriangleMesh five = mesh_of(pattern, options);
    EXPECT_EQ(one.triangles, five.triangles);
    ASSERT_EQ(one.positions.size(), five.positions.size());
    for (std::size_t i = 0; i < one.positions.size(); ++i) EXPECT_EQ(one.positions[i].z, five.positions[i].z);
}

TEST(Tile, ComesNearerWithASmallerTolerance) {
    const ResolvedPattern pattern = scene_pattern("overhang");
    double before = 1e9;
    for (const double tolerance : {1e-4, 1e-5, 1e-6}) {
        MeshOptions options;
        options.tolerance = tolerance;
        const double mean = compare_rays(pattern, mesh_of(pattern, options), 2000, 3).mean;
        EXPECT_LT(mean, 0.5 * before);
        before = mean;
    }
}

TEST(Tile, RefusesWhatMakesNoSense) {
    const ResolvedPattern pattern = scene_pattern("crossing");
    const auto grid = build_grid(pattern);
    MeshOptions options;
    options.tolerance = 1.0;
    const auto coarse = mesh_pattern(pattern, *grid, options);
    ASSERT_FALSE(coarse);
    EXPECT_NE(coarse.error().message.find("tolerance 1 m"), std::string::npos) << coarse.error().message;
    options.tolerance = 0.0;
    options.base = -1.0;
    const auto sunk = mesh_pattern(pattern, *grid, options);
    ASSERT_FALSE(sunk);
    EXPECT_NE(sunk.error().message.find("base -1 m"), std::string::npos) << sunk.error().message;
}

// Every corner lies on the tile's own surface, wrapped around the ball.
TEST(Body, BearsTheReliefOfItsTile) {
    const scenes::Part part = scenes::find_scene("grooved_sphere")->make().parts.at(0);
    const Asset asset = asset_of(part);
    const ResolvedPattern pattern = *resolve_pattern(part.pattern);
    const TriangleMesh tile = mesh_of(pattern, {});
    const auto body = mesh::mesh_body(tile, pattern, asset.primitives.at(0));
    ASSERT_TRUE(body) << body.error().message;
    const Truth truth(pattern);
    const auto length_at = [](const std::vector<float>& v, std::size_t i) { return std::hypot(double(v[3 * i]), double(v[3 * i + 1]), double(v[3 * i + 2])); };
    double radius = 0.0, lowest = 1e9, highest = 0.0;
    for (std::size_t i = 0; i < part.mesh.positions.size() / 3; ++i) radius = std::max(radius, length_at(part.mesh.positions, i));
    for (std::size_t i = 0; i < body->positions.size() / 3; ++i) {
        lowest = std::min(lowest, length_at(body->positions, i));
        highest = std::max(highest, length_at(body->positions, i));
        EXPECT_NEAR(length_at(body->normals, i), 1.0, 1e-5);
    }
    EXPECT_LE(highest, radius * (1.0 + 1e-6));
    // The ball's own mesh is cut off a little between its corners.
    EXPECT_NEAR(lowest, radius - (pattern.base_offset - tile.lowest), 0.01 * radius);
    EXPECT_GE(lowest, 0.99 * (radius - (pattern.base_offset - tile.lowest)));
}

TEST(Body, IsTheTileItselfOnAPlane) {
    const scenes::Part part = scenes::find_scene("overhang")->make().parts.at(0);
    const Asset asset = asset_of(part);
    const ResolvedPattern pattern = *resolve_pattern(part.pattern);
    const TriangleMesh tile = mesh_of(pattern, {});
    const auto body = mesh::mesh_body(tile, pattern, asset.primitives.at(0));
    ASSERT_TRUE(body) << body.error().message;
    double area = 0.0, other = 0.0;
    const auto half = [](const reference::Vec3& a, const reference::Vec3& b, const reference::Vec3& c) {
        const reference::Vec3 n = cross(b - a, c - a);
        return 0.5 * std::sqrt(dot(n, n));
    };
    for (const auto& t : tile.triangles) area += half(tile.positions[t[0]], tile.positions[t[1]], tile.positions[t[2]]);
    const auto corner = [&](std::size_t i) {
        const std::size_t v = 3 * body->indices[i];
        return reference::Vec3{body->positions[v], body->positions[v + 1], body->positions[v + 2]};
    };
    for (std::size_t i = 0; i + 2 < body->indices.size(); i += 3) other += half(corner(i), corner(i + 1), corner(i + 2));
    EXPECT_NEAR(other, area, 1e-5 * area);
}

}  // namespace
}  // namespace burin::testing
