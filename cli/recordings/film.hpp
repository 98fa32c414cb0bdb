#pragma once

#include <string>

#include "report/frame.hpp"
#include "report/paths.hpp"
#include "tessera/device.hpp"

namespace tessera::cli {

/// The film that `tessera replay --film FILE` makes.
struct FilmOptions {
  std::string file, recording, camera;
  std::string spec;  ///< the specification of the world; empty: that of the run
  std::string size = "960x540";
  double speed = 1, from_s = 0, to_s = 0;  ///< speed: simulated seconds per second
};

/// Draws the run and writes the film. Returns the exit code; prints the mistakes.
[[nodiscard]] int make_film(const FilmOptions& options);

/// The world of a recording, for drawing: that of its run, or of `spec`. Throws std::runtime_error with a
/// hint.
[[nodiscard]] WorldOptions world_of_recording(const std::string& recording, const std::string& spec);

/// A picture of the run's last instant, with all robots in view. Throws std::runtime_error with the reason if
/// there is none.
[[nodiscard]] report::Frame poster_of(const std::string& recording, const WorldOptions& world, int width,
                                      int height);

}  // namespace tessera::cli
