// Scales at stations along each line by least squares, then as few of them as the map asks for.
#include "vectorize_scales.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel.hpp"
#include "resolve_curve.hpp"

namespace burin::vectorizing {
namespace {

constexpr double kStationSpacing = 6.0;  // texels
constexpr int kIterations = 4;           // Gauss-Newton
constexpr int kSweeps = 40;              // Gauss-Seidel
constexpr double kSmoothness = 0.03, kRest = 0.01;  // springs between stations, and to 1, of the mean evidence
constexpr double kLeastWidth = 0.3, kMostWidth = 3.0, kMostHeight = 3.5;
constexpr double kCore = 0.3, kFoot = 0.1;  // of a section's height: where it rules, and where it ends
constexpr double kSnap = 2.0;            // texels: a knot this near to an element's end is there

// A texel near the chain.
struct Sample {
    float station = 0.0f;  // place along the chain, in stations
    float offset = 0.0f;
    float value = 0.0f;    // above the ground
};

struct Scale {
    double height = 1.0, width = 1.0;
};

Scale between(const Scale& a, const Scale& b, double t) {
    return {a.height + (b.height - a.height) * t, a.width + (b.width - a.width) * t};
}

// A profile as texels show it: its mean over a texel's width.
class BlurredProfile {
  public:
    explicit BlurredProfile(const Profile& profile) : points_(profile.points), sums_(profile.points.size(), 0.0) {
        for (std::size_t k = 1; k < points_.size(); ++k)
            sums_[k] = sums_[k - 1] + 0.5 * (points_[k].h + points_[k - 1].h) * (points_[k].b - points_[k - 1].b);
    }

    // Height at an offset, and its derivative by the width scale.
    double value(double b, double width, double& by_width) const {
        double h[2], sum[2];
        const double u[2] = {(b - 0.5) / width, (b + 0.5) / width};
        for (int i : {0, 1}) look_up(u[i], h[i], sum[i]);
        by_width = sum[1] - sum[0] - (u[1] * h[1] - u[0] * h[0]);
        return width * (sum[1] - sum[0]);
    }
    double value(double b, double width) const {
        double ignored = 0.0;
        return value(b, width, ignored);
    }

    // Offset beyond which the profile stays below a share of its height.
    double extent(double share) const {
        double most = 0.0, extent = 0.0;
        for (const ProfilePoint& p : points_) most = std::max(most, std::fabs(p.h));
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, points_.size() - 1);
            for (const std::size_t i : {before, k, after}) {
                // A facet that leads down to less than the share counts as far as it stands above it.
                const double h = std::fabs(points_[k].h), other = std::fabs(points_[i].h), limit = share * most;
                if (h <= limit) continue;
                const double t = other < limit ? (h - limit) / (h - other) : 0.0;
                extent = std::max(extent, std::fabs(points_[k].b + t * (points_[i].b - points_[k].b)));
            }
        }
        return extent;
    }

  private:
    // Height, and the sum of heights from the left end.
    void look_up(double u, double& h, double& sum) const {
        h = 0.0;
        sum = u <= points_.front().b ? 0.0 : sums_.back();
        if (!(u >= points_.front().b && u < points_.back().b)) return;
        const auto after = std::upper_bound(points_.begin(), points_.end(), u, [](double at, const ProfilePoint& p) { return at < p.b; });
        const std::size_t k = static_cast<std::size_t>(after - points_.begin());
        const double t = (u - points_[k - 1].b) / (points_[k].b - points_[k - 1].b);
        h = points_[k - 1].h + t * (points_[k].h - points_[k - 1].h);
        sum = sums_[k - 1] + 0.5 * (h + points_[k - 1].h) * (u - points_[k - 1].b);
    }

    const std::vector<ProfilePoint>& points_;
    std::vector<double> sums_;
};

// Evidence for the scales of one station, and for it together with the next one.
struct Evidence {
    double own[3] = {0, 0, 0};      // height-height, height-width, width-width
    double next[4] = {0, 0, 0, 0};  // rows of this one, columns of the next
    double gradient[2] = {0, 0};
};

// Where the chain's elements and stations lie on its length.
struct Course {
    std::vector<double> begin;  // of each element, and the whole length last
    int stations = 2;
    bool closed = false;

    double length() const { return begin.back(); }
    double spacing() const { return length() / (closed ? stations : stations - 1); }
    int after(int station) const { return closed ? (station + 1) % stations : std::min(station + 1, stations - 1); }
};

