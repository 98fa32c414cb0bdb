#include "project/process/network_status.hpp"

#include <dlfcn.h>
#include <fmt/core.h>

#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <string_view>
#include <thread>
#include <utility>

#include "project/process/status_inbox.hpp"

namespace tessera::project {

namespace {

constexpr std::chrono::milliseconds longest_wait{100};

/// nullptr, and `error` says why.
std::unique_ptr<network::StatusReader> open_reader(const std::filesystem::path& library,
                                                   const std::string& system,
                                                   const Snapshot::Deployment& where, std::string& error) {
  void* const loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr) {
    const char* const why = dlerror();
    error = why == nullptr ? library.string() : why;
    return nullptr;
  }
  auto* const open =
      reinterpret_cast<network::OpenStatusReader*>(dlsym(loaded, network::open_status_reader_function));
  if (open == nullptr) {
    error = fmt::format("{} is of another version", library.string());
    return nullptr;
  }
  const std::vector<std::string_view> peers(where.peers.begin(), where.peers.end());
  std::array<char, 1024> why{};
  std::unique_ptr<network::StatusReader> made(
      open({.system = system, .domain = where.domain, .interface = where.interface, .peers = peers},
           why.data(), why.size()));
  error = why.data();
  return made;
}

/// Entering a network may wait for the name service: its thread does.
class LibraryFeed final : public StatusFeed {
 public:
  LibraryFeed(std::filesystem::path library, const std::string& system, const Snapshot::Deployment& where)
      : inbox_(system, where) {
    thread_ = std::thread([this, library = std::move(library), system, where] {
      try {
        read(library, system, where);
      } catch (const std::exception& problem) {
        inbox_.complaint(std::string("other machines are not watched any more: ") + problem.what());
      }
    });
  }
  ~LibraryFeed() override {
    ends_ = true;
    thread_.join();
  }
  LibraryFeed(const LibraryFeed&) = delete;
  LibraryFeed& operator=(const LibraryFeed&) = delete;

  [[nodiscard]] std::vector<HeardStatus> take() override { return inbox_.take(); }
  [[nodiscard]] std::string remark() const override { return inbox_.remark(); }

 private:
  void read(const std::filesystem::path& library, const std::string& system,
            const Snapshot::Deployment& where) {
    std::string error;
    const std::unique_ptr<network::StatusReader> reader = open_reader(library, system, where, error);
    if (reader == nullptr) inbox_.complaint("other machines are not watched: " + error);
    while (reader != nullptr && !ends_) reader->receive(inbox_, longest_wait);
  }

  StatusInbox inbox_;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace

OpenFeed feed_of_library(const std::filesystem::path& library) {
  return [library](const std::string& system, const Snapshot::Deployment& where) {
    return std::make_unique<LibraryFeed>(library, system, where);
  };
}

}  // namespace tessera::project
