// Pictures of an asset: every mesh with its material, several passes with shifted pixels, averaged.
#include "gl/render.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "gl/look_textures.hpp"
#include "gl/pixel_filter.h"
#include "gl/program.hpp"

namespace burin {
namespace {

struct Bounds {
    glm::dvec3 low{1e300}, high{-1e300};
    glm::dvec3 middle() const { return (low + high) * 0.5; }
    double radius() const { return glm::length(high - low) * 0.5; }
};

// Where the camera stands and what it sees.
struct View {
    glm::dvec3 eye, direction, up;
    glm::dmat4 to_view{1.0};
    double half_height = 0.0;  // of the picture at distance 1, or in metres when orthographic
    double near = 0.0, far = 1.0;
};

glm::dvec3 vertex(const std::vector<float>& values, std::uint32_t i) {
    return {double(values[3 * i]), double(values[3 * i + 1]), double(values[3 * i + 2])};
}

glm::dvec3 direction_of(double azimuth, double elevation) {
    const double a = glm::radians(azimuth), e = glm::radians(elevation);
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

Bounds bounds_of(const Asset& asset) {
    Bounds box;
    for (const Primitive& primitive : asset.primitives) {
        for (std::uint32_t i : primitive.indices) {
            const glm::dvec3 p = vertex(primitive.positions, i);
            box.low = glm::min(box.low, p);
            box.high = glm::max(box.high, p);
        }
    }
    return box;
}

// World point of a triangle at a point of the uv plane.
std::optional<glm::dvec3> point_at(const Primitive& primitive, std::size_t first, Vec2 uv) {
    glm::dvec3 corner[3];
    Vec2 at[3];
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t i = primitive.indices[first + k];
        corner[k] = vertex(primitive.positions, i);
        at[k] = {double(primitive.uvs[2 * i]), double(primitive.uvs[2 * i + 1])};
    }
    const double area = cross(at[1] - at[0], at[2] - at[0]);
    if (area == 0.0) return std::nullopt;
    const double b = cross(uv - at[0], at[2] - at[0]) / area;
    const double c = cross(at[1] - at[0], uv - at[0]) / area;
    if (b < -1e-9 || c < -1e-9 || b + c > 1.0 + 1e-9) return std::nullopt;
    return corner[0] + b * (corner[1] - corner[0]) + c * (corner[2] - corner[0]);
}

glm::dvec3 target_of(const Asset& asset, const Camera& camera, const Bounds& box) {
    if (camera.target) return {(*camera.target)[0], (*camera.target)[1], (*camera.target)[2]};
    if (camera.center) {
        for (const Primitive& primitive : asset.primitives) {
            if (!asset.materials[std::size_t(primitive.material)].has_detail) continue;
            for (std::size_t first = 0; first + 2 < primitive.indices.size(); first += 3)
                if (auto point = point_at(primitive, first, *camera.center)) return *point;
        }
    }
    return box.middle();
}

// Half the picture's height, at distance 1 from the eye, that shows every vertex.
double half_height_for(const Asset& asset, const View& view, bool orthographic, double aspect) {
    double half = 1e-9;
    for (const Primitive& primitive : asset.primitives) {
        for (std::uint32_t i : primitive.indices) {
            const glm::dvec3 p = view.to_view * glm::dvec4(vertex(primitive.positions, i), 1.0);
            const double distance = orthographic ? 1.0 : std::max(-p.z, 1e-9);
            half = std::max({half, std::abs(p.y) / distance, std::abs(p.x) / (aspect * distance)});
        }
    }
    return half * 1.03;
}

// Distance along the line of sight at which the asset just fits the angle of view.
double distance_for(const Asset& asset, const View& view, glm::dvec3 target, double tangent, double aspect) {
    const glm::dvec3 right = glm::normalize(glm::cross(view.direction, view.up));
    const glm::dvec3 top = glm::cross(right, view.direction);
    double distance = 1e-6;
    for (const Primitive& primitive : asset.primitives) {
        for (std::uint32_t i : primitive.indices) {
            const glm::dvec3 q = vertex(primitive.positions, i) - target;
            const double sideways =
                std::max(std::abs(glm::dot(q, top)), std::abs(glm::dot(q, right)) / aspect);
            distance = std::max(distance, sideways * 1.03 / tangent - glm::dot(q, view.direction));
        }
    }
    return distance;
}

View place_camera(const Asset& asset, const RenderOptions& options) {
    const Camera& camera = options.camera;
    const Bounds box = bounds_of(asset);
    const glm::dvec3 target = target_of(asset, camera, box);
    const double aspect = double(options.width) / options.height;
    const double radius = std::max(box.radius(), 1e-9);
    View view;
    view.direction = -direction_of(camera.azimuth, camera.elevation);
    const double a = glm::radians(camera.azimuth);
    // Straight above, up is away from where the camera would stand in front.
    view.up =
        std::abs(camera.elevation) > 89.9 ? glm::dvec3(-std::sin(a), 0.0, -std::cos(a)) : glm::dvec3(0, 1, 0);
    const double tangent = std::tan(glm::radians(camera.field_of_view) * 0.5);
    view.half_height = tangent;
    if (camera.eye) {
        view.eye = {(*camera.eye)[0], (*camera.eye)[1], (*camera.eye)[2]};
        view.direction = glm::normalize(target - view.eye);
        view.up = std::abs(view.direction.y) > 0.999 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
    } else if (camera.orthographic) {
        view.eye = target - view.direction * (radius * 4.0);
    } else {
        view.eye = target - view.direction * distance_for(asset, view, target, tangent, aspect);
    }
    view.to_view = glm::lookAt(view.eye, view.eye + view.direction, view.up);
    if (camera.orthographic) view.half_height = half_height_for(asset, view, true, aspect);
    if (!camera.eye) view.half_height /= camera.zoom;
    const double depth_middle = glm::dot(box.middle() - view.eye, view.direction);
    view.far = std::max(depth_middle + radius * 1.1, radius * 1e-3);
    view.near = std::max(depth_middle - radius * 1.1, camera.orthographic ? -1e30 : view.far * 1e-4);
    return view;
}

// Matrix of the view with the picture moved by (x, y) of a pixel.
glm::mat4 projection(const View& view, const RenderOptions& options, double x, double y) {
    const double h = view.half_height, w = h * options.width / options.height;
    glm::dmat4 clip;
    if (options.camera.orthographic)
        clip = glm::ortho(-w, w, -h, h, view.near, view.far);
    else
        clip =
            glm::frustum(-w * view.near, w * view.near, -h * view.near, h * view.near, view.near, view.far);
    const glm::dvec3 shift(2.0 * x / options.width, 2.0 * y / options.height, 0.0);
    return glm::mat4(glm::translate(glm::dmat4(1.0), shift) * clip * view.to_view);
}

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

// One primitive as vertex arrays of its own.
class Mesh {
  public:
    Mesh(const gl::Functions& gl, const Primitive& primitive)
        : gl_(gl), count_(GLsizei(primitive.indices.size())) {
        gl_.GenVertexArrays(1, &array_);
        gl_.BindVertexArray(array_);
        gl_.GenBuffers(kBuffers, buffers_);
        attribute(0, 3, primitive.positions);
        attribute(1, 3, primitive.normals);
        attribute(2, 2, primitive.uvs);
        // Without frames the second derivatives are those of OpenGL's disabled attributes: zero.
        const bool framed = !primitive.frames.empty();
        attributes(3, framed ? 5 : 2, framed ? frames_of(primitive) : directions_of(primitive));
        if (!primitive.texture_uvs.empty()) attribute(8, 4, primitive.texture_uvs, 0, 5);
        if (!primitive.charts.empty()) attribute(9, 1, primitive.charts, 0, 6);
        gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[4]);
        gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(primitive.indices.size() * 4),
                       primitive.indices.data(), GL_STATIC_DRAW);
    }
    Mesh(const Mesh&) = delete;
    Mesh& operator=(const Mesh&) = delete;
    ~Mesh() {
        gl_.DeleteBuffers(kBuffers, buffers_);
        gl_.DeleteVertexArrays(1, &array_);
    }
    void draw() const {
        gl_.BindVertexArray(array_);
        gl_.DrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    }

