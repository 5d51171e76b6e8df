#include "picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <burin/fit.hpp>
#include <burin/image_io.hpp>

namespace burin::bench {
namespace {

constexpr int kEnlarge = 16;

struct Colour {
    std::uint8_t red, green, blue;
};

class Canvas {
  public:
    Canvas(const Image& map, Vec2 corner, int side) : corner_(corner) {
        picture_.width = picture_.height = side * kEnlarge;
        picture_.texels.resize(static_cast<std::size_t>(picture_.width) * picture_.height * 4);
        for (int y = 0; y < picture_.height; ++y) {
            for (int x = 0; x < picture_.width; ++x) {
                const int u = std::clamp(static_cast<int>(corner.x) + x / kEnlarge, 0, map.width - 1);
                const int v = std::clamp(static_cast<int>(corner.y) + y / kEnlarge, 0, map.height - 1);
                const auto grey = static_cast<std::uint8_t>(60.0f + 180.0f * map.at(u, v));
                set(x, y, {grey, grey, grey});
            }
        }
    }

    void draw(const std::vector<Segment>& lines, Colour colour) {
        for (const Segment& s : lines) {
            const int steps = 1 + static_cast<int>(length(s.b - s.a) * kEnlarge);
            for (int k = 0; k <= steps; ++k) {
                const Vec2 p = lerp(s.a, s.b, double(k) / steps);
                const int x = static_cast<int>(std::floor((p.x - std::floor(corner_.x)) * kEnlarge));
                const int y = static_cast<int>(std::floor((p.y - std::floor(corner_.y)) * kEnlarge));
                if (x >= 0 && y >= 0 && x < picture_.width && y < picture_.height) set(x, y, colour);
            }
        }
    }

    const RgbaImage& picture() const { return picture_; }

  private:
    void set(int x, int y, Colour c) {
        std::uint8_t* texel = &picture_.texels[(static_cast<std::size_t>(y) * picture_.width + x) * 4];
        texel[0] = c.red, texel[1] = c.green, texel[2] = c.blue, texel[3] = 255;
    }

    Vec2 corner_;
    RgbaImage picture_;
};

}  // namespace

std::vector<Segment> chords_of(const Pattern& pattern, int texels) {
    constexpr int kChords = 8;
    std::vector<Segment> chords;
    for (const Path& path : pattern.paths)
        for (const Element& e : path.elements)
            for (int k = 0; k < kChords; ++k)
                chords.push_back({point_at(e, double(k) / kChords) * (texels / pattern.size.x),
                                  point_at(e, (k + 1.0) / kChords) * (texels / pattern.size.x)});
    return chords;
}

void write_close_up(const std::string& file, const Image& map, Vec2 corner, int side, const std::vector<Segment>& truth,
                    const std::vector<Segment>& ours, const std::vector<Segment>& paths) {
    Canvas canvas(map, corner, side);
    canvas.draw(truth, {0, 160, 0});
    canvas.draw(paths, {0, 60, 255});
    canvas.draw(ours, {220, 0, 0});
    const Status written = write_png(file, canvas.picture());
    if (written.ok()) return;
    std::fprintf(stderr, "bench: %s\n", written.error().message.c_str());
    std::exit(3);
}

}  // namespace burin::bench
