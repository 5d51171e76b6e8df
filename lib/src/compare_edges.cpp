// Edge positions of a reconstruction against its map.
//
// Along a row or a column, texels are means over neighbouring boxes, so their sum across a wall gives the
// wall's place exactly, however sharp it is and wherever it lies between the texels. Where a contour crosses
// the line drawn from sample to sample does not: at a vertical wall it moves by half to twice the way the
// wall moves. The places compared are therefore means over the heights around half of the wall, as many as
// both maps have there: the same sum, and the plain contour where the heights are few.
#include <burin/compare.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <vector>

namespace burin {

namespace {

constexpr int kReach =
    4;  // texels along the normal, from the steepest place of a wall to its foot and to its top
constexpr double kLevelledOut = 0.25;         // of the steepest slope: less is no longer the wall
constexpr double kLeastShare = 1.0 / 16.0;    // of the map's own range: lower walls are not strong
constexpr double kLeastHeight = 4.0 / 255.0;  // and these are steps of an 8-bit map's grey
constexpr double kLeastGrains =
    10.0;                          // of the grain: least slope per texel, moves a contour by a tenth of one
constexpr double kLost = 2.0;      // texels
constexpr double kDoubtful = 0.5;  // texels along the line, from which on the contour may be nearer elsewhere

// Index i brought into [0, n): around the border, or held at it.
int folded(int i, int n, bool wrap) {
    if (i >= 0 && i < n) return i;
    return wrap ? ((i % n) + n) % n : std::clamp(i, 0, n - 1);
}

struct Map {
    const Image& image;
    bool wrap;
    double at(int x, int y) const {
        return static_cast<double>(image.at(folded(x, image.width, wrap), folded(y, image.height, wrap)));
    }
};

// A row or a column. `sign` -1 turns it upside down, so that every wall rises with growing index.
struct Line {
    const Map& map;
    bool row;
    int number;
    double sign;
    double at(int i) const { return sign * (row ? map.at(i, number) : map.at(number, i)); }
    double rise(int i) const { return at(i + 1) - at(i); }
};

// Samples first .. last of a line rise from the foot of a wall to its top.
struct Wall {
    int first = 0, last = 0;
    int steepest = 0;  // from this sample to the next
    double low = 0.0, high = 0.0;
    bool levels_out = true;  // within reach, on both sides
    double middle() const { return 0.5 * (low + high); }
};

Wall wall_at(const Line& line, int i, int reach) {
    for (int k = 0; k < reach; ++k) {
        if (line.rise(i + 1) > line.rise(i))
            ++i;
        else if (line.rise(i - 1) > line.rise(i))
            --i;
    }
    Wall wall{i, i + 1, i};
    const double least = kLevelledOut * line.rise(i);
    while (wall.last - i <= reach && line.rise(wall.last) >= least) ++wall.last;
    while (i - wall.first < reach && line.rise(wall.first - 1) >= least) --wall.first;
    wall.levels_out = line.rise(wall.last) < least && line.rise(wall.first - 1) < least;
    // The texel that a vertical wall touches at its rim.
    if (line.rise(wall.last) > 0.0) ++wall.last;
    if (line.rise(wall.first - 1) > 0.0) --wall.first;
    wall.low = line.at(wall.first);
    wall.high = line.at(wall.last);
    return wall;
}

// False when another place of the same wall is as steep: it stands for the wall then.
bool is_steepest(const Line& line, const Wall& wall, int i) {
    for (int j = wall.first; j < wall.last; ++j)
        if (j < i ? line.rise(j) >= line.rise(i) : line.rise(j) > line.rise(i)) return false;
    return wall.steepest == i;
}

// Mean place of the contours at heights low .. high along the wall.
double mean_place(const Line& line, const Wall& wall, double low, double high) {
    double sum = 0.0, weight = 0.0;
    for (int i = wall.first; i < wall.last; ++i) {
        const double a = line.at(i), b = line.at(i + 1);
        const double from = std::max(a, low), to = std::min(b, high);
        if (to <= from) continue;
        sum += (to - from) * (i + (0.5 * (from + to) - a) / (b - a));
        weight += to - from;
    }
    return sum / weight;
}

// Where the line rises through a level, nearest to `near` within `reach`: the sample before.
std::optional<int> crossing_near(const Line& line, double level, double near, double reach) {
    std::optional<int> found;
    double best = reach;
    const int middle = static_cast<int>(std::floor(near)), steps = static_cast<int>(reach) + 1;
    for (int i = middle - steps; i <= middle + steps; ++i) {
        const double a = line.at(i), b = line.at(i + 1);
        if (!(a < level && level <= b)) continue;
        const double off = std::abs(i + (level - a) / (b - a) - near);
        if (off <= best) best = off, found = i;
    }
    return found;
}

double distance_to(Vec2 a, Vec2 b, Vec2 p) {
    const Vec2 d = b - a;
    const double square = dot(d, d);
    const double t = square > 0.0 ? std::clamp(dot(p - a, d) / square, 0.0, 1.0) : 0.0;
    return length(p - lerp(a, b, t));
}

// The contour of `level` between four neighbouring samples (x, y) .. (x + 1, y + 1), where it rises along
// `uphill`: its distance from p.
double distance_in_cell(const Map& map, int x, int y, double level, Vec2 uphill, Vec2 p) {
    const std::array<double, 4> v{map.at(x, y) - level, map.at(x + 1, y) - level,
                                  map.at(x + 1, y + 1) - level, map.at(x, y + 1) - level};
    const Vec2 gradient{v[1] + v[2] - v[0] - v[3], v[2] + v[3] - v[0] - v[1]};
    if (dot(gradient, uphill) <= 0.0) return kLost;
    constexpr std::array<Vec2, 5> corner{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
    std::array<Vec2, 4> crossing;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const double a = v[k], b = v[(k + 1) % 4];
        if ((a >= 0.0) == (b >= 0.0)) continue;
        crossing[count++] = Vec2{double(x), double(y)} + lerp(corner[k], corner[k + 1], a / (a - b));
    }
    double best = kLost;
    for (std::size_t k = 0; k + 1 < count; k += 2)
        best = std::min(best, distance_to(crossing[k], crossing[k + 1], p));
    return best;
}

double nearest_contour(const Map& map, double level, Vec2 uphill, Vec2 p) {
    const int cx = static_cast<int>(std::floor(p.x)), cy = static_cast<int>(std::floor(p.y));
    double best = kLost;
    for (int y = cy - 2; y <= cy + 2; ++y)
        for (int x = cx - 2; x <= cx + 2; ++x)
            best = std::min(best, distance_in_cell(map, x, y, level, uphill, p));
    return best;
}

// Standard deviation of the grain: the median of a second difference along both axes, which planes and steps
// along the axes leave at 0.
double grain_of(const Map& map) {
    std::vector<float> responses;
    for (int y = 0; y < map.image.height; y += 2) {
        for (int x = (y / 2) % 2; x < map.image.width; x += 2) {
            double sum = 0.0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                    sum += (dx == 0 ? 2 : -1) * (dy == 0 ? 2 : -1) * map.at(x + dx, y + dy);
            responses.push_back(static_cast<float>(std::abs(sum)));
        }
    }
    const auto middle = responses.begin() + static_cast<std::ptrdiff_t>(responses.size() / 2);
    std::nth_element(responses.begin(), middle, responses.end());
    return static_cast<double>(*middle) / 0.6745 / 6.0;
}

// Distances by the length they stand for; the percentile is good to a thousandth of a texel.
class Distances {
  public:
    void add(double distance, double weight) {
        const bool is_lost = distance >= kLost;
        const double d = std::min(distance, kLost);
        length_ += weight;
        squares_ += weight * d * d;
        if (is_lost) lost_ += weight;
        bins_[static_cast<std::size_t>(d * kPerTexel)] += weight;
    }
    EdgeError figures() const;

