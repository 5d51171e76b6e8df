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
#include "refine_hold.hpp"
#include "refine_parameters.hpp"
#include "refine_sampling.hpp"
#include "refine_sections.hpp"
#include "refine_simplify.hpp"
#include "refine_solve.hpp"
#include "refine_units.hpp"

namespace burin {
namespace refinement {
namespace {

constexpr double kLeastThreshold = 0.004;  // map scale: one step of an 8-bit map
constexpr double kLeastDeviation = 1e-5;    // map scale: rounding of a 16-bit map
constexpr double kThresholdInDeviations = 4.0;
constexpr double kFirstDamping = 1e-3;
constexpr double kRoughDamping = 1e-2;       // of a map that is not clean, fitted before: less is refused more often
constexpr double kSlower = 0.3;              // damping below it hardly shortens a step
constexpr double kSimplerMayCost = 1.05;     // of the misfit
constexpr double kStraighterMayDiffer[] = {0.1, 0.03, 0.01};  // of a profile's relief, root mean square
constexpr double kSurelyDamage = 2.0, kNearDamage = 16.0;  // of the misfit that the map's damage alone makes
constexpr double kDamageMayCost = 1.6;                    // of a misfit near that
constexpr double kCoarsest = 1.0 / 255.0;   // map scale: rounding of maps that have few values
constexpr double kRoughThreshold = 0.05;    // Huber's, before anything is fitted
constexpr double kTidyMayCost = 1.05;        // of the misfit, before ends are settled
constexpr int kSettleRounds = 4;
constexpr int kSplitRounds = 2;
constexpr double kSplitMustGain = 0.3;       // of the misfit around a quadratic
constexpr double kStrain = 0.012;            // texels, root mean square: an arc that is farther off is split
constexpr double kStrainInDeviations = 1.6;  // of what the map's noise alone makes of it
constexpr double kShortestSplit = 6.0;       // texels
constexpr double kTorn = 0.1;                // map scale
// A texel's model is as exact as this share of what it is off by, not more: doubt about a part of it is then cheap.
constexpr double kPrecision = 0.5;
constexpr double kClean = 2e-3;  // map scale: a map that is farther off its model does not tell it from the exact one
constexpr double kSettled = 1e-3;  // as Model::settled, of a clean map
// Steps are so many that they look at this number of texels, but some at least: large maps tell in fewer.
constexpr std::size_t kMostLooks = 800000;
constexpr int kFewestSteps = 3;
constexpr int kFewestLater = 2;     // of what was fitted before
constexpr int kMostRefused = 8;    // steps in a row
constexpr int kHoldRounds = 6;    // in the first half, what crosses stays near the crossing alone

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

// What the steps that a map's heights come in are off by, root mean square.
double rounding_of(const Image& map) {
    constexpr std::size_t kLooks = 1 << 16;
    std::vector<float> heights;
    for (std::size_t i = 0; i < map.texels.size(); i += map.texels.size() / kLooks + 1) heights.push_back(map.texels[i]);
    std::sort(heights.begin(), heights.end());
    double finest = kCoarsest;
    for (std::size_t i = 1; i < heights.size(); ++i)
        if (const double gap = double(heights[i]) - heights[i - 1]; gap > 1e-6) finest = std::min(finest, gap);
    return finest / std::sqrt(12.0);
}

// Huber's.
double threshold_of(double deviation) { return std::max(kLeastThreshold, kThresholdInDeviations * deviation); }

// How a pattern is compared with the map. What is rough is only so within a texel of where features meet, but many times
// faster.
struct Model {
    bool sparse = false;     // half of the texels where the map bends
    int divisions = kWhole;  // see ForwardOptions
    double precision = 0.0;  // map scale
    int steps = 0;           // most of them
    double settled = 0.0;    // the iteration ends when a step gains less than this share of the cost
};
constexpr Model kRough{true, kWhole, 0.0, 12, 3e-3};
constexpr Model kClose{false, 2, 0.05, 6, 2e-3};
// Off by not more than a share of what the map is off by.
Model exact_model(double deviation) { return {false, kFineDivisions, kPrecision * deviation, 12, 1e-3}; }

struct State {
    Pattern pattern;
    Parameters parameters;
    std::vector<ElementUnknowns> elements;
    Prediction prediction;
    std::vector<double> damping;         // by unknown
    std::vector<std::uint8_t> resolves;  // by path: whether anything is left of it once it is resolved
};

// A pattern and how the rough model sees it.
struct Seen {
    Pattern pattern;
    Prediction prediction;
};

// Over the whole map: patterns whose features cover different texels compare fairly.
double misfit(const Prediction& prediction, double threshold) {
    return robust_cost(prediction.residuals, threshold) + robust_cost(prediction.far, threshold);
}

// What a step has to lower: the misfit, and the springs at the strength the misfit leaves them.
double cost_of(const State& state, double deviation) {
    double springs = 0.0;
    for (std::size_t i = 0; i < state.parameters.moved().size(); ++i)
        springs += state.parameters.stiffness()[i] * state.parameters.moved()[i] * state.parameters.moved()[i];
    return misfit(state.prediction, threshold_of(deviation)) + 0.5 * deviation * deviation * springs;
}

class Refinement {
  public:
    Refinement(const Image& map, Vec2 side, const RefineOptions& options)
        : map_(map), side_(side), options_(options), sparse_(sample_map(map, true)), dense_(sample_map(map, false)),
          damage_(std::max(options.damage, rounding_of(map))) {}

