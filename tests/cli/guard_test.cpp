// What no command line can provoke: an exception that nothing expected, and want of memory.
#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

#include "command.hpp"
#include "options.hpp"

namespace burin::cli {
namespace {

TEST(Guard, unexpected_exception_is_a_bug) {
    Arguments arguments;
    arguments.command = "convert";
    testing::internal::CaptureStderr();
    const ExitCode code = guard(arguments, []() -> ExitCode { throw std::logic_error("list is empty"); });
    EXPECT_EQ(code, ExitCode::bug);
    EXPECT_EQ(static_cast<int>(code), 70);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "burin convert: error: internal: list is empty\n");
}

TEST(Guard, want_of_memory_is_unavailable) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(guard({}, []() -> ExitCode { throw std::bad_alloc(); }), ExitCode::unavailable);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "burin: error: not enough memory for this input\n");
}

TEST(Guard, result_of_the_work_passes) {
    EXPECT_EQ(guard({}, [] { return ExitCode::no; }), ExitCode::no);
}

TEST(Fail, is_one_line_whatever_the_message) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(fail({}, ExitCode::input, "two\nlines"), ExitCode::input);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "burin: error: two lines\n");
}

TEST(ExitCodes, follow_the_kind_of_error) {
    EXPECT_EQ(code_for_input({ErrorCode::invalid_argument, ""}), ExitCode::usage);
    for (ErrorCode code : {ErrorCode::invalid_input, ErrorCode::unsupported, ErrorCode::limit_exceeded, ErrorCode::io_failed})
        EXPECT_EQ(code_for_input({code, ""}), ExitCode::input);
    EXPECT_EQ(code_for_input({ErrorCode::unavailable, ""}), ExitCode::unavailable);
    EXPECT_EQ(code_for_output({ErrorCode::io_failed, ""}), ExitCode::output);
    EXPECT_EQ(code_for_output({ErrorCode::invalid_argument, ""}), ExitCode::usage);
}

// Every default of the table is a value that the table itself accepts, and every option belongs to a command.
TEST(OptionTable, defaults_are_in_range) {
    const Command commands[] = {{"convert", "MAP", "", nullptr}, {"render", "ASSET", "", nullptr},
                                {"check", "ASSET", "", nullptr}, {"info", "FILE", "", nullptr},
                                {"mesh", "ASSET", "", nullptr},  {"pack", "DRAWING", "", nullptr}, {"build", "RECIPE", "", nullptr},
                                {"generate", "KIND", "", nullptr},
                                {"validate", "ASSET", "", nullptr}};
    for (const OptionSpec& spec : option_table()) {
        const std::string name = std::string(spec.name).substr(0, std::string(spec.name).find(','));
        EXPECT_EQ(name.substr(0, 2), "--");
        if (spec.fallback.empty()) continue;
        const std::string command = std::string(spec.commands).substr(0, std::string(spec.commands).find(' '));
        Arguments partial;
        const char* const words[] = {"burin", command.c_str(), "file", name.c_str(), spec.fallback.c_str()};
        const auto request = parse_arguments(words, commands, partial);
        // Another option may be required; the default itself must not be refused.
        if (!request) {
            EXPECT_NE(request.error().message.find("is missing"), std::string::npos)
                << name << ": " << request.error().message;
        }
    }
}

}  // namespace
}  // namespace burin::cli
