#include <burin/residual.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include <burin/format/texels.hpp>

#include "parallel.hpp"
#include "residual_fit.hpp"

namespace burin {
namespace {

using namespace residual;

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

// Slopes of both maps, and the sizes that a residual may have.
struct Scene {
    const Image& map;
    SlopeReader source, paths;
    Wrap wrap;
    int threads;
};

// Interpolated; x and y in texels of the grid.
Slope bilinear(const SlopeGrid& grid, float x, float y, Wrap wrap) {
    const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
    const float ax = x - 0.5f - left, ay = y - 0.5f - top;
    const int x0 = wrapped(static_cast<int>(left), grid.width, wrap), x1 = wrapped(static_cast<int>(left) + 1, grid.width, wrap);
    const int y0 = wrapped(static_cast<int>(top), grid.height, wrap), y1 = wrapped(static_cast<int>(top) + 1, grid.height, wrap);
    const auto at = [&](int i, int j) {
        return grid.slopes[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(i)];
    };
    const Slope a = at(x0, y0), b = at(x1, y0), c = at(x0, y1), d = at(x1, y1);
    const auto mix = [&](float p, float q, float r, float s) {
        return (p * (1 - ax) + q * ax) * (1 - ay) + (r * (1 - ax) + s * ax) * ay;
    };
    return {mix(a.x, b.x, c.x, d.x), mix(a.y, b.y, c.y, d.y)};
}

// Squared angle between the normals of two slopes, radians.
double squared_angle(Slope a, Slope b) {
    const float dx = a.x - b.x, dy = a.y - b.y, turn = a.x * b.y - a.y * b.x;
    const float angle = std::atan2(std::sqrt(dx * dx + dy * dy + turn * turn), 1.0f + a.x * b.x + a.y * b.y);
    return static_cast<double>(angle) * static_cast<double>(angle);
}

// A number below `range` that looks random and depends on the block alone.
int scattered(int x, int y, int range) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1u ^ static_cast<std::uint32_t>(y) * 0x85EBCA6Bu;
    h = (h ^ h >> 15) * 0x2C1B3C6Du;
    h ^= h >> 12;
    return static_cast<int>(h % static_cast<std::uint32_t>(range));
}

// Squared angle between what is drawn in a texel of the map and the map; without a grid, by the paths alone.
double squared_error(const Scene& scene, const SlopeGrid* grid, int x, int y) {
    Slope drawn = scene.paths.at(x, y);
    if (grid) {
        const float across = (static_cast<float>(x) + 0.5f) / static_cast<float>(scene.map.width);
        const float down = (static_cast<float>(y) + 0.5f) / static_cast<float>(scene.map.height);
        const Slope more = bilinear(*grid, across * static_cast<float>(grid->width), down * static_cast<float>(grid->height), scene.wrap);
        drawn = {drawn.x + more.x, drawn.y + more.y};
    }
    return squared_angle(drawn, scene.source.at(x, y));
}

// RMS angle in degrees, one texel in every block.
double normal_error(const Scene& scene, const SlopeGrid* grid) {
    constexpr double kMostSamples = 1 << 20;
    const int width = scene.map.width, height = scene.map.height;
    const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(width) * height / kMostSamples))));
    const int columns = (width + side - 1) / side, rows = (height + side - 1) / side;
    std::vector<double> sums(static_cast<std::size_t>(rows), 0.0);
    for_each_band(rows, scene.threads, [&](Band band) {
        for (int row = band.begin; row < band.end; ++row)
            for (int column = 0; column < columns; ++column) {
                const int pick = scattered(column, row, side * side);
                const int x = std::min(width - 1, column * side + pick % side), y = std::min(height - 1, row * side + pick / side);
                sums[static_cast<std::size_t>(row)] += squared_error(scene, grid, x, y);
            }
    });
    double sum = 0.0;
    for (const double s : sums) sum += s;
    return std::sqrt(sum / (static_cast<double>(columns) * rows)) * kDegrees;
}

// The codes of a grid, and what they stand for.
struct Coded {
    RgbaImage picture;
    double scale = 1.0;
    double error = 0.0;
    std::vector<std::uint8_t> png;  // once its size was asked for
};

// Every `step`th code, counted from that next to level.
std::uint8_t code_of(float part, int step = 1) {
    // Rounded as std::lround does, which is a call.
    const double scaled = (std::clamp(part, -1.0f, 1.0f) * 127.5f + 0.5f) / static_cast<float>(step);
    const long code = 127 + step * static_cast<long>(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);
    return static_cast<std::uint8_t>(std::clamp(code, 0L, 255L));
}

