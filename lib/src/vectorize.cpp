// Stage vectorize: lines, plateaus and their rims, fitted and measured, as one pattern.
#include <burin/vectorize.hpp>

#include <algorithm>
#include <cmath>

#include <burin/compare.hpp>
#include <burin/fit.hpp>
#include <burin/rasterize.hpp>
#include <burin/resolve.hpp>

#include "parallel.hpp"
#include "vectorize_fit.hpp"
#include "vectorize_internal.hpp"
#include "vectorize_profiles.hpp"

namespace burin {
namespace {

using namespace vectorizing;

// Regions that hold a smaller share of the map's sum of squares than this join a neighbour.
constexpr double kLeastRegionShare = 4e-5;

// Mean differences between neighbouring rows, and last between the first and the last.
std::vector<double> row_differences(const Image& map, int threads) {
    std::vector<double> differences(static_cast<std::size_t>(map.height), 0.0);
    for_each_band(map.height, threads, [&](const Band& band) {
        for (int y = band.begin; y < band.end; ++y) {
            const float* here = &map.texels[static_cast<std::size_t>(y) * map.width];
            const float* next = &map.texels[static_cast<std::size_t>((y + 1) % map.height) * map.width];
            double sum = 0.0;
            for (int x = 0; x < map.width; ++x) sum += std::fabs(here[x] - next[x]);
            differences[y] = sum / map.width;
        }
    });
    return differences;
}

std::vector<double> column_differences(const Image& map, int threads) {
    constexpr int kSlices = 8;
    const std::size_t w = static_cast<std::size_t>(map.width);
    std::vector<double> sums(kSlices * w, 0.0), differences(w, 0.0);
    for_each_band(map.height, kSlices, threads, [&](const Band& band) {
        double* sum = &sums[band.index * w];
        for (int y = band.begin; y < band.end; ++y) {
            const float* row = &map.texels[static_cast<std::size_t>(y) * w];
            for (std::size_t x = 0; x + 1 < w; ++x) sum[x] += std::fabs(row[x] - row[x + 1]);
            sum[w - 1] += std::fabs(row[w - 1] - row[0]);
        }
    });
    for (std::size_t k = 0; k < sums.size(); ++k) differences[k % w] += sums[k] / map.height;
    return differences;
}

// A map tiles when its opposite borders differ no more than neighbours inside do where an edge lies between them.
bool borders_match(const Image& map, int threads) {
    for (const bool columns : {false, true}) {
        std::vector<double> differences = columns ? column_differences(map, threads) : row_differences(map, threads);
        const double border = differences.back();
        differences.pop_back();
        if (differences.empty()) continue;
        std::sort(differences.begin(), differences.end());
        if (border > differences[differences.size() * 99 / 100] + 0.004) return false;
    }
    return true;
}

// Lines, then the plateaus in what is left of the map without them.
void find_features(const Image& source, Traced& traced) {
    const Lattice& lattice = traced.lattice;
    const double noise = traced.damage, energy = traced.energy;
    const double radius = std::clamp(0.02 * std::min(lattice.width, lattice.height), 6.0, 24.0);
    // A line along the border of a map that does not tile is half outside: a mirrored margin makes it whole.
    const int margin = lattice.wrap ? 0 : static_cast<int>(radius) + 8;
    const Lattice wide{lattice.width + 2 * margin, lattice.height + 2 * margin, lattice.wrap,
                       lattice.threads};
    Image map = mirror_margin(source, margin);
    std::vector<Chain> grooves, ridges;
    Erased erased_grooves, erased_ridges;
    // Thin lines first: between them, to a wide look, the ground is a ridge.
    for (const double r : {std::clamp(0.4 * radius, 4.0, 8.0), 0.65 * radius, radius}) {
        Image response = line_response(map, wide, ChainKind::groove, r, noise);
        const double groove_energy = line_energy(response, noise);
        Image other = line_response(map, wide, ChainKind::ridge, r, noise);
        const bool grooves_first = groove_energy >= line_energy(other, noise);
        if (!grooves_first) response = std::move(other);
        other = {};
        for (const bool first : {true, false}) {
            const ChainKind kind = first == grooves_first ? ChainKind::groove : ChainKind::ridge;
            std::vector<Chain>& lines = kind == ChainKind::groove ? grooves : ridges;
            Erased& erased = kind == ChainKind::groove ? erased_grooves : erased_ridges;
            if (!first) response = line_response(map, wide, kind, r, noise);
            for (Chain& chain : trace_lines(map, std::move(response), erased, wide, kind, {r, radius}, noise, energy))
                lines.push_back(std::move(chain));
        }
    }
    if (!grooves.empty())
        tie_lines(grooves, ridges, restored_response(map, erased_grooves, wide, ChainKind::groove, radius, noise), wide);
    if (!ridges.empty())
        tie_lines(ridges, grooves, restored_response(map, erased_ridges, wide, ChainKind::ridge, radius, noise), wide);
    traced.lines = std::move(grooves);
    for (Chain& chain : ridges) traced.lines.push_back(std::move(chain));
    std::vector<Chain> spots;
    for (const ChainKind kind : {ChainKind::groove, ChainKind::ridge})
        for (Chain& spot : trace_spots(map, wide, kind, radius, noise, energy)) spots.push_back(std::move(spot));
    drop_crumbs(spots, traced.lines, wide);
    for (Chain& spot : spots) traced.lines.push_back(std::move(spot));
    if (margin > 0) traced.lines = clip_chains(traced.lines, margin, lattice);
    Image flattened = margin > 0 ? crop_margin(map, margin, lattice) : std::move(map);
    map = {};
    std::vector<std::uint8_t> flat = find_flat(flattened, lattice, noise);
    const MergeOptions merging{noise, kLeastRegionShare * energy, true, traced.gentle};
    traced.regions = segment_regions(source, flattened, lattice, merging, flat);
    if (return_islands(source, flattened, traced.lines, lattice, traced.regions, flat, noise))
        traced.regions = segment_regions(source, flattened, lattice, merging, flat);
    for (int i = 0; i < lattice.size(); ++i)
        if (flattened.texels[i] != source.texels[i]) traced.changed.push_back({i, flattened.texels[i]});
    traced.changed.shrink_to_fit();
    traced.steps = trace_steps(flattened, {}, lattice, traced.regions);
}

std::size_t count_elements(const std::vector<FittedChain>& chains) {
    std::size_t sum = 0;
    for (const FittedChain& fitted : chains) sum += fitted.elements.size();
    return sum;
}

std::vector<FittedChain> join(std::vector<FittedChain> a, std::vector<FittedChain> b) {
    for (FittedChain& f : b) a.push_back(std::move(f));
    return a;
}

// All lines, and the steps between the regions that are left, to be fitted.
class Fitting {
  public:
    Fitting(const Traced& traced, const Image& map, Regions& regions, int threads)
        : traced_(traced), map_(map), regions_(regions), threads_(threads) {
        std::size_t points = 0;
        for (const std::vector<Chain>* chains : {&traced.lines, &traced.steps})
            for (const Chain& chain : *chains) points += chain.points.size();
        is_quick_ = points <= kFewPoints;
    }

