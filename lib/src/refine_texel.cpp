#include "refine_texel.hpp"

#include <algorithm>
#include <cmath>

namespace burin::refinement {
namespace {

constexpr double kStraight = 0.004;  // curvature per texel below which an arc is integrated like a line
constexpr double kBent = 0.05;       // above this an arc's texel is divided twice, below once
constexpr int kProbes = 4;           // per side: whether a texel needs more cells

double scale_at(double start, double end, double along) { return start + (end - start) * along; }

Spread spread_of(const Placement& placement, Vec2 cell, double width) {
    return {std::max(1e-9, std::abs(placement.gradient.x) * cell.x / width),
            std::max(1e-9, std::abs(placement.gradient.y) * cell.y / width)};
}

void start_using(Candidate& candidate) {
    if (candidate.used) return;
    candidate.used = true;
    std::fill_n(candidate.local.begin(), local_count(*candidate.feature), 0.0);
}

struct Range {
    double low = 0.0, high = 0.0;
};

Range product(Range a, Range b) {
    const auto [low, high] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
    return {low, high};
}

// A scale between the curve parameters that a square within `radius` of the foot may have.
Range scales_near(const Feature& feature, const Foot& foot, double radius, double start, double end) {
    const bool line = feature.frame.kind == ElementKind::line;
    const double from = line ? std::clamp(foot.parameter - radius / feature.frame.size, 0.0, 1.0) : 0.0;
    const double to = line ? std::clamp(foot.parameter + radius / feature.frame.size, 0.0, 1.0) : 1.0;
    const auto [low, high] = std::minmax({scale_at(start, end, from), scale_at(start, end, to)});
    return {low, high};
}

struct ProfileRange {
    Range height;
    bool any_internal = false, all_internal = true;
    // The chord from the first offset to the last, and the most that the profile leaves it by.
    double start = 0.0, slope = 0.0, bulge = 0.0;
};

// Of the profile between two offsets; its ends go on level.
ProfileRange range_of(const SweptProfile& profile, Range b) {
    const std::size_t count = profile.b.size();
    const auto height_at = [&](double at, std::size_t facet) {
        const double share = (at - profile.b[facet]) / (profile.b[facet + 1] - profile.b[facet]);
        return profile.h[facet] + (profile.h[facet + 1] - profile.h[facet]) * share;
    };
    std::size_t first = 0;
    while (first + 2 < count && profile.b[first + 1] < b.low) ++first;
    std::size_t last = first;
    while (last + 2 < count && profile.b[last + 1] <= b.high) ++last;
    ProfileRange out;
    out.start = b.low <= profile.left() ? profile.h.front() : b.low >= profile.right() ? profile.h.back() : height_at(b.low, first);
    const double end = b.high >= profile.right() ? profile.h.back() : b.high <= profile.left() ? profile.h.front() : height_at(b.high, last);
    out.slope = (end - out.start) / (b.high - b.low);
    out.height = {std::min(out.start, end), std::max(out.start, end)};
    for (std::size_t i = first; i <= last + 1; ++i) {
        if (profile.b[i] <= b.low || profile.b[i] >= b.high) continue;
        out.height = {std::min(out.height.low, profile.h[i]), std::max(out.height.high, profile.h[i])};
        out.bulge = std::max(out.bulge, std::abs(profile.h[i] - out.start - out.slope * (profile.b[i] - b.low)));
    }
    for (std::size_t i = first; i <= last; ++i) {
        if (b.high < profile.b[i] || b.low > profile.b[i + 1]) continue;
        const bool internal = (profile.internal_mask >> i) & 1u;
        out.any_internal |= internal;
        out.all_internal &= internal;
    }
    return out;
}

bool same_level(double a, double b) { return std::abs(a - b) <= kLevelTolerance; }

}  // namespace

TexelModel::TexelModel(const Layout& layout, const ForwardOptions& options, bool derivatives)
    : layout_(layout),
      divisions_(std::min(options.divisions, 1 << (kDepths - 1))),
      precision_(options.precision),
      derivatives_(derivatives) {}

bool TexelModel::gather(int x, int y) {
    const int column = x / kTile, row = y / kTile;
    const std::size_t tile = static_cast<std::size_t>(row) * layout_.tile_columns + static_cast<std::size_t>(column);
    if (tile != tile_) enter_tile(tile, column, row);
    count_ = 0;
    actors_[0].clear();
    steps_[0].clear();
    if (tile_list_.empty()) return false;
    texel_ = {layout_.centre(x, y), layout_.side, layout_.half_diagonal(), 1.0};
    if (candidates_.size() < tile_list_.size()) candidates_.resize(tile_list_.size());
    if (lone_) return gather_lone();
    near_step_ = false;
    ground_ = layout_.outer_level;
    if (!layout_.ground.empty()) {
        const float level = layout_.ground[static_cast<std::size_t>(y) * layout_.width + x];
        near_step_ = level == kNearStep;
        ground_ = level;
    }
    for (const Listed& listed : tile_list_) consider(listed, texel_);
    if (near_step_) {
        steps_[0] = *tile_steps_;
        if (divisions_ > kWhole) keep_nearest_steps(layout_, texel_.centre, texel_.half, steps_[0]);
    }
    return count_ > 0;
}

// The tile's one feature, where no other has a say.
bool TexelModel::gather_lone() {
    Actor actor = actor_of(tile_list_.front().instance);
    const Feature& feature = *actor.feature;
    actor.foot = foot_of(feature.frame, texel_.centre - actor.offset, tile_list_.front().guess);
    const double margin = texel_.half + kNearMargin;
    if (actor.foot.offset < feature.left - margin || actor.foot.offset > feature.right + margin) return false;
    actor.reach.possible = actor.reach.plain = true;
    actor.candidate = 0;
    candidates_[0].instance = actor.instance;
    candidates_[0].feature = &feature;
    candidates_[0].used = false;
    count_ = 1;
    actors_[0].push_back(actor);
    return true;
}

// What acts nowhere in the tile is left out; where the tile has one ground, so is what others leave no say.
void TexelModel::enter_tile(std::size_t tile, int column, int row) {
    tile_ = tile;
    const Vec2 side = layout_.side * double(kTile), centre{(column + 0.5) * side.x, (row + 0.5) * side.y};
    // Texels count as near a feature a little beyond it.
    const double radius = 0.5 * length(side) + kNearMargin;
    tile_actors_.clear();
    for (std::uint32_t k = layout_.first[tile]; k < layout_.first[tile + 1]; ++k) {
        Actor actor = actor_of(layout_.listed[k]);
        const Feature& feature = *actor.feature;
        const Vec2 p = centre - actor.offset;
        actor.foot = foot_of(feature.frame, p);
        actor.reach = reach_at(feature.frame, p, actor.foot, feature.left, feature.right, radius);
        if (!actor.reach.possible && is_tame(feature.frame, actor.foot, radius)) continue;
        actor.candidate = static_cast<int>(tile_actors_.size());
        tile_actors_.push_back(actor);
    }
    if (tile_actors_.size() > 1 && has_one_ground(tile, column, row)) {
        steps_[0].clear();
        for (Actor& actor : tile_actors_) bound(actor, radius);
        cull(tile_actors_, steps_[0], radius);
    }
    tile_list_.clear();
    for (const Actor& actor : tile_actors_)
        tile_list_.push_back({actor.instance, guess_near(actor.feature->frame, actor.foot, radius)});
    tile_steps_ = layout_.tile_has_step[tile] ? &layout_.tile_steps[tile] : nullptr;
    lone_ = tile_actors_.size() == 1 && rules_tile(tile_actors_.front(), tile, column, row, radius);
}

// Whether the actor plainly rules all of the tile, as most do that hold a path at all.
bool TexelModel::rules_tile(const Actor& actor, std::size_t tile, int column, int row, double radius) {
    if (!actor.reach.plain || !is_tame(actor.feature->frame, actor.foot, radius)) return false;
    if (actor.feature->step) return tile_steps_->size() == 1 && tile_steps_->front().instance == actor.instance;
    return has_one_ground(tile, column, row) && same_level(actor.feature->level_left, ground_);
}

// Takes the ground of a tile that no step comes near.
bool TexelModel::has_one_ground(std::size_t tile, int column, int row) {
    if (layout_.tile_has_step[tile]) return false;
    near_step_ = false;
    ground_ = layout_.outer_level;
    if (layout_.ground.empty()) return true;
    const TileSpan span = layout_.span(column, row);
    const float* const first = &layout_.ground[static_cast<std::size_t>(span.y0) * layout_.width + span.x0];
    ground_ = *first;
    for (int y = span.y0; y < span.y1; ++y)
        for (int x = span.x0; x < span.x1; ++x)
            if (layout_.ground[static_cast<std::size_t>(y) * layout_.width + x] != *first) return false;
    return true;
}

TexelModel::Actor TexelModel::actor_of(std::uint32_t index) const {
    Actor actor;
    actor.instance = index;
    actor.feature = &layout_.features[layout_.instances[index].element];
    actor.offset = layout_.instances[index].offset;
    return actor;
}

void TexelModel::consider(const Listed& listed, const Square& texel) {
    Actor actor = actor_of(listed.instance);
    const Feature& feature = *actor.feature;
    const Vec2 p = texel.centre - actor.offset;
    actor.foot = foot_of(feature.frame, p, listed.guess);
    actor.reach = reach_at(feature.frame, p, actor.foot, feature.left, feature.right, texel.half + kNearMargin);
    if (!actor.reach.possible) return;
    Candidate& c = candidates_[count_];
    c.instance = listed.instance;
    c.feature = &feature;
    c.used = false;
    actor.candidate = static_cast<int>(count_++);
    if (divisions_ == kWhole) return actors_[0].push_back(actor);
    if (!actor.reach.plain)
        actor.reach = reach_at(feature.frame, p, actor.foot, feature.left, feature.right, texel.half);
    if (!actor.reach.possible) return;
    bound(actor, texel.half);
    actors_[0].push_back(actor);
}

// Fills in what the feature may show within `radius` of its foot's point.
void TexelModel::bound(Actor& a, double radius) const {
    const Feature& f = *a.feature;
    const bool known = is_tame(f.frame, a.foot, radius) && std::min(f.frame.width0, f.frame.width1) > 1e-6;
    a.reach.plain = a.reach.plain && known;
    a.plane = known && !a.reach.shaped;
    const Range width = scales_near(f, a.foot, radius, f.frame.width0, f.frame.width1);
    const Range scale = scales_near(f, a.foot, radius, f.frame.height0, f.frame.height1);
    Range b{-1e300, 1e300};
    if (a.plane) b = product({a.foot.offset - radius, a.foot.offset + radius}, {1.0 / width.high, 1.0 / width.low});
    const ProfileRange profile = range_of(*f.profile, b);
    const Range height = product(profile.height, scale);
    a.low = f.level_left + height.low;
    a.high = f.level_left + height.high;
    a.left = !f.step || b.low <= 0.0;
    a.right = f.step && b.high > 0.0;
    a.within = b.low >= f.profile->left() && b.high <= f.profile->right();
    a.may_cut = profile.any_internal;
    a.must_cut = a.reach.plain && a.within && profile.any_internal && profile.all_internal;
    if (!a.plane) return;
    // The chord of the profile, swept with the scales of the middle.
    const double wide = 0.5 * (width.low + width.high), high = 0.5 * (scale.low + scale.high);
    const double steep = high * profile.slope / wide;
    a.middle = f.level_left + high * (profile.start + profile.slope * (a.foot.offset / wide - b.low));
    a.slope = normal_of(a.foot.tangent) * steep;
    a.slack = 0.5 * std::abs(a.foot.bend * steep) * radius * radius + high * profile.bulge +
              0.5 * (scale.high - scale.low) * std::max(std::abs(profile.height.low), std::abs(profile.height.high)) +
              std::abs(steep) * (std::abs(a.foot.offset) + radius) * 0.5 * (width.high - width.low) / width.low;
}

// Moves the actors and steps of the square above on to one of its quarters.
void TexelModel::descend(int depth, const Square& part) {
    std::vector<Actor>& actors = actors_[depth];
    actors.clear();
    for (const Actor& above : actors_[depth - 1]) {
        actors.push_back(above);
        Actor& a = actors.back();
        const Vec2 p = part.centre - a.offset;
        a.foot = foot_of(a.feature->frame, p, std::clamp(above.foot.parameter, 0.0, 1.0));
        a.reach = reach_at(a.feature->frame, p, a.foot, a.feature->left, a.feature->right, part.half);
        if (a.reach.possible)
            bound(a, part.half);
        else
            actors.pop_back();
    }
    steps_[depth] = steps_[depth - 1];
    keep_nearest_steps(layout_, part.centre, part.half, steps_[depth]);
}

TexelModel::Base TexelModel::base_of(const std::vector<Actor>& actors, const std::vector<StepLine>& steps) const {
    Base base;
    base.low = base.high = base.level = ground_;
    base.known = true;
    if (!near_step_ || steps.empty()) return base;
    base = {1e300, -1e300, steps.front().level, true, -1};
    for (const StepLine& step : steps) {
        const Feature& f = layout_.features[layout_.instances[step.instance].element];
        base.known = base.known && step.one_sided && same_level(step.level, base.level);
        base.low = std::min(base.low, step.one_sided ? step.level : std::min(f.level_left, f.level_right));
        base.high = std::max(base.high, step.one_sided ? step.level : std::max(f.level_left, f.level_right));
        for (std::size_t i = 0; i < actors.size(); ++i) {
            if (actors[i].instance != step.instance) continue;
            if (steps.size() == 1 && actors[i].reach.plain)
                return {actors[i].low, actors[i].high, step.level, step.one_sided, static_cast<int>(i)};
            base.low = std::min(base.low, actors[i].low);
            base.high = std::max(base.high, actors[i].high);
        }
    }
    return base;
}

// Whether the actor's height counts in all of the square.
bool TexelModel::rules(const Actor& actor, const Base& base) const {
    if (!actor.reach.plain || !base.known) return false;
    if (near_step_ && !actor.within) return false;
    return (!actor.left || same_level(actor.feature->level_left, base.level)) &&
           (!actor.right || same_level(actor.feature->level_right, base.level));
}

// The least height that stands, and the greatest that cuts leave, wherever in the square; and whose they are.
TexelModel::Limits TexelModel::limits_of(const std::vector<Actor>& actors, const Base& base) const {
    Limits limits;
    limits.floor = base.low;
    limits.upper = base.high;
    for (const Actor& a : actors) limits.upper = std::max(limits.upper, a.high);
    for (std::size_t i = 0; i < actors.size(); ++i) {
        const Actor& a = actors[i];
        const bool nearest = static_cast<int>(i) == base.step;
        if (!nearest && !rules(a, base)) continue;
        if (a.low > limits.floor + kLevelTolerance && !nearest) limits.floor = a.low, limits.highest = a.candidate;
        if (a.must_cut && a.high < std::min(limits.ceiling, limits.upper - kLevelTolerance))
            limits.ceiling = a.high, limits.lowest = a.candidate;
    }
    return limits;
}

// Whether a lies above b by `margin` at least, or below by as much for -1, in all of the square: by their planes, which
// tell features apart that run side by side at nearly the same height.
bool TexelModel::clears(const Actor& a, const Actor& b, double sign, double half) {
    if (!a.plane || !b.plane) return false;
    const Vec2 apart = a.slope - b.slope;
    return sign * (a.middle - b.middle) + kLevelTolerance >= std::sqrt(dot(apart, apart)) * half + a.slack + b.slack;
}

// Whether the ruler `r` leaves `a` no say.
bool TexelModel::outdone(const Actor& a, const Actor& r, double half) {
    const bool over = clears(a, r, 1.0, half), under = clears(a, r, -1.0, half);
    // Of two that are the same the first stays.
    if (over && under) return a.may_cut == r.may_cut && a.candidate > r.candidate;
    return (over && r.must_cut) || (under && !a.may_cut);
}

// Drops the actors that others, or the ground, leave no say in the square.
void TexelModel::cull(std::vector<Actor>& actors, const std::vector<StepLine>& steps, double half) const {
    const Base base = base_of(actors, steps);
    const Limits limits = limits_of(actors, base);
    const auto is_mute = [&](const Actor& a) {
        if (base.known && !(a.left && same_level(a.feature->level_left, base.level)) &&
            !(a.right && same_level(a.feature->level_right, base.level)))
            return true;
        if (a.candidate == limits.lowest) return false;
        if (a.candidate == limits.highest) return a.low > limits.ceiling + kLevelTolerance;
        if (a.low >= limits.ceiling - kLevelTolerance) return true;
        const bool lowers = a.may_cut && a.low < limits.upper - kLevelTolerance;
        return a.high <= limits.floor + kLevelTolerance && !lowers;
    };
    const auto is_base = [&](const Actor& a) {
        return std::any_of(steps.begin(), steps.end(), [&](const StepLine& s) { return s.instance == a.instance; });
    };
    for (std::size_t i = 0; i < actors.size(); ++i)
        actors[i].ruler = static_cast<int>(i) == base.step || rules(actors[i], base);
    std::erase_if(actors, [&](const Actor& a) { return is_mute(a) && !is_base(a); });
    for (std::size_t i = 0; i < actors.size() && actors.size() > 1;) {
        const bool out = !is_base(actors[i]) && std::any_of(actors.begin(), actors.end(), [&](const Actor& r) {
            return r.ruler && &r != &actors[i] && outdone(actors[i], r, half);
        });
        if (out)
            actors.erase(actors.begin() + static_cast<std::ptrdiff_t>(i));
        else
            ++i;
    }
}

// The most that the surface may vary in the square.
double TexelModel::doubt(const std::vector<Actor>& actors, const std::vector<StepLine>& steps) const {
    const Limits limits = limits_of(actors, base_of(actors, steps));
    double low = limits.floor;
    for (const Actor& a : actors)
        if (a.may_cut) low = std::min(low, a.low);
    return std::min(limits.upper, limits.ceiling) - low;
}

// The most that the means of what acts in the square, combined, may differ from the mean of what they combine to: planes
// that are parallel combine alike everywhere.
double TexelModel::discord(const std::vector<Actor>& actors, const std::vector<StepLine>& steps, double half) const {
    constexpr double kShare = 0.18;  // of the difference at a corner: the mean of two planes' maximum, over a square
    const Base base = base_of(actors, steps);
    const Limits limits = limits_of(actors, base);
    const Actor& first = actors.front();
    double sum = 0.0;
    for (const Actor& a : actors) {
        if (!a.plane || !a.ruler || a.may_cut != a.must_cut) return 1e300;
        const Vec2 apart = a.slope - first.slope;
        sum += kShare * std::sqrt(dot(apart, apart)) * half + a.slack;
    }
    const bool on_ground = base.step < 0 && limits.highest < 0 && limits.lowest < 0;
    return on_ground ? sum + kShare * std::sqrt(dot(first.slope, first.slope)) * half : sum;
}

// Whether one evaluation gives the mean over the square.
bool TexelModel::settled(const std::vector<Actor>& actors, const std::vector<StepLine>& steps, const Square& square,
                         int depth) const {
    if (actors.empty()) return true;
    if (doubt(actors, steps) * square.share <= precision_) return true;
    if (actors.size() > 1 && discord(actors, steps, square.half) * square.share <= precision_) return true;
    const Actor& only = actors.front();
    if (actors.size() > 1 || !only.reach.plain) return false;
    if (near_step_ && only.feature->step && (steps.size() != 1 || steps[0].instance != only.instance)) {
        const Base base = base_of(actors, steps);
        const bool above = only.low >= base.level - kLevelTolerance;
        const bool below = only.high <= base.level + kLevelTolerance && (only.must_cut || !only.may_cut);
        if (!base.known || !only.within || !(above || below)) return false;
    }
    const double bend = std::abs(only.foot.bend);
    return only.low == only.high || bend <= kStraight || (depth >= 1 && bend < kBent) || depth >= 2;
}

// Whether the actors are a chain that merely hands over from one to the next here.
bool TexelModel::joined_smoothly(const std::vector<Actor>& actors) const {
    const Actor* previous = nullptr;
    for (const Actor& a : actors) {
        if (!a.reach.plain) {
            const ElementEnd& start = a.feature->frame.start.end;
            const ElementEnd& end = a.feature->frame.end.end;
            if (!start.clips_both() || !end.clips_both()) return false;
        }
        if (previous && dot(previous->foot.tangent, a.foot.tangent) < 0.99) return false;
        if (previous && std::abs(previous->foot.offset - a.foot.offset) > 0.1) return false;
        previous = &a;
    }
    return true;
}

// Whether one feature, or the ground, rules wherever it is asked in the texel, though that is not plain.
bool TexelModel::ruled_by_one() {
    const Vec2 side = texel_.side * (1.0 / kProbes);
    const Vec2 corner = texel_.centre - texel_.side * 0.5;
    int winner = -2;
    for (int j = 0; j < kProbes; ++j) {
        for (int i = 0; i < kProbes; ++i) {
            const Vec2 centre{corner.x + (i + 0.5) * side.x, corner.y + (j + 0.5) * side.y};
            cell_mean({centre, side, texel_.half / kProbes, 0.0}, 0, false);
            if (winner != -2 && winner_ != winner) return false;
            winner = winner_;
        }
    }
    return true;
}

// Where a feature is alone: one cell where it is straight or level, some where it bends.
double TexelModel::lone_mean(const Actor& actor) {
    const double bend = std::abs(actor.foot.bend);
    const int cells = std::min(divisions_, bend <= kStraight ? 1 : bend < kBent ? 2 : 4);
    Say say;
    speak(actor, texel_, say);
    if (cells == 1 || profile_mean(*actor.feature->profile, say.b, say.spread, nullptr, nullptr).slope == 0.0)
        return lone_cell(actor, texel_);
    const Vec2 side = texel_.side * (1.0 / cells), corner = texel_.centre - texel_.side * 0.5;
    double sum = 0.0;
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            Square cell{{corner.x + (i + 0.5) * side.x, corner.y + (j + 0.5) * side.y}, side, texel_.half / cells, 1.0 / (cells * cells)};
            Actor part = actor;
            part.foot = foot_of(actor.feature->frame, cell.centre - actor.offset, std::clamp(actor.foot.parameter, 0.0, 1.0));
            sum += lone_cell(part, cell);
        }
    }
    return sum / (cells * cells);
}

