// Plateaus: levels of the map, seeds on flat ground, growth over the walls to half height, and no border without an edge.
#include "vectorize_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

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

// Index of the level nearest to a value.
class LevelFinder {
  public:
    explicit LevelFinder(const std::vector<double>& levels) : levels_(levels) {}
    int operator()(float value) const {
        int best = 0;
        for (std::size_t k = 1; k < levels_.size() && value > 0.5 * (levels_[k - 1] + levels_[k]); ++k)
            best = static_cast<int>(k);
        return best;
    }

  private:
    const std::vector<double>& levels_;  // rising
};

constexpr int kSideX[4] = {1, -1, 0, 0};
constexpr int kSideY[4] = {0, 0, 1, -1};

// Texels still to be taken, cheapest first; equal costs in the order in which they came.
class GrowthQueue {
  public:
    struct Front {
        float cost = 0.0f;
        int texel = 0;
        std::uint32_t region = 0;
        int steps = 0;
    };

    void push(const Front& front) {
        const std::size_t slot = std::min(slots_.size() - 1, static_cast<std::size_t>(front.cost * kPerUnit));
        slots_[slot].fronts.push_back(front);
        lowest_ = std::min(lowest_, slot);
        ++count_;
    }
    bool pop(Front& front) {
        if (count_ == 0) return false;
        while (slots_[lowest_].next == slots_[lowest_].fronts.size()) {
            slots_[lowest_].fronts.clear();
            slots_[lowest_].next = 0;
            ++lowest_;
        }
        front = slots_[lowest_].fronts[slots_[lowest_].next++];
        --count_;
        return true;
    }

  private:
    static constexpr float kPerUnit = 2048.0f;  // costs closer than that are equal
    struct Slot {
        std::vector<Front> fronts;
        std::size_t next = 0;
    };
    std::vector<Slot> slots_ = std::vector<Slot>(16384);
    std::size_t lowest_ = 0, count_ = 0;
};

// Parts of some size are seeds of regions, at their mean: all, or those that `is_seed` says.
void plant_seeds(const Image& map, const Lattice& lattice, const Parts& parts, Regions& regions,
                 std::vector<std::uint32_t>& label, const std::vector<std::uint8_t>& is_seed = {}) {
    constexpr std::uint32_t kLeastArea = 6;
    std::vector<double> sum(parts.count, 0.0);
    std::vector<std::uint32_t> area(parts.count, 0), number(parts.count, kNone);
    for_each_run(parts, [&](int y, const Run& run) {
        const float* row = &map.texels[static_cast<std::size_t>(y) * lattice.width];
        sum[run.part] = std::accumulate(row + run.begin, row + run.end, sum[run.part]);
        area[run.part] += static_cast<std::uint32_t>(run.end - run.begin);
    });
    for (std::uint32_t p = 0; p < parts.count; ++p) {
        if (area[p] < kLeastArea || (!is_seed.empty() && !is_seed[p])) continue;
        number[p] = static_cast<std::uint32_t>(regions.level.size());
        regions.level.push_back(sum[p] / area[p]);
    }
    for_each_run(parts, [&](int y, const Run& run) {
        if (number[run.part] == kNone) return;
        std::uint32_t* row = &label[static_cast<std::size_t>(y) * lattice.width];
        std::fill(row + run.begin, row + run.end, number[run.part]);
    });
}

// The parts of flat texels of one level.
void plant_plateaus(const Image& map, const Lattice& lattice, const std::vector<std::uint8_t>& flat,
                    const std::vector<double>& levels, Regions& regions, std::vector<std::uint32_t>& label) {
    const LevelFinder level_of(levels);
    const Parts parts = find_parts(lattice, false, [&](int x, int y) -> std::uint8_t {
        const std::size_t i = static_cast<std::size_t>(y) * lattice.width + x;
        return flat[i] ? static_cast<std::uint8_t>(1 + level_of(map.texels[i])) : 0;
    });
    plant_seeds(map, lattice, parts, regions, label);
}

