#include "surface_maps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>

#include <burin/image_io.hpp>

#include "../../tests/judge/judge.hpp"

namespace burin::rivals {
namespace {

constexpr int kBlock = 32;  // texels per side that share their candidates
constexpr int kCell = 4;    // texels per side within which a facet is taken to be smooth

// One sample of the truth per texel.
struct Samples {
    std::vector<float> heights;
    std::vector<std::int16_t> normals;
    std::vector<std::uint8_t> paints;
    explicit Samples(std::size_t count) : heights(count), normals(count * 2), paints(count) {}
};

// Where an element may act: so far around its chord.
struct Zone {
    Vec2 from, to;
    double reach = 0.0;
};

Zone zone_of(const ResolvedPattern& pattern, const ResolvedElement& e) {
    double offset = 0.0;
    for (const ProfilePoint& point : pattern.profiles[pattern.styles[e.style].profile].points) offset = std::max(offset, std::abs(point.b));
    const Vec2 middle = lerp(e.element.p0, e.element.p2, 0.5);
    // Mitres reach four times as far as the profile.
    return {e.element.p0, e.element.p2, offset * 4.5 * std::max(e.element.width0, e.element.width1) + length(e.element.p1 - middle)};
}

double distance_to(const Zone& zone, Vec2 p) {
    const Vec2 along = zone.to - zone.from;
    const double square = dot(along, along);
    const double t = square > 0.0 ? std::clamp(dot(p - zone.from, along) / square, 0.0, 1.0) : 0.0;
    return length(p - zone.from - along * t);
}

class Sampler {
  public:
    Sampler(const ResolvedPattern& pattern, const Paints& paints, int size)
        : pattern_(pattern), paints_(paints), truth_(pattern), size_(size), texel_{pattern.size.x / size, pattern.size.y / size} {
        for (const ResolvedElement& e : pattern.elements) zones_.push_back(zone_of(pattern, e));
    }

    Samples all() const {
        Samples samples(std::size_t(size_) * std::size_t(size_));
        std::vector<std::uint32_t> everything(zones_.size());
        std::iota(everything.begin(), everything.end(), 0u);
        const int large = std::min(size_, kBlock * 16), side = size_ / large;
        testing::in_parallel(std::size_t(side) * std::size_t(side), [&](std::size_t i) {
            const int x = int(i) % side * large, y = int(i) / side * large;
            const auto near = near_block(everything, x, y, large);
            const int small = std::min(large, kBlock);
            for (int v = y; v < y + large; v += small)
                for (int u = x; u < x + large; u += small) fill_block(samples, u, v, small, near_block(near, u, v, small));
        });
        return samples;
    }

  private:
    Vec2 at(double x, double y) const { return {x * texel_.x, y * texel_.y}; }

    std::vector<std::uint32_t> near_block(const std::vector<std::uint32_t>& among, int x, int y, int side) const {
        const Vec2 middle = at(x + 0.5 * side, y + 0.5 * side);
        const double radius = 0.5 * side * length(texel_);
        const int images = pattern_.wrap == Wrap::repeat ? 1 : 0;
        std::vector<std::uint32_t> near;
        for (const std::uint32_t element : among) {
            double least = 1e300;
            for (int j = -images; j <= images; ++j)
                for (int i = -images; i <= images; ++i)
                    least = std::min(least, distance_to(zones_[element], middle - Vec2{i * pattern_.size.x, j * pattern_.size.y}));
            if (least <= radius + zones_[element].reach) near.push_back(element);
        }
        return near;
    }

    void fill_block(Samples& samples, int x, int y, int side, const std::vector<std::uint32_t>& near) const {
        const bool steps = std::any_of(near.begin(), near.end(), [&](std::uint32_t e) { return pattern_.styles[pattern_.elements[e].style].step; });
        const double ground = truth_.ground_at(at(x + 0.5 * side, y + 0.5 * side));
        if (near.empty()) return fill_level(samples, x, y, side, ground);
        const auto sample = [&](int u, int v) {
            const Vec2 p = at(u + 0.5, v + 0.5);
            return steps ? truth_.surface_at(p, near) : truth_.surface_at(p, near, ground);
        };
        if (!fills_cells(near) || side < kCell) return fill_texels(samples, x, y, side, sample);
        const int lines = side / kCell + 1;
        std::vector<SurfacePoint> corners;
        for (int j = 0; j < lines; ++j)
            for (int i = 0; i < lines; ++i) corners.push_back(sample(x + i * kCell, y + j * kCell));
        for (int j = 0; j + 1 < lines; ++j)
            for (int i = 0; i + 1 < lines; ++i) {
                const SurfacePoint* first = &corners[std::size_t(j * lines + i)];
                const SurfacePoint* four[4] = {first, first + 1, first + lines, first + lines + 1};
                if (is_smooth(four)) fill_smooth(samples, x + i * kCell, y + j * kCell, four);
                else fill_texels(samples, x + i * kCell, y + j * kCell, kCell, sample);
            }
    }

