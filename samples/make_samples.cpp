// Writes burin's own samples: patterns authored as vectors, as a height map and as scenes in glTF.
//
//     make_samples FOLDER            writes FOLDER/plate.png, 512 x 512, 16 bits, rasterized by the library's evaluator
//     make_samples FOLDER scenes     writes FOLDER/NAME.glb for every scene of scenes/
//     make_samples FOLDER NAME       writes this one
//     make_samples FOLDER NAME FILE  writes this one's first pattern on the only material of another model (.gltf, .glb, .obj)
//
// The plate has one of everything a pattern is made of: lines, arcs, a mitred zigzag, crossings, T-junctions, isolated
// ends, and letters as plateaus with holes.
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <burin/image_io.hpp>
#include <burin/rasterize.hpp>
#include <burin/resolve.hpp>

#include "write_scene.hpp"

namespace {

using burin::Element;
using burin::ElementKind;
using burin::Path;
using burin::Pattern;
using burin::Vec2;

constexpr double kSide = 0.2;  // metres; paths below are drawn in a unit square and scaled by this

// Draws one path in the unit square, y down.
class Pen {
  public:
    explicit Pen(Vec2 start) : first_(start), at_(start) {}

    Pen& line(Vec2 to) {
        path_.elements.push_back({.kind = ElementKind::line, .p0 = at_ * kSide, .p1 = {}, .p2 = to * kSide});
        at_ = to;
        return *this;
    }
    Pen& curve(Vec2 control, Vec2 to) {
        path_.elements.push_back(
            {.kind = ElementKind::quadratic, .p0 = at_ * kSide, .p1 = control * kSide, .p2 = to * kSide});
        at_ = to;
        return *this;
    }
    // A circular arc as quadratics of at most an eighth of a turn: the radius is kept within 1 in 3000.
    Pen& arc(Vec2 centre, double turn) {
        const int parts = static_cast<int>(std::ceil(std::abs(turn) / (std::numbers::pi / 4) - 1e-9));
        const double half = turn / parts / 2.0;
        for (int i = 0; i < parts; ++i) {
            const Vec2 spoke = at_ - centre;
            const auto turned = [&](double angle, double scale) {
                return centre + Vec2{spoke.x * std::cos(angle) - spoke.y * std::sin(angle),
                                     spoke.x * std::sin(angle) + spoke.y * std::cos(angle)} * scale;
            };
            curve(turned(half, 1.0 / std::cos(half)), turned(2.0 * half, 1.0));
        }
        return *this;
    }
    Path done(std::uint32_t profile) {
        path_.profile = profile;
        return path_;
    }
    Path closed(std::uint32_t profile) {
        path_.elements.back().p2 = first_ * kSide;
        path_.closed = true;
        return done(profile);
    }

