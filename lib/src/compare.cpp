// Figures of a reconstruction against its map.
//
// The Gaussian is wide (a sixteenth of the map), so it is applied to means over blocks of a sixteenth of its
// sigma and interpolated back. Block means and linear interpolation blur by themselves, by the variances of a
// box (B^2 / 12) and a triangle (B^2 / 6); the Gaussian on the blocks is narrowed by as much, and the whole
// has the sigma asked for.
#include <burin/compare.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "parallel.hpp"

namespace burin {

namespace {

constexpr double kSigmaShare = 1.0 / 16.0;  // of the shorter side
constexpr double kBlocksPerSigma = 16.0;    // 16: error of `explained` below 1e-5 on maps of noise
constexpr double kKernelReach = 4.0;        // in sigma

// How one axis of `texels` is cut into `blocks` equal pieces, and read back.
struct Axis {
    int texels = 0;
    int blocks = 0;
    bool wrap = false;
    double per_block() const { return static_cast<double>(texels) / blocks; }

    // Block number i, brought into range: around the border, or mirrored at it (half-sample symmetric).
    int folded(long i) const {
        const long n = blocks;
        if (wrap) return static_cast<int>(((i % n) + n) % n);
        const long m = ((i % (2 * n)) + 2 * n) % (2 * n);
        return static_cast<int>(m < n ? m : 2 * n - 1 - m);
    }
};

Axis make_axis(int texels, double sigma, bool wrap) {
    const double wanted = std::max(1.0, sigma / kBlocksPerSigma);
    return {texels, std::max(1, static_cast<int>(std::ceil(texels / wanted - 1e-9))), wrap};
}

// Weights of texels in blocks: texel i adds share[i] of itself to block[i] and the rest to the next.
struct Shares {
    std::vector<int> block;
    std::vector<double> share;
};

Shares shares_of(const Axis& axis) {
    Shares s;
    for (int i = 0; i < axis.texels; ++i) {
        const double low = i / axis.per_block();
        const double high = (i + 1) / axis.per_block();
        const int b = std::min(static_cast<int>(low + 1e-9), axis.blocks - 1);
        s.block.push_back(b);
        s.share.push_back(b + 1 < axis.blocks ? std::clamp((b + 1 - low) / (high - low), 0.0, 1.0) : 1.0);
    }
    return s;
}

std::vector<double> kernel_of(double sigma, int radius) {
    std::vector<double> k(static_cast<std::size_t>(2 * radius + 1));
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i) {
        const double w = sigma > 0.0 ? std::exp(-0.5 * i * i / (sigma * sigma)) : (i == 0 ? 1.0 : 0.0);
        k[static_cast<std::size_t>(i + radius)] = w;
        sum += w;
    }
    for (double& w : k) w /= sum;
    return k;
}

// One axis of the blur over blocks: `count` rows of the axis' length, `step` apart, elements `stride` apart.
struct Rows {
    int count;
    std::size_t step, stride;
};

void blur_axis(std::vector<double>& blocks, const Axis& axis, Rows rows, double sigma) {
    // In blocks; the narrowing is that of the file's first comment, and none where a block is a texel.
    const double own = axis.blocks == axis.texels ? 0.0 : 0.25;
    const double s = sigma / axis.per_block();
    const int radius = static_cast<int>(std::floor(kKernelReach * s));
    const std::vector<double> kernel = kernel_of(std::sqrt(std::max(0.0, s * s - own)), radius);
    std::vector<double> padded(static_cast<std::size_t>(axis.blocks + 2 * radius));
    for (int r = 0; r < rows.count; ++r) {
        double* row = blocks.data() + static_cast<std::size_t>(r) * rows.step;
        for (int i = -radius; i < axis.blocks + radius; ++i)
            padded[static_cast<std::size_t>(i + radius)] =
                row[static_cast<std::size_t>(axis.folded(i)) * rows.stride];
        for (int i = 0; i < axis.blocks; ++i) {
            double sum = 0.0;
            for (std::size_t k = 0; k < kernel.size(); ++k)
                sum += kernel[k] * padded[static_cast<std::size_t>(i) + k];
            row[static_cast<std::size_t>(i) * rows.stride] = sum;
        }
    }
}

// The wide Gaussian of a map, by rows.
class WideBlur {
  public:
    // `texel(x, y)` gives the map's values.
    template <typename Texel>
    WideBlur(int width, int height, Wrap wrap, int threads, const Texel& texel);

