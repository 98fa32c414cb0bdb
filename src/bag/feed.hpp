#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bag/bag_inputs.hpp"
#include "mcap/reader.hpp"

namespace tessera::bag {

/// Makes the values of one real input of the messages in a bag.
class Feed {
 public:
  struct Value {
    std::uint64_t log_ns = 0;
    std::span<const std::byte> bytes;  ///< valid during the call
    bool is_queued = false;            ///< the input gets it before any later one
  };
  using Give = std::function<void(const Value&)>;

  virtual ~Feed() = default;
  [[nodiscard]] virtual bool reads(const std::string& topic) const = 0;
  /// Takes a message of such a topic. Returns why the bag cannot be used; empty: it can.
  [[nodiscard]] virtual std::string take(const mcap::ReadMessage& one, const Give& give) = 0;
  /// All messages have been taken.
  virtual void finish(const Give& give) = 0;
  /// The things that a person should know, after `finish`.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
};

/// Reads a topic, or the topics of an action. nullptr and `error`: the driver does not fit.
[[nodiscard]] std::unique_ptr<Feed> make_feed(const WantedInput& wanted, std::string& error);

/// "has json messages of Text on /scan, and the driver of robot.laser.scan wants cdr messages of ..."; empty: it has
/// messages of this type there.
[[nodiscard]] std::string wrong_type(const mcap::ReadMessage& one, const std::string& wanted_type,
                                     const std::string& path);

/// Counts the messages of a topic, and those that do not fit.
struct MessageCount {
  std::uint64_t messages = 0, misfits = 0;
  /// Empty: all have come as they should.
  [[nodiscard]] std::optional<std::string> note(const std::string& topic, const std::string& path) const;
};

}  // namespace tessera::bag
