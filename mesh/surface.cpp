#include "surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace burin::mesh {

using reference::Vec3;

namespace {

// Heights that the surface has over each corner of the plan: the vertices of the mesh.
class Heights {
  public:
    void note(std::uint32_t corner, double z) { noted_.push_back({corner, z}); }

    // Of heights within `fine` of the next one is kept.
    void sort(std::size_t corners, double fine) {
        std::sort(noted_.begin(), noted_.end());
        first_.assign(corners + 1, 0);
        for (std::size_t i = 0; i < noted_.size(); ++i) {
            const bool again = i > 0 && noted_[i].first == noted_[i - 1].first && noted_[i].second - noted_[i - 1].second <= fine;
            if (again) continue;
            heights_.push_back(noted_[i].second);
            ++first_[noted_[i].first + 1];
        }
        for (std::size_t c = 0; c < corners; ++c) first_[c + 1] += first_[c];
        noted_.clear();
        noted_.shrink_to_fit();
    }

    std::uint32_t vertex(std::uint32_t corner, double z) const {
        const auto begin = heights_.begin() + first_[corner], end = heights_.begin() + first_[corner + 1];
        return static_cast<std::uint32_t>(std::upper_bound(begin, end, z) - heights_.begin() - 1);
    }

    std::vector<Vec3> positions(const std::vector<Vec2>& corners) const {
        std::vector<Vec3> out;
        for (std::size_t c = 0; c < corners.size(); ++c)
            for (std::uint32_t i = first_[c]; i < first_[c + 1]; ++i) out.push_back({corners[c].x, corners[c].y, heights_[i]});
        return out;
    }

  private:
    std::vector<std::pair<std::uint32_t, double>> noted_;
    std::vector<double> heights_;
    std::vector<std::uint32_t> first_;
};

struct Builder {
    Plan plan;
    const Columns& columns;
    const Walls& walls;
    SurfaceOptions options;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> splits;  // from the smaller corner to the larger
    Heights heights;
    TriangleMesh mesh;
    std::vector<Boundary> outside;  // the column around the map

    double height(const Boundary& boundary, std::uint32_t corner) const { return boundary.plane.at(plan.corners[corner]); }

    // Corner i, and what divides the edge from it to the next; without that one.
    void edge_of(const PlanTriangle& t, int i, std::vector<std::uint32_t>& out) const {
        const std::uint32_t a = t.corner[i], b = t.corner[(i + 1) % 3];
        out.push_back(a);
        const auto found = splits.find(std::minmax(a, b));
        if (found == splits.end()) return;
        if (a < b) out.insert(out.end(), found->second.begin(), found->second.end());
        else out.insert(out.end(), found->second.rbegin(), found->second.rend());
    }

    template <typename Visit>
    void for_each_edge(const Visit& visit) {
        for (std::size_t t = 0; t < plan.triangles.size(); ++t)
            for (int i = 0; i < 3; ++i)
                if (const std::int32_t beyond = plan.triangles[t].across[i]; beyond == kBorder || static_cast<std::size_t>(beyond) > t) visit(t, i, beyond);
    }

    // Where a surface on one side of the edge passes one on the other side.
    void split_edge(std::size_t t, int i, std::int32_t beyond) {
        const auto [a, b] = std::minmax(plan.triangles[t].corner[i], plan.triangles[t].corner[(i + 1) % 3]);
        std::vector<double> at;
        for (const Boundary& here : columns.of(t))
            for (const Boundary& there : column_beyond(beyond)) {
                const double from = height(here, a) - height(there, a), to = height(here, b) - height(there, b);
                if (std::min(std::abs(from), std::abs(to)) > options.fine && (from < 0.0) != (to < 0.0)) at.push_back(from / (from - to));
            }
        if (at.empty() || a == b) return;
        std::sort(at.begin(), at.end());
        const Vec2 start = plan.corners[a], way = plan.corners[b] - start;
        std::vector<std::uint32_t>& corners = splits[{a, b}];
        for (std::size_t k = 0; k < at.size(); ++k) {
            if (k > 0 && (at[k] - at[k - 1]) * length(way) <= options.fine) continue;
            corners.push_back(static_cast<std::uint32_t>(plan.corners.size()));
            plan.corners.push_back(start + way * at[k]);
        }
    }

    std::size_t first_boundary() const { return options.closed ? 0 : 1; }

