#include <burin/path_data.hpp>

#include <algorithm>
#include <cmath>
#include <exception>

#include <2geom/elliptical-arc.h>
#include <2geom/path-sink.h>
#include <2geom/svg-path-parser.h>

namespace burin {
namespace {

// A curve that asks for more pieces is no drawing, and would take all memory.
constexpr int kMostPieces = 4096;

Element line_between(Vec2 a, Vec2 b) {
    Element e;
    e.p0 = a, e.p1 = lerp(a, b, 0.5), e.p2 = b;
    return e;
}

Element quadratic_between(Vec2 a, Vec2 control, Vec2 b) {
    Element e;
    e.kind = ElementKind::quadratic;
    e.p0 = a, e.p1 = control, e.p2 = b;
    return e;
}

struct Cubic {
    Vec2 p0, c0, c1, p1;
    Vec2 at(double t) const {
        const double s = 1.0 - t;
        return p0 * (s * s * s) + c0 * (3.0 * s * s * t) + c1 * (3.0 * s * t * t) + p1 * (t * t * t);
    }
    Vec2 tangent(double t) const {
        const double s = 1.0 - t;
        return ((c0 - p0) * (s * s) + (c1 - c0) * (2.0 * s * t) + (p1 - c1) * (t * t)) * 3.0;
    }
    // Third difference: 0 for a raised quadratic.
    Vec2 twist() const { return p1 - c1 * 3.0 + c0 * 3.0 - p0; }
};

// Where the tangents at both ends meet, or `usual` where they do not, or so far from there that the curve would be another one.
Vec2 common_control(Vec2 p0, Vec2 t0, Vec2 p1, Vec2 t1, Vec2 usual, double tolerance) {
    const double across = cross(t0, t1);
    if (std::abs(across) <= 1e-6 * length(t0) * length(t1)) return usual;
    const Vec2 control = p0 + t0 * (cross(p1 - p0, t1) / across);
    return length(control - usual) <= tolerance ? control : usual;
}

Vec2 of(const Geom::Point& p) { return {p[Geom::X], p[Geom::Y]}; }
Geom::Point of(Vec2 p) { return {p.x, p.y}; }

class Sink : public Geom::PathSink {
  public:
    explicit Sink(PathPen& pen) : pen_(pen) {}
    void moveTo(const Geom::Point& p) override { pen_.move_to(of(p)); }
    void lineTo(const Geom::Point& p) override { pen_.line_to(of(p)); }
    void curveTo(const Geom::Point& a, const Geom::Point& b, const Geom::Point& p) override { pen_.cubic_to(of(a), of(b), of(p)); }
    void quadTo(const Geom::Point& c, const Geom::Point& p) override { pen_.quadratic_to(of(c), of(p)); }
    void arcTo(double rx, double ry, double rotation, bool large, bool sweep, const Geom::Point& p) override {
        pen_.arc_to(rx, ry, rotation, large, sweep, of(p));
    }
    void closePath() override { pen_.close(); }
    void flush() override {}

