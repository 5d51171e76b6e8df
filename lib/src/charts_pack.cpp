// Borders of charts as texels: records, then a grid of lists.
#include <burin/charts.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "layout.h"

namespace burin {
namespace {

constexpr int kMostCells = 256;  // per side

// A border thickened by as far as its crease moves it, over the cells.
struct Stretch {
    Vec2 begin, end;
    double margin;
};

Stretch stretch_of(const ChartBorder& border, double depth) {
    const double lean = std::tan(0.5 * std::abs(border.angle)) / border.scale;
    // Rounding of what the shader does with it.
    const double rounding = 1e-3 * length(border.end - border.begin);
    // Its corners lie farther off than its sides.
    return {border.begin, border.end, 1.5 * depth * lean + rounding};
}

ChartLayout lay_out(const std::vector<Stretch>& all) {
    Vec2 low = all[0].begin, high = low;
    for (const Stretch& s : all)
        for (const Vec2 p : {s.begin, s.end}) {
            low = {std::min(low.x, p.x - s.margin), std::min(low.y, p.y - s.margin)};
            high = {std::max(high.x, p.x + s.margin), std::max(high.y, p.y + s.margin)};
        }
    const Vec2 span{std::max(high.x - low.x, 1e-9), std::max(high.y - low.y, 1e-9)};
    const double side = std::sqrt(span.x * span.y / double(all.size()));
    ChartLayout layout;
    layout.borders = static_cast<int>(all.size());
    layout.columns = static_cast<int>(std::clamp(std::ceil(span.x / side), 1.0, double(kMostCells)));
    layout.rows = static_cast<int>(std::clamp(std::ceil(span.y / side), 1.0, double(kMostCells)));
    layout.origin = {low.x, low.y};
    layout.cell = {span.x / layout.columns, span.y / layout.rows};
    return layout;
}

// Whether a thickened segment comes into a rectangle: no axis, nor the segment's normal, parts them.
bool meets(const Stretch& s, Vec2 low, Vec2 high) {
    if (std::max(s.begin.x, s.end.x) + s.margin < low.x || std::min(s.begin.x, s.end.x) - s.margin > high.x) return false;
    if (std::max(s.begin.y, s.end.y) + s.margin < low.y || std::min(s.begin.y, s.end.y) - s.margin > high.y) return false;
    const Vec2 d = s.end - s.begin, middle = (low + high) * 0.5 - s.begin, half = (high - low) * 0.5;
    const double reach = std::abs(d.y) * half.x + std::abs(d.x) * half.y + s.margin * length(d);
    return std::abs(cross(d, middle)) <= reach;
}

std::vector<std::vector<std::uint32_t>> list_borders(const std::vector<Stretch>& all, const ChartLayout& layout) {
    std::vector<std::vector<std::uint32_t>> lists(static_cast<std::size_t>(layout.columns) * static_cast<std::size_t>(layout.rows));
    const auto index = [](double at, double origin, double cell, int count) {
        return std::clamp(static_cast<int>(std::floor((at - origin) / cell)), 0, count - 1);
    };
    for (std::uint32_t i = 0; i < all.size(); ++i) {
        const Stretch& s = all[i];
        const auto column = [&](double x) { return index(x, layout.origin[0], layout.cell[0], layout.columns); };
        const auto row = [&](double y) { return index(y, layout.origin[1], layout.cell[1], layout.rows); };
        for (int y = row(std::min(s.begin.y, s.end.y) - s.margin); y <= row(std::max(s.begin.y, s.end.y) + s.margin); ++y)
            for (int x = column(std::min(s.begin.x, s.end.x) - s.margin); x <= column(std::max(s.begin.x, s.end.x) + s.margin); ++x) {
                const Vec2 low{layout.origin[0] + x * layout.cell[0], layout.origin[1] + y * layout.cell[1]};
                if (meets(s, low, low + Vec2{layout.cell[0], layout.cell[1]}))
                    lists[static_cast<std::size_t>(y) * static_cast<std::size_t>(layout.columns) + static_cast<std::size_t>(x)].push_back(i);
            }
    }
    return lists;
}

void append_border(const ChartBorder& b, std::vector<std::uint32_t>& words) {
    const double numbers[] = {b.begin.x, b.begin.y, b.end.x, b.end.y, b.there.x, b.there.y, b.across.x, b.across.y,
                              b.map[0], b.map[1], b.map[2], b.map[3], b.scale, b.angle};
    for (const double number : numbers) words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(number)));
    words.push_back(b.from);
    words.push_back(b.to);
}

}  // namespace

ChartTable pack_charts(std::span<const ChartBorder> borders, double depth) {
    assert(!borders.empty());
    std::vector<Stretch> all;
    for (const ChartBorder& border : borders) all.push_back(stretch_of(border, depth));
    ChartTable table;
    table.layout = lay_out(all);
    for (const ChartBorder& border : borders) append_border(border, table.words);
    static_assert(BURIN_BORDER_TEXELS * 4 == 16);
    std::uint32_t first = 0;
    std::vector<std::uint32_t> references;
    for (const std::vector<std::uint32_t>& list : list_borders(all, table.layout)) {
        table.words.push_back(first);
        table.words.push_back(static_cast<std::uint32_t>(list.size()));
        references.insert(references.end(), list.begin(), list.end());
        first = static_cast<std::uint32_t>(references.size());
    }
    table.words.resize((table.words.size() + 3) / 4 * 4, 0);
    table.words.insert(table.words.end(), references.begin(), references.end());
    const std::size_t texels = (table.words.size() + 3) / 4;
    table.layout.width = static_cast<int>(std::min<std::size_t>(texels, BURIN_MAX_TEXTURE_SIDE));
    table.layout.height = static_cast<int>((texels + BURIN_MAX_TEXTURE_SIDE - 1) / BURIN_MAX_TEXTURE_SIDE);
    table.words.resize(static_cast<std::size_t>(table.layout.width) * static_cast<std::size_t>(table.layout.height) * 4, 0);
    return table;
}

}  // namespace burin
