// Two patterns that are to be the same, bit by bit, but for what has no meaning: control points of lines, parameters that the kind of a
// perturbation does not use, colours of materials that override nothing, and the order in which perturbations are listed.
#pragma once

#include <gtest/gtest.h>

#include <burin/pattern.hpp>

namespace burin::testing {

inline void expect_equal(const Element& a, const Element& b) {
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_TRUE(a.p0 == b.p0 && a.p2 == b.p2);
    if (a.kind == ElementKind::quadratic) { EXPECT_TRUE(a.p1 == b.p1); }
    EXPECT_EQ(a.width0, b.width0);
    EXPECT_EQ(a.width1, b.width1);
    EXPECT_EQ(a.height0, b.height0);
    EXPECT_EQ(a.height1, b.height1);
}

inline void expect_equal(const Path& a, const Path& b) {
    ASSERT_EQ(a.elements.size(), b.elements.size());
    for (std::size_t i = 0; i < a.elements.size(); ++i) expect_equal(a.elements[i], b.elements[i]);
    EXPECT_EQ(a.closed, b.closed);
    EXPECT_EQ(a.profile, b.profile);
    EXPECT_EQ(a.material, b.material);
    EXPECT_EQ(a.level, b.level);
    EXPECT_EQ(a.join, b.join);
    EXPECT_EQ(a.start_cap, b.start_cap);
    EXPECT_EQ(a.end_cap, b.end_cap);
}

inline void expect_equal(const Profile& a, const Profile& b) {
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i)
        EXPECT_TRUE(a.points[i].b == b.points[i].b && a.points[i].h == b.points[i].h);
    EXPECT_EQ(a.facets, b.facets);
}

inline void expect_equal(const Perturbation& a, const Perturbation& b) {
    ASSERT_EQ(a.kind, b.kind);
    if (a.kind == PerturbationKind::polynomial) {
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(a.width_polynomial[i], b.width_polynomial[i]);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(a.height_polynomial[i], b.height_polynomial[i]);
        return;
    }
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.wavelength, b.wavelength);
    if (a.kind == PerturbationKind::sine) { EXPECT_EQ(a.phase, b.phase); }
    if (a.kind == PerturbationKind::noise) { EXPECT_EQ(a.seed, b.seed); }
    if (a.kind == PerturbationKind::noise) { EXPECT_EQ(a.octaves, b.octaves); }
}

inline void expect_equal(const Pattern& a, const Pattern& b) {
    EXPECT_TRUE(a.size == b.size);
    EXPECT_EQ(a.depth, b.depth);
    EXPECT_EQ(a.base_offset, b.base_offset);
    EXPECT_EQ(a.outer_level, b.outer_level);
    EXPECT_EQ(a.wrap, b.wrap);
    ASSERT_EQ(a.profiles.size(), b.profiles.size());
    for (std::size_t i = 0; i < a.profiles.size(); ++i) expect_equal(a.profiles[i], b.profiles[i]);
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) {
        EXPECT_EQ(a.materials[i].overrides, b.materials[i].overrides);
        if (!a.materials[i].overrides) continue;
        for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(a.materials[i].base_color[c], b.materials[i].base_color[c]);
        EXPECT_EQ(a.materials[i].metallic, b.materials[i].metallic);
        EXPECT_EQ(a.materials[i].roughness, b.materials[i].roughness);
    }
    ASSERT_EQ(a.paths.size(), b.paths.size());
    for (std::size_t i = 0; i < a.paths.size(); ++i) {
        expect_equal(a.paths[i], b.paths[i]);
        const bool perturbed = a.paths[i].perturbation != kNoPerturbation;
        ASSERT_EQ(perturbed, b.paths[i].perturbation != kNoPerturbation);
        if (perturbed) expect_equal(a.perturbations[a.paths[i].perturbation], b.perturbations[b.paths[i].perturbation]);
    }
}

}  // namespace burin::testing
