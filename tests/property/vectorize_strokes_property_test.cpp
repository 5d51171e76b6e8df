// What is known to break tracers of strokes: each case drawn at random places and angles, traced, and compared with what
// was drawn, paths and joints and contours alike. The full table is bench/vectorizer's.
#include <gtest/gtest.h>

#include <cmath>

#include "drawn_map.hpp"

namespace burin::testing {
namespace {

using bench::arc;
using bench::NodeKind;
using bench::Pen;
using bench::polyline;
using bench::Stroke;
using bench::Tally;

constexpr double kDepth = 0.5;

const Tally& nodes(const Recovered& r, NodeKind kind) { return r.structure.nodes[static_cast<int>(kind)]; }

void report(const char* what, const Recovered& r) {
    std::printf("  %-28s contour %.4f, 99.9 %% %.3f, lost %.2f %%; structure %.0f %%\n", what, r.contour.rms, r.contour.p999,
                100.0 * r.contour.lost, r.structure.percent());
    for (const bench::Miss& miss : r.structure.misses)
        std::printf("    %s %s at %.1f, %.1f\n", miss.authored ? "missed" : "false", miss.path ? "path" : "node", miss.place.x, miss.place.y);
}

Recovered traced(DrawnMap& map, const char* what) {
    Recovered r = recovered_from(map.take());
    report(what, r);
    return r;
}

void expect_whole(const Tally& tally, const char* what) {
    EXPECT_EQ(tally.authored, tally.matched) << what;
    EXPECT_EQ(tally.recovered, tally.matched) << what;
}

// Nothing that was drawn is missed; more may be found.
void expect_found(const Tally& tally, const char* what) { EXPECT_EQ(tally.authored, tally.matched) << what; }

TEST(VectorizeStrokes, StemsEndInsideTheStrokeTheyMeet) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28);
        const Vec2 c = map.field(i) + Vec2{random(-4, 4), random(-4, 4)};
        map.draw(map.pens().groove(random(5, 9), kDepth), polyline({c - toward(along, 50), c + toward(along, 50)}));
        map.draw(map.pens().groove(random(3.5, 6), kDepth), polyline({c, c + toward(along + degrees(random(60, 120)), 50)}));
    }
    const Recovered r = traced(map, "stems");
    expect_whole(nodes(r, NodeKind::tee), "tees");
    expect_whole(r.structure.ends(), "ends");
    expect_whole(r.structure.paths, "paths");
    EXPECT_LT(r.contour.rms, 0.02);
}

// The middle of both leads astray for as long as they overlap.
TEST(VectorizeStrokes, WideStemsRunStraightIntoThinStrokes) {
    Uniform random(seed_of_run());
    DrawnMap map(2.0);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28), turn = degrees(random(30, 45));
        const Vec2 c = map.field(i) + toward(along, 16);
        map.draw(map.pens().groove(random(3.5, 4), kDepth), polyline({c - toward(along, 60), c + toward(along, 30)}));
        map.draw(map.pens().groove(random(7, 8), kDepth), polyline({c, c + toward(along + 3.14159 - turn, 60)}));
    }
    const Recovered r = recovered_from(map.take());
    report("wide stems", r);
    expect_whole(nodes(r, NodeKind::tee), "tees");
    expect_whole(r.structure.paths, "paths");
    EXPECT_LT(r.contour.rms, 0.02);
}

TEST(VectorizeStrokes, ArcsEndWhereTheyEnd) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0);
    for (int i = 0; i < 4; ++i) {
        const double from = random(0, 6.28);
        map.draw(map.pens().groove(random(4, 7), kDepth), arc(map.field(i), random(25, 50), from, from + random(1.0, 4.5)));
    }
    const Recovered r = traced(map, "arcs");
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, 0.02);
}

// No longer than a few widths, and bent all along.
TEST(VectorizeStrokes, ShortTightArcsStayArcs) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5);
    for (int i = 0; i < 4; ++i) {
        const double from = random(0, 6.28);
        map.draw(map.pens().groove(random(3, 4.5), kDepth), arc(map.field(i), random(8, 12), from, from + random(1.2, 1.7)));
    }
    const Recovered r = traced(map, "short arcs");
    expect_whole(r.structure.paths, "paths");
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, 0.03);
}

// The ground between strokes nearly as near as they are wide is no ridge.
TEST(VectorizeStrokes, NearStrokesAreStrokes) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5);
    for (int i = 0; i < 4; ++i) {
        const double width = random(3, 4.5), pitch = random(2.3, 3.0) * width, along = random(0, 6.28);
        const Pen pen = map.pens().groove(width, kDepth);
        for (int k = -1; k <= 1; ++k) {
            const Vec2 c = map.field(i) + toward(along + degrees(90), k * pitch);
            i % 2 ? map.draw(pen, bench::circle(map.field(i), 36.0 + k * pitch))
                  : map.draw(pen, polyline({c - toward(along, 40), c + toward(along, 40)}));
        }
    }
    const Recovered r = traced(map, "near strokes");
    expect_whole(r.structure.paths, "paths");
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, 0.03);
}

