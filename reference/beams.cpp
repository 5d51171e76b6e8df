#include "beams.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <burin/evaluate.hpp>

#include "gl/camera.hpp"

#include "spread.hpp"

namespace burin::reference {
namespace {

constexpr double kItems = 64.0;   // that a whole pixel's light is worth: what brings less is followed by lot
constexpr double kWholeBeam = 8.0;   // items for which a beam starts from all that is seen of a facet
constexpr double kLeastBeam = 0.15;  // of its width
constexpr double kAside = 1e-3;   // least cosine under which a facet is taken to be seen

// Level beams are tilted, as low views are.
Vec3 leaned(Vec3 d) {
    const double least = std::hypot(d.x, d.y) / kMostSlope;
    if (std::abs(d.z) < least) d.z = d.z < 0.0 ? -least : least;
    return d;
}

// Keeps so many of the items, chosen at even steps of their running sum, each with the same part of it: the sum stays.
template <typename Item, typename Amount, typename Scale>
void thin_out(std::vector<Item>& items, double most, double start, const Amount& amount, const Scale& scale) {
    const double count = std::max(1.0, std::ceil(most));
    if (double(items.size()) <= count) return;
    double sum = 0.0;
    for (const Item& item : items) sum += amount(item);
    const double step = sum / count;
    double next = start * step, at = 0.0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const double own = amount(items[i]);
        int picks = 0;
        for (at += own; next < at; next += step) ++picks;
        if (picks == 0) continue;
        items[kept] = items[i];
        scale(items[kept++], picks * step / own);
    }
    items.resize(kept);
}

double brightness(const glm::dvec3& color) { return (color.x + color.y + color.z) / 3.0; }

// Interpolated normals may turn where no eye is.
glm::dvec3 faced(const glm::dvec3& normal, const Place& place) {
    const double side = place.within ? -1.0 : 1.0, cosine = glm::dot(normal, place.to_eye) * side;
    return cosine >= kAside ? normal : glm::normalize(normal + place.to_eye * (side * (kAside - cosine)));
}

// A point of a convex polygon, by a triangle of its fan.
Vec3 point_of(const Vec3* corners, std::uint32_t count, const Spread& spread) {
    const auto area = [&](std::uint32_t i) {
        const Vec3 n = cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
        return std::sqrt(dot(n, n));
    };
    double whole = 0.0;
    for (std::uint32_t i = 1; i + 1 < count; ++i) whole += area(i);
    std::uint32_t i = 1;
    double at = spread.x(0) * whole;
    for (; i + 2 < count && at > area(i); ++i) at -= area(i);
    const double along = std::sqrt(Spread::fraction(spread.x(1))), across = spread.y(0);
    return corners[0] + (corners[i] + (corners[i + 1] - corners[i]) * across - corners[0]) * along;
}

// All of a footprint.
Share smooth_share(const Place& place, const Footprint& footprint, std::vector<Vec3>& corners) {
    Share share;
    share.element = share.facet = kGround;
    share.normal = {0, 0, 1};
    share.seen = share.lit = 1.0;
    const Vec2 middle = middle_of(footprint);
    share.place = {middle.x, middle.y, place.at.z};
    corners.clear();
    for (const Vec2 p : footprint.corners) corners.push_back({p.x, p.y, place.at.z});
    share.corners = std::uint32_t(corners.size());
    return share;
}

// Makes the part of the facet that is seen the start of a beam; one that few items stand for starts from a part of it, chosen by lot. Its
// middle.
Vec3 set_beam(Level& level, const Share& share, double items, std::uint64_t seed) {
    const Vec3* corners = level.areas.area.corners.data() + share.first_corner;
    const double part = std::clamp(std::sqrt(items / kWholeBeam), kLeastBeam, 1.0);
    Vec3 about = share.place;
    if (part < 1.0) about = point_of(corners, share.corners, Spread(seed));
    level.beam.normal = share.normal;
    level.beam.corners.clear();
    Vec3 middle{};
    for (std::uint32_t k = 0; k < share.corners; ++k) {
        level.beam.corners.push_back(about + (corners[k] - about) * part);
        middle = middle + level.beam.corners[k] * (1.0 / share.corners);
    }
    return middle;
}

}  // namespace

BeamTracer::BeamTracer(const Scene& scene, const ReferenceOptions& options)
    : scene_(scene), options_(options), bodies_(scene.asset()), light_(direction_of(options.view.light.azimuth, options.view.light.elevation)) {
    for (std::size_t c = 0; c < 3; ++c) background_[int(c)] = double(to_linear(options.view.background[c]));
    if (options.view.environment && !options.surround) environment_.emplace(*options.view.environment);
    most_opaque_ = std::size_t(std::max(options.bounces, options.view.environment ? 1 : 0));
    most_ = most_opaque_;
    for (const MaterialInfo& material : scene.asset().materials)
        if (material.transmission > 0.0f) most_ = std::max(most_opaque_, std::size_t(options.passes));
}

