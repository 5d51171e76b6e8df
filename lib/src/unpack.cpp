// The two textures -> ResolvedPattern + CellGrid. Nothing is followed before the validator has found no
// error.
#include <burin/pack.hpp>

#include <map>
#include <string>
#include <tuple>

#include <burin/format/validate.hpp>

namespace burin {
namespace {

class Unpacker {
  public:
    Unpacker(const PackedTextures& textures, const PathDetail& detail)
        : textures_(textures), detail_(detail) {}

    UnpackedPattern run() {
        ResolvedPattern& pattern = out_.pattern;
        pattern.size = {detail_.size_u, detail_.size_v};
        pattern.depth = detail_.depth;
        pattern.base_offset = detail_.base_offset;
        pattern.wrap = detail_.repeat ? Wrap::repeat : Wrap::clamp;
        // Levels are compared as codes, so the one that JSON writes as a number takes the code nearest to it.
        pattern.outer_level = detail_.outer_level;
        std::uint32_t code = 0;
        if (encode_unorm16(height_to_unit(detail_.outer_level, detail_.depth, detail_.base_offset), code))
            pattern.outer_level = height(code);
        read_materials();
        read_elements();
        read_cells();
        return std::move(out_);
    }

  private:
    double height(std::uint32_t level_code) const {
        return unit_to_height(decode_unorm16(level_code), detail_.depth, detail_.base_offset);
    }
    Vec2 point(const PointCode& p) const {
        return {decode_coordinate(p.u) * detail_.size_u, decode_coordinate(p.v) * detail_.size_v};
    }

    void read_materials();
    void read_elements();
    void read_cells();
    void read_cell(std::uint32_t index);
    std::uint32_t style_of(const ElementCode& code);
    std::uint32_t profile_of(const StyleCode& style, double height_scale);
    std::uint32_t function_of(const ElementCode& code);
    bool continues(const ElementCode& before, const ElementCode& code) const;

