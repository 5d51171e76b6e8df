// Stage vectorize: lines, plateaus and their rims, fitted and measured, as one pattern.
#include <burin/vectorize.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include <burin/compare.hpp>
#include <burin/fit.hpp>
#include <burin/rasterize.hpp>
#include <burin/resolve.hpp>

#include "vectorize_internal.hpp"
#include "vectorize_profiles.hpp"

namespace burin {
namespace {

using namespace vectorizing;

// Regions that hold a smaller share of the map's sum of squares than this join a neighbour.
constexpr double kLeastRegionShare = 4e-5;

// Mean differences between neighbouring rows (columns), and last between the opposite borders.
std::vector<double> row_differences(const Image& map, bool columns) {
    const int lines = columns ? map.width : map.height, length = columns ? map.height : map.width;
    std::vector<double> differences(static_cast<std::size_t>(lines), 0.0);
    for (int line = 0; line < lines; ++line) {
        const int next = (line + 1) % lines;
        for (int k = 0; k < length; ++k)
            differences[line] += columns ? std::fabs(map.at(line, k) - map.at(next, k))
                                         : std::fabs(map.at(k, line) - map.at(k, next));
        differences[line] /= length;
    }
    return differences;
}

// A map tiles when its opposite borders differ no more than neighbours inside do where an edge lies between them.
bool borders_match(const Image& map) {
    for (const bool columns : {false, true}) {
        std::vector<double> differences = row_differences(map, columns);
        const double border = differences.back();
        differences.pop_back();
        if (differences.empty()) continue;
        std::sort(differences.begin(), differences.end());
        if (border > differences[differences.size() * 99 / 100] + 0.004) return false;
    }
    return true;
}

double total_energy(const Image& map, Wrap wrap) {
    const Image flat(map.width, map.height, 0.0f);
    return compare_heights(flat, map, wrap).input_variance * static_cast<double>(map.texels.size());
}

// Lines, then the plateaus in what is left of the map without them.
void find_features(const Image& source, Traced& traced) {
    const Lattice& lattice = traced.lattice;
    const double noise = traced.noise, energy = traced.energy;
    const double radius = std::clamp(0.02 * std::min(lattice.width, lattice.height), 6.0, 24.0);
    // A line along the border of a map that does not tile is half outside: a mirrored margin makes it whole.
    const int margin = lattice.wrap ? 0 : static_cast<int>(radius) + 8;
    const Lattice wide{lattice.width + 2 * margin, lattice.height + 2 * margin, lattice.wrap};
    Image map = mirror_margin(source, margin);
    std::vector<Chain> grooves, ridges;
    Image with_grooves = map, with_ridges = map;  // without the lines of the other kind
    // Thin lines first: between them, to a wide look, the ground is a ridge.
    for (const double r : {std::clamp(0.4 * radius, 4.0, 8.0), radius}) {
        const bool grooves_first = line_energy(map, wide, ChainKind::groove, r, noise) >=
                                   line_energy(map, wide, ChainKind::ridge, r, noise);
        for (const bool first : {true, false}) {
            const ChainKind kind = first == grooves_first ? ChainKind::groove : ChainKind::ridge;
            std::vector<Chain>& lines = kind == ChainKind::groove ? grooves : ridges;
            Image& with_same = kind == ChainKind::groove ? with_grooves : with_ridges;
            Image& with_other = kind == ChainKind::groove ? with_ridges : with_grooves;
            const Image before = map;
            for (Chain& chain : trace_lines(map, with_same, wide, kind, {r, radius}, noise, energy))
                lines.push_back(std::move(chain));
            for (std::size_t i = 0; i < map.texels.size(); ++i) with_other.texels[i] += map.texels[i] - before.texels[i];
        }
    }
    tie_lines(grooves, with_grooves, wide, ChainKind::groove, radius);
    tie_lines(ridges, with_ridges, wide, ChainKind::ridge, radius);
    traced.lines = std::move(grooves);
    for (Chain& chain : ridges) traced.lines.push_back(std::move(chain));
    if (margin > 0) traced.lines = clip_chains(traced.lines, margin, lattice);
    traced.flattened = crop_margin(map, margin, lattice);
    traced.regions = segment_regions(traced.flattened, lattice, noise, kLeastRegionShare * energy);
    traced.steps = trace_steps(traced.flattened, lattice, traced.regions);
}

double chain_length(const std::vector<Element>& elements) {
    double sum = 0.0;
    for (const Element& e : elements)
        sum += e.kind == ElementKind::line ? length(e.p2 - e.p0)
                                           : 0.5 * (length(e.p1 - e.p0) + length(e.p2 - e.p1) + length(e.p2 - e.p0)) +
                                                 (length(e.p2 - e.p0) - 0.5 * (length(e.p1 - e.p0) + length(e.p2 - e.p1) +
                                                                             length(e.p2 - e.p0))) / 3.0;
    return sum;
}

FitOptions fit_options(const Chain& chain, double tolerance) {
    FitOptions options;
    options.tolerance = tolerance;
    options.closed = chain.closed;
    options.period = chain.winding;
    options.corner_reach = chain.kind == ChainKind::step ? 1.2 : std::max(1.0, chain.half_width);
    options.pin_start = chain.start_tie != EndTie::free;
    options.pin_end = chain.end_tie != EndTie::free;
    return options;
}

// Whether every control point stays near the points that the curve was fitted to.
bool stays_near(const std::vector<Vec2>& points, const std::vector<Element>& elements, double slack) {
    Box box;
    for (const Vec2 p : points) {
        box.low = {std::min(box.low.x, p.x - slack), std::min(box.low.y, p.y - slack)};
        box.high = {std::max(box.high.x, p.x + slack), std::max(box.high.y, p.y + slack)};
    }
    const auto inside = [&](Vec2 p) {
        return p.x >= box.low.x && p.x <= box.high.x && p.y >= box.low.y && p.y <= box.high.y;
    };
    return std::all_of(elements.begin(), elements.end(), [&](const Element& e) {
        return inside(e.p0) && inside(e.p2) && (e.kind == ElementKind::line || inside(e.p1));
    });
}

// Keeps the points that a polyline within the tolerance needs, between two kept ones (Douglas and Peucker 1973).
void keep_points(const std::vector<Vec2>& points, std::size_t first, std::size_t last, double tolerance,
                 std::vector<std::uint8_t>& keep) {
    std::vector<std::pair<std::size_t, std::size_t>> stack{{first, last}};
    while (!stack.empty()) {
        const auto [a, b] = stack.back();
        stack.pop_back();
        const Vec2 d = points[b] - points[a];
        double worst = tolerance;
        std::size_t at = a;
        for (std::size_t k = a + 1; k < b; ++k) {
            const Vec2 q = points[k] - points[a];
            const double s = std::clamp(dot(q, d) / std::max(1e-12, dot(d, d)), 0.0, 1.0);
            const double distance = length(q - d * s);
            if (distance > worst) worst = distance, at = k;
        }
        if (at == a) continue;
        keep[at] = 1;
        stack.push_back({a, at});
        stack.push_back({at, b});
    }
}

// What always works: lines through some of the points.
std::vector<Element> fit_polyline(const Chain& chain, double tolerance) {
    std::vector<Vec2> points = chain.points;
    if (chain.closed) points.push_back(points.front() + chain.winding);
    std::vector<std::uint8_t> keep(points.size(), 0);
    keep.front() = keep.back() = 1;
    keep_points(points, 0, points.size() - 1, tolerance, keep);
    std::vector<Element> elements;
    Vec2 start = points.front();
    for (std::size_t k = 1; k < points.size(); ++k) {
        if (!keep[k] || length(points[k] - start) == 0.0) continue;
        elements.push_back({ElementKind::line, start, {}, points[k]});
        start = points[k];
    }
    return elements;
}

// Texels of the data texture: one a line, two a quadratic.
std::size_t texels_of(const std::vector<Element>& elements) {
    std::size_t sum = elements.size();
    for (const Element& e : elements) sum += e.kind == ElementKind::quadratic;
    return sum;
}

std::vector<FittedChain> fit_chains(const std::vector<Chain>& chains, double tolerance, int threads) {
    std::vector<FittedChain> fitted(chains.size());
    // Curve fitting takes some 20 microseconds a point on ragged rims; where there are very many, corners have to do.
    constexpr std::size_t kMostCurvePoints = 120000;
    std::size_t points = 0;
    for (const Chain& chain : chains) points += chain.points.size();
    const bool curves = points <= kMostCurvePoints;
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t c = next++; c < chains.size(); c = next++) {
            const Result<FitResult> fit = curves ? fit_curve(chains[c].points, fit_options(chains[c], tolerance))
                                                 : Result<FitResult>(FitResult{{}, {}, {}, 1e9, 1e9});
            if (!fit) continue;  // all points coincide: nothing to draw
            fitted[c].chain = chains[c];
            const bool sound = fit->max_error < 3.0 * tolerance + 0.5 &&
                               stays_near(chains[c].points, fit->elements, 2.0 + 2.0 * chains[c].half_width);
            // Along a ragged rim a smooth chain needs more elements than corners do, and shows no more.
            const std::vector<Element> polyline = fit_polyline(chains[c], tolerance);
            const bool smooth = sound && 3 * texels_of(fit->elements) <= 4 * texels_of(polyline);
            fitted[c].elements = smooth ? fit->elements : polyline;
            fitted[c].length = chain_length(fitted[c].elements);
        }
    };
    std::vector<std::thread> pool;
    for (int t = 1; t < threads; ++t) pool.emplace_back(work);
    work();
    for (std::thread& thread : pool) thread.join();
    fitted.erase(std::remove_if(fitted.begin(), fitted.end(), [](const FittedChain& f) { return f.elements.empty(); }),
                 fitted.end());
    return fitted;
}

