// Textures of shading: a material's own, and light from all around.
#pragma once

#include <burin/model.hpp>

#include "cpp/environment.hpp"
#include "gl/program.hpp"

namespace burin::gl {

// Which textures materials have, for ProgramKind.
int texture_kinds(const Asset& asset);

// The textures of glTF's own of one material, on units 8 to 11, as their samplers say: sRGB is decoded
// before filtering.
class MaterialTextures {
  public:
    MaterialTextures(const Functions& gl, const MaterialInfo& material);
    MaterialTextures(const MaterialTextures&) = delete;
    MaterialTextures& operator=(const MaterialTextures&) = delete;
    ~MaterialTextures();

    // Requires: `program` is in use and draws surfaces. Sets textures and factors of gl/material.glsl.
    void bind(const Program& program) const;

  private:
    const Functions& gl_;
    const MaterialInfo& material_;
    GLuint names_[4] = {0, 0, 0, 0};
};

// An environment on units 12 and 13.
class EnvironmentTextures {
  public:
    EnvironmentTextures(const Functions& gl, const PreparedEnvironment& environment);
    EnvironmentTextures(const EnvironmentTextures&) = delete;
    EnvironmentTextures& operator=(const EnvironmentTextures&) = delete;
    ~EnvironmentTextures();

    // Requires: `program` is in use and was built with an environment. `rotation` in degrees about y, towards larger azimuths.
    void bind(const Program& program, double rotation, double strength) const;

  private:
    const Functions& gl_;
    std::array<std::array<float, 3>, 9> irradiance_;
    int last_level_;
    GLuint names_[2] = {0, 0};
};

}  // namespace burin::gl
