// Internal to lib: the parts of stage rasterize.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <burin/rasterize.hpp>

#include "evaluate_prepare.hpp"

namespace burin::rasterizing {

using namespace truth;
using Prepared = Truth::Prepared;

constexpr int kBucket = 8;  // texels per side; smaller ones cost more to fill than they save

// One tile image of an element, over a bucket.
struct Entry {
    const PreparedElement* element;
    Vec2 shift;
    bool inside;  // it lies to every texel of the bucket as Nearness::inside says
};

// How an element lies to a texel: it acts nowhere in it; everywhere, by the offset from its path alone; or in part of it.
enum class Nearness { absent, inside, partly };

// What an element does over a whole texel.
enum class Cover { absent, plane, mixed };
struct Plane {
    double middle = 0;         // height at the texel's centre, corrected so that it is the mean
    double low = 0, high = 0;  // bounds over the texel
    bool internal = false;
};

// A line, or a curve of gentle bend, over a texel: its offset and the place along it at the texel's centre, and how they
// grow.
struct Strip {
    const PreparedElement* element = nullptr;
    double offset = 0, parameter = 0;
    Vec2 normal;
    double bend = 0;  // of the offset, along the path
    // The ends that rule in a part of the texel, and where its centre lies to them.
    struct End {
        const PreparedEnd* end = nullptr;
        double along = 0, across_clip = 0;
    };
    End ends[2];
    int end_count = 0;
};

// Where a row of samples crosses a step path line, and the levels to both sides in x.
struct RowCrossing {
    double x, before, after;
};

// Samples up to `end` of a row of samples, of one level.
struct SampleRun {
    int end;
    double level;
};

// Texels up to `end` of a row of texels, of one level; or a single texel of several, one for each of its samples.
struct TexelRun {
    int end;
    double level;
    std::vector<double> levels;

    double level_of(std::size_t sample) const { return levels.empty() ? level : levels[sample]; }
};

// An element that acts in a texel, and where the texel's centre lies to it.
struct Acting {
    Entry entry;
    Foot foot;
    bool inside;  // see Nearness
};

// Of a texel: the ground or what was added to it, and the lowest cut.
struct Samples {
    std::vector<double> bases, cuts;

    void add(std::size_t k, double z, bool internal) {
        bases[k] = std::max(bases[k], z);
        if (internal) cuts[k] = std::min(cuts[k], z);
    }
};

class Rasterizer {
  public:
    Rasterizer(const ResolvedPattern& pattern, int width, int height, const RasterizeOptions& options);
    Image run();

  private:
    int bucket_columns() const { return last_column_ - first_column_ + 1; }
    Vec2 texel_centre(int x, int y) const { return {(x + 0.5) * texel_.x, (y + 0.5) * texel_.y}; }

    void fill_buckets();
    void fill_step_rows();
    bool can_act(const PreparedElement& e, Vec2 p, double radius) const;
    bool acts_by_offset(const PreparedElement& e, Vec2 p, double radius) const;
    void draw_bucket_row(int row, Image& image) const;
    void draw_texel_row(int y, Image& image) const;
    float draw_texel(int x, int y, const std::vector<Entry>& bucket, const TexelRun& run) const;

    std::vector<TexelRun> find_levels(int y) const;
    void cross_row(const Entry& entry, double y, std::vector<RowCrossing>& crossings) const;
    std::vector<SampleRun> find_runs(double y, std::vector<RowCrossing>& crossings) const;

    Nearness nearness_of(const Entry& entry, Vec2 centre, Foot& foot) const;
    bool find_bend(const PreparedElement& e, const Foot& foot, double most, double& bend) const;
    Cover cover_by_offset(const PreparedElement& e, const Foot& foot, double ground,
                          Plane& plane) const;
    bool merge_planes(const std::vector<Plane>& planes, double ground, double& mean) const;
    bool make_strip(const PreparedElement& e, Vec2 p, const Foot& foot, bool inside, Strip& strip) const;
    void sample_strip(const Strip& strip, const TexelRun& run, Samples& samples) const;
    void sample_entry(const Entry& entry, Vec2 centre, const TexelRun& run, Samples& samples) const;
    double mean_of_samples(Vec2 centre, const std::vector<Acting>& acting, const TexelRun& run) const;
    double mean_of_surface(Vec2 centre, const std::vector<Acting>& acting, const TexelRun& run) const;
    // Rays begin at the object surface and end at the deepest point: a reader sees nothing beyond.
    double seen(double z) const { return std::clamp(z, base_offset_ - truth_.depth, base_offset_); }
    float value_of(double z) const {
        return static_cast<float>(1.0 + (seen(z) - base_offset_) / truth_.depth);
    }

    Truth owner_;
    const Prepared& truth_;
    double base_offset_;
    int width_, height_, samples_, threads_;
    double tolerance_;
    TexelRegion region_;
    Vec2 texel_;     // metres per texel
    double radius_;  // half the diagonal of a texel
    std::vector<Vec2> around_;  // the samples of a texel, from its centre
    Vec2 spread_;    // mean square distance of the samples from the centre, per axis
    int first_column_ = 0, last_column_ = 0, first_row_ = 0, last_row_ = 0;
    std::vector<std::vector<Entry>> buckets_;
    std::vector<std::vector<Entry>> step_rows_;  // step path lines over each row of buckets
};

inline bool near_box(const Box& box, Vec2 p, double radius) {
    return p.x + radius >= box.low.x && p.y + radius >= box.low.y && p.x - radius <= box.high.x &&
           p.y - radius <= box.high.y;
}

}  // namespace burin::rasterizing
