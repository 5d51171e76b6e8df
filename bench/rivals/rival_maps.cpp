#include <algorithm>
#include <cstdio>
#include <string>

#include <burin/image_io.hpp>

#include "cone_map.hpp"
#include "rival.hpp"

namespace burin::rivals {
namespace {

// Cones of all levels from that of `size` on.
std::vector<std::vector<std::uint8_t>> cones_of(const SurfaceMaps& maps, const RivalMaps::Wanted& wanted) {
    const std::size_t first = maps.level_of(wanted.size);
    const std::string path = wanted.cache + "/" + wanted.key + "_" + std::to_string(wanted.size) + ".cones";
    std::size_t total = 0;
    for (std::size_t i = first; i < maps.levels.size(); ++i) total += maps.levels[i].heights.size();
    std::vector<std::vector<std::uint8_t>> cones;
    if (auto bytes = wanted.cache.empty() ? Result<std::vector<std::uint8_t>>(std::vector<std::uint8_t>{}) : read_file(path, std::size_t(1) << 31);
        bytes && bytes->size() == total) {
        std::size_t at = 0;
        for (std::size_t i = first; i < maps.levels.size(); at += maps.levels[i++].heights.size())
            cones.emplace_back(bytes->begin() + std::ptrdiff_t(at), bytes->begin() + std::ptrdiff_t(at + maps.levels[i].heights.size()));
        return cones;
    }
    std::vector<std::uint8_t> all;
    for (std::size_t i = first; i < maps.levels.size(); ++i) {
        // Of so fine a map neighbouring texels take turns at what lies between directions.
        cones.push_back(make_relaxed_cones(maps, maps.levels[i], {.directions = maps.levels[i].size > 1024 ? 16 : 32}));
        all.insert(all.end(), cones.back().begin(), cones.back().end());
    }
    if (!wanted.cache.empty())
        if (Status written = write_file(path, all); !written) std::fprintf(stderr, "the cones are not kept: %s\n", written.error().message.c_str());
    return cones;
}

// Heights in as many bytes as asked for, each followed by its cone where there are cones.
std::vector<std::uint8_t> height_texels(const MapLevel& level, bool wide, const std::vector<std::uint8_t>* cones) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(level.heights.size() * (wide ? 2u : 1u) * (cones != nullptr ? 2u : 1u));
    const auto add = [&](std::uint16_t value) {
        bytes.push_back(std::uint8_t(wide ? value & 255 : (value + 128) / 257));
        if (wide) bytes.push_back(std::uint8_t(value >> 8));
    };
    for (std::size_t i = 0; i < level.heights.size(); ++i) {
        add(level.heights[i]);
        if (cones != nullptr) add(std::uint16_t((*cones)[i] * 257));
    }
    return bytes;
}

struct Format {
    GLint inner;
    GLenum layout, type;
};

Format format_of(std::size_t channels, bool wide) {
    constexpr Format kNarrow[] = {{GL_R8, GL_RED, GL_UNSIGNED_BYTE}, {GL_RG8, GL_RG, GL_UNSIGNED_BYTE}, {GL_RGB8, GL_RGB, GL_UNSIGNED_BYTE},
                                  {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE}};
    constexpr Format kWide[] = {{GL_R16, GL_RED, GL_UNSIGNED_SHORT}, {GL_RG16, GL_RG, GL_UNSIGNED_SHORT}};
    return wide ? kWide[channels - 1] : kNarrow[channels - 1];
}

void upload(const gl::Functions& gl, int level, int size, const Format& format, const void* texels) {
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.TexImage2D(GL_TEXTURE_2D, level, format.inner, size, size, 0, format.layout, format.type, texels);
}

void filter(const gl::Functions& gl, bool repeat, GLint between, const GLfloat (&around)[4]) {
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, between);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    for (const GLenum side : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) gl.TexParameteri(GL_TEXTURE_2D, side, repeat ? GL_REPEAT : GL_CLAMP_TO_BORDER);
    gl.TexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, around);
}