  private:
    PathPen& pen_;
};

bool draw(const std::string& data, PathPen& pen) {
    Sink sink(pen);
    Geom::SVGPathParser parser(sink);
    try {
        parser.parse(data);
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

bool parses(const std::string& data) {
    PathPen pen({}, 1.0);
    return draw(data, pen);
}

// Whether data may begin so: with a few more numbers it is whole.
bool begins_well(const std::string& data) {
    for (const char* first : {"", "0"}) {
        std::string whole = data + first;
        for (int k = 0; k < 8; ++k, whole += " 0")
            if (parses(whole)) return true;
    }
    return false;
}

// The parser does not tell where it stops: at the first character with which no data can begin. Found by halving.
std::size_t stop_in(const std::string& data) {
    std::size_t good = 0, bad = data.size() + 1;
    while (bad - good > 1) {
        const std::size_t middle = good + (bad - good) / 2;
        (begins_well(data.substr(0, middle)) ? good : bad) = middle;
    }
    return good;
}

std::string problem_at(const std::string& data, std::size_t stop) {
    if (stop == data.size()) return "path data ends too early";
    const std::size_t from = stop < 12 ? 0 : stop - 12;
    return "path data has '" + data.substr(stop, 1) + "' at character " + std::to_string(stop + 1) + ", behind '" +
           data.substr(from, stop - from) + "'";
}

// The longest beginning that is whole.
std::string whole_part(const std::string& data, std::size_t stop) {
    constexpr int kMostTries = 256;
    for (int tries = 0; stop > 0 && tries < kMostTries; --stop, ++tries)
        if (parses(data.substr(0, stop))) return data.substr(0, stop);
    return "";
}

}  // namespace

Affine operator*(const Affine& outer, const Affine& inner) {
    if (outer.identity()) return inner;
    if (inner.identity()) return outer;
    const Vec2 u = outer.direction({inner.a, inner.b}), v = outer.direction({inner.c, inner.d}), o = outer({inner.e, inner.f});
    return {u.x, u.y, v.x, v.y, o.x, o.y};
}

Subpath& PathPen::current() {
    // After Z a drawing command goes on from the start of the subpath that was closed.
    if (!open_) move_to(start_);
    return subpaths_.back();
}

void PathPen::append(const Element& element) {
    const bool nothing = element.p0 == element.p2 && (element.kind == ElementKind::line || element.p1 == element.p0);
    if (!nothing) subpaths_.back().elements.push_back(element);
}

void PathPen::move_to(Vec2 p) {
    here_ = start_ = p;
    open_ = true;
    subpaths_.push_back({{}, false, false, transform_(p)});
}

void PathPen::line_to(Vec2 p) {
    current();
    append(line_between(transform_(here_), transform_(p)));
    here_ = p;
}

void PathPen::quadratic_to(Vec2 control, Vec2 p) {
    current();
    append(quadratic_between(transform_(here_), transform_(control), transform_(p)));
    here_ = p;
}

void PathPen::cubic_to(Vec2 control0, Vec2 control1, Vec2 p) {
    current();
    const Cubic cubic{transform_(here_), transform_(control0), transform_(control1), transform_(p)};
    here_ = p;
    const Vec2 twist = cubic.twist();
    const double largest = std::max({length(cubic.c0 - cubic.p0), length(cubic.c1 - cubic.p0), length(cubic.p1 - cubic.p0)});
    if (length(twist) <= 1e-9 * largest) {
        append(quadratic_between(cubic.p0, ((cubic.c0 + cubic.c1) * 3.0 - cubic.p0 - cubic.p1) * 0.25, cubic.p1));
        return;
    }
    // A quadratic with the same ends and middle lies within sqrt(3)/36 of the twist; half of the tolerance is for common tangents.
    const double error = std::sqrt(3.0) / 36.0 * length(twist);
    const int pieces = std::clamp(static_cast<int>(std::ceil(std::cbrt(2.0 * error / tolerance_))), 1, kMostPieces);
    Vec2 from = cubic.p0;
    for (int k = 0; k < pieces; ++k) {
        const double t0 = double(k) / pieces, t1 = double(k + 1) / pieces;
        const Vec2 to = k + 1 == pieces ? cubic.p1 : cubic.at(t1);
        const Vec2 middle = cubic.at(0.5 * (t0 + t1)) * 2.0 - (from + to) * 0.5;
        append(quadratic_between(from, common_control(from, cubic.tangent(t0), to, cubic.tangent(t1), middle, tolerance_), to));
        from = to;
    }
}

void PathPen::arc_to(double rx, double ry, double rotation, bool large, bool sweep, Vec2 p) {
    if (!(std::abs(rx) > 0.0 && std::abs(ry) > 0.0) || p == here_) return line_to(p);
    current();
    const Geom::EllipticalArc arc(of(here_), std::abs(rx), std::abs(ry), rotation, large, sweep, of(p));
    const Geom::Affine unit = arc.unitCircleTransform();
    const Affine to_plane = transform_ * Affine{unit[0], unit[1], unit[2], unit[3], unit[4], unit[5]};
    const double begin = arc.initialAngle().radians(), sweep_angle = arc.sweepAngle();
    // A quadratic over an angle of the unit circle leaves it by about angle^4 / 128, which the transform stretches.
    const double stretch = std::hypot(std::hypot(to_plane.a, to_plane.b), std::hypot(to_plane.c, to_plane.d));
    const double angle = std::min(std::pow(128.0 * tolerance_ / stretch, 0.25), 1.5);
    const int pieces = std::clamp(static_cast<int>(std::ceil(std::abs(sweep_angle) / angle)), 1, kMostPieces);
    const double step = sweep_angle / pieces, reach = 1.0 / std::cos(0.5 * step);
    Vec2 from = transform_(here_);
    here_ = p;
    for (int k = 0; k < pieces; ++k) {
        const double middle = begin + (k + 0.5) * step, end = begin + (k + 1) * step;
        const Vec2 to = k + 1 == pieces ? transform_(p) : to_plane({std::cos(end), std::sin(end)});
        append(quadratic_between(from, to_plane({reach * std::cos(middle), reach * std::sin(middle)}), to));
        from = to;
    }
}

void PathPen::close() {
    if (!open_) return;
    Subpath& subpath = subpaths_.back();
    const Vec2 here = transform_(here_), start = transform_(start_);
    // Relative coordinates come back to the start but for rounding.
    const bool back = !subpath.elements.empty() && length(here - start) < 0.01 * tolerance_;
    if (back) subpath.elements.back().p2 = start;
    else if (!(here == start)) append(line_between(here, start)), subpath.closing_line = true;
    subpath.closed = !subpath.elements.empty();
    here_ = start_;
    open_ = false;
}

std::vector<Subpath> PathPen::finish() { return std::move(subpaths_); }

PathData parse_path_data(std::string_view text, const Affine& transform, double tolerance) {
    const std::string data(text);
    PathData out;
    PathPen pen(transform, tolerance);
    if (!draw(data, pen)) {
        const std::size_t stop = stop_in(data);
        out.problem = problem_at(data, stop);
        pen = PathPen(transform, tolerance);
        draw(whole_part(data, stop), pen);
    }
    out.subpaths = pen.finish();
    return out;
}

}  // namespace burin
