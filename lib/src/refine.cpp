#include <burin/refine.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <burin/resolve.hpp>

#include "refine_curves.hpp"
#include "refine_ends.hpp"
#include "refine_forward.hpp"
#include "refine_parameters.hpp"
#include "refine_simplify.hpp"
#include "refine_solve.hpp"

namespace burin {
namespace refinement {
namespace {

constexpr double kLeastThreshold = 0.004;  // map scale: one step of an 8-bit map
constexpr double kLeastDeviation = 1e-5;    // map scale: rounding of a 16-bit map
constexpr double kThresholdInDeviations = 4.0;
constexpr double kFirstDamping = 1e-3;
constexpr double kMostDamping = 1e4;
constexpr double kSimplerMayCost = 1.05;     // of the misfit
constexpr double kRoughThreshold = 0.05;    // Huber's, before anything is fitted
constexpr double kTidyMayCost = 1.05;        // of the misfit, before ends are settled
constexpr int kSettleRounds = 4;
constexpr int kSplitRounds = 2;
constexpr double kSplitMustGain = 0.95;      // of the misfit
constexpr double kStrain = 0.02;             // texels, root mean square: an arc that is farther off is split
constexpr double kShortestSplit = 6.0;       // texels
constexpr double kTorn = 0.1;                // map scale
// A texel's model is as exact as this share of what it is off by, not more: doubt about a part of it is then cheap.
constexpr double kPrecision = 0.2;
constexpr double kFirstPrecision = 4e-3;     // map scale
constexpr double kLowerPrecision = 0.25;     // of the precision in use: what makes it worth to begin anew
constexpr double kMisfitPrecision = 0.02;   // of Huber's threshold
constexpr double kSettled = 1e-3;  // relative gain of a step below which the iteration ends

// The pattern in texels of the map's width, heights in map scale: white 1, black 0.
Pattern to_texels(const Pattern& pattern, double texel) {
    Pattern out = pattern;
    const double inverse = 1.0 / texel;
    const auto height = [&](double z) { return 1.0 + (z - pattern.base_offset) / pattern.depth; };
    out.size = pattern.size * inverse;
    out.depth = 1.0;
    out.base_offset = 1.0;
    out.outer_level = height(pattern.outer_level);
    for (Profile& profile : out.profiles)
        for (ProfilePoint& point : profile.points) point.b *= inverse, point.h /= pattern.depth;
    for (Path& path : out.paths) {
        path.level = height(path.level);
        for (Element& e : path.elements) e.p0 = e.p0 * inverse, e.p1 = e.p1 * inverse, e.p2 = e.p2 * inverse;
    }
    return out;
}

// Writes the refined paths and profiles back into the pattern in metres.
void from_texels(Pattern refined, double texel, Pattern& pattern) {
    const auto metres = [&](double value) { return pattern.base_offset + (value - 1.0) * pattern.depth; };
    pattern.outer_level = metres(refined.outer_level);
    pattern.profiles = std::move(refined.profiles);
    pattern.paths = std::move(refined.paths);
    for (Profile& profile : pattern.profiles)
        for (ProfilePoint& point : profile.points) point.b *= texel, point.h *= pattern.depth;
    for (Path& path : pattern.paths) {
        path.level = metres(path.level);
        for (Element& e : path.elements) e.p0 = e.p0 * texel, e.p1 = e.p1 * texel, e.p2 = e.p2 * texel;
    }
}

double root_mean_square(const std::vector<Residual>& residuals) {
    double sum = 0.0;
    for (const Residual& r : residuals) sum += double(r.value) * r.value;
    return residuals.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(residuals.size()));
}

// Standard deviation of the residuals on walls, where misplacement shows, or off them; outliers do not count.
double deviation_of(const std::vector<Residual>& residuals, bool on_walls = true) {
    std::vector<float> magnitudes;
    for (const Residual& r : residuals)
        if (r.steep() == on_walls) magnitudes.push_back(std::abs(r.value));
    if (magnitudes.empty()) return kLeastDeviation;
    const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
    std::nth_element(magnitudes.begin(), middle, magnitudes.end());
    return std::max(kLeastDeviation, 1.4826 * *middle);
}

// Huber's.
double threshold_of(double deviation) { return std::max(kLeastThreshold, kThresholdInDeviations * deviation); }


struct State {
    Pattern pattern;
    Parameters parameters;
    std::vector<ElementUnknowns> elements;
    Prediction prediction;
};

// What a step has to lower: the misfit, and the springs at the strength the misfit leaves them.
double cost_of(const State& state, double deviation) {
    double springs = 0.0;
    for (std::size_t i = 0; i < state.parameters.moved().size(); ++i)
        springs += state.parameters.stiffness()[i] * state.parameters.moved()[i] * state.parameters.moved()[i];
    return robust_cost(state.prediction.residuals, threshold_of(deviation)) + 0.5 * deviation * deviation * springs;
}

class Refinement {
  public:
    Refinement(const Image& map, Vec2 side, const RefineOptions& options)
        : map_(map), side_(side), options_(options) {}

