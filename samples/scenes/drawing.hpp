// How scenes are drawn: chains of lines and curves in metres, and the cross-sections they carry. x right, y down.
#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

#include <burin/pattern.hpp>

namespace burin::scenes {

inline constexpr double kPi = std::numbers::pi;

// A chain of elements; each piece begins where the one before it ended.
class Stroke {
  public:
    explicit Stroke(Vec2 start) : at_(start) {}

    Stroke& line(Vec2 to);
    Stroke& curve(Vec2 control, Vec2 to);
    // Along a circle by `turn` radians (clockwise on screen when positive), quadratics of at most `piece` radians.
    Stroke& arc(Vec2 centre, double turn, double piece = kPi / 6);
    // Ends at the very start, by a line where the chain has not come back to it.
    Stroke& close();
    // Ends where it began, one tile on.
    Stroke& close_across();

    // As a path of this profile.
    Path path(std::uint32_t profile, std::uint32_t material = 0, double level = 0.0) const;

  private:
    Path path_;
    Vec2 at_;
};

Stroke polyline(const std::vector<Vec2>& points);
Stroke polygon(const std::vector<Vec2>& points);
Stroke circle(Vec2 centre, double radius, double piece = kPi / 6);
// Rectangle with round corners, clockwise on screen: its inside is to the right.
Stroke slab(Vec2 centre, Vec2 half, double radius);
// A smooth curve through at(0) ... at(1) by `pieces` quadratics that keep its tangents; lines where it bends both ways.
Stroke smooth(const std::function<Vec2(double)>& at, int pieces);

// Every point moved by `to` (isometries and scalings; curves stay quadratics under them).
Path mapped(Path path, const std::function<Vec2(Vec2)>& to);
// Every length of the pattern times `factor`, > 0: the same relief, larger.
Pattern enlarged(Pattern pattern, double factor);
// To the area of a tile of that size, evenly, so that circles stay round where the uvs are.
Pattern enlarged_to(Pattern pattern, Vec2 size);

// Width and height scales by arc length, from 0 at the start to 1 at the end. Elements are cut into pieces until the
// straight run of the scales between their ends stays within `tolerance` of the functions.
Path scaled(const Path& path, const std::function<double(double)>& width, const std::function<double(double)>& height,
            double tolerance);
// Sine along the path: width and height scale 1 + amplitude sin(2 pi s / wavelength), `wavelength` in metres, rounded to
// a whole number of waves on a closed path.
Path with_sine(const Path& path, double width_amplitude, double height_amplitude, double wavelength);
double path_length(const Path& path);

// Joints of a wall or floor laid in courses over the whole tile, each course shifted by half a stone against the one before it.
void add_courses(Pattern& pattern, int courses, int stones, std::uint32_t profile, std::uint32_t material = 0);

// Cross-sections, metres. Halves are widths from the path line to where the ground begins.
Profile vee(double half, double deep);
Profile trough(double half, double floor, double deep);   // flat floor of half width `floor`
Profile ridge(double half, double top, double high);      // flat top of half width `top`
Profile round_groove(double half, double deep, int facets);
Profile lipped(double half, double deep, double lip);     // material thrown up on both sides
Profile scratch(double half, double deep, double lip);    // seven points, uneven: what a hard grain leaves
Profile rail(double foot, double head, double high);      // wider above than below
Profile undercut(double mouth, double floor, double deep);
Profile rise(double half, double high);                   // step up from left to right
Profile moulding(double half, double high);               // step up with a ledge before it

// Chance, the same on every machine.
class Chance {
  public:
    explicit Chance(std::uint64_t seed) : engine_(seed) {}
    double uniform() { return double(engine_() >> 11) * 0x1p-53; }  // [0, 1)
    double between(double low, double high) { return low + (high - low) * uniform(); }
    int below(int n) { return int(uniform() * n); }

  private:
    std::mt19937_64 engine_;
};

// Outlines of a line of capitals `height` high from the upper left corner `at`, as step paths with the letter on their
// right side: bodies clockwise on screen, holes the other way. Known: A B E G I L N O R S T U V and space.
std::vector<Path> outlines(std::string_view text, double height, Vec2 at, std::uint32_t profile);
double width_of(std::string_view text, double height);

}  // namespace burin::scenes