TEST(VectorizeStrokes, AcuteCornersStayOnePath) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28), angle = degrees(random(30, 80));
        const Vec2 c = map.field(i) - toward(along + 0.5 * angle, 25);
        map.draw(map.pens().groove(random(4, 7), kDepth), polyline({c + toward(along, 55), c, c + toward(along + angle, 55)}));
    }
    const Recovered r = traced(map, "acute corners");
    expect_found(r.structure.paths, "paths");
    expect_found(nodes(r, NodeKind::corner), "corners");
    EXPECT_LT(r.contour.rms, 0.02);
}

// A groove cuts a ridge, which goes on behind it: straight, or round as a ring.
TEST(VectorizeStrokes, RidgesGoOnBehindGrooves) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5, 0.5);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28);
        const Vec2 c = map.field(i);
        const Pen ridge = map.pens().ridge(random(5, 8), 0.3);
        i % 2 ? map.draw(ridge, bench::circle(c, random(28, 42)))
              : map.draw(ridge, polyline({c - toward(along, 46), c + toward(along, 46)}));
        const Vec2 across = toward(along + degrees(90), 56);
        map.draw(map.pens().groove(random(4, 6), 0.4), polyline({c - across, c + across}));
    }
    const Recovered r = traced(map, "ridges behind grooves");
    expect_whole(r.structure.paths, "paths");
    EXPECT_EQ(r.contour.lost, 0.0);
}

// Edge points read off such walls are off by up to 0.06 texel.
TEST(VectorizeStrokes, AxisAlignedWallsSharperThanATexel) {
    Uniform random(seed_of_run());
    for (const double wall : {0.4, 0.1}) {
        DrawnMap map(wall);
        for (int i = 0; i < 4; ++i) {
            const Vec2 c = map.field(i) + Vec2{std::round(random(-80, 80)) / 40.0, std::round(random(-80, 80)) / 40.0};
            const Vec2 along = i % 2 ? Vec2{50, 0} : Vec2{0, 50};
            map.draw(map.pens().groove(4.0 + i, kDepth), polyline({c - along, c + along}));
        }
        const Recovered r = traced(map, "axis-aligned walls");
        expect_whole(r.structure.paths, "paths");
        EXPECT_LT(r.contour.rms, 0.01);
        EXPECT_LT(r.contour.p999, 0.05);
    }
}

TEST(VectorizeStrokes, CornersStaySharp) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0);
    const double inner[] = {75.0, 90.0, 120.0, 145.0};
    for (int i = 0; i < 4; ++i) {
        const double base = random(0, 6.28);
        const Vec2 tip = map.field(i) - toward(base + 0.5 * degrees(inner[i]), 22);
        map.draw(map.pens().groove(random(4, 7), kDepth),
                 polyline({tip + toward(base, 55), tip, tip + toward(base + degrees(inner[i]), 55)}));
    }
    const Recovered r = traced(map, "corners");
    expect_found(nodes(r, NodeKind::corner), "corners");
    EXPECT_LT(r.contour.p999, 0.05);
}

TEST(VectorizeStrokes, AcuteFansKeepTheirStrokes) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0);
    for (int i = 0; i < 4; ++i) {
        const double base = random(0, 6.28);
        const Vec2 tip = map.field(i) - toward(base, 45);
        for (const double angle : {-random(22, 30), 0.0, random(22, 30)})
            map.draw(map.pens().groove(4.0, kDepth), polyline({tip, tip + toward(base + degrees(angle), 90)}));
    }
    const Recovered r = traced(map, "fans");
    expect_found(r.structure.ends(), "ends");
    EXPECT_EQ(r.contour.lost, 0.0);
}

TEST(VectorizeStrokes, CrossingsAreNoPairsOfStems) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28), across = along + degrees(random(45, 135));
        const Vec2 c = map.field(i);
        map.draw(map.pens().groove(random(4, 7), kDepth), polyline({c - toward(along, 50), c + toward(along, 50)}));
        map.draw(map.pens().groove(random(4, 7), kDepth), polyline({c - toward(across, 50), c + toward(across, 50)}));
    }
    const Recovered r = traced(map, "crossings");
    expect_whole(nodes(r, NodeKind::cross), "crossings");
    expect_whole(r.structure.paths, "paths");
    EXPECT_LT(r.contour.rms, 0.02);
}

