// Circles: the grooves of a record, and the rings of chainmail.
#include <algorithm>
#include <cmath>

#include "generate_internal.hpp"

namespace burin::generating {
namespace {

constexpr int kPieces = 24;           // quadratics of a turn: within 5e-5 of the radius
constexpr double kMostTurns = 10000;

struct OnCurve {
    Vec2 at, tangent;
};

// Archimedean spiral (a circle where `inwards` is 0) after `turns`; metres by which it comes nearer to the centre with every turn.
OnCurve on_spiral(Vec2 centre, double radius, double inwards, double turns) {
    const Vec2 d = steady::direction(turns);
    const double r = radius - inwards * turns;
    return {centre + d * r, normal_of(d) * r - d * (inwards / 6.283185307179586)};
}

// Where both tangents meet.
Vec2 meeting(const OnCurve& a, const OnCurve& b) { return a.at + a.tangent * (cross(b.at - a.at, b.tangent) / cross(a.tangent, b.tangent)); }

std::vector<Element> spiral(Vec2 centre, double radius, double inwards, double first, double last, int pieces) {
    std::vector<Element> elements;
    OnCurve from = on_spiral(centre, radius, inwards, first);
    for (int i = 1; i <= pieces; ++i) {
        const OnCurve to = on_spiral(centre, radius, inwards, first + (last - first) * i / pieces);
        elements.push_back(bent(from.at, meeting(from, to), to.at));
        from = to;
    }
    return elements;
}

Path circle(Vec2 centre, double radius, double first, int pieces, std::uint32_t profile) {
    Path path;
    path.profile = profile;
    path.closed = true;
    path.elements = spiral(centre, radius, 0.0, first, first + 1.0, pieces);
    path.elements.back().p2 = path.elements.front().p0;
    return path;
}

}  // namespace

Status make_vinyl(Work& work) {
    const Vec2 centre = work.pattern.size * 0.5;
    const double half = std::min(centre.x, centre.y), pitch = work.value("pitch");
    const double outer = work.value("outer") * half, inner = work.value("inner") * half;
    const int turns = int(std::floor((outer - inner) / pitch));
    if (turns < 1) return refuse(work, "between outer and inner there is no room for one groove of pitch " + parameter_text(pitch));
    if (turns > kMostTurns) return refuse(work, "pitch " + parameter_text(pitch) + " gives more than 10000 grooves");
    const auto profile = work.add_section(work.value("width"), -work.value("depth"));
    if (!profile) return profile.error();
    const std::uint32_t noise = work.add_noise(work.value("uneven"), 0.5 * work.value("uneven"), work.value("wavelength"));
    if (work.count("spiral") == 1) {
        Path path;
        path.profile = *profile;
        path.perturbation = noise;
        path.elements = spiral(centre, outer, pitch, 0.0, turns, kPieces * turns);
        work.pattern.paths.push_back(std::move(path));
        return Done{};
    }
    for (int i = 0; i < turns; ++i) {
        // Grooves begin at different angles, or the noise of all would begin alike.
        Chance chance(work.spec.seed, std::uint64_t(i));
        work.pattern.paths.push_back(circle(centre, outer - i * pitch, chance.uniform(), kPieces, *profile));
        work.pattern.paths.back().perturbation = noise;
    }
    return Done{};
}

// Rows of rings that lean to one side and to the other in turn. A ring is high where its neighbour in the next row is low, so that it
// passes over it there, and under it on its other side: they are linked.
Status make_chainmail(Work& work) {
    const int columns = work.count("columns"), rows = 2 * work.count("row_pairs");
    const Vec2 size = work.pattern.size, pitch{size.x / columns, size.y / rows};
    const double wire = work.value("wire") * pitch.x, lean = work.value("lean");
    const double radius = work.value("ring") * pitch.x;
    const auto profile = work.add_section(wire, work.value("height"));
    if (!profile) return profile.error();
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const Vec2 centre{(column + 0.25 + 0.5 * (row % 2)) * pitch.x, (row + 0.5) * pitch.y};
            Path path = circle(centre, radius, 0.0, kPieces, *profile);
            const double side = row % 2 == 0 ? lean : -lean;
            const auto height = [&](std::size_t i) { return 1.0 - lean + side * steady::direction(double(i % kPieces) / kPieces).x; };
            for (std::size_t i = 0; i < path.elements.size(); ++i) path.elements[i].height0 = height(i), path.elements[i].height1 = height(i + 1);
            work.pattern.paths.push_back(std::move(path));
        }
    return Done{};
}

}  // namespace burin::generating