    // Whether each is so wide that no strip of it runs unseen between the corners of a cell.
    bool fills_cells(const std::vector<std::uint32_t>& near) const {
        const double least = 1.5 * kCell * std::max(texel_.x, texel_.y);
        return std::all_of(near.begin(), near.end(), [&](std::uint32_t e) {
            const ResolvedElement& element = pattern_.elements[e];
            double low = 0.0, high = 0.0;
            for (const ProfilePoint& point : pattern_.profiles[pattern_.styles[element.style].profile].points)
                low = std::min(low, point.b), high = std::max(high, point.b);
            return (high - low) * std::max(element.element.width0, element.element.width1) > least;
        });
    }

    static bool is_smooth(const SurfacePoint* const (&four)[4]) {
        return std::all_of(four + 1, four + 4, [&](const SurfacePoint* one) {
            double turned = 0.0;
            for (std::size_t k = 0; k < 3; ++k) turned += std::abs(one->normal[k] - four[0]->normal[k]);
            return one->element == four[0]->element && one->facet == four[0]->facet && turned < 0.02;
        });
    }

    void fill_smooth(Samples& samples, int x, int y, const SurfacePoint* const (&four)[4]) const {
        for (int v = 0; v < kCell; ++v)
            for (int u = 0; u < kCell; ++u) {
                const double s = double(u) / kCell, t = double(v) / kCell;
                const double weights[4] = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
                SurfacePoint mean = *four[0];
                mean.height = mean.normal[0] = mean.normal[1] = 0.0;
                for (std::size_t k = 0; k < 4; ++k) {
                    mean.height += weights[k] * four[k]->height;
                    for (std::size_t axis = 0; axis < 2; ++axis) mean.normal[axis] += weights[k] * four[k]->normal[axis];
                }
                put(samples, texel(x + u, y + v), mean);
            }
    }

    template <typename Sample>
    void fill_texels(Samples& samples, int x, int y, int side, const Sample& sample) const {
        for (int v = y; v < y + side; ++v)
            for (int u = x; u < x + side; ++u) put(samples, texel(u, v), sample(u, v));
    }

    void fill_level(Samples& samples, int x, int y, int side, double height) const {
        for (int v = y; v < y + side; ++v)
            for (int u = x; u < x + side; ++u) samples.heights[texel(u, v)] = float(height);
    }

    std::size_t texel(int x, int y) const { return std::size_t(y) * std::size_t(size_) + std::size_t(x); }

    void put(Samples& samples, std::size_t texel, const SurfacePoint& point) const {
        samples.heights[texel] = float(point.height);
        for (std::size_t k = 0; k < 2; ++k) samples.normals[2 * texel + k] = std::int16_t(std::lround(point.normal[k] * 32767.0));
        if (point.element != kGround) samples.paints[texel] = paints_.of_style[pattern_.elements[point.element].style];
    }

