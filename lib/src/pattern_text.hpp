// A pattern's parts as text in files: names of its enumerations in the order of their values, numbers, curves.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <string>
#include <vector>

#include <burin/pattern.hpp>

namespace burin {

inline constexpr std::array kJoinNames{"mitre", "round", "bevel"};
inline constexpr std::array kCapNames{"hip", "butt", "round", "taper"};
inline constexpr std::array kFacetNames{"automatic", "internal", "external"};
inline constexpr std::array kWrapNames{"repeat", "clamp"};
inline constexpr std::array kPerturbationNames{"sine", "polynomial", "noise"};

template <typename Names, typename Kind>
constexpr const char* name_in(const Names& names, Kind kind) { return names[static_cast<std::size_t>(kind)]; }

// As many digits as tell a double (a float) from all others. Zero has no sign: equal numbers give equal text.
template <typename Number>
std::string exact(Number value) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value + Number(0)).ptr;
    return {text.data(), end};
}

// Path data of one chain: commands M, L and Q, and Z at the end when `closed`, which needs no line where the chain ends at its start.
std::string path_data_of(const std::vector<Element>& elements, bool closed);

}  // namespace burin
