// ResolvedPattern + CellGrid -> the two textures. [2010] 4.2; SPECIFICATION.md says what each field means.
#include <burin/pack.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "pack_levels.hpp"
#include "pack_lists.hpp"

namespace burin {
namespace {

std::string text(std::size_t number) { return std::to_string(number); }

Error limit(std::string message) { return {ErrorCode::limit_exceeded, std::move(message)}; }
Error invalid(std::string message) { return {ErrorCode::invalid_input, std::move(message)}; }

std::string place_text(Vec2 p) {
    std::string place = "(";
    place += std::to_string(p.x);
    place += ", ";
    place += std::to_string(p.y);
    return place += ") m";
}

// Ground on the right of an element whose style is a step, resolve.hpp.
double right_level(const ResolvedPattern& pattern, const ResolvedElement& element) {
    const Style& style = pattern.styles[element.style];
    if (!style.step) return style.level;
    const std::vector<ProfilePoint>& points = pattern.profiles[style.profile].points;
    return style.level + (points.back().h - points.front().h) * element.element.height0;
}

// A profile as words, and what its style needs beside them.
struct ProfileCode {
    std::vector<std::uint32_t> words;  // one per point
    float reach = 0.0f;
    std::uint32_t internal_mask = 0;
};

bool encode_scale_function(const ScaleFunction& f, FunctionCode& code) {
    code.kind = static_cast<std::uint32_t>(f.kind);
    if (f.kind == PerturbationKind::polynomial) {
        for (std::size_t i = 0; i < 4; ++i) {
            code.coefficients[i] = static_cast<float>(f.width_polynomial[i]);
            code.coefficients[4 + i] = static_cast<float>(f.height_polynomial[i]);
        }
        return true;
    }
    if (f.kind == PerturbationKind::noise) code.octaves = f.octaves, code.seed = f.seed, code.period = f.period;
    return encode_snorm16(f.width, code.width) && encode_snorm16(f.height, code.height);
}

class Packer {
  public:
    Packer(const ResolvedPattern& pattern, const CellGrid& grid, const PackOptions& options)
        : pattern_(pattern), grid_(grid), options_(options) {}

    Result<PackedTextures> run() {
        for (const auto stage : {&Packer::check_input, &Packer::collect_levels, &Packer::encode_profiles,
                                 &Packer::encode_materials, &Packer::encode_elements, &Packer::encode_cells,
                                 &Packer::assemble}) {
            if (std::optional<Error> error = (this->*stage)()) return *error;
        }
        return std::move(out_);
    }

    const PackStatistics& statistics() const { return statistics_; }

  private:
    using Failure = std::optional<Error>;

    double unit(double height) const { return height_to_unit(height, pattern_.depth, pattern_.base_offset); }
    std::uint32_t level_code(double height) const { return levels_->code(unit(height)); }

    Failure check_input();
    Failure check_indices() const;
    Failure collect_levels();
    Failure encode_profiles();
    Failure encode_profile(std::size_t index);
    Failure encode_materials();
    Failure encode_elements();
    Failure encode_element(std::size_t index);
    Failure encode_points(std::size_t index, ElementCode& code) const;
    Failure encode_end(std::size_t index, const ElementEnd& end, EndCode& code) const;
    Failure encode_scales(std::size_t index, ElementCode& code) const;
    Failure encode_function(std::size_t index, ElementCode& code);
    Failure encode_style(std::size_t index, ElementCode& code);
    std::uint32_t stored_profile(const ProfileCode& profile);
    Failure encode_cells();
    CellCode encode_cell(std::size_t cell, std::size_t count, std::uint32_t first) const;
    Failure assemble();

