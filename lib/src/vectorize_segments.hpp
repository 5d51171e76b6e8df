// Segments of many chains in buckets, for questions of the kind "what lies near here". Part of stage vectorize.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vectorize_internal.hpp"

namespace burin::vectorizing {

struct Segment {
    Vec2 a, b;
    std::uint32_t chain = 0;
    std::uint32_t index = 0;  // along the chain
};

// Buckets of 16 texels; on a map that tiles, a segment is found under its image in the tile.
class SegmentBuckets {
  public:
    explicit SegmentBuckets(const Lattice& lattice)
        : lattice_(lattice), columns_(std::max(1, (lattice.width + kSide - 1) / kSide)),
          rows_(std::max(1, (lattice.height + kSide - 1) / kSide)),
          buckets_(static_cast<std::size_t>(columns_) * rows_) {}

    void add(const Segment& segment) {
        const std::uint32_t id = static_cast<std::uint32_t>(segments_.size());
        segments_.push_back(segment);
        for_each_bucket(segment.a, segment.b, 0.0, [&](std::vector<std::uint32_t>& bucket) { bucket.push_back(id); });
    }

    // Calls visit(segment, shift) for every segment whose bucket the box of a-b touches; segment + shift is the image
    // nearest to a. A segment may come more than once.
    template <typename Visit>
    void near(Vec2 a, Vec2 b, double margin, const Visit& visit) const {
        const_cast<SegmentBuckets*>(this)->for_each_bucket(a, b, margin, [&](const std::vector<std::uint32_t>& bucket) {
            for (const std::uint32_t id : bucket) {
                const Segment& s = segments_[id];
                Vec2 shift;
                if (lattice_.wrap)
                    shift = {lattice_.width * std::round((a.x - s.a.x) / lattice_.width),
                             lattice_.height * std::round((a.y - s.a.y) / lattice_.height)};
                visit(s, shift);
            }
        });
    }

    template <typename Visit>
    void for_each(const Visit& visit) const {
        for (const Segment& segment : segments_) visit(segment);
    }

  private:
    static constexpr int kSide = 16;

    template <typename Use>
    void for_each_bucket(Vec2 a, Vec2 b, double margin, const Use& use) {
        const int x0 = static_cast<int>(std::floor((std::min(a.x, b.x) - margin) / kSide));
        const int x1 = static_cast<int>(std::floor((std::max(a.x, b.x) + margin) / kSide));
        const int y0 = static_cast<int>(std::floor((std::min(a.y, b.y) - margin) / kSide));
        const int y1 = static_cast<int>(std::floor((std::max(a.y, b.y) + margin) / kSide));
        // A map whose side is no multiple of the bucket's has a narrower last bucket: go by texel, not by bucket.
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const int i = bucket_at(x, y);
                if (i >= 0) use(buckets_[i]);
            }
    }
    int bucket_at(int x, int y) const {
        if (lattice_.wrap) {
            x = Lattice::modulo(x * kSide, lattice_.width) / kSide;
            y = Lattice::modulo(y * kSide, lattice_.height) / kSide;
        }
        x = std::clamp(x, 0, columns_ - 1);
        y = std::clamp(y, 0, rows_ - 1);
        return y * columns_ + x;
    }

    const Lattice& lattice_;
    int columns_, rows_;
    std::vector<std::vector<std::uint32_t>> buckets_;
    std::vector<Segment> segments_;
};

// Where p-q meets a-b: parameters along both, or false when they are parallel or do not meet.
inline bool meet(Vec2 p, Vec2 q, Vec2 a, Vec2 b, double& along_pq, double& along_ab) {
    const Vec2 d = q - p, e = b - a;
    const double det = cross(d, e);
    if (det == 0.0) return false;
    along_pq = cross(a - p, e) / det;
    along_ab = cross(a - p, d) / det;
    return along_pq >= 0.0 && along_pq <= 1.0 && along_ab >= 0.0 && along_ab <= 1.0;
}

}  // namespace burin::vectorizing
