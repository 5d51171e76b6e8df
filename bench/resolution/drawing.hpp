// How the benches draw: strokes of lines and arcs, and pens of a width and a height, become a pattern.
//
//     Drawing d(512, 2.0);
//     d.draw(d.groove(8.0, 0.5), Stroke({10, 20}).line({90, 20}).arc({90, 40}, 20, -kQuarter, 0));
//     const Pattern pattern = d.take();
//
// The sheet is one square metre of 512 x 512 units, x to the right, y down; angles turn from +x towards +y. Widths are
// in texels of the map that will be made of it, heights in map scale (1 = object surface).
#pragma once

#include <vector>

#include <burin/pattern.hpp>

namespace burin::bench {

inline constexpr double kSheet = 512.0;  // units of a side
inline constexpr double kQuarter = 1.5707963267948966;

// A chain of elements in units. Each piece begins where the one before it ended.
class Stroke {
  public:
    explicit Stroke(Vec2 start) : at_(start) {}

    Stroke& line(Vec2 to);
    // Quadratics of at most about 22 degrees along a circle; where the chain ends elsewhere, its end counts.
    Stroke& arc(Vec2 centre, double radius, double from, double to);
    Stroke& quadratic(Vec2 control, Vec2 to);
    // Ends at the very start, by a line where the chain has not come back to it.
    Stroke& close();
    // Ends where it began, one or more tiles on: for sheets that repeat.
    Stroke& close_across();
    // Scales of width and height along the chain: at its start, at equal steps by element count, at its end.
    Stroke& taper(const std::vector<double>& widths, const std::vector<double>& heights = {1.0});
    // Scaled, then turned by `angle`, then moved by `shift`.
    Stroke placed(double scale, double angle, Vec2 shift) const;

    const std::vector<Element>& elements() const { return elements_; }
    bool closed() const { return closed_; }

  private:
    std::vector<Element> elements_;
    Vec2 at_;
    bool closed_ = false;
};

Stroke polyline(const std::vector<Vec2>& points, bool closed = false);
Stroke arc(Vec2 centre, double radius, double from, double to);
Stroke circle(Vec2 centre, double radius);
// A rectangle with round corners, turned by `angle`; clockwise on screen, so its inside is to the right.
Stroke slab(Vec2 centre, Vec2 half, double radius, double angle);

// What a stroke is drawn with.
struct Pen {
    std::uint32_t profile = 0;
    double level = 0.0;  // metres; of a step: the ground on its left
};

class Drawing {
  public:
    // `texels`: side of the map. `wall`: width of every wall, texels; 0: vertical. `ground`: level 0 in map scale.
    Drawing(int texels, double wall, double ground = 0.5, Wrap wrap = Wrap::clamp);

    // Width at half the height. One narrower than a wall comes to a point.
    Pen groove(double width, double depth);
    Pen ridge(double width, double height) { return groove(width, -height); }
    // The right side of the stroke is higher by `height`.
    Pen step(double height);
    // The pen on ground of another level: map scale above `ground`.
    Pen on(Pen pen, double level) const;

    void draw(Pen pen, const Stroke& stroke);

    Pattern take() { return std::move(pattern_); }

  private:
    std::uint32_t add(Profile profile);

    Pattern pattern_;
    double texel_, ramp_;  // metres; of a wall: half its width
};

}  // namespace burin::bench
