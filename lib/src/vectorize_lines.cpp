// Grooves and ridges: what a closing (or opening) fills is narrower than its square; the mask of what was filled is
// thinned to centre lines, which are then measured and joined.
#include "vectorize_internal.hpp"
#include "vectorize_skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <opencv2/imgproc.hpp>

namespace burin::vectorizing {
namespace {

cv::Mat padded(const Image& image, const Lattice& lattice, int margin) {
    cv::Mat out(lattice.height + 2 * margin, lattice.width + 2 * margin, CV_32F);
    for (int y = 0; y < out.rows; ++y) {
        float* row = out.ptr<float>(y);
        for (int x = 0; x < out.cols; ++x) row[x] = image.texels[lattice.nearest(x - margin, y - margin)];
    }
    return out;
}

Image cropped(const cv::Mat& mat, const Lattice& lattice, int margin) {
    Image out(lattice.width, lattice.height);
    for (int y = 0; y < lattice.height; ++y) {
        const float* row = mat.ptr<float>(y + margin) + margin;
        std::copy(row, row + lattice.width, &out.texels[static_cast<std::size_t>(y) * lattice.width]);
    }
    return out;
}

// Depth of each texel below the closing of the map (grooves), or height above its opening (ridges).
Image hat_response(const Image& map, const Lattice& lattice, ChainKind kind, int radius) {
    const int margin = 2 * radius + 1;
    const cv::Mat source = padded(map, lattice, margin);
    const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {2 * radius + 1, 2 * radius + 1});
    cv::Mat hat;
    cv::morphologyEx(source, hat, kind == ChainKind::groove ? cv::MORPH_BLACKHAT : cv::MORPH_TOPHAT, square);
    return cropped(hat, lattice, margin);
}

// Texels above half of the strongest response around them, and above the grain.
std::vector<std::uint8_t> half_height_mask(const Image& response, const Lattice& lattice, int radius, double least) {
    const int margin = radius + 1;
    const cv::Mat source = padded(response, lattice, margin);
    const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {2 * radius + 1, 2 * radius + 1});
    cv::Mat peak;
    cv::dilate(source, peak, square);
    const Image local = cropped(peak, lattice, margin);
    std::vector<std::uint8_t> mask(response.texels.size());
    for (std::size_t i = 0; i < mask.size(); ++i)
        mask[i] = response.texels[i] > std::max(0.5f * local.texels[i], static_cast<float>(least));
    return mask;
}

// Drops connected parts whose area or summed response is that of a speck.
void drop_specks(std::vector<std::uint8_t>& mask, const Image& response, const Lattice& lattice, double least_energy) {
    std::vector<std::uint8_t> seen(mask.size(), 0);
    std::vector<int> part;
    for (int i = 0; i < lattice.size(); ++i) {
        if (!mask[i] || seen[i]) continue;
        part.assign(1, i);
        seen[i] = 1;
        double energy = 0.0;
        for (std::size_t k = 0; k < part.size(); ++k) {
            const int x = part[k] % lattice.width, y = part[k] / lattice.width;
            energy += response.texels[part[k]] * response.texels[part[k]];
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int j = lattice.index(x + dx, y + dy);
                    if (j >= 0 && mask[j] && !seen[j]) {
                        seen[j] = 1;
                        part.push_back(j);
                    }
                }
        }
        if (part.size() < 8 || energy < least_energy)
            for (const int j : part) mask[j] = 0;
    }
}

double chain_length(const Chain& chain) {
    double sum = 0.0;
    for (std::size_t i = 1; i < chain.points.size(); ++i) sum += length(chain.points[i] - chain.points[i - 1]);
    return sum;
}

double median_of(std::vector<float>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Median of the map across the chain at offsets -n..n steps of 0.5 texel; and how much of the variance it explains.
struct CrossSection {
    std::vector<double> height;
    double explained = 0.0;
};

CrossSection measure_cross_section(const Chain& chain, const Image& map, const Lattice& lattice, double reach) {
    constexpr double kStep = 0.5;
    const int n = static_cast<int>(std::ceil(reach / kStep));
    CrossSection section;
    std::vector<std::vector<float>> values(static_cast<std::size_t>(2 * n + 1));
    for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
        const Vec2 a = chain.points[i], b = chain.points[i + 1];
        const double l = length(b - a);
        if (l == 0.0) continue;
        const Vec2 normal = normal_of(unit(b - a));
        const int pieces = std::max(1, static_cast<int>(l / 2.0));
        for (int piece = 0; piece < pieces; ++piece) {
            const Vec2 p = lerp(a, b, (piece + 0.5) / pieces);
            for (int k = -n; k <= n; ++k) values[k + n].push_back(sample(map, lattice, p + normal * (k * kStep)));
        }
    }
    double total = 0.0, left = 0.0, mean = 0.0, count = 0.0;
    for (auto& column : values) {
        if (column.empty()) return section;
        section.height.push_back(median_of(column));
        for (const float v : column) mean += v;
        count += static_cast<double>(column.size());
    }
    mean /= count;
    for (std::size_t k = 0; k < values.size(); ++k)
        for (const float v : values[k]) {
            total += (v - mean) * (v - mean);
            left += (v - section.height[k]) * (v - section.height[k]);
        }
    section.explained = total > 0.0 ? 1.0 - left / total : 0.0;
    return section;
}

