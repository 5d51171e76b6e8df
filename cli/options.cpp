#include "options.hpp"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <sstream>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <burin/json_text.hpp>

namespace burin::cli {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::stringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    if (!text.empty() && text.back() == separator) parts.emplace_back();
    return parts;
}

const OptionSpec* find_option(const std::string& command, const std::string& name) {
    for (const OptionSpec& spec : option_table())
        if (long_name(spec) == name && belongs(spec, command)) return &spec;
    return nullptr;
}

// The whole of `text` as one finite number.
bool parse_number(const std::string& text, double& value) {
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && rest == end && std::isfinite(value);
}

// What may stand behind a number of bytes, each 1024 times as much as the one before it.
constexpr std::string_view kByteUnits = "KMG";

// A whole number of bytes, or of KiB, MiB or GiB.
bool parse_bytes(std::string text, double& value) {
    const std::size_t unit = text.empty() ? std::string_view::npos : kByteUnits.find(text.back());
    if (unit != std::string_view::npos) text.pop_back();
    if (!parse_number(text, value) || value != std::floor(value)) return false;
    if (unit != std::string_view::npos) value *= std::pow(1024.0, static_cast<double>(unit + 1));
    return true;
}

bool parse_numbers(const std::string& text, char separator, std::vector<double>& values) {
    values.clear();
    for (const std::string& part : split(text, separator)) {
        double value = 0.0;
        if (!parse_number(part, value)) return false;
        values.push_back(value);
    }
    return !values.empty();
}

std::string plain(double value) {
    char text[32];
    const auto result = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 8);
    return std::string(text, result.ptr);
}

std::string with_unit(const OptionSpec& spec, const std::string& text) {
    return *spec.unit ? text + ' ' + spec.unit : text;
}

// A number of bytes as one may write it.
std::string plain_bytes(double value) {
    std::size_t units = 0;
    for (; units < kByteUnits.size() && std::fmod(value, 1024.0) == 0.0; ++units) value /= 1024.0;
    return plain(value) + std::string(units > 0 ? kByteUnits.substr(units - 1, 1) : "");
}

// "1e-06 to 1000 m", "one of height, depth": what a message offers and --help shows.
std::string range_text(const OptionSpec& spec) {
    const auto text = [&](double value) { return spec.kind == OptionKind::bytes ? plain_bytes(value) : plain(value); };
    const std::string range = with_unit(spec, text(spec.low) + " to " + text(spec.high));
    if (spec.kind != OptionKind::choice && spec.kind != OptionKind::choice_or_integer) return range;
    std::string list;
    for (const std::string& name : split(spec.choices, '|')) list += (list.empty() ? "" : ", ") + name;
    return spec.kind == OptionKind::choice ? "one of " + list : list + " or " + range;
}

std::string form_text(const OptionSpec& spec) {
    switch (spec.kind) {
        case OptionKind::integer: return "a whole number";
        case OptionKind::choice_or_integer: return "one of the names or a whole number";
        case OptionKind::extent: return "one number or two joined by x, such as 2 or 2x1.5";
        case OptionKind::pixels: return "one whole number or two joined by x, such as 640x480";
        case OptionKind::bytes: return "a whole number, or one with K, M or G behind it, such as 65536 or 64K";
        case OptionKind::numbers: return std::string("numbers as ") + spec.argument;
        default: return "a number";
    }
}

Error refuse(const std::string& message) { return {ErrorCode::invalid_argument, message}; }

Status check_numbers(const OptionSpec& spec, const std::string& text) {
    std::vector<double> values;
    const bool extent = spec.kind == OptionKind::extent || spec.kind == OptionKind::pixels;
    const bool list = spec.kind == OptionKind::numbers;
    const std::size_t wanted = list ? split(spec.argument, ',').size() : 1;
    const bool sized = spec.kind == OptionKind::bytes;
    if (sized) values.resize(1);
    const bool parsed = sized ? parse_bytes(text, values[0]) : parse_numbers(text, extent ? 'x' : list ? ',' : '\0', values);
    const bool wants_whole = spec.kind == OptionKind::integer || spec.kind == OptionKind::pixels ||
                             spec.kind == OptionKind::choice_or_integer;
    const bool whole = !wants_whole ||
                       std::all_of(values.begin(), values.end(), [](double v) { return v == std::floor(v); });
    const bool counted = extent ? values.size() <= 2 : values.size() == wanted;
    const std::string given = long_name(spec) + " '" + text + "'";
    if (!parsed || !whole || !counted)
        return refuse(given + " is not " + form_text(spec) + "; " + range_text(spec) + " works");
    for (double value : values)
        if (value < spec.low || value > spec.high)
            return refuse(given + " is out of its range; " + range_text(spec) + " works");
    return Done{};
}

