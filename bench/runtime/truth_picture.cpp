#include "truth_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>

#include <burin/image_io.hpp>

namespace burin::bench {
namespace {

using Vec3 = std::array<double, 3>;

double dot3(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 unit3(const Vec3& a) {
    const double l = std::sqrt(dot3(a, a));
    return {a[0] / l, a[1] / l, a[2] / l};
}

// Only the elements near what a view shows: the truth asks each element about each ray. Ground needs every step.
ResolvedPattern seen_part(const ResolvedPattern& whole, const PlaneView& view) {
    ResolvedPattern part = whole;
    for (const Style& style : whole.styles)
        if (style.step) return part;
    const double radius = view.pixel * std::hypot(view.width, view.height) / std::sin(view.elevation * 0.0174533) +
                          whole.depth * 12.0;
    part.elements.clear();
    for (const ResolvedElement& e : whole.elements) {
        double reach = 0.0;
        for (const ProfilePoint& point : whole.profiles[whole.styles[e.style].profile].points)
            reach = std::max(reach, std::abs(point.b));
        reach *= 4.5 * std::max(e.element.width0, e.element.width1);
        const Vec2 middle = lerp(e.element.p0, e.element.p2, 0.5);
        Vec2 off = middle - view.focus;
        if (whole.wrap == Wrap::repeat)
            off = off - Vec2{whole.size.x * std::round(off.x / whole.size.x), whole.size.y * std::round(off.y / whole.size.y)};
        if (length(off) < radius + reach + length(e.element.p2 - e.element.p0) + length(e.element.p1 - middle))
            part.elements.push_back(e);
    }
    return part;
}

}  // namespace

double to_srgb(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

double background_color() { return std::pow((0.93 + 0.055) / 1.055, 2.4); }

std::array<double, 3> direction_to(const Light& light) {
    const double a = light.azimuth * std::numbers::pi / 180.0, e = light.elevation * std::numbers::pi / 180.0;
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

Look look_of(const scenes::Part& part, const Material* own) {
    if (own && own->overrides) return {{double(own->base_color[0]), double(own->base_color[1]), double(own->base_color[2])}, double(own->metallic), double(own->roughness)};
    return {{double(part.color[0]), double(part.color[1]), double(part.color[2])}, double(part.metallic), double(part.roughness)};
}

Vec3 shade(const Look& look, const Light& light, const Vec3& to_light, const Vec3& n, const Vec3& to_eye, bool lit) {
    const Vec3 half = unit3({to_eye[0] + to_light[0], to_eye[1] + to_light[1], to_eye[2] + to_light[2]});
    const double nl = std::max(dot3(n, to_light), 0.0), nv = std::max(dot3(n, to_eye), 1e-3), nh = std::max(dot3(n, half), 0.0);
    const double a = std::max(look.roughness * look.roughness, 2e-3), a2 = a * a;
    const double spread = nh * nh * (a2 - 1.0) + 1.0, d = a2 / (std::numbers::pi * spread * spread);
    const double visible =
        0.5 / (nl * std::sqrt(nv * nv * (1.0 - a2) + a2) + nv * std::sqrt(nl * nl * (1.0 - a2) + a2) + 1e-6);
    const double off = 1.0 - std::max(dot3(to_eye, half), 0.0), grazing = off * off * off * off * off, sky = 0.5 + 0.5 * n[1];
    Vec3 color;
    for (std::size_t i = 0; i < 3; ++i) {
        const double f0 = 0.04 + (look.albedo[i] - 0.04) * look.metallic, fresnel = f0 + (1.0 - f0) * grazing;
        const double diffuse = look.albedo[i] * (1.0 - look.metallic) / std::numbers::pi;
        const double direct = (diffuse * (1.0 - fresnel) + fresnel * d * visible) * (lit ? nl * light.strength : 0.0);
        const double matt = look.albedo[i] * (1.0 - look.metallic), mirrored = fresnel * (1.0 + (0.75 - 1.0) * look.roughness);
        const double around = matt + (mirrored - matt) * (0.1 + 0.9 * look.metallic);
        color[i] = std::clamp(direct + around * light.ambient * (0.35 + 0.65 * sky), 0.0, 1.0);
    }
    return color;
}

TruthScene::TruthScene(const Subject& subject, const PlaneView& view, const Extent& extent)
    : pattern_(seen_part(subject.prepared.resolved, view)),
      truth_(pattern_),
      part_(subject.part()),
      view_(view),
      camera_(camera_of(view, pattern_.size)),
      extent_(extent),
      light_(direction_to(view.light)) {}

// Followed from the object surface: whatever is met before the point itself stands in the light.
bool TruthScene::in_shadow(const RayHit& hit) const {
    const double climb = (pattern_.base_offset - hit.position[2]) / light_[1];
    Ray ray;
    ray.origin[0] = hit.position[0] + light_[0] * climb;
    ray.origin[1] = hit.position[1] + light_[2] * climb;
    ray.origin[2] = pattern_.base_offset;
    ray.direction[0] = -light_[0];
    ray.direction[1] = -light_[2];
    ray.direction[2] = -light_[1];
    const RayHit blocker = truth_.trace_ray(ray);
    return blocker.hit && blocker.t < climb - 1e-6 * pattern_.depth / light_[1];
}

Look TruthScene::look_at(std::uint32_t element) const {
    if (element == kGround) return look_of(part_, nullptr);
    return look_of(part_, &pattern_.materials[pattern_.styles[pattern_.elements[element].style].material]);
}

TruthSample TruthScene::sample(double x, double y) const {
    const double across = (2.0 * x / view_.width - 1.0) * camera_.tangent * camera_.aspect,
                 upwards = (1.0 - 2.0 * y / view_.height) * camera_.tangent;
    Vec3 way;
    for (std::size_t i = 0; i < 3; ++i) way[i] = camera_.forward[i] + across * camera_.right[i] + upwards * camera_.up[i];
    way = unit3(way);
    TruthSample sample;
    const double background = background_color();
    sample.color = {background, background, background};
    if (way[1] >= 0.0) return sample;
    const double t = camera_.eye[1] / -way[1];
    const Vec2 at{camera_.eye[0] + way[0] * t + pattern_.size.x * 0.5, camera_.eye[2] + way[2] * t + pattern_.size.y * 0.5};
    const double u = at.x / pattern_.size.x, v = at.y / pattern_.size.y;
    if (u < extent_.low.x || u > extent_.high.x || v < extent_.low.y || v > extent_.high.y) return sample;
    Ray ray;
    ray.origin[0] = at.x;
    ray.origin[1] = at.y;
    ray.origin[2] = pattern_.base_offset;
    ray.direction[0] = way[0];
    ray.direction[1] = way[2];
    ray.direction[2] = way[1];
    RayHit hit = truth_.trace_ray(ray);
    // The object surface is the top of everything: solid that reaches it is ground seen from above.
    if (hit.inside) hit.normal[0] = hit.normal[1] = 0.0, hit.normal[2] = 1.0;
    const Vec3 n = {hit.normal[0], hit.normal[2], hit.normal[1]};
    const bool faces = dot3(n, light_) > 0.0 && light_[1] > 0.0;
    const bool lit = faces && !in_shadow(hit);
    sample.color = shade(look_at(hit.element), view_.light, light_, n, {-way[0], -way[1], -way[2]}, lit);
    sample.feature = hit.element != kGround || hit.facet != kGround;
    // Neighbours along a path that look alike are alike: the element itself does not count.
    sample.what = 1 + ((std::uint64_t{hit.facet} << 2) ^ (hit.element == kGround ? 1u : 0u) ^ (lit ? 2u : 0u));
    return sample;
}

namespace {

// What the samples of one pixel amount to.
struct Pixel {
    Vec3 sum{0, 0, 0};
    std::uint64_t what = 0;
    bool uneven = false, feature = false, background = false;
    double low = 1e9, high = -1e9;

    void add(const TruthSample& sample, bool first) {
        for (std::size_t i = 0; i < 3; ++i) sum[i] += sample.color[i];
        const double seen = std::sqrt(sample.color[0] + 2.0 * sample.color[1] + sample.color[2]) * 0.5;
        low = std::min(low, seen);
        high = std::max(high, seen);
        feature |= sample.feature;
        background |= sample.what == 0;
        if (first) what = sample.what;
        uneven |= sample.what != what;
    }
};

Pixel draw_pixel(const TruthScene& scene, int x, int y, int side) {
    Pixel pixel;
    for (int k = 0; k < side * side; ++k)
        pixel.add(scene.sample(x + (k % side + 0.5) / side, y + (k / side + 0.5) / side), k == 0);
    for (double& value : pixel.sum) value /= side * side;
    return pixel;
}

constexpr double kEven = 0.004;  // samples within this of each other are averaged as they are

bool is_uneven(const Pixel& pixel) { return pixel.uneven || pixel.high - pixel.low > kEven; }

// Whether a thing too small for the first samples may stand here: something else begins beside the pixel.
bool has_other_neighbour(const std::vector<Pixel>& pixels, int width, int height, int x, int y) {
    const Pixel& own = pixels[std::size_t(y * width + x)];
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i)
            if (pixels[std::size_t(j * width + i)].what != own.what) return true;
    return false;
}

Pixel refine_pixel(const TruthScene& scene, const std::vector<Pixel>& few, const PlaneView& view, int x, int y) {
    Pixel pixel = few[std::size_t(y * view.width + x)];
    if (!is_uneven(pixel) && has_other_neighbour(few, view.width, view.height, x, y)) pixel = draw_pixel(scene, x, y, 8);
    return is_uneven(pixel) ? draw_pixel(scene, x, y, 16) : pixel;
}

TruthPicture draw_anew(const Subject& subject, const PlaneView& view) {
    const TruthScene scene(subject, view, extent_of(view, subject.prepared.resolved));
    const std::size_t count = std::size_t(view.width) * std::size_t(view.height);
    std::vector<Pixel> few(count), all(count);
    const auto x_of = [&](std::size_t i) { return int(i) % view.width; };
    const auto y_of = [&](std::size_t i) { return int(i) / view.width; };
    testing::in_parallel(count, [&](std::size_t i) { few[i] = draw_pixel(scene, x_of(i), y_of(i), 4); });
    testing::in_parallel(count, [&](std::size_t i) {
        all[i] = refine_pixel(scene, few, view, x_of(i), y_of(i));
    });
    TruthPicture picture{view.width, view.height, {}, {}};
    for (const Pixel& pixel : all) {
        for (const double value : pixel.sum) picture.linear.push_back(float(value));
        // The silhouette of the mesh is not the detail's affair.
        picture.feature.push_back((pixel.feature || pixel.uneven) && !pixel.background);
    }
    return picture;
}

// Names a picture by all that it depends on: the stored numbers, the material, the view, and the drawing's own version.
std::string key_of(const Subject& subject, const PlaneView& view) {
    constexpr std::uint64_t kVersion = 2;
    std::uint64_t hash = 0xcbf29ce484222325ull;
    const auto add = [&](const void* data, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; ++i) hash = (hash ^ static_cast<const std::uint8_t*>(data)[i]) * 0x100000001b3ull;
    };
    const auto& data = subject.prepared.textures.data;
    add(data.data(), 16 * std::size_t(subject.prepared.textures.sections.lists_begin()));
    const double numbers[] = {double(kVersion), double(view.width), double(view.height), view.focus.x, view.focus.y, view.azimuth,
                              view.elevation, view.pixel, view.field_of_view, view.light.azimuth, view.light.elevation,
                              view.light.strength, view.light.ambient, double(subject.part().color[0]),
                              double(subject.part().color[1]), double(subject.part().color[2]), double(subject.part().metallic),
                              double(subject.part().roughness), subject.prepared.resolved.depth,
                              subject.prepared.resolved.size.x, subject.prepared.resolved.size.y};
    add(numbers, sizeof numbers);
    char name[32];
    std::snprintf(name, sizeof name, "%016llx.truth", static_cast<unsigned long long>(hash));
    return name;
}

}  // namespace

TruthPicture draw_truth(const Subject& subject, const PlaneView& view, const std::string& cache) {
    if (cache.empty()) return draw_anew(subject, view);
    const std::size_t count = std::size_t(view.width) * std::size_t(view.height);
    const std::string path = cache + "/" + key_of(subject, view);
    if (auto bytes = read_file(path, 1u << 30); bytes && bytes->size() == count * 13) {
        TruthPicture picture{view.width, view.height, std::vector<float>(count * 3), {}};
        std::memcpy(picture.linear.data(), bytes->data(), count * 12);
        picture.feature.assign(bytes->begin() + std::ptrdiff_t(count * 12), bytes->end());
        return picture;
    }
    TruthPicture picture = draw_anew(subject, view);
    std::vector<std::uint8_t> bytes(count * 12);
    std::memcpy(bytes.data(), picture.linear.data(), count * 12);
    bytes.insert(bytes.end(), picture.feature.begin(), picture.feature.end());
    if (Status written = write_file(path, bytes); !written)
        std::fprintf(stderr, "the truth's picture is not kept: %s\n", written.error().message.c_str());
    return picture;
}

}  // namespace burin::bench
