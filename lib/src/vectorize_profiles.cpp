// Which chain every texel belongs to, and the mean section of each chain.
#include "vectorize_profiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <set>
#include <utility>

#include <burin/fit.hpp>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

constexpr std::uint32_t kNobody = 0x7fffffffu;

// The nearest chain of a texel, and the signed offset from it, whose magnitude is the distance.
struct Owner {
    float offset = 1e9f;
    std::uint32_t chain : 31 = kNobody;
    std::uint32_t beyond : 1 = 0;  // past an open end, where the section does not hold

    float distance() const { return std::fabs(offset); }
};

struct Piece {
    Vec2 a, b;
    bool first = false, last = false;  // at an open end of the chain
    std::uint32_t chain = 0;
};

void add_pieces(const FittedChain& fitted, std::uint32_t chain, std::vector<Piece>& pieces) {
    const std::size_t before = pieces.size();
    for (const Element& e : fitted.elements) {
        int n = 1;
        if (e.kind == ElementKind::quadratic) {
            const double bend = length(e.p0 - 2.0 * e.p1 + e.p2);
            n = std::clamp(static_cast<int>(std::ceil(std::sqrt(bend / (4.0 * 0.02)))), 1, 64);
        }
        for (int k = 0; k < n; ++k)
            pieces.push_back({point_at(e, double(k) / n), point_at(e, double(k + 1) / n), false, false, chain});
    }
    if (!fitted.chain.closed && pieces.size() > before) {
        pieces[before].first = true;
        pieces.back().last = true;
    }
}

// Squares of kCell texels, and the pieces that may be the nearest to one of their texels.
constexpr int kCell = 16;

struct Candidate {
    const Piece* piece;
    Vec2 shift;       // of the piece's image that is near
    double distance;  // of the cell's centre from it
};

double distance_to(const Piece& piece, Vec2 p) {
    const Vec2 d = piece.b - piece.a;
    const double t = std::clamp(dot(p - piece.a, d) / dot(d, d), 0.0, 1.0);
    return length(piece.a + d * t - p);
}

class Cells {
  public:
    Cells(const Lattice& lattice, double reach)
        : lattice_(lattice), reach_(reach), columns_((lattice.width + kCell - 1) / kCell),
          rows_((lattice.height + kCell - 1) / kCell), candidates_(static_cast<std::size_t>(columns_) * rows_) {}

    int rows() const { return rows_; }
    int columns() const { return columns_; }
    const std::vector<Candidate>& at(int column, int row) const { return candidates_[static_cast<std::size_t>(row) * columns_ + column]; }

    void add(const Piece& piece) {
        if (piece.a == piece.b) return;
        const Vec2 low{std::min(piece.a.x, piece.b.x) - reach_, std::min(piece.a.y, piece.b.y) - reach_};
        const Vec2 high{std::max(piece.a.x, piece.b.x) + reach_, std::max(piece.a.y, piece.b.y) + reach_};
        const int w = lattice_.width, h = lattice_.height;
        const auto first_tile = [&](double v, int n) { return lattice_.wrap ? static_cast<int>(std::floor(v / n)) : 0; };
        for (int ty = first_tile(low.y, h); ty <= first_tile(high.y, h); ++ty)
            for (int tx = first_tile(low.x, w); tx <= first_tile(high.x, w); ++tx)
                add_image(piece, {-double(tx) * w, -double(ty) * h}, low, high);
    }
    // A piece farther from the cell's centre than the nearest one by more than the cell's width is nowhere the nearest.
    void settle() {
        for_each_piece(candidates_.size(), lattice_.threads, [&](std::size_t cell) {
            double nearest = reach_ + kRadius;
            for (const Candidate& c : candidates_[cell]) nearest = std::min(nearest, c.distance);
            std::erase_if(candidates_[cell], [&](const Candidate& c) { return c.distance > nearest + 2.0 * kRadius + 1e-6; });
        });
    }

  private:
    static constexpr double kRadius = 0.7072 * kCell;

    void add_image(const Piece& piece, Vec2 shift, Vec2 low, Vec2 high) {
        const auto cell = [](double v, int n) { return std::clamp(static_cast<int>(std::floor(v / kCell)), 0, n - 1); };
        for (int y = cell(low.y + shift.y, rows_); y <= cell(high.y + shift.y, rows_); ++y)
            for (int x = cell(low.x + shift.x, columns_); x <= cell(high.x + shift.x, columns_); ++x) {
                const Vec2 centre{(x + 0.5) * kCell, (y + 0.5) * kCell};
                const double distance = distance_to(piece, centre - shift);
                if (distance < reach_ + kRadius)
                    candidates_[static_cast<std::size_t>(y) * columns_ + x].push_back({&piece, shift, distance});
            }
    }