  private:
    Path path_;
    Vec2 first_, at_;
};

constexpr std::uint32_t kVee = 0, kTrough = 1, kLetter = 2;

// Sections in metres on the plate of kSide: a V groove, a flat-bottomed groove, and a plateau's bevelled edge.
std::vector<burin::Profile> make_profiles() {
    return {{{{-0.0014, 0.0}, {0.0, -0.0012}, {0.0014, 0.0}}, {}},
            {{{-0.0022, 0.0}, {-0.0012, -0.0016}, {0.0012, -0.0016}, {0.0022, 0.0}}, {}},
            {{{-0.0006, 0.0}, {0.0006, 0.0012}}, {}}};
}

void add_frame(Pattern& pattern) {
    const double low = 0.05, high = 0.95, r = 0.06;
    const double quarter = std::numbers::pi / 2;
    pattern.paths.push_back(Pen({low + r, low})
                                .line({high - r, low}).arc({high - r, low + r}, quarter)
                                .line({high, high - r}).arc({high - r, high - r}, quarter)
                                .line({low + r, high}).arc({low + r, high - r}, quarter)
                                .line({low, low + r}).arc({low + r, low + r}, quarter)
                                .closed(kTrough));
}

void add_compass(Pattern& pattern) {
    const Vec2 centre{0.5, 0.23};
    pattern.paths.push_back(Pen(centre + Vec2{0.12, 0.0}).arc(centre, 2.0 * std::numbers::pi).closed(kTrough));
    pattern.paths.push_back(Pen({0.05, 0.23}).line({0.95, 0.23}).done(kVee));
    pattern.paths.push_back(Pen({0.5, 0.05}).line({0.5, 0.31}).done(kVee));
    for (double x : {0.14, 0.20, 0.26})
        pattern.paths.push_back(Pen({x, 0.23}).line({x + 0.05, 0.12}).done(kVee));
    pattern.paths.push_back(Pen({0.70, 0.31}).curve({0.78, 0.08}, {0.89, 0.30}).done(kTrough));
}

void add_zigzag(Pattern& pattern) {
    pattern.paths.push_back(Pen({0.05, 0.80}).line({0.16, 0.80}).line({0.24, 0.70}).line({0.32, 0.88})
                                .line({0.40, 0.72}).line({0.46, 0.80}).curve({0.52, 0.88}, {0.60, 0.80})
                                .curve({0.68, 0.72}, {0.74, 0.80}).line({0.95, 0.80}).done(kTrough));
    pattern.paths.push_back(Pen({0.56, 0.90}).curve({0.80, 0.90}, {0.88, 0.68}).done(kVee));
    pattern.paths.push_back(Pen({0.10, 0.88}).line({0.21, 0.88}).line({0.21, 0.95}).done(kVee));
}

// Letters run clockwise on screen outside and anticlockwise inside, so that the plateau lies on the right.
Path polygon(const std::vector<Vec2>& points) {
    Pen pen(points.front());
    for (std::size_t i = 1; i < points.size(); ++i) pen.line(points[i]);
    pen.line(points.front());
    return pen.closed(kLetter);
}

void add_letters(Pattern& pattern) {
    const double top = 0.41, bottom = 0.62, stem = 0.035, half = std::numbers::pi;
    auto& paths = pattern.paths;
    // B: two bowls, two holes.
    const double middle = (top + bottom) / 2, radius = (bottom - top) / 4, x = 0.14;
    paths.push_back(Pen({x, top}).line({x + 0.06, top}).arc({x + 0.06, top + radius}, half)
                        .arc({x + 0.06, bottom - radius}, half).line({x, bottom}).line({x, top}).closed(kLetter));
    for (double y : {top + radius, bottom - radius}) {
        const double r = radius - 0.026;
        paths.push_back(Pen({x + stem, y - r}).line({x + stem, y + r}).line({x + 0.06, y + r})
                            .arc({x + 0.06, y}, -half).line({x + stem, y - r}).closed(kLetter));
    }
    // U: one bend outside, one inside.
    const double u = 0.29, w = 0.12;
    paths.push_back(Pen({u, top}).line({u + stem, top}).line({u + stem, bottom - w / 2})
                        .arc({u + w / 2, bottom - w / 2}, -half).line({u + w - stem, top}).line({u + w, top})
                        .line({u + w, bottom - w / 2}).arc({u + w / 2, bottom - w / 2}, half).line({u, top})
                        .closed(kLetter));
    // R: a bowl with a hole, and a leg.
    const double r = 0.45;
    paths.push_back(Pen({r, top}).line({r + 0.06, top}).arc({r + 0.06, top + radius}, half)
                        .line({r + 0.115, bottom}).line({r + 0.078, bottom}).line({r + stem, middle + 0.012})
                        .line({r + stem, bottom}).line({r, bottom}).line({r, top}).closed(kLetter));
    paths.push_back(Pen({r + stem, top + 0.026}).line({r + stem, middle - 0.026}).line({r + 0.06, middle - 0.026})
                        .arc({r + 0.06, top + radius}, -half).line({r + stem, top + 0.026}).closed(kLetter));
    // I and N.
    paths.push_back(polygon({{0.605, top}, {0.64, top}, {0.64, bottom}, {0.605, bottom}}));
    const double n = 0.68;
    paths.push_back(polygon({{n, top}, {n + stem, top}, {n + 0.145, middle + 0.04}, {n + 0.145, top},
                             {n + 0.18, top}, {n + 0.18, bottom}, {n + 0.145, bottom}, {n + stem, middle - 0.04},
                             {n + stem, bottom}, {n, bottom}}));
}

Pattern make_plate() {
    Pattern pattern;
    pattern.size = {kSide, kSide};
    pattern.depth = 0.0032;
    pattern.base_offset = 0.0014;  // the letters stay a little below the object surface
    pattern.wrap = burin::Wrap::clamp;
    pattern.profiles = make_profiles();
    add_frame(pattern);
    add_compass(pattern);
    add_letters(pattern);
    add_zigzag(pattern);
    return pattern;
}

int report(const std::string& message) {
    std::fprintf(stderr, "make_samples: error: %s\n", message.c_str());
    return 1;
}

int write_plate(const std::string& folder) {
    const auto resolved = burin::resolve_pattern(make_plate());
    if (!resolved) return report(resolved.error().message);
    const burin::Image map = burin::rasterize_height(*resolved, 512, 512, {.samples = 8});
    const auto written = burin::write_height(folder + "/plate.png", map);
    return written ? 0 : report(written.error().message);
}

// One line: name, source, elements, bytes of textures and file, and the options with which `burin render` shows it.
void print_scene(const burin::scenes::SceneEntry& entry, const burin::scenes::Scene& scene, const burin::scenes::SceneFile& file) {
    const burin::scenes::View& view = scene.view;
    std::printf("%s; %s; %zu; %zu; %zu;", entry.name, entry.source, file.elements, file.texture_bytes, file.bytes.size());
    if (view.stand) {
        const auto& [eye, target, field_of_view] = *view.stand;
        std::printf(" --eye %g,%g,%g --target %g,%g,%g --fov %g", eye[0], eye[1], eye[2], target[0], target[1], target[2], field_of_view);
    } else {
        std::printf(" --azimuth %g --elevation %g --zoom %g", view.azimuth, view.elevation, view.zoom);
    }
    std::printf(" --light %g,%g", view.light_azimuth, view.light_elevation);
    if (view.room) std::printf(" --environment room");
    if (view.center) std::printf(" --center %g,%g", view.center->x, view.center->y);
    std::printf("\n");
}

// `name`: one of the table, or "scenes" for all of them.
int write_scenes(const std::string& folder, const std::string& name) {
    bool any = false;
    for (const burin::scenes::SceneEntry& entry : burin::scenes::scene_table()) {
        if (name != "scenes" && name != entry.name) continue;
        any = true;
        const burin::scenes::Scene scene = entry.make();
        const auto file = burin::scenes::write_scene(scene);
        if (!file) return report(entry.name + (": " + file.error().message));
        const std::string path = folder + "/" + entry.name + ".glb";
        if (const auto written = burin::write_file(path, file->bytes); !written) return report(written.error().message);
        print_scene(entry, scene, *file);
    }
    return any ? 0 : report("no scene is called '" + name + "'");
}

int write_scene_on_model(const std::string& folder, const std::string& name, const std::string& path) {
    const burin::scenes::SceneEntry* entry = burin::scenes::find_scene(name);
    if (entry == nullptr) return report("no scene is called '" + name + "'");
    const auto model = burin::read_model(path);
    if (!model) return report(path + ": " + model.error().message);
    const auto file = burin::scenes::write_scene_on(entry->make(), *model);
    if (!file) return report(name + " on " + path + ": " + file.error().message);
    const auto written = burin::write_file(folder + "/" + name + ".glb", file->bytes);
    return written ? 0 : report(written.error().message);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2) return write_plate(argv[1]);
    if (argc == 3) return write_scenes(argv[1], argv[2]);
    if (argc == 4) return write_scene_on_model(argv[1], argv[2], argv[3]);
    return report("usage: make_samples FOLDER [scenes | NAME [MODEL]]");
}
