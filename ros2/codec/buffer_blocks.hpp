#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ros2/codec/translator.hpp"
#include "ros2/codec/value_type.hpp"

/// The parts of a buffer to which the fields of a message correspond.
namespace tessera::ros2 {

/// The blocks of a buffer, in its order.
class BufferBlocks {
 public:
  /// nullopt: the buffer has too many.
  [[nodiscard]] static std::optional<BufferBlocks> number(const ValueType& value);

  [[nodiscard]] const std::vector<Translator::Block>& all() const { return blocks_; }
  /// The number of the block at a path of numbers or texts: "v", "poses[2].x". Errors: std::out_of_range.
  [[nodiscard]] std::size_t at(const std::string& path) const { return by_path_.at(path); }
  /// The number of the block for the length of a sequence of structures. Errors: std::out_of_range.
  [[nodiscard]] std::size_t length_at(const std::string& path) const;

 private:
  /// The element of a sequence in which a part of the buffer lies, if it lies in one; of several, the innermost.
  struct Element {
    std::optional<std::size_t> sequence{};  ///< the block of its length
    std::uint32_t number = 0;
  };
  void add(const ValueType& type, const std::string& path, const Element& element);
  void add_block(const std::string& path, Translator::Block block);

  std::vector<Translator::Block> blocks_;
  std::map<std::string, std::size_t> by_path_;
};

struct ElementsOfBuffer {
  const ValueType* type;   ///< of the array
  std::string path, rest;  ///< of the array; inside its elements
};
/// The first array of structures of the buffer through which the path leads, or to which it leads; nullopt:
/// there is none.
[[nodiscard]] std::optional<ElementsOfBuffer> elements_in(const std::string& path, const ValueType& value);

}  // namespace tessera::ros2
