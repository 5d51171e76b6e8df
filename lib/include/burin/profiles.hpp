// Profiles by name: a small library of cross-sections for patterns that are drawn by hand or generated.
//
//     "flat(floor=0.4)" --[parse_profile]--> ProfileSpec --[make_profile]--> Profile of a groove or ridge
//                                                        --[make_step_profile]--> Profile of a step
//
// Every name is one curve, the flank: from (0, 0), the ground at the side, to (1, 1), the bottom of a groove, top of a ridge or far
// level of a step. A groove or ridge has it on both sides, mirrored, with a floor between them; a step has it once. `docs/profiles.md`
// shows all of them, and `profile_table()` is the one list of names and parameters.
// Round flanks are the best polylines of a few points (each point makes drawing slower), built without functions whose last digits
// depend on the machine: equal specs give equal bytes everywhere. `overhang` is wider than `width` away from the ground and flags
// its facets where it undercuts; `burr` rises to both sides of the ground; all others are height fields between 0 and `height`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <burin/parameter.hpp>
#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin {

struct ProfileSpec {
    std::string name = "vee";
    ParameterValues parameters;  // those that differ from the usual ones
};

struct ProfileEntry {
    const char* name;
    const char* help;  // one line, no full stop
    std::vector<Parameter> parameters;
};

// Every profile that has a name, in the order of the documentation.
const std::vector<ProfileEntry>& profile_table();

// "NAME" or "NAME(parameter=number, ...)". Fails with invalid_argument: unknown name or parameter (the message lists those there
// are), no number, a number out of its range.
Result<ProfileSpec> parse_profile(std::string_view text);

// Section of a groove (height < 0) or ridge (height > 0), centred on b = 0. width: between the ends on the ground, metres, > 0.
// height: of its bottom or top above the ground, metres, not 0. Fails as parse_profile does, and with invalid_argument for a
// width or height that is not finite, or 0; or flanks of a slope that the width has no room for. At most 31 points.
// Cost: up to a millisecond for a curve; make a profile once for all paths that carry it.
Result<Profile> make_profile(const ProfileSpec& spec, double width, double height);

// Section of a step, from the ground on the left to `height` above it on the right, `width` metres wide and centred on b = 0.
// Width 0 is an upright wall, whatever the name; a floor means nothing here. Fails as make_profile does.
Result<Profile> make_step_profile(const ProfileSpec& spec, double width, double height);

}  // namespace burin
