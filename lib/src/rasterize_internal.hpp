// Internal to lib: the parts of stage rasterize.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <burin/rasterize.hpp>

#include "evaluate_prepare.hpp"

namespace burin::rasterizing {

using namespace truth;
using Prepared = Truth::Prepared;

constexpr int kBucket = 8;  // texels per side; smaller ones cost more to fill than they save

// One tile image of an element, over a block of texels.
struct Entry {
    const PreparedElement* element;
    Vec2 shift;
    bool inside;         // it lies to every texel of the block as Nearness::inside says
    double guess = -1.0;  // a curve's parameter near the feet of all points of the block, when they lie on one arc of it
};

// Texels [x, x + side) x [y, y + side) of the map; at its border some of them may lie beyond it.
struct Block {
    int x = 0, y = 0, side = kBucket;
};

// How an element lies to a texel: it acts nowhere in it; everywhere, by the offset from its path alone; or in part of it.
enum class Nearness { absent, inside, partly };

// What an element does over a whole texel.
enum class Cover { absent, plane, mixed };
struct Plane {
    double middle = 0;         // height at the texel's centre, corrected so that it is the mean
    double low = 0, high = 0;  // bounds over the texel
    bool internal = false;
    Vec2 slope;
};

// Between which heights an element stays over a block, where it acts.
struct Bounds {
    bool known = false;        // it acts by its offset alone, and the ground is that of its side
    bool everywhere = false;   // and acts at all of the block
    bool any_internal = true;  // it may cut
    double low = 0, high = 0;
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

// The levels of some rows of texels.
struct LevelRows {
    int x = 0, y = 0;                             // of the first texel
    std::vector<std::vector<TexelRun>> runs;      // by row
    std::vector<std::vector<std::uint32_t>> run;  // by row and texel, an index into runs

    const TexelRun& at(int texel_x, int texel_y) const {
        const auto row = static_cast<std::size_t>(texel_y - y);
        return runs[row][run[row][static_cast<std::size_t>(texel_x - x)]];
    }
    // Whether [x0, x1) x [y0, y1) has one level.
    bool one_level(int x0, int y0, int x1, int y1) const;
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
    bool is_plain(const PreparedElement& e) const;
    void draw_bucket_row(int row, Image& image) const;
    void draw_block(const Block& block, const std::vector<Entry>& above, const LevelRows& levels, Image& image) const;
    void split_block(const Block& block, const std::vector<Entry>& entries, const LevelRows& levels, Image& image) const;
    void fill_block(const Block& block, const Plane& plane, Image& image) const;
    bool fill_with_plane(const Block& block, const std::vector<Acting>& acting, double ground, Image& image) const;
    void find_acting(const Block& block, const std::vector<Entry>& above, std::vector<Acting>& acting) const;
    void drop_hidden(const Block& block, double ground, std::vector<Acting>& acting) const;
    Bounds bounds_of(const Block& block, const Acting& acting, double ground) const;
    float draw_texel(int x, int y, const std::vector<Entry>& bucket, const TexelRun& run) const;

    std::vector<TexelRun> find_levels(int y) const;
    LevelRows find_level_rows(int y0, int y1) const;
    void cross_row(const Entry& entry, double y, std::vector<RowCrossing>& crossings) const;
    std::vector<SampleRun> find_runs(double y, std::vector<RowCrossing>& crossings) const;

    Foot foot_of(const Entry& entry, Vec2 p) const;
    double guess_of(const PreparedElement& e, const Foot& foot, double radius) const;
    Nearness nearness_of(const Entry& entry, Vec2 centre, double radius, Foot& foot) const;
    bool find_bend(const PreparedElement& e, const Foot& foot, double most, double& bend) const;
    Cover cover_by_offset(const PreparedElement& e, const Foot& foot, double ground, int side, Plane& plane) const;
    bool merge_planes(const std::vector<Plane>& planes, double ground, Plane& ruler) const;
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
    TexelRegion asked_, region_;  // the latter whole blocks
    Vec2 texel_;     // metres per texel
    double radius_;  // half the diagonal of a texel
    std::vector<Vec2> around_;  // the samples of a texel, from its centre
    Vec2 spread_;    // mean square distance of the samples from the centre, per axis
    int first_column_ = 0, last_column_ = 0, first_row_ = 0, last_row_ = 0;
    std::vector<double> bows_;  // by element: a curve's greatest curvature
    std::vector<std::vector<Entry>> buckets_;
    std::vector<std::vector<Entry>> step_rows_;  // step path lines over each row of buckets
};

inline bool near_box(const Box& box, Vec2 p, double radius) {
    return p.x + radius >= box.low.x && p.y + radius >= box.low.y && p.x - radius <= box.high.x &&
           p.y - radius <= box.high.y;
}

}  // namespace burin::rasterizing