  private:
    static constexpr double kPerTexel = 1000.0;
    std::vector<double> bins_ = std::vector<double>(static_cast<std::size_t>(kLost * kPerTexel) + 1, 0.0);
    double length_ = 0.0, squares_ = 0.0, lost_ = 0.0;
};

EdgeError Distances::figures() const {
    EdgeError out;
    if (length_ <= 0.0) return out;
    out.length = length_;
    out.lost = lost_ / length_;
    out.rms = std::sqrt(squares_ / length_);
    const double found = length_ - lost_;
    if (lost_ < length_) out.rms_found = std::sqrt(std::max(0.0, squares_ - lost_ * kLost * kLost) / found);
    double beyond = 0.0;
    std::size_t bin = bins_.size();
    while (bin > 0 && beyond <= 0.001 * length_) beyond += bins_[--bin];
    out.p999 = static_cast<double>(bin) / kPerTexel;
    return out;
}

// Looks at one line after the other for walls of the map and their places in both maps.
class EdgeSearch {
  public:
    EdgeSearch(const Map& reconstruction, const Map& input) : reconstruction_(reconstruction), input_(input) {
        const auto [low, high] = std::minmax_element(input.image.texels.begin(), input.image.texels.end());
        const double range = static_cast<double>(*high) - static_cast<double>(*low);
        least_height_ = std::max(kLeastHeight, kLeastShare * range);
        // Less cannot rise that high within the wall's reach.
        least_slope_ = std::max(kLeastGrains * grain_of(input), least_height_ / (3 * kReach + 3));
    }

