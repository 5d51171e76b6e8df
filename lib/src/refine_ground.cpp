#include <algorithm>
#include <cmath>
#include <map>

#include "parallel.hpp"
#include "refine_scene.hpp"

namespace burin::refinement {
NearestStep nearest_step(const Layout& layout, const std::vector<StepLine>& steps, Vec2 p) {
    NearestStep best;
    double farthest = 0.0;
    for (const StepLine& step : steps) {
        const Instance& instance = layout.instances[step.instance];
        const Feature& feature = layout.features[instance.element];
        const Foot foot = foot_of(feature.frame, p - instance.offset, step.guess);
        // Two neighbours share the nearest point at their corner: the one whose line is farther away decides.
        const double difference = foot.distance - best.distance;
        const bool tie = std::abs(difference) <= 1e-9 * (1.0 + foot.distance);
        if (tie ? std::abs(foot.offset) <= farthest : difference > 0.0) continue;
        farthest = std::abs(foot.offset);
        best = {static_cast<int>(step.instance), foot.offset < 0.0 ? feature.level_left : feature.level_right,
                foot.distance, foot.offset};
    }
    return best;
}

namespace {

// The end of the element that is nearer than the rest of it to all points within `radius` of p; null when none is.
const Vec2* nearest_vertex(const ElementFrame& frame, const Foot& foot, Vec2 p, double radius) {
    if (foot.parameter >= 0.0 && foot.parameter <= 1.0) return nullptr;
    const EndFrame& end = foot.parameter < 0.0 ? frame.start : frame.end;
    const bool clear = dot(p - end.vertex, end.outward) > radius && is_tame(frame, foot, radius);
    return clear ? &end.vertex : nullptr;
}

// Where neighbours share the nearest point, the one whose line is farther away decides: see nearest_step.
bool gives_way(const StepLine& a, const StepLine& b, Vec2 apart, double radius) {
    if (!a.vertex || !b.vertex) return false;
    const Vec2 gap = *a.vertex + apart - *b.vertex;
    return std::abs(gap.x) + std::abs(gap.y) < 1e-9 && std::abs(b.offset) > std::abs(a.offset) + 2.0 * radius;
}

}  // namespace

void keep_nearest_steps(const Layout& layout, Vec2 p, double radius, std::vector<StepLine>& steps) {
    double nearest = 1e300;
    for (StepLine& step : steps) {
        const Instance& instance = layout.instances[step.instance];
        const Feature& feature = layout.features[instance.element];
        const ElementFrame& frame = feature.frame;
        const Foot foot = foot_of(frame, p - instance.offset, step.guess);
        step.guess = guess_near(frame, foot, radius);
        step.distance = foot.distance;
        step.offset = foot.offset;
        step.one_sided = std::abs(foot.offset) > radius && is_tame(frame, foot, radius);
        step.level = foot.offset < 0.0 ? feature.level_left : feature.level_right;
        step.vertex = nearest_vertex(frame, foot, p - instance.offset, radius);
        nearest = std::min(nearest, step.distance);
    }
    const double farthest = (nearest + 2.0 * radius) * (1.0 + 1e-6);
    std::erase_if(steps, [&](const StepLine& s) { return s.distance > farthest; });
    const std::vector<Instance>& instances = layout.instances;
    for (std::size_t i = 0; i < steps.size();) {
        const bool out = std::any_of(steps.begin(), steps.end(), [&](const StepLine& other) {
            return gives_way(steps[i], other, instances[steps[i].instance].offset - instances[other.instance].offset, radius);
        });
        if (out)
            steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(i));
        else
            ++i;
    }
}

namespace {

constexpr double kStepMargin = 1.25;  // texels beyond a step's walls that its texels' squares may touch them from

// The steps that may be the nearest somewhere in a tile.
void nearest_steps_of_tile(const Layout& layout, int column, int row, std::vector<StepLine>& steps) {
    const std::size_t tile = static_cast<std::size_t>(row) * layout.tile_columns + static_cast<std::size_t>(column);
    steps.clear();
    for (std::uint32_t k = layout.first[tile]; k < layout.first[tile + 1]; ++k)
        if (layout.features[layout.instances[layout.listed[k]].element].step) steps.push_back({layout.listed[k], 0.0});
    const Vec2 side = layout.side * double(kTile);
    keep_nearest_steps(layout, {(column + 0.5) * side.x, (row + 0.5) * side.y}, 0.5 * length(side), steps);
}

// How far a step's walls reach on the side of an offset: it may be soft on one side and hard on the other.
double reach_beside(const Layout& layout, std::uint32_t instance, double offset) {
    const Feature& feature = layout.features[layout.instances[instance].element];
    return (offset < 0.0 ? -feature.left : feature.right) + kStepMargin;
}

// Which texels of a tile lie within a step's walls, and the levels that the steps leave on their sides.
class TileGround {
  public:
    TileGround(Layout& layout, std::vector<float>& sides) : layout_(layout), sides_(sides) {}

    void lay(int column, int row) {
        const std::size_t tile = static_cast<std::size_t>(row) * layout_.tile_columns + static_cast<std::size_t>(column);
        std::vector<StepLine>& steps = layout_.tile_steps[tile];
        nearest_steps_of_tile(layout_, column, row, steps);
        const double radius = 0.5 * length(layout_.side * double(kTile));
        bool any_near = false;
        for (const StepLine& step : steps) any_near |= step.distance - radius <= farthest_reach(step);
        if (!any_near) return;
        layout_.tile_far[tile] = 0;
        const bool plain = steps.size() == 1 && steps[0].one_sided &&
                           steps[0].distance + radius <= reach_beside(layout_, steps[0].instance, steps[0].offset);
        for (int y = row * kTile; y < std::min((row + 1) * kTile, layout_.height); ++y)
            for (int x = column * kTile; x < std::min((column + 1) * kTile, layout_.width); ++x)
                plain ? mark(x, y, steps[0].level) : look(x, y, steps);
    }

