#include "refine_parameters.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>

namespace burin::refinement {
namespace {

constexpr double kThinnest = 0.05;             // texels: no profile gets narrower
constexpr double kSameOffset = 1e-4;           // texels
// One iteration narrows the wall of a step that is wider than the second, in texels, to this share at most: where a wall has
// closed, the map does not show that this was too much, since opening looks the same to first order as turning over.
constexpr double kMostNarrowing = 0.5;
constexpr double kWideWall = 0.25;
constexpr double kSameHeight = 1e-6;           // map scale
// 1 / deviation^2 of what is expected before the map is asked: a point to move by a texel, a profile's offset by half
// a texel, its height by a twentieth of the relief. The errors of neighbouring texels are alike, so against a profile
// the map is trusted ten times less than its texel count says.
constexpr double kLoose = 1.0;
constexpr double kOffset = 10.0 * 4.0;
constexpr double kHeight = 10.0 * 400.0;
constexpr double kSameLevel = 1.0 / 4096.0;    // map scale: levels that resolve takes for equal

bool is_step(const Profile& profile) {
    return std::abs(profile.points.back().h - profile.points.front().h) > kSameHeight;
}

bool is_symmetric(const Profile& profile) {
    const std::size_t count = profile.points.size();
    for (std::size_t i = 0; i < count; ++i) {
        const ProfilePoint& a = profile.points[i];
        const ProfilePoint& b = profile.points[count - 1 - i];
        if (std::abs(a.b + b.b) > kSameOffset || std::abs(a.h - b.h) > kSameHeight) return false;
    }
    return true;
}

// A step that is as wide to both sides: its place is the path's. Else all rims could move outwards and their profile inwards.
bool is_centred_step(const Profile& profile) {
    const std::size_t count = profile.points.size();
    for (std::size_t i = 0; i < count; ++i)
        if (std::abs(profile.points[i].b + profile.points[count - 1 - i].b) > kSameOffset) return false;
    return is_step(profile);
}

double mean_scale(const Pattern& pattern, std::size_t profile) {
    double sum = 0.0, length_sum = 0.0;
    for (const Path& path : pattern.paths) {
        if (path.profile != profile) continue;
        for (const Element& e : path.elements) {
            const double l = length(e.p2 - e.p0);
            sum += l * 0.5 * (e.width0 + e.width1);
            length_sum += l;
        }
    }
    return length_sum > 0.0 ? sum / length_sum : 1.0;
}

// Area over greatest height: the width of the box that shows the same.
double box_width(const Profile& profile) {
    double area = 0.0, most = 0.0;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
        const ProfilePoint& a = profile.points[i];
        const ProfilePoint& b = profile.points[i + 1];
        area += 0.5 * std::abs(a.h + b.h) * (b.b - a.b);
        most = std::max({most, std::abs(a.h), std::abs(b.h)});
    }
    return most > 0.0 ? area / most : 0.0;
}

// The share of the offsets' step that narrows a wall by not too much.
double share_of_offsets(const Profile& before, const Profile& after) {
    const double was = before.points.back().b - before.points.front().b, is = after.points.back().b - after.points.front().b;
    return was > kWideWall && is < kMostNarrowing * was ? (1.0 - kMostNarrowing) * was / (was - is) : 1.0;
}

// Facets may close, not turn over; a step keeps its line within its walls.
void keep_order(Profile& profile, bool step) {
    std::vector<ProfilePoint>& points = profile.points;
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
        if (points[k + 1].b < points[k].b) points[k].b = points[k + 1].b = 0.5 * (points[k].b + points[k + 1].b);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) points[k + 1].b = std::max(points[k + 1].b, points[k].b);
    if (!step) return;
    points.front().b = std::min(points.front().b, 0.0);
    points.back().b = std::max(points.back().b, 0.0);
}

// Keeps the relief between white and black on every path of the profile, or as far outside as it was.
void keep_within(const Pattern& pattern, std::size_t index, const Profile& before, Profile& profile) {
    double lowest_height = -1e300, highest_height = 1e300;
    for (const Path& path : pattern.paths) {
        if (path.profile != index) continue;
        double scale = 0.0;
        for (const Element& e : path.elements) scale = std::max({scale, e.height0, e.height1});
        if (scale <= 0.0) continue;
        lowest_height = std::max(lowest_height, -path.level / scale);
        highest_height = std::min(highest_height, (1.0 - path.level) / scale);
    }
    for (std::size_t k = 0; k < profile.points.size(); ++k) {
        const double was = before.points[k].h;
        profile.points[k].h = std::clamp(profile.points[k].h, std::min(lowest_height, was), std::max(highest_height, was));
    }
}

