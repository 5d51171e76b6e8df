// Checks of the grid texture and of the lists it refers to, SPECIFICATION.md "Grid texture" and "Lists".
#include <algorithm>
#include <unordered_map>

#include "texture_check.hpp"

namespace burin {
namespace {

std::string text(std::uint32_t number) { return std::to_string(number); }

std::string cell_place(int i, int j) { return "cell (" + std::to_string(i) + "," + std::to_string(j) + ")"; }

struct GridView {
    const PackedTextures& textures;
    int cols, rows;

    CellCode at(int i, int j) const {
        return unpack_cell(
            cell_texel(textures, static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(cols) +
                                     static_cast<std::uint32_t>(i)));
    }
    std::uint32_t references() const { return textures.sections.references(); }
    std::uint32_t begin_of(const CellCode& c) const { return list_begin(textures.sections, c); }
    std::uint32_t end_of(const CellCode& c) const { return begin_of(c) + c.count; }
    bool list_inside(const CellCode& c) const { return end_of(c) <= references(); }
};

void check_cell(const GridView& grid, const CellCode& c, const std::string& place, Reporter& reporter) {
    if (!grid.list_inside(c)) {
        reporter.report(
            3001,
            "list ends at reference " + text(grid.end_of(c)) + " of " + text(grid.references()),
            place);
    }
    if (c.count == 0 && c.first_reference != 0) {
        reporter.report(
            3002, "lists nothing but its first reference is " + text(c.first_reference) + ", 0 is needed",
            place);
    }
    if (c.count == 0 && (c.flags & BURIN_CELL_FLAG_STEP) != 0) {
        reporter.report(3003, "lists nothing but has flag STEP", place);
    }
    // With STEP the bits name the start of the walk instead.
    if (c.count != 0 && c.skip != 0 && (c.flags & BURIN_CELL_FLAG_STEP) == 0) {
        reporter.report(3004,
                        "lists " + text(c.count) + " elements but has skip " + text(c.skip) + ", 0 is needed",
                        place);
    }
    // 65535 = 257 * 255: both scales compared without rounding.
    if (c.lowest * 257 > c.level || c.level > c.highest * 257) {
        reporter.report(3006,
                        "level " + number_text(decode_unorm16(c.level)) + " lies outside of its bounds " +
                            number_text(decode_unorm8(c.lowest)) + " to " +
                            number_text(decode_unorm8(c.highest)),
                        place);
    }
}

bool joined(const ElementCode& a, const ElementCode& b) {
    const std::uint32_t tile = static_cast<std::uint32_t>(BURIN_COORDINATE_STEPS);
    const bool met = (a.p2.u - b.p0.u) % tile == 0 && (a.p2.v - b.p0.v) % tile == 0;
    return met && a.end.priority == BURIN_PRIORITY_BOTH && b.start.priority == BURIN_PRIORITY_BOTH &&
           a.end.shape == BURIN_END_CLIP && b.start.shape == BURIN_END_CLIP;
}

// One smooth chain: each element of the list joins the next one, but for one gap where a closed path begins
// anew.
bool is_chain(const std::vector<const ElementCode*>& list) {
    std::size_t gaps = 0;
    for (std::size_t i = 0; i + 1 < list.size(); ++i) gaps += joined(*list[i], *list[i + 1]) ? 0 : 1;
    return gaps == 0 || (gaps == 1 && joined(*list.back(), *list.front()));
}

// What a list is, whichever cell refers to it.
struct ListTraits {
    bool chain = true, step = false;
};

ListTraits traits_of(const std::vector<const ElementCode*>& list, const DecodedData& data) {
    const bool step = std::any_of(list.begin(), list.end(), [&data](const ElementCode* e) {
        const StyleCode* style = data.style_of(*e);
        return style != nullptr && style->step;
    });
    return {is_chain(list), step};
}

void check_flags(const CellCode& c, const ListTraits& list, const std::string& place, Reporter& reporter) {
    if ((c.flags & BURIN_CELL_FLAG_STEP) != 0 && !list.step) {
        reporter.report(3007, "has flag STEP but lists no element of a step", place);
    }
    if ((c.flags & BURIN_CELL_FLAG_ISOLATED) != 0 && !list.chain) {
        reporter.report(3008, "has flag ISOLATED but its list is not one smooth chain", place);
    }
}

// The elements of one cell's list; reports references that lead nowhere or are out of order.
std::vector<const ElementCode*> check_list(const GridView& grid, const CellCode& c, const DecodedData& data,
                                           const std::string& place, Reporter& reporter) {
    std::vector<const ElementCode*> list;
    std::uint32_t previous = 0;
    for (std::uint32_t k = 0; k < c.count; ++k) {
        const std::uint32_t reference = list_reference(grid.textures, grid.begin_of(c) + k);
        const bool is_start =
            reference < data.element_at.size() && data.element_at[reference] != DecodedData::kNone;
        if (is_start) list.push_back(&data.elements[data.element_at[reference]]);
        if (!is_start) {
            reporter.report(4050, "reference " + text(reference) + " is not the first texel of an element",
                            place);
        }
        if (k > 0 && reference <= previous) {
            reporter.report(
                4051, "reference " + text(reference) + " follows " + text(previous) + ", they must grow",
                place);
        }
        previous = reference;
    }
    return list;
}

void check_unlisted(const GridView& grid, const std::vector<bool>& covered, Reporter& reporter) {
    for (std::uint32_t k = 0; k < grid.references(); ++k) {
        if (!covered[k] && list_reference(grid.textures, k) != 0) {
            reporter.report(4052, "reference " + text(k) + " belongs to no cell's list and is not 0",
                            "lists");
        }
    }
}

// Distance to the nearest listing cell in cells (Chebyshev), capped at 17: two passes over the map with a
// frame of 16 cells around, which repeats it, or counts as listing where the map ends.
std::vector<std::uint8_t> listing_distance(const GridView& grid, bool repeat) {
    constexpr int kFrame = 16;
    constexpr std::uint8_t kFar = 17;
    const int width = grid.cols + 2 * kFrame, height = grid.rows + 2 * kFrame;
    const auto wrapped = [](int k, int n) { return ((k % n) + n) % n; };
    std::vector<std::uint8_t> d(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto at = [&d, width](int x, int y) -> std::uint8_t& {
        return d[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int i = x - kFrame, j = y - kFrame;
            const bool inside = i >= 0 && j >= 0 && i < grid.cols && j < grid.rows;
            const bool empty =
                (inside || repeat) && grid.at(wrapped(i, grid.cols), wrapped(j, grid.rows)).count == 0;
            at(x, y) = empty ? kFar : 0;
        }
    }
    const auto relax = [&at, width, height](int x, int y, int dx, int dy) {
        if (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height) return;
        at(x, y) = std::min<std::uint8_t>(at(x, y), static_cast<std::uint8_t>(at(x + dx, y + dy) + 1));
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            relax(x, y, -1, 0), relax(x, y, -1, -1), relax(x, y, 0, -1), relax(x, y, 1, -1);
    }
    for (int y = height - 1; y >= 0; --y) {
        for (int x = width - 1; x >= 0; --x)
            relax(x, y, 1, 0), relax(x, y, 1, 1), relax(x, y, 0, 1), relax(x, y, -1, 1);
    }
    std::vector<std::uint8_t> inner;
    inner.reserve(static_cast<std::size_t>(grid.cols) * static_cast<std::size_t>(grid.rows));
    for (int j = 0; j < grid.rows; ++j) {
        for (int i = 0; i < grid.cols; ++i) inner.push_back(at(i + kFrame, j + kFrame));
    }
    return inner;
}

void check_skips(const GridView& grid, bool repeat, Reporter& reporter) {
    const std::vector<std::uint8_t> distance = listing_distance(grid, repeat);
    for (int j = 0; j < grid.rows; ++j) {
        for (int i = 0; i < grid.cols; ++i) {
            const CellCode c = grid.at(i, j);
            const std::uint32_t nearest =
                distance[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.cols) +
                         static_cast<std::size_t>(i)];
            if (c.count == 0 && c.skip >= nearest) {
                reporter.report(3005,
                                "skip is " + text(c.skip) +
                                    ", a cell that lists elements or the border of a clamped map is " +
                                    text(nearest) + " cells away",
                                cell_place(i, j));
            }
        }
    }
}

// No step lies between two empty neighbours, so their levels agree.
void check_levels(const GridView& grid, bool repeat, Reporter& reporter) {
    const auto compare = [&grid, &reporter](int i, int j, int k, int l) {
        const CellCode a = grid.at(i, j), b = grid.at(k, l);
        if (a.count != 0 || b.count != 0 || a.level == b.level) return;
        reporter.report(3009,
                        "lists nothing and has level code " + text(a.level) + ", its empty neighbour " +
                            cell_place(k, l) + " has " + text(b.level),
                        cell_place(i, j));
    };
    for (int j = 0; j < grid.rows; ++j) {
        for (int i = 0; i < grid.cols; ++i) {
            if (i + 1 < grid.cols || repeat) compare(i, j, (i + 1) % grid.cols, j);
            if (j + 1 < grid.rows || repeat) compare(i, j, i, (j + 1) % grid.rows);
        }
    }
}

}  // namespace

void check_grid(const PackedTextures& textures, const PathDetail& detail, const DecodedData& data,
                Reporter& reporter) {
    const GridView grid{textures, textures.grid_width, textures.grid_height};
    std::vector<bool> covered(grid.references(), false);
    std::unordered_map<std::uint32_t, ListTraits> lists;  // first reference and count in one word
    for (int j = 0; j < grid.rows; ++j) {
        for (int i = 0; i < grid.cols; ++i) {
            const CellCode c = grid.at(i, j);
            const std::string place = cell_place(i, j);
            check_cell(grid, c, place, reporter);
            if (c.count == 0 || !grid.list_inside(c)) continue;
            // A list that many cells share is read and reported once.
            const auto [known, first] =
                lists.try_emplace(c.first_reference << BURIN_CELL_COUNT_BITS | c.count);
            if (first) {
                std::fill_n(covered.begin() + grid.begin_of(c), c.count, true);
                known->second = traits_of(check_list(grid, c, data, place, reporter), data);
            }
            check_flags(c, known->second, place, reporter);
        }
    }
    check_unlisted(grid, covered, reporter);
    check_skips(grid, detail.repeat, reporter);
    check_levels(grid, detail.repeat, reporter);
}

}  // namespace burin
