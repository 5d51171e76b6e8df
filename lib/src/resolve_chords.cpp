#include "resolve_chords.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

namespace burin::resolving {
namespace {

using Filtered = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;

int floor_divide(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

int orientation(Vec2 a, Vec2 b, Vec2 c) {
    return CGAL::orientation(Filtered::Point_2(a.x, a.y), Filtered::Point_2(b.x, b.y),
                             Filtered::Point_2(c.x, c.y));
}

int sign(double v) { return v > 0.0 ? 1 : v < 0.0 ? -1 : 0; }

// Sign of cross(d, (e, e^2)) for an infinitesimal e > 0: the direction all ties are broken along.
int perturbed_sign(Vec2 d) { return d.y != 0.0 ? -sign(d.y) : sign(d.x); }

// Side of line ab on which c lies when c was moved by the infinitesimal vector.
int side_of_moved(Vec2 a, Vec2 b, Vec2 c) {
    const int exact = orientation(a, b, c);
    return exact != 0 ? exact : perturbed_sign(b - a);
}

// Side of line ab on which c lies when a and b were moved by it.
int side_of_fixed(Vec2 a, Vec2 b, Vec2 c) {
    const int exact = orientation(a, b, c);
    return exact != 0 ? exact : -perturbed_sign(b - a);
}

bool cross_properly(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    return side_of_moved(a, b, c) != side_of_moved(a, b, d) &&
           side_of_fixed(c, d, a) != side_of_fixed(c, d, b);
}

// The crossing point, constructed exactly and rounded once; for chords that only touch, a shared end.
Vec2 crossing_point(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    const Exact::Segment_2 first(Exact::Point_2(a.x, a.y), Exact::Point_2(b.x, b.y));
    const Exact::Segment_2 second(Exact::Point_2(c.x, c.y), Exact::Point_2(d.x, d.y));
    const auto meeting = CGAL::intersection(first, second);
    if (meeting) {
        if (const auto* p = boost::get<Exact::Point_2>(&*meeting))
            return {CGAL::to_double(p->x()), CGAL::to_double(p->y())};
        if (const auto* s = boost::get<Exact::Segment_2>(&*meeting))
            return {0.5 * CGAL::to_double(s->source().x() + s->target().x()),
                    0.5 * CGAL::to_double(s->source().y() + s->target().y())};
    }
    double along = 0.0;
    return segment_distance(a, b, c, along) < segment_distance(a, b, d, along) ? c : d;
}

bool boxes_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    return std::min(a.x, b.x) <= std::max(c.x, d.x) && std::min(c.x, d.x) <= std::max(a.x, b.x) &&
           std::min(a.y, b.y) <= std::max(c.y, d.y) && std::min(c.y, d.y) <= std::max(a.y, b.y);
}

}  // namespace

double segment_distance(Vec2 a, Vec2 b, Vec2 p, double& along) {
    const Vec2 d = b - a;
    const double dd = dot(d, d);
    along = dd > 0.0 ? std::clamp(dot(p - a, d) / dd, 0.0, 1.0) : 0.0;
    return length(p - lerp(a, b, along));
}

ChordIndex::ChordIndex(std::vector<Chord> chords, Vec2 size, bool repeat)
    : chords_(std::move(chords)), size_(size), repeat_(repeat) {
    Box box;
    for (const Chord& chord : chords_)
        for (const Vec2 p : {chord.a, chord.b}) {
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
        }
    if (repeat_ || chords_.empty()) box = {{0.0, 0.0}, size_};
    size_buckets(box);
    fill();
}

void ChordIndex::size_buckets(Box box) {
    origin_ = box.low;
    const Vec2 extent = {std::max(box.high.x - box.low.x, 1e-9 * size_.x),
                         std::max(box.high.y - box.low.y, 1e-9 * size_.y)};
    // About one chord per bucket; long chords among short ones pass many buckets, so the mean length bounds
    // them below.
    double total = 0.0;
    for (const Chord& chord : chords_) total += length(chord.b - chord.a);
    const double count = std::max<double>(1.0, static_cast<double>(chords_.size()));
    double side = std::sqrt(extent.x * extent.y / count);
    side = std::max({side, 0.5 * total / count, std::max(extent.x, extent.y) / 1024.0});
    cols_ = std::clamp(static_cast<int>(extent.x / side), 1, 1024);
    rows_ = std::clamp(static_cast<int>(extent.y / side), 1, 1024);
    side_ = {extent.x / cols_, extent.y / rows_};
}

ChordIndex::Bucket ChordIndex::bucket_at(Vec2 p) const {
    const double x = std::floor((p.x - origin_.x) / side_.x), y = std::floor((p.y - origin_.y) / side_.y);
    return {static_cast<int>(std::clamp(x, -1e8, 1e8)), static_cast<int>(std::clamp(y, -1e8, 1e8))};
}

bool ChordIndex::place(Bucket bucket, std::size_t& slot, Shift& tile) const {
    tile = {};
    if (repeat_) {
        tile = {floor_divide(bucket.x, cols_), floor_divide(bucket.y, rows_)};
        bucket.x -= tile.x * cols_;
        bucket.y -= tile.y * rows_;
    } else {
        // The box's far border belongs to the last bucket.
        if (bucket.x == cols_) --bucket.x;
        if (bucket.y == rows_) --bucket.y;
        if (bucket.x < 0 || bucket.y < 0 || bucket.x >= cols_ || bucket.y >= rows_) return false;
    }
    slot = static_cast<std::size_t>(bucket.y) * cols_ + bucket.x;
    return true;
}

// Visits the buckets a segment passes, a little grown so that rounding cannot lose one.
template <typename Visit>
void ChordIndex::walk(Vec2 a, Vec2 b, Visit visit) const {
    if (a.y > b.y) std::swap(a, b);
    const Vec2 pad = {1e-9 * side_.x + 1e-12 * std::abs(a.x), 1e-9 * side_.y + 1e-12 * std::abs(a.y)};
    const int first_row = bucket_at(a - pad).y, last_row = bucket_at(b + pad).y;
    for (int row = first_row; row <= last_row; ++row) {
        const double low = origin_.y + row * side_.y - pad.y, high = low + side_.y + 2.0 * pad.y;
        const auto x_at = [&](double y) {
            return b.y > a.y ? a.x + (b.x - a.x) * std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0) : a.x;
        };
        double left = b.y > a.y ? x_at(low) : a.x, right = b.y > a.y ? x_at(high) : b.x;
        if (left > right) std::swap(left, right);
        const int last = bucket_at({right + pad.x, low}).x;
        for (int col = bucket_at({left - pad.x, low}).x; col <= last; ++col) visit(Bucket{col, row});
    }
}

