// Pictures by the truth: every sample a ray in double precision, shaded by the formula of gl/surface.frag written anew.
#pragma once

#include <string>

#include "subject.hpp"

namespace burin::bench {

struct TruthPicture {
    int width = 0, height = 0;
    std::vector<float> linear;          // three per pixel: the mean over its samples
    std::vector<std::uint8_t> feature;  // 1: the footprint meets a feature or a shadow's edge, and lies on the mesh
};

// What one sample sees.
struct TruthSample {
    std::array<double, 3> color;  // linear, clamped to [0, 1] as the shader's are
    std::uint64_t what = 0;       // equal for samples of like facets in the same light
    bool feature = false;         // met something that is not the ground
};

// What a facet looks like.
struct Look {
    std::array<double, 3> albedo;
    double metallic, roughness;
};
// Of the part, or of a material of its own.
Look look_of(const scenes::Part& part, const Material* own);
// Towards the lamp.
std::array<double, 3> direction_to(const Light& light);
// The formula of the shader, written anew. All directions are of unit length, y up.
std::array<double, 3> shade(const Look& look, const Light& light, const std::array<double, 3>& to_light, const std::array<double, 3>& normal,
                            const std::array<double, 3>& to_eye, bool lit);
// Linear, each channel: what is seen where no mesh is.
double background_color();

// A pattern on its plane in one light, ready for samples.
class TruthScene {
  public:
    TruthScene(const Subject& subject, const PlaneView& view, const Extent& extent);
    // x and y in pixels from the upper left corner of the picture.
    TruthSample sample(double x, double y) const;

  private:
    Look look_at(std::uint32_t element) const;
    bool in_shadow(const RayHit& hit) const;

    ResolvedPattern pattern_;
    Truth truth_;
    const scenes::Part& part_;
    PlaneView view_;
    PlaneCamera camera_;
    Extent extent_;
    std::array<double, 3> light_;  // towards it
};

// 16 samples in every pixel, 64 beside something else, and 256 where these do not all see facets of one kind in the same light
// and colour. `cache`: folder of pictures drawn before, "" for none. Cost: about 10 us a sample and core.
TruthPicture draw_truth(const Subject& subject, const PlaneView& view, const std::string& cache);

double to_srgb(double linear);

}  // namespace burin::bench
