// Recipes: several patterns on one model, each with the options of `convert` or `pack`.
//
//     text of a .json --[read_recipe]--> Recipe --> build
//
// format/recipe.schema.json is the schema. Files are named relative to the recipe's folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <burin/geometry.hpp>
#include <burin/result.hpp>

#include "options.hpp"

namespace burin::cli {

struct RecipePattern {
    std::string place;    // "recipe.json:12: patterns[3]", begins messages about it
    Arguments arguments;  // of `convert` or `pack`, checked like those of a command line
};

struct Recipe {
    std::string model;          // a file; empty: a rectangle
    std::optional<Vec2> plane;  // its size in metres; none: the pattern's own, of which there is one then
    std::string output;         // empty: not named
    std::vector<RecipePattern> patterns;
};

// `arguments`: those of `build`, whose --threads and --quiet go on to every pattern. Reads the first bytes of the files in `from`, to
// tell drawings from maps.
// Fails with io_failed, and with invalid_input: damaged JSON; what is unknown, missing, twice there or out of its range. The message names
// file, line, place and value.
Result<Recipe> read_recipe(const Arguments& arguments);

}  // namespace burin::cli
