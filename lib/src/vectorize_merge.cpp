// Regions as a graph: what their texels sum up to and how the map jumps over their borders. Joining two regions adds what
// is known of both, so that the map itself is looked at once.
#include "vectorize_internal.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

constexpr int kSlices = 8;  // of the map, each summed up on its own
constexpr std::uint32_t kNone = 0xffffffffu;

using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Borders = std::map<Pair, Regions::Border>;

// The borders between the texels of a band and their right and lower neighbours.
Borders measure_borders(const Image& map, const Lattice& lattice, const std::vector<std::uint8_t>& flat,
                        const std::vector<std::uint32_t>& label, const Band& band) {
    Borders borders;
    const int far = std::clamp(std::min(lattice.width, lattice.height) / 512, 3, 24);
    Pair last{kNone, kNone};
    Regions::Border* border = nullptr;
    const auto add = [&](int x, int y, int dx, int dy, std::uint32_t a, std::uint32_t b) {
        const auto jump_at = [&](int reach) {
            return map.texels[lattice.nearest(x + (reach + 1) * dx, y + (reach + 1) * dy)] -
                   map.texels[lattice.nearest(x - reach * dx, y - reach * dy)];
        };
        const double sign = a > b ? -1.0 : 1.0;
        const Pair pair{std::min(a, b), std::max(a, b)};
        if (pair != last) border = &borders[pair], last = pair;
        const float near = jump_at(3);
        border->near += sign * near;
        if (far > 3) border->far += sign * jump_at(far);
        const bool soft = flat[lattice.index(x, y)] && flat[lattice.index(x + dx, y + dy)];
        border->walls += !soft || (std::fabs(near) > 0.015f && std::fabs(jump_at(1)) > 0.6f * std::fabs(near));
        ++border->length;
    };
    for (int y = band.begin; y < band.end; ++y) {
        const std::uint32_t* here = &label[static_cast<std::size_t>(y) * lattice.width];
        const int next = lattice.index(0, y + 1);
        const std::uint32_t* below = next < 0 ? here : &label[next];
        for (int x = 0; x + 1 < lattice.width; ++x) {
            if (here[x] != here[x + 1]) add(x, y, 1, 0, here[x], here[x + 1]);
            if (here[x] != below[x]) add(x, y, 0, 1, here[x], below[x]);
        }
        const int x = lattice.width - 1;
        if (lattice.wrap && here[x] != here[0]) add(x, y, 1, 0, here[x], here[0]);
        if (here[x] != below[x]) add(x, y, 0, 1, here[x], below[x]);
    }
    return borders;
}

void add_borders(Borders& borders, const Borders& more) {
    for (const auto& [pair, border] : more) borders[pair].add(border, 1.0);
}

// Texels on walls count next to nothing for the level of a region.
void sum_texels(const Image& map, const Lattice& lattice, const std::vector<std::uint8_t>& flat,
                const std::vector<std::uint32_t>& label, const Band& band, std::vector<Regions::Sum>& sums) {
    for (int y = band.begin; y < band.end; ++y) {
        const std::size_t row = static_cast<std::size_t>(y) * lattice.width;
        for (int x = 0; x < lattice.width;) {
            const std::uint32_t region = label[row + x];
            Regions::Sum sum;
            for (; x < lattice.width && label[row + x] == region; ++x) {
                const double weight = flat[row + x] ? 1.0 : 1e-3;
                sum.value += weight * map.texels[row + x];
                sum.weight += weight;
                ++sum.area;
            }
            sums[region].add(sum);
        }
    }
}

void settle_regions(Regions& regions) {
    regions.level.resize(regions.sum.size());
    regions.area.resize(regions.sum.size());
    for (std::size_t r = 0; r < regions.sum.size(); ++r) {
        if (regions.sum[r].weight > 0.0) regions.level[r] = regions.sum[r].value / regions.sum[r].weight;
        regions.area[r] = regions.sum[r].area;
    }
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t r) {
    while (parent[r] != r) r = parent[r] = parent[parent[r]];
    return r;
}

struct Weak {
    double strength;
    std::uint32_t a, b;
};

