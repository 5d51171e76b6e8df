// Grooves are split where they cross a step: each piece stands on the ground of its side.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "resolve_curve.hpp"
#include "resolve_internal.hpp"

namespace burin::resolving {
namespace {

// A place on a path: element index plus parameter. On a closed path it goes on beyond the last element.
using Place = double;

struct Cut {
    Place at = 0.0;
    ElementEnd end;  // of the pieces on both sides
    double forward = 0.0,
           back = 0.0;  // metres by which the piece before and the piece after reach beyond the cut
};

// How a step's line passes through a groove's strip, along the groove from the crossing.
struct Passage {
    double forward = 0.0, back = 0.0;
    bool straight = true;  // by its tangent, to a hundredth of the strip's half-width
};

// Follows the step from the crossing one way, until it leaves the strip.
void follow(const WorkPath& step, std::size_t element, double s, int way, Vec2 along, Vec2 line,
            double half_width, Passage& passage) {
    const double stride = half_width / 8.0;
    const std::size_t count = step.elements.size();
    Vec2 d{0.0, 0.0};
    for (int i = 0; i < 96; ++i) {
        const Element& e = step.elements[element];
        const double speed = std::max(length(curve::derivative(e, s)), 1e-300);
        const double next = std::clamp(s + way * stride / speed, 0.0, 1.0);
        d = d + (curve::point(e, next) - curve::point(e, s));
        s = next;
        const double a = dot(d, along);
        passage.forward = std::max(passage.forward, a);
        passage.back = std::max(passage.back, -a);
        if (std::abs(cross(line, d)) > 0.01 * half_width) passage.straight = false;
        if (std::abs(cross(along, d)) > half_width) return;
        if (s == (way > 0 ? 1.0 : 0.0)) {
            const bool last = way > 0 ? element + 1 == count : element == 0;
            if (last && !step.closed) return;
            element = (element + (way > 0 ? 1 : count - 1)) % count;
            s = way > 0 ? 0.0 : 1.0;
        }
    }
    passage.straight = false;
}

Passage passage_of(const WorkPath& step, std::size_t element, double s, Vec2 along, Vec2 line,
                   double half_width) {
    Passage passage;
    if (half_width <= 0.0) return passage;
    follow(step, element, s, 1, along, line, half_width, passage);
    follow(step, element, s, -1, along, line, half_width, passage);
    return passage;
}

double half_width_of(const WorkPath& path, std::size_t element) {
    const Element& e = path.elements[element];
    return path.reach * std::max(e.width0, e.width1);
}

// A straight step bounds the pieces by its line, as a clip. One that bends within the strip, or runs along
// it, bounds them by the level: the pieces reach beyond it, butt-ended where their whole width lies on the
// other ground.
Cut cut_at(const Work& work, const ArcCrossing& crossing, int groove) {
    const WorkPath &path = work.paths[crossing.path[groove]], &step = work.paths[crossing.path[1 - groove]];
    const std::size_t element = crossing.element[groove], step_element = crossing.element[1 - groove];
    const Vec2 line = tangent_at(work, step, step_element, crossing.s[1 - groove]);
    const Vec2 along = curve::tangent(path.elements[element], crossing.s[groove]);
    const double half_width = half_width_of(path, element);
    const Passage passage = passage_of(step, step_element, crossing.s[1 - groove], along, line, half_width);
    Cut cut{static_cast<double>(element) + crossing.s[groove], clip_or_hip(along, line), 0.0, 0.0};
    if (passage.straight && cut.end.clips_both()) return cut;
    cut.end = {};
    cut.forward = 1.1 * passage.forward + 0.1 * half_width;
    cut.back = 1.1 * passage.back + 0.1 * half_width;
    return cut;
}

// Builds the pieces of one groove.
class Splitter {
  public:
    Splitter(const Work& work, WorkPath& path, std::vector<Cut> cuts)
        : work_(work),
          path_(path),
          old_(std::move(path.elements)),
          cuts_(std::move(cuts)),
          shortest_(std::max(work.snap, 1e-9 * work.pattern.size.x)) {
        path.elements.clear();
        lap_ = old_.back().p2 - old_.front().p0;
        for (const Element& e : old_) lengths_.push_back(curve::arc_length(e));
        merge_cuts();
    }