// Which texels without a label are at one of the levels, give or take a share of what lies between them: its number from 1
// on, or 0.
std::vector<std::uint8_t> find_level_texels(const Image& map, const Lattice& lattice, const std::vector<double>& levels,
                                            const std::vector<std::uint32_t>& label) {
    constexpr double kNear = 0.12;
    const LevelFinder level_of(levels);
    std::vector<double> near(levels.size(), 1e300);
    for (std::size_t k = 1; k < levels.size(); ++k)
        for (const std::size_t i : {k - 1, k}) near[i] = std::min(near[i], kNear * (levels[k] - levels[k - 1]));
    std::vector<std::uint8_t> at(label.size(), 0);
    for_each_band(lattice.height, lattice.threads, [&](const Band& band) {
        for (std::size_t i = static_cast<std::size_t>(band.begin) * lattice.width,
                         end = static_cast<std::size_t>(band.end) * lattice.width; i < end; ++i) {
            if (label[i] != kNone) continue;
            const int k = level_of(map.texels[i]);
            if (std::fabs(map.texels[i] - levels[k]) < near[k]) at[i] = static_cast<std::uint8_t>(k + 1);
        }
    });
    return at;
}

// What lies a little beside a part of texels that are at one level.
struct Rim {
    int above = 0, below = 0;
    bool is_other = false;  // the part goes on as a seed, or was beside a line
    bool is_one_sided() const { return std::max(above, below) > 0.9 * (above + below); }
};

// Per part of `parts`, whose kind is the number of its level as in `at`; `source` is the map with its lines.
std::vector<Rim> look_at_rims(const Image& source, const Image& map, const Lattice& lattice, const std::vector<double>& levels,
                              const std::vector<std::uint8_t>& at, const std::vector<std::uint32_t>& label, const Parts& parts) {
    constexpr int kOnWall = 2, kBehindWall = 4;  // texels
    const LevelFinder level_of(levels);
    std::vector<Rim> rims(parts.count);
    for_each_run(parts, [&](int y, const Run& run) {
        Rim& rim = rims[run.part];
        for (int x = run.begin; x < run.end; ++x)
            for (int side = 0; side < 4; ++side) {
                const int behind = lattice.nearest(x + kBehindWall * kSideX[side], y + kBehindWall * kSideY[side]);
                rim.is_other |= map.texels[behind] != source.texels[behind];
                const int j = lattice.index(x + kOnWall * kSideX[side], y + kOnWall * kSideY[side]);
                if (j < 0 || at[j] == run.kind) continue;
                rim.is_other |= label[j] != kNone && level_of(map.texels[j]) + 1 == run.kind;
                ++(map.texels[j] > levels[run.kind - 1] ? rim.above : rim.below);
            }
    });
    return rims;
}

// A narrow plateau that JPEG left uneven has no flat texels; but it is at a level of the map, two texels wide or more, and
// all around it the map falls off, or rises: a wall passes a level otherwise. What lines left of themselves, beside where
// they were taken out of `source`, is none.
void plant_narrow_plateaus(const Image& source, const Image& map, const Lattice& lattice, const std::vector<double>& levels,
                          Regions& regions, std::vector<std::uint32_t>& label) {
    if (levels.size() < 2) return;
    const std::vector<std::uint8_t> at = find_level_texels(map, lattice, levels, label);
    const Parts parts = find_parts(lattice, false, [&](int x, int y) -> std::uint8_t {
        const std::uint8_t k = at[static_cast<std::size_t>(y) * lattice.width + x];
        if (k == 0 || at[lattice.nearest(x + 1, y)] != k) return 0;
        return at[lattice.nearest(x, y + 1)] == k && at[lattice.nearest(x + 1, y + 1)] == k ? k : 0;
    });
    std::vector<std::uint8_t> is_seed;
    for (const Rim& rim : look_at_rims(source, map, lattice, levels, at, label, parts))
        is_seed.push_back(!rim.is_other && rim.is_one_sided());
    plant_seeds(map, lattice, parts, regions, label, is_seed);
}

// Texels [begin, end) of a row.
struct Span {
    int y, begin, end;
};

std::vector<std::vector<Span>> spans_of(const Parts& parts) {
    std::vector<std::vector<Span>> spans(parts.count);
    for_each_run(parts, [&](int y, const Run& run) { spans[run.part].push_back({y, run.begin, run.end}); });
    return spans;
}

// Connected texels that no region has taken yet.
Parts find_walls(const Lattice& lattice, const std::vector<std::uint32_t>& label) {
    return find_parts(lattice, false, [&](int x, int y) -> std::uint8_t {
        return label[static_cast<std::size_t>(y) * lattice.width + x] == kNone;
    });
}

