#pragma once

#include <sys/types.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "tessera/result.hpp"

namespace tessera::cli {

/// ".mp4" for "run.MP4".
[[nodiscard]] std::string ending_of(const std::string& file);
/// Whether a film can have this ending.
[[nodiscard]] bool is_known_ending(const std::string& ending);
/// An existing file is replaced only if it is a film of the same kind. Throws std::runtime_error otherwise.
void check_film_file(const std::string& file, const std::string& ending);

/// The unfinished film, which gets its name at the end; written by this process, or by ffmpeg. During its
/// lifetime, SIGINT, SIGTERM and SIGHUP end the film and not the process. Only one may exist at a time.
class FilmFile {
 public:
  /// Throws std::runtime_error with a hint: it cannot be written, or ffmpeg is needed and not installed.
  FilmFile(const std::string& file, const std::string& ending);
  FilmFile(const FilmFile&) = delete;
  FilmFile& operator=(const FilmFile&) = delete;
  ~FilmFile();

  [[nodiscard]] bool write(std::string_view bytes);
  /// nullopt: the film is complete. Otherwise the reason.
  [[nodiscard]] std::optional<Problem> finish(bool complete);

 private:
  void start_ffmpeg(const std::string& ending);

  std::string file_, unfinished_;
  std::optional<std::string> reason_;  ///< why it cannot be written
  int descriptor_ = -1;
  pid_t child_ = -1;
  std::array<void (*)(int), 3> before_{};  ///< the earlier handlers of the signals
  bool finished_ = false;
};

}  // namespace tessera::cli
