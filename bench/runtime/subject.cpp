#include "subject.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <burin/model.hpp>
#include <write_scene.hpp>

namespace burin::bench {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

using Vec3 = std::array<double, 3>;
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3 unit(const Vec3& a) {
    const double l = std::hypot(a[0], a[1], a[2]);
    return {a[0] / l, a[1] / l, a[2] / l};
}

double mean_width(const ResolvedPattern& pattern) {
    double sum = 0.0, weight = 0.0;
    for (const ResolvedElement& e : pattern.elements) {
        double low = 0.0, high = 0.0;
        for (const ProfilePoint& point : pattern.profiles[pattern.styles[e.style].profile].points) {
            low = std::min(low, point.b);
            high = std::max(high, point.b);
        }
        const double chord = length(e.element.p2 - e.element.p0);
        sum += chord * (high - low) * 0.5 * (e.element.width0 + e.element.width1);
        weight += chord;
    }
    return weight > 0.0 ? sum / weight : 0.1 * pattern.size.x;
}

Vec2 focus_of(const ResolvedPattern& pattern) {
    const Vec2 middle = pattern.size * 0.5;
    std::vector<Vec2> places;
    for (const Junction& junction : pattern.junctions) places.push_back(junction.position);
    if (places.empty())
        for (const ResolvedElement& e : pattern.elements) places.push_back(lerp(e.element.p0, e.element.p2, 0.5));
    const auto nearer = [&](Vec2 a, Vec2 b) { return length(a - middle) < length(b - middle); };
    return places.empty() ? middle : *std::min_element(places.begin(), places.end(), nearer);
}

}  // namespace

Result<Subject> prepare_subject(const scenes::SceneEntry& entry, std::size_t part, const GridOptions& grid) {
    return prepare_subject(entry.name, entry.make(), part, grid);
}

Result<Subject> prepare_subject(const std::string& name, scenes::Scene scene, std::size_t part, const GridOptions& grid) {
    Subject subject;
    subject.scene = std::move(scene);
    subject.index = part;
    subject.name = subject.scene.parts.size() > 1 ? name + ": " + subject.part().name : name;
    auto prepared = testing::prepare_pattern(subject.part().pattern, grid);
    if (!prepared) return prepared.error();
    subject.prepared = std::move(*prepared);
    subject.width = mean_width(subject.prepared.resolved);
    subject.focus = focus_of(subject.prepared.resolved);
    return subject;
}

Result<OpenedScene> open_scene(const scenes::Scene& scene) {
    const auto file = scenes::write_scene(scene);
    if (!file) return file.error();
    auto asset = read_asset(file->bytes);
    if (!asset) return asset.error();
    OpenedScene opened{std::move(*asset), {}};
    RenderOptions& options = opened.options;
    const scenes::View& view = scene.view;
    options.camera.azimuth = view.azimuth;
    options.camera.elevation = view.elevation;
    options.camera.zoom = view.zoom;
    options.camera.center = view.center;
    if (view.stand) {
        options.camera.eye = view.stand->eye;
        options.camera.target = view.stand->target;
        options.camera.field_of_view = view.stand->field_of_view;
    }
    options.light.azimuth = view.light_azimuth;
    options.light.elevation = view.light_elevation;
    if (view.room) options.environment = Environment{};
    return opened;
}

std::vector<PlaneView> standard_views(const Subject& subject, int width, int height) {
    struct Row {
        const char* name;
        double pixels_per_width, elevation;
    };
    constexpr Row kRows[] = {{"near", 40.0, 60.0}, {"middle", 8.0, 50.0}, {"far", 1.5, 50.0},
                             {"far away", 0.3, 50.0}, {"60 degrees", 6.0, 30.0}, {"80 degrees", 6.0, 10.0}};
    const scenes::View& wanted = subject.scene.view;
    std::vector<PlaneView> views;
    for (const Row& row : kRows) {
        PlaneView view;
        view.name = row.name;
        view.width = width;
        view.height = height;
        view.focus = subject.focus;
        view.azimuth = wanted.azimuth;
        view.elevation = row.elevation;
        view.pixel = subject.width / row.pixels_per_width;
        view.light.azimuth = wanted.light_azimuth;
        view.light.elevation = wanted.light_elevation;
        views.push_back(view);
    }
    return views;
}

