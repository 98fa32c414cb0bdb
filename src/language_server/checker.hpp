#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"

namespace tessera::language_server {

/// A file that a checked text includes, as it is saved.
struct IncludedFile {
  std::filesystem::path path;
  std::string text;
  std::vector<diagnostics::Diagnostic> found{};  ///< of its own lines
};

/// The results for a text that was checked.
struct Checked {
  std::vector<diagnostics::Diagnostic>
      found;  ///< those of project::draft_of, which `tessera check` finds too
  std::vector<IncludedFile> included;
  std::shared_ptr<const net::HierarchicalNet> pages;  ///< nullptr: of a text with errors
};
/// uri: of the text, whose included files are looked up beside it.
[[nodiscard]] Checked check(const std::string& uri, const std::string& text);

/// Checks texts in a thread of its own, some time after they were changed for the last time.
///
/// Threads: any.
class Checker {
 public:
  struct Text {
    std::string uri;
    std::string text;
    std::int64_t version = 0;
  };
  using Told = std::function<void(const Text&, const Checked&)>;
  /// told: called by the thread; `delay`: of the check after a change.
  Checker(std::chrono::milliseconds delay, Told told);
  ~Checker();
  Checker(const Checker&) = delete;
  Checker& operator=(const Checker&) = delete;

  /// Replaces an earlier text of that URI that was not checked yet.
  void changed(Text text);
  void forget(const std::string& uri);

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    Text text;
    Clock::time_point due;
  };
  void work();

  std::chrono::milliseconds delay_;
  Told told_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Waiting> waiting_;
  std::string checked_now_;
  bool forgotten_ = false;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace tessera::language_server
