// Which traced chains are lines: one section all along, and level ground to both sides.
#include "vectorize_candidates.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

// Visits the discs of texels around a place that moves, each but for what the disc before it held too.
class MovingDisc {
  public:
    explicit MovingDisc(int reach) : reach_(reach) {
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx)
                if (holds(dx, dy)) add({dx, dy});
    }

    // Calls visit(x, y) with unwrapped coordinates.
    template <typename Visit>
    void move_to(int x, int y, const Visit& visit) {
        const int dx = x - x_, dy = y - y_;
        const bool near = placed_ && std::abs(dx) <= 1 && std::abs(dy) <= 1;
        x_ = x, y_ = y, placed_ = true;
        if (near && dx == 0 && dy == 0) return;
        for (const Offset& o : near ? entering_[(dy + 1) * 3 + dx + 1] : all_) visit(x + o.dx, y + o.dy);
    }

  private:
    struct Offset {
        int dx, dy;
    };
    bool holds(int dx, int dy) const { return dx * dx + dy * dy <= reach_ * reach_; }
    void add(Offset o) {
        all_.push_back(o);
        for (int my = -1; my <= 1; ++my)
            for (int mx = -1; mx <= 1; ++mx)
                if (!holds(o.dx + mx, o.dy + my)) entering_[(my + 1) * 3 + mx + 1].push_back(o);
    }

    int reach_, x_ = 0, y_ = 0;
    bool placed_ = false;
    std::vector<Offset> all_, entering_[9];  // by the move that brings them in
};

}  // namespace

std::vector<std::int32_t> claim_texels(const std::vector<Chain>& chains, const Lattice& lattice) {
    std::vector<std::int32_t> owner(static_cast<std::size_t>(lattice.size()), kNobody);
    for (std::size_t c = 0; c < chains.size(); ++c) {
        std::map<int, MovingDisc> discs;  // by reach
        for_each_place(chains[c], [&](Vec2 p, Vec2, double half_width) {
            const int reach = static_cast<int>(std::ceil(half_width + 1.0));
            discs.try_emplace(reach, reach).first->second.move_to(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)), [&](int x, int y) {
                const int texel = lattice.index(x, y);
                if (texel < 0) return;
                const bool free = owner[texel] == kNobody || owner[texel] == static_cast<std::int32_t>(c);
                owner[texel] = free ? static_cast<std::int32_t>(c) : kSeveral;
            });
        });
    }
    return owner;
}