struct Heights {
    double low = 1e300, high = -1e300;

    void add(double value) { low = std::min(low, value), high = std::max(high, value); }
};

enum Side : std::uint8_t { neither, above, below };

Parts find_hill_parts(const Lattice& lattice, const std::vector<std::uint8_t>& side) {
    return find_parts(lattice, false, [&](int x, int y) { return side[static_cast<std::size_t>(y) * lattice.width + x]; });
}

// Marks the texels of walls that rise above, or fall below, all seeds around them by more than `least`.
std::vector<std::uint8_t> find_hills(const Image& map, const Lattice& lattice, const Regions& regions,
                                     const std::vector<std::uint32_t>& label, double least) {
    const Parts walls = find_walls(lattice, label);
    std::vector<Heights> rim(walls.count);
    const auto look = [&](int texel, std::uint32_t wall) {
        if (texel >= 0 && label[texel] != kNone) rim[wall].add(regions.level[label[texel]]);
    };
    for_each_run(walls, [&](int y, const Run& run) {
        look(lattice.index(run.begin - 1, y), run.part), look(lattice.index(run.end, y), run.part);
        for (int x = run.begin; x < run.end; ++x) look(lattice.index(x, y - 1), run.part), look(lattice.index(x, y + 1), run.part);
    });
    std::vector<std::uint8_t> side(label.size(), neither);
    for_each_run(walls, [&](int y, const Run& run) {
        for (std::size_t i = static_cast<std::size_t>(y) * lattice.width + run.begin, end = i + (run.end - run.begin); i < end; ++i)
            side[i] = map.texels[i] > rim[run.part].high + least ? above : map.texels[i] < rim[run.part].low - least ? below : neither;
    });
    return side;
}

// Domes and pyramids have no flat texels, however high they are: what stands out of the plateaus around it is a region of
// its own from half of its height on.
void plant_hills(const Image& map, const Lattice& lattice, Regions& regions, std::vector<std::uint32_t>& label) {
    constexpr double kLeastShare = 0.1;  // of the map's range: lower ones are grain, or what is left of lines
    const auto [lowest, highest] = std::minmax_element(map.texels.begin(), map.texels.end());
    const double least = kLeastShare * (*highest - *lowest);
    std::vector<std::uint8_t> side = find_hills(map, lattice, regions, label, least);
    const Parts hills = find_hill_parts(lattice, side);
    std::vector<Heights> heights(hills.count);
    for_each_run(hills, [&](int y, const Run& run) {
        for (int x = run.begin; x < run.end; ++x) heights[run.part].add(map.at(x, y));
    });
    for_each_run(hills, [&](int y, const Run& run) {
        const auto [low, high] = heights[run.part];
        for (int x = run.begin; x < run.end; ++x) {
            std::uint8_t& of_hill = side[static_cast<std::size_t>(y) * lattice.width + x];
            const double middle = of_hill == above ? 0.5 * (high + low - least) : 0.5 * (low + high + least);
            if (of_hill == above ? map.at(x, y) < middle : map.at(x, y) > middle) of_hill = neither;
        }
    });
    plant_seeds(map, lattice, find_hill_parts(lattice, side), regions, label);
}

// Without the cost per step a middle level would creep along every wall that passes its height.
float growth_cost(float value, double level, int steps) { return std::fabs(value - static_cast<float>(level)) + 0.03f * steps; }

// The texels of `wall` are taken by the regions around them; the queue is left empty.
void grow_into(const Image& map, const Lattice& lattice, const std::vector<double>& level, const std::vector<Span>& wall,
               std::vector<std::uint32_t>& label, GrowthQueue& queue) {
    const auto for_each_neighbour = [&](int x, int y, const auto& visit) {
        for (int side = 0; side < 4; ++side)
            if (const int j = lattice.index(x + kSideX[side], y + kSideY[side]); j >= 0) visit(j);
    };
    for (const Span& span : wall)
        for (int x = span.begin; x < span.end; ++x) {
            const int i = span.y * lattice.width + x;
            for_each_neighbour(x, span.y, [&](int j) {
                if (label[j] != kNone) queue.push({growth_cost(map.texels[i], level[label[j]], 1), i, label[j], 2});
            });
        }
    for (GrowthQueue::Front front; queue.pop(front);) {
        if (label[front.texel] != kNone) continue;
        label[front.texel] = front.region;
        for_each_neighbour(front.texel % lattice.width, front.texel / lattice.width, [&](int j) {
            if (label[j] != kNone) return;
            queue.push({growth_cost(map.texels[j], level[front.region], front.steps), j, front.region, front.steps + 1});
        });
    }
}

