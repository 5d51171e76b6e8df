// Question: how good is the cell size that build_grid chooses? The time of a view against the size of cells at several angles
// (the figure 14 of 2010), as a table and, with --pictures, as grid_SCENE.svg.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <burin/image_io.hpp>

#include "questions.hpp"
#include "timing.hpp"

namespace burin::bench {
namespace {

constexpr double kAngles[] = {0.0, 30.0, 60.0, 80.0};  // off the normal
constexpr double kFactors[] = {0.25, 0.35, 0.5, 0.71, 1.0, 1.41, 2.0, 2.83, 4.0};

struct Curve {
    std::vector<double> factors, times;  // of the chosen cell size; ns per pixel
    std::vector<bool> alike;             // the picture is that of the chosen size
};

// How far a pixel spans is counted in cells, so that with smaller ones the prefilter, which is coarser, may stand in for areas: then
// the time says nothing.
bool look_alike(const RgbaImage& a, const RgbaImage& b) {
    constexpr double kMost = 1.5;  // of 255, root mean square
    double sum = 0.0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) sum += std::pow(double(a.texels[i]) - double(b.texels[i]), 2.0);
    return sum <= kMost * kMost * double(a.texels.size());
}

std::string svg_of(const std::vector<Curve>& curves) {
    constexpr double kWide = 480.0, kHigh = 300.0, kEdge = 40.0;
    double most = 0.0;
    for (const Curve& curve : curves)
        for (const double time : curve.times) most = std::max(most, time);
    const auto x_of = [&](double factor) { return kEdge + (kWide - 2 * kEdge) * (std::log2(factor) + 2.0) / 4.0; };
    const auto y_of = [&](double time) { return kHigh - kEdge - (kHigh - 2 * kEdge) * time / most; };
    std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' width='480' height='300' font-family='sans-serif' font-size='11'>\n";
    char row[200];
    std::snprintf(row, sizeof row, "<path d='M%g %g V%g H%g' fill='none' stroke='#888'/>\n", kEdge, kEdge, kHigh - kEdge, kWide - kEdge);
    svg += row;
    constexpr const char* kColors[] = {"#762a83", "#1b7837", "#2166ac", "#b2182b"};
    for (std::size_t k = 0; k < curves.size(); ++k) {
        svg += std::string("<polyline fill='none' stroke='") + kColors[k] + "' points='";
        for (std::size_t i = 0; i < curves[k].times.size(); ++i) {
            std::snprintf(row, sizeof row, "%.1f,%.1f ", x_of(curves[k].factors[i]), y_of(curves[k].times[i]));
            svg += row;
        }
        std::snprintf(row, sizeof row, "'/>\n<text x='%g' y='%g' fill='%s'>%g degrees</text>\n", kEdge + 8, kEdge + 14.0 * double(k), kColors[k], kAngles[k]);
        svg += row;
    }
    for (const double factor : {0.25, 0.5, 1.0, 2.0, 4.0}) {
        std::snprintf(row, sizeof row, "<text x='%.1f' y='%g' text-anchor='middle'>%g</text>\n", x_of(factor), kHigh - kEdge + 16, factor);
        svg += row;
    }
    std::snprintf(row, sizeof row, "<text x='%g' y='%g' text-anchor='middle'>cell size over the chosen one; at the top %.0f ns per pixel</text>\n</svg>\n",
                  kWide / 2, kHigh - 6, most);
    return svg + row;
}

PlaneView view_from(const Settings& settings, const Subject& subject, double angle) {
    PlaneView view = standard_views(subject, settings.quick ? 256 : 400, settings.quick ? 192 : 300)[1];
    view.elevation = 90.0 - angle;
    return view;
}

struct Size {
    double factor;
    Subject subject;
};

std::vector<Size> sizes_of(const Subject& chosen) {
    const double own = chosen.prepared.resolved.size.x / chosen.prepared.textures.grid_width;
    std::vector<Size> sizes;
    for (const double factor : kFactors) {
        auto subject = prepare_subject(chosen.name, chosen.scene, chosen.index, {.cell_size = factor == 1.0 ? 0.0 : own * factor});
        if (subject) sizes.push_back({factor, std::move(*subject)});  // else such cells would list too many elements
    }
    return sizes;
}

// The sizes take turns, so that what else the machine does falls on all of them.
Curve curve_of(const Settings& settings, const std::vector<Size>& sizes, const PlaneView& view, Antialiasing antialiasing) {
    std::vector<Asset> assets;
    for (const Size& size : sizes) assets.push_back(asset_of(size.subject, extent_of(view, size.subject.prepared.resolved)));
    RenderOptions options = options_of(view, sizes[0].subject.prepared.resolved.size);
    options.backend = settings.backend;
    options.antialiasing = antialiasing;
    std::vector<PassTimer> timers;
    std::vector<RgbaImage> pictures;
    for (const Asset& asset : assets) {
        timers.emplace_back(asset, options);
        const auto picture = render_asset(asset, options);
        pictures.push_back(picture ? *picture : RgbaImage{});
    }
    std::size_t own = 0;
    while (sizes[own].factor != 1.0) ++own;
    for (int k = 0; k < (settings.quick ? 3 : 5); ++k)
        for (PassTimer& timer : timers) timer.try_once();
    Curve curve;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        curve.factors.push_back(sizes[i].factor);
        curve.times.push_back(timers[i].seconds() / (view.width * view.height) * 1e9);
        curve.alike.push_back(pictures[i].texels.size() == pictures[own].texels.size() && look_alike(pictures[i], pictures[own]));
    }
    return curve;
}