    // Row y of the blurred map into out[0 .. width).
    void row(int y, std::vector<double>& out) const;

  private:
    struct Place {
        int low, high;
        double t;
    };
    static std::vector<Place> places_of(const Axis& axis);

    Axis across_, down_;
    std::vector<double> blocks_;
    std::vector<Place> columns_, lines_;
};

template <typename Texel>
WideBlur::WideBlur(int width, int height, Wrap wrap, int threads, const Texel& texel) {
    const double sigma = std::min(width, height) * kSigmaShare;
    across_ = make_axis(width, sigma, wrap == Wrap::repeat);
    down_ = make_axis(height, sigma, wrap == Wrap::repeat);
    const Shares columns = shares_of(across_), lines = shares_of(down_);
    const std::size_t n = static_cast<std::size_t>(across_.blocks);
    std::vector<double> sums((n + 1) * static_cast<std::size_t>(height), 0.0);  // of every row in the columns of blocks
    for_each_band(height, threads, [&](const Band& band) {
        for (int y = band.begin; y < band.end; ++y) {
            double* row = &sums[(n + 1) * static_cast<std::size_t>(y)];
            for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
                const double v = texel(static_cast<int>(x), y), first = v * columns.share[x];
                row[columns.block[x]] += first;
                row[columns.block[x] + 1] += v - first;
            }
        }
    });
    blocks_.assign(n * static_cast<std::size_t>(down_.blocks) + n + 1, 0.0);
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        double* block = blocks_.data() + static_cast<std::size_t>(lines.block[y]) * n;
        for (std::size_t b = 0; b < n; ++b) {
            const double sum = sums[(n + 1) * y + b];
            block[b] += sum * lines.share[y];
            block[b + n] += sum * (1.0 - lines.share[y]);
        }
    }
    const double area = across_.per_block() * down_.per_block();
    blocks_.resize(n * static_cast<std::size_t>(down_.blocks));
    for (double& b : blocks_) b /= area;
    blur_axis(blocks_, across_, {down_.blocks, n, 1}, sigma);
    blur_axis(blocks_, down_, {across_.blocks, 1, n}, sigma);
    columns_ = places_of(across_);
    lines_ = places_of(down_);
}

std::vector<WideBlur::Place> WideBlur::places_of(const Axis& axis) {
    std::vector<Place> out;
    for (int i = 0; i < axis.texels; ++i) {
        const double at = (i + 0.5) / axis.per_block() - 0.5;
        const long low = static_cast<long>(std::floor(at + 1e-9));
        out.push_back({axis.folded(low), axis.folded(low + 1), std::max(0.0, at - static_cast<double>(low))});
    }
    return out;
}

void WideBlur::row(int y, std::vector<double>& out) const {
    const Place line = lines_[static_cast<std::size_t>(y)];
    const std::size_t n = static_cast<std::size_t>(across_.blocks);
    const double* a = blocks_.data() + static_cast<std::size_t>(line.low) * n;
    const double* b = blocks_.data() + static_cast<std::size_t>(line.high) * n;
    std::vector<double> mixed(n);
    for (std::size_t i = 0; i < n; ++i) mixed[i] = a[i] + (b[i] - a[i]) * line.t;
    out.resize(columns_.size());
    for (std::size_t x = 0; x < columns_.size(); ++x) {
        const double low = mixed[static_cast<std::size_t>(columns_[x].low)];
        out[x] = low + (mixed[static_cast<std::size_t>(columns_[x].high)] - low) * columns_[x].t;
    }
}

// The map is summed up in slices, whatever the number of threads.
constexpr int kSlices = 16;

// Finds a value of some rank without keeping all: first values are counted by their leading bits, then those are
// kept that share them with the one looked for.
class RankFinder {
  public:
    // `above`: how many values may be greater.
    explicit RankFinder(std::size_t above) : above_(above), count_(kSlices), kept_(kSlices) {}

