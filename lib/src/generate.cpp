// The table of kinds, and what all of them have in common.
#include <burin/generate.hpp>

#include <algorithm>
#include <cmath>

#include "generate_internal.hpp"

namespace burin {
namespace generating {
namespace {

struct Kind : GeneratorEntry {
    Generator generate;
};

// Scratches and brushed metal differ in what is usual alone.
struct ScratchNumbers {
    double density, length, length_spread, direction, spread, bend, width, depth, clustered;
};

std::vector<Parameter> scratch_parameters(const ScratchNumbers& usual) {
    return {{"density", usual.density, 0.0, 1e8, "how many", "per cm2"},
            {"length", usual.length, 1e-7, 1e5, "median length", "m"},
            {"length_spread", usual.length_spread, 0.0, 1.5, "deviation of the length's logarithm"},
            {"direction", usual.direction, -360.0, 360.0, "mean direction, 0 along u", "deg"},
            {"spread", usual.spread, 0.0, 180.0, "deviation of the direction, 0 all parallel, 180 any way", "deg"},
            {"bend", usual.bend, 0.0, 90.0, "deviation of how far one turns from end to end", "deg"},
            {"width", usual.width, 1e-9, 1e4, "median width", "m"},
            {"width_spread", 0.4, 0.0, 1.0, "deviation of the width's logarithm"},
            {"depth", usual.depth, 1e-9, 1e4, "median depth", "m"},
            {"depth_spread", 0.4, 0.0, 1.0, "deviation of the depth's logarithm"},
            {"taper", 1.0, 0.0, 1.0, "how far both ends thin, 1 to nothing"},
            {"clustered", usual.clustered, 0.0, 1.0, "share of them that lie in clusters, side by side"},
            {"cluster_size", 8.0, 2.0, 1000.0, "how many lie in one cluster", "", true},
            {"cluster_radius", 0.004, 0.0, 1e4, "deviation of a cluster's places", "m"}};
}

constexpr const char* kBevelHelp = "width of the slope at the edges of a block; where raised is 1";

std::vector<Parameter> block_parameters(double joint, double depth, double uneven, double irregular) {
    return {{"joint", joint, 1e-7, 1e4, "width of the joints", "m"},
            {"depth", depth, 1e-9, 1e4, "of the joints", "m"},
            {"bevel", 0.4 * joint, 0.0, 1e4, kBevelHelp, "m"},
            {"round", 0.5 * joint, 0.0, 1e4, "radius of round corners; where raised is 1", "m"},
            {"uneven", uneven, 0.0, 0.9, "share of the depth by which blocks differ in height; where raised is 1"},
            {"irregular", irregular, 0.0, 1.0, "how far corners stray into the joints; where raised is 1"},
            {"raised", 1.0, 0.0, 1.0, "1: blocks are plateaus; 0: joints are grooves", "", true}};
}

std::vector<Parameter> with(std::vector<Parameter> first, const std::vector<Parameter>& more) {
    first.insert(first.end(), more.begin(), more.end());
    return first;
}

std::vector<Kind> make_kinds() {
    return {
        {{"scratches", "scratches of wear, thrown up at their edges", "burr", true,
          scratch_parameters({4.0, 0.014, 0.5, 0.0, 180.0, 12.0, 0.0005, 0.0001, 0.3})}, make_scratches},
        {{"brushed", "long fine grooves one beside the other, as a brush leaves them on metal", "vee", true,
          scratch_parameters({24.0, 0.05, 0.4, 0.0, 0.8, 0.5, 0.0004, 0.00006, 0.0})}, make_scratches},
        {{"cracks", "cracks that wander, branch and thin to nothing", "vee", true,
          {{"count", 7, 0, 100000, "cracks that are nobody's branch", "", true},
           {"length", 0.16, 1e-6, 1e5, "of the longest of them", "m"},
           {"width", 0.0024, 1e-9, 1e4, "where they are widest", "m"},
           {"depth", 0.0024, 1e-9, 1e4, "where they are deepest", "m"},
           {"wander", 22, 0, 60, "deviation of the turn from piece to piece", "deg"},
           {"branching", 0.12, 0, 1, "chance that a piece sends out a branch"},
           {"generations", 2, 0, 5, "how often branches branch again, 0 no branch", "", true}}}, make_cracks},
        {{"hatch", "hatching, as a graver darkens a field", "vee", false,
          {{"angle", 30, -360, 360, "of the first layer, 0 along u", "deg"},
           {"layers", 2, 1, 4, "families of parallel lines", "", true},
           {"turn", 75, -180, 180, "from one layer to the next", "deg"},
           {"spacing", 0.004, 1e-7, 1e4, "from line to line", "m"},
           {"width", 0.0009, 1e-9, 1e4, "of a line", "m"},
           {"depth", 0.0005, 1e-9, 1e4, "of a line", "m"},
           {"jitter", 0.15, 0, 0.9, "how far lines stray, as a share of the spacing"},
           {"uneven", 0.35, 0, 0.9, "how far width and depth swell along a line"}}}, make_hatch},
        {{"knurl", "pyramids between two families of grooves, as on a handle", "vee", false,
          {{"angle", 0, -360, 360, "middle of both directions, 0 along u", "deg"},
           {"crossing", 60, 10, 90, "between both directions", "deg"},
           {"spacing", 0.006, 1e-7, 1e4, "from groove to groove", "m"},
           {"depth", 0.0025, 1e-9, 1e4, "of the grooves", "m"},
           {"land", 0, 0, 0.9, "width of the flat tops, as a share of the spacing"}}}, make_knurl},
        {{"weave", "threads that go over and under each other", "bead(floor=0.3,points=3)", false,
          {{"warp", 6, 1, 500, "pairs of threads along v", "", true},
           {"weft", 6, 1, 500, "pairs of threads along u", "", true},
           {"width", 0.85, 0.1, 1, "of a thread, as a share of the distance to the next"},
           {"height", 0.003, 1e-9, 1e4, "of a thread where it goes over", "m"},
           {"under", 0.4, 0.05, 1, "height where it goes under, as a share of that"}}}, make_weave},
        {{"tiles", "square tiles with joints", "bead(points=3)", false,
          with({{"columns", 4, 1, 1000, "tiles along u", "", true}, {"rows", 4, 1, 1000, "tiles along v", "", true}},
               block_parameters(0.003, 0.002, 0.1, 0.0))}, make_tiles},
        {{"bricks", "courses of bricks, each shifted against the one before it", "bead(points=3)", false,
          with({{"columns", 3, 1, 1000, "bricks along u", "", true},
                {"course_pairs", 4, 1, 1000, "pairs of courses along v", "", true},
                {"shift", 0.5, 0.1, 0.9, "of every second course, as a share of a brick"}},
               block_parameters(0.004, 0.003, 0.25, 0.6))}, make_bricks},
        {{"vinyl", "grooves of a record around the middle of the tile", "vee", false,
          {{"outer", 0.95, 0.01, 1, "radius of the first groove, as a share of half the shorter side"},
           {"inner", 0.38, 0, 0.99, "radius of the last one, likewise"},
           {"pitch", 0.0015, 1e-7, 1e4, "from groove to groove", "m"},
           {"width", 0.0011, 1e-9, 1e4, "of a groove", "m"},
           {"depth", 0.0005, 1e-9, 1e4, "of a groove", "m"},
           {"spiral", 1, 0, 1, "1: one groove all the way; 0: circles", "", true},
           {"uneven", 0.25, 0, 0.9, "how far the width swells; the depth by half of that"},
           {"wavelength", 0.004, 1e-7, 1e4, "of the swelling", "m"}}}, make_vinyl},
        {{"chainmail", "linked rings, four through each", "bead(points=3)", false,
          {{"columns", 8, 2, 500, "rings along u", "", true},
           {"row_pairs", 7, 1, 500, "pairs of rows along v", "", true},
           {"ring", 0.45, 0.1, 0.7, "radius of a ring, as a share of the distance from ring to ring"},
           {"wire", 0.13, 0.01, 0.4, "thickness of the wire, likewise"},
           {"height", 0.003, 1e-9, 1e4, "of a ring where it is highest", "m"},
           {"lean", 0.2, 0, 0.45, "how much lower a ring is in its middle than there, and once more on its far side"}}}, make_chainmail},
    };
}

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> table = make_kinds();
    return table;
}

Result<const Kind*> find_kind(const std::string& name) {
    std::string names;
    for (const Kind& kind : kinds()) {
        if (name == kind.name) return &kind;
        names.append(names.empty() ? "" : ", ").append(kind.name);
    }
    return Error{ErrorCode::invalid_argument, std::string("generator '").append(name).append("' is not known; one of ").append(names).append(" works")};
}

Status check_frame(const Kind& kind, const GenerateSpec& spec) {
    for (const double side : {spec.size.x, spec.size.y})
        if (!(side >= 1e-6 && side <= 1e6))
            return Error{ErrorCode::invalid_argument, "size " + parameter_text(side) + " is out of its range; 1e-06 to 1e+06 m works"};
    if (spec.mask && !kind.masked)
        return Error{ErrorCode::invalid_argument, std::string(kind.name) + " takes no mask; scratches, brushed and cracks do"};
    return Done{};
}

// Greatest factor that a perturbation puts on heights.
double swelling(const Pattern& pattern, const Path& path) {
    return path.perturbation == kNoPerturbation ? 1.0 : 1.0 + pattern.perturbations[path.perturbation].height;
}

// Depth and base offset as the paths need them.
void fit_depth(Pattern& pattern) {
    if (pattern.paths.empty()) pattern.profiles.clear();
    double low = std::min(0.0, pattern.outer_level), high = std::max(0.0, pattern.outer_level);
    std::vector<std::pair<double, double>> reaches;
    for (const Profile& profile : pattern.profiles) {
        reaches.emplace_back(0.0, 0.0);
        for (const ProfilePoint& p : profile.points)
            reaches.back() = {std::min(reaches.back().first, p.h), std::max(reaches.back().second, p.h)};
    }
    for (const Path& path : pattern.paths) {
        // A profile itself lies within the depth, even where all that carry it are lower.
        double scale = 1.0;
        for (const Element& e : path.elements) scale = std::max({scale, e.height0, e.height1});
        scale *= swelling(pattern, path);
        low = std::min(low, path.level + scale * reaches[path.profile].first);
        high = std::max(high, path.level + scale * reaches[path.profile].second);
    }
    pattern.base_offset = high;
    // A pattern that came out empty is as flat as a pattern can be.
    pattern.depth = high > low ? high - low : 1e-6;
}

}  // namespace

double Work::worn_at(Vec2 p) const {
    if (!spec.mask) return 1.0;
    const auto texel = [](double share, int count) {
        const double inside = share - std::floor(share);
        return std::min(count - 1, int(inside * count));
    };
    return spec.mask->at(texel(p.x / pattern.size.x, spec.mask->width), texel(p.y / pattern.size.y, spec.mask->height));
}

Result<std::uint32_t> Work::add_section(double width, double height) {
    auto section = make_profile(profile, width, height);
    if (!section) return section.error();
    pattern.profiles.push_back(std::move(*section));
    return static_cast<std::uint32_t>(pattern.profiles.size() - 1);
}

Result<std::uint32_t> Work::add_step(double width, double height) {
    auto step = make_step_profile(profile, width, height);
    if (!step) return step.error();
    pattern.profiles.push_back(std::move(*step));
    return static_cast<std::uint32_t>(pattern.profiles.size() - 1);
}

std::uint32_t Work::add_noise(double width, double height, double wavelength) {
    if (width == 0.0 && height == 0.0) return kNoPerturbation;
    Perturbation noise;
    noise.kind = PerturbationKind::noise;
    noise.width = width;
    noise.height = height;
    noise.wavelength = wavelength;
    noise.octaves = 2;
    noise.seed = static_cast<std::uint32_t>(spec.seed ^ (spec.seed >> 32));
    pattern.perturbations.push_back(noise);
    return static_cast<std::uint32_t>(pattern.perturbations.size() - 1);
}

Error refuse(const Work& work, const std::string& what) { return {ErrorCode::invalid_argument, work.spec.kind + ": " + what}; }

}  // namespace generating

const std::vector<GeneratorEntry>& generator_table() {
    static const std::vector<GeneratorEntry> table(generating::kinds().begin(), generating::kinds().end());
    return table;
}

Result<Pattern> generate_pattern(const GenerateSpec& spec) {
    const auto kind = generating::find_kind(spec.kind);
    if (!kind) return kind.error();
    if (const Status status = generating::check_frame(**kind, spec); !status) return status.error();
    auto values = complete_parameters(spec.kind, (*kind)->parameters, spec.parameters);
    if (!values) return values.error();
    auto profile = parse_profile(spec.profile.empty() ? (*kind)->profile : spec.profile);
    if (!profile) return profile.error();
    generating::Work work{spec, std::move(*values), std::move(*profile), {}};
    work.pattern.size = spec.size;
    work.pattern.wrap = spec.wrap;
    if (const Status generated = (*kind)->generate(work); !generated) return generated.error();
    generating::fit_depth(work.pattern);
    return std::move(work.pattern);
}

}  // namespace burin
