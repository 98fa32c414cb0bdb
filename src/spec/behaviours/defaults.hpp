#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spec/document/section.hpp"
#include "spec/model/model.hpp"

/// A specification, an agent and a subsystem may say something for all behaviours in it. After reading, the model is
/// that of the same specification with everything written out.
namespace tessera::spec {

/// `on_error`: where a failure leads that no entry of `next` names.
struct OnError {
  std::string behaviour;  ///< empty: `stop`, or it could not be read
  Span span{};            ///< of that word
  /// Some behaviour has taken it, or some subsystem has taken `stop`, or there was an error about it.
  bool used = false;
};

/// nullopt: the section does not say it. Errors: E104.
[[nodiscard]] std::optional<OnError> read_on_error(const Section& section, Diagnostics& out);

/// The behaviour of the subsystem that it means; none: `stop`.
///
/// around: the group that says it, of whose behaviours it is one; none: it is one of the subsystem itself.
/// own: whether the group or subsystem itself says it, not its agent or the system.
/// Errors: E101 its own `on_error` names no behaviour; E271 an inherited one does; E275 `stop` is the name of a
///         behaviour, too.
[[nodiscard]] BehaviourId resolve_on_error(OnError& on_error, BehaviourId around, bool own,
                                           const Subsystem& subsystem, Diagnostics& out);

/// The entry of `next` by which `on_error` leads there.
///
/// Errors: those of check_entry.
[[nodiscard]] Next entry_for_errors(BehaviourId to, Span at, const Subsystem& subsystem, Diagnostics& out);

/// Warnings: W361 nothing uses it.
void check_used(const OnError& on_error, Diagnostics& out);

/// The buffers that a behaviour sends or receives; nullopt: all, in the order of the channels.
using BufferList = std::optional<std::vector<BufferId>>;

/// `send` or `receive` of a subsystem, for the behaviours that have no list, or change it by `+` and `-`.
struct ListDefault {
  BufferList list;
  const Entry* entry = nullptr;  ///< the key; null: the subsystem does not say it
  bool used = false;
};

/// The buffers that lists of one subsystem may name, and those of the other direction.
struct ListScope {
  const std::vector<Field>& buffers;
  const std::vector<Field>& others;
  std::string_view what;           ///< "output", "input"
  const Member* member = nullptr;  ///< for which the list is, so that it may name request[i]; null: for none
};

/// A key of the map form with something behind it, and the buffers that it names.
struct ListedOption {
  const Entry* entry;
  std::vector<BufferId> buffers;
};

/// The list of `send` or `receive`: names, or changes of the list around it such as [+request, -grip].
///
/// value:  a list, or a map whose keys are the list (sending.hpp reads its values); `at` is its key.
/// around: `-x` and `+x` change it; without a list all buffers, as declared. Its `used` is set then.
/// Errors: E101 unknown buffer; E104 no list; E107 one twice; E272 `+x` of what is listed; E273 `-x` of what is not;
///         E274 changes beside names; E328 `-x` with a value; E329 a map of inputs; E286, those of number_of: indices.
///         A name without index of which there is one buffer for each member means all of them.
[[nodiscard]] std::vector<BufferId> read_buffer_list(const Node& value, const Entry& at,
                                                     const ListScope& scope, ListDefault& around,
                                                     Diagnostics& out,
                                                     std::vector<ListedOption>* options = nullptr);

/// Warnings: W361 every behaviour has a list of its own.
void check_used(const ListDefault& list, Diagnostics& out);

/// `conditions` of a subsystem: expressions that `terminal` and `error` of its behaviours name.
struct SharedConditions {
  std::vector<Expression> all;
  std::vector<bool> used;

  /// The expression of that name, which is then used; or nullptr.
  [[nodiscard]] const Expression* use(std::string_view name);
  [[nodiscard]] std::vector<std::string> names() const;
};

/// Warnings: W361 no behaviour names it.
void check_used(const SharedConditions& conditions, Diagnostics& out);

/// The defaults of one subsystem for all its behaviours, besides `on_error`.
struct SubsystemDefaults {
  ListDefault send, receive;
  SharedConditions conditions;
};

/// Leads the errors and failures that no entry of `next` names to this one, which is for every error. Whether there was
/// one.
/// Precondition: `next` has been read, and complete_next has not been called.
bool lead_failures(Behaviour& behaviour, const Next& entry);

}  // namespace tessera::spec