double TexelModel::lone_cell(const Actor& actor, const Square& cell) {
    Say say;
    if (!speak(actor, cell, say)) return actor.feature->level_left;
    if (derivatives_) return differentiate(candidates_[0], say, cell.share);
    return actor.feature->level_left + say.height * profile_mean(*actor.feature->profile, say.b, say.spread, nullptr, nullptr).value;
}

double TexelModel::mean() {
    if (lone_) return lone_mean(actors_[0].front());
    if (divisions_ == kWhole) return cell_mean(texel_, 0, derivatives_);
    cull(actors_[0], steps_[0], texel_.half);
    most_divisions_ = divisions_;
    const std::size_t left = actors_[0].size();
    if (left > 1 && joined_smoothly(actors_[0])) most_divisions_ = std::min(kProbes, divisions_);
    if (left == 1 && !actors_[0].front().reach.plain && ruled_by_one()) most_divisions_ = std::min(kProbes, divisions_);
    return square_mean(texel_, 0);
}

double TexelModel::square_mean(const Square& square, int depth) {
    if (depth > 0) cull(actors_[depth], steps_[depth], square.half);
    if ((1 << depth) >= most_divisions_ || settled(actors_[depth], steps_[depth], square, depth))
        return cell_mean(square, depth, derivatives_);
    double sum = 0.0;
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Vec2 away{(quarter & 1 ? 0.25 : -0.25) * square.side.x, (quarter & 2 ? 0.25 : -0.25) * square.side.y};
        const Square part{square.centre + away, square.side * 0.5, 0.5 * square.half, 0.25 * square.share};
        descend(depth + 1, part);
        sum += square_mean(part, depth + 1);
    }
    return 0.25 * sum;
}

