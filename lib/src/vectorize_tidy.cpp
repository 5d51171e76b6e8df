// Chains against each other: open ends that belong on another line, and step contours that a loose fit let cross.
#include "vectorize_internal.hpp"
#include "vectorize_profiles.hpp"
#include "vectorize_segments.hpp"

#include <algorithm>
#include <cmath>

#include <burin/fit.hpp>

#include "resolve_curve.hpp"

namespace burin::vectorizing {

LineFit fit_line(const std::vector<Vec2>& points) {
    Vec2 mean;
    for (const Vec2 p : points) mean = mean + p * (1.0 / static_cast<double>(points.size()));
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (const Vec2 p : points) {
        const Vec2 d = p - mean;
        xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    return {mean, {std::cos(angle), std::sin(angle)}};
}

namespace {

constexpr double kHiddenStub = 2.0;  // texels a line may reach out of the one it ends on

void reverse_points(Chain& chain) {
    std::reverse(chain.points.begin(), chain.points.end());
    std::swap(chain.start_tie, chain.end_tie);
}

// The straight way on from an end of a chain, fitted to its last points.
struct EndLine {
    std::uint32_t chain = 0;
    bool at_start = false;
    Vec2 foot, outward;
};

EndLine fit_end_line(const Chain& chain, std::uint32_t index, bool at_start) {
    std::vector<Vec2> near;
    const double span = std::max(8.0, 4.0 * chain.half_width);
    const std::size_t n = chain.points.size();
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2 p = chain.points[at_start ? k : n - 1 - k];
        // The point of a tie lies apart from those that were measured.
        if (near.size() == 1 && length(p - near.front()) > kBridge) near.clear();
        if (near.size() >= 2 && length(p - near.back()) > kBridge) break;
        if (near.size() >= 3 && length(p - near.front()) > span) break;
        near.push_back(p);
    }
    auto [mean, outward] = fit_line(near);
    if (dot(outward, near.front() - near.back()) < 0.0) outward = -outward;
    return {index, at_start, mean + outward * dot(near.front() - mean, outward), outward};
}

class EndJoiner {
  public:
    EndJoiner(std::vector<Chain>& chains, const Image& response, const std::vector<std::uint8_t>& hidden, const Lattice& lattice)
        : chains_(chains), response_(response), hidden_(hidden), lattice_(lattice) {}

    void run() {
        std::vector<EndLine> ends;
        for (std::uint32_t c = 0; c < chains_.size(); ++c) {
            if (chains_[c].closed || chains_[c].points.size() < 6) continue;
            for (const bool at_start : {true, false}) ends.push_back(fit_end_line(chains_[c], c, at_start));
        }
        struct Pair {
            double cost;
            std::size_t a, b;
        };
        std::vector<Pair> pairs;
        SegmentBuckets buckets(lattice_);
        for (std::uint32_t a = 0; a < ends.size(); ++a) buckets.add({ends[a].foot, ends[a].foot, a});
        for (std::size_t a = 0; a < ends.size(); ++a)
            for (const std::size_t b : later_ends_near(a, ends[a], buckets)) {
                const double cost = cost_of(ends[a], ends[b]);
                if (cost < 1.0) pairs.push_back({cost, a, b});
            }
        std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) { return p.cost < q.cost; });
        std::vector<std::uint8_t> taken(ends.size(), 0);
        for (std::uint32_t c = 0; c < chains_.size(); ++c) part_of_.push_back(c), ends_.push_back({2 * c, 2 * c + 1});
        for (const Pair& pair : pairs) {
            if (taken[pair.a] || taken[pair.b] || !join(ends[pair.a], ends[pair.b])) continue;
            taken[pair.a] = taken[pair.b] = 1;
        }
        chains_.erase(std::remove_if(chains_.begin(), chains_.end(), [](const Chain& c) { return c.points.empty(); }),
                      chains_.end());
    }

  private:
    static constexpr double kMostWidths = 8.0, kWider = 1.3;  // of a gap; between the two lines

