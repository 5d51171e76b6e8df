// Breakpoints worth trying.
#include <algorithm>
#include <array>
#include <cmath>

#include "fit_piece.hpp"

namespace burin::fit {

namespace {

void split_span(const Points& points, long first, long last, double tolerance, std::vector<long>& out) {
    // Own stack: a contour of a million points would otherwise recurse as deep.
    std::vector<std::array<long, 2>> open{{first, last}};
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        const Vec2 t = unit(points[b] - points[a]);
        const bool loop = length(points[b] - points[a]) == 0.0;
        double most = tolerance;
        long where = -1;
        for (long i = a + 1; i < b; ++i) {
            const Vec2 p = points[i] - points[a];
            const double e = loop ? length(p) : std::abs(cross(t, p));
            if (e > most) most = e, where = i;
        }
        if (where < 0) {
            out.push_back(b);
            continue;
        }
        open.push_back({where, b});
        open.push_back({a, where});
    }
}

}  // namespace

std::vector<long> candidates_of(const Points& points, double tolerance) {
    std::vector<long> out{0};
    if (!points.closed) {
        split_span(points, 0, points.end(), tolerance, out);
        return out;
    }
    // A loop is halved first at its furthest point: its chord has no direction of its own.
    long far = points.count / 2;
    for (long i = 1; i < points.count; ++i)
        if (length(points[i] - points[0]) > length(points[far] - points[0])) far = i;
    split_span(points, 0, far, tolerance, out);
    split_span(points, far, points.end(), tolerance, out);
    return out;
}

namespace {

// Adds the neighbours of sharp vertices: the polyline's vertex is the point furthest out, and a corner's
// sides may part one point before or after it.
std::vector<long> with_more_at_corners(const Points& points, const std::vector<long>& vertices) {
    std::vector<long> out{vertices[0]};
    for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
        const Vec2 here = points[vertices[i]];
        const Vec2 in = unit(here - points[vertices[i - 1]]), out_of = unit(points[vertices[i + 1]] - here);
        const bool sharp = dot(in, out_of) < 0.94;  // 20 degrees
        if (sharp && vertices[i] - 1 > out.back()) out.push_back(vertices[i] - 1);
        if (vertices[i] > out.back()) out.push_back(vertices[i]);
        if (sharp && vertices[i] + 1 < vertices[i + 1]) out.push_back(vertices[i] + 1);
    }
    out.push_back(vertices.back());
    return out;
}

// Adds candidates in bends. On an arc of radius r a quadratic spans about (256 tolerance r^3)^(1/4), see
// fit_curve; with six candidates to that length, ending at one of them instead of where it must costs a piece
// a twelfth of its length.
std::vector<long> with_more_in_bends(const Points& points, const std::vector<long>& vertices,
                                     double tolerance) {
    constexpr double kPerQuadratic = 6.0;
    const auto turn = [&](std::size_t i) {
        if (i == 0 || i + 1 >= vertices.size()) return 0.0;
        const Vec2 here = points[vertices[i]];
        const Vec2 in = unit(here - points[vertices[i - 1]]), out = unit(points[vertices[i + 1]] - here);
        const double a = std::abs(std::atan2(cross(in, out), dot(in, out)));
        return a < 1.2 ? a : 0.0;  // more is a corner
    };
    std::vector<long> out{vertices[0]};
    double before = turn(0);
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        const double after = turn(i);
        const long span = vertices[i] - vertices[i - 1];
        const double arc = points.arc(vertices[i]) - points.arc(vertices[i - 1]);
        const double radius = arc / std::max({before, after, 1e-3});
        const double spacing =
            std::sqrt(std::sqrt(256.0 * tolerance * radius * radius * radius)) / kPerQuadratic;
        const long parts = std::min({1L + static_cast<long>(arc / spacing), 6L, span});
        for (long k = 1; k < parts; ++k) out.push_back(vertices[i - 1] + span * k / parts);
        out.push_back(vertices[i]);
        before = after;
    }
    return out;
}

}  // namespace

std::vector<long> breakpoints_of(const Points& points, double tolerance) {
    // 0.6: a vertex then lies near every place where a piece within the tolerance has to end.
    const std::vector<long> vertices = candidates_of(points, 0.6 * tolerance);
    return with_more_in_bends(points, with_more_at_corners(points, vertices), tolerance);
}

}  // namespace burin::fit
