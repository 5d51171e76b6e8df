#include "exact_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <gl/camera.hpp>
#include <gl/mesh.hpp>
#include <gl/sample_places.hpp>
#include <gl/shader_text.hpp>

#include "rival_text.hpp"
#include "target.hpp"

namespace burin::rivals {
namespace {

Result<gl::Program> build_program(const gl::Functions& gl, bool depth_alone) {
    const std::string head = std::string("#version 330 core\n") + (depth_alone ? "#define GEOMETRY_DEPTH\n" : "");
    return gl::Program::build(gl, head + gl::shader_text::geometry_vert, head + gl::shader_text::lamp + gl::shader_text::geometry_frag);
}

// Depths seen from the lamp, compared where they are looked up, the mean over four texels.
class DepthMap {
  public:
    DepthMap(const gl::Functions& gl, int size) : gl_(gl), size_(size) {
        gl_.GenTextures(1, &texture_);
        gl_.GenFramebuffers(1, &framebuffer_);
        gl_.BindTexture(GL_TEXTURE_2D, texture_);
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, size, size, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
        for (const GLenum side : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) gl_.TexParameteri(GL_TEXTURE_2D, side, GL_CLAMP_TO_EDGE);
        gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_, 0);
        const GLenum none = GL_NONE;
        gl_.DrawBuffers(1, &none);
        complete_ = gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    }
    DepthMap(const DepthMap&) = delete;
    DepthMap& operator=(const DepthMap&) = delete;
    ~DepthMap() {
        gl_.DeleteFramebuffers(1, &framebuffer_);
        gl_.DeleteTextures(1, &texture_);
    }
    bool complete() const { return complete_; }
    int size() const { return size_; }
    void begin() const {
        gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        gl_.Viewport(0, 0, size_, size_);
        gl_.Clear(GL_DEPTH_BUFFER_BIT);
    }
    void bind(const gl::Program& program) const {
        gl_.ActiveTexture(GL_TEXTURE0);
        gl_.BindTexture(GL_TEXTURE_2D, texture_);
        program.set("from_light", 0);
    }

  private:
    const gl::Functions& gl_;
    int size_;
    bool complete_ = false;
    GLuint texture_ = 0, framebuffer_ = 0;
};

// Corners that share a place, a normal and a paint are one.
class PrimitiveMaker {
  public:
    void add(const std::array<std::array<float, 3>, 3>& corners, const std::array<float, 3>& normal, int paint) {
        for (const auto& corner : corners) primitive_.indices.push_back(index_of({corner[0], corner[1], corner[2], normal[0], normal[1], normal[2], float(paint)}));
    }
    Primitive take() { return std::move(primitive_); }

