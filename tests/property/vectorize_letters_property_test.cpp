// Letters cut out of a plate, or into it: closed rims, not centre lines, however even their strokes; where the map has no
// plateaus of their height, the same strokes are lines.
#include <gtest/gtest.h>

#include <algorithm>

#include <burin/vectorize.hpp>

#include "../../bench/vectorizer/damage.hpp"
#include "../unit/temporary_folder.hpp"
#include "drawn_map.hpp"

namespace burin::testing {
namespace {

using bench::NodeKind;
using bench::Pen;
using bench::polyline;
using bench::Stroke;

// In a box of height 1, strokes 0.18 wide; clockwise, so that their inside is to the right.
std::vector<Stroke> letters() {
    return {polyline({{0, 0}, {0.7, 0}, {0.7, 0.18}, {0.44, 0.18}, {0.44, 1}, {0.26, 1}, {0.26, 0.18}, {0, 0.18}}, true),
            polyline({{0, 0}, {0.18, 0}, {0.18, 0.82}, {0.6, 0.82}, {0.6, 1}, {0, 1}}, true),
            polyline({{0, 0}, {0.6, 0}, {0.6, 0.18}, {0.18, 0.18}, {0.18, 0.4}, {0.5, 0.4}, {0.5, 0.58}, {0.18, 0.58}, {0.18, 1}, {0, 1}}, true),
            Stroke({0, 0}).line({0.18, 0}).line({0.18, 0.6}).arc({0.4, 0.6}, 0.22, 2.0 * bench::kQuarter, 0.0).line({0.62, 0})
                .line({0.8, 0}).line({0.8, 0.6}).arc({0.4, 0.6}, 0.4, 0.0, 2.0 * bench::kQuarter).close()};
}

// A large letter on every field, and two small ones beside it.
Pattern word(Uniform& random, double height, double wall) {
    DrawnMap map(wall, 0.5);
    const std::vector<Stroke> all = letters();
    const Pen pen = map.pens().step(height);
    for (int i = 0; i < 4; ++i) {
        const double turn = degrees(random(-8, 8)), small = random(28, 40);
        const Vec2 corner = DrawnMap::field(i) - Vec2{50, 46};
        map.draw(pen, all[i].placed(random(80, 88), turn, corner + Vec2{random(-2, 2), random(-2, 2)}));
        for (const int k : {0, 1}) map.draw(pen, all[(i + k + 1) % 4].placed(small, turn, corner + Vec2{78.0, 4.0 + 48.0 * k}));
    }
    return map.take();
}

void expect_rims(const char* what, const Recovered& r, double most_off) {
    std::printf("  %-28s contour %.4f, 99.9 %% %.3f, lost %.2f %%; structure %.0f %%, paths %d/%d/%d\n", what, r.contour.rms, r.contour.p999,
                100.0 * r.contour.lost, r.structure.percent(), r.structure.paths.authored, r.structure.paths.recovered, r.structure.paths.matched);
    EXPECT_EQ(r.structure.ends().recovered, 0);
    EXPECT_EQ(r.structure.paths.matched, r.structure.paths.authored);
    EXPECT_EQ(r.structure.paths.recovered, r.structure.paths.authored);
    EXPECT_GT(r.structure.percent(), 90.0);
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, most_off);
}

TEST(VectorizeLetters, RaisedLettersAreRims) {
    Uniform random(seed_of_run());
    for (const double wall : {2.0, 0.4}) expect_rims("raised", recovered_from(word(random, random(0.15, 0.45), wall)), 0.08);
}

TEST(VectorizeLetters, EngravedLettersAreRims) {
    Uniform random(seed_of_run());
    expect_rims("engraved", recovered_from(word(random, -random(0.15, 0.45), 1.5)), 0.08);
}

// Rows of letters of strokes as thin as 4 texels on a sheet of 512; the large ones say that they are areas.
Pattern page(Uniform& random) {
    bench::Drawing page(512, 2.0, 0.2);
    const Pen pen = page.step(0.6);
    const std::vector<Stroke> all = letters();
    for (int i = 0; i < 15; ++i) page.draw(pen, all[i % 4].placed(80, 0.0, {20.0 + 97.0 * (i % 5), 16.0 + 92.0 * (i / 5)}));
    for (int row = 0; row < 5; ++row)
        for (int i = 0; i < 11; ++i) {
            const Vec2 corner{20.0 + 44.0 * i + random(0, 4), 288.0 + 44.0 * row + random(0, 4)};
            page.draw(pen, all[(row + i) % 4].placed(random(22, 28), degrees(random(-3, 3)), corner));
        }
    return page.take();
}

void expect_every_letter(const Image& map, const Pattern& drawing) {
    HeightMap height_map;
    height_map.image = map;
    VectorizeOptions options;
    options.size = drawing.size, options.depth = drawing.depth;
    const auto found = vectorize_map(height_map, options);
    ASSERT_TRUE(found.ok());
    const auto is_rim = [](const Path& path) { return path.closed; };
    EXPECT_EQ(found->pattern.paths.size(), drawing.paths.size());
    EXPECT_TRUE(std::all_of(found->pattern.paths.begin(), found->pattern.paths.end(), is_rim));
}

// What is left of a letter of thin strokes, once its foot was taken for a line, is no spot.
TEST(VectorizeLetters, FeetLeaveNoSpots) {
    Uniform random(seed_of_run() + 1);
    const Stroke e = polyline({{0, 0}, {0.6, 0}, {0.6, 0.18}, {0.2, 0.18}, {0.2, 0.41}, {0.52, 0.41}, {0.52, 0.59}, {0.2, 0.59},
                               {0.2, 0.82}, {0.6, 0.82}, {0.6, 1}, {0, 1}}, true);
    bench::Drawing page(512, 2.0, 0.2);
    const Pen pen = page.step(0.6);
    for (int i = 0; i < 10; ++i) page.draw(pen, e.placed(80, 0.0, {20.0 + 97.0 * (i % 5), 16.0 + 92.0 * (i / 5)}));
    for (int i = 0; i < 24; ++i)
        page.draw(pen, e.placed(random(23.5, 24.5), 0.0, {20.0 + 40.0 * (i % 12) + random(0, 1), 290.0 + 42.0 * (i / 12) + random(0, 1)}));
    const Pattern drawing = page.take();
    expect_every_letter(bench::map_of(drawing, 512, 8), drawing);
}

// Ringing leaves no level texels in thin strokes.
TEST(VectorizeLetters, JpegLosesNoThinLetter) {
    Uniform random(seed_of_run());
    const Pattern drawing = page(random);
    const test::TemporaryFolder folder;
    expect_every_letter(bench::damaged(bench::map_of(drawing, 512, 8), bench::Damage::jpeg, folder.path()).image, drawing);
}

// Where the ramp passes a level its line may join that of a letter, but no letter is lost.
TEST(VectorizeLetters, LettersOnARampAreKept) {
    Uniform random(seed_of_run());
    const Pattern drawing = word(random, 0.3, 1.5);
    Image map = bench::map_of(drawing, kTexels, 16);
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) map.at(x, y) += static_cast<float>(0.02 * (x - y) / kTexels);
    const Recovered r = recovered_from(map, drawing);
    std::printf("  on a ramp: contour %.4f, structure %.0f %%\n", r.contour.rms, r.structure.percent());
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, 0.1);
}