    // Those behind `a` that cost_of may accept, in order.
    std::vector<std::size_t> later_ends_near(std::size_t a, const EndLine& end, const SegmentBuckets& buckets) const {
        const double widest = kWider * (chains_[end.chain].half_width + 0.5);
        std::vector<std::size_t> near;
        // A bucket more, since the last one of a row may be narrower.
        buckets.near(end.foot, end.foot, kMostWidths * (widest + 1.0) + 16.0, [&](const Segment& s, Vec2) {
            if (s.chain > a) near.push_back(s.chain);
        });
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        return near;
    }

    // Below 1 when the two continue each other.
    double cost_of(const EndLine& a, const EndLine& b) const {
        const Chain& p = chains_[a.chain];
        const Chain& q = chains_[b.chain];
        const double wide = std::max(p.half_width, q.half_width), narrow = std::min(p.half_width, q.half_width);
        const double high = std::max(p.contrast, q.contrast), low = std::min(p.contrast, q.contrast);
        const Vec2 between = b.foot + lattice_.shift_to(b.foot, a.foot) - a.foot;
        const double gap = length(between);
        if (gap > kMostWidths * (wide + 1.0) || wide + 0.5 > kWider * (narrow + 0.5) || high > 1.4 * low) return 2.0;
        // A ring that something hides once is one chain already.
        if (a.chain == b.chain && static_cast<double>(p.points.size()) < 4.0 * gap) return 2.0;
        if (gap == 0.0 || dot(between, a.outward) < 0.0 || !is_shown(a, between)) return 2.0;
        return std::min(straight_cost(a, b, between, 0.25 * wide + 0.5 + 0.04 * gap), bent_cost(a, b, between));
    }

    static double straight_cost(const EndLine& a, const EndLine& b, Vec2 between, double allowed) {
        const double turn = std::acos(std::clamp(-dot(a.outward, b.outward), -1.0, 1.0));
        const double offset = std::max(std::fabs(cross(a.outward, between)), std::fabs(cross(b.outward, between)));
        return turn > 0.3 || offset > allowed ? 2.0 : 0.5 * turn / 0.3 + 0.5 * offset / allowed;
    }

    // An arc that another line hides in the middle turns on both sides of it by the same angle.
    double bent_cost(const EndLine& a, const EndLine& b, Vec2 between) const {
        constexpr double kMostTurn = 1.5, kMostDifference = 0.15;  // radians
        if (!hidden_[lattice_.nearest(a.foot + between * 0.5)]) return 2.0;
        const double first = turn_between(a.outward, between), second = turn_between(between, -b.outward);
        const double difference = std::fabs(first - second);
        if (std::fabs(first + second) > kMostTurn || difference > kMostDifference) return 2.0;
        return 0.5 + 0.5 * difference / kMostDifference;
    }

    bool is_shown(const EndLine& a, Vec2 between) const {
        const int steps = static_cast<int>(std::ceil(2.0 * length(between)));
        for (int k = 0; k <= steps; ++k) {
            const Vec2 p = a.foot + between * (double(k) / std::max(1, steps));
            if (!hidden_[lattice_.nearest(p)] && sample(response_, lattice_, p) < 0.5 * chains_[a.chain].contrast) return false;
        }
        return true;
    }

    bool join(const EndLine& a, const EndLine& b) {
        const std::uint32_t first = part_of_[a.chain], second = part_of_[b.chain];
        if (first == second) return close(chains_[first], ends_[first].back == id_of(a) ? a : b, ends_[first].back == id_of(a) ? b : a);
        Chain& p = chains_[first];
        Chain& q = chains_[second];
        if (ends_[first].back != id_of(a)) turn(first);
        if (ends_[second].back != id_of(b)) turn(second);
        drop_beyond(p.points, a);
        drop_beyond(q.points, b);
        turn(second);
        const Vec2 shift = lattice_.shift_to(q.points.front(), p.points.back());
        const double np = static_cast<double>(p.points.size()), nq = static_cast<double>(q.points.size());
        p.half_width = (np * p.half_width + nq * q.half_width) / (np + nq);
        p.contrast = (np * p.contrast + nq * q.contrast) / (np + nq);
        for (const Vec2 point : q.points) p.points.push_back(point + shift);
        p.end_tie = q.end_tie;
        q.points.clear();
        ends_[first].back = ends_[second].back;
        for (std::uint32_t& part : part_of_)
            if (part == second) part = first;
        return true;
    }

