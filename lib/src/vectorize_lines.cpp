// Grooves and ridges: what a closing (or opening) fills is narrower than its square; the mask of what was filled is
// thinned to centre lines, which are then measured and joined.
#include "vectorize_hat.hpp"
#include "vectorize_skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

// The connected parts of a mask, without those whose area or summed response is that of a speck.
Parts find_shapes(std::vector<std::uint8_t>& mask, const Image& response, const Lattice& lattice, double least_energy) {
    const auto row_of = [&](auto& texels, int y) { return &texels[static_cast<std::size_t>(y) * lattice.width]; };
    Parts parts = find_parts(lattice, true, [&](int x, int y) { return row_of(mask, y)[x]; });
    std::vector<std::uint32_t> area(parts.count, 0);
    std::vector<double> energy(parts.count, 0.0);
    for_each_run(parts, [&](int y, const Run& run) {
        area[run.part] += static_cast<std::uint32_t>(run.end - run.begin);
        for (int x = run.begin; x < run.end; ++x) energy[run.part] += row_of(response.texels, y)[x] * row_of(response.texels, y)[x];
    });
    Parts kept;
    kept.count = parts.count;
    kept.row_start.assign(parts.row_start.size(), 0);
    for_each_run(parts, [&](int y, const Run& run) {
        const bool speck = area[run.part] < 8 || energy[run.part] < least_energy;
        std::fill(row_of(mask, y) + run.begin, row_of(mask, y) + run.end, speck ? 0 : Mask::shape | Mask::thin);
        if (speck) return;
        kept.runs.push_back(run);
        kept.row_start[static_cast<std::size_t>(y) + 1] = kept.runs.size();
    });
    for (std::size_t y = 1; y < kept.row_start.size(); ++y)
        kept.row_start[y] = std::max(kept.row_start[y], kept.row_start[y - 1]);
    return kept;
}

// Calls visit(point, normal) about once a texel along the chain.
template <typename Visit>
void for_each_place(const Chain& chain, const Visit& visit) {
    for (std::size_t i = 0; i + (chain.closed ? 0 : 1) < chain.points.size(); ++i) {
        const Vec2 a = chain.points[i];
        const Vec2 b = i + 1 < chain.points.size() ? chain.points[i + 1] : chain.points.front() + chain.winding;
        if (length(b - a) == 0.0) continue;
        const int pieces = std::max(1, static_cast<int>(std::ceil(length(b - a))));
        for (int piece = 0; piece <= pieces; ++piece)
            visit(lerp(a, b, static_cast<double>(piece) / pieces), normal_of(unit(b - a)));
    }
}

// Calls visit(index, centre) for the texels within `reach` of p; the centre is the one near p on a map that tiles.
template <typename Visit>
void for_each_texel_near(Vec2 p, const Lattice& lattice, int reach, const Visit& visit) {
    const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
            const int j = dx * dx + dy * dy <= reach * reach ? lattice.index(x + dx, y + dy) : -1;
            if (j >= 0) visit(j, Vec2{x + dx + 0.5, y + dy + 0.5});
        }
}

double chain_length(const Chain& chain) {
    double sum = 0.0;
    for (std::size_t i = 1; i < chain.points.size(); ++i) sum += length(chain.points[i] - chain.points[i - 1]);
    return sum;
}

constexpr std::int32_t kNobody = -1, kSeveral = -2;

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

// Which chain each texel is a part of: its index, nobody's, or several chains'.
std::vector<std::int32_t> claim_texels(const std::vector<Chain>& chains, const Lattice& lattice) {
    std::vector<std::int32_t> owner(static_cast<std::size_t>(lattice.size()), kNobody);
    for (std::size_t c = 0; c < chains.size(); ++c) {
        MovingDisc disc(static_cast<int>(std::ceil(chains[c].half_width + 1.0)));
        for_each_place(chains[c], [&](Vec2 p, Vec2) {
            disc.move_to(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)), [&](int x, int y) {
                const int texel = lattice.index(x, y);
                if (texel < 0) return;
                const bool free = owner[texel] == kNobody || owner[texel] == static_cast<std::int32_t>(c);
                owner[texel] = free ? static_cast<std::int32_t>(c) : kSeveral;
            });
        });
    }
    return owner;
}

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

// One row per place along the chain, offsets -n..n steps of half a texel; the mean of both ends is subtracted, so that
// a line that runs over soft or stepped ground still has one section.
struct Rows {
    std::vector<std::vector<float>> columns;  // per offset
    std::vector<float> tilts;
};

