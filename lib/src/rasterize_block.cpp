// Blocks of texels: what no element changes, or one plane rules, is filled; of the rest, what others hide is left out
// before texels are looked at.
#include "rasterize_internal.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace burin::rasterizing {
namespace {

constexpr int kDepths = 4;  // of blocks: 8, 4, 2 texels and 1
static_assert(kBucket == 1 << (kDepths - 1));

int depth_of(const Block& block) { return block.side == 8 ? 0 : block.side == 4 ? 1 : block.side == 2 ? 2 : 3; }

// Used again from block to block, one for each size since they are nested.
struct Scratch {
    std::array<std::vector<Acting>, kDepths> acting;
    std::array<std::vector<Entry>, kDepths> entries;
    std::vector<Plane> planes;
};
thread_local Scratch scratch;

// Least and greatest height of a profile between two offsets, and whether any facet there is internal.
void bound_profile(const PreparedProfile& profile, double from, double to, double height, Bounds& out) {
    double low = 1e300, high = -1e300;
    out.any_internal = false;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
        const ProfilePoint &p = profile.points[i], &q = profile.points[i + 1];
        if (q.b < from || p.b > to) continue;
        const double start = p.b >= from ? p.h : p.h + profile.slope[i] * (from - p.b);
        const double end = q.b <= to ? q.h : p.h + profile.slope[i] * (to - p.b);
        low = std::min({low, start, end});
        high = std::max({high, start, end});
        out.any_internal = out.any_internal || ((profile.internal_mask >> i) & 1u);
    }
    out.low += height * (height < 0.0 ? high : low);
    out.high += height * (height < 0.0 ? low : high);
}

}  // namespace

bool LevelRows::one_level(int x0, int y0, int x1, int y1) const {
    const double level = at(x0, y0).level;
    for (int row = y0; row < y1; ++row) {
        const TexelRun& first = at(x0, row);
        if (&first != &at(x1 - 1, row) || !first.levels.empty() || first.level != level) return false;
    }
    return true;
}

LevelRows Rasterizer::find_level_rows(int y0, int y1) const {
    LevelRows rows{region_.x, y0, {}, {}};
    for (int y = y0; y < y1; ++y) {
        rows.runs.push_back(find_levels(y));
        std::vector<std::uint32_t> run;
        run.reserve(static_cast<std::size_t>(region_.width));
        for (std::uint32_t i = 0; i < rows.runs.back().size(); ++i)
            run.resize(static_cast<std::size_t>(rows.runs.back()[i].end), i);
        rows.run.push_back(std::move(run));
    }
    return rows;
}

// What may act in the block, and where its centre lies to it.
void Rasterizer::find_acting(const Block& block, const std::vector<Entry>& above, std::vector<Acting>& acting) const {
    const Vec2 centre{(block.x + 0.5 * block.side) * texel_.x, (block.y + 0.5 * block.side) * texel_.y};
    acting.clear();
    for (const Entry& entry : above) {
        Acting a{entry, {}, false};
        const Nearness nearness = nearness_of(entry, centre, block.side * radius_, a.foot);
        if (nearness == Nearness::absent) continue;
        a.inside = a.entry.inside = nearness == Nearness::inside;
        a.entry.guess = guess_of(*entry.element, a.foot, block.side * radius_);
        acting.push_back(a);
    }
}

Bounds Rasterizer::bounds_of(const Block& block, const Acting& acting, double ground) const {
    const PreparedElement& e = *acting.entry.element;
    const PreparedProfile& profile = truth_.profiles[e.profile];
    Bounds bounds;
    const double reach = block.side * radius_ * (1.0 + 1e-9);
    if (!acting.inside || (e.step && std::abs(acting.foot.offset) <= reach)) return bounds;
    const double level = acting.foot.offset < 0.0 ? e.left_level : e.right_level;
    if (std::abs(ground - level) > truth_.level_tolerance) return bounds;
    const double from = (acting.foot.offset - reach) / e.width0, to = (acting.foot.offset + reach) / e.width0;
    if (to < profile.low || from > profile.high) return bounds;
    bounds.known = true;
    bounds.everywhere = from >= profile.low && to < profile.high;
    bounds.low = bounds.high = e.level;
    bound_profile(profile, from, to, e.height0, bounds);
    return bounds;
}

