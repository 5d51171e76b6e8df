// Hard patterns at random, for the property tests of resolve, grid, pack and the decoder.
//
//     seed --[random_pattern]--> Pattern (unresolved, valid input of resolve_pattern)
//
// The same seed gives the same pattern on every machine (own generator, no <random>). Tests print the seed.
// Everything is inside the tile of 1 x 1 metres (or size), depth 10 mm, base_offset 3 mm: heights stay
// within. What can come up: crossings of several lines in a knot, near-parallel lines and tiny angles, arcs
// tangent to lines, U-turns, lines on cell borders and on the border of the map, wrap-around, closed loops, T
// (exact and within the snap distance), sharp, right and blunt corners, hairpins, Y and stars of ends,
// duplicate ends, scales along the path, all joins and caps, nested closed steps in both orientations,
// grooves across steps, grooves that end on a step. Step paths never cross each other.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <burin/pattern.hpp>

#include "../elements.hpp"

namespace burin::testing {

// splitmix64: small, fast, the same everywhere.
class Random {
  public:
    // The seed is mixed first: neighbouring seeds must not give the same numbers one step later.
    explicit Random(std::uint64_t seed) : state_(mix(seed + 0x2545f4914f6cdd1dull)) {}
    std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15ull); }
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  // [0, 1)
    double between(double low, double high) { return low + (high - low) * uniform(); }
    int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
    bool chance(double p) { return uniform() < p; }
    Vec2 direction() {
        const double a = between(0.0, 2.0 * std::numbers::pi);
        return {std::cos(a), std::sin(a)};
    }

  private:
    static std::uint64_t mix(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    std::uint64_t state_;
};

struct RandomPatternOptions {
    int motifs = 8;               // how many groups of grooves and ridges
    int step_loops = 3;           // how many outer step loops are tried; some hold a second one
    double width = 0.012;         // half-width of the widest profile, fraction of the smaller side
    bool quadratics = true;       // arcs, loops of arcs
    bool scales = true;           // width and height scale along the path
    bool near_degenerate = true;  // tiny angles, near-parallel and tangent lines, hairpins, snap distances
    bool wrap_around = true;      // paths across the border of the tile (repeat only)
    bool step_crossings = true;   // grooves across and onto steps
    Vec2 size{1.0, 1.0};
    Wrap wrap = Wrap::repeat;
};

namespace detail {

// A closed step, kept as a polygon so that levels of points can be looked up.
struct StepLoop {
    std::vector<Vec2> outline;
    Vec2 centre;
    double radius = 0.0;
    double inside_level = 0.0;
};

inline bool contains(const std::vector<Vec2>& outline, Vec2 p) {
    bool inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
        const Vec2 a = outline[i], b = outline[j];
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x)
            inside = !inside;
    }
    return inside;
}

class PatternMaker {
  public:
    PatternMaker(std::uint64_t seed, const RandomPatternOptions& options) : random_(seed), options_(options) {
        pattern_.size = options.size;
        pattern_.depth = 0.01;
        pattern_.base_offset = 0.003;
        pattern_.wrap = options.wrap;
        pattern_.materials.push_back({true, {0.8f, 0.6f, 0.2f, 1.0f}, 1.0f, 0.3f});
        unit_ = std::min(options.size.x, options.size.y);
        half_ = options.width * unit_;
        add_profiles();
    }

    Pattern make() {
        for (int i = 0; i < options_.step_loops; ++i) add_step_loop();
        for (int i = 0; i < options_.motifs; ++i) add_motif();
        return pattern_;
    }

  private:
    using Points = std::vector<Vec2>;

