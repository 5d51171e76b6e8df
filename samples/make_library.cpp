// The library of profiles and generators for docs/: assets to draw, and lists made of the tables.
//
//     make_library FOLDER                 writes profiles_NAME.glb for every profile: a groove, a ridge and a step that carry it
//     make_library --list profiles        prints profiles and their parameters as Markdown
//     make_library --list generators      prints generators and their parameters as Markdown
#include <cctype>
#include <cstdio>
#include <string>

#include <burin/author.hpp>
#include <burin/generate.hpp>
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

std::string capital(std::string text) {
    text.front() = static_cast<char>(std::toupper(text.front()));
    return text;
}

void list_parameters(const std::vector<Parameter>& parameters) {
    if (parameters.empty()) return;
    std::printf("| parameter | usual | range | |\n|---|--:|---|---|\n");
    for (const Parameter& p : parameters)
        std::printf("| `%s` | %s | %s | %s |\n", p.name, parameter_text(p.usual).c_str(), range_text(p).c_str(), p.help);
    std::printf("\n");
}

void list_profiles() {
    for (const ProfileEntry& entry : profile_table()) {
        std::printf("## %s\n\n%s.\n\n![%s](../samples/pictures/profiles_%s.png)\n\n", entry.name, capital(entry.help).c_str(), entry.name, entry.name);
        list_parameters(entry.parameters);
    }
}

void list_generators() {
    for (const GeneratorEntry& entry : generator_table()) {
        std::printf("## %s\n\n%s. Profile: `%s`.%s\n\n![%s](../samples/pictures/generate_%s.png)\n\n", entry.name, capital(entry.help).c_str(), entry.profile,
                    entry.masked ? " Takes a mask." : "", entry.name, entry.name);
        list_parameters(entry.parameters);
    }
}

int write_profiles(const std::string& folder) {
    for (const ProfileEntry& entry : profile_table())
        if (const Status written = write_asset(folder, entry); !written) {
            std::fprintf(stderr, "make_library: error: %s: %s\n", entry.name, written.error().message.c_str());
            return 1;
        }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string first = argc > 1 ? argv[1] : "", second = argc > 2 ? argv[2] : "";
    if (argc == 2 && first != "--list") return write_profiles(first);
    if (first == "--list" && second == "profiles") return list_profiles(), 0;
    if (first == "--list" && second == "generators") return list_generators(), 0;
    std::fprintf(stderr, "make_library: error: usage: make_library FOLDER, or make_library --list profiles|generators\n");
    return 2;
}
