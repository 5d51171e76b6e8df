// Plateaus: levels of the map, seeds on flat ground, growth over the walls to half height, and no border without an edge.
#include "vectorize_internal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>

namespace burin::vectorizing {
namespace {

constexpr int kBins = 256;
constexpr int kMostLevels = 8;
constexpr std::uint32_t kNone = 0xffffffffu;

struct Histogram {
    std::array<double, kBins + 1> count{}, sum{}, square{};  // running totals

    double error(int from, int to) const {  // squared deviation of bins [from, to) from their mean
        const double n = count[to] - count[from], s = sum[to] - sum[from], q = square[to] - square[from];
        return n > 0.0 ? std::max(0.0, q - s * s / n) : 0.0;
    }
    double mean(int from, int to) const {
        const double n = count[to] - count[from];
        return n > 0.0 ? (sum[to] - sum[from]) / n : 0.0;
    }
};

Histogram make_histogram(const Image& map, const std::vector<std::uint8_t>& flat) {
    Histogram histogram;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        if (!flat[i]) continue;
        const double v = map.texels[i];
        const int bin = std::clamp(static_cast<int>(v * kBins), 0, kBins - 1);
        histogram.count[bin + 1] += 1.0;
        histogram.sum[bin + 1] += v;
        histogram.square[bin + 1] += v * v;
    }
    for (int i = 0; i < kBins; ++i) {
        histogram.count[i + 1] += histogram.count[i];
        histogram.sum[i + 1] += histogram.sum[i];
        histogram.square[i + 1] += histogram.square[i];
    }
    return histogram;
}

// The best k levels by dynamic programming over the histogram, k grown while a further level still pays.
std::vector<double> choose_levels(const Histogram& histogram, int most_levels) {
    std::vector<std::array<double, kBins + 1>> cost(most_levels + 1);
    std::vector<std::array<int, kBins + 1>> from(most_levels + 1);
    cost[0].fill(1e300);
    cost[0][0] = 0.0;
    for (int k = 1; k <= most_levels; ++k)
        for (int end = 0; end <= kBins; ++end) {
            cost[k][end] = 1e300;
            for (int start = 0; start <= end; ++start) {
                const double c = cost[k - 1][start] + histogram.error(start, end);
                if (c < cost[k][end]) {
                    cost[k][end] = c;
                    from[k][end] = start;
                }
            }
        }
    const double whole = cost[1][kBins];
    int levels = 1;
    while (levels < most_levels && cost[levels][kBins] > 0.01 * whole &&
           cost[levels][kBins] - cost[levels + 1][kBins] > 0.01 * whole && whole > 1e-9)
        ++levels;
    std::vector<double> result;
    for (int k = levels, end = kBins; k > 0; end = from[k][end], --k)
        if (histogram.count[end] > histogram.count[from[k][end]]) result.push_back(histogram.mean(from[k][end], end));
    std::sort(result.begin(), result.end());
    return result;
}

int nearest_level(const std::vector<double>& levels, double value) {
    int best = 0;
    for (std::size_t k = 1; k < levels.size(); ++k)
        if (std::fabs(levels[k] - value) < std::fabs(levels[best] - value)) best = static_cast<int>(k);
    return best;
}

constexpr int kSideX[4] = {1, -1, 0, 0};
constexpr int kSideY[4] = {0, 0, 1, -1};

// Connected flat texels of one level are seeds; the rest of the texels are taken by the seed whose level is nearest to
// their value, nearest texels first, so that two plateaus meet at half height.
Regions grow_regions(const Image& map, const Lattice& lattice, const std::vector<std::uint8_t>& flat,
                     const std::vector<double>& levels, int least_area) {
    Regions regions;
    regions.label.assign(map.texels.size(), kNone);
    std::vector<std::uint8_t> seen(map.texels.size(), 0);
    std::vector<int> part;
    for (int i = 0; i < lattice.size(); ++i) {
        if (!flat[i] || seen[i]) continue;
        const int level = nearest_level(levels, map.texels[i]);
        part.assign(1, i);
        seen[i] = 1;
        double sum = 0.0;
        for (std::size_t k = 0; k < part.size(); ++k) {
            sum += map.texels[part[k]];
            for (int side = 0; side < 4; ++side) {
                const int j = lattice.index(part[k] % lattice.width + kSideX[side], part[k] / lattice.width + kSideY[side]);
                if (j < 0 || seen[j] || !flat[j] || nearest_level(levels, map.texels[j]) != level) continue;
                seen[j] = 1;
                part.push_back(j);
            }
        }
        if (static_cast<int>(part.size()) < least_area) continue;
        for (const int j : part) regions.label[j] = static_cast<std::uint32_t>(regions.level.size());
        regions.level.push_back(sum / static_cast<double>(part.size()));
    }
    if (regions.level.empty()) {
        regions.label.assign(map.texels.size(), 0);
        regions.level.push_back(std::accumulate(map.texels.begin(), map.texels.end(), 0.0) / map.texels.size());
        return regions;
    }
    struct Front {
        float cost;
        int texel;
        std::uint32_t region;
        int steps;
        bool operator>(const Front& o) const {
            return cost != o.cost ? cost > o.cost : texel != o.texel ? texel > o.texel : region > o.region;
        }
    };
    std::priority_queue<Front, std::vector<Front>, std::greater<>> queue;
    const auto push_around = [&](int i, std::uint32_t region, int steps) {
        for (int side = 0; side < 4; ++side) {
            const int j = lattice.index(i % lattice.width + kSideX[side], i / lattice.width + kSideY[side]);
            if (j < 0 || regions.label[j] != kNone) continue;
            // Without the cost per step a middle level would creep along every wall that passes its height.
            const float cost = std::fabs(map.texels[j] - static_cast<float>(regions.level[region])) + 0.03f * steps;
            queue.push({cost, j, region, steps + 1});
        }
    };
    for (int i = 0; i < lattice.size(); ++i)
        if (regions.label[i] != kNone) push_around(i, regions.label[i], 1);
    while (!queue.empty()) {
        const Front front = queue.top();
        queue.pop();
        if (regions.label[front.texel] != kNone) continue;
        regions.label[front.texel] = front.region;
        push_around(front.texel, front.region, front.steps);
    }
    return regions;
}

// Summed height differences from a few texels before the border to a few behind it, and from farther away on both sides:
// a large map may show its walls softer than a small one.
struct Border {
    double near = 0.0, far = 0.0;
    int length = 0;

