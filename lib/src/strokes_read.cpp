// Lines of OBJ and glTF as strokes.
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>

#include <burin/image_io.hpp>
#include <burin/strokes.hpp>

#include "gltf_geometry.hpp"
#include "obj_text.hpp"

namespace burin {
namespace {

using namespace obj_text;

// Chains of points by number; those of one object that share ends become one.
class Chains {
  public:
    void add(const std::vector<std::uint32_t>& chain) {
        for (std::size_t i = 0; i + 1 < chain.size(); ++i)
            if (chain[i] != chain[i + 1]) links_.push_back({chain[i], chain[i + 1]});
    }

    // In the order in which they were drawn: a chain runs the way of its first link. What is left after all open chains are loops.
    std::vector<Stroke> join(const std::string& name, const std::vector<Point3>& points) {
        merge_equal(points);
        for (std::size_t i = 0; i < links_.size(); ++i)
            for (const std::uint32_t p : links_[i]) at_[p].push_back(i);
        used_.assign(links_.size(), false);
        std::vector<Stroke> strokes;
        for (std::size_t i = 0; i < links_.size(); ++i) {
            if (used_[i]) continue;
            // Back to where the chain begins, then along it.
            std::vector<std::uint32_t> back = follow(i, links_[i][1]), ahead;
            const bool closed = back.size() > 2 && back.front() == back.back();
            if (!closed) ahead = follow(i, links_[i][0], true);
            std::vector<std::uint32_t> chain(back.rbegin(), back.rend());
            if (!closed) chain.insert(chain.end(), ahead.begin() + 2, ahead.end());
            append(name, chain, closed, points, strokes);
        }
        links_.clear(), at_.clear();
        return strokes;
    }

  private:
    // Points of equal position are one, however often they are stored.
    void merge_equal(const std::vector<Point3>& points) {
        std::map<std::array<double, 3>, std::uint32_t> first;
        for (auto& link : links_)
            for (std::uint32_t& i : link) i = first.try_emplace({points[i].x, points[i].y, points[i].z}, i).first->second;
        std::erase_if(links_, [](const auto& link) { return link[0] == link[1]; });
    }

    // Points from the far end of a link through it and on, as long as just two links meet.
    std::vector<std::uint32_t> follow(std::size_t link, std::uint32_t from, bool again = false) {
        std::vector<std::uint32_t> chain{from};
        while (again || !used_[link]) {
            again = false;
            used_[link] = true;
            const std::uint32_t to = links_[link][0] == chain.back() ? links_[link][1] : links_[link][0];
            chain.push_back(to);
            const std::vector<std::size_t>& here = at_[to];
            if (to == from || here.size() != 2) break;
            link = here[0] == link ? here[1] : here[0];
        }
        return chain;
    }

    static void append(const std::string& name, const std::vector<std::uint32_t>& chain, bool closed, const std::vector<Point3>& points,
                       std::vector<Stroke>& strokes) {
        Stroke stroke{name, {}, closed};
        for (const std::uint32_t i : chain) stroke.points.push_back(points[i]);
        if (closed) stroke.points.pop_back();
        strokes.push_back(std::move(stroke));
    }

    std::vector<std::array<std::uint32_t, 2>> links_;
    std::map<std::uint32_t, std::vector<std::size_t>> at_;
    std::vector<bool> used_;
};

class ObjLines {
  public:
    explicit ObjLines(std::string_view text) : text_(text) {}

    Result<std::vector<Stroke>> run() {
        while (!text_.empty()) {
            ++line_number_;
            if (const Status status = statement(next_line(text_, line_number_)); !status) return status.error();
        }
        end_object();
        if (!strokes_.empty()) return std::move(strokes_);
        return model_error("OBJ: there is no line (l) among " + std::to_string(line_number_) + " lines of text" +
                           (curves_ > 0 ? "; free-form curves are not read, export them as a mesh of edges" : faces_ > 0 ? "; it holds faces" : ""));
    }

  private:
    Error fail(const std::string& message) const { return model_error("OBJ: line " + std::to_string(line_number_) + ": " + message); }

    Status statement(std::string_view line) {
        const std::string_view key = next_word(line);
        if (key == "v") return vertex(line);
        if (key == "l") return polyline(line);
        if (key == "f") ++faces_;
        if (key == "curv" || key == "cstype") ++curves_;
        if (key == "o" || key == "g") {
            end_object();
            name_ = printable(next_word(line));
        }
        return Done{};
    }