// Greatest scale that keeps a profile on a level within the relief; at least what it was.
double most_scale(const Profile& profile, double level, double was) {
    double most = 3.999;
    for (const ProfilePoint& point : profile.points) {
        if (point.h < 0.0) most = std::min(most, level / -point.h);
        if (point.h > 0.0) most = std::min(most, (1.0 - level) / point.h);
    }
    return std::max(most, was);
}

double sum_of(const std::vector<Term>& terms, const std::vector<double>& step) {
    double sum = 0.0;
    for (const Term& term : terms) sum += term.factor * step[term.unknown];
    return sum;
}

// A resolved element as a stretch of the path's element it was cut from.
struct Stretch {
    int element = -1;
    double from = 0.0, to = 1.0;
};

Vec2 point_at(const Element& e, double s) {
    return e.kind == ElementKind::line ? lerp(e.p0, e.p2, s) : lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
}

double parameter_near(const Element& e, Vec2 p) {
    double s = 0.5;
    if (e.kind != ElementKind::line) {
        double best = 1e300;
        for (int i = 0; i <= 8; ++i) {
            const double d = length(point_at(e, i / 8.0) - p);
            if (d < best) best = d, s = i / 8.0;
        }
    }
    for (int i = 0; i < 20; ++i) {
        const Vec2 t = e.kind == ElementKind::line ? e.p2 - e.p0 : 2.0 * lerp(e.p1 - e.p0, e.p2 - e.p1, s);
        if (dot(t, t) <= 0.0) break;
        s = std::clamp(s + dot(p - point_at(e, s), t) / dot(t, t), 0.0, 1.0);
    }
    return s;
}

class StretchFinder {
  public:
    explicit StretchFinder(const Pattern& pattern) : pattern_(pattern), hint_(pattern.paths.size(), 0) {}

    std::optional<Stretch> find(const ResolvedElement& resolved) {
        const std::vector<Element>& elements = pattern_.paths[resolved.path].elements;
        const std::size_t count = elements.size();
        Stretch best;
        double least = kClose;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = (hint_[resolved.path] + k) % count;
            consider(elements[i], static_cast<int>(i), resolved.element, best, least);
            if (k >= 2 && least < kExact) break;
        }
        if (best.element < 0) return std::nullopt;
        hint_[resolved.path] = static_cast<std::size_t>(best.element);
        return best;
    }

  private:
    static constexpr double kExact = 1e-6;  // texels
    static constexpr double kClose = 0.5;   // texels: snapping and cleaning may move ends a little

    void consider(const Element& e, int index, const Element& part, Stretch& best, double& least) const {
        if (e.kind != part.kind) return;
        const int span = pattern_.wrap == Wrap::repeat ? 1 : 0;
        for (int j = -span; j <= span; ++j) {
            for (int i = -span; i <= span; ++i) {
                const Vec2 offset{i * pattern_.size.x, j * pattern_.size.y};
                const double from = parameter_near(e, part.p0 - offset), to = parameter_near(e, part.p2 - offset);
                const double distance = length(point_at(e, from) + offset - part.p0) +
                                        length(point_at(e, to) + offset - part.p2) +
                                        length(point_at(e, 0.5 * (from + to)) + offset - point_at(part, 0.5));
                if (to <= from || distance >= least) continue;
                least = distance;
                best = {index, from, to};
            }
        }
    }

    const Pattern& pattern_;
    std::vector<std::size_t> hint_;
};

// Shares of the element's control points in those of its stretch.
std::array<std::array<double, 3>, 3> stretch_weights(bool line, const Stretch& s) {
    if (line) return {{{1.0 - s.from, 0.0, s.from}, {0.0, 0.0, 0.0}, {1.0 - s.to, 0.0, s.to}}};
    const auto blossom = [](double a, double b) {
        return std::array<double, 3>{(1.0 - a) * (1.0 - b), a * (1.0 - b) + b * (1.0 - a), a * b};
    };
    return {blossom(s.from, s.from), blossom(s.from, s.to), blossom(s.to, s.to)};
}