// Contours of one map never cross; where their fits do, they are fitted again by lines ever closer to the points.
void untangle_steps(std::vector<FittedChain>& chains, const Lattice& lattice, double tolerance) {
    for (const double closer : {0.5, 0.15, 0.0}) {
        const std::vector<std::uint8_t> tangled = find_tangled_steps(chains, lattice);
        if (std::find(tangled.begin(), tangled.end(), 1) == tangled.end()) return;
        for (std::size_t c = 0; c < chains.size(); ++c) {
            if (!tangled[c]) continue;
            chains[c].elements = fit_polyline(chains[c].chain, closer * tolerance);
            chains[c].length = chain_length(chains[c].elements);
        }
    }
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

std::size_t count_lines(const std::vector<Chain>& chains, double tolerance) {
    std::size_t sum = 0;
    for (const Chain& chain : chains) sum += fit_polyline(chain, tolerance).size();
    return sum;
}

// A curve that follows the grain of a ragged edge costs an element every few texels: first the fit is loosened, then
// the least regions are given up, until the steps leave room for lines.
std::vector<FittedChain> fit_within(Traced& traced, const VectorizeOptions& options, std::size_t budget,
                                    Vectorized& result, int threads) {
    const Lattice& lattice = traced.lattice;
    const double energy = traced.energy;
    double share = kLeastRegionShare;
    const double asked = options.most_elements > 0 ? 1.7 : 1.0;  // a limit that was asked for goes before beauty
    const double loosest = asked * std::max(1.2, 0.0012 * std::min(lattice.width, lattice.height));
    result.tolerance = options.tolerance > 0.0 ? options.tolerance : 0.3;
    // Polylines are fast and tell how many elements to expect; the curves, which need fewer, are fitted once at the end.
    const std::size_t most = budget * 5 / 4;
    std::size_t lines = count_lines(traced.lines, result.tolerance), steps = count_lines(traced.steps, result.tolerance);
    while (options.tolerance == 0.0 && lines + steps > most && result.tolerance * 1.4 <= loosest) {
        result.tolerance *= 1.4;
        lines = count_lines(traced.lines, result.tolerance);
        steps = count_lines(traced.steps, result.tolerance);
    }
    for (int round = 0; round < 8 && steps > most * 3 / 4; ++round) {
        share *= 2.0;
        merge_regions(traced.flattened, lattice, result.noise, share * energy, traced.regions);
        traced.steps = trace_steps(traced.flattened, lattice, traced.regions);
        steps = count_lines(traced.steps, result.tolerance);
    }
    return join(fit_chains(traced.lines, result.tolerance, threads), fit_chains(traced.steps, result.tolerance, threads));
}

// Lines that explain little per element go, the least useful first, until the rest is within the budget. Steps hold the
// regions together and stay.
void drop_useless(std::vector<FittedChain>& chains, double energy, std::size_t most_elements) {
    const double least = 2e-5 * energy;
    const auto worth = [](const FittedChain& f) { return f.gain / static_cast<double>(f.elements.size()); };
    const auto removable = [](const FittedChain& f) { return f.chain.kind != ChainKind::step; };
    chains.erase(std::remove_if(chains.begin(), chains.end(),
                                [&](const FittedChain& f) { return removable(f) && worth(f) < least; }),
                 chains.end());
    std::size_t count = count_elements(chains);
    if (count <= most_elements) return;
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
    for (Element e : fitted.elements) {
        e.p0 = units.point(e.p0);
        e.p1 = units.point(e.p1);
        e.p2 = units.point(e.p2);
        path.elements.push_back(e);
    }
    std::uint32_t region = fitted.chain.left_region;
    if (fitted.chain.kind != ChainKind::step) {
        const Vec2 p = fitted.chain.points[fitted.chain.points.size() / 2];
        region = regions.label[lattice.nearest(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)))];
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

// Elements whose texels, lists and share of the grid fit into a sixteenth of the map's size.
std::size_t element_budget(const Lattice& lattice, const VectorizeOptions& options) {
    if (options.most_elements > 0) return static_cast<std::size_t>(options.most_elements);
    const double bytes = static_cast<double>(lattice.size()) / 16.0;
    return std::max<std::size_t>(64, static_cast<std::size_t>(std::min(bytes, 60.0 * 1024.0 + bytes / 16.0) / 36.0));
}

Wrap choose_wrap(const Image& map, WrapChoice choice) {
    if (choice == WrapChoice::automatic) return borders_match(map) ? Wrap::repeat : Wrap::clamp;
    return choice == WrapChoice::repeat ? Wrap::repeat : Wrap::clamp;
}

int thread_count(const VectorizeOptions& options) {
    return options.threads > 0 ? options.threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

ProfileOptions profile_options(const Traced& traced) {
    ProfileOptions options;
    options.noise = traced.noise;
    options.reach = std::clamp(0.06 * std::min(traced.lattice.width, traced.lattice.height), 8.0, 64.0);
    options.most_profiles = static_cast<std::size_t>(std::clamp(traced.lattice.size() / 4096, 16, 400));
    return options;
}

Error stopped() { return {ErrorCode::invalid_argument, "vectorize: stopped by the caller"}; }

}  // namespace

Result<TracedMap> trace_map(const HeightMap& map, const VectorizeOptions& options, const Progress& progress) {
    const Status checked = check_options(map, options);
    if (!checked) return checked.error();
    const Wrap wrap = choose_wrap(map.image, options.wrap);
    auto traced = std::make_shared<Traced>();
    traced->lattice = {map.image.width, map.image.height, wrap == Wrap::repeat};
    traced->noise = estimate_noise(map.image, traced->lattice);
    traced->energy = total_energy(map.image, wrap);
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
    Traced traced = *found.found;  // regions are merged and levels settled to fit the budget
    const Lattice& lattice = traced.lattice;
    Vectorized result;
    result.noise = traced.noise;
    result.energy = traced.energy;
    const std::size_t budget = element_budget(lattice, options);
    std::vector<FittedChain> fitted = fit_within(traced, options, budget, result, thread_count(options));
    untangle_steps(fitted, lattice, result.tolerance);
    if (!proceed(0.6)) return stopped();
    const ProfileSet set = measure_profiles(fitted, map.image, lattice, traced.regions, profile_options(traced));
    drop_useless(fitted, traced.energy, budget);
    if (!proceed(0.8)) return stopped();
    const Wrap wrap = lattice.wrap ? Wrap::repeat : Wrap::clamp;
    result.pattern = make_pattern(fitted, set, traced.regions, lattice, options, wrap);
    for (const FittedChain& f : fitted) result.path_length_texels += f.length;
    return result;
}

Result<Vectorized> vectorize_map(const HeightMap& map, const VectorizeOptions& options, const Progress& progress) {
    const Result<TracedMap> traced = trace_map(map, options, progress);
    if (!traced) return traced.error();
    return fit_traced_map(*traced, map, options, progress);
}

}  // namespace burin
