// EGL without a surface: a GPU where there is one, through the device platform, else Mesa's surfaceless
// platform.
#include <dlfcn.h>

#include <array>
#include <vector>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "gl/context.hpp"

namespace burin::gl {
namespace {

class EglContext final : public Context {
  public:
    ~EglContext() override {
        if (display_ != EGL_NO_DISPLAY) {
            make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
            if (context_ != EGL_NO_CONTEXT) destroy_context_(display_, context_);
            terminate_(display_);
        }
        // The library stays loaded: drivers leave threads behind that still run its code.
    }

    Status open() {
        for (const char* name : {"libEGL.so.1", "libEGL.so"}) {
            library_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
            if (library_ != nullptr) break;
        }
        if (library_ == nullptr)
            return Error{ErrorCode::unavailable,
                         "libEGL is not installed (Debian: libegl1), or use the backend osmesa"};
        if (!load_egl())
            return Error{ErrorCode::unavailable, "libEGL is too old: a function of EGL 1.4 is missing"};
        for (EGLDisplay display : displays()) {
            if (open_on(display)) {
                return load(
                    [](void* self, const char* name) {
                        return reinterpret_cast<void*>(static_cast<EglContext*>(self)->get_(name));
                    },
                    this);
            }
        }
        return Error{ErrorCode::unavailable,
                     "EGL finds no device with OpenGL 3.3 core, or use the backend osmesa"};
    }

  private:
    template <typename F>
    bool symbol(F& function, const char* name) {
        function = reinterpret_cast<F>(dlsym(library_, name));
        return function != nullptr;
    }

    bool load_egl() {
        return symbol(get_, "eglGetProcAddress") && symbol(initialize_, "eglInitialize") &&
               symbol(terminate_, "eglTerminate") && symbol(bind_api_, "eglBindAPI") &&
               symbol(choose_config_, "eglChooseConfig") && symbol(create_context_, "eglCreateContext") &&
               symbol(destroy_context_, "eglDestroyContext") && symbol(make_current_, "eglMakeCurrent") &&
               symbol(get_display_, "eglGetDisplay");
    }

    // Devices first, since they are the GPUs; then the platforms that need none.
    std::vector<EGLDisplay> displays() {
        std::vector<EGLDisplay> found;
        auto platform = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(get_("eglGetPlatformDisplayEXT"));
        auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(get_("eglQueryDevicesEXT"));
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (platform != nullptr && query != nullptr && query(16, devices.data(), &count) == EGL_TRUE)
            for (EGLint i = 0; i < count; ++i)
                found.push_back(platform(EGL_PLATFORM_DEVICE_EXT, devices[std::size_t(i)], nullptr));
        if (platform != nullptr)
            found.push_back(platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
        found.push_back(get_display_(EGL_DEFAULT_DISPLAY));
        return found;
    }

    bool open_on(EGLDisplay display) {
        if (display == EGL_NO_DISPLAY || initialize_(display, nullptr, nullptr) == EGL_FALSE) return false;
        const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                 EGL_NONE};
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                                     3,
                                     EGL_CONTEXT_MINOR_VERSION_KHR,
                                     3,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                     EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        EGLContext context = EGL_NO_CONTEXT;
        if (bind_api_(EGL_OPENGL_API) == EGL_TRUE &&
            choose_config_(display, wanted, &config, 1, &count) == EGL_TRUE && count > 0)
            context = create_context_(display, config, EGL_NO_CONTEXT, attributes);
        if (context != EGL_NO_CONTEXT &&
            make_current_(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
            display_ = display;
            context_ = context;
            return true;
        }
        if (context != EGL_NO_CONTEXT) destroy_context_(display, context);
        terminate_(display);
        return false;
    }

    void* library_ = nullptr;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    decltype(&eglGetProcAddress) get_ = nullptr;
    decltype(&eglInitialize) initialize_ = nullptr;
    decltype(&eglTerminate) terminate_ = nullptr;
    decltype(&eglBindAPI) bind_api_ = nullptr;
    decltype(&eglChooseConfig) choose_config_ = nullptr;
    decltype(&eglCreateContext) create_context_ = nullptr;
    decltype(&eglDestroyContext) destroy_context_ = nullptr;
    decltype(&eglMakeCurrent) make_current_ = nullptr;
    decltype(&eglGetDisplay) get_display_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<Context>> open_egl() {
    auto context = std::make_unique<EglContext>();
    if (Status status = context->open(); !status) return status.error();
    return std::unique_ptr<Context>(std::move(context));
}

}  // namespace burin::gl
