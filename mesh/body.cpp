#include "body.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <unordered_map>

#include <burin/evaluate.hpp>

namespace burin::mesh {

using reference::HalfSpace;
using reference::include;
using reference::meet;
using reference::Polygon;
using reference::Polygons;
using reference::Vec3;

namespace {

constexpr int kBinsPerSide = 128;

// Triangles of the tile by where they lie.
class TileBins {
  public:
    TileBins(const TriangleMesh& tile, Vec2 size) : size_(size), bins_(std::size_t{kBinsPerSide} * kBinsPerSide), asked_(tile.triangles.size(), 0) {
        for (std::uint32_t t = 0; t < tile.triangles.size(); ++t) {
            Box box;
            for (const std::uint32_t v : tile.triangles[t]) include(box, plan(tile.positions[v]));
            boxes_.push_back(box);
            for_each_bin(box, [&](std::vector<std::uint32_t>& bin) { bin.push_back(t); });
        }
    }
    // Each triangle whose box meets the given one, once.
    template <typename Visit>
    void visit(const Box& box, const Visit& visit) {
        ++turn_;
        for_each_bin(box, [&](const std::vector<std::uint32_t>& bin) {
            for (const std::uint32_t t : bin) {
                if (asked_[t] == turn_ || !meet(boxes_[t], box)) continue;
                asked_[t] = turn_;
                visit(t);
            }
        });
    }

  private:
    static std::size_t place(double at, double side) {
        return static_cast<std::size_t>(std::clamp(at / side * kBinsPerSide, 0.0, static_cast<double>(kBinsPerSide - 1)));
    }
    template <typename Use>
    void for_each_bin(const Box& box, const Use& use) {
        for (std::size_t j = place(box.low.y, size_.y); j <= place(box.high.y, size_.y); ++j)
            for (std::size_t i = place(box.low.x, size_.x); i <= place(box.high.x, size_.x); ++i) use(bins_[j * kBinsPerSide + i]);
    }

    Vec2 size_;
    std::vector<std::vector<std::uint32_t>> bins_;
    std::vector<Box> boxes_;
    std::vector<std::uint32_t> asked_;
    std::uint32_t turn_ = 0;
};

// Corners that are as good as equal are stored once.
class Vertices {
  public:
    Vertices(BodyMesh& out, double fine) : out_(out), fine_(fine) {}

    std::uint32_t index_of(Vec3 p, Vec3 normal) {
        const Key key{round_of(p.x), round_of(p.y), round_of(p.z), std::lround(normal.x * 512), std::lround(normal.y * 512), std::lround(normal.z * 512)};
        const auto [it, fresh] = places_.try_emplace(key, static_cast<std::uint32_t>(out_.positions.size() / 3));
        if (fresh) {
            for (const double v : {p.x, p.y, p.z}) out_.positions.push_back(static_cast<float>(v));
            for (const double v : {normal.x, normal.y, normal.z}) out_.normals.push_back(static_cast<float>(v));
        }
        return it->second;
    }

  private:
    using Key = std::array<long, 6>;
    struct Hash {
        std::size_t operator()(const Key& key) const {
            std::size_t h = 1469598103934665603u;
            for (const long part : key) h = (h ^ static_cast<std::size_t>(part)) * 1099511628211u;
            return h ^ (h >> 29);
        }
    };
    long round_of(double at) const { return std::lround(at / fine_); }

    BodyMesh& out_;
    double fine_;
    std::unordered_map<Key, std::uint32_t, Hash> places_;
};

// A point of the relief, and the body's normal there.
struct Lifted {
    Vec3 position, up;
};

// A triangle of the body in the plane of the pattern.
struct Patch {
    Vec2 at[3];  // metres
    Vec3 position[3], normal[3];
    double scale = 1.0;  // metres of the world per metre of the pattern
    double area = 0.0;  // twice; below 0 where the picture is not mirrored, v being down
    Box box;