Course lay_course(const FittedChain& fitted) {
    Course course;
    double sum = 0.0;
    for (const Element& e : fitted.elements) course.begin.push_back(sum), sum += curve::arc_length(e);
    course.begin.push_back(sum);
    course.closed = fitted.chain.closed;
    const int spans = std::max(course.closed ? 3 : 1, static_cast<int>(std::lround(sum / kStationSpacing)));
    course.stations = course.closed ? spans : spans + 1;
    return course;
}

// Texels where another chain than the nearest has a say, too.
std::vector<std::uint8_t> find_contested(const std::vector<FittedChain>& chains,
                                         const std::vector<BlurredProfile>& profiles, const Lattice& lattice,
                                         const std::vector<Owner>& owners, double reach) {
    std::vector<std::uint8_t> contested(owners.size(), 0);
    for (std::size_t c = 0; c < chains.size(); ++c) {
        const double extent = std::min(reach, profiles[chains[c].profile].extent(kCore) + 0.5);
        for (const Piece& piece : flatten(chains[c]))
            for_each_texel_of_piece(lattice, piece, extent, [&](int texel, const Place&) {
                if (owners[texel].chain != c) contested[texel] = 1;
            });
    }
    return contested;
}

class ScaleFit {
  public:
    ScaleFit(const Course& course, const BlurredProfile& profile, const std::vector<Sample>& samples)
        : course_(course), profile_(profile), samples_(samples), seen_(samples.size()), scales_(course.stations),
          evidence_(course.stations) {}

    void run() {
        for (int i = 0; i < kIterations; ++i) {
            gather();
            solve();
        }
        gather();
    }

    const std::vector<Scale>& scales() const { return scales_; }
    const std::vector<Evidence>& evidence() const { return evidence_; }

    // Squared error with scales 1.
    double plain_error() const {
        double sum = 0.0;
        for (const Sample& s : samples_) sum += std::pow(s.value - profile_.value(s.offset, 1.0), 2.0);
        return sum;
    }

    // Squared error with the scales found.
    double error() const {
        double sum = 0.0;
        for (const Sample& s : samples_) sum += std::pow(s.value - predict(s), 2.0);
        return sum;
    }

  private:
    Scale scale_at(const Sample& s) const {
        const int k = std::min(static_cast<int>(s.station), course_.stations - 1);
        return between(scales_[k], scales_[course_.after(k)], s.station - k);
    }
    double predict(const Sample& s) const {
        const Scale scale = scale_at(s);
        return scale.height * profile_.value(s.offset, scale.width);
    }

    // Residuals and derivatives of all samples; returns the squared error.
    double look() {
        double sum = 0.0;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const Sample& s = samples_[i];
            const Scale scale = scale_at(s);
            double by_width = 0.0;
            const double value = profile_.value(s.offset, scale.width, by_width);
            seen_[i] = {{value, scale.height * by_width}, s.value - scale.height * value};
            sum += seen_[i].residual * seen_[i].residual;
        }
        return sum;
    }

    void gather() {
        std::fill(evidence_.begin(), evidence_.end(), Evidence{});
        const double usual = 2.0 * std::sqrt(look() / std::max<std::size_t>(1, samples_.size())) + 1e-9;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const Sample& s = samples_[i];
            const double* const by = seen_[i].by;
            const double residual = seen_[i].residual;
            const double weight = std::min(1.0, usual / std::max(1e-12, std::fabs(residual)));
            const int k = std::min(static_cast<int>(s.station), course_.stations - 1), n = course_.after(k);
            const double share[2] = {1.0 - (s.station - k), s.station - k};
            for (int end : {0, 1}) {
                Evidence& e = evidence_[end == 0 ? k : n];
                const double w = weight * share[end];
                e.own[0] += w * share[end] * by[0] * by[0];
                e.own[1] += w * share[end] * by[0] * by[1];
                e.own[2] += w * share[end] * by[1] * by[1];
                e.gradient[0] += w * by[0] * residual;
                e.gradient[1] += w * by[1] * residual;
            }
            for (int a : {0, 1})
                for (int b : {0, 1}) evidence_[k].next[2 * a + b] += weight * share[0] * share[1] * by[a] * by[b];
        }
    }

    void solve() {
        const int n = course_.stations;
        double mean[2] = {1e-12, 1e-12};
        for (const Evidence& e : evidence_) mean[0] += e.own[0] / n, mean[1] += e.own[2] / n;
        std::vector<std::array<double, 2>> step(n, {0.0, 0.0});
        for (int sweep = 0; sweep < kSweeps; ++sweep)
            for (int k = 0; k < n; ++k) relax(k, mean, step);
        for (int k = 0; k < n; ++k) {
            scales_[k].height = std::clamp(scales_[k].height + step[k][0], 0.0, kMostHeight);
            scales_[k].width = std::clamp(scales_[k].width + step[k][1], kLeastWidth, kMostWidth);
        }
    }

    // Brings one station to rest between its neighbours.
    void relax(int k, const double mean[2], std::vector<std::array<double, 2>>& step) const {
        const int n = course_.stations;
        const int next = course_.closed || k + 1 < n ? (k + 1) % n : -1;
        const int last = course_.closed || k > 0 ? (k + n - 1) % n : -1;
        double right[2] = {evidence_[k].gradient[0], evidence_[k].gradient[1]};
        double diagonal[3] = {evidence_[k].own[0], evidence_[k].own[1], evidence_[k].own[2]};
        const double now[2] = {scales_[k].height, scales_[k].width};
        for (int i : {0, 1}) {
            diagonal[2 * i] += kRest * mean[i];
            right[i] += kRest * mean[i] * (1.0 - now[i]);
            for (int other : {last, next}) {
                if (other < 0) continue;
                const double there = (i == 0 ? scales_[other].height : scales_[other].width) + step[other][i];
                diagonal[2 * i] += kSmoothness * mean[i];
                right[i] += kSmoothness * mean[i] * (there - now[i]);
                for (int j : {0, 1})
                    right[i] -= (other == next ? evidence_[k].next[2 * i + j] : evidence_[other].next[2 * j + i]) *
                                step[other][j];
            }
        }
        const double determinant = diagonal[0] * diagonal[2] - diagonal[1] * diagonal[1];
        if (!(determinant > 1e-30)) return;
        step[k] = {(right[0] * diagonal[2] - right[1] * diagonal[1]) / determinant,
                   (right[1] * diagonal[0] - right[0] * diagonal[1]) / determinant};
    }

    const Course& course_;
    const BlurredProfile& profile_;
    const std::vector<Sample>& samples_;
    struct Seen {
        double by[2] = {0.0, 0.0};  // derivatives by height and width scale
        double residual = 0.0;
    };
    std::vector<Seen> seen_;  // by sample
    std::vector<Scale> scales_;
    std::vector<Evidence> evidence_;
};

