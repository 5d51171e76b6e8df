// A map that was damaged (8 bits, JPEG) rounds corners and lets a measured section ripple, and points follow what is not
// there: walls then stand off by a tenth of a texel all along. A section of few points has no room for that.
#include "refine_sections.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "refine_profile.hpp"
#include "refine_simplify.hpp"

namespace burin::refinement {
namespace {

constexpr double kStep = 0.25;         // texels between samples
constexpr double kMargin = 1.0;        // texels beyond the ends: half of a texel's blur, and a little ground
constexpr double kNarrowest = 0.02;    // texels between points
constexpr double kFurthest = 1.0;      // texels that the middle may lie beside b = 0
constexpr double kLeastError = 0.01;   // of the relief: less is none
constexpr double kNumberCosts = 1.35;  // times the error that a number more must take away
constexpr int kRounds = 12;
constexpr Spread kTexel{1.0, 0.0};

// A family of polylines: their points as linear functions of few numbers.
struct Family {
    std::size_t points = 0;
    bool symmetric = false;
};

struct Term {
    std::size_t number = 0;
    double factor = 0.0;
};

// Numbers of a symmetric family: the middle, then half offsets from outside inwards, then heights. Of another: all offsets,
// then heights. The two ends lie on the ground and have none.
class Layout {
  public:
    Layout(Family family) : family_(family) {}

    std::size_t count() const {
        const std::size_t n = family_.points;
        return family_.symmetric ? 1 + n / 2 + ((n + 1) / 2 - 1) : 2 * n - 2;
    }
    std::vector<Term> offset(std::size_t i) const {
        if (!family_.symmetric) return {{i, 1.0}};
        const std::size_t mirrored = family_.points - 1 - i;
        if (i == mirrored) return {{0, 1.0}};
        return {{0, 1.0}, {1 + std::min(i, mirrored), i < mirrored ? -1.0 : 1.0}};
    }
    std::optional<std::size_t> height(std::size_t i) const {
        const std::size_t n = family_.points, mirrored = n - 1 - i;
        if (i == 0 || mirrored == 0) return std::nullopt;
        return family_.symmetric ? n / 2 + std::min(i, mirrored) : n + i - 1;
    }

