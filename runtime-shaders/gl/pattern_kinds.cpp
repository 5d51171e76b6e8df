#include "gl/pattern_kinds.hpp"

#include "layout.h"

namespace burin::gl {
namespace {

bool is_round(const EndCode& end) {
    if (end.priority == BURIN_PRIORITY_BOTH) return end.shape == BURIN_END_ROUND;
    return end.priority != BURIN_PRIORITY_NONE && end.shape == BURIN_CORNER_ROUND;
}

bool is_tapered(const ElementCode& element) { return element.width0 != element.width1 || element.height0 != element.height1; }

bool is_folded(const PackedTextures& textures, const StyleCode& style) {
    const auto offset = [&](std::uint32_t i) {
        const Texel texel = data_texel(textures, textures.sections.profiles_begin() + style.profile_texel + i / BURIN_POINTS_PER_TEXEL);
        return unpack_profile_point(texel[i % BURIN_POINTS_PER_TEXEL]).b;
    };
    for (std::uint32_t i = 1; i < style.point_count; ++i)
        if (offset(i) < offset(i - 1)) return true;
    return false;
}

}  // namespace

PatternKinds kinds_of(const PackedTextures& textures) {
    PatternKinds kinds;
    const Sections& sections = textures.sections;
    for (std::uint32_t at = 0; at < sections.function_texels;) {
        const Texel head = data_texel(textures, sections.functions_begin() + at);
        kinds.functions |= (1 << (head[0] & 3u)) & 7;
        at += function_texel_count(head);
    }
    for (std::uint32_t at = 0; at < sections.element_texels;) {
        const ElementCode element = element_at(textures, at);
        kinds.curves = kinds.curves || element.quadratic;
        kinds.bends = kinds.bends || is_tapered(element) || is_round(element.start) || is_round(element.end);
        at += element_texel_count(data_texel(textures, at));
    }
    kinds.bends = kinds.bends || kinds.curves || kinds.functions != 0;
    for (std::uint32_t at = sections.styles_begin(); at < sections.profiles_begin(); ++at) {
        const StyleCode style = unpack_style(data_texel(textures, at));
        kinds.steps = kinds.steps || style.step;
        kinds.folds = kinds.folds || is_folded(textures, style);
    }
    return kinds;
}

PatternKinds join_kinds(const PatternKinds& a, const PatternKinds& b) {
    return {a.functions | b.functions, a.curves || b.curves, a.bends || b.bends, a.steps || b.steps, a.folds || b.folds};
}

std::string kinds_text(const PatternKinds& kinds) {
    const auto line = [](const char* macro, int value) {
        return std::string("#define ") + macro + " " + std::to_string(value) + "\n";
    };
    return line("BURIN_FUNCTION_KINDS", kinds.functions) + line("BURIN_CURVES", kinds.curves ? 1 : 0) +
           line("BURIN_BENDS", kinds.bends ? 1 : 0) + line("BURIN_STEPS", kinds.steps ? 1 : 0) +
           line("BURIN_FOLDS", kinds.folds ? 1 : 0);
}

}  // namespace burin::gl
