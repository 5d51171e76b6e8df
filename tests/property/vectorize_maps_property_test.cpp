// What is known to break tracers of maps: grain, shading, few levels, dots, ragged edges, maps without paths, maps hardly
// there. Drawn at random, spoilt, traced, and compared with what was drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <burin/convert.hpp>
#include <burin/resolve.hpp>

#include "drawn_map.hpp"

namespace burin::testing {
namespace {

using bench::circle;
using bench::Pen;
using bench::polyline;
using bench::slab;

constexpr double kDepth = 0.5;

void report(const char* what, const Recovered& r) {
    std::printf("  %-28s contour %.4f, 99.9 %% %.3f, lost %.2f %%; paths %d/%d/%d\n", what, r.contour.rms, r.contour.p999,
                100.0 * r.contour.lost, r.structure.paths.authored, r.structure.paths.recovered, r.structure.paths.matched);
}

// Four strokes and a plateau, none near another.
Pattern plain_drawing(Uniform& random, double depth) {
    DrawnMap map(1.5);
    for (int i = 0; i < 3; ++i) {
        const double along = random(0, 6.28);
        const Vec2 c = map.field(i);
        map.draw(map.pens().groove(random(4, 8), depth), polyline({c - toward(along, 48), c + toward(along, 48)}));
    }
    map.draw(map.pens().groove(5.0, depth), bench::arc(map.field(3), 45.0, 0.5, 4.0));
    map.draw(map.pens().step(0.4 * depth), slab(map.field(3), {18, 12}, 4.0, random(0, 3)));
    return map.take();
}

double normal(Uniform& random) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += random(0, 1);
    return sum;
}

// Smooth noise between 0 and 1: random values every `period` texels, joined by cubics.
Image clouds(int width, int height, double period, Uniform& random) {
    const int columns = static_cast<int>(width / period) + 3, rows = static_cast<int>(height / period) + 3;
    std::vector<double> values(static_cast<std::size_t>(columns) * rows);
    for (double& v : values) v = random(0, 1);
    Image out(width, height);
    const auto ease = [](double t) { return t * t * (3.0 - 2.0 * t); };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int i = static_cast<int>(x / period), j = static_cast<int>(y / period);
            const double s = ease(x / period - i), t = ease(y / period - j);
            const auto at = [&](int a, int b) { return values[static_cast<std::size_t>(b) * columns + a]; };
            out.at(x, y) = static_cast<float>(std::lerp(std::lerp(at(i, j), at(i + 1, j), s), std::lerp(at(i, j + 1), at(i + 1, j + 1), s), t));
        }
    }
    return out;
}

void expect_same_paths(const Recovered& r) {
    EXPECT_EQ(r.structure.paths.recovered, r.structure.paths.authored);
    EXPECT_EQ(r.structure.paths.matched, r.structure.paths.authored);
}

TEST(VectorizeMaps, GrainMakesNoPaths) {
    Uniform random(seed_of_run());
    const Pattern drawing = plain_drawing(random, kDepth);
    Image map = bench::map_of(drawing, kTexels, 16);
    for (float& v : map.texels) v = std::clamp(v + static_cast<float>(0.008 * normal(random)), 0.0f, 1.0f);
    const Recovered r = recovered_from(map, drawing);
    report("grain", r);
    expect_same_paths(r);
    EXPECT_LT(r.contour.rms, 0.06);
}

// A vignette around a groove is shape, and no part of its profile.
TEST(VectorizeMaps, ShadingAroundGroovesIsNoGroove) {
    Uniform random(seed_of_run());
    const Pattern drawing = plain_drawing(random, kDepth);
    Image map = bench::map_of(drawing, kTexels, 16);
    const Image shade = clouds(kTexels, kTexels, 90.0, random);
    for (std::size_t i = 0; i < map.texels.size(); ++i) map.texels[i] = std::min(1.0f, map.texels[i] + 0.2f * (shade.texels[i] - 0.5f));
    const Recovered r = recovered_from(map, drawing);
    report("shading", r);
    EXPECT_EQ(r.structure.paths.matched, r.structure.paths.authored);
}

TEST(VectorizeMaps, FewLevelsAreEnough) {
    Uniform random(seed_of_run());
    const Pattern drawing = plain_drawing(random, kDepth);
    Image map = bench::map_of(drawing, kTexels, 16);
    for (float& v : map.texels) v = (219.0f + std::round(36.0f * v)) / 255.0f;
    Pattern low = drawing;
    const double share = 36.0 / 255.0;
    low.base_offset = drawing.depth * (1.0 - share) * 0.0 + drawing.base_offset * share;
    for (Profile& profile : low.profiles)
        for (ProfilePoint& point : profile.points) point.h *= share;
    const Recovered r = recovered_from(map, low);
    report("levels 219 to 255", r);
    expect_same_paths(r);
    EXPECT_LT(r.contour.rms, 0.1);
}