// The narrow land between two pits belongs to the plateau that it leads to.
TEST(VectorizeLetters, LandBetweenPitsIsNoRidge) {
    Uniform random(seed_of_run());
    DrawnMap map(2.0, 0.5);
    const Pen pit = map.pens().step(-random(0.1, 0.4));
    for (int i = 0; i < 4; ++i) {
        const double land = random(6, 11), turn = degrees(random(-20, 20));
        for (const int k : {-1, 1})
            map.draw(pit, bench::slab({0.5 * k * (22.0 + land), 0.0}, {11.0, random(22, 30)}, 0.0, 0.0)
                              .placed(1.0, turn, DrawnMap::field(i)));
    }
    expect_rims("land between pits", recovered_from(map.take()), 0.05);
}

// The same letters as lines on level ground: no plateau is of their height.
TEST(VectorizeLetters, StrokesAloneStayLines) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5);
    const Pen pen = map.pens().groove(random(6, 8), 0.4);
    for (int i = 0; i < 4; ++i) {
        const Vec2 corner = DrawnMap::field(i) - Vec2{40, 40};
        const double turn = degrees(random(-8, 8));
        for (const int k : {0, 1}) {
            const Vec2 at = corner + Vec2{56.0 * k, 4.0};
            map.draw(pen, polyline({{0.5, 0}, {0, 0}, {0, 1}, {0.5, 1}}).placed(48, turn, at));
            if ((i + k) % 2) map.draw(pen, polyline({{0, 0.5}, {0.4, 0.5}}).placed(48, turn, at));
        }
    }
    const Recovered r = recovered_from(map.take());
    std::printf("  strokes: structure %.0f %%\n", r.structure.percent());
    EXPECT_EQ(r.structure.paths.matched, r.structure.paths.authored);
    EXPECT_EQ(r.structure.ends().matched, r.structure.ends().authored);
}

}  // namespace
}  // namespace burin::testing
