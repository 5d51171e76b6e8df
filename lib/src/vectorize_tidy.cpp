// Chains against each other: open ends that belong on another line, and step contours that a loose fit let cross.
#include "vectorize_internal.hpp"
#include "vectorize_profiles.hpp"
#include "vectorize_segments.hpp"

#include <algorithm>
#include <cmath>

#include <burin/fit.hpp>

namespace burin::vectorizing {
namespace {

// Looks from behind the end of `points` to some way ahead of it for the first other chain.
bool find_ahead(const std::vector<Vec2>& points, double half_width, std::uint32_t self, const SegmentBuckets& buckets,
                const std::vector<Chain>& chains, Vec2& found) {
    const std::size_t n = points.size();
    const double behind = 3.0 * half_width + 4.0, ahead = 2.0 * half_width + 6.0;
    std::size_t base = n - 1;
    while (base > 0 && length(points[base] - points[n - 1]) < behind) --base;
    const Vec2 direction = unit(points[n - 1] - points[base]);
    const Vec2 from = points[base], to = points[n - 1] + direction * (ahead + 12.0);
    const double past_end = length(points[n - 1] - from);
    double best = 1e300;
    buckets.near(from, to, 1.0, [&](const Segment& s, Vec2 shift) {
        if (s.chain == self) return;
        double t = 0.0, u = 0.0;
        if (!meet(from, to, s.a + shift, s.b + shift, t, u)) return;
        const double distance = t * length(to - from);
        // Only as far as the other line is wide: two separate lines may well end facing each other.
        if (distance - past_end > ahead + 1.5 * chains[s.chain].half_width - 2.0) return;
        if (distance < best) best = distance, found = from + (to - from) * t;
    });
    return best < 1e300;
}

void extend_end(Chain& chain, std::uint32_t self, const SegmentBuckets& buckets, const std::vector<Chain>& chains) {
    Vec2 target;
    if (chain.points.size() < 2 || !find_ahead(chain.points, chain.half_width, self, buckets, chains, target)) return;
    const Vec2 direction = unit(chain.points.back() - chain.points[chain.points.size() - 2]);
    while (chain.points.size() > 2 && dot(chain.points.back() - target, direction) > -0.5) chain.points.pop_back();
    chain.points.push_back(target);
    chain.end_tie = EndTie::chain;
}

}  // namespace

void extend_to_lines(std::vector<Chain>& chains, const Lattice& lattice) {
    SegmentBuckets buckets(lattice);
    for (std::size_t c = 0; c < chains.size(); ++c)
        for (std::size_t k = 0; k + 1 < chains[c].points.size(); ++k)
            buckets.add({chains[c].points[k], chains[c].points[k + 1], static_cast<std::uint32_t>(c),
                         static_cast<std::uint32_t>(k)});
    for (std::size_t c = 0; c < chains.size(); ++c) {
        Chain& chain = chains[c];
        if (chain.closed) continue;
        if (chain.end_tie == EndTie::free) extend_end(chain, static_cast<std::uint32_t>(c), buckets, chains);
        if (chain.start_tie != EndTie::free) continue;
        std::reverse(chain.points.begin(), chain.points.end());
        std::swap(chain.start_tie, chain.end_tie);
        extend_end(chain, static_cast<std::uint32_t>(c), buckets, chains);
        std::swap(chain.start_tie, chain.end_tie);
        std::reverse(chain.points.begin(), chain.points.end());
    }
}

namespace {

void add_elements(SegmentBuckets& buckets, const FittedChain& fitted, std::uint32_t chain) {
    std::uint32_t index = 0;
    for (const Element& e : fitted.elements) {
        const int n = e.kind == ElementKind::line ? 1 : 12;
        for (int k = 0; k < n; ++k)
            buckets.add({point_at(e, double(k) / n), point_at(e, double(k + 1) / n), chain, index++});
    }
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
