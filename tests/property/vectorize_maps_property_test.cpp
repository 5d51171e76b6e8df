// What is known to break tracers of maps: grain, shading, few levels, dots, ragged edges, maps without paths, maps hardly
// there. Drawn at random, spoilt, traced, and compared with what was drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <burin/resolve.hpp>

#include "../../bench/vectorizer/damage.hpp"
#include "../unit/temporary_folder.hpp"
#include "converted_map.hpp"
#include "drawn_map.hpp"

namespace burin::testing {
namespace {

using bench::circle;
using bench::Pen;
using bench::polyline;
using bench::slab;
using bench::Stroke;

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

// The strokes and plateaus are there, all but one at most, and no edge is lost or invented far from one.
void expect_found(const Recovered& r, double rms) {
    EXPECT_GE(r.structure.paths.matched, r.structure.paths.authored - 1);
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, rms);
}

TEST(VectorizeMaps, GrainMakesNoPaths) {
    Uniform random(seed_of_run());
    const Pattern drawing = plain_drawing(random, kDepth);
    Image map = bench::map_of(drawing, kTexels, 16);
    bench::add_grain(map, 0.008, random);
    const Recovered r = recovered_from(map, drawing);
    report("grain", r);
    expect_found(r, 0.1);
}

// Sharp walls ring in their blocks; that is no plateau around every stroke.
TEST(VectorizeMaps, RingingIsNoPlateau) {
    Uniform random(seed_of_run());
    DrawnMap map(0.4);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28);
        const Vec2 c = map.field(i);
        map.draw(map.pens().groove(random(4, 8), kDepth), polyline({c - toward(along, 48), c, c + toward(along + random(-0.9, 0.9), 48)}));
    }
    const Pattern drawing = map.take();
    const test::TemporaryFolder folder;
    const HeightMap map_read = bench::damaged(bench::map_of(drawing, kTexels, 16), bench::Damage::jpeg, folder.path());
    const Recovered r = recovered_from(map_read.image, drawing);
    report("JPEG 85", r);
    EXPECT_EQ(r.structure.paths.recovered, r.structure.paths.authored);
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, 0.06);
}

// Straight walls of upright strokes: rounding and ringing are the same all along them, so that no mean takes them away, and
// a profile with points to spare follows them.
Pattern upright_strokes(Uniform& random) {
    DrawnMap map(2.0);
    for (int i = 0; i < 4; ++i) {
        const double width = random(4, 10), depth = random(0.3, 0.5), at = 22.0 + 42.0 * i + random(0, 5), end = random(120, 230);
        map.draw(map.pens().groove(width, depth), polyline({{at, 20.0}, {at, end}}));
    }
    return map.take();
}

Pattern round_strokes(Uniform& random) {
    DrawnMap map(2.0);
    for (int i = 0; i < 4; ++i) {
        const double from = random(0, 6.28);
        map.draw(map.pens().groove(random(4, 8), kDepth), bench::arc(map.field(i), random(16, 44), from, from + random(2, 5)));
    }
    return map.take();
}

void expect_walls_stand(const Pattern& drawing, bench::Damage damage, const char* what, double rms) {
    const test::TemporaryFolder folder;
    const HeightMap map = bench::damaged(bench::map_of(drawing, kTexels, 16), damage, folder.path());
    const Recovered r = recovered_from(map.image, drawing);
    report(what, r);
    expect_found(r, rms);
}

TEST(VectorizeMaps, DamageMovesNoWalls) {
    Uniform random(seed_of_run());
    const Pattern upright = upright_strokes(random), bent = round_strokes(random);
    expect_walls_stand(upright, bench::Damage::eight_bit, "upright, 8 bits", 0.02);
    expect_walls_stand(upright, bench::Damage::jpeg, "upright, JPEG 85", 0.06);
    expect_walls_stand(bent, bench::Damage::eight_bit, "bent, 8 bits", 0.03);
    expect_walls_stand(bent, bench::Damage::jpeg, "bent, JPEG 85", 0.03);
}

// A vignette around a groove is shape, and no part of its profile.
TEST(VectorizeMaps, ShadingAroundGroovesIsNoGroove) {
    Uniform random(seed_of_run());
    const Pattern drawing = plain_drawing(random, kDepth);
    Image map = bench::map_of(drawing, kTexels, 16);
    bench::add_clouds(map, 0.1, 90.0, random);
    const Recovered r = recovered_from(map, drawing);
    report("shading", r);
    expect_found(r, 0.3);
}

TEST(VectorizeMaps, FewLevelsAreEnough) {
    Uniform random(seed_of_run());
    const Pattern drawing = plain_drawing(random, kDepth);
    Image map = bench::map_of(drawing, kTexels, 16);
    bench::keep_few_levels(map);
    Pattern low = drawing;
    constexpr double kShare = 36.0 / 255.0;
    low.base_offset *= kShare;
    for (Profile& profile : low.profiles)
        for (ProfilePoint& point : profile.points) point.h *= kShare;
    for (Path& path : low.paths) path.level *= kShare;
    const Recovered r = recovered_from(map, low);
    report("levels 219 to 255", r);
    expect_found(r, 0.1);
}

