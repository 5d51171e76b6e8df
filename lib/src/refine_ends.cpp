#include "refine_ends.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "refine_profile.hpp"

namespace burin::refinement {
namespace {

// All in texels, or as shares of the section's relief.
constexpr double kStride = 0.5;
constexpr double kLookBack = 40.0;
constexpr double kLookAhead = 80.0;
constexpr double kLeastMove = 1.5;    // outwards
constexpr double kLeastReturn = 4.0;  // inwards: an end is seen less sharply than the fit will find it
constexpr double kCurveAhead = 0.5;     // of a quadratic's length: so far it is followed beyond its end
constexpr double kGap = 1.5;           // a stretch of mismatch that ends a path
constexpr double kMatch = 0.15;        // mean difference over the section
constexpr double kMiddleMatch = 0.25;  // difference in the middle
constexpr double kNear = 2.5;          // ends that meet
constexpr double kLongestCorner = 40.0;
constexpr double kFacing = -0.94;      // cosine between the outward tangents of ends that continue each other
constexpr double kSmallStep = 48.0;    // greatest side of a closed step that may be a leftover
constexpr double kBucket = 16.0;
constexpr int kAcross = 11;            // samples over a section

struct End {
    std::size_t path = 0;
    bool at_start = false;
    Vec2 place, outward;
    Vec2 from;              // where it was
    bool moved = false;
    bool on_line = false;  // lies on another path's line: a T already
    double shown = 0.0;    // how far ahead the map shows at least the middle of the section
};

struct Decision {
    double move = 0.0;               // along the outward tangent; negative: taken back
    std::optional<std::size_t> join;  // an end that this one continues into
    std::optional<Vec2> meet;         // a place on another path's line where this one ends
};

Vec2 point_of(const Element& e, double s) {
    return e.kind == ElementKind::line ? lerp(e.p0, e.p2, s) : lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
}

Vec2 tangent_of(const Element& e, double s) {
    return unit(e.kind == ElementKind::line ? e.p2 - e.p0 : lerp(e.p1 - e.p0, e.p2 - e.p1, s));
}

double length_of(const Element& e) {
    return e.kind == ElementKind::line ? length(e.p2 - e.p0)
                                       : 0.5 * (length(e.p2 - e.p0) + length(e.p1 - e.p0) + length(e.p2 - e.p1));
}

double distance_to_chord(Vec2 p, Vec2 a, Vec2 b) {
    const Vec2 d = b - a;
    const double t = dot(d, d) > 0.0 ? std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0) : 0.0;
    return length(p - lerp(a, b, t));
}

double distance_to(const Element& e, Vec2 p) {
    if (e.kind == ElementKind::line) return distance_to_chord(p, e.p0, e.p2);
    double best = 1e300;
    for (int i = 0; i < 8; ++i)
        best = std::min(best, distance_to_chord(p, point_of(e, i / 8.0), point_of(e, (i + 1) / 8.0)));
    return best;
}

bool is_step(const Profile& profile) { return std::abs(profile.points.back().h - profile.points.front().h) > 1e-6; }

double reach_of(const Profile& profile) { return std::max(-profile.points.front().b, profile.points.back().b); }

class EndSettler {
  public:
    EndSettler(Pattern& pattern, const Image& map, Vec2 side, const std::vector<std::uint8_t>& held)
        : pattern_(pattern), map_(map), side_(side), held_(held) {}

    std::vector<MovedEnd> run() {
        find_ends();
        fill_buckets();
        for (End& end : ends_)
            end.on_line = any_near(end, end.place, 0,
                                   [&](std::size_t, const Element& e) { return distance_to(e, end.place) < 0.1; });
        for (std::size_t i = 0; i < ends_.size(); ++i)
            end_buckets_[{bucket(ends_[i].place.x), bucket(ends_[i].place.y)}].push_back(i);
        std::vector<Decision> decisions;
        for (std::size_t i = 0; i < ends_.size(); ++i) decisions.push_back(is_held(i) ? Decision{} : decide(i));
        for (std::size_t i = 0; i < ends_.size(); ++i) carry_out(i, decisions[i]);
        join_corners();
        const std::vector<MovedEnd> moved = moved_ends();
        if (!drawn_out_.empty()) drop_leftovers();
        return moved;
    }

  private:
    struct Section {
        SweptProfile profile;
        double width = 1.0, height = 1.0, level = 0.0, middle = 0.0;
        double beyond = 0.0;  // how far a right end still looks like the path: a hip is the section turned
    };

    Element& last_element(const End& end) {
        std::vector<Element>& elements = pattern_.paths[end.path].elements;
        return end.at_start ? elements.front() : elements.back();
    }

