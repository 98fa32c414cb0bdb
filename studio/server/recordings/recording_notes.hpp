#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tessera::server {

/// The name and the notes that a user gives to a recording. They are a small file beside it, RECORDING.notes.json.
struct Notes {
  struct Mark {
    std::int64_t time_ns = 0;
    std::string text;
  };
  std::string title, text;
  std::vector<Mark> marks;

  static constexpr std::size_t longest_title = 200, longest_text = 10'000, longest_mark = 500,
                               most_marks = 500;
  [[nodiscard]] bool empty() const { return title.empty() && text.empty() && marks.empty(); }
  /// Why these notes are not kept; empty: they can be.
  [[nodiscard]] std::string problem() const;
};

/// Reads and writes the notes of recordings. No symbolic link is followed.
///
/// Threads: any.
class RecordingNotes {
 public:
  /// {"title", "text", "marks": [{"t", "text"}], "revision", "problem"} of docs/reference/studio.md; null: there are
  /// none.
  [[nodiscard]] static nlohmann::json of(const std::filesystem::path& recording);

  struct Outcome {
    bool conflict = false;  ///< the notes on disk have another revision, so nothing is written
    nlohmann::json now;     ///< on disk after the write, as `of` gives them
  };
  /// Replaces the notes if those on disk still have `revision` ("": there are none). Empty notes remove the file. A run
  /// whose recording has notes is not removed when it is old (project::RunFolder).
  ///
  /// Errors: throws std::runtime_error if the file cannot be written.
  [[nodiscard]] Outcome write(const std::filesystem::path& recording, const Notes& notes,
                              const std::string& revision);

 private:
  std::mutex writing_;
};

}  // namespace tessera::server
