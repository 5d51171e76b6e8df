#include "residual_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel.hpp"

namespace burin::residual {
namespace {

std::size_t place(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

// First of `from` items that part `i` of `to` holds.
int part_begin(int i, int from, int to) { return static_cast<int>(static_cast<long long>(i) * from / to); }

float squared(Slope s) { return s.x * s.x + s.y * s.y; }

// One block of the field that a grid texel reaches: its share, and the share of the one other texel of the same
// axis that takes part there.
struct Share {
    int block = 0;
    float own = 0.0f, other = 0.0f;
    int side = 0;  // where the other lies: -1, +1, or 0 for none
};

// Shares of every grid texel along one axis: bilinear interpolation, read backwards.
std::vector<std::vector<Share>> shares_of(int blocks, int texels, Wrap wrap) {
    std::vector<std::vector<Share>> shares(static_cast<std::size_t>(texels));
    for (int block = 0; block < blocks; ++block) {
        const double at = (block + 0.5) * texels / blocks - 0.5;
        const int low = static_cast<int>(std::floor(at));
        const auto part = static_cast<float>(at - low);
        if (wrap == Wrap::clamp && (low < 0 || low + 1 >= texels)) {
            shares[static_cast<std::size_t>(std::clamp(low, 0, texels - 1))].push_back({block, 1.0f, 0.0f, 0});
            continue;
        }
        shares[static_cast<std::size_t>(wrapped(low, texels, wrap))].push_back({block, 1.0f - part, part, 1});
        shares[static_cast<std::size_t>(wrapped(low + 1, texels, wrap))].push_back({block, part, 1.0f - part, -1});
    }
    return shares;
}

// The normal equations: nine coefficients a texel, for itself and its neighbours, and the right side.
struct Equations {
    int width, height;
    Wrap wrap;
    std::vector<std::array<float, 9>> rows;
    std::vector<Slope> right;
};

void assemble_texel(const SlopeField& field, const std::vector<Share>& across, const std::vector<Share>& down,
                    std::array<float, 9>& row, Slope& right) {
    for (const Share& v : down) {
        std::array<float, 3> sums{};
        Slope sum;
        for (const Share& u : across) {
            const std::size_t i = place(u.block, v.block, field.width);
            const float weight = field.weight[i] * u.own;
            sums[1] += weight * u.own;
            sums[static_cast<std::size_t>(1 + u.side)] += weight * u.other;
            sum.x += u.own * field.x[i];
            sum.y += u.own * field.y[i];
        }
        for (std::size_t k = 0; k < 3; ++k) {
            row[3 + k] += v.own * v.own * sums[k];
            row[static_cast<std::size_t>(3 * (1 + v.side)) + k] += v.own * v.other * sums[k];
        }
        right.x += v.own * sum.x;
        right.y += v.own * sum.y;
    }
}

Equations assemble(const SlopeField& field, int width, int height, Wrap wrap, int threads) {
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Equations equations{width, height, wrap, std::vector<std::array<float, 9>>(count), std::vector<Slope>(count)};
    const auto across = shares_of(field.width, width, wrap), down = shares_of(field.height, height, wrap);
    for_each_band(height, threads, [&](Band band) {
        for (int y = band.begin; y < band.end; ++y)
            for (int x = 0; x < width; ++x) {
                const std::size_t i = place(x, y, width);
                assemble_texel(field, across[static_cast<std::size_t>(x)], down[static_cast<std::size_t>(y)],
                               equations.rows[i], equations.right[i]);
                // Keeps texels that nothing weighs on at rest.
                equations.rows[i][4] *= 1.001f;
                equations.rows[i][4] += 1e-9f;
            }
    });
    return equations;
}

// Coefficients times values.
std::vector<Slope> multiply(const Equations& equations, const std::vector<Slope>& values, int threads) {
    std::vector<Slope> product(values.size());
    const int width = equations.width, height = equations.height;
    for_each_band(height, threads, [&](Band band) {
        for (int y = band.begin; y < band.end; ++y)
            for (int x = 0; x < width; ++x) {
                const std::array<float, 9>& row = equations.rows[place(x, y, width)];
                Slope sum;
                for (int k = 0; k < 9; ++k) {
                    const Slope& value = values[place(wrapped(x + k % 3 - 1, width, equations.wrap),
                                                      wrapped(y + k / 3 - 1, height, equations.wrap), width)];
                    sum.x += row[static_cast<std::size_t>(k)] * value.x;
                    sum.y += row[static_cast<std::size_t>(k)] * value.y;
                }
                product[place(x, y, width)] = sum;
            }
    });
    return product;
}

struct Pair {
    double x = 0.0, y = 0.0;
};

// Inner products of both components, each texel divided by its own coefficient.
Pair inner(const std::vector<Slope>& a, const std::vector<Slope>& b, const Equations* divide) {
    Pair sum;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double scale = divide ? 1.0 / static_cast<double>(divide->rows[i][4]) : 1.0;
        sum.x += static_cast<double>(a[i].x) * b[i].x * scale;
        sum.y += static_cast<double>(a[i].y) * b[i].y * scale;
    }
    return sum;
}

double ratio(double a, double b) { return b > 0.0 ? a / b : 0.0; }

// Conjugate gradients, both components at once; the diagonal scales. Ten steps bring bilinear equations, whose
// eigenvalues lie close together then, below the picture's 8 bits.
std::vector<Slope> solve(const Equations& equations, int threads) {
    constexpr int kSteps = 10;
    std::vector<Slope> values(equations.right.size()), rest = equations.right, way(rest.size());
    Pair before;
    for (int step = 0; step < kSteps; ++step) {
        const Pair now = inner(rest, rest, &equations);
        const auto bx = static_cast<float>(ratio(now.x, before.x)), by = static_cast<float>(ratio(now.y, before.y));
        for (std::size_t i = 0; i < way.size(); ++i) {
            const float scale = 1.0f / equations.rows[i][4];
            way[i] = {rest[i].x * scale + bx * way[i].x, rest[i].y * scale + by * way[i].y};
        }
        const std::vector<Slope> product = multiply(equations, way, threads);
        const Pair curve = inner(way, product, nullptr);
        const auto ax = static_cast<float>(ratio(now.x, curve.x)), ay = static_cast<float>(ratio(now.y, curve.y));
        for (std::size_t i = 0; i < way.size(); ++i) {
            values[i] = {values[i].x + ax * way[i].x, values[i].y + ay * way[i].y};
            rest[i] = {rest[i].x - ax * product[i].x, rest[i].y - ay * product[i].y};
        }
        before = now;
    }
    return values;
}

}  // namespace

int wrapped(int i, int count, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(i, 0, count - 1);
    const int rest = i % count;
    return rest < 0 ? rest + count : rest;
}

SlopeReader::SlopeReader(const Image& heights, Vec2 size, double depth, Wrap wrap)
    : heights_(heights),
      along_(make_axis(heights.width, size.x, depth, wrap)),
      down_(make_axis(heights.height, size.y, depth, wrap)) {}

SlopeReader::Axis SlopeReader::make_axis(int texels, double metres, double depth, Wrap wrap) {
    Axis axis;
    for (int i = 0; i < texels; ++i) {
        const bool border = wrap == Wrap::clamp && (i == 0 || i + 1 == texels);
        axis.before.push_back(wrapped(i - 1, texels, wrap));
        axis.after.push_back(wrapped(i + 1, texels, wrap));
        axis.factor.push_back(static_cast<float>(depth * texels / metres / (border ? 1.0 : 2.0)));
    }
    return axis;
}

SlopeField measure_field(const SlopeReader& map, const SlopeReader& paths, int map_width, int map_height, int width,
                         int height, int threads) {
    SlopeField field(width, height);
    for_each_band(height, threads, [&](Band band) {
        for (int y = band.begin; y < band.end; ++y)
            for (int x = 0; x < width; ++x) {
                float weights = 0.0f;
                Slope sum;
                for (int j = part_begin(y, map_height, height); j < part_begin(y + 1, map_height, height); ++j)
                    for (int i = part_begin(x, map_width, width); i < part_begin(x + 1, map_width, width); ++i) {
                        const Slope a = paths.at(i, j), b = map.at(i, j);
                        const float weight = 1.0f / ((1.0f + squared(a)) * (1.0f + squared(b)));
                        weights += weight;
                        sum.x += weight * (b.x - a.x);
                        sum.y += weight * (b.y - a.y);
                    }
                const std::size_t at = place(x, y, width);
                field.weight[at] = weights;
                field.x[at] = sum.x;
                field.y[at] = sum.y;
            }
    });
    return field;
}

SlopeField halve(const SlopeField& field) {
    SlopeField half(std::max(1, field.width / 2), std::max(1, field.height / 2));
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            const std::size_t at = place(x, y, half.width);
            for (int j = part_begin(y, field.height, half.height); j < part_begin(y + 1, field.height, half.height); ++j)
                for (int i = part_begin(x, field.width, half.width); i < part_begin(x + 1, field.width, half.width); ++i) {
                    const std::size_t from = place(i, j, field.width);
                    half.weight[at] += field.weight[from];
                    half.x[at] += field.x[from];
                    half.y[at] += field.y[from];
                }
        }
    return half;
}

SlopeGrid measure_difference(const SlopeReader& map, const SlopeReader& paths, int width, int height, int threads) {
    SlopeGrid grid(width, height);
    for_each_band(height, threads, [&](Band band) {
        for (int y = band.begin; y < band.end; ++y)
            for (int x = 0; x < width; ++x) {
                const Slope a = paths.at(x, y), b = map.at(x, y);
                grid.slopes[place(x, y, width)] = {b.x - a.x, b.y - a.y};
            }
    });
    return grid;
}

SlopeGrid fit_slopes(const SlopeField& field, int width, int height, Wrap wrap, int threads) {
    SlopeGrid grid(width, height);
    if (width == field.width && height == field.height) {
        for (std::size_t i = 0; i < grid.slopes.size(); ++i)
            grid.slopes[i] = {field.x[i] / field.weight[i], field.y[i] / field.weight[i]};
        return grid;
    }
    grid.slopes = solve(assemble(field, width, height, wrap, threads), threads);
    return grid;
}

}  // namespace burin::residual
