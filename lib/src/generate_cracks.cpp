// Cracks: each wanders, sends out branches and thins to nothing at its ends.
#include <algorithm>
#include <cmath>

#include "generate_internal.hpp"

namespace burin::generating {
namespace {

constexpr int kSteps = 40;         // pieces of a crack of full length
constexpr double kMostPaths = 200000;

class CrackGrower {
  public:
    CrackGrower(Work& work, std::uint32_t profile)
        : work_(work), profile_(profile), step_(work.value("length") / kSteps), wander_(work.value("wander")), branching_(work.value("branching")) {}

    // From the middle both ways, so that no end is open.
    void grow_trunk(Chance& chance, Vec2 at, double heading, double length) {
        std::vector<Vec2> back = wandered(chance, at, heading + 180.0, 0.5 * length);
        const std::vector<Vec2> forth = wandered(chance, at, heading, 0.5 * length);
        const std::size_t middle = back.size() - 1;
        std::reverse(back.begin(), back.end());
        back.insert(back.end(), forth.begin() + 1, forth.end());
        std::vector<double> scale;
        for (std::size_t i = 0; i < back.size(); ++i)
            scale.push_back(i < middle ? double(i) / double(middle) : 1.0 - double(i - middle) / double(back.size() - 1 - middle));
        add(chance, back, scale, work_.count("generations"));
    }

  private:
    // Points of a walk whose heading strays and comes back.
    std::vector<Vec2> wandered(Chance& chance, Vec2 at, double heading, double length) const {
        std::vector<Vec2> points = {at};
        const int steps = std::max(2, int(std::round(length / step_)));
        double stray = 0.0;
        for (int i = 0; i < steps; ++i) {
            stray = 0.75 * stray + wander_ * chance.normal();
            points.push_back(points.back() + steady::direction((heading + stray) / kFullTurn) * (length / steps * chance.between(0.6, 1.4)));
        }
        return points;
    }

    void add(Chance& chance, const std::vector<Vec2>& points, const std::vector<double>& scale, int generations) {
        Path path;
        path.profile = profile_;
        for (std::size_t i = 0; i + 1 < points.size(); ++i) path.elements.push_back(scaled(straight(points[i], points[i + 1]), scale[i], scale[i + 1]));
        work_.pattern.paths.push_back(std::move(path));
        if (generations == 0) return;
        for (std::size_t i = 1; i + 2 < points.size(); ++i)
            if (chance.uniform() < branching_) branch(chance, points[i], points[i + 1], 0.5 * (scale[i] + scale[i + 1]), generations - 1);
    }

    // From the middle of a piece, not from its corner: a T.
    void branch(Chance& chance, Vec2 from, Vec2 to, double scale, int generations) {
        const double side = chance.uniform() < 0.5 ? -1.0 : 1.0, turn = side * chance.between(35.0, 75.0);
        const double length = work_.value("length") * scale * chance.between(0.25, 0.5);
        if (length < 2.0 * step_ || scale < 0.15) return;
        const Vec2 way = unit_of(to - from), rotation = steady::direction(turn / kFullTurn);
        const Vec2 first{way.x * rotation.x - way.y * rotation.y, way.x * rotation.y + way.y * rotation.x};
        std::vector<Vec2> points = wandered(chance, {0.0, 0.0}, 0.0, length);
        // The walk is drawn along x and laid along `first`.
        for (Vec2& p : points) p = lerp(from, to, 0.5) + first * p.x + normal_of(first) * p.y;
        std::vector<double> scales;
        for (std::size_t i = 0; i < points.size(); ++i) scales.push_back(0.8 * scale * (1.0 - double(i) / double(points.size() - 1)));
        add(chance, points, scales, generations);
    }

    static Vec2 unit_of(Vec2 a) { return a * (1.0 / steady::distance(a)); }

    Work& work_;
    std::uint32_t profile_;
    double step_, wander_, branching_;
};

}  // namespace

Status make_cracks(Work& work) {
    const auto profile = work.add_section(work.value("width"), -work.value("depth"));
    if (!profile) return profile.error();
    CrackGrower grower(work, *profile);
    const Vec2 size = work.pattern.size;
    for (int i = 0; i < work.count("count"); ++i) {
        Chance chance(work.spec.seed, std::uint64_t(i));
        const Vec2 at{size.x * chance.uniform(), size.y * chance.uniform()};
        const double heading = kFullTurn * chance.uniform(), length = work.value("length") * chance.between(0.6, 1.0);
        if (chance.uniform() < work.worn_at(at)) grower.grow_trunk(chance, at, heading, length);
        if (double(work.pattern.paths.size()) > kMostPaths)
            return refuse(work, "more than 200000 cracks and branches; a smaller count, branching or number of generations works");
    }
    return Done{};
}

}  // namespace burin::generating
