// Centre lines and widths from the response across a skeleton, and how widths change along a line.
#include "vectorize_skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

struct Section {
    bool found = false;
    double centre = 0.0, half_width = 0.0, peak = 0.0;
};

// Half-height edges of the response along the normal at p.
Section measure_section(const Image& response, const Lattice& lattice, Vec2 p, Vec2 normal, double reach) {
    constexpr double kStep = 0.25;
    const int n = static_cast<int>(std::ceil(reach / kStep));
    const auto value = [&](int k) { return sample(response, lattice, p + normal * (k * kStep)); };
    Section section;
    int best = 0;
    float peak = value(0);
    const int search = std::min(n, static_cast<int>(1.5 / kStep));
    for (int k = -search; k <= search; ++k) {
        const float v = value(k);
        if (v > peak) peak = v, best = k;
    }
    section.peak = peak;
    const float half = peak * 0.5f;
    if (half <= 0.0f) return section;
    // Where the response falls to half on one side, from the peak outwards.
    const auto edge = [&](int direction, double& at) {
        float inside = peak;
        for (int k = best; std::abs(k) < n;) {
            k += direction;
            const float v = value(k);
            if (!(v > half)) {
                at = k - direction + direction * (inside - half) / (inside - v);
                return true;
            }
            inside = v;
        }
        return false;
    };
    double left = 0.0, right = 0.0;
    if (!edge(-1, left) || !edge(1, right)) return section;
    section.found = true;
    section.centre = 0.5 * (left + right) * kStep;
    section.half_width = 0.5 * (right - left) * kStep;
    return section;
}

// Values along a line.
struct Track {
    std::vector<double> place, value;  // places rise

    void add(double at, double v) { place.push_back(at), value.push_back(v); }
};

struct Trend {
    double value = 0.0, slope = 0.0;
};

// The straight line through the medians of both halves of what lies within `span` of a place: it follows a taper, but not
// crossings and specks. Near an end the window is the end's.
Trend trend_at(const Track& track, double at, double span) {
    const double first = track.place.front(), last = track.place.back();
    const double from = std::clamp(at - span, first, std::max(first, last - 2.0 * span));
    const auto index = [&](double p) { return std::lower_bound(track.place.begin(), track.place.end(), p) - track.place.begin(); };
    const std::ptrdiff_t begin = index(from), end = index(from + 2.0 * span), middle = (begin + end) / 2;
    if (end - begin < 4) return {median(track.value), 0.0};
    const auto median_of = [](const std::vector<double>& v, std::ptrdiff_t i, std::ptrdiff_t j) {
        return median({v.begin() + i, v.begin() + j});
    };
    const double p = median_of(track.place, begin, middle), q = median_of(track.place, middle, end);
    const double v = median_of(track.value, begin, middle), w = median_of(track.value, middle, end);
    const double slope = q > p ? (w - v) / (q - p) : 0.0;
    return {std::max(0.0, v + slope * (at - p)), slope};
}

// Whether a place is clearly narrower or wider than the line is there.
bool differs(double half_width, double usual) { return std::fabs(half_width - usual) >= 0.25 * usual + 0.3; }

// Whether a line is as wide as ever but for an end that widens: it runs into a broader one.
bool widens_at_end(const std::vector<double>& taper, double usual) {
    constexpr double kBroader = 1.6;
    const auto is_narrow = [&](double half_width) { return half_width < usual && differs(half_width, usual); };
    return std::max(taper.front(), taper.back()) > kBroader * usual && std::none_of(taper.begin(), taper.end(), is_narrow);
}

// The half-width at each of `places` along a line that clearly tapers or swells; none for one that does not, and for what
// widens as fast as a blob or two lines that part.
std::vector<double> taper_of(const Track& widths, const std::vector<double>& places) {
    constexpr double kLeastChange = 0.3, kSteepest = 0.1;
    if (widths.value.size() < 8) return {};
    const double usual = median(widths.value), span = 4.0 * usual + 8.0;
    if (widths.place.back() - widths.place.front() < 2.0 * span) return {};
    std::vector<double> taper;
    for (const double place : places) {
        const Trend trend = trend_at(widths, place, span);
        if (std::fabs(trend.slope) > kSteepest) return {};
        taper.push_back(trend.value);
    }
    if (widens_at_end(taper, usual)) return {};
    const auto [least, most] = std::minmax_element(taper.begin(), taper.end());
    return *most - *least < kLeastChange * usual + 0.5 ? std::vector<double>{} : taper;
}

Vec2 smoothed(const std::vector<Vec2>& points, std::ptrdiff_t i, std::ptrdiff_t reach) {
    const std::ptrdiff_t n = static_cast<std::ptrdiff_t>(points.size());
    Vec2 sum;
    double weight = 0.0;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
        const std::ptrdiff_t j = i + k;
        if (j < 0 || j >= n) continue;  // loops are opened: their seam is smoothed one-sidedly
        sum = sum + points[j];
        weight += 1.0;
    }
    return sum * (1.0 / weight);
}

