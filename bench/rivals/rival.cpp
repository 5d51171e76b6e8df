#include "rival.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/type_ptr.hpp>

#include <gl/camera.hpp>
#include <gl/mesh.hpp>
#include <gl/sample_places.hpp>
#include <gl/shader_text.hpp>

#include "rival_text.hpp"
#include "target.hpp"

namespace burin::rivals {
namespace {

constexpr const char* kVersion = "#version 330 core\n";

Result<gl::Program> build_program(const gl::Functions& gl, Technique technique, std::size_t channels) {
    const std::string macros = "#define TECHNIQUE " + std::to_string(int(technique)) + "\n#define CHANNELS " + std::to_string(channels) + "\n" +
                               (technique == Technique::triangles ? "#define RIVAL_TRIANGLES\n" : "");
    return gl::Program::build(gl, kVersion + macros + gl::shader_text::rival_vert,
                              kVersion + macros + gl::shader_text::lamp + gl::shader_text::rival_frag);
}

double radical_inverse(int i) {
    double value = 0.0, share = 0.5;
    for (; i > 0; i /= 2, share /= 2.0) value += share * (i % 2);
    return value;
}

std::vector<Vec2> places_of(const RivalSettings& settings) {
    if (settings.places == Places::grid && settings.samples != 32) return gl::sample_grid(settings.samples, false).places;
    std::vector<Vec2> places;
    for (int k = 0; k < settings.samples; ++k)
        places.push_back({(k + 0.5) / settings.samples - 0.5, radical_inverse(k) + 0.5 / settings.samples - 0.5});
    return places;
}

}  // namespace

const char* name_of(Technique technique) {
    constexpr const char* kNames[] = {"normal mapping", "parallax occlusion", "relief", "relaxed cones", "triangles"};
    return kNames[int(technique)];
}

struct Rival::State {
    const gl::Functions& gl;
    const Asset& asset;
    RenderOptions options;
    Technique technique;
    gl::Program program;
    std::unique_ptr<Target> target;
    View view;
    std::vector<std::unique_ptr<gl::Mesh>> meshes;

    void begin_picture() const {
        gl.Enable(GL_DEPTH_TEST);
        gl.Enable(GL_CULL_FACE);
        gl.CullFace(GL_BACK);
        const auto& background = options.background;
        gl.ClearColor(to_linear(background[0]), to_linear(background[1]), to_linear(background[2]), 0.0f);
        program.use();
        const glm::dvec3 to_light = direction_of(options.light.azimuth, options.light.elevation);
        program.set("eye", float(view.eye.x), float(view.eye.y), float(view.eye.z));
        program.set("light", float(to_light.x), float(to_light.y), float(to_light.z));
        program.set("light_strength", float(options.light.strength));
        program.set("ambient", float(options.light.ambient));
    }

    void set(const RivalSettings& settings) const {
        program.set("steps", settings.steps);
        program.set("refinements", settings.refinements);
        program.set("sample_side", float(1.0 / std::sqrt(double(settings.samples))));
        program.set("bias", settings.bias);
        program.set("shadow_slack", settings.shadow_slack + (settings.wide_heights ? 0.0f : 2.0f / 255.0f));
        program.set("anisotropy", settings.anisotropy);
        const auto& window = settings.window;
        gl.Uniform4f(program.at("window"), float(window[0]), float(window[1]), float(window[2]), float(window[3]));
        program.set("grid_level", float(std::max(0.0, std::log2(settings.edge * settings.size))));
    }

    // In the loop of the shader: these places of the picture moved by `shift`, pixels.
    std::vector<float> draw_pass(Vec2 shift, const std::vector<Vec2>& places, const std::vector<const RivalMaps*>& maps) const {
        program.set("count", int(places.size()));
        for (std::size_t k = 0; k < places.size(); ++k)
            program.set(("places[" + std::to_string(k) + "]").c_str(), float(places[k].x), float(places[k].y));
        const glm::mat4 matrix(projection(view, options, shift.x, shift.y));
        gl.UniformMatrix4fv(program.at("world_to_clip"), 1, GL_FALSE, glm::value_ptr(matrix));
        target->bind();
        gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            maps[std::size_t(asset.primitives[i].material)]->bind(program);
            meshes[i]->draw();
        }
        gl.Finish();
        return target->read();
    }
};