// Where the actor's profile lies over a cell. False where it does not act.
bool TexelModel::speak(const Actor& actor, const Square& cell, Say& say) const {
    const ElementFrame& frame = actor.feature->frame;
    say.placement = place(frame, cell.centre - actor.offset, actor.foot, actor.reach.plain);
    if (!say.placement.acts) return false;
    say.width = scale_at(frame.width0, frame.width1, say.placement.along);
    say.height = scale_at(frame.height0, frame.height1, say.placement.along);
    if (say.width <= 1e-9) return false;
    const Vec2 across = normal_of(say.placement.gradient);
    say.placement.offset += say.placement.bend * (cell.side.x * cell.side.x * across.x * across.x +
                                                  cell.side.y * cell.side.y * across.y * across.y) / 24.0;
    say.spread = spread_of(say.placement, cell.side, say.width);
    say.b = say.placement.offset / say.width;
    return true;
}

bool TexelModel::say_of(const Actor& actor, const Square& cell, double ground, bool any_level, Say& say) const {
    if (!speak(actor, cell, say)) return false;
    const Feature& f = *actor.feature;
    if (!any_level) {
        if (say.b < f.profile->left() - say.spread.half() || say.b > f.profile->right() + say.spread.half()) return false;
        if (!same_level(f.step && say.b > 0.0 ? f.level_right : f.level_left, ground)) return false;
    }
    say.value = f.level_left + say.height * profile_mean(*f.profile, say.b, say.spread, nullptr, nullptr).value;
    // A step's cut ends with its profile, at full height where a ridge stands there; a groove's edge fades out.
    const bool within = say.b >= f.profile->left() && say.b <= f.profile->right();
    say.cuts = (within || !f.step) && internal_at(*f.profile, say.b);
    return true;
}

