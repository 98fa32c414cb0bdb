#include "ros2/dds/fast_library.hpp"

#include <dlfcn.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <utility>

namespace tessera::ros2 {
namespace {

constexpr const char* library_name = "libtessera_ros2_fast.so";

std::string library_path() {
  if (const char* const given = std::getenv("TESSERA_ROS2_FAST_LIBRARY"); given != nullptr && *given != '\0')
    return given;
  Dl_info ours{};
  if (dladdr(library_name, &ours) != 0 && ours.dli_fname != nullptr) {
    const auto beside = std::filesystem::path(ours.dli_fname).parent_path() / library_name;
    std::error_code none;
    if (std::filesystem::exists(beside, none)) return beside.string();
  }
  return library_name;
}

}  // namespace

void FastLibrary::begin(const FastSetup& setup) {
  if (std::exchange(begun_, true)) return;
  making_ = std::async(std::launch::async, [setup] { return made(setup); });
}

FastService* FastLibrary::service() {
  if (making_.valid() && making_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    Made made = making_.get();
    service_ = std::move(made.service);
    error_ = std::move(made.error);
  }
  return service_.get();
}

/// The library stays loaded, as its threads may run code of it.
FastLibrary::Made FastLibrary::made(const FastSetup& setup) {
  void* const library = dlopen(library_path().c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const function = library == nullptr ? nullptr : dlsym(library, fast_service_function);
  if (function == nullptr) {
    const char* const why = dlerror();
    return {nullptr, why == nullptr ? "it cannot be loaded" : why};
  }
  Made result;
  result.service = reinterpret_cast<MakeFastService*>(function)(setup, result.error);
  return result;
}

}  // namespace tessera::ros2