// What it costs that a station has other scales than the ones it asks for.
double loss(const Evidence& e, const Scale& wanted, const Scale& given) {
    const double h = given.height - wanted.height, w = given.width - wanted.width;
    return e.own[0] * h * h + 2.0 * e.own[1] * h * w + e.own[2] * w * w;
}

// Fewest stations between which the scales run straight: each costs `cost`. Begins and ends at the ends of the course.
std::vector<int> choose_knots(const std::vector<Scale>& scales, const std::vector<Evidence>& evidence, bool closed,
                              double cost) {
    constexpr int kLongest = 80;  // stations between knots
    const int n = static_cast<int>(scales.size()), last = closed ? n : n - 1;
    std::vector<double> best(last + 1, 1e300);
    std::vector<int> from(last + 1, 0);
    best[0] = 0.0;
    for (int j = 1; j <= last; ++j)
        for (int i = std::max(0, j - kLongest); i < j; ++i) {
            double sum = best[i] + cost;
            for (int k = i + 1; k < j && sum < best[j]; ++k)
                sum += loss(evidence[k], scales[k], between(scales[i], scales[j % n], double(k - i) / (j - i)));
            if (sum < best[j]) best[j] = sum, from[j] = i;
        }
    std::vector<int> knots;
    for (int k = last; k > 0; k = from[k]) knots.push_back(k);
    knots.push_back(0);
    std::reverse(knots.begin(), knots.end());
    return knots;
}

// The elements divided at the knots, with the scales of both their ends.
std::vector<Element> divide(const FittedChain& fitted, const Course& course, const std::vector<Scale>& scales,
                            const std::vector<int>& knots) {
    const int n = static_cast<int>(scales.size());
    const auto scale_at = [&](double place) {
        std::size_t k = 1;
        while (k + 1 < knots.size() && knots[k] * course.spacing() < place) ++k;
        const double a = knots[k - 1] * course.spacing(), b = knots[k] * course.spacing();
        const double t = std::clamp((place - a) / (b - a), 0.0, 1.0);
        return between(scales[knots[k - 1] % n], scales[knots[k] % n], t);
    };
    std::vector<Element> out;
    for (std::size_t i = 0; i < fitted.elements.size(); ++i) {
        const double begin = course.begin[i], end = course.begin[i + 1];
        std::vector<double> cuts{begin};
        for (const int knot : knots) {
            const double place = knot * course.spacing();
            if (place > cuts.back() + kSnap && place < end - kSnap) cuts.push_back(place);
        }
        cuts.push_back(end);
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
            const double l = std::max(1e-12, end - begin);
            Element e = curve::part(fitted.elements[i], (cuts[k] - begin) / l, (cuts[k + 1] - begin) / l);
            if (!out.empty()) e.p0 = out.back().p2;
            const Scale s0 = scale_at(cuts[k]), s1 = scale_at(cuts[k + 1]);
            e.width0 = s0.width, e.width1 = s1.width;
            e.height0 = s0.height, e.height1 = s1.height;
            out.push_back(e);
        }
    }
    if (!out.empty()) out.front().p0 = fitted.elements.front().p0, out.back().p2 = fitted.elements.back().p2;
    return out;
}