void ChordIndex::fill() {
    const std::size_t count = static_cast<std::size_t>(cols_) * rows_;
    first_.assign(count + 1, 0);
    std::size_t slot = 0;
    Shift tile;
    for (const Chord& chord : chords_)
        walk(chord.a, chord.b, [&](Bucket bucket) {
            if (place(bucket, slot, tile)) ++first_[slot + 1];
        });
    for (std::size_t i = 0; i < count; ++i) first_[i + 1] += first_[i];
    entries_.resize(first_[count]);
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < chords_.size(); ++i)
        walk(chords_[i].a, chords_[i].b, [&](Bucket bucket) {
            if (place(bucket, slot, tile)) entries_[next[slot]++] = {i, tile};
        });
}

void ChordIndex::visit_box(Box box, const std::function<void(std::uint32_t, Shift)>& visit) const {
    Bucket low = bucket_at(box.low), high = bucket_at(box.high);
    if (!repeat_) {
        low = {std::max(low.x, 0), std::max(low.y, 0)};
        high = {std::min(high.x, cols_), std::min(high.y, rows_)};
    }
    std::size_t slot = 0;
    Shift tile;
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            if (!place({x, y}, slot, tile)) continue;
            for (std::uint32_t i = first_[slot]; i < first_[slot + 1]; ++i)
                visit(entries_[i].chord, {tile.x - entries_[i].tile.x, tile.y - entries_[i].tile.y});
        }
}

