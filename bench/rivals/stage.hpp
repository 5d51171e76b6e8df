// One scene and one view of it in an open context, on which burin and its rivals take turns.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>

#include <runtime/image_error.hpp>
#include <runtime/subject.hpp>
#include <runtime/truth_picture.hpp>

#include "rival.hpp"

namespace burin::rivals {

// What one way of drawing came to.
struct Trial {
    double decibels = 0.0;  // against the truth, over the pixels that meet a feature
    double milliseconds = 0.0;  // processor time of a picture; programs, textures and meshes were there already
};

// What the ground of a part is made of.
MapPaint paint_of(const scenes::Part& part);
// The rectangle that a view shows, in uv, of what lies `drop` metres below the object surface or less.
bench::Extent seen_extent(const bench::PlaneView& view, Vec2 size, double drop);

// Maps of a scene, made when first asked for.
class SceneMaps {
  public:
    // `finest`: texels per side. All must outlive it.
    SceneMaps(const gl::Context& context, const bench::Subject& subject, int finest, const std::string& cache);
    const SurfaceMaps& surface() const { return maps_; }
    // In the context: of that size, with cones if the technique asks for them.
    const RivalMaps& maps_for(const RivalSettings& settings);

  private:
    const gl::Context& context_;
    std::string cache_, key_;
    SurfaceMaps maps_;
    std::map<std::array<int, 3>, std::unique_ptr<RivalMaps>> made_;
};

// Anything that draws the picture once.
using Draw = std::function<gl::Accumulator()>;
double time_once(const Draw& draw);  // milliseconds of processor time
// burin itself, loaded and with its programs built. Context and asset must outlive it.
Result<Draw> prepare_burin(const gl::Context& context, const Asset& asset, const RenderOptions& options);

class Stage {
  public:
    // All must outlive it.
    Stage(const gl::Context& context, const bench::Subject& subject, SceneMaps& maps, const bench::PlaneView& view, const std::string& cache);

    const bench::PlaneView& view() const { return view_; }
    const bench::TruthPicture& truth() const { return truth_; }
    bool shows_features() const;
    bool shows_outline() const;  // the plane ends within the picture
    const RenderOptions& options() const { return options_; }
    const Asset& asset() const { return asset_; }
    MapBytes bytes_of(const RivalSettings& settings) const { return rivals::bytes_of(settings, maps_.surface()); }
    double pixel_in_uv() const;  // at the place looked at

    // Ready to be drawn: what is loaded once is loaded.
    Result<Draw> rival(const RivalSettings& settings);
    // That a ready rival draws. Requires: rival(settings) went well.
    std::size_t triangles_of(const RivalSettings& settings) const { return rivals_.at(key_of(settings))->asset.primitives[0].indices.size() / 3; }
    Result<Draw> burin(const std::function<void(RenderOptions&)>& apply);

    // Draws once.
    Trial measure(const Draw& draw) const;
    RgbaImage picture(const Draw& draw) const { return draw().image(); }

  private:
    // Of a technique, and for triangles of the distance of their vertices.
    Result<Rival*> rival_of(const RivalSettings& settings);
    static std::pair<int, double> key_of(const RivalSettings& settings) {
        return {int(settings.technique), settings.technique == Technique::triangles ? settings.edge : 0.0};
    }

    const gl::Context& context_;
    const bench::Subject& subject_;
    SceneMaps& maps_;
    bench::PlaneView view_;
    bench::TruthPicture truth_;
    Asset asset_;       // with burin's textures
    RenderOptions options_;
    struct Drawn {
        Asset asset;
        std::optional<Rival> rival;
    };
    std::map<std::pair<int, double>, std::unique_ptr<Drawn>> rivals_;
};

}  // namespace burin::rivals