TEST(VectorizeMaps, BoltsAndSlotsAreOnePathEach) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0, 0.5);
    const Pen bolt = map.pens().step(0.4), slot = map.pens().step(-0.4);
    for (int i = 0; i < 16; ++i) {
        const Vec2 c{36.0 + 60.0 * (i % 4), 36.0 + 60.0 * (i / 4)};
        i % 2 ? map.draw(bolt, circle(c, 5.0 + 0.8 * i)) : map.draw(slot, slab(c, {14, 6}, 5.0, random(0, 3)));
    }
    const Recovered r = recovered_from(map.take());
    report("bolts and slots", r);
    EXPECT_EQ(r.structure.paths.recovered, r.structure.paths.authored);
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, 0.05);
}

// Discs of any size, high and low: the small ones are dots, the large ones outlines, and none is lost.
TEST(VectorizeMaps, DiscsAreOnePathEach) {
    Uniform random(seed_of_run());
    for (const double wall : {0.4, 2.0}) {
        DrawnMap map(wall, 0.5);
        const Pen rise = map.pens().step(0.4), pit = map.pens().step(-0.4);
        for (int i = 0; i < 25; ++i) {
            const Vec2 c = Vec2{28.0 + 50.0 * (i % 5), 28.0 + 50.0 * (i / 5)} + Vec2{random(-1, 1), random(-1, 1)};
            map.draw(random(0, 1) < 0.5 ? rise : pit, circle(c, random(1.5, i % 5 == 0 ? 20.0 : 8.0)));
        }
        const Recovered r = recovered_from(map.take());
        report("discs", r);
        EXPECT_EQ(r.structure.paths.recovered, r.structure.paths.authored);
        EXPECT_GE(r.structure.paths.matched, r.structure.paths.authored - 1);
        EXPECT_EQ(r.contour.lost, 0.0);
        EXPECT_LT(r.contour.rms, 0.04);
    }
}

// Milled slots of any direction: straight, both ends round.
TEST(VectorizeMaps, SlotsEndRound) {
    Uniform random(seed_of_run());
    for (const double wall : {0.4, 2.0}) {
        DrawnMap map(wall, 0.5);
        const Pen pens[] = {map.pens().step(0.4), map.pens().step(-0.4)};
        for (int i = 0; i < 16; ++i) {
            const Vec2 c = Vec2{36.0 + 60.0 * (i % 4), 36.0 + 60.0 * (i / 4)} + Vec2{random(-1, 1), random(-1, 1)};
            const double radius = random(2.5, 6.0);
            map.draw(pens[i % 2], slab(c, {radius + random(3.0, 14.0), radius}, radius, random(0, 3)));
        }
        const Recovered r = recovered_from(map.take());
        report("slots", r);
        EXPECT_EQ(r.structure.paths.recovered, r.structure.paths.authored);
        EXPECT_EQ(r.contour.lost, 0.0);
        EXPECT_LT(r.contour.rms, 0.1);
    }
}

Stroke letter_h(double height, double width, double stem) {
    const double bar = 0.5 * (height - stem);
    return polyline({{0, 0}, {stem, 0}, {stem, bar}, {width - stem, bar}, {width - stem, 0}, {width, 0}, {width, height},
                     {width - stem, height}, {width - stem, bar + stem}, {stem, bar + stem}, {stem, height}, {0, height}}, true);
}

// Letters of broad strokes are found as a whole, whether as strokes or as outlines.
TEST(VectorizeMaps, BroadLettersStayWhole) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5, 0.3);
    const Pen rise = map.pens().step(0.4), fall = map.pens().on(map.pens().step(-0.4), 0.4);
    for (int i = 0; i < 4; ++i) {
        const double stem = random(7.0, 18.0), angle = random(-0.2, 0.2), height = random(80.0, 100.0);
        const Vec2 corner = DrawnMap::field(i) - Vec2{40.0, 48.0};
        if (i % 2 == 0) {
            map.draw(rise, letter_h(height, 70.0, stem).placed(1.0, angle, corner));
            continue;
        }
        map.draw(rise, slab(DrawnMap::field(i), {36.0, 46.0}, 36.0, angle));
        map.draw(fall, slab(DrawnMap::field(i), {36.0 - stem, 46.0 - stem}, 36.0 - stem, angle));
    }
    const Recovered r = recovered_from(map.take());
    report("broad letters", r);
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, 0.1);
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
    EXPECT_LT(r.contour.rms, 0.3);
}

// Noise can be "explained" by sheer number of paths; hills are smooth enough for a few. Neither may fill the textures.
TEST(VectorizeMaps, NoiseAndTerrainAreNotTracedToPieces) {
    constexpr int kSide = 96;
    Uniform random(seed_of_run());
    Image noise(kSide, kSide), terrain(kSide, kSide);
    for (float& v : noise.texels) v = static_cast<float>(random(0, 1));
    for (double period = 50.0, share = 0.5; period > 2.0; period *= 0.5, share *= 0.5) {
        const Image octave = bench::clouds(kSide, kSide, period, random);
        for (std::size_t i = 0; i < terrain.texels.size(); ++i) terrain.texels[i] += static_cast<float>(share) * octave.texels[i];
    }
    const ConvertStats of_noise = converted(noise).stats, of_terrain = converted(terrain).stats;
    std::printf("  noise %d paths, explained %.3f; terrain %d, %.3f\n", of_noise.paths, of_noise.explained, of_terrain.paths,
                of_terrain.explained);
    EXPECT_FALSE(of_noise.path_like);
    EXPECT_EQ(of_noise.paths, 0);
    EXPECT_LE(of_terrain.grid_bytes + of_terrain.data_bytes, 16u * 1024);
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
