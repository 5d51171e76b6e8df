// Rays over a real suit of armour, bent and cut into hundreds of charts: the decoder against Embree on the displaced mesh.
//
// The displaced mesh is what tessellation makes of the model: every point of a triangle moved along the interpolated normal,
// in pieces so small that the relief is straight over each. It gapes where the uvs are cut or the mesh has an edge; rays that end within the
// depth of such a border are counted apart (charts_test.cpp judges them on bodies that are known as volumes).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include <burin/charts.hpp>
#include <burin/image_io.hpp>
#include <burin/model.hpp>
#include <cpp/decode.hpp>
#include <scenes/drawing.hpp>
#include <scenes/scenes.hpp>

#include "embree_scene.hpp"
#include "rays.hpp"

namespace burin::testing {
namespace {

const char* const kArmour = BURIN_SHARED_DATA "/models/oga_knight_armor.gltf";
constexpr double kStem = 2 * 0.00125;  // width of the engraving's stems on its plate, metres

struct Setting {
    BaseMesh mesh;  // the whole model in world space
    ChartSet set;
    ChartTable table;
    PreparedPattern pattern;
    PathDetail detail;
    double width = 0.0;  // of a stem: the unit of all errors
    std::vector<std::array<Vec3, 2>> borders;
};

BaseMesh joined(const Asset& asset) {
    BaseMesh mesh;
    for (const Primitive& p : asset.primitives) {
        const auto first = std::uint32_t(mesh.positions.size() / 3);
        mesh.positions.insert(mesh.positions.end(), p.positions.begin(), p.positions.end());
        mesh.normals.insert(mesh.normals.end(), p.normals.begin(), p.normals.end());
        mesh.uvs.insert(mesh.uvs.end(), p.uvs.begin(), p.uvs.end());
        for (const std::uint32_t i : p.indices) mesh.indices.push_back(first + i);
    }
    mesh.frames = compute_frames({mesh.positions, mesh.normals, mesh.uvs, mesh.indices});
    return mesh;
}

Vec3 read3(const std::vector<float>& values, std::uint32_t i) {
    return {double(values[3 * i]), double(values[3 * i + 1]), double(values[3 * i + 2])};
}
Vec2 read_uv(const BaseMesh& mesh, std::uint32_t i) { return {double(mesh.uvs[2 * i]), double(mesh.uvs[2 * i + 1])}; }
double far(const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); }

double area_of(const BaseMesh& mesh, std::size_t triangle) {
    const std::uint32_t* i = &mesh.indices[3 * triangle];
    const Vec3 n = cross(read3(mesh.positions, i[1]) - read3(mesh.positions, i[0]), read3(mesh.positions, i[2]) - read3(mesh.positions, i[0]));
    return 0.5 * std::sqrt(dot(n, n));
}

// Edges of triangles that are borders, found by the middles of their uvs.
std::vector<std::array<Vec3, 2>> find_borders(const BaseMesh& mesh, const ChartSet& set, Vec2 size) {
    const auto key = [](Vec2 p) { return std::array{std::llround(p.x * 1e6), std::llround(p.y * 1e6)}; };
    std::vector<std::array<long long, 2>> middles;
    for (const ChartBorder& b : set.borders) middles.push_back(key((b.begin + b.end) * 0.5));
    std::sort(middles.begin(), middles.end());
    std::vector<std::array<Vec3, 2>> edges;
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.indices[t + k], b = mesh.indices[t + (k + 1) % 3];
            const Vec2 middle = (read_uv(mesh, a) + read_uv(mesh, b)) * 0.5;
            if (std::binary_search(middles.begin(), middles.end(), key({middle.x * size.x, middle.y * size.y})))
                edges.push_back({read3(mesh.positions, a), read3(mesh.positions, b)});
        }
    return edges;
}

Setting prepare_setting(const Asset& asset, Vec2 metres_per_uv) {
    Setting s;
    s.mesh = joined(asset);
    const Pattern plate = scenes::find_scene("engraved_armour")->make().parts.front().pattern;
    const Pattern engraving = scenes::enlarged_to(plate, metres_per_uv);
    s.width = kStem * engraving.size.x / plate.size.x;
    s.pattern = prepare(engraving);
    s.detail = s.pattern.detail;
    const SurfaceMesh view{s.mesh.positions, s.mesh.normals, s.mesh.uvs, s.mesh.indices};
    const Vec2 size{s.detail.size_u, s.detail.size_v};
    s.set = find_charts(std::span(&view, 1), {size, s.detail.repeat, 0.8});
    s.table = pack_charts(s.set.borders, s.detail.depth);
    s.detail.charts = s.table.layout;
    s.borders = find_borders(s.mesh, s.set, size);
    return s;
}

