#include "drawing.hpp"

#include <algorithm>
#include <cmath>

namespace burin::bench {
namespace {

Vec2 on_circle(Vec2 centre, double radius, double angle) {
    return centre + Vec2{std::cos(angle), std::sin(angle)} * radius;
}

// Linear between values at equal steps of [0, 1].
double between(const std::vector<double>& values, double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(place), values.size() - 1);
    return i + 1 < values.size() ? std::lerp(values[i], values[i + 1], place - static_cast<double>(i)) : values[i];
}

}  // namespace

Stroke& Stroke::line(Vec2 to) {
    Element e;
    e.p0 = at_;
    e.p2 = at_ = to;
    elements_.push_back(e);
    return *this;
}

Stroke& Stroke::quadratic(Vec2 control, Vec2 to) {
    line(to);
    elements_.back().kind = ElementKind::quadratic;
    elements_.back().p1 = control;
    return *this;
}

Stroke& Stroke::arc(Vec2 centre, double radius, double from, double to) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / 0.3927)));
    const double turn = (to - from) / pieces;
    for (int i = 0; i < pieces; ++i) {
        const double angle = from + i * turn;
        quadratic(on_circle(centre, radius / std::cos(0.5 * turn), angle + 0.5 * turn),
                  on_circle(centre, radius, angle + turn));
    }
    return *this;
}

Stroke& Stroke::close() {
    constexpr double kThere = 1e-9 * kSheet;
    const Vec2 start = elements_.front().p0;
    if (length(at_ - start) > kThere) line(start);
    elements_.back().p2 = at_ = start;
    closed_ = true;
    return *this;
}

Stroke& Stroke::close_across() {
    closed_ = true;
    return *this;
}

Stroke& Stroke::taper(const std::vector<double>& widths, const std::vector<double>& heights) {
    const double count = static_cast<double>(elements_.size());
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        const double from = static_cast<double>(i) / count, to = static_cast<double>(i + 1) / count;
        elements_[i].width0 = between(widths, from), elements_[i].width1 = between(widths, to);
        elements_[i].height0 = between(heights, from), elements_[i].height1 = between(heights, to);
    }
    return *this;
}

Stroke Stroke::placed(double scale, double angle, Vec2 shift) const {
    const Vec2 along = Vec2{std::cos(angle), std::sin(angle)} * scale, across = normal_of(along);
    const auto place = [&](Vec2 p) { return shift + along * p.x + across * p.y; };
    Stroke out = *this;
    for (Element& e : out.elements_) e.p0 = place(e.p0), e.p1 = place(e.p1), e.p2 = place(e.p2);
    out.at_ = place(at_);
    return out;
}

Stroke polyline(const std::vector<Vec2>& points, bool closed) {
    Stroke stroke(points.front());
    for (std::size_t i = 1; i < points.size(); ++i) stroke.line(points[i]);
    if (closed) stroke.close();
    return stroke;
}

Stroke arc(Vec2 centre, double radius, double from, double to) {
    return Stroke(on_circle(centre, radius, from)).arc(centre, radius, from, to);
}

Stroke circle(Vec2 centre, double radius) { return arc(centre, radius, 0.0, 4.0 * kQuarter).close(); }

Stroke slab(Vec2 centre, Vec2 half, double radius, double angle) {
    const Vec2 along{std::cos(angle), std::sin(angle)}, across = normal_of(along);
    const auto corner = [&](double x, double y) {
        return centre + along * (x * (half.x - radius)) + across * (y * (half.y - radius));
    };
    const Vec2 corners[4] = {corner(1, -1), corner(1, 1), corner(-1, 1), corner(-1, -1)};
    Stroke stroke(on_circle(corners[0], radius, angle - kQuarter));
    for (int i = 0; i < 4; ++i) {
        const double from = angle + (i - 1) * kQuarter;
        if (i > 0) stroke.line(on_circle(corners[i], radius, from));
        stroke.arc(corners[i], radius, from, from + kQuarter);
    }
    return stroke.close();
}

Drawing::Drawing(int texels, double wall, double ground, Wrap wrap) : texel_(1.0 / texels), ramp_(0.5 * wall / texels) {
    pattern_.size = {1.0, 1.0};
    pattern_.depth = 0.01;
    pattern_.base_offset = (1.0 - ground) * pattern_.depth;
    pattern_.wrap = wrap;
}

std::uint32_t Drawing::add(Profile profile) {
    const auto same = [&](const Profile& other) {
        return std::equal(other.points.begin(), other.points.end(), profile.points.begin(), profile.points.end(),
                          [](const ProfilePoint& a, const ProfilePoint& b) { return a.b == b.b && a.h == b.h; });
    };
    const auto known = std::find_if(pattern_.profiles.begin(), pattern_.profiles.end(), same);
    const auto index = static_cast<std::uint32_t>(known - pattern_.profiles.begin());
    if (known == pattern_.profiles.end()) pattern_.profiles.push_back(std::move(profile));
    return index;
}

Pen Drawing::groove(double width, double depth) {
    const double half = 0.5 * width * texel_, low = -depth * pattern_.depth;
    if (half <= ramp_) return {add({{{-2.0 * half, 0}, {0, low}, {2.0 * half, 0}}, {}}), 0.0};
    return {add({{{-half - ramp_, 0}, {-half + ramp_, low}, {half - ramp_, low}, {half + ramp_, 0}}, {}}), 0.0};
}

Pen Drawing::step(double height) { return {add({{{-ramp_, 0}, {ramp_, height * pattern_.depth}}, {}}), 0.0}; }

Pen Drawing::on(Pen pen, double level) const { return {pen.profile, pen.level + level * pattern_.depth}; }

void Drawing::draw(Pen pen, const Stroke& stroke) {
    Path path;
    path.profile = pen.profile;
    path.level = pen.level;
    path.closed = stroke.closed();
    path.elements = stroke.placed(1.0 / kSheet, 0.0, {}).elements();
    pattern_.paths.push_back(std::move(path));
}

}  // namespace burin::bench