    // ---- profiles
    // ------------------------------------------------------------------------------------------
    void add_profiles() {
        const double w = half_;
        pattern_.profiles = {
            {{{-w, 0}, {0, -0.002}, {w, 0}}, {}},                                         // V
            {{{-w, 0}, {-0.4 * w, -0.003}, {0.4 * w, -0.003}, {w, 0}}, {}},               // trapezium
            {{{-0.6 * w, 0}, {-0.6 * w, -0.001}, {0.6 * w, -0.001}, {0.6 * w, 0}}, {}},   // vertical walls
            {{{-w, 0}, {-0.5 * w, 0.0008}, {0.5 * w, 0.0008}, {w, 0}}, {}},               // ridge
            {{{-w, 0}, {-0.7 * w, 0.0005}, {0, -0.002}, {0.7 * w, 0.0005}, {w, 0}}, {}},  // groove with rims
            {{{-0.5 * w, 0}, {-0.3 * w, -0.0015}, {0.2 * w, -0.0007}, {w, 0}}, {}},       // lopsided groove
            {{{-w, 0}, {0, 0.001}, {w, 0}}, {}},                                          // roof
            {{{-0.9 * w, 0}, {-0.5 * w, -0.001}, {0, 0.0004}, {0.4 * w, -0.0012}, {0.8 * w, 0}},
             {}},  // two troughs
        };
        plain_profiles_ = pattern_.profiles.size();
    }

    std::uint32_t step_profile(double rise) {
        const double w = half_ * random_.between(0.3, 0.8);
        Profile profile;
        switch (random_.below(4)) {
            case 0:
                profile.points = {{-w, 0}, {w, rise}};
                break;
            case 1:
                profile.points = {{-w, 0}, {0, 0.5 * rise}, {w, rise}};
                break;
            case 2:
                profile.points = {{-w, 0}, {-0.5 * w, 0.2 * rise}, {0.5 * w, 0.8 * rise}, {w, rise}};
                break;
            default:
                profile.points = {{0, 0}, {0, rise}};
                break;  // a plain wall
        }
        pattern_.profiles.push_back(profile);
        return static_cast<std::uint32_t>(pattern_.profiles.size() - 1);
    }

    // ---- building blocks
    // -----------------------------------------------------------------------------------
    Vec2 point() { return {random_.uniform() * options_.size.x, random_.uniform() * options_.size.y}; }
    Vec2 point_inside() {
        return {random_.between(0.2, 0.8) * options_.size.x, random_.between(0.2, 0.8) * options_.size.y};
    }

    // Level of the ground at p; nested loops come later in the list and win. Asks the nine images when
    // repeating.
    double level_at(Vec2 p) const {
        double level = 0.0;
        const int reach = options_.wrap == Wrap::repeat ? 1 : 0;
        for (const StepLoop& loop : loops_)
            for (int i = -reach; i <= reach; ++i)
                for (int j = -reach; j <= reach; ++j)
                    if (contains(loop.outline, p + Vec2{i * options_.size.x, j * options_.size.y}))
                        level = loop.inside_level;
        return level;
    }

    // Distance over which a path is far from every step: lets motifs stay within one region when wanted.
    bool clear_of_steps(Vec2 p, double margin) const {
        for (const StepLoop& loop : loops_) {
            Vec2 d = p - loop.centre;
            if (options_.wrap == Wrap::repeat) {
                d.x -= options_.size.x * std::round(d.x / options_.size.x);
                d.y -= options_.size.y * std::round(d.y / options_.size.y);
            }
            if (length(d) < loop.radius + margin) return false;
        }
        return true;
    }

    Path& add_path(std::vector<Element> elements, bool closed = false) {
        Path path;
        path.elements = std::move(elements);
        path.closed = closed;
        path.profile = static_cast<std::uint32_t>(random_.below(static_cast<int>(plain_profiles_)));
        path.material = random_.chance(0.2) ? 1 : 0;
        // The level is that of the first element's middle: ends often lie exactly on other paths or on steps.
        const Element& e = path.elements.front();
        path.level = level_at(e.kind == ElementKind::line
                                  ? lerp(e.p0, e.p2, 0.37)
                                  : lerp(lerp(e.p0, e.p1, 0.37), lerp(e.p1, e.p2, 0.37), 0.37));
        path.join = static_cast<JoinKind>(random_.below(3));
        path.start_cap = static_cast<CapKind>(random_.below(4));
        path.end_cap = static_cast<CapKind>(random_.below(4));
        if (options_.scales && !closed && random_.chance(0.25)) scale_along(path);
        pattern_.paths.push_back(std::move(path));
        return pattern_.paths.back();
    }