    void look_along(bool rows) {
        const int lines = rows ? input_.image.height : input_.image.width;
        const int count = rows ? input_.image.width : input_.image.height;
        const int pairs = input_.wrap ? count : count - 1;
        for (int number = 0; number < lines; ++number) {
            const Line line{input_, rows, number, 1.0};
            for (int i = 0; i < pairs; ++i) {
                const double rise = line.rise(i);
                if (std::abs(rise) >= least_slope_)
                    look_at({input_, rows, number, rise > 0.0 ? 1.0 : -1.0}, i);
            }
        }
    }

    EdgeError figures() const { return distances_.figures(); }

  private:
    void look_at(const Line& line, int i);
    Vec2 uphill_at(const Line& line, int i) const;
    double distance(const Line& line, const Wall& wall, double along, Vec2 uphill) const;

    const Map& reconstruction_;
    const Map& input_;
    double least_height_ = 0.0, least_slope_ = 0.0;
    Distances distances_;
};

// Texels along a line that makes an angle of this cosine with the normal.
int reach_of(double along) { return static_cast<int>(std::lround(kReach / along)); }

// Direction of the map's steepest ascent between samples i and i + 1 of a line; (1, 0) where it is level.
Vec2 EdgeSearch::uphill_at(const Line& line, int i) const {
    Vec2 sum;
    for (int k = i; k <= i + 1; ++k) {
        const int x = line.row ? k : line.number, y = line.row ? line.number : k;
        for (int d = -1; d <= 1; ++d) {
            const double weight = d == 0 ? 2.0 : 1.0;
            sum.x += weight * (input_.at(x + 1, y + d) - input_.at(x - 1, y + d));
            sum.y += weight * (input_.at(x + d, y + 1) - input_.at(x + d, y - 1));
        }
    }
    return unit(sum);
}

void EdgeSearch::look_at(const Line& line, int i) {
    // A wall is looked at along the axis that crosses it at the steeper angle.
    const Vec2 uphill = uphill_at(line, i);
    const double along = line.sign * (line.row ? uphill.x : uphill.y);
    const double across = std::abs(line.row ? uphill.y : uphill.x);
    if (line.row ? along < across : along <= across) return;
    const Wall wall = wall_at(line, i, reach_of(along));
    if (!wall.levels_out || wall.high - wall.low < least_height_ || !is_steepest(line, wall, i)) return;
    distances_.add(distance(line, wall, along, uphill), 1.0 / along);
}

// Of the two contours at half the wall's height; kLost or more: there is none. `along`: cosine between line
// and normal.
double EdgeSearch::distance(const Line& line, const Wall& wall, double along, Vec2 uphill) const {
    const double level = wall.middle();
    const double place = mean_place(line, wall, wall.low, wall.high);
    const Line other{reconstruction_, line.row, line.number, line.sign};
    double best = kLost;
    if (const auto found = crossing_near(other, level, place, kLost / along)) {
        Wall there = wall_at(other, *found, reach_of(along));
        if (there.first > *found || there.last <= *found)
            there = {*found, *found + 1, *found, other.at(*found), other.at(*found + 1)};
        const double half = std::min({wall.high - level, there.high - level, level - there.low});
        const double low = level - half, high = level + half;
        // A level that the reconstruction just touches has no heights around it.
        if (half > 1e-6 * (wall.high - wall.low))
            best = along * std::abs(mean_place(other, there, low, high) - mean_place(line, wall, low, high));
    }
    if (best <= kDoubtful) return best;
    const Vec2 p = line.row ? Vec2{place, double(line.number)} : Vec2{double(line.number), place};
    return std::min(best, nearest_contour(reconstruction_, line.sign * level, uphill, p));
}

}  // namespace

EdgeError compare_edges(const Image& reconstruction, const Image& input, Wrap wrap) {
    assert(reconstruction.width == input.width && reconstruction.height == input.height);
    assert(!input.texels.empty());
    const Map ours{reconstruction, wrap == Wrap::repeat}, theirs{input, wrap == Wrap::repeat};
    EdgeSearch search(ours, theirs);
    search.look_along(true);
    search.look_along(false);
    return search.figures();
}

}  // namespace burin