// A resolved profile's points as shares of the pattern's: resolve adds points where a facet passes b = 0 or the ground.
struct PointShare {
    std::size_t first = 0;
    double second_share = 0.0;  // of point first + 1
};

std::vector<PointShare> point_shares(const ResolvedProfile& resolved, const Profile& profile) {
    std::vector<PointShare> shares;
    const std::size_t count = profile.points.size();
    std::size_t facet = 0;
    for (const ProfilePoint& p : resolved.points) {
        const auto same = [&](std::size_t i) {
            return std::abs(profile.points[i].b - p.b) < 1e-9 && std::abs(profile.points[i].h - p.h) < 1e-9;
        };
        std::size_t at = facet;
        while (at < count && !same(at)) ++at;
        if (at < count) {
            facet = at;
            shares.push_back(at + 1 < count ? PointShare{at, 0.0} : PointShare{count - 2, 1.0});
            continue;
        }
        const std::size_t i = std::min(facet, count - 2);
        const double width = profile.points[i + 1].b - profile.points[i].b;
        const double rise = profile.points[i + 1].h - profile.points[i].h;
        const double share = std::abs(width) > std::abs(rise) ? (p.b - profile.points[i].b) / width
                             : rise != 0.0                    ? (p.h - profile.points[i].h) / rise
                                                              : 0.0;
        shares.push_back({i, std::clamp(share, 0.0, 1.0)});
    }
    return shares;
}

// Collects local terms by unknown.
class TermCollector {
  public:
    void add(int local, int unknown, double factor) {
        if (unknown >= 0 && factor != 0.0) raw_.push_back({local, unknown, factor});
    }

    ElementUnknowns finish() {
        ElementUnknowns out;
        for (const LocalTerm& term : raw_) out.unknowns.push_back(term.slot);
        std::sort(out.unknowns.begin(), out.unknowns.end());
        out.unknowns.erase(std::unique(out.unknowns.begin(), out.unknowns.end()), out.unknowns.end());
        for (LocalTerm term : raw_) {
            const auto found = std::lower_bound(out.unknowns.begin(), out.unknowns.end(), term.slot);
            term.slot = static_cast<int>(found - out.unknowns.begin());
            out.terms.push_back(term);
        }
        raw_.clear();
        return out;
    }

  private:
    std::vector<LocalTerm> raw_;  // slot holds the unknown until the end
};

}  // namespace

Parameters::Parameters(Pattern& pattern, const RefineOptions& options)
    : nodes_(pattern, options.snap * std::max(pattern.size.x, pattern.size.y), !options.positions, 0) {
    count_ = nodes_.unknown_count();
    number_levels(pattern, options.levels);
    number_profiles(pattern, options);
    scales_.resize(pattern.paths.size());
    for (std::size_t p = 0; p < pattern.paths.size(); ++p) scales_[p].resize(pattern.paths[p].elements.size());
    if (options.scales) number_scales(pattern);
    moved_.assign(count_, 0.0);
    held_.assign(count_, 0);
    stiffness_.resize(count_, kLoose);
    nodes_.write(pattern);
}

int Parameters::level_class(double level) {
    for (std::size_t i = 0; i < levels_.size(); ++i)
        if (std::abs(levels_[i] - level) < kSameLevel) return static_cast<int>(i);
    levels_.push_back(level);
    return static_cast<int>(levels_.size()) - 1;
}

int Parameters::nearest_level(double level) const {
    int best = 0;
    for (std::size_t i = 1; i < levels_.size(); ++i)
        if (std::abs(levels_[i] - level) < std::abs(levels_[best] - level)) best = static_cast<int>(i);
    return best;
}

void Parameters::number_levels(const Pattern& pattern, bool free) {
    outer_level_ = level_class(pattern.outer_level);
    for (const Path& path : pattern.paths) {
        const Profile& profile = pattern.profiles[path.profile];
        PathLevels levels;
        levels.step = is_step(profile);
        levels.left = levels.right = level_class(path.level);
        levels.left_value = levels.right_value = path.level;
        if (levels.step && !path.elements.empty()) {
            levels.right_value +=
                (profile.points.back().h - profile.points.front().h) * path.elements.front().height0;
            levels.right = level_class(levels.right_value);
        }
        path_levels_.push_back(levels);
    }
    for (std::size_t i = 0; i < levels_.size(); ++i) level_unknown_.push_back(free ? count_++ : -1);
}