namespace {

// The map across a chain, relative to the ground beside each place: medians over the chain.
struct CrossSection {
    double depth = 0.0;      // of the middle below (above) the ground
    double tilt = 0.0;       // right ground - left ground
    double explained = 0.0;  // share of the variance that the median section explains
    double wobble = 0.0;     // what it leaves, in texels by which the rims would have to be off to leave as much
};

// What a chain is measured in.
struct Surroundings {
    const Image& map;
    const Lattice& lattice;
    const std::vector<std::int32_t>& owner;  // see claim_texels
    double noise = 0.0;
};

// Whether another line lies `offset` texels beside a chain: another chain, or another turn of the same.
bool is_beside(double half_width, std::int32_t self, const Surroundings& around, Vec2 p, double offset) {
    const auto owner = around.owner[around.lattice.nearest(p)];
    return owner != kNobody && (owner != self || std::fabs(offset) > half_width + 2.5);
}

// How far a chain is measured to its sides, texels.
struct Reach {
    double left = 0.0, right = 0.0;
};

// How far from a chain, at half of its places, the next one begins; at most `furthest`.
Reach free_reach(const Chain& chain, std::int32_t self, const Surroundings& around, double furthest) {
    std::vector<double> free[2];
    for_each_place(chain, [&](Vec2 p, Vec2 normal, double half_width) {
        for (const int side : {0, 1}) {
            const double sign = side == 0 ? -1.0 : 1.0;
            double reach = 0.5;
            while (reach < furthest && !is_beside(half_width, self, around, p + normal * (sign * reach), reach)) reach += 0.5;
            free[side].push_back(std::min(reach, furthest));
        }
    });
    return {median(std::move(free[0])), median(std::move(free[1]))};
}

// One row per place along the chain, offsets by steps of half a texel, or in proportion where the line is narrower or wider
// than elsewhere; the mean of both ends is subtracted, so that a line that runs over soft or stepped ground still has one
// section.
struct Rows {
    int left = 0;                             // columns before the one at offset 0
    std::vector<std::vector<float>> columns;  // per offset
    std::vector<float> tilts;
};

// A line may grow deeper along its way, and is one line all the same: takes out of the rows by how much they are deeper than
// all in the mean, as far as a few in a row are that together.
void level_depths(Rows& rows) {
    constexpr std::size_t kTogether = 8;  // rows to either side
    const std::size_t count = rows.tilts.size();
    if (count < 4 * kTogether) return;
    std::vector<double> mean, like_mean(count + 1, 0.0);  // the latter summed up over the rows before
    double square = 0.0;
    for (const std::vector<float>& column : rows.columns) {
        mean.push_back(std::accumulate(column.begin(), column.end(), 0.0) / static_cast<double>(count));
        square += mean.back() * mean.back();
        for (std::size_t i = 0; i < count; ++i) like_mean[i + 1] += mean.back() * column[i];
    }
    if (square <= 0.0) return;
    std::partial_sum(like_mean.begin(), like_mean.end(), like_mean.begin());
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i - std::min(i, kTogether), last = std::min(count, i + kTogether + 1);
        const double times = (like_mean[last] - like_mean[first]) / (square * static_cast<double>(last - first));
        for (std::size_t k = 0; k < rows.columns.size(); ++k)
            rows.columns[k][i] -= static_cast<float>((std::max(0.0, times) - 1.0) * mean[k]);
    }
}

constexpr double kPoint = 1.0;  // half-width below which a taper is but blur

// No other chain comes near; on one side none does, which stands for both (they are as wide); any.
enum class Places : std::uint8_t { alone, one_sided, all };
const std::vector<Places> kUsualPlaces{Places::alone, Places::all};

Rows sample_sections(const Chain& chain, std::int32_t self, const Surroundings& around, Reach reach, Places places) {
    Rows rows;
    rows.left = static_cast<int>(std::ceil(reach.left / 0.5));
    const int right = static_cast<int>(std::ceil(reach.right / 0.5));
    rows.columns.resize(static_cast<std::size_t>(rows.left + right + 1));
    std::vector<float> row(rows.columns.size());
    // Of a long chain some hundreds of places tell as much as all.
    const std::size_t stride = std::max<std::size_t>(1, chain.points.size() / 1000);
    for (std::size_t i = 0; i + 1 < chain.points.size(); i += stride) {
        const Vec2 a = chain.points[i], b = chain.points[i + 1];
        const double l = length(b - a);
        // Where points are missing the chain was bridged over a crossing.
        if (l == 0.0 || (places != Places::all && l > kBridge)) continue;
        const Vec2 normal = normal_of(unit(b - a));
        const double half_width = chain.half_width_at(i);
        if (!chain.half_widths.empty() && half_width < kPoint) continue;
        const double step = 0.5 * half_width / chain.half_width;
        const int pieces = std::max(1, static_cast<int>(l / 2.0));
        for (int piece = 0; piece < pieces; ++piece) {
            const Vec2 p = lerp(a, b, (piece + 0.5) / pieces);
            bool disturbed[2] = {false, false};
            for (int k = -rows.left; k <= right; ++k) {
                const Vec2 q = p + normal * (k * step);
                disturbed[k > 0] |= is_beside(half_width, self, around, q, k * step);
                row[static_cast<std::size_t>(k + rows.left)] = sample(around.map, around.lattice, q);
            }
            if (places == Places::alone && (disturbed[0] || disturbed[1])) continue;
            if (places == Places::one_sided) {
                if (disturbed[0] && disturbed[1]) continue;
                if (disturbed[0]) std::reverse_copy(row.end() - rows.left, row.end(), row.begin());
                if (disturbed[1]) std::reverse_copy(row.begin(), row.begin() + right, row.end() - right);
            }
            const float ground = 0.5f * (row.front() + row.back());
            rows.tilts.push_back(row.back() - row.front());
            for (std::size_t k = 0; k < row.size(); ++k) rows.columns[k].push_back(row[k] - ground);
        }
    }
    return rows;
}