// A line has one section all along it, and the same ground on both sides. What fails this is the rim of a plateau or a
// blob, which the step contours describe better.
bool is_line(const Chain& chain, const Image& map, const Lattice& lattice, double noise) {
    const double extent = chain_length(chain) + 2.0 * chain.half_width;
    if (extent < 3.0 * chain.half_width + 3.0 || chain.contrast < 3.0 * noise) return false;
    const double reach = std::max(3.0, 1.6 * chain.half_width + 1.5);
    const CrossSection section = measure_cross_section(chain, map, lattice, reach);
    if (section.height.empty()) return false;
    const double left = section.height.front(), right = section.height.back();
    const double middle = section.height[section.height.size() / 2];
    const double depth = std::fabs(0.5 * (left + right) - middle);
    // Thin lines never fit their mean section well, since half a texel of wobble is half their width; a wide one that
    // does not fit is better described by its two rims.
    const double wide = std::clamp((chain.half_width - 2.0) / 3.0, 0.0, 1.0);
    const double needed = 0.55 + 0.37 * wide;
    return depth > std::max(3.0 * noise, 0.012) && std::fabs(left - right) < 0.35 * depth && section.explained > needed;
}

}  // namespace

namespace {

double least_response(double noise) { return std::max(4.0 * noise, 0.012); }

int square_radius(double radius) { return std::max(2, static_cast<int>(std::lround(radius))); }

// A chain whose points were mostly dropped as unsteady was bridged over noise.
bool is_supported(const Chain& chain) {
    double bridged = 0.0;
    for (std::size_t i = 1; i < chain.points.size(); ++i) {
        const double gap = length(chain.points[i] - chain.points[i - 1]);
        if (gap > 3.0) bridged += gap - std::min(gap, 6.0 * chain.half_width + 4.0) + 3.0;
    }
    return chain.points.size() >= 4 && bridged < 0.4 * chain_length(chain);
}

double chain_energy(const Chain& chain) {
    return chain_length(chain) * 2.0 * (chain.half_width + 0.25) * chain.contrast * chain.contrast;
}

// Fills the lines' texels to the height of the ground beside them, which is what the closing (opening) holds.
void erase_lines(Image& map, const Image& response, const Lattice& lattice, const std::vector<Chain>& chains,
                 ChainKind kind) {
    std::vector<std::uint8_t> erased(map.texels.size(), 0);
    const float sign = kind == ChainKind::groove ? 1.0f : -1.0f;
    for (const Chain& chain : chains) {
        const int reach = static_cast<int>(std::ceil(1.5 * chain.half_width + 2.0));
        for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
            const Vec2 a = chain.points[i], b = chain.points[i + 1];
            const int pieces = std::max(1, static_cast<int>(std::ceil(length(b - a))));
            for (int piece = 0; piece <= pieces; ++piece) {
                const Vec2 p = lerp(a, b, static_cast<double>(piece) / pieces);
                const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
                for (int dy = -reach; dy <= reach; ++dy)
                    for (int dx = -reach; dx <= reach; ++dx) {
                        const int j = lattice.index(x + dx, y + dy);
                        if (j < 0 || erased[j] || dx * dx + dy * dy > reach * reach) continue;
                        erased[j] = 1;
                        map.texels[j] += sign * response.texels[j];
                    }
            }
        }
    }
}

}  // namespace

double line_energy(const Image& map, const Lattice& lattice, ChainKind kind, double radius, double noise) {
    const Image response = hat_response(map, lattice, kind, square_radius(radius));
    const float least = static_cast<float>(least_response(noise));
    double sum = 0.0;
    for (const float v : response.texels)
        if (v > least) sum += static_cast<double>(v) * v;
    return sum;
}

std::vector<Chain> trace_lines(Image& map, const Lattice& lattice, ChainKind kind, double radius, double noise,
                               double energy) {
    const int r = square_radius(radius);
    const Image response = hat_response(map, lattice, kind, r);
    const double least = least_response(noise);
    std::vector<std::uint8_t> mask = half_height_mask(response, lattice, r, least);
    drop_specks(mask, response, lattice, 24.0 * least * least);
    const std::vector<float> thickness = distance_inside(mask, lattice);
    thin_mask(mask, lattice);
    Skeleton skeleton = trace_skeleton(mask, thickness, lattice);
    measure_strands(skeleton, response, lattice);
    std::vector<Chain> chains = join_strands(skeleton, response, lattice, kind);
    chains.erase(std::remove_if(chains.begin(), chains.end(),
                                [&](const Chain& chain) {
                                    return !is_supported(chain) || !is_line(chain, map, lattice, noise) ||
                                           chain_energy(chain) < 2e-5 * energy;
                                }),
                 chains.end());
    erase_lines(map, response, lattice, chains, kind);
    return chains;
}

}  // namespace burin::vectorizing
