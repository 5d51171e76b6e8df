// Closings, openings and dilations by squares, tile by tile, so that all that lies between the map and the result stays in
// the cache, and tiles of level ground cost next to nothing.
#include "vectorize_hat.hpp"

#include <algorithm>
#include <cmath>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

constexpr int kSide = 256;  // of a tile of the result

// Texels of the map, copied with some around them.
struct Tile {
    int width = 0, height = 0;
    std::vector<float> texels;

    float* row(int y) { return &texels[static_cast<std::size_t>(y) * width]; }
};

struct Rect {
    int x = 0, y = 0, width = 0, height = 0;
};

std::vector<Rect> tiles_of(const Lattice& lattice) {
    std::vector<Rect> tiles;
    for (int y = 0; y < lattice.height; y += kSide)
        for (int x = 0; x < lattice.width; x += kSide)
            tiles.push_back({x, y, std::min(kSide, lattice.width - x), std::min(kSide, lattice.height - y)});
    return tiles;
}

void copy_around(const Image& map, const Lattice& lattice, const Rect& rect, int margin, Tile& tile) {
    tile.width = rect.width + 2 * margin;
    tile.height = rect.height + 2 * margin;
    tile.texels.resize(static_cast<std::size_t>(tile.width) * tile.height);
    const int left = rect.x - margin, inside = std::clamp(-left, 0, tile.width);
    const int outside = std::clamp(lattice.width - left, inside, tile.width);
    for (int y = 0; y < tile.height; ++y) {
        const float* source = &map.texels[lattice.nearest(0, rect.y - margin + y)];
        float* row = tile.row(y);
        for (int x = 0; x < inside; ++x) row[x] = source[lattice.nearest(left + x, 0)];
        std::copy(source + left + inside, source + left + outside, row + inside);
        for (int x = outside; x < tile.width; ++x) row[x] = source[lattice.nearest(left + x, 0)];
    }
}

struct Greatest {
    float operator()(float a, float b) const { return a > b ? a : b; }
};
struct Least {
    float operator()(float a, float b) const { return a < b ? a : b; }
};

// v[i] becomes the extreme of v[i .. i + window), for all i up to count - window: windows of twice the length from two of
// half the length, and the last from two that overlap.
template <typename Extreme>
void slide_row(float* v, int count, int window, const Extreme& extreme) {
    int length = 1;
    for (; 2 * length <= window; length *= 2) {
        const int end = count - 2 * length + 1;
        for (int i = 0; i < end; ++i) v[i] = extreme(v[i], v[i + length]);
    }
    const int end = count - window + 1, offset = window - length;
    if (offset > 0)
        for (int i = 0; i < end; ++i) v[i] = extreme(v[i], v[i + offset]);
}

// The same down a strip of kStrip columns of a tile.
constexpr int kStrip = 16;

template <typename Extreme>
void slide_strip(Tile& tile, int x, int window, const Extreme& extreme) {
    const int columns = std::min(kStrip, tile.width - x);
    const auto combine = [&](int y, int offset) {
        float* a = tile.row(y) + x;
        const float* b = tile.row(y + offset) + x;
        if (columns == kStrip)
            for (int i = 0; i < kStrip; ++i) a[i] = extreme(a[i], b[i]);
        else
            for (int i = 0; i < columns; ++i) a[i] = extreme(a[i], b[i]);
    };
    int length = 1;
    for (; 2 * length <= window; length *= 2)
        for (int y = 0; y + 2 * length <= tile.height; ++y) combine(y, length);
    if (window > length)
        for (int y = 0; y + window <= tile.height; ++y) combine(y, window - length);
}

// The extreme over the square around each texel; the tile loses `radius` texels at every side.
template <typename Extreme>
void slide_square(Tile& tile, int radius, const Extreme& extreme) {
    const int window = 2 * radius + 1, width = tile.width - 2 * radius;
    for (int y = 0; y < tile.height; ++y) {
        slide_row(tile.row(y), tile.width, window, extreme);
        std::copy(tile.row(y), tile.row(y) + width, &tile.texels[static_cast<std::size_t>(y) * width]);
    }
    tile.width = width;
    for (int x = 0; x < width; x += kStrip) slide_strip(tile, x, window, extreme);
    tile.height -= 2 * radius;
}

