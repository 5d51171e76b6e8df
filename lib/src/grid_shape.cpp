#include "grid_shape.hpp"

#include <algorithm>
#include <cmath>

#include "resolve_curve.hpp"
#include "scale_function.hpp"

namespace burin::gridding {
namespace {

// Extent of a profile along b.
struct Extent {
    double low = 0.0, high = 0.0;
};

Extent extent_of(const ResolvedProfile& profile) {
    Extent extent{1e300, -1e300};
    for (const ProfilePoint& p : profile.points) {
        extent.low = std::min(extent.low, p.b);
        extent.high = std::max(extent.high, p.b);
    }
    return extent;
}

void finish(Shape& shape) {
    for (int i = 0; i < shape.count; ++i) {
        const Vec2 p = shape.corners[i];
        shape.box.low = {std::min(shape.box.low.x, p.x), std::min(shape.box.low.y, p.y)};
        shape.box.high = {std::max(shape.box.high.x, p.x), std::max(shape.box.high.y, p.y)};
    }
    shape.box.low = shape.box.low - Vec2{shape.grow, shape.grow};
    shape.box.high = shape.box.high + Vec2{shape.grow, shape.grow};
}

// Collects the shapes of one element.
class Outline {
  public:
    Outline(const ResolvedPattern& pattern, const ResolvedElement& element, Joints joints, double piece)
        : pattern_(pattern),
          resolved_(element),
          element_(element.element),
          style_(pattern.styles[element.style]),
          piece_(piece),
          extent_(extent_of(pattern.profiles[style_.profile])) {
        // A relative growth far below the promised thousandth covers rounding.
        grow_ =
            1e-7 * (extent_.high - extent_.low) + 1e-12 * (std::abs(element_.p0.x) + std::abs(element_.p0.y));
        add_body(0.0, 1.0, 0);
        const Scales from = scales_over(0.0, 0.0), to = scales_over(1.0, 1.0);
        add_end(element.start, element_.p0, curve::tangent(element_, 0.0), -1.0, from.width[1], from.height[1], joints.start);
        add_end(element.end, element_.p2, curve::tangent(element_, 1.0), 1.0, to.width[1], to.height[1], joints.end);
    }

    std::vector<Shape> take() { return std::move(shapes_); }

  private:
    // Least and greatest scales between two parameters, and the widths that bound the strip at both.
    struct Scales {
        double width[2], height[2], from, to;
    };
    Scales scales_over(double s0, double s1) const {
        const auto at = [](double a, double b, double s) { return a + (b - a) * s; };
        const double w0 = at(element_.width0, element_.width1, s0), w1 = at(element_.width0, element_.width1, s1);
        const double h0 = at(element_.height0, element_.height1, s0), h1 = at(element_.height0, element_.height1, s1);
        const auto [low, high] = std::minmax(w0, w1);
        if (resolved_.function == kNoFunction) return {{low, high}, {std::min(h0, h1), std::max(h0, h1)}, w0, w1};
        const FactorRange f = factor_range(pattern_, resolved_, s0, s1);
        return {{low * f.width_low, high * f.width_high},
                {std::min(h0, h1) * f.height_low, std::max(h0, h1) * f.height_high},
                w0 * f.width_high, w1 * f.width_high};
    }
    // Whether the function along the path changes so much there that one strip would not be tight.
    bool is_wavy(const Scales& scales) const {
        return resolved_.function != kNoFunction &&
               (scales.width[1] - scales.width[0] > 0.15 * scales.width[1] + 1e-3 ||
                scales.height[1] - scales.height[0] > 0.15 * scales.height[1] + 1e-3);
    }

