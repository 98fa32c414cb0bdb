#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tessera {

/// Counts lines that differ in their numbers only, so that one warning does not bury the others. The digits of a
/// name count as letters: robot[1] is not robot[2].
///
/// The first three of a kind are printed, then the 10th, the 100th and so on. Kinds beyond the 128th are always
/// printed.
///
/// Threads: any; no function waits or allocates.
class RepeatedLines {
 public:
  struct Turn {
    bool printed = true;
    std::uint64_t count = 1;  ///< how many of this kind there have been
  };
  /// One more line. level: any number that tells kinds apart.
  [[nodiscard]] Turn next(int level, std::string_view path, std::string_view text);

  /// Calls `tell(path, text, left_out)` for each kind whose last lines were not printed: the text of the first
  /// line, cut off after some words. The counts begin anew. Threads: while no other calls a function.
  template <class Tell>
  void tell_left_out(Tell&& tell) {
    for (Kind& one : kinds_) {
      if (const std::uint64_t left_out = one.count - one.printed; one.ready && left_out > 0)
        tell(std::string_view(one.path.data(), one.path_size),
             std::string_view(one.text.data(), one.text_size), left_out);
      one.key = 0;
      one.ready = false;
      one.count = one.printed = 0;
    }
  }

 private:
  struct Kind {
    std::atomic<std::uint64_t> key{0};  ///< 0: free
    std::atomic<bool> ready{false};     ///< path and text are there
    std::atomic<std::uint64_t> count{0}, printed{0};
    std::array<char, 64> path{};
    std::array<char, 160> text{};
    std::size_t path_size = 0, text_size = 0;
  };
  [[nodiscard]] Kind* find(std::uint64_t key, std::string_view path, std::string_view text);

  std::array<Kind, 128> kinds_;
};

}  // namespace tessera
