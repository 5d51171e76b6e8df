// An asset in an open context, to be drawn any number of times: for whoever measures, or draws the next frame.
//
//     Context + Asset --[PreparedAsset::load]--> PreparedAsset --[draw]--> Accumulator
#pragma once

#include <memory>

#include "gl/accumulator.hpp"
#include "gl/context.hpp"
#include "gl/render.hpp"

namespace burin::gl {

class PreparedAsset {
  public:
    // Meshes and textures go to the context; it and the asset must outlive what is made. Fails as render_asset does.
    static Result<PreparedAsset> load(const Context& context, const Asset& asset, const RenderOptions& options);
    PreparedAsset(PreparedAsset&& other) noexcept;
    PreparedAsset& operator=(PreparedAsset&&) = delete;
    ~PreparedAsset();

    // The picture that render_asset shows. Programs are built by the first call.
    Result<Accumulator> draw();

  private:
    struct State;
    explicit PreparedAsset(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace burin::gl