enum class Depths : std::uint8_t { as_they_are, levelled };

CrossSection measure_cross_section(const Chain& chain, std::int32_t self, const Surroundings& around, Reach reach,
                                   const std::vector<Places>& choice, Depths depths = Depths::as_they_are) {
    constexpr std::size_t kEnough = 4;
    Rows rows;
    for (const Places places : choice) {
        rows = sample_sections(chain, self, around, reach, places);
        if (rows.tilts.size() >= kEnough) break;
    }
    if (depths == Depths::levelled) level_depths(rows);
    std::vector<float>& tilts = rows.tilts;
    std::vector<std::vector<float>>& columns = rows.columns;
    CrossSection section;
    if (tilts.size() < 2) return section;
    std::nth_element(tilts.begin(), tilts.begin() + static_cast<std::ptrdiff_t>(tilts.size() / 2), tilts.end());
    section.tilt = tilts[tilts.size() / 2];
    // Lines that cross this one and specks are outliers: the residual is taken over the middle 80 % of each offset.
    std::vector<double> height;
    double left = 0.0, mean = 0.0, model = 0.0;
    for (auto& column : columns) {
        const std::size_t cut = column.size() / 10;
        const auto middle = column.begin() + static_cast<std::ptrdiff_t>(column.size() / 2);
        std::nth_element(column.begin(), middle, column.end());
        const double median = *middle;
        if (cut > 0) {
            std::nth_element(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(cut), middle);
            std::nth_element(middle + 1, column.end() - static_cast<std::ptrdiff_t>(cut), column.end());
        }
        height.push_back(median);
        mean += median / static_cast<double>(columns.size());
        double sum = 0.0;
        for (std::size_t i = cut; i < column.size() - cut; ++i) sum += (column[i] - median) * (column[i] - median);
        left += sum / static_cast<double>(column.size() - 2 * cut);
    }
    for (const double h : height) model += (h - mean) * (h - mean);
    section.depth = std::fabs(height[static_cast<std::size_t>(rows.left)] - 0.5 * (height.front() + height.back()));
    section.explained = model + left > 0.0 ? model / (model + left) : 0.0;
    section.wobble = 0.5 * left / std::max(1e-9, section.depth * section.depth);
    return section;
}

constexpr double kBroad = 6.0;  // half-width in texels
constexpr double kMostly = 0.55, kClearly = 0.93, kWholly = 0.98;  // share of a section that is one and the same

// A line has one section all along it, and the same ground on both sides. What fails this is the rim of a plateau or a
// blob, which the step contours describe better; and so do they a wide line whose rims are ragged.
bool has_one_section(const Chain& chain, std::int32_t self, const Surroundings& around, Reach reach,
                     const std::vector<Places>& choice = kUsualPlaces, Depths depths = Depths::as_they_are,
                     double least_explained = kMostly) {
    const double noise = around.noise;
    const CrossSection section = measure_cross_section(chain, self, around, reach, choice, depths);
    // A closing that does not span the line fills only a part of it: it is wider than it looks.
    if (chain.half_width > 2.0 && chain.contrast < 0.93 * section.depth) return false;
    const double grain = 0.5 * (2.0 * (reach.left + reach.right) + 1.0) * (noise / section.depth) * (noise / section.depth);
    const double most_wobble = chain.half_width > kBroad ? 0.05 : 0.13;
    const bool straight_rims = chain.half_width < 2.5 || section.wobble - grain < most_wobble;
    return section.depth > std::max(3.0 * noise, 0.012) && std::fabs(section.tilt) < 0.35 * section.depth &&
           section.explained > least_explained && straight_rims;
}

