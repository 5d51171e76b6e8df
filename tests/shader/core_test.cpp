// The decoder against the truth: the core text as C++, and the same text as GLSL on OSMesa.
#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include <cpp/decode.hpp>

#include "../judge/context.hpp"
#include "../property/perturbed.hpp"
#include "../property/random_pattern.hpp"
#include "../property/wide_pattern.hpp"
#include "patterns.hpp"
#include "rays.hpp"

namespace burin::testing {
namespace {

constexpr std::uint64_t kSeed = 20100705;

// Rays per pattern: 10^5 in the full measurement, fewer where every run of the tests pays for it.
int ray_count() {
    const char* asked = std::getenv("BURIN_RAYS");
    return asked != nullptr ? std::atoi(asked) : 10000;
}

void expect_agreement(const Agreement& agreement, const std::string& name) {
    std::cout << agreement.report(name) << std::flush;
    for (RayKind kind : {RayKind::feature, RayKind::junction, RayKind::anywhere}) {
        const std::size_t k = std::size_t(kind);
        EXPECT_GE(agreement.facet_share(kind), 0.999) << name << ", seed " << kSeed << "\n"
                                                      << agreement.worst;
        EXPECT_LE(agreement.height_differs[k], agreement.rays[k] / 1000) << name << "\n" << agreement.worst;
        // The rule about borders must not excuse what it is not for.
        EXPECT_LE(agreement.borders[k], agreement.rays[k] / 200) << name;
        EXPECT_LE(agreement.sheets[k], agreement.rays[k] / 200) << name;
    }
}

Result<std::vector<ShadedHit>> shade(const PreparedPattern& pattern, const std::vector<AimedRay>& rays) {
    std::vector<PatternRay> bare;
    for (const AimedRay& ray : rays) bare.push_back(ray.ray);
    return shade_rays(pattern.textures, pattern.detail, bare, backend());
}

TEST(CorePatterns, WheelHasSixteenFeaturesInACell) {
    const PreparedPattern pattern = prepare(wheel_pattern());
    std::uint32_t most = 0;
    for (std::uint32_t i = 0; i < pattern.textures.grid.size() / 2; ++i)
        most = std::max(most, std::uint32_t(unpack_cell(cell_texel(pattern.textures, i)).count));
    EXPECT_GE(most, 16u);
}

class CoreTest : public ::testing::TestWithParam<NamedPattern> {};

TEST_P(CoreTest, DecoderAgreesWithTruth) {
    const PreparedPattern pattern = prepare(GetParam().pattern);
    ASSERT_FALSE(pattern.textures.data.empty());
    const std::vector<AimedRay> rays = aim_rays(pattern, ray_count(), kSeed);
    expect_agreement(judge(pattern, rays, decode_rays(pattern, rays)), GetParam().name);
}

TEST_P(CoreTest, ShaderAgreesWithTruth) {
    const PreparedPattern pattern = prepare(GetParam().pattern);
    ASSERT_FALSE(pattern.textures.data.empty());
    const std::vector<AimedRay> rays = aim_rays(pattern, ray_count(), kSeed);
    const auto hits = shade(pattern, rays);
    SKIP_WITHOUT_CONTEXT(hits);
    expect_agreement(judge(pattern, rays, *hits), GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(Authored, CoreTest, ::testing::ValuesIn(authored_patterns()),
                         [](const auto& named) { return named.param.name; });

// Steps exactly through the centres of cells, where the side that a centre lies on would be rounding.
TEST(DecoderTest, StepsThroughCellCentres) {
    const std::vector<NamedPattern> patterns = {
        {"stripes", stripes_pattern()}, {"diamonds", diamonds_pattern()}, {"checker", checker_pattern()}};
    for (const NamedPattern& named : patterns) {
        const PreparedPattern pattern = prepare(named.pattern, {.cell_size = 0.1});
        ASSERT_EQ(pattern.textures.grid_width, 10) << named.name;
        const std::vector<AimedRay> rays = aim_rays(pattern, ray_count(), kSeed);
        expect_agreement(judge(pattern, rays, decode_rays(pattern, rays)), named.name);
        const auto hits = shade(pattern, rays);
        SKIP_WITHOUT_CONTEXT(hits);
        expect_agreement(judge(pattern, rays, *hits), named.name + " as shader");
    }
}

// Rays that fall to the lowest point there is, on bare ground, after some cells.
TEST(DecoderTest, GroundAtTheLowestPointIsMet) {
    const PreparedPattern pattern = prepare(floor_pattern(), {.cell_size = 0.1});
    const Decoder decoder(pattern.textures, pattern.detail);
    Random random(kSeed);
    for (int i = 0; i < 1000; ++i) {
        const Vec2 slope = random.direction() * random.between(0, 20);
        const Vec2 foot{random.between(0.65, 1.05), random.between(0.1, 0.55)};
        const DecodedHit hit = decoder.trace(foot - slope * kDepth, slope);
        if (hit.drop < 0.999 * kDepth) continue;  // a wall stood before
        ASSERT_TRUE(hit.met) << foot.x << ", " << foot.y;
        ASSERT_GT(hit.normal[2], 0.9999) << foot.x << ", " << foot.y << ", slope " << length(slope);
    }
}

// Knots, hairpins, near-parallel lines, steps in steps: what nobody would author.
class RandomCoreTest : public ::testing::TestWithParam<int> {};

TEST_P(RandomCoreTest, DecoderAndShaderAgreeWithTruth) {
    const std::uint64_t seed = std::uint64_t(GetParam());
    RandomPatternOptions options;
    options.wrap = GetParam() % 4 == 3 ? Wrap::clamp : Wrap::repeat;
    const bool perturbed = GetParam() >= 8;
    const PreparedPattern pattern = prepare(perturbed ? perturbed_pattern(seed, options) : random_pattern(seed, options));
    ASSERT_FALSE(pattern.textures.data.empty());
    const std::vector<AimedRay> rays = aim_rays(pattern, ray_count(), seed);
    expect_agreement(judge(pattern, rays, decode_rays(pattern, rays)), "random " + std::to_string(seed));
    if (GetParam() % 3 != 0) return;
    const auto hits = shade(pattern, rays);
    SKIP_WITHOUT_CONTEXT(hits);
    expect_agreement(judge(pattern, rays, *hits), "random " + std::to_string(seed) + " as shader");
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomCoreTest, ::testing::Range(0, 14));

// References of 32 bits, in lists that begin on texels.
TEST(WideTest, DecoderAndShaderAgreeWithTruth) {
    const PreparedPattern pattern = prepare(wide_pattern(kSeed));
    ASSERT_TRUE(pattern.textures.sections.wide());
    const std::vector<AimedRay> rays = aim_rays(pattern, ray_count() / 10, kSeed);
    expect_agreement(judge(pattern, rays, decode_rays(pattern, rays)), "wide");
    const auto hits = shade(pattern, rays);
    SKIP_WITHOUT_CONTEXT(hits);
    expect_agreement(judge(pattern, rays, *hits), "wide as shader");
}

// Textures of noise: some answer within the relief, no access out of bounds, no endless loop.
TEST(DecoderTest, AnswersOnDamagedTextures) {
    Random random(kSeed);
    for (int k = 0; k < 300; ++k) {
        PackedTextures textures;
        textures.grid_width = 1 + random.below(9);
        textures.grid_height = 1 + random.below(9);
        textures.grid.resize(2 * std::size_t(textures.grid_width * textures.grid_height));
        textures.data_width = 1 + random.below(20);
        textures.data_height = 1 + random.below(20);
        textures.data.resize(4 * std::size_t(textures.data_width * textures.data_height));
        for (std::uint32_t& word : textures.grid) word = std::uint32_t(random.bits());
        for (std::uint32_t& word : textures.data) word = std::uint32_t(random.bits());
        textures.sections = {5, 3, 4, 1, 5};
        if (k % 5 == 4) textures.sections.element_texels += BURIN_MAX_NARROW_ELEMENT_TEXELS;  // styles and lists behind the texture's end
        PathDetail detail;
        detail.size_v = 2.0;
        detail.repeat = k % 2 == 0;
        const Decoder decoder(textures, detail);
        for (int i = 0; i < 40; ++i) {
            const Vec2 origin{random.between(-1, 2), random.between(-1, 2)};
            const DecodedHit hit = decoder.trace(origin, random.direction() * random.between(0, 20));
            EXPECT_TRUE(hit.drop >= 0.0 && hit.drop <= detail.depth * 1.001) << hit.drop << ", round " << k;
        }
    }
}

}  // namespace
}  // namespace burin::testing