// `alone`: only places where no other chain comes near.
Rows sample_sections(const Chain& chain, std::int32_t self, const Surroundings& around, int n, bool alone) {
    Rows rows;
    rows.columns.resize(static_cast<std::size_t>(2 * n + 1));
    std::vector<float> row(rows.columns.size());
    // Of a long chain some hundreds of places tell as much as all.
    const std::size_t stride = std::max<std::size_t>(1, chain.points.size() / 1000);
    for (std::size_t i = 0; i + 1 < chain.points.size(); i += stride) {
        const Vec2 a = chain.points[i], b = chain.points[i + 1];
        const double l = length(b - a);
        // Where points are missing the chain was bridged over a crossing.
        if (l == 0.0 || (alone && l > kBridge)) continue;
        const Vec2 normal = normal_of(unit(b - a));
        const int pieces = std::max(1, static_cast<int>(l / 2.0));
        for (int piece = 0; piece < pieces; ++piece) {
            const Vec2 p = lerp(a, b, (piece + 0.5) / pieces);
            bool disturbed = false;
            for (int k = -n; k <= n; ++k) {
                const Vec2 q = p + normal * (k * 0.5);
                const auto owner = around.owner[around.lattice.nearest(int(std::floor(q.x)), int(std::floor(q.y)))];
                disturbed |= owner != kNobody && owner != self;
                row[k + n] = sample(around.map, around.lattice, q);
            }
            if (alone && disturbed) continue;
            const float ground = 0.5f * (row.front() + row.back());
            rows.tilts.push_back(row.back() - row.front());
            for (std::size_t k = 0; k < row.size(); ++k) rows.columns[k].push_back(row[k] - ground);
        }
    }
    return rows;
}

CrossSection measure_cross_section(const Chain& chain, std::int32_t self, const Surroundings& around, double reach) {
    constexpr std::size_t kEnoughAlone = 4;
    const int n = static_cast<int>(std::ceil(reach / 0.5));
    Rows rows = sample_sections(chain, self, around, n, true);
    if (rows.tilts.size() < kEnoughAlone) rows = sample_sections(chain, self, around, n, false);
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
    section.depth = std::fabs(height[static_cast<std::size_t>(n)] - 0.5 * (height.front() + height.back()));
    section.explained = model + left > 0.0 ? model / (model + left) : 0.0;
    section.wobble = 0.5 * left / std::max(1e-9, section.depth * section.depth);
    return section;
}

constexpr double kBroad = 6.0;  // half-width in texels

// A line has one section all along it, and the same ground on both sides. What fails this is the rim of a plateau or a
// blob, which the step contours describe better; and so do they a wide line whose rims are ragged.
bool is_line(const Chain& chain, std::int32_t self, const Surroundings& around) {
    const double noise = around.noise;
    const double extent = chain_length(chain) + 2.0 * chain.half_width;
    if (extent < 3.0 * chain.half_width + 3.0 || chain.contrast < 3.0 * noise) return false;
    // A short broad bar, or a broad piece of a net of joints, is an area with a rim.
    if (chain.half_width > kBroad && extent < 20.0 * chain.half_width) return false;
    // A thin line may have a rim of its own on one side: there the ground lies farther out.
    const double near = std::max(3.0, 1.6 * chain.half_width + 1.5);
    for (const double reach : {near, 4.0 * near}) {
        if (reach > near && chain.half_width > 1.5) return false;
        const CrossSection section = measure_cross_section(chain, self, around, reach);
        // A closing that does not span the line fills only a part of it: it is wider than it looks.
        if (chain.half_width > 2.0 && chain.contrast < 0.93 * section.depth) return false;
        const double grain = 0.5 * (4.0 * reach + 1.0) * (noise / section.depth) * (noise / section.depth);
        const double most_wobble = chain.half_width > kBroad ? 0.05 : 0.13;
        const bool straight_rims = chain.half_width < 2.5 || section.wobble - grain < most_wobble;
        if (section.depth > std::max(3.0 * noise, 0.012) && std::fabs(section.tilt) < 0.35 * section.depth &&
            section.explained > 0.55 && straight_rims)
            return true;
    }
    return false;
}

float sign_of(ChainKind kind) { return kind == ChainKind::groove ? 1.0f : -1.0f; }

