#include "recipe.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>

#include <burin/image_io.hpp>
#include <burin/json_text.hpp>

#include "asset_file.hpp"
#include "pattern_file.hpp"

namespace burin::cli {
namespace {

// What stands in a recipe once for all patterns, or would write files of its own.
constexpr std::array kNotOfPatterns{"--output", "--model", "--report", "--error-map", "--threads", "--format", "--quiet"};
constexpr Command kMakers[] = {{"convert", "MAP", "", run_convert}, {"pack", "DRAWING", "", run_pack, nullptr, "--paths-3d"}};

// "max_error" for --max-error.
std::string property_of(const OptionSpec& spec) {
    std::string name = long_name(spec).substr(2);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

std::string number_word(double value) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

// The value as a command line has it.
std::string word_of(JsonReader& json, const JsonValue& value, const OptionSpec& spec) {
    if (value.is_number()) return number_word(json.number(value));
    if (value.is_list() && spec.kind == OptionKind::extent) {
        const Vec2 both = json.pair(value);
        return number_word(both.x) + "x" + number_word(both.y);
    }
    if (!value.is_text()) json.expect(value, "a number or a text in quotes");
    return json.text(value);
}

class RecipeReader {
  public:
    RecipeReader(const JsonValue& root, const Arguments& build) : build_(build), json_(root, build.file) {}

    Result<Recipe> read(const JsonValue& root) {
        JsonObject document(json_, root);
        if (const JsonValue* schema = document.find("$schema")) json_.text(*schema);
        if (const JsonValue* model = document.find("model")) recipe_.model = file_named(*model);
        if (const JsonValue* output = document.find("output")) recipe_.output = file_named(*output);
        const JsonValue* plane = document.find("plane");
        if (plane != nullptr) read_plane(*plane);
        const JsonValue* patterns = document.need("patterns");
        document.finish();
        if (patterns != nullptr && !json_.failed())
            for (const JsonValue& pattern : json_.list(*patterns, 1, 4096)) read_pattern(pattern);
        if (!recipe_.model.empty() && plane != nullptr) json_.refuse(*plane, "\"model\" is given too; one of them works");
        if (recipe_.patterns.size() > 1 && recipe_.model.empty())
            json_.refuse(*patterns, "several patterns need a \"model\" with a material for each");
        if (json_.failed()) return json_.error();
        return std::move(recipe_);
    }

  private:
    std::string file_named(const JsonValue& value) {
        const std::string& name = json_.text(value);
        if (name.empty()) json_.refuse(value, "the name of a file is empty");
        return std::filesystem::path(name).is_absolute() ? name : std::filesystem::path(folder_of(build_.file) + name).lexically_normal().string();
    }

    void read_plane(const JsonValue& value) {
        constexpr JsonRange side{1e-6, 1e6};
        recipe_.plane = value.is_number() ? Vec2{1, 1} * json_.number(value, side) : json_.pair(value, side);
    }

    // The words of a command line with one option or with all of them, read as such.
    Result<Request> parse(const std::string& command, const std::string& from, const std::vector<std::string>& options) {
        // What the recipe says once; the output is written at the end.
        std::vector<std::string> words{"burin", command, from, "--output=recipe.glb"};
        words.push_back("--threads=" + build_.text("--threads"));
        if (build_.flag("--quiet")) words.emplace_back("--quiet");
        words.insert(words.end(), options.begin(), options.end());
        // A material names its model, which is the one that the patterns before were put on.
        if (!recipe_.model.empty()) words.push_back("--model=" + recipe_.model);
        std::vector<const char*> pointers;
        for (const std::string& word : words) pointers.push_back(word.c_str());
        Arguments partial;
        return parse_arguments(pointers, kMakers, partial);
    }

    void read_pattern(const JsonValue& value) {
        if (json_.failed()) return;
        JsonObject object(json_, value);
        // Lines drawn in space stand in for a drawing.
        const JsonValue* lines = object.find("paths_3d");
        const JsonValue* from = lines != nullptr ? lines : object.need("from");
        const std::string file = from == nullptr || json_.failed() ? "" : file_named(*from);
        const bool is_drawing = lines != nullptr || (from != nullptr && !json_.failed() && looks_like_drawing(file));
        const std::string command = is_drawing ? "pack" : "convert";
        const std::string source = lines != nullptr ? "--paths-3d=" + file : file;
        std::vector<std::string> options;
        for (const OptionSpec& spec : option_table()) {
            if (!belongs(spec, command) || std::count(kNotOfPatterns.begin(), kNotOfPatterns.end(), long_name(spec)) > 0) continue;
            const JsonValue* given = object.find(property_of(spec).c_str());
            if (given == nullptr || given == lines || json_.failed()) continue;
            // The one option that names a file.
            const bool names_file = long_name(spec) == "--font";
            options.push_back(long_name(spec) + "=" + (names_file ? file_named(*given) : word_of(json_, *given, spec)));
            if (const auto alone = parse(command, source, {options.back()}); !alone) json_.refuse(*given, alone.error().message);
        }
        object.finish();
        if (json_.failed()) return;
        const auto request = parse(command, source, options);
        if (!request) return json_.refuse(value, request.error().message);
        recipe_.patterns.push_back({build_.file + ":" + std::to_string(value.line) + ": " + json_.place_of(value), request->arguments});
    }

    const Arguments& build_;
    JsonReader json_;
    Recipe recipe_;
};

}  // namespace

Result<Recipe> read_recipe(const Arguments& arguments) {
    const auto bytes = read_file(arguments.file, kMaxJsonTextBytes);
    if (!bytes) return bytes.error();
    const auto root = parse_json_text({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, arguments.file);
    if (!root) return root.error();
    return RecipeReader(*root, arguments).read(*root);
}

}  // namespace burin::cli