void ChordIndex::visit_pairs(const std::function<void(std::uint32_t, std::uint32_t, Shift)>& visit) const {
    for (std::size_t slot = 0; slot + 1 < first_.size(); ++slot)
        for (std::uint32_t i = first_[slot]; i < first_[slot + 1]; ++i)
            for (std::uint32_t k = i + 1; k < first_[slot + 1]; ++k) {
                Entry a = entries_[i], b = entries_[k];
                if (a.chord > b.chord) std::swap(a, b);
                visit(a.chord, b.chord, {a.tile.x - b.tile.x, a.tile.y - b.tile.y});
            }
}

void ChordIndex::visit_rings(Vec2 p, const std::function<double(std::uint32_t, Shift)>& visit) const {
    const Bucket centre = bucket_at(p);
    const double side = std::min(side_.x, side_.y);
    std::size_t slot = 0;
    Shift tile;
    // In a repeating plane a ring of one tile and a half has seen a copy of everything; in a clamped one p
    // may lie outside.
    const int reach_x = std::max(std::abs(centre.x), std::abs(centre.x - cols_)) + 1;
    const int reach_y = std::max(std::abs(centre.y), std::abs(centre.y - rows_)) + 1;
    const int last = repeat_ ? 2 * std::max(cols_, rows_) + 2 : std::max(reach_x, reach_y);
    const auto visit_bucket = [&](int x, int y, double best) {
        if (!place({x, y}, slot, tile)) return best;
        for (std::uint32_t i = first_[slot]; i < first_[slot + 1]; ++i)
            best = visit(entries_[i].chord, {tile.x - entries_[i].tile.x, tile.y - entries_[i].tile.y});
        return best;
    };
    // In a clamped plane only the part of a ring that lies over the buckets is walked, from the first ring that does.
    constexpr int kAnywhere = 1 << 30;
    const int low = repeat_ ? -kAnywhere : 0, high_x = repeat_ ? kAnywhere : cols_, high_y = repeat_ ? kAnywhere : rows_;
    const int first = repeat_ ? 0 : std::max({0, -centre.x, centre.x - cols_, -centre.y, centre.y - rows_});
    double best = 1e300;
    for (int ring = first; ring <= last; ++ring) {
        if ((ring - 1) * side > best) return;
        const auto visit_row = [&](int y) {
            if (y < low || y > high_y) return;
            const int end = std::min(centre.x + ring, high_x);
            for (int x = std::max(centre.x - ring, low); x <= end; ++x) best = visit_bucket(x, y, best);
        };
        const auto visit_column = [&](int x) {
            if (x < low || x > high_x) return;
            const int end = std::min(centre.y + ring - 1, high_y);
            for (int y = std::max(centre.y - ring + 1, low); y <= end; ++y) best = visit_bucket(x, y, best);
        };
        visit_row(centre.y - ring);
        if (ring == 0) continue;
        visit_row(centre.y + ring);
        visit_column(centre.x - ring);
        visit_column(centre.x + ring);
    }
}

std::vector<ChordCrossing> find_crossings(
    const ChordIndex& index, const std::function<bool(const Chord&, const Chord&, Shift)>& wanted) {
    std::vector<ChordCrossing> found;
    index.visit_pairs([&](std::uint32_t first, std::uint32_t second, Shift shift) {
        const Chord &one = index.chords()[first], &two = index.chords()[second];
        const Vec2 by = shift * index.size();
        const Vec2 c = two.a + by, d = two.b + by;
        if (!boxes_meet(one.a, one.b, c, d) || !wanted(one, two, shift) ||
            !cross_properly(one.a, one.b, c, d))
            return;
        found.push_back({first, second, shift, {}});
    });
    const auto key = [](const ChordCrossing& x) {
        return std::tuple(x.first, x.second, x.shift.x, x.shift.y);
    };
    std::sort(found.begin(), found.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    found.erase(std::unique(found.begin(), found.end(),
                            [&](const auto& a, const auto& b) { return key(a) == key(b); }),
                found.end());
    for (ChordCrossing& crossing : found) {
        const Chord &one = index.chords()[crossing.first], &two = index.chords()[crossing.second];
        const Vec2 by = crossing.shift * index.size();
        crossing.position = crossing_point(one.a, one.b, two.a + by, two.b + by);
    }
    return found;
}

}  // namespace burin::resolving
