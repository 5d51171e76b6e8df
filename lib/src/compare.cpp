// Figures of a reconstruction against its map.
//
// The Gaussian is wide (a sixteenth of the map), so it is applied to means over blocks of a sixteenth of its
// sigma and interpolated back. Block means and linear interpolation blur by themselves, by the variances of a
// box (B^2 / 12) and a triangle (B^2 / 6); the Gaussian on the blocks is narrowed by as much, and the whole
// has the sigma asked for.
#include <burin/compare.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

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
    WideBlur(int width, int height, Wrap wrap, const Texel& texel);

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
WideBlur::WideBlur(int width, int height, Wrap wrap, const Texel& texel) {
    const double sigma = std::min(width, height) * kSigmaShare;
    across_ = make_axis(width, sigma, wrap == Wrap::repeat);
    down_ = make_axis(height, sigma, wrap == Wrap::repeat);
    const Shares columns = shares_of(across_), lines = shares_of(down_);
    const std::size_t n = static_cast<std::size_t>(across_.blocks);
    blocks_.assign(n * static_cast<std::size_t>(down_.blocks) + n + 1, 0.0);
    std::vector<double> sums(n + 1);
    for (int y = 0; y < height; ++y) {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (int x = 0; x < width; ++x) {
            const std::size_t i = static_cast<std::size_t>(x);
            const double v = texel(x, y);
            const double first = v * columns.share[i];
            sums[static_cast<std::size_t>(columns.block[i])] += first;
            sums[static_cast<std::size_t>(columns.block[i]) + 1] += v - first;
        }
        const double share = lines.share[static_cast<std::size_t>(y)];
        double* block =
            blocks_.data() + static_cast<std::size_t>(lines.block[static_cast<std::size_t>(y)]) * n;
        for (std::size_t b = 0; b < n; ++b) {
            block[b] += sums[b] * share;
            block[b + n] += sums[b] * (1.0 - share);
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

// Variance of a map less its wide Gaussian; the absolute values of that difference go to `absolute`, if
// given.
template <typename Texel>
double high_pass_variance(int width, int height, Wrap wrap, const Texel& texel,
                          std::vector<float>* absolute = nullptr) {
    const WideBlur blur(width, height, wrap, texel);
    std::vector<double> smooth;
    double sum = 0.0, squares = 0.0;
    for (int y = 0; y < height; ++y) {
        blur.row(y, smooth);
        double row_sum = 0.0, row_squares = 0.0;
        for (int x = 0; x < width; ++x) {
            const double v = texel(x, y) - smooth[static_cast<std::size_t>(x)];
            row_sum += v;
            row_squares += v * v;
            if (absolute) absolute->push_back(static_cast<float>(std::abs(v)));
        }
        sum += row_sum;
        squares += row_squares;
    }
    const double n = static_cast<double>(width) * height;
    return std::max(0.0, squares / n - (sum / n) * (sum / n));
}

// At most 1 in 1000 is greater. Reorders the values.
double p999_of(std::vector<float>& values) {
    const std::size_t n = values.size();
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(n - 1 - n / 1000);
    std::nth_element(values.begin(), nth, values.end());
    return static_cast<double>(*nth);
}

// The errors themselves; their 99.9th percentile needs them side by side.
void point_figures(const Image& a, const Image& b, Comparison& out) {
    const std::size_t n = a.texels.size();
    std::vector<float> absolute(n);
    double sum = 0.0, sum_abs = 0.0, squares = 0.0;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double e = static_cast<double>(a.texels[i]) - static_cast<double>(b.texels[i]);
        const double size = std::abs(e);
        absolute[i] = static_cast<float>(size);
        sum += e;
        sum_abs += size;
        squares += e * e;
        if (size > out.max) out.max = size, worst = i;
    }
    out.mean_error = sum / static_cast<double>(n);
    out.mean_abs = sum_abs / static_cast<double>(n);
    out.rms = std::sqrt(squares / static_cast<double>(n));
    out.worst_x = static_cast<int>(worst % static_cast<std::size_t>(a.width));
    out.worst_y = static_cast<int>(worst / static_cast<std::size_t>(a.width));
    out.p999 = p999_of(absolute);
}

}  // namespace

Comparison compare_heights(const Image& reconstruction, const Image& input, Wrap wrap) {
    assert(reconstruction.width == input.width && reconstruction.height == input.height);
    assert(!input.texels.empty());
    Comparison out;
    point_figures(reconstruction, input, out);
    const auto value = [&](int x, int y) { return static_cast<double>(input.at(x, y)); };
    const auto error = [&](int x, int y) {
        return static_cast<double>(input.at(x, y)) - static_cast<double>(reconstruction.at(x, y));
    };
    out.input_variance = high_pass_variance(input.width, input.height, wrap, value);
    std::vector<float> absolute;
    absolute.reserve(input.texels.size());
    out.error_variance = high_pass_variance(input.width, input.height, wrap, error, &absolute);
    out.rms_without_smooth = std::sqrt(out.error_variance);
    out.p999_without_smooth = p999_of(absolute);
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
    const WideBlur blur(map.width, map.height, wrap,
                        [&](int x, int y) { return static_cast<double>(map.at(x, y)); });
    Image out(map.width, map.height);
    std::vector<double> smooth;
    for (int y = 0; y < map.height; ++y) {
        blur.row(y, smooth);
        for (int x = 0; x < map.width; ++x)
            out.at(x, y) =
                static_cast<float>(static_cast<double>(map.at(x, y)) - smooth[static_cast<std::size_t>(x)]);
    }
    return out;
}

}  // namespace burin
