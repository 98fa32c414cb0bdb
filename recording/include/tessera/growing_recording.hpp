#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace tessera {

/// The bytes of a recording as they come, while it is written or afterwards. One with a limit goes on in the
/// next file where one is full.
///
/// Threads: one at a time.
class GrowingRecording {
 public:
  /// Where one with a limit begins.
  enum class From : std::uint8_t {
    oldest,  ///< at the first segment that is left; of a segment named by its number ("run.3.tsr") there
    newest   ///< at the file itself
  };
  /// It need not exist yet. A symbolic link is none.
  GrowingRecording(std::string file, From from);
  ~GrowingRecording();
  GrowingRecording(const GrowingRecording&) = delete;
  GrowingRecording& operator=(const GrowingRecording&) = delete;

  struct Piece {
    std::string bytes;
    bool begins = false;  ///< of a file: a RecordingReader of its own is due
    bool more = false;    ///< there may be more at once
  };
  /// At most so many bytes, of one file. Does not wait.
  [[nodiscard]] Piece next(std::size_t most);

 private:
  struct File {
    int descriptor = -1;
    std::string run;  ///< its header without the number
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
