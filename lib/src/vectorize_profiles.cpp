// Which chain every texel belongs to, and the mean section of each chain.
#include "vectorize_profiles.hpp"
#include "vectorize_owners.hpp"
#include "vectorize_scales.hpp"

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

// Of very many values some thousands, evenly picked, tell their mean as well.
struct Picked {
    std::uint32_t count = 0, next = 0;

    std::uint32_t stride() const { return count / 8192 + 1; }
    std::uint32_t size() const { return (count + stride() - 1) / stride(); }
    bool take() { return next++ % stride() == 0; }
};

// The level of a region is what its texels far from any path have; a soft ramp along its rim belongs to the profiles.
void settle_levels(Regions& regions, const Image& map, const std::vector<Owner>& owners, double reach) {
    const std::size_t count = regions.level.size();
    std::vector<float> furthest(count, 0.0f);
    for (std::size_t i = 0; i < owners.size(); ++i) {
        float& f = furthest[regions.at(i)];
        f = std::max(f, std::min(owners[i].distance(), static_cast<float>(reach)));
    }
    const auto is_far = [&](std::size_t i, std::uint32_t r) { return owners[i].distance() >= 0.6f * furthest[r]; };
    std::vector<Picked> picked(count);
    for (std::size_t i = 0; i < owners.size(); ++i)
        if (const std::uint32_t r = regions.at(i); is_far(i, r)) ++picked[r].count;
    std::vector<std::vector<float>> values(count);
    for (std::size_t r = 0; r < count; ++r) values[r].reserve(picked[r].size());
    for (std::size_t i = 0; i < owners.size(); ++i)
        if (const std::uint32_t r = regions.at(i); is_far(i, r) && picked[r].take()) values[r].push_back(map.texels[i]);
    for (std::size_t r = 0; r < count; ++r)
        if (!values[r].empty())
            regions.level[r] = trimmed_mean(values[r].data(), values[r].data() + values[r].size());
}

struct Section {
    std::vector<double> height;  // relative to the level of the side
    std::vector<double> weight;
};

// What a section comes to far out on one side (-1 left, 1 right): there lies the ground the line was cut into, which on
// soft ground is not the level of the region. 0 where another line is near.
double tail_of(const Section& section, int side) {
    constexpr int kNear = static_cast<int>(8.0 / kSectionStep);
    const int half = static_cast<int>(section.height.size() / 2);
    const auto index = [&](int k) { return static_cast<std::size_t>(half + side * k); };
    const double heaviest = *std::max_element(section.weight.begin(), section.weight.end());
    int reach = half;
    while (reach > 0 && section.weight[index(reach)] < std::max(2.0, 0.35 * heaviest)) --reach;
    if (reach < kNear) return 0.0;
    double sum = 0.0, weight = 0.0;
    for (int k = reach * 3 / 4; k <= reach; ++k) {
        sum += section.weight[index(k)] * section.height[index(k)];
        weight += section.weight[index(k)];
    }
    return weight > 0.0 ? sum / weight : 0.0;
}

// Lets a line's section run out to nothing on both sides.
void level_tails(Section& section) {
    const int half = static_cast<int>(section.height.size() / 2);
    const double left = tail_of(section, -1), right = tail_of(section, 1);
    for (int k = -half; k <= half; ++k) {
        const double t = 0.5 + 0.5 * k / half;
        section.height[half + k] -= left + (right - left) * t;
    }
}

void mirror(Section& section) {
    std::reverse(section.height.begin(), section.height.end());
    std::reverse(section.weight.begin(), section.weight.end());
}

void add_section(Section& total, const Section& part) {
    for (std::size_t k = 0; k < total.height.size(); ++k) {
        const double w = total.weight[k] + part.weight[k];
        if (w > 0.0) total.height[k] = (total.height[k] * total.weight[k] + part.height[k] * part.weight[k]) / w;
        total.weight[k] = w;
    }
}

void make_symmetric(Section& section) {
    Section mirrored = section;
    mirror(mirrored);
    add_section(section, mirrored);
}