    // Gives up the regions that hold less than a share of the map's sum of squares.
    void merge(double share, bool shading) {
        const std::size_t before = regions_.level.size();
        merge_regions({traced_.damage, share * traced_.energy, shading, traced_.gentle}, regions_);
        if (regions_.level.size() == before && (merged_ || shading)) return;
        merged_ = true;
        fewer_steps_ = trace_steps(map_, traced_.changed, traced_.lattice, regions_);
    }
    // Polylines are fast and tell how many elements to expect.
    void foretell(double tolerance) {
        lines_ = foretell_elements(traced_.lines, tolerance);
        steps_ = foretell_elements(steps(), tolerance);
    }
    double expected_steps() const { return ratio_ * static_cast<double>(steps_); }
    double expected() const { return ratio_ * static_cast<double>(lines_ + steps_); }
    // Whether curves can be fitted to see how many there are; and whether they were.
    bool is_quick() const { return is_quick_; }
    bool is_sure() const { return is_sure_; }
    std::vector<FittedChain> fit(double tolerance) {
        std::vector<FittedChain> fitted = join(fit_chains(traced_.lines, map_, traced_.lattice, tolerance, threads_),
                                               fit_chains(steps(), map_, traced_.lattice, tolerance, threads_));
        is_sure_ = true;
        ratio_ = static_cast<double>(count_elements(fitted)) / static_cast<double>(std::max<std::size_t>(1, lines_ + steps_));
        return fitted;
    }

  private:
    static constexpr std::size_t kFewPoints = 30000;
    const std::vector<Chain>& steps() const { return merged_ ? fewer_steps_ : traced_.steps; }

