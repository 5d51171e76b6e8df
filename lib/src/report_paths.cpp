// Paths of the report: drawn over pictures, and how well their cross-sections fit.
#include <algorithm>
#include <array>
#include <cmath>

#include "report_internal.hpp"
#include "resolve_curve.hpp"

namespace burin::report {
namespace {

Element in_texels(const Element& e, double scale, Vec2 shift) {
    Element scaled = e;
    scaled.p0 = e.p0 * scale + shift;
    scaled.p1 = e.p1 * scale + shift;
    scaled.p2 = e.p2 * scale + shift;
    return scaled;
}

bool meets(const Box& box, const TexelRegion& region) {
    return box.high.x >= region.x && box.low.x <= region.x + region.width && box.high.y >= region.y &&
           box.low.y <= region.y + region.height;
}

std::string point_text(Vec2 p) { return decimal(p.x, 2) + " " + decimal(p.y, 2); }

// The elements that meet the region, each run of neighbours as one stroke.
std::string stroke_data(const Path& path, double scale, Vec2 shift, const TexelRegion& region) {
    std::string data;
    bool drawing = false;
    for (const Element& metres : path.elements) {
        const Element e = in_texels(metres, scale, shift);
        if (!meets(curve::control_box(e), region)) {
            drawing = false;
            continue;
        }
        if (!drawing) data += "M" + point_text(e.p0);
        data += e.kind == ElementKind::line ? "L" : "Q" + point_text(e.p1) + " ";
        data += point_text(e.p2);
        drawing = true;
    }
    return data;
}

// Where copies of the pattern lie: one tile around, when it repeats.
std::vector<Vec2> tile_shifts(const Pattern& pattern, const Image& map) {
    std::vector<Vec2> shifts{{0.0, 0.0}};
    if (pattern.wrap == Wrap::clamp) return shifts;
    for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u)
            if (u != 0 || v != 0) shifts.push_back({u * static_cast<double>(map.width), v * static_cast<double>(map.height)});
    return shifts;
}

// Adds the squares of the errors across one point of a path.
struct Sum {
    double squares = 0.0, count = 0.0;
    void add_across(const Image& error, Wrap wrap, Vec2 at, Vec2 normal, double from, double to) {
        const int steps = std::max(1, static_cast<int>(std::ceil(to - from)));
        for (int i = 0; i <= steps; ++i) {
            const Vec2 p = at + normal * (from + (to - from) * i / steps);
            long x = static_cast<long>(std::floor(p.x)), y = static_cast<long>(std::floor(p.y));
            if (wrap == Wrap::repeat) {
                x = ((x % error.width) + error.width) % error.width;
                y = ((y % error.height) + error.height) % error.height;
            } else if (x < 0 || y < 0 || x >= error.width || y >= error.height) {
                continue;
            }
            const double e = static_cast<double>(error.at(static_cast<int>(x), static_cast<int>(y)));
            squares += e * e;
            count += 1.0;
        }
    }
};

SectionFit fit_of(const Pattern& pattern, const Path& path, const Image& error) {
    const double scale = error.width / pattern.size.x;
    const auto& points = pattern.profiles[path.profile].points;
    SectionFit fit{path_kind(pattern, path)};
    Sum sum;
    for (const Element& metres : path.elements) {
        const Element e = in_texels(metres, scale, {});
        const double length = curve::arc_length(e);
        fit.length += length;
        const int steps = std::max(1, static_cast<int>(std::ceil(length)));
        for (int i = 0; i < steps; ++i) {
            const double s = (i + 0.5) / steps, width = (e.width0 + (e.width1 - e.width0) * s) * scale;
            sum.add_across(error, pattern.wrap, curve::point(e, s), normal_of(curve::tangent(e, s)),
                           points.front().b * width, points.back().b * width);
        }
    }
    fit.rms = sum.count > 0.0 ? std::sqrt(sum.squares / sum.count) : 0.0;
    return fit;
}

constexpr int kBars = 30;

// The error at which the last bar ends: all but 2 % of the length of path lies below it, or it is counted into it.
double histogram_end(std::vector<SectionFit> fits) {
    std::sort(fits.begin(), fits.end(), [](const SectionFit& a, const SectionFit& b) { return a.rms < b.rms; });
    double total = 0.0, below = 0.0;
    for (const SectionFit& fit : fits) total += fit.length;
    for (const SectionFit& fit : fits) {
        below += fit.length;
        if (below >= 0.98 * total) return std::max(fit.rms * 1.05, 1e-5);
    }
    return 1e-5;
}

std::string bar(double x, double y, double width, double height, const char* color) {
    return "<rect x=\"" + decimal(x, 1) + "\" y=\"" + decimal(y, 1) + "\" width=\"" + decimal(width, 1) +
           "\" height=\"" + decimal(height, 1) + "\" fill=\"" + color + "\"/>";
}

std::string label(double x, double y, const std::string& text) {
    return "<text x=\"" + decimal(x, 1) + "\" y=\"" + decimal(y, 1) + "\">" + text + "</text>";
}

}  // namespace

