// The soft ground of a map: ramps and vignettes that no path should follow. Slopes gentler than any wall belong to it;
// walls and lines do not. The surface with those slopes, and none where there are walls, is found by least squares on a
// coarse lattice, so that plateaus keep the levels they have above it.
#include "vectorize_internal.hpp"

#include <algorithm>
#include <cmath>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

constexpr int kCoarseSide = 64;          // blocks along the shorter side: four to the sigma of the blur
constexpr double kLeastFlat = 0.15;       // share of a block's texels that tell its slope; without, it is level
constexpr int kMostSteps = 4000;         // of the conjugate gradients
constexpr double kSettledSquare = 1e-14; // of the residual, against the first one

// The map in blocks, neighbours as in the lattice.
struct Blocks {
    int columns = 0, rows = 0, side = 1;
    bool wrap = false;

    int size() const { return columns * rows; }
    // Index of the block right of (below) this one, or -1.
    int right(int x, int y) const { return x + 1 < columns ? y * columns + x + 1 : wrap ? y * columns : -1; }
    int below(int x, int y) const { return y + 1 < rows ? (y + 1) * columns + x : wrap ? x : -1; }
};

// Mean slope of the flat texels per block, times the block's side; and how many there are.
struct Slopes {
    std::vector<double> rise[2], count[2];  // along x, along y
};

Slopes measure_slopes(const Image& map, const Lattice& lattice, const std::vector<std::uint8_t>& flat,
                      const Blocks& blocks) {
    Slopes slopes;
    for (int axis : {0, 1}) {
        slopes.rise[axis].assign(blocks.size(), 0.0);
        slopes.count[axis].assign(blocks.size(), 0.0);
    }
    for_each_piece(static_cast<std::size_t>(blocks.rows), lattice.threads, [&](std::size_t row) {
        const int begin = static_cast<int>(row) * blocks.side, end = std::min(lattice.height, begin + blocks.side);
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < lattice.width; ++x) {
                const int i = y * lattice.width + x, block = (y / blocks.side) * blocks.columns + x / blocks.side;
                if (!flat[i]) continue;
                for (int axis : {0, 1}) {
                    const int j = axis == 0 ? lattice.index(x + 1, y) : lattice.index(x, y + 1);
                    if (j < 0 || !flat[j]) continue;
                    slopes.rise[axis][block] += static_cast<double>(map.texels[j]) - map.texels[i];
                    slopes.count[axis][block] += 1.0;
                }
            }
    });
    return slopes;
}

// A difference that two blocks should have.
struct Link {
    int from = 0, to = 0;
    double rise = 0.0;
};

std::vector<Link> make_links(const Slopes& slopes, const Blocks& blocks) {
    std::vector<Link> links;
    const double area = static_cast<double>(blocks.side) * blocks.side;
    for (int y = 0; y < blocks.rows; ++y)
        for (int x = 0; x < blocks.columns; ++x)
            for (int axis : {0, 1}) {
                const int from = y * blocks.columns + x, to = axis == 0 ? blocks.right(x, y) : blocks.below(x, y);
                if (to < 0) continue;
                const double count = slopes.count[axis][from] + slopes.count[axis][to];
                const double rise = slopes.rise[axis][from] + slopes.rise[axis][to];
                links.push_back({from, to, 0.5 * count > kLeastFlat * area ? blocks.side * rise / count : 0.0});
            }
    return links;
}

// Heights whose differences come nearest to the links', by conjugate gradients; their mean is 0.
std::vector<double> solve_heights(const std::vector<Link>& links, std::size_t size) {
    std::vector<double> height(size, 0.0), residual(size, 0.0), product(size);
    for (const Link& link : links) {
        residual[link.from] -= link.rise;
        residual[link.to] += link.rise;
    }
    std::vector<double> direction = residual;
    const auto square = [](const std::vector<double>& v) {
        double sum = 0.0;
        for (const double x : v) sum += x * x;
        return sum;
    };
    const double first = square(residual);
    double now = first;
    for (int step = 0; step < kMostSteps && now > kSettledSquare * first && now > 0.0; ++step) {
        std::fill(product.begin(), product.end(), 0.0);
        for (const Link& link : links) {
            const double flow = direction[link.to] - direction[link.from];
            product[link.to] += flow;
            product[link.from] -= flow;
        }
        double curvature = 0.0;
        for (std::size_t i = 0; i < size; ++i) curvature += direction[i] * product[i];
        if (curvature <= 0.0) break;
        const double length = now / curvature;
        for (std::size_t i = 0; i < size; ++i) height[i] += length * direction[i], residual[i] -= length * product[i];
        const double next = square(residual);
        for (std::size_t i = 0; i < size; ++i) direction[i] = residual[i] + next / now * direction[i];
        now = next;
    }
    double mean = 0.0;
    for (const double h : height) mean += h / static_cast<double>(size);
    for (double& h : height) h -= mean;
    return height;
}