void print(const std::string& scene, const char* filter, double angle, const Curve& curve) {
    std::printf("| %s | %s | %g ", scene.c_str(), filter, angle);
    double best = 1e300, of_own = 0.0;
    for (std::size_t i = 0; i < curve.times.size(); ++i)
        if (curve.alike[i]) best = std::min(best, curve.times[i]);
    for (const double factor : kFactors) {
        const auto found = std::find(curve.factors.begin(), curve.factors.end(), factor);
        if (found == curve.factors.end()) {
            std::printf("| ");
            continue;
        }
        const std::size_t at = std::size_t(found - curve.factors.begin());
        if (factor == 1.0) of_own = curve.times[at];
        std::printf(curve.alike[at] ? "| %.0f " : "| (%.0f) ", curve.times[at]);
    }
    std::printf("| %.2f |\n", of_own / best);
    std::fflush(stdout);
}

void print_bytes(const std::string& scene, const std::vector<Size>& sizes) {
    std::printf("| %s | kB | ", scene.c_str());
    for (const double factor : kFactors) {
        const auto found = std::find_if(sizes.begin(), sizes.end(), [&](const Size& size) { return size.factor == factor; });
        std::printf("| ");
        if (found == sizes.end()) continue;
        const PackedTextures& textures = found->subject.prepared.textures;
        std::printf("%.1f ", 4.0 * double(textures.grid.size() + textures.data.size()) / 1000.0);
    }
    std::printf("| |\n");
}

void draw(const Settings& settings, const std::string& scene, const std::vector<Curve>& curves) {
    if (settings.pictures.empty()) return;
    const std::string svg = svg_of(curves);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(svg.data());
    if (Status written = write_file(settings.pictures + "/grid_" + scene + ".svg", {bytes, svg.size()}); !written)
        std::fprintf(stderr, "%s\n", written.error().message.c_str());
}

void measure(const Settings& settings, const Subject& chosen) {
    const std::vector<Size> sizes = sizes_of(chosen);
    print_bytes(chosen.name, sizes);
    constexpr struct {
        const char* name;
        Antialiasing antialiasing;
    } kFilters[] = {{"rays", Antialiasing::points}, {"areas", Antialiasing::regions}};
    for (const auto& filter : kFilters) {
        std::vector<Curve> curves;
        for (const double angle : kAngles) {
            curves.push_back(curve_of(settings, sizes, view_from(settings, chosen, angle), filter.antialiasing));
            print(chosen.name, filter.name, angle, curves.back());
        }
        draw(settings, chosen.name + "_" + filter.name, curves);
    }
}

}  // namespace

void ask_grid(const Settings& settings) {
    std::printf("\n### Cell size\n\nProcessor time of a pixel and sample, ns, at cell sizes over the chosen one (a gap: more elements in a cell than the format allows;\n"
                "in brackets: another picture, since the prefilter stands in), and the bytes of both textures.\n\n| scene | filter | degrees |");
    for (const double factor : kFactors) std::printf(" %g |", factor);
    std::printf(" chosen over best |\n|---|---|--:|");
    for (std::size_t i = 0; i <= std::size(kFactors); ++i) std::printf("--:|");
    std::printf("\n");
    for_each_subject(settings, [&](const Subject& subject) {
        // Of small patterns the cells are few whatever their size.
        if (settings.scene.empty() && subject.prepared.resolved.elements.size() < 60) return;
        measure(settings, subject);
    });
}

}  // namespace burin::bench