  private:
    // `count` vectors of three per vertex, in attributes from `place` on.
    void attributes(GLuint place, int count, const std::vector<float>& values) {
        attribute(place, 3, values, 3 * count);
        for (int i = 1; i < count; ++i) {
            const auto offset = std::size_t(3 * i) * sizeof(float);
            gl_.VertexAttribPointer(place + GLuint(i), 3, GL_FLOAT, GL_FALSE, GLsizei(3 * count * int(sizeof(float))),
                                    reinterpret_cast<void*>(offset));
            gl_.EnableVertexAttribArray(place + GLuint(i));
        }
    }
    // `stride` floats from one vertex to the next; 0: packed.
    void attribute(GLuint place, GLint components, const std::vector<float>& values, int stride = 0) {
        attribute(place, components, values, stride, place);
    }
    void attribute(GLuint place, GLint components, const std::vector<float>& values, int stride, std::size_t buffer) {
        gl_.BindBuffer(GL_ARRAY_BUFFER, buffers_[buffer]);
        gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(values.size() * 4), values.data(), GL_STATIC_DRAW);
        gl_.VertexAttribPointer(place, components, GL_FLOAT, GL_FALSE, GLsizei(stride * int(sizeof(float))),
                                nullptr);
        gl_.EnableVertexAttribArray(place);
    }

    static constexpr int kBuffers = 7;
    const gl::Functions& gl_;
    GLsizei count_;
    GLuint array_ = 0;
    GLuint buffers_[kBuffers] = {};  // attributes up to the derivatives, indices, other uvs, charts
};

