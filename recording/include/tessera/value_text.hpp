#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

/// Reads recorded values by the type in the header (tessera/value_encoding.hpp), without a C++ type.
class ValueLayout {
 public:
  /// nullopt: `type` describes no type.
  [[nodiscard]] static std::optional<ValueLayout> parse(std::string_view type);

  /// One number, bool or text of a value.
  struct ScalarValue {
    std::string_view text;     ///< text of a string; unknown bytes in hexadecimal
    double number = 0;         ///< value of every other kind; for integers beyond 2^53 the nearest double
    std::int64_t integer = 0;  ///< value of signed integers; unsigned ones with the same bits
    enum class Kind : std::uint8_t { boolean, integer, natural, real, text } kind = Kind::real;
    bool single = false;  ///< for a real number: it is a float32
    /// The shortest text that gives the same number.
    [[nodiscard]] std::string shown() const;
  };
  /// path: "linear", "points[3].x"; empty for a value that is one scalar.
  using Visit = std::function<void(const std::string& path, const ScalarValue& scalar)>;
  /// The length of a sequence, before its elements: `TYPE[<=N]` alone has one.
  using VisitLength = std::function<void(const std::string& path, std::size_t length)>;
  /// Visits the scalars in the order of the bytes, those that a sequence does not have left out. false: the
  /// bytes do not encode such a value; the scalars before the mistake have been visited.
  [[nodiscard]] bool visit(std::string_view bytes, const Visit& visit,
                           const VisitLength& visit_length = {}) const;

  /// The number of scalars in every such value; with sequences, the largest number.
  [[nodiscard]] std::size_t scalars() const;
  /// Whether the number of scalars depends on the value.
  [[nodiscard]] bool has_sequences() const;
  /// The paths of the sequences of varying length.
  [[nodiscard]] std::vector<std::string> sequences() const;
  /// The paths of the scalars; those of all elements that a sequence can have.
  [[nodiscard]] std::vector<std::string> paths() const;
  /// The types of the scalars, such as "float32", "bool" or "string(8)".
  [[nodiscard]] std::vector<std::string> types() const;
  /// "{linear: 0.3, angular: -1}", cut after `most` bytes.
  [[nodiscard]] std::string shown(std::string_view bytes, std::size_t most = 200) const;

  struct Node;  ///< tessera/value_layout.hpp
  [[nodiscard]] const Node& root() const { return *root_; }

 private:
  explicit ValueLayout(std::shared_ptr<const Node> root) : root_(std::move(root)) {}
  friend class ValueLayoutParser;
  std::shared_ptr<const Node> root_;
};

}  // namespace tessera
