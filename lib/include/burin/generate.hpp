// Patterns that nobody draws: scratches, cracks, hatching, tiles, rings, by a kind, numbers and a seed.
//
//     GenerateSpec --[generate_pattern]--> Pattern --[author_asset, write_svg]--> file
//
// `generator_table()` is the one list of kinds and their parameters: messages, `burin generate --help` and docs/generators.md are made
// of it. Lengths are metres, angles degrees, densities per square centimetre.
// Chance is the library's own (lib/src/chance.hpp) and so are sine and exponential, so that equal specs give equal bytes on every
// machine and with any number of threads.
// Random scratches are what [var] 6.2 left open: how many, how long, in which directions, how bent, how wide and deep, in clusters or
// alone, and where a mask says that the surface is worn.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <burin/image.hpp>
#include <burin/parameter.hpp>
#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin {

struct GeneratorEntry {
    const char* name;
    const char* help;     // one line, no full stop
    const char* profile;  // the usual cross-section, as parse_profile reads it
    bool masked;          // a mask says where
    std::vector<Parameter> parameters;
};

// Every kind, in the order of the documentation.
const std::vector<GeneratorEntry>& generator_table();

struct GenerateSpec {
    std::string kind;            // a name of generator_table
    ParameterValues parameters;  // those that differ from the usual ones
    Vec2 size{0.2, 0.2};         // metres, each in [1e-6, 1e6]; lengths among the parameters do not follow it
    Wrap wrap = Wrap::repeat;
    std::uint64_t seed = 1;
    std::string profile;         // as parse_profile reads it; empty: the usual one of the kind
    const Image* mask = nullptr; // over the whole tile: 1 is worn as the density says, 0 untouched; none: 1 everywhere
    int threads = 0;             // 0: all cores; the result does not depend on it
};

// Ensures: depth and base_offset as the relief needs them; a pattern that resolve_pattern takes. With Wrap::repeat it tiles: directions
// and numbers of lines that would not are moved to the nearest that do.
// Fails with invalid_argument: an unknown kind, parameter or profile, a value out of its range, parts that leave no room for each other,
// a mask for a kind that takes none, more than 4,000,000 paths. Cost: linear in paths; 10^6 scratches take about a second.
Result<Pattern> generate_pattern(const GenerateSpec& spec);

}  // namespace burin
