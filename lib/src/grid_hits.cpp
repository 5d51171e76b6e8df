// Which cells each element touches.
#include <algorithm>
#include <cmath>

#include "grid_internal.hpp"
#include "parallel.hpp"
#include "resolve_curve.hpp"

namespace burin::gridding {
namespace {

bool is_smooth(const ElementEnd& a, const ElementEnd& b) {
    const auto clip = [](const ElementEnd& end) {
        return end.priority == Priority::both && end.shape == static_cast<std::uint8_t>(EndShape::clip);
    };
    if (!clip(a) || !clip(b)) return false;
    const double gap = std::abs(a.clip_angle - b.clip_angle);
    return std::min(gap, 3.14159265358979323846 - gap) < 2e-3;
}

// Whether two points coincide, modulo the tile when it repeats.
bool same_place(const ResolvedPattern& pattern, Vec2 p, Vec2 q) {
    Vec2 gap = q - p;
    if (pattern.wrap == Wrap::repeat)
        gap = gap - Vec2{std::round(gap.x / pattern.size.x) * pattern.size.x,
                         std::round(gap.y / pattern.size.y) * pattern.size.y};
    // Unpacked coordinates carry the rounding of 20 bits.
    return std::abs(gap.x) <= 4e-6 * pattern.size.x && std::abs(gap.y) <= 4e-6 * pattern.size.y;
}

void merge(HeightRange& into, const HeightRange& range) {
    into.low = std::min(into.low, range.low);
    into.high = std::max(into.high, range.high);
}

class Toucher {
  public:
    Toucher(const Frame& frame, const ResolvedElement& element, Joints joints)
        : frame_(frame), element_(element) {
        const double piece = 3.0 * std::max(frame.cell.x, frame.cell.y);
        profile_ = &frame.pattern.profiles[frame.pattern.styles[element.style].profile];
        for (const Shape& shape : shapes_of(frame.pattern, element, joints, piece)) touch(shape);
    }

    // One hit per cell.
    std::vector<Hit> take() {
        std::sort(hits_.begin(), hits_.end(), [](const Hit& a, const Hit& b) { return a.cell < b.cell; });
        std::vector<Hit> merged;
        for (const Hit& hit : hits_) {
            if (merged.empty() || merged.back().cell != hit.cell) {
                merged.push_back(hit);
                continue;
            }
            merged.back().path_line |= hit.path_line;
            merged.back().end_zone |= hit.end_zone;
            merge(merged.back().heights, hit.heights);
        }
        return merged;
    }

  private:
    void touch(const Shape& shape) {
        const auto first = [&](double low, double side) {
            return static_cast<int>(std::floor(low / side - frame_.margin));
        };
        const auto last = [&](double high, double side) {
            return static_cast<int>(std::floor(high / side + frame_.margin));
        };
        int left = first(shape.box.low.x, frame_.cell.x), right = last(shape.box.high.x, frame_.cell.x);
        int top = first(shape.box.low.y, frame_.cell.y), bottom = last(shape.box.high.y, frame_.cell.y);
        if (!frame_.repeats()) {
            left = std::max(left, 0), top = std::max(top, 0);
            right = std::min(right, frame_.cols - 1), bottom = std::min(bottom, frame_.rows - 1);
        }
        for (int row = top; row <= bottom; ++row)
            for (int col = left; col <= right; ++col) touch_cell(shape, col, row);
    }

    void touch_cell(const Shape& shape, int col, int row) {
        const Box rectangle = frame_.margin_rectangle(col, row);
        if (!meets(shape, rectangle)) return;
        Hit hit;
        const int x = frame_.repeats() ? (col % frame_.cols + frame_.cols) % frame_.cols : col;
        const int y = frame_.repeats() ? (row % frame_.rows + frame_.rows) % frame_.rows : row;
        hit.cell = static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(frame_.cols) +
                   static_cast<std::uint32_t>(x);
        hit.end_zone = shape.end_zone;
        hit.path_line = shape.path_line && segment_meets(shape.chord[0], shape.chord[1],
                                                         shape.sag + 1e-9 * frame_.cell.x, rectangle);
        hit.heights = heights_in(shape, *profile_, rectangle);
        hits_.push_back(hit);
    }

    const Frame& frame_;
    const ResolvedElement& element_;
    const ResolvedProfile* profile_;
    std::vector<Hit> hits_;
};

}  // namespace

void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
    constexpr std::size_t kPiece = 64, kWorthAThread = 256;
    const int worth = static_cast<int>(std::max<std::size_t>(1, (count + kWorthAThread - 1) / kWorthAThread));
    for_each_piece((count + kPiece - 1) / kPiece, std::min(thread_count(threads), worth), [&](std::size_t piece) {
        for (std::size_t i = piece * kPiece; i < std::min(count, (piece + 1) * kPiece); ++i) work(i);
    });
}

Chain find_chain(const ResolvedPattern& pattern) {
    const auto& elements = pattern.elements;
    Chain chain{std::vector<std::uint32_t>(elements.size(), kNoElement),
                std::vector<char>(elements.size(), 0)};
    const auto link = [&](std::size_t a, std::size_t b) {
        if (!is_smooth(elements[a].end, elements[b].start) ||
            !same_place(pattern, elements[a].element.p2, elements[b].element.p0))
            return;
        // A change of profile or level is a joint of place, not of surface.
        if (elements[a].style != elements[b].style) return;
        chain.next[a] = static_cast<std::uint32_t>(b);
        chain.joined_start[b] = 1;
    };
    std::size_t first = 0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (i + 1 < elements.size() && elements[i + 1].path == elements[i].path) {
            link(i, i + 1);
        } else {
            if (i > first) link(i, first);
            first = i + 1;
        }
    }
    return chain;
}

Vec2 farthest_extent(const ResolvedPattern& pattern, const Chain& chain) {
    Vec2 extent{0.0, 0.0};
    for (std::uint32_t i = 0; i < pattern.elements.size(); ++i) {
        const ResolvedElement& e = pattern.elements[i];
        const Vec2 middle = lerp(e.element.p0, e.element.p2, 0.5);
        for (const Shape& shape : shapes_of(pattern, e, chain.joints(i), 1e300)) {
            extent.x = std::max({extent.x, middle.x - shape.box.low.x, shape.box.high.x - middle.x});
            extent.y = std::max({extent.y, middle.y - shape.box.low.y, shape.box.high.y - middle.y});
        }
    }
    return extent;
}

std::vector<std::vector<Hit>> find_hits(const Frame& frame, const Chain& chain, int threads) {
    std::vector<std::vector<Hit>> hits(frame.pattern.elements.size());
    for_each_index(hits.size(), threads, [&](std::size_t i) {
        hits[i] =
            Toucher(frame, frame.pattern.elements[i], chain.joints(static_cast<std::uint32_t>(i))).take();
    });
    return hits;
}

}  // namespace burin::gridding
