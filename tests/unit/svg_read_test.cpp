// Drawings as patterns: what each part of SVG comes to, and that burin's own drawings come back.
#include <cmath>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/resolve.hpp>
#include <burin/svg.hpp>

#include "../property/perturbed.hpp"
#include "pattern_equal.hpp"

namespace burin::testing {
namespace {

constexpr double kMm = 1e-3;

// A page of 100 x 80 mm, a millimetre to the user unit.
std::string page(const std::string& content) {
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
           "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"100mm\" height=\"80mm\" viewBox=\"0 0 100 80\">\n" +
           content + "</svg>\n";
}

SvgDrawing read(const std::string& text, const SvgOptions& options = {}) {
    auto drawing = read_svg(text, options);
    EXPECT_TRUE(drawing.ok()) << (drawing ? "" : drawing.error().message);
    return drawing ? std::move(*drawing) : SvgDrawing{};
}

Truth truth_of(const Pattern& pattern) {
    auto resolved = resolve_pattern(pattern);
    EXPECT_TRUE(resolved.ok()) << (resolved ? "" : resolved.error().message);
    return Truth(resolved ? *resolved : ResolvedPattern{});
}

double width_of(const Pattern& pattern, const Path& path, double scale) {
    const auto& points = pattern.profiles[path.profile].points;
    return (points.back().b - points.front().b) * scale;
}

std::string error_of(const std::string& text, const SvgOptions& options = {}) {
    const auto drawing = read_svg(text, options);
    EXPECT_FALSE(drawing.ok()) << text;
    return drawing ? "" : drawing.error().message;
}

TEST(SvgRead, OwnDrawingsComeBackBitByBit) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        RandomPatternOptions options;
        options.size = {1.0 / 3.0, 0.7};
        options.wrap = seed % 2 == 0 ? Wrap::repeat : Wrap::clamp;
        options.wrap_around = seed % 2 == 0;
        Pattern pattern = perturbed_pattern(seed, options);
        pattern.outer_level = 1e-300;
        pattern.profiles[0].facets = {FacetClass::internal, FacetClass::external};
        SCOPED_TRACE("seed " + std::to_string(seed));
        const SvgDrawing drawing = read(write_svg(pattern));
        EXPECT_TRUE(drawing.notes.empty());
        expect_equal(pattern, drawing.pattern);
        for (std::size_t i = 0; i < std::min(pattern.paths.size(), drawing.pattern.paths.size()); ++i) {
            const std::uint32_t a = pattern.paths[i].perturbation, b = drawing.pattern.paths[i].perturbation;
            ASSERT_EQ(a == kNoPerturbation, b == kNoPerturbation);
            if (a == kNoPerturbation) continue;
            EXPECT_EQ(pattern.perturbations[a].width, drawing.pattern.perturbations[b].width);
            EXPECT_EQ(pattern.perturbations[a].seed, pattern.perturbations[a].kind == PerturbationKind::noise ? drawing.pattern.perturbations[b].seed : pattern.perturbations[a].seed);
        }
    }
}

TEST(SvgRead, MovedOwnPathsTakeTheirWidthsAlong) {
    Pattern pattern = random_pattern(3);
    std::string text = write_svg(pattern);
    const std::string id = "id=\"path-0\"";
    text.replace(text.find(id), id.size(), id + " transform=\"translate(0.01 0.02) scale(2)\"");
    const SvgDrawing drawing = read(text);
    const Element &before = pattern.paths[0].elements[0], &after = drawing.pattern.paths[0].elements[0];
    EXPECT_NEAR(after.p0.x, 2.0 * before.p0.x + 0.01, 1e-12);
    EXPECT_NEAR(after.p0.y, 2.0 * before.p0.y + 0.02, 1e-12);
    EXPECT_NEAR(after.width0, 2.0 * before.width0, 1e-12);
    for (std::size_t i = 1; i < pattern.paths.size(); ++i) expect_equal(pattern.paths[i], drawing.pattern.paths[i]);
}

TEST(SvgRead, PageSizesAndUnits) {
    EXPECT_NEAR(length(read(page("")).pattern.size - Vec2{100 * kMm, 80 * kMm}), 0.0, 1e-15);
    const auto sized = [](const std::string& attributes, const SvgOptions& options = {}) {
        return read("<svg xmlns='http://www.w3.org/2000/svg' " + attributes + "/>", options).pattern.size;
    };
    EXPECT_NEAR(sized("width='96' height='48'").x, 0.0254, 1e-15);
    EXPECT_NEAR(sized("viewBox='0 0 96 48'").y, 0.0127, 1e-15);
    EXPECT_NEAR(sized("width='100%' height='100%' viewBox='5 5 96 48'").y, 0.0127, 1e-15);
    EXPECT_NEAR(sized("width='2in' viewBox='0 0 4 1'").y, 0.0127, 1e-15);
    EXPECT_NEAR(sized("width='72pt' height='6pc'").x, 0.0254, 1e-15);
    SvgOptions wide;
    wide.width = 0.5;
    EXPECT_NEAR(sized("viewBox='0 0 96 48'", wide).y, 0.25, 1e-15);
    wide.height = 0.3;
    EXPECT_NE(error_of("<svg viewBox='0 0 96 48'/>", wide).find("would stretch"), std::string::npos);
}

