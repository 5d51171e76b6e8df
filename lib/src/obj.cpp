#include "obj.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "mesh_document.hpp"
#include "obj_text.hpp"

namespace burin {
namespace {

// Ear clipping takes the cube of the corners at worst.
constexpr std::size_t kMaxCorners = 256;
using Vec3 = std::array<double, 3>;
using namespace obj_text;

struct Corner {
    std::uint32_t position = 0;
    std::uint32_t uv = kNone;
    std::uint32_t normal = kNone;
    static constexpr std::uint32_t kNone = 0xffffffffu;
    bool operator==(const Corner&) const = default;
};

struct CornerHash {
    std::size_t operator()(const Corner& c) const {
        std::uint64_t h = c.position * 0x9e3779b97f4a7c15ull;
        h = (h ^ c.uv) * 0xbf58476d1ce4e5b9ull;
        h = (h ^ (h >> 29) ^ c.normal) * 0x94d049bb133111ebull;
        return static_cast<std::size_t>(h ^ (h >> 32));
    }
};

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 cross_of(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot_of(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Corners of one polygon by ear clipping, in the plane of its own normal. A polygon that crosses itself, or
// is flat to a line, falls back to a fan.
class EarClipper {
  public:
    explicit EarClipper(const std::vector<Vec3>& corners) : corners_(corners) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec3 edge =
                cross_of(minus(corners[i], corners[0]), minus(corners[(i + 1) % corners.size()], corners[0]));
            for (std::size_t k = 0; k < 3; ++k) normal_[k] += edge[k];
            left_.push_back(i);
        }
    }

    std::vector<std::array<std::size_t, 3>> run() {
        std::vector<std::array<std::size_t, 3>> triangles;
        while (left_.size() > 3) {
            std::size_t ear = 0;
            while (ear < left_.size() && !is_ear(ear)) ++ear;
            if (ear == left_.size()) ear = 1;  // none: continue as a fan
            triangles.push_back({before(ear), left_[ear], after(ear)});
            left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        triangles.push_back({left_[0], left_[1], left_[2]});
        return triangles;
    }

  private:
    std::size_t before(std::size_t i) const { return left_[(i + left_.size() - 1) % left_.size()]; }
    std::size_t after(std::size_t i) const { return left_[(i + 1) % left_.size()]; }
    double turn(std::size_t a, std::size_t b, std::size_t c) const {
        return dot_of(cross_of(minus(corners_[b], corners_[a]), minus(corners_[c], corners_[a])), normal_);
    }
    bool is_ear(std::size_t i) const {
        const std::size_t a = before(i), b = left_[i], c = after(i);
        if (turn(a, b, c) <= 0.0) return false;
        return std::none_of(left_.begin(), left_.end(), [&](std::size_t p) {
            return p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 &&
                   turn(c, a, p) >= 0.0;
        });
    }

    const std::vector<Vec3>& corners_;
    std::vector<std::size_t> left_;
    Vec3 normal_{};
};

// Triangles of one material while they are read.
struct Group {
    std::vector<Corner> corners;  // unique, in the order of their first use
    std::unordered_map<Corner, std::uint32_t, CornerHash> known;
    std::vector<std::uint32_t> indices;
};

class ObjReader {
  public:
    explicit ObjReader(std::span<const std::uint8_t> bytes)
        : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

    Result<ModelData> run() {
        if (text_.find('\0') != std::string_view::npos)
            return Error{ErrorCode::unsupported,
                         "it is neither glTF nor text; models are read from .gltf, .glb and .obj"};
        while (!text_.empty()) {
            ++line_number_;
            if (Status status = statement(next_line(text_, line_number_)); !status.ok()) return status.error();
        }
        if (faces_ == 0)
            return model_error("OBJ: there is no face, in " + std::to_string(line_number_) + " lines");
        if (positions_.size() > kMaxModelVertices)
            return Error{ErrorCode::limit_exceeded, "OBJ: " + std::to_string(positions_.size()) +
                                                        " vertices, limit " +
                                                        std::to_string(kMaxModelVertices)};
        compute_missing_normals();
        std::vector<MeshPart> parts;
        for (const std::string& name : order_)
            if (!groups_[name].indices.empty()) parts.push_back(part(name, groups_[name]));
        return make_document("mesh", parts);
    }

  private:
    Error fail(const std::string& message) const {
        return model_error("OBJ: line " + std::to_string(line_number_) + ": " + message);
    }

    Status statement(std::string_view line) {
        const std::string_view key = next_word(line);
        if (key == "v") return numbers(line, 3, positions_);
        if (key == "vt") return numbers(line, 2, uvs_);
        if (key == "vn") return numbers(line, 3, normals_);
        if (key == "f") return face(line);
        if (key == "usemtl") {
            // A name may hold blanks; those at its ends do not count.
            const std::size_t begin = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t\r");
            material_ = begin == std::string_view::npos ? "default"
                                                        : std::string(line.substr(begin, end - begin + 1));
            // The name goes into JSON, which is UTF-8 only.
            for (char& c : material_)
                if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '_';
        } else if (!key.empty() && key[0] != '#' && !is_passed_over(key)) {
            return fail("'" + printable(key) +
                        "' is no statement of OBJ; models are read from .gltf, .glb and .obj");
        }
        return Done{};
    }

    static bool is_passed_over(std::string_view key) {
        static constexpr std::array<std::string_view, 30> kKeys{
            "g",      "o",        "s",        "l",    "p",          "mg",       "vp",   "mtllib",
            "usemap", "maplib",   "cstype",   "deg",  "bmat",       "step",     "curv", "curv2",
            "surf",   "parm",     "trim",     "hole", "scrv",       "sp",       "end",  "con",
            "bevel",  "c_interp", "d_interp", "lod",  "shadow_obj", "trace_obj"};
        return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end() || key == "ctech" ||
               key == "stech" || key == "call";
    }

    template <std::size_t N>
    Status numbers(std::string_view line, std::size_t needed, std::vector<std::array<float, N>>& list) {
        std::array<float, N> values{};
        for (std::size_t i = 0; i < N; ++i) {
            const std::string_view word = next_word(line);
            if (word.empty() && i >= needed) break;
            const std::optional<double> value = obj_number(word);
            if (!value) return fail("'" + printable(word) + "' is no number within 1e30");
            values[i] = static_cast<float>(*value);
        }
        list.push_back(values);
        if (list.size() > kMaxModelVertices)
            return Error{ErrorCode::limit_exceeded,
                         "OBJ: more than " + std::to_string(kMaxModelVertices) + " vertices"};
        return Done{};
    }

    Result<Corner> corner(std::string_view word) const {
        Corner result;
        const std::size_t first = word.find('/');
        const std::size_t second = first == std::string_view::npos ? first : word.find('/', first + 1);
        const auto position = obj_index(word.substr(0, first), positions_.size());
        if (!position.has_value())
            return fail("corner '" + printable(word) + "': there are " + std::to_string(positions_.size()) +
                        " positions");
        result.position = *position;
        if (first == std::string_view::npos) return result;
        const std::string_view uv =
            word.substr(first + 1, second == std::string_view::npos ? second : second - first - 1);
        if (!uv.empty()) {
            const auto at = obj_index(uv, uvs_.size());
            if (!at.has_value())
                return fail("corner '" + printable(word) + "': there are " + std::to_string(uvs_.size()) +
                            " texture coordinates");
            result.uv = *at;
        }
        if (second == std::string_view::npos) return result;
        const auto at = obj_index(word.substr(second + 1), normals_.size());
        if (!at.has_value())
            return fail("corner '" + printable(word) + "': there are " + std::to_string(normals_.size()) +
                        " normals");
        result.normal = *at;
        return result;
    }

    Status face(std::string_view line) {
        std::vector<Corner> corners;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
            Result<Corner> read = corner(word);
            if (!read.ok()) return read.error();
            corners.push_back(*read);
            if (corners.size() > kMaxCorners)
                return Error{ErrorCode::limit_exceeded, "OBJ: line " + std::to_string(line_number_) +
                                                            ": a face has more than " +
                                                            std::to_string(kMaxCorners) + " corners"};
        }
        if (corners.size() < 3) return fail("a face has " + std::to_string(corners.size()) + " corners");
        ++faces_;
        if (groups_.find(material_) == groups_.end()) order_.push_back(material_);
        Group& group = groups_[material_];
        std::vector<Vec3> points;
        for (const Corner& c : corners) {
            const auto& p = positions_[c.position];
            points.push_back({p[0], p[1], p[2]});
        }
        for (const auto& triangle : EarClipper(points).run())
            for (const std::size_t i : triangle) group.indices.push_back(vertex(group, corners[i]));
        return Done{};
    }

    static std::uint32_t vertex(Group& group, const Corner& corner) {
        const auto [at, is_new] =
            group.known.try_emplace(corner, static_cast<std::uint32_t>(group.corners.size()));
        if (is_new) group.corners.push_back(corner);
        return at->second;
    }

    // Mean of the faces around each position, weighted by area.
    void compute_missing_normals() {
        computed_.assign(positions_.size(), Vec3{});
        for (const auto& [name, group] : groups_)
            for (std::size_t i = 0; i + 2 < group.indices.size(); i += 3) {
                std::array<std::uint32_t, 3> p{};
                std::array<Vec3, 3> at{};
                for (std::size_t k = 0; k < 3; ++k) {
                    p[k] = group.corners[group.indices[i + k]].position;
                    at[k] = {positions_[p[k]][0], positions_[p[k]][1], positions_[p[k]][2]};
                }
                const Vec3 n = cross_of(minus(at[1], at[0]), minus(at[2], at[0]));
                for (const std::uint32_t v : p)
                    for (std::size_t k = 0; k < 3; ++k) computed_[v][k] += n[k];
            }
    }

    // glTF wants unit length; what has none gets +y.
    static void append_unit(Vec3 n, std::vector<float>& out) {
        const double length = std::sqrt(dot_of(n, n));
        if (!(length > 0.0) || !std::isfinite(length)) n = {0, 1, 0};
        const double scale = length > 0.0 && std::isfinite(length) ? 1.0 / length : 1.0;
        for (const double v : n) out.push_back(static_cast<float>(v * scale));
    }

    MeshPart part(const std::string& name, const Group& group) const {
        MeshPart result;
        result.material = name;
        result.indices = group.indices;
        const bool has_uv = std::all_of(group.corners.begin(), group.corners.end(),
                                        [](const Corner& c) { return c.uv != Corner::kNone; });
        for (const Corner& c : group.corners) {
            const auto& p = positions_[c.position];
            result.positions.insert(result.positions.end(), p.begin(), p.end());
            if (c.normal == Corner::kNone) {
                append_unit(computed_[c.position], result.normals);
            } else {
                const auto& n = normals_[c.normal];
                append_unit({n[0], n[1], n[2]}, result.normals);
            }
            // OBJ counts v upwards, glTF downwards.
            if (has_uv) result.uvs.insert(result.uvs.end(), {uvs_[c.uv][0], 1.0f - uvs_[c.uv][1]});
        }
        return result;
    }

    std::string_view text_;
    std::size_t line_number_ = 0;
    std::size_t faces_ = 0;
    std::vector<std::array<float, 3>> positions_, normals_;
    std::vector<std::array<float, 2>> uvs_;
    std::vector<Vec3> computed_;
    std::string material_ = "default";
    std::map<std::string, Group> groups_;
    std::vector<std::string> order_;  // of the materials' first faces
};

}  // namespace

Result<ModelData> read_obj(std::span<const std::uint8_t> bytes) { return ObjReader(bytes).run(); }

}  // namespace burin
