#include "traced_mesh.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include <embree3/rtcore.h>

namespace burin::bench {

using Direction = std::array<double, 3>;

struct TracedMesh::Parts {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr, tile_scene = nullptr;
    std::atomic<long long> built{0};     // bytes that Embree holds
    std::size_t tile_triangles = 0, tile_bytes = 0;
    std::vector<std::array<float, 3>> normals;  // of each triangle of the tile, in the world
    std::vector<std::uint32_t> elements;        // likewise
    bool instanced = false;
    std::uint32_t outside = RTC_INVALID_GEOMETRY_ID;  // geometry of what lies around a map that ends

    ~Parts() {
        if (scene) rtcReleaseScene(scene);
        if (tile_scene) rtcReleaseScene(tile_scene);
        if (device) rtcReleaseDevice(device);
    }
};

namespace {

constexpr std::size_t kMostCopied = std::size_t{1} << 23;

bool count_bytes(void* user, ssize_t bytes, bool) {
    *static_cast<std::atomic<long long>*>(user) += bytes;
    return true;
}

// From the plane of the pattern into the world of make_plane(size).
struct Placement {
    Vec2 size;
    double top;
    std::array<float, 3> operator()(const reference::Vec3& p, Vec2 shift) const {
        return {float(p.x + shift.x - 0.5 * size.x), float(p.z - top), float(p.y + shift.y - 0.5 * size.y)};
    }
};

void attach(RTCDevice device, RTCScene scene, const std::vector<std::array<float, 3>>& corners, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, corners.size()), corners.data(), 12 * corners.size());
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.size()), triangles.data(), 12 * triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

void attach_tile(TracedMesh::Parts& parts, RTCScene scene, const mesh::TriangleMesh& tile, const Placement& place, Vec2 shift) {
    std::vector<std::array<float, 3>> corners;
    for (const reference::Vec3& p : tile.positions) corners.push_back(place(p, shift));
    attach(parts.device, scene, corners, tile.triangles);
}

void attach_instance(TracedMesh::Parts& parts, Vec2 shift) {
    RTCGeometry geometry = rtcNewGeometry(parts.device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, parts.tile_scene);
    const float transform[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, float(shift.x), 0, float(shift.y)};
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(parts.scene, geometry);
    rtcReleaseGeometry(geometry);
}

void attach_outside(TracedMesh::Parts& parts, const ResolvedPattern& pattern, const Placement& place) {
    const Vec2 size = pattern.size;
    const double far = 100.0 * std::max({size.x, size.y, pattern.depth});
    const Vec2 low[] = {{-far, -far}, {-far, size.y}, {-far, 0}, {size.x, 0}}, high[] = {{far, 0}, {far, far}, {0, size.y}, {far, size.y}};
    std::vector<std::array<float, 3>> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (int i = 0; i < 4; ++i) {
        const auto first = static_cast<std::uint32_t>(corners.size());
        for (const Vec2 p : {low[i], Vec2{high[i].x, low[i].y}, high[i], Vec2{low[i].x, high[i].y}}) corners.push_back(place({p.x, p.y, pattern.outer_level}, {0, 0}));
        triangles.push_back({first, first + 1, first + 2});
        triangles.push_back({first, first + 2, first + 3});
    }
    attach(parts.device, parts.scene, corners, triangles);
    parts.outside = 1;
}

void describe_tile(TracedMesh::Parts& parts, const mesh::TriangleMesh& tile) {
    for (std::size_t t = 0; t < tile.triangles.size(); ++t) {
        const auto& [a, b, c] = tile.triangles[t];
        const reference::Vec3 n = unit(cross(tile.positions[b] - tile.positions[a], tile.positions[c] - tile.positions[a]));
        parts.normals.push_back({float(n.x), float(n.z), float(n.y)});
        parts.elements.push_back(tile.origins[t].element);
    }
}

}  // namespace

