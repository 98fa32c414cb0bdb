#include "recorder/pose_recorder.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "tessera/recording.hpp"
#include "tessera/value_encoding.hpp"

namespace tessera {

PoseRecorder::PoseRecorder(RecordingLane& lane, const Clock& clock, const WorldScene& scene)
    : lane_(lane), clock_(clock), encoder_(scene.bodies.size()) {}

void PoseRecorder::take(Time time, std::span<const BodyPose> poses) {
  const Time at = clock_.simulated() ? time : clock_.now();
  const std::string_view frame = encoder_.encode(at.time_since_epoch().count(), poses);
  if (!frame.empty()) lane_.poses(at, frame);
}

std::string hash_of(const WorldScene& scene) {
  ValueSink sink(0);
  sink.put(scene.glb.data(), scene.glb.size());
  return fmt::format("{:016x}", sink.hash());
}

std::string keep_scene(const WorldScene& scene, const std::string& recording, std::string& error) {
  namespace fs = std::filesystem;
  std::error_code problem;
  if (!fs::is_regular_file(recording, problem)) return {};
  const std::string file = scene_file(recording, hash_of(scene));
  // An existing file of that name has the same content, unless it was cut off.
  if (fs::is_regular_file(fs::symlink_status(file, problem)) &&
      fs::file_size(file, problem) == scene.glb.size())
    return file;
  const std::string unfinished = fmt::format("{}.{}", file, getpid());
  errno = 0;
  std::ofstream stream(unfinished, std::ios::binary | std::ios::trunc);
  stream << scene.glb << std::flush;
  const int reason = errno;
  if (stream) {
    stream.close();
    fs::rename(unfinished, file, problem);
    if (!problem) return file;
  } else {
    problem = std::error_code(reason, std::generic_category());
  }
  error = fmt::format("the scene of the world cannot be written to '{}': {}", file, problem.message());
  fs::remove(unfinished, problem);
  return {};
}

}  // namespace tessera
