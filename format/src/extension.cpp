#include <burin/format/extension.hpp>

#include <cmath>
#include <limits>

#include "extension_json.hpp"

namespace burin {
namespace {

using nlohmann::json;

const char* type_text(const json& value) { return value.type_name(); }

// A value for a message; containers by their type alone, since printing one recurses as deep as a hostile
// file nests.
std::string value_text(const json& value) {
    if (value.is_structured()) return std::string("an ") + type_text(value);
    return value.dump(-1, ' ', true, json::error_handler_t::replace).substr(0, 40);
}

bool is_length(double metres) { return metres >= BURIN_MIN_LENGTH && metres <= BURIN_MAX_LENGTH; }

// Looks up one property; reports a missing required one.
const json* find_property(const json& object, const char* name, bool required, const std::string& path,
                          Reporter& reporter) {
    const auto found = object.find(name);
    if (found != object.end()) return &*found;
    if (required) reporter.report(2004, std::string("property ") + name + " is missing", path);
    return nullptr;
}

bool read_number(const json& object, const char* name, bool required, double& out, Reporter& reporter) {
    const json* value = find_property(object, name, required, "", reporter);
    if (value == nullptr) return !required;
    if (!value->is_number()) {
        reporter.report(2005, std::string(name) + " is a " + type_text(*value) + ", a number is needed",
                        std::string("/") + name);
        return false;
    }
    out = value->get<double>();
    return true;
}

// Integer property of `object` (at `path`) within [low, high]; out of range is issue `range_issue`.
bool read_count(const json& object, const std::string& path, const char* name, std::int64_t low,
                std::int64_t high, int range_issue, std::int64_t& out, Reporter& reporter) {
    const json* value = find_property(object, name, true, path, reporter);
    if (value == nullptr) return false;
    const std::string place = path + "/" + name;
    std::int64_t number = 0;
    if (!value->is_number() || !read_integer(*value, std::numeric_limits<std::int64_t>::min(),
                                             std::numeric_limits<std::int64_t>::max(), number)) {
        reporter.report(2005, std::string(name) + " is " + value_text(*value) + ", an integer is needed",
                        place);
        return false;
    }
    if (number < low || number > high) {
        reporter.report(range_issue,
                        std::string(name) + " is " + std::to_string(number) + ", range [" +
                            std::to_string(low) + ", " + std::to_string(high) + "]",
                        place);
        return false;
    }
    out = number;
    return true;
}

void read_version(const json& extension, PathDetail& detail, Reporter& reporter) {
    std::int64_t version = 0;
    if (read_count(extension, "", "version", kPathDetailVersion, kPathDetailVersion, 2006, version,
                   reporter)) {
        detail.version = static_cast<int>(version);
    }
}

// Required property of `object` (at `path`): an array of two numbers.
bool read_two_numbers(const json& object, const std::string& path, const char* name, double& first, double& second, Reporter& reporter) {
    const json* pair = find_property(object, name, true, path, reporter);
    if (pair == nullptr) return false;
    if (!pair->is_array() || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number()) {
        reporter.report(2005, std::string(name) + " is " + value_text(*pair) + ", two numbers are needed", path + "/" + name);
        return false;
    }
    first = (*pair)[0].get<double>();
    second = (*pair)[1].get<double>();
    return true;
}

void read_size(const json& extension, PathDetail& detail, Reporter& reporter) {
    if (!read_two_numbers(extension, "", "size", detail.size_u, detail.size_v, reporter)) return;
    if (!is_length(detail.size_u) || !is_length(detail.size_v)) {
        reporter.report(2007,
                        "size is [" + number_text(detail.size_u) + ", " + number_text(detail.size_v) +
                            "], both must be lengths from 1e-9 to 1e9 m",
                        "/size");
    }
}

void read_heights(const json& extension, PathDetail& detail, Reporter& reporter) {
    const bool have_depth = read_number(extension, "depth", true, detail.depth, reporter);
    const bool have_base = read_number(extension, "baseOffset", false, detail.base_offset, reporter);
    const bool have_outer = read_number(extension, "outerLevel", false, detail.outer_level, reporter);
    if (!have_depth) return;
    if (!is_length(detail.depth)) {
        reporter.report(2008,
                        "depth is " + number_text(detail.depth) + ", a length from 1e-9 to 1e9 m is needed",
                        "/depth");
        return;
    }
    if (!have_base) return;
    if (!(detail.base_offset >= 0.0 && detail.base_offset <= detail.depth)) {
        reporter.report(2009,
                        "baseOffset is " + number_text(detail.base_offset) + ", range [0, " +
                            number_text(detail.depth) + "]",
                        "/baseOffset");
        return;
    }
    // Relative slack, since base_offset - depth is itself rounded.
    const double lowest = detail.base_offset - detail.depth, slack = 1e-9 * detail.depth;
    if (have_outer &&
        !(detail.outer_level >= lowest - slack && detail.outer_level <= detail.base_offset + slack)) {
        reporter.report(2010,
                        "outerLevel is " + number_text(detail.outer_level) + ", range [" +
                            number_text(lowest) + ", " + number_text(detail.base_offset) + "]",
                        "/outerLevel");
    }
}

void read_placement(const json& extension, PathDetail& detail, Reporter& reporter) {
    if (const json* wrap = find_property(extension, "wrap", false, "", reporter)) {
        if (!wrap->is_string()) {
            reporter.report(2005, std::string("wrap is a ") + type_text(*wrap) + ", a string is needed",
                            "/wrap");
        } else if (*wrap != "repeat" && *wrap != "clamp") {
            reporter.report(2011, "wrap is " + value_text(*wrap) + ", \"repeat\" or \"clamp\" is needed",
                            "/wrap");
        } else {
            detail.repeat = *wrap == "repeat";
        }
    }
    std::int64_t tex_coord = 0;
    if (extension.contains("texCoord") &&
        read_count(extension, "", "texCoord", 0, 255, 2012, tex_coord, reporter)) {
        detail.tex_coord = static_cast<int>(tex_coord);
    }
}

// "grid" or "data": its buffer view and sides. Returns the object, nullptr when it is not one.
const json* read_texture(const json& extension, const char* name, int& view, int& width, int& height,
                         Reporter& reporter) {
    const json* texture = find_property(extension, name, true, "", reporter);
    if (texture == nullptr) return nullptr;
    const std::string path = std::string("/") + name;
    if (!texture->is_object()) {
        reporter.report(2005, std::string(name) + " is a " + type_text(*texture) + ", an object is needed",
                        path);
        return nullptr;
    }
    std::int64_t number = 0;
    if (read_count(*texture, path, "bufferView", 0, std::numeric_limits<int>::max(), 2016, number,
                   reporter)) {
        view = static_cast<int>(number);
    }
    if (read_count(*texture, path, "width", 1, BURIN_MAX_TEXTURE_SIDE, 2013, number, reporter)) {
        width = static_cast<int>(number);
    }
    if (read_count(*texture, path, "height", 1, BURIN_MAX_TEXTURE_SIDE, 2013, number, reporter)) {
        height = static_cast<int>(number);
    }
    return texture;
}

void read_sections(const json& data, PathDetail& detail, Reporter& reporter) {
    const struct {
        const char* name;
        std::int64_t low, high;
        std::uint32_t Sections::*member;
    } rows[] = {
        {"elements", 0, BURIN_MAX_ELEMENT_TEXELS, &Sections::element_texels},
        {"styles", 0, BURIN_MAX_STYLES, &Sections::style_texels},
        {"profiles", 0, BURIN_MAX_PROFILE_TEXELS, &Sections::profile_texels},
        {"materials", 1, BURIN_MAX_MATERIALS, &Sections::material_texels},
        {"lists", 0, BURIN_MAX_LIST_TEXELS, &Sections::list_texels},
        {"functions", 0, BURIN_MAX_FUNCTION_TEXELS, &Sections::function_texels},
    };
    bool complete = true;
    for (const auto& row : rows) {
        std::int64_t number = 0;
        if (row.member == &Sections::function_texels && !data.contains(row.name)) continue;  // the one that may be absent
        if (read_count(data, "/data", row.name, row.low, row.high, 2015, number, reporter)) {
            detail.sections.*row.member = static_cast<std::uint32_t>(number);
        } else {
            complete = false;
        }
    }
    if (complete && detail.sections.list_texels > detail.sections.max_list_texels()) {
        reporter.report(2015, "lists is " + std::to_string(detail.sections.list_texels) + ", range [0, " +
                                  std::to_string(detail.sections.max_list_texels()) + "] where the pattern is not wide", "/data/lists");
    }
    const std::int64_t texels = std::int64_t{detail.data_width} * detail.data_height;
    if (complete && texels > 0 && detail.sections.end() > texels) {
        reporter.report(2014,
                        "the sections take " + std::to_string(detail.sections.end()) +
                            " texels, the data texture has " + std::to_string(texels),
                        "/data");
    }
}

// Whether its texture and image are there shows in the document alone.
void read_residual(const json& extension, PathDetail& detail, Reporter& reporter) {
    const json* residual = find_property(extension, "residualTexture", false, "", reporter);
    if (residual == nullptr) return;
    const std::string path = "/residualTexture";
    if (!residual->is_object()) {
        reporter.report(2005, std::string("residualTexture is a ") + type_text(*residual) + ", an object is needed", path);
        return;
    }
    std::int64_t number = 0;
    if (read_count(*residual, path, "index", 0, std::numeric_limits<int>::max(), 2023, number, reporter))
        detail.residual_texture = static_cast<int>(number);
    number = 0;
    const bool named = residual->contains("texCoord");
    if ((!named || read_count(*residual, path, "texCoord", 0, 255, 2026, number, reporter)) && number != detail.tex_coord)
        reporter.report(2026, "texCoord is " + std::to_string(number) + ", the pattern's is " +
                                  std::to_string(detail.tex_coord), path + "/texCoord");
    const auto scale = residual->find("scale");
    if (scale == residual->end()) return;
    if (!scale->is_number()) {
        reporter.report(2005, std::string("scale is a ") + type_text(*scale) + ", a number is needed", path + "/scale");
        return;
    }
    detail.residual_scale = scale->get<double>();
    if (!(detail.residual_scale > 0.0 && detail.residual_scale <= BURIN_MAX_LENGTH))
        reporter.report(2025, "scale is " + number_text(detail.residual_scale) + ", above 0 and at most 1e9 is needed",
                        path + "/scale");
}

bool read_chart_lengths(const json& table, const char* name, double low, std::array<double, 2>& out, Reporter& reporter) {
    if (!read_two_numbers(table, "/charts", name, out[0], out[1], reporter)) return false;
    for (const double length : out) {
        if (length >= low && length <= BURIN_MAX_LENGTH) continue;
        reporter.report(2043, std::string(name) + " is " + number_text(length) + ", range [" + number_text(low) + ", 1e9]",
                        std::string("/charts/") + name);
        return false;
    }
    return true;
}

void read_charts(const json& extension, PathDetail& detail, Reporter& reporter) {
    if (!extension.contains("charts")) return;
    ChartLayout& charts = detail.charts;
    const json* table = read_texture(extension, "charts", charts.view, charts.width, charts.height, reporter);
    if (table == nullptr) return;
    const struct {
        const char* name;
        std::int64_t most;
        int ChartLayout::*member;
    } rows[] = {{"borders", BURIN_MAX_BORDERS, &ChartLayout::borders},
                {"columns", BURIN_MAX_CHART_CELLS, &ChartLayout::columns},
                {"rows", BURIN_MAX_CHART_CELLS, &ChartLayout::rows}};
    bool complete = charts.width > 0 && charts.height > 0;
    for (const auto& row : rows) {
        std::int64_t number = 0;
        if (read_count(*table, "/charts", row.name, 1, row.most, 2043, number, reporter)) charts.*row.member = static_cast<int>(number);
        else complete = false;
    }
    complete = read_chart_lengths(*table, "origin", -BURIN_MAX_LENGTH, charts.origin, reporter) && complete;
    complete = read_chart_lengths(*table, "cell", BURIN_MIN_LENGTH, charts.cell, reporter) && complete;
    const std::size_t texels = static_cast<std::size_t>(charts.width) * static_cast<std::size_t>(charts.height);
    if (complete && charts.first_reference() > texels)
        reporter.report(2044, "borders and cells take " + std::to_string(charts.first_reference()) + " texels, the table has " +
                                  std::to_string(texels), "/charts");
}

}  // namespace

bool read_integer(const json& value, std::int64_t low, std::int64_t high, std::int64_t& out) {
    if (value.is_number_unsigned()) {
        const auto number = value.get<std::uint64_t>();
        if (number > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return false;
        out = static_cast<std::int64_t>(number);
    } else if (value.is_number_integer()) {
        out = value.get<std::int64_t>();
    } else if (value.is_number_float()) {
        const double number = value.get<double>();
        if (!(std::abs(number) < 9e15) || number != std::floor(number)) return false;
        out = static_cast<std::int64_t>(number);
    } else {
        return false;
    }
    return out >= low && out <= high;
}

bool read_extension(const json& extension, PathDetail& detail, Reporter& reporter) {
    const std::size_t errors = reporter.errors();
    if (!extension.is_object()) {
        reporter.report(2003,
                        std::string("the extension is a ") + type_text(extension) + ", an object is needed");
        return false;
    }
    detail = PathDetail{};
    read_version(extension, detail, reporter);
    read_size(extension, detail, reporter);
    read_heights(extension, detail, reporter);
    read_placement(extension, detail, reporter);
    read_texture(extension, "grid", detail.grid_view, detail.grid_width, detail.grid_height, reporter);
    const json* data =
        read_texture(extension, "data", detail.data_view, detail.data_width, detail.data_height, reporter);
    if (data != nullptr) read_sections(*data, detail, reporter);
    read_residual(extension, detail, reporter);
    read_charts(extension, detail, reporter);
    return reporter.errors() == errors;
}

std::string write_extension(const PathDetail& d) {
    nlohmann::ordered_json extension;
    extension["version"] = d.version;
    extension["size"] = {d.size_u, d.size_v};
    extension["depth"] = d.depth;
    extension["baseOffset"] = d.base_offset;
    extension["outerLevel"] = d.outer_level;
    extension["wrap"] = d.repeat ? "repeat" : "clamp";
    extension["texCoord"] = d.tex_coord;
    extension["grid"] = {{"bufferView", d.grid_view}, {"width", d.grid_width}, {"height", d.grid_height}};
    extension["data"] = {{"bufferView", d.data_view},
                         {"width", d.data_width},
                         {"height", d.data_height},
                         {"elements", d.sections.element_texels},
                         {"styles", d.sections.style_texels},
                         {"profiles", d.sections.profile_texels},
                         {"materials", d.sections.material_texels},
                         {"lists", d.sections.list_texels}};
    if (d.sections.function_texels > 0) extension["data"]["functions"] = d.sections.function_texels;
    if (d.residual_texture >= 0) {
        extension["residualTexture"] = {
            {"index", d.residual_texture}, {"texCoord", d.tex_coord}, {"scale", d.residual_scale}};
    }
    if (d.charts.borders > 0) {
        const ChartLayout& c = d.charts;
        extension["charts"] = {{"bufferView", c.view}, {"width", c.width}, {"height", c.height}, {"borders", c.borders},
                               {"columns", c.columns}, {"rows", c.rows}, {"origin", c.origin}, {"cell", c.cell}};
    }
    return extension.dump();
}

Result<PathDetail> parse_extension(std::string_view text) {
    const json extension = json::parse(text, nullptr, false);
    if (extension.is_discarded()) return Error{ErrorCode::invalid_input, "extension object is not JSON"};
    Issue first;
    const IssueSink sink = [&first](const Issue& issue) {
        if (first.number == 0 && issue.severity == Severity::error) first = issue;
    };
    Reporter reporter(sink, 1);
    PathDetail detail;
    if (read_extension(extension, detail, reporter)) return detail;
    return Error{first.number == 2006 ? ErrorCode::unsupported : ErrorCode::invalid_input,
                 std::string(kPathDetailExtension) + first.pointer + ": " + first.message};
}

}  // namespace burin
