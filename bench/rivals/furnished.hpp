// A scene of many parts, each on its own triangles, as the rivals draw it: maps of every part, one program for all.
//
//     Scene + Asset --[FurnishedScene::prepare]--> FurnishedScene;    + RivalSettings --[draw]--> Draw
#pragma once

#include <deque>

#include "stage.hpp"

namespace burin::rivals {

class FurnishedScene {
  public:
    // `asset`: of the scene, one material for each part in their order; `finest`: texels per side of the finest maps. Context, asset
    // and scene must outlive it. Fails as prepare_subject does.
    static Result<FurnishedScene> prepare(const gl::Context& context, const scenes::Scene& scene, const Asset& asset, const RenderOptions& options,
                                          int finest, const std::string& cache);

    // Ready to be drawn. `outlines` as in Rival::load. Requires: a technique other than triangles, which would need a finer mesh.
    Result<Draw> draw(const RivalSettings& settings, bool outlines);
    // Of the maps of all parts.
    MapBytes bytes_of(const RivalSettings& settings) const;

  private:
    FurnishedScene(const gl::Context& context, const Asset& asset, const RenderOptions& options) : context_(&context), asset_(&asset), options_(options) {}

    const gl::Context* context_;
    const Asset* asset_;
    RenderOptions options_;
    std::deque<SceneMaps> maps_;  // of each part
    std::map<std::pair<Technique, bool>, std::shared_ptr<Rival>> rivals_;
};

// The best that a technique does with its samples: the mip bias and the places of least error, then the fewest steps, texels and bits that
// lose no more than a twentieth of a decibel in all. `settings`: ample ones. `decibels_of` draws once.
RivalSettings tune_rival(RivalSettings settings, const std::function<double(const RivalSettings&)>& decibels_of);

}  // namespace burin::rivals
