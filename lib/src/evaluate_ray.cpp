// First hit of a ray with the solid.
//
// Along a ray the solid can only begin or end at an event: where the ray meets a facet's surface, the
// vertical over a profile point, the border of where an element acts, a step's path line, or a level of
// ground. All events are gathered, sorted, and the solid is asked half way between neighbours; nothing else
// is reasoned about.
#include <algorithm>
#include <cassert>

#include "evaluate_prepare.hpp"

namespace burin {
namespace {

using namespace truth;
using Prepared = Truth::Prepared;

constexpr int kSamples = 32;       // per smooth piece of a curved element; between them roots are polished
constexpr double kSliver = 1e-13;  // pieces of the ray shorter than this fraction of the tile are not asked

// One tile image of an element near the ray. Its own coordinates are those of the plane minus shift.
struct Near {
    const PreparedElement* element;
    std::uint32_t index;
    Vec2 shift;
};

struct State {
    double ground = 0;
    bool under_ground = false;
    std::vector<std::uint8_t> add, cut;  // per Near
    bool any_add = false, any_cut = false;
    bool base() const { return under_ground || any_add; }
    bool solid() const { return base() && !any_cut; }
};

class Tracer {
  public:
    Tracer(const Truth& owner, const Ray& ray)
        : owner_(owner),
          truth_(owner.prepared()),
          origin_{ray.origin[0], ray.origin[1]},
          height_(ray.origin[2]),
          along_{ray.direction[0], ray.direction[1]},
          climb_(ray.direction[2]) {
        const double whole = std::sqrt(dot(along_, along_) + climb_ * climb_);
        assert(whole > 0.0);
        whole_ = whole;
        before_ = -1e-6 * truth_.depth / whole;
    }

    RayHit trace();

  private:
    Vec2 at(double t) const { return origin_ + along_ * t; }
    double z_at(double t) const { return height_ + climb_ * t; }

    bool find_range(double& begin, double& end) const;
    std::vector<double> cut_into_chunks(double begin, double end) const;
    bool trace_chunk(double begin, double end, RayHit& hit);

    void gather_near(double begin, double end);
    void gather_events(double begin, double end);
    void gather_ground_events(double begin, double end);
    void gather_element_events(const Near& near, double begin, double end);
    void gather_breaks(const Near& near, double begin, double end);
    void gather_wave_breaks(const Near& near, double begin, double end);
    void gather_hip_breaks(const Near& near, double begin, double end);
    void gather_smooth(const Near& near, const Form& form, double begin, double end);
    template <typename Function>
    void find_roots(const double* values, double begin, double end, Function&& function);

    void add_linear(std::vector<double>& to, double at_begin, double at_end, double begin, double end) const;
    Local local_at(const Near& near, const Form& form, double t) const;
    State state_at(double t, double ground) const;
    void describe(double t, double t_before, double t_after, RayHit& hit);
    void describe_element(const Near& near, double t, bool acted, bool acts, const State& was,
                          const State& is, RayHit& hit);
    bool describe_facet(const Near& near, double t, const Form& form, RayHit& hit) const;
    void describe_wall(const Near& near, double t, const Form& form, RayHit& hit) const;
    bool describe_step_wall(double t, RayHit& hit) const;
    void set_normal(double x, double y, double z, RayHit& hit) const;