// Whether the tile's values differ by more than `least`.
bool varies(const Tile& tile, double least) {
    float low = tile.texels[0], high = low;
    for (const float v : tile.texels) {
        low = Least()(low, v);
        high = Greatest()(high, v);
    }
    return high - low > least;
}

// The closing (opening) of a tile of the map, or false where there is nothing to fill.
bool close_tile(const Image& map, const Lattice& lattice, ChainKind kind, int radius, double least, const Rect& rect, Tile& tile) {
    copy_around(map, lattice, rect, 2 * radius, tile);
    if (!varies(tile, least)) return false;
    if (kind == ChainKind::groove) {
        slide_square(tile, radius, Greatest());
        slide_square(tile, radius, Least());
    } else {
        slide_square(tile, radius, Least());
        slide_square(tile, radius, Greatest());
    }
    return true;
}

float sign_of(ChainKind kind) { return kind == ChainKind::groove ? 1.0f : -1.0f; }

}  // namespace

double least_response(double noise) { return std::max(4.0 * noise, 0.012); }

int square_radius(double radius) { return std::max(2, static_cast<int>(std::lround(radius))); }

Image hat_response(const Image& map, const Lattice& lattice, ChainKind kind, int radius, double least) {
    Image out(map.width, map.height);
    const std::vector<Rect> tiles = tiles_of(lattice);
    const float sign = sign_of(kind);
    for_each_piece(tiles.size(), lattice.threads, [&](std::size_t k) {
        thread_local Tile tile;
        const Rect& rect = tiles[k];
        if (!close_tile(map, lattice, kind, radius, least, rect, tile)) return;
        for (int y = 0; y < rect.height; ++y) {
            const std::size_t first = static_cast<std::size_t>(rect.y + y) * map.width + rect.x;
            const float* closed = tile.row(y);
            for (int x = 0; x < rect.width; ++x) out.texels[first + x] = sign * (closed[x] - map.texels[first + x]);
        }
    });
    return out;
}

std::vector<float> hat_at(const Image& map, const Lattice& lattice, ChainKind kind, int radius, double least,
                          const std::vector<int>& texels) {
    const std::vector<Rect> tiles = tiles_of(lattice);
    const int columns = (lattice.width + kSide - 1) / kSide;
    std::vector<std::vector<std::size_t>> asked(tiles.size());
    for (std::size_t k = 0; k < texels.size(); ++k)
        asked[static_cast<std::size_t>(texels[k] / lattice.width / kSide) * columns + texels[k] % lattice.width / kSide].push_back(k);
    std::vector<float> out(texels.size(), 0.0f);
    for_each_piece(tiles.size(), lattice.threads, [&](std::size_t t) {
        thread_local Tile tile;
        if (asked[t].empty() || !close_tile(map, lattice, kind, radius, least, tiles[t], tile)) return;
        for (const std::size_t k : asked[t]) {
            const int x = texels[k] % lattice.width - tiles[t].x, y = texels[k] / lattice.width - tiles[t].y;
            out[k] = sign_of(kind) * (tile.row(y)[x] - map.texels[texels[k]]);
        }
    });
    return out;
}

std::vector<std::uint8_t> strong_mask(const Image& response, const Lattice& lattice, int radius, double least) {
    std::vector<std::uint8_t> mask(response.texels.size(), 0);
    const std::vector<Rect> tiles = tiles_of(lattice);
    for_each_piece(tiles.size(), lattice.threads, [&](std::size_t k) {
        thread_local Tile tile;
        const Rect& rect = tiles[k];
        copy_around(response, lattice, rect, radius, tile);
        if (*std::max_element(tile.texels.begin(), tile.texels.end()) <= least) return;
        slide_square(tile, radius, Greatest());
        for (int y = 0; y < rect.height; ++y) {
            const std::size_t first = static_cast<std::size_t>(rect.y + y) * response.width + rect.x;
            const float* peak = tile.row(y);
            for (int x = 0; x < rect.width; ++x)
                mask[first + x] = response.texels[first + x] > Greatest()(0.4f * peak[x], static_cast<float>(least));
        }
    });
    return mask;
}

}  // namespace burin::vectorizing