TEST(VectorizeMaps, BoltsAndSlotsAreOutlines) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0, 0.5);
    const Pen bolt = map.pens().step(0.4), slot = map.pens().step(-0.4);
    for (int i = 0; i < 16; ++i) {
        const Vec2 c{36.0 + 60.0 * (i % 4), 36.0 + 60.0 * (i / 4)};
        i % 2 ? map.draw(bolt, circle(c, 5.0 + 0.8 * i)) : map.draw(slot, slab(c, {14, 6}, 5.0, random(0, 3)));
    }
    const Recovered r = recovered_from(map.take());
    report("bolts and slots", r);
    expect_same_paths(r);
    EXPECT_LT(r.contour.rms, 0.03);
}

TEST(VectorizeMaps, RaggedEdgesStayOneOutline) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0, 0.4);
    std::vector<Vec2> outline;
    for (int i = 0; i < 240; ++i)
        outline.push_back(Vec2{128, 128} + toward(i * 4.0 * bench::kQuarter / 240.0, 80.0 + random(-1.0, 1.0)));
    map.draw(map.pens().step(0.4), polyline(outline, true));
    const Pattern drawing = map.take();
    const Recovered r = recovered_from(drawing);
    report("ragged edge", r);
    EXPECT_EQ(r.pattern.paths.size(), 1u);
    EXPECT_EQ(r.contour.lost, 0.0);
}

// Hairlines a fifth as deep as the clouds below them are high.
TEST(VectorizeMaps, ScratchesOverCloudsAreFound) {
    Uniform random(seed_of_run());
    DrawnMap drawn(0.3, 0.9);
    for (int i = 0; i < 6; ++i) {
        const double along = random(-0.4, 0.4), y = 30.0 + 38.0 * i;
        drawn.draw(drawn.pens().groove(1.6, 0.1), polyline({Vec2{128, y} - toward(along, 100), Vec2{128, y} + toward(along, 100)}));
    }
    const Pattern drawing = drawn.take();
    Image map = bench::map_of(drawing, kTexels, 16);
    const Image cloud = clouds(kTexels, kTexels, 40.0, random);
    for (std::size_t i = 0; i < map.texels.size(); ++i) map.texels[i] -= 0.5f * cloud.texels[i];
    const Pattern found = bench::vectorized(map, drawing, true);
    const bench::StructureScore score = bench::compare_structure(drawing, found, kTexels);
    std::printf("  %zu paths for %d scratches, %d whole\n", found.paths.size(), score.paths.authored, score.paths.matched);
    EXPECT_GE(score.paths.matched, 4);
    EXPECT_LE(score.paths.recovered - score.paths.matched, 6);
}

Converted converted(const Image& image) {
    HeightMap map;
    map.image = image;
    ConvertOptions options;
    options.vectorize.size = {1.0, static_cast<double>(image.height) / image.width};
    Result<Converted> result = convert_map(map, make_plane(options.vectorize.size), options);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(*result) : Converted{};
}

// Noise and hills can be "explained" by sheer number of paths: what is said must be that they are not path-like.
TEST(VectorizeMaps, NoiseAndTerrainAreNotPathLike) {
    Uniform random(seed_of_run());
    constexpr int kSide = 128;
    Image noise(kSide, kSide), terrain(kSide, kSide);
    for (float& v : noise.texels) v = static_cast<float>(random(0, 1));
    for (double period = 50.0, share = 0.5; period > 2.0; period *= 0.5, share *= 0.5) {
        const Image octave = clouds(kSide, kSide, period, random);
        for (std::size_t i = 0; i < terrain.texels.size(); ++i) terrain.texels[i] += static_cast<float>(share) * octave.texels[i];
    }
    for (const Image* map : {&noise, &terrain}) {
        const ConvertStats stats = converted(*map).stats;
        std::printf("  %s: %d paths, explained %.3f\n", map == &noise ? "noise" : "terrain", stats.paths, stats.explained);
        EXPECT_FALSE(stats.path_like);
        EXPECT_LE(stats.grid_bytes + stats.data_bytes, 16u * 1024);
    }
}

TEST(VectorizeMaps, ConstantAndTinyMaps) {
    Uniform random(seed_of_run());
    const int sides[][2] = {{1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 3}, {3, 100}, {100, 3}, {1, 300}, {300, 1}, {7, 5}, {16, 16}};
    for (const auto& side : sides) {
        SCOPED_TRACE(std::to_string(side[0]) + " x " + std::to_string(side[1]));
        for (const float level : {0.0f, 0.37f, 1.0f}) EXPECT_EQ(converted(Image(side[0], side[1], level)).stats.paths, 0);
        Image map(side[0], side[1]);
        for (float& v : map.texels) v = static_cast<float>(random(0, 1));
        EXPECT_FALSE(converted(map).glb.empty());
        for (int y = 0; y < map.height; ++y)
            for (int x = 0; x < map.width; ++x) map.at(x, y) = (x + y) % 2 ? 1.0f : 0.0f;
        EXPECT_FALSE(converted(map).glb.empty());
    }
}

}  // namespace
}  // namespace burin::testing
