#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

/// Parts of a subsystem of which there is one for each member of a fleet: "Request[each robot]", `for: each robot`, and
/// the names of such parts: "lend[i]", "request[3]".
namespace tessera::spec {

/// How many agents a fleet has, and whether the first of them follows the last.
struct FleetSize {
  std::uint32_t count = 1;
  bool ring = false;
};

/// The sizes of the fleets, known before the agents are read.
class FleetSizes {
 public:
  FleetSizes() = default;
  /// agents: the section; may be null. Mistakes in it are left to read_agents.
  explicit FleetSizes(const Entry* agents);

  /// nullopt: no fleet has that name.
  [[nodiscard]] std::optional<FleetSize> find(const std::string& name) const;
  /// Whether one agent has that name, which is no fleet.
  [[nodiscard]] bool is_one_agent(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  std::map<std::string, std::optional<FleetSize>> sizes_;  ///< nullopt: one agent
};

/// The fleet that "each robot" names.
struct EachMember {
  std::string fleet;
  std::uint32_t count = 1;
  bool ring = false;  ///< the first follows the last

  [[nodiscard]] Member member(const std::string& family, std::uint32_t number) const {
    return {family, fleet, number, count};
  }
  /// The member that `[i+offset]` names for member `number`; nullopt: that is past the end.
  [[nodiscard]] std::optional<std::uint32_t> neighbour(std::uint32_t number, std::int64_t offset) const;
};

/// Whether a text is meant as "each FLEET".
[[nodiscard]] bool says_each(std::string_view text);

/// Reads "each robot", which is `length` bytes of the text from byte `offset`.
///
/// fleets: may be null. Errors: E285 no such fleet; E290 something else than a name stands behind `each`.
[[nodiscard]] std::optional<EachMember> read_each(const Node& text, std::size_t offset, std::size_t length,
                                                  const FleetSizes* fleets, Diagnostics& out);

/// The place of "[each robot]" in a type.
struct EachInType {
  std::size_t begin = 0, end = 0;  ///< with the brackets
};
[[nodiscard]] std::optional<EachInType> each_in(std::string_view type);

/// A name that may have an index: "lend", "lend[i]", "lend[i+1]", "lend[3]".
struct IndexedName {
  std::string name;
  Span span, index_span;
  enum class Index : std::uint8_t { none, constant, variable } index = Index::none;
  std::uint32_t number = 0;  ///< of a constant
  std::int64_t offset = 0;   ///< what is added to `i`

  /// Whether it names another member than the one of `i`.
  [[nodiscard]] bool is_neighbour() const { return offset != 0; }
};

/// The name that a text has from byte `offset` on. It need not be the name of anything.
///
/// Errors: E289 the index is neither a number nor `i`, with or without an offset.
[[nodiscard]] std::optional<IndexedName> read_indexed(const Node& text, std::size_t offset, Diagnostics& out);

/// The number of the member that the index of a name means, which `member` (null: none) gives for `i`. The name is
/// that of a family.
///
/// what: "behaviour". Errors: E287 there is no index; E288 `i` means nothing here; E289 the fleet has no such member,
///       or the index is that of a neighbour, which only `next` may name; E292 `i` counts over another fleet.
[[nodiscard]] std::optional<std::uint32_t> number_of(const IndexedName& name, const Member& family,
                                                     const Member* member, std::string_view what,
                                                     Diagnostics& out);

/// Errors: E286 the name, which is that of one part, has an index. false: it has.
[[nodiscard]] bool check_single(const IndexedName& name, std::string_view what, Diagnostics& out);

/// The names as the file has them: those of families without an index.
template <class Parts>
[[nodiscard]] std::vector<std::string> written_names(const Parts& parts) {
  std::vector<std::string> names;
  for (const auto& part : parts)
    if (!part.member || part.member->number == 0)
      names.push_back(part.member ? part.member->family : part.name);
  return names;
}

}  // namespace tessera::spec