std::size_t BeamTracer::most_for(const Paint& paint) const { return paint.is_glass() ? most_ : most_opaque_; }

AreasOptions BeamTracer::areas_of(const Place& place, double width) const {
    AreasOptions areas;
    areas.tolerance = options_.tolerance;
    areas.width = width;
    areas.corners = most_opaque_ > 0 || scene_.material(place).transmission > 0.0f;
    return areas;
}

Slopes BeamTracer::slopes_of(const Place& place) const {
    Place lamp = place;
    lamp.within = false;
    return {place.slope(place.to_eye), lamp.slope(light_), !place.within && place.pattern_direction(light_).z > 0.0};
}

void BeamTracer::find_seen(const Place& place, std::size_t level, double width, BeamWork& work) const {
    Level& own = work.levels[level];
    if (!place.surface)
        own.shares.assign(1, smooth_share(place, own.footprint, own.areas.area.corners));
    else if (place.within)
        find_areas_within(*place.surface, own.footprint, place.slope(place.to_eye), areas_of(place, width), own.areas, own.shares);
    else
        find_areas(*place.surface, own.footprint, slopes_of(place), areas_of(place, width), own.areas, own.shares);
}

glm::dvec3 BeamTracer::color_of(const Place& place, const Path& path, BeamWork& work) const {
    std::vector<Share>& shares = work.levels[path.level].shares;
    glm::dvec3 sum(0.0);
    for (const Share& share : shares) sum += own_light(place, share, path) * share.seen;
    if (most_opaque_ == 0 && !(scene_.material(place).transmission > 0.0f)) return sum;
    thin_out(shares, path.weight * kItems, Spread(++work.seed).turn_x, [](const Share& s) { return s.seen; }, [](Share& s, double by) { s.seen *= by; });
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const Share share = shares[i];
        sum += followed_light(place, share, path, work) * share.seen;
    }
    return sum;
}

// Of the lamp, and what shines by itself.
glm::dvec3 BeamTracer::own_light(const Place& place, const Share& share, const Path& path) const {
    const bool lamp = !place.within && (!place.surface || place.pattern_direction(light_).z > 0.0);
    const double lit = !lamp ? 0.0 : options_.view.shadows ? share.lit / share.seen : 1.0;
    const glm::dvec3 color = facet_color(place, scene_.paint_of(place, share), faced(place.world_normal(share.normal), place), lit);
    if (path.level == 0) return color;
    // A lamp that a matt facet happens to see in a smooth one would be a spark.
    return glm::min(color, glm::dvec3(1.0)) * kept_within(place, share, path);
}

glm::dvec3 BeamTracer::followed_light(const Place& place, const Share& share, const Path& path, BeamWork& work) const {
    const Paint paint = scene_.paint_of(place, share);
    glm::dvec3 color(0.0);
    if (path.level < most_for(paint)) {
        color = light_by_way(place, share, paint, faced(place.world_normal(share.normal), place), path, work);
    } else if (paint.is_glass()) {
        color = light_of_surround(path, -place.to_eye);
        work.cut_off += path.weight * share.seen;
    }
    return color * kept_within(place, share, path);
}

// A facet's own colour, the lit part and the rest mixed as they are seen.
glm::dvec3 BeamTracer::facet_color(const Place& place, const Paint& paint, const glm::dvec3& outward, double lit) const {
    const glm::dvec3 normal = place.within ? -outward : outward;
    const glm::dvec3 lamp = options_.brdf(paint, normal, light_, place.to_eye) * options_.view.light.strength;
    if (follows(paint)) return paint.glow + lamp * lit;
    const glm::dvec3 dark = paint.glow + soft_surround(paint, normal, light_, place.to_eye, options_.view.light.ambient);
    return glm::mix(glm::clamp(dark, 0.0, 1.0), glm::clamp(dark + lamp, 0.0, 1.0), lit);
}