    void count(std::size_t slice, float value) { ++counts_of(slice)[bin_of(value)]; }
    void end_counting() {
        std::size_t greater = 0;
        for (bin_ = kBins; bin_-- > 0;) {
            std::size_t here = 0;
            for (const std::vector<std::uint32_t>& counts : count_) here += counts.empty() ? 0 : counts[bin_];
            if (greater + here > above_) break;
            greater += here;
        }
        above_ -= greater;
    }
    void keep(std::size_t slice, float value) {
        if (bin_of(value) == bin_) kept_[slice].push_back(value);
    }
    double value() {
        std::vector<float> all;
        for (const std::vector<float>& some : kept_) all.insert(all.end(), some.begin(), some.end());
        const auto nth = all.begin() + static_cast<std::ptrdiff_t>(all.size() - 1 - above_);
        std::nth_element(all.begin(), nth, all.end());
        return static_cast<double>(*nth);
    }

  private:
    static constexpr std::size_t kBins = std::size_t{1} << 16;
    // Floats that are not negative sort as their bits do.
    static std::size_t bin_of(float value) { return std::bit_cast<std::uint32_t>(value) >> 15; }
    std::vector<std::uint32_t>& counts_of(std::size_t slice) {
        if (count_[slice].empty()) count_[slice].assign(kBins, 0);
        return count_[slice];
    }

    std::size_t above_, bin_ = 0;
    std::vector<std::vector<std::uint32_t>> count_;  // per slice
    std::vector<std::vector<float>> kept_;
};

// Calls visit(slice, x, y, value) for the texels of a map less its wide Gaussian.
template <typename Texel, typename Visit>
void for_each_detail(const WideBlur& blur, int width, int height, int threads, const Texel& texel, const Visit& visit) {
    for_each_band(height, kSlices, threads, [&](const Band& band) {
        std::vector<double> smooth;
        for (int y = band.begin; y < band.end; ++y) {
            blur.row(y, smooth);
            for (int x = 0; x < width; ++x) visit(band.index, x, y, texel(x, y) - smooth[static_cast<std::size_t>(x)]);
        }
    });
}

// Sum and sum of squares, by slices.
class Moments {
  public:
    void add(std::size_t slice, double v) {
        sums_[slice].sum += v;
        sums_[slice].squares += v * v;
    }
    double mean(double n) const { return total().sum / n; }
    double mean_square(double n) const { return total().squares / n; }
    double variance(double n) const { return std::max(0.0, mean_square(n) - mean(n) * mean(n)); }

  private:
    struct alignas(64) Sums {  // one a cache line: threads write to neighbours
        double sum = 0.0, squares = 0.0;
    };
    Sums total() const {
        Sums all;
        for (const Sums& s : sums_) all.sum += s.sum, all.squares += s.squares;
        return all;
    }
    std::array<Sums, kSlices> sums_;
};

// Variance of a map less its wide Gaussian.
template <typename Texel>
double high_pass_variance(int width, int height, Wrap wrap, int threads, const Texel& texel) {
    const WideBlur blur(width, height, wrap, threads, texel);
    Moments moments;
    for_each_detail(blur, width, height, threads, texel, [&](std::size_t slice, int, int, double v) { moments.add(slice, v); });
    return moments.variance(static_cast<double>(width) * height);
}

std::size_t rank_of_p999(const Image& map) { return map.texels.size() / 1000; }

