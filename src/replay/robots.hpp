#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tessera/growing_recording.hpp"
#include "tessera/poses.hpp"
#include "tessera/recording.hpp"

/// The positions of the robots in a recording.
namespace tessera::replay {

/// A body that stands on the world itself and belongs to an agent. If no body has an agent, all of them count.
struct Robot {
  std::string name;  ///< of the agent; of the body if the agent has several such bodies
  std::size_t body = 0;
};
[[nodiscard]] std::vector<Robot> robots_of(const Recording::Scene& scene);
/// The robots and all bodies that are attached to them, such as the hand of an arm.
[[nodiscard]] std::vector<std::size_t> parts_of_robots(const Recording::Scene& scene);

/// A body seen from above.
struct RobotPoint {
  std::int64_t time_ns = 0;
  double x_m = 0, y_m = 0, heading_rad = 0;  ///< heading: of its x axis
};
[[nodiscard]] RobotPoint from_above(std::int64_t time_ns, const BodyPose& pose);
/// A point in the frame of a body, as the world sees it.
[[nodiscard]] RobotPoint from_above(std::int64_t time_ns, const BodyPose& pose,
                                    const Recording::Scene::Eye& eye);

/// Any number of points as so many that are evenly spread; the first and the last are among them.
template <class Point>
class Thinned {
 public:
  explicit Thinned(std::size_t most) : most_(most) {}
  void add(const Point& point) {
    last_ = point;
    if (count_++ % every_ != 0) return;
    points_.push_back(point);
    if (points_.size() < most_) return;
    for (std::size_t index = 0; 2 * index < points_.size(); ++index) points_[index] = points_[2 * index];
    points_.resize((points_.size() + 1) / 2);
    every_ *= 2;
  }
  [[nodiscard]] std::vector<Point> points() const {
    std::vector<Point> all = points_;
    if (count_ > 0 && (count_ - 1) % every_ != 0) all.push_back(last_);
    return all;
  }

 private:
  std::size_t most_, every_ = 1, count_ = 0;
  std::vector<Point> points_;
  Point last_{};
};

/// Reads a recording of any length from its oldest part on, piece by piece.
class PoseReader {
 public:
  /// A folder stands for the recording in it.
  explicit PoseReader(const std::string& recording);
  /// The next entry; nullptr: there is no more. Valid until the next call.
  [[nodiscard]] const Recording::Entry* next();
  /// The data of the run; nullptr before the first entry.
  [[nodiscard]] const Recording* header() const { return reader_ ? &reader_->recording() : nullptr; }
  /// The poses after the last entry. Empty: they are not known now.
  [[nodiscard]] const std::vector<BodyPose>& poses() const { return poses_; }

 private:
  [[nodiscard]] bool read_on();
  void follow(const Recording::Entry& entry);

  GrowingRecording file_;
  std::unique_ptr<RecordingReader> reader_;
  std::vector<Recording::Entry> entries_;
  std::size_t at_ = 0;
  std::string scene_;  // hash
  std::optional<PoseDecoder> decoder_;
  std::vector<BodyPose> poses_;
};

}  // namespace tessera::replay