    Status vertex(std::string_view line) {
        double values[3];
        for (double& value : values) {
            const std::string_view word = next_word(line);
            const auto read = obj_number(word);
            if (!read) return fail("'" + printable(word) + "' is no number within 1e30");
            value = *read;
        }
        points_.push_back({values[0], values[1], values[2]});
        if (points_.size() <= kMaxModelVertices) return Done{};
        return Error{ErrorCode::limit_exceeded, "OBJ: more than " + std::to_string(kMaxModelVertices) + " vertices"};
    }

    Status polyline(std::string_view line) {
        std::vector<std::uint32_t> chain;
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
            const auto at = obj_index(word.substr(0, word.find('/')), points_.size());
            if (!at) return fail("point '" + printable(word) + "': there are " + std::to_string(points_.size()) + " positions");
            chain.push_back(*at);
        }
        if (chain.size() < 2) return fail("a line needs two points or more, here are " + std::to_string(chain.size()));
        chains_.add(chain);
        return Done{};
    }

    void end_object() {
        for (Stroke& stroke : chains_.join(name_, points_)) strokes_.push_back(std::move(stroke));
    }

    std::string_view text_;
    std::string name_;
    std::size_t line_number_ = 0, faces_ = 0, curves_ = 0;
    std::vector<Point3> points_;
    Chains chains_;
    std::vector<Stroke> strokes_;
};

// Indices of a primitive's points, as they are joined: LINES in pairs, a LOOP back to its start.
void add_lines(const ModelData& data, const Json& primitive, std::uint64_t mode, Chains& chains) {
    std::vector<std::uint32_t> list;
    if (primitive.contains("indices")) {
        list = read_indices(data, unsigned_or(primitive, "indices", 0));
    } else {
        list.resize(vertex_count(data, primitive));
        for (std::size_t i = 0; i < list.size(); ++i) list[i] = static_cast<std::uint32_t>(i);
    }
    if (mode == 2 && !list.empty()) list.push_back(list.front());
    if (mode != 1) return chains.add(list);
    for (std::size_t i = 0; i + 1 < list.size(); i += 2) chains.add({list[i], list[i + 1]});
}

std::vector<Point3> placed_points(const ModelData& data, const Json& primitive, const Matrix& m) {
    const std::vector<float> numbers = read_numbers(data, *attribute_of(primitive, "POSITION"));
    std::vector<Point3> points;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
        const auto row = [&](std::size_t r) { return m[r] * numbers[i] + m[4 + r] * numbers[i + 1] + m[8 + r] * numbers[i + 2] + m[12 + r]; };
        points.push_back({row(0), row(1), row(2)});
    }
    return points;
}

Result<std::vector<Stroke>> gltf_lines(const Model& model) {
    const ModelData& data = model.data();
    std::vector<Stroke> strokes;
    std::size_t others = 0;
    for (const PlacedMesh& placed : placed_meshes(data)) {
        const Json& mesh = array_of(data.document, "meshes")[placed.mesh];
        for (const Json& primitive : mesh["primitives"]) {
            const std::uint64_t mode = unsigned_or(primitive, "mode", 4);
            others += mode < 1 || mode > 3;
            if (mode < 1 || mode > 3) continue;
            Chains chains;
            add_lines(data, primitive, mode, chains);
            for (Stroke& stroke : chains.join(text_or(mesh, "name", ""), placed_points(data, primitive, placed.transform)))
                strokes.push_back(std::move(stroke));
        }
    }
    if (!strokes.empty()) return strokes;
    return model_error("glTF: there is no line in the scene shown (LINES, LINE_STRIP or LINE_LOOP), but " + std::to_string(others) +
                       " primitives of triangles or points");
}

// As read_model decides: glb by its magic, JSON by its brace, else OBJ.
bool is_gltf(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t at = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return text.starts_with("glTF") || (at != std::string_view::npos && text[at] == '{');
}

}  // namespace

Result<std::vector<Stroke>> read_strokes(const std::string& path) {
    const auto bytes = read_file(path, kMaxModelFileBytes);
    if (!bytes) return bytes.error();
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    auto strokes = read_strokes_bytes(*bytes, folder.empty() ? "." : folder.string());
    if (!strokes) return Error{strokes.error().code, "cannot read strokes '" + path + "': " + strokes.error().message};
    return strokes;
}

Result<std::vector<Stroke>> read_strokes_bytes(std::span<const std::uint8_t> bytes, const std::string& base_folder) {
    if (is_gltf(bytes)) {
        const auto model = read_model_bytes(bytes, base_folder);
        if (!model) return model.error();
        return gltf_lines(*model);
    }
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.find('\0') != std::string_view::npos)
        return Error{ErrorCode::unsupported, "it is neither glTF nor text; strokes are read from .obj, .gltf and .glb"};
    return ObjLines(text).run();
}

}  // namespace burin
