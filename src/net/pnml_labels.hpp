#pragma once

#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>

#include "diagnostics/diagnostics.hpp"
#include "net/pnml_elements.hpp"
#include "net/pnml_vocabulary.hpp"

namespace tessera::net {

/// Reads the labels of the elements of a PNML document: names, markings, weights and kinds of arcs, as the standard,
/// PIPE ("Default,2") and TAPAAL (attributes) write them. A marking or weight that cannot be read counts as one that
/// is missing.
///
/// Errors: E425 a number that is none in range; E428 a label that is given twice or has no single value; E429 an arc
///         with an interval of time; what the vocabulary refuses. The vocabulary reports all but E425.
class PnmlLabels {
 public:
  /// All three outlive this object.
  PnmlLabels(diagnostics::Diagnostics& out, const PnmlPositions& positions, PnmlVocabulary& vocabulary)
      : out_(out), positions_(positions), vocabulary_(vocabulary) {}

  /// The name of an element: its label, as the standard says and as PIPE does, or its attribute, as TAPAAL does.
  [[nodiscard]] static std::string name(const pugi::xml_node& node);
  /// The tokens of a place at the start.
  [[nodiscard]] std::uint32_t marking(const pugi::xml_node& place);
  /// TAPAAL has the weight beside the inscription, which is an interval of time or 1.
  [[nodiscard]] std::uint32_t weight(const pugi::xml_node& arc);
  /// Whether tokens are taken or put. false: it is another kind of arc, which has been reported.
  [[nodiscard]] bool is_plain(const pugi::xml_node& arc);
  /// Whether the reader reads that child. A child that has no meaning for the net has been judged then.
  [[nodiscard]] bool is_read(PnmlOwner owner, const pugi::xml_node& node);

 private:
  /// The text of a label, and where it stands.
  struct Value {
    std::string text;
    diagnostics::Span span;
  };
  /// nullopt: it is not clear, which has been reported.
  [[nodiscard]] std::optional<Value> value_of(const pugi::xml_node& holder);
  /// owner: has the number as a label, or as an attribute of its own.
  [[nodiscard]] std::uint32_t number(const pugi::xml_node& owner, const char* label,
                                     const pugi::xml_attribute& attribute, const char* what,
                                     std::uint32_t missing, std::uint32_t least);
  /// "3", or "Default,3" as PIPE writes it: the number of tokens of a class.
  [[nodiscard]] std::uint32_t whole_number(const Value& given, const char* what, std::uint32_t missing,
                                           std::uint32_t least);

  diagnostics::Diagnostics& out_;
  const PnmlPositions& positions_;
  PnmlVocabulary& vocabulary_;
};

}  // namespace tessera::net
