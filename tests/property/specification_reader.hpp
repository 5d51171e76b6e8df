// A reader of the two textures written from SPECIFICATION.md alone: bytes in, height out. It shares no code
// with burin's packer, validator, decoder or truth, and knows neither layout.h nor texels.hpp, so that a gap
// in that page shows.
//
// Slow and plain. Profiles that are height fields only: H(p) = min(max(ground, adds), cuts).
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <vector>

namespace burin::testing {

class SpecificationReader {
  public:
    struct Properties {  // of the extension's JSON
        double size[2] = {1, 1};
        double depth = 0, base_offset = 0, outer_level = 0;
        bool repeat = true;
        int grid_width = 0, grid_height = 0;
        unsigned elements = 0, styles = 0, profiles = 0, materials = 0, lists = 0;
    };

    SpecificationReader(const Properties& properties, std::vector<std::uint8_t> grid,
                        std::vector<std::uint8_t> data)
        : q_(properties), grid_(std::move(grid)), data_(std::move(data)) {}

    struct Answer {
        double height = 0, ground = 0;
        double lowest = 0, highest = 0;  // bounds that the cell states
        // How near the point is to a place where the answer may jump, in metres: tests leave those points
        // out.
        double clearance = 1e300;
    };

    // Height at uv, section 9.
    Answer height_at(double u, double v) const {
        Answer answer;
        if (!q_.repeat && (u < 0 || v < 0 || u >= 1 || v >= 1)) {
            answer.height = answer.ground = answer.lowest = answer.highest = q_.outer_level;
            return answer;
        }
        u -= std::floor(u), v -= std::floor(v);
        const int i = static_cast<int>(u * q_.grid_width), j = static_cast<int>(v * q_.grid_height);
        const std::size_t cell = 8u * static_cast<std::size_t>(j * q_.grid_width + i);
        const std::uint32_t x = word(grid_, cell), y = word(grid_, cell + 4);
        const Point p{u * q_.size[0], v * q_.size[1]};
        const double cu = (i + 0.5) / q_.grid_width, cv = (j + 0.5) / q_.grid_height;
        std::vector<Element> list;
        for (std::uint32_t k = 0; k < bits(x, 20, 25); ++k)
            list.push_back(element(reference(bits(x, 0, 19), k), cu, cv));
        std::uint32_t level = bits(y, 0, 15);
        // The start of the walk, section 5.
        const int k = static_cast<int>(bits(x, 26, 29));
        const double su = cu + ((771 * k + 510) % 1021 - 510) / 1361.0 / q_.grid_width;
        const double sv = cv + ((582 * k + 510) % 1021 - 510) / 1361.0 / q_.grid_height;
        if (bits(x, 31, 31)) level = ground_code(list, {su * q_.size[0], sv * q_.size[1]}, p, level);
        answer.ground = height_of(level);
        answer.highest = height_of(257 * bits(y, 16, 23));
        answer.lowest = height_of(257 * bits(y, 24, 31));
        double add = answer.ground, cut = 1e300;
        for (const Element& e : list) apply(e, p, level, add, cut, answer.clearance);
        answer.height = std::min(add, cut);
        return answer;
    }

  private:
    struct Point {
        double x, y;
    };
    struct End {
        Point v, out;  // vertex, tangent that points out of the element
        unsigned priority, shape;
        double clip;
    };
    struct Style {
        unsigned profile, points, left, right;
        bool step;
        double reach;
        std::uint32_t internal;
    };
    struct Element {
        Point p0, p1, p2;
        bool quadratic;
        double width[2], height[2];
        bool follows;  // a function
        unsigned function;
        double argument[2];
        End ends[2];
        Style style;
    };