    // The greater of both means, seen upwards from the lower region to the higher one.
    double jump(double gap) const { return std::max(gap < 0 ? -near : near, gap < 0 ? -far : far) / length; }
};

using Borders = std::map<std::pair<std::uint32_t, std::uint32_t>, Border>;

Borders measure_borders(const Image& map, const Lattice& lattice, const Regions& regions) {
    Borders borders;
    const int far = std::clamp(std::min(lattice.width, lattice.height) / 512, 3, 24);
    for (int y = 0; y < lattice.height; ++y)
        for (int x = 0; x < lattice.width; ++x)
            for (int side = 0; side < 4; side += 2) {
                const int dx = kSideX[side], dy = kSideY[side];
                const int j = lattice.index(x + dx, y + dy);
                if (j < 0) continue;
                std::uint32_t a = regions.label[lattice.index(x, y)], b = regions.label[j];
                if (a == b) continue;
                const auto jump_at = [&](int reach) {
                    return map.texels[lattice.nearest(x + (reach + 1) * dx, y + (reach + 1) * dy)] -
                           map.texels[lattice.nearest(x - reach * dx, y - reach * dy)];
                };
                const double sign = a > b ? -1.0 : 1.0;
                if (a > b) std::swap(a, b);
                Border& border = borders[{a, b}];
                border.near += sign * jump_at(3);
                if (far > 3) border.far += sign * jump_at(far);
                ++border.length;
            }
    return borders;
}

void recompute_levels(const Image& map, Regions& regions, const std::vector<std::uint8_t>& flat) {
    std::vector<double> sum(regions.level.size(), 0.0), count(regions.level.size(), 0.0);
    regions.area.assign(regions.level.size(), 0);
    for (std::size_t i = 0; i < regions.label.size(); ++i) {
        const double weight = flat[i] ? 1.0 : 1e-3;
        sum[regions.label[i]] += weight * map.texels[i];
        count[regions.label[i]] += weight;
        ++regions.area[regions.label[i]];
    }
    for (std::size_t r = 0; r < regions.level.size(); ++r)
        if (count[r] > 0.0) regions.level[r] = sum[r] / count[r];
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t r) {
    while (parent[r] != r) r = parent[r] = parent[parent[r]];
    return r;
}

// Joins regions whose common border is no edge: the map does not jump there, or the difference is within the grain,
// or one of them is too small to be worth a path.
bool merge_weak(const Image& map, const Lattice& lattice, Regions& regions, const std::vector<std::uint8_t>& flat,
                double least_jump, double least_energy) {
    const Borders borders = measure_borders(map, lattice, regions);
    std::vector<std::uint32_t> parent(regions.level.size());
    std::iota(parent.begin(), parent.end(), 0u);
    struct Weak {
        double strength;
        std::uint32_t a, b;
    };
    std::vector<Weak> weak;
    for (const auto& [pair, border] : borders) {
        const double gap = regions.level[pair.second] - regions.level[pair.first];
        const double jump = border.jump(gap);
        const double small = std::min(regions.area[pair.first], regions.area[pair.second]);
        const double energy = small * gap * gap;
        if (jump < least_jump || jump < 0.3 * std::fabs(gap) || energy < least_energy)
            weak.push_back({std::fabs(gap), pair.first, pair.second});
    }
    if (weak.empty()) return false;
    std::stable_sort(weak.begin(), weak.end(), [](const Weak& p, const Weak& q) { return p.strength < q.strength; });
    // The most alike first, the smaller into the larger. Levels change by it, so nothing that took part is joined to
    // a third region in the same round, except that one may take up many.
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
    std::vector<std::uint32_t> renumber(parent.size(), kNone);
    std::uint32_t next = 0;
    for (std::uint32_t& label : regions.label) {
        const std::uint32_t root = root_of(parent, label);
        if (renumber[root] == kNone) renumber[root] = next++;
        label = renumber[root];
    }
    regions.level.assign(next, 0.0);
    recompute_levels(map, regions, flat);
    return true;
}

void merge_weak_regions(const Image& map, const Lattice& lattice, double noise, double least_energy,
                        const std::vector<std::uint8_t>& flat, Regions& regions) {
    const double least_jump = std::max(4.0 * noise, 0.02);
    for (int round = 0; round < 200; ++round)
        if (!merge_weak(map, lattice, regions, flat, least_jump, least_energy)) break;
}

}  // namespace