    void scale_along(Path& path) {
        double width = random_.between(0.4, 1.4), height = random_.between(0.4, 1.0);
        for (Element& e : path.elements) {
            e.width0 = width;
            e.height0 = height;
            width = random_.between(0.4, 1.4);
            height = random_.between(0.4, 1.0);
            e.width1 = width;
            e.height1 = height;
        }
    }

    // Ends may leave the tile only when it repeats; a path starts inside.
    Vec2 keep(Vec2 p) const {
        const double out = options_.wrap == Wrap::repeat && options_.wrap_around ? 0.45 : 0.0;
        return {std::clamp(p.x, -out * options_.size.x, (1.0 + out) * options_.size.x),
                std::clamp(p.y, -out * options_.size.y, (1.0 + out) * options_.size.y)};
    }

    static std::vector<Element> chain(const Points& points) {
        std::vector<Element> elements;
        for (std::size_t i = 0; i + 1 < points.size(); ++i)
            elements.push_back(make_line(points[i], points[i + 1]));
        return elements;
    }

    // n quadratics that pass for a circle; way +1 turns right on screen (inside to the right).
    static std::vector<Element> circle(Vec2 centre, double radius, int n, double phase, int way) {
        std::vector<Element> elements;
        const double step = way * 2.0 * std::numbers::pi / n, bulge = radius / std::cos(0.5 * step);
        const auto on = [&](double a, double r) { return centre + Vec2{std::cos(a), std::sin(a)} * r; };
        Points points;
        for (int i = 0; i < n; ++i) points.push_back(on(phase + i * step, radius));
        points.push_back(points.front());
        for (int i = 0; i < n; ++i)
            elements.push_back(make_arc(points[static_cast<std::size_t>(i)], on(phase + (i + 0.5) * step, bulge),
                                   points[static_cast<std::size_t>(i) + 1]));
        return elements;
    }

    // ---- steps
    // ---------------------------------------------------------------------------------------------
    void add_step_loop() {
        const double radius = random_.between(0.08, 0.2) * unit_;
        Vec2 centre = point();
        if (options_.wrap == Wrap::clamp || !options_.wrap_around)
            centre = {std::clamp(centre.x, 1.1 * radius, options_.size.x - 1.1 * radius),
                      std::clamp(centre.y, 1.1 * radius, options_.size.y - 1.1 * radius)};
        if (!clear_of_steps(centre, radius + 3.0 * half_)) return;
        const double level =
            random_.chance(0.5) ? random_.between(0.0003, 0.0008) : -random_.between(0.0005, 0.0015);
        place_step_loop(centre, radius, 0.0, level);
        if (!random_.chance(0.6)) return;
        const double rise =
            random_.chance(0.5) ? random_.between(0.0003, 0.0008) : -random_.between(0.0005, 0.0015);
        place_step_loop(centre, 0.25 * radius, level, level + rise);
    }