// Leaves out what only adds, and stays below the ground or another addition in all of the block.
void Rasterizer::drop_hidden(const Block& block, double ground, std::vector<Acting>& acting) const {
    double floor = ground;
    const Acting* highest = nullptr;
    thread_local std::vector<Bounds> bounds;
    bounds.clear();
    for (const Acting& a : acting) {
        bounds.push_back(bounds_of(block, a, ground));
        if (bounds.back().everywhere && bounds.back().low > floor) floor = bounds.back().low, highest = &a;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < acting.size(); ++i) {
        const Bounds& b = bounds[i];
        const bool hidden = b.known && !b.any_internal && b.high <= floor && &acting[i] != highest;
        if (!hidden) acting[kept++] = acting[i];
    }
    acting.erase(acting.begin() + static_cast<std::ptrdiff_t>(kept), acting.end());
}

void Rasterizer::fill_block(const Block& block, const Plane& plane, Image& image) const {
    const int right = std::min(block.x + block.side, width_), below = std::min(block.y + block.side, height_);
    const Vec2 middle{block.x + 0.5 * block.side, block.y + 0.5 * block.side};
    for (int y = block.y; y < below; ++y) {
        float* const out = &image.at(0, y - region_.y) - region_.x;
        const double start = plane.middle + plane.slope.y * ((y + 0.5 - middle.y) * texel_.y);
        for (int x = block.x; x < right; ++x) out[x] = value_of(start + plane.slope.x * ((x + 0.5 - middle.x) * texel_.x));
    }
}

// Fills a block over which one plane rules; false where none does.
bool Rasterizer::fill_with_plane(const Block& block, const std::vector<Acting>& acting, double ground, Image& image) const {
    std::vector<Plane>& planes = scratch.planes;
    planes.clear();
    for (const Acting& a : acting) {
        Plane plane;
        const Cover cover = a.inside ? cover_by_offset(*a.entry.element, a.foot, ground, block.side, plane) : Cover::mixed;
        if (cover == Cover::mixed) return false;
        if (cover == Cover::plane) planes.push_back(plane);
    }
    Plane ruler;
    if (!merge_planes(planes, ground, ruler)) return false;
    fill_block(block, ruler, image);
    return true;
}

void Rasterizer::split_block(const Block& block, const std::vector<Entry>& entries, const LevelRows& levels, Image& image) const {
    const int side = block.side / 2;
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Block part{block.x + (quarter & 1) * side, block.y + (quarter >> 1) * side, side};
        if (part.x >= width_ || part.y >= height_) continue;
        if (side > 1)
            draw_block(part, entries, levels, image);
        else
            image.at(part.x - region_.x, part.y - region_.y) = draw_texel(part.x, part.y, entries, levels.at(part.x, part.y));
    }
}

void Rasterizer::draw_block(const Block& block, const std::vector<Entry>& above, const LevelRows& levels, Image& image) const {
    const int right = std::min(block.x + block.side, width_), below = std::min(block.y + block.side, height_);
    const bool level = levels.one_level(block.x, block.y, right, below);
    const double ground = levels.at(block.x, block.y).level;
    const auto depth = static_cast<std::size_t>(depth_of(block));
    std::vector<Acting>& acting = scratch.acting[depth];
    find_acting(block, above, acting);
    if (level && acting.size() > 1) drop_hidden(block, ground, acting);
    if (level && fill_with_plane(block, acting, ground, image)) return;
    std::vector<Entry>& entries = scratch.entries[depth];
    entries.clear();
    for (const Acting& a : acting) entries.push_back(a.entry);
    split_block(block, entries, levels, image);
}

void Rasterizer::draw_bucket_row(int row, Image& image) const {
    const LevelRows levels = find_level_rows(row * kBucket, std::min((row + 1) * kBucket, height_));
    const std::vector<Entry>* const buckets = &buckets_[static_cast<std::size_t>(row - first_row_) *
                                                        static_cast<std::size_t>(bucket_columns())];
    for (int column = first_column_; column <= last_column_; ++column)
        draw_block({column * kBucket, row * kBucket, kBucket}, buckets[column - first_column_], levels, image);
}

}  // namespace burin::rasterizing
