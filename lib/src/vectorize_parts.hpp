// Connected parts of a map's texels, found by runs along the rows. Part of stage vectorize.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel.hpp"
#include "vectorize_internal.hpp"

namespace burin::vectorizing {

// Texels [begin, end) of a row that are of one kind.
struct Run {
    int begin = 0, end = 0;
    std::uint32_t part = 0;
    std::uint8_t kind = 0;
};

// Parts are numbered in the order of their first texels, row by row.
struct Parts {
    std::vector<Run> runs;               // row by row, from left to right
    std::vector<std::size_t> row_start;  // index of each row's first run, and the end
    std::uint32_t count = 0;

    // Index of the run that texel x of row y lies in, or row_start[y + 1].
    std::size_t find(int x, int y) const;
};

// Joins runs of one kind that touch: with a side, or with a corner where `corners` says so.
void connect_runs(Parts& parts, const Lattice& lattice, bool corners);

// Parts of texels of equal kind; kind_of(x, y) is 0 for texels that belong to none.
template <typename Kind>
Parts find_parts(const Lattice& lattice, bool corners, const Kind& kind_of) {
    constexpr int kBandRows = 32;
    const int bands = (lattice.height + kBandRows - 1) / kBandRows;
    std::vector<std::vector<Run>> found(static_cast<std::size_t>(bands));
    Parts parts;
    parts.row_start.assign(static_cast<std::size_t>(lattice.height) + 1, 0);
    for_each_band(lattice.height, bands, lattice.threads, [&](const Band& band) {
        std::vector<Run>& runs = found[band.index];
        for (int y = band.begin; y < band.end; ++y) {
            const std::size_t before = runs.size();
            std::uint8_t last = 0;
            for (int x = 0; x < lattice.width; ++x) {
                const std::uint8_t kind = kind_of(x, y);
                if (kind == last) continue;
                if (last != 0) runs.back().end = x;
                if (kind != 0) runs.push_back({x, lattice.width, 0, kind});
                last = kind;
            }
            parts.row_start[static_cast<std::size_t>(y) + 1] = runs.size() - before;
        }
    });
    for (int y = 0; y < lattice.height; ++y) parts.row_start[y + 1] += parts.row_start[y];
    parts.runs.reserve(parts.row_start.back());
    for (std::vector<Run>& runs : found) {
        parts.runs.insert(parts.runs.end(), runs.begin(), runs.end());
        std::vector<Run>().swap(runs);
    }
    connect_runs(parts, lattice, corners);
    return parts;
}

// Calls visit(y, run) for every run.
template <typename Visit>
void for_each_run(const Parts& parts, const Visit& visit) {
    for (std::size_t y = 0; y + 1 < parts.row_start.size(); ++y)
        for (std::size_t r = parts.row_start[y]; r < parts.row_start[y + 1]; ++r) visit(static_cast<int>(y), parts.runs[r]);
}

}  // namespace burin::vectorizing