    void place_step_loop(Vec2 centre, double radius, double outside, double inside) {
        const int way = random_.chance(0.5) ? 1 : -1;  // +1: the inside lies to the right
        std::vector<Element> elements;
        const int corners = 3 + random_.below(5);
        const double phase = random_.chance(0.4) ? std::numbers::pi / 4 : random_.between(0.0, 6.0);
        if (options_.quadratics && random_.chance(0.4)) {
            elements = circle(centre, radius, 4 + random_.below(5), phase, way);
        } else {
            Points points;
            const bool square = random_.chance(0.4);
            const int n = square ? 4 : corners;
            for (int i = 0; i < n; ++i) {
                const double a = phase + way * 2.0 * std::numbers::pi * i / n;
                const double r = square ? radius : radius * random_.between(0.6, 1.0);
                points.push_back(centre + Vec2{std::cos(a), std::sin(a)} * r);
            }
            points.push_back(points.front());
            elements = chain(points);
        }
        StepLoop loop{{}, centre, radius, inside};
        for (const Element& e : elements)
            for (int i = 0; i < 16; ++i) {
                const double s = i / 16.0;
                loop.outline.push_back(e.kind == ElementKind::line
                                           ? lerp(e.p0, e.p2, s)
                                           : lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s));
            }
        Path path;
        path.elements = std::move(elements);
        path.closed = true;
        path.level = way > 0 ? outside : inside;
        path.profile = step_profile(way > 0 ? inside - outside : outside - inside);
        path.join = static_cast<JoinKind>(random_.below(3));
        pattern_.paths.push_back(std::move(path));
        loops_.push_back(std::move(loop));
    }

    // ---- motifs
    // --------------------------------------------------------------------------------------------
    void add_motif() {
        switch (random_.below(14)) {
            case 0:
                return knot();
            case 1:
                return near_parallel();
            case 2:
                return tangent_arc();
            case 3:
                return tee();
            case 4:
                return corners();
            case 5:
                return on_borders();
            case 6:
                return around();
            case 7:
                return across_step();
            case 8:
                return star();
            case 9:
                return ring();
            case 10:
                return curve();
            case 11:
                return lattice();
            case 12:
                return onto_step();
            default:
                return strokes();
        }
    }

    // Several lines through nearly one point.
    void knot() {
        const Vec2 c = point_inside();
        const int n = 2 + random_.below(4);
        for (int i = 0; i < n; ++i) {
            const Vec2 d = random_.direction() * (random_.between(0.05, 0.15) * unit_);
            const Vec2 shift =
                random_.direction() * (random_.chance(0.5) ? 0.0 : random_.between(0.0, half_));
            add_path({make_line(keep(c + shift - d), keep(c + shift + d * random_.between(0.5, 1.0)))});
        }
    }

    // Two lines a small distance and a tiny angle apart; sometimes they cross.
    void near_parallel() {
        const Vec2 c = point_inside(), d = random_.direction() * (0.15 * unit_);
        const double angle = options_.near_degenerate ? std::pow(10.0, random_.between(-4.0, -1.0)) : 0.15;
        const double gap = random_.chance(0.5) ? 0.0 : random_.between(0.05, 2.0) * half_;
        const Vec2 e{d.x * std::cos(angle) - d.y * std::sin(angle),
                     d.x * std::sin(angle) + d.y * std::cos(angle)};
        const Vec2 shift = normal_of(unit(d)) * gap;
        add_path({make_line(keep(c - d), keep(c + d))});
        add_path({make_line(keep(c + shift - e), keep(c + shift + e))});
    }

    // An arc that touches a line in its middle, exactly or nearly.
    void tangent_arc() {
        if (!options_.quadratics) return near_parallel();
        const Vec2 c = point_inside(), t = random_.direction(), n = normal_of(t);
        const double r = random_.between(0.04, 0.1) * unit_;
        const double off =
            options_.near_degenerate && random_.chance(0.5) ? random_.between(-1e-3, 1e-3) * unit_ : 0.0;
        add_path({make_line(keep(c - t * (2.0 * r)), keep(c + t * (2.0 * r)))});
        // The parabola's vertex lies half way between chord and control point.
        add_path({make_arc(c - t * r + n * (r + off), c - n * (r - off), c + t * r + n * (r + off))});
    }

    // One path ends on another: exactly on it, or off by less than the snap distance.
    void tee() {
        const Vec2 a = point_inside(), d = random_.direction() * (random_.between(0.08, 0.2) * unit_);
        const Vec2 b = keep(a + d);
        const bool bent = options_.quadratics && random_.chance(0.4);
        const Vec2 control = lerp(a, b, 0.5) + normal_of(unit(d)) * (0.05 * unit_);
        add_path({bent ? make_arc(a, control, b) : make_line(a, b)});
        const double s = random_.between(0.3, 0.7);
        Vec2 foot = bent ? lerp(lerp(a, control, s), lerp(control, b, s), s) : lerp(a, b, s);
        if (options_.near_degenerate && random_.chance(0.5))
            foot = foot + random_.direction() * (0.5e-4 * unit_);
        const double lean = random_.chance(0.3) ? random_.between(0.15, 0.4) : random_.between(0.5, 2.6);
        const Vec2 t = unit(d);
        const Vec2 away{t.x * std::cos(lean) - t.y * std::sin(lean),
                        t.x * std::sin(lean) + t.y * std::cos(lean)};
        const Vec2 far = keep(foot + away * (random_.between(0.06, 0.12) * unit_));
        add_path(random_.chance(0.5) ? std::vector{make_line(foot, far)} : std::vector{make_line(far, foot)});
    }

    // A polyline with corners of every sharpness.
    void corners() {
        Points points{point_inside()};
        Vec2 t = random_.direction();
        const int n = 2 + random_.below(4);
        for (int i = 0; i < n; ++i) {
            points.push_back(keep(points.back() + t * (random_.between(0.05, 0.12) * unit_)));
            const double turns[] = {0.02, 0.06, 0.5, std::numbers::pi / 2, 2.3, 2.9};
            double turn = turns[random_.below(options_.near_degenerate ? 6 : 5)];
            if (random_.chance(0.5)) turn = -turn;
            t = {t.x * std::cos(turn) - t.y * std::sin(turn), t.x * std::sin(turn) + t.y * std::cos(turn)};
            if (length(points.back() - points[points.size() - 2]) < 0.02 * unit_) {
                points.pop_back();
                break;
            }
        }
        if (points.size() > 1) add_path(chain(points));
    }

    // Lines on the border of the map and on lines where a power-of-two grid has its cell borders.
    void on_borders() {
        const double places[] = {0.0, 0.25, 0.5, 0.125, 0.0625, 0.75};
        const double x = places[random_.below(6)] * options_.size.x,
                     y = places[random_.below(6)] * options_.size.y;
        const double low = random_.between(0.0, 0.3), high = random_.between(0.5, 1.0);
        if (random_.chance(0.5)) add_path({make_line({x, low * options_.size.y}, {x, high * options_.size.y})});
        if (random_.chance(0.7)) add_path({make_line({low * options_.size.x, y}, {high * options_.size.x, y})});
        if (random_.chance(0.3)) add_path({make_line({0, 0}, {options_.size.x * 0.5, options_.size.y * 0.5})});
    }

    // All around the tile: closed modulo the tile, or across its border and ending there.
    void around() {
        if (options_.wrap == Wrap::clamp || !options_.wrap_around) return strokes();
        const double y = random_.uniform() * options_.size.y;
        const Vec2 a{random_.chance(0.5) ? 0.0 : 0.3 * options_.size.x, y};
        const Vec2 b = a + Vec2{0.5 * options_.size.x, random_.between(-0.1, 0.1) * options_.size.y};
        const Vec2 c = a + Vec2{options_.size.x, 0.0};
        const bool transpose = random_.chance(0.5) && options_.size.x == options_.size.y;
        const auto place = [&](Vec2 p) { return transpose ? Vec2{p.y, p.x} : p; };
        if (random_.chance(0.6)) {
            add_path({make_line(place(a), place(b)), make_line(place(b), place(c))}, true);
        } else {
            const Vec2 end = a + Vec2{0.9 * options_.size.x, 0.2 * options_.size.y};
            add_path({make_line(place(a), place(lerp(a, end, 0.5))), make_line(place(lerp(a, end, 0.5)), place(end))});
        }
    }

    // A groove straight across a step loop, sometimes along a chord near its edge.
    void across_step() {
        if (loops_.empty() || !options_.step_crossings) return knot();
        const StepLoop& loop =
            loops_[static_cast<std::size_t>(random_.below(static_cast<int>(loops_.size())))];
        const Vec2 d = random_.direction();
        const Vec2 shift = normal_of(d) * (random_.between(-0.6, 0.6) * loop.radius);
        const Vec2 a = keep(loop.centre + shift - d * (1.4 * loop.radius));
        const Vec2 b = keep(loop.centre + shift + d * (random_.chance(0.5) ? 1.4 : 0.3) * loop.radius);
        if (length(b - a) > 0.02 * unit_) add_path({make_line(a, b)});
    }

    // A groove that ends exactly on a step's path line, from outside or from inside.
    void onto_step() {
        if (loops_.empty() || !options_.step_crossings) return tee();
        const std::size_t which = static_cast<std::size_t>(random_.below(static_cast<int>(loops_.size())));
        const StepLoop& loop = loops_[which];
        const Vec2 on =
            loop.outline[static_cast<std::size_t>(random_.below(static_cast<int>(loop.outline.size())))];
        const Vec2 out = unit(on - loop.centre);
        const Vec2 other = keep(on + out * (random_.chance(0.5) ? 0.3 : -0.4) * loop.radius);
        if (length(other - on) > 0.02 * unit_) add_path({make_line(other, on)});
    }

    // Three or more ends at one point.
    void star() {
        const Vec2 c = point_inside();
        const int n = 3 + random_.below(3);
        const double phase = random_.between(0.0, 6.0);
        for (int i = 0; i < n; ++i) {
            const double a = phase + 2.0 * std::numbers::pi * (i + random_.between(-0.2, 0.2)) / n;
            const Vec2 far = keep(c + Vec2{std::cos(a), std::sin(a)} * (random_.between(0.05, 0.12) * unit_));
            add_path(random_.chance(0.5) ? std::vector{make_line(c, far)} : std::vector{make_line(far, c)});
        }
    }

    // Closed groove: circle of arcs, or a rectangle; sometimes with a second one that touches it.
    void ring() {
        const Vec2 c = point_inside();
        const double r = random_.between(0.03, 0.1) * unit_;
        if (options_.quadratics && random_.chance(0.6)) {
            add_path(circle(c, r, 4 + random_.below(5), 0.3, random_.chance(0.5) ? 1 : -1), true);
            if (random_.chance(0.3)) add_path(circle(c + Vec2{2.0 * r, 0.0}, r, 8, 0.0, 1), true);
            return;
        }
        const Vec2 u{r, 0.0}, v{0.0, 0.7 * r};
        add_path(chain({c - u - v, c + u - v, c + u + v, c - u + v, c - u - v}), true);
    }

    // A smooth chain of quadratics, some with a strong turn.
    void curve() {
        if (!options_.quadratics) return corners();
        const Vec2 a = point_inside();
        Vec2 t = random_.direction(), from = a;
        std::vector<Element> elements;
        const int n = 1 + random_.below(4);
        for (int i = 0; i < n; ++i) {
            const double turn =
                random_.between(-1.0, 1.0) * (options_.near_degenerate && random_.chance(0.2) ? 2.7 : 1.2);
            const double leg = random_.between(0.03, 0.06) * unit_;
            const Vec2 control = from + t * leg;
            t = {t.x * std::cos(turn) - t.y * std::sin(turn), t.x * std::sin(turn) + t.y * std::cos(turn)};
            const Vec2 to = control + t * (leg * random_.between(0.5, 1.5));
            elements.push_back(make_arc(from, control, to));
            from = to;
        }
        add_path(elements);
    }

    // Rows and columns: many crossings, all at right angles.
    void lattice() {
        const Vec2 c = point_inside();
        const double pitch = random_.between(1.2, 4.0) * half_;
        const int n = 2 + random_.below(3);
        const double reach = pitch * n;
        for (int i = 0; i < n; ++i) {
            const double s = (i - 0.5 * (n - 1)) * pitch;
            add_path({make_line(keep(c + Vec2{-reach, s}), keep(c + Vec2{reach, s}))});
            add_path({make_line(keep(c + Vec2{s, -reach}), keep(c + Vec2{s, reach}))});
        }
    }

    // Short strokes, some shorter than they are wide.
    void strokes() {
        const int n = 2 + random_.below(4);
        for (int i = 0; i < n; ++i) {
            const Vec2 a = point();
            const double reach =
                random_.chance(0.3) ? random_.between(0.2, 2.0) * half_ : random_.between(0.03, 0.1) * unit_;
            const Vec2 b = keep(a + random_.direction() * reach);
            if (length(b - a) > 0.1 * half_) add_path({make_line(a, b)});
        }
    }

    Random random_;
    RandomPatternOptions options_;
    Pattern pattern_;
    std::vector<StepLoop> loops_;
    std::size_t plain_profiles_ = 0;
    double unit_ = 1.0, half_ = 0.01;
};

}  // namespace detail

inline Pattern random_pattern(std::uint64_t seed, const RandomPatternOptions& options = {}) {
    return detail::PatternMaker(seed, options).make();
}

}  // namespace burin::testing
