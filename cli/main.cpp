// burin: the table of commands, and dispatch.
#include <csignal>
#include <cstdio>

#include "command.hpp"
#include "options.hpp"

namespace burin::cli {
namespace {

constexpr Command kCommands[] = {
    {"convert", "MAP", "turn a height map into paths with cross-sections in a glTF material", run_convert},
    {"vectorize", "MAP", "turn a height map into a drawing of its paths, for editing by hand", run_vectorize},
    {"pack", "DRAWING", "turn a drawing of paths into a glTF material", run_pack, nullptr, "--paths-3d"},
    {"generate", "KIND", "make a pattern of scratches, cracks, bricks, rings ... by numbers and a seed", run_generate, generate_help},
    {"build", "RECIPE", "put several patterns on one model, as a recipe says", run_build},
    {"render", "ASSET", "draw an asset as its shader does, or its height from straight above", run_render},
    {"check", "ASSET", "measure how far an asset lies from the map it was made from", run_check},
    {"info", "FILE", "say what is inside an asset or a height map", run_info},
    {"mesh", "ASSET", "write the surface as triangles: the body with its relief, or one tile as a solid", run_mesh},
    {"validate", "ASSET", "list what is wrong with an asset, by numbered findings", run_validate},
};

const Command* find_command(const std::string& name) {
    for (const Command& command : kCommands)
        if (name == command.name) return &command;
    return nullptr;
}

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

ExitCode dispatch(const Request& request) {
    const Command* command = find_command(request.arguments.command);
    switch (request.kind) {
        case Request::Kind::help:
            print(command ? help_text(*command) : help_text(kCommands));
            return ExitCode::done;
        case Request::Kind::version:
            print("burin " BURIN_VERSION "\n");
            return ExitCode::done;
        case Request::Kind::run: break;
    }
    return command->run(request.arguments);
}

}  // namespace

}  // namespace burin::cli

int main(int argc, char** argv) {
    using namespace burin::cli;
    // A reader that leaves early is a failed write, with its code and without remains; not the end of the program.
    std::signal(SIGPIPE, SIG_IGN);
    Arguments partial;
    return static_cast<int>(guard(partial, [&] {
        const std::span<const char* const> words(argv, static_cast<std::size_t>(argc));
        const auto request = parse_arguments(words, kCommands, partial);
        if (!request) return fail(partial, ExitCode::usage, request.error().message);
        return dispatch(*request);
    }));
}
