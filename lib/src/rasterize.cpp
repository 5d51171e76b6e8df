// Box-filtered height map of a pattern, asked from the truth's own rules for where elements act.
//
// Speed comes from three things, none of which changes the result: buckets of texels list the elements that
// can act there; the ground of a row of samples comes from its crossings with step path lines; and texels
// over which the surface is one plane are sampled once. Buckets lie at multiples of kBucket texels of the
// whole map, so that a region is computed exactly as the same part of the whole.
#include <burin/rasterize.hpp>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <thread>

#include "evaluate_prepare.hpp"

namespace burin {
namespace {

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

// A line that acts everywhere in a texel: its offset at the texel's centre, and how that grows.
struct Strip {
    const PreparedElement* element;
    double offset;
    Vec2 normal;
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
    Cover cover_by_offset(const PreparedElement& e, Vec2 p, const Foot& foot, double ground,
                          Plane& plane) const;
    bool merge_planes(const std::vector<Plane>& planes, double ground, double& mean) const;
    void sample_strip(const Strip& strip, const TexelRun& run, std::vector<double>& bases, std::vector<double>& cuts) const;
    double mean_of_strips(const std::vector<Strip>& strips, const TexelRun& run) const;
    double mean_of_samples(int x, int y, const std::vector<Entry>& entries, const TexelRun& run, bool height_field) const;
    double sample(const std::vector<Entry>& entries, Vec2 p, double ground) const;
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

Rasterizer::Rasterizer(const ResolvedPattern& pattern, int width, int height, const RasterizeOptions& options)
    : owner_(pattern, TruthOptions{.level_tolerance = options.level_tolerance}),
      truth_(owner_.prepared()),
      base_offset_(pattern.base_offset),
      width_(width),
      height_(height),
      samples_(options.samples),
      threads_(options.threads),
      tolerance_(options.curve_tolerance * pattern.depth),
      region_(options.region) {
    assert(width >= 1 && height >= 1 && samples_ >= 1 && samples_ <= 64);
    if (region_.width == 0) region_ = {0, 0, width, height};
    assert(region_.x >= 0 && region_.y >= 0 && region_.height >= 1);
    assert(region_.x + region_.width <= width && region_.y + region_.height <= height);
    texel_ = {truth_.size.x / width, truth_.size.y / height};
    radius_ = 0.5 * length(texel_);
    const double share = (1.0 - 1.0 / (samples_ * samples_)) / 12.0;
    spread_ = {texel_.x * texel_.x * share, texel_.y * texel_.y * share};
    for (int j = 0; j < samples_; ++j)
        for (int i = 0; i < samples_; ++i)
            around_.push_back({((i + 0.5) / samples_ - 0.5) * texel_.x, ((j + 0.5) / samples_ - 0.5) * texel_.y});
    first_column_ = region_.x / kBucket;
    last_column_ = (region_.x + region_.width - 1) / kBucket;
    first_row_ = region_.y / kBucket;
    last_row_ = (region_.y + region_.height - 1) / kBucket;
}

// ---- buckets
// -------------------------------------------------------------------------------------------------

bool near_box(const Box& box, Vec2 p, double radius) {
    return p.x + radius >= box.low.x && p.y + radius >= box.low.y && p.x - radius <= box.high.x &&
           p.y - radius <= box.high.y;
}

// False only where the element acts at no point within `radius` of p.
bool Rasterizer::can_act(const PreparedElement& e, Vec2 p, double radius) const {
    const double slack = radius * (1.0 + 1e-9);
    if (!near_box(e.box, p, slack)) return false;
    for (const PreparedEnd& end : e.ends) {
        const bool stops = end.priority == Priority::none;
        const bool clips = end.priority == Priority::both && end.end == EndShape::clip;
        if (stops && dot(p - end.vertex, end.outward) > slack) return false;
        if (clips && dot(p - end.vertex, end.clip_inward) < -slack) return false;
    }
    // b' is never nearer to 0 than b, and b changes no faster than p.
    return std::abs(truth::find_foot(e, p).offset) <= e.reach + slack;
}

// True only where the element acts at all points within `radius` of p, as far as its reach goes, with b' = b.
bool Rasterizer::acts_by_offset(const PreparedElement& e, Vec2 p, double radius) const {
    if (e.scaled || !truth_.profiles[e.profile].height_field || !(e.width0 > 0.0)) return false;
    for (const PreparedEnd& end : e.ends) {
        const double a = dot(p - end.vertex, end.outward), c = dot(p - end.vertex, end.clip_inward);
        const bool stops = end.priority == Priority::none, ends = end.priority == Priority::both;
        // A clip lets b' = b also beyond the end.
        const bool clear = ends && end.end == EndShape::clip ? c > radius : a < -radius && (stops || ends || c > radius);
        if (!clear) return false;
    }
    return true;
}

void Rasterizer::fill_buckets() {
    const Vec2 side = texel_ * kBucket;
    const double radius = 0.5 * length(side);
    buckets_.assign(
        static_cast<std::size_t>(bucket_columns()) * static_cast<std::size_t>(last_row_ - first_row_ + 1),
        {});
    const Vec2 low{first_column_ * side.x, first_row_ * side.y};
    const Vec2 high{(last_column_ + 1) * side.x, (last_row_ + 1) * side.y};
    for (const PreparedElement& e : truth_.elements)
        truth::for_each_image(truth_, e.box, low, high, [&](Vec2 shift) {
            const auto cell = [](double x, int first, int last) {
                return static_cast<int>(
                    std::clamp(std::floor(x), static_cast<double>(first), static_cast<double>(last)));
            };
            const int x0 = cell((e.box.low.x + shift.x) / side.x - 1e-6, first_column_, last_column_);
            const int x1 = cell((e.box.high.x + shift.x) / side.x + 1e-6, first_column_, last_column_);
            const int y0 = cell((e.box.low.y + shift.y) / side.y - 1e-6, first_row_, last_row_);
            const int y1 = cell((e.box.high.y + shift.y) / side.y + 1e-6, first_row_, last_row_);
            for (int y = y0; y <= y1; ++y) {
                for (int x = x0; x <= x1; ++x) {
                    const Vec2 centre{(x + 0.5) * side.x, (y + 0.5) * side.y};
                    if (!can_act(e, centre - shift, radius)) continue;
                    buckets_[static_cast<std::size_t>(y - first_row_) *
                                 static_cast<std::size_t>(bucket_columns()) +
                             static_cast<std::size_t>(x - first_column_)]
                        .push_back({&e, shift, acts_by_offset(e, centre - shift, radius)});
                }
            }
        });
}

// Path lines over the whole width, also for a region: the levels of a row come from all its crossings.
void Rasterizer::fill_step_rows() {
    const double side = texel_.y * kBucket;
    step_rows_.assign(static_cast<std::size_t>(last_row_ - first_row_ + 1), {});
    for (const std::uint32_t index : truth_.steps) {
        const PreparedElement& e = truth_.elements[index];
        for (int row = first_row_; row <= last_row_; ++row)
            truth::for_each_image(
                truth_, e.box, {0.0, row * side}, {truth_.size.x, (row + 1) * side}, [&](Vec2 shift) {
                    step_rows_[static_cast<std::size_t>(row - first_row_)].push_back({&e, shift, false});
                });
    }
}

// ---- ground of a row
// -----------------------------------------------------------------------------------------

// Pieces of the path line that are monotone in y, each open at its lower end: touching vertices count twice
// or not.
void Rasterizer::cross_row(const Entry& entry, double y, std::vector<RowCrossing>& crossings) const {
    const PreparedElement& e = *entry.element;
    const double bend = e.bend.y, edge = e.edge.y, start = e.p0.y + entry.shift.y;
    double cuts[3] = {0.0, 1.0, 1.0};
    if (e.kind == ElementKind::quadratic && bend != 0.0 && -edge / bend > 0.0 && -edge / bend < 1.0)
        cuts[1] = -edge / bend;
    const auto place = [&](double u) { return truth::point_on(e, u) + entry.shift; };
    for (int i = 0; i < 2 && cuts[i] < 1.0; ++i) {
        double low = cuts[i], high = cuts[i + 1];
        if ((place(low).y <= y) == (place(high).y <= y)) continue;
        double roots[2];
        const int n = e.kind == ElementKind::line
                          ? truth::solve_quadratic(0.0, e.p2.y - e.p0.y, start - y, roots)
                          : truth::solve_quadratic(bend, 2.0 * edge, start - y, roots);
        double u = 0.5 * (low + high), miss = 1e300;
        for (int k = 0; k < n; ++k) {
            const double outside = std::max({0.0, low - roots[k], roots[k] - high});
            if (outside < miss) miss = outside, u = std::clamp(roots[k], low, high);
        }
        // Beyond the crossing, in x, lies the side that n points to when n.x > 0. The whole piece rises or
        // falls in y, so its ends say which.
        const bool right_after = place(high).y < place(low).y;
        crossings.push_back({place(u).x, right_after ? e.left_level : e.right_level,
                             right_after ? e.right_level : e.left_level});
    }
}

// Levels at the samples of one row. Where neighbouring crossings do not agree (they touch) the truth is
// asked.
std::vector<SampleRun> Rasterizer::find_runs(double y, std::vector<RowCrossing>& crossings) const {
    std::erase_if(crossings, [&](const RowCrossing& c) { return c.x < 0.0 || c.x > truth_.size.x; });
    std::sort(crossings.begin(), crossings.end(), [](const RowCrossing& a, const RowCrossing& b) {
        return a.x != b.x ? a.x < b.x : a.before < b.before;
    });
    std::vector<SampleRun> runs;
    const double pitch = texel_.x / samples_;
    const int first = region_.x * samples_, count = region_.width * samples_;
    int at = 0;
    for (std::size_t i = 0; i <= crossings.size() && at < count; ++i) {
        const bool open_start = i == 0, open_end = i == crossings.size();
        const double from = open_start ? 0.0 : crossings[i - 1].x,
                     to = open_end ? truth_.size.x : crossings[i].x;
        int end = open_end
                      ? count
                      : static_cast<int>(std::ceil(std::clamp(to / pitch - 0.5 - first, 0.0, 1.0 * count)));
        if (end <= at) continue;
        double level = open_start ? truth_.outer_level : crossings[i - 1].after;
        const bool tie = i > 1 && from - crossings[i - 2].x < 1e-9 * truth_.size.x;
        const bool closed = !open_start && !open_end;
        const bool differ = closed && std::abs(level - crossings[i].before) > truth_.level_tolerance;
        if (open_start && !open_end) level = crossings[i].before;
        const bool next_tie = i + 1 < crossings.size() && crossings[i + 1].x - to < 1e-9 * truth_.size.x;
        if ((open_start && open_end) || differ || (open_end && tie) || (open_start && next_tie))
            level = owner_.ground_at({0.5 * (from + to), y});
        runs.push_back({end, level});
        at = end;
    }
    return runs;
}

// Levels of texel row y, from those of its rows of samples.
std::vector<TexelRun> Rasterizer::find_levels(int y) const {
    if (truth_.steps.empty()) return {{region_.width, truth_.outer_level, {}}};
    std::vector<RowCrossing> crossings;
    std::vector<std::vector<SampleRun>> rows;
    for (int s = 0; s < samples_; ++s) {
        const double v = (y + (s + 0.5) / samples_) * texel_.y;
        crossings.clear();
        for (const Entry& entry : step_rows_[static_cast<std::size_t>(y / kBucket - first_row_)])
            cross_row(entry, v, crossings);
        rows.push_back(find_runs(v, crossings));
    }
    std::vector<TexelRun> texels;
    std::vector<std::size_t> at(rows.size(), 0);
    for (int x = 0; x < region_.width;) {
        int end = region_.width;  // as far as all rows have one level
        for (std::size_t j = 0; j < rows.size(); ++j) {
            while (rows[j][at[j]].end <= x * samples_) ++at[j];
            const SampleRun& run = rows[j][at[j]];
            end = run.level == rows[0][at[0]].level ? std::min(end, run.end / samples_) : x;
        }
        if (end > x) {
            texels.push_back({end, rows[0][at[0]].level, {}});
            x = end;
            continue;
        }
        TexelRun mixed{++x, rows[0][at[0]].level, {}};
        for (std::size_t j = 0; j < rows.size(); ++j)
            for (int i = (x - 1) * samples_; i < x * samples_; ++i) {
                while (rows[j][at[j]].end <= i) ++at[j];
                mixed.levels.push_back(rows[j][at[j]].level);
            }
        texels.push_back(std::move(mixed));
    }
    return texels;
}

// ---- one texel
// -----------------------------------------------------------------------------------------------

// With b' = b over the whole texel: which facets it meets, and how much a curve bends the plane.
Cover Rasterizer::cover_by_offset(const PreparedElement& e, Vec2 p, const Foot& foot, double ground,
                                  Plane& plane) const {
    const PreparedProfile& profile = truth_.profiles[e.profile];
    const double width = e.width0, height = e.height0;
    const Vec2 t = truth::tangent_on(e, foot.parameter), n = normal_of(t);
    double reach = 0.5 * (std::abs(n.x) * texel_.x + std::abs(n.y) * texel_.y), bend = 0.0;
    if (e.kind == ElementKind::quadratic) {
        // Second derivative of b along t: -k / (1 - k b), k the curvature.
        const Vec2 d = e.edge + e.bend * foot.parameter;
        const double l = length(d), k = l > 0.0 ? cross(d, e.bend) / (2.0 * l * l * l) : 1e300;
        const double inside = 1.0 - k * foot.offset;
        if (!(inside > 0.0) || std::abs(k) * radius_ > 0.1 * inside) return Cover::mixed;
        bend = -k / inside;
        reach += 0.6 * std::abs(bend) * radius_ * radius_;
        static_cast<void>(p);
    }
    const double low = (foot.offset - reach) / width, high = (foot.offset + reach) / width;
    if (high < profile.low || low > profile.high) return Cover::absent;
    if (e.step && std::abs(foot.offset) <= reach) return Cover::mixed;
    const double side = foot.offset < 0.0 ? e.left_level : e.right_level;
    if (std::abs(ground - side) > truth_.level_tolerance) return Cover::absent;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
        if (low < profile.points[i].b || high > profile.points[i + 1].b) continue;
        const double slope = height * profile.slope[i] / width;
        const double h =
            height * (profile.points[i].h + profile.slope[i] * (foot.offset / width - profile.points[i].b));
        const double correction = 0.5 * slope * bend * (t.x * t.x * spread_.x + t.y * t.y * spread_.y);
        if (correction != 0.0 && !(std::abs(correction * bend) * radius_ < tolerance_)) return Cover::mixed;
        plane.middle = e.level + h + correction;
        plane.low = e.level + h - std::abs(slope) * reach;
        plane.high = e.level + h + std::abs(slope) * reach;
        plane.internal = (profile.internal_mask >> i) & 1u;
        return Cover::plane;
    }
    return Cover::mixed;
}

Nearness Rasterizer::nearness_of(const Entry& entry, Vec2 centre, Foot& foot) const {
    const PreparedElement& e = *entry.element;
    const Vec2 p = centre - entry.shift;
    const double r = radius_ * (1.0 + 1e-9);
    if (entry.inside && e.kind == ElementKind::line) {
        foot = {dot(p - e.p0, normal_of(e.tangent)), 0.5};
        return std::abs(foot.offset) > e.reach + r ? Nearness::absent : Nearness::inside;
    }
    if (!near_box(e.box, p, r)) return Nearness::absent;
    foot = truth::find_foot(e, p);
    if (std::abs(foot.offset) > e.reach + r) return Nearness::absent;
    if (entry.inside) return Nearness::inside;
    for (const PreparedEnd& end : e.ends) {
        const double a = dot(p - end.vertex, end.outward), c = dot(p - end.vertex, end.clip_inward);
        const bool stops = end.priority == Priority::none;
        const bool caps = end.priority == Priority::both && end.end != EndShape::clip;
        const bool clips = end.priority == Priority::both && end.end == EndShape::clip;
        if (stops && a > r) return Nearness::absent;
        if (clips && c < -r) return Nearness::absent;
        if (caps && a > e.reach + r) return Nearness::absent;
    }
    return acts_by_offset(e, p, r) ? Nearness::inside : Nearness::partly;
}

// min(max(ground, adds), cuts) where one plane rules over the whole texel; false where planes cross in it.
bool Rasterizer::merge_planes(const std::vector<Plane>& planes, double ground, double& mean) const {
    Plane base{ground, ground, ground, false};
    for (const Plane& plane : planes) {  // highest base
        if (plane.low >= base.high)
            base = plane;
        else if (plane.high > base.low)
            return false;
    }
    Plane cut{1e300, 1e300, 1e300, true};
    for (const Plane& plane : planes) {  // lowest cut
        if (!plane.internal) continue;
        if (plane.high <= cut.low)
            cut = plane;
        else if (plane.low < cut.high)
            return false;
    }
    if (cut.low < base.high && cut.high > base.low && !(cut.middle == base.middle && cut.low == base.low))
        return false;
    mean = std::min(base.middle, cut.middle);
    return true;
}

double Rasterizer::sample(const std::vector<Entry>& entries, Vec2 p, double ground) const {
    double base = ground, cut = 1e300;
    Local local;
    for (const Entry& entry : entries) {
        const PreparedElement& e = *entry.element;
        if (!near_box(e.box, p - entry.shift, 0.0) ||
            !truth::acts_at(truth_, e, p - entry.shift, ground, local))
            continue;
        const PreparedProfile& profile = truth_.profiles[e.profile];
        const double b = local.offset / local.width;
        for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
            if (!(profile.points[i].b <= b && b < profile.points[i + 1].b)) continue;
            const double z =
                e.level + local.height * (profile.points[i].h + profile.slope[i] * (b - profile.points[i].b));
            base = std::max(base, z);
            if ((profile.internal_mask >> i) & 1u) cut = std::min(cut, z);
            break;
        }
    }
    return std::min(base, cut);
}

// What a strip does to the samples of a texel: raises their bases, lowers their cuts.
void Rasterizer::sample_strip(const Strip& strip, const TexelRun& run, std::vector<double>& bases,
                              std::vector<double>& cuts) const {
    const PreparedElement& e = *strip.element;
    const PreparedProfile& profile = truth_.profiles[e.profile];
    const double half = 0.5 * (samples_ - 1) / samples_, per_width = 1.0 / e.width0;
    const double reach = half * (std::abs(strip.normal.x) * texel_.x + std::abs(strip.normal.y) * texel_.y);
    const double lowest = (strip.offset - reach) * per_width - 1e-12, on_line = 1e-12 * truth_.size.x;
    const ProfilePoint* const points = profile.points.data();
    const std::size_t last = profile.points.size() - 2;  // facet
    std::size_t first = 0;
    while (first < last && points[first + 1].b <= lowest) ++first;
    bool left = true, right = true;  // whether the ground is that of a side
    const auto find_sides = [&](double ground) {
        left = std::abs(ground - e.left_level) <= truth_.level_tolerance;
        right = std::abs(ground - e.right_level) <= truth_.level_tolerance;
    };
    find_sides(run.level);
    for (std::size_t k = 0; k < bases.size(); ++k) {
        const double offset = strip.offset + dot(strip.normal, around_[k]), b = offset * per_width;
        if (b < profile.low || b >= profile.high) continue;
        if (!run.levels.empty()) find_sides(run.levels[k]);
        if (std::abs(offset) <= on_line ? !left && !right : !(offset < 0.0 ? left : right)) continue;
        std::size_t i = first;
        while (i < last && points[i + 1].b <= b) ++i;
        const double z = e.level + e.height0 * (points[i].h + profile.slope[i] * (b - points[i].b));
        bases[k] = std::max(bases[k], z);
        if ((profile.internal_mask >> i) & 1u) cuts[k] = std::min(cuts[k], z);
    }
}

double Rasterizer::mean_of_strips(const std::vector<Strip>& strips, const TexelRun& run) const {
    thread_local std::vector<double> bases, cuts;
    const std::size_t count = static_cast<std::size_t>(samples_) * static_cast<std::size_t>(samples_);
    if (run.levels.empty())
        bases.assign(count, run.level);
    else
        bases = run.levels;
    cuts.assign(count, 1e300);
    for (const Strip& strip : strips) sample_strip(strip, run, bases, cuts);
    double sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) sum += seen(std::min(bases[k], cuts[k]));
    return sum / static_cast<double>(count);
}