Status check_value(const OptionSpec& spec, const std::string& text) {
    if (spec.kind == OptionKind::flag) return Done{};
    if (spec.kind == OptionKind::text) {
        if (text.empty()) return refuse(long_name(spec) + " is empty; it needs a " + spec.argument);
        return Done{};
    }
    if (spec.kind == OptionKind::choice || spec.kind == OptionKind::choice_or_integer) {
        const auto names = split(spec.choices, '|');
        if (std::find(names.begin(), names.end(), text) != names.end()) return Done{};
        if (spec.kind == OptionKind::choice_or_integer) return check_numbers(spec, text);
        return refuse(long_name(spec) + " '" + text + "' is not known; " + range_text(spec) + " works");
    }
    return check_numbers(spec, text);
}

Error unknown_option(const std::string& command, const std::string& word) {
    const std::string name = word.substr(0, word.find('='));
    std::vector<std::string> names;
    for (const OptionSpec& spec : option_table())
        if (belongs(spec, command)) names.push_back(long_name(spec));
    const std::string best = nearest_name(name, names);
    const std::string advice = best.empty() ? "`burin " + command + " --help` lists the options" : "did you mean " + best;
    return refuse("unknown option '" + name + "'; " + advice);
}

// Value of each option as CLI11 collects it; the checks are ours, so that messages name range and unit.
struct Collected {
    std::map<std::string, std::vector<std::string>> texts;
    std::map<std::string, bool> flags;
    std::vector<std::string> files;
};

void declare_options(CLI::App& app, const std::string& command, Collected& collected) {
    app.set_help_flag();
    app.allow_extras();
    for (const OptionSpec& spec : option_table()) {
        if (!belongs(spec, command)) continue;
        if (spec.kind == OptionKind::flag) {
            app.add_flag(spec.name, collected.flags[long_name(spec)]);
        } else {
            app.add_option(spec.name, collected.texts[long_name(spec)])
                ->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->allow_extra_args(false);
        }
    }
}

Status take_values(const Collected& collected, Arguments& arguments) {
    for (const auto& [name, set] : collected.flags)
        if (set) arguments.values[name] = "yes";
    for (const auto& [name, texts] : collected.texts) {
        if (texts.empty()) continue;
        const OptionSpec& spec = *find_option(arguments.command, name);
        for (const std::string& text : texts)
            if (find_option(arguments.command, text))
                return refuse(name + " needs a " + spec.argument + ", but the option " + text + " follows");
        if (texts.size() > 1) return refuse(name + " is given " + std::to_string(texts.size()) + " times; once works");
        if (const Status checked = check_value(spec, texts[0]); !checked) return checked.error();
        arguments.values[name] = texts[0];
    }
    return Done{};
}

Status take_files(const std::vector<std::string>& words, const Command& command, Arguments& arguments) {
    std::vector<std::string> files;
    for (const std::string& word : words) {
        if (word.size() > 1 && word[0] == '-' && word != "--") return unknown_option(command.name, word);
        if (word != "--") files.push_back(word);
    }
    const std::string usage = "`burin " + std::string(command.name) + " --help` shows how";
    const bool instead = *command.instead != '\0' && arguments.given(command.instead);
    if (files.empty() && instead) return Done{};
    if (instead) return refuse("'" + files[0] + "' does not go with " + command.instead + ": one of them works");
    if (files.empty()) return refuse(std::string("no ") + command.positional + " is given; " + usage);
    if (files.size() > 1)
        return refuse("one " + std::string(command.positional) + " is read at a time, '" + files[1] +
                      "' is the second; " + usage);
    arguments.file = files[0];
    return Done{};
}

Status check_required(const Arguments& arguments) {
    for (const OptionSpec& spec : option_table())
        if (spec.required && belongs(spec, arguments.command) && !arguments.given(long_name(spec)))
            return refuse(long_name(spec) + " " + spec.argument + " is missing: " + spec.help);
    return Done{};
}

Status check_together(const Arguments& arguments) {
    for (const OptionConflict& conflict : option_conflicts()) {
        if (arguments.command != conflict.command || !arguments.given(conflict.beside)) continue;
        for (const std::string& name : split(conflict.names, ' '))
            if (arguments.given(name)) return refuse(name + " does not go with " + conflict.beside + ": " + conflict.reason);
    }
    return Done{};
}

Result<Request> parse_command(std::span<const char* const> words, const Command& command, Arguments& partial) {
    CLI::App app;
    Collected collected;
    declare_options(app, command.name, collected);
    std::vector<std::string> reversed;
    for (std::size_t i = words.size(); i-- > 0;) reversed.emplace_back(words[i]);
    try {
        app.parse(reversed);
    } catch (const CLI::ParseError&) {
        // The one thing CLI11 still objects to: an option at the end without its value.
        return refuse(std::string("'") + words.back() + "' needs a value after it");
    }
    if (const Status taken = take_values(collected, partial); !taken) return taken.error();
    if (const Status taken = take_files(app.remaining(), command, partial); !taken) return taken.error();
    if (const Status complete = check_required(partial); !complete) return complete.error();
    if (const Status fitting = check_together(partial); !fitting) return fitting.error();
    return Request{Request::Kind::run, partial};
}

