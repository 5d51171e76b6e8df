// Two patterns that are to be the same, bit by bit, but for the unused control points of lines.
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
        for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(a.materials[i].base_color[c], b.materials[i].base_color[c]);
        EXPECT_EQ(a.materials[i].metallic, b.materials[i].metallic);
        EXPECT_EQ(a.materials[i].roughness, b.materials[i].roughness);
    }
    ASSERT_EQ(a.paths.size(), b.paths.size());
    for (std::size_t i = 0; i < a.paths.size(); ++i) expect_equal(a.paths[i], b.paths[i]);
}

}  // namespace burin::testing
