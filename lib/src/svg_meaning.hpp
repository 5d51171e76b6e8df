// What a stroke or a fill of a drawing means as relief.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burin/profiles.hpp>
#include <burin/result.hpp>
#include <burin/svg.hpp>

#include "svg_document.hpp"

namespace burin::svg {

enum class Kind { none, groove, ridge, plateau, sunken, ground };

struct Meaning {
    Kind kind = Kind::none;
    std::optional<ProfileSpec> profile;
    double height = 0.0;  // metres, > 0; 0: the usual one
    double width = 0.0;   // metres; 0: the usual one
    bool of_stroke() const { return kind == Kind::groove || kind == Kind::ridge || kind == Kind::none; }
    bool of_fill() const { return !(kind == Kind::groove || kind == Kind::ridge); }
};

// Fails with invalid_argument: what the word is that is not understood, and what would work.
Result<Meaning> parse_meaning(std::string_view text);
// Metres; "0.5mm", "2e-3". Nothing where it is no length.
std::optional<double> parse_metres(std::string_view text);
// Colours as "#rrggbb", as far as they are white or written in hexadecimal digits; others as they are written.
std::string plain_color(std::string_view paint);

// The user's words, read once.
class Meanings {
  public:
    // Fails as parse_meaning.
    static Result<Meanings> read(const SvgOptions& options);
    // By data attribute, then by rules on id, class and layer from within, then by colour, then by layers and classes whose names
    // are meanings themselves; then the usual one. Fails with invalid_input: an attribute that is no meaning.
    Result<Meaning> of(const Shape& shape, bool fill, const std::string& color);
    // Whether a rule, attribute or name says what fills of this shape mean.
    bool said(const Shape& shape, bool fill, const std::string& color);

    // Names that begin as a meaning does but are none, and what is wrong with each.
    const std::vector<std::string>& misread() const { return misread_; }

  private:
    Result<std::optional<Meaning>> find(const Shape& shape, bool fill, const std::string& color);
    const Meaning* rule(const std::string& name, bool fill) const;
    const Meaning* named(const std::string& name, bool fill);
    std::map<std::string, Meaning> rules_;
    std::map<std::string, std::optional<Meaning>> named_;  // of names that were asked for
    std::vector<std::string> misread_;
    Meaning stroke_, fill_;
};

}  // namespace burin::svg