    bool is_held(std::size_t end) const { return end < held_.size() && held_[end]; }

    std::vector<MovedEnd> moved_ends() const {
        std::vector<MovedEnd> moved;
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            const End& end = ends_[i];
            if (!end.moved) continue;
            const double reach = reach_of(pattern_.profiles[pattern_.paths[end.path].profile]) + 4.0;
            MovedEnd entry{i, {}};
            entry.window.low = {std::min(end.from.x, end.place.x) - reach, std::min(end.from.y, end.place.y) - reach};
            entry.window.high = {std::max(end.from.x, end.place.x) + reach, std::max(end.from.y, end.place.y) + reach};
            moved.push_back(entry);
        }
        return moved;
    }

    void find_ends() {
        for (std::size_t p = 0; p < pattern_.paths.size(); ++p) {
            const Path& path = pattern_.paths[p];
            if (path.closed || path.elements.empty() || is_step(pattern_.profiles[path.profile])) continue;
            ends_.push_back({p, true, path.elements.front().p0, -tangent_of(path.elements.front(), 0.0), path.elements.front().p0});
            ends_.push_back({p, false, path.elements.back().p2, tangent_of(path.elements.back(), 1.0), path.elements.back().p2});
        }
    }

    static int bucket(double x) { return static_cast<int>(std::floor(x / kBucket)); }

    void fill_buckets() {
        for (std::size_t p = 0; p < pattern_.paths.size(); ++p) {
            const double reach = reach_of(pattern_.profiles[pattern_.paths[p].profile]) + 1.0;
            for (std::size_t i = 0; i < pattern_.paths[p].elements.size(); ++i) {
                const Element& e = pattern_.paths[p].elements[i];
                const Vec2 middle = e.kind == ElementKind::line ? e.p0 : e.p1;
                const Vec2 low{std::min({e.p0.x, middle.x, e.p2.x}), std::min({e.p0.y, middle.y, e.p2.y})};
                const Vec2 high{std::max({e.p0.x, middle.x, e.p2.x}), std::max({e.p0.y, middle.y, e.p2.y})};
                for (int y = bucket(low.y - reach); y <= bucket(high.y + reach); ++y)
                    for (int x = bucket(low.x - reach); x <= bucket(high.x + reach); ++x)
                        buckets_[{x, y}].push_back({p, i});
            }
        }
    }

    // Calls visit(path, element) for the elements in the buckets around p but the end's own; stops when it returns true.
    template <typename Visit>
    bool any_around(const End& end, Vec2 p, int span, Visit visit) const {
        for (int y = bucket(p.y) - span; y <= bucket(p.y) + span; ++y) {
            for (int x = bucket(p.x) - span; x <= bucket(p.x) + span; ++x) {
                const auto found = buckets_.find({x, y});
                if (found == buckets_.end()) continue;
                for (const auto& [path, index] : found->second) {
                    const Path& other = pattern_.paths[path];
                    const std::size_t own = end.at_start ? 0 : other.elements.size() - 1;
                    if (path == end.path && index == own) continue;
                    if (visit(path, other.elements[index])) return true;
                }
            }
        }
        return false;
    }

    // Whether another groove or ridge covers part of the section at p.
    bool covered(const End& end, Vec2 p, double reach) const {
        return any_around(end, p, static_cast<int>(std::ceil(reach / kBucket)), [&](std::size_t path, const Element& e) {
            const Path& other = pattern_.paths[path];
            const Profile& profile = pattern_.profiles[other.profile];
            // A small closed step is no obstacle: it may be what the tracer made of the stub itself.
            if (other.closed && is_step(profile)) return false;
            return distance_to(e, p) < reach_of(profile) + reach;
        });
    }

    double map_at(Vec2 p) const {
        const double u = p.x / side_.x - 0.5, v = p.y / side_.y - 0.5;
        const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
        const double s = u - i, t = v - j;
        return (1 - t) * ((1 - s) * texel(i, j) + s * texel(i + 1, j)) +
               t * ((1 - s) * texel(i, j + 1) + s * texel(i + 1, j + 1));
    }

    double texel(int x, int y) const {
        if (pattern_.wrap == Wrap::repeat) {
            x = ((x % map_.width) + map_.width) % map_.width;
            y = ((y % map_.height) + map_.height) % map_.height;
        }
        return map_.at(std::clamp(x, 0, map_.width - 1), std::clamp(y, 0, map_.height - 1));
    }