// The asset in the context: meshes, textures and the program.
struct Scene {
    std::vector<std::unique_ptr<Mesh>> meshes;
    std::vector<std::unique_ptr<gl::DetailTextures>> details;  // one per material, null without detail
    std::unique_ptr<gl::DetailTextures> none;                  // stands in where a material has no detail
    std::vector<std::unique_ptr<gl::MaterialTextures>> looks;  // one per material
    std::unique_ptr<gl::EnvironmentTextures> environment;      // null without one
};

Scene load_scene(const gl::Functions& gl, const Asset& asset, const RenderOptions& options) {
    Scene scene;
    for (const Primitive& primitive : asset.primitives)
        scene.meshes.push_back(std::make_unique<Mesh>(gl, primitive));
    for (const MaterialInfo& material : asset.materials)
        scene.details.push_back(
            material.has_detail ? std::make_unique<gl::DetailTextures>(gl, material.textures, material.detail, material.residual, material.charts)
                                : nullptr);
    for (const MaterialInfo& material : asset.materials)
        scene.looks.push_back(std::make_unique<gl::MaterialTextures>(gl, material));
    if (options.environment) {
        const auto& map = options.environment->map;
        scene.environment = std::make_unique<gl::EnvironmentTextures>(gl, prepare_environment(map ? *map : neutral_environment()));
    }
    PackedTextures empty;
    empty.grid_width = empty.grid_height = empty.data_width = empty.data_height = 1;
    empty.grid.assign(2, 0);
    empty.data.assign(4, 0);
    scene.none = std::make_unique<gl::DetailTextures>(gl, empty, PathDetail{});
    return scene;
}

gl::ProgramKind program_for(const Asset& asset, const RenderOptions& options) {
    gl::ProgramKind kind;
    kind.stage = options.correct_depth ? gl::Stage::surface_with_depth : gl::Stage::surface;
    kind.function_kinds = 0;
    kind.environment = options.environment.has_value();
    kind.textures = gl::texture_kinds(asset);
    for (const MaterialInfo& material : asset.materials) {
        if (material.has_detail) kind.function_kinds |= gl::function_kinds(material.textures);
        kind.charts = kind.charts || !material.charts.empty();
    }
    return kind;
}