Result<Rival> Rival::load(const gl::Context& context, const Asset& asset, const RenderOptions& options, Technique technique,
                          std::size_t channels, bool outlines) {
    if (Status status = check_render(asset, options); !status) return status.error();
    const gl::Functions& gl = context.functions();
    auto program = build_program(gl, technique, channels);
    if (!program) return program.error();
    auto target = Target::create(gl, options.width, options.height, outlines && technique != Technique::triangles);
    if (!target) return target.error();
    auto state = std::make_unique<State>(
        State{gl, asset, options, technique, std::move(*program), std::move(*target), place_camera(asset, options), {}});
    for (const Primitive& primitive : asset.primitives) state->meshes.push_back(std::make_unique<gl::Mesh>(gl, primitive));
    return Rival(std::move(state));
}

Rival::Rival(std::unique_ptr<State> state) : state_(std::move(state)) {}
Rival::Rival(Rival&& other) noexcept = default;
Rival::~Rival() = default;

gl::Accumulator Rival::draw(const RivalSettings& settings, const std::vector<const RivalMaps*>& maps) {
    state_->begin_picture();
    state_->set(settings);
    gl::Accumulator sums(state_->options.width, state_->options.height);
    const std::vector<Vec2> places = places_of(settings);
    if (settings.passes || state_->technique == Technique::triangles)
        for (const Vec2 place : places) sums.add(state_->draw_pass(place, {Vec2{0, 0}}, maps));
    else
        sums.add(state_->draw_pass({0, 0}, places, maps));
    return sums;
}

namespace {

// Vertices and triangles of one triangle cut into n x n.
void add_subdivided(const Primitive& primitive, const std::uint32_t* corner, int n, Primitive& fine) {
    const std::uint32_t base = std::uint32_t(fine.positions.size() / 3);
    const auto add = [&](const std::vector<float>& values, std::size_t width, double s, double t, std::vector<float>& to) {
        const float* of[3];
        for (std::size_t k = 0; k < 3; ++k) of[k] = &values[width * corner[k]];
        for (std::size_t c = 0; c < width; ++c) to.push_back(float((1.0 - s - t) * double(of[0][c]) + s * double(of[1][c]) + t * double(of[2][c])));
    };
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n - i; ++j) {
            const double s = double(i) / n, t = double(j) / n;
            add(primitive.positions, 3, s, t, fine.positions);
            add(primitive.normals, 3, s, t, fine.normals);
            add(primitive.uvs, 2, s, t, fine.uvs);
        }
    const auto at = [&](int i, int j) { return base + std::uint32_t(i * (n + 1) - i * (i - 1) / 2 + j); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n - i; ++j) {
            fine.indices.insert(fine.indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
            if (j + 1 < n - i) fine.indices.insert(fine.indices.end(), {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
}

double longest_side(const Primitive& primitive, const std::uint32_t* corner) {
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const float *a = &primitive.uvs[2 * corner[k]], *b = &primitive.uvs[2 * corner[(k + 1) % 3]];
        longest = std::max(longest, std::hypot(double(a[0] - b[0]), double(a[1] - b[1])));
    }
    return longest;
}

}  // namespace

Primitive subdivide(const Primitive& primitive, double edge) {
    Primitive fine;
    fine.material = primitive.material;
    for (std::size_t first = 0; first + 2 < primitive.indices.size(); first += 3) {
        const std::uint32_t* corner = &primitive.indices[first];
        add_subdivided(primitive, corner, std::max(1, int(std::ceil(longest_side(primitive, corner) / edge))), fine);
    }
    return fine;
}

}  // namespace burin::rivals