    bool close(Chain& chain, const EndLine& back, const EndLine& front) {
        drop_beyond(chain.points, back);
        std::reverse(chain.points.begin(), chain.points.end());
        drop_beyond(chain.points, front);
        std::reverse(chain.points.begin(), chain.points.end());
        chain.closed = true;
        chain.start_tie = chain.end_tie = EndTie::free;
        chain.winding = lattice_.shift_to(chain.points.front() - chain.points.back(), {0.0, 0.0});
        return true;
    }

    static std::uint32_t id_of(const EndLine& end) { return 2 * end.chain + (end.at_start ? 0 : 1); }

    void turn(std::uint32_t part) {
        reverse_points(chains_[part]);
        std::swap(ends_[part].front, ends_[part].back);
    }

    // The point of a tie, and what was guessed of an end.
    void drop_beyond(std::vector<Vec2>& points, const EndLine& end) const {
        while (points.size() > 3 &&
               dot(points.back() + lattice_.shift_to(points.back(), end.foot) - end.foot, end.outward) > 0.25)
            points.pop_back();
    }

    std::vector<Chain>& chains_;
    const Image& response_;
    const std::vector<std::uint8_t>& hidden_;
    const Lattice& lattice_;
    std::vector<std::uint32_t> part_of_;  // where a chain's points are after joining
    struct Ends {
        std::uint32_t front, back;  // see id_of
    };
    std::vector<Ends> ends_;              // of the chains as they are now
};

}  // namespace

void join_facing_ends(std::vector<Chain>& chains, const Image& response, const std::vector<std::uint8_t>& hidden,
                      const Lattice& lattice) {
    EndJoiner(chains, response, hidden, lattice).run();
}

namespace {

class LineExtender {
  public:
    LineExtender(std::vector<Chain>& chains, const Image& response, const Lattice& lattice)
        : chains_(chains), response_(response), lattice_(lattice), buckets_(lattice) {
        for (std::size_t c = 0; c < chains.size(); ++c)
            for (std::size_t k = 0; k + 1 < chains[c].points.size(); ++k)
                buckets_.add({chains[c].points[k], chains[c].points[k + 1], static_cast<std::uint32_t>(c),
                              static_cast<std::uint32_t>(k)});
    }

    // The end of chain c, if it is free.
    void extend(std::uint32_t c) {
        Chain& chain = chains_[c];
        Vec2 target;
        if (chain.end_tie != EndTie::free || chain.points.size() < 2 || !find_ahead(c, target)) return;
        const Vec2 direction = unit(chain.points.back() - chain.points[chain.points.size() - 2]);
        while (chain.points.size() > 2 && dot(chain.points.back() - target, direction) > -0.5) chain.points.pop_back();
        chain.points.push_back(target);
        chain.end_tie = EndTie::chain;
    }

  private:
    // Looks from behind the end to some way ahead of it for the first other chain.
    bool find_ahead(std::uint32_t c, Vec2& found) const {
        const Chain& chain = chains_[c];
        const std::vector<Vec2>& points = chain.points;
        const std::size_t n = points.size();
        const double behind = 3.0 * chain.half_width + 4.0, ahead = 2.0 * chain.half_width + 6.0;
        std::size_t base = n - 1;
        while (base > 0 && length(points[base] - points[n - 1]) < behind) --base;
        const Vec2 direction = unit(points[n - 1] - points[base]);
        const Vec2 from = points[base], to = points[n - 1] + direction * (ahead + 12.0);
        const double past_end = length(points[n - 1] - from);
        double best = 1e300, other_half_width = 0.0;
        buckets_.near(from, to, 1.0, [&](const Segment& s, Vec2 shift) {
            if (s.chain == c) return;
            double t = 0.0, u = 0.0;
            if (!meet(from, to, s.a + shift, s.b + shift, t, u)) return;
            const double distance = t * length(to - from);
            const double other = chains_[s.chain].half_width;
            // Only as far as the other line is wide: two separate lines may well end facing each other.
            if (distance - past_end > ahead + 1.5 * other - 2.0) return;
            // A stub that can be seen beyond the other line stays.
            const double sine = std::fabs(cross(direction, unit(s.b - s.a)));
            if ((past_end - distance) * sine + chain.half_width > other + kHiddenStub) return;
            if (distance >= best) return;
            best = distance;
            found = from + (to - from) * t;
            other_half_width = other;
        });
        return best < 1e300 && is_shown(chain, found, other_half_width);
    }