std::string draw_paths(const Pattern& pattern, const Image& map, const TexelRegion& region) {
    const double scale = map.width / pattern.size.x;
    std::array<std::string, 3> strokes;
    for (const Vec2 shift : tile_shifts(pattern, map))
        for (const Path& path : pattern.paths)
            strokes[static_cast<std::size_t>(path_kind(pattern, path))] += stroke_data(path, scale, shift, region);
    std::string svg = "<svg viewBox=\"" + std::to_string(region.x) + " " + std::to_string(region.y) + " " +
                      std::to_string(region.width) + " " + std::to_string(region.height) + "\">";
    for (const PathKind kind : {PathKind::step, PathKind::ridge, PathKind::groove}) {
        const auto k = static_cast<std::size_t>(kind);
        if (!strokes[k].empty())
            svg += std::string("<path class=\"") + kKindNames[k] + "\" d=\"" + strokes[k] + "\"/>";
    }
    return svg + "</svg>";
}

std::vector<SectionFit> fit_of_sections(const Pattern& pattern, const Image& error) {
    std::vector<SectionFit> fits;
    for (const Path& path : pattern.paths) fits.push_back(fit_of(pattern, path, error));
    return fits;
}

std::string draw_histogram(const std::vector<SectionFit>& fits) {
    constexpr double kWidth = 720.0, kHeight = 160.0, kBottom = 24.0;
    const double end = histogram_end(fits);
    std::array<std::array<double, kBars>, 3> lengths{};
    std::array<double, kBars> sums{};
    for (const SectionFit& fit : fits) {
        const auto i = static_cast<std::size_t>(std::min(kBars - 1, static_cast<int>(fit.rms / end * kBars)));
        lengths[static_cast<std::size_t>(fit.kind)][i] += fit.length;
        sums[i] += fit.length;
    }
    const double highest = std::max(*std::max_element(sums.begin(), sums.end()), 1e-9);
    std::string svg = "<svg class=\"histogram\" viewBox=\"0 0 " + decimal(kWidth, 0) + " " +
                      decimal(kHeight + kBottom, 0) + "\">";
    const double step = kWidth / kBars;
    for (std::size_t i = 0; i < kBars; ++i) {
        double top = kHeight;
        for (std::size_t kind = 0; kind < 3; ++kind) {
            const double height = lengths[kind][i] / highest * (kHeight - 4.0);
            if (height <= 0.0) continue;
            top -= height;
            svg += bar(static_cast<double>(i) * step + 1.0, top, step - 2.0, height, kKindColors[kind]);
        }
    }
    svg += bar(0.0, kHeight, kWidth, 1.0, "#999");
    for (const double at : {0.0, 0.25, 0.5, 0.75})
        svg += label(at * kWidth + 1.0, kHeight + 17.0, decimal(at * end * 100.0, 3) + " %");
    return svg + "<text x=\"" + decimal(kWidth, 1) + "\" y=\"" + decimal(kHeight + 17.0, 1) +
           "\" text-anchor=\"end\">" + decimal(end * 100.0, 3) + " % and more</text></svg>";
}

}  // namespace burin::report