    double damage() const { return damage_; }

    // How much less the second prediction is off at each texel.
    std::vector<float> gains_of(const Prediction& before, const Prediction& after, double threshold) const {
        std::vector<float> gains(map_.texels.size(), 0.0f);
        const auto add = [&](const std::vector<Residual>& residuals, double sign) {
            for (const Residual& r : residuals) gains[r.texel] += static_cast<float>(sign * robust_cost(r, threshold));
        };
        add(before.residuals, 1.0), add(before.far, 1.0);
        add(after.residuals, -1.0), add(after.far, -1.0);
        return gains;
    }

    // The model's map alone.
    Result<Prediction> look(const Pattern& pattern, const Model& model) const {
        const Result<ResolvedPattern> resolved = resolve_pattern(pattern, resolve_options());
        if (!resolved) return resolved.error();
        ForwardOptions forward = forward_options(model);
        forward.equations = false;
        return Forward(*resolved, map_, side_, sampling(model), options_.threads).predict({}, forward);
    }

    // Damped Gauss-Newton steps from `start` until nothing is gained.
    Result<State> run(const Pattern& start, const Model& model, RefineReport& report) const {
        Result<State> best = begin(start, model);
        if (!best) return best;
        const bool clean = deviation_of(best->prediction.residuals) <= kClean;
        const double settled = clean ? std::min(kSettled, model.settled) : model.settled;
        if (!clean && report.iterations > 0) std::fill(best->damping.begin(), best->damping.end(), kRoughDamping);
        report.unknowns = best->parameters.count();
        const std::size_t looks = std::max<std::size_t>(1, best->prediction.residuals.size());
        const int fewest = report.iterations > 0 ? kFewestLater : kFewestSteps;
        const int affordable = std::max(fewest, static_cast<int>(kMostLooks / looks));
        const int most = report.unknowns > 0 ? std::min({model.steps, options_.iterations, affordable}) : 0;
        int refused = 0;  // steps in a row
        for (int i = 0; i < most && refused < kMostRefused; ++i) {
            const double gain = advance(*best, model, refused > 0, affordable > 2 * kFewestSteps ? 2 : 1);
            ++report.iterations;
            refused = gain > 0.0 ? 0 : refused + 1;
            if (gain > 0.0 && gain < settled) break;
        }
        return best;
    }

