#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"

/// Elements of a PNML document: their names, children and positions.
namespace tessera::net {

/// The name without a namespace prefix.
[[nodiscard]] std::string_view name_of(const pugi::xml_node& node);

/// The first child of that name, without a namespace prefix; an empty node: there is none.
[[nodiscard]] pugi::xml_node child(const pugi::xml_node& node, std::string_view name);

/// Lines and columns of byte offsets.
class PnmlPositions {
 public:
  explicit PnmlPositions(std::string_view text);
  /// length: in bytes. A negative offset has no position.
  [[nodiscard]] diagnostics::Span at(std::ptrdiff_t offset, std::size_t length) const;
  /// The extent of an element's name, or of a text.
  [[nodiscard]] diagnostics::Span of(const pugi::xml_node& node) const;

 private:
  std::size_t size_;
  std::vector<std::size_t> starts_{0};  ///< of the lines
};

}  // namespace tessera::net
