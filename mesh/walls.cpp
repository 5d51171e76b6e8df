#include "walls.hpp"

#include <algorithm>
#include <cmath>

namespace burin::mesh {

using reference::Brush;
using reference::Vec3;

std::span<const std::uint32_t> Walls::brushes_of(std::int32_t triangle) const {
    return triangle == kBorder ? std::span<const std::uint32_t>{} : columns_.brushes_of(static_cast<std::size_t>(triangle));
}

bool Walls::reaches(const Brush& brush, bool cut, const Vec3& at) const {
    const Vec2 p{at.x, at.y};
    return brush.cut == cut && (!brush.has_bottom || brush.bottom.at(p) < at.z) && (!brush.has_top || brush.top.at(p) > at.z);
}

std::uint32_t Walls::first_beyond(std::int32_t there, std::int32_t here, bool cut, const Vec3& at) const {
    std::uint32_t first = kGround;
    for (const std::uint32_t i : brushes_of(there)) {
        const Brush& brush = geometry_.brushes[i];
        if (!reaches(brush, cut, at)) continue;
        const auto goes_on = [&](std::uint32_t k) { return geometry_.brushes[k].instance == brush.instance && reaches(geometry_.brushes[k], cut, at); };
        const auto others = brushes_of(here);
        if (std::any_of(others.begin(), others.end(), goes_on)) continue;
        // The ground's number is above all others.
        first = std::min(first, gathered_.instances[brush.instance].element);
    }
    return first;
}

std::uint32_t Walls::element_of(std::int32_t solid, std::int32_t open, std::uint32_t step, const Vec3& at) const {
    const auto level = [&](std::int32_t t) { return levels_[static_cast<std::size_t>(t)]; };
    if (step != kNoStep && solid != kBorder && open != kBorder && std::abs(level(solid) - level(open)) > level_tolerance_) return step;
    const std::uint32_t cutter = first_beyond(open, solid, true, at);
    return cutter != kGround ? cutter : first_beyond(solid, open, false, at);
}

}  // namespace burin::mesh