    // The pattern with ends where the map shows them; each stays that fits no better around where it moved.
    Seen with_settled_ends(Seen before) const {
        std::vector<std::uint8_t> held;
        for (int round = 0; round < kSettleRounds; ++round) {
            Pattern settled = before.pattern;
            const std::vector<MovedEnd> moved = settle_ends(settled, map_, side_, held);
            if (moved.empty()) return before;
            Result<Prediction> after = look(settled, kRough);
            if (!after) return before;
            const std::vector<float> gains = gains_of(before.prediction, *after, kRoughThreshold);
            bool any_held = false;
            for (const MovedEnd& end : moved) {
                if (sum_within(gains, end.window) > 0.0) continue;
                if (held.size() <= end.end) held.resize(end.end + 1, 0);
                held[end.end] = 1;
                any_held = true;
            }
            const bool better = misfit(*after, kRoughThreshold) < misfit(before.prediction, kRoughThreshold);
            if (better && (!any_held || round + 1 == kSettleRounds)) return {std::move(settled), std::move(*after)};
        }
        return before;
    }

    // The pattern with tails that go on as arcs, unless that fits worse.
    Seen with_tidy_tails(Seen before) const {
        Pattern tidy = before.pattern;
        return tidy_tails(tidy) ? better_of(std::move(before), std::move(tidy), kTidyMayCost) : before;
    }

    // The pattern with curves for the polylines that go round, unless that fits worse.
    Seen with_curves(Seen before) const {
        Pattern curved = before.pattern;
        return curve_polylines(curved) ? better_of(std::move(before), std::move(curved), 1.0) : before;
    }

  private:
    // The model's map and its equations, at a state's pattern.
    void predict(State& state, const ResolvedPattern& resolved, const Model& model, double threshold) const {
        state.elements = state.parameters.of_elements(state.pattern, resolved);
        ForwardOptions forward = forward_options(model);
        forward.robust = threshold;
        state.prediction = Forward(resolved, map_, side_, sampling(model), options_.threads).predict(state.elements, forward);
        state.resolves = resolving_paths(state.pattern, resolved);
    }

    Result<State> begin(const Pattern& start, const Model& model) const {
        Pattern tied = start;
        Parameters parameters(tied, options_);
        std::vector<double> damping(parameters.count(), kFirstDamping);
        State state{std::move(tied), std::move(parameters), {}, {}, std::move(damping), {}};
        const Result<ResolvedPattern> resolved = resolve_pattern(state.pattern, resolve_options());
        if (!resolved) return resolved.error();
        predict(state, *resolved, model, 1e30);
        return state;
    }

    // One step. Returns the share of the cost that it gained, not above 0 when it was refused.
    double advance(State& best, const Model& model, bool refused_before, int attempts) const {
        const double deviation = deviation_of(best.prediction.residuals);
        NormalEquations equations(best.parameters.count(), best.elements, best.prediction);
        equations.add_springs(best.parameters.stiffness(), deviation * deviation, best.parameters.moved());
        const double before = cost_of(best, deviation);
        std::vector<std::uint8_t> resting(best.damping.size(), 0);
        std::vector<double> adapted = best.damping;
        double gain = 0.0;
        // Where the model leaps does not keep all the rest from moving.
        for (int attempt = 0; attempt < attempts && gain <= 0.0; ++attempt) {
            State next{best.pattern, best.parameters, {}, {}, best.damping, {}};
            const Result<ResolvedPattern> resolved = take_step(best, equations, resting, next);
            if (!resolved) return 0.0;
            predict(next, *resolved, model, threshold_of(deviation));
            gain = before > 0.0 ? (before - cost_of(next, deviation)) / before : 0.0;
            if (attempt == 0) {
                resting = adapt_damping(best, next, threshold_of(deviation), refused_before, gain > 0.0);
                adapted = next.damping;
            }
            if (gain > 0.0) best = std::move(next);
        }
        best.damping = std::move(adapted);
        return gain;
    }

