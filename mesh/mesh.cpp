#include "mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "columns.hpp"
#include "evaluate_prepare.hpp"
#include "surface.hpp"

namespace burin::mesh {

using reference::Gathered;
using reference::GroovedSurface;
using reference::LocalGeometry;

namespace {

// Corners nearer than this part of the tolerance are one.
constexpr double kSnap = 1.0 / 32.0;

double mean_width(const ResolvedPattern& pattern) {
    double width = 0.0, run = 0.0;
    for (const ResolvedElement& e : pattern.elements) {
        double low = 0.0, high = 0.0;
        for (const ProfilePoint& point : pattern.profiles[pattern.styles[e.style].profile].points) low = std::min(low, point.b), high = std::max(high, point.b);
        const double way = length(e.element.p2 - e.element.p0);
        width += way * (high - low) * 0.5 * (e.element.width0 + e.element.width1);
        run += way;
    }
    return run > 0.0 && width > 0.0 ? width / run : std::max(pattern.size.x, pattern.size.y);
}

std::string short_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

Result<double> tolerance_of(const ResolvedPattern& pattern, const MeshOptions& options) {
    const double longer = std::max(pattern.size.x, pattern.size.y), least = 1e-7 * longer, most = 0.1 * longer;
    if (options.tolerance == 0.0) return std::clamp(1e-3 * mean_width(pattern), least, most);
    if (options.tolerance >= least && options.tolerance <= most) return options.tolerance;
    return Error{ErrorCode::invalid_argument, "tolerance " + short_text(options.tolerance) + " m is not within [" + short_text(least) + ", " +
                                                  short_text(most) + "], 1e-7 to 0.1 times the longer side of the map"};
}

// All elements that act anywhere on the map.
Gathered gather_map(const GroovedSurface& surface) {
    const Vec2 size = surface.pattern().size;
    Gathered gathered;
    reference::Footprint footprint;
    for (const Vec2 corner : {Vec2{0, 0}, Vec2{size.x, 0}, size, Vec2{0, size.y}}) footprint.corners.push_back(corner);
    reference::gather_grooves(surface, footprint, {}, gathered);
    return gathered;
}

// Path lines of steps, in the pieces that brushes have.
void add_step_lines(const GroovedSurface& surface, const Gathered& gathered, double tolerance, std::vector<PlanLine>& lines) {
    reference::Stations stations;
    for (const reference::Instance& instance : gathered.instances) {
        const PreparedElement& e = surface.truth().prepared().elements[instance.element];
        if (!e.step) continue;
        reference::place_stations(e, surface.pattern().elements[instance.element], instance.shift, {&gathered.region, tolerance, 0.0}, stations);
        for (std::size_t k = 0; k + 1 < stations.list.size(); ++k) lines.push_back({stations.list[k].origin, stations.list[k + 1].origin, instance.element});
    }
}

}  // namespace

Result<TriangleMesh> mesh_pattern(const ResolvedPattern& pattern, const CellGrid& grid, const MeshOptions& options) {
    const Result<double> tolerance = tolerance_of(pattern, options);
    if (!tolerance) return tolerance.error();
    if (!(options.base >= 0.0)) return Error{ErrorCode::invalid_argument, "base " + short_text(options.base) + " m is below 0"};
    const GroovedSurface surface(pattern, grid);
    const Gathered gathered = gather_map(surface);
    LocalGeometry geometry;
    reference::sweep_brushes(surface, gathered, {*tolerance}, geometry);
    const double same_level = pattern.depth / 4096.0, snap = kSnap * *tolerance;
    const BrushBins bins(geometry, pattern.size);
    std::vector<PlanLine> lines = find_edges(geometry, bins, same_level);
    add_step_lines(surface, gathered, *tolerance, lines);
    Plan plan = divide_plan(lines, pattern.size, snap);
    const double base = options.base > 0.0 ? options.base : 0.5 * pattern.depth;
    const std::vector<double> levels = find_levels(surface, plan);
    const Columns columns = stack_columns(geometry, gathered, bins, plan, levels, {surface.lowest() - base, 2.0 * snap, same_level, options.threads});
    const Walls walls(geometry, gathered, columns, levels, same_level);
    std::optional<double> outside;
    if (pattern.wrap == Wrap::clamp && !options.closed) outside = pattern.outer_level;
    TriangleMesh mesh = close_surface(std::move(plan), columns, walls, {geometry.fine, options.closed, outside});
    if (mesh.triangles.size() > kMaxTriangles)
        return Error{ErrorCode::limit_exceeded, std::to_string(mesh.triangles.size()) + " triangles are more than " + std::to_string(kMaxTriangles) +
                                                    "; a larger tolerance than " + short_text(*tolerance) + " m takes fewer"};
    mesh.tolerance = *tolerance;
    mesh.lowest = surface.lowest();
    return mesh;
}

std::size_t count_open_edges(const TriangleMesh& mesh) {
    std::vector<std::pair<std::uint64_t, int>> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint64_t a = t[i], b = t[(i + 1) % 3];
            edges.emplace_back(std::min(a, b) << 32 | std::max(a, b), a < b ? 1 : -1);
        }
    std::sort(edges.begin(), edges.end());
    std::size_t open = 0;
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        int sum = 0;
        for (; end < edges.size() && edges[end].first == edges[i].first; ++end) sum += edges[end].second;
        open += static_cast<std::size_t>(std::abs(sum));
    }
    return open;
}

}  // namespace burin::mesh