TracedMesh::TracedMesh(const mesh::TriangleMesh& tile, const ResolvedPattern& pattern, const Extent& extent) : parts_(std::make_unique<Parts>()) {
    Parts& parts = *parts_;
    parts.device = rtcNewDevice(nullptr);
    rtcSetDeviceMemoryMonitorFunction(parts.device, count_bytes, &parts.built);
    const Placement place{pattern.size, pattern.base_offset};
    parts.tile_scene = rtcNewScene(parts.device);
    rtcSetSceneBuildQuality(parts.tile_scene, RTC_BUILD_QUALITY_HIGH);
    attach_tile(parts, parts.tile_scene, tile, place, {0, 0});
    rtcCommitScene(parts.tile_scene);
    parts.tile_triangles = tile.triangles.size();
    parts.tile_bytes = static_cast<std::size_t>(parts.built.load());
    describe_tile(parts, tile);
    parts.scene = rtcNewScene(parts.device);
    rtcSetSceneBuildQuality(parts.scene, RTC_BUILD_QUALITY_HIGH);
    const bool repeat = pattern.wrap == Wrap::repeat;
    const int ring = repeat ? 1 : 0;
    const int first_x = int(std::floor(extent.low.x)) - ring, last_x = int(std::ceil(extent.high.x)) + ring;
    const int first_y = int(std::floor(extent.low.y)) - ring, last_y = int(std::ceil(extent.high.y)) + ring;
    parts.instanced = std::size_t(last_x - first_x) * std::size_t(last_y - first_y) * tile.triangles.size() > kMostCopied;
    for (int j = first_y; j < last_y; ++j)
        for (int i = first_x; i < last_x; ++i) {
            const Vec2 shift{i * pattern.size.x, j * pattern.size.y};
            if (parts.instanced) attach_instance(parts, shift);
            else attach_tile(parts, parts.scene, tile, place, shift);
        }
    if (!repeat) attach_outside(parts, pattern, place);
    rtcCommitScene(parts.scene);
}

TracedMesh::~TracedMesh() = default;
std::size_t TracedMesh::bytes() const { return parts_->tile_bytes; }
std::size_t TracedMesh::triangles() const { return parts_->tile_triangles; }

namespace {

// Equal for equal numbers, spread over [0, 1).
double chance(std::uint32_t x, std::uint32_t y, std::uint32_t k) {
    std::uint64_t h = x * 0x9E3779B97F4A7C15ull ^ y * 0xC2B2AE3D27D4EB4Full ^ k * 0x165667B19E3779F9ull;
    h = (h ^ (h >> 29)) * 0xBF58476D1CE4E5B9ull;
    h = (h ^ (h >> 32)) * 0x94D049BB133111EBull;
    return double((h ^ (h >> 29)) >> 11) * 0x1p-53;
}

struct Seen {
    Direction sum{0, 0, 0};
    std::uint64_t what = ~std::uint64_t{0};
    bool uneven = false;
    double low = 1e9, high = -1e9;
};

struct Sample {
    std::size_t pixel;
    double x, y;
};

class Tracer {
  public:
    Tracer(const TracedMesh::Parts& parts, const Subject& subject, const PlaneView& view)
        : parts_(parts), view_(view), size_(subject.prepared.resolved.size), camera_(camera_of(view, size_)),
          extent_(extent_of(view, subject.prepared.resolved)), light_(direction_to(view.light)), background_(background_color()) {
        const ResolvedPattern& pattern = subject.prepared.resolved;
        looks_.push_back(look_of(subject.part(), nullptr));
        for (const Material& material : pattern.materials) looks_.push_back(look_of(subject.part(), &material));
        for (const std::uint32_t element : parts.elements)
            look_.push_back(element < pattern.elements.size() ? std::uint32_t(1 + pattern.styles[pattern.elements[element].style].material) : 0u);
        deep_ = 2.0 * pattern.depth;
        rtcInitIntersectContext(&context_);
        context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    }

    // Up to 16 at once.
    void trace(const Sample* samples, int count, std::vector<Seen>& pixels) {
        alignas(64) RTCRayHit16 rays{};
        alignas(64) int valid[16] = {};
        Direction ways[16];
        for (int i = 0; i < count; ++i) valid[i] = start(samples[i], ways[i], rays, i) ? -1 : 0;
        rtcIntersect16(valid, parts_.scene, &context_, &rays);
        alignas(64) RTCRay16 shadows{};
        alignas(64) int lit[16] = {};
        for (int i = 0; i < count; ++i)
            if (valid[i] && rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) lit[i] = aim_at_light(rays, ways[i], shadows, i) ? -1 : 0;
        alignas(64) int asked[16];
        std::copy(lit, lit + 16, asked);
        rtcOccluded16(asked, parts_.scene, &context_, &shadows);
        for (int i = 0; i < count; ++i) {
            const bool hit = valid[i] && rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
            add(pixels[samples[i].pixel], hit ? triangle_of(rays, i) : kNothing, ways[i], lit[i] && shadows.tfar[i] >= 0.0f);
        }
    }

