#include "convert_internal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include <burin/compare.hpp>
#include <burin/reconstruct.hpp>

#include "resolve_curve.hpp"

namespace burin {
using namespace converting;
namespace {

constexpr double kAccidentShare = 0.1;  // explained: paths that reach less are accidents

// A step of the refinement looks at the texels within reach of every element: wide profiles on long paths would take
// long and gain little, since a soft wall shows its place well. Whether it runs depends on the pattern alone, not on a
// clock, so that the bytes do not depend on the machine.
bool can_afford_refinement(const Pattern& pattern, const Image& map, double explained) {
    // Element lengths times profile widths: up to 8 seconds on two cores where the paths are what the map is made of, a
    // third as much where much of it is something else.
    constexpr double kMade = 0.9, kMostTexels = 1e6, kMostOfOthers = 3e5;
    const double texels = map.width / pattern.size.x;
    double work = 0.0;
    for (const Path& path : pattern.paths) {
        const std::vector<ProfilePoint>& points = pattern.profiles[path.profile].points;
        const double reach = (points.back().b - points.front().b) * texels + 2.0;
        for (const Element& element : path.elements) work += curve::arc_length(element) * texels * reach;
    }
    return work <= (explained >= kMade ? kMostTexels : kMostOfOthers);
}

Unrefined reason_not_to_refine(const Candidate& candidate, const HeightMap& map, const ConvertOptions& options) {
    if (!options.refine) return Unrefined::not_asked;
    if (candidate.traced.pattern.paths.empty()) return Unrefined::no_paths;
    if (!candidate.stats.path_like) return Unrefined::not_path_like;
    return can_afford_refinement(candidate.traced.pattern, map.image, candidate.stats.explained) ? Unrefined::no : Unrefined::too_much_work;
}

// Takes out elements of hardly a texel: where a crossing left a kink, the refinement may fold it, and what lies in the
// outer sector of a fold reaches far.
Pattern without_folds(Pattern pattern, double texel) {
    constexpr double kShortest = 1.5;  // texels
    for (Path& path : pattern.paths) {
        std::vector<Element>& elements = path.elements;
        for (std::size_t i = 1; i + 1 < elements.size();) {
            if (length(elements[i].p2 - elements[i].p0) >= kShortest * texel) {
                ++i;
                continue;
            }
            elements[i + 1].p0 = elements[i].p0;
            elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
    return pattern;
}

RefineOptions refine_options(const Candidate& candidate, const ConvertOptions& options, std::size_t budget) {
    RefineOptions refinement = options.refinement;
    refinement.threads = options.threads;
    refinement.damage = candidate.traced.damage;
    // Where bytes are short, the refinement has none to add.
    if (candidate.most_elements > 0 || candidate.traced.tolerance > kUsualTolerance) refinement.elements = false;
    refinement.most_splits = std::min(refinement.most_splits, room_for_elements(candidate.packed.textures, budget));
    return refinement;
}

// What the refinement made worse, because the traced structure is not that of the map, is not kept: nothing then.
std::optional<Candidate> refined_once(const Candidate& candidate, const Source& source, const ConvertOptions& options,
                                      const RefineOptions& refinement, std::size_t budget, StageClock& clock) {
    const HeightMap& map = source.map;
    const auto is_better = [&](const Result<Candidate>& other) {
        return other && other->stats.explained >= candidate.stats.explained &&
               (options.max_texture_bytes == 0 || other->bytes() <= budget);
    };
    Vectorized refined = candidate.traced;
    if (!clock.begin("refine") || !refine_pattern(refined.pattern, source.detail().image, refinement)) return std::nullopt;
    Vectorized unfolded = refined;
    auto better = pack_and_measure(std::move(refined), map, options, budget, clock);
    if (!is_better(better)) {
        const double texel = unfolded.pattern.size.x / map.image.width;
        unfolded.pattern = without_folds(std::move(unfolded.pattern), texel);
        better = pack_and_measure(std::move(unfolded), map, options, budget, clock);
    }
    if (!is_better(better)) return std::nullopt;
    return std::move(*better);
}

// Least squares against the map; with the profiles as they were measured where fitting them as well does harm.
Result<Candidate> refine_candidate(Candidate candidate, const Source& source, const ConvertOptions& options,
                                   std::size_t budget, StageClock& clock) {
    candidate.stats.unrefined = reason_not_to_refine(candidate, source.map, options);
    if (candidate.stats.unrefined != Unrefined::no) return candidate;
    candidate.stats.unrefined = Unrefined::no_gain;
    RefineOptions refinement = refine_options(candidate, options, budget);
    std::optional<Candidate> better = refined_once(candidate, source, options, refinement, budget, clock);
    if (!better && refinement.profiles) {
        refinement.profiles = false;
        better = refined_once(candidate, source, options, refinement, budget, clock);
    }
    return better ? std::move(*better) : std::move(candidate);
}

// Paths that explain next to nothing are accidents of rock or noise: the fallback maps show the surface better alone.
Result<Candidate> without_accidents(Candidate candidate, const HeightMap& map, const ConvertOptions& options,
                                    std::size_t budget, StageClock& clock) {
    if (candidate.stats.explained >= kAccidentShare || candidate.traced.pattern.paths.empty()) return candidate;
    Vectorized empty = candidate.traced;
    empty.pattern.paths.clear();
    empty.pattern.profiles.clear();
    return pack_and_measure(std::move(empty), map, options, budget, clock);
}

// A candidate without what is no path, and refined.
Result<Candidate> finish_candidate(Candidate fitted, const Source& source, const ConvertOptions& options,
                                   std::size_t budget, StageClock& clock) {
    const double traced_explained = fitted.stats.explained;
    auto candidate = without_accidents(std::move(fitted), source.map, options, budget, clock);
    if (candidate) candidate = refine_candidate(std::move(*candidate), source, options, budget, clock);
    if (candidate) candidate->stats.traced_explained = traced_explained;
    return candidate;
}

Result<Start> start_within(const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                           const Progress& progress, StageClock& clock) {
    auto start = trace_best(map, options, budget, progress, clock);
    if (!start) return start.error();
    auto finished = finish_candidate(std::move(start->candidate), start->source, options, start->budget, clock);
    if (!finished) return finished.error();
    start->candidate = std::move(*finished);
    return start;
}

// A bound that no conversion kept, and the value that one did keep.
Error cannot_keep(const std::string& bound, const std::string& why, const std::string& works) {
    return {ErrorCode::invalid_argument, bound + " cannot be kept: " + why + "; " + works + " works"};
}

// Whether paths are given up until both textures take no more. The refinement keeps to what they took without it.
Result<bool> can_keep_bytes(const HeightMap& map, ConvertOptions options, std::size_t bytes, const Progress& progress,
                            StageClock& clock) {
    options.max_texture_bytes = bytes;
    options.refine = false;
    const auto start = start_within(map, options, bytes, progress, clock);
    if (!start) return start.error();
    return start->candidate.bytes() <= bytes;
}

// Looks for the least number of bytes that can be kept, to be told: what works is what was tried.
Error refuse_bytes(const HeightMap& map, const ConvertOptions& options, std::size_t reached, const Progress& progress,
                   StageClock& clock) {
    constexpr int kMostHalvings = 5;
    constexpr std::size_t kNear = 16;  // a share of what works
    std::size_t fails = options.max_texture_bytes, works = 0, trial = reached;
    for (int halvings = 0; works == 0 || (halvings < kMostHalvings && works - fails > works / kNear);) {
        const auto kept = can_keep_bytes(map, options, trial, progress, clock);
        if (!kept) return kept.error();
        (*kept ? works : fails) = trial;
        halvings += works > 0;
        trial = works > 0 ? fails + (works - fails) / 2 : trial + trial / 2;
    }
    return cannot_keep("a limit of " + std::to_string(options.max_texture_bytes) + " bytes for both textures",
                       std::string("giving up paths does not come down to it") +
                           (options.grid.cell_size > 0.0 ? " with cells of the size that was asked for" : ""),
                       std::to_string(works) + " bytes");
}

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", share * 100.0);
    return text;
}

// Three digits, upwards: what was reached keeps within it.
std::string percent_above(double share) {
    const double scale = std::pow(10.0, 2.0 - std::floor(std::log10(std::max(share * 100.0, 1e-6))));
    return percent(std::ceil(share * 100.0 * scale) / scale / 100.0);
}

// The 99.9th percentile of the height error without the texels next to the borders.
double p999_inside(const Image& drawn, const Image& map) {
    constexpr int kRim = 8;  // texels
    std::vector<float> errors;
    for (int y = kRim; y < map.height - kRim; ++y)
        for (int x = kRim; x < map.width - kRim; ++x) errors.push_back(std::abs(drawn.at(x, y) - map.at(x, y)));
    if (errors.empty()) return 0.0;
    const auto at = errors.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(errors.size() - 1) * 0.999);
    std::nth_element(errors.begin(), at, errors.end());
    return static_cast<double>(*at);
}

Error refuse_error(const HeightMap& map, const ConvertOptions& options, const Candidate& best) {
    const std::size_t bytes = options.max_texture_bytes;
    std::string why = "the closest paths " + (bytes > 0 ? "within " + std::to_string(bytes) + " bytes " : std::string()) +
                      "err by " + percent(best.stats.p999) + " % in the 99.9th percentile";
    if (best.stats.p999_without_smooth < 0.8 * best.stats.p999)
        why += ", by " + percent(best.stats.p999_without_smooth) + " % but for soft ground, which is no path";
    if (options.vectorize.wrap == WrapChoice::automatic && best.stats.repeat && best.heights.texels.size() == map.image.texels.size())
        if (const double inside = p999_inside(best.heights, map.image); inside > 0.0 && inside < 0.5 * best.stats.p999)
            why += ", by " + percent(inside) + " % but for the borders, which a map that does not repeat need not join: wrap clamp";
    return cannot_keep("a height error of " + percent(options.max_error) + " % of range", why,
                       percent_above(best.stats.p999) + " %");
}

// Fits and refines anew from curves of other tolerances, and then once more, until 99.9 % of the texels keep the bound.
// Closer curves are not closer to the map each time, since what is refined from them ends in other minima: each is tried,
// looser ones too, and the best is kept.
Result<Candidate> closer_within(const Source& source, ConvertOptions options, Candidate best, const Progress& progress,
                                StageClock& clock) {
    constexpr double kLoosest = 8.0;  // VectorizeOptions::tolerance
    const bool bytes_bound = options.max_texture_bytes > 0;
    const std::size_t texels = source.map.image.texels.size();
    const std::size_t budget = bytes_bound ? options.max_texture_bytes : std::max(texels, default_budget(texels));
    const double usual = best.traced.tolerance;
    const auto take_better = [&](Result<Candidate> other) {
        if (other && other->bytes() <= budget && other->stats.p999 < best.stats.p999) best = std::move(*other);
    };
    for (const double times : {0.5, 0.25, 2.0, 0.125}) {
        if (best.stats.p999 <= options.max_error) return best;
        options.vectorize.tolerance = std::min(kLoosest, times * usual);
        auto other = fit_within(source, options, budget, progress, clock);
        if (other) other = finish_candidate(std::move(*other), source, options, budget, clock);
        take_better(std::move(other));
    }
    if (best.stats.p999 > options.max_error) take_better(refine_candidate(best, source, options, budget, clock));
    if (best.stats.p999 > options.max_error) return refuse_error(source.map, options, best);
    return best;
}

Result<Candidate> within_bounds(const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                                const Progress& progress, StageClock& clock) {
    const bool bytes_bound = options.max_texture_bytes > 0;
    auto start = start_within(map, options, budget, progress, clock);
    if (!start) return start.error();
    const Candidate& first = start->candidate;
    if (bytes_bound && first.bytes() > budget) return refuse_bytes(map, options, first.bytes(), progress, clock);
    if (options.max_error <= 0.0 || first.stats.p999 <= options.max_error) return std::move(start->candidate);
    return closer_within(start->source, options, std::move(start->candidate), progress, clock);
}

// The candidate of a coarser map, with the figures that it reaches against the map itself.
Result<Candidate> of_finer_map(Candidate candidate, const HeightMap& map, int halvings, const ConvertOptions& options,
                               StageClock& clock) {
    const int times = 1 << halvings;
    candidate.stats.halvings = halvings;
    candidate.stats.path_length_texels *= times;
    candidate.traced.tolerance *= times;
    return measure_candidate(std::move(candidate), map, options, clock);
}

// As many texels as show all of the map are traced.
Result<Candidate> best_candidate(const HeightMap& map, const ConvertOptions& options, const Progress& progress,
                                 StageClock& clock) {
    const bool bytes_bound = options.max_texture_bytes > 0;
    const std::size_t budget = bytes_bound ? options.max_texture_bytes : default_budget(map.image.texels.size());
    if (options.max_error > 0.0) return within_bounds(map, options, budget, progress, clock);
    if (!clock.begin("coarsen")) return stopped();
    CoarsenOptions coarsen = options.coarsen;
    coarsen.threads = options.threads;
    const Coarsened coarse = coarsen_map(map, coarsen);
    if (!coarse.map) return within_bounds(map, options, budget, progress, clock);
    ConvertOptions coarse_options = options;
    coarse_options.vectorize.tolerance /= 1 << coarse.halvings;
    auto candidate = within_bounds(*coarse.map, coarse_options, budget, progress, clock);
    if (candidate) candidate = of_finer_map(std::move(*candidate), map, coarse.halvings, options, clock);
    return candidate;
}

// Without the paths that could not be joined: the pattern of what is stored.
Pattern stored_pattern(Pattern pattern, const std::vector<std::uint32_t>& paths) {
    std::vector<Path> kept;
    for (const std::uint32_t path : paths) kept.push_back(std::move(pattern.paths[path]));
    pattern.paths = std::move(kept);
    return pattern;
}

void count_kinds(const Pattern& pattern, ConvertStats& stats) {
    int* const counts[] = {&stats.grooves, &stats.ridges, &stats.steps};  // as PathKind counts them
    for (const Path& path : pattern.paths) ++*counts[static_cast<std::size_t>(path_kind(pattern, path))];
}

// A large map at half its sides, a quarter, ...; nothing where it is small.
std::optional<Image> of_fewer_texels(const Image& map, int threads) {
    constexpr std::size_t kEnough = 2u << 20;
    std::optional<Image> fewer;
    for (const Image* from = &map; from->texels.size() > kEnough && from->width % 2 == 0 && from->height % 2 == 0; from = &*fewer)
        fewer = halve_image(*from, threads);
    return fewer;
}

// The certificate by class. Drawn again only where both classes are there.
Status share_out(const Image& map, const Candidate& candidate, int threads, ConvertStats& stats) {
    const bool lines = stats.grooves + stats.ridges > 0;
    double steps = lines ? 0.0 : stats.explained;
    if (lines && stats.steps > 0) {
        // Fewer texels and samples take a small part of the time and move the share by less than 0.0005.
        const std::optional<Image> fewer = of_fewer_texels(map, threads);
        const Image& seen = fewer ? *fewer : map;
        const auto heights = reconstruct(seen, candidate.packed.textures, candidate.packed.detail,
                                         {.steps_only = true, .samples = 2, .threads = threads});
        if (!heights) return heights.error();
        steps = compare_heights(*heights, seen, stats.repeat ? Wrap::repeat : Wrap::clamp, threads).explained;
    }
    stats.shares = {steps, stats.explained - steps, 1.0 - stats.explained};
    return Done{};
}

// What the stored paths leave, as a normal map.
Result<Residual> residual_of(const HeightMap& map, const FoundPattern& found, Image heights, const ConvertOptions& options) {
    if (heights.texels.empty()) {
        // Fewer samples than the figures of heights take: half the time, and angles within 0.02 degrees.
        auto drawn = reconstruct(map.image, found.textures, found.detail,
                                 {.samples = samples_for(found.stats, 3), .threads = options.threads});
        if (!drawn) return drawn.error();
        heights = std::move(*drawn);
    }
    ResidualOptions residual = options.residual;
    residual.threads = options.threads;
    const bool chosen = residual.most_texels != ResidualOptions{}.most_texels;
    if (!chosen && found.stats.explained >= kWellExplained) residual.most_texels = map.image.texels.size() / 64;
    if (found.pattern.paths.empty()) residual.worthwhile = 0.0;
    const std::size_t spent = found.stats.grid_bytes + found.stats.data_bytes;
    if (options.max_texture_bytes > 0) residual.most_bytes = std::min(residual.most_bytes, options.max_texture_bytes - spent);
    const Wrap wrap = found.stats.repeat ? Wrap::repeat : Wrap::clamp;
    auto baked = bake_residual(map.image, heights, found.pattern.size, found.pattern.depth, wrap, residual);
    // A larger texture is the lesser evil where the map is small.
    constexpr std::size_t kMostTexels = std::size_t{1} << 20;
    if (chosen || !baked || baked->error <= residual.tolerance || map.image.texels.size() > kMostTexels) return baked;
    residual.most_texels = ResidualOptions{}.most_texels;
    return bake_residual(map.image, heights, found.pattern.size, found.pattern.depth, wrap, residual);
}

// The pattern, and what was drawn of it to be measured.
Result<std::pair<FoundPattern, Image>> find_and_draw(const HeightMap& map, const ConvertOptions& options,
                                                     const Progress& progress) {
    if (!(options.max_error >= 0.0 && options.max_error <= 1.0))
        return Error{ErrorCode::invalid_argument,
                     "max_error: " + std::to_string(options.max_error) + " of the range; 0 to 1 would work"};
    std::vector<std::pair<std::string, double>> seconds;
    StageClock clock(progress, seconds);
    auto candidate = best_candidate(map, options, progress, clock);
    if (!candidate) return candidate.error();

    FoundPattern found;
    found.stats = candidate->stats;
    found.stats.noise = candidate->traced.noise;
    found.stats.tolerance = candidate->traced.tolerance;
    found.pattern = stored_pattern(std::move(candidate->traced.pattern), candidate->packed.paths);
    count_kinds(found.pattern, found.stats);
    if (!clock.begin("measure")) return stopped();
    if (const Status shared = share_out(map.image, *candidate, options.threads, found.stats); !shared) return shared.error();
    clock.end();
    found.stats.seconds = std::move(seconds);
    found.textures = std::move(candidate->packed.textures);
    found.detail = std::move(candidate->packed.detail);
    return std::pair{std::move(found), std::move(candidate->heights)};
}

}  // namespace

Result<FoundPattern> find_pattern(const HeightMap& map, const ConvertOptions& options, const Progress& progress) {
    auto found = find_and_draw(map, options, progress);
    if (!found) return found.error();
    return std::move(found->first);
}

Result<Converted> convert_map(const HeightMap& map, const Model& model, const ConvertOptions& options,
                              const Progress& progress) {
    auto found = find_and_draw(map, options, progress);
    if (!found) return found.error();
    Converted converted{std::move(found->first), {}, {}};
    StageClock clock(progress, converted.stats.seconds);
    if (!clock.begin("bake")) return stopped();
    auto residual = residual_of(map, converted, std::move(found->second), options);
    if (!residual) return residual.error();
    converted.residual = std::move(*residual);
    const Pattern& pattern = converted.pattern;
    Fallback fallback = bake_fallback(map.image, pattern.size, pattern.depth, pattern.wrap, options.fallback);
    // Both show the whole map then; one is stored.
    if (pattern.paths.empty() && converted.residual.picture.width > 0) fallback.normal = {};

    if (!clock.begin("write")) return stopped();
    auto bytes = write_glb(model, converted.textures, converted.detail, fallback, options.attach, converted.residual);
    if (!bytes) return bytes.error();
    clock.end();
    converted.glb = std::move(*bytes);
    converted.stats.file_bytes = converted.glb.size();
    return converted;
}

}  // namespace burin