// Cuts triangles until the drop is straight over each; what lies farther than `reach` from `middle` is left out.
class Displacer {
  public:
    Displacer(const Setting& setting, const Truth& truth, const Vec3& middle, double reach)
        : s_(setting), truth_(truth), middle_(middle), reach_(reach) {}

    void add(std::size_t triangle) {
        Corner corners[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t i = s_.mesh.indices[3 * triangle + k];
            corners[k] = with_drop({read3(s_.mesh.positions, i), read3(s_.mesh.normals, i), read_uv(s_.mesh, i), 0});
        }
        divide(corners[0], corners[1], corners[2]);
    }
    Triangles triangles;

  private:
    struct Corner {
        Vec3 position, normal;
        Vec2 uv;
        double drop;
    };
    Corner with_drop(Corner c) const {
        c.drop = s_.detail.base_offset - truth_.surface_at({c.uv.x * s_.detail.size_u, c.uv.y * s_.detail.size_v}).height;
        return c;
    }
    Corner between(const Corner& a, const Corner& b) const {
        return with_drop({(a.position + b.position) * 0.5, (a.normal + b.normal) * 0.5, (a.uv + b.uv) * 0.5, 0});
    }
    void divide(const Corner& a, const Corner& b, const Corner& c) {
        const double side = std::max({far(a.position, b.position), far(b.position, c.position), far(c.position, a.position)});
        if (far(a.position, middle_) > reach_ + side) return;
        const Corner ab = between(a, b), bc = between(b, c), ca = between(c, a);
        const auto bent = [&](const Corner& m, const Corner& p, const Corner& q) {
            return std::abs(m.drop - 0.5 * (p.drop + q.drop)) > 1e-3 * s_.width;
        };
        const bool fine = side < s_.width / 4 && !bent(ab, a, b) && !bent(bc, b, c) && !bent(ca, c, a);
        if (fine || side < s_.width / 40) {
            put(a), put(b), put(c);
            return;
        }
        divide(a, ab, ca), divide(ab, b, bc), divide(ca, bc, c), divide(ab, bc, ca);
    }
    void put(const Corner& c) {
        const Vec3 p = c.position - normalized(c.normal) * c.drop;
        triangles.indices.push_back(std::uint32_t(triangles.positions.size() / 3));
        for (const double value : p) triangles.positions.push_back(float(value));
    }
    const Setting& s_;
    const Truth& truth_;
    Vec3 middle_;
    double reach_;
};

struct Errors {
    std::vector<double> widths;
    int rays = 0, lost = 0;
    void add(const Errors& other) {
        widths.insert(widths.end(), other.widths.begin(), other.widths.end());
        rays += other.rays, lost += other.lost;
    }
    double at(double share) {
        std::sort(widths.begin(), widths.end());
        return widths.empty() ? HUGE_VAL : widths[std::size_t(share * double(widths.size() - 1))];
    }
};
struct Place {
    Errors inside, border;
};

double distance_to(const std::array<Vec3, 2>& edge, const Vec3& p) {
    const Vec3 way = edge[1] - edge[0];
    const double part = std::clamp(dot(p - edge[0], way) / std::max(dot(way, way), 1e-30), 0.0, 1.0);
    return far(p, edge[0] + way * part);
}

