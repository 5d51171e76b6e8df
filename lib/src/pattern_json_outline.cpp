// Curves of paths and outlines: path data or points, and which side of an outline is within.
#include <algorithm>
#include <cmath>
#include <utility>

#include <burin/pattern_json.hpp>

#include "pattern_json_internal.hpp"

namespace burin::pattern_json {
namespace {

using Elements = std::vector<Element>;

Elements polyline(const std::vector<Vec2>& points) {
    Elements elements;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        if (!(points[i] == points[i + 1])) elements.push_back({ElementKind::line, points[i], lerp(points[i], points[i + 1], 0.5), points[i + 1]});
    return elements;
}

// Chords near enough to tell what lies within what.
std::vector<Vec2> flattened(const Elements& elements) {
    constexpr int chords = 8;
    std::vector<Vec2> points;
    for (const Element& e : elements) {
        points.push_back(e.p0);
        for (int i = 1; i < chords && e.kind == ElementKind::quadratic; ++i) {
            const double s = static_cast<double>(i) / chords;
            points.push_back(lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s));
        }
    }
    return points;
}

// Above 0: clockwise on screen.
double area_of(const std::vector<Vec2>& points) {
    double area = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) area += cross(points[i], points[(i + 1) % points.size()]);
    return area;
}

bool contains(const std::vector<Vec2>& outline, Vec2 p) {
    bool inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
        const Vec2 a = outline[i], b = outline[j];
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
    }
    return inside;
}

// In the document's unit first: with the identity as transform the numbers stay as they are written.
std::vector<Subpath> read_path_data(Reading& reading, const JsonValue& value) {
    PathData data = parse_path_data(reading.json.text(value), {}, reading.tolerance);
    if (!data.problem.empty()) reading.json.refuse(value, data.problem);
    std::erase_if(data.subpaths, [](const Subpath& subpath) { return subpath.elements.empty(); });
    const auto finite = [](Vec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); };
    for (Subpath& subpath : data.subpaths)
        for (Element& e : subpath.elements) {
            e.p0 = reading.plane.metres(e.p0), e.p1 = reading.plane.metres(e.p1), e.p2 = reading.plane.metres(e.p2);
            if (!finite(e.p0) || !finite(e.p1) || !finite(e.p2)) reading.json.refuse(value, "path data has a number that is too large");
        }
    return std::move(data.subpaths);
}

void reverse(Elements& elements) {
    std::reverse(elements.begin(), elements.end());
    for (Element& e : elements) std::swap(e.p0, e.p2);
}

}  // namespace

std::vector<Subpath> read_curves(Reading& reading, const JsonValue& value) {
    JsonReader& json = reading.json;
    std::vector<Subpath> subpaths;
    if (value.is_list()) {
        std::vector<Vec2> points;
        for (const JsonValue& point : json.list(value, 2, std::size_t(-1))) points.push_back(reading.plane.metres(json.pair(point)));
        Elements elements = polyline(points);
        if (!elements.empty()) subpaths.push_back({.elements = std::move(elements), .closed = points.front() == points.back(), .start = points.front()});
    } else if (value.is_text()) {
        subpaths = read_path_data(reading, value);
    } else {
        json.expect(value, "path data as in SVG, or a list of points,");
    }
    if (subpaths.empty()) json.refuse(value, "it draws nothing; two points that differ work");
    return subpaths;
}

void close_outline(Reading& reading, const JsonValue& value, std::vector<Subpath>& subpaths) {
    if (subpaths.size() > kMaxOutlineSubpaths)
        return reading.json.refuse(value, std::to_string(subpaths.size()) + " subpaths in one outline, limit " + std::to_string(kMaxOutlineSubpaths) +
                                              "; several regions work", ErrorCode::limit_exceeded);
    std::vector<std::vector<Vec2>> polygons;
    for (Subpath& subpath : subpaths) {
        Elements& elements = subpath.elements;
        const Vec2 start = elements.front().p0, end = elements.back().p2;
        if (!(start == end)) elements.push_back({ElementKind::line, end, lerp(end, start, 0.5), start});
        polygons.push_back(flattened(elements));
        if (area_of(polygons.back()) == 0.0) return reading.json.refuse(value, "an outline encloses no area");
    }
    for (std::size_t i = 0; i < subpaths.size(); ++i) {
        bool hole = false;
        for (std::size_t k = 0; k < subpaths.size(); ++k)
            if (k != i && contains(polygons[k], polygons[i].front())) hole = !hole;
        if ((area_of(polygons[i]) > 0.0) == hole) reverse(subpaths[i].elements);
    }
}

}  // namespace burin::pattern_json
