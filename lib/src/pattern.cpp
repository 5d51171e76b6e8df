#include <burin/pattern.hpp>

#include <algorithm>
#include <cmath>

namespace burin {

PathKind path_kind(const Pattern& pattern, const Path& path) {
    const std::vector<ProfilePoint>& points = pattern.profiles[path.profile].points;
    if (std::abs(points.back().h - points.front().h) > pattern.depth / 4096.0) return PathKind::step;
    double down = 0.0, up = 0.0;
    for (const ProfilePoint& p : points) down = std::min(down, p.h), up = std::max(up, p.h);
    return -down >= up ? PathKind::groove : PathKind::ridge;
}

}  // namespace burin
