// Every profile that has a name, as an asset to draw and as text for docs/profiles.md.
//
//     make_profiles FOLDER      writes profiles_NAME.glb for each: a groove, a ridge and a step that carry it
//     make_profiles --list      prints the list of profiles and parameters as Markdown
#include <cctype>
#include <cstdio>
#include <string>

#include <burin/author.hpp>
#include <burin/image_io.hpp>
#include <burin/profiles.hpp>

#include "scenes/build.hpp"

namespace {

using namespace burin;
using namespace burin::scenes;

constexpr double kWidth = 0.024, kHeight = 0.010;

// From the front to the back of the tile, swinging once so that both flanks show.
Path swinging(double x, std::uint32_t profile) {
    const auto at = [x](double s) { return Vec2{x + 0.010 * std::sin(2.0 * kPi * s), 0.1 * (1.0 - s)}; };
    return smooth(at, 12).path(profile);
}

Result<Pattern> pattern_of(const ProfileSpec& spec) {
    Pattern p = sheet({0.2, 0.1}, kHeight, kHeight, Wrap::clamp);
    for (const auto& profile : {make_profile(spec, kWidth, -kHeight), make_profile(spec, kWidth, kHeight), make_step_profile(spec, 0.5 * kWidth, kHeight)}) {
        if (!profile) return profile.error();
        p.profiles.push_back(*profile);
    }
    p.paths.push_back(swinging(0.036, 0));
    p.paths.push_back(swinging(0.092, 1));
    p.paths.push_back(swinging(0.155, 2));
    return p;
}

Status write_asset(const std::string& folder, const ProfileEntry& entry) {
    const auto pattern = pattern_of({entry.name, {}});
    if (!pattern) return pattern.error();
    const auto authored = author_asset(*pattern, make_plane(pattern->size));
    if (!authored) return authored.error();
    return write_file(folder + "/profiles_" + entry.name + ".glb", authored->glb);
}

void list_entry(const ProfileEntry& entry) {
    std::printf("## %s\n\n%c%s.\n\n![%s](../samples/pictures/profiles_%s.png)\n\n", entry.name, std::toupper(entry.help[0]), entry.help + 1,
                entry.name, entry.name);
    if (entry.parameters.empty()) return;
    std::printf("| parameter | usual | range | |\n|---|--:|---|---|\n");
    for (const Parameter& p : entry.parameters)
        std::printf("| `%s` | %s | %s | %s |\n", p.name, parameter_text(p.usual).c_str(), range_text(p).c_str(), p.help);
    std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "make_profiles: error: usage: make_profiles FOLDER, or make_profiles --list\n");
        return 2;
    }
    for (const ProfileEntry& entry : profile_table()) {
        if (std::string(argv[1]) == "--list") {
            list_entry(entry);
        } else if (const Status written = write_asset(argv[1], entry); !written) {
            std::fprintf(stderr, "make_profiles: error: %s: %s\n", entry.name, written.error().message.c_str());
            return 1;
        }
    }
    return 0;
}
