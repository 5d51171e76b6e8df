#include "found.hpp"

#include <ctime>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <burin/convert.hpp>
#include <burin/pack.hpp>

#include "leave.hpp"

namespace burin::bench {
namespace {

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

Found found_in(const HeightMap& map, const Pattern& like) {
    ConvertOptions options;
    options.vectorize.size = like.size;
    options.vectorize.depth = like.depth;
    options.vectorize.wrap = like.wrap == Wrap::repeat ? WrapChoice::repeat : WrapChoice::clamp;
    options.threads = 1;
    const double begun = processor_seconds();
    FoundPattern pattern = value_or_leave(find_pattern(map, options));
    Found found;
    found.seconds = processor_seconds() - begun;
    found.stored = value_or_leave(unpack_textures(pattern.textures, pattern.detail)).pattern;
    found.pattern = std::move(pattern.pattern);
    found.texture_bytes = pattern.stats.grid_bytes + pattern.stats.data_bytes;
    found.elements = found.stored.elements.size();
    found.explained = pattern.stats.explained;
    return found;
}

}  // namespace burin::bench