    static Point sub(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
    static double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
    static double norm(Point a) { return std::hypot(a.x, a.y); }
    static Point unit(Point a) { return {a.x / norm(a), a.y / norm(a)}; }
    static Point normal(Point t) { return {-t.y, t.x}; }

    static std::uint32_t word(const std::vector<std::uint8_t>& bytes, std::size_t at) {
        return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 |
               static_cast<std::uint32_t>(bytes[at + 3]) << 24;
    }
    static std::uint32_t bits(std::uint32_t w, unsigned first, unsigned last) {
        return w >> first & static_cast<std::uint32_t>((std::uint64_t{1} << (last - first + 1)) - 1);
    }
    std::uint32_t data(unsigned texel, unsigned channel) const {
        return word(data_, 16u * texel + 4u * channel);
    }
    double height_of(std::uint32_t unorm16) const {
        return q_.base_offset - q_.depth * (1.0 - unorm16 / 65535.0);
    }
    static double snorm(std::uint32_t code) { return static_cast<std::int16_t>(code) / 32767.0; }
    static double coordinate(std::uint32_t w) { return bits(w, 0, 19) / 524288.0 - 0.5; }

    // Section 11.
    // Reference n of the list that a cell's bits 0-19 name, section 11.
    unsigned reference(std::uint32_t first, std::uint32_t n) const {
        const unsigned lists = q_.elements + q_.styles + q_.profiles + q_.materials;
        if (q_.elements > 65536) return data(lists + first + n / 4, n % 4);
        const std::uint32_t k = first + n;
        const std::uint32_t w = data(lists + k / 8, k % 8 / 2);
        return k % 2 == 0 ? bits(w, 0, 15) : bits(w, 16, 31);
    }

    // Section 7.
    Style style(unsigned index) const {
        const unsigned t = q_.elements + index;
        Style s{};
        s.profile = q_.elements + q_.styles + bits(data(t, 0), 0, 15);
        s.points = bits(data(t, 0), 16, 21);
        s.step = bits(data(t, 0), 22, 22) != 0;
        s.left = bits(data(t, 1), 0, 15);
        s.right = bits(data(t, 1), 16, 31);
        const std::uint32_t reach = data(t, 2);
        float metres = 0;
        std::memcpy(&metres, &reach, 4);
        s.reach = static_cast<double>(metres);
        s.internal = data(t, 3);
        return s;
    }

    // Section 6 and 6.1: the copy whose chord's middle is nearest to the cell's centre.
    Element element(unsigned t, double cu, double cv) const {
        Element e{};
        const double u[3] = {coordinate(data(t, 0)), 0, coordinate(data(t, 2))};
        const double v[3] = {coordinate(data(t, 1)), 0, coordinate(data(t, 3))};
        const double ku = q_.repeat ? std::floor(cu - (u[0] + u[2]) / 2 + 0.5) : 0;
        const double kv = q_.repeat ? std::floor(cv - (v[0] + v[2]) / 2 + 0.5) : 0;
        const auto metric = [&](double a, double b) {
            return Point{(a + ku) * q_.size[0], (b + kv) * q_.size[1]};
        };
        e.p0 = metric(u[0], v[0]);
        e.p2 = metric(u[2], v[2]);
        const std::uint32_t z = data(t, 2);
        e.quadratic = bits(z, 28, 28) != 0;
        e.width[0] = e.width[1] = e.height[0] = e.height[1] = 1;
        if (bits(z, 29, 29)) {
            e.p1 = metric(coordinate(data(t + 1, 0)), coordinate(data(t + 1, 1)));
            for (unsigned k = 0; k < 2; ++k) {
                e.width[k] = bits(data(t + 1, 2), 16 * k, 16 * k + 15) / 16384.0;
                e.height[k] = bits(data(t + 1, 3), 16 * k, 16 * k + 15) / 16384.0;
            }
        }
        e.follows = bits(z, 30, 30) != 0;
        if (e.follows) {
            const unsigned c = t + 1 + bits(z, 29, 29);
            e.argument[0] = data(c, 0) / 65536.0, e.argument[1] = data(c, 1) / 65536.0;
            e.function = bits(data(c, 2), 0, 15);
        }
        if (!e.quadratic) e.p1 = {(e.p0.x + e.p2.x) / 2, (e.p0.y + e.p2.y) / 2};
        const Point t0 = unit(sub(e.p1, e.p0)), t2 = unit(sub(e.p2, e.p1));
        const double angle = std::numbers::pi / 4096;
        e.ends[0] = {
            e.p0, {-t0.x, -t0.y}, bits(z, 20, 21), bits(z, 22, 23), bits(data(t, 0), 20, 31) * angle};
        e.ends[1] = {e.p2, t2, bits(z, 24, 25), bits(z, 26, 27), bits(data(t, 1), 20, 31) * angle};
        e.style = style(bits(data(t, 3), 20, 31));
        return e;
    }

    static Point on_curve(const Element& e, double s) {
        const double a = (1 - s) * (1 - s), b = 2 * s * (1 - s), c = s * s;
        return {a * e.p0.x + b * e.p1.x + c * e.p2.x, a * e.p0.y + b * e.p1.y + c * e.p2.y};
    }
    static Point tangent(const Element& e, double s) {
        const Point a = sub(e.p1, e.p0), b = sub(e.p2, e.p1);
        return unit({(1 - s) * a.x + s * b.x, (1 - s) * a.y + s * b.y});
    }

    // Section 5: the last crossing on the way c-p, found on fine chords of each step's path line.
    static std::uint32_t ground_code(const std::vector<Element>& list, Point c, Point p,
                                     std::uint32_t level) {
        double last = -1;
        const Point d = sub(p, c);
        for (const Element& e : list) {
            if (!e.style.step) continue;
            const int chords = e.quadratic ? 512 : 1;
            for (int k = 0; k < chords; ++k) {
                const Point a = on_curve(e, k / static_cast<double>(chords));
                const Point b = on_curve(e, (k + 1) / static_cast<double>(chords));
                const Point n = normal(sub(b, a));
                const double sa = dot(normal(d), sub(a, c)), sb = dot(normal(d), sub(b, c));
                const double at = dot(sub(a, c), n) / dot(d, n);
                if ((sa > 0) == (sb > 0) || !(at >= 0 && at <= 1) || at <= last) continue;
                last = at;
                level = dot(d, n) > 0 ? e.style.right : e.style.left;
            }
        }
        return level;
    }

    // Section 6.3, the foot: offset b and the curve parameter.
    static void find_foot(const Element& e, Point p, double& b, double& s) {
        if (!e.quadratic) {
            const Point t = unit(sub(e.p2, e.p0));
            b = dot(sub(p, e.p0), normal(t));
            s = std::fmin(1, std::fmax(0, dot(sub(p, e.p0), t) / norm(sub(e.p2, e.p0))));
            return;
        }
        double best = 1e300;
        const auto offer = [&](double parameter, Point t, Point from, double distance) {
            if (distance >= best) return;
            best = distance, s = parameter, b = dot(sub(p, from), normal(t));
        };
        constexpr int kSamples = 256;
        double nearest = 1e300, at = 0;
        for (int k = 0; k <= kSamples; ++k) {
            const double distance = norm(sub(p, on_curve(e, k / static_cast<double>(kSamples))));
            if (distance < nearest) nearest = distance, at = k / static_cast<double>(kSamples);
        }
        double low = std::fmax(0, at - 1.0 / kSamples), high = std::fmin(1, at + 1.0 / kSamples);
        for (int k = 0; k < 100; ++k) {
            const double third = (high - low) / 3;
            const bool left =
                norm(sub(p, on_curve(e, low + third))) < norm(sub(p, on_curve(e, high - third)));
            (left ? high : low) = left ? high - third : low + third;
        }
        const double middle = (low + high) / 2;
        offer(middle, tangent(e, middle), on_curve(e, middle), norm(sub(p, on_curve(e, middle))));
        const Point t0 = tangent(e, 0), t2 = tangent(e, 1);
        if (dot(sub(p, e.p0), t0) < 0) offer(0, t0, e.p0, std::fabs(dot(sub(p, e.p0), normal(t0))));
        if (dot(sub(p, e.p2), t2) > 0) offer(1, t2, e.p2, std::fabs(dot(sub(p, e.p2), normal(t2))));
    }

    // Section 6.3, one row of the table per line.
    static bool admit(const End& end, Point t, Point p, double b, double& offset, double& clearance) {
        const Point from = sub(p, end.v);
        const double a = dot(from, end.out), sign = b < 0 ? -1 : 1;
        const Point line{std::cos(end.clip), std::sin(end.clip)};
        Point inward = normal(line);
        if (std::fabs(dot(inward, end.out)) < 1e-9) inward = {-end.out.x, -end.out.y};
        if (dot(inward, end.out) > 0) inward = {-inward.x, -inward.y};
        const double side = dot(from, inward);
        clearance = std::fmin(clearance, std::fabs(a));
        if (end.priority == 0) return a <= 0;
        if (end.priority == 3 && (end.shape == 0 || end.shape == 3)) {
            clearance = std::fmin(clearance, std::fabs(side));
            return side >= 0;
        }
        if (end.priority == 3 && end.shape == 1) {
            if (a > std::fabs(offset)) offset = sign * a;
            return true;
        }
        if (end.priority == 3) {
            if (a > 0) offset = sign * norm(from);
            return true;
        }
        if ((end.priority == 1) != (b < 0)) return a <= 0;
        clearance = std::fmin(clearance, std::fabs(side));
        const Point m = dot(line, normal(t)) < 0 ? Point{-line.x, -line.y} : line;
        if (a > 0 && end.shape == 1) offset = dot(from, m) / dot(m, normal(t));
        if (a > 0 && end.shape == 2) offset = sign * norm(from);
        return side >= 0;
    }

    // Section 6.4: the argument at s, and the factor of width (0) or height (1) there.
    static double argument(const Element& e, double s) {
        const auto v = [&e](double u) {
            const Point a = sub(e.p1, e.p0), b = sub(e.p2, e.p1);
            return norm({(1 - u) * a.x + u * b.x, (1 - u) * a.y + u * b.y});
        };
        const double g = std::sqrt(3.0 / 5.0);
        const auto run = [&](double to) {
            return to * (5 * v((1 - g) * to / 2) + 8 * v(to / 2) + 5 * v((1 + g) * to / 2));
        };
        return e.argument[0] + (e.argument[1] - e.argument[0]) * (e.quadratic ? run(s) / run(1) : s);
    }
    static double lattice(std::uint32_t seed, std::uint32_t period, std::uint32_t k, std::uint32_t i, unsigned which) {
        if (period != 0) i %= period << k;
        std::uint32_t h = i + seed * 0x9e3779b9u + k * 0x85ebca6bu;
        h = (h ^ (h >> 16)) * 0x7feb352du;
        h = (h ^ (h >> 15)) * 0x846ca68bu;
        h ^= h >> 16;
        return 2.0 * bits(h, 16 * which, 16 * which + 15) / 65535.0 - 1;
    }
    double factor(unsigned function, double a, unsigned which) const {
        const unsigned t = q_.elements + q_.styles + q_.profiles + q_.materials + q_.lists + function;
        const double amplitude = snorm(bits(data(t, 1), 16 * which, 16 * which + 15));
        const unsigned kind = bits(data(t, 0), 0, 1);
        if (kind == 0) return 1 + amplitude * std::sin(2 * std::numbers::pi * a);
        if (kind == 1) {
            double sum = 0;
            for (unsigned c = 0; c < 4; ++c) {
                const std::uint32_t word = data(t + 1 + which, c);
                float value = 0;
                std::memcpy(&value, &word, 4);
                sum += static_cast<double>(value) * std::pow(a, c);
            }
            return sum;
        }
        double sum = 0, weights = 0;
        for (std::uint32_t k = 0; k < bits(data(t, 0), 2, 5); ++k) {
            const double y = std::ldexp(a, static_cast<int>(k)) + 0.375 * k, i = std::floor(y), f = y - i;
            const double from = lattice(data(t, 2), data(t, 3), k, static_cast<std::uint32_t>(i), which);
            const double to = lattice(data(t, 2), data(t, 3), k, static_cast<std::uint32_t>(i) + 1, which);
            sum += std::ldexp(from + (to - from) * f * f * (3 - 2 * f), -static_cast<int>(k));
            weights += std::ldexp(1.0, -static_cast<int>(k));
        }
        return 1 + amplitude * sum / weights;
    }

    void apply(const Element& e, Point p, std::uint32_t ground, double& add, double& cut,
               double& clearance) const {
        double b = 0, s = 0;
        find_foot(e, p, b, s);
        double offset = b, near = std::fabs(b);
        const bool start = admit(e.ends[0], tangent(e, 0), p, b, offset, near);
        const bool end = admit(e.ends[1], tangent(e, 1), p, b, offset, near);
        double width = e.width[0] + (e.width[1] - e.width[0]) * s;
        double scale = e.height[0] + (e.height[1] - e.height[0]) * s;
        if (e.follows) {
            width *= factor(e.function, argument(e, s), 0);
            scale *= factor(e.function, argument(e, s), 1);
        }
        const Style& style = e.style;
        const auto point = [this, &style](unsigned k, double& pb, double& ph) {
            const std::uint32_t w = data(style.profile + k / 4, k % 4);
            pb = snorm(bits(w, 0, 15)), ph = snorm(bits(w, 16, 31));
        };
        double first = 0, last = 0, h = 0;
        point(0, first, h);
        point(style.points - 1, last, h);
        const double beta = offset / (width * style.reach);
        near =
            std::fmin(near, std::fmin(std::fabs(beta - first), std::fabs(beta - last)) * width * style.reach);
        clearance = std::fmin(clearance, near);
        if (!start || !end || !(width > 0) || beta < first || beta > last) return;
        if (ground != (offset < 0 ? style.left : style.right)) return;
        for (unsigned k = 0; k + 1 < style.points; ++k) {
            double b1 = 0, h1 = 0, b2 = 0, h2 = 0;
            point(k, b1, h1);
            point(k + 1, b2, h2);
            if (b1 == b2) clearance = std::fmin(clearance, std::fabs(beta - b1) * width * style.reach);
            if ((b1 <= beta) == (b2 <= beta)) continue;
            const double z =
                height_of(style.left) + scale * q_.depth * (h1 + (h2 - h1) * (beta - b1) / (b2 - b1));
            add = std::fmax(add, z);
            if (bits(style.internal, k, k)) cut = std::fmin(cut, z);
        }
    }

    Properties q_;
    std::vector<std::uint8_t> grid_, data_;
};

}  // namespace burin::testing
