// The validator's order of work: container, extension JSON, buffer views, textures; one function per step.
#include <burin/format/validate.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "container.hpp"
#include "extension_json.hpp"
#include "layout.h"
#include "texture_check.hpp"

namespace burin {
namespace {

using nlohmann::json;

bool names_extension(const json& document, const char* list, Reporter& reporter) {
    const json* names = find_array(document, list, reporter);
    if (names == nullptr) return false;
    return std::any_of(names->begin(), names->end(), [](const json& name) {
        return name.is_string() && name.get_ref<const std::string&>() == kPathDetailExtension;
    });
}

const json* find_extension(const json& material) {
    if (!material.is_object()) return nullptr;
    const auto extensions = material.find("extensions");
    if (extensions == material.end() || !extensions->is_object()) return nullptr;
    const auto found = extensions->find(std::string(kPathDetailExtension));
    return found == extensions->end() ? nullptr : &*found;
}

// Sizes that do not fit make every further check meaningless.
bool check_sizes(const PackedTextures& t, const PathDetail& d, Reporter& reporter) {
    const auto words = [](int width, int height, std::size_t channels) {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels;
    };
    const auto side = [](int value) { return value >= 1 && value <= BURIN_MAX_TEXTURE_SIDE; };
    if (!side(t.grid_width) || !side(t.grid_height) || !side(t.data_width) || !side(t.data_height)) {
        reporter.report(2013, "a texture's side is outside of [1, 4096]");
        return false;
    }
    const bool same = t.grid_width == d.grid_width && t.grid_height == d.grid_height &&
                      t.data_width == d.data_width && t.data_height == d.data_height;
    if (!same || t.grid.size() != words(t.grid_width, t.grid_height, 2) ||
        t.data.size() != words(t.data_width, t.data_height, 4)) {
        reporter.report(2017, "the textures' words do not make up the sides that the extension states");
        return false;
    }
    const Sections& s = t.sections;
    const bool limits = s.element_texels <= BURIN_MAX_ELEMENT_TEXELS && s.style_texels <= BURIN_MAX_STYLES &&
                        s.profile_texels <= BURIN_MAX_PROFILE_TEXELS && s.material_texels >= 1 &&
                        s.material_texels <= BURIN_MAX_MATERIALS && s.list_texels <= s.max_list_texels() &&
                        s.function_texels <= BURIN_MAX_FUNCTION_TEXELS;
    const bool equal =
        s.element_texels == d.sections.element_texels && s.style_texels == d.sections.style_texels &&
        s.profile_texels == d.sections.profile_texels && s.material_texels == d.sections.material_texels &&
        s.list_texels == d.sections.list_texels && s.function_texels == d.sections.function_texels;
    if (!limits || !equal) {
        reporter.report(2015,
                        "a section's length is beyond its limit or not the one that the extension states");
        return false;
    }
    if (s.end() > words(t.data_width, t.data_height, 1)) {
        reporter.report(
            2014, "the sections take " + std::to_string(s.end()) + " texels, more than the texture has");
        return false;
    }
    return true;
}

void check_textures(const PackedTextures& textures, const PathDetail& detail, Reporter& reporter) {
    if (!check_sizes(textures, detail, reporter)) return;
    const DecodedData data = check_data(textures, detail, reporter);
    check_grid(textures, detail, data, reporter);
    check_steps(textures, detail, data, reporter);
}

// Entry `object[key]` of the document's `array`; nullptr when there is none.
const json* referred(const json& document, const char* array, const json& object, const char* key) {
    const auto list = document.find(array);
    const auto index = object.find(key);
    std::int64_t place = 0;
    if (list == document.end() || !list->is_array() || index == object.end() || !index->is_number() ||
        !read_integer(*index, 0, static_cast<std::int64_t>(list->size()) - 1, place))
        return nullptr;
    const json& entry = (*list)[static_cast<std::size_t>(place)];
    return entry.is_object() ? &entry : nullptr;
}

// Whether the bytes can be looked for; what is in them is not checked.
bool has_picture(const json& document, const json& image) {
    if (image.contains("uri")) return image["uri"].is_string();
    const auto type = image.find("mimeType");
    return referred(document, "bufferViews", image, "bufferView") != nullptr && type != image.end() &&
           (*type == "image/png" || *type == "image/jpeg");
}

void check_sampler(const json& document, const json& texture, bool repeat, Reporter& reporter) {
    constexpr std::int64_t kRepeat = 10497, kClampToEdge = 33071;
    const json* sampler = referred(document, "samplers", texture, "sampler");
    for (const char* key : {"wrapS", "wrapT"}) {
        std::int64_t wrap = kRepeat;
        if (sampler != nullptr && sampler->contains(key) && (*sampler)[key].is_number())
            (void)read_integer((*sampler)[key], 0, 1 << 16, wrap);
        if (wrap != (repeat ? kRepeat : kClampToEdge))
            reporter.report(2027, std::string(key) + " of its sampler is " + std::to_string(wrap) + ", " +
                                      std::to_string(repeat ? kRepeat : kClampToEdge) + " is needed",
                            "/residualTexture/index");
    }
}

void check_residual(const json& document, const json& extension, const PathDetail& detail, Reporter& reporter) {
    if (detail.residual_texture < 0) return;
    const std::string place = "/residualTexture/index", index = std::to_string(detail.residual_texture);
    const json* texture = referred(document, "textures", extension["residualTexture"], "index");
    if (texture == nullptr) {
        reporter.report(2023, "there is no texture " + index, place);
        return;
    }
    const json* image = referred(document, "images", *texture, "source");
    if (image == nullptr || !has_picture(document, *image))
        reporter.report(2024, "texture " + index + " leads to no image of type image/png or image/jpeg", place);
    check_sampler(document, *texture, detail.repeat, reporter);
}

// Lists stay inside the table and name borders that are there; borders are finite.
void check_charts(const ChartLayout& charts, const std::vector<std::uint32_t>& words, Reporter& reporter) {
    constexpr std::size_t kScale = 12, kAngle = 13;
    for (std::size_t i = 0; i < static_cast<std::size_t>(charts.borders); ++i)
        for (std::size_t k = 0; k < 14; ++k) {
            const float number = std::bit_cast<float>(words[16 * i + k]);
            const bool good = std::isfinite(number) && (k != kScale || number > 0.0f) && (k != kAngle || std::abs(number) <= float(BURIN_MOST_EDGE_ANGLE));
            if (good) continue;
            reporter.report(2046, "number " + std::to_string(k) + " of border " + std::to_string(i) + " is " + number_text(double(number)) +
                                      ", not finite or out of its range", "/charts");
            break;
        }
    const std::size_t cells = static_cast<std::size_t>(charts.columns) * static_cast<std::size_t>(charts.rows);
    const std::size_t references = 4 * charts.first_reference(), room = words.size() - references;
    for (std::size_t i = 0; i < cells; ++i) {
        const std::uint64_t first = words[4 * charts.first_cell() + 2 * i], count = words[4 * charts.first_cell() + 2 * i + 1];
        bool good = first + count <= room;
        for (std::uint64_t k = first; good && k < first + count; ++k)
            good = words[references + k] < static_cast<std::uint32_t>(charts.borders);
        if (!good) reporter.report(2045, "the list of cell " + std::to_string(i) + " leads out of the table", "/charts");
    }
}

void check_material(const json& document, const json& extension, Buffers& buffers, Reporter& reporter) {
    PathDetail detail;
    const std::string prefix = reporter.prefix();
    if (!read_extension(extension, detail, reporter)) return;
    check_residual(document, extension, detail, reporter);
    const auto texels = [](int width, int height) {
        return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    };
    reporter.set_prefix({});
    const auto grid =
        buffers.view(detail.grid_view, 8 * texels(detail.grid_width, detail.grid_height), prefix + "/grid");
    const auto data =
        buffers.view(detail.data_view, 16 * texels(detail.data_width, detail.data_height), prefix + "/data");
    const bool charted = detail.charts.borders > 0;
    const auto charts = charted ? buffers.view(detail.charts.view, 16 * texels(detail.charts.width, detail.charts.height), prefix + "/charts")
                                : std::nullopt;
    reporter.set_prefix(prefix);
    if (charts) check_charts(detail.charts, words_from_bytes(*charts), reporter);
    if (!grid || !data) return;
    check_textures({detail.grid_width, detail.grid_height, words_from_bytes(*grid), detail.data_width,
                    detail.data_height, words_from_bytes(*data), detail.sections},
                   detail, reporter);
}

// Accessor of an attribute of a primitive; nullptr when there is none.
const json* accessor_of(const json& document, const json& primitive, const char* name) {
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) return nullptr;
    return referred(document, "accessors", *attributes, name);
}

// Whether an attribute is of `type`, in floats, one per vertex.
bool is_float_attribute(const json& document, const json& primitive, const char* name, const char* type) {
    constexpr std::int64_t kFloat = 5126;
    const json* accessor = accessor_of(document, primitive, name);
    const json* positions = accessor_of(document, primitive, "POSITION");
    std::int64_t component = 0;
    return accessor != nullptr && positions != nullptr && accessor->value("type", json()) == type &&
           accessor->contains("componentType") && read_integer((*accessor)["componentType"], 0, 1 << 16, component) &&
           component == kFloat && accessor->value("count", json()) == positions->value("count", json());
}

// The derivatives of the position are all there or none, in the form that a reader expects.
void check_frames(const json& document, const json& primitive, const std::string& place, Reporter& reporter) {
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) return;
    std::string missing;
    std::size_t found = 0;
    for (const char* name : kFrameAttributes) {
        if (attributes->contains(name)) ++found;
        else missing = name;
    }
    if (found == 0) return;
    if (found < kFrameAttributes.size())
        reporter.report(2040, "the primitive has derivatives of the position but no " + missing, place);
    for (const char* name : kFrameAttributes) {
        if (attributes->contains(name) && !is_float_attribute(document, primitive, name, "VEC3"))
            reporter.report(2041, std::string(name) + " must be VEC3 of FLOAT (5126), as many as positions",
                            place + "/attributes/" + name);
    }
}