  private:
    static constexpr std::uint32_t kNothing = 0xffffffffu, kOutside = 0xfffffffeu;

    bool start(const Sample& s, Direction& way, RTCRayHit16& rays, int i) const {
        const double across = (2.0 * s.x / view_.width - 1.0) * camera_.tangent * camera_.aspect, upwards = (1.0 - 2.0 * s.y / view_.height) * camera_.tangent;
        double square = 0.0;
        for (std::size_t k = 0; k < 3; ++k) way[k] = camera_.forward[k] + across * camera_.right[k] + upwards * camera_.up[k], square += way[k] * way[k];
        for (double& part : way) part /= std::sqrt(square);
        if (way[1] >= 0.0) return false;
        const double t = camera_.eye[1] / -way[1];
        const double x = camera_.eye[0] + way[0] * t, z = camera_.eye[2] + way[2] * t;
        const double u = x / size_.x + 0.5, v = z / size_.y + 0.5;
        if (u < extent_.low.x || u > extent_.high.x || v < extent_.low.y || v > extent_.high.y) return false;
        // A little above the plane, which the surface may touch.
        const double lift = 1e-4 * deep_;
        rays.ray.org_x[i] = float(x - way[0] / -way[1] * lift), rays.ray.org_y[i] = float(lift), rays.ray.org_z[i] = float(z - way[2] / -way[1] * lift);
        rays.ray.dir_x[i] = float(way[0]), rays.ray.dir_y[i] = float(way[1]), rays.ray.dir_z[i] = float(way[2]);
        rays.ray.tfar[i] = HUGE_VALF, rays.ray.mask[i] = ~0u;
        rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        return true;
    }

    std::uint32_t triangle_of(const RTCRayHit16& rays, int i) const {
        const bool outside = !parts_.instanced && rays.hit.geomID[i] == parts_.outside;
        return outside ? kOutside : rays.hit.primID[i];
    }
    Direction normal_at(std::uint32_t triangle) const {
        if (triangle == kOutside) return {0, 1, 0};
        const auto& n = parts_.normals[triangle];
        return {double(n[0]), double(n[1]), double(n[2])};
    }

    bool aim_at_light(const RTCRayHit16& rays, const Direction& way, RTCRay16& shadows, int i) const {
        const Direction n = normal_at(triangle_of(rays, i));
        if (n[0] * light_[0] + n[1] * light_[1] + n[2] * light_[2] <= 0.0 || light_[1] <= 0.0) return false;
        const float t = rays.ray.tfar[i];
        shadows.org_x[i] = rays.ray.org_x[i] + float(way[0]) * t, shadows.org_y[i] = rays.ray.org_y[i] + float(way[1]) * t;
        shadows.org_z[i] = rays.ray.org_z[i] + float(way[2]) * t;
        shadows.dir_x[i] = float(light_[0]), shadows.dir_y[i] = float(light_[1]), shadows.dir_z[i] = float(light_[2]);
        shadows.tnear[i] = float(2e-4 * deep_), shadows.tfar[i] = float(2.0 * deep_ / light_[1]), shadows.mask[i] = ~0u;
        return true;
    }

    void add(Seen& pixel, std::uint32_t triangle, const Direction& way, bool lit) const {
        Direction color{background_, background_, background_};
        std::uint64_t what = 0;
        if (triangle != kNothing) {
            const std::uint32_t look = triangle == kOutside ? 0u : look_[triangle];
            color = shade(looks_[look], view_.light, light_, normal_at(triangle), {-way[0], -way[1], -way[2]}, lit);
            // Like facets in the same light and colour are alike.
            const Direction n = normal_at(triangle);
            for (const double part : n) what = what * 4099 + std::uint64_t(std::lround(512.0 * part) + 1024);
            what = 1 + 2 * (what * 64 + look) + (lit ? 1 : 0);
        }
        for (std::size_t k = 0; k < 3; ++k) pixel.sum[k] += color[k];
        const double bright = std::sqrt(color[0] + 2.0 * color[1] + color[2]) * 0.5;
        pixel.low = std::min(pixel.low, bright), pixel.high = std::max(pixel.high, bright);
        if (pixel.what == ~std::uint64_t{0}) pixel.what = what;
        pixel.uneven |= pixel.what != what;
    }