    // Whether the line goes on from its end until it runs into the other.
    bool is_shown(const Chain& chain, Vec2 target, double other_half_width) const {
        constexpr double kStride = 0.5, kMostGap = 1.5;
        const Vec2 way = target - chain.points.back();
        const double end = length(way) - other_half_width - 1.0;
        double gap = 0.0;
        for (double t = 0.0; t < end && gap <= kMostGap; t += kStride)
            if (sample(response_, lattice_, chain.points.back() + unit(way) * t) < 0.5 * chain.contrast) gap += kStride;
        return gap <= kMostGap;
    }

    std::vector<Chain>& chains_;
    const Image& response_;
    const Lattice& lattice_;
    SegmentBuckets buckets_;
};

}  // namespace

void extend_to_lines(std::vector<Chain>& chains, const Image& response, const Lattice& lattice) {
    LineExtender extender(chains, response, lattice);
    for (std::size_t c = 0; c < chains.size(); ++c) {
        if (chains[c].closed) continue;
        extender.extend(static_cast<std::uint32_t>(c));
        reverse_points(chains[c]);
        extender.extend(static_cast<std::uint32_t>(c));
        reverse_points(chains[c]);
    }
}

namespace {

// Chords of an element; all have one index, or each its own.
std::uint32_t add_chords(SegmentBuckets& buckets, const Element& e, std::uint32_t chain, std::uint32_t index, bool counted) {
    const int n = e.kind == ElementKind::line ? 1 : 12;
    for (int k = 0; k < n; ++k, index += counted ? 1 : 0)
        buckets.add({point_at(e, double(k) / n), point_at(e, double(k + 1) / n), chain, index});
    return index;
}

void add_elements(SegmentBuckets& buckets, const FittedChain& fitted, std::uint32_t chain) {
    std::uint32_t index = 0;
    for (const Element& e : fitted.elements) index = add_chords(buckets, e, chain, index, true);
}

// Chains may touch at the ends they share, and neighbours along a chain always do.
bool is_crossing(const Segment& p, const Segment& q, Vec2 shift) {
    if (p.chain == q.chain && (p.index <= q.index + 1 && q.index <= p.index + 1)) return false;
    const Vec2 a = q.a + shift, b = q.b + shift;
    const double near = 1e-6;
    for (const Vec2 u : {p.a, p.b})
        for (const Vec2 v : {a, b})
            if (length(u - v) < near) return false;
    double t = 0.0, s = 0.0;
    return meet(p.a, p.b, a, b, t, s);
}

}  // namespace

std::vector<std::uint8_t> find_tangled_steps(const std::vector<FittedChain>& chains, const Lattice& lattice) {
    SegmentBuckets buckets(lattice);
    for (std::size_t c = 0; c < chains.size(); ++c)
        if (chains[c].chain.kind == ChainKind::step) add_elements(buckets, chains[c], static_cast<std::uint32_t>(c));
    std::vector<std::uint8_t> tangled(chains.size(), 0);
    buckets.for_each([&](const Segment& p) {
        buckets.near(p.a, p.b, 0.0, [&](const Segment& q, Vec2 shift) {
            if (is_crossing(p, q, shift)) tangled[p.chain] = tangled[q.chain] = 1;
        });
    });
    return tangled;
}

