#include "start.hpp"

#include <cstdio>
#include <cstdlib>

#include <burin/refine.hpp>
#include <burin/vectorize.hpp>

namespace burin::bench {

Pattern vectorized(const Image& map, const Pattern& like, bool refined) {
    HeightMap input;
    input.image = map;
    VectorizeOptions options;
    options.size = like.size;
    options.depth = like.depth;
    options.wrap = like.wrap == Wrap::repeat ? WrapChoice::repeat : WrapChoice::clamp;
    Result<Vectorized> traced = vectorize_map(input, options);
    if (!traced) {
        std::fprintf(stderr, "resolution: %s\n", traced.error().message.c_str());
        std::exit(3);
    }
    Pattern pattern = std::move(traced->pattern);
    if (!refined) return pattern;
    RefineOptions refinement;
    refinement.damage = traced->damage;
    const Result<RefineReport> report = refine_pattern(pattern, map, refinement);
    if (!report) {
        std::fprintf(stderr, "resolution: %s\n", report.error().message.c_str());
        std::exit(3);
    }
    return pattern;
}

}  // namespace burin::bench
