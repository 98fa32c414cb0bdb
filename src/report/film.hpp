#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "report/frame.hpp"

namespace tessera::report {

/// Takes the bytes of a film in order. false: they could not be written.
using FilmSink = std::function<bool(std::string_view)>;

/// Makes the bytes of a film, frame by frame.
class FilmWriter {
 public:
  virtual ~FilmWriter() = default;
  /// false: the sink has refused.
  [[nodiscard]] virtual bool add(const Frame& frame) = 0;
  /// Call it after the last frame.
  [[nodiscard]] virtual bool finish() = 0;
};

/// YUV4MPEG2, without compression: what every player and ffmpeg read. Width and height must be even.
[[nodiscard]] std::unique_ptr<FilmWriter> y4m_writer(int width, int height, int frames_per_s, FilmSink sink);
/// An animated PNG, which browsers play. frames: how many will be added.
[[nodiscard]] std::unique_ptr<FilmWriter> apng_writer(std::size_t frames, int frames_per_s, FilmSink sink);

}  // namespace tessera::report
