#include <burin/profiles.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace burin {
namespace {

Error refuse(const std::string& what) { return {ErrorCode::invalid_argument, "profile: " + what}; }

const ProfileEntry* find_entry(const std::string& name) {
    for (const ProfileEntry& entry : profile_table())
        if (name == entry.name) return &entry;
    return nullptr;
}

}  // namespace

const std::vector<ProfileEntry>& profile_table() {
    static const std::vector<ProfileEntry> table = {
        {"vee", "two straight flanks that meet", {}},
        {"flat", "a floor between two straight flanks", {{"floor", 0.5, 0.0, 1.0, "width of the floor, as a share of the whole"}}},
    };
    return table;
}

Result<ProfileSpec> parse_profile(std::string_view text) {
    ProfileSpec spec{std::string(text), {}};
    if (!find_entry(spec.name)) return refuse("'" + spec.name + "' is no name");
    return spec;
}

Result<Profile> make_profile(const ProfileSpec& spec, double width, double height) {
    const double floor = spec.name == "flat" ? 0.25 * width : 0.0;
    Profile profile;
    profile.points = {{-0.5 * width, 0.0}, {-floor, height}, {floor, height}, {0.5 * width, 0.0}};
    if (floor == 0.0) profile.points.erase(profile.points.begin() + 2);
    return profile;
}

Result<Profile> make_step_profile(const ProfileSpec&, double width, double height) {
    return Profile{{{-0.5 * width, 0.0}, {0.5 * width, height}}, {}};
}

}  // namespace burin