    // Unknowns that made their texels worse are damped more, the others less. Returns 1 for the former.
    std::vector<std::uint8_t> adapt_damping(const State& from, State& next, double threshold, bool refused_before,
                                            bool accepted) const {
        const std::vector<float> gains = gains_of(from.prediction, next.prediction, threshold);
        std::vector<double> of_elements(from.elements.size(), 0.0), of_unknowns(next.damping.size(), 0.0);
        for (const Residual& r : from.prediction.residuals)
            if (r.element >= 0) of_elements[r.element] += gains[r.texel];
        for (std::size_t e = 0; e < of_elements.size(); ++e)
            for (const int unknown : from.elements[e].unknowns) of_unknowns[unknown] += of_elements[e];
        std::vector<std::uint8_t> worse(of_unknowns.size(), 0);
        for (std::size_t i = 0; i < of_unknowns.size(); ++i) {
            double& damping = next.damping[i];
            worse[i] = of_unknowns[i] < 0.0;
            // Refused twice: what leaps may lie where no texel is an element's own, so that all of it goes slower.
            if (worse[i] || (!accepted && refused_before)) damping = std::max(10.0 * damping, kSlower);
            // What was too little damping a step ago is so still.
            if (!worse[i] && accepted && !refused_before) damping = std::max(0.1 * damping, 1e-6);
        }
        return worse;
    }

    // Moves `next` on from `from`, all but what rests. Where paths would then resolve no more, since step paths cross, they
    // stay as they are from now on: shorter steps of everything else would not help them.
    Result<ResolvedPattern> take_step(State& from, const NormalEquations& equations, std::vector<std::uint8_t> resting,
                                      State& next) const {
        for (int round = 0;; ++round) {
            next.pattern = from.pattern;
            next.parameters = from.parameters;
            for (std::size_t i = 0; i < resting.size(); ++i) resting[i] |= from.parameters.held()[i];
            next.parameters.apply(equations.step(from.damping, resting), options_.max_shift_texels, next.pattern);
            Result<ResolvedPattern> resolved = resolve_pattern(next.pattern, resolve_options());
            if (!resolved) return resolved;
            const std::vector<std::size_t> lost = lost_paths(from.resolves, resolving_paths(next.pattern, *resolved));
            if (lost.empty()) return resolved;
            if (round == kHoldRounds) return Error{ErrorCode::invalid_input, "a step loses paths"};
            if (round < kHoldRounds / 2 && !resolved->stats.crossings.empty())
                hold_crossings(resolved->stats.crossings, next.pattern, from.parameters);
            else
                hold_paths(lost, from.elements, from.parameters);
        }
    }

    // The other pattern when its misfit is below a share of the first one's.
    Seen better_of(Seen first, Pattern other, double share) const {
        Result<Prediction> after = look(other, kRough);
        if (!after || misfit(*after, kRoughThreshold) >= share * misfit(first.prediction, kRoughThreshold)) return first;
        return {std::move(other), std::move(*after)};
    }

    double sum_within(const std::vector<float>& values, const Box& window) const {
        const auto index = [](double x, int count) { return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1); };
        double sum = 0.0;
        for (int y = index(window.low.y / side_.y, map_.height); y <= index(window.high.y / side_.y, map_.height); ++y)
            for (int x = index(window.low.x / side_.x, map_.width); x <= index(window.high.x / side_.x, map_.width); ++x)
                sum += values[static_cast<std::size_t>(y) * map_.width + x];
        return sum;
    }

    ResolveOptions resolve_options() const {
        ResolveOptions resolve;
        resolve.snap = options_.snap;
        resolve.lenient = true;  // what cannot be resolved stays where it is
        return resolve;
    }

    ForwardOptions forward_options(const Model& model) const {
        ForwardOptions forward;
        forward.divisions = model.divisions;
        forward.precision = model.precision;
        forward.threads = options_.threads;
        return forward;
    }

