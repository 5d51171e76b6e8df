// A pattern through all stages, for tests that cannot go on without it.
#pragma once

#include <gtest/gtest.h>

#include "../judge/judge.hpp"

namespace burin::testing {

// Fails the running test when a stage fails.
inline PreparedPattern prepare(const Pattern& pattern, const GridOptions& options = {}) {
    auto prepared = prepare_pattern(pattern, options);
    EXPECT_TRUE(prepared.ok()) << (prepared ? "" : prepared.error().message);
    return prepared ? std::move(*prepared) : PreparedPattern{};
}

}  // namespace burin::testing