PlaneCamera camera_of(const PlaneView& view, Vec2 size) {
    const double a = view.azimuth * kDegree, e = view.elevation * kDegree;
    const Vec3 towards = {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
    PlaneCamera camera;
    camera.tangent = std::tan(view.field_of_view * kDegree * 0.5);
    camera.aspect = double(view.width) / view.height;
    const double distance = view.pixel * view.height * 0.5 / camera.tangent;
    camera.target = {view.focus.x - size.x * 0.5, 0.0, view.focus.y - size.y * 0.5};
    for (std::size_t i = 0; i < 3; ++i) camera.eye[i] = camera.target[i] + towards[i] * distance;
    camera.forward = {-towards[0], -towards[1], -towards[2]};
    const Vec3 up = std::abs(towards[1]) > 0.999 ? Vec3{0, 0, -1} : Vec3{0, 1, 0};
    camera.right = unit(cross(camera.forward, up));
    camera.up = cross(camera.right, camera.forward);
    return camera;
}

Extent extent_of(const PlaneView& view, const ResolvedPattern& pattern, double most_tiles) {
    if (pattern.wrap == Wrap::clamp) return {{0, 0}, {1, 1}};
    const PlaneCamera camera = camera_of(view, pattern.size);
    Extent extent{{0, 0}, {1, 1}};
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) {
            Vec3 way;
            for (std::size_t i = 0; i < 3; ++i)
                way[i] = camera.forward[i] + camera.tangent * (x * camera.aspect * camera.right[i] + y * camera.up[i]);
            const double t = way[1] < 0.0 ? camera.eye[1] / -way[1] : 1e9;
            const double u = (camera.eye[0] + way[0] * t) / pattern.size.x + 0.5,
                         v = (camera.eye[2] + way[2] * t) / pattern.size.y + 0.5;
            extent.low = {std::min(extent.low.x, std::floor(u)), std::min(extent.low.y, std::floor(v))};
            extent.high = {std::max(extent.high.x, std::ceil(u)), std::max(extent.high.y, std::ceil(v))};
        }
    extent.low = {std::max(extent.low.x, -most_tiles), std::max(extent.low.y, -most_tiles)};
    extent.high = {std::min(extent.high.x, most_tiles), std::min(extent.high.y, most_tiles)};
    return extent;
}

Asset asset_of(const Subject& subject, const Extent& extent) {
    const Vec2 size = subject.prepared.resolved.size;
    Primitive plane;
    for (const double v : {extent.low.y, extent.high.y})
        for (const double u : {extent.low.x, extent.high.x}) {
            for (const double x : {(u - 0.5) * size.x, 0.0, (v - 0.5) * size.y}) plane.positions.push_back(float(x));
            plane.normals.insert(plane.normals.end(), {0.0f, 1.0f, 0.0f});
            plane.uvs.insert(plane.uvs.end(), {float(u), float(v)});
        }
    plane.indices = {0, 2, 1, 1, 2, 3};
    MaterialInfo material = scenes::material_of(subject.part());
    testing::put_pattern(subject.prepared, material);
    Asset asset;
    asset.primitives.push_back(std::move(plane));
    asset.materials.push_back(std::move(material));
    return asset;
}

RenderOptions options_of(const PlaneView& view, Vec2 size) {
    const PlaneCamera camera = camera_of(view, size);
    RenderOptions options;
    options.width = view.width;
    options.height = view.height;
    options.camera.field_of_view = view.field_of_view;
    options.camera.eye = camera.eye;
    options.camera.target = camera.target;
    options.light = view.light;
    return options;
}

}  // namespace burin::bench
