#include "refine_scene.hpp"

#include <algorithm>
#include <cmath>

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

// How far from the end a profile's side may act, in reaches: the tip of a mitre, the corner of a hip.
double tip_of(const EndFrame& end) {
    const double tip = std::sqrt(dot(end.bevel_normal, end.bevel_normal));
    return tip > 0.0 ? std::clamp(tip, 1.5, kLongestTip) : kLongestTip;
}

Box grown_box(const Feature& feature) {
    Box box;
    for (const Vec2 p : {feature.frame.p0, feature.frame.p1, feature.frame.p2}) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    }
    const double tip = std::max(tip_of(feature.frame.start), tip_of(feature.frame.end));
    const double grow = tip * std::max(-feature.left, feature.right) + kNearMargin + 1.0;
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

struct TileRange {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // half open
};

TileRange tiles_of(const Layout& layout, const Box& box, Vec2 offset) {
    const Vec2 side{kTile * layout.side.x, kTile * layout.side.y};
    const auto index = [](double x, int count) { return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1); };
    return {index((box.low.x + offset.x) / side.x, layout.tile_columns),
            index((box.low.y + offset.y) / side.y, layout.tile_rows),
            index((box.high.x + offset.x) / side.x, layout.tile_columns) + 1,
            index((box.high.y + offset.y) / side.y, layout.tile_rows) + 1};
}

// Calls visit(tile) for each tile of the range that the instance may come near; ranges that it does not are not entered.
template <typename Visit>
void for_tiles(const Layout& layout, const Instance& instance, TileRange range, const Visit& visit) {
    const int columns = range.x1 - range.x0, rows = range.y1 - range.y0;
    if (columns <= 0 || rows <= 0) return;
    const Feature& feature = layout.features[instance.element];
    const Vec2 side{kTile * layout.side.x, kTile * layout.side.y};
    const Vec2 p = Vec2{0.5 * (range.x0 + range.x1) * side.x, 0.5 * (range.y0 + range.y1) * side.y} - instance.offset;
    const double reach = std::max(-feature.left, feature.right);
    const double margin = 0.5 * (columns * side.x + rows * side.y) + kNearMargin + 1.0;
    const Foot foot = foot_of(feature.frame, p);
    const bool near = foot.distance < reach + margin ||
                      reach_at(feature.frame, p, foot, -reach, reach, margin).possible ||
                      (columns * rows > 1 && !is_tame(feature.frame, foot, margin));
    if (!near) return;
    if (columns * rows == 1) return visit(static_cast<std::size_t>(range.y0) * layout.tile_columns + range.x0);
    TileRange first = range, second = range;
    if (columns >= rows)
        first.x1 = second.x0 = range.x0 + columns / 2;
    else
        first.y1 = second.y0 = range.y0 + rows / 2;
    for_tiles(layout, instance, first, visit);
    for_tiles(layout, instance, second, visit);
}

void list_by_tile(Layout& layout) {
    const std::size_t tiles = static_cast<std::size_t>(layout.tile_columns) * layout.tile_rows;
    std::vector<std::vector<std::uint32_t>> lists(tiles);
    for (std::uint32_t i = 0; i < layout.instances.size(); ++i) {
        const Instance& instance = layout.instances[i];
        const TileRange range = tiles_of(layout, grown_box(layout.features[instance.element]), instance.offset);
        for_tiles(layout, instance, range, [&](std::size_t tile) { lists[tile].push_back(i); });
    }
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

}  // namespace

Layout lay_out(const ResolvedPattern& pattern, int width, int height, Vec2 side, int threads) {
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
    lay_ground(layout, threads);
    return layout;
}

}  // namespace burin::refinement