TEST(SvgRead, StrokesAreGroovesAsWideAsTheyAre) {
    const SvgDrawing drawing = read(page("<path d='M10 10H60' stroke='#000' stroke-width='4'/>"));
    ASSERT_EQ(drawing.pattern.paths.size(), 1u);
    EXPECT_NEAR(width_of(drawing.pattern, drawing.pattern.paths[0], 1.0), 4 * kMm, 1e-15);
    EXPECT_EQ(drawing.pattern.paths[0].start_cap, CapKind::butt);
    const Truth truth = truth_of(drawing.pattern);
    EXPECT_NEAR(truth.surface_at({30 * kMm, 10 * kMm}).height, -2 * kMm, 1e-12);
    EXPECT_NEAR(truth.surface_at({30 * kMm, 11 * kMm}).height, -1 * kMm, 1e-12);
    EXPECT_EQ(truth.surface_at({30 * kMm, 12.1 * kMm}).height, 0.0);
    EXPECT_EQ(drawing.sources[0], "line 2, path");
}

TEST(SvgRead, UnevenTransformsMakeUnevenWidths) {
    // A circle's stroke, pulled apart along x: wide where it runs along y.
    const SvgDrawing drawing = read(page("<circle r='5' fill='none' stroke='#000' stroke-width='2' transform='translate(50 40) scale(3 1)'/>"));
    const Path& path = drawing.pattern.paths.at(0);
    for (const Element& e : path.elements) {
        const double x = (e.p0.x / kMm - 50.0) / 15.0, y = (e.p0.y / kMm - 40.0) / 5.0;
        const double width = width_of(drawing.pattern, path, e.width0);
        if (std::abs(x) > 0.999) { EXPECT_NEAR(width, 6 * kMm, 1e-6 * kMm); }
        if (std::abs(y) > 0.999) { EXPECT_NEAR(width, 2 * kMm, 1e-6 * kMm); }
    }
}

TEST(SvgRead, StylesCascade) {
    const SvgDrawing drawing = read(page(
        "<style>/* all */ path { stroke: red; stroke-width: 1 } .wide { stroke-width: 2 } g > .wide { stroke-width: 3 }"
        " #one { stroke-width: 5 } .late.wide { stroke-width: 4 !important } @media print { path { stroke: none } } path:hover { stroke: none }</style>"
        "<path d='M1 1h9'/><path class='wide' d='M1 5h9'/><g><path class='wide' d='M1 10h9'/></g><path id='one' class='wide' d='M1 20h9'/>"
        "<path id='one' class='wide late' style='stroke-width:9' d='M1 30h9'/><path d='M1 40h9' style='stroke-width:6;stroke:none'/>"
        "<g stroke-width='7' style='stroke:blue'><line x1='1' y1='50' x2='9' y2='50' style='stroke-width:inherit'/></g>"));
    std::vector<double> widths;
    for (const Path& path : drawing.pattern.paths) widths.push_back(std::round(width_of(drawing.pattern, path, 1.0) / kMm));
    EXPECT_EQ(widths, (std::vector<double>{1, 2, 3, 5, 4, 7}));
    ASSERT_EQ(drawing.notes.size(), 2u);
    EXPECT_NE(drawing.notes[1].find("path:hover"), std::string::npos);
}

TEST(SvgRead, UsesSymbolsAndNestedDrawings) {
    const SvgDrawing drawing = read(page(
        "<defs><path id='a' d='M0 0h4' stroke='#000'/><symbol id='s' viewBox='0 0 10 10'><path d='M0 5h10' stroke='#000'/></symbol></defs>"
        "<use href='#a' x='10' y='10'/><g transform='rotate(90 50 40)'><use xlink:href='#a' transform='scale(2)'/></g>"
        "<use href='#s' x='20' y='20' width='40' height='20'/><svg x='50' y='50' width='10' height='10' viewBox='0 0 100 100'><path d='M0 0h100' stroke='#000'/></svg>"));
    ASSERT_EQ(drawing.pattern.paths.size(), 4u);
    const auto begin = [&](std::size_t i) { return drawing.pattern.paths[i].elements[0].p0 * (1.0 / kMm); };
    const auto end = [&](std::size_t i) { return drawing.pattern.paths[i].elements[0].p2 * (1.0 / kMm); };
    EXPECT_NEAR(length(begin(0) - Vec2{10, 10}), 0.0, 1e-9);
    EXPECT_NEAR(length(begin(1) - Vec2{90, -10}), 0.0, 1e-9);
    EXPECT_NEAR(length(end(1) - Vec2{90, -2}), 0.0, 1e-9);
    EXPECT_NEAR(length(begin(2) - Vec2{30, 30}), 0.0, 1e-9);  // fitted into 40 x 20, in the middle
    EXPECT_NEAR(length(end(2) - Vec2{50, 30}), 0.0, 1e-9);
    EXPECT_NEAR(length(end(3) - Vec2{60, 50}), 0.0, 1e-9);
}