// A line with level ground to both sides: far, or as far as the next line, if that leaves ground wider than the line. A
// small square fills only the bottom of a wide line or the corner of an area, and the ground between two lines looks like a
// line of the other sign, wider than they are: those are none.
bool stands_alone(const Chain& chain, std::int32_t self, const Surroundings& around) {
    if (chain_length(chain) < 6.0 * chain.half_width + 8.0) return false;
    const double far = 3.0 * chain.half_width + 4.0;
    const double least = std::min(far, std::max(chain.half_width + 2.0, 2.2 * chain.half_width));
    const Reach reach = free_reach(chain, self, around, far);
    if (std::min(reach.left, reach.right) < least) return false;
    const CrossSection section = measure_cross_section(chain, self, around, reach, kUsualPlaces);
    return section.depth > 0.9 * chain.contrast && std::fabs(section.tilt) < 0.2 * section.depth &&
           section.explained > kClearly;
}

// Whether much of a chain was bridged: it crosses others at small angles.
bool crosses_long(const Chain& chain) {
    constexpr double kMuch = 0.3;
    double bridged = 0.0;
    for (std::size_t i = 1; i < chain.points.size(); ++i) {
        const double gap = length(chain.points[i] - chain.points[i - 1]);
        if (gap > kBridge) bridged += gap;
    }
    return bridged > kMuch * chain_length(chain);
}

bool is_line(const Chain& chain, std::int32_t self, const Surroundings& around) {
    const double extent = chain_length(chain) + 2.0 * chain.half_width;
    if (extent < 3.0 * chain.half_width + 3.0 || chain.contrast < 3.0 * around.noise) return false;
    // A short broad bar, or a broad piece of a net of joints, is an area with a rim.
    if (chain.half_width > kBroad && extent < 20.0 * chain.half_width) return false;
    const double near = std::max(3.0, 1.6 * chain.half_width + 1.5);
    if (has_one_section(chain, self, around, {near, near})) return true;
    // Where another line lies nearer, the ground is what is left between the two.
    const Reach free = free_reach(chain, self, around, near);
    const double least = chain.half_width + 1.0;
    if (std::min(free.left, free.right) < near &&
        has_one_section(chain, self, around, {std::max(least, free.left), std::max(least, free.right)}))
        return true;
    // A line that crosses another at a small angle has that one first on one side, then on the other.
    if (crosses_long(chain) &&
        has_one_section(chain, self, around, {near, near}, {Places::one_sided}, Depths::as_they_are, kClearly))
        return true;
    // Depths that vary are a long line's own where nothing else does.
    if (extent > 20.0 * chain.half_width + 20.0 &&
        has_one_section(chain, self, around, {near, near}, kUsualPlaces, Depths::levelled, kWholly))
        return true;
    // A thin line may have a rim of its own on one side: there the ground lies farther out. The rim of an area has too.
    const double far = 4.0 * near;
    return chain.half_width <= 1.5 && chain_length(chain) > far && has_one_section(chain, self, around, {far, far});
}

// Whether the map is as deep (high) between two points of a chain as it is at them.
bool goes_on(const Chain& chain, Vec2 a, Vec2 b, const Surroundings& around) {
    const auto value = [&](Vec2 p) { return static_cast<double>(sample(around.map, around.lattice, p)); };
    const double least = std::min(value(a), value(b)) - 0.3 * chain.contrast;
    const double most = std::max(value(a), value(b)) + 0.3 * chain.contrast;
    const int steps = static_cast<int>(std::ceil(length(b - a)));
    for (int k = 1; k < steps; ++k) {
        const double v = value(lerp(a, b, static_cast<double>(k) / steps));
        if (v < least || v > most) return false;
    }
    return true;
}

