#include <burin/profiles.hpp>

#include <algorithm>
#include <cmath>

#include "profiles_curve.hpp"
#include "steady_math.hpp"
#include "text.hpp"

namespace burin {
namespace {

using profiling::Curve;
using profiling::few_points;

using Values = ParameterValues;
using Flank = std::vector<Vec2>;

Error refuse(const std::string& what) { return {ErrorCode::invalid_argument, "profile " + what}; }

// Part of a circle that begins level and bends up by `degrees`, stretched over the unit square.
Curve cove_curve(double degrees) {
    const double turns = degrees / 360.0;
    const Vec2 end = steady::direction(turns);
    return [=](double t) {
        const Vec2 at = steady::direction(t * turns);
        return t < 1.0 ? Vec2{at.y / end.y, (1.0 - at.x) / (1.0 - end.x)} : Vec2{1.0, 1.0};
    };
}

Curve bead_curve(double degrees) {
    return [cove = cove_curve(degrees)](double t) { return Vec2{1.0, 1.0} - cove(1.0 - t); };
}

// A cove over the first `middle` of width and height, then a bead.
Curve ogee_curve(double degrees, double middle) {
    return [cove = cove_curve(degrees), bead = bead_curve(degrees), middle](double t) {
        return t < middle ? cove(t / middle) * middle : Vec2{middle, middle} + bead((t - middle) / (1.0 - middle)) * (1.0 - middle);
    };
}

int count_of(const Values& values, const char* name) { return static_cast<int>(values.at(name)); }

Flank straight(const Values&) { return {{0, 0}, {1, 1}}; }
Flank bead(const Values& v) { return few_points(bead_curve(v.at("arc")), count_of(v, "points")); }
Flank cove(const Values& v) { return few_points(cove_curve(v.at("arc")), count_of(v, "points")); }
Flank ogee(const Values& v) { return few_points(ogee_curve(v.at("arc"), v.at("middle")), count_of(v, "points")); }

Flank u(const Values& v) {
    const double wall = v.at("wall");
    Flank flank = few_points(bead_curve(90.0), count_of(v, "points"));
    for (Vec2& p : flank) p.y = wall + (1.0 - wall) * p.y;
    if (wall > 0.0) flank.insert(flank.begin(), Vec2{0, 0});
    return flank;
}

Flank stair(const Values& v) {
    const int steps = count_of(v, "steps");
    const double riser = v.at("lean") / steps, tread = (1.0 - v.at("lean")) / (steps - 1);
    Flank flank;
    for (int i = 0; i < steps; ++i) {
        flank.push_back({i * (riser + tread), double(i) / steps});
        flank.push_back({i * (riser + tread) + riser, double(i + 1) / steps});
    }
    flank.back() = {1, 1};
    return flank;
}

Flank overhang(const Values& v) {
    const double foot = v.at("foot"), reach = v.at("reach");
    if (foot == 0.0) return {{0, 0}, {-reach, 1}, {1, 1}};
    return {{0, 0}, {0, foot}, {-reach, foot}, {-reach, 1}, {1, 1}};
}

Flank burr(const Values& v) {
    return {{0, 0}, {v.at("peak"), -v.at("lip")}, {1, 1}};
}

struct Entry : ProfileEntry {
    Flank (*flank)(const Values&);
};

constexpr const char* kFloorHelp = "width of the floor or top, as a share of the whole";
constexpr const char* kPointsHelp = "points of the curve, both ends included; more are rounder and slower to draw";
constexpr const char* kArcHelp = "how far each round part bends";

const std::vector<Entry>& entries() {
    static const std::vector<Entry> table = {
        {{"vee", "straight flanks that meet", {}}, straight},
        {{"u", "upright walls that round into the floor",
          {{"wall", 0.4, 0.0, 0.9, "height of the upright wall, as a share of the whole"},
           {"floor", 0.0, 0.0, 0.9, kFloorHelp},
           {"points", 3, 2, 8, kPointsHelp, "", true}}}, u},
        {{"flat", "straight flanks with a floor between them",
          {{"floor", 0.5, 0.0, 1.0, kFloorHelp},
           {"slope", 0.0, 0.0, 90.0, "of the flanks, 90 upright; it decides the floor, or 0 leaves that to floor", "deg"}}}, straight},
        {{"bead", "a flank that bulges: half round as a ridge",
          {{"arc", 90.0, 10.0, 90.0, kArcHelp, "deg"}, {"floor", 0.0, 0.0, 0.9, kFloorHelp}, {"points", 4, 2, 8, kPointsHelp, "", true}}}, bead},
        {{"cove", "a hollow flank: it leaves the ground level and ends steep",
          {{"arc", 90.0, 10.0, 90.0, kArcHelp, "deg"}, {"floor", 0.2, 0.0, 0.9, kFloorHelp}, {"points", 4, 2, 8, kPointsHelp, "", true}}}, cove},
        {{"ogee", "a flank like an S: a hollow, then a bulge",
          {{"arc", 60.0, 10.0, 90.0, kArcHelp, "deg"},
           {"middle", 0.5, 0.2, 0.8, "where hollow and bulge meet, as a share of the flank"},
           {"floor", 0.2, 0.0, 0.9, kFloorHelp},
           {"points", 5, 3, 12, kPointsHelp, "", true}}}, ogee},
        {{"stair", "a stair",
          {{"steps", 3, 2, 7, "how many", "", true},
           {"lean", 0.0, 0.0, 0.9, "share of the flank's width that its risers take; 0 upright"},
           {"floor", 0.3, 0.05, 0.9, kFloorHelp}}}, stair},
        {{"overhang", "wider at the bottom or top than at the ground, so that it undercuts",
          {{"reach", 0.4, 0.05, 1.0, "how far it overhangs, as a share of the flank"},
           {"foot", 0.0, 0.0, 0.9, "height of an upright neck below a flat overhang, as a share of the whole; 0 overhangs in a slope"}}},
         overhang},
        {{"burr", "straight flanks with material thrown up beside them, as a scratch has it",
          {{"lip", 0.2, 0.02, 0.9, "how far that rises to the other side of the ground, as a share of the height"},
           {"peak", 0.35, 0.05, 0.9, "where it is highest, as a share of the flank"}}}, burr},
    };
    return table;
}

Result<const Entry*> find_entry(const std::string& name) {
    std::string names;
    for (const Entry& entry : entries()) {
        if (name == entry.name) return &entry;
        names.append(names.empty() ? "" : ", ").append(entry.name);
    }
    return refuse(std::string("'").append(name).append("' is not known; one of ").append(names).append(" works"));
}

Result<Values> values_of(const Entry& entry, const ProfileSpec& spec) {
    return complete_parameters("profile " + spec.name, entry.parameters, spec.parameters);
}

struct Shape {
    Flank flank;
    double floor = 0.0;  // share of the width
    double slope = 0.0;  // degrees; 0: by the floor
    bool overhangs = false;
};

Result<Shape> shape_of(const ProfileSpec& spec, double width, double height) {
    const auto entry = find_entry(spec.name);
    if (!entry) return entry.error();
    const auto values = values_of(**entry, spec);
    if (!values) return values.error();
    if (!std::isfinite(width) || width < 0.0) return refuse(spec.name + ": width " + parameter_text(width) + " is not 0 or above");
    if (!std::isfinite(height) || height == 0.0) return refuse(spec.name + ": height " + parameter_text(height) + " is not a height");
    const auto value = [&](const char* name) { return values->count(name) ? values->at(name) : 0.0; };
    Shape shape{(*entry)->flank(*values), value("floor"), value("slope"), false};
    for (const Vec2 p : shape.flank) shape.overhangs = shape.overhangs || p.x < 0.0;
    return shape;
}

// Width that a flank of this slope and height takes.
double width_at_slope(double slope, double height) {
    const Vec2 d = steady::direction(slope / 360.0);
    return slope == 90.0 ? 0.0 : std::abs(height) * d.x / d.y;
}

// Leaves out the middle one of three points at one height: a floor is one facet.
void append(Profile& profile, ProfilePoint p) {
    std::vector<ProfilePoint>& points = profile.points;
    const std::size_t n = points.size();
    if (n > 0 && points[n - 1].b == p.b && points[n - 1].h == p.h) return;
    if (n > 1 && points[n - 1].h == p.h && points[n - 2].h == p.h) points.pop_back();
    points.push_back(p);
}

// What undercuts the ground cuts with every facet; which ones do cannot be told from the outline.
void flag_undercut(Profile& profile, const Shape& shape, double height) {
    if (shape.overhangs && height < 0.0) profile.facets.assign(profile.points.size() - 1, FacetClass::internal);
}

}  // namespace

const std::vector<ProfileEntry>& profile_table() {
    static const std::vector<ProfileEntry> table(entries().begin(), entries().end());
    return table;
}

Result<ProfileSpec> parse_profile(std::string_view text) {
    text = trimmed(text);
    const std::size_t open = text.find('(');
    ProfileSpec spec{std::string(trimmed(text.substr(0, open))), {}};
    const auto entry = find_entry(spec.name);
    if (!entry) return entry.error();
    if (open != std::string_view::npos) {
        if (text.back() != ')')
            return refuse(spec.name + ": '" + std::string(text).append("' does not end in ')'; NAME(parameter=number, ...) works"));
        auto parameters = parse_parameters("profile " + spec.name, text.substr(open + 1, text.size() - open - 2));
        if (!parameters) return parameters.error();
        spec.parameters = std::move(*parameters);
    }
    const auto values = values_of(**entry, spec);
    return values ? Result<ProfileSpec>(std::move(spec)) : values.error();
}

Result<Profile> make_profile(const ProfileSpec& spec, double width, double height) {
    const auto shape = shape_of(spec, width, height);
    if (!shape) return shape.error();
    if (width == 0.0) return refuse(spec.name + ": width 0 is no width for a groove or ridge");
    double flank = 0.5 * width * (1.0 - shape->floor);
    if (shape->slope > 0.0) flank = width_at_slope(shape->slope, height);
    if (flank > 0.5 * width)
        return refuse(spec.name + ": a slope of " + parameter_text(shape->slope) + " degrees needs a width of " + parameter_text(2.0 * flank) +
                      " or more; " + parameter_text(width) + " is given");
    Profile profile;
    const std::size_t n = shape->flank.size();
    for (std::size_t i = 0; i < 2 * n; ++i) {
        const double side = i < n ? -1.0 : 1.0;
        const Vec2 p = shape->flank[i < n ? i : 2 * n - 1 - i];
        append(profile, {side * (0.5 * width - flank * p.x), height * p.y});
    }
    flag_undercut(profile, *shape, height);
    return profile;
}

Result<Profile> make_step_profile(const ProfileSpec& spec, double width, double height) {
    const auto shape = shape_of(spec, width, height);
    if (!shape) return shape.error();
    Profile profile;
    if (width == 0.0) return Profile{{{0.0, 0.0}, {0.0, height}}, {}};
    const double flank = shape->slope > 0.0 ? std::min(width, width_at_slope(shape->slope, height)) : width;
    for (const Vec2 p : shape->flank) append(profile, {flank * (p.x - 0.5), height * p.y});
    flag_undercut(profile, *shape, height);
    return profile;
}

}  // namespace burin
