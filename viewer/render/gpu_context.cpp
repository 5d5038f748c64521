#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <sys/resource.h>

#include <string_view>
#include <utility>

#include "viewer/render/gpu.h"

namespace sgm::render {
namespace {

/// Whether a limit of address space (ulimit -v) leaves enough for OpenGL drivers, which end the program where it
/// doesn't.
bool hasAddressSpace() {
    constexpr rlim_t least_bytes = rlim_t{700} << 20;
    rlimit limit{};
    return getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur >= least_bytes;
}

/// Whether the system has the libraries that libepoxy opens with its first call, and without which it ends the program.
bool hasOpenGl() {
    const auto opens = [](const char* library) {
        void* const handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
        if (handle) dlclose(handle);
        return handle != nullptr;
    };
    return opens("libEGL.so.1") && (opens("libOpenGL.so.0") || opens("libGL.so.1"));
}

/// The displays worth trying, in order: surfaceless (Mesa, no hardware needed), then the first EGL devices.
std::vector<EGLDisplay> displays() {
    std::vector<EGLDisplay> found;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        if (eglQueryDevicesEXT(16, devices, &count))
            for (EGLint i = 0; i < count; ++i)
                found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    }
    return found;
}

/// A GL 4.3 core context without a surface on `display`, current on this thread, or EGL_NO_CONTEXT.
EGLContext contextOn(EGLDisplay display) {
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_CONTEXT;
    const EGLint configWanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    const EGLint contextWanted[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    EGLContext context = EGL_NO_CONTEXT;
    if (eglBindAPI(EGL_OPENGL_API) && eglChooseConfig(display, configWanted, &config, 1, &configs) && configs == 1)
        context = eglCreateContext(display, config, EGL_NO_CONTEXT, contextWanted);
    if (context != EGL_NO_CONTEXT && !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        eglDestroyContext(display, context);
        context = EGL_NO_CONTEXT;
    }
    if (context == EGL_NO_CONTEXT) eglTerminate(display);
    return context;
}

}  // namespace

Result<GpuContext> GpuContext::create() {
    if (!hasAddressSpace())
        return Error{Error::Kind::Budget, "out of memory: OpenGL drivers need 700 MiB of address space (ulimit -v)"};
    if (!hasOpenGl())
        return Error{Error::Kind::Internal,
                     "the system has no OpenGL: libEGL.so.1 and libOpenGL.so.0 aren't there (on Debian, libegl1 and "
                     "libopengl0)"};
    for (const EGLDisplay display : displays())
        if (const EGLContext context = contextOn(display); context != EGL_NO_CONTEXT)
            return GpuContext(display, context);
    return Error{
        Error::Kind::Internal,
        "EGL offers no OpenGL 4.3 context, neither surfaceless nor on a device (Mesa's software driver is enough)"};
}

GpuContext::GpuContext(GpuContext&& other) noexcept
    : display_(std::exchange(other.display_, nullptr)), context_(std::exchange(other.context_, nullptr)) {}

GpuContext::~GpuContext() {
    if (!context_) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
}

std::string GpuContext::description() const {
    const auto text = [](GLenum name) { return std::string(reinterpret_cast<const char*>(glGetString(name))); };
    return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

bool softwareGl() {
    const std::string_view renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return renderer.starts_with("llvmpipe") || renderer.starts_with("softpipe") ||
           renderer.find("Software Rasterizer") != renderer.npos || renderer.find("SwiftShader") != renderer.npos;
}

}  // namespace sgm::render
