#include <burin/html_report.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

#include <burin/error_map.hpp>
#include <burin/rasterize.hpp>

#include "report_internal.hpp"

namespace burin {
namespace {

using namespace report;

constexpr int kOverviewSide = 1024;  // texels of a picture of the whole map
constexpr int kSpots = 8;
constexpr int kSpotSide = 40;   // texels of a close-up
constexpr int kSpotScale = 8;   // samples per texel of the surface drawn in it

constexpr const char* kStyle = R"(
:root{color-scheme:light}
*{box-sizing:border-box}
body{margin:0;background:#f3f3f0;color:#222;font:15px/1.45 system-ui,"DejaVu Sans",sans-serif}
main{max-width:1400px;margin:0 auto;padding:24px}
h1{font-size:24px;margin:0 0 2px}
h2{font-size:18px;margin:36px 0 8px}
p{margin:4px 0 10px;color:#555;max-width:90ch}
code{font:13px/1.5 ui-monospace,"DejaVu Sans Mono",monospace;overflow-wrap:anywhere}
.tiles{display:flex;flex-wrap:wrap;gap:10px;margin:18px 0 12px}
.tile{background:#fff;border-radius:8px;padding:10px 16px;min-width:130px}
.tile b{display:block;font-size:22px;font-weight:600;font-variant-numeric:tabular-nums}
.tile span{color:#666;font-size:13px}
.shares{display:flex;height:22px;border-radius:6px;overflow:hidden;background:#d8d8d4}
.overview{display:grid;grid-template-columns:repeat(auto-fit,minmax(540px,1fr));gap:16px}
.spot{display:grid;grid-template-columns:repeat(4,1fr);gap:8px;margin-bottom:18px}
.spot h3{grid-column:1/-1;font-size:14px;font-weight:600;margin:4px 0 0}
figure{margin:0;background:#fff;border-radius:8px;overflow:hidden}
figcaption{padding:6px 10px;font-size:13px;color:#444}
.picture{position:relative;line-height:0;overflow:hidden}
.picture img{width:100%;height:auto}
.picture svg{position:absolute;inset:0;width:100%;height:100%}
.spot img{image-rendering:pixelated}
.picture path{fill:none;stroke-width:1.6px;vector-effect:non-scaling-stroke;stroke-linejoin:round}
.spot path{stroke-width:1.4px}
.key{white-space:nowrap;margin-left:10px}
.key i{display:inline-block;width:11px;height:11px;border-radius:2px;margin-right:4px;vertical-align:-1px}
.legend{display:flex;align-items:center;gap:8px;padding:4px 0 2px;font-size:12px;color:#444}
.legend i{flex:1;height:12px;border-radius:3px}
.card{background:#fff;border-radius:8px;padding:14px 18px}
.histogram{width:100%;max-width:900px;font-size:12px;fill:#555;display:block}
table{border-collapse:collapse}
td{padding:3px 22px 3px 0;vertical-align:top}
td:first-child{color:#666;white-space:nowrap}
)";

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '&') safe += "&amp;";
        else if (c == '<') safe += "&lt;";
        else if (c == '>') safe += "&gt;";
        else if (c == '"') safe += "&quot;";
        else if (static_cast<unsigned char>(c) < ' ') safe += ' ';
        else safe += c;
    }
    return safe;
}

std::string percent(double share, int decimals) { return decimal(share * 100.0, decimals) + " %"; }

std::string tile(const std::string& value, const std::string& name) {
    return "<div class=\"tile\"><b>" + value + "</b><span>" + name + "</span></div>";
}

std::string key(const std::string& color, const std::string& name) {
    return "<span class=\"key\"><i style=\"background:" + color + "\"></i>" + name + "</span>";
}

std::string kind_keys() {
    std::string keys;
    for (const PathKind kind : kPathKinds) {
        const auto k = static_cast<std::size_t>(kind);
        keys += key(kKindColors[k], kKindNames[k]);
    }
    return keys;
}

// Pictures of one kind have one scale each; this holds what they share.
struct Scene {
    const HeightMap& map;
    const FoundPattern& found;
    const Image& reconstruction;
    Image error;         // reconstruction - map
    double full = 0.01;  // error in full colour
    double low = 0.0, high = 1.0;
    TexelRegion whole() const { return {0, 0, map.image.width, map.image.height}; }
};

Scene make_scene(const HeightMap& map, const FoundPattern& found, const Image& reconstruction) {
    Scene scene{map, found, reconstruction, Image(map.image.width, map.image.height)};
    for (std::size_t i = 0; i < scene.error.texels.size(); ++i)
        scene.error.texels[i] = reconstruction.texels[i] - map.image.texels[i];
    scene.full = full_error(found.stats.p999);
    const auto [low, high] = std::minmax_element(map.image.texels.begin(), map.image.texels.end());
    scene.low = static_cast<double>(*low);
    scene.high = static_cast<double>(*high);
    return scene;
}

RgbaImage color_error(const Image& error, double full) {
    return draw_error(error, Image(error.width, error.height, 0.0f), full);
}

// A picture with its name; `over` is laid over it, `below` explains it.
Result<std::string> figure(const RgbaImage& picture, const std::string& name, const std::string& over = "",
                           const std::string& below = "") {
    const auto image = image_tag(picture, name);
    if (!image) return image.error();
    return "<figure><div class=\"picture\">" + *image + over + "</div><figcaption>" + name + below +
           "</figcaption></figure>\n";
}

// Collects parts; the first failure is the answer.
class Page {
  public:
    void add(const std::string& part) { text_ += part; }
    void add(const Result<std::string>& part) {
        if (part) text_ += *part;
        else if (status_) status_ = part.error();
    }
    Result<std::string> text() const {
        if (!status_) return status_.error();
        return text_;
    }

  private:
    std::string text_;
    Status status_ = Done{};
};

std::string head(const Scene& scene, const ReportText& text, const Residual* residual) {
    const ConvertStats& stats = scene.found.stats;
    const ExplainedShares& shares = stats.shares;
    const std::size_t bytes = stats.grid_bytes + stats.data_bytes + (residual ? residual->png.size() : 0);
    std::string page = "<h1>" + escaped(text.title) + "</h1><p>" + std::to_string(scene.map.image.width) + " x " +
                       std::to_string(scene.map.image.height) + " texels, " + scene.map.format + ", " +
                       std::to_string(scene.map.bit_depth) + " bits, channel " + escaped(scene.map.channel) +
                       "</p><div class=\"tiles\">" + tile(percent(std::floor(stats.explained * 1e4) / 1e4, 2), "of the detail explained") +
                       tile(percent(stats.rms, 3), "RMS height error") +
                       tile(percent(stats.p999, 2), "99.9th percentile of the error") +
                       tile(std::to_string(stats.paths), "paths") +
                       tile(std::to_string(stats.lines + stats.quadratics), "elements") +
                       tile(decimal(static_cast<double>(bytes) / 1024.0, 1) + " KiB", residual ? "both textures and the residual" : "both textures") + "</div>";
    const auto part = [](double share, const char* color) {
        return "<div style=\"width:" + decimal(100.0 * std::clamp(share, 0.0, 1.0), 3) + "%;background:" + color + "\"></div>";
    };
    const std::string lines = kKindColors[0], steps = kKindColors[2];
    page += "<div class=\"shares\">" + part(shares.steps, kKindColors[2]) + part(shares.lines, kKindColors[0]) +
            "</div><p>" + key(steps, "steps and levels explain " + percent(shares.steps, 2)) +
            key(lines, "grooves and ridges on top " + percent(shares.lines, 2)) +
            key("#d8d8d4", "left by the paths " + percent(shares.left, 4)) + "</p>";
    for (const std::string& note : text.notes) page += "<p>" + escaped(note) + "</p>";
    return page;
}

std::string error_legend(double full) {
    std::string stops;
    for (int i = -8; i <= 8; ++i) {
        const std::uint32_t c = error_color(i / 8.0);
        stops += ",rgb(" + std::to_string(c >> 16) + "," + std::to_string(c >> 8 & 255u) + "," +
                 std::to_string(c & 255u) + ")";
    }
    return "<div class=\"legend\"><span>" + percent(full, 2) + " too low</span><i style=\"background:linear-gradient(90deg" +
           stops + ")\"></i><span>" + percent(full, 2) + " of range too high</span></div>";
}

void add_overview(const Scene& scene, Page& page) {
    const Image map = shrink(scene.map.image, kOverviewSide, Shrink::mean);
    const RgbaImage grey = draw_grey(map, scene.low, scene.high);
    const Image built = shrink(scene.reconstruction, kOverviewSide, Shrink::mean);
    const Image error = shrink(scene.error, kOverviewSide, Shrink::farthest);
    page.add("<h2>The whole map</h2><div class=\"overview\">");
    page.add(figure(grey, "the map"));
    page.add(figure(draw_grey(built, scene.low, scene.high), "what the paths make of it"));
    page.add(figure(color_error(error, scene.full), "error", "", error_legend(scene.full)));
    page.add(figure(grey, "paths over the map", draw_paths(scene.found.pattern, scene.map.image, scene.whole()), kind_keys()));
    page.add("</div>");
}

// Normals with and without the residual, and the residual.
void add_residual(const Residual* residual, Page& page) {
    if (residual == nullptr) return;
    const auto degrees = [](double angle) { return decimal(angle, 2) + "°"; };
    page.add("<h2>Normals</h2><div class=\"tiles\">" + tile(degrees(residual->error_without), "RMS angle to the map's, paths alone") +
             tile(degrees(residual->error), "with the residual") + "</div>");
    const RgbaImage& picture = residual->picture;
    if (picture.width == 0) {
        page.add("<p>No residual normal map: none is needed, or none that is allowed helps.</p>");
        return;
    }
    page.add("<div class=\"overview\" style=\"max-width:690px\">");
    page.add(figure(picture, "residual normal map: what the paths leave out", "",
                    ", " + std::to_string(picture.width) + " x " + std::to_string(picture.height) + " texels, " +
                        decimal(static_cast<double>(residual->png.size()) / 1024.0, 1) + " KiB, a full channel is a slope of " +
                        decimal(residual->scale, 3)));
    page.add("</div>");
}

// The surface itself, sampled eight times finer than the map: what a close view shows.
Image surface_of(const ResolvedPattern& pattern, const Scene& scene, const TexelRegion& region, int threads) {
    RasterizeOptions options;
    options.samples = 2;
    options.threads = threads;
    options.level_tolerance = 4e-5;  // as reconstruct_heights
    options.region = {region.x * kSpotScale, region.y * kSpotScale, region.width * kSpotScale,
                      region.height * kSpotScale};
    return rasterize_height(pattern, scene.map.image.width * kSpotScale, scene.map.image.height * kSpotScale, options);
}

void add_spot(const Scene& scene, const Spot& spot, const ResolvedPattern& surface, int threads, Page& page) {
    const Image map = crop(scene.map.image, spot.region), built = crop(scene.reconstruction, spot.region);
    const auto [low, high] = std::minmax_element(map.texels.begin(), map.texels.end());
    const auto grey = [&, l = static_cast<double>(*low), h = static_cast<double>(*high)](const Image& heights) {
        return draw_grey(heights, l, h);
    };
    const std::string paths = draw_paths(scene.found.pattern, scene.map.image, spot.region);
    page.add("<div class=\"spot\"><h3>texel " + std::to_string(spot.x) + ", " + std::to_string(spot.y) + ": " +
             percent(std::abs(spot.error), 2) + " of range too " + (spot.error > 0.0 ? "high" : "low") + "</h3>");
    page.add(figure(grey(map), "map", paths));
    page.add(figure(grey(built), "reconstruction", paths));
    page.add(figure(color_error(crop(scene.error, spot.region), scene.full), "error", paths));
    page.add(figure(grey(surface_of(surface, scene, spot.region, threads)), "the surface, 8 times finer"));
    page.add("</div>\n");
}

void add_spots(const Scene& scene, const ResolvedPattern& surface, int threads, Page& page) {
    const std::vector<Spot> spots = worst_spots(scene.error, kSpotSide, kSpots);
    if (spots.empty()) return;
    page.add("<h2>Where it errs most</h2><p>The worst places first, each " + std::to_string(kSpotSide) +
             " texels wide at most, black and white stretched to what is there;" + kind_keys() + ".</p>" +
             error_legend(scene.full));
    for (const Spot& spot : spots) add_spot(scene, spot, surface, threads, page);
}

std::string fits_section(const Scene& scene) {
    if (scene.found.pattern.paths.empty()) return "";
    return "<h2>How well the cross-sections fit</h2><p>Length of path by the RMS height error across its section, in % of "
           "range:" + kind_keys() + ".</p><div class=\"card\">" +
           draw_histogram(fit_of_sections(scene.found.pattern, scene.error)) + "</div>";
}

std::string figures_section(const ReportText& text) {
    std::string page = "<h2>Figures</h2><div class=\"card\"><table>";
    for (const auto& [name, value] : text.figures)
        page += "<tr><td>" + escaped(name) + "</td><td>" + escaped(value) + "</td></tr>";
    return page + "</table></div><h2>Made by</h2><p><code>" + escaped(text.command) + "</code><br>" +
           escaped(text.version) + "</p>";
}

}  // namespace

Result<std::string> write_html_report(const HeightMap& map, const FoundPattern& found, const Image& reconstruction,
                                      const ReportText& text, const Residual* residual, int threads) {
    assert(reconstruction.width == map.image.width && reconstruction.height == map.image.height);
    const auto unpacked = unpack_textures(found.textures, found.detail);
    if (!unpacked) return unpacked.error();
    const Scene scene = make_scene(map, found, reconstruction);
    Page page;
    page.add("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
             "content=\"width=device-width\"><title>" + escaped(text.title) + "</title><style>" + kStyle);
    for (std::size_t kind = 0; kind < 3; ++kind)
        page.add(std::string(".") + kKindNames[kind] + "{stroke:" + kKindColors[kind] + "}\n");
    page.add("</style></head><body><main>" + head(scene, text, residual));
    add_overview(scene, page);
    add_residual(residual, page);
    add_spots(scene, unpacked->pattern, threads, page);
    page.add(fits_section(scene) + figures_section(text) + "</main></body></html>\n");
    return page.text();
}

}  // namespace burin
