#include "sample_file.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <burin/format/validate.hpp>

namespace burin::test {
namespace {

constexpr int kCells = 8;
constexpr std::uint32_t kGround = 65535, kSunken = 32768;

PointCode point(double u, double v) {
    PointCode p;
    if (!encode_coordinate(u, p.u) || !encode_coordinate(v, p.v)) std::abort();
    return p;
}

ElementCode line(PointCode p0, PointCode p2, EndCode start, EndCode end, std::uint32_t style) {
    ElementCode e;
    e.p0 = p0;
    e.p2 = p2;
    e.start = start;
    e.end = end;
    e.style = style;
    return e;
}

constexpr EndCode kHip{BURIN_PRIORITY_BOTH, BURIN_END_HIP, 0};
constexpr EndCode kJoint{BURIN_PRIORITY_BOTH, BURIN_END_CLIP, 2048};

EndCode mitre(std::uint32_t angle) { return {BURIN_PRIORITY_LEFT, BURIN_CORNER_MITRE, angle}; }

// The square runs clockwise on screen, so its inside is on the right and its outer sectors are on the left.
std::vector<ElementCode> sample_elements() {
    const std::array<PointCode, 4> corner = {point(0.66, 0.66), point(0.84, 0.66), point(0.84, 0.84),
                                             point(0.66, 0.84)};
    const std::array<std::uint32_t, 4> bisector = {1024, 3072, 1024, 3072};
    std::vector<ElementCode> elements;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        elements.push_back(line(corner[i], corner[next], mitre(bisector[i]), mitre(bisector[next]), 0));
    }
    elements.back().has_texel_b = elements.back().has_texel_c = true;
    elements.back().argument1 = 98304;
    elements.back().function = 1;
    elements.push_back(line(point(0.05, 0.2), point(0.3, 0.2), kHip, kJoint, 1));
    ElementCode curve = line(point(0.3, 0.2), point(0.44, 0.23), kJoint, kHip, 1);
    curve.quadratic = curve.has_texel_b = true;
    curve.p1 = point(0.4, 0.2);
    elements.push_back(curve);
    ElementCode scaled = line(point(0.1, 0.7), point(0.3, 0.7), kHip, kHip, 2);
    scaled.has_texel_b = true;
    scaled.width0 = 8192;
    elements.push_back(scaled);
    elements.push_back(line(point(0.1, 0.85), point(0.3, 0.85), kHip, kHip, 1));
    elements.back().has_texel_c = true;
    elements.back().argument0 = 65536, elements.back().argument1 = 3 * 65536;
    return elements;
}

std::vector<FunctionCode> sample_functions() {
    FunctionCode noise, sine, polynomial;
    noise.kind = BURIN_FUNCTION_NOISE;
    noise.octaves = 3;
    noise.seed = 77;
    noise.period = 3;
    noise.width = 3000, noise.height = -2000;
    sine.width = 9000;
    polynomial.kind = BURIN_FUNCTION_POLYNOMIAL;
    polynomial.coefficients = {0.5f, 1.0f, -0.5f, 0.25f, 1.0f, 0.0f, 0.5f, -1.0f};
    return {noise, sine, polynomial, sine};
}

std::vector<StyleCode> sample_styles() {
    StyleCode step;
    step.profile_texel = 0;
    step.point_count = 2;
    step.step = true;
    step.level_left = kGround;
    step.level_right = kSunken;
    step.reach = 0.01f;
    step.internal_mask = 1;
    StyleCode groove;
    groove.profile_texel = 1;
    groove.point_count = 3;
    groove.level_left = groove.level_right = kGround;
    groove.reach = 0.01f;
    groove.internal_mask = 3;
    StyleCode painted = groove;
    painted.material = 1;
    return {step, groove, painted};
}

struct Listed {
    int i, j;
    std::uint32_t first, count, flags;
    std::uint32_t level, lowest;
};

constexpr std::uint32_t kIsolated = BURIN_CELL_FLAG_ISOLATED, kStep = BURIN_CELL_FLAG_STEP;
// References: the cells of the square find their pairs in the runs 0 1 2 3 and 0 3.
constexpr std::array<std::uint32_t, 10> kReferences = {0, 1, 2, 3, 0, 3, 6, 7, 9, 11};
constexpr std::array<Listed, 14> kListed = {{{5, 5, 4, 2, kStep, kSunken, 127},
                                             {6, 5, 0, 2, kStep, kSunken, 127},
                                             {6, 6, 1, 2, kStep, kSunken, 127},
                                             {5, 6, 2, 2, kStep, kSunken, 127},
                                             {0, 1, 6, 1, kIsolated, kGround, 190},
                                             {1, 1, 6, 1, kIsolated, kGround, 190},
                                             {2, 1, 6, 2, kIsolated, kGround, 190},
                                             {3, 1, 7, 1, kIsolated, kGround, 190},
                                             {0, 5, 8, 1, kIsolated, kGround, 190},
                                             {1, 5, 8, 1, kIsolated, kGround, 190},
                                             {2, 5, 8, 1, kIsolated, kGround, 190},
                                             {0, 6, 9, 1, kIsolated, kGround, 190},
                                             {1, 6, 9, 1, kIsolated, kGround, 190},
                                             {2, 6, 9, 1, kIsolated, kGround, 190}}};

int distance_along(int a, int b) {
    const int d = std::abs(a - b);
    return std::min(d, kCells - d);
}

std::uint32_t skip_of(int i, int j) {
    int nearest = 16;
    for (const Listed& cell : kListed) {
        nearest = std::min(nearest, std::max(distance_along(i, cell.i), distance_along(j, cell.j)));
    }
    return nearest == 0 ? 0u : static_cast<std::uint32_t>(nearest - 1);
}

void fill_grid(PackedTextures& t) {
    t.grid_width = t.grid_height = kCells;
    t.grid.assign(2 * kCells * kCells, 0);
    for (int j = 0; j < kCells; ++j) {
        for (int i = 0; i < kCells; ++i)
            set_cell(t, i, j, {0, 0, skip_of(i, j), kIsolated, kGround, 255, 255});
    }
    for (const Listed& c : kListed)
        set_cell(t, c.i, c.j, {c.first, c.count, 0, c.flags, c.level, 255, c.lowest});
}

std::uint32_t profile_word(std::int32_t b, std::int32_t h) { return pack_profile_point({b, h}); }

}  // namespace