    const Sampling& sampling(const Model& model) const { return model.sparse ? sparse_ : dense_; }

    const Image& map_;
    const Vec2 side_;
    const RefineOptions& options_;
    const Sampling sparse_, dense_;
    const double damage_;  // map scale
};

// What would be indexed or divided by blindly. The rest is for `resolve_pattern` to leave out.
std::optional<Error> fault_of_paths(const Pattern& pattern) {
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
    if (options.most_splits < 0) return fault("most_splits is " + std::to_string(options.most_splits) + ", below 0");
    if (options.iterations < 0) return fault("iterations is " + std::to_string(options.iterations) + ", below 0");
    if (!(options.max_shift_texels > 0.0)) return fault("max_shift_texels must be above 0");
    if (!(options.snap >= 0.0 && options.snap <= 0.01)) return fault("snap must lie in [0, 0.01]");
    if (!(options.narrow_texels >= 0.0)) return fault("narrow_texels must not be negative");
    if (!(options.damage >= 0.0)) return fault("damage must not be negative");
    return fault_of_paths(pattern);
}

// Calls visit(residual, element) for the residuals on walls of paths: there misplacement shows.
template <typename Visit>
void for_each_on_walls(const State& state, const Visit& visit) {
    for (const Residual& r : state.prediction.residuals) {
        if (!r.steep()) continue;
        const ElementUnknowns& element = state.elements[static_cast<std::size_t>(r.element)];
        if (element.path >= 0) visit(r, element);
    }
}

// Quadratics that leave the map by more than its noise accounts for: too few for the arc they follow. At most so many,
// those that are off by most.
std::vector<ElementIndex> strained_quadratics(const State& state, int most) {
    struct Sums {
        double squares = 0.0, slopes = 0.0, count = 0.0;
    };
    std::map<std::pair<int, int>, Sums> sums;
    for_each_on_walls(state, [&](const Residual& r, const ElementUnknowns& element) {
        Sums& sum = sums[{element.path, element.element}];
        // One torn texel does not make a strained arc.
        const double value = std::min(double(std::abs(r.value)), kTorn);
        sum.squares += r.weight * value * value;
        sum.slopes += r.weight * double(r.slope) * r.slope;
        sum.count += r.weight;
    });
    const double noise = deviation_of(state.prediction.residuals, false);
    std::vector<std::pair<double, ElementIndex>> strained;
    for (const auto& [index, sum] : sums) {
        const Element& e = state.pattern.paths[index.first].elements[index.second];
        if (e.kind != ElementKind::quadratic || length(e.p2 - e.p0) < kShortestSplit || sum.count < 10.0) continue;
        const double off = std::sqrt(sum.squares / sum.slopes);
        if (off > std::max(kStrain, kStrainInDeviations * noise * std::sqrt(sum.count / sum.slopes)))
            strained.push_back({sum.squares, {index.first, index.second}});
    }
    std::stable_sort(strained.begin(), strained.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    strained.resize(std::min(strained.size(), static_cast<std::size_t>(most)));
    std::vector<ElementIndex> worst;
    for (const auto& [squares, index] : strained) worst.push_back(index);
    return worst;
}

// Whether a path that is left in the first state is none in the second. A robust misfit hardly sees that.
bool loses_paths(const State& before, const State& after) { return !lost_paths(before.resolves, after.resolves).empty(); }

// Refines `candidate` and puts it in the place of `best` when its misfit is at most `share` of the best one's.
bool keep_better(const Refinement& refinement, const Model& model, const Pattern& candidate, double share, State& best,
                 RefineReport& report) {
    RefineReport trial = report;
    Result<State> state = refinement.run(candidate, model, trial);
    if (!state || loses_paths(best, *state)) return false;
    const double threshold = threshold_of(deviation_of(best.prediction.residuals));
    if (misfit(state->prediction, threshold) > share * misfit(best.prediction, threshold)) return false;
    report = trial;
    best = std::move(*state);
    return true;
}

// With fewer points where that costs little: a section measured through the blur of the texels has rounded corners, which
// the fit before has straightened.
void keep_simpler(const Refinement& refinement, const Model& model, State& best, RefineReport& report) {
    Pattern simpler = best.pattern;
    if (simplify_profiles(simpler)) keep_better(refinement, model, simpler, kSimplerMayCost, best, report);
}

// What the paths of a profile are off by around them.
struct ProfileMisfit {
    double cost = 0.0;
    double damage = 0.0;  // what the map's own damage alone would cost

    // Whether a plainer profile may cost as much: what follows the damage is no part of the surface.
    bool allows(double other) const {
        const bool is_damage = cost < kNearDamage * damage;
        return other <= std::max((is_damage ? kDamageMayCost : kSimplerMayCost) * cost, kSurelyDamage * damage);
    }
};

std::vector<ProfileMisfit> misfit_by_profile(const State& state, double threshold, double damage) {
    std::vector<ProfileMisfit> misfits(state.pattern.profiles.size());
    for_each_on_walls(state, [&](const Residual& r, const ElementUnknowns& element) {
        ProfileMisfit& misfit = misfits[state.pattern.paths[static_cast<std::size_t>(element.path)].profile];
        misfit.cost += robust_cost(r, threshold);
        misfit.damage += 0.5 * r.weight * damage * damage;
    });
    return misfits;
}

// With straighter profiles, each as much so as the map hardly shows the difference.
void keep_straighter(const Refinement& refinement, const Model& model, State& best, RefineReport& report) {
    const double threshold = threshold_of(deviation_of(best.prediction.residuals));
    const std::vector<ProfileMisfit> before = misfit_by_profile(best, threshold, refinement.damage());
    std::vector<std::uint8_t> settled(before.size(), 0);
    Pattern mixed = best.pattern;
    for (const double share : kStraighterMayDiffer) {
        Pattern straighter = mixed;
        if (!straighten_sections(straighter, share, settled)) continue;
        Result<State> trial = refinement.run(straighter, model, report);
        if (!trial || loses_paths(best, *trial)) continue;
        const std::vector<ProfileMisfit> after = misfit_by_profile(*trial, threshold, refinement.damage());
        for (std::size_t i = 0; i < before.size(); ++i) settled[i] = before[i].allows(after[i].cost);
        mixed = with_sections(trial->pattern, best.pattern, settled);
        if (std::find(settled.begin(), settled.end(), 0) == settled.end()) break;
    }
    if (std::find(settled.begin(), settled.end(), 1) != settled.end())
        keep_better(refinement, model, mixed, kDamageMayCost, best, report);
}

// Of the quadratics, those around which the second state is off by enough less.
std::vector<ElementIndex> gaining(const std::vector<ElementIndex>& quadratics, const State& before, const Prediction& after,
                                  const Refinement& refinement) {
    const double threshold = threshold_of(deviation_of(before.prediction.residuals));
    const std::vector<float> gains = refinement.gains_of(before.prediction, after, threshold);
    std::map<std::pair<int, int>, std::pair<double, double>> sums;  // gain and cost
    for (const ElementIndex& index : quadratics) sums[{index.path, index.element}] = {0.0, 0.0};
    for_each_on_walls(before, [&](const Residual& r, const ElementUnknowns& element) {
        const auto at = sums.find({element.path, element.element});
        if (at != sums.end()) at->second.first += gains[r.texel], at->second.second += robust_cost(r, threshold);
    });
    std::vector<ElementIndex> out;
    for (const ElementIndex& index : quadratics)
        if (const auto& [gain, cost] = sums[{index.path, index.element}]; gain > kSplitMustGain * cost) out.push_back(index);
    return out;
}

// Splits the quadratics for which that pays, and tells how many.
std::size_t keep_split(const Refinement& refinement, const Model& model, const std::vector<ElementIndex>& quadratics, State& best,
                       RefineReport& report) {
    Pattern split = best.pattern;
    split_quadratics(split, quadratics);
    Result<State> trial = refinement.run(split, model, report);
    if (!trial || loses_paths(best, *trial)) return 0;
    const std::vector<ElementIndex> paying = gaining(quadratics, best, trial->prediction, refinement);
    if (paying.size() == quadratics.size()) {
        best = std::move(*trial);
        return paying.size();
    }
    split = best.pattern;
    split_quadratics(split, paying);
    return !paying.empty() && keep_better(refinement, model, split, 1.0, best, report) ? paying.size() : 0;
}

// First with the profiles as they came, symmetric ones made so; then simpler ones, and more elements where they are too few.
Result<State> refine_roughly(const Refinement& refinement, const Pattern& start, const RefineOptions& options,
                             RefineReport& report) {
    Pattern first = start;
    if (options.profiles) make_symmetric(first);
    Result<Prediction> prediction = refinement.look(first, kRough);
    if (!prediction) return prediction.error();
    Seen seen{std::move(first), std::move(*prediction)};
    if (options.elements) seen = refinement.with_tidy_tails(refinement.with_curves(std::move(seen)));
    if (options.ends) seen = refinement.with_settled_ends(std::move(seen));
    Result<State> best = refinement.run(seen.pattern, kRough, report);
    if (!best) return best;
    if (options.profiles) {
        keep_simpler(refinement, kRough, *best, report);
        keep_straighter(refinement, kRough, *best, report);
    }
    int splits = options.most_splits;
    for (int round = 0; round < kSplitRounds && options.positions && options.elements; ++round) {
        const std::vector<ElementIndex> strained = strained_quadratics(*best, splits);
        const std::size_t kept = strained.empty() ? 0 : keep_split(refinement, kRough, strained, *best, report);
        if (kept == 0) break;
        splits -= static_cast<int>(kept);
    }
    return best;
}

// Then closely, and exactly where the map is clean enough. `model`: the one that judged last.
Result<State> refine_finely(const Refinement& refinement, const Pattern& rough, const RefineOptions& options,
                            RefineReport& report, Model& model) {
    model = kClose;
    Result<State> close = refinement.run(rough, model, report);
    if (!close) return close;
    if (deviation_of(close->prediction.residuals) > kClean) return close;
    if (options.profiles) keep_simpler(refinement, model, *close, report);
    model = exact_model(deviation_of(close->prediction.residuals));
    Result<State> exact = refinement.run(close->pattern, model, report);
    if (exact && options.profiles) keep_simpler(refinement, model, *exact, report);
    return exact;
}

}  // namespace
}  // namespace refinement

Result<RefineReport> refine_pattern(Pattern& pattern, const Image& map, const RefineOptions& options) {
    using namespace refinement;
    if (const std::optional<Error> fault = fault_of(pattern, map, options)) return *fault;
    for (const Path& path : pattern.paths)
        if (path.perturbation != kNoPerturbation) return RefineReport{};
    const double texel = pattern.size.x / map.width;
    const Vec2 side{1.0, pattern.size.y / map.height / texel};
    const Pattern start = to_texels(pattern, texel);
    const Refinement refinement(map, side, options);
    RefineReport report;
    const Result<State> rough = refine_roughly(refinement, start, options, report);
    if (!rough) return rough.error();
    Model model;
    const Result<State> best = refine_finely(refinement, rough->pattern, options, report, model);
    if (!best) return best.error();
    const Result<Prediction> before = refinement.look(start, model);
    if (!before) return before.error();
    report.rms_before = root_mean_square(before->residuals);
    report.rms_after = root_mean_square(best->prediction.residuals);
    report.largest_shift_texels = best->parameters.largest_shift();
    const double threshold = threshold_of(deviation_of(best->prediction.residuals));
    if (misfit(best->prediction, threshold) < misfit(*before, threshold)) from_texels(best->pattern, texel, pattern);
    return report;
}

}  // namespace burin
