// What the makers of scenes share.
#pragma once

#include <utility>

#include "drawing.hpp"
#include "meshes.hpp"
#include "scenes.hpp"

namespace burin::scenes {

// A pattern without paths: `high` above and `deep` below its ground.
inline Pattern sheet(Vec2 size, double deep, double high, Wrap wrap = Wrap::repeat) {
    Pattern pattern;
    pattern.size = size;
    pattern.depth = deep + high;
    pattern.base_offset = high;
    pattern.wrap = wrap;
    return pattern;
}

// The pattern on the plane that is as large as its tile.
inline Scene on_plane(Pattern pattern, std::array<float, 3> color, float metallic, float roughness) {
    Scene scene;
    const Vec2 size = pattern.size;
    scene.parts.push_back({"plane", std::move(pattern), make_rectangle(size), color, metallic, roughness});
    return scene;
}

}  // namespace burin::scenes