// A chain whose points were mostly dropped as unsteady was bridged over noise; where lines cross at a small angle, it goes
// on although nothing can be measured.
bool is_supported(const Chain& chain, const Surroundings& around) {
    double bridged = 0.0;
    for (std::size_t i = 1; i < chain.points.size(); ++i) {
        const double gap = length(chain.points[i] - chain.points[i - 1]);
        const double plain = 6.0 * chain.half_width + 4.0;
        if (gap <= kBridge) continue;
        bridged += kBridge;
        if (gap > plain && !goes_on(chain, chain.points[i - 1], chain.points[i], around)) bridged += gap - plain;
    }
    return chain.points.size() >= 4 && bridged < 0.4 * chain_length(chain);
}

double chain_energy(const Chain& chain) {
    return chain_length(chain) * 2.0 * (chain.half_width + 0.25) * chain.contrast * chain.contrast;
}

// Where along a chain its depth changes most: the index of the first point behind the change. A groove that runs from a
// plateau over its rim is two lines of different depth.
std::size_t find_change(const Chain& chain, const Image& map, const Lattice& lattice) {
    const double reach = std::max(3.0, 1.6 * chain.half_width + 1.5);
    std::vector<double> sums{0.0};
    for (std::size_t i = 0; i < chain.points.size(); ++i) {
        const Vec2 a = chain.points[i > 0 ? i - 1 : 0], b = chain.points[std::min(i + 1, chain.points.size() - 1)];
        const Vec2 n = normal_of(unit(b - a)), p = chain.points[i];
        const double ground = 0.5 * (sample(map, lattice, p + n * reach) + sample(map, lattice, p - n * reach));
        sums.push_back(sums.back() + std::fabs(ground - sample(map, lattice, p)));
    }
    const std::size_t n = chain.points.size(), margin = std::max<std::size_t>(4, n / 12);
    double best = 0.0;
    std::size_t at = 0;
    for (std::size_t k = margin; k + margin < n; ++k) {
        const double first = sums[k] / static_cast<double>(k);
        const double second = (sums[n] - sums[k]) / static_cast<double>(n - k);
        const double gain = (first - second) * (first - second) * static_cast<double>(k * (n - k));
        if (gain > best) best = gain, at = k;
    }
    return at;
}

double widest_of(const Chain& chain) {
    return chain.half_widths.empty() ? chain.half_width : *std::max_element(chain.half_widths.begin(), chain.half_widths.end());
}

struct Kept {
    std::vector<Chain> lines;
    bool is_whole = false;  // the chain is a line, whether this scale takes it or a wider one will
};

// A chain that is a line; of one that is not, the parts before and behind its greatest change that are.
Kept keep_parts(const Chain& whole, std::int32_t self, const Surroundings& around, double least_energy,
                const LineScale& scale) {
    struct Part {
        Chain chain;
        int splits = 0;
    };
    Kept kept;
    std::vector<Part> stack{{whole, 0}};
    while (!stack.empty()) {
        auto [chain, splits] = std::move(stack.back());
        stack.pop_back();
        if (chain_energy(chain) < least_energy) continue;
        const bool is_one = is_supported(chain, around) && is_line(chain, self, around);
        if (splits == 0) kept.is_whole = is_one;
        if (is_one && (scale.radius == scale.widest ||
                       (widest_of(chain) <= 0.6 * scale.radius && stands_alone(chain, self, around)))) {
            kept.lines.push_back(std::move(chain));
            continue;
        }
        // A line that was followed over a crossing of small angle waits for a wider look as a whole.
        const bool waits = is_one && crosses_long(chain);
        const bool splits_well = !waits && splits < 3 && !chain.closed && chain.points.size() >= 24 &&
                                 chain.half_width <= kBroad && chain.half_widths.empty();
        const std::size_t at = splits_well ? find_change(chain, around.map, around.lattice) : 0;
        if (at == 0) continue;
        Chain second = chain;
        second.points.erase(second.points.begin(), second.points.begin() + static_cast<std::ptrdiff_t>(at));
        second.start_tie = EndTie::free;
        chain.points.resize(at);
        chain.end_tie = EndTie::free;
        stack.push_back({std::move(second), splits + 1});
        stack.push_back({std::move(chain), splits + 1});
    }
    return kept;
}

