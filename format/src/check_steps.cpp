// 3010: the ground rule finds a region's level by the step path lines that it crosses, so every cell that
// such a line passes through must list it. Sampled along each line; a cell is only judged where the sample
// lies well inside it.
#include <algorithm>
#include <cmath>

#include "texture_check.hpp"

namespace burin {
namespace {

constexpr double kSamplesPerCell = 8.0;
constexpr double kInset = 0.05;  // of a cell: nearer to its border a line need not count as inside
constexpr std::size_t kEnoughFindings = 64;  // keeps a hostile file from costing elements times cells

struct Place {
    double u, v;
};

Place place_at(const ElementCode& e, double s) {
    const double u0 = decode_coordinate(e.p0.u), v0 = decode_coordinate(e.p0.v);
    const double u2 = decode_coordinate(e.p2.u), v2 = decode_coordinate(e.p2.v);
    if (!e.quadratic) return {u0 + (u2 - u0) * s, v0 + (v2 - v0) * s};
    const double u1 = decode_coordinate(e.p1.u), v1 = decode_coordinate(e.p1.v), r = 1.0 - s;
    return {r * r * u0 + 2.0 * r * s * u1 + s * s * u2, r * r * v0 + 2.0 * r * s * v1 + s * s * v2};
}

// Cell index along one axis, -1 where the sample does not count.
int cell_along(double uv, int cells, bool repeat) {
    const double at = (repeat ? uv - std::floor(uv) : uv) * cells, inside = at - std::floor(at);
    if (at < 0.0 || at >= cells || inside < kInset || inside > 1.0 - kInset) return -1;
    return static_cast<int>(at);
}

bool lists_element(const PackedTextures& textures, const CellCode& c, std::uint32_t texel) {
    const std::uint32_t begin = list_begin(textures.sections, c), end = std::min(begin + c.count, textures.sections.references());
    for (std::uint32_t k = begin; k < end; ++k) {
        if (list_reference(textures, k) == texel) return true;
    }
    return false;
}

double length_in_cells(const ElementCode& e, int cols, int rows) {
    const Place a = place_at(e, 0.0), m = place_at(e, 0.5), b = place_at(e, 1.0);
    return 1.5 * (std::hypot((m.u - a.u) * cols, (m.v - a.v) * rows) +
                  std::hypot((b.u - m.u) * cols, (b.v - m.v) * rows));
}

// Returns the number of findings on this element.
std::size_t check_line(const PackedTextures& textures, bool repeat, const ElementCode& e, std::uint32_t texel,
                       Reporter& reporter) {
    const int cols = textures.grid_width, rows = textures.grid_height;
    const int samples = 2 + static_cast<int>(length_in_cells(e, cols, rows) * kSamplesPerCell);
    int last_i = -1, last_j = -1;
    std::size_t findings = 0;
    for (int k = 0; k <= samples && findings < kEnoughFindings; ++k) {
        const Place p = place_at(e, static_cast<double>(k) / samples);
        const int i = cell_along(p.u, cols, repeat), j = cell_along(p.v, rows, repeat);
        if (i < 0 || j < 0 || (i == last_i && j == last_j)) continue;
        last_i = i, last_j = j;
        const CellCode c = unpack_cell(
            cell_texel(textures, static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(cols) +
                                     static_cast<std::uint32_t>(i)));
        const bool listed = lists_element(textures, c, texel);
        if (listed && (c.flags & BURIN_CELL_FLAG_STEP) != 0) continue;
        ++findings;
        reporter.report(3010,
                        std::string("the path line of the step element at texel ") + std::to_string(texel) +
                            " passes through the cell, which " +
                            (listed ? "lacks flag STEP" : "does not list it"),
                        "cell (" + std::to_string(i) + "," + std::to_string(j) + ")");
    }
    return findings;
}

}  // namespace

void check_steps(const PackedTextures& textures, const PathDetail& detail, const DecodedData& data,
                 Reporter& reporter) {
    std::size_t findings = 0;
    for (std::size_t n = 0; n < data.elements.size() && findings < kEnoughFindings; ++n) {
        const StyleCode* style = data.style_of(data.elements[n]);
        if (style == nullptr || !style->step) continue;
        findings += check_line(textures, detail.repeat, data.elements[n], data.element_texel[n], reporter);
    }
}

}  // namespace burin