double Rasterizer::mean_of_samples(int x, int y, const std::vector<Entry>& entries, const TexelRun& run,
                                   bool height_field) const {
    std::vector<std::uint32_t> candidates;
    if (!height_field)
        for (const Entry& entry : entries)
            candidates.push_back(static_cast<std::uint32_t>(entry.element - truth_.elements.data()));
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    const std::size_t n = static_cast<std::size_t>(samples_);
    double sum = 0.0;
    for (std::size_t k = 0; k < n * n; ++k) {
        const double ground = run.levels.empty() ? run.level : run.levels[k];
        const Vec2 p{(x + (static_cast<double>(k % n) + 0.5) / samples_) * texel_.x,
                     (y + (static_cast<double>(k / n) + 0.5) / samples_) * texel_.y};
        sum += seen(height_field ? sample(entries, p, ground) : owner_.surface_at(p, candidates, ground).height);
    }
    return sum / static_cast<double>(n * n);
}

float Rasterizer::draw_texel(int x, int y, const std::vector<Entry>& bucket, const TexelRun& run) const {
    const bool uniform = run.levels.empty();
    const Vec2 centre = texel_centre(x, y);
    thread_local std::vector<Entry> entries;  // those that act in this texel
    thread_local std::vector<Plane> planes;
    thread_local std::vector<Strip> strips;
    entries.clear();
    planes.clear();
    strips.clear();
    bool mixed = !uniform, height_field = true;
    for (const Entry& entry : bucket) {
        const PreparedElement& e = *entry.element;
        Foot foot;
        Plane plane;
        const Nearness nearness = nearness_of(entry, centre, foot);
        if (nearness == Nearness::absent) continue;
        const bool inside = nearness == Nearness::inside;
        const Cover cover =
            uniform && inside ? cover_by_offset(e, centre - entry.shift, foot, run.level, plane) : Cover::mixed;
        if (cover == Cover::absent) continue;
        entries.push_back(entry);
        planes.push_back(plane);
        if (inside && e.kind == ElementKind::line) strips.push_back({&e, foot.offset, normal_of(e.tangent)});
        mixed = mixed || cover == Cover::mixed;
        height_field = height_field && truth_.profiles[e.profile].height_field;
    }
    double mean = 0.0;
    if (!mixed && merge_planes(planes, run.level, mean)) return value_of(mean);
    if (strips.size() == entries.size()) return value_of(mean_of_strips(strips, run));
    return value_of(mean_of_samples(x, y, entries, run, height_field));
}