// Where the material has borders, every vertex says in which chart it lies.
void check_chart_numbers(const json& document, const json& primitive, bool charted, const std::string& place, Reporter& reporter) {
    const auto attributes = primitive.find("attributes");
    const bool named = attributes != primitive.end() && attributes->is_object() && attributes->contains(kChartAttribute);
    std::int64_t mode = 4;
    if (primitive.contains("mode")) read_integer(primitive["mode"], 0, 6, mode);
    const bool lines = mode < 4;  // and points have no charts
    if (!named && (!charted || lines)) return;
    if (!is_float_attribute(document, primitive, kChartAttribute, "SCALAR"))
        reporter.report(2042, std::string(kChartAttribute) + " must be SCALAR of FLOAT (5126), as many as positions", place);
}

// A primitive with the material needs the texture coordinates that the extension names.
// `charted`: materials with borders.
void check_primitives(const json& document, const std::map<std::size_t, std::string>& attribute_of_material,
                      const std::set<std::size_t>& charted, Reporter& reporter) {
    const json* meshes = find_array(document, "meshes", reporter);
    if (meshes == nullptr) return;
    for (std::size_t m = 0; m < meshes->size(); ++m) {
        const json& mesh = (*meshes)[m];
        const auto primitives = mesh.is_object() ? mesh.find("primitives") : mesh.end();
        if (!mesh.is_object() || primitives == mesh.end() || !primitives->is_array()) continue;
        for (std::size_t p = 0; p < primitives->size(); ++p) {
            const json& primitive = (*primitives)[p];
            std::int64_t material = 0;
            if (!primitive.is_object() || !primitive.contains("material") ||
                !read_integer(primitive["material"], 0, 1 << 30, material)) {
                continue;
            }
            const auto wanted = attribute_of_material.find(static_cast<std::size_t>(material));
            if (wanted == attribute_of_material.end()) continue;
            const std::string place = "/meshes/" + std::to_string(m) + "/primitives/" + std::to_string(p);
            check_frames(document, primitive, place, reporter);
            check_chart_numbers(document, primitive, charted.contains(static_cast<std::size_t>(material)), place, reporter);
            const auto attributes = primitive.find("attributes");
            if (attributes != primitive.end() && attributes->is_object() &&
                attributes->contains(wanted->second))
                continue;
            reporter.report(
                2022, "the primitive has no " + wanted->second + ", which its material's texCoord names", place);
        }
    }
}

