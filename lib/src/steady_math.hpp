// Functions of <cmath> whose last digits differ between libraries, built of + - * / and floor alone, so that what is generated has
// equal bytes on every machine. Each is exact to about 1e-14 of its value's range; sqrt, floor and ldexp are exact everywhere already.
#pragma once

#include <cmath>

#include <burin/geometry.hpp>

namespace burin::steady {

// Cosine (x) and sine (y) of `turns` full turns; any finite number of them.
inline Vec2 direction(double turns) {
    constexpr double kQuarter = 1.5707963267948966;
    const double quarters = std::floor(4.0 * turns + 0.5);
    const double angle = (4.0 * turns - quarters) * kQuarter, square = angle * angle;  // within an eighth of a turn of 0
    double sine = 1.0, cosine = 1.0;
    for (int k = 18; k >= 2; k -= 2) {
        sine = 1.0 - square / (k * (k + 1.0)) * sine;
        cosine = 1.0 - square / (k * (k - 1.0)) * cosine;
    }
    sine *= angle;
    switch (static_cast<int>(quarters - 4.0 * std::floor(quarters / 4.0))) {
        case 0: return {cosine, sine};
        case 1: return {-sine, cosine};
        case 2: return {-cosine, -sine};
        default: return {sine, -cosine};
    }
}

// e to the x, |x| < 700.
inline double exponential(double x) {
    constexpr double kLog2 = 0.6931471805599453;
    const double halvings = std::floor(x / kLog2 + 0.5), rest = x - halvings * kLog2;
    double sum = 1.0;
    for (int k = 16; k >= 1; --k) sum = 1.0 + rest / k * sum;
    return std::ldexp(sum, static_cast<int>(halvings));
}

// Unlike length() of geometry.hpp without care for overflow; hypot is not the same everywhere.
inline double distance(Vec2 a) { return std::sqrt(a.x * a.x + a.y * a.y); }

}  // namespace burin::steady
