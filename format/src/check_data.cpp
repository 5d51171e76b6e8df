// Checks of the data texture, SPECIFICATION.md "Data texture"; one function per section.
#include <algorithm>
#include <cmath>

#include "texture_check.hpp"

namespace burin {
namespace {

std::string text(std::uint32_t number) { return std::to_string(number); }

bool uses_clip_line(const EndCode& end) {
    if (end.priority == BURIN_PRIORITY_NONE) return false;
    return end.priority != BURIN_PRIORITY_BOTH || end.shape == BURIN_END_CLIP || end.shape == BURIN_END_TEE;
}

void check_end(const EndCode& end, const char* name, const std::string& place, Reporter& reporter) {
    const bool both = end.priority == BURIN_PRIORITY_BOTH;
    const std::uint32_t shapes = end.priority == BURIN_PRIORITY_NONE ? 1 : both ? 4 : 3;
    if (end.shape >= shapes) {
        reporter.report(4005,
                        std::string(name) + " has priority " + text(end.priority) + " with shape " +
                            text(end.shape) + ", less than " + text(shapes) + " is needed",
                        place);
    } else if (!uses_clip_line(end) && end.clip_angle != 0) {
        reporter.report(
            4006,
            std::string(name) + " has no clip line but clip angle " + text(end.clip_angle) + ", 0 is needed",
            place);
    }
}

void check_extent(const ElementCode& e, const std::string& place, Reporter& reporter) {
    const auto span = [&e](std::uint32_t PointCode::*axis) {
        std::uint32_t low = std::min(e.p0.*axis, e.p2.*axis), high = std::max(e.p0.*axis, e.p2.*axis);
        if (e.quadratic && e.has_texel_b) low = std::min(low, e.p1.*axis), high = std::max(high, e.p1.*axis);
        return high - low;
    };
    const std::uint32_t longest = std::max(span(&PointCode::u), span(&PointCode::v));
    if (longest > static_cast<std::uint32_t>(BURIN_COORDINATE_STEPS)) {
        reporter.report(4009,
                        "element spans " + number_text(longest / BURIN_COORDINATE_STEPS) +
                            " tiles, at most 1 where the pattern repeats",
                        place);
    }
}

// The right level is stored, so it must be where the profile's last point ends; the slack is what
// quantization of levels, heights and scale can add up to.
void check_step(const ElementCode& e, const StyleCode& style, std::int32_t last_h, const std::string& place,
                Reporter& reporter) {
    if (e.height0 != e.height1) {
        reporter.report(4010,
                        "element of a step has height scales " + number_text(decode_scale(e.height0)) +
                            " and " + number_text(decode_scale(e.height1)) + ", equal ones are needed",
                        place);
        return;
    }
    const double scale = decode_scale(e.height0), h = decode_snorm16(last_h);
    const double expected = decode_unorm16(style.level_left) + scale * h;
    const double slack = 3.0 / 65535.0 + scale / 32767.0 + std::abs(h) / BURIN_SCALE_STEPS;
    if (std::abs(expected - decode_unorm16(style.level_right)) > slack) {
        reporter.report(4011,
                        "the profile ends at " + number_text(expected) +
                            " of the height range, the right level is " +
                            number_text(decode_unorm16(style.level_right)),
                        place);
    }
}

std::int32_t last_height(const PackedTextures& textures, const StyleCode& style,
                         std::uint32_t profile_texels) {
    const std::uint32_t last = style.point_count - 1,
                        at = style.profile_texel + last / BURIN_POINTS_PER_TEXEL;
    if (style.point_count < 2 || style.point_count > BURIN_MAX_PROFILE_POINTS || at >= profile_texels)
        return 0;
    const Texel texel = data_texel(textures, textures.sections.profiles_begin() + at);
    return unpack_profile_point(texel[last % BURIN_POINTS_PER_TEXEL]).h;
}

void check_element(const PackedTextures& textures, const PathDetail& detail, const DecodedData& data,
                   const ElementCode& e, const std::string& place, Reporter& reporter) {
    if (e.unused != 0 || e.unused_c) reporter.report(4002, "bits without meaning are set, all must be 0", place);
    if (e.quadratic && !e.has_texel_b) reporter.report(4003, "a quadratic has no texel B", place);
    if (!e.quadratic && e.has_texel_b && !(e.p1 == PointCode{})) {
        reporter.report(4004, "a line has p1 codes " + text(e.p1.u) + ", " + text(e.p1.v) + ", 0 is needed",
                        place);
    }
    check_end(e.start, "the start", place, reporter);
    check_end(e.end, "the end", place, reporter);
    if (e.p0 == e.p2)
        reporter.report(4008, "both ends have codes " + text(e.p0.u) + ", " + text(e.p0.v), place);
    if (detail.repeat) check_extent(e, place, reporter);
    const StyleCode* style = data.style_of(e);
    if (style == nullptr) {
        reporter.report(4007, "style " + text(e.style) + " of " + std::to_string(data.styles.size()), place);
    } else if (style->step) {
        check_step(e, *style, last_height(textures, *style, detail.sections.profile_texels), place, reporter);
    }
}

void check_elements(const PackedTextures& textures, const PathDetail& detail, DecodedData& data,
                    Reporter& reporter) {
    const std::uint32_t count = detail.sections.element_texels;
    data.element_at.assign(count, DecodedData::kNone);
    for (std::uint32_t at = 0; at < count;) {
        const std::string place = "element at texel " + text(at);
        const Texel a = data_texel(textures, at);
        const std::uint32_t texels = element_texel_count(a);
        const bool cut = at + texels > count;
        if (cut) {
            reporter.report(4001, "its " + text(texels) + " texels reach behind the section of " + text(count), place);
        }
        const ElementCode element = cut ? unpack_element(a, {}) : element_at(textures, at);
        data.element_at[at] = static_cast<std::uint32_t>(data.elements.size());
        data.elements.push_back(element);
        data.element_texel.push_back(at);
        check_element(textures, detail, data, element, place, reporter);
        if (!cut) check_function_of(textures, data, element, place, reporter);
        at += texels;
    }
}

void check_points(const std::vector<ProfilePointCode>& points, bool step, const std::string& place,
                  Reporter& reporter) {
    bool at_zero = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].b == -32768 || points[i].h == -32768) {
            reporter.report(4030, "point " + std::to_string(i) + " has code -32768, range [-32767, 32767]",
                            place);
        }
        if (i > 0 && points[i] == points[i - 1]) {
            reporter.report(
                4032, "points " + std::to_string(i - 1) + " and " + std::to_string(i) + " are equal", place);
        }
        at_zero = at_zero || points[i].b == 0;
    }
    // A step may be a bare cliff, all over its path line.
    if (points.front().b > points.back().b || (points.front().b == points.back().b && !step)) {
        reporter.report(4031,
                        "the first point's b code " + std::to_string(points.front().b) +
                            " is not less than the last one's " + std::to_string(points.back().b),
                        place);
    }
    if (step && !at_zero) reporter.report(4033, "no point of a step profile lies at b = 0", place);
    if (points.front().h != 0 || (!step && points.back().h != 0)) {
        reporter.report(4034,
                        "the profile ends off the ground, h codes " + std::to_string(points.front().h) +
                            " and " + std::to_string(points.back().h),
                        place);
    }
}