    const ResolvedPattern& pattern_;
    const Paints& paints_;
    Truth truth_;
    int size_;
    Vec2 texel_;
    std::vector<Zone> zones_;
};

template <typename Value>
void append(std::vector<std::uint8_t>& bytes, const std::vector<Value>& values) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
    bytes.insert(bytes.end(), first, first + values.size() * sizeof(Value));
}

template <typename Value>
const std::uint8_t* take(const std::uint8_t* from, std::vector<Value>& values) {
    std::memcpy(values.data(), from, values.size() * sizeof(Value));
    return from + values.size() * sizeof(Value);
}

Samples samples_of(const ResolvedPattern& pattern, const Paints& paints, int size, const std::string& cache, const std::string& key) {
    const std::string path = cache + "/" + key + "_" + std::to_string(size) + ".maps";
    Samples samples(std::size_t(size) * std::size_t(size));
    const std::size_t bytes_wanted = samples.heights.size() * 9;
    if (!cache.empty())
        if (auto bytes = read_file(path, std::size_t(1) << 31); bytes && bytes->size() == bytes_wanted) {
            take(take(take(bytes->data(), samples.heights), samples.normals), samples.paints);
            return samples;
        }
    samples = Sampler(pattern, paints, size).all();
    if (cache.empty()) return samples;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(bytes_wanted);
    append(bytes, samples.heights), append(bytes, samples.normals), append(bytes, samples.paints);
    if (Status written = write_file(path, bytes); !written) std::fprintf(stderr, "the map is not kept: %s\n", written.error().message.c_str());
    return samples;
}

MapLevel first_level(const SurfaceMaps& maps, const Samples& samples, int size, double base) {
    MapLevel level;
    level.size = size;
    const std::size_t count = samples.heights.size(), channels = maps.channels();
    level.heights.resize(count);
    level.normals = samples.normals;
    level.shares.assign(count * channels, 0);
    const double scale = maps.lowest > maps.highest ? 65535.0 / (maps.lowest - maps.highest) : 0.0;
    testing::in_parallel(std::size_t(size), [&](std::size_t row) {
        for (std::size_t i = row * std::size_t(size); i < (row + 1) * std::size_t(size); ++i) {
            level.heights[i] = std::uint16_t(std::clamp(std::lround((maps.lowest - (base - double(samples.heights[i]))) * scale), 0l, 65535l));
            if (samples.paints[i] > 0) level.shares[i * channels + samples.paints[i] - 1u] = 255;
        }
    });
    return level;
}

// Mean of four normals, of unit length again.
void average_normals(const MapLevel& fine, const std::size_t (&four)[4], std::int16_t* mean) {
    double sum[3] = {0, 0, 0};
    for (const std::size_t i : four) {
        const double x = fine.normals[2 * i] / 32767.0, y = fine.normals[2 * i + 1] / 32767.0;
        sum[0] += x, sum[1] += y, sum[2] += std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
    }
    const double l = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    for (std::size_t k = 0; k < 2; ++k) mean[k] = l > 0.0 ? std::int16_t(std::lround(sum[k] / l * 32767.0)) : std::int16_t(0);
}

MapLevel next_level(const MapLevel& fine, std::size_t channels) {
    MapLevel level;
    level.size = fine.size / 2;
    const std::size_t side = std::size_t(level.size), wide = side * 2;
    level.heights.resize(side * side);
    level.normals.resize(side * side * 2);
    level.shares.resize(side * side * channels);
    testing::in_parallel(side, [&](std::size_t y) {
        for (std::size_t x = 0; x < side; ++x) {
            const std::size_t to = y * side + x, from = 2 * y * wide + 2 * x;
            const std::size_t four[4] = {from, from + 1, from + wide, from + wide + 1};
            unsigned sum = 2;
            for (const std::size_t i : four) sum += fine.heights[i];
            level.heights[to] = std::uint16_t(sum / 4);
            average_normals(fine, four, &level.normals[2 * to]);
            for (std::size_t c = 0; c < channels; ++c) {
                unsigned share = 2;
                for (const std::size_t i : four) share += fine.shares[i * channels + c];
                level.shares[to * channels + c] = std::uint8_t(share / 4);
            }
        }
    });
    return level;
}

}  // namespace

Paints paints_of(const ResolvedPattern& pattern, const MapPaint& base) {
    Paints paints{{base}, {}};
    for (const Style& style : pattern.styles) {
        const Material& own = pattern.materials[style.material];
        MapPaint paint = base;
        if (own.overrides) paint = {{own.base_color[0], own.base_color[1], own.base_color[2]}, own.metallic, own.roughness};
        const auto found = std::find(paints.list.begin(), paints.list.end(), paint);
        paints.of_style.push_back(std::uint8_t(found - paints.list.begin()));
        if (found == paints.list.end()) paints.list.push_back(paint);
    }
    return paints;
}

std::size_t SurfaceMaps::level_of(int size) const {
    std::size_t level = 0;
    while (levels[level].size > size) ++level;
    return level;
}

SurfaceMaps map_surface(const ResolvedPattern& pattern, const MapPaint& base, int size, const std::string& cache, const std::string& key) {
    const Paints paints = paints_of(pattern, base);
    const Samples samples = samples_of(pattern, paints, size, cache, key);
    SurfaceMaps maps;
    maps.metres = pattern.size;
    maps.repeat = pattern.wrap == Wrap::repeat;
    maps.paints = paints.list;
    const auto [low, high] = std::minmax_element(samples.heights.begin(), samples.heights.end());
    maps.highest = pattern.base_offset - double(*high);
    maps.lowest = pattern.base_offset - double(*low);
    maps.outer = maps.repeat ? maps.highest : pattern.base_offset - pattern.outer_level;
    maps.highest = std::min(maps.highest, maps.outer);
    maps.lowest = std::max(maps.lowest, maps.outer);
    maps.levels.push_back(first_level(maps, samples, size, pattern.base_offset));
    while (maps.levels.back().size > 1) maps.levels.push_back(next_level(maps.levels.back(), maps.channels()));
    return maps;
}

}  // namespace burin::rivals
