// The accurate renderer on the CPU: [2008] with one sample per pixel, whose areas are exact.
//
//     Asset --[render_reference]--> picture
//
// What it shares with the shader is the meaning of the data and the formula of shading, not the way to the areas: it is what
// pictures of the shader are held against, and what needs neither a GPU nor OpenGL.
#pragma once

#include <functional>

#include <gl/render.hpp>

#include "shade.hpp"

namespace burin::reference {

struct ReferenceOptions {
    // Camera, light, size, background and shadows. Samples, rays and backend say nothing here.
    RenderOptions view;
    double tolerance = 0.004;  // of a footprint's width: how far bent grooves may lie from what stands for them, (0, 0.1]
    int threads = 0;           // 0: as many as the machine has; the picture does not depend on it
    Brdf brdf = metallic_roughness;
    // Light that comes by way of other facets, [2008] 7: after how many of them none is followed. From 1 on the soft surround is seen
    // by the parts of facets that it reaches, instead of falling on all alike, and what the eye sees is not bounded before it is averaged; what a facet
    // sees of others is, by 1.
    int bounces = 0;     // [0, 8]
    int directions = 8;  // for each facet and way to scatter that is no mirror, [1, 1024]
    // Of glass: facets that a beam passes or is mirrored by, one after the other. What comes after them looks straight on into the surround.
    int passes = 12;     // [2, 32]
    Scatter scatter = scatter_metallic_roughness;
    // Radiance of what surrounds the asset, by direction; none: view.environment, or else soft_radiance of the light's ambient strength.
    std::function<glm::dvec3(const glm::dvec3&)> surround;
    // Called with the part that is done, from 0 to 1, by one thread at a time.
    std::function<void(double)> progress = [](double) {};
};

struct ReferenceStats {
    long footprints = 0;        // parts of pixels that show a pattern
    long by_line = 0, by_area = 0;  // of these, or of their parts: by a cross-section, by polygons
    double cut_off = 0.0;       // part of the picture's light that `passes` cut off, the mean over its pixels
    double worst_sum = 0.0, mean_sum = 0.0;  // how far the shares of a pixel's facets were from its own part of the pixel
};

struct ReferencePicture {
    int width = 0, height = 0;
    std::vector<float> linear;  // three per pixel, rows from the top
    ReferenceStats stats;
    RgbaImage image() const;  // sRGB
};

// A view or light lower than 2.9 degrees over the mesh counts as one of 2.9 degrees: farther along the surface nothing is flat. Pattern rays do not bend with a round mesh, nor cross the seams of its uvs, within a pixel's reach ([2008] 9).
// With an environment 0 bounces count as 1. Glass (MaterialInfo::transmission) is always followed; without an environment it shows the background.
// Fails as render_asset does; invalid_input: textures that break a rule of the format. Cost: some 2 us per
// pixel on smooth grooves, 10 to 50 where they meet; with bounces as much for each facet, direction and bounce.
Result<ReferencePicture> render_reference(const Asset& asset, const ReferenceOptions& options = {});

}  // namespace burin::reference