void check_document(const Container& container, const ValidateOptions& options, Reporter& reporter) {
    const json& document = container.document;
    const bool used = names_extension(document, "extensionsUsed", reporter);
    if (names_extension(document, "extensionsRequired", reporter)) {
        reporter.report(2002,
                        "the extension is listed in extensionsRequired, its fallback would never be shown",
                        "/extensionsRequired");
    }
    const json* materials = find_array(document, "materials", reporter);
    Buffers buffers(container, options, reporter);
    std::map<std::size_t, std::string> attribute_of_material;
    std::set<std::size_t> charted;
    bool used_by_material = false;
    for (std::size_t i = 0; materials != nullptr && i < materials->size(); ++i) {
        const json* extension = find_extension((*materials)[i]);
        if (extension == nullptr) continue;
        std::int64_t tex_coord = 0;
        const bool named = extension->is_object() && extension->contains("texCoord");
        if (!named || read_integer((*extension)["texCoord"], 0, 255, tex_coord)) {
            attribute_of_material[i] = "TEXCOORD_" + std::to_string(tex_coord);
        }
        if (extension->is_object() && extension->contains("charts")) charted.insert(i);
        used_by_material = true;
        reporter.set_prefix("/materials/" + std::to_string(i) + "/extensions/" +
                            std::string(kPathDetailExtension));
        check_material(document, *extension, buffers, reporter);
        reporter.set_prefix({});
    }
    if (used_by_material && !used) {
        reporter.report(2001, "a material has the extension, extensionsUsed does not list it",
                        "/extensionsUsed");
    }
    if (!used_by_material) {
        reporter.report(2021, "no material has " + std::string(kPathDetailExtension), "/materials");
    }
    check_primitives(document, attribute_of_material, charted, reporter);
}

}  // namespace