  private:
    std::uint32_t index_of(const std::array<float, 7>& corner) {
        const auto [found, fresh] = indices_.try_emplace(corner, std::uint32_t(indices_.size()));
        if (fresh) {
            primitive_.positions.insert(primitive_.positions.end(), corner.begin(), corner.begin() + 3);
            primitive_.normals.insert(primitive_.normals.end(), corner.begin() + 3, corner.begin() + 6);
            primitive_.uvs.insert(primitive_.uvs.end(), {corner[6], 0.0f});
        }
        return found->second;
    }
    std::map<std::array<float, 7>, std::uint32_t> indices_;
    Primitive primitive_;
};

// Pattern space to the world of asset_of: its third axis is up, so that triangles turn around.
std::array<float, 3> in_world(const ResolvedPattern& pattern, const reference::Vec3& p) {
    return {float(p.x - 0.5 * pattern.size.x), float(p.z - pattern.base_offset), float(p.y - 0.5 * pattern.size.y)};
}

Primitive primitive_of(const ResolvedPattern& pattern, const Paints& paints, const mesh::TriangleMesh& tile) {
    PrimitiveMaker maker;
    for (std::size_t t = 0; t < tile.triangles.size(); ++t) {
        const auto& [a, b, c] = tile.triangles[t];
        const reference::Vec3 &p = tile.positions[a], &q = tile.positions[b], &r = tile.positions[c];
        const reference::Vec3 across = cross(q - p, r - p);
        if (dot(across, across) == 0.0) continue;  // it shows nothing, and has no normal
        const reference::Vec3 n = unit(across);
        const std::uint32_t element = tile.origins[t].element;
        const int paint = element < pattern.elements.size() ? paints.of_style[pattern.elements[element].style] : 0;
        maker.add({in_world(pattern, p), in_world(pattern, r), in_world(pattern, q)}, {float(n.x), float(n.z), float(n.y)}, paint);
    }
    return maker.take();
}

// The level around a map that ends, in four pieces, as far as the view goes.
Primitive surroundings_of(const ResolvedPattern& pattern) {
    const double far = 100.0 * std::max({pattern.size.x, pattern.size.y, pattern.depth}), z = pattern.outer_level;
    const Vec2 size = pattern.size;
    const Vec2 low[] = {{-far, -far}, {-far, size.y}, {-far, 0}, {size.x, 0}}, high[] = {{far, 0}, {far, far}, {0, size.y}, {far, size.y}};
    PrimitiveMaker maker;
    for (int i = 0; i < 4; ++i) {
        const auto at = [&](double x, double y) { return in_world(pattern, {x, y, z}); };
        const auto a = at(low[i].x, low[i].y), b = at(high[i].x, low[i].y), c = at(high[i].x, high[i].y), d = at(low[i].x, high[i].y);
        maker.add({a, c, b}, {0.0f, 1.0f, 0.0f}, 0);
        maker.add({a, d, c}, {0.0f, 1.0f, 0.0f}, 0);
    }
    return maker.take();
}

// What of the plane the picture needs, in uv: what is seen, and what may stand before it or throw a shadow on it.
bench::Extent needed_extent(const bench::PlaneView& view, const ResolvedPattern& pattern, double deep) {
    const bench::Extent seen = seen_extent(view, pattern.size, deep);
    const double reach = deep / std::tan(std::max(view.light.elevation, 5.0) * 0.0174533);
    const Vec2 more{reach / pattern.size.x, reach / pattern.size.y};
    return {{seen.low.x - more.x, seen.low.y - more.y}, {seen.high.x + more.x, seen.high.y + more.y}};
}

// World to clip space of the lamp, around the box of what the picture needs.
glm::dmat4 light_matrix(const bench::PlaneView& view, Vec2 size, const bench::Extent& needed, double deep) {
    const glm::dvec3 to_light = direction_of(view.light.azimuth, view.light.elevation);
    const glm::dvec3 up = std::abs(to_light.y) > 0.99 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dmat4 to_view = glm::lookAt(to_light, glm::dvec3(0.0), up);
    glm::dvec3 low(1e30), high(-1e30);
    for (const double u : {needed.low.x, needed.high.x})
        for (const double v : {needed.low.y, needed.high.y})
            for (const double y : {0.0, -deep}) {
                const glm::dvec3 p(to_view * glm::dvec4((u - 0.5) * size.x, y, (v - 0.5) * size.y, 1.0));
                low = glm::min(low, p), high = glm::max(high, p);
            }
    const double room = 0.01 * (high.z - low.z) + 1e-6;
    return glm::ortho(low.x, high.x, low.y, high.y, -high.z - room, -low.z + room) * to_view;
}

}  // namespace

struct ExactGeometry::State {
    const gl::Functions& gl;
    const Stage& stage;
    GeometrySettings settings;
    gl::Program shading, depths;
    std::unique_ptr<Target> target;
    std::unique_ptr<DepthMap> shadow;
    std::unique_ptr<gl::Mesh> tile, surroundings;
    Paints paints;
    std::vector<glm::vec3> shifts;  // of the tiles
    std::size_t corners = 0, triangles = 0;
    glm::mat4 to_light{1.0f};
    double texel = 0.0;  // of the depth map, metres
    std::array<float, 4> window{};

    // The tiles and the lamp's view of them, for relief that reaches `deep` below the object surface.
    void place(const ResolvedPattern& pattern, double deep) {
        const bool repeat = pattern.wrap == Wrap::repeat;
        const bench::Extent needed = needed_extent(stage.view(), pattern, deep), whole = bench::extent_of(stage.view(), pattern);
        const auto first = [&](double low) { return repeat ? int(std::floor(low)) : 0; };
        const auto last = [&](double high) { return repeat ? int(std::ceil(high)) : 1; };
        for (int j = first(needed.low.y); j < last(needed.high.y); ++j)
            for (int i = first(needed.low.x); i < last(needed.high.x); ++i) shifts.push_back({i * pattern.size.x, 0.0, j * pattern.size.y});
        to_light = glm::mat4(light_matrix(stage.view(), pattern.size, needed, deep));
        texel = std::max((needed.high.x - needed.low.x) * pattern.size.x, (needed.high.y - needed.low.y) * pattern.size.y) / settings.shadow_texels;
        const auto at = [](double uv, double size) { return float((uv - 0.5) * size); };
        window = {at(whole.low.x, pattern.size.x), at(whole.low.y, pattern.size.y), at(whole.high.x, pattern.size.x), at(whole.high.y, pattern.size.y)};
    }