void Parameters::number_offsets(const Profile& profile, bool narrow, ProfileTerms& terms) {
    const std::size_t count = profile.points.size();
    const double widest = std::max(-profile.points.front().b, profile.points.back().b);
    if (narrow) {
        for (std::size_t i = 0; i < count; ++i)
            terms.b[i].push_back({count_, widest > 0.0 ? profile.points[i].b / widest : 0.0});
        ++count_;
        return;
    }
    const bool mirrored = is_symmetric(profile) || is_centred_step(profile);
    int last = -1;
    for (std::size_t i = 0; i < count; ++i) {
        const ProfilePoint& point = profile.points[i];
        if (mirrored && i >= (count + 1) / 2) {
            for (const Term& term : terms.b[count - 1 - i]) terms.b[i].push_back({term.unknown, -term.factor});
            continue;
        }
        if (mirrored && std::abs(point.b) < kSameOffset) continue;
        const bool vertical = i > 0 && point.b - profile.points[i - 1].b < kSameOffset && last >= 0;
        if (!vertical) last = count_++;
        terms.b[i].push_back({last, 1.0});
    }
}

void Parameters::number_heights(const Profile& profile, bool free, const PathLevels* step, ProfileTerms& terms) {
    const std::size_t count = profile.points.size();
    const double low = profile.points.front().h, high = profile.points.back().h;
    std::vector<std::pair<double, int>> known;
    for (std::size_t i = 0; i < count; ++i) {
        const double h = profile.points[i].h;
        if (std::abs(h - high) < kSameHeight && step) {
            if (level_unknown_[step->right] >= 0) terms.h[i].push_back({level_unknown_[step->right], 1.0});
            if (level_unknown_[step->left] >= 0) terms.h[i].push_back({level_unknown_[step->left], -1.0});
            continue;
        }
        if (!free || std::abs(h - low) < kSameHeight) continue;
        const auto found = std::find_if(known.begin(), known.end(),
                                        [&](const auto& entry) { return std::abs(entry.first - h) < kSameHeight; });
        const int unknown = found != known.end() ? found->second : count_++;
        if (found == known.end()) known.push_back({h, unknown});
        terms.h[i].push_back({unknown, 1.0});
    }
}

void Parameters::number_profiles(const Pattern& pattern, const RefineOptions& options) {
    profiles_.resize(pattern.profiles.size());
    for (std::size_t i = 0; i < pattern.profiles.size(); ++i) {
        const Profile& profile = pattern.profiles[i];
        const PathLevels* step = nullptr;
        for (std::size_t p = 0; p < pattern.paths.size() && !step; ++p)
            if (pattern.paths[p].profile == i && path_levels_[p].step) step = &path_levels_[p];
        profiles_[i].b.resize(profile.points.size());
        profiles_[i].h.resize(profile.points.size());
        const bool used = std::any_of(pattern.paths.begin(), pattern.paths.end(),
                                      [&](const Path& path) { return path.profile == i; });
        if (!used) continue;
        const bool narrow = !step && box_width(profile) * mean_scale(pattern, i) < options.narrow_texels;
        stiffness_.resize(count_, kLoose);
        if (options.profiles) number_offsets(profile, narrow, profiles_[i]);
        stiffness_.resize(count_, kOffset);
        number_heights(profile, options.profiles, step, profiles_[i]);
        stiffness_.resize(count_, kHeight);
    }
}

