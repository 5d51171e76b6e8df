// Accessors as numbers and meshes as triangles, for the sources of this library only.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gltf_document.hpp"

namespace burin {

// Sizes of an accessor's elements.
struct AccessorKind {
    int component_bytes = 0;          // 0: unknown component type
    int components = 0;               // 0: unknown type
    std::uint64_t element_bytes = 0;  // with the padding of matrix columns
};
AccessorKind accessor_kind(const Json& accessor);

// Values of an accessor, `components` each, sparse ones put in place, normalized integers as glTF decodes
// them. Requires: check of the accessor passed.
std::vector<float> read_numbers(const ModelData& model, std::size_t accessor);
std::vector<std::uint32_t> read_indices(const ModelData& model, std::size_t accessor);

using Matrix = std::array<double, 16>;  // column-major, as in glTF

// Of the upper 3 x 3 part: by how much volumes grow, < 0 where it mirrors; and the mean of what lengths grow by.
double determinant(const Matrix& m);
double mean_scale(const Matrix& m);

// A mesh at a node of the scene that is shown.
struct PlacedMesh {
    std::size_t mesh = 0;
    Matrix transform{};
};

// The default scene's meshes (all root nodes when there is no scene; all meshes when there is no node), in
// the order of a walk from the roots. Requires: check_document passed.
std::vector<PlacedMesh> placed_meshes(const ModelData& model);

// Indices of a primitive's triangles; empty for points and lines. Strips and fans are unrolled.
std::vector<std::uint32_t> triangle_indices(const ModelData& model, const Json& primitive);

std::optional<std::size_t> attribute_of(const Json& primitive, const std::string& name);
std::uint64_t vertex_count(const ModelData& model, const Json& primitive);
bool is_triangles(const Json& primitive);

// Writes n as a unit vector to `out`, (0, 1, 0) where it has no direction.
void set_unit(std::array<double, 3> n, float* out);

// Normals of vertices from the faces around them, by area.
std::vector<float> normals_of_faces(const std::vector<float>& positions, const std::vector<std::uint32_t>& indices);

}  // namespace burin
