#include "sim/rendering/offscreen.hpp"

#include <dlfcn.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string_view>

namespace tessera::sim {
namespace {

// The part of EGL that is used, as its specification defines it. Its headers would be one more build
// dependency.
using Handle = void*;
using Whole = std::int32_t;
using Truth = unsigned int;
constexpr Whole no_more = 0x3038, config_red = 0x3024, config_green = 0x3023, config_blue = 0x3022,
                config_depth = 0x3025, config_stencil = 0x3026, config_renderable = 0x3040,
                opengl_bit = 0x0008, config_surface = 0x3033, pbuffer_bit = 0x0001;
constexpr Whole extensions_text = 0x3055;
constexpr unsigned opengl_api = 0x30A2, platform_device = 0x313F, platform_surfaceless = 0x31DD;

constexpr const char* packages = "install the packages libegl1 and libgl1-mesa-dri";

Problem cannot_render(const std::string& why) {
  return {"cameras cannot be rendered on this machine: " + why + "; " + packages};
}

}  // namespace

/// libEGL, its display and the context.
struct OffscreenContext::Egl {
  Handle library = nullptr, display = nullptr, context = nullptr;
  void* (*find)(const char*) = nullptr;
  Truth (*initialise)(Handle, Whole*, Whole*) = nullptr;
  Truth (*choose_config)(Handle, const Whole*, Handle*, Whole, Whole*) = nullptr;
  Truth (*bind_api)(unsigned) = nullptr;
  Handle (*create_context)(Handle, Handle, Handle, const Whole*) = nullptr;
  Truth (*destroy_context)(Handle, Handle) = nullptr;
  Truth (*make_current)(Handle, Handle, Handle, Handle) = nullptr;
  Whole (*error)() = nullptr;
  // Extensions.
  Handle (*platform_display)(unsigned, void*, const Whole*) = nullptr;
  Truth (*query_devices)(Whole, Handle*, Whole*) = nullptr;
  const char* (*device_text)(Handle, Whole) = nullptr;

  Egl() = default;
  Egl(const Egl&) = delete;
  Egl& operator=(const Egl&) = delete;
  /// All users of EGL in this process share the display, so it is not terminated. The library stays loaded
  /// because Mesa has threads of its own.
  ~Egl() {
    if (context != nullptr) destroy_context(display, context);
  }

  template <class Function>
  bool load(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    return function != nullptr;
  }
  bool load_all() {
    const bool all = load(find, "eglGetProcAddress") && load(initialise, "eglInitialize") &&
                     load(choose_config, "eglChooseConfig") && load(bind_api, "eglBindAPI") &&
                     load(create_context, "eglCreateContext") && load(destroy_context, "eglDestroyContext") &&
                     load(make_current, "eglMakeCurrent") && load(error, "eglGetError");
    if (!all) return false;
    const auto extension = [this](auto& function, const char* name) {
      function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(find(name));
    };
    extension(platform_display, "eglGetPlatformDisplayEXT");
    extension(query_devices, "eglQueryDevicesEXT");
    extension(device_text, "eglQueryDeviceStringEXT");
    return platform_display != nullptr;
  }

  /// nullptr: EGL has none, or does not say.
  [[nodiscard]] Handle software_device() const {
    if (query_devices == nullptr || device_text == nullptr) return nullptr;
    std::array<Handle, 64> devices{};
    Whole count = 0;
    if (query_devices(static_cast<Whole>(devices.size()), devices.data(), &count) == 0) return nullptr;
    for (std::size_t index = 0; index < static_cast<std::size_t>(count); ++index) {
      const char* const extensions = device_text(devices[index], extensions_text);
      if (extensions != nullptr && std::string_view(extensions).find("device_software") != std::string::npos)
        return devices[index];
    }
    return nullptr;
  }

  bool open_display() {
    const auto opens = [this](Handle candidate) {
      if (candidate == nullptr || initialise(candidate, nullptr, nullptr) == 0) return false;
      display = candidate;
      return true;
    };
    if (Handle const device = software_device();
        device != nullptr && opens(platform_display(platform_device, device, nullptr)))
      return true;
    return opens(platform_display(platform_surfaceless, nullptr, nullptr));
  }

  bool open_context() {
    constexpr std::array<Whole, 15> wanted{
        config_red,     8,           config_green,      8,          config_blue,    8, config_depth, 24,
        config_surface, pbuffer_bit, config_renderable, opengl_bit, config_stencil, 8, no_more};
    Handle config = nullptr;
    Whole count = 0;
    if (bind_api(opengl_api) == 0 || choose_config(display, wanted.data(), &config, 1, &count) == 0)
      return false;
    context = create_context(display, count > 0 ? config : nullptr, nullptr, nullptr);
    return context != nullptr;
  }

  [[nodiscard]] std::string code() const {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), " (EGL error 0x%x)", static_cast<unsigned>(error()));
    return text.data();
  }
};

OffscreenContext::OffscreenContext(std::unique_ptr<Egl> egl) : egl_(std::move(egl)) {}
OffscreenContext::~OffscreenContext() = default;

Result<std::unique_ptr<OffscreenContext>> OffscreenContext::open(const char* library) {
  auto egl = std::make_unique<Egl>();
  egl->library = dlopen(library, RTLD_NOW | RTLD_LOCAL);
  if (egl->library == nullptr) return cannot_render(dlerror());
  if (!egl->load_all()) return cannot_render(std::string(library) + " lacks functions of EGL");
  if (!egl->open_display()) return cannot_render("EGL finds no renderer" + egl->code());
  if (!egl->open_context()) return cannot_render("EGL gives no OpenGL context" + egl->code());
  return std::unique_ptr<OffscreenContext>(new OffscreenContext(std::move(egl)));
}

/// It is never destroyed: at the end of the process, Mesa may be unloaded already.
const Result<std::unique_ptr<OffscreenContext>>& OffscreenContext::of_process() {
  static const auto& context = *new Result<std::unique_ptr<OffscreenContext>>(open("libEGL.so.1"));
  return context;
}

OffscreenContext::Current::Current(OffscreenContext& context) : context_(context), lock_(context.mutex_) {
  const Egl& egl = *context_.egl_;
  egl.bind_api(opengl_api);  // each thread has to call this
  if (egl.make_current(egl.display, nullptr, nullptr, egl.context) == 0)
    throw std::runtime_error("the OpenGL context cannot be used" + egl.code());
}

OffscreenContext::Current::~Current() {
  const Egl& egl = *context_.egl_;
  egl.make_current(egl.display, nullptr, nullptr, nullptr);
}

}  // namespace tessera::sim