    Section section_of(const End& end) {
        const Path& path = pattern_.paths[end.path];
        const Element& e = last_element(end);
        const Profile& profile = pattern_.profiles[path.profile];
        Section section;
        section.profile = swept({profile.points, 0u});
        section.width = std::max(0.02, end.at_start ? e.width0 : e.width1);
        section.height = end.at_start ? e.height0 : e.height1;
        section.level = path.level;
        double most = 0.0, sum = 0.0, count = 0.0;
        for (const ProfilePoint& point : profile.points) most = std::max(most, std::abs(point.h));
        for (const ProfilePoint& point : profile.points)
            if (std::abs(point.h) > 0.9 * most) sum += point.b, count += 1.0;
        const CapKind cap = end.at_start ? path.start_cap : path.end_cap;
        for (const ProfilePoint& point : profile.points)
            if (std::abs(point.h) > 0.85 * most && cap != CapKind::butt)
                section.beyond = std::max(section.beyond, section.width * std::abs(point.b));
        section.middle = count > 0.0 ? section.width * sum / count : 0.0;
        return section;
    }

    enum class Look { no, middle_only, all };

    Look look_at(const Section& section, Vec2 centre, Vec2 tangent) const {
        const Vec2 n = normal_of(tangent);
        const Spread spread{std::max(1e-3, std::abs(n.x) * side_.x / section.width),
                            std::max(1e-3, std::abs(n.y) * side_.y / section.width)};
        const auto expected = [&](double b) {
            return section.level + section.height * profile_mean(section.profile, b / section.width, spread, nullptr, nullptr).value;
        };
        const double left = section.profile.left() * section.width - 1.0;
        const double right = section.profile.right() * section.width + 1.0;
        double difference = 0.0, relief = 1e-3;
        for (int k = 0; k < kAcross; ++k) {
            const double b = left + (right - left) * k / (kAcross - 1);
            const double value = expected(b);
            difference += std::abs(map_at(centre + n * b) - value) / kAcross;
            relief = std::max(relief, std::abs(value - section.level));
        }
        const double middle = expected(section.middle);
        const double off = std::abs(map_at(centre + n * section.middle) - middle);
        relief = std::max(relief, std::abs(middle - section.level));
        if (off > kMiddleMatch * relief) return Look::no;
        return difference < kMatch * relief ? Look::all : Look::middle_only;
    }

    // An end that faces this one and lies at p.
    std::optional<std::size_t> facing(std::size_t own, Vec2 p, Vec2 outward) const {
        for (int y = bucket(p.y - kNear); y <= bucket(p.y + kNear); ++y) {
            for (int x = bucket(p.x - kNear); x <= bucket(p.x + kNear); ++x) {
                const auto found = end_buckets_.find({x, y});
                if (found == end_buckets_.end()) continue;
                for (const std::size_t i : found->second) {
                    if (i == own || is_held(i) || ends_[i].path == ends_[own].path) continue;
                    if (pattern_.paths[ends_[i].path].profile != pattern_.paths[ends_[own].path].profile) continue;
                    if (length(ends_[i].place - p) < kNear && dot(ends_[i].outward, outward) < kFacing) return i;
                }
            }
        }
        return std::nullopt;
    }

    Decision decide(std::size_t index) {
        const End& end = ends_[index];
        const Element e = last_element(end);
        const Section section = section_of(end);
        const double reach = std::max(-section.profile.left(), section.profile.right()) * section.width;
        const double whole = length_of(e);
        std::optional<double> last_clear, last_any;
        double gap = 0.0;
        bool torn = false;  // the map stops showing the path before its end
        for (double a = -std::min(kLookBack, 0.8 * whole); a <= kLookAhead && gap <= kGap; a += kStride) {
            const double s = end.at_start ? -a / whole : 1.0 + a / whole;
            const bool inside = a < 0.0;
            const bool on_curve_ahead = e.kind == ElementKind::quadratic && a < kCurveAhead * whole;
            const bool curve = inside || on_curve_ahead;
            const Vec2 p = curve ? point_of(e, s) : end.place + end.outward * a;
            const Vec2 t = curve ? tangent_of(e, s) : (end.at_start ? -end.outward : end.outward);
            if (outside(p)) break;
            if (a > -kNear)
                if (const std::optional<std::size_t> other = facing(index, p, end.outward)) return {0.0, other, std::nullopt};
            const Look look = look_at(section, p, t);
            const bool over = look != Look::all && covered(end, p, reach);
            if (look == Look::all) {
                last_clear = last_any = a;
                gap = 0.0;
            } else if (look == Look::middle_only && over) {
                last_any = a;
                gap = 0.0;
            } else {
                gap += kStride;
                torn |= gap > kGap && inside;
            }
        }
        if (last_any) ends_[index].shown = *last_any;
        if (torn && last_any) {
            const double back = *last_any + 0.5 * kStride - section.beyond;
            return {back < -kLeastMove ? back : 0.0, std::nullopt, std::nullopt};
        }
        if (!last_clear || *last_any > *last_clear + kLeastMove) return {0.0, std::nullopt, meeting(index)};
        const double move = *last_clear + 0.5 * kStride - section.beyond;
        if (move > -kLeastReturn && move < kLeastMove) return {};
        return {move, std::nullopt, std::nullopt};
    }