    void note_heights() {
        std::vector<std::uint32_t> outline;
        for (std::size_t t = 0; t < plan.triangles.size(); ++t) {
            outline.clear();
            for (int i = 0; i < 3; ++i) edge_of(plan.triangles[t], i, outline);
            for (const Boundary& boundary : columns.of(t))
                for (const std::uint32_t corner : outline) heights.note(corner, height(boundary, corner));
        }
        for_each_edge([&](std::size_t t, int i, std::int32_t beyond) {
            if (beyond != kBorder) return;
            outline.clear();
            edge_of(plan.triangles[t], i, outline);
            outline.push_back(plan.triangles[t].corner[(i + 1) % 3]);
            for (const Boundary& boundary : outside)
                for (const std::uint32_t corner : outline) heights.note(corner, height(boundary, corner));
        });
        heights.sort(plan.corners.size(), options.fine);
        mesh.positions = heights.positions(plan.corners);
    }

    void put(std::uint32_t a, std::uint32_t b, std::uint32_t c, Origin origin) {
        if (a == b || b == c || c == a) return;
        mesh.triangles.push_back({a, b, c});
        mesh.origins.push_back(origin);
    }

    // A solid stretch ends at its odd boundaries: their faces look up.
    void put_faces(std::size_t t, std::vector<std::uint32_t>& outline) {
        outline.clear();
        for (int i = 0; i < 3; ++i) edge_of(plan.triangles[t], i, outline);
        const auto boundaries = columns.of(t);
        for (std::size_t k = first_boundary(); k < boundaries.size(); ++k) {
            std::vector<std::uint32_t> face;
            for (const std::uint32_t corner : outline) face.push_back(heights.vertex(corner, height(boundaries[k], corner)));
            if (k % 2 == 0) std::reverse(face.begin(), face.end());
            put_polygon(face, boundaries[k].origin);
        }
    }

    // A triangle whose sides may hold further corners.
    void put_polygon(const std::vector<std::uint32_t>& face, Origin origin) {
        if (face.size() == 3) return put(face[0], face[1], face[2], origin);
        Vec3 middle;
        for (const std::uint32_t v : face) middle = middle + mesh.positions[v] * (1.0 / static_cast<double>(face.size()));
        const auto centre = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(middle);
        for (std::size_t i = 0; i < face.size(); ++i) put(centre, face[i], face[(i + 1) % face.size()], origin);
    }

    struct Level {
        const Boundary* boundary;
        bool here;  // of the triangle itself, not of the one beyond
        double at_a, at_b;
    };

    std::span<const Boundary> column_beyond(std::int32_t beyond) const {
        if (beyond != kBorder) return columns.of(static_cast<std::size_t>(beyond));
        return options.closed ? std::span<const Boundary>{} : std::span<const Boundary>{outside};
    }

    // What is solid on one side of the edge alone.
    void put_walls(std::size_t t, int i, std::int32_t beyond, std::vector<Level>& levels) {
        if (beyond == kBorder && !options.closed && !options.outside) return;
        std::vector<std::uint32_t> way;
        edge_of(plan.triangles[t], i, way);
        way.push_back(plan.triangles[t].corner[(i + 1) % 3]);
        for (std::size_t k = 0; k + 1 < way.size(); ++k) {
            levels.clear();
            const auto take = [&](const Boundary& boundary, bool here) {
                levels.push_back({&boundary, here, height(boundary, way[k]), height(boundary, way[k + 1])});
            };
            for (const Boundary& boundary : columns.of(t)) take(boundary, true);
            for (const Boundary& boundary : column_beyond(beyond)) take(boundary, false);
            std::stable_sort(levels.begin(), levels.end(), [](const Level& x, const Level& y) { return x.at_a + x.at_b < y.at_a + y.at_b; });
            put_walls_between(way[k], way[k + 1], levels, {static_cast<std::int32_t>(t), beyond, plan.triangles[t].step[i]});
        }
    }

    // Triangles on both sides, and the step whose path line parts them.
    struct Sides {
        std::int32_t here, there;
        std::uint32_t step;
    };

    void put_walls_between(std::uint32_t a, std::uint32_t b, const std::vector<Level>& levels, const Sides& sides) {
        bool here = false, there = false;
        const Vec2 middle = lerp(plan.corners[a], plan.corners[b], 0.5);
        for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
            const Level &low = levels[k], &high = levels[k + 1];
            bool& side = low.here ? here : there;
            side = !side;
            if (here == there) continue;
            const Vec3 at{middle.x, middle.y, 0.25 * (low.at_a + low.at_b + high.at_a + high.at_b)};
            const std::uint32_t element = walls.element_of(here ? sides.here : sides.there, here ? sides.there : sides.here, sides.step, at);
            put_wall(a, b, low, high, here, {element, kWall});
        }
    }

