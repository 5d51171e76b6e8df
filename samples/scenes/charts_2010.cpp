// Bodies whose texture coordinates are cut into six charts: grooves run on over the cuts.
#include <cmath>

#include "build.hpp"
#include "scenes_2010.hpp"

namespace burin::scenes {
namespace {

constexpr double kSide = 0.1;                  // metres of a face
constexpr double kGutter = 0.05;               // between charts, part of a face
constexpr double kPitch = kSide * (1 + kGutter);

// Middle of the chart of face i, of an atlas of three by two.
Vec2 middle_of(std::size_t i) { return {(double(i % 3) + 0.5) * kPitch, (double(i / 3) + 0.5) * kPitch}; }

// On every face grooves that meet those of its neighbours however they are turned, a coin in the middle and a lozenge around.
Pattern six_faces() {
    Pattern p = sheet({3 * kPitch, 2 * kPitch}, 0.0040, 0.0, Wrap::clamp);
    p.profiles = {trough(0.0040, 0.0016, 0.0030), vee(0.0022, 0.0016)};
    constexpr double kReach = 0.51 * kSide;  // somewhat into the gutter, so that nothing ends on an edge
    for (std::size_t i = 0; i < 6; ++i) {
        const Vec2 m = middle_of(i);
        for (const double at : {-0.3 * kSide, 0.3 * kSide}) {
            p.paths.push_back(Stroke(m + Vec2{at, -kReach}).line(m + Vec2{at, kReach}).path(0));
            p.paths.push_back(Stroke(m + Vec2{-kReach, at}).line(m + Vec2{kReach, at}).path(0));
        }
        const double r = 0.5 * kSide;
        p.paths.push_back(polygon({m + Vec2{-0.44 * r, 0}, m + Vec2{0, -0.44 * r}, m + Vec2{0.44 * r, 0}, m + Vec2{0, 0.44 * r}}).path(1));
    }
    return p;
}

struct Face {
    std::array<double, 3> x, y, normal;
};

Face face(std::size_t i) {
    Face f{};
    const std::size_t axis = i / 2;
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    f.normal[axis] = sign;
    f.x[(axis + 1) % 3] = 1.0;
    f.y[(axis + 2) % 3] = -sign;  // x right and y down as seen from outside
    return f;
}

// Six sheets of pieces x pieces, each turned by quarters in its chart; `place` leads from coordinates on a face, -1 to 1, to its points.
Mesh six_sheets(int pieces, SurfacePoint3 (*place)(const Face&, double x, double y)) {
    Mesh mesh;
    for (std::size_t i = 0; i < 6; ++i) {
        Mesh sheet = make_sheet(pieces, pieces, [&](double u, double v) { return place(face(i), 2 * u - 1, 2 * v - 1); });
        const double c = std::cos(0.5 * kPi * double(i)), s = std::sin(0.5 * kPi * double(i));
        for (std::size_t k = 0; k < sheet.uvs.size(); k += 2) {
            const Vec2 at{double(sheet.uvs[k]) - 0.5, double(sheet.uvs[k + 1]) - 0.5}, m = middle_of(i);
            sheet.uvs[k] = float((m.x + kSide * (c * at.x - s * at.y)) / (3 * kPitch));
            sheet.uvs[k + 1] = float((m.y + kSide * (s * at.x + c * at.y)) / (2 * kPitch));
        }
        append(mesh, sheet);
    }
    return mesh;
}

std::array<double, 3> combined(const Face& f, double x, double y) {
    std::array<double, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = f.x[k] * x + f.y[k] * y + f.normal[k];
    return p;
}

Scene carved(const char* name, Mesh mesh, std::array<float, 3> color) {
    Scene scene;
    scene.flat = false;
    scene.parts.push_back({name, six_faces(), std::move(mesh), color, 0.0f, 0.4f});
    scene.view.azimuth = 35.0;
    scene.view.elevation = 32.0;
    return scene;
}

}  // namespace

Scene make_carved_cube() {
    return carved("cube", six_sheets(1, [](const Face& f, double x, double y) {
                      std::array<double, 3> p = combined(f, x, y);
                      for (double& v : p) v *= 0.5 * kSide;
                      return SurfacePoint3{p, f.normal};
                  }), {0.62f, 0.50f, 0.34f});
}

Scene make_carved_ball() {
    // Equal angles, so that a face is about as large as its chart.
    return carved("ball", six_sheets(24, [](const Face& f, double x, double y) {
                      std::array<double, 3> n = combined(f, std::tan(0.25 * kPi * x), std::tan(0.25 * kPi * y));
                      const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
                      for (double& v : n) v /= length;
                      constexpr double kRadius = kSide * 2.0 / kPi;
                      // Edges of neighbouring sheets close exactly.
                      const auto at = [&](std::size_t k) { return std::round(n[k] * kRadius * 1e7) * 1e-7; };
                      return SurfacePoint3{{at(0), at(1), at(2)}, n};
                  }), {0.40f, 0.52f, 0.60f});
}

}  // namespace burin::scenes