// An arc that a stroke crosses turns while it is hidden.
TEST(VectorizeStrokes, ArcsGoOnThroughCrossings) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28);
        const Vec2 c = map.field(i), way = toward(along, 52);
        map.draw(map.pens().groove(random(4, 6), kDepth), arc(c, random(26, 40), along + 1.0, along + 1.0 + random(3.5, 4.2)));
        map.draw(map.pens().groove(random(6, 9), kDepth), polyline({c - way, c + way}));
    }
    const Recovered r = traced(map, "arcs through crossings");
    EXPECT_GE(r.structure.percent(), 65.0);
    EXPECT_LT(r.contour.rms, 0.03);
}

// They run as one for most of their length, and each has the other first on one side, then on the other.
TEST(VectorizeStrokes, StrokesCrossAtSmallAngles) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28), across = along + degrees(random(10, 25)), thin = random(3, 4);
        const Vec2 c = map.field(i);
        map.draw(map.pens().groove(thin, kDepth), polyline({c - toward(along, 46), c + toward(along, 46)}));
        map.draw(map.pens().groove(thin * random(1, 1.5), kDepth), polyline({c - toward(across, 46), c + toward(across, 46)}));
    }
    const Recovered r = traced(map, "small angles");
    expect_whole(nodes(r, NodeKind::cross), "crossings");
    expect_whole(r.structure.paths, "paths");
    EXPECT_LT(r.contour.rms, 0.02);
}

// Chains of diagonal staircases.
TEST(VectorizeStrokes, HexagonsMeetInThrees) {
    DrawnMap map(1.0);
    const Pen pen = map.pens().groove(5.0, kDepth);
    constexpr double kEdge = 26.3;
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 4; ++column) {
            const Vec2 c{34.2 + kEdge * std::sqrt(3.0) * (column + 0.5 * (row & 1)), 40.9 + 1.5 * kEdge * row};
            for (const double angle : {-30.0, 30.0, 90.0})
                map.draw(pen, polyline({c + toward(degrees(angle), kEdge), c + toward(degrees(angle + 60), kEdge)}));
        }
    const Recovered r = traced(map, "hexagons");
    expect_whole(nodes(r, NodeKind::wye), "wyes");
    EXPECT_EQ(r.contour.lost, 0.0);
}

// One path, or the clean outline of a pit: no second centre line, no edge on its own.
TEST(VectorizeStrokes, WideFlatGroovesAreFoundOnce) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28);
        map.draw(map.pens().groove(14.0 + 6.0 * i, kDepth),
                 polyline({map.field(i) - toward(along, 40), map.field(i) + toward(along, 40)}));
    }
    const Recovered r = traced(map, "wide grooves");
    expect_whole(r.structure.paths, "paths");
    EXPECT_LT(r.contour.rms, 0.02);
}

// Down to a fourth of the width, to a point, swelling in the middle, and along arcs.
TEST(VectorizeStrokes, TapersAreOnePathEach) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0);
    const std::vector<double> widths[] = {{1.0, 0.25}, {1.0, 0.0}, {0.4, 1.0, 0.4}, {0.25, 1.0}};
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28);
        const Vec2 c = map.field(i), reach = toward(along, random(46, 54));
        Stroke stroke = i < 2   ? polyline({c - reach, c + reach})
                        : i < 3 ? polyline({c - reach, c, c + reach})
                                : arc(c, random(36, 46), along, along + random(2.5, 4.0));
        map.draw(map.pens().groove(random(9, 12), kDepth), stroke.taper(widths[i]));
    }
    const Recovered r = traced(map, "tapers");
    expect_whole(r.structure.paths, "paths");
    EXPECT_EQ(r.contour.lost, 0.0);
    EXPECT_LT(r.contour.rms, 0.05);
}

// Both ways: the upper of two ridges runs on over the lower, which is one path all the same.
TEST(VectorizeStrokes, RidgesCrossOverAndUnder) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5, 0.3);
    for (int i = 0; i < 4; ++i) {
        const double along = random(0, 6.28), across = along + degrees(random(60, 120));
        const Vec2 c = map.field(i);
        map.draw(map.pens().ridge(8.0, 0.5), polyline({c - toward(along, 50), c + toward(along, 50)}));
        map.draw(map.pens().ridge(7.0, 0.35), polyline({c - toward(across, 50), c + toward(across, 50)}));
    }
    const Recovered r = traced(map, "over and under");
    expect_found(nodes(r, NodeKind::cross), "crossings");
    expect_whole(r.structure.paths, "paths");
    EXPECT_LT(r.contour.rms, 0.01);
}

}  // namespace
}  // namespace burin::testing
