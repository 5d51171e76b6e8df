#include "gl/sample_places.hpp"

#include <algorithm>
#include <cmath>

#include "gl/pixel_filter.h"

namespace burin::gl {
namespace {

Vec2 middle_of(int column, int row, int side) { return {(column + 0.5) / side - 0.5, (row + 0.5) / side - 0.5}; }

// From the middle of a cell, in cells.
double shift_of(int line, int side) { return side < LEAST_MOVED_SIDE ? 0.0 : (MOVED_TURN(line, side) + 0.5) / side - 0.5; }

// Moves the place to `index` that is nearest to `wish` of those from there on.
template <typename Place, typename Middle>
void bring_nearest(std::vector<Place>& places, std::size_t index, Vec2 wish, const Middle& middle) {
    const auto nearer = [&](const Place& a, const Place& b) { return length(middle(a) - wish) < length(middle(b) - wish); };
    const auto to = places.begin() + std::ptrdiff_t(index);
    std::iter_swap(to, std::min_element(to, places.end(), nearer));
}

std::vector<Vec2> square_places(int side) {
    std::vector<Vec2> places;
    for (int k = 0; k < side * side; ++k) places.push_back(middle_of(k % side, k / side, side));
    for (std::size_t i = 0; i < 4 && places.size() > 4; ++i) {
        // Corners of a square turned by about 27 degrees.
        const double turn = 0.4636 + 1.5708 * double(i);
        const Vec2 wish{0.28 * std::cos(turn), 0.28 * std::sin(turn)};
        bring_nearest(places, i, wish, [](Vec2 place) { return place; });
    }
    return places;
}

}  // namespace

SampleGrid sample_grid(int count, bool areas) {
    if (count == 2 && areas) return {1, {{-0.25, 0.0}, {0.25, 0.0}}, {0.5, 1.0}};
    if (count == 2) return {1, {{-0.25, -0.25}, {0.25, 0.25}}, {0.5, 0.5}};
    const int side = int(std::ceil(std::sqrt(double(count)) - 1e-9));
    return {side, square_places(side), {1.0 / side, 1.0 / side}};
}

RayCell first_ray_cell(int side, Vec2 sample, int samples) {
    return {int((sample.x + 0.5) * samples) * side, int((sample.y + 0.5) * samples) * side};
}

std::vector<RayPlace> ray_places(int side, Vec2 sample, int samples) {
    const RayCell first = first_ray_cell(side, sample, samples);
    const int cells = side * samples;
    std::vector<RayPlace> places;
    for (int k = 0; k < side * side; ++k) {
        const int column = k % side, row = k / side;
        const Vec2 shift{shift_of(first.row + row, cells), shift_of(first.column + column, cells)};
        places.push_back({middle_of(column, row, side), shift * (1.0 / side)});
    }
    // Quarters row by row.
    constexpr Vec2 kFirst[] = {{-0.26, -0.13}, {0.13, -0.26}, {-0.13, 0.26}, {0.26, 0.13}};
    for (std::size_t i = 0; i < 4; ++i) bring_nearest(places, i, kFirst[i], [](const RayPlace& place) { return place.middle; });
    return places;
}

}  // namespace burin::gl
