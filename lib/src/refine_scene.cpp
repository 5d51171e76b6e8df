#include "refine_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace burin::refinement {
namespace {

constexpr double kLongestTip = 4.0;  // of a mitre, in reaches: ResolveOptions::mitre_limit

std::vector<Feature> features_of(const ResolvedPattern& pattern, const std::vector<SweptProfile>& profiles) {
    std::vector<Feature> features;
    features.reserve(pattern.elements.size());
    for (const ResolvedElement& element : pattern.elements) {
        const Style& style = pattern.styles[element.style];
        Feature feature;
        feature.frame = frame_of(element);
        feature.profile = &profiles[style.profile];
        feature.step = style.step;
        feature.level_left = feature.level_right = style.level;
        if (style.step)
            feature.level_right += element.element.height0 * (feature.profile->h.back() - feature.profile->h.front());
        const double widest = std::max(element.element.width0, element.element.width1);
        feature.left = std::min(0.0, feature.profile->left() * widest);
        feature.right = std::max(0.0, feature.profile->right() * widest);
        features.push_back(feature);
    }
    return features;
}

Box grown_box(const Feature& feature) {
    Box box;
    for (const Vec2 p : {feature.frame.p0, feature.frame.p1, feature.frame.p2}) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    }
    const double grow = kLongestTip * std::max(-feature.left, feature.right) + kNearMargin + 1.0;
    return {box.low - Vec2{grow, grow}, box.high + Vec2{grow, grow}};
}

void add_instances(const Layout& layout, std::uint32_t element, const Box& box, std::vector<Instance>& out) {
    const Vec2 size{layout.width * layout.side.x, layout.height * layout.side.y};
    const int span = layout.repeat ? 2 : 0;
    for (int j = -span; j <= span; ++j) {
        for (int i = -span; i <= span; ++i) {
            const Vec2 offset{i * size.x, j * size.y};
            if (box.low.x + offset.x < size.x && box.high.x + offset.x > 0.0 && box.low.y + offset.y < size.y &&
                box.high.y + offset.y > 0.0)
                out.push_back({element, offset});
        }
    }
}

// Calls visit(tile) for each tile that the instance may come near.
template <typename Visit>
void for_tiles(const Layout& layout, const Instance& instance, Visit visit) {
    const Feature& feature = layout.features[instance.element];
    const Box box = grown_box(feature);
    const Vec2 tile_side{kTile * layout.side.x, kTile * layout.side.y};
    const auto index = [](double x, int count) { return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1); };
    const int x0 = index((box.low.x + instance.offset.x) / tile_side.x, layout.tile_columns);
    const int x1 = index((box.high.x + instance.offset.x) / tile_side.x, layout.tile_columns);
    const int y0 = index((box.low.y + instance.offset.y) / tile_side.y, layout.tile_rows);
    const int y1 = index((box.high.y + instance.offset.y) / tile_side.y, layout.tile_rows);
    const double reach = std::max(-feature.left, feature.right);
    const double margin = 0.5 * length(tile_side) + kNearMargin + 1.0;
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            const Vec2 p = Vec2{(x + 0.5) * tile_side.x, (y + 0.5) * tile_side.y} - instance.offset;
            const Foot foot = foot_of(feature.frame, p);
            if (reach_at(feature.frame, p, foot, -reach, reach, margin).possible || foot.distance < reach + margin)
                visit(static_cast<std::size_t>(y) * layout.tile_columns + x);
        }
    }
}

void list_by_tile(Layout& layout) {
    const std::size_t tiles = static_cast<std::size_t>(layout.tile_columns) * layout.tile_rows;
    std::vector<std::vector<std::uint32_t>> lists(tiles);
    for (std::uint32_t i = 0; i < layout.instances.size(); ++i)
        for_tiles(layout, layout.instances[i], [&](std::size_t tile) { lists[tile].push_back(i); });
    layout.tile_has_step.assign(tiles, 0);
    layout.first.assign(1, 0);
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        for (const std::uint32_t i : lists[tile]) {
            layout.listed.push_back(i);
            if (layout.features[layout.instances[i].element].step) layout.tile_has_step[tile] = 1;
        }
        layout.first.push_back(static_cast<std::uint32_t>(layout.listed.size()));
    }
}

void note_side(Layout& layout, const std::vector<StepLine>& steps, int x, int y, std::vector<float>& side) {
    const NearestStep nearest = nearest_step(layout, steps, layout.centre(x, y));
    if (nearest.instance < 0) return;
    const Feature& feature = layout.features[layout.instances[nearest.instance].element];
    // A step may be soft on one side and hard on the other.
    const double reach = nearest.offset < 0.0 ? -feature.left : feature.right;
    if (nearest.distance > reach + 1.25) return;
    const std::size_t k = static_cast<std::size_t>(y) * layout.width + x;
    layout.ground[k] = kNearStep;
    side[k] = static_cast<float>(nearest.level);
}

