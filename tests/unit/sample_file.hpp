// A small valid file for tests of the format: one of everything, written texel by texel, without the stage
// pack.
//
// 8 x 8 cells, repeating, 1 m by 1 m. Elements by their texel:
//   0, 1, 2, 3+4+5  a sunken square of four step lines with mitred corners (the last one carries texels B and C)
//   6, 7+8          a line that goes over into a quadratic, one groove
//   9+10            a line with width scale, of material 1
//   11+12           a line with noise
// Functions by their texel: 0 noise, 1 sine of widths alone, 2 to 4 a polynomial, 5 sine; nobody refers to the last two.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <burin/format/extension.hpp>
#include <burin/format/texels.hpp>

namespace burin::test {

struct SampleFile {
    PackedTextures textures;
    PathDetail detail;
};

SampleFile make_sample_file();

// Replace one texel.
void set_cell(PackedTextures& textures, int i, int j, const CellCode& cell);
CellCode get_cell(const PackedTextures& textures, int i, int j);
void set_data(PackedTextures& textures, std::uint32_t index, const Texel& texel);
// Element at `texel` (with its texels B and C).
ElementCode get_element(const PackedTextures& textures, std::uint32_t texel);
void set_element(PackedTextures& textures, std::uint32_t texel, const ElementCode& element);
StyleCode get_style(const PackedTextures& textures, std::uint32_t index);
void set_style(PackedTextures& textures, std::uint32_t index, const StyleCode& style);
// Word `word` of the profile section, the list section's references.
void set_profile_word(PackedTextures& textures, std::uint32_t word, std::uint32_t value);
void set_reference(PackedTextures& textures, std::uint32_t index, std::uint32_t value);

// glTF document of one triangle whose material holds the file; the textures lie in the BIN chunk from byte
// `lead` on.
nlohmann::json make_document(const SampleFile& file, std::uint32_t lead = 0);
// Both textures' bytes behind `lead` zero bytes.
std::vector<std::uint8_t> make_bin(const SampleFile& file, std::uint32_t lead = 0);
std::vector<std::uint8_t> make_glb(const nlohmann::json& document, const std::vector<std::uint8_t>& bin);

}  // namespace burin::test
