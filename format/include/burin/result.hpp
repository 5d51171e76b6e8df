// Result<T>: a value, or an error that a person can act on. Lowest header of the project, no dependency.
//
// Three kinds of trouble are never mixed:
//   caller broke the contract      -> assert
//   input or a limit               -> Result with a message: what, where, which value, what would work
//   findings on a file             -> Issue (format/validate.hpp), all of them, not the first
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace burin {

enum class ErrorCode {
    invalid_argument,  // an option is out of its range or contradicts another
    invalid_input,     // the bytes or the geometry handed in are damaged or not for this stage
    unsupported,       // valid, but outside what burin promises to read
    limit_exceeded,    // a named limit of format/layout.h or of the reader
    io_failed,         // a file could not be read or written
    unavailable,       // needs something this build or machine lacks (an OpenGL context)
};

struct Error {
    ErrorCode code = ErrorCode::invalid_input;
    std::string message;  // one line, no trailing full stop, no program name
};

// Holds either T or Error. Check `ok()` (or the bool conversion) before value access; wrong access asserts.
template <typename T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::move(value)) {}
    Result(Error error) : state_(std::move(error)) {}

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    T& value() & { assert(ok()); return std::get<0>(state_); }
    const T& value() const& { assert(ok()); return std::get<0>(state_); }
    T&& value() && { assert(ok()); return std::get<0>(std::move(state_)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    const Error& error() const { assert(!ok()); return std::get<1>(state_); }

  private:
    std::variant<T, Error> state_;
};

// A Result without a value.
struct Done {};
using Status = Result<Done>;

}  // namespace burin