    int run() {
        const double count = static_cast<double>(old_.size());
        if (cuts_.empty()) {
            add_run(0.0, count, 0.0, count);
        } else if (path_.closed) {
            for (std::size_t i = 0; i < cuts_.size(); ++i) {
                const Cut &from = cuts_[i], &to = cuts_[(i + 1) % cuts_.size()];
                add_piece(&from, &to, from.at, i + 1 < cuts_.size() ? to.at : to.at + count);
            }
        } else {
            for (std::size_t i = 0; i <= cuts_.size(); ++i)
                add_piece(i > 0 ? &cuts_[i - 1] : nullptr, i < cuts_.size() ? &cuts_[i] : nullptr,
                          i > 0 ? cuts_[i - 1].at : 0.0, i < cuts_.size() ? cuts_[i].at : count);
        }
        return static_cast<int>(cuts_.size());
    }

  private:
    // Metres along the path from its start.
    double distance(Place at) const {
        double sum = 0.0;
        const std::size_t element = std::min(static_cast<std::size_t>(at), old_.size() - 1);
        for (std::size_t i = 0; i < element; ++i) sum += lengths_[i];
        return sum + (at - static_cast<double>(element)) * lengths_[element];
    }

    // Cuts closer together than the snap distance: an odd number of them is one crossing, an even one a
    // touch. On an open path a cut at an end leaves no piece beyond.
    void merge_cuts() {
        std::sort(cuts_.begin(), cuts_.end(), [](const Cut& a, const Cut& b) {
            return std::tuple(a.at, a.end.clip_angle) < std::tuple(b.at, b.end.clip_angle);
        });
        const double whole = distance(static_cast<double>(old_.size()));
        std::vector<Cut> kept;
        for (std::size_t i = 0; i < cuts_.size();) {
            std::size_t k = i + 1;
            while (k < cuts_.size() && distance(cuts_[k].at) - distance(cuts_[k - 1].at) <= shortest_) ++k;
            const double at = distance(cuts_[i].at);
            const bool at_end = !path_.closed && (at <= shortest_ || whole - at <= shortest_);
            if ((k - i) % 2 == 1 && !at_end) kept.push_back(cuts_[i]);
            i = k;
        }
        cuts_ = std::move(kept);
    }

    // The place `by` metres farther; stops at the ends of an open path.
    Place advanced(Place at, double by) const {
        const double count = static_cast<double>(old_.size());
        for (int guard = 0; by != 0.0 && guard < 64; ++guard) {
            const bool ahead = by > 0.0;
            double whole = ahead ? std::floor(at) : std::ceil(at) - 1.0;
            if (!path_.closed && (whole < 0.0 || whole >= count)) break;
            const double extent = std::max(lengths_[index_of(whole)], 1e-300);
            const double room = (ahead ? whole + 1.0 - at : at - whole) * extent;
            if (room >= std::abs(by)) return at + by / extent;
            at = ahead ? whole + 1.0 : whole;
            by += ahead ? -room : room;
        }
        return at;
    }

    std::size_t index_of(double whole) const {
        const double count = static_cast<double>(old_.size());
        return static_cast<std::size_t>(whole - std::floor(whole / count) * count);
    }

    void add_piece(const Cut* from, const Cut* to, Place low, Place high) {
        const std::size_t first = path_.elements.size();
        add_run(low, high, from && from->back > 0.0 ? advanced(low, -from->back) : low,
                to && to->forward > 0.0 ? advanced(high, to->forward) : high);
        if (from) {
            path_.region_starts[first] = 1;
            path_.starts[first] = from->end;
        }
        if (to) path_.ends.back() = to->end;
    }

    // Elements from `begin` to `end`; the run's own region is [low, high].
    void add_run(Place low, Place high, Place begin, Place end) {
        const std::size_t first = path_.elements.size();
        for (double whole = std::floor(begin); whole < end; whole += 1.0) {
            const double s0 = std::max(0.0, begin - whole), s1 = std::min(1.0, end - whole);
            const std::size_t i = index_of(whole);
            // Slivers at a cut carry no direction; one element always stays.
            const bool sliver = (s1 - s0) * lengths_[i] <= 0.1 * shortest_ && (s0 > 0.0 || s1 < 1.0);
            if (sliver && !(path_.elements.size() == first && whole + 1.0 >= end)) continue;
            const double lap = std::floor(whole / static_cast<double>(old_.size()));
            push(curve::translated(curve::part(old_[i], s0, s1), lap_ * lap));
        }
        std::vector<Vec2> samples;
        constexpr int kSamples = 12;
        for (int k = 0; k < kSamples; ++k) {
            const Place at = low + (high - low) * (k + 0.5) / kSamples;
            samples.push_back(curve::point(old_[index_of(std::floor(at))], at - std::floor(at)));
        }
        path_.samples.push_back(std::move(samples));
    }