    // The same without steps.
    template <typename Visit>
    bool any_near(const End& end, Vec2 p, int span, Visit visit) const {
        return any_around(end, p, span, [&](std::size_t path, const Element& e) {
            return !is_step(pattern_.profiles[pattern_.paths[path].profile]) && visit(path, e);
        });
    }

    // Where the way ahead of an end first meets another path's line, as far as the map shows the path's middle.
    std::optional<Vec2> meeting(std::size_t index) const {
        const End& end = ends_[index];
        if (end.on_line || end.shown <= 0.0) return std::nullopt;
        double nearest = std::min(end.shown + 1.0, kBucket);
        std::optional<Vec2> place;
        any_near(end, end.place, 1, [&](std::size_t, const Element& e) {
            const int pieces = e.kind == ElementKind::line ? 1 : 16;
            for (int k = 0; k < pieces; ++k) {
                const Vec2 a = point_of(e, double(k) / pieces), d = point_of(e, double(k + 1) / pieces) - a;
                const double turn = cross(end.outward, d);
                if (std::abs(turn) < 0.2 * length(d)) continue;
                const double along = cross(a - end.place, d) / turn;
                const double share = cross(a - end.place, end.outward) / turn;
                if (along < 0.1 || along > nearest || share < 0.0 || share > 1.0) continue;
                const Vec2 p = lerp(a, a + d, share);
                // Near the other's end it is a corner.
                if (length(p - e.p0) < 2.0 * kNear || length(p - e.p2) < 2.0 * kNear) continue;
                nearest = along;
                place = on_curve(e, (k + share) / pieces, p);
            }
            return false;
        });
        return place;
    }

    static Vec2 on_curve(const Element& e, double s, Vec2 p) {
        for (int i = 0; i < 8 && e.kind == ElementKind::quadratic; ++i) {
            const Vec2 t = 2.0 * lerp(e.p1 - e.p0, e.p2 - e.p1, s);
            s = std::clamp(s + dot(p - point_of(e, s), t) / std::max(1e-12, dot(t, t)), 0.0, 1.0);
        }
        return point_of(e, s);
    }

    bool outside(Vec2 p) const {
        if (pattern_.wrap == Wrap::repeat) return false;
        return p.x < 0.0 || p.y < 0.0 || p.x > pattern_.size.x || p.y > pattern_.size.y;
    }

    void set_place(End& end, Vec2 p) {
        Element& e = last_element(end);
        (end.at_start ? e.p0 : e.p2) = p;
        end.place = p;
        end.moved = true;
    }

    bool carry_out(std::size_t index, const Decision& decision) {
        End& end = ends_[index];
        if (decision.join) {
            End& other = ends_[*decision.join];
            if (end.place == other.place) return false;
            const Vec2 middle = lerp(end.place, other.place, 0.5);
            set_place(end, middle);
            set_place(other, middle);
            return true;
        }
        if (decision.meet && !end.moved) {
            drawn_out_.push_back({end.place, *decision.meet});
            return set_place(end, *decision.meet), true;
        }
        if (decision.move == 0.0 || end.moved) return false;
        if (decision.move < 0.0) return take_back(end, -decision.move);
        const Vec2 place = end.place + end.outward * decision.move;
        drawn_out_.push_back({end.place, place});
        if (last_element(end).kind == ElementKind::line) return set_place(end, place), true;
        if (decision.move < kCurveAhead * length_of(last_element(end))) return stretch(end, decision.move);
        Element line = last_element(end);
        line.kind = ElementKind::line;
        line.p0 = end.at_start ? place : end.place;
        line.p2 = end.at_start ? end.place : place;
        (end.at_start ? line.width1 : line.width0) = end.at_start ? line.width0 : line.width1;
        (end.at_start ? line.height1 : line.height0) = end.at_start ? line.height0 : line.height1;
        std::vector<Element>& elements = pattern_.paths[end.path].elements;
        elements.insert(end.at_start ? elements.begin() : elements.end(), line);
        end.place = place;
        end.moved = true;
        return true;
    }