std::vector<std::int8_t> normal_texels(const MapLevel& level) {
    std::vector<std::int8_t> bytes(level.normals.size());
    std::transform(level.normals.begin(), level.normals.end(), bytes.begin(),
                   [](std::int16_t value) { return std::int8_t((value * 127 + (value < 0 ? -16383 : 16383)) / 32767); });
    return bytes;
}

}  // namespace

MapBytes bytes_of(const RivalSettings& settings, const SurfaceMaps& maps) {
    const bool flat = settings.technique == Technique::normals;
    const double heights = flat ? 0.0 : settings.wide_heights ? 2.0 : 1.0;
    const double others = 2.0 + double(maps.channels()) + (settings.technique == Technique::cones ? 1.0 : 0.0);
    double plain = 0.0, blocks = 0.0;
    for (double side = settings.size; side >= 1.0; side /= 2.0) {
        plain += side * side * (heights + others);
        const double whole = std::max(side, 4.0);
        blocks += whole * whole * 0.5 * ((flat ? 0.0 : 1.0) + others);
    }
    return {plain, blocks};
}

RivalMaps::RivalMaps(const gl::Functions& gl, const SurfaceMaps& maps, const Wanted& wanted) : gl_(gl), maps_(maps), size_(wanted.size) {
    const std::size_t first = maps.level_of(wanted.size);
    const auto cones = wanted.cones ? cones_of(maps, wanted) : std::vector<std::vector<std::uint8_t>>{};
    gl.GenTextures(3, names_);
    for (int which = 0; which < 3; ++which) {
        if (which == 2 && maps.channels() == 0) continue;
        gl.ActiveTexture(GL_TEXTURE0 + GLenum(which));
        gl.BindTexture(GL_TEXTURE_2D, names_[which]);
        for (std::size_t i = first; i < maps.levels.size(); ++i) {
            const MapLevel& level = maps.levels[i];
            const int at = int(i - first);
            if (which == 0)
                upload(gl, at, level.size, format_of(wanted.cones ? 2 : 1, wanted.wide_heights),
                       height_texels(level, wanted.wide_heights, wanted.cones ? &cones[i - first] : nullptr).data());
            else if (which == 1)
                upload(gl, at, level.size, {GL_RG8_SNORM, GL_RG, GL_BYTE}, normal_texels(level).data());
            else
                upload(gl, at, level.size, format_of(maps.channels(), false), level.shares.data());
        }
        // Around a map that ends lies level ground, which needs no cone.
        const double range = maps.lowest - maps.highest;
        const GLfloat outer = which == 0 && range > 0.0 ? GLfloat((maps.lowest - maps.outer) / range) : 0.0f;
        filter(gl, maps.repeat, which == 0 ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR, {outer, which == 0 ? 1.0f : 0.0f, 0.0f, 0.0f});
    }
}

RivalMaps::~RivalMaps() { gl_.DeleteTextures(3, names_); }

void RivalMaps::bind(const gl::Program& program) const {
    constexpr const char* kNames[] = {"heights", "normals", "shares"};
    for (int which = 0; which < 3; ++which) {
        gl_.ActiveTexture(GL_TEXTURE0 + GLenum(which));
        gl_.BindTexture(GL_TEXTURE_2D, names_[which]);
        program.set(kNames[which], which);
    }
    program.set("metres", float(maps_.metres.x), float(maps_.metres.y));
    program.set("texels", float(size_), float(size_));
    program.set("drops", float(maps_.highest), float(maps_.lowest));
    program.set("widest", float(kWidestCone));
    bind_paints(program, maps_.paints);
}

void bind_paints(const gl::Program& program, const std::vector<MapPaint>& paints) {
    for (std::size_t k = 0; k < kMostPaints; ++k) {
        const MapPaint& paint = paints[k < paints.size() ? k : 0];
        const auto named = [k](std::string name) { return name.append("[").append(std::to_string(k)).append("]"); };
        program.set(named("albedos").c_str(), paint.albedo[0], paint.albedo[1], paint.albedo[2]);
        program.set(named("metal_rough").c_str(), paint.metallic, paint.roughness);
    }
}

}  // namespace burin::rivals
