#include "drawing.hpp"

#include <algorithm>
#include <cmath>

namespace burin::scenes {
namespace {

Vec2 point_on(const Element& e, double s) {
    if (e.kind == ElementKind::line) return lerp(e.p0, e.p2, s);
    return lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
}

double length_of(const Element& e) {
    if (e.kind == ElementKind::line) return length(e.p2 - e.p0);
    constexpr int kSteps = 32;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) sum += length(point_on(e, (i + 1.0) / kSteps) - point_on(e, double(i) / kSteps));
    return sum;
}

// The part of an element between two curve parameters; its ends are the element's own where it reaches them.
Element part_of(const Element& e, double from, double to) {
    Element part = e;
    if (from > 0.0) part.p0 = point_on(e, from);
    if (to < 1.0) part.p2 = point_on(e, to);
    // Control point of the part: the blossom of the curve at both parameters.
    if (e.kind == ElementKind::quadratic)
        part.p1 = lerp(lerp(e.p0, e.p1, from), lerp(e.p1, e.p2, from), to);
    return part;
}

Vec2 turned(Vec2 spoke, double angle) {
    return {spoke.x * std::cos(angle) - spoke.y * std::sin(angle), spoke.x * std::sin(angle) + spoke.y * std::cos(angle)};
}

}  // namespace

Stroke& Stroke::line(Vec2 to) {
    Element element;
    element.p0 = at_;
    element.p2 = to;
    path_.elements.push_back(element);
    at_ = to;
    return *this;
}

Stroke& Stroke::curve(Vec2 control, Vec2 to) {
    line(to);
    path_.elements.back().kind = ElementKind::quadratic;
    path_.elements.back().p1 = control;
    return *this;
}

Stroke& Stroke::arc(Vec2 centre, double turn, double piece) {
    const int parts = std::max(1, int(std::ceil(std::abs(turn) / piece - 1e-9)));
    const double half = turn / parts / 2.0;
    const Vec2 spoke = at_ - centre;
    for (int i = 0; i < parts; ++i)
        curve(centre + turned(spoke, (2 * i + 1) * half) * (1.0 / std::cos(half)), centre + turned(spoke, (2 * i + 2) * half));
    return *this;
}

Stroke& Stroke::close() {
    const Vec2 first = path_.elements.front().p0;
    if (length(at_ - first) > 1e-9 * path_length(path_)) line(first);
    path_.elements.back().p2 = first;
    path_.closed = true;
    return *this;
}

Stroke& Stroke::close_across() {
    path_.closed = true;
    return *this;
}

Path Stroke::path(std::uint32_t profile, std::uint32_t material, double level) const {
    Path path = path_;
    path.profile = profile;
    path.material = material;
    path.level = level;
    return path;
}

Stroke polyline(const std::vector<Vec2>& points) {
    Stroke stroke(points.front());
    for (std::size_t i = 1; i < points.size(); ++i) stroke.line(points[i]);
    return stroke;
}

Stroke polygon(const std::vector<Vec2>& points) { return polyline(points).close(); }

Stroke circle(Vec2 centre, double radius, double piece) {
    return Stroke(centre + Vec2{radius, 0.0}).arc(centre, 2.0 * kPi, piece).close();
}

Stroke slab(Vec2 c, Vec2 half, double r) {
    const double x0 = c.x - half.x, x1 = c.x + half.x, y0 = c.y - half.y, y1 = c.y + half.y, q = kPi / 2;
    return Stroke({x0 + r, y0}).line({x1 - r, y0}).arc({x1 - r, y0 + r}, q).line({x1, y1 - r}).arc({x1 - r, y1 - r}, q)
        .line({x0 + r, y1}).arc({x0 + r, y1 - r}, q).line({x0, y0 + r}).arc({x0 + r, y0 + r}, q).close();
}

Stroke smooth(const std::function<Vec2(double)>& at, int pieces) {
    constexpr double kStep = 1e-5;
    Stroke stroke(at(0.0));
    Vec2 from = at(0.0);
    for (int i = 0; i < pieces; ++i) {
        const double s0 = double(i) / pieces, s1 = double(i + 1) / pieces;
        const Vec2 to = at(s1), chord = to - from;
        const Vec2 t0 = unit(at(s0 + kStep) - at(s0 - kStep)), t1 = unit(at(s1 + kStep) - at(s1 - kStep));
        // Where the tangents meet, along each of them; both ahead, and neither far off the chord.
        const double turn = cross(t0, t1);
        const double ahead = cross(chord, t1) / turn, behind = cross(t0, chord) / turn, far = 2.0 * length(chord);
        if (std::abs(turn) > 0.01 && ahead > 0.0 && behind > 0.0 && ahead < far && behind < far)
            stroke.curve(from + t0 * ahead, to);
        else
            stroke.line(to);
        from = to;
    }
    return stroke;
}

