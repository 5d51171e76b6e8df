#include "contour.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

namespace burin::bench {
namespace {

constexpr double kLost = 2.0;
constexpr double kBucket = 0.5;

std::int64_t key_of(int x, int y) { return (static_cast<std::int64_t>(x) << 32) ^ static_cast<std::uint32_t>(y); }
int bucket(double x) { return static_cast<int>(std::floor(x / kBucket)); }

double distance_to(const Segment& s, Vec2 p) {
    const Vec2 d = s.b - s.a;
    const double square = dot(d, d);
    const double t = square > 0.0 ? std::clamp(dot(p - s.a, d) / square, 0.0, 1.0) : 0.0;
    return length(p - lerp(s.a, s.b, t));
}

class Buckets {
  public:
    explicit Buckets(const std::vector<Segment>& segments) : segments_(segments) {
        for (std::size_t i = 0; i < segments.size(); ++i) {
            const Segment& s = segments[i];
            for (int y = bucket(std::min(s.a.y, s.b.y)); y <= bucket(std::max(s.a.y, s.b.y)); ++y)
                for (int x = bucket(std::min(s.a.x, s.b.x)); x <= bucket(std::max(s.a.x, s.b.x)); ++x)
                    cells_[key_of(x, y)].push_back(static_cast<std::uint32_t>(i));
        }
    }

    double nearest(Vec2 p) const {
        double best = kLost;
        const int cx = bucket(p.x), cy = bucket(p.y);
        for (int ring = 0; ring * kBucket <= best + kBucket; ++ring) {
            for (int y = cy - ring; y <= cy + ring; ++y) {
                const int step = std::abs(y - cy) == ring ? 1 : std::max(1, 2 * ring);
                for (int x = cx - ring; x <= cx + ring; x += step) {
                    const auto found = cells_.find(key_of(x, y));
                    if (found == cells_.end()) continue;
                    for (const std::uint32_t i : found->second) best = std::min(best, distance_to(segments_[i], p));
                }
            }
        }
        return best;
    }

  private:
    const std::vector<Segment>& segments_;
    std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

constexpr double kSpot = 16.0;

struct Measured {
    double distance, weight;
    Vec2 place;
};

void measure(const std::vector<Segment>& from, const Buckets& to, std::vector<Measured>& out, LineDistance& result) {
    for (const Segment& s : from) {
        const Vec2 middle = lerp(s.a, s.b, 0.5);
        const double distance = to.nearest(middle);
        out.push_back({distance, length(s.b - s.a), middle});
        if (distance > result.max) result.max = distance, result.worst = middle;
    }
}

std::vector<LineDistance::Spot> spots_of(const std::vector<Measured>& all) {
    std::map<std::pair<int, int>, double> sums;
    double total = 1e-300;
    for (const Measured& m : all) {
        const double square = m.weight * m.distance * m.distance;
        sums[{static_cast<int>(m.place.x / kSpot), static_cast<int>(m.place.y / kSpot)}] += square;
        total += square;
    }
    std::vector<LineDistance::Spot> spots;
    for (const auto& [cell, sum] : sums) spots.push_back({{cell.first * kSpot, cell.second * kSpot}, sum / total});
    std::stable_sort(spots.begin(), spots.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
    return spots;
}

}  // namespace

void add_level_lines(const Image& surface, double level, double scale, std::vector<Segment>& out) {
    for (int y = 0; y + 1 < surface.height; ++y) {
        for (int x = 0; x + 1 < surface.width; ++x) {
            const double v[4] = {surface.at(x, y) - level, surface.at(x + 1, y) - level, surface.at(x + 1, y + 1) - level,
                                 surface.at(x, y + 1) - level};
            const int above = (v[0] > 0) + (v[1] > 0) + (v[2] > 0) + (v[3] > 0);
            if (above == 0 || above == 4) continue;
            static const int kCorner[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
            Vec2 crossing[4];
            int count = 0;
            for (int k = 0; k < 4; ++k) {
                const double a = v[k], b = v[(k + 1) % 4];
                if ((a > 0) == (b > 0)) continue;
                const double t = a / (a - b);
                crossing[count++] = {(x + 0.5 + kCorner[k][0] + t * (kCorner[k + 1][0] - kCorner[k][0])) / scale,
                                     (y + 0.5 + kCorner[k][1] + t * (kCorner[k + 1][1] - kCorner[k][1])) / scale};
            }
            out.push_back({crossing[0], crossing[1]});
            if (count == 4) out.push_back({crossing[2], crossing[3]});
        }
    }
}

LineDistance distance_between(const std::vector<Segment>& first, const std::vector<Segment>& second) {
    LineDistance result;
    std::vector<Measured> all;
    measure(first, Buckets(second), all, result);
    for (const Measured& m : all) result.length += m.weight;
    measure(second, Buckets(first), all, result);
    double weight = 0.0, squares = 0.0, lost = 0.0;
    for (const Measured& m : all) {
        weight += m.weight;
        squares += m.weight * m.distance * m.distance;
        if (m.distance >= kLost) lost += m.weight;
    }
    if (weight <= 0.0) return result;
    result.spots = spots_of(all);
    result.rms = std::sqrt(squares / weight);
    result.lost = lost / weight;
    std::sort(all.begin(), all.end(), [](const Measured& a, const Measured& b) { return a.distance > b.distance; });
    double seen = 0.0;
    for (const Measured& m : all) {
        seen += m.weight;
        result.p999 = m.distance;
        if (seen >= 0.001 * weight) break;
    }
    return result;
}

}  // namespace burin::bench
