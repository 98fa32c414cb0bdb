#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "range_coder.hpp"
#include "tessera/poses.hpp"

namespace tessera {

/// The prediction that both ends of a stream of packed poses make of the next frame: the motion of each body,
/// and the size of its last prediction errors. It computes with whole numbers only, so every machine predicts
/// the same.
class PoseModel {
 public:
  /// parents: see PoseEncoder.
  PoseModel(std::size_t bodies, const PoseParents& parents);

  /// Starts again with bodies that rest at these poses.
  void restart(const std::vector<RoundedPose>& poses);
  /// Appends the poses to `bytes`, as many as there are bodies. whole: the result needs no earlier frame.
  void pack(bool whole, const std::vector<RoundedPose>& poses, std::string& bytes);
  /// false: the bytes are damaged.
  [[nodiscard]] bool unpack(bool whole, std::string_view bytes, std::vector<RoundedPose>& poses);

 private:
  static constexpr std::size_t components = 7, longest_number = 44, classes = 16;
  static constexpr std::size_t ways = 3;  // of prediction: at rest; continued motion; motion with the parent
  /// A model for numbers of similar size.
  struct NumberModel {
    BitModel zero, sign;
    std::array<BitModel, longest_number> length, next;  // next: the bit after the first, by length
  };
  struct Body {
    RoundedPose last, before, older;  // of the last three frames
    std::optional<std::size_t> parent;
    std::array<std::uint8_t, components> sizes{};  // of the last prediction errors, in bits
    std::array<std::array<std::uint32_t, ways>, components> misses{};
    bool rested = false;
  };

  template <class Coder>
  [[nodiscard]] bool code_frame(Coder& coder, bool whole, std::vector<RoundedPose>& poses);
  template <class Coder>
  [[nodiscard]] bool code_moved(Coder& coder, Body& body, RoundedPose& pose);
  template <class Coder>
  [[nodiscard]] static bool code_number(Coder& coder, NumberModel& model, std::int64_t& number);
  void forget();

  std::vector<Body> bodies_;
  std::array<BitModel, 2> rests_;
  std::array<std::array<NumberModel, classes>, 3> moved_;  // positions, rotations, their largest parts
  std::array<NumberModel, components> whole_;
};

}  // namespace tessera
