#include "tools/gpu/egl_context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <utility>
#include <vector>

namespace gim {

struct EglContext::State {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (display == EGL_NO_DISPLAY) return;
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
        eglTerminate(display);
    }
};

namespace {

std::vector<EGLDisplay> displays() {
    std::vector<EGLDisplay> found;
    const bool has_platforms = epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base");
    if (has_platforms && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    if (has_platforms && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        if (!eglQueryDevicesEXT(16, devices, &count)) count = 0;
        for (EGLint i = 0; i < count; ++i)
            found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    }
    found.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
    return found;
}

// Returns an empty string if the context is current now, else what is missing.
std::string start(EGLDisplay display, EGLContext* context) {
    if (!eglBindAPI(EGL_OPENGL_API)) return "EGL has no OpenGL";
    const EGLint any_config[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, any_config, &config, 1, &count) || count == 0) config = nullptr;
    const EGLint version[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    *context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    if (*context == EGL_NO_CONTEXT) return "the driver has no OpenGL 4.5";
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, *context)) return "the driver draws only to surfaces";
    return {};
}

}  // namespace

EglContext::EglContext(std::unique_ptr<State> state) : state_(std::move(state)) {}
EglContext::EglContext(EglContext&&) noexcept = default;
EglContext& EglContext::operator=(EglContext&&) noexcept = default;
EglContext::~EglContext() = default;

Result<EglContext> EglContext::create() {
    std::string reasons;
    for (const EGLDisplay display : displays()) {
        if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) continue;
        auto state = std::make_unique<State>();
        state->display = display;
        const std::string reason = start(display, &state->context);
        if (reason.empty()) return EglContext(std::move(state));
        reasons += "; " + reason;
    }
    return Error{Stage::kInput, "no display of EGL gives OpenGL 4.5 without a window" + reasons};
}

std::string EglContext::renderer() const {
    const auto text = [](GLenum name) { return std::string(reinterpret_cast<const char*>(glGetString(name))); };
    return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

}  // namespace gim
