// Every rival draws a simple groove as the truth does, given a large map: a weak rival would prove nothing.
#include <cmath>

#include <gtest/gtest.h>

#include <rivals/exact_geometry.hpp>
#include <rivals/furnished.hpp>

#include "../../samples/scenes/build.hpp"
#include "../judge/context.hpp"

namespace burin::rivals {
namespace {

// One shallow groove across a tile.
scenes::Scene groove_scene(double deep) {
    Pattern pattern = scenes::sheet({0.1, 0.1}, deep, 0.0);
    pattern.profiles = {scenes::vee(0.02, deep * 0.9)};
    pattern.paths = {scenes::polyline({{0.05, 0.0}, {0.05, 0.1}}).path(0)};
    return scenes::on_plane(std::move(pattern), {0.6f, 0.5f, 0.4f}, 0.0f, 0.5f);
}

bench::Subject groove(double deep) { return *bench::prepare_subject("groove", groove_scene(deep)); }

bench::PlaneView view_of(const bench::Subject& subject, double elevation, double light) {
    bench::PlaneView view = bench::standard_views(subject, 64, 48)[1];
    view.elevation = elevation;
    view.light.elevation = light;
    return view;
}

RivalSettings settings_of(Technique technique, const Stage& stage) {
    RivalSettings settings;
    settings.technique = technique;
    settings.size = 1024;
    settings.samples = 16;
    settings.steps = 64;
    settings.refinements = 8;
    settings.bias = -1.0f;
    settings.wide_heights = true;
    settings.edge = 0.5 * stage.pixel_in_uv();
    return settings;
}

double decibels_of(Technique technique, const bench::Subject& subject, const bench::PlaneView& view, const gl::Context& context) {
    SceneMaps maps(context, subject, 1024, "");
    Stage stage(context, subject, maps, view, "");
    const auto draw = stage.rival(settings_of(technique, stage));
    EXPECT_TRUE(bool(draw)) << draw.error().message;
    return stage.measure(*draw).decibels;
}

TEST(Rivals, DrawAGrooveWithItsShadow) {
    const auto context = gl::open_context(testing::backend());
    SKIP_WITHOUT_CONTEXT(context);
    const bench::Subject subject = groove(0.008);
    for (const Technique technique : {Technique::parallax, Technique::relief, Technique::cones, Technique::triangles}) {
        const double least = technique == Technique::triangles ? 30.0 : 40.0;
        EXPECT_GE(decibels_of(technique, subject, view_of(subject, 45.0, 35.0), **context), least) << name_of(technique);
    }
}

TEST(Rivals, NormalsSufficeStraightOn) {
    const auto context = gl::open_context(testing::backend());
    SKIP_WITHOUT_CONTEXT(context);
    const bench::Subject subject = groove(0.002);
    EXPECT_GE(decibels_of(Technique::normals, subject, view_of(subject, 89.0, 70.0), **context), 40.0);
}

TEST(Rivals, DrawTheSameInALoopAndInPasses) {
    const auto context = gl::open_context(testing::backend());
    SKIP_WITHOUT_CONTEXT(context);
    const bench::Subject subject = groove(0.008);
    SceneMaps maps(**context, subject, 1024, "");
    Stage stage(**context, subject, maps, view_of(subject, 45.0, 35.0), "");
    RivalSettings settings = settings_of(Technique::relief, stage);
    const double loop = stage.measure(*stage.rival(settings)).decibels;
    settings.passes = true;
    EXPECT_NEAR(stage.measure(*stage.rival(settings)).decibels, loop, 1.0);
}

TEST(ExactGeometry, DrawsAGrooveWithItsShadow) {
    const auto context = gl::open_context(testing::backend());
    SKIP_WITHOUT_CONTEXT(context);
    const bench::Subject subject = groove(0.008);
    const auto grid = build_grid(subject.prepared.resolved);
    const auto tile = mesh::mesh_pattern(subject.prepared.resolved, *grid);
    ASSERT_TRUE(bool(tile)) << tile.error().message;
    SceneMaps maps(**context, subject, 64, "");
    Stage stage(**context, subject, maps, view_of(subject, 45.0, 35.0), "");
    const auto decibels = [&](const GeometrySettings& settings) {
        auto geometry = ExactGeometry::load(**context, subject, *tile, stage, settings);
        EXPECT_TRUE(bool(geometry)) << geometry.error().message;
        return stage.measure([&] { return geometry->draw(); }).decibels;
    };
    const double many = decibels({.passes = 16, .shadow_texels = 2048}), one = decibels({.shadow_texels = 2048});
    EXPECT_GE(many, 45.0);
    EXPECT_GE(many, one + 6.0);
    EXPECT_GE(decibels({.coverage = true, .shadow_texels = 2048}), one + 3.0);
}

// Two parts of unlike colour and relief side by side, each with maps of its own.
TEST(FurnishedScene, DrawsEveryPartAsBurinDoes) {
    const auto context = gl::open_context(testing::backend());
    SKIP_WITHOUT_CONTEXT(context);
    scenes::Scene scene = groove_scene(0.008);
    scenes::Part other = groove_scene(0.004).parts[0];
    scene.parts[0].name = "deep";
    other.name = "shallow";
    other.color = {0.2f, 0.4f, 0.7f};
    for (std::size_t i = 0; i < other.mesh.positions.size(); i += 3) other.mesh.positions[i] += 0.1f;
    scene.parts.push_back(std::move(other));
    auto opened = bench::open_scene(scene);
    ASSERT_TRUE(bool(opened)) << opened.error().message;
    RenderOptions& options = opened->options;
    options.width = 96;
    options.height = 64;
    auto furnished = FurnishedScene::prepare(**context, scene, opened->asset, options, 512, "");
    ASSERT_TRUE(bool(furnished)) << furnished.error().message;
    RivalSettings settings;
    settings.technique = Technique::relief;
    settings.size = 512;
    settings.samples = 16;
    settings.bias = -1.0f;
    settings.wide_heights = true;
    const auto rival = furnished->draw(settings, true);
    const auto own = prepare_burin(**context, opened->asset, options);
    ASSERT_TRUE(bool(rival) && bool(own));
    const RgbaImage a = (*rival)().image(), b = (*own)().image();
    double squares = 0.0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) squares += std::pow((int(a.texels[i]) - int(b.texels[i])) / 255.0, 2.0);
    EXPECT_GE(-10.0 * std::log10(squares / double(a.texels.size())), 35.0);
    EXPECT_NEAR(furnished->bytes_of(settings).plain, 2 * 4.0 / 3.0 * 4.0 * 512 * 512, 100.0);
}

TEST(TuneRival, GivesUpWhatCostsNothing) {
    const auto decibels = [](const RivalSettings& settings) {
        return 40.0 - std::abs(double(settings.bias) + 2.0) - (settings.steps < 16 ? 1.0 : 0.0) - (settings.size < 512 ? 3.0 : 0.0) -
               (settings.refinements < 4 ? 0.06 : 0.0) - (settings.wide_heights ? 0.0 : 0.04);
    };
    const RivalSettings tuned = tune_rival({.size = 2048, .samples = 4, .steps = 64, .refinements = 8, .wide_heights = true}, decibels);
    EXPECT_EQ(tuned.bias, -2.0f);
    EXPECT_EQ(tuned.steps, 16);
    EXPECT_EQ(tuned.size, 512);
    EXPECT_EQ(tuned.refinements, 4);
    EXPECT_FALSE(tuned.wide_heights);
}

}  // namespace
}  // namespace burin::rivals
