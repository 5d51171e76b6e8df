// What a pattern's textures hold, so that a program leaves the rest of the decoder out (README.md, the macros).
#pragma once

#include <string>

#include <burin/format/texels.hpp>

namespace burin::gl {

struct PatternKinds {
    int functions = 0;    // BURIN_FUNCTION_KINDS of core/types.glsl
    bool curves = false;  // quadratics
    bool bends = false;   // anything beside which a straight ray has a bent section
    bool steps = false;
    bool folds = false;  // profiles that are no height fields
};

// Cost: one look at every element and style.
PatternKinds kinds_of(const PackedTextures& textures);

// What a program for both must know.
PatternKinds join_kinds(const PatternKinds& a, const PatternKinds& b);

// The macros of core/types.glsl, a line each.
std::string kinds_text(const PatternKinds& kinds);

}  // namespace burin::gl
