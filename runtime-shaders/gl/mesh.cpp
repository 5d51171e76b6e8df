#include "gl/mesh.hpp"

#include <cmath>

#include <glm/geometric.hpp>

#include "gl/camera.hpp"

namespace burin::gl {
namespace {

// World directions of one unit of u and one of v at every vertex, the mean over its triangles by their area
// in uv; six numbers per vertex. On a round surface they turn smoothly where those of the triangles jump.
std::vector<float> directions_of(const Primitive& primitive) {
    const std::size_t vertices = primitive.positions.size() / 3;
    std::vector<float> sums(vertices * 6, 0.0f), weights(vertices, 0.0f);
    for (std::size_t first = 0; first + 2 < primitive.indices.size(); first += 3) {
        const std::uint32_t* corner = &primitive.indices[first];
        const glm::dvec3 p = vertex(primitive.positions, corner[0]);
        const glm::dvec3 p1 = vertex(primitive.positions, corner[1]) - p,
                         p2 = vertex(primitive.positions, corner[2]) - p;
        const auto uv = [&](int k) {
            return Vec2{double(primitive.uvs[2 * corner[k]]), double(primitive.uvs[2 * corner[k] + 1])};
        };
        const Vec2 a = uv(1) - uv(0), b = uv(2) - uv(0);
        const double area = cross(a, b);
        const double sign = area < 0.0 ? -1.0 : 1.0;
        const glm::dvec3 u = (p1 * b.y - p2 * a.y) * sign, v = (p2 * a.x - p1 * b.x) * sign;
        for (std::size_t k = 0; k < 3; ++k) {
            weights[corner[k]] += float(std::abs(area));
            for (int axis = 0; axis < 3; ++axis) {
                sums[6 * corner[k] + std::size_t(axis)] += float(u[axis]);
                sums[6 * corner[k] + 3 + std::size_t(axis)] += float(v[axis]);
            }
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        sums[i] = weights[i / 6] > 0.0f ? sums[i] / weights[i / 6] : 0.0f;
    return sums;
}

// First and second derivatives of the position, fifteen numbers per vertex.
std::vector<float> frames_of(const Primitive& primitive) {
    std::vector<float> values;
    values.reserve(primitive.frames.size() * 15);
    for (const SurfaceFrame& frame : primitive.frames)
        for (const auto& v : {frame.du, frame.dv, frame.duu, frame.duv, frame.dvv}) values.insert(values.end(), v.begin(), v.end());
    return values;
}

}  // namespace

Mesh::Mesh(const Functions& gl, const Primitive& primitive) : gl_(gl), count_(GLsizei(primitive.indices.size())) {
    gl_.GenVertexArrays(1, &array_);
    gl_.BindVertexArray(array_);
    gl_.GenBuffers(kBuffers, buffers_);
    attribute(0, 3, primitive.positions, 0, 0);
    attribute(1, 3, primitive.normals, 0, 1);
    attribute(2, 2, primitive.uvs, 0, 2);
    // Without frames the second derivatives are those of OpenGL's disabled attributes: zero.
    const bool framed = !primitive.frames.empty();
    attributes(3, framed ? 5 : 2, framed ? frames_of(primitive) : directions_of(primitive));
    if (!primitive.texture_uvs.empty()) attribute(8, 4, primitive.texture_uvs, 0, 5);
    if (!primitive.charts.empty()) attribute(9, 1, primitive.charts, 0, 6);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[4]);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(primitive.indices.size() * 4), primitive.indices.data(), GL_STATIC_DRAW);
}

Mesh::~Mesh() {
    gl_.DeleteBuffers(kBuffers, buffers_);
    gl_.DeleteVertexArrays(1, &array_);
}

void Mesh::draw() const {
    gl_.BindVertexArray(array_);
    gl_.DrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
}

void Mesh::attributes(GLuint place, int count, const std::vector<float>& values) {
    attribute(place, 3, values, 3 * count, place);
    for (int i = 1; i < count; ++i) {
        const auto offset = std::size_t(3 * i) * sizeof(float);
        gl_.VertexAttribPointer(place + GLuint(i), 3, GL_FLOAT, GL_FALSE, GLsizei(3 * count * int(sizeof(float))),
                                reinterpret_cast<void*>(offset));
        gl_.EnableVertexAttribArray(place + GLuint(i));
    }
}

void Mesh::attribute(GLuint place, GLint components, const std::vector<float>& values, int stride, std::size_t buffer) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[buffer]);
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(values.size() * 4), values.data(), GL_STATIC_DRAW);
    gl_.VertexAttribPointer(place, components, GL_FLOAT, GL_FALSE, GLsizei(stride * int(sizeof(float))), nullptr);
    gl_.EnableVertexAttribArray(place);
}

}  // namespace burin::gl
