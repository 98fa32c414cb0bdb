#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "recorder/recorder.hpp"
#include "system/clock.hpp"
#include "tessera/device.hpp"
#include "tessera/poses.hpp"

namespace tessera {

/// Records the poses of the bodies of a world.
///
/// Threads: the one that moves the world.
class PoseRecorder final : public PoseSink {
 public:
  PoseRecorder(RecordingLane& lane, const Clock& clock, const WorldScene& scene);
  /// In real time, a frame has the time at which it is taken: the time of a slow world falls behind.
  void take(Time time, std::span<const BodyPose> poses) override;

 private:
  RecordingLane& lane_;
  const Clock& clock_;
  PoseEncoder encoder_;
};

/// What tells scenes apart, and names their files.
[[nodiscard]] std::string hash_of(const WorldScene& scene);

/// Writes the scene beside the recording. If the recording is no regular file, there is no place for it.
/// Returns the file. Empty and `error`: it could not be written; the run goes on without it.
[[nodiscard]] std::string keep_scene(const WorldScene& scene, const std::string& recording,
                                     std::string& error);

}  // namespace tessera
