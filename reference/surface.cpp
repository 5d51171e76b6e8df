#include "surface.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "evaluate_prepare.hpp"

namespace burin::reference {
namespace {

// Values of b that are one and the same line.
constexpr double kSame = 1e-12;

std::uint32_t line_at(const std::vector<double>& lines, double b) {
    const auto found = std::lower_bound(lines.begin(), lines.end(), b - kSame);
    return static_cast<std::uint32_t>(found - lines.begin());
}

std::vector<double> lines_of(const ResolvedProfile& profile) {
    std::vector<double> lines;
    double low = 0.0, high = 0.0;
    for (const ProfilePoint& point : profile.points) {
        lines.push_back(point.b);
        low = std::min(low, point.b);
        high = std::max(high, point.b);
    }
    // Corners and caps treat the two sides of the path each in its own way.
    if (low < 0.0 && high > 0.0) lines.push_back(0.0);
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end(), [](double a, double b) { return b - a <= kSame; }), lines.end());
    return lines;
}

double height_on(const ProfilePoint& p, const ProfilePoint& q, double b) {
    return q.b == p.b ? p.h : p.h + (q.h - p.h) * (b - p.b) / (q.b - p.b);
}

void add_facet(SlabbedProfile& out, const ResolvedProfile& profile, std::uint32_t i) {
    const ProfilePoint p = profile.points[i], q = profile.points[i + 1];
    ProfileFacet facet;
    facet.facet = i;
    facet.internal = ((profile.internal_mask >> i) & 1u) != 0;
    facet.rightward = q.b >= p.b;
    const ProfilePoint &low = facet.rightward ? p : q, &high = facet.rightward ? q : p;
    const std::uint32_t first = line_at(out.lines, low.b), last = line_at(out.lines, high.b);
    const std::uint32_t zero = line_at(out.lines, 0.0);
    facet.from = first, facet.to = last, facet.h0 = low.h, facet.h1 = high.h;
    if (first == last) facet.h0 = p.h, facet.h1 = q.h;
    if (!(low.b < -kSame && high.b > kSame)) return out.facets.push_back(facet);
    const double middle = height_on(p, q, 0.0);
    facet.to = zero, facet.h1 = middle;
    out.facets.push_back(facet);
    facet.from = zero, facet.h0 = middle, facet.to = last, facet.h1 = high.h;
    out.facets.push_back(facet);
}

struct Crossing {
    double at[2];         // heights on the two lines of the slab
    std::uint32_t facet;  // of the profile
    double middle() const { return 0.5 * (at[0] + at[1]); }
};

// Facets over the slab from line to line + 1 among facets [first, last) of the profile, from the lowest.
std::vector<Crossing> crossings(const SlabbedProfile& out, const ResolvedProfile& profile, std::uint32_t line, std::uint32_t first,
                                std::uint32_t last) {
    std::vector<Crossing> found;
    const double b0 = out.lines[line], b1 = out.lines[line + 1], middle = 0.5 * (b0 + b1);
    for (std::uint32_t i = first; i < last; ++i) {
        const ProfilePoint p = profile.points[i], q = profile.points[i + 1];
        if ((p.b <= middle) == (q.b <= middle)) continue;
        found.push_back({{height_on(p, q, b0), height_on(p, q, b1)}, i});
    }
    std::sort(found.begin(), found.end(), [](const Crossing& x, const Crossing& y) { return x.middle() < y.middle(); });
    return found;
}

Slab slab_between(std::uint32_t line, bool cut, const Crossing* bottom, const Crossing* top) {
    Slab slab;
    slab.line = line;
    slab.cut = cut;
    slab.has_bottom = bottom != nullptr;
    slab.has_top = top != nullptr;
    for (int k = 0; k < 2; ++k) {
        if (bottom) slab.bottom[k] = bottom->at[k];
        if (top) slab.top[k] = top->at[k];
    }
    if (bottom) slab.bottom_facet = bottom->facet;
    if (top) slab.top_facet = top->facet;
    return slab;
}

// Added: below an odd number of facets. Cut: above an odd number of facets of one internal run. As evaluate.hpp has it.
void add_slabs(SlabbedProfile& out, const ResolvedProfile& profile, std::uint32_t line) {
    const auto count = static_cast<std::uint32_t>(profile.points.size()) - 1;
    const auto all = crossings(out, profile, line, 0, count);
    for (std::size_t i = all.size(); i > 0; i = i > 2 ? i - 2 : 0)
        out.slabs.push_back(slab_between(line, false, i > 1 ? &all[i - 2] : nullptr, &all[i - 1]));
    for (std::uint32_t i = 0; i < count;) {
        std::uint32_t end = i;
        while (end < count && ((profile.internal_mask >> end) & 1u)) ++end;
        const auto run = crossings(out, profile, line, i, end);
        for (std::size_t k = 0; k < run.size(); k += 2)
            out.slabs.push_back(slab_between(line, true, &run[k], k + 1 < run.size() ? &run[k + 1] : nullptr));
        i = end + 1;
    }
}

}  // namespace

SlabbedProfile slab_profile(const ResolvedProfile& profile) {
    SlabbedProfile out;
    out.lines = lines_of(profile);
    out.first_height = profile.points.front().h;
    out.last_height = profile.points.back().h;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
        add_facet(out, profile, static_cast<std::uint32_t>(i));
        out.height_field = out.height_field && profile.points[i + 1].b >= profile.points[i].b;
    }
    for (std::uint32_t line = 0; line + 1 < out.lines.size(); ++line) add_slabs(out, profile, line);
    out.reach = std::max(-out.lines.front(), out.lines.back());
    return out;
}

namespace {

double spacing_of(const ResolvedPattern& pattern, const CellGrid& grid) {
    std::size_t used = 0;
    for (std::size_t cell = 0; cell + 1 < grid.first_ref.size(); ++cell) used += grid.first_ref[cell + 1] > grid.first_ref[cell];
    const double cell_area = pattern.size.x / grid.cols * (pattern.size.y / grid.rows);
    return std::sqrt(cell_area * static_cast<double>(std::max<std::size_t>(used, 1)) / static_cast<double>(std::max<std::size_t>(grid.refs.size(), 1)));
}

}  // namespace

GroovedSurface::GroovedSurface(const ResolvedPattern& pattern, const CellGrid& grid)
    : pattern_(pattern), grid_(grid), truth_(pattern) {
    for (const ResolvedProfile& profile : pattern.profiles) profiles_.push_back(slab_profile(profile));
    static std::atomic<std::uint64_t> made{0};
    lowest_ = truth_.prepared().lowest;
    id_ = ++made;
    spacing_ = spacing_of(pattern_, grid_);
}
GroovedSurface::~GroovedSurface() = default;
GroovedSurface::GroovedSurface(GroovedSurface&&) noexcept = default;

std::size_t GroovedSurface::bytes() const {
    std::size_t bytes = grid_bytes(grid_) + pattern_.elements.size() * (sizeof(PreparedElement));
    for (const SlabbedProfile& profile : profiles_)
        bytes += profile.lines.size() * sizeof(double) + profile.facets.size() * sizeof(ProfileFacet) + profile.slabs.size() * sizeof(Slab);
    return bytes;
}

}  // namespace burin::reference
