// Every rival draws a simple groove as the truth does, given a large map: a weak rival would prove nothing.
#include <gtest/gtest.h>

#include <rivals/stage.hpp>

#include "../../samples/scenes/build.hpp"
#include "../judge/context.hpp"

namespace burin::rivals {
namespace {

// One shallow groove across a tile.
bench::Subject groove(double deep) {
    Pattern pattern = scenes::sheet({0.1, 0.1}, deep, 0.0);
    pattern.profiles = {scenes::vee(0.02, deep * 0.9)};
    pattern.paths = {scenes::polyline({{0.05, 0.0}, {0.05, 0.1}}).path(0)};
    return *bench::prepare_subject("groove", scenes::on_plane(std::move(pattern), {0.6f, 0.5f, 0.4f}, 0.0f, 0.5f));
}

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

}  // namespace
}  // namespace burin::rivals
