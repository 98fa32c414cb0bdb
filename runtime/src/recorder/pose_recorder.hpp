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
  /// In real time, a frame has the time at which it is taken: a slow world falls behind.
  void take(Time time, std::span<const BodyPose> poses) override;

 private:
  RecordingLane& lane_;
  const Clock& clock_;
  PoseEncoder encoder_;
};

/// The identity of a scene, which is also its file name.
[[nodiscard]] std::string hash_of(const WorldScene& scene);

/// Writes the scene beside the recording. A recording that is no regular file has no scene. Returns the file.
/// Empty and `error`: it could not be written; the run goes on without it.
[[nodiscard]] std::string keep_scene(const WorldScene& scene, const std::string& recording,
                                     std::string& error);

}  // namespace tessera
