// What the generators share; one source file each for kinds that are alike.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <burin/generate.hpp>
#include <burin/profiles.hpp>

#include "chance.hpp"

namespace burin::generating {

// A spec with all parameters, checked, and the pattern that grows: size and wrap stand, depth follows from the paths at the end.
struct Work {
    const GenerateSpec& spec;
    ParameterValues values;
    ProfileSpec profile;
    Pattern pattern;

    double value(const char* name) const { return values.at(name); }
    int count(const char* name) const { return static_cast<int>(values.at(name)); }
    bool repeats() const { return pattern.wrap == Wrap::repeat; }
    double area() const { return pattern.size.x * pattern.size.y; }
    // How worn the surface is at p, [0, 1].
    double worn_at(Vec2 p) const;
    // Index of a new profile of the pattern, by the spec's name.
    Result<std::uint32_t> add_section(double width, double height);
    Result<std::uint32_t> add_step(double width, double height);
    // Noise that swells and narrows what carries it; none where amplitude is 0.
    std::uint32_t add_noise(double width, double height, double wavelength);
};

using Generator = Status (*)(Work&);
Status make_scratches(Work& work);
Status make_cracks(Work& work);
Status make_hatch(Work& work);
Status make_knurl(Work& work);
Status make_weave(Work& work);
Status make_tiles(Work& work);
Status make_bricks(Work& work);
Status make_vinyl(Work& work);
Status make_chainmail(Work& work);

Error refuse(const Work& work, const std::string& what);

inline Element straight(Vec2 from, Vec2 to) {
    Element element;
    element.p0 = from;
    element.p2 = to;
    return element;
}
inline Element bent(Vec2 from, Vec2 control, Vec2 to) {
    Element element = straight(from, to);
    element.kind = ElementKind::quadratic;
    element.p1 = control;
    return element;
}
// Width and height scales together, from one end to the other.
inline Element scaled(Element element, double start, double end) {
    element.width0 = element.height0 = start;
    element.width1 = element.height1 = end;
    return element;
}

inline constexpr double kFullTurn = 360.0;  // degrees

}  // namespace burin::generating
