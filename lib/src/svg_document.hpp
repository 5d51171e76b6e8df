// An SVG document flattened: every shape that is shown, with its outline in pattern space, its style and its names.
//
//     text --[read_document]--> Document --> strokes and regions of a pattern (svg_read.cpp)
//
// Groups, nested transforms, `use`, symbols, nested svg elements, viewBox and units are worked in. What is not read is listed in the
// notes, each kind once, with how many there are and where the first is.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burin/path_data.hpp>
#include <burin/result.hpp>
#include <burin/svg.hpp>

#include "svg_style.hpp"

namespace burin::svg {

// Kinds of remarks, each with a count and the place of the first.
class Notes {
  public:
    void add(const std::string& what, const std::string& place);
    std::vector<std::string> list() const;

  private:
    struct Entry {
        std::string what, place;
        int count = 0;
    };
    std::vector<Entry> entries_;
    std::map<std::string, std::size_t> index_;
};

// Names and attributes that groups hand down.
struct Names {
    std::shared_ptr<const Names> outer;
    std::string id;
    std::string layer;                 // inkscape:label of a layer; Illustrator's layers are groups with an id
    std::vector<std::string> classes;
    std::map<std::string, std::string> data;  // attributes data-burin-..., without that prefix
    // Innermost first; nothing where none has it.
    const std::string* find(const std::string& key) const;
};

struct Shape {
    std::string place;  // "line 12, path 'id'"
    std::shared_ptr<const Names> names;
    Style style;
    Affine to_pattern;             // from user units to metres
    std::vector<Subpath> outline;  // in pattern space
    bool fillable = true;          // not a line
};

struct Document {
    Vec2 size{};  // of the page, metres
    std::vector<Shape> shapes;  // in the order they are painted
    Notes notes;
    // A drawing that burin wrote (format/svg.md): its root, and the profiles. Their user units are metres.
    bool own = false;
    std::map<std::string, std::string> root_data;
    std::vector<std::map<std::string, std::string>> profiles;  // data of the elements profile-0, profile-1, ...
};

struct DocumentOptions {
    std::optional<double> width, height;  // metres; of the page, the other side follows; both must agree with it within a hundredth
    double tolerance = 0.0;               // metres; 0: 5e-5 of the longer side
    std::string text_path;                // id of a path that guides text and is not drawn itself
};

inline constexpr std::size_t kMaxSvgShapes = std::size_t{1} << 22;
inline constexpr std::size_t kMaxSvgUses = std::size_t{1} << 18;  // with those within others
inline constexpr int kMaxSvgDepth = 256;

// A length in user units. Fails with nothing: no number, unknown unit. `percent_of`: what 100 % are.
std::optional<double> parse_length(std::string_view text, double percent_of);
// "transform" of SVG 1.1; nothing where it is malformed.
std::optional<Affine> parse_transform(std::string_view text);
// Numbers between blanks and commas; nothing where there is anything else.
std::optional<std::vector<double>> parse_numbers(std::string_view text);
// Factor by which areas grow, as a length: the root of |determinant|.
double scale_of(const Affine& transform);

// Fails with invalid_input (not well-formed, no svg element, a size that is not positive, a malformed transform; line and value) and
// limit_exceeded. `guide` gets the outline of the path that options.text_path names.
Result<Document> read_document(std::string_view text, const DocumentOptions& options, std::vector<Subpath>* guide = nullptr);

}  // namespace burin::svg