    // Halves the arc until a piece is short, turns little and runs at nearly even speed: then its strip lies
    // within the quadrilateral of its four corners, grown by the chord's sag and by what the normals' arc
    // leaves their chord.
    void add_body(double s0, double s1, int depth) {
        const Vec2 a = curve::point(element_, s0), b = curve::point(element_, s1);
        const Vec2 ta = curve::tangent(element_, s0), tb = curve::tangent(element_, s1);
        const double turn = std::atan2(std::abs(cross(ta, tb)), dot(ta, tb));
        const double speed_a = length(curve::derivative(element_, s0)),
                     speed_b = length(curve::derivative(element_, s1));
        const bool even = std::max(speed_a, speed_b) <= 1.2 * std::min(speed_a, speed_b) || turn < 1e-6;
        const Scales scales = scales_over(s0, s1);
        const bool wavy = is_wavy(scales) && length(b - a) > 0.05 * piece_;
        if ((length(b - a) > piece_ || turn > 0.06 || !even || wavy) && depth < 12) {
            const double middle = 0.5 * (s0 + s1);
            add_body(s0, middle, depth + 1);
            add_body(middle, s1, depth + 1);
            return;
        }
        const double w0 = scales.from, w1 = scales.to;
        const double reach = std::max(std::abs(extent_.low), std::abs(extent_.high)) * std::max(w0, w1);
        const double span = s1 - s0;
        Shape shape;
        shape.sag = element_.kind == ElementKind::line
                        ? 0.0
                        : 0.25 * span * span * length(element_.p0 - 2.0 * element_.p1 + element_.p2);
        shape.grow = grow_ + shape.sag + reach * (0.5 * turn * turn + (even ? 0.05 : 1.0) * turn) +
                     (even && element_.kind == ElementKind::line
                          ? 0.0
                          : 0.1 * reach * std::abs(w1 - w0) / std::max({w0, w1, 1e-9}));
        const Vec2 na = normal_of(ta), nb = normal_of(tb);
        shape.corners = {a + na * (extent_.low * w0), b + nb * (extent_.low * w1),
                         b + nb * (extent_.high * w1), a + na * (extent_.high * w0)};
        shape.count = 4;
        shape.body = true;
        shape.origin = a;
        shape.normal = normal_of(unit(b - a));
        shape.blur =
            grow_ + shape.sag + 0.01 * reach * (turn > 0.0 ? 1.0 : 0.0) + (turn > 0.0 ? shape.grow : 0.0);
        shape.width_low = scales.width[0], shape.width_high = scales.width[1];
        shape.height_low = scales.height[0], shape.height_high = scales.height[1];
        shape.path_line = style_.step;
        shape.chord[0] = a, shape.chord[1] = b;
        finish(shape);
        shapes_.push_back(shape);
    }

    void add_polygon(std::initializer_list<Vec2> corners, double width, double height, bool end_zone) {
        Shape shape;
        for (const Vec2 p : corners) shape.corners[shape.count++] = p;
        shape.grow = grow_;
        shape.width_low = shape.width_high = width;
        shape.height_low = shape.height_high = height;
        shape.end_zone = end_zone;
        finish(shape);
        shapes_.push_back(shape);
    }

    // What an end lets act beyond its normal. `outward` is +1 at the end, -1 at the start.
    void add_end(const ElementEnd& end, Vec2 at, Vec2 tangent, double outward, double width, double height,
                 bool joint) {
        const Vec2 out = tangent * outward, normal = normal_of(tangent);
        const double low = extent_.low * width, high = extent_.high * width;
        // The cut across the strip itself: a decoder has to look at the end wherever this is seen.
        if (!joint) add_polygon({at + normal * low, at + normal * high}, width, height, true);
        if (end.priority == Priority::none) return;
        for (const bool right : {false, true}) {
            const double near = right ? std::max(low, 0.0) : std::min(high, 0.0), far = right ? high : low;
            if (right ? far <= 0.0 : far >= 0.0) continue;
            const bool given = end.priority == Priority::both || (end.priority == Priority::right) == right;
            if (given) add_side(end, {at, out, normal, near, far, width, height, !joint});
        }
    }

    // One side of an end's extension: offsets from near to far along the normal.
    struct Side {
        Vec2 at, out, normal;
        double near, far, width, height;
        bool end_zone;
    };

    void add_side(const ElementEnd& end, const Side& side) {
        const bool cap = end.priority == Priority::both;
        if (cap && end.shape == static_cast<std::uint8_t>(EndShape::hip))
            add_cap(side, 1.0);
        else if (cap && end.shape == static_cast<std::uint8_t>(EndShape::round))
            add_cap(side, std::tan(3.14159265358979323846 / 8.0));
        else if (cap || end.shape == static_cast<std::uint8_t>(CornerShape::mitre))
            add_clipped(end, side);
        else
            add_fan(end, side);
    }

    // A square (cut = 1) or, around a quarter disc, a square with its corner cut off.
    void add_cap(const Side& side, double cut) {
        const double r = std::abs(side.far);
        const Vec2 across = side.normal * side.far, ahead = side.out * r;
        add_polygon({side.at, side.at + across, side.at + across + ahead * cut,
                     side.at + across * cut + ahead, side.at + ahead},
                    side.width, side.height, side.end_zone);
    }

    // Up to the clip line: how far it lies ahead grows with b.
    void add_clipped(const ElementEnd& end, const Side& side) {
        const Vec2 clip = {std::cos(end.clip_angle), std::sin(end.clip_angle)};
        const double along = cross(side.out, clip);
        if (std::abs(along) < 1e-9) return;
        const double slope = -cross(side.normal, clip) / along;
        if (slope * side.far <= 0.0) return;
        add_polygon({side.at + side.normal * side.near, side.at + side.normal * side.far,
                     side.at + side.normal * side.far + side.out * (slope * side.far),
                     side.at + side.normal * side.near + side.out * std::max(0.0, slope * side.near)},
                    side.width, side.height, side.end_zone);
    }