// Beyond the free end of a line lies the inside of a broader one that it runs into: a few of its texels may look like the
// line's own, but they do not hang together with it.
void drop_stray_end(std::vector<Vec2>& points) {
    constexpr std::size_t kFew = 4;
    for (std::size_t k = 1; k < std::min(kFew, points.size() / 2); ++k) {
        const std::size_t last = points.size() - k;
        if (length(points[last] - points[last - 1]) <= kBridge) continue;
        points.resize(last);
        return;
    }
}

void drop_stray_ends(Strand& strand) {
    for (const int end : {1, 0}) {
        if (strand.node[end] < 0 && !strand.loop) drop_stray_end(strand.points);
        std::reverse(strand.points.begin(), strand.points.end());
    }
}

void measure_strand(Strand& strand, const Image& response, const Lattice& lattice,
                    const std::vector<SkeletonNode>& nodes, double reach) {
    const std::ptrdiff_t n = static_cast<std::ptrdiff_t>(strand.texels.size());
    std::vector<Vec2> smooth(strand.texels.size());
    for (std::ptrdiff_t i = 0; i < n; ++i) smooth[i] = smoothed(strand.texels, i, 2);
    std::vector<Section> sections(strand.texels.size());
    std::vector<Vec2> centres(strand.texels.size());
    Track widths;
    std::vector<double> peaks;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
        const std::ptrdiff_t a = std::max<std::ptrdiff_t>(0, i - 3), b = std::min(n - 1, i + 3);
        const Vec2 normal = normal_of(unit(smooth[b] - smooth[a]));
        sections[i] = measure_section(response, lattice, smooth[i], normal, reach);
        centres[i] = smooth[i] + normal * sections[i].centre;
        if (sections[i].found) {
            widths.add(static_cast<double>(i), sections[i].half_width);
            peaks.push_back(sections[i].peak);
        }
    }
    strand.half_width = median(widths.value);
    strand.contrast = median(peaks);
    std::vector<double> places(strand.texels.size());
    std::iota(places.begin(), places.end(), 0.0);
    const std::vector<double> taper = taper_of(widths, places);
    for (std::ptrdiff_t i = 0; i < n; ++i) {
        const double usual = taper.empty() ? strand.half_width : taper[static_cast<std::size_t>(i)];
        const bool steady = sections[i].found && !differs(sections[i].half_width, usual);
        bool near_node = false;
        for (const int node : strand.node)
            if (node >= 0) {
                const Vec2 d = centres[i] + lattice.shift_to(centres[i], nodes[node].position) - nodes[node].position;
                near_node = near_node || length(d) < 1.3 * nodes[node].radius + 1.0;
            }
        if (steady && !near_node) strand.points.push_back(centres[i]);
    }
    drop_stray_ends(strand);
}

}  // namespace

void measure_strands(Skeleton& skeleton, const Image& response, const Lattice& lattice) {
    for_each_piece(skeleton.strands.size(), lattice.threads, [&](std::size_t s) {
        Strand& strand = skeleton.strands[s];
        if (strand.gone) return;
        double widest = 2.0;
        for (const int node : strand.node)
            if (node >= 0) widest = std::max(widest, skeleton.nodes[node].radius);
        measure_strand(strand, response, lattice, skeleton.nodes, std::max(16.0, 3.0 * widest + 4.0));
    });
}

void measure_half_widths(Chain& chain, const Image& response, const Lattice& lattice) {
    constexpr double kNarrow = 1.5;   // texels: below, blur hides what the width does
    constexpr double kSpacing = 2.0;  // texels between places that are measured
    chain.half_widths.clear();
    if (chain.half_width < kNarrow || chain.points.size() < 8) return;
    const double reach = std::max(16.0, 5.0 * chain.half_width);
    const std::size_t n = chain.points.size();
    std::vector<double> place{0.0};
    for (std::size_t i = 1; i < n; ++i) place.push_back(place.back() + length(chain.points[i] - chain.points[i - 1]));
    Track widths;
    for (std::size_t i = 1; i + 1 < n; ++i) {
        if (!widths.place.empty() && place[i] < widths.place.back() + kSpacing) continue;
        const Vec2 along = chain.points[std::min(n - 1, i + 3)] - chain.points[i - std::min<std::size_t>(i, 3)];
        if (along == Vec2{}) continue;
        const Section section = measure_section(response, lattice, chain.points[i], normal_of(unit(along)), reach);
        if (section.found) widths.add(place[i], section.half_width);
    }
    chain.half_widths = taper_of(widths, place);
}

}  // namespace burin::vectorizing