  private:
    Family family_;
};

SweptProfile polyline_of(const std::vector<ProfilePoint>& points) {
    SweptProfile out;
    for (const ProfilePoint& p : points) out.b.push_back(p.b), out.h.push_back(p.h);
    for (std::size_t i = 1; i < out.b.size(); ++i) out.b[i] = std::max(out.b[i], out.b[i - 1] + kThinnestWall);
    return out;
}

double height_of(const std::vector<ProfilePoint>& points, double b) {
    if (b <= points.front().b) return points.front().h;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const ProfilePoint &from = points[i - 1], &to = points[i];
        if (b < to.b) return from.h + (to.h - from.h) * (b - from.b) / (to.b - from.b);
    }
    return points.back().h;
}

// What a polyline without point i is off by, squared and summed over its width.
double harm_without(const std::vector<ProfilePoint>& points, std::size_t i) {
    const ProfilePoint &a = points[i - 1], &b = points[i + 1];
    const double width = std::max(b.b - a.b, 1e-9);
    const double off = points[i].h - (a.h + (b.h - a.h) * (points[i].b - a.b) / width);
    return off * off * width;
}

// The most telling `count` of the points.
std::vector<ProfilePoint> thinned(std::vector<ProfilePoint> points, std::size_t count) {
    while (points.size() > count) {
        std::size_t least = 1;
        for (std::size_t i = 2; i + 1 < points.size(); ++i)
            if (harm_without(points, i) < harm_without(points, least)) least = i;
        points.erase(points.begin() + static_cast<std::ptrdiff_t>(least));
    }
    return points;
}

// Half of the mean of a profile and its mirror image about `middle`: from the left end to the middle.
std::vector<ProfilePoint> left_half(const std::vector<ProfilePoint>& points, double middle) {
    std::vector<double> offsets{0.0};
    for (const ProfilePoint& p : points) offsets.push_back(std::abs(p.b - middle));
    std::sort(offsets.rbegin(), offsets.rend());
    std::vector<ProfilePoint> half;
    for (const double b : offsets) {
        if (!half.empty() && middle - b < half.back().b + kNarrowest) continue;
        half.push_back({middle - b, 0.5 * (height_of(points, middle - b) + height_of(points, middle + b))});
    }
    half.front().h = points.front().h;
    return half;
}

// Where a fit starts. Nothing where the profile has too few points.
std::optional<std::vector<ProfilePoint>> start_of(const Family& family, const std::vector<ProfilePoint>& points) {
    if (!family.symmetric) {
        if (points.size() < family.points) return std::nullopt;
        return thinned(points, family.points);
    }
    const double middle = 0.5 * (points.front().b + points.back().b);
    std::vector<ProfilePoint> half = left_half(points, middle);
    const bool peaked = family.points % 2 == 1;
    // A flat middle ends half-way: its point is not one.
    const std::size_t wanted = family.points / 2 + 1;
    if (half.size() < wanted) return std::nullopt;
    half = thinned(half, wanted);
    if (!peaked) half.pop_back();
    std::vector<ProfilePoint> whole = half;
    for (std::size_t i = half.size() - (peaked ? 1 : 0); i-- > 0;) whole.push_back({2.0 * middle - half[i].b, half[i].h});
    return whole;
}

// Normal equations of a handful of numbers, by Cholesky. False where they have no answer.
bool solve(std::vector<std::vector<double>>& a, std::vector<double>& x) {
    const std::size_t n = x.size();
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
        if (!(a[j][j] > 0.0)) return false;
        a[j][j] = std::sqrt(a[j][j]);
        for (std::size_t i = j + 1; i < n; ++i) {
            for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) x[i] -= a[k][i] * x[k];
        x[i] /= a[i][i];
    }
    return true;
}

class Section {
  public:
    explicit Section(const std::vector<ProfilePoint>& points) {
        const SweptProfile profile = polyline_of(points);
        for (double b = points.front().b - kMargin; b <= points.back().b + kMargin; b += kStep) {
            offsets_.push_back(b);
            heights_.push_back(profile_mean(profile, b, kTexel, nullptr, nullptr).value);
        }
    }

    double error_of(const std::vector<ProfilePoint>& points) const {
        const SweptProfile profile = polyline_of(points);
        double sum = 0.0;
        for (std::size_t i = 0; i < offsets_.size(); ++i) {
            const double off = profile_mean(profile, offsets_[i], kTexel, nullptr, nullptr).value - heights_[i];
            sum += off * off;
        }
        return std::sqrt(sum / static_cast<double>(offsets_.size()));
    }

    // Damped Gauss-Newton steps of the family's numbers.
    std::vector<ProfilePoint> fit(const Family& family, std::vector<ProfilePoint> points) const {
        const Layout layout(family);
        double error = error_of(points), damping = 1e-3;
        for (int round = 0; round < kRounds; ++round) {
            std::vector<ProfilePoint> next = points;
            if (!step(layout, damping, next)) return points;
            const double after = error_of(next);
            if (after < error) {
                if (after > 0.999 * error) return next;
                points = std::move(next), error = after, damping *= 0.3;
            } else {
                damping *= 10.0;
            }
        }
        return points;
    }