// A chain whose points were mostly dropped as unsteady was bridged over noise.
bool is_supported(const Chain& chain) {
    double bridged = 0.0;
    for (std::size_t i = 1; i < chain.points.size(); ++i) {
        const double gap = length(chain.points[i] - chain.points[i - 1]);
        if (gap > kBridge) bridged += gap - std::min(gap, 6.0 * chain.half_width + 4.0) + kBridge;
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

// A line with level ground far to both sides. A small square fills only the bottom of a wide line or the corner of an
// area, and the ground between two lines looks like a line of the other sign: those are none.
bool stands_alone(const Chain& chain, std::int32_t self, const Surroundings& around, double radius) {
    if (chain.half_width > 0.6 * radius || chain_length(chain) < 6.0 * chain.half_width + 8.0) return false;
    const CrossSection section = measure_cross_section(chain, self, around, 3.0 * chain.half_width + 4.0);
    return section.depth > 0.9 * chain.contrast && std::fabs(section.tilt) < 0.2 * section.depth &&
           section.explained > 0.93;
}

// A chain that is a line; of one that is not, the parts before and behind its greatest change that are.
std::vector<Chain> keep_lines(const Chain& whole, std::int32_t self, const Surroundings& around, double least_energy,
                              const LineScale& scale) {
    struct Part {
        Chain chain;
        int splits = 0;
    };
    std::vector<Chain> kept;
    std::vector<Part> stack{{whole, 0}};
    while (!stack.empty()) {
        auto [chain, splits] = std::move(stack.back());
        stack.pop_back();
        if (chain_energy(chain) < least_energy) continue;
        if (is_supported(chain) && is_line(chain, self, around) &&
            (scale.radius == scale.widest || stands_alone(chain, self, around, scale.radius))) {
            kept.push_back(std::move(chain));
            continue;
        }
        const bool splits_well = splits < 3 && !chain.closed && chain.points.size() >= 24 && chain.half_width <= kBroad;
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

std::vector<Chain> keep_lines(const std::vector<Chain>& chains, const Image& map, const Lattice& lattice, double noise,
                              double least_energy, const LineScale& scale) {
    const std::vector<std::int32_t> owner = claim_texels(chains, lattice);
    const Surroundings around{map, lattice, owner, noise};
    std::vector<std::vector<Chain>> parts(chains.size());
    for_each_piece(chains.size(), lattice.threads, [&](std::size_t c) {
        parts[c] = keep_lines(chains[c], static_cast<std::int32_t>(c), around, least_energy, scale);
    });
    std::vector<Chain> kept;
    for (std::vector<Chain>& some : parts) std::move(some.begin(), some.end(), std::back_inserter(kept));
    return kept;
}

// A letter of broad strokes is lines as a whole or an area as a whole: where the bands of its lines are not what the mask
// shows, because strokes are missing, lie beside it, or swell and taper, all its broad lines go; and where most of them are
// so wide that the square touches the feet of their walls and takes only a part of them.
void drop_partial_shapes(std::vector<Chain>& chains, const std::vector<std::uint8_t>& mask, const Parts& parts,
                         const Lattice& lattice, double radius) {
    constexpr double kBroadStroke = 2.5, kMostMismatch = 0.1, kMostOutside = 0.04, kTooWide = 0.82;
    // 1: within a line's band, a texel of doubt included; 2: well within it.
    std::vector<std::uint8_t> band(mask.size(), 0);
    const auto part_at = [&](int texel) {
        const std::size_t run = parts.find(texel % lattice.width, texel / lattice.width);
        return mask[texel] ? static_cast<std::int32_t>(parts.runs[run].part) : -1;
    };
    std::vector<std::int32_t> part_of(chains.size(), -1);
    for (std::size_t c = 0; c < chains.size(); ++c)
        for_each_place(chains[c], [&](Vec2 p, Vec2) {
            const double half_width = chains[c].half_width;
            for_each_texel_near(p, lattice, static_cast<int>(std::ceil(half_width + 1.0)), [&](int texel, Vec2 centre) {
                const double distance = length(centre - p);
                if (part_of[c] < 0 && distance < 1.0) part_of[c] = part_at(texel);
                if (distance > half_width + 1.0) return;
                band[texel] = std::max<std::uint8_t>(band[texel], distance < half_width - 1.0 ? 2 : 1);
            });
        });
    struct Area {
        double whole = 0.0, different = 0.0, outside = 0.0;  // of the mask; of what differs; of lines where it has nothing
    };
    std::map<std::int32_t, Area> area;
    for_each_run(parts, [&](int y, const Run& run) {
        const auto row = band.begin() + static_cast<std::ptrdiff_t>(y) * lattice.width;
        Area& part = area[static_cast<std::int32_t>(run.part)];
        part.whole += run.end - run.begin;
        part.different += static_cast<double>(std::count(row + run.begin, row + run.end, 0));
    });
    for (std::size_t c = 0; c < chains.size(); ++c)
        for_each_place(chains[c], [&](Vec2 p, Vec2) {
            for_each_texel_near(p, lattice, static_cast<int>(std::ceil(chains[c].half_width)), [&](int texel, Vec2) {
                if (band[texel] != 2 || mask[texel] || part_of[c] < 0) return;
                band[texel] = 0;
                area[part_of[c]].different += 1.0;
                area[part_of[c]].outside += 1.0;
            });
        });
    struct Drawn {
        double all = 0.0, broad = 0.0, too_wide = 0.0;  // areas of lines
    };
    std::map<std::int32_t, Drawn> drawn;
    for (std::size_t c = 0; c < chains.size(); ++c) {
        const double size = chain_length(chains[c]) * chains[c].half_width;
        Drawn& part = drawn[part_of[c]];
        part.all += size;
        if (chains[c].half_width > kBroadStroke) part.broad += size;
        if (chains[c].half_width > kTooWide * radius) part.too_wide += size;
    }
    std::size_t c = 0;
    std::erase_if(chains, [&](const Chain& chain) {
        const std::int32_t label = part_of[c++];
        const Drawn& part = drawn[label];
        const Area& shown = area[label];
        const bool is_area = shown.different > kMostMismatch * shown.whole || shown.outside > kMostOutside * shown.whole ||
                             part.too_wide > 0.5 * part.all;
        // The hairlines of a letter go with its strokes; a net of thin lines does not go with the blobs on it.
        const bool is_broad = part.broad > 0.5 * part.all;
        return is_area && (is_broad || chain.half_width > kBroadStroke);
    });
}

// Whether something deeper than the ground, and no other chain, lies beside a place of a chain: there the chain crosses an
// area or a line that is still to be found, and takes nothing away.
bool crosses_unknown(const Chain& chain, Vec2 p, Vec2 normal, const Image& response, const Lattice& lattice,
                     const std::vector<std::int32_t>& owner) {
    const double beside = 1.6 * chain.half_width + 1.5;
    for (const double side : {-beside, beside}) {
        const Vec2 q = p + normal * side;
        const int texel = lattice.nearest(static_cast<int>(std::floor(q.x)), static_cast<int>(std::floor(q.y)));
        if (owner[texel] == kNobody && sample(response, lattice, q) > 0.5 * chain.contrast) return true;
    }
    return false;
}

// Calls visit(index, centre) as for_each_texel_near, for the texels no farther than one from the normal at p.
template <typename Visit>
void for_each_texel_across(Vec2 p, Vec2 normal, const Lattice& lattice, int reach, const Visit& visit) {
    const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
    for (int dy = -reach; dy <= reach; ++dy) {
        int first = -reach, last = reach;
        if (std::fabs(normal.y) > 0.01) {
            const double middle = (y + dy + 0.5 - p.y) * normal.x / normal.y + p.x - 0.5 - x, half = 1.0 / std::fabs(normal.y);
            first = std::max(first, static_cast<int>(std::floor(middle - half)));
            last = std::min(last, static_cast<int>(std::ceil(middle + half)));
        }
        for (int dx = first; dx <= last; ++dx) {
            const Vec2 centre{x + dx + 0.5, y + dy + 0.5};
            if (dx * dx + dy * dy > reach * reach || std::fabs(cross(centre - p, normal)) > 1.0) continue;
            const int j = lattice.index(x + dx, y + dy);
            if (j >= 0) visit(j, centre);
        }
    }
}

// The texels of the lines, each once.
std::vector<int> covered_texels(const Image& response, const Lattice& lattice, const std::vector<Chain>& chains,
                                const std::vector<std::int32_t>& owner) {
    std::vector<std::uint8_t> covered(response.texels.size(), 0);
    std::vector<int> texels;
    const auto cover = [&](int texel, Vec2) {
        if (!covered[texel]) texels.push_back(texel);
        covered[texel] = 1;
    };
    for (const Chain& chain : chains) {
        const int reach = static_cast<int>(std::ceil(1.5 * chain.half_width + 2.0));
        for_each_place(chain, [&](Vec2 p, Vec2 normal) {
            if (crosses_unknown(chain, p, normal, response, lattice, owner)) return;
            const bool at_end = !chain.closed && (p == chain.points.front() || p == chain.points.back());
            // Beyond the place itself only at the ends: the next one may cross something.
            if (at_end)
                for_each_texel_near(p, lattice, reach, cover);
            else
                for_each_texel_across(p, normal, lattice, reach, cover);
        });
    }
    return texels;
}

void change_texel(Image& map, int texel, float change, Erased& erased) {
    map.texels[texel] += change;
    erased.push_back({texel, change});
}

// Where two thin lines cross, a small square may find no level ground: what is left there of the filled texels is filled by
// a large one.
void erase_crossings(Image& map, const Lattice& lattice, const std::vector<std::int32_t>& owner,
                     const std::vector<int>& covered, ChainKind kind, const LineScale& scale, double least, Erased& erased) {
    const int near = 2 * square_radius(scale.radius);
    // Texels beside a crossing in its row; those above and below are looked for from where it matters.
    std::vector<std::uint8_t> beside(owner.size(), 0);
    for (int i = 0; i < lattice.size(); ++i)
        for (int dx = -near; owner[i] == kSeveral && dx <= near; ++dx)
            beside[lattice.nearest(i % lattice.width + dx, i / lattice.width)] = 1;
    const auto is_near_crossing = [&](int texel) {
        for (int dy = -near; dy <= near; ++dy)
            if (beside[lattice.nearest(texel % lattice.width, texel / lattice.width + dy)]) return true;
        return false;
    };
    std::vector<int> texels;
    std::copy_if(covered.begin(), covered.end(), std::back_inserter(texels), is_near_crossing);
    const std::vector<float> left = hat_at(map, lattice, kind, square_radius(scale.widest), least, texels);
    for (std::size_t k = 0; k < texels.size(); ++k) change_texel(map, texels[k], sign_of(kind) * left[k], erased);
}

// Fills the lines' texels to the height of the ground beside them, which is what the closing (opening) holds.
void erase_lines(Image& map, const Image& response, const Lattice& lattice, const std::vector<Chain>& chains, ChainKind kind,
                 const LineScale& scale, double least, Erased& erased) {
    const std::vector<std::int32_t> owner = claim_texels(chains, lattice);
    const std::vector<int> covered = covered_texels(response, lattice, chains, owner);
    for (const int texel : covered) change_texel(map, texel, sign_of(kind) * response.texels[texel], erased);
    if (scale.radius < scale.widest) erase_crossings(map, lattice, owner, covered, kind, scale, least, erased);
}

}  // namespace

Image line_response(const Image& map, const Lattice& lattice, ChainKind kind, double radius, double noise) {
    return hat_response(map, lattice, kind, square_radius(radius), least_response(noise));
}

double line_energy(const Image& response, double noise) {
    const float least = static_cast<float>(least_response(noise));
    double sum = 0.0;
    for (const float v : response.texels)
        if (v > least) sum += static_cast<double>(v) * v;
    return sum;
}

Image restored_response(Image& map, const Erased& erased, const Lattice& lattice, ChainKind kind, double radius, double noise) {
    std::vector<float> values;  // as they are now, to be put back exactly
    for (const auto& [texel, change] : erased) {
        values.push_back(map.texels[texel]);
        map.texels[texel] -= change;
    }
    Image response = line_response(map, lattice, kind, radius, noise);
    for (std::size_t k = erased.size(); k-- > 0;) map.texels[erased[k].texel] = values[k];
    return response;
}

std::vector<Chain> trace_lines(Image& map, Image response, Erased& erased, const Lattice& lattice, ChainKind kind,
                               const LineScale& scale, double noise, double energy) {
    const double least = least_response(noise);
    // A wide window would hide a shallow line where it comes near a deep one.
    const int window = std::max(4, square_radius(scale.radius) / 3);
    std::vector<std::uint8_t> mask = strong_mask(response, lattice, window, least);
    const Parts parts = find_shapes(mask, response, lattice, 24.0 * least * least);
    if (parts.runs.empty()) return {};
    thin_mask(mask, parts, lattice);
    Skeleton skeleton = trace_skeleton(mask, parts, lattice);
    Image restored;
    if (!erased.empty()) restored = restored_response(map, erased, lattice, kind, scale.radius, noise);
    const Image& whole = erased.empty() ? response : restored;
    measure_strands(skeleton, whole, lattice);
    const std::vector<Chain> all = join_strands(skeleton, whole, lattice, kind);
    restored = {};
    std::vector<Chain> chains = keep_lines(all, map, lattice, noise, 2e-5 * energy, scale);
    if (scale.radius == scale.widest) drop_partial_shapes(chains, mask, parts, lattice, scale.radius);
    if (!chains.empty()) erase_lines(map, response, lattice, chains, kind, scale, least, erased);
    return chains;
}

void tie_lines(std::vector<Chain>& chains, const Image& response, const Lattice& lattice) {
    join_facing_ends(chains, response, lattice);
    extend_to_lines(chains, response, lattice);
}

}  // namespace burin::vectorizing
