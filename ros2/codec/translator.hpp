#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ros2/codec/value_type.hpp"
#include "ros2/definitions/type.hpp"
#include "tessera/nearest.hpp"

namespace tessera::ros2 {

enum class Direction : std::uint8_t { receive, send };

/// A number of the buffer that the driver sets or reads itself, because no message has it.
struct OwnField {
  std::string name;
  std::vector<Primitive> types;  ///< any of these
  bool needed = true;
  std::string meaning{};  ///< "the number of the call", for error messages
};

/// How a message and a real buffer correspond.
struct Mapping {
  /// Field of the message -> field of the buffer: {"linear.x", "v"}. An empty buffer field is the whole
  /// buffer. If the list is empty, fields of equal names correspond; a buffer that is no structure
  /// corresponds to the only field of the message, or to its field `data`.
  std::vector<std::pair<std::string, std::string>> fields{};
  /// With names, the message has a field `name` (sensor_msgs/JointState) or `joint_names`
  /// (trajectory_msgs/JointTrajectory), itself or in a structure. The sequences beside it, and those of the
  /// points of trajectories beside it, are received in the order of these names, whatever order the sender
  /// uses; they are sent with these names.
  std::vector<std::string> names{};
  /// The value of `header.frame_id` in sent messages; without a field `header`, that of all headers inside.
  std::string frame_id{};
  /// Parts of the message may be empty, as those of feedback and result, of which one comes without the other. So
  /// its sequences need sequences of the buffer, and its names may be missing together with what they name.
  bool parts_may_be_empty = false;
  /// Fields of the buffer that are no part of the message.
  std::vector<OwnField> own{};
};

/// A mistake in a mapping.
struct MappingProblem {
  std::string subject;  ///< the field of the message as the mapping names it; "names"; empty: all of it
  std::string text;
  Hint hint{};
};

/// The time stamp of a sent message.
struct Stamp {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};

/// Translates messages into values of a real buffer, or the reverse. Values are in the form of
/// tessera/value_encoding.hpp. It is made once, because it compares the types.
///
/// When it sends, it fills the fields that the buffer does not: with defaults of the definition, otherwise
/// zeros. The field `header` gets the time and the `frame_id`.
///
/// Threads: const functions at any time.
class Translator {
 public:
  /// Errors: all problems are reported, then nullopt. A number must convert exactly, so int64 does not become
  /// float64. Every field of the buffer must correspond to one of the message.
  [[nodiscard]] static std::optional<Translator> make(std::shared_ptr<const Structure> message,
                                                      const ValueType& value, const Mapping& mapping,
                                                      Direction direction,
                                                      std::vector<MappingProblem>& problems);

  enum class Outcome : std::uint8_t {
    good,
    malformed,     ///< no such message: too short, too long, a bool of 2 ...
    other_length,  ///< a sequence or string has another length than the buffer, or one too great for it
    other_names    ///< one of Mapping::names is missing, or is there twice
  };
  /// The part of a message that does not fit.
  struct Misfit {
    std::string
        field;  ///< of the buffer: "ranges"; empty: it is not known. other_names: a name that is missing
    std::size_t came = 0, room = 0;  ///< elements of the message and of the buffer; of a text: bytes
    bool is_text = false;
  };
  /// The value is unchanged unless the outcome is good. Reads any bytes safely.
  ///
  /// own: values of Mapping::own; missing ones are 0. misfit: gets the reason of other_length and other_names.
  [[nodiscard]] Outcome decode(std::span<const std::byte> message, std::vector<std::byte>& value,
                               std::span<const std::uint64_t> own = {}, Misfit* misfit = nullptr) const;
  /// A value without a message: numbers are 0 and strings empty, except for its own fields.
  [[nodiscard]] std::vector<std::byte> empty_value(std::span<const std::uint64_t> own) const;
  /// The number in an own field of a value; 0: the buffer has no such field, or the value does not have its
  /// type.
  [[nodiscard]] std::uint64_t own_number(std::span<const std::byte> value, std::size_t field) const;
  /// Whether the buffer has that field of Mapping::own.
  [[nodiscard]] bool has_own(std::size_t field) const { return own_[field].has_value(); }

  /// false: the value does not have the bytes of its type. The result replaces the content of `message`.
  [[nodiscard]] bool encode(std::span<const std::byte> value, const Stamp& stamp,
                            std::vector<std::byte>& message) const;

  /// Numbers and texts of the buffer, in its order; an array of numbers is one block. A sequence of structures
  /// is a block for its length, then those of all elements that it can have.
  struct Block {
    std::string path{};  ///< in the buffer; empty: it is the buffer
    Primitive primitive = Primitive::boolean;
    std::uint32_t count = 1, capacity = 0;
    bool is_sequence = false;               ///< its length comes first, and `count` is the largest
    bool is_length = false;                 ///< of a sequence of structures
    std::optional<std::size_t> sequence{};  ///< in an element of a sequence: the block of its length
    std::uint32_t element = 0;              ///< the number of that element
  };
  enum class Fill : std::uint8_t { nothing, stamp_sec, stamp_nanosec, frame_id, names };
  /// A field of the message, or an element of it.
  struct Step {
    Type type;
    std::optional<std::size_t> block{};  ///< the corresponding part of the buffer
    Fill fill = Fill::nothing;
    bool by_name = false;      ///< its elements are in the order of Mapping::names
    bool per_element = false;  ///< `members` has one step for each element of an array of messages
    std::string array{};       ///< per element: the array of the buffer whose elements these are
    std::optional<std::size_t>
        length{};               ///< per element of a sequence of the buffer: the block of its length
    std::vector<Step> members;  ///< for a message
    std::vector<Literal> defaults{};
  };

 private:
  friend class TranslatorBuilder;
  Translator() = default;
  /// The number of a block that is an own field; nullopt: it is none.
  [[nodiscard]] std::optional<std::uint64_t> own_value(std::size_t block,
                                                       std::span<const std::uint64_t> own) const;
  std::shared_ptr<const Structure> message_;
  std::vector<Step> steps_;
  std::vector<Block> blocks_;
  std::vector<std::optional<std::size_t>> own_;  ///< the block of each own field
  std::vector<std::string> names_;
  bool names_may_be_empty_ = false;
  std::string frame_id_;
};

}  // namespace tessera::ros2