    Status predict(State& state, double threshold, double precision) const {
        const Result<ResolvedPattern> resolved = resolve_pattern(state.pattern, resolve_options());
        if (!resolved) return resolved.error();
        state.elements = state.parameters.of_elements(state.pattern, *resolved);
        ForwardOptions forward;
        forward.robust = threshold;
        forward.precision = precision;
        forward.threads = options_.threads;
        state.prediction = Forward(*resolved, map_, side_).predict(state.elements, forward);
        return Done{};
    }

    // Damped Gauss-Newton steps from `start` until nothing is gained.
    Result<State> run(const Pattern& start, RefineReport& report) const {
        Pattern tied = start;
        Parameters parameters(tied, options_);
        State best{std::move(tied), std::move(parameters), {}, {}};
        double precision = kFirstPrecision;
        if (Status status = predict(best, 1e30, precision); !status) return status.error();
        if (report.iterations == 0) report.rms_before = root_mean_square(best.prediction.residuals);
        report.unknowns = best.parameters.count();
        double damping = kFirstDamping;
        bool refused = false;  // the last step
        for (int i = 0; i < options_.iterations && damping < kMostDamping && report.unknowns > 0; ++i) {
            double deviation = deviation_of(best.prediction.residuals);
            if (kPrecision * deviation < kLowerPrecision * precision) {
                precision = kPrecision * deviation;
                if (Status status = predict(best, threshold_of(deviation), precision); !status) return status.error();
                deviation = deviation_of(best.prediction.residuals);
            }
            NormalEquations equations(best.parameters.count(), best.elements, best.prediction);
            equations.add_springs(best.parameters.stiffness(), deviation * deviation, best.parameters.moved());
            State next{best.pattern, best.parameters, {}, {}};
            next.parameters.apply(equations.step(damping), options_.max_shift_texels, next.pattern);
            ++report.iterations;
            const bool resolves = predict(next, threshold_of(deviation), precision).ok();
            const double before = cost_of(best, deviation);
            const double after = resolves ? cost_of(next, deviation) : 1e300;
            if (after >= before) {
                damping = std::max(10.0 * damping, 1e-2);
                refused = true;
                continue;
            }
            best = std::move(next);
            // What was too little damping a step ago is so still: a refused step costs as much as one that is taken.
            if (!refused) damping = std::max(0.1 * damping, 1e-6);
            refused = false;
            if (before - after < kSettled * before) break;
        }
        return best;
    }

    // The pattern with ends where the map shows them; each stays that fits no better around where it moved.
    Pattern with_settled_ends(const Pattern& pattern) const {
        const Result<std::vector<Residual>> before = residuals(pattern);
        if (!before) return pattern;
        std::vector<std::uint8_t> held;
        for (int round = 0; round < kSettleRounds; ++round) {
            Pattern settled = pattern;
            const std::vector<MovedEnd> moved = settle_ends(settled, map_, side_, held);
            const Result<std::vector<Residual>> after = residuals(settled);
            if (moved.empty() || !after) return pattern;
            bool any_held = false;
            for (const MovedEnd& end : moved) {
                if (window_cost(*after, end.window) < window_cost(*before, end.window)) continue;
                if (held.size() <= end.end) held.resize(end.end + 1, 0);
                held[end.end] = 1;
                any_held = true;
            }
            const bool gains = robust_cost(*after, kRoughThreshold) < robust_cost(*before, kRoughThreshold);
            if (gains && (!any_held || round + 1 == kSettleRounds)) return settled;
        }
        return pattern;
    }

