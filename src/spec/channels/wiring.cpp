#include "spec/channels/wiring.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "diagnostics/utf8.hpp"
#include "spec/model/timeless_cycles.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// Instances that share a complaint about one line of the file.
struct Shared {
  InstanceId first;
  std::size_t count = 0;

  void add(InstanceId instance) {
    if (count++ == 0) first = instance;
  }
};

std::string others(const Shared& shared) {
  if (shared.count < 2) return {};
  return " (and of " + std::to_string(shared.count - 1) + " more agent" + (shared.count == 2 ? "" : "s") +
         ")";
}

bool is_listed(const std::optional<std::vector<BufferId>>& list, BufferId buffer) {
  return !list || std::find(list->begin(), list->end(), buffer) != list->end();
}

class WiringCheck {
 public:
  WiringCheck(const Model& model, const WiringExcuses& excuses, Diagnostics& out)
      : model_(model),
        excuses_(excuses),
        out_(out),
        in_(model.instances.size()),
        out_of_(model.instances.size()) {
    for (const ChannelId i : model.channels.ids()) {
      in_[model.channels[i].to.instance].push_back(i);
      out_of_[model.channels[i].from.instance].push_back(i);
    }
  }

  void run() {
    for (const InstanceId instance : model_.instances.ids()) {
      find_unfed(instance);
      find_unread(instance);
      find_standstill(instance);
    }
    report_unfed();
    if (!excuses_.outputs) report_unread();
    report_standstill();
    for (const Definition& definition : model_.definitions) check_lists(definition);
  }

 private:
  [[nodiscard]] bool is_excused(InstanceId instance, BufferId input) const {
    return excuses_.everything || excuses_.instances.contains(instance) ||
           excuses_.inputs.contains({instance, input}) ||
           excuses_.agents.contains(model_.instances[instance].agent);
  }

  void find_unfed(InstanceId instance) {
    const Subsystem& subsystem = model_.subsystem(instance);
    for (const BufferId input : subsystem.inputs.ids()) {
      const bool fed = std::any_of(in_[instance].begin(), in_[instance].end(), [&](ChannelId channel) {
        return model_.channels[channel].to.buffer == input;
      });
      if (!fed && !is_excused(instance, input)) unfed_[&subsystem.inputs[input]].add(instance);
    }
  }

  void find_unread(InstanceId instance) {
    const Subsystem& subsystem = model_.subsystem(instance);
    for (const BufferId output : subsystem.outputs.ids()) {
      const bool read =
          std::any_of(out_of_[instance].begin(), out_of_[instance].end(),
                      [&](ChannelId channel) { return model_.channels[channel].from.buffer == output; });
      // If a neighbour of some agent reads the output, it need not be read at the end of the fleet.
      auto& entry = outputs_[&subsystem.outputs[output]];
      entry.second = entry.second || read;
      entry.first.add(instance);
    }
  }

  void find_standstill(InstanceId instance) {
    const Subsystem& subsystem = model_.subsystem(instance);
    if (subsystem.period) return;
    Numbered<BehaviourId, bool> waits;
    for (const Behaviour& behaviour : subsystem.behaviours) waits.push_back(can_wait(behaviour, instance));
    for (const BehaviourId behaviour : timeless_cycles(subsystem, waits)) {
      standstill_[&subsystem.behaviours[behaviour]].add(instance);
    }
  }

  /// Whether an iteration takes time: declared time, or waiting for the other side of a channel.
  [[nodiscard]] bool can_wait(const Behaviour& behaviour, InstanceId instance) const {
    const auto receives = [&](ChannelId i) {
      const Channel& channel = model_.channels[i];
      return model_.receiver_waits(channel) && is_listed(behaviour.receive, channel.to.buffer);
    };
    const auto sends = [&](ChannelId i) {
      const Channel& channel = model_.channels[i];
      return model_.sender_waits(channel) && is_listed(behaviour.send, channel.from.buffer) &&
             behaviour.skips(channel.from.buffer) == nullptr;
    };
    return behaviour.takes.shortest > Duration{0} ||
           std::any_of(in_[instance].begin(), in_[instance].end(), receives) ||
           std::any_of(out_of_[instance].begin(), out_of_[instance].end(), sends);
  }

  void report_unfed() {
    std::set<Span> said;  // one line declares the inputs for all members of a fleet
    for (const auto& [input, shared] : unfed_) {
      if (input->member && !said.insert(input->span).second) continue;
      out_.error("E302", input->span,
                 "input " + in_quotes(input->name) + " of " + model_.instance_path(shared.first) +
                     others(shared) + " has no source",
                 "add a channel that leads to " + model_.instance_path(shared.first) + "." + input->name);
    }
  }

  void report_unread() {
    std::set<Span> said;
    for (const auto& [output, entry] : outputs_) {
      const auto& [shared, read] = entry;
      if (read || (output->member && !said.insert(output->span).second)) continue;
      out_.warning("W316", output->span,
                   "output " + in_quotes(output->name) + " of " + model_.instance_path(shared.first) +
                       others(shared) + " is not read");
    }
  }

  void report_standstill() {
    if (excuses_.everything) return;
    for (const auto& [behaviour, shared] : standstill_) {
      if (behaviour->member && behaviour->member->number > 0) continue;
      if (excuses_.instances.contains(shared.first) ||
          excuses_.agents.contains(model_.instances[shared.first].agent))
        continue;
      out_.error("E305", behaviour->span,
                 "behaviour " + in_quotes(behaviour->name) + " of " + model_.instance_path(shared.first) +
                     others(shared) + " never waits: time would stand still",
                 "give the subsystem a rate, or the behaviour a blocking channel or 'takes: 3 ms'");
    }
  }

  void check_lists(const Definition& definition) {
    for (const Subsystem& subsystem : definition.subsystems) {
      if (subsystem.behaviours.empty()) continue;
      check_lists(subsystem.inputs, subsystem, &Behaviour::receive, "input", "received");
      check_lists(subsystem.outputs, subsystem, &Behaviour::send, "output", "sent");
    }
  }

  void check_lists(const Numbered<BufferId, Field>& buffers, const Subsystem& subsystem,
                   std::optional<std::vector<BufferId>> Behaviour::*list, const std::string& what,
                   const std::string& verb) {
    for (const BufferId buffer : buffers.ids()) {
      const bool used = std::any_of(subsystem.behaviours.begin(), subsystem.behaviours.end(),
                                    [&](const Behaviour& one) { return is_listed(one.*list, buffer); });
      if (used) continue;
      const auto more = others_of_family(buffers, buffer, [&](BufferId other) {
        return std::ranges::none_of(subsystem.behaviours,
                                    [&](const Behaviour& one) { return is_listed(one.*list, other); });
      });
      if (!more) continue;
      out_.warning("W317", buffers[buffer].span,
                   what + " " + in_quotes(buffers[buffer].name) + *more + " is " + verb + " by no behaviour",
                   "list it under '" + std::string(what == "input" ? "receive" : "send") +
                       "' of a behaviour, or remove it");
    }
  }

  const Model& model_;
  const WiringExcuses& excuses_;
  Diagnostics& out_;
  Numbered<InstanceId, std::vector<ChannelId>> in_, out_of_;
  std::map<const Field*, Shared> unfed_;
  std::map<const Field*, std::pair<Shared, bool>> outputs_;
  std::map<const Behaviour*, Shared> standstill_;
};

}  // namespace

void check_wiring(const Model& model, const WiringExcuses& excuses, Diagnostics& out) {
  WiringCheck(model, excuses, out).run();
}

}  // namespace tessera::spec
