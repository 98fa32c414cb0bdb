#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "drivers/substitutes.hpp"
#include "system/clock.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"
#include "tessera/value_encoding.hpp"

namespace tessera {

/// The values that came into the real inputs of a run, or that stood in a bag, take the place of all devices of a
/// simulated run. A real input without values has none. Commands go nowhere.
///
/// In a file with the clock "bag", a value is a message: it is new once, when it is read for the first time, as the
/// driver of a topic of ROS 2 gives it. One that is queued, such as the state of a goal, is read before any later one.
/// In a recording, a value stays until the next one, as it was read.
///
/// Threads: as Substitutes.
class RecordedInputs final : public Substitutes {
 public:
  struct Value {
    std::int64_t time_ns = 0;
    std::string bytes;
    bool silent = false, failed = false, queued = false;
  };
  struct Input {
    std::string type;  ///< as tessera/value_encoding.hpp describes
    std::vector<Value> values;
    bool are_messages = false;
  };

  /// file: a recording. nullptr and `error`: it cannot be read, or its values cannot be given again.
  [[nodiscard]] static std::unique_ptr<RecordedInputs> read(const std::string& file, std::string& error);

  [[nodiscard]] std::unique_ptr<Subsystem> subsystem(std::uint32_t instance, std::unique_ptr<Subsystem> own,
                                                     bool& scripted) override;
  [[nodiscard]] std::unique_ptr<RealReceptor> receptor(const std::string& path) override;
  [[nodiscard]] std::unique_ptr<RealEffector> effector(const std::string& path) override;

 private:
  std::map<std::string, std::shared_ptr<Input>> inputs_;  // by path
};

/// Gives the values of one real input as time goes on.
class RecordedReceptor final : public RealReceptor {
 public:
  explicit RecordedReceptor(std::shared_ptr<const RecordedInputs::Input> input) : input_(std::move(input)) {}
  /// Before the first read. clock lives longer. path: of the buffer. The values may have another type.
  [[nodiscard]] std::optional<Problem> follow(const Clock& clock, const std::string& path,
                                              const ValueEncoding* encoding);
  /// Throws std::runtime_error where the device has thrown.
  [[nodiscard]] bool read(std::span<std::byte> value) override;

 private:
  std::shared_ptr<const RecordedInputs::Input> input_;
  const Clock* clock_ = nullptr;
  const ValueEncoding* encoding_ = nullptr;
  std::size_t next_ = 0;  // the first value that has not come yet
};

}  // namespace tessera
