#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace tessera {

/// The bytes of a recording in order, while it is written or afterwards. A recording with a limit continues
/// in the next file when one file is full.
///
/// Threads: one at a time.
class GrowingRecording {
 public:
  /// The point at which to begin in a recording with a limit.
  enum class From : std::uint8_t {
    oldest,  ///< with the oldest segment that still exists, or with the segment named by its number
             ///< ("run.3.tsr")
    newest   ///< with the file itself, which is the newest segment
  };
  /// The file need not exist yet. A symbolic link counts as no file.
  GrowingRecording(std::string file, From from);
  ~GrowingRecording();
  GrowingRecording(const GrowingRecording&) = delete;
  GrowingRecording& operator=(const GrowingRecording&) = delete;

  struct Piece {
    std::string bytes;
    bool begins = false;  ///< a file begins here: it needs a new RecordingReader
    bool more = false;    ///< there may be more bytes now
  };
  /// The next bytes of one file, at most `most`. Does not wait.
  [[nodiscard]] Piece next(std::size_t most);

 private:
  struct File {
    int descriptor = -1;
    std::string run;  ///< header of the current run without the segment number
    std::optional<std::uint64_t> segment;
  };
  [[nodiscard]] static File open(const std::string& file);
  void begin();
  [[nodiscard]] std::string read_some(std::size_t most) const;
  [[nodiscard]] bool is_full() const;
  void go_on();
  void take(File file);

  std::string path_;
  From from_;
  File file_;
  bool begins_ = false;
};

}  // namespace tessera
