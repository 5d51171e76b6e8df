#include "gl/camera.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace burin {

glm::dvec3 vertex(const std::vector<float>& values, std::uint32_t i) {
    return {double(values[3 * i]), double(values[3 * i + 1]), double(values[3 * i + 2])};
}

glm::dvec3 direction_of(double azimuth, double elevation) {
    const double a = glm::radians(azimuth), e = glm::radians(elevation);
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

namespace {

struct Bounds {
    glm::dvec3 low{1e300}, high{-1e300};
    glm::dvec3 middle() const { return (low + high) * 0.5; }
    double radius() const { return glm::length(high - low) * 0.5; }
};

Bounds bounds_of(const Asset& asset) {
    Bounds box;
    for (const Primitive& primitive : asset.primitives) {
        for (std::uint32_t i : primitive.indices) {
            const glm::dvec3 p = vertex(primitive.positions, i);
            box.low = glm::min(box.low, p);
            box.high = glm::max(box.high, p);
        }
    }
    return box;
}

// World point of a triangle at a point of the uv plane.
std::optional<glm::dvec3> point_at(const Primitive& primitive, std::size_t first, Vec2 uv) {
    glm::dvec3 corner[3];
    Vec2 at[3];
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t i = primitive.indices[first + k];
        corner[k] = vertex(primitive.positions, i);
        at[k] = {double(primitive.uvs[2 * i]), double(primitive.uvs[2 * i + 1])};
    }
    const double area = cross(at[1] - at[0], at[2] - at[0]);
    if (area == 0.0) return std::nullopt;
    const double b = cross(uv - at[0], at[2] - at[0]) / area;
    const double c = cross(at[1] - at[0], uv - at[0]) / area;
    if (b < -1e-9 || c < -1e-9 || b + c > 1.0 + 1e-9) return std::nullopt;
    return corner[0] + b * (corner[1] - corner[0]) + c * (corner[2] - corner[0]);
}

glm::dvec3 target_of(const Asset& asset, const Camera& camera, const Bounds& box) {
    if (camera.target) return {(*camera.target)[0], (*camera.target)[1], (*camera.target)[2]};
    if (camera.center) {
        for (const Primitive& primitive : asset.primitives) {
            if (!asset.materials[std::size_t(primitive.material)].has_detail) continue;
            for (std::size_t first = 0; first + 2 < primitive.indices.size(); first += 3)
                if (auto point = point_at(primitive, first, *camera.center)) return *point;
        }
    }
    return box.middle();
}

// Half the picture's height, at distance 1 from the eye, that shows every vertex.
double half_height_for(const Asset& asset, const View& view, bool orthographic, double aspect) {
    double half = 1e-9;
    for (const Primitive& primitive : asset.primitives) {
        for (std::uint32_t i : primitive.indices) {
            const glm::dvec3 p = view.to_view * glm::dvec4(vertex(primitive.positions, i), 1.0);
            const double distance = orthographic ? 1.0 : std::max(-p.z, 1e-9);
            half = std::max({half, std::abs(p.y) / distance, std::abs(p.x) / (aspect * distance)});
        }
    }
    return half * 1.03;
}

// Distance along the line of sight at which the asset just fits the angle of view.
double distance_for(const Asset& asset, const View& view, glm::dvec3 target, double tangent, double aspect) {
    const glm::dvec3 right = glm::normalize(glm::cross(view.direction, view.up));
    const glm::dvec3 top = glm::cross(right, view.direction);
    double distance = 1e-6;
    for (const Primitive& primitive : asset.primitives) {
        for (std::uint32_t i : primitive.indices) {
            const glm::dvec3 q = vertex(primitive.positions, i) - target;
            const double sideways =
                std::max(std::abs(glm::dot(q, top)), std::abs(glm::dot(q, right)) / aspect);
            distance = std::max(distance, sideways * 1.03 / tangent - glm::dot(q, view.direction));
        }
    }
    return distance;
}

}  // namespace

View place_camera(const Asset& asset, const RenderOptions& options) {
    const Camera& camera = options.camera;
    const Bounds box = bounds_of(asset);
    const glm::dvec3 target = target_of(asset, camera, box);
    const double aspect = double(options.width) / options.height;
    const double radius = std::max(box.radius(), 1e-9);
    View view;
    view.direction = -direction_of(camera.azimuth, camera.elevation);
    const double a = glm::radians(camera.azimuth);
    // Straight above, up is away from where the camera would stand in front.
    view.up =
        std::abs(camera.elevation) > 89.9 ? glm::dvec3(-std::sin(a), 0.0, -std::cos(a)) : glm::dvec3(0, 1, 0);
    const double tangent = std::tan(glm::radians(camera.field_of_view) * 0.5);
    view.half_height = tangent;
    if (camera.eye) {
        view.eye = {(*camera.eye)[0], (*camera.eye)[1], (*camera.eye)[2]};
        view.direction = glm::normalize(target - view.eye);
        view.up = std::abs(view.direction.y) > 0.999 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
    } else if (camera.orthographic) {
        view.eye = target - view.direction * (radius * 4.0);
    } else {
        view.eye = target - view.direction * distance_for(asset, view, target, tangent, aspect);
    }
    view.to_view = glm::lookAt(view.eye, view.eye + view.direction, view.up);
    if (camera.orthographic) view.half_height = half_height_for(asset, view, true, aspect);
    if (!camera.eye) view.half_height /= camera.zoom;
    const double depth_middle = glm::dot(box.middle() - view.eye, view.direction);
    view.far = std::max(depth_middle + radius * 1.1, radius * 1e-3);
    view.near = std::max(depth_middle - radius * 1.1, camera.orthographic ? -1e30 : view.far * 1e-4);
    return view;
}

glm::dmat4 projection(const View& view, const RenderOptions& options, double x, double y) {
    const double h = view.half_height, w = h * options.width / options.height;
    glm::dmat4 clip;
    if (options.camera.orthographic)
        clip = glm::ortho(-w, w, -h, h, view.near, view.far);
    else
        clip =
            glm::frustum(-w * view.near, w * view.near, -h * view.near, h * view.near, view.near, view.far);
    const glm::dvec3 shift(2.0 * x / options.width, 2.0 * y / options.height, 0.0);
    return glm::translate(glm::dmat4(1.0), shift) * clip * view.to_view;
}

float to_linear(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }

Status check_render(const Asset& asset, const RenderOptions& options) {
    const Camera& camera = options.camera;
    if (options.width < 1 || options.height < 1 || options.width > 8192 || options.height > 8192)
        return Error{ErrorCode::invalid_argument, "a picture's sides must be 1 to 8192 pixels"};
    if (options.samples < 1 || options.samples > 256)
        return Error{ErrorCode::invalid_argument, "samples per pixel must be 1 to 256"};
    if (options.rays < 4 || options.rays > 64)
        return Error{ErrorCode::invalid_argument, "rays per sample must be 4 to 64"};
    if (!(camera.zoom > 0.0) || !(camera.field_of_view > 0.0) || camera.field_of_view > 120.0)
        return Error{ErrorCode::invalid_argument,
                     "zoom must be above 0, the angle of view above 0 and at most 120 degrees"};
    if (options.environment && !(options.environment->strength >= 0.0 && std::isfinite(options.environment->strength)))
        return Error{ErrorCode::invalid_argument, "the strength of an environment must be 0 or more"};
    for (const Primitive& primitive : asset.primitives)
        if (!primitive.indices.empty()) return Done{};
    return Error{ErrorCode::invalid_input, "the asset has no triangle to draw"};
}

}  // namespace burin