    const ResolvedPattern& pattern_;
    const CellGrid& grid_;
    const PackOptions& options_;
    PackedTextures out_;
    PackStatistics statistics_;
    std::optional<LevelCodes> levels_;
    std::vector<ProfileCode> profile_codes_;
    std::vector<std::uint32_t> material_index_;  // pattern's material -> texel
    std::vector<std::uint32_t> element_texel_;   // element -> texel, kDropped where it was left out
    static constexpr std::uint32_t kDropped = 0xFFFFFFFFu;
    std::map<std::array<Texel, 3>, std::uint32_t> function_texel_;
    std::vector<Texel> elements_, styles_, materials_, functions_;
    std::vector<std::uint32_t> profile_words_;
    std::map<Texel, std::uint32_t> style_index_;
    std::map<std::vector<std::uint32_t>, std::uint32_t> profile_texel_;
    std::vector<std::uint32_t> references_;
};

Packer::Failure Packer::check_input() {
    const std::size_t cells =
        static_cast<std::size_t>(std::max(grid_.cols, 0)) * static_cast<std::size_t>(std::max(grid_.rows, 0));
    if (grid_.cols < 1 || grid_.rows < 1 || grid_.cols > BURIN_MAX_TEXTURE_SIDE ||
        grid_.rows > BURIN_MAX_TEXTURE_SIDE) {
        return limit("grid has " + std::to_string(grid_.cols) + " x " + std::to_string(grid_.rows) +
                     " cells, range [1, " + std::to_string(BURIN_MAX_TEXTURE_SIDE) + "] on each side");
    }
    if (grid_.first_ref.size() != cells + 1 || grid_.level.size() != cells || grid_.highest.size() != cells ||
        grid_.lowest.size() != cells || grid_.skip.size() != cells || grid_.start.size() != cells ||
        grid_.flags.size() != cells ||
        grid_.first_ref.back() != grid_.refs.size()) {
        return invalid("the grid's arrays do not have one entry for each of its " + text(cells) + " cells");
    }
    if (!(pattern_.depth > 0.0) || !(pattern_.size.x > 0.0) || !(pattern_.size.y > 0.0)) {
        return invalid("depth and size of the pattern must be greater than 0");
    }
    return check_indices();
}

Packer::Failure Packer::check_indices() const {
    for (std::size_t i = 0; i < pattern_.styles.size(); ++i) {
        const Style& style = pattern_.styles[i];
        if (style.profile >= pattern_.profiles.size() || style.material >= pattern_.materials.size()) {
            return invalid("style " + text(i) + " has profile " + text(style.profile) + " of " +
                           text(pattern_.profiles.size()) + " and material " + text(style.material) + " of " +
                           text(pattern_.materials.size()));
        }
    }
    for (std::size_t i = 0; i < pattern_.elements.size(); ++i) {
        const std::uint32_t function = pattern_.elements[i].function;
        if (function != kNoFunction && function >= pattern_.functions.size()) {
            return invalid("element " + text(i) + " has function " + text(function) + " of " +
                           text(pattern_.functions.size()));
        }
        if (pattern_.elements[i].style >= pattern_.styles.size()) {
            return invalid("element " + text(i) + " has style " + text(pattern_.elements[i].style) + " of " +
                           text(pattern_.styles.size()));
        }
    }
    for (const std::uint32_t reference : grid_.refs) {
        if (reference >= pattern_.elements.size()) {
            return invalid("a cell lists element " + text(reference) + " of " +
                           text(pattern_.elements.size()));
        }
    }
    return {};
}

// Every level that the decoder compares: cells, and both sides of every element.
Packer::Failure Packer::collect_levels() {
    std::vector<double> units;
    units.reserve(grid_.level.size() + 2 * pattern_.elements.size());
    constexpr double kSlack = 1e-6;  // of depth: rounding of sums, far below a code
    const auto add = [this, &units](double height) {
        units.push_back(unit(height));
        return units.back() >= -kSlack && units.back() <= 1.0 + kSlack;
    };
    const auto range = [this] {
        return " m, range [" + std::to_string(pattern_.base_offset - pattern_.depth) + ", " +
               std::to_string(pattern_.base_offset) + "]";
    };
    for (std::size_t i = 0; i < grid_.level.size(); ++i) {
        if (!add(grid_.level[i])) {
            return invalid("ground level of cell " + text(i) + " is " + std::to_string(grid_.level[i]) +
                           range());
        }
    }
    for (std::size_t i = 0; i < pattern_.elements.size(); ++i) {
        const ResolvedElement& e = pattern_.elements[i];
        if (!add(pattern_.styles[e.style].level) || !add(right_level(pattern_, e))) {
            return invalid("element " + text(i) + " at " + place_text(e.element.p0) + " has levels " +
                           std::to_string(pattern_.styles[e.style].level) + " and " +
                           std::to_string(right_level(pattern_, e)) + range());
        }
    }
    levels_.emplace(std::move(units), options_.same_level);
    return {};
}

Packer::Failure Packer::encode_profiles() {
    profile_codes_.resize(pattern_.profiles.size());
    for (std::size_t i = 0; i < pattern_.profiles.size(); ++i) {
        if (Failure error = encode_profile(i)) return error;
    }
    return {};
}

Packer::Failure Packer::encode_profile(std::size_t index) {
    const ResolvedProfile& profile = pattern_.profiles[index];
    if (profile.points.size() < 2 || profile.points.size() > BURIN_MAX_PROFILE_POINTS) {
        return limit("profile " + text(index) + " has " + text(profile.points.size()) +
                     " points, range [2, " + std::to_string(BURIN_MAX_PROFILE_POINTS) + "]");
    }
    double reach = 0.0;
    for (const ProfilePoint& p : profile.points) reach = std::max(reach, std::abs(p.b));
    ProfileCode& code = profile_codes_[index];
    // Rounded up, so that no point lies beyond 1.
    code.reach = static_cast<float>(reach);
    if (static_cast<double>(code.reach) < reach) code.reach = std::nextafter(code.reach, HUGE_VALF);
    // A bare cliff, all points over the path line itself: any length will do as unit of its b.
    if (reach == 0.0) code.reach = static_cast<float>(pattern_.depth);
    if (!(code.reach > 0.0f) || !std::isfinite(code.reach)) {
        return invalid("profile " + text(index) + " reaches " + std::to_string(reach) +
                       " m, it must be wider than 0");
    }
    for (std::size_t i = 0; i < profile.points.size(); ++i) {
        ProfilePointCode point;
        if (!encode_snorm16(profile.points[i].b / static_cast<double>(code.reach), point.b) ||
            !encode_snorm16(profile.points[i].h / pattern_.depth, point.h)) {
            return limit("profile " + text(index) + " point " + text(i) +
                         " has h = " + std::to_string(profile.points[i].h) + " m, range [-" +
                         std::to_string(pattern_.depth) + ", " + std::to_string(pattern_.depth) +
                         "]; a larger depth or height scale would fit");
        }
        const std::uint32_t word = pack_profile_point(point);
        // Points that quantization made equal are one; the facet between them is gone.
        const bool merged = !code.words.empty() && code.words.back() == word;
        const bool internal = i > 0 && (profile.internal_mask >> (i - 1) & 1u) != 0;
        if (internal && !merged) code.internal_mask |= 1u << (code.words.size() - 1);
        if (!merged) code.words.push_back(word);
    }
    if (code.words.size() < 2) return invalid("all points of profile " + text(index) + " are equal");
    return {};
}

Packer::Failure Packer::encode_materials() {
    std::map<Texel, std::uint32_t> known;
    if (pattern_.materials.empty() || pattern_.materials[0].overrides) {
        return invalid("material 0 must exist and leave the glTF material as it is");
    }
    for (std::size_t i = 0; i < pattern_.materials.size(); ++i) {
        const Material& material = pattern_.materials[i];
        MaterialCode code;
        code.overrides = material.overrides;
        bool ok = true;
        for (std::size_t c = 0; c < 4 && code.overrides; ++c)
            ok = ok && encode_unorm8(static_cast<double>(material.base_color[c]), code.base_color[c]);
        if (code.overrides) {
            ok = ok && encode_unorm8(static_cast<double>(material.metallic), code.metallic) &&
                 encode_unorm8(static_cast<double>(material.roughness), code.roughness);
        }
        if (!ok) return invalid("material " + text(i) + " has a value outside of [0, 1]");
        const auto [entry, inserted] =
            known.try_emplace(pack_material(code), static_cast<std::uint32_t>(materials_.size()));
        if (inserted) materials_.push_back(entry->first);
        material_index_.push_back(entry->second);
    }
    if (materials_.size() > BURIN_MAX_MATERIALS) {
        return limit("pattern has " + text(materials_.size()) + " different materials, limit " +
                     std::to_string(BURIN_MAX_MATERIALS));
    }
    return {};
}

Packer::Failure Packer::encode_elements() {
    element_texel_.reserve(pattern_.elements.size());
    for (std::size_t i = 0; i < pattern_.elements.size(); ++i) {
        if (Failure error = encode_element(i)) return error;
        if (elements_.size() > BURIN_MAX_ELEMENT_TEXELS) {
            return limit("element " + text(i) + " of " + text(pattern_.elements.size()) + " ends beyond texel " +
                         std::to_string(BURIN_MAX_ELEMENT_TEXELS) + ", the limit; the first " + text(i) +
                         " would fit, and a larger error or a smaller tile would need fewer");
        }
    }
    out_.sections.element_texels = static_cast<std::uint32_t>(elements_.size());
    statistics_.styles = styles_.size();
    statistics_.profiles = profile_texel_.size();
    return {};
}

// Within 16 steps, a quarter of a texel of an 8192 x 8192 map.
bool is_near(const PointCode& a, const PointCode& b) {
    const auto apart = [](std::uint32_t p, std::uint32_t q) { return p > q ? p - q : q - p; };
    return apart(a.u, b.u) <= 16 && apart(a.v, b.v) <= 16;
}

Packer::Failure Packer::encode_element(std::size_t index) {
    const ResolvedElement& e = pattern_.elements[index];
    ElementCode code;
    if (Failure error = encode_points(index, code)) return error;
    if (code.p0 == code.p2) {
        // Of a quadratic that comes back to where it began only what goes some way in between is an error.
        if (code.quadratic && !is_near(code.p1, code.p0)) {
            return invalid("element " + text(index) + " at " + place_text(e.element.p0) +
                           " begins and ends at the same place");
        }
        ++statistics_.dropped_elements;
        element_texel_.push_back(kDropped);
        return {};
    }
    if (Failure error = encode_end(index, e.start, code.start)) return error;
    if (Failure error = encode_end(index, e.end, code.end)) return error;
    if (Failure error = encode_scales(index, code)) return error;
    if (Failure error = encode_style(index, code)) return error;
    if (Failure error = encode_function(index, code)) return error;
    const std::array<Texel, 3> texels = pack_element(code);
    element_texel_.push_back(static_cast<std::uint32_t>(elements_.size()));
    elements_.push_back(texels[0]);
    if (code.has_texel_b) elements_.push_back(texels[1]);
    if (code.has_texel_c) elements_.push_back(texels[2]);
    return {};
}

Packer::Failure Packer::encode_points(std::size_t index, ElementCode& code) const {
    const Element& e = pattern_.elements[index].element;
    code.quadratic = e.kind == ElementKind::quadratic;
    const auto encode = [this](Vec2 p, PointCode& point) {
        return encode_coordinate(p.x / pattern_.size.x, point.u) &&
               encode_coordinate(p.y / pattern_.size.y, point.v);
    };
    if (encode(e.p0, code.p0) && encode(e.p2, code.p2) && (!code.quadratic || encode(e.p1, code.p1)))
        return {};
    return limit("element " + text(index) + " from " + place_text(e.p0) + " to " + place_text(e.p2) +
                 " leaves [-0.5, 1.5) of the tile; shorter elements would fit");
}

Packer::Failure Packer::encode_end(std::size_t index, const ElementEnd& end, EndCode& code) const {
    code.priority = static_cast<std::uint32_t>(end.priority);
    code.shape = end.priority == Priority::none ? 0u : end.shape;
    const bool clipped =
        end.priority == Priority::left || end.priority == Priority::right || end.clips_both();
    const std::uint32_t last = end.priority == Priority::both ? BURIN_END_TEE : BURIN_CORNER_ROUND;
    if (code.shape > last || (clipped && !encode_clip_angle(end.clip_angle, code.clip_angle))) {
        return invalid("element " + text(index) + " has an end of shape " + text(end.shape) +
                       " and clip angle " + std::to_string(end.clip_angle));
    }
    return {};
}

Packer::Failure Packer::encode_scales(std::size_t index, ElementCode& code) const {
    const ResolvedElement& e = pattern_.elements[index];
    const bool ok =
        encode_scale(e.element.width0, code.width0) && encode_scale(e.element.width1, code.width1) &&
        encode_scale(e.element.height0, code.height0) && encode_scale(e.element.height1, code.height1);
    if (!ok) {
        return limit("element " + text(index) + " at " + place_text(e.element.p0) + " has scales " +
                     std::to_string(e.element.width0) + ", " + std::to_string(e.element.width1) + ", " +
                     std::to_string(e.element.height0) + ", " + std::to_string(e.element.height1) +
                     ", range [0, 4); a profile of its own would fit");
    }
    if (pattern_.styles[e.style].step && code.height0 != code.height1) {
        return invalid("element " + text(index) + " at " + place_text(e.element.p0) +
                       " belongs to a step, its height scale must be constant");
    }
    const bool scaled =
        code.width0 != 16384 || code.width1 != 16384 || code.height0 != 16384 || code.height1 != 16384;
    code.has_texel_b = code.quadratic || scaled;
    return {};
}

// Equal functions are stored once, and only those that an element refers to.
Packer::Failure Packer::encode_function(std::size_t index, ElementCode& code) {
    const ResolvedElement& e = pattern_.elements[index];
    if (e.function == kNoFunction) return {};
    FunctionCode function;
    const bool ok = encode_argument(e.element.argument0, code.argument0) &&
                    encode_argument(e.element.argument1, code.argument1) &&
                    encode_scale_function(pattern_.functions[e.function], function);
    if (!ok) {
        return invalid("element " + text(index) + " at " + place_text(e.element.p0) + " has function " + text(e.function) +
                       " with arguments " + std::to_string(e.element.argument0) + " to " +
                       std::to_string(e.element.argument1) + "; amplitudes in [-1, 1] and arguments in [0, 65536) are needed");
    }
    code.has_texel_c = true;
    const std::array<Texel, 3> texels = pack_function(function);
    const auto [entry, inserted] = function_texel_.try_emplace(texels, static_cast<std::uint32_t>(functions_.size()));
    if (inserted) functions_.insert(functions_.end(), texels.begin(), texels.begin() + function_texel_count(texels[0]));
    code.function = entry->second;
    if (functions_.size() <= BURIN_MAX_FUNCTION_TEXELS) return {};
    return limit("functions along paths take more than " + std::to_string(BURIN_MAX_FUNCTION_TEXELS) + " texels");
}

Packer::Failure Packer::encode_style(std::size_t index, ElementCode& code) {
    const ResolvedElement& e = pattern_.elements[index];
    const Style& style = pattern_.styles[e.style];
    const ProfileCode& profile = profile_codes_[style.profile];
    StyleCode s;
    s.profile_texel = stored_profile(profile);
    s.point_count = static_cast<std::uint32_t>(profile.words.size());
    s.material = material_index_[style.material];
    s.level_left = level_code(style.level);
    // The right level is a level like any other: its code comes from the same table, never from h.
    s.level_right = level_code(right_level(pattern_, e));
    s.step = s.level_left != s.level_right;
    s.reach = profile.reach;
    s.internal_mask = profile.internal_mask;
    if (profile_words_.size() > std::size_t{BURIN_MAX_PROFILE_TEXELS} * BURIN_POINTS_PER_TEXEL) {
        return limit("profiles take more than " + std::to_string(BURIN_MAX_PROFILE_TEXELS) + " texels");
    }
    const auto [entry, inserted] =
        style_index_.try_emplace(pack_style(s), static_cast<std::uint32_t>(styles_.size()));
    if (inserted) styles_.push_back(entry->first);
    code.style = entry->second;
    if (styles_.size() <= BURIN_MAX_STYLES) return {};
    return limit("element " + text(index) + " needs one more style than the limit of " +
                 std::to_string(BURIN_MAX_STYLES) + "; fewer profiles, materials or levels would fit");
}

std::uint32_t Packer::stored_profile(const ProfileCode& profile) {
    const auto texel = static_cast<std::uint32_t>(profile_words_.size() / BURIN_POINTS_PER_TEXEL);
    const auto [entry, inserted] = profile_texel_.try_emplace(profile.words, texel);
    if (inserted) {
        profile_words_.insert(profile_words_.end(), profile.words.begin(), profile.words.end());
        while (profile_words_.size() % BURIN_POINTS_PER_TEXEL != 0) profile_words_.push_back(0);
    }
    return entry->second;
}

Packer::Failure Packer::encode_cells() {
    const std::size_t cells = grid_.level.size();
    std::vector<ReferenceList> lists(cells);
    for (std::size_t k = 0; k < cells; ++k) {
        if (grid_.first_ref[k] > grid_.first_ref[k + 1])
            return invalid("the grid's first references do not grow");
        for (std::size_t r = grid_.first_ref[k]; r < grid_.first_ref[k + 1]; ++r) {
            const std::uint32_t at = element_texel_[grid_.refs[r]];
            if (at != kDropped) lists[k].push_back(at);
        }
        std::sort(lists[k].begin(), lists[k].end());
        lists[k].erase(std::unique(lists[k].begin(), lists[k].end()), lists[k].end());
        statistics_.references_listed += lists[k].size();
        if (lists[k].size() > BURIN_MAX_REFS_PER_CELL) {
            const std::size_t cols = static_cast<std::size_t>(grid_.cols);
            return limit("cell (" + text(k % cols) + "," + text(k / cols) + ") lists " +
                         text(lists[k].size()) + " elements, limit " +
                         std::to_string(BURIN_MAX_REFS_PER_CELL) + "; a grid of " + text(2 * cols) +
                         " columns may fit");
        }
    }
    StoredLists stored = out_.sections.wide() ? store_aligned_lists(lists, BURIN_WIDE_REFS_PER_TEXEL) : store_lists(lists, elements_.size());
    references_ = std::move(stored.references);
    statistics_.references_stored = references_.size();
    const std::size_t per_texel = out_.sections.references_per_texel(), most = out_.sections.max_list_texels() * per_texel;
    if (references_.size() > most) {
        return limit("the cells' lists hold " + text(references_.size()) + " references, limit " + text(most) +
                     "; larger cells would fit");
    }
    out_.sections.list_texels = static_cast<std::uint32_t>((references_.size() + per_texel - 1) / per_texel);
    out_.grid_width = grid_.cols;
    out_.grid_height = grid_.rows;
    out_.grid.reserve(2 * cells);
    for (std::size_t k = 0; k < cells; ++k) {
        const CellTexel texel = pack_cell(encode_cell(k, lists[k].size(), first_reference_code(out_.sections, stored.first[k])));
        out_.grid.insert(out_.grid.end(), texel.begin(), texel.end());
    }
    return {};
}

CellCode Packer::encode_cell(std::size_t cell, std::size_t count, std::uint32_t first) const {
    CellCode code;
    code.first_reference = first;
    code.count = static_cast<std::uint32_t>(count);
    code.level = level_code(grid_.level[cell]);
    if (count == 0) {
        code.skip = std::min<std::uint32_t>(grid_.skip[cell], (1u << BURIN_CELL_SKIP_BITS) - 1);
        code.flags = grid_.flags[cell] & BURIN_CELL_FLAG_ISOLATED;
        code.highest = (code.level + 256) / 257;
        code.lowest = code.level / 257;
        return code;
    }
    code.flags = grid_.flags[cell];
    if ((code.flags & BURIN_CELL_FLAG_STEP) != 0) code.skip = grid_.start[cell];
    // Wider by what levels, heights and scales may have moved in quantization, so that the bounds stay
    // conservative. The surface lies within the height range, so bounds beyond it say no more than the range
    // itself.
    constexpr double kMoved = 1.0 / 8192.0;
    encode_unorm8_ceil(std::clamp(unit(grid_.highest[cell]) + kMoved, 0.0, 1.0), code.highest);
    encode_unorm8_floor(std::clamp(unit(grid_.lowest[cell]) - kMoved, 0.0, 1.0), code.lowest);
    code.highest = std::max(code.highest, (code.level + 256) / 257);
    code.lowest = std::min(code.lowest, code.level / 257);
    return code;
}

// Sides of the data texture: not far from a square, with as few texels left over as any such width gives.
void choose_sides(std::size_t texels, int& width, int& height) {
    const auto root = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(texels))));
    std::size_t best = std::max<std::size_t>(root, 1), best_area = ~std::size_t{0};
    for (std::size_t w = best; w <= 8 * root && w <= BURIN_MAX_TEXTURE_SIDE; ++w) {
        const std::size_t area = (texels + w - 1) / w * w;
        if (area < best_area) best_area = area, best = w;
    }
    width = static_cast<int>(best);
    height = static_cast<int>(std::max<std::size_t>((texels + best - 1) / best, 1));
}

