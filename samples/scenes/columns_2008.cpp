// Columns with hieroglyphs on a paved floor.
#include <cmath>

#include "build.hpp"
#include "scenes_2008.hpp"

namespace burin::scenes {
namespace {

constexpr double kRadius = 0.16, kHigh = 1.2;
constexpr std::uint32_t kGroove = 0, kBand = 1, kContour = 2;  // profiles
constexpr std::uint32_t kSwelling = 0, kRipple = 1, kWorn = 2;  // functions along paths

// A stroke of the chisel swells in its middle; water ripples; edges that everyone touched are worn.
std::vector<Perturbation> make_functions() {
    Perturbation swelling, ripple, worn;
    swelling.kind = PerturbationKind::polynomial;
    for (double* scale : {swelling.width_polynomial, swelling.height_polynomial}) scale[0] = 0.55, scale[1] = 1.8, scale[2] = -1.8;
    ripple.kind = PerturbationKind::sine;
    ripple.width = 0.3, ripple.height = 0.2, ripple.wavelength = 0.013;
    worn.kind = PerturbationKind::noise;
    worn.width = 0.35, worn.height = 0.45, worn.wavelength = 0.06, worn.octaves = 3, worn.seed = 1822;
    return {swelling, ripple, worn};
}

// Signs in a box of 1 x 1 around the origin.
struct Scribe {
    Pattern& pattern;
    Vec2 at;
    double scale;

    void add(const Stroke& stroke, std::uint32_t profile, std::uint32_t function) const {
        Path path = mapped(stroke.path(profile), [&](Vec2 q) { return at + q * scale; });
        path.perturbation = function;
        pattern.paths.push_back(std::move(path));
    }
    void cut(const Stroke& stroke) const { add(stroke, kGroove, kNoPerturbation); }
    void chisel(const Stroke& stroke) const { add(stroke, kGroove, kSwelling); }
    // A disc that stands in a sunken ring: two contours, the lower ground on the right of both.
    void disc(double radius, double inner) const {
        add(circle({0.0, 0.0}, radius), kContour, kNoPerturbation);
        add(Stroke({inner, 0.0}).arc({0.0, 0.0}, -2.0 * kPi).close(), kContour, kNoPerturbation);
    }
};

void draw_sign(const Scribe& s, int sign) {
    switch (sign) {
        case 0:  // ankh
            s.chisel(Stroke({0.0, 0.05}).curve({-0.42, -0.25}, {0.0, -0.48}).curve({0.42, -0.25}, {0.0, 0.05}).close());
            s.chisel(polyline({{0.0, 0.14}, {0.0, 0.5}}));
            s.chisel(polyline({{-0.32, 0.14}, {0.32, 0.14}}));
            break;
        case 1:  // water
            for (const double y : {-0.25, 0.0, 0.25})
                s.add(polyline({{-0.45, y}, {-0.3, y - 0.12}, {-0.15, y}, {0.0, y - 0.12}, {0.15, y}, {0.3, y - 0.12}, {0.45, y}}), kGroove, kRipple);
            break;
        case 2:  // sun
            s.disc(0.44, 0.26);
            break;
        case 3:  // eye
            s.chisel(Stroke({-0.45, 0.0}).curve({0.0, -0.42}, {0.45, 0.0}));
            s.chisel(Stroke({-0.45, 0.0}).curve({0.0, 0.30}, {0.45, 0.0}));
            s.cut(circle({0.0, -0.04}, 0.10));
            s.chisel(Stroke({-0.1, 0.16}).curve({-0.12, 0.4}, {-0.34, 0.46}));
            break;
        case 4:  // feather
            s.chisel(Stroke({0.0, 0.5}).line({0.0, -0.1}).curve({0.0, -0.5}, {0.26, -0.46}).curve({0.3, -0.1}, {0.04, 0.2}));
            for (const double y : {-0.25, -0.1, 0.05}) s.chisel(polyline({{0.0, y + 0.1}, {0.2, y - 0.06}}));
            break;
        case 5:  // reed hut
            s.cut(polyline({{-0.4, 0.42}, {-0.4, -0.35}, {0.4, -0.35}, {0.4, 0.42}, {0.1, 0.42}, {0.1, 0.05}}));
            break;
        default:  // bread and basket
            s.chisel(Stroke({-0.4, 0.1}).curve({0.0, 0.75}, {0.4, 0.1}).close());
            s.chisel(Stroke({-0.16, -0.1}).curve({0.0, -0.5}, {0.16, -0.1}).close());
    }
}

Pattern hieroglyphs() {
    const Vec2 size{2.0 * kPi * kRadius, kHigh};
    Pattern p = sheet(size, 0.0145, 0.004);
    p.profiles = {trough(0.0075, 0.003, 0.007), ridge(0.012, 0.006, 0.0035), {{{-0.005, 0}, {0, -0.003}, {0.005, -0.006}}, {}}};
    p.perturbations = make_functions();
    for (const double y : {0.05, 0.09, 1.11, 1.15}) p.paths.push_back(Stroke({0.0, y}).line({size.x, y}).close_across().path(kBand));
    Chance chance(1799);
    constexpr int kColumns = 8, kRows = 8;
    for (int column = 0; column < kColumns; ++column) {
        const double x = size.x * (column + 0.5) / kColumns, edge = size.x * column / kColumns;
        p.paths.push_back(polyline({{edge, 0.135}, {edge, 1.065}}).path(kGroove));
        p.paths.back().perturbation = kWorn;
        for (int row = 0; row < kRows; ++row) {
            const Vec2 at{x, 0.195 + 0.1155 * row};
            draw_sign({p, at, 0.088}, chance.below(7));
        }
    }
    return p;
}

Pattern paving() {
    Pattern p = sheet({0.8, 0.8}, 0.006, 0.0);
    p.profiles = {trough(0.008, 0.004, 0.005)};
    add_courses(p, 2, 2, 0);
    return p;
}

}  // namespace

Scene make_columns() {
    Scene scene;
    scene.flat = false;
    Mesh columns;
    for (const auto& [x, z, turn] : {std::array{-0.62, 0.1, 20.0}, std::array{0.0, -0.35, 140.0}, std::array{0.62, 0.1, 260.0}})
        append(columns, placed(make_column(kRadius * 0.96, kRadius * 1.04, kHigh), turn, {x, kHigh / 2, z}));
    scene.parts.push_back({"columns", hieroglyphs(), std::move(columns), {0.76f, 0.62f, 0.42f}, 0.0f, 0.75f});
    Mesh floor = make_rectangle({2.4, 2.4});
    for (float& value : floor.uvs) value *= 3.0f;
    scene.parts.push_back({"floor", paving(), std::move(floor), {0.55f, 0.50f, 0.44f}, 0.0f, 0.8f});
    scene.parts.front().erosion = 0.10;
    scene.view.elevation = 12.0;
    scene.view.azimuth = 8.0;
    scene.view.zoom = 1.9;
    return scene;
}

}  // namespace burin::scenes