void set_view(const gl::Program& program, const View& view, const RenderOptions& options) {
    const glm::dvec3 to_light = direction_of(options.light.azimuth, options.light.elevation);
    program.set("eye", float(view.eye.x), float(view.eye.y), float(view.eye.z));
    const glm::dvec3 d = options.camera.orthographic ? view.direction : glm::dvec3(0.0);
    program.set("view", float(d.x), float(d.y), float(d.z));
    program.set("light", float(to_light.x), float(to_light.y), float(to_light.z));
    program.set("light_strength", float(options.light.strength));
    program.set("ambient", float(options.light.ambient));
    program.set("shadows", options.shadows ? 1 : 0);
}

void draw_pass(const gl::Functions& gl, const gl::Program& program, const Asset& asset, const Scene& scene) {
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (std::size_t i = 0; i < asset.primitives.size(); ++i) {
        const std::size_t index = std::size_t(asset.primitives[i].material);
        const MaterialInfo& material = asset.materials[index];
        (material.has_detail ? *scene.details[index] : *scene.none).bind(program);
        program.set("has_detail", material.has_detail ? 1 : 0);
        scene.looks[index]->bind(program);
        program.set("mirrored", asset.primitives[i].mirrored ? 1 : 0);
        program.set("burin_charts.scale", asset.primitives[i].scale);
        // A mesh seen from behind shows nothing unless its material says so.
        if (material.double_sided)
            gl.Disable(GL_CULL_FACE);
        else
            gl.Enable(GL_CULL_FACE);
        scene.meshes[i]->draw();
    }
    gl.Finish();
}

float to_linear(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }

std::uint8_t to_srgb(float linear) {
    const float c = std::clamp(linear, 0.0f, 1.0f);
    const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
    return std::uint8_t(s * 255.0f + 0.5f);
}

// Sums of samples, and what their spread says about where more are needed.
class Accumulator {
  public:
    Accumulator(int width, int height)
        : width_(width),
          height_(height),
          sum_(count() * 4, 0.0f),
          low_(count(), 1e9f),
          high_(count(), -1e9f),
          samples_(count(), 0.0f),
          wanted_(count(), 255) {}

    // Pixels with wanted() == 0 are left alone.
    void add(const std::vector<float>& pixels) {
        for (std::size_t i = 0; i < count(); ++i) {
            if (wanted_[i] == 0) continue;
            for (std::size_t k = 0; k < 4; ++k) sum_[4 * i + k] += pixels[4 * i + k];
            samples_[i] += 1.0f;
            // A gamma of 2 stands in for the eye.
            const float seen = std::sqrt(pixels[4 * i] + 2.0f * pixels[4 * i + 1] + pixels[4 * i + 2]) * 0.5f;
            low_[i] = std::min(low_[i], seen);
            high_[i] = std::max(high_[i], seen);
        }
    }

    // Keeps the pixels whose samples, or whose neighbours' samples, differ by more than half a step of the
    // picture's 8 bits: an edge that no sample of a pixel caught shows in the one beside it.
    void keep_uneven() {
        constexpr float kStep = 1.0f / 255.0f;
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                float low = 1e9f, high = -1e9f;
                for (int dy = std::max(y - 1, 0); dy <= std::min(y + 1, height_ - 1); ++dy)
                    for (int dx = std::max(x - 1, 0); dx <= std::min(x + 1, width_ - 1); ++dx) {
                        low = std::min(low, low_[at(dx, dy)]);
                        high = std::max(high, high_[at(dx, dy)]);
                    }
                wanted_[at(x, y)] = high - low > kStep ? 255 : 0;
            }
    }
    const std::vector<std::uint8_t>& wanted() const { return wanted_; }

    RgbaImage image() const {
        RgbaImage image{width_, height_, std::vector<std::uint8_t>(count() * 4, 255)};
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                // The target's first row is the lowest one.
                const std::size_t from = at(x, height_ - 1 - y);
                for (std::size_t k = 0; k < 3; ++k)
                    image.texels[4 * at(x, y) + k] = to_srgb(sum_[4 * from + k] / samples_[from]);
            }
        return image;
    }

  private:
    std::size_t count() const { return std::size_t(width_) * std::size_t(height_); }
    std::size_t at(int x, int y) const { return std::size_t(y) * std::size_t(width_) + std::size_t(x); }

    int width_, height_;
    std::vector<float> sum_, low_, high_, samples_;
    std::vector<std::uint8_t> wanted_;  // 255 or 0 per pixel, lower row first
};