    // Bevel and round: between the normal and the clip line, no farther from the vertex than the profile
    // reaches.
    void add_fan(const ElementEnd& end, const Side& side) {
        const Vec2 outer = side.normal * (side.far > 0.0 ? 1.0 : -1.0);
        Vec2 middle = {std::cos(end.clip_angle), std::sin(end.clip_angle)};
        if (dot(middle, outer) < 0.0) middle = -middle;
        const double r = std::abs(side.far), half = std::acos(std::clamp(dot(middle, outer), -1.0, 1.0));
        add_polygon({side.at, side.at + outer * r,
                     side.at + unit(outer + unit(outer + middle)) * (r / std::cos(0.25 * half)),
                     side.at + unit(middle + unit(outer + middle)) * (r / std::cos(0.25 * half)),
                     side.at + middle * r},
                    side.width, side.height, side.end_zone);
    }

    const ResolvedPattern& pattern_;
    const ResolvedElement& resolved_;
    const Element& element_;
    const Style& style_;
    double piece_, grow_ = 0.0;
    Extent extent_;
    std::vector<Shape> shapes_;
};

// Separating axis: the edge normals of a convex polygon and the axes.
bool separated(const Vec2* corners, int count, double grow, const Box& r) {
    for (int i = 0; i < count; ++i) {
        const Vec2 a = corners[i], b = corners[(i + 1) % count];
        const Vec2 edge = b - a;
        const double l = length(edge);
        if (l <= 0.0) continue;
        const Vec2 axis = normal_of(edge * (1.0 / l));
        double low = 1e300, high = -1e300;
        for (int k = 0; k < count; ++k) {
            const double t = dot(corners[k], axis);
            low = std::min(low, t), high = std::max(high, t);
        }
        const double x0 = axis.x * r.low.x, x1 = axis.x * r.high.x, y0 = axis.y * r.low.y,
                     y1 = axis.y * r.high.y;
        if (std::min(x0, x1) + std::min(y0, y1) > high + grow ||
            std::max(x0, x1) + std::max(y0, y1) < low - grow)
            return true;
    }
    return false;
}

}  // namespace

std::vector<Shape> shapes_of(const ResolvedPattern& pattern, const ResolvedElement& element, Joints joints,
                             double piece) {
    return Outline(pattern, element, joints, piece).take();
}

bool meets(const Shape& shape, const Box& rectangle) {
    if (shape.box.low.x > rectangle.high.x || shape.box.low.y > rectangle.high.y ||
        shape.box.high.x < rectangle.low.x || shape.box.high.y < rectangle.low.y)
        return false;
    return !separated(shape.corners.data(), shape.count, shape.grow, rectangle);
}

bool segment_meets(Vec2 a, Vec2 b, double grow, const Box& r) {
    if (std::min(a.x, b.x) - grow > r.high.x || std::min(a.y, b.y) - grow > r.high.y ||
        std::max(a.x, b.x) + grow < r.low.x || std::max(a.y, b.y) + grow < r.low.y)
        return false;
    const Vec2 corners[2] = {a, b};
    return !separated(corners, 2, grow, r);
}

HeightRange profile_range(const ResolvedProfile& profile, double b_low, double b_high) {
    HeightRange range;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
        const ProfilePoint p = profile.points[i], q = profile.points[i + 1];
        const double low = std::max(b_low, std::min(p.b, q.b)), high = std::min(b_high, std::max(p.b, q.b));
        if (low > high) continue;
        const auto at = [&](double b) {
            return p.h + (q.h - p.h) * std::clamp((b - p.b) / (q.b - p.b), 0.0, 1.0);
        };
        const double h0 = p.b == q.b ? p.h : at(low), h1 = p.b == q.b ? q.h : at(high);
        range.high = std::max({range.high, h0, h1});
        if (profile.internal_mask >> i & 1u) range.low = std::min({range.low, h0, h1});
    }
    return range;
}

HeightRange heights_in(const Shape& shape, const ResolvedProfile& profile, const Box& r) {
    double low = -1e300, high = 1e300;
    if (shape.body) {
        const Vec2 n = shape.normal;
        const double at = dot(shape.origin, n);
        low = std::min(n.x * r.low.x, n.x * r.high.x) + std::min(n.y * r.low.y, n.y * r.high.y) - at -
              shape.blur;
        high = std::max(n.x * r.low.x, n.x * r.high.x) + std::max(n.y * r.low.y, n.y * r.high.y) - at +
               shape.blur;
        // Offsets count in width scales; the smaller scale makes them larger.
        const double tiny = 1e-9;
        low = std::min(low / std::max(shape.width_low, tiny), low / std::max(shape.width_high, tiny));
        high = std::max(high / std::max(shape.width_low, tiny), high / std::max(shape.width_high, tiny));
    }
    HeightRange range = profile_range(profile, low, high);
    if (range.high > -1e299)
        range.high = std::max(range.high * shape.height_low, range.high * shape.height_high);
    if (range.low < 1e299) range.low = std::min(range.low * shape.height_low, range.low * shape.height_high);
    return range;
}

}  // namespace burin::gridding