// As one word for a shell.
std::string shell_word(const std::string& word) {
    constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+./,:@%";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

// "  -o, --output FILE    text" with the help in its own column.
std::string option_line(const OptionSpec& spec) {
    const auto names = split(spec.name, ',');
    std::string left = names.size() > 1 ? "  " + names[1] + ", " : "      ";
    left += names[0];
    if (*spec.argument) left += std::string(" ") + spec.argument;
    left += left.size() < 30 ? std::string(30 - left.size(), ' ') : "  ";
    std::string notes;
    if (spec.kind != OptionKind::flag && spec.kind != OptionKind::text) notes += range_text(spec);
    const bool named = spec.kind == OptionKind::choice_or_integer;
    if (!spec.fallback.empty()) notes += (notes.empty() ? "" : "; ") + ("default " + (named ? spec.fallback : with_unit(spec, spec.fallback)));
    if (spec.required) notes += notes.empty() ? "required" : "; required";
    return left + spec.help + (notes.empty() ? "" : " [" + notes + "]") + "\n";
}

constexpr const char* kExitCodes =
    "\nexit codes: 0 done; 1 the answer is no; 2 usage; 3 input unreadable or invalid; 4 output not written;\n"
    "            5 not available here; 70 bug in burin\n";

}  // namespace

bool belongs(const OptionSpec& spec, const std::string& command) {
    const auto names = split(spec.commands, ' ');
    return std::find(names.begin(), names.end(), command) != names.end();
}

std::string long_name(const OptionSpec& spec) { return split(spec.name, ',').front(); }

bool Arguments::given(const std::string& name) const { return values.count(name) != 0; }

bool Arguments::flag(const std::string& name) const {
    assert(find_option(command, name));
    return given(name);
}

std::string Arguments::text(const std::string& name) const {
    const OptionSpec* spec = find_option(command, name);
    assert(spec);
    const auto found = values.find(name);
    return found != values.end() ? found->second : spec->fallback;
}

std::vector<double> Arguments::numbers(const std::string& name) const {
    const OptionSpec* spec = find_option(command, name);
    assert(spec);
    std::vector<double> values_read;
    const bool extent = spec->kind == OptionKind::extent || spec->kind == OptionKind::pixels;
    parse_numbers(text(name), extent ? 'x' : ',', values_read);
    return values_read;
}

double Arguments::number(const std::string& name) const {
    const auto list = numbers(name);
    assert(!list.empty());
    return list.front();
}

int Arguments::integer(const std::string& name) const { return static_cast<int>(number(name)); }

std::uint64_t Arguments::bytes(const std::string& name) const {
    double value = 0.0;
    const bool parsed = parse_bytes(text(name), value);
    assert(parsed);
    return parsed ? static_cast<std::uint64_t>(value) : 0;
}

Result<Request> parse_arguments(std::span<const char* const> argv, std::span<const Command> commands,
                                Arguments& partial) {
    const std::span<const char* const> words = argv.size() > 1 ? argv.subspan(1) : argv.subspan(argv.size());
    if (words.empty()) return refuse("no command is given; `burin --help` lists them");
    const std::string first = words[0];
    if (first == "--version") return Request{Request::Kind::version, {}};
    if (first == "--help" || first == "-h") return Request{Request::Kind::help, {}};
    std::string names;
    for (const Command& command : commands) {
        names += (names.empty() ? "" : ", ") + std::string(command.name);
        if (first != command.name) continue;
        partial.command = first;
        partial.line = "burin";
        for (const std::string word : words) partial.line += " " + shell_word(word);
        for (const std::string word : words.subspan(1))
            if (word == "--help" || word == "-h") return Request{Request::Kind::help, partial};
        return parse_command(words.subspan(1), command, partial);
    }
    return refuse("unknown command '" + first + "'; " + names + " work");
}

std::string help_text(std::span<const Command> commands) {
    std::string text =
        "burin turns displacement maps into paths with cross-sections inside a glTF material.\n\n"
        "usage: burin COMMAND FILE [options]\n\ncommands:\n";
    for (const Command& command : commands) {
        std::string left = std::string("  ") + command.name + " " + command.positional;
        left.resize(20, ' ');
        text += left + command.summary + "\n";
    }
    text += "\n`burin COMMAND --help` lists the options of a command; `burin --version` names the version.\n";
    return text + kExitCodes;
}

std::string help_text(const Command& command) {
    std::string text = "burin " + std::string(command.name) + ": " + command.summary + "\n\nusage: burin " +
                       command.name + " " + command.positional;
    for (const OptionSpec& spec : option_table())
        if (spec.required && belongs(spec, command.name)) {
            const auto names = split(spec.name, ',');
            text += " " + (names.size() > 1 ? names[1] : names[0]) + " " + spec.argument;
        }
    text += " [options]\n\noptions:\n";
    for (const OptionSpec& spec : option_table())
        if (belongs(spec, command.name)) text += option_line(spec);
    text += "  -h, --help                  this text\n";
    if (command.more_help) text += command.more_help();
    return text + kExitCodes;
}

}  // namespace burin::cli
