// Box-filtered height map of a pattern, asked from the truth's own rules for where elements act.
//
// Speed comes from three things, none of which changes the result: buckets of texels list the elements that
// can act there, and blocks within them those that are not hidden; the ground of a row of samples comes from its
// crossings with step path lines; and blocks over which the surface is one plane are filled. Buckets lie at multiples
// of kBucket texels of the whole map and are drawn whole, so that a region is computed exactly as the same part of the
// whole.
#include <burin/rasterize.hpp>

#include <algorithm>
#include <cassert>

#include "parallel.hpp"
#include "rasterize_internal.hpp"

namespace burin {
namespace rasterizing {
namespace {

// The cross product of a quadratic's first two derivatives is constant: it bends most where it is slowest.
double greatest_curvature(const PreparedElement& e) {
    const double square = dot(e.bend, e.bend);
    if (e.kind == ElementKind::line || square <= 0.0) return 0.0;
    const Vec2 slowest = e.edge + e.bend * std::clamp(-dot(e.edge, e.bend) / square, 0.0, 1.0);
    const double speed = std::max(1e-300, length(slowest));
    return std::abs(cross(e.edge, e.bend)) / (2.0 * speed * speed * speed);
}

}  // namespace

Rasterizer::Rasterizer(const ResolvedPattern& pattern, int width, int height, const RasterizeOptions& options)
    : owner_(pattern, TruthOptions{.level_tolerance = options.level_tolerance}),
      truth_(owner_.prepared()),
      base_offset_(pattern.base_offset),
      width_(width),
      height_(height),
      samples_(options.samples),
      threads_(options.threads),
      tolerance_(options.curve_tolerance * pattern.depth),
      asked_(options.region) {
    assert(width >= 1 && height >= 1 && samples_ >= 1 && samples_ <= 64);
    if (asked_.width == 0) asked_ = {0, 0, width, height};
    assert(asked_.x >= 0 && asked_.y >= 0 && asked_.height >= 1);
    assert(asked_.x + asked_.width <= width && asked_.y + asked_.height <= height);
    first_column_ = asked_.x / kBucket;
    last_column_ = (asked_.x + asked_.width - 1) / kBucket;
    first_row_ = asked_.y / kBucket;
    last_row_ = (asked_.y + asked_.height - 1) / kBucket;
    region_ = {first_column_ * kBucket, first_row_ * kBucket, 0, 0};
    region_.width = std::min(width, (last_column_ + 1) * kBucket) - region_.x;
    region_.height = std::min(height, (last_row_ + 1) * kBucket) - region_.y;
    texel_ = {truth_.size.x / width, truth_.size.y / height};
    radius_ = 0.5 * length(texel_);
    const double share = (1.0 - 1.0 / (samples_ * samples_)) / 12.0;
    spread_ = {texel_.x * texel_.x * share, texel_.y * texel_.y * share};
    for (int j = 0; j < samples_; ++j)
        for (int i = 0; i < samples_; ++i)
            around_.push_back({((i + 0.5) / samples_ - 0.5) * texel_.x, ((j + 0.5) / samples_ - 0.5) * texel_.y});
    for (const PreparedElement& e : truth_.elements) bows_.push_back(greatest_curvature(e));
}

// ---- buckets
// -------------------------------------------------------------------------------------------------

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
                    Foot foot;
                    const Nearness nearness = nearness_of({&e, shift, false, -1.0}, centre, radius, foot);
                    if (nearness == Nearness::absent) continue;
                    buckets_[static_cast<std::size_t>(y - first_row_) *
                                 static_cast<std::size_t>(bucket_columns()) +
                             static_cast<std::size_t>(x - first_column_)]
                        .push_back({&e, shift, nearness == Nearness::inside, -1.0});
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
                    step_rows_[static_cast<std::size_t>(row - first_row_)].push_back({&e, shift, false, -1.0});
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
    const std::vector<Entry>& steps = step_rows_[static_cast<std::size_t>(y / kBucket - first_row_)];
    // No line crosses the row.
    if (steps.empty()) return {{region_.width, owner_.ground_at({0.5 * truth_.size.x, (y + 0.5) * texel_.y}), {}}};
    std::vector<RowCrossing> crossings;
    std::vector<std::vector<SampleRun>> rows;
    for (int s = 0; s < samples_; ++s) {
        const double v = (y + (s + 0.5) / samples_) * texel_.y;
        crossings.clear();
        for (const Entry& entry : steps) cross_row(entry, v, crossings);
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

// ---- the map
// -------------------------------------------------------------------------------------------------

Image Rasterizer::run() {
    fill_buckets();
    fill_step_rows();
    Image image(region_.width, region_.height);
    for_each_piece(static_cast<std::size_t>(last_row_ - first_row_ + 1), threads_,
                   [&](std::size_t row) { draw_bucket_row(first_row_ + static_cast<int>(row), image); });
    if (asked_.width == region_.width && asked_.height == region_.height) return image;
    Image out(asked_.width, asked_.height);
    for (int y = 0; y < out.height; ++y) {
        const float* const from = &image.at(asked_.x - region_.x, asked_.y - region_.y + y);
        std::copy(from, from + out.width, &out.at(0, y));
    }
    return out;
}

}  // namespace rasterizing

Image rasterize_height(const ResolvedPattern& pattern, int width, int height,
                       const RasterizeOptions& options) {
    return rasterizing::Rasterizer(pattern, width, height, options).run();
}

}  // namespace burin