// Sections of all chains as the map shows them: heights relative to the ground of the side, mean over the texels of each
// offset.
std::vector<Section> measure_sections(const std::vector<FittedChain>& chains, const Image& map,
                                      const std::vector<Owner>& owners, const Regions& regions, int half) {
    const std::size_t bins = static_cast<std::size_t>(2 * half + 1);
    std::vector<Picked> picked(chains.size() * bins);
    const auto bin_of = [&](const Owner& owner) {
        const int k = static_cast<int>(std::lround(owner.offset / kSectionStep)) + half;
        return owner.chain * bins + static_cast<std::size_t>(std::clamp(k, 0, 2 * half));
    };
    // Around a spot lies what it stands on.
    constexpr double kRim = 2.5;  // texels
    const auto counts = [&](const Owner& owner) {
        if (owner.chain == kNoChain || owner.beyond) return false;
        const Chain& chain = chains[owner.chain].chain;
        return chain.spot == Spot::no || std::fabs(owner.offset) < chain.half_width + kRim;
    };
    for (const Owner& owner : owners)
        if (counts(owner)) ++picked[bin_of(owner)].count;
    std::vector<std::size_t> first{0};
    for (const Picked& p : picked) first.push_back(first.back() + p.size());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    std::vector<float> values(first.back());
    for (std::size_t i = 0; i < owners.size(); ++i) {
        if (!counts(owners[i]) || !picked[bin_of(owners[i])].take()) continue;
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
            sections[c].weight[k] = picked[c * bins + k].count;
        }
    }
    return sections;
}