// The part of the mask that a chain lies in.
std::int64_t part_of(const Chain& chain, const std::vector<std::uint8_t>& mask, const Parts& parts, const Lattice& lattice) {
    for (const Vec2 p : chain.points) {
        const int texel = lattice.nearest(p);
        if (mask[texel]) return parts.runs[parts.find(texel % lattice.width, texel / lattice.width)].part;
    }
    return -1;
}

// Lines that hang together are found together: without the others, those that wait for a wider look would be torn. With a
// line wait all that share a node with it, and the whole shape when much of it waits.
void wait_with_others(const std::vector<Chain>& chains, const std::vector<std::int64_t>& shape, const Lattice& lattice,
                      std::vector<std::uint8_t>& waits) {
    constexpr double kMuch = 0.25;
    std::map<std::int64_t, std::pair<double, double>> energy;  // per shape: of all lines, of those that wait
    std::map<int, std::vector<std::size_t>> at_node;           // by the node's texel
    for (std::size_t c = 0; c < chains.size(); ++c) {
        energy[shape[c]].first += chain_energy(chains[c]);
        if (waits[c]) energy[shape[c]].second += chain_energy(chains[c]);
        const auto add = [&](Vec2 p) {
            at_node[lattice.nearest(p)].push_back(c);
        };
        if (chains[c].start_tie == EndTie::node) add(chains[c].points.front());
        if (chains[c].end_tie == EndTie::node) add(chains[c].points.back());
    }
    for (std::size_t c = 0; c < chains.size(); ++c)
        if (energy[shape[c]].second > kMuch * energy[shape[c]].first) waits[c] = 1;
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [texel, touching] : at_node) {
            const auto waiting = std::count_if(touching.begin(), touching.end(), [&](std::size_t c) { return waits[c] != 0; });
            if (waiting == 0 || waiting == static_cast<std::ptrdiff_t>(touching.size())) continue;
            for (const std::size_t c : touching) waits[c] = 1;
            changed = true;
        }
    }
}

}  // namespace

std::vector<Chain> keep_lines(const std::vector<Chain>& chains, const std::vector<std::uint8_t>& mask, const Parts& shapes,
                              const Image& map, const Lattice& lattice, double noise, double least_energy,
                              const LineScale& scale) {
    const std::vector<std::int32_t> owner = claim_texels(chains, lattice);
    const Surroundings around{map, lattice, owner, noise};
    std::vector<Kept> kept_of(chains.size());
    std::vector<std::int64_t> shape(chains.size());
    std::vector<std::uint8_t> waits(chains.size(), 0);
    for_each_piece(chains.size(), lattice.threads, [&](std::size_t c) {
        kept_of[c] = keep_parts(chains[c], static_cast<std::int32_t>(c), around, least_energy, scale);
        shape[c] = part_of(chains[c], mask, shapes, lattice);
        waits[c] = scale.radius < scale.widest && kept_of[c].lines.empty() && kept_of[c].is_whole;
    });
    wait_with_others(chains, shape, lattice, waits);
    std::vector<Chain> kept;
    for (std::size_t c = 0; c < chains.size(); ++c)
        if (!waits[c]) std::move(kept_of[c].lines.begin(), kept_of[c].lines.end(), std::back_inserter(kept));
    return kept;
}

}  // namespace burin::vectorizing