    void draw_tiles(const gl::Program& program) const {
        for (const glm::vec3& shift : shifts) {
            program.set("shift", shift.x, shift.y, shift.z);
            tile->draw();
        }
        if (!surroundings) return;
        program.set("shift", 0.0f, 0.0f, 0.0f);
        surroundings->draw();
    }

    void draw_depths() const {
        depths.use();
        gl.UniformMatrix4fv(depths.at("world_to_clip"), 1, GL_FALSE, glm::value_ptr(to_light));
        shadow->begin();
        draw_tiles(depths);
    }

    void begin_shading(const View& view) const {
        const Light& lamp = stage.view().light;
        const glm::dvec3 to_lamp = direction_of(lamp.azimuth, lamp.elevation);
        shading.use();
        shadow->bind(shading);
        shading.set("eye", float(view.eye.x), float(view.eye.y), float(view.eye.z));
        shading.set("light", float(to_lamp.x), float(to_lamp.y), float(to_lamp.z));
        shading.set("light_strength", float(lamp.strength));
        shading.set("ambient", float(lamp.ambient));
        shading.set("shadow_lift", float(1.5 * texel));
        gl.UniformMatrix4fv(shading.at("world_to_light"), 1, GL_FALSE, glm::value_ptr(to_light));
        gl.Uniform4f(shading.at("window"), window[0], window[1], window[2], window[3]);
        bind_paints(shading, paints.list);
    }

    std::vector<float> draw_pass(const View& view, Vec2 moved) const {
        const glm::mat4 matrix(projection(view, stage.options(), moved.x, moved.y));
        gl.UniformMatrix4fv(shading.at("world_to_clip"), 1, GL_FALSE, glm::value_ptr(matrix));
        target->bind();
        gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        draw_tiles(shading);
        gl.Finish();
        return target->read();
    }
};

Result<ExactGeometry> ExactGeometry::load(const gl::Context& context, const bench::Subject& subject, const mesh::TriangleMesh& tile, const Stage& stage,
                                          const GeometrySettings& settings) {
    const gl::Functions& gl = context.functions();
    const ResolvedPattern& pattern = subject.prepared.resolved;
    auto shading = build_program(gl, false), depths = build_program(gl, true);
    if (!shading || !depths) return shading ? depths.error() : shading.error();
    auto target = Target::create(gl, stage.view().width, stage.view().height, settings.coverage);
    if (!target) return target.error();
    auto state = std::make_unique<State>(State{gl, stage, settings, std::move(*shading), std::move(*depths), std::move(*target),
                                               std::make_unique<DepthMap>(gl, settings.shadow_texels), {}, {}, paints_of(pattern, paint_of(subject.part())), {}});
    if (!state->shadow->complete()) return Error{ErrorCode::unavailable, "the driver draws no depth into a texture"};
    const Primitive primitive = primitive_of(pattern, state->paints, tile);
    state->tile = std::make_unique<gl::Mesh>(gl, primitive);
    state->corners = primitive.positions.size() / 3;
    state->triangles = primitive.indices.size() / 3;
    if (pattern.wrap == Wrap::clamp) state->surroundings = std::make_unique<gl::Mesh>(gl, surroundings_of(pattern));
    state->place(pattern, pattern.base_offset - tile.lowest);
    return ExactGeometry(std::move(state));
}

ExactGeometry::ExactGeometry(std::unique_ptr<State> state) : state_(std::move(state)) {}
ExactGeometry::ExactGeometry(ExactGeometry&& other) noexcept = default;
ExactGeometry::~ExactGeometry() = default;

gl::Accumulator ExactGeometry::draw() {
    const gl::Functions& gl = state_->gl;
    const RenderOptions& options = state_->stage.options();
    gl.Enable(GL_DEPTH_TEST);
    gl.Enable(GL_CULL_FACE);
    gl.CullFace(GL_BACK);
    gl.ClearColor(to_linear(options.background[0]), to_linear(options.background[1]), to_linear(options.background[2]), 0.0f);
    state_->draw_depths();
    const View view = place_camera(state_->stage.asset(), options);
    state_->begin_shading(view);
    gl::Accumulator sums(options.width, options.height);
    for (const Vec2 moved : gl::sample_grid(state_->settings.passes, false).places) sums.add(state_->draw_pass(view, moved));
    return sums;
}

std::size_t ExactGeometry::drawn_triangles() const { return state_->triangles * state_->shifts.size(); }

double ExactGeometry::bytes() const { return 16.0 * double(state_->corners) + 12.0 * double(state_->triangles); }

}  // namespace burin::rivals