    // From the height of `low` to that of `high`; further corners on its upright sides are those of other walls. It looks to the
    // right of the way from a to b, or to the left.
    void put_wall(std::uint32_t a, std::uint32_t b, const Level& low, const Level& high, bool to_right, Origin origin) {
        const std::uint32_t a0 = heights.vertex(a, low.at_a), a1 = heights.vertex(a, high.at_a);
        const std::uint32_t b0 = heights.vertex(b, low.at_b), b1 = heights.vertex(b, high.at_b);
        const int count_a = std::abs(static_cast<int>(a1) - static_cast<int>(a0)), count_b = std::abs(static_cast<int>(b1) - static_cast<int>(b0));
        const int up_a = a1 < a0 ? -1 : 1, up_b = b1 < b0 ? -1 : 1;
        const auto face = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) { to_right ? put(p, q, r, origin) : put(p, r, q, origin); };
        int i = 0, k = 0;
        std::uint32_t at_a = a0, at_b = b0;
        while (i < count_a || k < count_b) {
            // The side that lags behind goes on.
            const bool on_b = k < count_b && (i == count_a || static_cast<long>(k) * count_a <= static_cast<long>(i) * count_b);
            if (on_b) {
                const std::uint32_t next = static_cast<std::uint32_t>(static_cast<int>(at_b) + up_b);
                face(at_a, at_b, next);
                at_b = next, ++k;
            } else {
                const std::uint32_t next = static_cast<std::uint32_t>(static_cast<int>(at_a) + up_a);
                face(at_a, at_b, next);
                at_a = next, ++i;
            }
        }
    }
};

// Faces that lie on each other back to back bound nothing.
void cancel_opposites(TriangleMesh& mesh) {
    struct Keyed {
        std::array<std::uint32_t, 3> corners;
        bool even;
        std::uint32_t triangle;
        bool operator<(const Keyed& o) const { return std::tie(corners, even, triangle) < std::tie(o.corners, o.even, o.triangle); }
    };
    std::vector<Keyed> all;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        auto [a, b, c] = mesh.triangles[t];
        bool even = true;
        const auto order = [&](std::uint32_t& x, std::uint32_t& y) {
            if (x > y) std::swap(x, y), even = !even;
        };
        order(a, b), order(b, c), order(a, b);
        all.push_back({{a, b, c}, even, t});
    }
    std::sort(all.begin(), all.end());
    std::vector<std::uint8_t> lost(mesh.triangles.size(), 0);
    for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
        while (end < all.size() && all[end].corners == all[i].corners) ++end;
        const auto odd = static_cast<std::size_t>(std::count_if(all.begin() + static_cast<std::ptrdiff_t>(i), all.begin() + static_cast<std::ptrdiff_t>(end), [](const Keyed& k) { return !k.even; }));
        const std::size_t pairs = std::min(odd, end - i - odd);
        for (std::size_t k = 0; k < pairs; ++k) lost[all[i + k].triangle] = lost[all[end - 1 - k].triangle] = 1;
    }
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (!lost[t]) mesh.triangles[kept] = mesh.triangles[t], mesh.origins[kept++] = mesh.origins[t];
    mesh.triangles.resize(kept);
    mesh.origins.resize(kept);
}

void drop_unused(TriangleMesh& mesh) {
    std::vector<std::uint32_t> place(mesh.positions.size(), 0);
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t) place[v] = 1;
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < place.size(); ++v)
        if (place[v]) mesh.positions[kept] = mesh.positions[v], place[v] = kept++;
    mesh.positions.resize(kept);
    for (auto& t : mesh.triangles)
        for (std::uint32_t& v : t) v = place[v];
}

}  // namespace

TriangleMesh close_surface(Plan plan, const Columns& columns, const Walls& walls, const SurfaceOptions& options) {
    Builder builder{std::move(plan), columns, walls, options, {}, {}, {}, {}};
    if (options.outside && !columns.boundaries.empty())
        builder.outside = {columns.boundaries.front(), {{{0, 0}, *options.outside}, {kGround, kGround}}};
    builder.for_each_edge([&](std::size_t t, int i, std::int32_t beyond) { builder.split_edge(t, i, beyond); });
    builder.note_heights();
    std::vector<std::uint32_t> outline;
    for (std::size_t t = 0; t < builder.plan.triangles.size(); ++t) builder.put_faces(t, outline);
    std::vector<Builder::Level> levels;
    builder.for_each_edge([&](std::size_t t, int i, std::int32_t beyond) { builder.put_walls(t, i, beyond, levels); });
    cancel_opposites(builder.mesh);
    drop_unused(builder.mesh);
    return std::move(builder.mesh);
}

}  // namespace burin::mesh