void Parameters::number_scales(const Pattern& pattern) {
    for (std::size_t p = 0; p < pattern.paths.size(); ++p) {
        const std::vector<Element>& elements = pattern.paths[p].elements;
        const auto any = [&](auto differs) { return std::any_of(elements.begin(), elements.end(), differs); };
        const bool widths = any([](const Element& e) { return e.width0 != 1.0 || e.width1 != 1.0; });
        const bool heights = !path_levels_[p].step &&
                             any([](const Element& e) { return e.height0 != 1.0 || e.height1 != 1.0; });
        const bool uniform_widths =
            !any([&](const Element& e) { return e.width0 != elements[0].width0 || e.width1 != elements[0].width0; });
        const bool uniform_heights =
            !any([&](const Element& e) { return e.height0 != elements[0].height0 || e.height1 != elements[0].height0; });
        for (std::size_t i = 0; i < elements.size(); ++i) {
            ScaleUnknowns& own = scales_[p][i];
            const Element& e = elements[i];
            const auto number = [&](int* ends, bool uniform, int before, bool joined) {
                ends[0] = i > 0 && (uniform || joined) ? before : count_++;
                ends[1] = uniform ? ends[0] : count_++;
            };
            const Element& previous = elements[i > 0 ? i - 1 : 0];
            const ScaleUnknowns& former = scales_[p][i > 0 ? i - 1 : 0];
            if (widths) number(own.width, uniform_widths, former.width[1], previous.width1 == e.width0);
            if (heights) number(own.height, uniform_heights, former.height[1], previous.height1 == e.height0);
        }
    }
}

void Parameters::hold(int path, int element) {
    for (int point = 0; point < 3; ++point)
        for (const PointTerm& term : nodes_.terms(path, element, point)) held_[term.unknown] = 1;
}

void Parameters::hold(const std::vector<int>& unknowns) {
    for (const int unknown : unknowns) held_[unknown] = 1;
}

void Parameters::apply(const std::vector<double>& step, double most_shift, Pattern& pattern) {
    assert(static_cast<int>(step.size()) == count_);
    for (int i = 0; i < count_; ++i) moved_[i] += step[i];
    nodes_.move(step, most_shift);
    nodes_.write(pattern);
    apply_levels(step, pattern);
    apply_profiles(step, pattern);
    apply_scales(step, pattern);
    follow_levels(pattern);
}

void Parameters::apply_profiles(const std::vector<double>& step, Pattern& pattern) const {
    for (std::size_t i = 0; i < profiles_.size(); ++i) {
        Profile& profile = pattern.profiles[i];
        const bool was_step = is_step(profile);
        const Profile before = profile;
        for (std::size_t k = 0; k < profile.points.size(); ++k) {
            profile.points[k].b += sum_of(profiles_[i].b[k], step);
            profile.points[k].h += sum_of(profiles_[i].h[k], step);
        }
        if (const double share = was_step ? share_of_offsets(before, profile) : 1.0; share < 1.0)
            for (std::size_t k = 0; k < profile.points.size(); ++k)
                profile.points[k].b = before.points[k].b + share * (profile.points[k].b - before.points[k].b);
        keep_order(profile, was_step);
        if (profile.points.back().b - profile.points.front().b < kThinnest)
            for (std::size_t k = 0; k < profile.points.size(); ++k) profile.points[k].b = before.points[k].b;
        if (!was_step) keep_within(pattern, i, before, profile);
    }
}

void Parameters::apply_scales(const std::vector<double>& step, Pattern& pattern) const {
    const auto changed = [&](double value, int unknown, double most) {
        return unknown < 0 ? value : std::clamp(value + step[unknown], 0.02, most);
    };
    for (std::size_t p = 0; p < scales_.size(); ++p) {
        for (std::size_t i = 0; i < scales_[p].size(); ++i) {
            Element& e = pattern.paths[p].elements[i];
            const ScaleUnknowns& unknowns = scales_[p][i];
            const Path& path = pattern.paths[p];
            const double most = most_scale(pattern.profiles[path.profile], path.level, std::max(e.height0, e.height1));
            e.width0 = changed(e.width0, unknowns.width[0], 3.999);
            e.width1 = changed(e.width1, unknowns.width[1], 3.999);
            e.height0 = changed(e.height0, unknowns.height[0], most);
            e.height1 = changed(e.height1, unknowns.height[1], most);
        }
    }
}

