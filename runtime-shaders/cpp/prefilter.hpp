// The pattern from far away, where a pixel spans many cells: how much of each kind of stripe there is around a place.
// Made when a pattern is loaded; nothing of it is stored in the file.
//
//     PackedTextures + PathDetail --[prefilter_pattern]--> Prefilter --> texture array + classes of the shader
//
// A class is a style that runs in one direction. The weight of a class at a place is the length of its paths per area
// there, times its reach: a number without unit, about half the share of the plane that its stripes cover. Weights are
// averages, so that they may be filtered as any texture; what a stripe looks like under a view and a light follows from
// its profile, as in near views, and so the mean colour does not change where the one takes over from the other.
// What is left out: features over each other, and the direction of bends within 360 / kDirections degrees.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/format/extension.hpp>
#include <burin/format/texels.hpp>
#include <burin/geometry.hpp>

namespace burin {

struct PrefilterClass {
    std::uint32_t style = 0;
    Vec2 tangent{1.0, 0.0};
    double height = 1.0;  // mean height scale
};

struct Prefilter {
    static constexpr int kDirections = 24;
    static constexpr int kMostClasses = 32;  // rare ones are counted as the kept class most like them
    static constexpr int kCellsPerBlock = 2;  // at least, along each side

    int columns = 0, rows = 0;  // blocks, powers of two up to 256
    std::vector<PrefilterClass> classes;
    std::vector<float> weights;  // by class, then row, then column
    float weight(std::size_t which, int column, int row) const {
        return weights[(which * std::size_t(rows) + std::size_t(row)) * std::size_t(columns) + std::size_t(column)];
    }
};

// Requires: textures that passed validate_textures. Cost: linear in the elements' length, counted in blocks.
Prefilter prefilter_pattern(const PackedTextures& textures, const PathDetail& detail);

}  // namespace burin
