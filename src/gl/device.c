// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// A graphics device without a window, by EGL: of all devices, else without any surface.
#include "gl/device.h"
#include "base/platform.h"
#include "gl/tuning.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEVICES = 16 };

/// What there is to choose from.
typedef struct candidates {
    EGLDisplay displays[MAX_DEVICES + 1];
    const char *files[MAX_DEVICES + 1]; ///< that the driver opens; NULL: not known
    int count;
} candidates;

/// epoxy ends the process where it finds no library.
static bool has_library(void) {
    return ewa_platform_has_library("libEGL.so.1") &&
           (ewa_platform_has_library("libOpenGL.so.0") || ewa_platform_has_library("libGL.so.1"));
}

/// The file by which a device is reached, as far as its driver says.
static const char *file_of(EGLDeviceEXT device) {
    const char *extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    enum { RENDER_NODE_FILE = 0x3377 }; // EGL_EXT_device_drm_render_node
    if (!extensions) return NULL;
    if (strstr(extensions, "EGL_EXT_device_drm_render_node")) return eglQueryDeviceStringEXT(device, RENDER_NODE_FILE);
    return strstr(extensions, "EGL_EXT_device_drm") ? eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT) : NULL;
}

static void find_displays(candidates *found) {
    memset(found, 0, sizeof *found);
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
        EGLDeviceEXT devices[MAX_DEVICES];
        EGLint count = 0;
        if (eglQueryDevicesEXT(MAX_DEVICES, devices, &count))
            for (EGLint i = 0; i < count; i++) {
                const EGLDisplay display =
                    eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL);
                if (display == EGL_NO_DISPLAY) continue;
                found->files[found->count] = file_of(devices[i]);
                found->displays[found->count++] = display;
            }
    }
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        const EGLDisplay display =
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
        if (display != EGL_NO_DISPLAY) found->displays[found->count++] = display;
    }
}

/// Makes a context on a display: of OpenGL 4.3, else 3.3.
static bool create_context(ewa_gl *device, EGLDisplay display) {
    EGLint major = 0, minor = 0;
    if (!eglInitialize(display, &major, &minor)) return false;
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) return false;
    const EGLint config_wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    if (!eglBindAPI(EGL_OPENGL_API)) return false;
    if (!eglChooseConfig(display, config_wanted, &config, 1, &count) || count < 1) config = EGL_NO_CONFIG_KHR;
    // Not every driver can tell of resets, and then some refuse to be asked to.
    const bool may_be_robust = major > 1 || minor >= 5;
    static const EGLint versions[2][2] = {{4, 3}, {3, 3}};
    for (int i = 0; i < 4; i++) {
        const bool robust = i % 2 == 0;
        if (robust && (!may_be_robust || ewa_gl_tuning("plain", 0))) continue;
        const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 versions[i / 2][0],
                                 EGL_CONTEXT_MINOR_VERSION,
                                 versions[i / 2][1],
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 robust ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY : EGL_NONE,
                                 EGL_LOSE_CONTEXT_ON_RESET,
                                 EGL_NONE};
        device->gl = eglCreateContext(display, config, EGL_NO_CONTEXT, wanted);
        if (device->gl != EGL_NO_CONTEXT) {
            device->display = display;
            return true;
        }
    }
    return false;
}

static void copy_text(char *to, size_t size_bytes, GLenum name) {
    const char *text = (const char *)glGetString(name);
    snprintf(to, size_bytes, "%s", text ? text : "unknown");
}

static uint32_t integer_of(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value > 0 ? (uint32_t)value : 0;
}

