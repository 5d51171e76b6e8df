// The OpenGL context that tests draw with.
#pragma once

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include <gl/render.hpp>

namespace burin::testing {

// OSMesa; EGL where the environment says BURIN_BACKEND=egl.
inline Backend backend() {
    const char* wanted = std::getenv("BURIN_BACKEND");
    return wanted != nullptr && std::string(wanted) == "egl" ? Backend::egl : Backend::osmesa;
}

// Skips where there is no context at all. A driver that has one and refuses a shader fails the test.
#define SKIP_WITHOUT_CONTEXT(result)                                                         \
    if (!(result)) {                                                                         \
        const auto described = ::burin::describe_backend(::burin::testing::backend());       \
        if (!described) GTEST_SKIP() << "SKIPPED: " << described.error().message;            \
        FAIL() << (result).error().message;                                                  \
    }                                                                                        \
    static_assert(true)

}  // namespace burin::testing
