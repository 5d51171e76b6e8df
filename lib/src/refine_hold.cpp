#include "refine_hold.hpp"

#include <algorithm>
#include <cmath>

namespace burin::refinement {
namespace {

constexpr double kReach = 2.0;  // texels from a crossing

// How far `at` lies outside the range of three coordinates; of the copies of a tile the nearest.
double beyond(double at, double a, double b, double c, double tile, bool repeats) {
    const double low = std::min({a, b, c}), high = std::max({a, b, c});
    if (repeats) at -= tile * std::round((at - 0.5 * (low + high)) / tile);
    return std::max(low - at, at - high);
}

bool lies_near(const Element& e, Vec2 p, const Pattern& pattern) {
    const bool repeats = pattern.wrap == Wrap::repeat;
    return beyond(p.x, e.p0.x, e.p1.x, e.p2.x, pattern.size.x, repeats) <= kReach &&
           beyond(p.y, e.p0.y, e.p1.y, e.p2.y, pattern.size.y, repeats) <= kReach;
}

}  // namespace

std::vector<std::uint8_t> resolving_paths(const Pattern& pattern, const ResolvedPattern& resolved) {
    std::vector<std::uint8_t> resolves(pattern.paths.size(), 0);
    for (const ResolvedElement& element : resolved.elements) resolves[element.path] = 1;
    return resolves;
}

std::vector<std::size_t> lost_paths(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after) {
    std::vector<std::size_t> lost;
    for (std::size_t path = 0; path < std::min(before.size(), after.size()); ++path)
        if (before[path] && !after[path]) lost.push_back(path);
    return lost;
}

void hold_crossings(const std::vector<StepCrossing>& crossings, const Pattern& next, Parameters& parameters) {
    for (const StepCrossing& crossing : crossings) {
        for (const std::uint32_t path : crossing.path) {
            const std::vector<Element>& elements = next.paths[path].elements;
            for (std::size_t i = 0; i < elements.size(); ++i)
                if (lies_near(elements[i], crossing.position, next))
                    parameters.hold(static_cast<int>(path), static_cast<int>(i));
        }
    }
}

void hold_paths(const std::vector<std::size_t>& paths, const std::vector<ElementUnknowns>& elements, Parameters& parameters) {
    for (const ElementUnknowns& element : elements)
        if (element.path >= 0 && std::binary_search(paths.begin(), paths.end(), static_cast<std::size_t>(element.path)))
            parameters.hold(element.unknowns);
}

}  // namespace burin::refinement
