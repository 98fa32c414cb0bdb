#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>

namespace tessera::server {

/// How the user has arranged the page for a project: panels, plots, chosen values. A browser keeps such things for one port
/// only, and the next server may have another. They belong to the user and not to the project: another user has other
/// screens, and a project that came from others brings none.
///
/// Threads: any.
class Arrangement {
 public:
  /// The texts of the page, by name. This program does not read them.
  using Entries = std::map<std::string, std::string>;

  static constexpr std::size_t most_names = 16;
  static constexpr std::size_t longest_name = 40;
  static constexpr std::size_t longest_text = std::size_t{1} << 16U;

  /// specification: absolute.
  explicit Arrangement(const std::filesystem::path& specification);

  /// Empty if nothing is kept, or if it is not understood.
  [[nodiscard]] Entries read() const;
  /// Replaces one text. Returns false if it cannot be kept: there is no folder for it, or no room.
  [[nodiscard]] bool keep(const std::string& name, const std::string& text);

 private:
  [[nodiscard]] Entries read_unlocked() const;

  std::filesystem::path file_;  ///< empty: nothing is kept for this user
  mutable std::mutex mutex_;
};

}  // namespace tessera::server
