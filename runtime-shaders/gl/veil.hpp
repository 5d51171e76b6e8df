// Hides what a picture wants no further sample of. Depths are tested before a pixel is shaded, while drivers that work on blocks of pixels
// let a shader that discards run to its end: a twentieth of the pixels took half of the time of all.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "gl/pixel_window.hpp"
#include "gl/program.hpp"
#include "gl/screen.hpp"
#include "gl/shader_text.hpp"

namespace burin::gl {

class Veil {
  public:
    static Result<std::unique_ptr<Veil>> create(const Functions& gl) {
        const std::string version = "#version 330 core\n";
        auto program = Program::build(gl, version + shader_text::screen_vert, version + shader_text::veil_frag);
        if (!program) return program.error();
        return std::unique_ptr<Veil>(new Veil(gl, std::move(*program)));
    }
    Veil(const Veil&) = delete;
    Veil& operator=(const Veil&) = delete;
    ~Veil() { gl_.DeleteTextures(1, &name_); }

    // `wanted`: one byte per pixel of a picture so large, 0 for those that are hidden.
    void set(const std::vector<std::uint8_t>& wanted, int width, int height) const {
        gl_.ActiveTexture(GL_TEXTURE0 + kUnit);
        gl_.BindTexture(GL_TEXTURE_2D, name_);
        gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, wanted.data());
        gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }

    // Over the cleared target at hand, which shows `window`; depths must be tested. Leaves its own program in use.
    void draw(const PixelWindow& window) const {
        program_.use();
        program_.set("wanted", kUnit);
        program_.set("across", window.across);
        program_.set("first_pixel", float(window.left), float(window.low));
        screen_.draw();
    }

  private:
    static constexpr int kUnit = 2;
    Veil(const Functions& gl, Program program) : gl_(gl), program_(std::move(program)), screen_(gl) { gl_.GenTextures(1, &name_); }
    const Functions& gl_;
    Program program_;
    Screen screen_;
    GLuint name_ = 0;
};

}  // namespace burin::gl