float value_of(std::uint8_t code) { return static_cast<float>(code) / 127.5f - 1.0f; }

// How far a scale's codes are off, squared: a slope that stands out turns the normal less than one near level ground.
double coding_error(const SlopeGrid& grid, float scale, int threads) {
    const auto off = [&](float value) {
        const float error = value_of(code_of(value / scale)) * scale - value;
        return error * error / ((1.0f + value * value) * (1.0f + value * value));
    };
    std::vector<double> sums(static_cast<std::size_t>(grid.height), 0.0);
    for_each_band(grid.height, threads, [&](Band band) {
        for (int y = band.begin; y < band.end; ++y) {
            const Slope* const row = &grid.slopes[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.width)];
            for (int x = 0; x < grid.width; ++x) sums[static_cast<std::size_t>(y)] += static_cast<double>(off(row[x].x) + off(row[x].y));
        }
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

// The scale that spends the 8 bits best: that of the steepest slope, or one that cuts it off.
float best_scale(const SlopeGrid& grid, int threads) {
    float steepest = 0.0f;
    for (const Slope& s : grid.slopes) steepest = std::max({steepest, std::abs(s.x), std::abs(s.y)});
    float best = std::max(steepest, 1e-6f);
    double least = coding_error(grid, best, threads);
    for (int halvings = 1; halvings <= 4; ++halvings) {
        const float trial = std::max(steepest, 1e-6f) / static_cast<float>(1 << halvings);
        const double error = coding_error(grid, trial, threads);
        if (error < least) least = error, best = trial;
    }
    return best;
}

// Codes the slopes, and puts in their place what the codes stand for.
Coded encode(SlopeGrid& grid, float scale, int step = 1) {
    Coded coded{{grid.width, grid.height, {}}, static_cast<double>(scale)};
    coded.picture.texels.reserve(grid.slopes.size() * 4);
    for (Slope& slope : grid.slopes) {
        const std::uint8_t red = code_of(-slope.x / scale, step), green = code_of(slope.y / scale, step);
        coded.picture.texels.insert(coded.picture.texels.end(), {red, green, 255, 255});
        slope = {-value_of(red) * scale, value_of(green) * scale};
    }
    return coded;
}

// Fields of half the map's sides, a quarter, ...: what grids are fitted to.
class Fields {
  public:
    explicit Fields(const Scene& scene) : scene_(scene) {
        fields_.push_back(measure_field(scene.source, scene.paths, scene.map.width, scene.map.height,
                                        std::max(1, scene.map.width / 2), std::max(1, scene.map.height / 2), scene.threads));
    }

    // The grid of the map's sides divided by 2^halvings. Blocks a quarter as wide as its texels are fine enough.
    SlopeGrid fit(int halvings) {
        const int width = std::max(1, scene_.map.width >> halvings), height = std::max(1, scene_.map.height >> halvings);
        if (halvings == 0) return measure_difference(scene_.source, scene_.paths, width, height, scene_.threads);
        const auto level = static_cast<std::size_t>(std::max(0, halvings - 3));
        while (fields_.size() <= level) fields_.push_back(halve(fields_.back()));
        return fit_slopes(fields_[level], width, height, scene_.wrap, scene_.threads);
    }

  private:
    const Scene& scene_;
    std::vector<SlopeField> fields_;
};

// Sizes that are allowed, the smallest first, as numbers of halvings.
std::vector<int> allowed_sizes(const Image& map, std::size_t most_texels) {
    constexpr int kLeastSide = 4;  // of the longer side
    std::vector<int> sizes;
    for (int halvings = 0; halvings == 0 || std::max(map.width, map.height) >> halvings >= kLeastSide; ++halvings) {
        const int width = std::max(1, map.width >> halvings), height = std::max(1, map.height >> halvings);
        const bool fits = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) <= most_texels;
        if (fits && std::max(width, height) <= BURIN_MAX_TEXTURE_SIDE) sizes.insert(sizes.begin(), halvings);
    }
    return sizes;
}

// Most texels of a residual that is welcome, but not needed to keep the tolerance.
std::size_t welcome_texels(const Scene& scene, const ResidualOptions& options) {
    return std::min(options.most_texels, scene.map.texels.size() / 64);
}

// A picture of the map's own size holds grain, which does not compress: codes as coarse as the error may be spare bytes.
void coarsen(const Scene& scene, Fields& fields, double error, Coded& coded) {
    for (const int step : {16, 8, 4, 2}) {
        SlopeGrid grid = fields.fit(0);
        Coded trial = encode(grid, static_cast<float>(coded.scale), step);
        trial.error = normal_error(scene, &grid);
        if (trial.error > error) continue;
        coded = std::move(trial);
        return;
    }
}

Coded code_size(const Scene& scene, Fields& fields, int halvings, double tolerance) {
    SlopeGrid grid = fields.fit(halvings);
    Coded coded = encode(grid, best_scale(grid, scene.threads));
    coded.error = normal_error(scene, &grid);
    if (halvings == 0) coarsen(scene, fields, tolerance / 2.0, coded);
    return coded;
}

Status encode_once(Coded& coded) {
    if (!coded.png.empty()) return Done{};
    auto png = encode_png(coded.picture);
    if (!png) return png.error();
    coded.png = std::move(*png);
    return Done{};
}

// What a residual is chosen by.
struct Wish {
    double error_without = 0.0;
    double enough = 0.0;     // error that ends the search
    double must_gain = 0.0;  // share of the error that it takes away at least
};

Wish wish_for(const ResidualOptions& options, double error_without) {
    constexpr double kNeededGain = 0.05;
    const bool needed = error_without > options.tolerance;
    return {error_without, needed ? options.tolerance : options.unneeded, needed ? kNeededGain : options.worthwhile};
}

// Of sizes that grow, the place of the smallest that errs by no more than is enough, or nearly as little as the best.
std::optional<std::size_t> pick(std::span<const Coded> sizes, const Wish& wish) {
    constexpr double kNearBest = 1.05;
    double least = wish.error_without;
    for (const Coded& coded : sizes) least = std::min(least, coded.error);
    if (least > wish.error_without * (1.0 - wish.must_gain)) return std::nullopt;
    const double most = least <= wish.enough ? wish.enough : least * kNearBest;
    const auto first = std::find_if(sizes.begin(), sizes.end(), [&](const Coded& coded) { return coded.error <= most; });
    if (first == sizes.end()) return std::nullopt;
    return static_cast<std::size_t>(first - sizes.begin());
}

// What was chosen, if anything was.
struct Choice {
    std::optional<Coded> coded;
    bool is_short = false;  // a larger one would have been, but takes too many bytes
};

Result<Choice> choose(const Scene& scene, const ResidualOptions& options, const Wish& wish) {
    const bool needed = wish.error_without > options.tolerance, bounded = options.most_bytes != ResidualOptions{}.most_bytes;
    std::vector<Coded> tried;
    std::size_t fitting = 0;  // of them, those that keep to the bytes; larger ones take more
    Fields fields(scene);
    for (const int halvings : allowed_sizes(scene.map, needed ? options.most_texels : welcome_texels(scene, options))) {
        tried.push_back(code_size(scene, fields, halvings, options.tolerance));
        Coded& coded = tried.back();
        const bool may_fit = fitting + 1 == tried.size();
        if (may_fit && bounded)
            if (const Status encoded = encode_once(coded); !encoded) return encoded.error();
        if (may_fit && coded.png.size() <= options.most_bytes) ++fitting;
        if (coded.error <= wish.enough) break;
    }
    const auto wanted = pick(tried, wish), chosen = pick(std::span(tried).first(fitting), wish);
    Choice choice;
    choice.is_short = wanted != chosen;
    if (chosen) choice.coded = std::move(tried[*chosen]);
    return choice;
}

}  // namespace

Result<Residual> bake_residual(const Image& map, const Image& reconstruction, Vec2 size, double depth, Wrap wrap,
                               const ResidualOptions& options) {
    assert(!map.texels.empty() && map.width == reconstruction.width && map.height == reconstruction.height);
    assert(size.x > 0.0 && size.y > 0.0 && depth > 0.0 && options.tolerance >= 0.0 && options.unneeded >= 0.0);
    const Scene scene{map, SlopeReader(map, size, depth, wrap), SlopeReader(reconstruction, size, depth, wrap), wrap,
                      options.threads};
    Residual residual;
    residual.error = residual.error_without = normal_error(scene, nullptr);
    if (residual.error_without <= options.unneeded) return residual;
    auto chosen = choose(scene, options, wish_for(options, residual.error_without));
    if (!chosen) return chosen.error();
    residual.is_short = chosen->is_short;
    if (!chosen->coded) return residual;
    if (const Status encoded = encode_once(*chosen->coded); !encoded) return encoded.error();
    residual.picture = std::move(chosen->coded->picture);
    residual.scale = chosen->coded->scale;
    residual.error = chosen->coded->error;
    residual.png = std::move(chosen->coded->png);
    return residual;
}

}  // namespace burin
