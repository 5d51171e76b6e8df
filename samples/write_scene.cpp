#include "write_scene.hpp"

#include <cmath>

#include <burin/author.hpp>

#include "scenes/drawing.hpp"

namespace burin::scenes {
namespace {

constexpr int kGrainSide = 128;

// Grain that repeats: sums of waves of whole numbers, so that both slopes belong to one surface.
Residual grain(double steepest) {
    Residual residual;
    residual.scale = steepest;
    residual.picture = {kGrainSide, kGrainSide, std::vector<std::uint8_t>(4 * kGrainSide * kGrainSide, 255)};
    std::vector<double> along(kGrainSide * kGrainSide, 0.0), down = along;
    Chance chance(77);
    double most = 0.0;
    for (int wave = 0; wave < 60; ++wave) {
        const int i = chance.below(41) - 20, j = chance.below(41) - 20;
        const double size = std::hypot(i, j), phase = chance.between(0.0, 2.0 * kPi), slope = size > 0.0 ? 1.0 / std::sqrt(size) : 0.0;
        for (int y = 0; y < kGrainSide; ++y)
            for (int x = 0; x < kGrainSide; ++x) {
                const double value = slope * std::cos(2.0 * kPi * (i * (x + 0.5) + j * (y + 0.5)) / kGrainSide + phase) / std::max(size, 1.0);
                along[std::size_t(y * kGrainSide + x)] += value * i;
                down[std::size_t(y * kGrainSide + x)] += value * j;
            }
    }
    for (std::size_t k = 0; k < along.size(); ++k) most = std::max({most, std::abs(along[k]), std::abs(down[k])});
    // Slopes in units of `scale`: red against the slope along u, green with the slope along v.
    for (std::size_t k = 0; k < along.size(); ++k) {
        residual.picture.texels[4 * k] = std::uint8_t(std::lround(127.5 - 127.0 * along[k] / most));
        residual.picture.texels[4 * k + 1] = std::uint8_t(std::lround(127.5 + 127.0 * down[k] / most));
    }
    return residual;
}

// The part's pattern on a material of the file's model.
Result<Model> add_part(SceneFile& file, const Model& model, const Part& part, const std::string& material) {
    const auto packed = author_textures(part.pattern);
    if (!packed) return Error{packed.error().code, part.name + ": " + packed.error().message};
    Residual residual;
    if (part.erosion > 0.0) {
        residual = grain(part.erosion);
        auto png = encode_png(residual.picture);
        if (!png) return png.error();
        residual.png = std::move(*png);
    }
    auto glb = write_glb(model, packed->textures, packed->detail, packed->fallback, {.material = material}, residual);
    if (!glb) return glb.error();
    file.bytes = std::move(*glb);
    file.elements += static_cast<std::size_t>(packed->stats.lines + packed->stats.quadratics);
    file.texture_bytes += 4 * (packed->textures.grid.size() + packed->textures.data.size());
    return read_model_bytes(file.bytes, "");
}

}  // namespace

Result<SceneFile> write_scene(const Scene& scene) {
    Model model = model_of(scene);
    SceneFile file;
    for (const Part& part : scene.parts) {
        auto next = add_part(file, model, part, part.name);
        if (!next) return next.error();
        model = std::move(*next);
    }
    return file;
}

Result<SceneFile> write_scene_on(const Scene& scene, const Model& model, const std::string& material) {
    const auto target = find_material(model, {.material = material});
    if (!target) return target.error();
    Part part = scene.parts.front();
    part.pattern = enlarged_to(std::move(part.pattern), target->metres_per_uv);
    SceneFile file;
    const auto done = add_part(file, model, part, material);
    return done ? Result<SceneFile>(std::move(file)) : done.error();
}

}  // namespace burin::scenes
