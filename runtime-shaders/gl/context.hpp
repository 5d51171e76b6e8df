// An OpenGL 3.3 core context without a window, behind one small interface, so that OSMesa and EGL can take
// each other's place. Neither library is linked: it is loaded when asked for, and its absence is an error
// with a reason.
#pragma once

#include <memory>
#include <string>

#include <burin/result.hpp>

#include "gl/functions.hpp"
#include "gl/render.hpp"

namespace burin::gl {

class Context {
  public:
    Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    virtual ~Context() = default;

    const Functions& functions() const { return functions_; }
    std::string describe() const;

  protected:
    using Lookup = void* (*)(void* owner, const char* name);
    // Fails with unavailable, naming the first function that is missing.
    Status load(Lookup lookup, void* owner);

  private:
    Functions functions_;
};

// Ensures: the context is current on the calling thread until it is destroyed. Only one at a time.
// Fails with unavailable.
Result<std::unique_ptr<Context>> open_context(Backend backend);

// The two that open_context chooses from.
Result<std::unique_ptr<Context>> open_osmesa();
Result<std::unique_ptr<Context>> open_egl();

}  // namespace burin::gl