// Borders that are no edge: soft ground only passes a level there, the map does not jump, or the difference is within the grain, or one of both regions is
// too small to be worth a path. The most alike first.
std::vector<Weak> find_weak(const Regions& regions, const MergeOptions& options) {
    const double least_jump = std::max(4.0 * options.noise, 0.02), least_share = options.gentle ? 0.0 : 0.3;
    std::vector<Weak> weak;
    for (const auto& [pair, border] : regions.borders) {
        const double gap = regions.level[pair.second] - regions.level[pair.first];
        const double jump = border.jump(gap);
        const double small = std::min(regions.area[pair.first], regions.area[pair.second]);
        const double energy = small * gap * gap;
        if ((!options.shading && border.is_ramp()) || jump < std::max(least_jump, least_share * std::fabs(gap)) || energy < options.least_energy)
            weak.push_back({std::fabs(gap), pair.first, pair.second});
    }
    std::stable_sort(weak.begin(), weak.end(), [](const Weak& p, const Weak& q) { return p.strength < q.strength; });
    return weak;
}

// Joins regions as `parent` says; the new ones are numbered in the order of their first old one.
void join_regions(Regions& regions, std::vector<std::uint32_t>& parent) {
    std::vector<std::uint32_t> root(parent.size()), number(parent.size(), kNone);
    std::vector<Regions::Sum> sums;
    for (std::uint32_t r = 0; r < parent.size(); ++r) {
        root[r] = root_of(parent, r);
        if (number[root[r]] == kNone) {
            number[root[r]] = static_cast<std::uint32_t>(sums.size());
            sums.emplace_back();
        }
        sums[number[root[r]]].add(regions.sum[r]);
    }
    const auto renamed = [&](std::uint32_t r) { return number[root[r]]; };
    for (std::uint32_t& region : regions.region_of) region = renamed(region);
    regions.sum = std::move(sums);
    std::map<Pair, Regions::Border> borders;
    for (const auto& [pair, border] : regions.borders) {
        const std::uint32_t a = renamed(pair.first), b = renamed(pair.second);
        if (a == b) continue;
        borders[{std::min(a, b), std::max(a, b)}].add(border, a > b ? -1.0 : 1.0);
    }
    regions.borders = std::move(borders);
    settle_regions(regions);
}

bool merge_weak(Regions& regions, const MergeOptions& options) {
    const std::vector<Weak> weak = find_weak(regions, options);
    if (weak.empty()) return false;
    std::vector<std::uint32_t> parent(regions.level.size());
    std::iota(parent.begin(), parent.end(), 0u);
    // The smaller into the larger. Levels change by it, so nothing that took part is joined to a third region in the same
    // round, except that one may take up many.
    enum State : std::uint8_t { untouched, taker, taken };
    std::vector<std::uint8_t> state(regions.level.size(), untouched);
    for (const Weak& w : weak) {
        const bool first_smaller = regions.area[w.a] < regions.area[w.b];
        const std::uint32_t small = first_smaller ? w.a : w.b, large = first_smaller ? w.b : w.a;
        if (state[small] != untouched || state[large] == taken) continue;
        state[small] = taken;
        state[large] = taker;
        parent[root_of(parent, small)] = root_of(parent, large);
    }
    join_regions(regions, parent);
    return true;
}

}  // namespace

void measure_regions(const Image& map, const Lattice& lattice, const std::vector<std::uint8_t>& flat,
                     const std::vector<std::uint32_t>& label, Regions& regions) {
    std::vector<Borders> borders(kSlices);
    std::vector<std::vector<Regions::Sum>> sums(kSlices);
    for_each_band(lattice.height, kSlices, lattice.threads, [&](const Band& band) {
        borders[band.index] = measure_borders(map, lattice, flat, label, band);
        sums[band.index].resize(regions.level.size());
        sum_texels(map, lattice, flat, label, band, sums[band.index]);
    });
    regions.sum.assign(regions.level.size(), {});
    regions.borders.clear();
    for (int slice = 0; slice < kSlices; ++slice) {
        add_borders(regions.borders, borders[slice]);
        for (std::size_t r = 0; r < regions.sum.size(); ++r) regions.sum[r].add(sums[slice][r]);
    }
    regions.region_of.resize(regions.level.size());
    std::iota(regions.region_of.begin(), regions.region_of.end(), 0u);
    settle_regions(regions);
}

void merge_regions(const MergeOptions& options, Regions& regions) {
    for (int round = 0; round < 200; ++round)
        if (!merge_weak(regions, options)) break;
}

}  // namespace burin::vectorizing