void check_profile(const PackedTextures& textures, const StyleCode& style, const std::string& place,
                   Reporter& reporter) {
    const std::uint32_t begin = textures.sections.profiles_begin() + style.profile_texel;
    const std::uint32_t words =
        (style.point_count + BURIN_POINTS_PER_TEXEL - 1) / BURIN_POINTS_PER_TEXEL * BURIN_POINTS_PER_TEXEL;
    std::vector<ProfilePointCode> points;
    for (std::uint32_t i = 0; i < words; ++i) {
        const std::uint32_t word = data_texel(textures, begin + i / 4)[i % 4];
        if (i < style.point_count) {
            points.push_back(unpack_profile_point(word));
        } else if (word != 0) {
            reporter.report(4035, "word " + text(i) + " behind the last point is not 0", place);
        }
    }
    check_points(points, style.step, place, reporter);
}

void check_style(const PackedTextures& textures, const Sections& sections, const StyleCode& s,
                 const std::string& place, Reporter& reporter) {
    const auto reach = static_cast<double>(s.reach);
    if (!(reach >= BURIN_MIN_LENGTH && reach <= BURIN_MAX_LENGTH)) {
        reporter.report(4023, "reach is " + number_text(reach) + ", a length from 1e-9 to 1e9 m is needed",
                        place);
    }
    if (s.material >= sections.material_texels) {
        reporter.report(4022, "material " + text(s.material) + " of " + text(sections.material_texels),
                        place);
    }
    if (s.step != (s.level_left != s.level_right)) {
        reporter.report(4025,
                        std::string("step flag is ") + (s.step ? "set" : "not set") + ", level codes are " +
                            text(s.level_left) + " and " + text(s.level_right),
                        place);
    }
    if (s.point_count < 2 || s.point_count > BURIN_MAX_PROFILE_POINTS) {
        reporter.report(4021, "profile has " + text(s.point_count) + " points, range [2, 32]", place);
        return;
    }
    const std::uint32_t last = s.profile_texel + (s.point_count - 1) / BURIN_POINTS_PER_TEXEL;
    if (last >= sections.profile_texels) {
        reporter.report(
            4020, "profile reaches texel " + text(last) + " of a section of " + text(sections.profile_texels),
            place);
        return;
    }
    if (s.internal_mask >> (s.point_count - 1) != 0) {
        reporter.report(4024,
                        "internal bits " + text(s.internal_mask) + " go beyond the " +
                            text(s.point_count - 1) + " facets",
                        place);
    }
    check_profile(textures, s, place, reporter);
}

