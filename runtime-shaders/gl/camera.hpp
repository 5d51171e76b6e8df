// Where a picture is seen from, for whatever draws it.
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "gl/render.hpp"

namespace burin {

// Where the camera stands and what it sees.
struct View {
    glm::dvec3 eye, direction, up;
    glm::dmat4 to_view{1.0};
    double half_height = 0.0;  // of the picture at distance 1, or in metres when orthographic
    double near = 0.0, far = 1.0;
};

// Element i of vectors of three.
glm::dvec3 vertex(const std::vector<float>& values, std::uint32_t i);

// Unit length; degrees as in render.hpp.
glm::dvec3 direction_of(double azimuth, double elevation);

// Requires: an asset with a triangle.
View place_camera(const Asset& asset, const RenderOptions& options);

// Matrix of the view, world to clip space, with the picture moved by (x, y) of a pixel.
glm::dmat4 projection(const View& view, const RenderOptions& options, double x, double y);

float to_linear(float srgb);

// What render_asset asks of its options and the asset. Fails with invalid_argument, and invalid_input without a triangle.
Status check_render(const Asset& asset, const RenderOptions& options);

}  // namespace burin