// The actor whose line is the nearest step, or -1; and the ground there.
int TexelModel::nearest_actor(const Square& cell, int depth, double& ground) const {
    int instance = -1;
    const NearestStep nearest = nearest_step(layout_, steps_[depth], cell.centre);
    ground = nearest.level;
    for (std::size_t i = 0; i < actors_[depth].size(); ++i)
        if (static_cast<int>(actors_[depth][i].instance) == nearest.instance) instance = static_cast<int>(i);
    return instance;
}

// `depth`: of the square that the cell lies in or is, whose actors speak.
double TexelModel::cell_mean(const Square& cell, int depth, bool derivatives) {
    const std::vector<Actor>& actors = actors_[depth];
    double ground = ground_;
    const int nearest = near_step_ ? nearest_actor(cell, depth, ground) : -1;
    double value = ground;
    int winner = -1;
    says_.resize(actors.size());
    spoke_.assign(actors.size(), 0);
    // The nearest step's mean stands for the ground: the ground's own jump at its line is no surface.
    if (nearest >= 0) {
        spoke_[nearest] = say_of(actors[nearest], cell, ground, true, says_[nearest]);
        if (spoke_[nearest]) value = says_[nearest].value, winner = nearest;
    }
    for (std::size_t i = 0; i < actors.size(); ++i)
        if (static_cast<int>(i) != nearest) spoke_[i] = say_of(actors[i], cell, ground, false, says_[i]);
    // All additions before any subtraction.
    for (std::size_t i = 0; i < actors.size(); ++i)
        if (spoke_[i] && says_[i].value > value) value = says_[i].value, winner = static_cast<int>(i);
    for (std::size_t i = 0; i < actors.size(); ++i)
        if (spoke_[i] && says_[i].cuts && says_[i].value < value) value = says_[i].value, winner = static_cast<int>(i);
    winner_ = winner;
    if (derivatives && winner >= 0) differentiate(candidates_[actors[winner].candidate], says_[winner], cell.share);
    if (derivatives && winner < 0) differentiate_ground(ground, cell.share);
    return value;
}