    // A quadratic goes on as the same parabola.
    bool stretch(End& end, double by) {
        Element& e = last_element(end);
        const double s = by / length_of(e);
        const double from = end.at_start ? -s : 0.0, to = end.at_start ? 1.0 : 1.0 + s;
        const Vec2 place = point_of(e, end.at_start ? from : to);
        e.p1 = lerp(lerp(e.p0, e.p1, from), lerp(e.p1, e.p2, from), to);
        set_place(end, place);
        return true;
    }

    bool take_back(End& end, double by) {
        Element& e = last_element(end);
        const double s = std::clamp(by / length_of(e), 0.0, 0.8);
        const double from = end.at_start ? s : 0.0, to = end.at_start ? 1.0 : 1.0 - s;
        const Vec2 place = point_of(e, end.at_start ? from : to);
        if (e.kind == ElementKind::quadratic) e.p1 = lerp(lerp(e.p0, e.p1, from), lerp(e.p1, e.p2, from), to);
        set_place(end, place);
        return true;
    }

    // Lines whose ways ahead meet, with the map showing both of them as far as that, meet there in a corner.
    void join_corners() {
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            std::optional<std::size_t> partner;
            Vec2 corner;
            double nearest = kLongestCorner;
            if (ends_[i].on_line || is_held(i)) continue;
            for (std::size_t j = 0; j < ends_.size(); ++j) {
                const std::optional<Vec2> at =
                    i == j || is_held(i) || is_held(j) ? std::nullopt : corner_of(ends_[i], ends_[j]);
                if (!at || length(*at - ends_[i].place) + length(*at - ends_[j].place) >= nearest) continue;
                nearest = length(*at - ends_[i].place) + length(*at - ends_[j].place);
                corner = *at;
                partner = j;
            }
            if (!partner) continue;
            for (End* end : {&ends_[i], &ends_[*partner]}) {
                drawn_out_.push_back({end->place, corner});
                set_place(*end, corner);
                end->on_line = true;
            }
        }
    }

    std::optional<Vec2> corner_of(const End& a, const End& b) {
        if (a.on_line || b.on_line || a.place == b.place) return std::nullopt;
        if (length(a.place - b.place) > kLongestCorner) return std::nullopt;
        if (pattern_.paths[a.path].profile != pattern_.paths[b.path].profile) return std::nullopt;
        if (last_element(a).kind != ElementKind::line || last_element(b).kind != ElementKind::line) return std::nullopt;
        const double turn = cross(a.outward, b.outward);
        if (std::abs(turn) < 0.2) return std::nullopt;
        const double ahead_a = cross(b.place - a.place, b.outward) / turn;
        const double ahead_b = cross(b.place - a.place, a.outward) / turn;
        const auto shown = [](const End& end, double ahead) {
            return ahead > -2.0 * kNear && ahead < (end.moved ? 2.0 * kNear : end.shown + kNear);
        };
        if (!shown(a, ahead_a) || !shown(b, ahead_b)) return std::nullopt;
        return a.place + a.outward * ahead_a;
    }

    void drop_leftovers() {
        std::erase_if(pattern_.paths, [&](const Path& path) {
            if (!path.closed || !is_step(pattern_.profiles[path.profile])) return false;
            Box box;
            for (const Element& e : path.elements) {
                box.low = {std::min(box.low.x, e.p0.x), std::min(box.low.y, e.p0.y)};
                box.high = {std::max(box.high.x, e.p0.x), std::max(box.high.y, e.p0.y)};
            }
            if (box.high.x - box.low.x > kSmallStep || box.high.y - box.low.y > kSmallStep) return false;
            const Vec2 middle = lerp(box.low, box.high, 0.5);
            return std::any_of(drawn_out_.begin(), drawn_out_.end(), [&](const auto& line) {
                return distance_to_chord(middle, line.first, line.second) < 0.5 * length(box.high - box.low);
            });
        });
    }

    Pattern& pattern_;
    const Image& map_;
    const Vec2 side_;
    const std::vector<std::uint8_t>& held_;
    std::vector<End> ends_;
    std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, std::size_t>>> buckets_;
    std::map<std::pair<int, int>, std::vector<std::size_t>> end_buckets_;
    std::vector<std::pair<Vec2, Vec2>> drawn_out_;
};

}  // namespace

std::vector<MovedEnd> settle_ends(Pattern& pattern, const Image& map, Vec2 side, const std::vector<std::uint8_t>& held) {
    return EndSettler(pattern, map, side, held).run();
}

}  // namespace burin::refinement