// Places of the samples within a pixel, -0.5 to 0.5: a grid of side x side, in an order whose first four
// spread.
std::vector<Vec2> sample_places(int side) {
    std::vector<Vec2> places;
    for (int k = 0; k < side * side; ++k)
        places.push_back({(k % side + 0.5) / side - 0.5, (k / side + 0.5) / side - 0.5});
    for (std::size_t i = 0; i < 4 && places.size() > 4; ++i) {
        // Corners of a square turned by about 27 degrees.
        const double turn = 0.4636 + 1.5708 * double(i);
        const Vec2 wish{0.28 * std::cos(turn), 0.28 * std::sin(turn)};
        const auto nearer = [&](Vec2 a, Vec2 b) { return length(a - wish) < length(b - wish); };
        std::iter_swap(places.begin() + std::ptrdiff_t(i),
                       std::min_element(places.begin() + std::ptrdiff_t(i), places.end(), nearer));
    }
    return places;
}

// A texture of one byte per pixel on unit 2, from which the shader reads where to draw.
class WantedTexture {
  public:
    explicit WantedTexture(const gl::Functions& gl) : gl_(gl) { gl_.GenTextures(1, &name_); }
    WantedTexture(const WantedTexture&) = delete;
    WantedTexture& operator=(const WantedTexture&) = delete;
    ~WantedTexture() { gl_.DeleteTextures(1, &name_); }

    void set(const std::vector<std::uint8_t>& wanted, int width, int height) const {
        gl_.ActiveTexture(GL_TEXTURE0 + 2);
        gl_.BindTexture(GL_TEXTURE_2D, name_);
        gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, wanted.data());
        gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }

  private:
    const gl::Functions& gl_;
    GLuint name_ = 0;
};

void set_filter(const gl::Program& program, int filter, int side = 1) {
    program.set("pixel_filter", filter);
    program.set("side", side);
}

// Rays per side of a pixel: an even number, so that they fall into quarters.
int ray_side(const RenderOptions& options) { return 2 * int(std::ceil(std::sqrt(double(options.rays)) / 2.0 - 1e-9)); }

// Adds the rays that `pixels` asks for in its fourth channel.
void add_marked_rays(const gl::Functions& gl, const gl::Program& program, const Asset& asset, const Scene& scene,
                     const gl::FloatTarget& target, const WantedTexture& wanted, const RenderOptions& options,
                     std::vector<float>& pixels) {
    std::vector<std::uint8_t> marks(pixels.size() / 4);
    for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = std::uint8_t(pixels[4 * i + 3]);
    if (std::all_of(marks.begin(), marks.end(), [](std::uint8_t mark) { return mark == 0; })) return;
    wanted.set(marks, options.width, options.height);
    set_filter(program, FILTER_QUARTERS);
    const int side = ray_side(options);
    for (int k = 0; k < side * side; ++k) {
        const double x = (k % side + 0.5) / side - 0.5, y = (k / side + 0.5) / side - 0.5;
        program.set("ray_place", float(x), float(y));
        draw_pass(gl, program, asset, scene);
        const std::vector<float> found = target.read(0);
        const int quarter = (x < 0.0 ? 0 : 1) + (y < 0.0 ? 0 : 2);
        for (std::size_t i = 0; i < marks.size(); ++i)
            if ((marks[i] >> quarter & 1) != 0)
                for (std::size_t c = 0; c < 3; ++c) pixels[4 * i + c] += found[4 * i + c] / float(side * side);
    }
}