// One spot of the armour: the mesh around it displaced, and rays through it 0 to 60 degrees from the normal.
Place measure_place(const Setting& s, const Truth& truth, const EmbreeScene& base, std::size_t triangle, int rays, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto uniform = [&](double low, double high) { return low + (high - low) * std::uniform_real_distribution<double>()(random); };
    const std::uint32_t* corner = &s.mesh.indices[3 * triangle];
    double b = uniform(0, 1), c = uniform(0, 1);
    if (b + c > 1) b = 1 - b, c = 1 - c;
    const Vec3 p = read3(s.mesh.positions, corner[0]) * (1 - b - c) + read3(s.mesh.positions, corner[1]) * b + read3(s.mesh.positions, corner[2]) * c;
    const double aimed = 0.5 * s.width, reach = 1.5 * aimed + 2.2 * s.detail.depth;
    Displacer displacer(s, truth, p, reach);
    for (std::size_t t = 0; 3 * t < s.mesh.indices.size(); ++t) {
        const Vec3 q[3] = {read3(s.mesh.positions, s.mesh.indices[3 * t]), read3(s.mesh.positions, s.mesh.indices[3 * t + 1]), read3(s.mesh.positions, s.mesh.indices[3 * t + 2])};
        const Vec3 middle = (q[0] + q[1] + q[2]) * (1.0 / 3);
        if (far(middle, p) < reach + std::max({far(middle, q[0]), far(middle, q[1]), far(middle, q[2])})) displacer.add(t);
    }
    const EmbreeScene displaced(displacer.triangles.positions, displacer.triangles.indices);
    std::vector<std::array<Vec3, 2>> borders;
    for (const auto& edge : s.borders)
        if (distance_to(edge, p) < 2 * reach) borders.push_back(edge);
    const Decoder decoder(s.pattern.textures, s.detail, &s.table.words);
    const Vec3 n = place_on(s.mesh, triangle, b, c).normal, x = normalized(cross(std::abs(n[1]) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, n)), y = cross(n, x);
    Place result;
    for (int i = 0; i < rays; ++i) {
        const double tilt = uniform(0, 3.14159265 / 3), turn = uniform(0, 6.283185307);
        const Vec3 out = n * std::cos(tilt) + (x * std::cos(turn) + y * std::sin(turn)) * std::sin(tilt);
        const Vec3 from = p + x * uniform(-aimed, aimed) + y * uniform(-aimed, aimed) + out * aimed, along = out * -1.0;
        const EmbreeHit entry = base.trace(from, along, 0.0);
        // Another part of the suit may stand in the way, or the ray see a sheet from behind.
        if (!(entry.distance < 2 * aimed)) continue;
        const SurfacePlace place = place_on(s.mesh, entry.triangle, entry.u, entry.v, &s.set.charts[0]);
        if (dot(place.normal, along) > -0.3) continue;
        const SurfaceHit hit = decoder.trace_surface(place, along);
        const double right = displaced.trace(from, along, 0.0).distance, way = right - entry.distance;
        // Sheets that lie back to back grow through each other.
        if (way < -1e-3 * s.width) continue;
        const Vec3 end = from + along * std::min(right, entry.distance + 2 * s.detail.depth);
        double gap = HUGE_VAL;
        for (const auto& edge : borders) gap = std::min({gap, distance_to(edge, end), distance_to(edge, from + along * entry.distance)});
        Errors& errors = gap < 1.5 * s.detail.depth ? result.border : result.inside;
        ++errors.rays;
        const bool near = way < 4 * s.detail.depth;
        if (near != hit.met) ++errors.lost;
        else if (near) errors.widths.push_back(std::abs(hit.way - way) / s.width);
    }
    return result;
}

TEST(Armour, HitDistanceAsOnTheDisplacedMesh) {
    if (!std::filesystem::exists(kArmour)) GTEST_SKIP() << "SKIPPED: " << kArmour << " is not there";
    const auto bytes = read_file(kArmour, kMaxModelFileBytes);
    ASSERT_TRUE(bytes.ok());
    const auto model = read_model(kArmour);
    const auto asset = read_asset(*bytes);
    ASSERT_TRUE(model.ok() && asset.ok());
    const auto target = find_material(*model);
    ASSERT_TRUE(target.ok());
    const Setting s = prepare_setting(*asset, target->metres_per_uv);
    ASSERT_TRUE(s.set.needed);
    const Truth truth(s.pattern.resolved);
    const EmbreeScene base(s.mesh.positions, s.mesh.indices);
    std::vector<double> areas;
    for (std::size_t t = 0; 3 * t < s.mesh.indices.size(); ++t) areas.push_back(area_of(s.mesh, t));
    std::mt19937_64 random(4700);
    std::discrete_distribution<std::size_t> pick(areas.begin(), areas.end());
    constexpr int kPlaces = 24, kRays = 100;
    std::vector<std::size_t> chosen;
    for (int i = 0; i < kPlaces; ++i) chosen.push_back(pick(random));
    std::vector<Place> results(chosen.size());
    in_parallel(chosen.size(), [&](std::size_t i) { results[i] = measure_place(s, truth, base, chosen[i], kRays, i); });
    Place all;
    for (const Place& one : results) all.inside.add(one.inside), all.border.add(one.border);
    for (auto [name, e] : {std::pair{"away from borders", &all.inside}, std::pair{"beside borders", &all.border}})
        std::printf("%s: median %.5f  95%% %.5f  99%% %.5f widths, lost %d of %d\n", name, e->at(0.5), e->at(0.95), e->at(0.99), e->lost, e->rays);
    // The rest stands on triangles whose neighbours turn by much over one depth of the relief.
    EXPECT_GT(all.inside.rays, 500);
    EXPECT_EQ(all.inside.lost, 0);
    EXPECT_LT(all.inside.at(0.5), 0.001);
    EXPECT_LT(all.inside.at(0.95), 0.04);
    EXPECT_LT(all.border.at(0.5), 0.001);
    EXPECT_LT(all.border.lost, all.border.rays / 50);
}

}  // namespace
}  // namespace burin::testing