static void read_facts(ewa_gl_facts *facts) {
    copy_text(facts->vendor, sizeof facts->vendor, GL_VENDOR);
    copy_text(facts->renderer, sizeof facts->renderer, GL_RENDERER);
    copy_text(facts->version, sizeof facts->version, GL_VERSION);
    static const char *const software[] = {"llvmpipe", "softpipe", "SwiftShader", "swrast"};
    for (size_t i = 0; i < sizeof software / sizeof software[0]; i++)
        facts->software |= strstr(facts->renderer, software[i]) != NULL;
    facts->texture_px = integer_of(GL_MAX_TEXTURE_SIZE);
    facts->compute = epoxy_gl_version() >= 43;
    if (!facts->compute) return;
    facts->with_doubles = true; // of OpenGL 4.0
    GLint64 bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    facts->storage_bytes = bytes > 0 ? (uint64_t)bytes : 0;
    facts->storage_count = integer_of(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
    facts->binding_count = integer_of(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
    facts->group_threads = integer_of(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
    GLint groups = 0;
    glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 0, &groups);
    facts->group_count = groups > 0 ? (uint32_t)groups : 0;
}

static void destroy_context(ewa_gl *device) {
    if (device->gl != EGL_NO_CONTEXT) eglDestroyContext(device->display, device->gl);
    device->gl = EGL_NO_CONTEXT;
}

/// Tries a display; returns whether the device has a context and its facts then.
static bool try_display(ewa_gl *device, EGLDisplay display) {
    if (!create_context(device, display)) return false;
    if (ewa_gl_enter(device) != EWA_OK) {
        destroy_context(device);
        return false;
    }
    memset(&device->facts, 0, sizeof device->facts);
    read_facts(&device->facts);
    ewa_gl_leave(device);
    return true;
}

/// Takes the device that the environment asks for, else the first that is no software, else the first.
static bool choose_display(ewa_gl *device, const candidates *found) {
    const char *asked = getenv("EWA_GL_DEVICE");
    if (asked && *asked) {
        const long index = strtol(asked, NULL, 10);
        return index >= 0 && index < found->count && try_display(device, found->displays[index]);
    }
    for (int hard = 1; hard >= 0; hard--)
        for (int i = 0; i < found->count; i++) {
            if (!try_display(device, found->displays[i])) continue;
            if (!hard || !device->facts.software) return true;
            destroy_context(device);
        }
    return false;
}

/// Why a device gives no context, where that can be seen from here; else "".
static const char *hint_of(const char *file) {
    ewa_platform_facts facts;
    if (!file && !ewa_platform_stat("/dev/dri", &facts) && !ewa_platform_stat("/dev/nvidiactl", &facts))
        return "; there is no /dev/dri: a container has to be given the files of the graphics driver";
    if (file && !(ewa_platform_may_read(file) && ewa_platform_may_write(file)))
        return "; its file in /dev/dri is not this user's to open (groups render and video)";
    return "";
}

void ewa_gl_list(char *text, size_t size_bytes) {
    text[0] = 0;
    if (!has_library()) return;
    const EGLenum api = eglQueryAPI();
    candidates found;
    find_displays(&found);
    size_t at = 0;
    for (int i = 0; i < found.count && at < size_bytes; i++) {
        ewa_gl device = {.gl = EGL_NO_CONTEXT};
        if (try_display(&device, found.displays[i]))
            at += (size_t)snprintf(text + at, size_bytes - at, "%s%d: %s", i ? "\n" : "", i, device.facts.renderer);
        else
            at += (size_t)snprintf(text + at, size_bytes - at, "%s%d: no context%s", i ? "\n" : "", i,
                                   hint_of(found.files[i]));
        destroy_context(&device);
    }
    eglBindAPI(api);
}

ewa_status ewa_gl_open(ewa_context *context, ewa_gl **device) {
    *device = NULL;
    if (!has_library())
        return ewa_fail(
            context, EWA_ERROR_UNSUPPORTED,
            "OpenGL: libEGL.so.1 or libOpenGL.so.0 is not installed (Debian: libegl1, libopengl0)");
    ewa_gl *made = ewa_allocate_zeroed(context, 1, sizeof *made);
    if (!made) return EWA_ERROR_MEMORY;
    made->context = context;
    const EGLenum api = eglQueryAPI();
    candidates found;
    find_displays(&found);
    const bool chosen = ewa_gl_tuning("nodevice", 0) == 0 && choose_display(made, &found);
    eglBindAPI(api);
    if (!chosen) {
        ewa_release(context, made, 1, sizeof *made);
        return ewa_fail(
            context, EWA_ERROR_UNSUPPORTED,
            "OpenGL: none of %d devices gives a context without a window; a driver may be missing "
            "(Debian: libegl-mesa0 and libgl1-mesa-dri, or libnvidia-gl)%s",
            found.count, hint_of(found.files[0]));
    }
    ewa_gl_facts *facts = &made->facts;
    facts->storage_bytes = ewa_gl_tuning("storage", facts->storage_bytes);
    facts->storage_count = (uint32_t)ewa_gl_tuning("blocks", facts->storage_count);
    facts->binding_count = (uint32_t)ewa_gl_tuning("bindings", facts->binding_count);
    facts->group_count = (uint32_t)ewa_gl_tuning("groups", facts->group_count);
    made->lose_at = ewa_gl_tuning("lose", 0), made->hang_at = ewa_gl_tuning("hang", 0);
    *device = made;
    return EWA_OK;
}

void ewa_gl_close(ewa_gl **device) {
    if (!device || !*device) return;
    ewa_gl *old = *device;
    // Displays are one for a process: others may use them.
    destroy_context(old);
    ewa_release(old->context, old, 1, sizeof *old);
    *device = NULL;
}

ewa_status ewa_gl_enter(ewa_gl *device) {
    if (device->lost)
        return ewa_fail(device->context, EWA_ERROR_UNSUPPORTED, "OpenGL: %s was lost",
                        device->facts.renderer);
    device->outside.api = eglQueryAPI();
    eglBindAPI(EGL_OPENGL_API);
    device->outside.display = eglGetCurrentDisplay();
    device->outside.gl = eglGetCurrentContext();
    device->outside.draw = eglGetCurrentSurface(EGL_DRAW);
    device->outside.read = eglGetCurrentSurface(EGL_READ);
    if (eglMakeCurrent(device->display, EGL_NO_SURFACE, EGL_NO_SURFACE, device->gl)) return EWA_OK;
    eglBindAPI(device->outside.api);
    return ewa_fail(device->context, EWA_ERROR_UNSUPPORTED, "OpenGL: the context cannot be used (EGL 0x%x)",
                    (unsigned)eglGetError());
}

void ewa_gl_leave(ewa_gl *device) {
    if (device->outside.gl != EGL_NO_CONTEXT)
        eglMakeCurrent(device->outside.display, device->outside.draw, device->outside.read,
                       device->outside.gl);
    else
        eglMakeCurrent(device->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglBindAPI(device->outside.api);
}

static ewa_status lose(ewa_gl *device, const char *what, const char *how) {
    device->lost = true;
    return ewa_fail(device->context, EWA_ERROR_UNSUPPORTED, "OpenGL: %s %s in %s", device->facts.renderer,
                    how, what);
}

ewa_status ewa_gl_check(ewa_gl *device, const char *what) {
    if (epoxy_gl_version() >= 45 && glGetGraphicsResetStatus() != GL_NO_ERROR)
        return lose(device, what, "was reset");
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return EWA_OK;
    enum { KINDS = 8 }; // of errors, each noted once; a lost context notes the same for ever
    for (int i = 0; i < KINDS && glGetError() != GL_NO_ERROR; i++) {
    }
    if (error == GL_OUT_OF_MEMORY)
        return ewa_fail(device->context, EWA_ERROR_MEMORY, "OpenGL: %s has too little memory for %s",
                        device->facts.renderer, what);
    return ewa_fail(device->context, EWA_ERROR_UNSUPPORTED, "OpenGL: error 0x%x in %s", (unsigned)error,
                    what);
}

ewa_status ewa_gl_wait(ewa_gl *device, const char *what) {
    device->wait_count++, device->counts.waits++;
    if (device->wait_count == device->lose_at) return lose(device, what, "was reset");
    if (device->wait_count == device->hang_at) return lose(device, what, "hangs");
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence) return ewa_gl_check(device, what);
    enum { SLOW = 60 }; // software does not hang, it is slow
    const double patience_s = (device->facts.software ? SLOW : 1) *
                              (EWA_GL_PATIENCE_S + EWA_GL_PATIENCE_PER_SURFEL_S * (double)device->surfel_count);
    const GLenum waited = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, (GLuint64)(patience_s * 1e9));
    glDeleteSync(fence);
    if (waited == GL_TIMEOUT_EXPIRED) return lose(device, what, "hangs");
    if (waited == GL_WAIT_FAILED) return lose(device, what, "fails");
    return ewa_gl_check(device, what);
}
