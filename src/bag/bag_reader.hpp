#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mcap/reader.hpp"
#include "tessera/recording.hpp"

namespace tessera::bag {

/// Whether a file begins as an MCAP file does.
[[nodiscard]] bool is_bag(const std::string& file);

/// A bag that Tessera has written.
struct Bag {
  Recording recording;  ///< that stands in it
  mcap::Condition condition;
  /// Messages of the other channels that are not those of the recording: "/scan at 1.200000 s is not what ...".
  /// Empty: they show this recording and nothing else.
  std::vector<std::string> differences;
};

/// Reads a bag of Tessera. Each message of it is compared with the one that the recording gives.
///
/// Errors: nullopt and `error`: it cannot be read, or does not contain a recording.
[[nodiscard]] std::optional<Bag> read_bag(const std::string& file, std::string& error);
/// The same of the bytes of a file.
[[nodiscard]] std::optional<Bag> read_bag_bytes(std::string_view bytes, std::string& error);

/// All bytes of a file. nullopt and `error`: it cannot be read.
[[nodiscard]] std::optional<std::string> bytes_of_file(const std::string& file, std::string& error);

}  // namespace tessera::bag