    const Traced& traced_;
    const Image& map_;
    Regions& regions_;
    int threads_;
    bool is_quick_ = false, is_sure_ = false, merged_ = false;
    std::vector<Chain> fewer_steps_;
    std::size_t lines_ = 0, steps_ = 0;
    double ratio_ = 1.0;  // of elements fitted to those foretold
};

// A curve that follows the grain of a ragged edge costs an element every few texels: first the fit is loosened, then
// the least regions are given up, until the steps leave room for lines.
std::vector<FittedChain> fit_within(const Traced& traced, const Image& map, const VectorizeOptions& options,
                                    std::size_t budget, Regions& regions, Vectorized& result, int threads) {
    constexpr double kLooser = 1.4;
    Fitting fitting(traced, map, regions, threads);
    const bool asked = options.most_elements > 0;  // a limit that was asked for goes before beauty
    const double loosest = (asked ? 1.7 : 1.0) * std::max(1.2, 0.0012 * std::min(traced.lattice.width, traced.lattice.height));
    // What is foretold from polylines alone may be too many.
    const double slack = 1.25 * static_cast<double>(budget), exact = asked ? static_cast<double>(budget) : slack;
    const auto most = [&] { return fitting.is_sure() ? exact : slack; };
    double share = kLeastRegionShare;
    result.shaded = options.shading && std::any_of(regions.borders.begin(), regions.borders.end(),
                                                   [](const auto& border) { return border.second.is_ramp(); });
    if (!options.shading) fitting.merge(share, false);
    for (result.tolerance = options.tolerance > 0.0 ? options.tolerance : kUsualTolerance;; result.tolerance *= kLooser) {
        fitting.foretell(result.tolerance);
        if (fitting.expected() <= most()) break;
        if (fitting.is_quick() && fitting.expected() < 2.0 * slack) {
            std::vector<FittedChain> fitted = fitting.fit(result.tolerance);
            if (static_cast<double>(count_elements(fitted)) <= exact) {
                result.is_short = options.tolerance == 0.0 && result.tolerance > kUsualTolerance;
                return fitted;
            }
        }
        if (options.tolerance > 0.0 || result.tolerance * kLooser > loosest) break;
    }
    result.is_short = options.tolerance == 0.0 && result.tolerance > kUsualTolerance;
    for (int round = 0; round < 8; ++round) {
        const double lines = fitting.expected() - fitting.expected_steps();
        if (fitting.expected_steps() <= most() - std::min(lines, 0.25 * most())) break;
        share *= 2.0;
        result.is_short = true;
        fitting.merge(share, options.shading);
        fitting.foretell(result.tolerance);
    }
    return fitting.fit(result.tolerance);
}

// Lines that explain little per element go, the least useful first, until the rest is within the budget. Steps hold the
// regions together and stay. True when any went for the budget alone.
bool drop_useless(std::vector<FittedChain>& chains, double energy, std::size_t most_elements) {
    const double least = 2e-5 * energy;
    const auto worth = [](const FittedChain& f) { return f.gain / static_cast<double>(f.elements.size()); };
    const auto removable = [](const FittedChain& f) { return f.chain.kind != ChainKind::step; };
    chains.erase(std::remove_if(chains.begin(), chains.end(),
                                [&](const FittedChain& f) { return removable(f) && worth(f) < least; }),
                 chains.end());
    std::size_t count = count_elements(chains);
    if (count <= most_elements) return false;
    std::vector<const FittedChain*> order;
    for (const FittedChain& f : chains)
        if (removable(f)) order.push_back(&f);
    std::stable_sort(order.begin(), order.end(),
                     [&](const FittedChain* a, const FittedChain* b) { return worth(*a) < worth(*b); });
    std::vector<std::uint8_t> drop(chains.size(), 0);
    for (const FittedChain* f : order) {
        if (count <= most_elements) break;
        drop[static_cast<std::size_t>(f - chains.data())] = 1;
        count -= f->elements.size();
    }
    std::vector<FittedChain> kept;
    for (std::size_t c = 0; c < chains.size(); ++c)
        if (!drop[c]) kept.push_back(std::move(chains[c]));
    chains = std::move(kept);
    return !order.empty();
}

// Texels and map values to metres. Ground level 0 is the level of the largest region.
struct Units {
    double texel = 1.0;
    double depth = 1.0;
    double ground = 1.0;  // map value of ground level 0

