// Grooves and ridges: what a closing (or opening) fills is narrower than its square; the mask of what was filled is
// thinned to centre lines, which are then measured and joined.
#include "vectorize_candidates.hpp"
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

float sign_of(ChainKind kind) { return kind == ChainKind::groove ? 1.0f : -1.0f; }

// A letter of broad strokes is lines as a whole or an area as a whole: where the bands of its lines are not what the mask
// shows, because strokes are missing, lie beside it, or swell and taper, all its broad lines go; and where most of them are
// so wide that the square touches the feet of their walls and takes only a part of them. What earlier lines took out of
// the mask, the `whole` response still shows and the present one does not.
void drop_partial_shapes(std::vector<Chain>& chains, const std::vector<std::uint8_t>& mask, const Parts& parts,
                         const Image& response, const Image& whole, const Lattice& lattice, double radius) {
    constexpr double kBroadStroke = 2.5, kMostMismatch = 0.1, kMostOutside = 0.04, kTooWide = 0.82;
    // 1: within a line's band, a texel of doubt included; 2: well within it.
    std::vector<std::uint8_t> band(mask.size(), 0);
    const auto part_at = [&](int texel) {
        const std::size_t run = parts.find(texel % lattice.width, texel / lattice.width);
        return mask[texel] ? static_cast<std::int32_t>(parts.runs[run].part) : -1;
    };
    std::vector<std::int32_t> part_of(chains.size(), -1);
    for (std::size_t c = 0; c < chains.size(); ++c)
        for_each_place(chains[c], [&](Vec2 p, Vec2, double half_width) {
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
        for_each_place(chains[c], [&](Vec2 p, Vec2, double half_width) {
            for_each_texel_near(p, lattice, static_cast<int>(std::ceil(half_width)), [&](int texel, Vec2) {
                if (band[texel] != 2 || mask[texel] || part_of[c] < 0) return;
                const double half = 0.5 * chains[c].contrast;
                if (whole.texels[texel] > half && response.texels[texel] < half) return;
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

// A place of a line, and how the line runs there.
struct LinePlace {
    Vec2 point, normal;
    double half_width = 0.0;
};

// Whether something deeper than the ground, and no other chain, lies beside a place of a chain: there the chain crosses an
// area or a line that is still to be found, and takes nothing away.
bool crosses_unknown(const Chain& chain, const LinePlace& place, const Image& response, const Lattice& lattice,
                     const std::vector<std::int32_t>& owner) {
    const double beside = 1.6 * place.half_width + 1.5;
    for (const double side : {-beside, beside}) {
        const Vec2 q = place.point + place.normal * side;
        const int texel = lattice.nearest(q);
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

// How far a line reaches beyond the middle of a place of its chain: round the end of a line, and out to the tip of a corner.
// 0: nowhere but across.
double reach_round(const Chain& chain, std::ptrdiff_t i) {
    constexpr double kLeastTurn = 0.5;  // radians
    const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(chain.points.size());
    const double half_width = chain.half_width_at(static_cast<std::size_t>(i));
    if (!chain.closed && (i == 0 || i + 1 == count)) return covered_reach(half_width);
    const auto point = [&](std::ptrdiff_t k) {
        if (!chain.closed) return chain.points[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, count - 1))];
        if (k < 0) return chain.points[static_cast<std::size_t>(k + count)] - chain.winding;
        return k < count ? chain.points[static_cast<std::size_t>(k)] : chain.points[static_cast<std::size_t>(k - count)] + chain.winding;
    };
    // A corner that is cut off turns by and by.
    const Vec2 p = point(i);
    const double baseline = 2.0 * half_width + 2.0;
    const auto neighbour = [&](std::ptrdiff_t step) {
        std::ptrdiff_t k = i + step;
        while (std::abs(k - i) < count / 2 && length(point(k) - p) < baseline) k += step;
        return point(k);
    };
    const Vec2 a = neighbour(-1), b = neighbour(1);
    if (a == p || b == p) return 0.0;
    const double turn = std::acos(std::clamp(dot(unit(p - a), unit(b - p)), -1.0, 1.0));
    if (turn < kLeastTurn) return 0.0;
    return std::min(half_width / std::max(0.25, std::cos(0.5 * turn)) + 2.0, 4.0 * half_width + 2.0);
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
        // Beyond the place itself only where it must be: the next one may cross something.
        for_each_place(chain, [&](Vec2 p, Vec2 normal, double half_width) {
            if (crosses_unknown(chain, {p, normal, half_width}, response, lattice, owner)) return;
            for_each_texel_across(p, normal, lattice, static_cast<int>(std::ceil(covered_reach(half_width))), cover);
        });
        for (std::size_t i = 0; i < chain.points.size(); ++i) {
            const double reach = reach_round(chain, static_cast<std::ptrdiff_t>(i));
            const Vec2 p = chain.points[i], other = chain.points[i == 0 ? 1 : i - 1];
            if (reach == 0.0 || p == other) continue;
            // Beside a corner lies its own tip.
            const bool is_end = !chain.closed && (i == 0 || i + 1 == chain.points.size());
            if (!is_end || !crosses_unknown(chain, {p, normal_of(unit(p - other)), chain.half_width_at(i)}, response, lattice, owner))
                for_each_texel_near(p, lattice, static_cast<int>(std::ceil(reach)), cover);
        }
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
    std::vector<Chain> chains = keep_lines(all, mask, parts, map, lattice, noise, 2e-5 * energy, scale);
    if (scale.radius == scale.widest) drop_partial_shapes(chains, mask, parts, response, whole, lattice, scale.radius);
    restored = {};
    if (!chains.empty()) erase_lines(map, response, lattice, chains, kind, scale, least, erased);
    for (Chain& chain : chains) chain.half_widths.clear();
    return chains;
}

void tie_lines(std::vector<Chain>& chains, const std::vector<Chain>& others, const Image& response, const Lattice& lattice) {
    std::vector<std::uint8_t> hidden(static_cast<std::size_t>(lattice.size()), 0);
    for (const Chain& other : others) {
        const int reach = static_cast<int>(std::ceil(covered_reach(other.half_width))) + 1;
        for_each_place(other, [&](Vec2 p, Vec2 normal, double) {
            for_each_texel_across(p, normal, lattice, reach, [&](int texel, Vec2) { hidden[texel] = 1; });
        });
    }
    join_facing_ends(chains, response, hidden, lattice);
    extend_to_lines(chains, response, lattice);
}

}  // namespace burin::vectorizing
