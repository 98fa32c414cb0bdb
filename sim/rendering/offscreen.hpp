#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "tessera/result.hpp"

namespace tessera::sim {

/// An OpenGL context without a window. It needs no X server and no graphics card. Among the devices that EGL
/// finds, it prefers the one that renders in software, so that machines of one kind give equal pictures.
///
/// libEGL is opened when it is needed. Without it everything else works.
///
/// Threads: any. It is current in one thread at a time.
class OffscreenContext {
 public:
  /// The context of the process, made at the first call. It stays until the process ends, so that shaders are
  /// compiled once. Problem: why this machine cannot render, with the missing packages.
  [[nodiscard]] static const Result<std::unique_ptr<OffscreenContext>>& of_process();
  /// library: the file name of libEGL.
  [[nodiscard]] static Result<std::unique_ptr<OffscreenContext>> open(const char* library);

  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;
  ~OffscreenContext();

  /// While it exists, the context is current in this thread; other threads wait for it.
  class Current {
   public:
    /// Throws std::runtime_error if EGL refuses.
    explicit Current(OffscreenContext& context);
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;
    ~Current();

   private:
    OffscreenContext& context_;
    std::scoped_lock<std::mutex> lock_;
  };

 private:
  struct Egl;
  explicit OffscreenContext(std::unique_ptr<Egl> egl);

  std::unique_ptr<Egl> egl_;
  std::mutex mutex_;
};

}  // namespace tessera::sim
