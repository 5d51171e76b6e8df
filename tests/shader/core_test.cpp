// The decoder against the truth: the core text as C++, and the same text as GLSL on OSMesa.
#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include "patterns.hpp"
#include "rays.hpp"

namespace burin::testing {
namespace {

constexpr std::uint64_t kSeed = 20100705;

// Rays per pattern: 10^5 in the full measurement, fewer where every run of the tests pays for it.
int ray_count() {
    const char* asked = std::getenv("BURIN_RAYS");
    return asked != nullptr ? std::atoi(asked) : 20000;
}

void expect_agreement(const Agreement& agreement, const std::string& name) {
    std::cout << agreement.report(name) << std::flush;
    for (RayKind kind : {RayKind::feature, RayKind::junction, RayKind::anywhere}) {
        const std::size_t k = std::size_t(kind);
        EXPECT_GE(agreement.facet_share(kind), 0.999) << name << ", seed " << kSeed << "\n" << agreement.worst;
        EXPECT_LE(agreement.height_differs[k], agreement.rays[k] / 1000) << name << "\n" << agreement.worst;
        // The rule about borders must not excuse what it is not for.
        EXPECT_LE(agreement.borders[k], agreement.rays[k] / 200) << name;
        EXPECT_LE(agreement.sheets[k], agreement.rays[k] / 200) << name;
    }
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
    std::vector<PatternRay> bare;
    for (const AimedRay& ray : rays) bare.push_back(ray.ray);
    const char* backend = std::getenv("BURIN_BACKEND");
    const bool egl = backend != nullptr && std::string(backend) == "egl";
    auto hits = shade_rays(pattern.textures, pattern.detail, bare, egl ? Backend::egl : Backend::osmesa);
    if (!hits && hits.error().code == ErrorCode::unavailable) GTEST_SKIP() << "SKIPPED: " << hits.error().message;
    ASSERT_TRUE(hits.ok()) << hits.error().message;
    expect_agreement(judge(pattern, rays, *hits), GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(Authored, CoreTest, ::testing::ValuesIn(authored_patterns()),
                         [](const auto& named) { return named.param.name; });

}  // namespace
}  // namespace burin::testing