Packer::Failure Packer::assemble() {
    Sections& sections = out_.sections;
    sections.style_texels = static_cast<std::uint32_t>(styles_.size());
    sections.profile_texels = static_cast<std::uint32_t>(profile_words_.size() / BURIN_POINTS_PER_TEXEL);
    sections.material_texels = static_cast<std::uint32_t>(materials_.size());
    sections.function_texels = static_cast<std::uint32_t>(functions_.size());
    for (const std::vector<Texel>* section : {&elements_, &styles_}) {
        for (const Texel& texel : *section) out_.data.insert(out_.data.end(), texel.begin(), texel.end());
    }
    out_.data.insert(out_.data.end(), profile_words_.begin(), profile_words_.end());
    for (const Texel& texel : materials_) out_.data.insert(out_.data.end(), texel.begin(), texel.end());
    if (sections.wide()) out_.data.insert(out_.data.end(), references_.begin(), references_.end());
    for (std::size_t i = 0; i < references_.size() && !sections.wide(); i += 2) {
        const std::uint32_t high = i + 1 < references_.size() ? references_[i + 1] : 0u;
        out_.data.push_back(references_[i] | high << 16);
    }
    out_.data.resize(std::size_t{4} * sections.functions_begin(), 0u);
    for (const Texel& texel : functions_) out_.data.insert(out_.data.end(), texel.begin(), texel.end());
    choose_sides(out_.sections.end(), out_.data_width, out_.data_height);
    if (out_.data_width > BURIN_MAX_TEXTURE_SIDE || out_.data_height > BURIN_MAX_TEXTURE_SIDE) {
        return limit("data texture needs " + text(out_.sections.end()) +
                     " texels, more than a texture holds");
    }
    out_.data.resize(std::size_t{4} * static_cast<std::size_t>(out_.data_width) *
                         static_cast<std::size_t>(out_.data_height),
                     0u);
    return {};
}

}  // namespace

Result<PackedTextures> pack_textures(const ResolvedPattern& pattern, const CellGrid& grid,
                                     const PackOptions& options, PackStatistics* statistics) {
    if (!(options.same_level >= 0.0 && options.same_level <= 0.01)) {
        return Error{ErrorCode::invalid_argument,
                     "same_level is " + std::to_string(options.same_level) + ", range [0, 0.01]"};
    }
    Packer packer(pattern, grid, options);
    Result<PackedTextures> textures = packer.run();
    if (statistics != nullptr) *statistics = packer.statistics();
    return textures;
}

PathDetail describe_pattern(const ResolvedPattern& pattern, const PackedTextures& textures) {
    PathDetail detail;
    detail.size_u = pattern.size.x;
    detail.size_v = pattern.size.y;
    detail.depth = pattern.depth;
    detail.base_offset = pattern.base_offset;
    detail.outer_level = pattern.outer_level;
    detail.repeat = pattern.wrap == Wrap::repeat;
    detail.grid_width = textures.grid_width;
    detail.grid_height = textures.grid_height;
    detail.data_width = textures.data_width;
    detail.data_height = textures.data_height;
    detail.sections = textures.sections;
    return detail;
}

}  // namespace burin