SampleFile make_sample_file() {
    SampleFile file;
    PackedTextures& t = file.textures;
    fill_grid(t);
    for (const ElementCode& element : sample_elements()) {
        const std::array<Texel, 3> texels = pack_element(element);
        t.data.insert(t.data.end(), texels[0].begin(), texels[0].end());
        if (element.has_texel_b) t.data.insert(t.data.end(), texels[1].begin(), texels[1].end());
        if (element.has_texel_c) t.data.insert(t.data.end(), texels[2].begin(), texels[2].end());
    }
    t.sections.element_texels = static_cast<std::uint32_t>(t.data.size() / 4);
    for (const StyleCode& style : sample_styles()) {
        const Texel texel = pack_style(style);
        t.data.insert(t.data.end(), texel.begin(), texel.end());
    }
    t.sections.style_texels = 3;
    t.data.insert(t.data.end(), {profile_word(0, 0), profile_word(32767, -16383), 0, 0,
                                 profile_word(-32767, 0), profile_word(0, -8000), profile_word(32767, 0), 0});
    t.sections.profile_texels = 2;
    MaterialCode painted;
    painted.overrides = true;
    painted.base_color = {200, 100, 50, 255};
    painted.metallic = 255;
    painted.roughness = 60;
    for (const MaterialCode& material : {MaterialCode{}, painted}) {
        const Texel texel = pack_material(material);
        t.data.insert(t.data.end(), texel.begin(), texel.end());
    }
    t.sections.material_texels = 2;
    t.sections.list_texels = 2;
    t.data.resize(4 * std::size_t{t.sections.functions_begin()}, 0);
    for (const FunctionCode& function : sample_functions()) {
        const std::array<Texel, 3> texels = pack_function(function);
        for (std::uint32_t k = 0; k < function_texel_count(texels[0]); ++k)
            t.data.insert(t.data.end(), texels[k].begin(), texels[k].end());
    }
    t.sections.function_texels = 6;
    t.data_width = 6;
    t.data_height = 5;
    t.data.resize(4 * 30, 0);
    for (std::uint32_t k = 0; k < kReferences.size(); ++k) set_reference(t, k, kReferences[k]);
    file.detail.grid_width = t.grid_width;
    file.detail.grid_height = t.grid_height;
    file.detail.data_width = t.data_width;
    file.detail.data_height = t.data_height;
    file.detail.sections = t.sections;
    file.detail.grid_view = 0;
    file.detail.data_view = 1;
    return file;
}

