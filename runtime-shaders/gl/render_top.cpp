// Straight-down heights, and single rays: both draw one triangle over a float target.
#include <algorithm>
#include <cstring>

#include "gl/program.hpp"
#include "gl/render.hpp"
#include "gl/screen.hpp"

namespace burin {
namespace {

// Pixels a side of the target that a large picture is drawn in, piece by piece: bounds memory and the time of
// one draw call, which some drivers limit.
constexpr int kTile = 512;

Result<int> find_detail(const Asset& asset, int wanted) {
    const int count = int(asset.materials.size());
    if (wanted >= count)
        return Error{ErrorCode::invalid_argument, "material " + std::to_string(wanted) +
                                                      " is not in the asset, which has " +
                                                      std::to_string(count)};
    for (int i = std::max(wanted, 0); i < (wanted < 0 ? count : wanted + 1); ++i)
        if (asset.materials[std::size_t(i)].has_detail) return i;
    return Error{ErrorCode::invalid_input,
                 wanted < 0 ? std::string("no material of the asset has path detail")
                            : "material " + std::to_string(wanted) + " has no path detail"};
}

void store(Image& image, const std::vector<float>& pixels, int x0, int y0, int width, int height) {
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.at(x0 + x, y0 + y) = pixels[4 * (std::size_t(y) * kTile + std::size_t(x))];
}

}  // namespace

Result<Image> render_top(const Asset& asset, int width, int height, const TopOptions& options) {
    if (width < 1 || height < 1 || options.samples < 1 || options.samples > 16)
        return Error{ErrorCode::invalid_argument,
                     "width and height must be at least 1, samples per side 1 to 16"};
    auto index = find_detail(asset, options.material);
    if (!index) return index.error();
    const MaterialInfo& material = asset.materials[std::size_t(*index)];
    auto context = gl::open_context(options.backend);
    if (!context) return context.error();
    const gl::Functions& gl = (*context)->functions();
    auto program = gl::Program::build(gl, {gl::Stage::top, gl::kinds_of(material.textures)});
    if (!program) return program.error();
    auto target = gl::FloatTarget::create(gl, kTile, kTile, 1, false);
    if (!target) return target.error();
    const gl::DetailTextures textures(gl, material.textures, material.detail);
    const gl::Screen screen(gl);
    program->use();
    textures.bind(*program);
    program->set("texel", float(material.detail.size_u / width), float(material.detail.size_v / height));
    program->set("samples", options.samples);
    Image image(width, height);
    for (int y = 0; y < height; y += kTile) {
        for (int x = 0; x < width; x += kTile) {
            // Row 0 of the target is its lowest; v grows with it, so that no row changes place.
            (*target)->bind();
            gl.Viewport(0, 0, std::min(kTile, width - x), std::min(kTile, height - y));
            program->set("first", float(x), float(y));
            screen.draw();
            gl.Finish();
            store(image, (*target)->read(0), x, y, std::min(kTile, width - x), std::min(kTile, height - y));
        }
    }
    return image;
}

Result<std::vector<ShadedHit>> shade_rays(const PackedTextures& packed, const PathDetail& detail,
                                          std::span<const PatternRay> rays, Backend backend, const RgbaImage& residual) {
    auto context = gl::open_context(backend);
    if (!context) return context.error();
    const gl::Functions& gl = (*context)->functions();
    auto program = gl::Program::build(gl, {gl::Stage::rays, gl::kinds_of(packed)});
    if (!program) return program.error();
    auto target = gl::FloatTarget::create(gl, kTile, kTile, 2, false);
    if (!target) return target.error();
    const gl::DetailTextures textures(gl, packed, detail, residual);
    const gl::Screen screen(gl);
    GLuint given = 0;
    gl.GenTextures(1, &given);
    std::vector<ShadedHit> hits(rays.size());
    constexpr std::size_t kPerTile = std::size_t(kTile) * kTile;
    for (std::size_t first = 0; first < rays.size(); first += kPerTile) {
        const std::size_t count = std::min(kPerTile, rays.size() - first);
        std::vector<float> texels(kPerTile * 4, 0.0f);
        std::memcpy(texels.data(), &rays[first], count * sizeof(PatternRay));
        program->use();
        textures.bind(*program);
        gl.ActiveTexture(GL_TEXTURE0 + 2);
        gl.BindTexture(GL_TEXTURE_2D, given);
        gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kTile, kTile, 0, GL_RGBA, GL_FLOAT, texels.data());
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        program->set("rays", 2);
        (*target)->bind();
        gl.Viewport(0, 0, kTile, int((count + kTile - 1) / kTile));
        screen.draw();
        gl.Finish();
        const std::vector<float> met = (*target)->read(0);
        const std::vector<float> normal = (*target)->read(1);
        for (std::size_t i = 0; i < count; ++i) {
            ShadedHit& hit = hits[first + i];
            hit.drop = met[4 * i];
            hit.element = std::uint32_t(met[4 * i + 1]) | std::uint32_t(met[4 * i + 2]) << 16;
            hit.facet = int(met[4 * i + 3]);
            for (std::size_t k = 0; k < 3; ++k) hit.normal[k] = normal[4 * i + k];
        }
    }
    gl.DeleteTextures(1, &given);
    return hits;
}

Result<std::string> describe_backend(Backend backend) {
    auto context = gl::open_context(backend);
    if (!context) return context.error();
    return (*context)->describe();
}

}  // namespace burin
