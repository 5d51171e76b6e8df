// Contours by marching squares. A cell is the square between four neighbouring samples; a side is the segment
// between two of them. A contour enters a cell by one side and leaves by another; following it from cell to
// cell gives chains.
#include <burin/contour.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <cstddef>

namespace burin {

namespace {

// Sides of a cell: 0 top, 1 right, 2 bottom, 3 left. Corners: 0 top left, 1 top right, 2 bottom right, 3
// bottom left. Side i joins corner i and corner i + 1, except that the left side joins corner 3 and corner 0.
//
// Direction: high values on the left of the way, b < 0 with n = (-t.y, t.x). With v down, n points to the
// right on screen, so high lies to the left on screen: a contour enters a cell by a side whose corners,
// clockwise on screen, go from low to high, and leaves by one where they go from high to low.
class Tracer {
  public:
    Tracer(const Image& image, float level, bool wrap)
        : image_(image),
          level_(level),
          wrap_(wrap),
          columns_(wrap ? image.width : image.width - 1),
          rows_(wrap ? image.height : image.height - 1),
          done_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

    std::vector<Contour> run();

  private:
    struct Crossing {
        int x, y;   // cell, unwrapped
        int enter;  // side by which the contour enters it
    };

    bool high(int x, int y) const { return image_.at(column(x), row(y)) >= level_; }
    int column(int x) const { return wrap_ ? (x % image_.width + image_.width) % image_.width : x; }
    int row(int y) const { return wrap_ ? (y % image_.height + image_.height) % image_.height : y; }
    float sample(int x, int y) const { return image_.at(column(x), row(y)); }
    bool inside(int x, int y) const { return wrap_ || (x >= 0 && y >= 0 && x < columns_ && y < rows_); }
    std::uint8_t& done(int x, int y) {
        return done_[static_cast<std::size_t>(row(y)) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(column(x))];
    }

    std::array<bool, 4> corners(int x, int y) const {
        return {high(x, y), high(x + 1, y), high(x + 1, y + 1), high(x, y + 1)};
    }
    bool enters_by(const std::array<bool, 4>& c, int side) const {
        return !c[static_cast<std::size_t>(side)] && c[static_cast<std::size_t>((side + 1) % 4)];
    }
    int leave_side(int x, int y, int enter) const;
    Vec2 point_on(int x, int y, int side) const;
    Contour follow(Crossing start);
    void trace_from(int x, int y, bool from_border, std::vector<Contour>& out);

    const Image& image_;
    float level_;
    bool wrap_;
    int columns_, rows_;              // of cells
    std::vector<std::uint8_t> done_;  // bit i: the contour that enters by side i has been traced
};

int Tracer::leave_side(int x, int y, int enter) const {
    const std::array<bool, 4> c = corners(x, y);
    const bool saddle = c[0] == c[2] && c[1] == c[3] && c[0] != c[1];
    if (saddle) {
        // Entering by side i, corner i is low and i + 1 high. Where the middle is high, the low corner i is
        // cut off and the way out is the side before; where it is low, the high corner i + 1 is cut off.
        const double mean =
            (static_cast<double>(sample(x, y)) + static_cast<double>(sample(x + 1, y)) +
             static_cast<double>(sample(x + 1, y + 1)) + static_cast<double>(sample(x, y + 1))) *
            0.25;
        return mean >= static_cast<double>(level_) ? (enter + 3) % 4 : (enter + 1) % 4;
    }
    for (int side = 0; side < 4; ++side)
        if (c[static_cast<std::size_t>(side)] && !c[static_cast<std::size_t>((side + 1) % 4)]) return side;
    assert(false && "a contour that enters a cell leaves it");
    return enter;
}

Vec2 Tracer::point_on(int x, int y, int side) const {
    // Always interpolated from the left or upper sample, so that both cells of a side get the same bits.
    const bool horizontal = side == 0 || side == 2;
    const int ax = side == 1 ? x + 1 : x, ay = side == 2 ? y + 1 : y;
    const double a = static_cast<double>(sample(ax, ay));
    const double b = static_cast<double>(horizontal ? sample(ax + 1, ay) : sample(ax, ay + 1));
    // 1e-4 keeps points apart that would fall on one sample.
    const double t = std::clamp((static_cast<double>(level_) - a) / (b - a), 1e-4, 1.0 - 1e-4);
    return {ax + 0.5 + (horizontal ? t : 0.0), ay + 0.5 + (horizontal ? 0.0 : t)};
}

Contour Tracer::follow(Crossing start) {
    Contour contour;
    constexpr std::array<int, 4> dx{0, 1, 0, -1}, dy{-1, 0, 1, 0};
    Crossing at = start;
    while (true) {
        contour.points.push_back(point_on(at.x, at.y, at.enter));
        done(at.x, at.y) = static_cast<std::uint8_t>(done(at.x, at.y) | 1u << at.enter);
        const int leave = leave_side(at.x, at.y, at.enter);
        const Crossing next{at.x + dx[static_cast<std::size_t>(leave)],
                            at.y + dy[static_cast<std::size_t>(leave)], (leave + 2) % 4};
        if (!inside(next.x, next.y)) {
            contour.points.push_back(point_on(at.x, at.y, leave));
            return contour;
        }
        if (next.enter == start.enter && column(next.x) == column(start.x) && row(next.y) == row(start.y)) {
            contour.closed = true;
            contour.period = {static_cast<double>(next.x - start.x), static_cast<double>(next.y - start.y)};
            return contour;
        }
        at = next;
    }
}

void Tracer::trace_from(int x, int y, bool from_border, std::vector<Contour>& out) {
    const std::array<bool, 4> c = corners(x, y);
    constexpr std::array<int, 4> dx{0, 1, 0, -1}, dy{-1, 0, 1, 0};
    for (int side = 0; side < 4; ++side) {
        if (!enters_by(c, side) || (done(x, y) >> side & 1u)) continue;
        const bool border =
            !inside(x + dx[static_cast<std::size_t>(side)], y + dy[static_cast<std::size_t>(side)]);
        if (from_border && !border) continue;
        out.push_back(follow({x, y, side}));
    }
}

std::vector<Contour> Tracer::run() {
    std::vector<Contour> out;
    // Chains that begin at the border first: a loop must not be started in the middle of one of them.
    if (!wrap_) {
        for (int y = 0; y < rows_; ++y) {
            const bool whole_row = y == 0 || y == rows_ - 1;
            for (int x = 0; x < columns_; x += whole_row ? 1 : std::max(1, columns_ - 1))
                trace_from(x, y, true, out);
        }
    }
    for (int y = 0; y < rows_; ++y)
        for (int x = 0; x < columns_; ++x) trace_from(x, y, false, out);
    return out;
}

}  // namespace

double enclosed_area(const Contour& contour) {
    if (!contour.closed || contour.period.x != 0.0 || contour.period.y != 0.0) return 0.0;
    double twice = 0.0;
    const std::vector<Vec2>& p = contour.points;
    for (std::size_t i = 0; i < p.size(); ++i) twice += cross(p[i] - p[0], p[(i + 1) % p.size()] - p[0]);
    return 0.5 * twice;
}

std::vector<Contour> trace_contours(const Image& image, float level, bool wrap) {
    assert(image.width >= 2 && image.height >= 2);
    return Tracer(image, level, wrap).run();
}

}  // namespace burin