// ---- the map
// -------------------------------------------------------------------------------------------------

void Rasterizer::draw_texel_row(int y, Image& image) const {
    const std::vector<TexelRun> levels = find_levels(y);
    const std::vector<Entry>* row = &buckets_[static_cast<std::size_t>(y / kBucket - first_row_) *
                                              static_cast<std::size_t>(bucket_columns())];
    float* out = &image.at(0, y - region_.y);
    int x = 0;  // within the region
    for (const TexelRun& run : levels) {
        const float empty = value_of(run.level);
        while (x < run.end) {
            const int column = (x + region_.x) / kBucket;
            const std::vector<Entry>& bucket = row[column - first_column_];
            const int end = std::min(run.end, (column + 1) * kBucket - region_.x);
            if (bucket.empty() && run.levels.empty()) std::fill(out + x, out + end, empty), x = end;
            for (; x < end; ++x) out[x] = draw_texel(x + region_.x, y, bucket, run);
        }
    }
}

void Rasterizer::draw_bucket_row(int row, Image& image) const {
    const int from = std::max(row * kBucket, region_.y);
    const int to = std::min((row + 1) * kBucket, region_.y + region_.height);
    for (int y = from; y < to; ++y) draw_texel_row(y, image);
}

Image Rasterizer::run() {
    fill_buckets();
    fill_step_rows();
    Image image(region_.width, region_.height);
    std::atomic<int> next{first_row_};
    const auto work = [&] {
        for (int row = next++; row <= last_row_; row = next++) draw_bucket_row(row, image);
    };
    int count = threads_ > 0 ? threads_ : static_cast<int>(std::thread::hardware_concurrency());
    count = std::clamp(count, 1, last_row_ - first_row_ + 1);
    std::vector<std::thread> workers;
    for (int i = 1; i < count; ++i) workers.emplace_back(work);
    work();
    for (std::thread& worker : workers) worker.join();
    return image;
}

}  // namespace

Image rasterize_height(const ResolvedPattern& pattern, int width, int height,
                       const RasterizeOptions& options) {
    return Rasterizer(pattern, width, height, options).run();
}

}  // namespace burin