Path mapped(Path path, const std::function<Vec2(Vec2)>& to) {
    for (Element& e : path.elements) {
        e.p0 = to(e.p0);
        e.p1 = to(e.p1);
        e.p2 = to(e.p2);
    }
    return path;
}

Pattern enlarged(Pattern pattern, double factor) {
    pattern.size = pattern.size * factor;
    pattern.depth *= factor;
    pattern.base_offset *= factor;
    pattern.outer_level *= factor;
    for (Profile& profile : pattern.profiles)
        for (ProfilePoint& point : profile.points) point = {point.b * factor, point.h * factor};
    for (Path& path : pattern.paths) {
        path = mapped(std::move(path), [factor](Vec2 q) { return q * factor; });
        path.level *= factor;
    }
    for (Perturbation& perturbation : pattern.perturbations) perturbation.wavelength *= factor;
    return pattern;
}

Pattern enlarged_to(Pattern pattern, Vec2 size) {
    const double factor = std::sqrt(size.x * size.y / (pattern.size.x * pattern.size.y));
    return enlarged(std::move(pattern), factor);
}

double path_length(const Path& path) {
    double sum = 0.0;
    for (const Element& e : path.elements) sum += length_of(e);
    return sum;
}

Path scaled(const Path& path, const std::function<double(double)>& width, const std::function<double(double)>& height,
            double tolerance) {
    const double whole = path_length(path);
    // Greatest distance of a function from its chord over [from, to].
    const auto clamped = [](const std::function<double(double)>& f, double s) { return std::max(0.0, f(s)); };
    const auto off = [](const std::function<double(double)>& f, double from, double to) {
        double worst = 0.0;
        for (double k : {0.25, 0.5, 0.75})
            worst = std::max(worst, std::abs(f(from + (to - from) * k) - f(from) - (f(to) - f(from)) * k));
        return worst;
    };
    Path result = path;
    result.elements.clear();
    double begin = 0.0;
    for (const Element& e : path.elements) {
        const double share = length_of(e) / whole;
        int parts = 1;
        const auto fits = [&] {
            for (int i = 0; i < parts; ++i) {
                const double from = begin + share * i / parts, to = begin + share * (i + 1) / parts;
                if (std::max(off(width, from, to), off(height, from, to)) > tolerance) return false;
            }
            return true;
        };
        while (parts < 64 && !fits()) ++parts;
        for (int i = 0; i < parts; ++i) {
            Element part = part_of(e, double(i) / parts, double(i + 1) / parts);
            part.width0 = clamped(width, begin + share * i / parts);
            part.width1 = clamped(width, begin + share * (i + 1) / parts);
            part.height0 = clamped(height, begin + share * i / parts);
            part.height1 = clamped(height, begin + share * (i + 1) / parts);
            // Neighbours are copies of each other where they meet.
            if (!result.elements.empty()) part.p0 = result.elements.back().p2;
            result.elements.push_back(part);
        }
        begin += share;
    }
    return result;
}

Path with_sine(const Path& path, double width_amplitude, double height_amplitude, double wavelength) {
    double waves = path_length(path) / wavelength;
    if (path.closed) waves = std::max(1.0, std::round(waves));
    const auto wave = [=](double amplitude) {
        return [=](double s) { return 1.0 + amplitude * std::sin(2.0 * kPi * waves * s); };
    };
    return scaled(path, wave(width_amplitude), wave(height_amplitude), 0.06);
}

void add_courses(Pattern& p, int courses, int stones, std::uint32_t profile, std::uint32_t material) {
    const Vec2 stone{p.size.x / stones, p.size.y / courses};
    for (int row = 0; row < courses; ++row) {
        const double y = stone.y * (row + 0.5);
        p.paths.push_back(Stroke({0.0, y}).line({p.size.x, y}).close_across().path(profile, material));
        for (int k = 0; k < stones; ++k) {
            const double x = stone.x * (k + 0.25 + 0.5 * (row % 2));
            p.paths.push_back(polyline({{x, y}, {x, y + stone.y}}).path(profile, material));
        }
    }
}

}  // namespace burin::scenes
