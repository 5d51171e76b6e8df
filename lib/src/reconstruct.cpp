#include <burin/reconstruct.hpp>

#include <vector>

#include <burin/rasterize.hpp>

namespace burin {

Result<Image> reconstruct_heights(const PackedTextures& textures, const PathDetail& detail, int width, int height,
                                  const ReconstructOptions& options) {
    auto unpacked = unpack_textures(textures, detail);
    if (!unpacked) return unpacked.error();
    ResolvedPattern& pattern = unpacked->pattern;
    // Step paths never depend on lines, so that what is left is a whole pattern.
    if (options.steps_only)
        std::erase_if(pattern.elements, [&](const ResolvedElement& e) { return !pattern.styles[e.style].step; });
    RasterizeOptions rasterize;
    rasterize.samples = options.samples;
    rasterize.threads = options.threads;
    rasterize.level_tolerance = 4e-5;  // levels and heights come from 16-bit codes
    return rasterize_height(pattern, width, height, rasterize);
}

}  // namespace burin
