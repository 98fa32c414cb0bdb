#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ros2/codec/cdr.hpp"
#include "ros2/codec/translator.hpp"

/// Reads the parts of a received message into a value of the buffer, for Translator::decode.
namespace tessera::ros2 {

/// Records the positions of the message's parts that the buffer takes.
///
/// The reader's `ok` is false after a walk through bytes that are no such message.
class PartFinder {
 public:
  struct Found {
    std::size_t at = 0, count = 0;
    const Translator::Step* step = nullptr;
  };

  /// blocks: the number of blocks of the buffer.
  PartFinder(CdrReader& reader, std::size_t blocks) : reader_(reader), blocks_(blocks) {}

  void walk(const std::vector<Translator::Step>& steps);

  /// The part for each block of the buffer; no step: the message has none.
  [[nodiscard]] const std::vector<Found>& blocks() const { return blocks_; }
  /// The part with the names of the elements.
  [[nodiscard]] const Found& names() const { return names_; }
  /// The first array of structures whose length does not fit, and the length that has come; nullptr: all fit.
  [[nodiscard]] const Found* misfit() const { return misfit_ ? &*misfit_ : nullptr; }

 private:
  void walk(const Translator::Step& step);

  CdrReader& reader_;
  std::vector<Found> blocks_;
  Found names_;
  std::optional<Found> misfit_;
};

/// The index of each name in the message. nullopt: a name is missing or there twice, which `misfit` tells.
[[nodiscard]] std::optional<std::vector<std::size_t>> order_of(CdrReader& reader,
                                                               const PartFinder::Found& found,
                                                               const std::vector<std::string>& names,
                                                               Translator::Misfit& misfit);

/// Writes the bytes of the buffer's value, block after block.
class ValueWriter {
 public:
  ValueWriter(CdrReader& reader, Translator::Misfit& misfit) : reader_(reader), misfit_(misfit) {}

  /// Adds the block that this part of the message fills. order: the index of each of Mapping::names in the
  /// message. names: how many the message has.
  ///
  /// other_length: the part does not fit, and the misfit tells why. malformed: a bool is neither 0 nor 1.
  [[nodiscard]] Translator::Outcome add(const PartFinder::Found& found, const Translator::Block& block,
                                        const std::vector<std::size_t>& order, std::size_t names);
  /// Adds the number that begins a sequence.
  void add_length(std::size_t count);
  std::vector<std::byte>& value() { return value_; }

 private:
  /// count: elements of the buffer. order: the index of each in the message; nullptr: the same.
  Translator::Outcome add_numbers(const PartFinder::Found& found, const Translator::Block& block,
                                  std::size_t count, const std::vector<std::size_t>* order);
  Translator::Outcome add_texts(const PartFinder::Found& found, const Translator::Block& block,
                                std::size_t count, const std::vector<std::size_t>* order);
  void put(const void* bytes, std::size_t count);

  CdrReader& reader_;
  Translator::Misfit& misfit_;
  std::vector<std::byte> value_;
};

}  // namespace tessera::ros2