// Which side the steps leave each texel near them on; kNearStep in the ground of texels within a step's walls.
std::vector<float> side_levels(Layout& layout) {
    std::vector<float> side(static_cast<std::size_t>(layout.width) * layout.height, 0.0f);
    std::vector<StepLine> steps;
    for (int row = 0; row < layout.tile_rows; ++row) {
        for (int column = 0; column < layout.tile_columns; ++column) {
            if (!layout.tile_has_step[static_cast<std::size_t>(row) * layout.tile_columns + column]) continue;
            nearest_steps_of_tile(layout, column, row, steps);
            for (int y = row * kTile; y < std::min((row + 1) * kTile, layout.height); ++y)
                for (int x = column * kTile; x < std::min((column + 1) * kTile, layout.width); ++x)
                    note_side(layout, steps, x, y, side);
        }
    }
    return side;
}

// Gives the connected texels around `start` the level that most of the steps around them show on this side.
class RegionFill {
  public:
    RegionFill(Layout& layout, const std::vector<float>& side)
        : layout_(layout), side_(side), done_(layout.ground.size(), 0) {}

    void fill_all() {
        for (std::size_t k = 0; k < done_.size(); ++k)
            if (!done_[k] && layout_.ground[k] != kNearStep) fill(k);
    }

  private:
    void look(int x, int y) {
        if (layout_.repeat) {
            x = (x + layout_.width) % layout_.width;
            y = (y + layout_.height) % layout_.height;
        } else if (x < 0 || y < 0 || x >= layout_.width || y >= layout_.height) {
            return;
        }
        const std::size_t k = static_cast<std::size_t>(y) * layout_.width + x;
        if (layout_.ground[k] == kNearStep) {
            ++votes_[side_[k]];
        } else if (!done_[k]) {
            done_[k] = 1;
            region_.push_back(k);
        }
    }

    void fill(std::size_t start) {
        region_.assign(1, start);
        votes_.clear();
        done_[start] = 1;
        for (std::size_t next = 0; next < region_.size(); ++next) {
            const int x = static_cast<int>(region_[next] % layout_.width);
            const int y = static_cast<int>(region_[next] / layout_.width);
            look(x - 1, y), look(x + 1, y), look(x, y - 1), look(x, y + 1);
        }
        float level = static_cast<float>(layout_.outer_level);
        std::size_t most = 0;
        for (const auto& [candidate, count] : votes_)
            if (count > most) most = count, level = candidate;
        for (const std::size_t k : region_) layout_.ground[k] = level;
    }

    Layout& layout_;
    const std::vector<float>& side_;
    std::vector<std::uint8_t> done_;
    std::vector<std::size_t> region_;
    std::map<float, std::size_t> votes_;
};

}  // namespace

NearestStep nearest_step(const Layout& layout, const std::vector<StepLine>& steps, Vec2 p) {
    NearestStep best;
    double farthest = 0.0;
    for (const StepLine& step : steps) {
        const Instance& instance = layout.instances[step.instance];
        const Feature& feature = layout.features[instance.element];
        const Foot foot = foot_of(feature.frame, p - instance.offset);
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
        const Foot foot = foot_of(frame, p - instance.offset);
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

void nearest_steps_of_tile(const Layout& layout, int column, int row, std::vector<StepLine>& steps) {
    const std::size_t tile = static_cast<std::size_t>(row) * layout.tile_columns + static_cast<std::size_t>(column);
    steps.clear();
    for (std::uint32_t k = layout.first[tile]; k < layout.first[tile + 1]; ++k)
        if (layout.features[layout.instances[layout.listed[k]].element].step) steps.push_back({layout.listed[k], 0.0});
    const Vec2 side = layout.side * double(kTile);
    keep_nearest_steps(layout, {(column + 0.5) * side.x, (row + 0.5) * side.y}, 0.5 * length(side), steps);
}

Layout lay_out(const ResolvedPattern& pattern, int width, int height, Vec2 side) {
    Layout layout;
    layout.width = width;
    layout.height = height;
    layout.side = side;
    layout.repeat = pattern.wrap == Wrap::repeat;
    layout.outer_level = pattern.outer_level;
    layout.tile_columns = (width + kTile - 1) / kTile;
    layout.tile_rows = (height + kTile - 1) / kTile;
    for (const ResolvedProfile& profile : pattern.profiles) layout.profiles.push_back(swept(profile));
    layout.features = features_of(pattern, layout.profiles);
    for (std::uint32_t i = 0; i < layout.features.size(); ++i)
        add_instances(layout, i, grown_box(layout.features[i]), layout.instances);
    list_by_tile(layout);
    if (std::find(layout.tile_has_step.begin(), layout.tile_has_step.end(), 1) != layout.tile_has_step.end()) {
        layout.ground.assign(static_cast<std::size_t>(width) * height, 0.0f);
        const std::vector<float> sides = side_levels(layout);
        RegionFill(layout, sides).fill_all();
    }
    return layout;
}

}  // namespace burin::refinement