// One picture of the whole, filtered over the part of the pixel that a sample stands for.
std::vector<float> draw_sample(const gl::Functions& gl, const gl::Program& program, const Asset& asset, const Scene& scene,
                               const gl::FloatTarget& target, const WantedTexture& wanted,
                               const RenderOptions& options) {
    const bool regions = options.antialiasing == Antialiasing::regions;
    const bool marked = regions && !options.one_run;
    if (regions)
        set_filter(program, marked ? FILTER_MARKED : FILTER_REGIONS, ray_side(options));
    else
        set_filter(program, FILTER_RAYS);
    draw_pass(gl, program, asset, scene);
    std::vector<float> pixels = target.read(0);
    if (marked) add_marked_rays(gl, program, asset, scene, target, wanted, options, pixels);
    return pixels;
}

Status check(const Asset& asset, const RenderOptions& options) {
    const Camera& camera = options.camera;
    if (options.width < 1 || options.height < 1 || options.width > 8192 || options.height > 8192)
        return Error{ErrorCode::invalid_argument, "a picture's sides must be 1 to 8192 pixels"};
    if (options.samples < 1 || options.samples > 256)
        return Error{ErrorCode::invalid_argument, "samples per pixel must be 1 to 256"};
    if (options.rays < 4 || options.rays > 64)
        return Error{ErrorCode::invalid_argument, "rays per sample must be 4 to 64"};
    if (!(camera.zoom > 0.0) || !(camera.field_of_view > 0.0) || camera.field_of_view > 120.0)
        return Error{ErrorCode::invalid_argument,
                     "zoom must be above 0, the angle of view above 0 and at most 120 degrees"};
    if (options.environment && !(options.environment->strength >= 0.0 && std::isfinite(options.environment->strength)))
        return Error{ErrorCode::invalid_argument, "the strength of an environment must be 0 or more"};
    for (const Primitive& primitive : asset.primitives)
        if (!primitive.indices.empty()) return Done{};
    return Error{ErrorCode::invalid_input, "the asset has no triangle to draw"};
}

}  // namespace

Result<RgbaImage> render_asset(const Asset& asset, const RenderOptions& options) {
    if (Status status = check(asset, options); !status) return status.error();
    auto context = gl::open_context(options.backend);
    if (!context) return context.error();
    const gl::Functions& gl = (*context)->functions();
    auto program = gl::Program::build(gl, program_for(asset, options));
    if (!program) return program.error();
    auto target = gl::FloatTarget::create(gl, options.width, options.height, 1, true);
    if (!target) return target.error();
    const Scene scene = load_scene(gl, asset, options);
    const View view = place_camera(asset, options);
    program->use();
    set_view(*program, view, options);
    if (options.environment) scene.environment->bind(*program, options.environment->rotation, options.environment->strength);
    gl.Enable(GL_DEPTH_TEST);
    gl.CullFace(GL_BACK);
    gl.ClearColor(to_linear(options.background[0]), to_linear(options.background[1]),
                  to_linear(options.background[2]), 0.0f);
    (*target)->bind();
    const std::vector<Vec2> places = sample_places(int(std::ceil(std::sqrt(double(options.samples)) - 1e-9)));
    Accumulator sums(options.width, options.height);
    const WantedTexture wanted(gl);
    wanted.set(sums.wanted(), options.width, options.height);
    const int side = int(std::round(std::sqrt(double(places.size()))));
    program->set("pixel_part", 1.0f / float(side));
    program->set("wanted", 2);
    program->set("everywhere", 1);
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (k == 4) {
            sums.keep_uneven();
            wanted.set(sums.wanted(), options.width, options.height);
            program->set("everywhere", 0);
        }
        const glm::mat4 matrix = projection(view, options, places[k].x, places[k].y);
        gl.UniformMatrix4fv(program->at("world_to_clip"), 1, GL_FALSE, glm::value_ptr(matrix));
        sums.add(draw_sample(gl, *program, asset, scene, **target, wanted, options));
        wanted.set(sums.wanted(), options.width, options.height);
    }
    return sums.image();
}

}  // namespace burin