    Vec2 point(Vec2 p) const { return p * texel; }
    double level(double value) const { return (value - ground) * depth; }
};

Path make_path(const FittedChain& fitted, const Units& units, const Regions& regions, const Lattice& lattice) {
    Path path;
    path.closed = fitted.chain.closed;
    path.profile = fitted.profile;
    if (fitted.round_start) path.start_cap = CapKind::round;
    if (fitted.round_end) path.end_cap = CapKind::round;
    for (Element e : fitted.elements) {
        e.p0 = units.point(e.p0);
        e.p1 = units.point(e.p1);
        e.p2 = units.point(e.p2);
        path.elements.push_back(e);
    }
    std::uint32_t region = fitted.chain.left_region;
    if (fitted.chain.kind != ChainKind::step) {
        const Vec2 p = fitted.chain.points[fitted.chain.points.size() / 2];
        region = regions.at(lattice.nearest(p));
    }
    path.level = units.level(regions.level[region]);
    return path;
}

Pattern make_pattern(const std::vector<FittedChain>& chains, const ProfileSet& set, const Regions& regions,
                     const Lattice& lattice, const VectorizeOptions& options, Wrap wrap) {
    std::size_t largest = 0;
    for (std::size_t r = 1; r < regions.area.size(); ++r)
        if (regions.area[r] > regions.area[largest]) largest = r;
    const Units units{options.size.x / lattice.width, options.depth, std::clamp(regions.level[largest], 0.0, 1.0)};
    Pattern pattern;
    pattern.size = options.size;
    pattern.depth = options.depth;
    pattern.base_offset = (1.0 - units.ground) * options.depth;
    pattern.wrap = wrap;
    pattern.outer_level = 0.0;
    std::vector<std::uint32_t> used(set.profiles.size(), 0xffffffffu);
    for (const FittedChain& fitted : chains) {
        Path path = make_path(fitted, units, regions, lattice);
        if (used[fitted.profile] == 0xffffffffu) {
            used[fitted.profile] = static_cast<std::uint32_t>(pattern.profiles.size());
            Profile profile = set.profiles[fitted.profile];
            for (ProfilePoint& p : profile.points) p = {p.b * units.texel, p.h * units.depth};
            pattern.profiles.push_back(std::move(profile));
        }
        path.profile = used[fitted.profile];
        pattern.paths.push_back(std::move(path));
    }
    // Nothing may rise above the object surface or fall below the map's black.
    for (Path& path : pattern.paths)
        for (ProfilePoint& p : pattern.profiles[path.profile].points)
            p.h = std::clamp(p.h, lowest(pattern) - path.level, highest(pattern) - path.level);
    return pattern;
}

Status check_options(const HeightMap& map, const VectorizeOptions& options) {
    const auto refuse = [](const std::string& message) { return Error{ErrorCode::invalid_argument, message}; };
    if (map.image.width < 1 || map.image.height < 1) return refuse("map: has no texels; at least 1 x 1 would work");
    if (map.image.texels.size() > kMaxVectorizedTexels)
        return Error{ErrorCode::limit_exceeded,
                     "map: " + std::to_string(map.image.width) + " x " + std::to_string(map.image.height) +
                         " texels; at most " + std::to_string(kMaxVectorizedTexels) +
                         " (8192 x 8192) are vectorized, so the map at half its size would work"};
    if (!(options.size.x > 0.0) || !(options.size.y > 0.0))
        return refuse("size: " + std::to_string(options.size.x) + " x " + std::to_string(options.size.y) +
                      " metres; both must be above 0");
    if (!(options.depth > 0.0)) return refuse("depth: " + std::to_string(options.depth) + " metres; must be above 0");
    if (!(options.tolerance >= 0.0 && options.tolerance <= 8.0))
        return refuse("tolerance: " + std::to_string(options.tolerance) + " texels; 0 to 8 would work");
    return Done{};
}

// Elements whose texels, lists and share of the grid fit into the bytes.
std::size_t element_budget(const Lattice& lattice, const VectorizeOptions& options) {
    constexpr std::size_t kElementBytes = 36;
    if (options.most_elements > 0) return static_cast<std::size_t>(options.most_elements);
    // A small map may be as rich as one of 512 x 512.
    const std::size_t usual = std::max<std::size_t>(16 * 1024, static_cast<std::size_t>(lattice.size()) / 16);
    return (options.most_bytes > 0 ? options.most_bytes : usual) / kElementBytes;
}

Wrap choose_wrap(const Image& map, WrapChoice choice, int threads) {
    if (choice == WrapChoice::automatic) return borders_match(map, threads) ? Wrap::repeat : Wrap::clamp;
    return choice == WrapChoice::repeat ? Wrap::repeat : Wrap::clamp;
}

ProfileOptions profile_options(const Traced& traced, const VectorizeOptions& asked) {
    ProfileOptions options;
    options.noise = traced.noise;
    // Where elements are short, most of them do more as lines of their own.
    options.least_gain = (asked.most_elements > 0 ? 1e-4 : 1e-5) * traced.energy;
    options.reach = std::clamp(0.06 * std::min(traced.lattice.width, traced.lattice.height), 8.0, 64.0);
    options.most_profiles = static_cast<std::size_t>(std::clamp(traced.lattice.size() / 4096, 16, 400));
    return options;
}

Error stopped() { return {ErrorCode::invalid_argument, "vectorize: stopped by the caller"}; }

}  // namespace

Result<SoftGround> separate_ground(const HeightMap& map, const VectorizeOptions& options) {
    const Status checked = check_options(map, options);
    if (!checked) return checked.error();
    const Wrap wrap = choose_wrap(map.image, options.wrap, thread_count(options.threads));
    const Lattice lattice{map.image.width, map.image.height, wrap == Wrap::repeat, thread_count(options.threads)};
    const Image ground = soft_ground(map.image, lattice, estimate_noise(map.image, lattice));
    SoftGround separated{map, 0.0};
    double square = 0.0;
    float highest = 1.0f;
    for (std::size_t i = 0; i < ground.texels.size(); ++i) {
        square += static_cast<double>(ground.texels[i]) * ground.texels[i];
        separated.detail.image.texels[i] -= ground.texels[i];
        highest = std::max(highest, separated.detail.image.texels[i]);
    }
    // Where the ground was low the rest would stick out of the object surface: all of it goes down.
    for (float& value : separated.detail.image.texels) value = std::max(0.0f, value - (highest - 1.0f));
    separated.deviation = std::sqrt(square / static_cast<double>(ground.texels.size()));
    return separated;
}

Result<TracedMap> trace_map(const HeightMap& map, const VectorizeOptions& options, const Progress& progress) {
    const Status checked = check_options(map, options);
    if (!checked) return checked.error();
    const Wrap wrap = choose_wrap(map.image, options.wrap, thread_count(options.threads));
    auto traced = std::make_shared<Traced>();
    traced->lattice = {map.image.width, map.image.height, wrap == Wrap::repeat, thread_count(options.threads)};
    traced->noise = estimate_noise(map.image, traced->lattice);
    traced->damage = std::max(traced->noise, estimate_ringing(map.image, traced->lattice));
    traced->energy = detail_variance(map.image, wrap, traced->lattice.threads) * static_cast<double>(map.image.texels.size());
    traced->gentle = options.gentle;
    if (progress && !progress("vectorize", 0.05)) return stopped();
    find_features(map.image, *traced);
    return TracedMap{std::move(traced)};
}

Result<Vectorized> fit_traced_map(const TracedMap& found, const HeightMap& map, const VectorizeOptions& options,
                                  const Progress& progress) {
    const Status checked = check_options(map, options);
    if (!checked) return checked.error();
    const auto proceed = [&](double fraction) { return !progress || progress("vectorize", fraction); };
    if (!proceed(0.4)) return stopped();
    const Traced& traced = *found.found;
    Regions regions = traced.regions;  // merged to fit the budget, and their levels settled
    const Lattice& lattice = traced.lattice;
    Vectorized result;
    result.noise = traced.noise;
    result.damage = traced.damage;
    result.energy = traced.energy;
    const std::size_t budget = element_budget(lattice, options);
    std::vector<FittedChain> fitted = fit_within(traced, map.image, options, budget, regions, result, thread_count(options.threads));
    untangle_steps(fitted, lattice, result.tolerance);
    land_tees(fitted, lattice, result.tolerance);
    if (!proceed(0.6)) return stopped();
    const ProfileSet set = measure_profiles(fitted, map.image, lattice, regions, profile_options(traced, options));
    result.is_short |= drop_useless(fitted, traced.energy, budget);
    choose_caps(fitted, set, map.image, lattice, regions);
    if (!proceed(0.8)) return stopped();
    const Wrap wrap = lattice.wrap ? Wrap::repeat : Wrap::clamp;
    result.pattern = make_pattern(fitted, set, regions, lattice, options, wrap);
    for (const FittedChain& f : fitted) result.path_length_texels += f.length;
    return result;
}

Result<Vectorized> vectorize_map(const HeightMap& map, const VectorizeOptions& options, const Progress& progress) {
    const Result<TracedMap> traced = trace_map(map, options, progress);
    if (!traced) return traced.error();
    return fit_traced_map(*traced, map, options, progress);
}

}  // namespace burin
