// What the bench does about a stage that fails: it says why and ends with 3.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include <burin/result.hpp>

namespace burin::bench {

[[noreturn]] inline void leave(const std::string& message) {
    std::fprintf(stderr, "vectorizer: %s\n", message.c_str());
    std::exit(3);
}

template <typename T>
T value_or_leave(Result<T> result) {
    if (!result) leave(result.error().message);
    return std::move(*result);
}

}  // namespace burin::bench
