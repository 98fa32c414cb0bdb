#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spec/agents/fleets.hpp"
#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

/// Paths of buffers as the file writes them: robot.control.line, robot[3]..., robot[i+1]..., robot[*]...
namespace tessera::spec {

/// Selects the agents of a group that a path means.
struct Selector {
  enum class Kind : std::uint8_t { plain, constant, variable, all } kind = Kind::plain;
  std::int64_t number = 0;  ///< constant: the number of the agent; variable: what is added to i
};

inline constexpr const char* index_hint = "an index is a number, i, i+1, i-1 or *";

/// Reads 3, i, i+1, i - 1, or *. nullopt: the text is no index.
[[nodiscard]] std::optional<Selector> read_index(std::string_view text);

/// The number of the agent that a selector means for i (which `*` counts too); none past the end of a group
/// that is no ring.
[[nodiscard]] std::optional<std::uint32_t> agent_number(const Selector& selector, const AgentGroup& group,
                                                        std::int64_t i);

/// A path, split but not looked up.
struct BufferPath {
  std::string agent, subsystem, buffer;
  Span whole, agent_span, index_span, subsystem_span, buffer_span;
  Selector selector;
  /// The index of the buffer, of which there is one for each member of a fleet; plain: none.
  Selector member{};
  Span member_span{};
};

/// text: the node that contains the path; [offset, offset + length) of it is the path.
/// Errors: E112 not of the form AGENT.SUBSYSTEM.BUFFER.
[[nodiscard]] std::optional<BufferPath> split_path(const Node& text, std::size_t offset, std::size_t length,
                                                   Diagnostics& out);

/// The path of a real buffer, or of a subsystem (AGENT.SUBSYSTEM); in that case `buffer` is empty.
/// Errors: E112 as for split_path.
[[nodiscard]] std::optional<BufferPath> split_device_path(const Node& text, Diagnostics& out);

/// A path whose agent and subsystem exist.
struct PathTarget {
  const AgentGroup* group = nullptr;
  DefinedSubsystemId subsystem;
};

/// How far a path could be followed before it named something unknown.
enum class KnownUpTo : std::uint8_t { nothing, agent, subsystem };

/// Looks paths up.
class PathLookup {
 public:
  PathLookup(const Model& model, const AgentGroups& groups);

  /// Errors: E101 unknown agent or subsystem; E303 index out of range; E112 an index where none belongs or
  /// none where one does. target and known tell how far it came; true if all is well.
  [[nodiscard]] bool find(const BufferPath& path, PathTarget& target, KnownUpTo& known,
                          Diagnostics& out) const;

  /// The agents with that name, or null.
  ///
  /// Errors: E101 unknown agent.
  [[nodiscard]] const AgentGroup* find_group(const std::string& agent, Span span, Diagnostics& out) const;

  /// Whether the index fits the group.
  ///
  /// Errors: E112, E303 as for find.
  [[nodiscard]] static bool check_index(const Selector& selector, const AgentGroup& group, Span agent_span,
                                        Span index_span, Diagnostics& out);

  /// The buffer's number in `buffers`; none and E101 if it is not there. If there is one for each member of a fleet,
  /// the number of the first. what: "output", "input", "real buffer".
  ///
  /// Errors: E286, E287, E289 an index where none belongs, none where one does, or one that no member has.
  template <class Id>
  [[nodiscard]] Id find_buffer(const BufferPath& path, const PathTarget& target,
                               const Numbered<Id, Field>& buffers, const std::string& what,
                               Diagnostics& out) const {
    for (const Id id : buffers.ids())
      if ((buffers[id].member ? buffers[id].member->family : buffers[id].name) == path.buffer)
        return check_member(path, buffers[id], what, out) ? id : Id{};
    complain_about_buffer(path, target, buffers, what, out);
    return {};
  }

  [[nodiscard]] const Subsystem& subsystem(const PathTarget& target) const;
  /// The instance of the target in agent `number` of its group.
  [[nodiscard]] InstanceId instance(const PathTarget& target, std::uint32_t number) const;
  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] const AgentGroups& groups() const { return groups_; }

 private:
  [[nodiscard]] static bool check_member(const BufferPath& path, const Field& buffer, const std::string& what,
                                         Diagnostics& out);
  void complain_about_buffer(const BufferPath& path, const PathTarget& target,
                             const std::vector<Field>& buffers, const std::string& what,
                             Diagnostics& out) const;

  const Model& model_;
  const AgentGroups& groups_;
  std::vector<std::string> names_;  ///< of the groups, sorted, to guess from
};

}  // namespace tessera::spec
