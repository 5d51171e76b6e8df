#include "gl/sample_places.hpp"

#include <algorithm>
#include <cmath>

namespace burin::gl {

namespace {

// Place within a cell, 0 to 1: the odd ones first, so that neighbours lie apart.
double within_cell(int line, int side) {
    const int turn = line < side / 2 ? 2 * line + 1 : 2 * (line - side / 2);
    return side < 4 ? 0.5 : 0.25 + 0.5 * (turn + 0.5) / side;
}

}  // namespace

Vec2 spread_place(int column, int row, int side) {
    return {(column + within_cell(row, side)) / side - 0.5, (row + within_cell(column, side)) / side - 0.5};
}

std::vector<Vec2> sample_places(int side, bool filtered) {
    std::vector<Vec2> places;
    for (int k = 0; k < side * side; ++k) {
        const int column = k % side, row = k / side;
        places.push_back(filtered ? Vec2{(column + 0.5) / side - 0.5, (row + 0.5) / side - 0.5} : spread_place(column, row, side));
    }
    for (std::size_t i = 0; i < 4 && places.size() > 4; ++i) {
        // Corners of a square turned by about 27 degrees.
        const double turn = 0.4636 + 1.5708 * double(i);
        const Vec2 wish{0.28 * std::cos(turn), 0.28 * std::sin(turn)};
        const auto nearer = [&](Vec2 a, Vec2 b) { return length(a - wish) < length(b - wish); };
        std::iter_swap(places.begin() + std::ptrdiff_t(i), std::min_element(places.begin() + std::ptrdiff_t(i), places.end(), nearer));
    }
    return places;
}

std::vector<Vec2> ray_places(int side, Vec2 sample, int samples) {
    const int first_column = int((sample.x + 0.5) * samples) * side, first_row = int((sample.y + 0.5) * samples) * side;
    std::vector<Vec2> places;
    for (int k = 0; k < side * side; ++k)
        places.push_back((spread_place(first_column + k % side, first_row + k / side, side * samples) - sample) * double(samples));
    return places;
}

}  // namespace burin::gl