void set_cell(PackedTextures& t, int i, int j, const CellCode& cell) {
    const CellTexel texel = pack_cell(cell);
    const std::size_t at = 2 * static_cast<std::size_t>(j * t.grid_width + i);
    t.grid[at] = texel[0];
    t.grid[at + 1] = texel[1];
}

CellCode get_cell(const PackedTextures& t, int i, int j) {
    return unpack_cell(cell_texel(t, static_cast<std::uint32_t>(j * t.grid_width + i)));
}

void set_data(PackedTextures& t, std::uint32_t index, const Texel& texel) {
    std::copy(texel.begin(), texel.end(), t.data.begin() + 4 * static_cast<std::ptrdiff_t>(index));
}

ElementCode get_element(const PackedTextures& t, std::uint32_t texel) {
    return element_at(t, texel);
}

void set_element(PackedTextures& t, std::uint32_t texel, const ElementCode& element) {
    const std::array<Texel, 3> texels = pack_element(element);
    set_data(t, texel, texels[0]);
    if (element.has_texel_b) set_data(t, texel + 1, texels[1]);
    if (element.has_texel_c) set_data(t, texel + element_texel_count(texels[0]) - 1, texels[2]);
}

StyleCode get_style(const PackedTextures& t, std::uint32_t index) {
    return unpack_style(data_texel(t, t.sections.styles_begin() + index));
}

void set_style(PackedTextures& t, std::uint32_t index, const StyleCode& style) {
    set_data(t, t.sections.styles_begin() + index, pack_style(style));
}

void set_profile_word(PackedTextures& t, std::uint32_t word, std::uint32_t value) {
    t.data[4 * std::size_t{t.sections.profiles_begin()} + word] = value;
}

void set_reference(PackedTextures& t, std::uint32_t index, std::uint32_t value) {
    std::uint32_t& word = t.data[4 * std::size_t{t.sections.lists_begin()} + index / 2];
    const unsigned shift = 16 * (index & 1u);
    word = (word & ~(0xFFFFu << shift)) | value << shift;
}

nlohmann::json make_document(const SampleFile& file, std::uint32_t lead) {
    using nlohmann::json;
    const std::size_t grid_bytes = 4 * file.textures.grid.size(), data_bytes = 4 * file.textures.data.size();
    json document;
    document["asset"]["version"] = "2.0";
    const std::string name(kPathDetailExtension);
    document["extensionsUsed"] = json::array({name});
    document["materials"] = json::array({json::object()});
    document["materials"][0]["extensions"][name] = json::parse(write_extension(file.detail));
    document["buffers"] = json::array({{{"byteLength", lead + grid_bytes + data_bytes}}});
    document["bufferViews"] =
        json::array({{{"buffer", 0}, {"byteOffset", lead}, {"byteLength", grid_bytes}},
                     {{"buffer", 0}, {"byteOffset", lead + grid_bytes}, {"byteLength", data_bytes}}});
    json primitive;
    primitive["attributes"] = {{"POSITION", 0}, {"TEXCOORD_0", 1}};
    primitive["material"] = 0;
    document["meshes"] = json::array({{{"primitives", json::array({primitive})}}});
    return document;
}

std::vector<std::uint8_t> make_bin(const SampleFile& file, std::uint32_t lead) {
    std::vector<std::uint8_t> bin(lead, 0);
    for (const std::vector<std::uint32_t>* words : {&file.textures.grid, &file.textures.data}) {
        const std::vector<std::uint8_t> bytes = bytes_from_words(*words);
        bin.insert(bin.end(), bytes.begin(), bytes.end());
    }
    return bin;
}

std::vector<std::uint8_t> make_glb(const nlohmann::json& document, const std::vector<std::uint8_t>& bin) {
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::uint8_t> padded = bin;
    padded.resize((bin.size() + 3) / 4 * 4, 0);
    const auto size = [](std::size_t bytes) { return static_cast<std::uint32_t>(bytes); };
    std::vector<std::uint32_t> header = {0x46546C67, 2, size(28 + text.size() + padded.size()),
                                         size(text.size()), 0x4E4F534A};
    std::vector<std::uint8_t> glb = bytes_from_words(header);
    glb.insert(glb.end(), text.begin(), text.end());
    const std::vector<std::uint8_t> chunk =
        bytes_from_words(std::vector<std::uint32_t>{size(padded.size()), 0x004E4942});
    glb.insert(glb.end(), chunk.begin(), chunk.end());
    glb.insert(glb.end(), padded.begin(), padded.end());
    return glb;
}

}  // namespace burin::test