    Lifted lift(Vec3 p, double top) const {
        const Vec2 q = plan(p);
        double w[3];
        for (int i = 0; i < 3; ++i) w[i] = cross(at[(i + 1) % 3] - q, at[(i + 2) % 3] - q) / area;
        const Vec3 on = position[0] * w[0] + position[1] * w[1] + position[2] * w[2];
        const Vec3 up = normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2];
        return {on + unit(up) * ((p.z - top) * scale), unit(up)};
    }
    // Of the flat triangle, outwards.
    Vec3 flat() const { return unit(cross(position[1] - position[0], position[2] - position[0])); }
};

Vec3 vector_of(const std::vector<float>& values, std::uint32_t i) { return {values[3 * i], values[3 * i + 1], values[3 * i + 2]}; }

Patch patch_of(const Primitive& primitive, std::size_t first, Vec2 size) {
    Patch patch;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = primitive.indices[first + i];
        patch.at[i] = {double(primitive.uvs[2 * v]) * size.x, double(primitive.uvs[2 * v + 1]) * size.y};
        patch.position[i] = vector_of(primitive.positions, v);
        patch.normal[i] = vector_of(primitive.normals, v);
        include(patch.box, patch.at[i]);
    }
    patch.scale = double(primitive.scale);
    patch.area = cross(patch.at[1] - patch.at[0], patch.at[2] - patch.at[0]);
    return patch;
}

class BodyMesher {
  public:
    BodyMesher(const TriangleMesh& tile, const ResolvedPattern& pattern, double fine)
        : tile_(tile), pattern_(pattern), bins_(tile, pattern.size), vertices_(out_, fine) {}

    void add(const Patch& patch) {
        const double sign = patch.area > 0.0 ? 1.0 : -1.0;
        for (int i = 0; i < 3; ++i) {
            const Vec2 a = patch.at[i], along = patch.at[(i + 1) % 3] - a, n = normal_of(along) * (-sign / length(along));
            edges_[i] = {{n.x, n.y, 0.0}, dot(n, a)};
        }
        const Vec2 size = pattern_.size;
        const bool repeat = pattern_.wrap == Wrap::repeat;
        const auto first = [&](double at, double side) { return repeat ? std::floor(at / side) : 0.0; };
        for (double j = first(patch.box.low.y, size.y); j <= first(patch.box.high.y, size.y); ++j)
            for (double i = first(patch.box.low.x, size.x); i <= first(patch.box.high.x, size.x); ++i) add_tile(patch, {i * size.x, j * size.y});
        if (!repeat) add_outside(patch);
    }
    BodyMesh take() { return std::move(out_); }
    std::size_t count() const { return out_.origins.size(); }

  private:
    void add_tile(const Patch& patch, Vec2 shift) {
        bins_.visit({patch.box.low - shift, patch.box.high - shift}, [&](std::uint32_t t) {
            points_.clear();
            const std::uint32_t mark = points_.mark();
            for (const std::uint32_t v : tile_.triangles[t]) points_.add(tile_.positions[v] + Vec3{shift.x, shift.y, 0.0});
            add_clipped(patch, points_.close(mark), tile_.origins[t]);
        });
    }

    void add_clipped(const Patch& patch, Polygon polygon, Origin origin) {
        for (const HalfSpace& edge : edges_) polygon = polygon ? points_.clip(polygon, edge) : polygon;
        if (!polygon) return;
        std::vector<Lifted> corners;
        for (std::uint32_t i = 0; i < polygon.count; ++i) corners.push_back(patch.lift(points_(polygon, i), pattern_.base_offset));
        if (patch.area < 0.0) std::reverse(corners.begin(), corners.end());
        add_polygon(corners, patch.flat(), origin);
    }