    const Lattice& lattice_;
    double reach_;
    int columns_, rows_;
    std::vector<std::vector<Candidate>> candidates_;
};

// The texels [x0, x1) of row y that are nearer to the piece than to what they belong to become its own.
void claim_row(Owner* owners, const Candidate& candidate, int x0, int x1, int y, double reach) {
    const Piece& piece = *candidate.piece;
    const Vec2 d = piece.b - piece.a;
    const double l = length(d);
    const Vec2 t = d * (1.0 / l), n = normal_of(t), start = piece.a + candidate.shift;
    for (int x = x0; x < x1; ++x) {
        const Vec2 q = Vec2{x + 0.5, y + 0.5} - start;
        const double along = dot(q, t), across = dot(q, n);
        const double past = along < 0.0 ? -along : along > l ? along - l : 0.0;
        const double square = past * past + across * across;
        Owner& owner = owners[x];
        const double limit = std::min(reach, static_cast<double>(owner.distance()));
        if (square >= limit * limit) continue;
        const double distance = std::sqrt(square);
        owner.chain = piece.chain;
        owner.offset = static_cast<float>(past > 0.0 ? (across < 0.0 ? -distance : distance) : across);
        owner.beyond = past > 0.25 && ((along < 0.0 && piece.first) || (along > l && piece.last));
    }
}

std::vector<Owner> find_owners(const std::vector<FittedChain>& chains, const Lattice& lattice, double reach) {
    std::vector<Piece> pieces;
    for (std::size_t c = 0; c < chains.size(); ++c) add_pieces(chains[c], static_cast<std::uint32_t>(c), pieces);
    Cells cells(lattice, reach);
    for (const Piece& piece : pieces) cells.add(piece);
    cells.settle();
    std::vector<Owner> owners(static_cast<std::size_t>(lattice.size()));
    for_each_piece(static_cast<std::size_t>(cells.rows()), lattice.threads, [&](std::size_t row) {
        const int y0 = static_cast<int>(row) * kCell, y1 = std::min(lattice.height, y0 + kCell);
        for (int column = 0; column < cells.columns(); ++column)
            for (const Candidate& candidate : cells.at(column, static_cast<int>(row)))
                for (int y = y0; y < y1; ++y)
                    claim_row(&owners[static_cast<std::size_t>(y) * lattice.width], candidate, column * kCell,
                              std::min(lattice.width, (column + 1) * kCell), y, reach);
    });
    return owners;
}

// Mean of the middle 60 %: texels of crossing lines and specks do not count.
double trimmed_mean(float* first, float* last) {
    const std::ptrdiff_t n = last - first, cut = n / 5;
    if (cut > 0) {
        std::nth_element(first, first + cut, last);
        std::nth_element(first + cut, last - cut, last);
    }
    double sum = 0.0;
    for (const float* v = first + cut; v != last - cut; ++v) sum += *v;
    return sum / static_cast<double>(n - 2 * cut);
}

// The level of a region is what its texels far from any path have; a soft ramp along its rim belongs to the profiles.
void settle_levels(Regions& regions, const Image& map, const std::vector<Owner>& owners, double reach) {
    const std::size_t count = regions.level.size();
    std::vector<float> furthest(count, 0.0f);
    for (std::size_t i = 0; i < owners.size(); ++i) {
        float& f = furthest[regions.at(i)];
        f = std::max(f, std::min(owners[i].distance(), static_cast<float>(reach)));
    }
    std::vector<std::vector<float>> values(count);
    for (std::size_t i = 0; i < owners.size(); ++i) {
        const std::uint32_t r = regions.at(i);
        if (owners[i].distance() >= 0.6f * furthest[r]) values[r].push_back(map.texels[i]);
    }
    for (std::size_t r = 0; r < count; ++r)
        if (!values[r].empty())
            regions.level[r] = trimmed_mean(values[r].data(), values[r].data() + values[r].size());
}

struct Section {
    std::vector<double> height;  // relative to the level of the side
    std::vector<double> weight;
};

