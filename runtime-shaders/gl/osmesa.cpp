// OSMesa: Mesa's renderer into a buffer of the caller.
#include <dlfcn.h>

#include <array>

// First, since osmesa.h brings the older gl.h, whose names of OpenGL 1.1 would keep glcorearb.h from its
// types.
#include "gl/context.hpp"

#include <GL/osmesa.h>

namespace burin::gl {
namespace {

class OsmesaContext final : public Context {
  public:
    ~OsmesaContext() override {
        if (context_ != nullptr) destroy_(context_);
        if (library_ != nullptr) dlclose(library_);
    }

    Status open() {
        for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
            library_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
            if (library_ != nullptr) break;
        }
        if (library_ == nullptr)
            return Error{ErrorCode::unavailable,
                         "libOSMesa is not installed (Debian: libosmesa6), or use the backend egl"};
        auto create = symbol<OSMesaContext (*)(const int*, OSMesaContext)>("OSMesaCreateContextAttribs");
        auto make_current =
            symbol<GLboolean (*)(OSMesaContext, void*, GLenum, GLsizei, GLsizei)>("OSMesaMakeCurrent");
        get_ = symbol<OSMESAproc (*)(const char*)>("OSMesaGetProcAddress");
        destroy_ = symbol<void (*)(OSMesaContext)>("OSMesaDestroyContext");
        if (create == nullptr || make_current == nullptr || get_ == nullptr || destroy_ == nullptr)
            return Error{ErrorCode::unavailable,
                         "libOSMesa is too old: it cannot make an OpenGL 3.3 core context"};
        const int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_RGBA,
                                  OSMESA_DEPTH_BITS,
                                  0,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  3,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  3,
                                  0};
        context_ = create(attributes, nullptr);
        if (context_ == nullptr)
            return Error{ErrorCode::unavailable, "libOSMesa makes no OpenGL 3.3 core context"};
        // Everything is drawn into framebuffer objects; this buffer only has to exist.
        if (make_current(context_, buffer_.data(), GL_UNSIGNED_BYTE, 4, 4) == GL_FALSE)
            return Error{ErrorCode::unavailable, "libOSMesa does not make its context current"};
        return load(
            [](void* self, const char* name) {
                return reinterpret_cast<void*>(static_cast<OsmesaContext*>(self)->get_(name));
            },
            this);
    }

  private:
    template <typename F>
    F symbol(const char* name) {
        return reinterpret_cast<F>(dlsym(library_, name));
    }

    void* library_ = nullptr;
    OSMesaContext context_ = nullptr;
    OSMESAproc (*get_)(const char*) = nullptr;
    void (*destroy_)(OSMesaContext) = nullptr;
    std::array<unsigned char, 64> buffer_{};
};

}  // namespace

Result<std::unique_ptr<Context>> open_osmesa() {
    auto context = std::make_unique<OsmesaContext>();
    if (Status status = context->open(); !status) return status.error();
    return std::unique_ptr<Context>(std::move(context));
}

}  // namespace burin::gl