    // The facet's normal turns with the body's: a round body stays smooth.
    void add_polygon(const std::vector<Lifted>& corners, Vec3 flat, Origin origin) {
        Vec3 area{};
        for (std::size_t i = 1; i + 1 < corners.size(); ++i)
            area = area + cross(corners[i].position - corners[0].position, corners[i + 1].position - corners[0].position);
        if (!(dot(area, area) > 0.0)) return;
        const Vec3 normal = unit(area);
        std::vector<std::uint32_t> at;
        for (const Lifted& corner : corners) at.push_back(vertices_.index_of(corner.position, unit(normal + corner.up - flat)));
        for (std::size_t i = 1; i + 1 < at.size(); ++i) {
            if (at[0] == at[i] || at[i] == at[i + 1] || at[i + 1] == at[0]) continue;
            out_.indices.insert(out_.indices.end(), {at[0], at[i], at[i + 1]});
            out_.origins.push_back(origin);
        }
    }

    // What of the patch lies beyond the borders of a map that does not repeat.
    void add_outside(const Patch& patch) {
        const Vec2 size = pattern_.size;
        const HalfSpace borders[] = {{{-1, 0, 0}, 0}, {{0, -1, 0}, 0}, {{1, 0, 0}, size.x}, {{0, 1, 0}, size.y}};
        points_.clear();
        const std::uint32_t mark = points_.mark();
        const bool turned = patch.area < 0.0;
        for (const int i : {0, turned ? 2 : 1, turned ? 1 : 2}) points_.add({patch.at[i].x, patch.at[i].y, pattern_.outer_level});
        Polygon left = points_.close(mark);
        for (const HalfSpace& border : borders) {
            if (!left) return;
            const Polygon beyond = points_.clip(left, HalfSpace{border.n * -1.0, -border.d});
            left = points_.clip(left, border);
            if (beyond) add_clipped(patch, beyond, {kGround, kGround});
        }
    }

    const TriangleMesh& tile_;
    const ResolvedPattern& pattern_;
    TileBins bins_;
    HalfSpace edges_[3];
    Polygons<Vec3> points_;
    BodyMesh out_;
    Vertices vertices_;
};

// Corners nearer than what a float tells apart are one.
double fine_of(const Primitive& primitive) {
    float low = HUGE_VALF, high = -HUGE_VALF;
    for (const float v : primitive.positions) low = std::min(low, v), high = std::max(high, v);
    return std::max(1e-7 * (double(high) - double(low)), 1e-12);
}

}  // namespace

Result<BodyMesh> mesh_body(const TriangleMesh& tile, const ResolvedPattern& pattern, const Primitive& primitive) {
    BodyMesher mesher(tile, pattern, fine_of(primitive));
    for (std::size_t first = 0; first + 2 < primitive.indices.size(); first += 3) {
        const Patch patch = patch_of(primitive, first, pattern.size);
        if (patch.area == 0.0) continue;  // no part of the pattern lies on it
        mesher.add(patch);
        if (mesher.count() > kMaxTriangles)
            return Error{ErrorCode::limit_exceeded, "the body's mesh has more than " + std::to_string(kMaxTriangles) + " triangles; a larger tolerance takes fewer"};
    }
    return mesher.take();
}

BodyMesh lay_flat(const TriangleMesh& tile, Vec2 size) {
    BodyMesh out;
    Vertices vertices(out, 1e-7 * std::max(size.x, size.y));
    for (std::size_t t = 0; t < tile.triangles.size(); ++t) {
        Vec3 corners[3];
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 p = tile.positions[tile.triangles[t][2 - i]];  // y and z change places, which turns it over
            corners[i] = {p.x - 0.5 * size.x, p.z, p.y - 0.5 * size.y};
        }
        const Vec3 area = cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (!(dot(area, area) > 0.0)) continue;
        std::uint32_t at[3];
        for (std::size_t i = 0; i < 3; ++i) at[i] = vertices.index_of(corners[i], unit(area));
        if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
        out.indices.insert(out.indices.end(), at, at + 3);
        out.origins.push_back(tile.origins[t]);
    }
    return out;
}

}  // namespace burin::mesh