std::vector<std::uint8_t> find_flat(const Image& map, const Lattice& lattice, double noise) {
    const float most = static_cast<float>(std::max(7.0 * noise, 0.035));
    std::vector<std::uint8_t> flat(map.texels.size());
    for (int y = 0; y < lattice.height; ++y)
        for (int x = 0; x < lattice.width; ++x) {
            float low = 2.0f, high = -2.0f;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const float v = map.texels[lattice.nearest(x + dx, y + dy)];
                    low = std::min(low, v);
                    high = std::max(high, v);
                }
            flat[static_cast<std::size_t>(y) * lattice.width + x] = high - low < most;
        }
    return flat;
}

Regions segment_regions(const Image& map, const Lattice& lattice, double noise, double least_energy,
                        const std::vector<std::uint8_t>& flat) {
    const Histogram histogram = make_histogram(map, flat);
    const std::vector<double> levels = choose_levels(histogram, kMostLevels);
    Regions regions = grow_regions(map, lattice, flat, levels.empty() ? std::vector<double>{0.5} : levels, 6);
    recompute_levels(map, regions, flat);
    merge_weak_regions(map, lattice, noise, least_energy, flat, regions);
    return regions;
}

void merge_regions(const Image& map, const Lattice& lattice, double noise, double least_energy,
                   const std::vector<std::uint8_t>& flat, Regions& regions) {
    merge_weak_regions(map, lattice, noise, least_energy, flat, regions);
}

}  // namespace burin::vectorizing