// Sections of all chains: heights relative to the ground of the side, mean over the texels of each offset.
std::vector<Section> measure_sections(const std::vector<FittedChain>& chains, const Image& map,
                                      const std::vector<Owner>& owners, const Regions& regions, int half) {
    const std::size_t bins = static_cast<std::size_t>(2 * half + 1);
    std::vector<std::uint32_t> first(chains.size() * bins + 1, 0);
    const auto bin_of = [&](const Owner& owner) {
        const int k = static_cast<int>(std::lround(owner.offset / kSectionStep)) + half;
        return owner.chain * bins + static_cast<std::size_t>(std::clamp(k, 0, 2 * half));
    };
    const auto counts = [](const Owner& owner) { return owner.chain != kNobody && !owner.beyond; };
    for (const Owner& owner : owners)
        if (counts(owner)) ++first[bin_of(owner) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    std::vector<float> values(first.back());
    for (std::size_t i = 0; i < owners.size(); ++i) {
        if (!counts(owners[i])) continue;
        const Chain& chain = chains[owners[i].chain].chain;
        const std::uint32_t region = chain.kind != ChainKind::step ? regions.at(i)
                                     : owners[i].offset < 0.0f     ? chain.left_region
                                                                   : chain.right_region;
        values[next[bin_of(owners[i])]++] = map.texels[i] - static_cast<float>(regions.level[region]);
    }
    std::vector<Section> sections(chains.size());
    for (std::size_t c = 0; c < chains.size(); ++c) {
        sections[c].height.assign(bins, 0.0);
        sections[c].weight.assign(bins, 0.0);
        for (std::size_t k = 0; k < bins; ++k) {
            float* begin = values.data() + first[c * bins + k];
            float* end = values.data() + first[c * bins + k + 1];
            if (begin == end) continue;
            sections[c].height[k] = trimmed_mean(begin, end);
            sections[c].weight[k] = static_cast<double>(end - begin);
        }
    }
    return sections;
}

void mirror(Section& section) {
    std::reverse(section.height.begin(), section.height.end());
    std::reverse(section.weight.begin(), section.weight.end());
}

// Weighted root mean square difference over the offsets that both have.
double difference(const Section& a, const Section& b) {
    double sum = 0.0, weight = 0.0;
    for (std::size_t k = 0; k < a.height.size(); ++k) {
        const double w = std::min(a.weight[k], b.weight[k]);
        const double d = a.height[k] - b.height[k];
        sum += w * d * d;
        weight += w;
    }
    return weight > 0.0 ? std::sqrt(sum / weight) : 1e300;
}

double amplitude(const Section& section) {
    double most = 0.0;
    for (std::size_t k = 0; k < section.height.size(); ++k)
        if (section.weight[k] >= 4.0) most = std::max(most, std::fabs(section.height[k]));
    return most;
}

void add_section(Section& total, const Section& part) {
    for (std::size_t k = 0; k < total.height.size(); ++k) {
        const double w = total.weight[k] + part.weight[k];
        if (w > 0.0) total.height[k] = (total.height[k] * total.weight[k] + part.height[k] * part.weight[k]) / w;
        total.weight[k] = w;
    }
}

void reverse_chain(FittedChain& fitted) {
    std::reverse(fitted.elements.begin(), fitted.elements.end());
    for (Element& e : fitted.elements) {
        std::swap(e.p0, e.p2);
        std::swap(e.width0, e.width1);
        std::swap(e.height0, e.height1);
    }
    Chain& chain = fitted.chain;
    std::reverse(chain.points.begin(), chain.points.end());
    std::swap(chain.left_region, chain.right_region);
    std::swap(chain.start_tie, chain.end_tie);
    chain.winding = -chain.winding;
}

struct Cluster {
    Section section;
    ChainKind kind = ChainKind::groove;
    double step = 0.0;  // right level - left level
};

// Longest chains first: each joins the cluster most like it, or founds one. `reversed`: 1 for the chains that were turned
// round for that.
std::vector<Cluster> cluster_sections(std::vector<FittedChain>& chains, std::vector<Section>& sections,
                                      const Regions& regions, double closeness, double noise,
                                      std::vector<std::uint8_t>& reversed) {
    reversed.assign(chains.size(), 0);
    std::vector<std::size_t> order(chains.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return chains[a].length > chains[b].length; });
    std::vector<Cluster> clusters;
    for (const std::size_t c : order) {
        const Chain& chain = chains[c].chain;
        const bool step = chain.kind == ChainKind::step;
        const double rise = step ? regions.level[chain.right_region] - regions.level[chain.left_region] : 0.0;
        const double allowed = closeness * std::max(amplitude(sections[c]), std::fabs(rise)) + noise;
        double best = allowed;
        std::size_t chosen = clusters.size();
        bool flip = false;
        Section mirrored = sections[c];
        mirror(mirrored);
        for (std::size_t k = 0; k < clusters.size(); ++k) {
            if ((clusters[k].kind == ChainKind::step) != step || std::fabs(clusters[k].step - rise) > 1e-9) continue;
            const double d = difference(clusters[k].section, sections[c]);
            if (d < best) best = d, chosen = k, flip = false;
            if (step) continue;
            const double m = difference(clusters[k].section, mirrored);
            if (m < 0.9 * best) best = m, chosen = k, flip = true;
        }
        if (flip) {
            reverse_chain(chains[c]);
            reversed[c] = 1;
            sections[c] = mirrored;
        }
        chains[c].profile = static_cast<std::uint32_t>(chosen);
        if (chosen == clusters.size())
            clusters.push_back({sections[c], chain.kind, rise});
        else
            add_section(clusters[chosen].section, sections[c]);
    }
    return clusters;
}