// What a facet gets from others and, past them, from what surrounds it.
glm::dvec3 BeamTracer::light_by_way(const Place& place, const Share& share, const Paint& paint, const glm::dvec3& normal, const Path& path,
                                    BeamWork& work) const {
    Level& own = work.levels[path.level];
    const int directions = paint.is_glass() && path.level > 0 ? 1 : options_.directions;
    own.scattered.clear();
    options_.scatter(paint, normal, place.to_eye, directions, ++work.seed, own.scattered);
    double whole = 0.0;
    for (const Scattered& way : own.scattered) whole += brightness(way.weight);
    if (path.level > 0)
        thin_out(own.scattered, path.weight * share.seen * whole * kItems, Spread(++work.seed).turn_x, [](const Scattered& s) { return brightness(s.weight); },
                 [](Scattered& s, double by) { s.weight *= by; });
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < own.scattered.size(); ++k) {
        const Scattered way = own.scattered[k];
        Path next{path.level + 1, path.weight * share.seen * brightness(way.weight), path.width, path.solid + way.solid, path.through, {}};
        const Vec3 start = set_beam(own, share, next.weight * kItems, ++work.seed);
        own.beam.within = glm::dot(way.direction, normal) < 0.0;
        next.through = path.through || own.beam.within != place.within;
        next.from = place.world(start);
        sum += way.weight * light_along(place, next, way.direction, work);
    }
    return sum;
}

// Of the beam of the level before: what it meets of the relief, and past that.
glm::dvec3 BeamTracer::light_along(const Place& place, const Path& path, const glm::dvec3& direction, BeamWork& work) const {
    Beam& beam = work.levels[path.level - 1].beam;
    Level& own = work.levels[path.level];
    if (!place.surface) return light_from_beyond(place, path, direction, work);
    beam.direction = leaned(place.pattern_direction(direction));
    const double left = find_hits(*place.surface, beam, slopes_of(place), areas_of(place, path.width), own.areas, own.shares);
    glm::dvec3 radiance(0.0);
    if (!own.shares.empty()) {
        Place there = place;
        there.to_eye = -direction;
        there.within = beam.within;
        radiance += color_of(there, path, work);
    }
    if (left > 0.0) {
        Path rest = path;
        rest.weight *= left;
        radiance += left * light_from_beyond(place, rest, direction, work);
    }
    return radiance;
}

// The same of a beam that meets no more of the relief.
glm::dvec3 BeamTracer::light_from_beyond(const Place& place, const Path& path, const glm::dvec3& direction, BeamWork& work) const {
    const Beam& beam = work.levels[path.level - 1].beam;
    const auto hit = bodies_.first_hit(path.from, direction, beam.within);
    Place there;
    if (hit) {
        there = scene_.place_at(*hit, -direction, false, beam.within);
    } else {
        const MaterialInfo& material = scene_.material(place);
        const double fall = -glm::dot(direction, place.normal);
        if (!beam.within || place.is_back || !(material.thickness > 0.0f) || fall < kAside) return light_of_surround(path, direction);
        const double thickness = double(material.thickness) * double(place.primitive->scale);
        there = Scene::smooth_place(*place.primitive, path.from + direction * (thickness / fall), -place.normal, -direction);
        there.within = there.is_back = true;
    }
    Level& own = work.levels[path.level];
    own.footprint.corners.clear();
    for (const Vec3 p : beam.corners) own.footprint.corners.push_back(there.project(place.world(p), direction));
    const double area = area_of(own.footprint);
    if (area < 0.0) std::reverse(own.footprint.corners.begin(), own.footprint.corners.end());
    if (!(std::abs(area) > 1e-24)) return light_of_surround(path, direction);
    find_seen(there, path.level, path.width, work);
    double seen = 0.0;
    for (const Share& share : own.shares) seen += share.seen;
    if (!(seen > 0.0)) return light_of_surround(path, direction);
    for (Share& share : own.shares) share.seen /= seen, share.lit /= seen;
    return color_of(there, path, work);
}

// Without an environment glass shows the picture's background, as other viewers do, and other things the soft surround.
glm::dvec3 BeamTracer::light_of_surround(const Path& path, const glm::dvec3& direction) const {
    if (options_.surround) return options_.surround(direction);
    if (environment_) return environment_->radiance(direction, path.solid);
    return path.through ? background_ : soft_radiance(direction, options_.view.light.ambient);
}

// What the way through glass to where the share is seen from leaves of light.
glm::dvec3 BeamTracer::kept_within(const Place& place, const Share& share, const Path& path) const {
    const MaterialInfo& material = scene_.material(place);
    if (!place.within || !(material.thickness > 0.0f) || std::isinf(material.attenuation_distance)) return glm::dvec3(1.0);
    const double part = glm::distance(path.from, place.world(share.place)) / double(material.attenuation_distance * place.primitive->scale);
    glm::dvec3 kept;
    for (int c = 0; c < 3; ++c) kept[c] = std::pow(double(material.attenuation_color[c]), part);
    return kept;
}

}  // namespace burin::reference
