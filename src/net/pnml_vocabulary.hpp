#pragma once

#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace tessera::net {

/// An element of PNML whose parts have a meaning of their own.
enum class PnmlOwner : std::uint8_t { document, net, page, place, transition, arc, reference, label };

/// The name without a namespace prefix.
[[nodiscard]] std::string_view local_name(std::string_view name);

/// Whether a type of a net, the attribute `type`, stands for place/transition nets. The core model is one of them:
/// its labels are judged one by one, as all are.
[[nodiscard]] bool is_place_transition_type(std::string_view type);

/// Judges the parts of elements of PNML: attributes, children and text. A part that the reader reads passes, and one
/// that cannot change what the net does: names, graphics, `toolspecific`. Parts of
/// other dialects (PIPE, TAPAAL, ProM) pass with the value that changes nothing. Everything else is refused, since
/// the net would be another one without it.
///
/// Parts with the same meaning are reported once, where the first stands, with their number.
///
/// Errors:   E423 colours, and arcs that are no plain ones; E428 a part that is not known; E429 time, capacities,
///           priorities. Warnings: W421 rates, probabilities, players; W422 final markings.
class PnmlVocabulary {
 public:
  using Span = diagnostics::Span;

  explicit PnmlVocabulary(diagnostics::Diagnostics& out) : out_(out) {}

  /// The attributes of an element. at: the extent of its name.
  void judge(PnmlOwner owner, const pugi::xml_node& node, Span at);
  /// A child of an element that was judged. false: it is not read; this has been reported if necessary.
  /// value: of the child's text, or its attribute `value`.
  [[nodiscard]] bool is_read(PnmlOwner owner, const pugi::xml_node& child, Span at, const std::string& value);
  /// Whether `is_read` asks for the value of such a child.
  [[nodiscard]] static bool has_value(PnmlOwner owner, const pugi::xml_node& child);
  /// An arc that is not of the plain kind.
  void refuse_arc(std::string_view kind, const pugi::xml_node& arc, Span at);
  /// A value that all elements must have in common: "timed" and "priority" of transitions, "class of tokens".
  void judge_same(std::string_view name, std::string_view value, Span at);
  /// The same for everything else that changes the meaning of the net.
  void refuse(const char* code, std::string key, Span at, std::string message, std::string hint);

  /// Reports what has been found. true: an error is among it.
  bool report();

 private:
  struct Finding {
    bool is_error = true;
    const char* code = "";
    Span span;
    std::string message, hint;
    std::size_t count = 0;
  };
  void find(bool is_error, const char* code, std::string key, Span at, std::string message, std::string hint);
  /// name, value: of an attribute, or of a child that holds one value.
  [[nodiscard]] bool judge_value(PnmlOwner owner, std::string_view name, std::string_view value, Span at);

  diagnostics::Diagnostics& out_;
  std::map<std::string, std::size_t> known_;              ///< keys of the findings
  std::vector<Finding> findings_;                         ///< in the order of the document
  std::map<std::string, std::string, std::less<>> same_;  ///< values that all transitions must have in common
};

}  // namespace tessera::net
