#include "spec/channels/waits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "diagnostics/utf8.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

bool is_used(const std::optional<std::vector<BufferId>>& list, BufferId buffer) {
  return !list || std::ranges::find(*list, buffer) != list->end();
}

/// The member that a reference to an input asks for: "fresh"; empty: the value, or the index of an element.
std::string status_of(const std::vector<Reference>& references, std::size_t at) {
  if (at + 1 == references.size() || references[at + 1].kind != Reference::Kind::status) return {};
  const std::string& path = references[at + 1].path;
  const std::string start = references[at].path + ".";
  return path.starts_with(start) ? path.substr(start.size()) : std::string();
}

/// A behaviour may use values that an earlier one has received, and their age goes on. But nothing new comes.
class UnreceivedInputs {
 public:
  UnreceivedInputs(const Subsystem& subsystem, Diagnostics& out) : subsystem_(subsystem), out_(out) {}

  void check() {
    for (const Behaviour& one : subsystem_.behaviours) {
      if (!one.receive || one.is_group()) continue;
      for (const Condition* condition : {&one.terminal, &one.error})
        for (const Expression& expression : condition->expressions) check(one, expression, /*decides=*/true);
      for (const Next& next : one.next)
        if (next.when.kind == When::Kind::expression) check(one, next.when.text, /*decides=*/false);
      for (const Skippable& output : one.skippable)
        for (const Expression& expression : output.when.expressions)
          check(one, expression, /*decides=*/false);
    }
  }

 private:
  /// Whether it receives another buffer of the same family: the reference does not know the index.
  [[nodiscard]] bool receives_one_like(const Behaviour& behaviour, BufferId input) const {
    const std::optional<Member>& member = subsystem_.inputs[input].member;
    return member && std::ranges::any_of(*behaviour.receive, [&](BufferId one) {
             const std::optional<Member>& other = subsystem_.inputs[one].member;
             return other && other->family == member->family;
           });
  }

  /// decides: whether the behaviour goes on; `next` may choose by the value of an earlier behaviour.
  void check(const Behaviour& behaviour, const Expression& expression, bool decides) {
    const std::vector<Reference>& all = expression.references;
    for (std::size_t at = 0; at < all.size(); ++at) {
      if (all[at].kind != Reference::Kind::input || !all[at].target) continue;
      const BufferId input{*all[at].target};
      if (is_used(behaviour.receive, input) || receives_one_like(behaviour, input)) continue;
      const std::string status = status_of(all, at), name = subsystem_.inputs[input].name;
      const bool is_new = status == "fresh" || status == "timed_out";
      // One condition beside another may join a value that stays to one that changes.
      const bool alone = expression.text.find_first_of("&|?") == std::string::npos && at == 0;
      if (!is_new && !(status.empty() && decides && alone)) continue;
      out_.warning("W371", all[at].span,
                   fmt::format("the condition asks input {}, which behaviour {} never receives",
                               in_quotes(name), in_quotes(behaviour.name)),
                   fmt::format("list {} under 'receive' of {}", in_quotes(name), in_quotes(behaviour.name)));
    }
  }

  const Subsystem& subsystem_;
  Diagnostics& out_;
};

std::string time_text(Duration time) {
  using namespace std::chrono_literals;
  if (time % 1s == 0s) return fmt::format("{} s", time / 1s);
  if (time % 1ms == 0ms) return fmt::format("{} ms", time / 1ms);
  return fmt::format("{} us", time / 1us);
}

class StaleCheck {
 public:
  StaleCheck(const Model& model, Diagnostics& out) : model_(model), out_(out), in_(model.instances.size()) {
    for (const ChannelId id : model.channels.ids()) in_[model.channels[id].to.instance].push_back(id);
  }

  void check() {
    for (const Channel& channel : model_.channels) {
      const Subsystem& effector = model_.subsystem(channel.to.instance);
      if (effector.kind != SubsystemKind::effector || !effector.stale) continue;
      for (const Behaviour& sender : model_.subsystem(channel.from.instance).behaviours)
        if (is_used(sender.send, channel.from.buffer) && sender.terminal.kind != Condition::Kind::always)
          check(channel, effector, sender);
    }
  }

 private:
  /// The bounded waits of one iteration of the sender: a value comes only once in it.
  void check(const Channel& channel, const Subsystem& effector, const Behaviour& sender) {
    Duration whole{0};
    std::string names;
    for (const ChannelId id : in_[channel.from.instance]) {
      const Channel& source = model_.channels[id];
      if (source.receive != Mode::blocking || source.model.valid() ||
          !is_used(sender.receive, source.to.buffer))
        continue;
      if (!source.receive_timeout) return;  // it waits as long as it takes, which is meant
      const Duration time = *source.receive_timeout;
      whole = sender.transfer == Transfer::parallel ? std::max(whole, time) : whole + time;
      const std::string& name = model_.subsystem(channel.from.instance).inputs[source.to.buffer].name;
      names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", in_quotes(name), time_text(time));
    }
    if (whole <= *effector.stale || !warned_.emplace(&effector, &sender).second) return;
    out_.warning(
        "W372", effector.span,
        fmt::format("'stale: {}' of {} is shorter than the waits of {} in {}: {}", time_text(*effector.stale),
                    model_.instance_path(channel.to.instance), model_.instance_path(channel.from.instance),
                    in_quotes(sender.name), names),
        "the devices get the safe command during such a wait; give the wait a shorter timeout, or 'stale' a "
        "longer time");
  }

  const Model& model_;
  Diagnostics& out_;
  Numbered<InstanceId, std::vector<ChannelId>> in_;
  std::set<std::pair<const Subsystem*, const Behaviour*>> warned_;
};

}  // namespace

void check_waits(const Model& model, Diagnostics& out) {
  for (const Definition& definition : model.definitions)
    for (const Subsystem& subsystem : definition.subsystems) UnreceivedInputs(subsystem, out).check();
  StaleCheck(model, out).check();
}

}  // namespace tessera::spec