void check_materials(const PackedTextures& textures, Reporter& reporter) {
    for (std::uint32_t i = 0; i < textures.sections.material_texels; ++i) {
        const std::string place = "material " + text(i);
        const Texel texel = data_texel(textures, textures.sections.materials_begin() + i);
        const MaterialCode material = unpack_material(texel);
        if (i == 0 && material.overrides)
            reporter.report(4040, "material 0 overrides the glTF material", place);
        const bool values = texel[0] != 0 || material.metallic != 0 || material.roughness != 0;
        if (material.unused != 0 || (!material.overrides && values)) {
            reporter.report(4041, "bits without meaning are set, all must be 0", place);
        }
    }
}

void check_tail(const PackedTextures& textures, Reporter& reporter) {
    const std::size_t begin = std::size_t{4} * textures.sections.end();
    const auto first = std::find_if(textures.data.begin() + static_cast<std::ptrdiff_t>(begin),
                                    textures.data.end(), [](std::uint32_t word) { return word != 0; });
    if (first != textures.data.end()) {
        reporter.report(4053, "a word behind the last section is not 0",
                        "texel " + std::to_string((first - textures.data.begin()) / 4));
    }
}

}  // namespace

DecodedData check_data(const PackedTextures& textures, const PathDetail& detail, Reporter& reporter) {
    DecodedData data;
    for (std::uint32_t i = 0; i < detail.sections.style_texels; ++i) {
        data.styles.push_back(unpack_style(data_texel(textures, textures.sections.styles_begin() + i)));
    }
    check_functions(textures, data, reporter);
    check_elements(textures, detail, data, reporter);
    for (std::uint32_t i = 0; i < data.styles.size(); ++i) {
        check_style(textures, detail.sections, data.styles[i], "style " + text(i), reporter);
    }
    check_materials(textures, reporter);
    check_tail(textures, reporter);
    return data;
}

}  // namespace burin