    const Truth& owner_;
    const Prepared& truth_;
    Vec2 origin_;
    double height_;
    Vec2 along_;
    double climb_;
    double whole_ = 1;       // length of the direction
    double sliver_ = 0;      // kSliver as a difference of t; far from the origin rounding makes it longer
    double before_ = 0;      // a little before the ray's origin
    double last_empty_ = 0;  // a place of the ray known to be outside of the solid, the latest one
    bool any_empty_ = false;
    std::vector<Near> near_;
    std::vector<double> events_, ground_events_, breaks_;
};

// Part of the ray between a little above and a little below everything.
bool Tracer::find_range(double& begin, double& end) const {
    const double margin = 1e-3 * truth_.depth + 1e-3 * (truth_.highest - truth_.lowest);
    const double high = truth_.highest + margin, low = truth_.lowest - margin;
    begin = 0.0;
    end = 1e300;
    if (climb_ < 0.0) {
        begin = std::max(0.0, (high - height_) / climb_);
        end = std::max(begin, (low - height_) / climb_);
        if (height_ < low) end = -1e-3 / climb_;
    } else if (height_ > high) {
        return false;
    } else if (climb_ > 0.0) {
        end = std::max((high - height_) / climb_, 0.0);
    }
    const double run = length(along_);
    if (run > 0.0)
        end = std::min(end, begin + truth_.max_tiles * std::max(truth_.size.x, truth_.size.y) / run);
    return true;
}

// Pieces of at most half a tile, so that few elements are near each; a clamped map ends where nothing acts.
std::vector<double> Tracer::cut_into_chunks(double begin, double end) const {
    std::vector<double> cuts{begin};
    double from = begin, to = end;
    if (!truth_.repeat) {
        const double o[2] = {origin_.x, origin_.y}, d[2] = {along_.x, along_.y},
                     size[2] = {truth_.size.x, truth_.size.y};
        for (int i = 0; i < 2; ++i) {
            if (d[i] == 0.0) continue;
            const double u = -o[i] / d[i], v = (size[i] - o[i]) / d[i];
            from = std::max(from, std::min(u, v));
            to = std::min(to, std::max(u, v));
        }
        if (from >= to) from = to = begin;
        if (from > begin) cuts.push_back(from);
    }
    const double run = length(along_) * (to - from), step = 0.5 * std::min(truth_.size.x, truth_.size.y);
    const double pieces = std::max(1.0, std::ceil(run / step));
    for (double i = 1.0; i < pieces; i += 1.0) cuts.push_back(from + (to - from) * (i / pieces));
    if (to > cuts.back()) cuts.push_back(to);
    if (end > cuts.back()) cuts.push_back(end);
    return cuts;
}

void Tracer::gather_near(double begin, double end) {
    near_.clear();
    const Vec2 a = at(begin), b = at(end);
    const Vec2 low{std::min(a.x, b.x), std::min(a.y, b.y)}, high{std::max(a.x, b.x), std::max(a.y, b.y)};
    for (std::uint32_t i = 0; i < truth_.elements.size(); ++i)
        truth::for_each_image(truth_, truth_.elements[i].box, low, high, [&](Vec2 shift) {
            near_.push_back({&truth_.elements[i], i, shift});
        });
}

// Zero of the function that runs straight from `at_begin` to `at_end`.
void Tracer::add_linear(std::vector<double>& to, double at_begin, double at_end, double begin,
                        double end) const {
    if ((at_begin < 0.0) == (at_end < 0.0) && at_begin != 0.0 && at_end != 0.0) return;
    if (at_begin == at_end) return;
    to.push_back(begin + (end - begin) * (at_begin / (at_begin - at_end)));
}

void Tracer::gather_ground_events(double begin, double end) {
    ground_events_.clear();
    if (along_.x == 0.0 && along_.y == 0.0) return;
    for (const Near& near : near_) {
        if (!near.element->step) continue;
        double u[2];
        const int n = truth::meet_line(*near.element, origin_ - near.shift, along_, u);
        for (int i = 0; i < n; ++i) {
            const Vec2 on = truth::point_on(*near.element, u[i]) + near.shift;
            const double t = dot(on - origin_, along_) / dot(along_, along_);
            if (t > begin && t < end) ground_events_.push_back(t);
        }
    }
    std::sort(ground_events_.begin(), ground_events_.end());
}

void Tracer::gather_events(double begin, double end) {
    events_.clear();
    events_.push_back(begin);
    events_.push_back(end);
    for (const double level : truth_.levels)
        add_linear(events_, z_at(begin) - level, z_at(end) - level, begin, end);
    gather_ground_events(begin, end);
    events_.insert(events_.end(), ground_events_.begin(), ground_events_.end());
    for (const Near& near : near_) gather_element_events(near, begin, end);
    std::sort(events_.begin(), events_.end());
}

// Borders of the pieces of the ray on which one rule holds and b' is smooth.
void Tracer::gather_breaks(const Near& near, double begin, double end) {
    const PreparedElement& e = *near.element;
    const Vec2 a = at(begin) - near.shift, b = at(end) - near.shift;
    breaks_ = {begin, end};
    for (const PreparedEnd& v : e.ends) {
        const double a0 = dot(a - v.vertex, v.outward), a1 = dot(b - v.vertex, v.outward);
        add_linear(breaks_, a0, a1, begin, end);
        if (v.priority != Priority::none)
            add_linear(breaks_, dot(a - v.vertex, v.clip_inward), dot(b - v.vertex, v.clip_inward), begin,
                       end);
        // The tangent line beyond the end: b = 0 there, and |b| = a for hips.
        const double b0 = cross(v.outward, a - v.vertex), b1 = cross(v.outward, b - v.vertex);
        add_linear(breaks_, b0, b1, begin, end);
        add_linear(breaks_, b0 - a0, b1 - a1, begin, end);
        add_linear(breaks_, b0 + a0, b1 + a1, begin, end);
    }
    if (e.function != nullptr) gather_wave_breaks(near, begin, end);
    if (e.kind == ElementKind::line || (along_.x == 0.0 && along_.y == 0.0)) return;
    double u[2];
    const int n = truth::meet_line(e, a, along_, u);
    for (int i = 0; i < n; ++i) {
        const double t = dot(truth::point_on(e, u[i]) + near.shift - origin_, along_) / dot(along_, along_);
        if (t > begin && t < end) breaks_.push_back(t);
    }
    gather_hip_breaks(near, begin, end);
}

// Parts of the ray in which a function along the path runs through a third of its finest wave at most, so that samples
// show every turn of it.
void Tracer::gather_wave_breaks(const Near& near, double begin, double end) {
    const PreparedElement& e = *near.element;
    const double finest = e.function->kind == PerturbationKind::noise ? std::ldexp(1.0, static_cast<int>(e.function->octaves) - 1) : 1.0;
    double run = e.argument_rise;
    if (e.kind == ElementKind::line && e.length > 0.0)
        run *= std::min(1.0, std::abs(dot(along_, e.tangent)) * (end - begin) / e.length);
    const double parts = std::min(std::ceil(3.0 * run * finest), 4096.0);
    for (double i = 1.0; i < parts; i += 1.0) breaks_.push_back(begin + (end - begin) * (i / parts));
}

// On the inside of a curve the foot may lie on the arc although the point is beyond an end; |b| = a is no
// line there.
void Tracer::gather_hip_breaks(const Near& near, double begin, double end) {
    for (const PreparedEnd& v : near.element->ends) {
        if (v.priority != Priority::both || v.end != EndShape::hip) continue;
        const auto gap = [&](double t) {
            const Vec2 p = at(t) - near.shift;
            return std::abs(truth::find_foot(*near.element, p).offset) - dot(p - v.vertex, v.outward);
        };
        double values[kSamples + 1];
        for (int i = 0; i <= kSamples; ++i) values[i] = gap(begin + (end - begin) * i / kSamples);
        const std::size_t known = events_.size();
        find_roots(values, begin, end, gap);
        breaks_.insert(breaks_.end(), events_.begin() + static_cast<std::ptrdiff_t>(known), events_.end());
    }
}

void Tracer::gather_element_events(const Near& near, double begin, double end) {
    // The part of the ray over the element's box.
    const double o[2] = {origin_.x - near.shift.x, origin_.y - near.shift.y}, d[2] = {along_.x, along_.y};
    const Box& box = near.element->box;
    const double low[2] = {box.low.x, box.low.y}, high[2] = {box.high.x, box.high.y};
    for (int i = 0; i < 2; ++i) {
        if (d[i] == 0.0) {
            if (o[i] < low[i] || o[i] > high[i]) return;
            continue;
        }
        const double u = (low[i] - o[i]) / d[i], v = (high[i] - o[i]) / d[i];
        begin = std::max(begin, std::min(u, v));
        end = std::min(end, std::max(u, v));
    }
    if (end - begin <= 0.0) return;
    gather_breaks(near, begin, end);
    std::sort(breaks_.begin(), breaks_.end());
    events_.insert(events_.end(), breaks_.begin(), breaks_.end());
    for (std::size_t i = 0; i + 1 < breaks_.size(); ++i) {
        if (breaks_[i + 1] - breaks_[i] <= sliver_) continue;
        const Vec2 p = at(0.5 * (breaks_[i] + breaks_[i + 1])) - near.shift;
        const Form form = truth::find_form(*near.element, p, truth::find_foot(*near.element, p));
        if (form.kind != FormKind::none) gather_smooth(near, form, breaks_[i], breaks_[i + 1]);
    }
}

Local Tracer::local_at(const Near& near, const Form& form, double t) const {
    const Vec2 p = at(t) - near.shift;
    return truth::evaluate_form(*near.element, form, p, truth::find_foot(*near.element, p));
}

// Events of one smooth piece: b' over profile points and the facets' surfaces, both multiplied by the width
// scale so that along a straight element they are polynomials of degree 2 in t at most.
void Tracer::gather_smooth(const Near& near, const Form& form, double begin, double end) {
    const PreparedElement& e = *near.element;
    const PreparedProfile& profile = truth_.profiles[e.profile];
    const bool polynomial =
        e.kind == ElementKind::line && form.kind != FormKind::radial && (e.function == nullptr || form.kind != FormKind::plain);
    const int n = polynomial ? 2 : kSamples;
    Local locals[kSamples + 1];
    double values[kSamples + 1];
    const auto place = [&](int i) { return begin + (end - begin) * i / n; };
    for (int i = 0; i <= n; ++i) locals[i] = local_at(near, form, place(i));
    const auto over_point = [&](const Local& l, std::size_t k) {
        return l.offset - profile.points[k].b * l.width;
    };
    const auto over_facet = [&](const Local& l, double t, std::size_t k) {
        const ProfilePoint p = profile.points[k];
        return (z_at(t) - e.level) * l.width -
               l.height * (p.h * l.width + profile.slope[k] * (l.offset - p.b * l.width));
    };
    const auto solve = [&](auto&& function) {
        if (!polynomial) return find_roots(values, begin, end, function);
        // Parabola through three values, on [0, 1].
        const double a = 2.0 * (values[0] + values[2]) - 4.0 * values[1], b = values[2] - values[0] - a;
        double roots[2];
        const int found = truth::solve_quadratic(a, b, values[0], roots);
        for (int i = 0; i < found; ++i)
            if (roots[i] >= 0.0 && roots[i] <= 1.0) events_.push_back(begin + (end - begin) * roots[i]);
    };
    for (std::size_t k = 0; k < profile.points.size(); ++k) {
        for (int i = 0; i <= n; ++i) values[i] = over_point(locals[i], k);
        solve([&](double t) { return over_point(local_at(near, form, t), k); });
        if (k + 1 == profile.points.size() || profile.points[k].b == profile.points[k + 1].b) continue;
        for (int i = 0; i <= n; ++i) values[i] = over_facet(locals[i], place(i), k);
        solve([&](double t) { return over_facet(local_at(near, form, t), t, k); });
    }
}

// Zeros of a function sampled at kSamples + 1 places: bisection where the sign changes, and a search for a
// pair of zeros where the function comes close to zero and turns back.
template <typename Function>
void Tracer::find_roots(const double* values, double begin, double end, Function&& function) {
    const auto place = [&](int i) { return begin + (end - begin) * i / kSamples; };
    const auto bisect = [&](double low, double high, double at_low) {
        for (int i = 0; i < 60 && high - low > 0.01 * sliver_; ++i) {
            const double middle = 0.5 * (low + high), value = function(middle);
            if ((value < 0.0) == (at_low < 0.0))
                low = middle;
            else
                high = middle;
        }
        events_.push_back(0.5 * (low + high));
    };
    for (int i = 0; i < kSamples; ++i) {
        if (values[i] == 0.0) events_.push_back(place(i));
        if ((values[i] < 0.0) != (values[i + 1] < 0.0)) bisect(place(i), place(i + 1), values[i]);
    }
    for (int i = 1; i < kSamples; ++i) {
        const double f = std::abs(values[i]), l = std::abs(values[i - 1]), r = std::abs(values[i + 1]);
        const bool same =
            (values[i - 1] < 0.0) == (values[i] < 0.0) && (values[i] < 0.0) == (values[i + 1] < 0.0);
        // A turning point that a parabola keeps well away from zero is not looked at.
        if (!same || f > l || f > r || f > (l - f) + (r - f)) continue;
        double low = place(i - 1), high = place(i + 1);
        for (int k = 0; k < 60 && high - low > sliver_; ++k) {
            const double a = low + (high - low) * 0.382, b = low + (high - low) * 0.618;
            const double fa = function(a), fb = function(b);
            const double x = std::abs(fa) < std::abs(fb) ? a : b, fx = std::abs(fa) < std::abs(fb) ? fa : fb;
            if ((fx < 0.0) != (values[i] < 0.0)) {
                bisect(place(i - 1), x, values[i - 1]);
                bisect(x, place(i + 1), fx);
                break;
            }
            (x == a ? high : low) = x == a ? b : a;
        }
    }
}

State Tracer::state_at(double t, double ground) const {
    State state;
    state.ground = ground;
    state.add.assign(near_.size(), 0);
    state.cut.assign(near_.size(), 0);
    const Vec2 p = at(t);
    const double z = z_at(t);
    state.under_ground = z <= ground;
    if (!truth::inside_map(truth_, p)) return state;
    Local local;
    for (std::size_t i = 0; i < near_.size(); ++i) {
        const PreparedElement& e = *near_[i].element;
        const Vec2 q = p - near_[i].shift;
        if (q.x < e.box.low.x || q.y < e.box.low.y || q.x > e.box.high.x || q.y > e.box.high.y) continue;
        if (!truth::acts_at(truth_, e, q, ground, local)) continue;
        const PreparedProfile& profile = truth_.profiles[e.profile];
        const double b = local.offset / local.width, rise = z - e.level;
        state.add[i] = z > ground && truth::in_add(profile, b, rise, local.height);
        state.cut[i] = truth::in_cut(profile, b, rise, local.height);
        state.any_add = state.any_add || state.add[i];
        state.any_cut = state.any_cut || state.cut[i];
    }
    return state;
}

bool Tracer::trace_chunk(double begin, double end, RayHit& hit) {
    const double far = std::max({std::abs(at(end).x), std::abs(at(end).y), truth_.size.x, truth_.size.y});
    sliver_ = kSliver * far / whole_;
    gather_near(begin, end);
    gather_events(begin, end);
    std::size_t passed = 0;  // step path lines behind us
    double ground = 0.0;
    bool ground_known = false;
    for (std::size_t i = 0; i + 1 < events_.size(); ++i) {
        const double from = std::max(events_[i], begin), to = std::min(events_[i + 1], end);
        if (to - from <= sliver_) continue;
        const double middle = 0.5 * (from + to);
        for (; passed < ground_events_.size() && ground_events_[passed] < middle; ++passed)
            ground_known = false;
        if (!ground_known || !truth_.repeat) ground = owner_.ground_at(at(middle)), ground_known = true;
        if (!state_at(middle, ground).solid()) {
            last_empty_ = middle;
            any_empty_ = true;
            continue;
        }
        hit.hit = true;
        hit.t = from;
        if (!any_empty_) last_empty_ = before_;
        describe(from, last_empty_, middle, hit);
        return true;
    }
    return false;
}

RayHit Tracer::trace() {
    RayHit hit;
    double begin = 0, end = 0;
    if (!find_range(begin, end)) return hit;
    if (end >= 1e299) end = begin + 1.0;  // a level ray without direction in the plane cannot be
    const std::vector<double> cuts = cut_into_chunks(begin, end);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
        if (trace_chunk(cuts[i], cuts[i + 1], hit)) break;
    return hit;
}

// ---- what was hit
// --------------------------------------------------------------------------------------------

// Length 1, against the ray.
void Tracer::set_normal(double x, double y, double z, RayHit& hit) const {
    const double l = std::sqrt(x * x + y * y + z * z);
    const double against = x * along_.x + y * along_.y + z * climb_;
    const double s = (against > 0.0 ? -1.0 : 1.0) / (l > 0.0 ? l : 1.0);
    hit.normal[0] = x * s;
    hit.normal[1] = y * s;
    hit.normal[2] = z * s;
}

// The solid begins at t because a cut ended there or because ground or an add began.
void Tracer::describe(double t, double t_before, double t_after, RayHit& hit) {
    const Vec2 p = at(t);
    hit.position[0] = p.x;
    hit.position[1] = p.y;
    hit.position[2] = z_at(t);
    gather_near(t_before, t_after);
    const State was = state_at(t_before, owner_.ground_at(at(t_before)));
    const State is = state_at(t_after, owner_.ground_at(at(t_after)));
    if (was.solid()) {
        hit.inside = true;
        return set_normal(-along_.x, -along_.y, -climb_, hit);
    }
    std::size_t who = near_.size();
    for (std::size_t i = 0; i < near_.size() && who == near_.size(); ++i)
        if (was.cut[i] && !is.cut[i]) who = i;
    if (who == near_.size() && is.under_ground && !was.under_ground) {
        if (was.ground != is.ground && describe_step_wall(t, hit)) return;
        return set_normal(0, 0, 1, hit);
    }
    for (std::size_t i = 0; i < near_.size() && who == near_.size(); ++i)
        if (is.add[i] && !was.add[i]) who = i;
    if (who == near_.size()) return set_normal(0, 0, 1, hit);
    Local local;
    const Near& near = near_[who];
    const bool acted = truth::acts_at(truth_, *near.element, at(t_before) - near.shift, was.ground, local);
    const bool acts = truth::acts_at(truth_, *near.element, at(t_after) - near.shift, is.ground, local);
    describe_element(near, t, acted, acts, was, is, hit);
}

void Tracer::describe_element(const Near& near, double t, bool acted, bool acts, const State& was,
                              const State& is, RayHit& hit) {
    hit.element = near.index;
    hit.facet = kWall;
    const Vec2 p = at(t) - near.shift;
    Form form = truth::find_form(*near.element, p, truth::find_foot(*near.element, p));
    if (form.kind == FormKind::none) form.kind = FormKind::plain;
    if (was.ground != is.ground && acted != acts && describe_step_wall(t, hit)) return;
    if (describe_facet(near, t, form, hit)) return;
    describe_wall(near, t, form, hit);
}

// The facet whose segment, in the plane of the profile, the hit lies on.
bool Tracer::describe_facet(const Near& near, double t, const Form& form, RayHit& hit) const {
    const PreparedElement& e = *near.element;
    const PreparedProfile& profile = truth_.profiles[e.profile];
    const Vec2 p = at(t) - near.shift;
    const Foot foot = truth::find_foot(e, p);
    const Local local = truth::evaluate_form(e, form, p, foot);
    double nearest = 1e-7 * (e.reach + truth_.depth);
    std::uint32_t facet = kWall;
    for (std::uint32_t i = 0; i + 1 < profile.points.size(); ++i) {
        const ProfilePoint a = profile.points[i], b = profile.points[i + 1];
        const Vec2 from{a.b * local.width, a.h * local.height}, to{b.b * local.width, b.h * local.height};
        const Vec2 q{local.offset, z_at(t) - e.level}, d = to - from;
        const double s = dot(d, d) > 0.0 ? std::clamp(dot(q - from, d) / dot(d, d), 0.0, 1.0) : 0.0;
        const double distance = length(q - (from + d * s));
        if (distance < nearest) nearest = distance, facet = i;
    }
    if (facet == kWall) return false;
    hit.facet = facet;
    const ProfilePoint a = profile.points[facet], b = profile.points[facet + 1];
    const truth::LocalGradient g = truth::gradient_of(e, form, p, foot);
    // F = (z - level) / H db - h_a db - dh (b' / W - b_a) vanishes on the facet, H and W the scales.
    const double db = b.b - a.b, dh = b.h - a.h, w = local.width,
                 h = local.height != 0.0 ? local.height : 1.0;
    const Vec2 slide = (g.offset - g.width * (local.offset / w)) * (1.0 / w);
    const Vec2 plan = slide * -dh - g.height * ((z_at(t) - e.level) / (h * h) * db);
    set_normal(plan.x, plan.y, db / h, hit);
    return true;
}

// A vertical wall: of the candidates the one that passes through the hit.
void Tracer::describe_wall(const Near& near, double t, const Form& form, RayHit& hit) const {
    const PreparedElement& e = *near.element;
    const Vec2 p = at(t) - near.shift;
    const Foot foot = truth::find_foot(e, p);
    const Local local = truth::evaluate_form(e, form, p, foot);
    const truth::LocalGradient g = truth::gradient_of(e, form, p, foot);
    double nearest = 1e300;
    Vec2 normal{1, 0};
    const auto offer = [&](double distance, Vec2 n) {
        if (std::abs(distance) < nearest) nearest = std::abs(distance), normal = n;
    };
    for (const PreparedEnd& v : e.ends) {
        offer(dot(p - v.vertex, v.outward), v.outward);
        if (v.priority != Priority::none) offer(dot(p - v.vertex, v.clip_inward), v.clip_inward);
        // The halves of a cap may differ where they meet, beyond the end of the path.
        if (v.priority == Priority::both && v.end != EndShape::clip && dot(p - v.vertex, v.outward) > 0.0)
            offer(dot(p - v.vertex, normal_of(v.outward)), normal_of(v.outward));
    }
    for (const ProfilePoint& point : truth_.profiles[e.profile].points)
        offer(local.offset - point.b * local.width, g.offset - g.width * point.b);
    if (!truth_.repeat) {
        const Vec2 q = at(t);
        offer(q.x, {1, 0});
        offer(q.x - truth_.size.x, {1, 0});
        offer(q.y, {0, 1});
        offer(q.y - truth_.size.y, {0, 1});
    }
    set_normal(normal.x, normal.y, 0.0, hit);
}

// A jump of the ground: the step element whose path line passes through the hit, and the vertical facet of
// its profile at b = 0 that stands at the hit's height, when there is one.
bool Tracer::describe_step_wall(double t, RayHit& hit) const {
    double nearest = 1e-9 * std::max(truth_.size.x, truth_.size.y);
    const Near* found = nullptr;
    Vec2 normal;
    for (const Near& near : near_) {
        if (!near.element->step) continue;
        const Vec2 p = at(t) - near.shift;
        const Foot foot = truth::find_foot(*near.element, p);
        const double distance = length(p - truth::point_on(*near.element, foot.parameter));
        if (distance >= nearest) continue;
        nearest = distance;
        found = &near;
        normal = normal_of(truth::tangent_on(*near.element, foot.parameter));
    }
    if (!found) return false;
    const PreparedElement& e = *found->element;
    const PreparedProfile& profile = truth_.profiles[e.profile];
    hit.element = found->index;
    hit.facet = kWall;
    for (std::uint32_t i = 0; i + 1 < profile.points.size(); ++i) {
        const ProfilePoint a = profile.points[i], b = profile.points[i + 1];
        if (a.b != 0.0 || b.b != 0.0) continue;
        const double rise = (z_at(t) - e.level) / (e.height0 != 0.0 ? e.height0 : 1.0);
        if (rise >= std::min(a.h, b.h) - 1e-12 && rise <= std::max(a.h, b.h) + 1e-12) hit.facet = i;
    }
    set_normal(normal.x, normal.y, 0.0, hit);
    return true;
}

}  // namespace

RayHit Truth::trace_ray(const Ray& ray) const { return Tracer(*this, ray).trace(); }

}  // namespace burin