    void push(const Element& e) {
        path_.elements.push_back(e);
        path_.starts.emplace_back();
        path_.ends.emplace_back();
        path_.region_starts.push_back(0);
    }

    const Work& work_;
    WorkPath& path_;
    std::vector<Element> old_;
    std::vector<Cut> cuts_;
    std::vector<double> lengths_;
    Vec2 lap_;  // a closed path around the tile comes back so much farther
    double shortest_;
};

// A groove that ends on a step which bends within its strip goes on beyond it; the level bounds it there.
void extend_onto_bent_steps(const Work& work, WorkPath& path) {
    for (int which = 0; which < 2 && !path.closed && !path.step; ++which) {
        PathEnd& end = path.end[which];
        if (!end.on_path || !work.paths[end.target].step) continue;
        const std::size_t element = which == 0 ? 0 : path.elements.size() - 1;
        const Vec2 away = which == 0 ? -curve::tangent(path.elements[element], 0.0)
                                     : curve::tangent(path.elements[element], 1.0);
        const double half_width = half_width_of(path, element);
        const Passage passage =
            passage_of(work.paths[end.target], end.target_element, end.target_s, away, end.clip, half_width);
        if (passage.straight && std::abs(cross(away, end.clip)) > 0.12) continue;
        Element more = path.elements[element];
        const Vec2 at = which == 0 ? more.p0 : more.p2;
        const Vec2 tip = at + away * (1.1 * passage.forward + 0.1 * half_width);
        more.kind = ElementKind::line;
        more.p0 = which == 0 ? tip : at;
        more.p2 = which == 0 ? at : tip;
        more.p1 = lerp(more.p0, more.p2, 0.5);
        if (which == 0)
            more.width1 = more.width0, more.height1 = more.height0, more.argument1 = more.argument0;
        else
            more.width0 = more.width1, more.height0 = more.height1, more.argument0 = more.argument1;
        const std::size_t place = which == 0 ? 0 : path.elements.size();
        path.elements.insert(path.elements.begin() + static_cast<std::ptrdiff_t>(place), more);
        path.starts.insert(path.starts.begin() + static_cast<std::ptrdiff_t>(place), ElementEnd{});
        path.ends.insert(path.ends.begin() + static_cast<std::ptrdiff_t>(place), ElementEnd{});
        path.region_starts.insert(path.region_starts.begin() + static_cast<std::ptrdiff_t>(place), 0);
        end.extended = true;
    }
}

}  // namespace

Vec2 tangent_at(const Work& work, const WorkPath& path, std::size_t element, double s) {
    const Element& e = path.elements[element];
    const std::size_t count = path.elements.size();
    const Vec2 p = curve::point(e, s);
    const double near = std::max(work.snap, 1e-12);
    if (length(p - e.p0) <= near && (element > 0 || path.closed))
        return unit(curve::tangent(e, 0.0) +
                    curve::tangent(path.elements[(element + count - 1) % count], 1.0));
    if (length(p - e.p2) <= near && (element + 1 < count || path.closed))
        return unit(curve::tangent(e, 1.0) + curve::tangent(path.elements[(element + 1) % count], 0.0));
    return curve::tangent(e, s);
}

std::vector<PathError> split_at_steps(Work& work) {
    std::vector<PathError> errors;
    std::vector<std::vector<Cut>> cuts(work.paths.size());
    for (const ArcCrossing& crossing : find_arc_crossings(work)) {
        const WorkPath &a = work.paths[crossing.path[0]], &b = work.paths[crossing.path[1]];
        if (a.step && b.step) {
            const std::size_t loser =
                a.elements.size() < b.elements.size() ? crossing.path[0] : crossing.path[1];
            work.stats.crossings.push_back({{a.source, b.source}, wrapped(work, crossing.position)});
            errors.push_back({loser, "step path " + std::to_string(a.source) + " crosses step path " +
                                         std::to_string(b.source) + " at " +
                                         position_text(wrapped(work, crossing.position)) +
                                         "; step paths may only end on each other"});
            continue;
        }
        work.junctions.push_back({JunctionKind::crossing, wrapped(work, crossing.position)});
        if (!a.step && !b.step) continue;
        const int groove = a.step ? 1 : 0;
        cuts[crossing.path[groove]].push_back(cut_at(work, crossing, groove));
    }
    if (!errors.empty()) return errors;
    for (std::size_t p = 0; p < work.paths.size(); ++p) {
        WorkPath& path = work.paths[p];
        work.stats.step_crossings += Splitter(work, path, std::move(cuts[p])).run();
        extend_onto_bent_steps(work, path);
    }
    return errors;
}

}  // namespace burin::resolving