// What a chain's section is compared and shared as.
Section settle_section(Section section, const Chain& chain) {
    if (chain.kind != ChainKind::step) level_tails(section);
    if (chain.spot != Spot::no) make_symmetric(section);
    return section;
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

// A section in few bytes, for a look that tells most pairs apart: from the middle outwards, where sections differ most.
class Glance {
  public:
    explicit Glance(const Section& section) : height_(padded(section)), weight_(padded(section)) {
        const std::size_t half = section.height.size() / 2;
        for (std::size_t i = 0; i < section.height.size(); ++i) {
            const std::size_t k = i % 2 == 1 ? half + (i + 1) / 2 : half - i / 2;
            height_[i] = static_cast<float>(section.height[k]);
            weight_[i] = static_cast<float>(section.weight[k]);
            total_ += section.weight[k];
        }
    }

    // Whether the difference of the two sections is certainly above `limit`: the sum over a part of the offsets, over at
    // least the weight of all, is a lower bound. What floats round off is far below the margins.
    bool differs(const Glance& other, double limit) const {
        const double safe = 1.001 * limit + 1e-6;
        const double most = safe * safe * std::min(total_, other.total_);
        double sum = 0.0;
        for (std::size_t first = 0; first < height_.size(); first += kBlock) {
            sum += difference(other, first);
            if (sum > most) return true;
        }
        return false;
    }

  private:
    static constexpr std::size_t kBlock = 16, kLanes = 4;

    static std::vector<float> padded(const Section& section) {
        return std::vector<float>((section.height.size() + kBlock - 1) / kBlock * kBlock, 0.0f);
    }
    float difference(const Glance& other, std::size_t first) const {
        const float *h = &height_[first], *w = &weight_[first], *g = &other.height_[first], *v = &other.weight_[first];
        float lanes[kLanes] = {};
        for (std::size_t k = 0; k < kBlock; k += kLanes)
            for (std::size_t i = 0; i < kLanes; ++i)
                lanes[i] += (w[k + i] < v[k + i] ? w[k + i] : v[k + i]) * (h[k + i] - g[k + i]) * (h[k + i] - g[k + i]);
        return lanes[0] + lanes[1] + lanes[2] + lanes[3];
    }

    std::vector<float> height_, weight_;
    double total_ = 0.0;
};

double amplitude(const Section& section) {
    double most = 0.0;
    for (std::size_t k = 0; k < section.height.size(); ++k)
        if (section.weight[k] >= 4.0) most = std::max(most, std::fabs(section.height[k]));
    return most;
}

struct Cluster {
    Section section;
    Glance glance;
    bool is_step = false;
    double rise = 0.0;  // of a step: right level - left level
};

// A chain on its way into a cluster.
struct Newcomer {
    Section section, mirrored;
    Glance glance, mirrored_glance;
    bool is_step = false;
    double rise = 0.0;     // as of a cluster
    double allowed = 0.0;  // difference from the cluster it joins
};

Newcomer look_at(const Chain& chain, Section section, const Regions& regions, double closeness, double noise) {
    const bool step = chain.kind == ChainKind::step;
    const double rise = step ? regions.level[chain.right_region] - regions.level[chain.left_region] : 0.0;
    // A spot is its section and a place, so that a section that is a little too wide shows all round it.
    const double close = chain.spot == Spot::no ? closeness : 0.2 * closeness;
    const double allowed = close * std::max(amplitude(section), std::fabs(rise)) + noise;
    Section mirrored = section;
    mirror(mirrored);
    const Glance glance(section), mirrored_glance(mirrored);
    return {std::move(section), std::move(mirrored), glance, mirrored_glance, step, rise, allowed};
}

struct Choice {
    std::size_t cluster = 0;
    bool flip = false;  // the section fits when the chain is turned round
};

// The cluster most like the newcomer; the number of clusters where none is close enough.
Choice choose_cluster(const Newcomer& newcomer, const std::vector<Cluster>& clusters) {
    double best = newcomer.allowed;
    Choice choice{clusters.size(), false};
    for (std::size_t k = 0; k < clusters.size(); ++k) {
        const Cluster& cluster = clusters[k];
        if (cluster.is_step != newcomer.is_step || std::fabs(cluster.rise - newcomer.rise) > 1e-9) continue;
        const auto is_closer = [&](const Section& section, const Glance& glance, double limit) {
            if (cluster.glance.differs(glance, limit)) return false;
            const double d = difference(cluster.section, section);
            if (d < limit) best = d;
            return d < limit;
        };
        if (is_closer(newcomer.section, newcomer.glance, best)) choice = {k, false};
        if (newcomer.is_step) continue;
        if (is_closer(newcomer.mirrored, newcomer.mirrored_glance, 0.9 * best)) choice = {k, true};
    }
    return choice;
}

// Longest chains first: each joins the cluster most like it, or founds one. Chains, and their sections, that were turned
// round for that change their mark in `reversed`.
std::vector<Cluster> cluster_sections(std::vector<FittedChain>& chains, std::vector<Section>& sections,
                                      const Regions& regions, double closeness, double noise,
                                      std::vector<std::uint8_t>& reversed) {
    std::vector<std::size_t> order(chains.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return chains[a].length > chains[b].length; });
    std::vector<Cluster> clusters;
    for (const std::size_t c : order) {
        const Chain& chain = chains[c].chain;
        Newcomer newcomer = look_at(chain, settle_section(sections[c], chain), regions, closeness, noise);
        const Choice choice = choose_cluster(newcomer, clusters);
        if (choice.flip) {
            reverse_chain(chains[c]);
            reversed[c] ^= 1;
            mirror(sections[c]);
        }
        Section& joining = choice.flip ? newcomer.mirrored : newcomer.section;
        chains[c].profile = static_cast<std::uint32_t>(choice.cluster);
        if (choice.cluster == clusters.size()) {
            clusters.push_back({std::move(joining), std::move(newcomer.glance), newcomer.is_step, newcomer.rise});
        } else {
            Cluster& cluster = clusters[choice.cluster];
            add_section(cluster.section, joining);
            cluster.glance = Glance(cluster.section);
        }
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

void measure_gains(std::vector<FittedChain>& chains, const ProfileSet& set, const Image& map,
                   const std::vector<Owner>& owners, const Regions& regions) {
    for (std::size_t i = 0; i < owners.size(); ++i) {
        if (owners[i].chain == kNoChain) continue;
        FittedChain& fitted = chains[owners[i].chain];
        if (fitted.chain.kind == ChainKind::step) continue;
        const Profile& profile = set.profiles[fitted.profile];
        const bool inside = owners[i].offset >= profile.points.front().b && owners[i].offset <= profile.points.back().b;
        if (!inside || owners[i].beyond) continue;
        const double h = height_at(profile, owners[i].offset);
        const double d = map.texels[i] - regions.level[regions.at(i)];
        fitted.gain += d * d - (d - h) * (d - h);
    }
}

}  // namespace

double height_at(const Profile& profile, double b) {
    const auto& p = profile.points;
    if (b < p.front().b) return p.front().h;
    for (std::size_t k = 1; k < p.size(); ++k)
        if (b <= p[k].b) {
            const double w = p[k].b - p[k - 1].b;
            return w > 0.0 ? p[k - 1].h + (p[k].h - p[k - 1].h) * (b - p[k - 1].b) / w : p[k].h;
        }
    return p.back().h;
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
    std::vector<Section> sections = measure_sections(chains, map, owners, regions, half);
    std::vector<std::uint8_t> reversed(chains.size(), 0);
    for (int round = 0; round < 6; ++round, closeness *= 1.6) {
        clusters = cluster_sections(chains, sections, regions, closeness, options.noise, reversed);
        if (clusters.size() <= options.most_profiles) break;
    }
    sections = {};
    for (Owner& owner : owners)
        if (owner.chain != kNoChain && reversed[owner.chain]) owner.offset = -owner.offset;
    for (const Cluster& cluster : clusters)
        set.profiles.push_back(fit_profile(cluster.section.height, cluster.section.weight, cluster.rise, options.noise));
    for (FittedChain& fitted : chains) fitted.gain = 0.0;
    measure_gains(chains, set, map, owners, regions);
    measure_scales(chains, set, map, lattice, regions, owners,
                   {options.reach, options.least_gain});
    return set;
}

}  // namespace burin::vectorizing
