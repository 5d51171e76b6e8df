// One table of options. Parsing, range checks, defaults and --help all come from it.
//
//     argv --[parse_arguments]--> Arguments --> the command's run function
//
// An option belongs to one or more commands. A value out of its range is refused with the range in the message, never
// clamped. Defaults stand in the table, as text that the same parser reads, and come from the options structs of the
// stages where a stage has one.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <burin/result.hpp>

#include "command.hpp"

namespace burin::cli {

enum class OptionKind {
    flag,     // present or not
    text,     // any text, such as a file name
    number,   // a real number in [low, high]
    integer,  // a whole number in [low, high]
    choice,   // one of `choices`, separated by |
    choice_or_integer,  // one of `choices`, or a whole number in [low, high]
    extent,   // one number, or two joined by x: 2 or 2x1.5; each in [low, high]
    pixels,   // an extent in whole numbers
    bytes,    // a whole number in [low, high], with K for KiB, M for MiB or G for GiB behind it if one likes
    numbers,  // as many numbers as `argument` has commas plus one, each in [low, high]
};

struct OptionSpec {
    const char* name;        // with both dashes; the short name, if any, follows after a comma: "--output,-o"
    const char* commands;    // names of the commands that take it, separated by spaces
    OptionKind kind;
    const char* argument;    // how --help names the value; empty for a flag
    const char* unit;        // "" when it has none
    std::string fallback;    // the value when the option is absent; "" when there is none
    double low, high;        // range, both ends included; unused unless the kind has numbers
    const char* choices;     // for OptionKind::choice and choice_or_integer
    bool required;
    const char* help;        // one sentence, no full stop
};

// Every option of every command, in the order --help shows them.
const std::vector<OptionSpec>& option_table();

// Whether the command takes the option; and the option's long name, with both dashes.
bool belongs(const OptionSpec& spec, const std::string& command);
std::string long_name(const OptionSpec& spec);

// Options that would change nothing beside another one, and are therefore refused with it.
struct OptionConflict {
    const char* command;
    const char* names;   // separated by spaces
    const char* beside;  // the option that leaves them without effect
    const char* reason;  // ends the message: why, and what would work
};
const std::vector<OptionConflict>& option_conflicts();

// What the user asked for, checked. Values are asked for by the option's long name; asking for a name that the table
// does not give to this command is a bug and asserts.
class Arguments {
  public:
    std::string command;  // "" when the arguments name none
    std::string file;     // the positional argument
    std::string line;     // the whole command line, as a shell takes it

    bool given(const std::string& name) const;  // the user wrote it
    bool flag(const std::string& name) const;
    std::string text(const std::string& name) const;  // the user's text or the fallback
    double number(const std::string& name) const;
    int integer(const std::string& name) const;
    std::uint64_t bytes(const std::string& name) const;
    std::vector<double> numbers(const std::string& name) const;  // extent, numbers

    std::map<std::string, std::string> values;  // by long name, as written
};

// What main should do with the command line.
struct Request {
    enum class Kind { run, help, version } kind = Kind::run;
    Arguments arguments;
};

// Fails with invalid_argument: unknown command or option, missing or malformed value, value out of range, options that do
// not go together. The message names the option, the value, and what would work. `partial` receives the command's name even then, so that the
// error can be reported under it.
Result<Request> parse_arguments(std::span<const char* const> argv, std::span<const Command> commands,
                                Arguments& partial);

// Text of --help for the whole program, or for one command.
std::string help_text(std::span<const Command> commands);
std::string help_text(const Command& command);

}  // namespace burin::cli
