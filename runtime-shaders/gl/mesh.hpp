// Triangles in a context.
#pragma once

#include <vector>

#include <burin/model.hpp>

#include "gl/functions.hpp"

namespace burin::gl {

// One primitive as vertex arrays of its own, with the attributes of gl/surface.vert.
class Mesh {
  public:
    Mesh(const Functions& gl, const Primitive& primitive);
    Mesh(const Mesh&) = delete;
    Mesh& operator=(const Mesh&) = delete;
    ~Mesh();
    void draw() const;

  private:
    // `count` vectors of three per vertex, in attributes from `place` on.
    void attributes(GLuint place, int count, const std::vector<float>& values);
    // `stride` floats from one vertex to the next; 0: packed.
    void attribute(GLuint place, GLint components, const std::vector<float>& values, int stride, std::size_t buffer);

    static constexpr int kBuffers = 7;
    const Functions& gl_;
    GLsizei count_;
    GLuint array_ = 0;
    GLuint buffers_[kBuffers] = {};  // attributes up to the derivatives, indices, other uvs, charts
};

}  // namespace burin::gl