// Connected flat texels of one level are seeds; the rest of the texels are taken by the seed whose level is nearest to
// their value, nearest texels first, so that two plateaus meet at half height.
std::vector<std::uint32_t> grow_regions(const Image& source, const Image& map, const Lattice& lattice,
                                        const std::vector<std::uint8_t>& flat, const std::vector<double>& levels, Regions& regions) {
    std::vector<std::uint32_t> label(map.texels.size(), kNone);
    plant_plateaus(map, lattice, flat, levels, regions, label);
    if (regions.level.empty()) {
        label.assign(map.texels.size(), 0);
        regions.level.push_back(std::accumulate(map.texels.begin(), map.texels.end(), 0.0) / map.texels.size());
        return label;
    }
    plant_narrow_plateaus(source, map, lattice, levels, regions, label);
    plant_hills(map, lattice, regions, label);
    // Connected texels without a label are taken from their own rim alone.
    const Parts walls = find_walls(lattice, label);
    const std::vector<std::vector<Span>> spans = spans_of(walls);
    for_each_piece(spans.size(), lattice.threads, [&](std::size_t wall) {
        thread_local GrowthQueue queue;
        grow_into(map, lattice, regions.level, spans[wall], label, queue);
    });
    return label;
}

}  // namespace

std::vector<std::uint8_t> find_flat(const Image& map, const Lattice& lattice, double noise) {
    const float most = static_cast<float>(std::max(7.0 * noise, 0.035));
    const int w = lattice.width;
    std::vector<std::uint8_t> flat(map.texels.size());
    for_each_band(lattice.height, lattice.threads, [&](const Band& band) {
        // Least and greatest of three rows, with a column more at either end.
        std::vector<float> low(static_cast<std::size_t>(w) + 2), high(low.size());
        for (int y = band.begin; y < band.end; ++y) {
            const float* above = &map.texels[lattice.nearest(0, y - 1)];
            const float* here = &map.texels[lattice.nearest(0, y)];
            const float* below = &map.texels[lattice.nearest(0, y + 1)];
            for (int x = 0; x < w; ++x) {
                low[x + 1] = std::min(std::min(above[x], here[x]), below[x]);
                high[x + 1] = std::max(std::max(above[x], here[x]), below[x]);
            }
            low[0] = low[lattice.wrap ? w : 1], high[0] = high[lattice.wrap ? w : 1];
            low[w + 1] = low[lattice.wrap ? 1 : w], high[w + 1] = high[lattice.wrap ? 1 : w];
            std::uint8_t* out = &flat[static_cast<std::size_t>(y) * w];
            for (int x = 0; x < w; ++x)
                out[x] = std::max(std::max(high[x], high[x + 1]), high[x + 2]) -
                             std::min(std::min(low[x], low[x + 1]), low[x + 2]) < most;
        }
    });
    return flat;
}

Regions segment_regions(const Image& source, const Image& map, const Lattice& lattice, const MergeOptions& options,
                        const std::vector<std::uint8_t>& flat) {
    const Histogram histogram = make_histogram(map, flat);
    const std::vector<double> levels = choose_levels(histogram, kMostLevels);
    Regions regions;
    std::vector<std::uint32_t> label =
        grow_regions(source, map, lattice, flat, levels.empty() ? std::vector<double>{0.5} : levels, regions);
    measure_regions(map, lattice, flat, label, regions);
    merge_regions(options, regions);
    // The parts that were joined at once need no numbers of their own.
    for_each_band(lattice.height, lattice.threads, [&](const Band& band) {
        for (std::size_t i = static_cast<std::size_t>(band.begin) * lattice.width,
                         end = static_cast<std::size_t>(band.end) * lattice.width; i < end; ++i)
            label[i] = regions.region_of[label[i]];
    });
    regions.part = std::make_shared<const std::vector<std::uint32_t>>(std::move(label));
    regions.region_of.resize(regions.level.size());
    std::iota(regions.region_of.begin(), regions.region_of.end(), 0u);
    return regions;
}

}  // namespace burin::vectorizing