    double window_cost(const std::vector<Residual>& all, const Box& window) const {
        const auto index = [](double x, int count) { return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1); };
        std::vector<Residual> part;
        for (int y = index(window.low.y / side_.y, map_.height); y <= index(window.high.y / side_.y, map_.height); ++y)
            for (int x = index(window.low.x / side_.x, map_.width); x <= index(window.high.x / side_.x, map_.width); ++x)
                part.push_back(all[static_cast<std::size_t>(y) * map_.width + x]);
        return robust_cost(part, kRoughThreshold);
    }

    // The pattern with tails that go on as arcs, unless that fits worse.
    Pattern with_tidy_tails(const Pattern& pattern) const {
        Pattern tidy = pattern;
        if (!tidy_tails(tidy)) return pattern;
        const Result<double> before = misfit(pattern, kRoughThreshold), after = misfit(tidy, kRoughThreshold);
        return before && after && *after < kTidyMayCost * *before ? tidy : pattern;
    }

    // The pattern with curves for the polylines that go round, unless that fits worse.
    Pattern with_curves(const Pattern& pattern) const {
        Pattern curved = pattern;
        if (!curve_polylines(curved)) return pattern;
        const Result<double> before = misfit(pattern, kRoughThreshold), after = misfit(curved, kRoughThreshold);
        return before && after && *after < *before ? curved : pattern;
    }

    // Model minus map of every texel.
    Result<std::vector<Residual>> residuals(const Pattern& pattern, double threshold = kRoughThreshold) const {
        const Result<ResolvedPattern> resolved = resolve_pattern(pattern, resolve_options());
        if (!resolved) return resolved.error();
        ForwardOptions forward;
        forward.threads = options_.threads;
        forward.precision = kMisfitPrecision * threshold;
        const Image model = Forward(*resolved, map_, side_).image(forward);
        std::vector<Residual> out(model.texels.size());
        for (std::size_t k = 0; k < out.size(); ++k) out[k].value = model.texels[k] - map_.texels[k];
        return out;
    }

    // Robust misfit over the whole map: patterns whose features cover different texels compare fairly.
    Result<double> misfit(const Pattern& pattern, double threshold) const {
        const Result<std::vector<Residual>> all = residuals(pattern, threshold);
        if (!all) return all.error();
        return robust_cost(*all, threshold);
    }

  private:
    ResolveOptions resolve_options() const {
        ResolveOptions resolve;
        resolve.snap = options_.snap;
        resolve.lenient = true;  // what cannot be resolved stays where it is
        return resolve;
    }