void validate_glb(std::span<const std::uint8_t> bytes, const IssueSink& sink,
                  const ValidateOptions& options) {
    Reporter reporter(sink, options.max_issues_per_number);
    const std::optional<Container> container = read_container(bytes, reporter);
    if (container) check_document(*container, options, reporter);
    reporter.close();
}

bool validate_charts(const ChartLayout& charts, const std::vector<std::uint32_t>& words, const IssueSink& sink) {
    Reporter reporter(sink, ValidateOptions{}.max_issues_per_number);
    check_charts(charts, words, reporter);
    reporter.close();
    return reporter.errors() == 0;
}

bool validate_textures(const PackedTextures& textures, const PathDetail& detail, const IssueSink& sink,
                       std::string_view pointer) {
    Reporter reporter(sink, ValidateOptions{}.max_issues_per_number);
    reporter.set_prefix(pointer);
    check_textures(textures, detail, reporter);
    reporter.close();
    return reporter.errors() == 0;
}

std::vector<std::uint32_t> words_from_bytes(std::span<const std::uint8_t> bytes) {
    std::vector<std::uint32_t> words(bytes.size() / 4);
    for (std::size_t i = 0; i < words.size(); ++i) {
        words[i] = static_cast<std::uint32_t>(bytes[4 * i]) |
                   static_cast<std::uint32_t>(bytes[4 * i + 1]) << 8 |
                   static_cast<std::uint32_t>(bytes[4 * i + 2]) << 16 |
                   static_cast<std::uint32_t>(bytes[4 * i + 3]) << 24;
    }
    return words;
}

std::vector<std::uint8_t> bytes_from_words(std::span<const std::uint32_t> words) {
    std::vector<std::uint8_t> bytes(words.size() * 4);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<std::uint8_t>(words[i / 4] >> (8 * (i % 4)));
    }
    return bytes;
}

}  // namespace burin