namespace {

// Moves one end of a line onto the fitted line of another chain that passes within `reach` of it. Where that one ends too, or
// runs alongside, the two continue each other, and neither ends on the other.
void land_end(std::vector<FittedChain>& chains, std::uint32_t chain, bool at_start, const SegmentBuckets& buckets, double reach) {
    constexpr double kLeastSine = 0.2, kPassesBy = 2.0;  // texels
    std::vector<Element>& own = chains[chain].elements;
    Vec2& end = at_start ? own.front().p0 : own.back().p2;
    const Vec2 along = at_start ? curve::tangent(own.front(), 0.0) : curve::tangent(own.back(), 1.0);
    Vec2 landing = end;
    double least = reach;
    buckets.near(end, end, reach, [&](const Segment& s, Vec2 shift) {
        if (s.chain == chain) return;
        const std::vector<Element>& other = chains[s.chain].elements;
        const Element& e = other[s.index];
        const double at = curve::nearest(e, end - shift);
        const Vec2 foot = curve::point(e, at);
        const bool passes = chains[s.chain].chain.closed || std::min(length(foot - other.front().p0), length(foot - other.back().p2)) > kPassesBy;
        if (!passes || std::fabs(cross(along, curve::tangent(e, at))) < kLeastSine) return;
        if (length(foot + shift - end) < least) least = length(foot + shift - end), landing = foot + shift;
    });
    end = landing;
}

}  // namespace

void land_tees(std::vector<FittedChain>& chains, const Lattice& lattice, double tolerance) {
    SegmentBuckets buckets(lattice);
    for (std::uint32_t c = 0; c < chains.size(); ++c)
        for (std::uint32_t i = 0; i < chains[c].elements.size() && chains[c].chain.kind != ChainKind::step; ++i)
            add_chords(buckets, chains[c].elements[i], c, i, false);
    const double reach = 2.0 * tolerance + 0.5;  // as far as both fits may lie from where the chains meet
    for (std::uint32_t c = 0; c < chains.size(); ++c) {
        const Chain& chain = chains[c].chain;
        if (chain.kind == ChainKind::step || chain.closed) continue;
        if (chain.start_tie == EndTie::chain) land_end(chains, c, true, buckets, reach);
        if (chain.end_tie == EndTie::chain) land_end(chains, c, false, buckets, reach);
    }
}

namespace {

// Continues a cut end straight to where no cap can be seen.
void run_out(std::vector<Vec2>& points, double half_width) {
    const std::size_t n = points.size(), back = std::min<std::size_t>(n - 1, 8);
    points.push_back(points[n - 1] + unit(points[n - 1] - points[n - 1 - back]) * (3.0 * half_width + 8.0));
}

void add_run(std::vector<Chain>& out, const Chain& source, std::vector<Vec2>& run, bool cut_front, bool cut_back) {
    if (run.size() >= 4 || (!cut_front && !cut_back && run.size() >= 2)) {
        Chain chain = source;
        chain.points = run;
        chain.closed = source.closed && !cut_front && !cut_back;
        if (cut_back) run_out(chain.points, chain.half_width), chain.end_tie = EndTie::border;
        if (cut_front) {
            std::reverse(chain.points.begin(), chain.points.end());
            run_out(chain.points, chain.half_width);
            std::reverse(chain.points.begin(), chain.points.end());
            chain.start_tie = EndTie::border;
        }
        out.push_back(std::move(chain));
    }
    run.clear();
}

}  // namespace

std::vector<Chain> clip_chains(const std::vector<Chain>& chains, int margin, const Lattice& lattice) {
    std::vector<Chain> out;
    const auto inside = [&](Vec2 p) {
        return p.x >= -1.0 && p.y >= -1.0 && p.x <= lattice.width + 1.0 && p.y <= lattice.height + 1.0;
    };
    for (const Chain& source : chains) {
        std::vector<Vec2> points = source.points;
        for (Vec2& p : points) p = p - Vec2{double(margin), double(margin)};
        // A loop that leaves the map is opened where it is outside.
        if (source.closed) {
            const auto outside = std::find_if_not(points.begin(), points.end(), inside);
            if (outside != points.end()) std::rotate(points.begin(), outside, points.end());
        }
        std::vector<Vec2> run;
        bool cut_front = false;
        for (const Vec2 p : points) {
            if (inside(p)) {
                run.push_back(p);
                continue;
            }
            add_run(out, source, run, cut_front, true);
            cut_front = true;
        }
        const bool reopened = source.closed && !points.empty() && !inside(points.front());
        add_run(out, source, run, cut_front, reopened);
    }
    return out;
}

}  // namespace burin::vectorizing