TEST(SvgRead, DashesCapsAndDots) {
    const SvgDrawing drawing = read(page("<path d='M10 10h20' stroke='#000' stroke-width='2' stroke-dasharray='4,2 1' stroke-dashoffset='1'/>"
                                         "<path d='M10 30h20' stroke='#000' stroke-width='2' stroke-linecap='square'/>"
                                         "<path d='M50 50z' stroke='#000' stroke-width='3' stroke-linecap='round'/><path d='M60 50z' stroke='#000'/>"));
    std::vector<std::pair<double, double>> spans;
    for (const Path& path : drawing.pattern.paths)
        spans.emplace_back(std::round(path.elements.front().p0.x / kMm * 1e6) / 1e6, std::round(path.elements.back().p2.x / kMm * 1e6) / 1e6);
    // 4 on, 2 off, 1 on, 4 off, 2 on, 1 off, from 1 on.
    EXPECT_EQ(spans[0], (std::pair{10.0, 13.0}));
    EXPECT_EQ(spans[1], (std::pair{15.0, 16.0}));
    EXPECT_EQ(spans[2], (std::pair{20.0, 22.0}));
    EXPECT_EQ(spans[3], (std::pair{23.0, 27.0}));
    EXPECT_EQ(spans[4], (std::pair{29.0, 30.0}));
    EXPECT_EQ(spans[5], (std::pair{9.0, 31.0}));
    ASSERT_EQ(spans.size(), 7u);
    EXPECT_NEAR(truth_of(drawing.pattern).surface_at({50 * kMm, 50 * kMm}).height, -1.5 * kMm, 0.02 * kMm);
    EXPECT_NEAR(truth_of(drawing.pattern).surface_at({50 * kMm, 51 * kMm}).height, -0.5 * kMm, 0.02 * kMm);
}

TEST(SvgRead, MeaningsByAttributeLayerClassColourAndRule) {
    SvgOptions options;
    options.fill = "sunken 1mm";
    options.rules = {{"special", "plateau 4mm"}, {"#0f0", "ridge vee 3mm"}};
    const SvgDrawing drawing = read(page(
        "<rect width='5' height='5'/>"
        "<g inkscape:groupmode='layer' inkscape:label='plateau 2mm'><rect x='10' width='5' height='5'/><rect x='20' width='5' height='5' data-burin-fill='sunken 3mm'/></g>"
        "<rect class='special' x='30' width='5' height='5'/><rect class='plateau' x='40' width='5' height='5'/><path d='M50 1v9' stroke='lime' style='stroke:#00ff00'/>"
        "<g data-burin-fill='none'><rect x='60' width='5' height='5'/></g>"), options);
    const Truth truth = truth_of(drawing.pattern);
    const auto height = [&](double x) { return truth.surface_at({x * kMm, 3 * kMm}).height / kMm; };
    EXPECT_NEAR(height(2.5), -1.0, 1e-9);
    EXPECT_NEAR(height(12.5), 2.0, 1e-9);
    EXPECT_NEAR(height(22.5), -3.0, 1e-9);
    EXPECT_NEAR(height(32.5), 4.0, 1e-9);
    EXPECT_NEAR(height(42.5), 0.4, 1e-9);  // 1/200 of the shorter side
    EXPECT_NEAR(height(50.0), 3.0, 1e-9);
    EXPECT_NEAR(height(62.5), 0.0, 1e-9);
    EXPECT_NEAR(drawing.pattern.base_offset, 7 * kMm, 1e-12);  // a ridge on the highest plateau
}

