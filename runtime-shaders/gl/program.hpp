// Programs of the renderer, their uniforms, textures and float targets.
#pragma once

#include <string>
#include <vector>

#include <burin/format/extension.hpp>
#include <burin/format/texels.hpp>
#include <burin/image_io.hpp>
#include <burin/result.hpp>

#include "cpp/prefilter.hpp"
#include "gl/context.hpp"
#include "gl/pattern_kinds.hpp"

namespace burin::gl {

// Which fragment shader of this folder a program ends in.
enum class Stage { rays, top, surface, surface_with_depth };  // the last writes the depth of what is met

// What a program is made for.
struct ProgramKind {
    Stage stage = Stage::surface;
    PatternKinds pattern;      // of the textures that it will draw
    int pixel_filter = 0;      // surfaces only: FILTER_* of gl/pixel_filter.h
    bool environment = false;  // surfaces only: lit by one, instead of a soft surround
    int textures = 0;          // surfaces only: which ones materials have, for BURIN_TEXTURES of gl/material.glsl
    bool round = false;        // surfaces only: some mesh bends
    bool charts = false;       // surfaces only: texture coordinates are cut
    bool counted = false;      // surfaces only: instead of its colour a pixel says what it fetched
};

// Text of a fragment shader as the driver gets it: version, macros, layout.h, core, bindings, main.
std::string fragment_text(const ProgramKind& kind);

class Program {
  public:
    // Fails with unavailable, carrying the driver's log.
    static Result<Program> build(const Functions& gl, const ProgramKind& kind);
    // The same of whole texts, version line included.
    static Result<Program> build(const Functions& gl, const std::string& vertex_text, const std::string& fragment_text);
    Program(Program&& other) noexcept;
    Program& operator=(Program&&) = delete;
    ~Program();

    void use() const { gl_->UseProgram(id_); }
    GLint at(const char* name) const { return gl_->GetUniformLocation(id_, name); }
    void set(const char* name, int v) const { gl_->Uniform1i(at(name), v); }
    void set(const char* name, float v) const { gl_->Uniform1f(at(name), v); }
    void set(const char* name, float x, float y) const { gl_->Uniform2f(at(name), x, y); }
    void set(const char* name, float x, float y, float z) const { gl_->Uniform3f(at(name), x, y, z); }

  private:
    Program(const Functions& gl, GLuint id) : gl_(&gl), id_(id) {}
    const Functions* gl_;
    GLuint id_;
};

// The two textures of a pattern on texture units 0 and 1, its residual, if it has one, on unit 3, and the table of its charts on 5.
class DetailTextures {
  public:
    DetailTextures(const Functions& gl, const PackedTextures& textures, const PathDetail& detail,
                   const RgbaImage& residual = {}, const std::vector<std::uint32_t>& charts = {});
    DetailTextures(const DetailTextures&) = delete;
    DetailTextures& operator=(const DetailTextures&) = delete;
    ~DetailTextures();

    // Requires: `program` is in use. Sets the textures and burin_map.
    void bind(const Program& program) const;

  private:
    const Functions& gl_;
    PathDetail detail_;
    Sections sections_;
    int data_width_;
    int grid_width_, grid_height_;
    std::array<float, 2> drop_range_;
    bool has_residual_;
    std::vector<PrefilterClass> classes_;
    GLuint names_[5] = {0, 0, 0, 0, 0};
};

// A framebuffer of RGBA float colours, with depth if asked.
class FloatTarget {
  public:
    static Result<std::unique_ptr<FloatTarget>> create(const Functions& gl, int width, int height, int colors,
                                                       bool depth);
    FloatTarget(const FloatTarget&) = delete;
    FloatTarget& operator=(const FloatTarget&) = delete;
    ~FloatTarget();

    void bind() const;
    // Four floats per pixel, lower row first.
    std::vector<float> read(int color) const;
    // One depth per pixel, [0, 1]. Requires: it has depth.
    std::vector<float> read_depths() const;

  private:
    FloatTarget(const Functions& gl, int width, int height) : gl_(gl), width_(width), height_(height) {}
    const Functions& gl_;
    int width_, height_;
    GLuint framebuffer_ = 0;
    std::vector<GLuint> buffers_;
};

}  // namespace burin::gl
