// Pictures of an asset: every mesh with its material, several passes with shifted pixels, averaged.
#include "gl/render.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "gl/accumulator.hpp"
#include "gl/camera.hpp"
#include "gl/look_textures.hpp"
#include "gl/marked_rays.hpp"
#include "gl/mesh.hpp"
#include "gl/outlines.hpp"
#include "gl/pixel_filter.h"
#include "gl/prepared_asset.hpp"
#include "gl/program.hpp"
#include "gl/sample_places.hpp"
#include "gl/veil.hpp"

namespace burin {
namespace {

// The asset in the context: meshes, textures and the program.
struct Scene {
    std::vector<std::unique_ptr<gl::Mesh>> meshes;
    std::vector<std::unique_ptr<gl::DetailTextures>> details;  // one per material, null without detail
    std::unique_ptr<gl::DetailTextures> none;                  // stands in where a material has no detail
    std::vector<std::unique_ptr<gl::MaterialTextures>> looks;  // one per material
    std::unique_ptr<gl::EnvironmentTextures> environment;      // null without one
};

Scene load_scene(const gl::Functions& gl, const Asset& asset, const RenderOptions& options) {
    Scene scene;
    for (const Primitive& primitive : asset.primitives)
        scene.meshes.push_back(std::make_unique<gl::Mesh>(gl, primitive));
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

bool is_round(const Primitive& primitive) {
    constexpr std::array<float, 3> kNone{};
    return std::any_of(primitive.frames.begin(), primitive.frames.end(), [&](const SurfaceFrame& frame) {
        return frame.duu != kNone || frame.duv != kNone || frame.dvv != kNone;
    });
}

gl::ProgramKind program_for(const Asset& asset, const RenderOptions& options, int pixel_filter) {
    gl::ProgramKind kind;
    kind.pixel_filter = pixel_filter;
    kind.stage = options.correct_depth ? gl::Stage::surface_with_depth : gl::Stage::surface;
    kind.environment = options.environment.has_value();
    kind.textures = gl::texture_kinds(asset);
    kind.round = std::any_of(asset.primitives.begin(), asset.primitives.end(), is_round);
    for (const MaterialInfo& material : asset.materials) {
        if (material.has_detail) kind.pattern = gl::join_kinds(kind.pattern, gl::kinds_of(material.textures));
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

void draw_meshes(const gl::Functions& gl, const gl::Program& program, const Asset& asset, const Scene& scene) {
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

// Clip space of the picture to that of a window of it.
glm::dmat4 crop(const RenderOptions& options, const gl::PixelWindow& window) {
    const glm::dvec3 scale(double(options.width) / window.width, double(options.height) / window.height, 1.0);
    const glm::dvec3 middle(2.0 * window.left + window.width - options.width, 2.0 * window.low + window.height - options.height, 0.0);
    const glm::dvec3 shift(-middle.x / window.width, -middle.y / window.height, 0.0);
    return glm::scale(glm::translate(glm::dmat4(1.0), shift), scale);
}

// Rays per side of a sample: an even number, so that the first four spread over its quarters.
int ray_side(int rays) { return 2 * int(std::ceil(std::sqrt(double(rays)) / 2.0 - 1e-9)); }

// Draws samples of one picture: all in one run of a shader, or areas and rays in runs of two.
class Painter {
  public:
    // All must outlive it.
    Painter(const gl::Functions& gl, const Asset& asset, const RenderOptions& options, const gl::FloatTarget& target, bool counted = false)
        : gl_(gl), asset_(asset), options_(options), target_(target), counted_(counted),
          scene_(load_scene(gl, asset, options)), view_(place_camera(asset, options)),
          samples_(gl::sample_grid(options.samples, options.antialiasing == Antialiasing::regions)), ray_side_(ray_side(options.rays)) {}

    const std::vector<Vec2>& places() const { return samples_.places; }

    // Linear colours of the pixels that are wanted, lower row first; `place` within the pixel.
    Result<std::vector<float>> draw_sample(Vec2 place, const std::vector<std::uint8_t>& wanted) {
        sample_ = place;
        const bool regions = options_.antialiasing == Antialiasing::regions;
        const bool marked = regions && !options_.one_run;
        const int filter = marked ? FILTER_MARKED : regions ? FILTER_REGIONS : FILTER_RAYS;
        auto drawn = draw(filter, {}, wanted);
        if (!drawn || !marked) return drawn;
        if (Status replaced = replace_marked(*drawn); !replaced) return replaced.error();
        return drawn;
    }

  private:
    // A program is built when first asked for: many pictures want no rays.
    Result<const gl::Program*> program(int filter) {
        auto& built = programs_[std::size_t(filter)];
        if (built) return &*built;
        gl::ProgramKind kind = program_for(asset_, options_, filter);
        kind.counted = counted_;
        auto program = gl::Program::build(gl_, kind);
        if (!program) return program.error();
        built.emplace(std::move(*program));
        built->use();
        set_view(*built, view_, options_);
        if (options_.environment)
            scene_.environment->bind(*built, options_.environment->rotation, options_.environment->strength);
        built->set("side", ray_side_);
        built->set("cells", ray_side_ * samples_.side);
        return &*built;
    }

    // Null where all pixels are wanted.
    Result<const gl::Veil*> veil_over(const std::vector<std::uint8_t>& wanted) {
        if (std::find(wanted.begin(), wanted.end(), 0) == wanted.end()) return nullptr;
        if (!veil_) {
            auto made = gl::Veil::create(gl_);
            if (!made) return made.error();
            veil_ = std::move(*made);
        }
        veil_->set(wanted, options_.width, options_.height);
        return veil_.get();
    }

    // Into the target at hand, which shows `window` by `to_clip`.
    void draw_window(const gl::Program& program, const gl::PixelWindow& window, const glm::dmat4& to_clip, const gl::Veil* veil) {
        gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        if (veil != nullptr) veil->draw(window);
        program.use();
        program.set("across", window.across);
        program.set("pixel_part", float(samples_.part.x * window.across), float(samples_.part.y * window.across));
        const glm::mat4 matrix(to_clip);
        gl_.UniformMatrix4fv(program.at("world_to_clip"), 1, GL_FALSE, glm::value_ptr(matrix));
        draw_meshes(gl_, program, asset_, scene_);
    }

    Result<std::vector<float>> draw(int filter, const gl::RayPlace& place, const std::vector<std::uint8_t>& wanted) {
        const auto chosen = program(filter);
        if (!chosen) return chosen.error();
        const auto veil = veil_over(wanted);
        if (!veil) return veil.error();
        const gl::Program& program = **chosen;
        program.use();
        program.set("ray_shift", float(place.shift.x), float(place.shift.y));
        const gl::RayCell first = gl::first_ray_cell(ray_side_, sample_, samples_.side);
        program.set("first_cell", float(first.column), float(first.row));
        // What is moved to the right is seen from a place further left.
        const Vec2 moved{sample_.x - place.middle.x * samples_.part.x, sample_.y - place.middle.y * samples_.part.y};
        draw_window(program, {0, 0, options_.width, options_.height}, projection(view_, options_, moved.x, moved.y), *veil);
        return target_.read(0);
    }

    // Adds across x across rays of each pixel that wants them, all side by side: drivers that work on blocks of texels, and for all of one
    // if for any, lose least when those of a block lie in one pixel. In windows, since a picture of rays is many times as large.
    Status add_rays(int across, gl::MarkedRays& rays) {
        const auto program = this->program(FILTER_RAYS);
        if (!program) return program.error();
        const auto veil = veil_over(rays.wanted());
        if (!veil) return veil.error();
        const int most = kMostTexels / across;
        gl::PixelWindow window{0, 0, std::min(most, options_.width), std::min(most, options_.height), across};
        const auto target = gl::FloatTarget::create(gl_, window.width * across, window.height * across, 1, true);
        if (!target) return target.error();
        (*target)->bind();
        for (int low = 0; low < options_.height; low += window.height)
            for (int left = 0; left < options_.width; left += window.width) {
                window.low = std::min(low, options_.height - window.height);
                window.left = std::min(left, options_.width - window.width);
                if (!rays.any_wanted(window)) continue;
                draw_window(**program, window, crop(options_, window) * projection(view_, options_, sample_.x, sample_.y), *veil);
                rays.add((*target)->read(0), window, left, low);
            }
        target_.bind();
        return Done{};
    }

    // Puts the mean of rays where `pixels` asks for them in its fourth channel, and, unless several samples do that, where a mesh ends or
    // has an edge: of four, and of all where these do not agree.
    Status replace_marked(std::vector<float>& pixels) {
        const bool alone = samples_.places.size() == 1;
        if (alone) gl::mark_outlines(target_.read_depths(), options_.width, options_.height, pixels);
        gl::MarkedRays rays(options_.width, options_.height, pixels);
        if (Status added = alone ? add_all(rays) : add_passes(rays); !added) return added;
        rays.put_means(pixels);
        return Done{};
    }

    Status add_all(gl::MarkedRays& rays) {
        if (!rays.any_wanted()) return Done{};
        if (Status added = add_rays(2, rays); !added || ray_side_ == 2) return added;
        rays.keep_uneven();
        return rays.any_wanted() ? add_rays(ray_side_, rays) : Status(Done{});
    }

    // The rays of one of several samples: their pixels do not adjoin.
    Status add_passes(gl::MarkedRays& rays) {
        const std::vector<gl::RayPlace> places = gl::ray_places(ray_side_, sample_, samples_.side);
        for (std::size_t k = 0; k < places.size(); ++k) {
            if (k == 4) rays.keep_uneven();
            if (!rays.any_wanted()) break;
            const auto found = draw(FILTER_RAYS, places[k], rays.wanted());
            if (!found) return found.error();
            rays.add(*found, k);
        }
        return Done{};
    }

    static constexpr int kMostTexels = 1024;  // on a side of a target of rays

    const gl::Functions& gl_;
    const Asset& asset_;
    const RenderOptions& options_;
    const gl::FloatTarget& target_;
    bool counted_;
    Scene scene_;
    View view_;
    std::unique_ptr<gl::Veil> veil_;  // made when first asked for
    gl::SampleGrid samples_;
    int ray_side_;
    Vec2 sample_{};  // at hand
    std::array<std::optional<gl::Program>, 3> programs_;  // by FILTER_*
};

// A target of the picture's size.
Result<std::unique_ptr<gl::FloatTarget>> make_target(const gl::Functions& gl, const RenderOptions& options) {
    return gl::FloatTarget::create(gl, options.width, options.height, 1, true);
}

// From now on passes go to the target, cleared to `background`.
void begin_picture(const gl::Functions& gl, const gl::FloatTarget& target, const std::array<float, 3>& background) {
    gl.Enable(GL_DEPTH_TEST);
    gl.CullFace(GL_BACK);
    gl.ClearColor(to_linear(background[0]), to_linear(background[1]), to_linear(background[2]), 0.0f);
    target.bind();
}

}  // namespace

struct gl::PreparedAsset::State {
    const Functions& gl;
    RenderOptions options;
    std::unique_ptr<FloatTarget> target;
    Painter painter;

    State(const Functions& functions, const Asset& asset, const RenderOptions& wanted, std::unique_ptr<FloatTarget> made)
        : gl(functions), options(wanted), target(std::move(made)), painter(functions, asset, options, *target) {}
};

Result<gl::PreparedAsset> gl::PreparedAsset::load(const Context& context, const Asset& asset, const RenderOptions& options) {
    if (Status status = check_render(asset, options); !status) return status.error();
    auto target = make_target(context.functions(), options);
    if (!target) return target.error();
    return PreparedAsset(std::make_unique<State>(context.functions(), asset, options, std::move(*target)));
}

gl::PreparedAsset::PreparedAsset(std::unique_ptr<State> state) : state_(std::move(state)) {}
gl::PreparedAsset::PreparedAsset(PreparedAsset&& other) noexcept = default;
gl::PreparedAsset::~PreparedAsset() = default;

Result<gl::Accumulator> gl::PreparedAsset::draw() {
    begin_picture(state_->gl, *state_->target, state_->options.background);
    Painter& painter = state_->painter;
    Accumulator sums(state_->options.width, state_->options.height);
    for (std::size_t k = 0; k < painter.places().size(); ++k) {
        if (k == 4) sums.keep_uneven();
        const auto drawn = painter.draw_sample(painter.places()[k], sums.wanted());
        if (!drawn) return drawn.error();
        sums.add(*drawn);
    }
    return sums;
}

Result<RgbaImage> render_asset(const Asset& asset, const RenderOptions& options) {
    if (Status status = check_render(asset, options); !status) return status.error();
    const auto context = gl::open_context(options.backend);
    if (!context) return context.error();
    auto prepared = gl::PreparedAsset::load(**context, asset, options);
    if (!prepared) return prepared.error();
    const auto sums = prepared->draw();
    if (!sums) return sums.error();
    return sums->image();
}

Result<FetchCounts> count_fetches(const Asset& asset, const RenderOptions& wanted) {
    RenderOptions options = wanted;
    options.samples = 1;
    options.one_run = true;
    if (Status status = check_render(asset, options); !status) return status.error();
    const auto context = gl::open_context(options.backend);
    if (!context) return context.error();
    const gl::Functions& gl = (*context)->functions();
    const auto target = make_target(gl, options);
    if (!target) return target.error();
    begin_picture(gl, **target, {0, 0, 0});
    Painter painter(gl, asset, options, **target, true);
    const auto drawn = painter.draw_sample(painter.places()[0], std::vector<std::uint8_t>(std::size_t(options.width) * std::size_t(options.height), 255));
    if (!drawn) return drawn.error();
    FetchCounts counts;
    for (std::size_t i = 0; i < drawn->size(); i += 4) {
        const float* pixel = drawn->data() + i;
        if (pixel[0] == 0.0f) continue;  // it shows no pattern
        counts.pixels += 1.0;
        counts.cells += double(pixel[0]), counts.elements += double(pixel[1]), counts.lists += double(pixel[2]), counts.others += double(pixel[3]);
    }
    for (double* sum : {&counts.cells, &counts.elements, &counts.lists, &counts.others}) *sum /= std::max(counts.pixels, 1.0);
    return counts;
}

}  // namespace burin