// Nearly equal levels become one level, so that steps between them can share profiles.
void share_levels(Regions& regions, double closeness) {
    std::vector<std::size_t> order(regions.level.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return regions.level[a] < regions.level[b]; });
    for (std::size_t first = 0; first < order.size();) {
        std::size_t end = first;
        double sum = 0.0, area = 0.0;
        while (end < order.size() && regions.level[order[end]] - regions.level[order[first]] <= closeness) {
            sum += regions.level[order[end]] * regions.area[order[end]];
            area += regions.area[order[end]];
            ++end;
        }
        for (std::size_t k = first; k < end; ++k)
            regions.level[order[k]] = std::clamp(sum / std::max(1.0, area), 0.0, 1.0);
        first = end;
    }
}

std::size_t count_step_kinds(const std::vector<FittedChain>& chains, const Regions& regions) {
    std::set<std::pair<double, double>> kinds;
    for (const FittedChain& f : chains)
        if (f.chain.kind == ChainKind::step)
            kinds.insert({regions.level[f.chain.left_region], regions.level[f.chain.right_region]});
    return kinds.size();
}

double value_at(const Profile& profile, double b, bool& inside) {
    const auto& p = profile.points;
    inside = b >= p.front().b && b <= p.back().b;
    if (!inside) return b < 0.0 ? p.front().h : p.back().h;
    for (std::size_t k = 1; k < p.size(); ++k)
        if (b <= p[k].b) {
            const double w = p[k].b - p[k - 1].b;
            return w > 0.0 ? p[k - 1].h + (p[k].h - p[k - 1].h) * (b - p[k - 1].b) / w : p[k].h;
        }
    return p.back().h;
}

void measure_gains(std::vector<FittedChain>& chains, const ProfileSet& set, const Image& map,
                   const std::vector<Owner>& owners, const Regions& regions) {
    for (std::size_t i = 0; i < owners.size(); ++i) {
        if (owners[i].chain == kNobody) continue;
        FittedChain& fitted = chains[owners[i].chain];
        if (fitted.chain.kind == ChainKind::step) continue;
        bool inside = false;
        const double h = value_at(set.profiles[fitted.profile], owners[i].offset, inside);
        if (!inside || owners[i].beyond) continue;
        const double d = map.texels[i] - regions.level[regions.at(i)];
        fitted.gain += d * d - (d - h) * (d - h);
    }
}

}  // namespace

ProfileSet measure_profiles(std::vector<FittedChain>& chains, const Image& map, const Lattice& lattice,
                            Regions& regions, const ProfileOptions& options) {
    std::vector<Owner> owners = find_owners(chains, lattice, options.reach);
    settle_levels(regions, map, owners, options.reach);
    // Every pair of levels needs a step profile of its own: with many regions there are fewer levels.
    double closeness_of_levels = std::max(2.0 * options.noise, 0.02);
    share_levels(regions, closeness_of_levels);
    while (count_step_kinds(chains, regions) > options.most_profiles / 2 && closeness_of_levels < 0.3)
        share_levels(regions, closeness_of_levels *= 1.4);
    // Between regions that came to one level there is no step, but there may be a line along their border.
    for (FittedChain& f : chains)
        if (f.chain.kind == ChainKind::step && regions.level[f.chain.left_region] == regions.level[f.chain.right_region])
            f.chain.kind = ChainKind::groove;
    const int half = static_cast<int>(std::ceil(options.reach / kSectionStep));
    ProfileSet set;
    double closeness = 0.04;
    std::vector<Cluster> clusters;
    for (int round = 0; round < 6; ++round, closeness *= 1.6) {
        std::vector<Section> sections = measure_sections(chains, map, owners, regions, half);
        std::vector<std::uint8_t> reversed;
        clusters = cluster_sections(chains, sections, regions, closeness, options.noise, reversed);
        for (Owner& owner : owners)
            if (owner.chain != kNobody && reversed[owner.chain]) owner.offset = -owner.offset;
        if (clusters.size() <= options.most_profiles) break;
    }
    for (const Cluster& cluster : clusters)
        set.profiles.push_back(fit_profile(cluster.section.height, cluster.section.weight, cluster.step, options.noise));
    for (FittedChain& fitted : chains) fitted.gain = 0.0;
    measure_gains(chains, set, map, owners, regions);
    return set;
}

}  // namespace burin::vectorizing