double TexelModel::differentiate(Candidate& c, const Say& say, double share) {
    start_using(c);
    const Feature& f = *c.feature;
    const int points = static_cast<int>(f.profile->b.size());
    const double along = say.placement.along;
    std::array<double, kMaxPoints> d_b, d_h;
    const ProfileMean mean = profile_mean(*f.profile, say.b, say.spread, d_b.data(), d_h.data());
    const double by_offset = share * say.height * mean.slope / say.width;
    for (int k = 0; k < 3; ++k) {
        c.local[kPoints + 2 * k] -= by_offset * say.placement.weight[k] * say.placement.gradient.x;
        c.local[kPoints + 2 * k + 1] -= by_offset * say.placement.weight[k] * say.placement.gradient.y;
    }
    double by_width = 0.0;
    for (int i = 0; i < points; ++i) {
        by_width += d_b[i] * f.profile->b[i];
        c.local[kProfile + i] += share * say.height * d_b[i];
        c.local[kProfile + points + i] += share * say.height * d_h[i];
    }
    by_width *= share * say.height / say.width;
    c.local[kWidths] += by_width * (1.0 - along);
    c.local[kWidths + 1] += by_width * along;
    c.local[kHeights] += share * mean.value * (1.0 - along);
    c.local[kHeights + 1] += share * mean.value * along;
    c.local[kLevel] += share;
    return f.level_left + say.height * mean.value;
}

// Ground moves with the levels of any feature that stands on it.
void TexelModel::differentiate_ground(double ground, double share) {
    for (std::size_t i = 0; i < count_; ++i) {
        Candidate& c = candidates_[i];
        const Feature& f = *c.feature;
        const bool left = std::abs(f.level_left - ground) <= kLevelTolerance;
        if (!left && std::abs(f.level_right - ground) > kLevelTolerance) continue;
        start_using(c);
        c.local[kLevel] += share;
        if (!left) c.local[local_count(f) - 1] += share * f.frame.height0;
        return;
    }
}

}  // namespace burin::refinement