  private:
    double farthest_reach(const StepLine& step) const {
        const double here = reach_beside(layout_, step.instance, step.offset);
        return step.one_sided ? here : std::max(here, reach_beside(layout_, step.instance, -step.offset));
    }

    void look(int x, int y, const std::vector<StepLine>& steps) {
        const NearestStep nearest = nearest_step(layout_, steps, layout_.centre(x, y));
        if (nearest.instance < 0) return;
        const std::uint32_t instance = static_cast<std::uint32_t>(nearest.instance);
        if (nearest.distance <= reach_beside(layout_, instance, nearest.offset)) mark(x, y, nearest.level);
    }

    void mark(int x, int y, double level) {
        const std::size_t k = static_cast<std::size_t>(y) * layout_.width + x;
        layout_.ground[k] = kNearStep;
        sides_[k] = static_cast<float>(level);
    }

    Layout& layout_;
    std::vector<float>& sides_;
};

// Gives connected texels between the steps' walls the level that most of the texels around them show on this side. Tiles
// that no wall comes near are taken whole.
class RegionFill {
  public:
    RegionFill(Layout& layout, const std::vector<float>& sides)
        : layout_(layout), sides_(sides), done_(layout.ground.size(), 0), tile_done_(layout.tile_far.size(), 0) {}

    void fill_all() {
        for (int y = 0; y < layout_.height; ++y)
            for (int x = 0; x < layout_.width; ++x) fill_from(x, y);
    }

  private:
    std::size_t tile_at(int x, int y) const {
        return static_cast<std::size_t>(y / kTile) * layout_.tile_columns + static_cast<std::size_t>(x / kTile);
    }

    void fill_from(int x, int y) {
        const std::size_t tile = tile_at(x, y), k = static_cast<std::size_t>(y) * layout_.width + x;
        if (layout_.tile_far[tile] ? tile_done_[tile] : done_[k] || layout_.ground[k] == kNearStep) return;
        texels_.clear(), tiles_.clear(), votes_.clear();
        look(x, y);
        std::size_t next_texel = 0, next_tile = 0;
        while (next_texel < texels_.size() || next_tile < tiles_.size()) {
            if (next_texel < texels_.size())
                look_around(texels_[next_texel++]);
            else
                look_around_tile(tiles_[next_tile++]);
        }
        give_level();
    }

    void look(int x, int y) {
        if (layout_.repeat) {
            x = (x + layout_.width) % layout_.width;
            y = (y + layout_.height) % layout_.height;
        } else if (x < 0 || y < 0 || x >= layout_.width || y >= layout_.height) {
            return;
        }
        const std::size_t k = static_cast<std::size_t>(y) * layout_.width + x, tile = tile_at(x, y);
        if (layout_.tile_far[tile]) {
            if (!tile_done_[tile]) tiles_.push_back(tile);
            tile_done_[tile] = 1;
        } else if (layout_.ground[k] == kNearStep) {
            ++votes_[sides_[k]];
        } else if (!done_[k]) {
            done_[k] = 1;
            texels_.push_back(k);
        }
    }

    void look_around(std::size_t k) {
        const int x = static_cast<int>(k % layout_.width), y = static_cast<int>(k / layout_.width);
        look(x - 1, y), look(x + 1, y), look(x, y - 1), look(x, y + 1);
    }

    TileSpan span_of(std::size_t tile) const {
        return layout_.span(static_cast<int>(tile % layout_.tile_columns), static_cast<int>(tile / layout_.tile_columns));
    }

    void look_around_tile(std::size_t tile) {
        const TileSpan span = span_of(tile);
        for (int x = span.x0; x < span.x1; ++x) look(x, span.y0 - 1), look(x, span.y1);
        for (int y = span.y0; y < span.y1; ++y) look(span.x0 - 1, y), look(span.x1, y);
    }

    void give_level() {
        float level = static_cast<float>(layout_.outer_level);
        std::size_t most = 0;
        for (const auto& [candidate, count] : votes_)
            if (count > most) most = count, level = candidate;
        for (const std::size_t k : texels_) layout_.ground[k] = level;
        for (const std::size_t tile : tiles_) {
            const TileSpan span = span_of(tile);
            for (int y = span.y0; y < span.y1; ++y)
                std::fill_n(layout_.ground.begin() + static_cast<std::ptrdiff_t>(y) * layout_.width + span.x0,
                            span.x1 - span.x0, level);
        }
    }

    Layout& layout_;
    const std::vector<float>& sides_;
    std::vector<std::uint8_t> done_, tile_done_;
    std::vector<std::size_t> texels_, tiles_;
    std::map<float, std::size_t> votes_;
};

}  // namespace

void lay_ground(Layout& layout, int threads) {
    if (std::find(layout.tile_has_step.begin(), layout.tile_has_step.end(), 1) == layout.tile_has_step.end()) return;
    layout.ground.assign(static_cast<std::size_t>(layout.width) * layout.height, 0.0f);
    layout.tile_steps.resize(layout.tile_has_step.size());
    layout.tile_far.assign(layout.tile_has_step.size(), 1);
    std::vector<float> sides(layout.ground.size(), 0.0f);
    for_each_piece(static_cast<std::size_t>(layout.tile_rows), threads, [&](std::size_t row) {
        TileGround ground(layout, sides);
        for (int column = 0; column < layout.tile_columns; ++column)
            if (layout.tile_has_step[row * layout.tile_columns + column]) ground.lay(column, static_cast<int>(row));
    });
    RegionFill(layout, sides).fill_all();
}

}  // namespace burin::refinement
