// A part of a scene as an asset to draw.
#pragma once

#include <utility>

#include <gtest/gtest.h>

#include "../../samples/scenes/build.hpp"
#include "../../samples/scenes/scenes.hpp"
#include "../../samples/write_scene.hpp"
#include "../judge/judge.hpp"

namespace burin::testing {

inline Asset asset_of(const scenes::Part& part) {
    auto prepared = prepare_pattern(part.pattern, {});
    EXPECT_TRUE(prepared.ok());
    MaterialInfo material = scenes::material_of(part);
    put_pattern(*prepared, material);
    Primitive primitive;
    primitive.positions = part.mesh.positions;
    primitive.normals = part.mesh.normals;
    primitive.uvs = part.mesh.uvs;
    primitive.indices = part.mesh.indices;
    Asset asset;
    asset.materials.push_back(std::move(material));
    asset.primitives.push_back(std::move(primitive));
    return asset;
}

}  // namespace burin::testing