// Gaussian over blocks, along one axis: over the border as the lattice goes on, or mirrored there.
void blur_axis(std::vector<double>& height, const Blocks& blocks, bool along_x, double sigma) {
    const int n = along_x ? blocks.columns : blocks.rows, lines = along_x ? blocks.rows : blocks.columns;
    const int stride = along_x ? 1 : blocks.columns, step = along_x ? blocks.columns : 1;
    const int reach = static_cast<int>(std::ceil(3.0 * sigma));
    std::vector<double> weight(reach + 1), line(n);
    double total = 0.0;
    for (int k = 0; k <= reach; ++k) {
        weight[k] = std::exp(-0.5 * k * k / (sigma * sigma));
        total += (k > 0 ? 2.0 : 1.0) * weight[k];
    }
    const auto at = [&](int i) {
        if (blocks.wrap) return line[Lattice::modulo(i, n)];
        const int m = Lattice::modulo(i, 2 * n);
        return line[m < n ? m : 2 * n - 1 - m];
    };
    for (int l = 0; l < lines; ++l) {
        for (int i = 0; i < n; ++i) line[i] = height[static_cast<std::size_t>(l) * step + i * stride];
        for (int i = 0; i < n; ++i) {
            double sum = weight[0] * line[i];
            for (int k = 1; k <= reach; ++k) sum += weight[k] * (at(i - k) + at(i + k));
            height[static_cast<std::size_t>(l) * step + i * stride] = sum / total;
        }
    }
}

// Texels whose neighbours are flat too.
std::vector<std::uint8_t> shrink(const std::vector<std::uint8_t>& flat, const Lattice& lattice) {
    std::vector<std::uint8_t> out(flat.size());
    const int w = lattice.width;
    for_each_band(lattice.height, lattice.threads, [&](const Band& band) {
        std::vector<std::uint8_t> all(static_cast<std::size_t>(w));  // three texels of a column
        for (int y = band.begin; y < band.end; ++y) {
            const std::uint8_t* above = &flat[lattice.nearest(0, y - 1)];
            const std::uint8_t* here = &flat[lattice.nearest(0, y)];
            const std::uint8_t* below = &flat[lattice.nearest(0, y + 1)];
            for (int x = 0; x < w; ++x) all[x] = above[x] & here[x] & below[x];
            std::uint8_t* row = &out[static_cast<std::size_t>(y) * w];
            for (int x = 1; x + 1 < w; ++x) row[x] = all[x - 1] & all[x] & all[x + 1];
            for (const int x : {0, w - 1}) row[x] = all[lattice.nearest(x - 1, 0)] & all[x] & all[lattice.nearest(x + 1, 0)];
        }
    });
    return out;
}

}  // namespace

Image soft_ground(const Image& map, const Lattice& lattice, double noise) {
    Blocks blocks;
    const int shorter = std::min(lattice.width, lattice.height);
    blocks.side = std::max(1, shorter / kCoarseSide);
    blocks.columns = (lattice.width + blocks.side - 1) / blocks.side;
    blocks.rows = (lattice.height + blocks.side - 1) / blocks.side;
    blocks.wrap = lattice.wrap;
    const std::vector<std::uint8_t> flat = shrink(find_flat(map, lattice, noise), lattice);
    const std::vector<Link> links = make_links(measure_slopes(map, lattice, flat, blocks), blocks);
    std::vector<double> height = solve_heights(links, static_cast<std::size_t>(blocks.size()));
    // What is finer than the Gaussian of `explained` is detail.
    const double sigma = shorter / 16.0 / blocks.side;
    for (const bool along_x : {true, false}) blur_axis(height, blocks, along_x, sigma);
    Image coarse(blocks.columns, blocks.rows), out(lattice.width, lattice.height);
    std::copy(height.begin(), height.end(), coarse.texels.begin());
    const Lattice of_blocks{blocks.columns, blocks.rows, lattice.wrap};
    for_each_band(lattice.height, lattice.threads, [&](const Band& band) {
        for (int y = band.begin; y < band.end; ++y)
            for (int x = 0; x < lattice.width; ++x)
                out.at(x, y) = sample(coarse, of_blocks, {(x + 0.5) / blocks.side, (y + 0.5) / blocks.side});
    });
    return out;
}

}  // namespace burin::vectorizing