TEST(SvgRead, LaterFillsCoverEarlierOnes) {
    const SvgDrawing drawing = read(page(
        "<path d='M10 10h40v40h-40z' data-burin-fill='plateau 4mm'/><circle cx='30' cy='30' r='10' data-burin-fill='sunken 2mm'/>"
        "<path d='M30 0h40v30h-40z' data-burin-fill='plateau 1mm'/><path d='M0 45h100v10h-100z M20 47h10v6h-10z' fill-rule='evenodd' data-burin-fill='ground'/>"
        "<path d='M60 20l20 0 0 20z' data-burin-fill='plateau 1mm'/>"));
    const Truth truth = truth_of(drawing.pattern);
    const auto ground = [&](double x, double y) { return truth.ground_at({x * kMm, y * kMm}) / kMm; };
    EXPECT_NEAR(ground(12, 12), 4, 1e-3);
    EXPECT_NEAR(ground(25, 30), -2, 1e-3);
    EXPECT_NEAR(ground(32, 28), 1, 1e-3);
    EXPECT_NEAR(ground(48, 48), 0, 1e-3);
    EXPECT_NEAR(ground(25, 49), 4, 1e-3);  // in the hole of what covers it
    EXPECT_NEAR(ground(65, 22), 1, 1e-3);
    EXPECT_NEAR(ground(75, 28), 1, 1e-3);
    EXPECT_NEAR(ground(90, 70), 0, 1e-3);
}

TEST(SvgRead, StrokedFillsAreStepsWithTheStrokesSection) {
    const SvgDrawing drawing = read(page("<rect x='20' y='20' width='30' height='20' data-burin-fill='plateau 3mm' stroke='#000' stroke-width='4'/>"));
    ASSERT_EQ(drawing.pattern.paths.size(), 1u);
    const Truth truth = truth_of(drawing.pattern);
    const auto height = [&](double x) { return truth.surface_at({x * kMm, 30 * kMm}).height / kMm; };
    EXPECT_NEAR(height(10), 0.0, 1e-9);
    EXPECT_NEAR(height(19), -1.0, 1e-9);
    EXPECT_NEAR(height(21), 2.0, 1e-9);
    EXPECT_NEAR(height(30), 3.0, 1e-9);
}

TEST(SvgRead, WhatIsNotReadIsListed) {
    const SvgDrawing drawing = read(page("<text>a</text><text>b</text><image href='x.png'/><rect width='5' height='5' clip-path='url(#c)'/><blob/>"
                                         "<path d='M1 1 L2 2 q' stroke='#000'/><rect width='9' height='9' fill='#fff'/>"));
    ASSERT_EQ(drawing.notes.size(), 6u);
    EXPECT_NE(drawing.notes[0].find("2 times"), std::string::npos);
    EXPECT_NE(drawing.notes[0].find("line 2"), std::string::npos);
    EXPECT_NE(drawing.notes[5].find("white fill"), std::string::npos);
}

TEST(SvgRead, ErrorsNameLineElementAndValue) {
    const auto says = [](const std::string& content, std::initializer_list<const char*> parts) {
        const std::string message = error_of(page(content));
        for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
    };
    says("\n<g transform='scael(2)'><path id='p' d='M0 0h9'/></g>", {"line 3", "'scael(2)'"});
    says("<use href='#nothing'/>", {"line 2", "'nothing'"});
    says("<g><g id='a'><use href='#a'/></g></g>", {"nested more than"});
    says("<path id='p' d='M0 0h9' stroke='red' stroke-width='thick'/>", {"path 'p'", "'thick'"});
    says("<path d='M0 0h9' stroke='red' stroke-dasharray='1 -1'/>", {"'1 -1'"});
    says("<polygon points='1 2 3'/>", {"'1 2 3'"});
    says("<path d='M0 0h9' stroke='red' data-burin-stroke='groove deep'/>", {"'groove deep'", "vee 0.5mm"});
    says("<path d='M0 0h9e30' stroke='red'/>", {"far from any page"});
    EXPECT_NE(error_of("<svg><g></svg>").find("line 1: not well-formed"), std::string::npos);
    EXPECT_NE(error_of("<html/>").find("'html'"), std::string::npos);
    EXPECT_NE(error_of("<svg width='-50'/>").find("'-50'"), std::string::npos);
    EXPECT_NE(error_of("<svg viewBox='0 0 0 5'/>").find("'0 0 0 5'"), std::string::npos);
    SvgOptions options;
    options.stroke = "plateau";
    EXPECT_NE(error_of(page(""), options).find("strokes are groove"), std::string::npos);
}

// Each use doubles what the one before it holds.
TEST(SvgRead, UsesThatMultiplyAreStopped) {
    std::string content = "<defs><path id='u0' d='M0 0h1' stroke='red'/>";
    for (int i = 1; i < 40; ++i)
        content += "<g id='u" + std::to_string(i) + "'><use href='#u" + std::to_string(i - 1) + "'/><use href='#u" + std::to_string(i - 1) + "'/></g>";
    EXPECT_NE(error_of(page(content + "</defs><use href='#u39'/>")).find("262144 uses"), std::string::npos);
}

}  // namespace
}  // namespace burin::testing
