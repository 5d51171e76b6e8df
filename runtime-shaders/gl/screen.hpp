// A draw call over the whole target, for programs that end screen.vert.
#pragma once

#include "gl/functions.hpp"

namespace burin::gl {

class Screen {
  public:
    explicit Screen(const Functions& gl) : gl_(gl) { gl_.GenVertexArrays(1, &array_); }
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;
    ~Screen() { gl_.DeleteVertexArrays(1, &array_); }

    // With the program in use.
    void draw() const {
        gl_.BindVertexArray(array_);
        gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    }

  private:
    const Functions& gl_;
    GLuint array_ = 0;
};

}  // namespace burin::gl