// The errors themselves.
void point_figures(const Image& a, const Image& b, int threads, Comparison& out) {
    struct alignas(64) Worst {
        double size = -1.0;
        std::size_t texel = 0;
    };
    Moments errors, sizes;
    RankFinder rank(rank_of_p999(a));
    std::array<Worst, kSlices> worst;
    const auto error_of = [&](std::size_t i) { return static_cast<double>(a.texels[i]) - static_cast<double>(b.texels[i]); };
    const auto for_each_texel = [&](const auto& visit) {
        for_each_band(a.height, kSlices, threads, [&](const Band& band) {
            const std::size_t width = static_cast<std::size_t>(a.width);
            for (std::size_t i = width * static_cast<std::size_t>(band.begin); i < width * static_cast<std::size_t>(band.end); ++i)
                visit(band.index, i);
        });
    };
    for_each_texel([&](std::size_t slice, std::size_t i) {
        const double e = error_of(i), size = std::abs(e);
        errors.add(slice, e);
        sizes.add(slice, size);
        rank.count(slice, static_cast<float>(size));
        if (size > worst[slice].size) worst[slice] = {size, i};
    });
    rank.end_counting();
    for_each_texel([&](std::size_t slice, std::size_t i) { rank.keep(slice, static_cast<float>(std::abs(error_of(i)))); });
    const Worst& greatest =
        *std::max_element(worst.begin(), worst.end(), [](const Worst& p, const Worst& q) { return p.size < q.size; });
    const double n = static_cast<double>(a.texels.size());
    out.max = greatest.size;
    out.mean_error = errors.mean(n);
    out.mean_abs = sizes.mean(n);
    out.rms = std::sqrt(errors.mean_square(n));
    out.worst_x = static_cast<int>(greatest.texel % static_cast<std::size_t>(a.width));
    out.worst_y = static_cast<int>(greatest.texel / static_cast<std::size_t>(a.width));
    out.p999 = rank.value();
}

// The errors less their wide Gaussian.
template <typename Error>
void detail_figures(const Image& map, Wrap wrap, int threads, const Error& error, Comparison& out) {
    const WideBlur blur(map.width, map.height, wrap, threads, error);
    Moments moments;
    RankFinder rank(rank_of_p999(map));
    for_each_detail(blur, map.width, map.height, threads, error, [&](std::size_t slice, int, int, double v) {
        moments.add(slice, v);
        rank.count(slice, static_cast<float>(std::abs(v)));
    });
    rank.end_counting();
    for_each_detail(blur, map.width, map.height, threads, error,
                    [&](std::size_t slice, int, int, double v) { rank.keep(slice, static_cast<float>(std::abs(v))); });
    out.error_variance = moments.variance(static_cast<double>(map.texels.size()));
    out.rms_without_smooth = std::sqrt(out.error_variance);
    out.p999_without_smooth = rank.value();
}

}  // namespace

double detail_variance(const Image& map, Wrap wrap, int threads) {
    assert(!map.texels.empty());
    return high_pass_variance(map.width, map.height, wrap, threads,
                              [&](int x, int y) { return static_cast<double>(map.at(x, y)); });
}

Comparison compare_heights(const Image& reconstruction, const Image& input, Wrap wrap, int threads) {
    assert(reconstruction.width == input.width && reconstruction.height == input.height);
    assert(!input.texels.empty());
    Comparison out;
    point_figures(reconstruction, input, threads, out);
    const auto error = [&](int x, int y) {
        return static_cast<double>(input.at(x, y)) - static_cast<double>(reconstruction.at(x, y));
    };
    out.input_variance = detail_variance(input, wrap, threads);
    detail_figures(input, wrap, threads, error, out);
    // 1e-14: what rounding leaves of a constant map; a map with one texel changed by 1/65535 has more up to
    // 100 Mtexel.
    constexpr double kNothing = 1e-14;
    const auto [low, high] = std::minmax_element(reconstruction.texels.begin(), reconstruction.texels.end());
    const bool constant = *low == *high;  // explains nothing, but for rounding
    if (out.input_variance > kNothing && constant) {
        out.explained = 0.0;
    } else if (out.input_variance > kNothing) {
        out.explained = 1.0 - out.error_variance / out.input_variance;
    } else {
        out.explained = out.error_variance > kNothing || out.rms > 1e-7 ? 0.0 : 1.0;
    }
    return out;
}

Image subtract_smooth(const Image& map, Wrap wrap) {
    assert(!map.texels.empty());
    const auto value = [&](int x, int y) { return static_cast<double>(map.at(x, y)); };
    const WideBlur blur(map.width, map.height, wrap, 1, value);
    Image out(map.width, map.height);
    for_each_detail(blur, map.width, map.height, 1, value,
                    [&](std::size_t, int x, int y, double v) { out.at(x, y) = static_cast<float>(v); });
    return out;
}

}  // namespace burin
