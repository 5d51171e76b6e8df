// The JSON of the material extension BURIN_materials_path_detail as a struct.
//
//     "extensions": { "BURIN_materials_path_detail": {
//         "version": 1, "size": [1.0, 1.0], "depth": 0.01, "baseOffset": 0.0, "outerLevel": 0.0,
//         "wrap": "repeat", "texCoord": 0,
//         "grid": { "bufferView": 3, "width": 32, "height": 32 },
//         "data": { "bufferView": 4, "width": 20, "height": 19,
//                   "elements": 210, "styles": 9, "profiles": 18, "materials": 1, "lists": 140 },
//         "residualTexture": { "index": 0, "scale": 0.3 } } }
//
// Meaning of each property: BURIN_materials_path_detail/README.md. The name goes into `extensionsUsed` only.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include <burin/format/texels.hpp>
#include <burin/result.hpp>

namespace burin {

inline constexpr std::string_view kPathDetailExtension = "BURIN_materials_path_detail";
inline constexpr int kPathDetailVersion = 1;
// Vertex attributes of primitives with the material: derivatives of the position by u and v, SPECIFICATION.md section 14.
inline constexpr std::array<const char*, 5> kFrameAttributes = {"_BURIN_DU", "_BURIN_DV", "_BURIN_DUU", "_BURIN_DUV",
                                                                "_BURIN_DVV"};

// And the number of a vertex' chart, section 14.1.
inline constexpr const char* kChartAttribute = "_BURIN_CHART";

// "charts": the table of borders over which rays go from chart to chart. No borders: there is none.
struct ChartLayout {
    int view = -1;                           // bufferView index; -1: not yet known
    int width = 0, height = 0;               // texels
    int borders = 0;                         // [1, 2^20]
    int columns = 0, rows = 0;               // cells of the grid over the borders, [1, 1024] each
    std::array<double, 2> origin{}, cell{};  // of that grid, metres of the pattern; cell > 0

    std::size_t first_cell() const { return std::size_t(borders) * BURIN_BORDER_TEXELS; }  // texels
    std::size_t first_reference() const { return first_cell() + (std::size_t(columns) * std::size_t(rows) + 1) / 2; }
};

struct PathDetail {
    int version = kPathDetailVersion;
    double size_u = 1.0, size_v = 1.0;    // metres per uv unit, > 0
    double depth = 0.01;                  // metres, > 0
    double base_offset = 0.0;             // metres, [0, depth]
    double outer_level = 0.0;             // metres, [base_offset - depth, base_offset]
    bool repeat = true;                   // "wrap": "repeat" or "clamp"
    int tex_coord = 0;                    // >= 0
    int grid_view = -1, data_view = -1;   // bufferView indices; -1: not yet known
    int grid_width = 0, grid_height = 0;  // cells
    int data_width = 0, data_height = 0;  // texels
    Sections sections;
    int residual_texture = -1;    // "residualTexture": index into the document's textures; -1: there is none
    double residual_scale = 1.0;  // slope that a full red or green stands for, (0, 1e9]
    ChartLayout charts;           // "charts"
};

// The extension object as compact JSON. Numbers are written so that parse_extension gives them back bit by
// bit.
std::string write_extension(const PathDetail& detail);

// Reads the extension object (the value, without its name). Unknown properties are passed over, as glTF asks;
// `wrap`, `texCoord`, `baseOffset` and `outerLevel` have defaults ("repeat", 0, 0, 0), `residualTexture`, `charts` and `data.functions` may
// be absent, the others are required. Fails with invalid_input, naming property and value: not JSON, a property missing, of wrong type
// or out of its range (the ranges above and layout.h's limits), sections that do not fit into the data
// texture; unsupported: another version.
Result<PathDetail> parse_extension(std::string_view json);

}  // namespace burin
