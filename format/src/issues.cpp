#include <burin/format/issues.hpp>

#include <algorithm>
#include <iterator>

namespace burin {
namespace {

constexpr Severity kError = Severity::error, kWarning = Severity::warning,
                   kInformation = Severity::information;

constexpr IssueKind kKinds[] = {
    {1001, kError, "neither a GLB nor glTF JSON"},
    {1002, kError, "GLB version is not 2"},
    {1003, kError, "GLB length differs from the file's"},
    {1004, kError, "GLB chunk exceeds the file"},
    {1005, kError, "GLB chunk length is not a multiple of 4"},
    {1006, kError, "first GLB chunk is not JSON"},
    {1007, kError, "document is not a JSON object"},
    {1008, kError, "asset.version is not 2.x"},
    {1009, kError, "buffer cannot be read"},
    {1010, kError, "glTF property has the wrong type or an index out of range"},
    {1011, kError, "buffer is shorter than its byteLength"},
    {2001, kError, "extension is not listed in extensionsUsed"},
    {2002, kError, "extension is listed in extensionsRequired"},
    {2003, kError, "extension is not an object"},
    {2004, kError, "property is missing"},
    {2005, kError, "property has the wrong type"},
    {2006, kError, "version is not supported"},
    {2007, kError, "size is out of range"},
    {2008, kError, "depth is out of range"},
    {2009, kError, "baseOffset is outside of [0, depth]"},
    {2010, kError, "outerLevel is outside of the height range"},
    {2011, kError, "wrap is neither repeat nor clamp"},
    {2012, kError, "texCoord is out of range"},
    {2013, kError, "texture side is out of range"},
    {2014, kError, "sections exceed the data texture"},
    {2015, kError, "section length is out of range"},
    {2016, kError, "bufferView index is out of range"},
    {2017, kError, "buffer view's length is not the texture's"},
    {2018, kError, "buffer view's offset is not a multiple of 4"},
    {2019, kError, "buffer view has byteStride or target"},
    {2020, kError, "buffer view exceeds its buffer"},
    {2021, kInformation, "no material has the extension"},
    {2022, kError, "primitive lacks the texture coordinates"},
    {2023, kError, "residualTexture's texture does not exist"},
    {2024, kError, "residualTexture's image is missing or of another type"},
    {2025, kError, "residualTexture's scale is out of range"},
    {2026, kError, "residualTexture's texCoord is not the pattern's"},
    {2027, kError, "residualTexture's sampler does not wrap like the pattern"},
    {2040, kError, "primitive has some of the derivatives and lacks others"},
    {2041, kError, "derivatives are not VEC3 of FLOAT, one per vertex"},
    {2042, kError, "chart numbers are missing, or not SCALAR of FLOAT, one per vertex"},
    {2043, kError, "a number of the chart table's description is out of range"},
    {2044, kError, "the chart table is too small for its borders and cells"},
    {2045, kError, "a list of the chart table leads out of it"},
    {2046, kError, "a border of the chart table has a number that is not finite or out of its range"},
    {3001, kError, "list exceeds the list section"},
    {3002, kError, "empty list with a first reference"},
    {3003, kError, "empty list with flag STEP"},
    {3004, kError, "skip in a cell that lists elements"},
    {3005, kError, "skip leads over a cell that lists elements"},
    {3006, kError, "level outside of the height bounds"},
    {3007, kError, "flag STEP without an element of a step"},
    {3008, kError, "flag ISOLATED on a list that is not one smooth chain"},
    {3009, kError, "empty neighbours with different levels"},
    {3010, kError, "step's path line passes through a cell that does not list it"},
    {4001, kError, "element exceeds the element section"},
    {4002, kError, "unused bits of an element are set"},
    {4003, kError, "quadratic without texel B"},
    {4004, kError, "line with a control point"},
    {4005, kError, "end-kind has no meaning"},
    {4006, kError, "clip angle without a clip line"},
    {4007, kError, "style index is out of range"},
    {4008, kError, "element's ends coincide"},
    {4009, kError, "element is longer than the tile"},
    {4010, kError, "height scale varies along a step"},
    {4011, kError, "right level is not where the step's profile ends"},
    {4012, kError, "function index is not a function"},
    {4013, kError, "argument falls along an element or leaves the period"},
    {4014, kError, "function changes the height of a step"},
    {4020, kError, "profile exceeds the profile section"},
    {4021, kError, "number of profile points is out of range"},
    {4022, kError, "material index is out of range"},
    {4023, kError, "reach is out of range"},
    {4024, kError, "internal bits beyond the last facet"},
    {4025, kError, "step flag contradicts the levels"},
    {4030, kError, "profile code is -32768"},
    {4031, kError, "profile does not run from left to right"},
    {4032, kError, "profile repeats a point"},
    {4033, kError, "step profile without a point at b = 0"},
    {4034, kWarning, "profile ends off the ground"},
    {4035, kError, "padding of a profile is not 0"},
    {4040, kError, "material 0 overrides the glTF material"},
    {4041, kError, "unused bits of a material are set"},
    {4050, kError, "reference is not an element"},
    {4051, kError, "references of a list do not grow"},
    {4052, kError, "reference outside of all lists is not 0"},
    {4053, kError, "texel behind the last section is not 0"},
    {4060, kError, "function has no meaning or exceeds the function section"},
    {4061, kError, "unused bits of a function are set"},
    {4062, kError, "amplitude, octaves or period is out of range"},
    {4063, kError, "polynomial leaves [0, 4)"},
    {9001, kInformation, "further findings of one number"},
};

}  // namespace

std::span<const IssueKind> issue_kinds() { return kKinds; }

const IssueKind* find_issue_kind(int number) {
    const auto found =
        std::lower_bound(std::begin(kKinds), std::end(kKinds), number,
                         [](const IssueKind& kind, int wanted) { return kind.number < wanted; });
    return found != std::end(kKinds) && found->number == number ? found : nullptr;
}

}  // namespace burin
