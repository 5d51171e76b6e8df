#include "gl/context.hpp"

namespace burin::gl {

Status Context::load(Lookup lookup, void* owner) {
    const char* missing = nullptr;
#define BURIN_GL_LOAD(type, name)                                                     \
    functions_.name = reinterpret_cast<PFNGL##type##PROC>(lookup(owner, "gl" #name)); \
    if (functions_.name == nullptr && missing == nullptr) missing = "gl" #name;
    BURIN_GL_FUNCTIONS(BURIN_GL_LOAD)
#undef BURIN_GL_LOAD
    if (missing != nullptr)
        return Error{ErrorCode::unavailable, std::string("the OpenGL library has no ") + missing};
    return Done{};
}

std::string Context::describe() const {
    auto text = [&](GLenum name) {
        const GLubyte* s = functions_.GetString(name);
        return s != nullptr ? std::string(reinterpret_cast<const char*>(s)) : std::string("unknown");
    };
    return text(GL_VENDOR) + ", " + text(GL_RENDERER) + ", " + text(GL_VERSION);
}

Result<std::unique_ptr<Context>> open_context(Backend backend) {
    return backend == Backend::egl ? open_egl() : open_osmesa();
}

}  // namespace burin::gl