double total_loss(const std::vector<Scale>& scales, const std::vector<Evidence>& evidence,
                  const std::vector<int>& knots) {
    const int n = static_cast<int>(scales.size());
    double sum = 0.0;
    for (std::size_t k = 1; k < knots.size(); ++k)
        for (int i = knots[k - 1] + 1; i < knots[k]; ++i)
            sum += loss(evidence[i % n], scales[i % n],
                        between(scales[knots[k - 1] % n], scales[knots[k] % n],
                                double(i - knots[k - 1]) / (knots[k] - knots[k - 1])));
    return sum;
}

// The texels that belong to chain c, and to no other.
std::vector<Sample> take_samples(const FittedChain& fitted, std::uint32_t c, const Course& course, const Image& map,
                                 const Lattice& lattice, const Regions& regions, const std::vector<Owner>& owners,
                                 const std::vector<std::uint8_t>& contested, double reach) {
    std::vector<Sample> samples;
    for (const Piece& piece : flatten(fitted)) {
        const double begin = course.begin[piece.element];
        const double l = course.begin[piece.element + 1] - begin;
        for_each_texel_of_piece(lattice, piece, reach, [&](int texel, const Place& place) {
            const Owner& owner = owners[texel];
            if (owner.chain != c || place.beyond || contested[texel] ||
                std::fabs(place.offset) > static_cast<double>(owner.distance()) + 1e-5)
                return;
            const double t = piece.t0 + (piece.t1 - piece.t0) * place.along;
            samples.push_back({static_cast<float>((begin + t * l) / course.spacing()), static_cast<float>(place.offset),
                               map.texels[texel] - static_cast<float>(regions.level[regions.at(texel)])});
        });
    }
    return samples;
}

void scale_chain(FittedChain& fitted, const Course& course, const BlurredProfile& profile,
                 const std::vector<Sample>& samples, double least_gain) {
    ScaleFit fit(course, profile, samples);
    // Elements with scales take twice the bytes of a plain line: what the map leaves to gain may not be worth that.
    const double plain = fit.plain_error();
    if (plain <= least_gain * static_cast<double>(fitted.elements.size())) return;
    fit.run();
    const std::vector<int> knots = choose_knots(fit.scales(), fit.evidence(), course.closed, least_gain);
    std::vector<Element> elements = divide(fitted, course, fit.scales(), knots);
    const double kept = plain - fit.error() - total_loss(fit.scales(), fit.evidence(), knots);
    const double cost = least_gain * (2.0 * elements.size() - fitted.elements.size());
    if (kept <= cost) return;
    fitted.elements = std::move(elements);
    fitted.gain += kept;
}

}  // namespace

void measure_scales(std::vector<FittedChain>& chains, const ProfileSet& set, const Image& map, const Lattice& lattice,
                    const Regions& regions, const std::vector<Owner>& owners, const ScaleOptions& options) {
    const std::vector<BlurredProfile> profiles(set.profiles.begin(), set.profiles.end());
    const std::vector<std::uint8_t> contested = find_contested(chains, profiles, lattice, owners, options.reach);
    for_each_piece(chains.size(), lattice.threads, [&](std::size_t c) {
        FittedChain& fitted = chains[c];
        if (fitted.chain.kind == ChainKind::step || fitted.elements.empty()) return;
        const BlurredProfile& profile = profiles[fitted.profile];
        const Course course = lay_course(fitted);
        if (course.length() < 2.0 * kStationSpacing) return;
        const double reach = std::min(options.reach, 1.5 * profile.extent(kFoot) + 2.0);
        const std::vector<Sample> samples =
            take_samples(fitted, static_cast<std::uint32_t>(c), course, map, lattice, regions, owners, contested, reach);
        scale_chain(fitted, course, profile, samples, options.least_gain);
    });
}

}  // namespace burin::vectorizing