  private:
    // False where the equations have no answer.
    bool step(const Layout& layout, double damping, std::vector<ProfilePoint>& points) const {
        const std::size_t n = layout.count();
        std::vector<std::vector<double>> matrix(n, std::vector<double>(n, 0.0));
        std::vector<double> right(n, 0.0);
        add_equations(layout, points, matrix, right);
        for (std::size_t i = 0; i < n; ++i) matrix[i][i] = matrix[i][i] * (1.0 + damping) + 1e-12;
        if (!solve(matrix, right)) return false;
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (const Term& term : layout.offset(i)) points[i].b += term.factor * right[term.number];
            if (const auto number = layout.height(i)) points[i].h += right[*number];
        }
        for (std::size_t i = 1; i < points.size(); ++i)
            points[i].b = std::max(points[i].b, points[i - 1].b + kNarrowest);
        return true;
    }

    void add_equations(const Layout& layout, const std::vector<ProfilePoint>& points, std::vector<std::vector<double>>& matrix,
                       std::vector<double>& right) const {
        const SweptProfile profile = polyline_of(points);
        std::vector<double> by_b(points.size()), by_h(points.size()), row(right.size());
        for (std::size_t s = 0; s < offsets_.size(); ++s) {
            const double value = profile_mean(profile, offsets_[s], kTexel, by_b.data(), by_h.data()).value;
            std::fill(row.begin(), row.end(), 0.0);
            for (std::size_t i = 0; i < points.size(); ++i) {
                for (const Term& term : layout.offset(i)) row[term.number] += term.factor * by_b[i];
                if (const auto number = layout.height(i)) row[*number] += by_h[i];
            }
            for (std::size_t i = 0; i < row.size(); ++i) {
                right[i] += row[i] * (heights_[s] - value);
                for (std::size_t j = 0; j <= i; ++j) matrix[i][j] += row[i] * row[j];
            }
        }
    }

    std::vector<double> offsets_, heights_;
};

// From the plainest on.
std::vector<Family> families_below(std::size_t points) {
    std::vector<Family> families;
    for (std::size_t n = 3; n <= points; ++n) families.push_back({n, true});
    for (std::size_t n = 3; n < points; ++n) families.push_back({n, false});
    std::stable_sort(families.begin(), families.end(),
                     [](const Family& a, const Family& b) { return Layout(a).count() < Layout(b).count(); });
    return families;
}

// Of the families within the tolerance the one whose error is least for what it costs.
bool straighten(Profile& profile, double share) {
    const std::vector<ProfilePoint>& points = profile.points;
    if (!profile.facets.empty() || points.size() < 4 || points.front().h != points.back().h) return false;
    const double relief = relief_of(profile);
    const Section section(points);
    std::vector<ProfilePoint> best;
    double least = 1e300;
    for (const Family& family : families_below(points.size())) {
        const auto start = start_of(family, points);
        if (!start) continue;
        std::vector<ProfilePoint> fitted = section.fit(family, *start);
        const double error = section.error_of(fitted);
        const double price = std::max(error, kLeastError * relief) * std::pow(kNumberCosts, Layout(family).count());
        const double middle = family.symmetric ? 0.5 * (fitted.front().b + fitted.back().b) : 0.0;
        if (error > share * relief || price >= least || std::abs(middle) > kFurthest) continue;
        least = price;
        best = std::move(fitted);
        for (ProfilePoint& p : best) p.b -= middle;
    }
    if (best.empty()) return false;
    profile.points = std::move(best);
    return true;
}

void take_scales(const Path& from, Path& to) {
    to.level = from.level;
    for (std::size_t i = 0; i < to.elements.size(); ++i) {
        Element& e = to.elements[i];
        const Element& other = from.elements[i];
        e.width0 = other.width0, e.width1 = other.width1;
        e.height0 = other.height0, e.height1 = other.height1;
    }
}

}  // namespace

bool straighten_sections(Pattern& pattern, double share, const std::vector<std::uint8_t>& stay) {
    bool changed = false;
    for (std::size_t i = 0; i < pattern.profiles.size(); ++i)
        if (!stay[i]) changed |= straighten(pattern.profiles[i], share);
    return changed;
}

Pattern with_sections(Pattern pattern, const Pattern& other, const std::vector<std::uint8_t>& stay) {
    for (std::size_t i = 0; i < stay.size(); ++i)
        if (!stay[i]) pattern.profiles[i] = other.profiles[i];
    for (std::size_t i = 0; i < pattern.paths.size(); ++i)
        if (!stay[pattern.paths[i].profile]) take_scales(other.paths[i], pattern.paths[i]);
    return pattern;
}

}  // namespace burin::refinement
