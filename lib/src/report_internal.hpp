// Parts of the report's page. Private to lib; the page itself is html_report.cpp.
#pragma once

#include <string>
#include <vector>

#include <burin/image.hpp>
#include <burin/image_io.hpp>
#include <burin/pattern.hpp>
#include <burin/rasterize.hpp>
#include <burin/result.hpp>

namespace burin::report {

// Colours of the kinds of paths, as PathKind counts them, and their names.
inline constexpr const char* kKindColors[] = {"#00a3d9", "#f08c00", "#d61f9c"};
inline constexpr const char* kKindNames[] = {"grooves", "ridges", "steps"};

// "12.5", with at most that many decimals.
std::string decimal(double value, int decimals);

// <img> of a picture that lies in the page. Fails as encode_png.
Result<std::string> image_tag(const RgbaImage& picture, const std::string& description);

// Heights as grey, `low` black and `high` white.
RgbaImage draw_grey(const Image& heights, double low, double high);
// The part of an image that lies in the region.
Image crop(const Image& image, const TexelRegion& region);
// At most `most` texels a side, each of a block of texels: their mean, or the value farthest from 0.
enum class Shrink { mean, farthest };
Image shrink(const Image& image, int most, Shrink how);

// Windows of at most `side` texels around the texels that err most, the worst first; none overlap.
struct Spot {
    TexelRegion region;
    int x = 0, y = 0;    // the texel that errs most
    double error = 0.0;  // there, signed
};
std::vector<Spot> worst_spots(const Image& error, int side, int most);

// SVG of the paths within the region, in texels, to be laid over a picture of it.
std::string draw_paths(const Pattern& pattern, const Image& map, const TexelRegion& region);

// How far the reconstruction lies from the map across one path: root mean square over its strip.
struct SectionFit {
    PathKind kind = PathKind::groove;
    double rms = 0.0;     // share of the range
    double length = 0.0;  // of the path, texels
};
std::vector<SectionFit> fit_of_sections(const Pattern& pattern, const Image& error);
// Stacked bars: length of path by `rms`, a colour for each kind.
std::string draw_histogram(const std::vector<SectionFit>& fits);

}  // namespace burin::report