    const TracedMesh::Parts& parts_;
    PlaneView view_;
    Vec2 size_;
    PlaneCamera camera_;
    Extent extent_;
    Direction light_;
    double background_, deep_ = 0.0;
    std::vector<Look> looks_;
    std::vector<std::uint32_t> look_;  // of each triangle
    RTCIntersectContext context_;
};

constexpr int kTile = 16;  // pixels
constexpr double kEven = 0.004;

bool is_even(const Seen& pixel) { return !pixel.uneven && pixel.high - pixel.low <= kEven; }

// Calls take(x, y) for the pixels of a tile that are asked for, and traces side x side samples of each.
template <typename Wanted>
void draw_tiles(Tracer& shared, const PlaneView& view, int side, std::uint32_t seed, std::vector<Seen>& pixels, const Wanted& wanted) {
    const int columns = (view.width + kTile - 1) / kTile, rows = (view.height + kTile - 1) / kTile;
    testing::in_parallel(std::size_t(columns * rows), [&](std::size_t tile) {
        Tracer tracer = shared;
        Sample packet[16];
        int count = 0;
        for (int k = 0; k < side * side; ++k)
            for (int p = 0; p < kTile * kTile; ++p) {
                const int x = int(tile) % columns * kTile + p % kTile, y = int(tile) / columns * kTile + p / kTile;
                if (x >= view.width || y >= view.height || !wanted(x, y)) continue;
                const std::uint32_t key = seed + 2 * std::uint32_t(k);
                packet[count++] = {std::size_t(y * view.width + x), x + (k % side + chance(std::uint32_t(x), std::uint32_t(y), key)) / side,
                                   y + (k / side + chance(std::uint32_t(x), std::uint32_t(y), key + 1)) / side};
                if (count == 16) tracer.trace(packet, count, pixels), count = 0;
            }
        if (count > 0) tracer.trace(packet, count, pixels);
    });
}

bool has_other_neighbour(const std::vector<Seen>& pixels, const PlaneView& view, int x, int y) {
    const Seen& own = pixels[std::size_t(y * view.width + x)];
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, view.height - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, view.width - 1); ++i) {
            const Seen& other = pixels[std::size_t(j * view.width + i)];
            if (other.what != own.what || other.uneven) return true;
        }
    return false;
}

}  // namespace

RgbaImage draw_traced(const TracedMesh& mesh, const Subject& subject, const PlaneView& view, const TraceOptions& options) {
    Tracer tracer(mesh.parts(), subject, view);
    const std::size_t count = std::size_t(view.width) * std::size_t(view.height);
    const int side = int(std::lround(std::sqrt(double(options.samples)))), first = options.adaptive ? 2 : side;
    std::vector<Seen> pixels(count);
    std::vector<int> taken(count, first * first);
    draw_tiles(tracer, view, first, 0, pixels, [](int, int) { return true; });
    if (options.adaptive && side > first) {
        const std::vector<Seen> few = pixels;
        const auto wanted = [&](int x, int y) { return !is_even(few[std::size_t(y * view.width + x)]) || has_other_neighbour(few, view, x, y); };
        draw_tiles(tracer, view, side, 1u << 20, pixels, wanted);
        for (std::size_t i = 0; i < count; ++i)
            if (wanted(int(i) % view.width, int(i) / view.width)) taken[i] += side * side;
    }
    RgbaImage image{view.width, view.height, std::vector<std::uint8_t>(4 * count, 255)};
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 3; ++k) image.texels[4 * i + k] = std::uint8_t(std::lround(255.0 * to_srgb(pixels[i].sum[k] / taken[i])));
    return image;
}

}  // namespace burin::bench