    const Image& map_;
    const Vec2 side_;
    const RefineOptions& options_;
};

// What would be indexed or divided by blindly. The rest is for `resolve_pattern` to leave out.
std::optional<Error> damage_of(const Pattern& pattern) {
    for (std::size_t p = 0; p < pattern.paths.size(); ++p) {
        const Path& path = pattern.paths[p];
        const auto damage = [&](const char* what) {
            return Error{ErrorCode::invalid_input, "path " + std::to_string(p) + ": " + what};
        };
        if (path.profile >= pattern.profiles.size()) return damage("no profile has its profile's index");
        if (pattern.profiles[path.profile].points.size() < 2) return damage("its profile has fewer than 2 points");
        for (const Element& e : path.elements)
            for (const double x : {e.p0.x, e.p0.y, e.p1.x, e.p1.y, e.p2.x, e.p2.y, e.width0, e.width1})
                if (!std::isfinite(x)) return damage("a point or a scale is not finite");
    }
    return std::nullopt;
}

std::optional<Error> fault_of(const Pattern& pattern, const Image& map, const RefineOptions& options) {
    const auto fault = [](const std::string& message) { return Error{ErrorCode::invalid_argument, message}; };
    if (map.width < 1 || map.height < 1) return fault("the map to refine against is empty");
    if (!(pattern.size.x > 0.0 && pattern.size.y > 0.0 && pattern.depth > 0.0))
        return fault("pattern size and depth must be above 0");
    if (options.iterations < 0) return fault("iterations is " + std::to_string(options.iterations) + ", below 0");
    if (!(options.max_shift_texels > 0.0)) return fault("max_shift_texels must be above 0");
    if (!(options.snap >= 0.0 && options.snap <= 0.01)) return fault("snap must lie in [0, 0.01]");
    if (!(options.narrow_texels >= 0.0)) return fault("narrow_texels must not be negative");
    return damage_of(pattern);
}

// Quadratics that leave the map by more than its noise accounts for: too few for the arc they follow.
std::vector<ElementIndex> strained_quadratics(const State& state) {
    struct Sums {
        double squares = 0.0, slopes = 0.0, count = 0.0;
    };
    std::map<std::pair<int, int>, Sums> sums;
    for (const Residual& r : state.prediction.residuals) {
        if (!r.steep()) continue;
        const ElementUnknowns& element = state.elements[static_cast<std::size_t>(r.element)];
        if (element.path < 0) continue;
        Sums& sum = sums[{element.path, element.element}];
        // One torn texel does not make a strained arc.
        const double value = std::min(double(std::abs(r.value)), kTorn);
        sum.squares += value * value;
        sum.slopes += double(r.slope) * r.slope;
        sum.count += 1.0;
    }
    const double noise = deviation_of(state.prediction.residuals, false);
    std::vector<ElementIndex> strained;
    for (const auto& [index, sum] : sums) {
        const Element& e = state.pattern.paths[index.first].elements[index.second];
        if (e.kind != ElementKind::quadratic || length(e.p2 - e.p0) < kShortestSplit || sum.count < 10.0) continue;
        const double off = std::sqrt(sum.squares / sum.slopes);
        if (off > std::max(kStrain, 3.0 * noise * std::sqrt(sum.count / sum.slopes)))
            strained.push_back({index.first, index.second});
    }
    return strained;
}

// Refines `candidate` and puts it in the place of `best` when its misfit is at most `share` of the best one's.
bool keep_better(const Refinement& refinement, const Pattern& candidate, double share, State& best,
                 RefineReport& report) {
    RefineReport trial = report;
    Result<State> state = refinement.run(candidate, trial);
    if (!state) return false;
    const double threshold = threshold_of(deviation_of(best.prediction.residuals));
    const Result<double> before = refinement.misfit(best.pattern, threshold);
    const Result<double> after = refinement.misfit(state->pattern, threshold);
    if (!before || !after || *after > share * *before) return false;
    report.iterations = trial.iterations;
    report.unknowns = trial.unknowns;
    best = std::move(*state);
    return true;
}

// First with the profiles as they came, symmetric ones made so; then, where it costs little, with fewer points: a
// section measured through the blur of the texels has rounded corners, which the first stage has straightened.
Result<State> refine_in_stages(const Refinement& refinement, const Pattern& start, const RefineOptions& options,
                               RefineReport& report) {
    Pattern first = start;
    if (options.profiles) make_symmetric(first);
    if (options.elements) first = refinement.with_tidy_tails(refinement.with_curves(first));
    if (options.ends) first = refinement.with_settled_ends(first);
    Result<State> best = refinement.run(first, report);
    if (!best) return best;
    Pattern simpler = best->pattern;
    if (options.profiles && simplify_profiles(simpler)) keep_better(refinement, simpler, kSimplerMayCost, *best, report);
    for (int round = 0; round < kSplitRounds && options.positions && options.elements; ++round) {
        const std::vector<ElementIndex> strained = strained_quadratics(*best);
        if (strained.empty()) break;
        Pattern split = best->pattern;
        split_quadratics(split, strained);
        if (!keep_better(refinement, split, kSplitMustGain, *best, report)) break;
    }
    return best;
}

}  // namespace
}  // namespace refinement

Result<RefineReport> refine_pattern(Pattern& pattern, const Image& map, const RefineOptions& options) {
    using namespace refinement;
    if (const std::optional<Error> fault = fault_of(pattern, map, options)) return *fault;
    const double texel = pattern.size.x / map.width;
    const Vec2 side{1.0, pattern.size.y / map.height / texel};
    const Pattern start = to_texels(pattern, texel);
    const Refinement refinement(map, side, options);
    RefineReport report;
    Result<State> best = refine_in_stages(refinement, start, options, report);
    if (!best) return best.error();
    report.rms_after = root_mean_square(best->prediction.residuals);
    report.largest_shift_texels = best->parameters.largest_shift();
    const double threshold = threshold_of(deviation_of(best->prediction.residuals));
    const Result<double> before = refinement.misfit(start, threshold);
    const Result<double> after = refinement.misfit(best->pattern, threshold);
    if (before && after && *after < *before) from_texels(best->pattern, texel, pattern);
    return report;
}

}  // namespace burin