void Parameters::apply_levels(const std::vector<double>& step, Pattern& pattern) {
    const auto moved = [&](int level) { return level_unknown_[level] < 0 ? 0.0 : step[level_unknown_[level]]; };
    for (std::size_t i = 0; i < levels_.size(); ++i) levels_[i] += moved(static_cast<int>(i));
    const auto within = [](double level) { return std::clamp(level, 0.0, 1.0); };
    pattern.outer_level = within(pattern.outer_level + moved(outer_level_));
    for (std::size_t p = 0; p < path_levels_.size(); ++p) {
        PathLevels& levels = path_levels_[p];
        levels.left_value = within(levels.left_value + moved(levels.left));
        levels.right_value = within(levels.right_value + moved(levels.right));
        pattern.paths[p].level = levels.left_value;
    }
}

// A step's scale carries its profile from the level on its left to that on its right.
void Parameters::follow_levels(Pattern& pattern) const {
    for (std::size_t p = 0; p < path_levels_.size(); ++p) {
        const PathLevels& levels = path_levels_[p];
        if (!levels.step) continue;
        const Profile& profile = pattern.profiles[pattern.paths[p].profile];
        const double rise = profile.points.back().h - profile.points.front().h;
        if (std::abs(rise) < kSameHeight) continue;
        const double scale = std::clamp((levels.right_value - levels.left_value) / rise, 0.0, 3.999);
        for (Element& e : pattern.paths[p].elements) e.height0 = e.height1 = scale;
    }
}

std::vector<ElementUnknowns> Parameters::of_elements(const Pattern& pattern, const ResolvedPattern& resolved) const {
    std::vector<ElementUnknowns> out;
    StretchFinder finder(pattern);
    TermCollector collect;
    for (const ResolvedElement& element : resolved.elements) {
        const Style& style = resolved.styles[element.style];
        const std::uint32_t profile_index = pattern.paths[element.path].profile;
        const std::size_t points = resolved.profiles[style.profile].points.size();
        const std::optional<Stretch> stretch = finder.find(element);
        if (stretch) {
            const bool line = element.element.kind == ElementKind::line;
            const auto weights = stretch_weights(line, *stretch);
            for (int k = 0; k < 3; ++k) {
                for (const PointTerm& term : nodes_.terms(static_cast<int>(element.path), stretch->element, k)) {
                    for (int local = 0; local < 3; ++local) {
                        collect.add(kPoints + 2 * local, term.unknown, weights[local][k] * term.direction.x);
                        collect.add(kPoints + 2 * local + 1, term.unknown, weights[local][k] * term.direction.y);
                    }
                }
            }
            const ScaleUnknowns& scales = scales_[element.path][stretch->element];
            const double ends[2] = {stretch->from, stretch->to};
            for (int k = 0; k < 2; ++k) {
                collect.add(kWidths + k, scales.width[0], 1.0 - ends[k]);
                collect.add(kWidths + k, scales.width[1], ends[k]);
                collect.add(kHeights + k, scales.height[0], 1.0 - ends[k]);
                collect.add(kHeights + k, scales.height[1], ends[k]);
            }
        }
        collect.add(kLevel, level_unknown_[nearest_level(style.level)], 1.0);
        const Profile& profile = pattern.profiles[profile_index];
        const PathLevels& levels = path_levels_[element.path];
        const std::vector<PointShare> shares = point_shares(resolved.profiles[style.profile], profile);
        for (std::size_t i = 0; i < points; ++i) {
            for (int end = 0; end < 2; ++end) {
                const double share = end == 0 ? 1.0 - shares[i].second_share : shares[i].second_share;
                const std::size_t point = shares[i].first + static_cast<std::size_t>(end);
                for (const Term& term : profiles_[profile_index].b[point])
                    collect.add(kProfile + static_cast<int>(i), term.unknown, share * term.factor);
                const int height_local = kProfile + static_cast<int>(points + i);
                const ProfilePoint& original = profile.points[point];
                if (levels.step && std::abs(original.h - profile.points.back().h) < kSameHeight) {
                    // The far side of a step ends at the level of its region, whatever the path's scale.
                    collect.add(height_local, level_unknown_[levels.right], share / element.element.height0);
                    collect.add(height_local, level_unknown_[levels.left], -share / element.element.height0);
                    continue;
                }
                for (const Term& term : profiles_[profile_index].h[point])
                    collect.add(height_local, term.unknown, share * term.factor);
            }
        }
        out.push_back(collect.finish());
        if (!stretch) continue;
        out.back().path = static_cast<int>(element.path);
        out.back().element = stretch->element;
    }
    return out;
}

}  // namespace burin::refinement