    const PackedTextures& textures_;
    const PathDetail& detail_;
    UnpackedPattern out_;
    // A step's last point is set to the stored right level, so its height scale is part of what makes it.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> style_index_;
    std::map<std::tuple<Texel, std::uint32_t>, std::uint32_t> profile_index_;
    std::map<std::uint32_t, std::uint32_t> function_index_;  // texel -> function
    std::vector<std::uint32_t> element_at_;  // texel -> element
};

double scaled(std::uint32_t unorm8) { return decode_unorm8(unorm8); }

void Unpacker::read_materials() {
    out_.pattern.materials.clear();
    for (std::uint32_t i = 0; i < detail_.sections.material_texels; ++i) {
        const MaterialCode code =
            unpack_material(data_texel(textures_, detail_.sections.materials_begin() + i));
        Material material;
        material.overrides = code.overrides;
        if (code.overrides) {
            for (std::size_t c = 0; c < 4; ++c)
                material.base_color[c] = static_cast<float>(scaled(code.base_color[c]));
            material.metallic = static_cast<float>(scaled(code.metallic));
            material.roughness = static_cast<float>(scaled(code.roughness));
        }
        out_.pattern.materials.push_back(material);
    }
}

std::uint32_t Unpacker::profile_of(const StyleCode& style, double height_scale) {
    ResolvedProfile profile;
    profile.internal_mask = style.internal_mask;
    const std::uint32_t begin = detail_.sections.profiles_begin() + style.profile_texel;
    for (std::uint32_t i = 0; i < style.point_count; ++i) {
        const Texel texel = data_texel(textures_, begin + i / BURIN_POINTS_PER_TEXEL);
        const ProfilePointCode p = unpack_profile_point(texel[i % BURIN_POINTS_PER_TEXEL]);
        profile.points.push_back(
            {decode_snorm16(p.b) * static_cast<double>(style.reach), decode_snorm16(p.h) * detail_.depth});
    }
    if (style.step && height_scale > 0.0) {
        profile.points.back().h =
            profile.points.front().h + (height(style.level_right) - height(style.level_left)) / height_scale;
    }
    out_.pattern.profiles.push_back(std::move(profile));
    return static_cast<std::uint32_t>(out_.pattern.profiles.size() - 1);
}

std::uint32_t Unpacker::style_of(const ElementCode& code) {
    const Texel texel = data_texel(textures_, detail_.sections.styles_begin() + code.style);
    const StyleCode style = unpack_style(texel);
    const std::uint32_t scale = style.step ? code.height0 : 0;
    const auto [entry, inserted] =
        style_index_.try_emplace({code.style, scale}, static_cast<std::uint32_t>(out_.pattern.styles.size()));
    if (!inserted) return entry->second;
    // Styles that differ in material or level alone share their profile.
    StyleCode shape = style;
    shape.material = 0;
    if (!style.step) shape.level_left = shape.level_right = 0;
    const auto [profile, fresh] = profile_index_.try_emplace({pack_style(shape), scale}, 0u);
    if (fresh) profile->second = profile_of(style, decode_scale(scale));
    out_.pattern.styles.push_back({profile->second, style.material, height(style.level_left), style.step});
    return entry->second;
}

std::uint32_t Unpacker::function_of(const ElementCode& code) {
    if (!code.has_texel_c) return kNoFunction;
    std::vector<ScaleFunction>& functions = out_.pattern.functions;
    const auto [entry, inserted] = function_index_.try_emplace(code.function, static_cast<std::uint32_t>(functions.size()));
    if (!inserted) return entry->second;
    const FunctionCode stored = function_at(textures_, code.function);
    ScaleFunction f;
    f.kind = static_cast<PerturbationKind>(stored.kind);
    f.width = decode_snorm16(stored.width);
    f.height = decode_snorm16(stored.height);
    if (f.kind == PerturbationKind::noise) f.seed = stored.seed, f.octaves = stored.octaves, f.period = stored.period;
    for (std::size_t i = 0; i < 4 && f.kind == PerturbationKind::polynomial; ++i) {
        f.width_polynomial[i] = static_cast<double>(stored.coefficients[i]);
        f.height_polynomial[i] = static_cast<double>(stored.coefficients[4 + i]);
    }
    functions.push_back(f);
    return entry->second;
}

bool Unpacker::continues(const ElementCode& before, const ElementCode& code) const {
    const auto tile = static_cast<std::uint32_t>(BURIN_COORDINATE_STEPS);
    const auto meet = [this, tile](std::uint32_t a, std::uint32_t b) {
        return detail_.repeat ? (a - b) % tile == 0 : a == b;
    };
    return meet(before.p2.u, code.p0.u) && meet(before.p2.v, code.p0.v) && before.style == code.style &&
           before.has_texel_c == code.has_texel_c && before.function == code.function;
}

void Unpacker::read_elements() {
    const std::uint32_t count = detail_.sections.element_texels;
    element_at_.assign(count, 0);
    ElementCode before;
    std::uint32_t path = 0;
    for (std::uint32_t at = 0; at < count;) {
        const ElementCode code = burin::element_at(textures_, at);
        ResolvedElement e;
        e.element = {code.quadratic ? ElementKind::quadratic : ElementKind::line,
                     point(code.p0),
                     code.quadratic ? point(code.p1) : Vec2{},
                     point(code.p2),
                     decode_scale(code.width0),
                     decode_scale(code.width1),
                     decode_scale(code.height0),
                     decode_scale(code.height1),
                     decode_argument(code.argument0),
                     decode_argument(code.argument1)};
        const auto end = [](const EndCode& c) {
            return ElementEnd{static_cast<Priority>(c.priority), static_cast<std::uint8_t>(c.shape),
                              decode_clip_angle(c.clip_angle)};
        };
        e.start = end(code.start);
        e.end = end(code.end);
        e.style = style_of(code);
        e.function = function_of(code);
        if (at > 0 && !continues(before, code)) ++path;
        e.path = path;
        element_at_[at] = static_cast<std::uint32_t>(out_.pattern.elements.size());
        out_.pattern.elements.push_back(e);
        before = code;
        at += element_texel_count(data_texel(textures_, at));
    }
}

void Unpacker::read_cell(std::uint32_t index) {
    CellGrid& grid = out_.grid;
    const CellCode code = unpack_cell(cell_texel(textures_, index));
    const std::uint32_t begin = list_begin(detail_.sections, code);
    for (std::uint32_t k = 0; k < code.count; ++k) {
        grid.refs.push_back(element_at_[list_reference(textures_, begin + k)]);
    }
    grid.first_ref.push_back(static_cast<std::uint32_t>(grid.refs.size()));
    grid.level.push_back(height(code.level));
    grid.highest.push_back(unit_to_height(decode_unorm8(code.highest), detail_.depth, detail_.base_offset));
    grid.lowest.push_back(unit_to_height(decode_unorm8(code.lowest), detail_.depth, detail_.base_offset));
    const bool step = (code.flags & BURIN_CELL_FLAG_STEP) != 0;
    grid.skip.push_back(static_cast<std::uint8_t>(step ? 0 : code.skip));
    grid.start.push_back(static_cast<std::uint8_t>(step ? code.skip : 0));
    grid.flags.push_back(static_cast<std::uint8_t>(code.flags));
}

void Unpacker::read_cells() {
    out_.grid.cols = textures_.grid_width;
    out_.grid.rows = textures_.grid_height;
    out_.grid.first_ref.push_back(0);
    const auto cells = static_cast<std::uint32_t>(textures_.grid.size() / 2);
    for (std::uint32_t k = 0; k < cells; ++k) read_cell(k);
}

}  // namespace

Result<UnpackedPattern> unpack_textures(const PackedTextures& textures, const PathDetail& detail) {
    Issue first;
    const bool valid = validate_textures(textures, detail, [&first](const Issue& issue) {
        if (first.number == 0 && issue.severity == Severity::error) first = issue;
    });
    if (!valid) {
        return Error{ErrorCode::invalid_input,
                     "issue " + std::to_string(first.number) + ": " + first.pointer + ": " + first.message};
    }
    if (!(detail.depth > 0.0) || !(detail.size_u > 0.0) || !(detail.size_v > 0.0)) {
        return Error{ErrorCode::invalid_input, "depth and size must be greater than 0"};
    }
    // Lists are shared in the file and written out here, so a small file could ask for much memory.
    std::uint64_t references = 0;
    for (std::size_t k = 0; k < textures.grid.size(); k += 2) {
        references += unpack_cell({textures.grid[k], textures.grid[k + 1]}).count;
    }
    if (references > kMaxUnpackedReferences) {
        return Error{ErrorCode::limit_exceeded, "the cells list " + std::to_string(references) +
                                                    " elements in all, limit " +
                                                    std::to_string(kMaxUnpackedReferences)};
    }
    return Unpacker(textures, detail).run();
}

}  // namespace burin
