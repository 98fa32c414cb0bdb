#include "replay/process_starts.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <unordered_map>

#include "replay/joint_source.hpp"

namespace tessera::replay {
namespace {

class Splitter {
 public:
  Splitter(const Recording& run, const DeployedNet& net, const ProcessMap& processes)
      : run_(run), processes_(processes), next_(run.instances.size(), 0), base_(run.instances.size(), 0) {
    std::unordered_map<std::string_view, std::uint32_t> by_name;
    for (std::uint32_t index = 0; index < net.net().transitions().size(); ++index)
      by_name.emplace(net.net().transitions()[index].name, index);
    process_of_instance_.resize(run.instances.size());
    for (const Recording::Transition& transition : run.transitions) {
      const auto found = by_name.find(transition.name);
      const ProcessId process =
          found == by_name.end() ? ProcessId{} : net[net::TransitionId{found->second}].process;
      process_of_transition_.push_back(process);
      if (transition.instance < process_of_instance_.size())
        process_of_instance_[transition.instance] = process;
    }
    for (const ProcessId process : processes.names.ids()) begin(process, 1);
  }

  std::vector<Recording> result() {
    for (const Recording::Entry& entry : run_.entries) take(entry);
    for (const std::size_t last : current_) {
      starts_[last].truncated = run_.truncated;
      starts_[last].lost = run_.lost + missing_;
    }
    return std::move(starts_);
  }

 private:
  void begin(ProcessId process, std::uint64_t incarnation) {
    current_.resize(processes_.names.size());
    current_[process] = starts_.size();
    Recording& start = starts_.emplace_back();
    start.instances = run_.instances;
    start.transitions = run_.transitions;
    start.processes = run_.processes;
    start.networked = run_.networked;
    start.process = Recording::OneProcess{processes_.names[process], process.value, incarnation};
    system_events_.push_back(0);
    for (std::size_t instance = 0; instance < base_.size(); ++instance)
      if (process_of_instance_[instance] == process) base_[instance] = next_[instance];
  }

  void take(const Recording::Entry& entry) {
    if (!is_counted(entry.event)) return;
    if (entry.event.instance() == system_instance) return take_of_system(entry);
    const std::uint32_t instance = entry.event.instance();
    const ProcessId process = process_of_instance_[instance];
    if (!process.valid()) return;
    next_[instance] = entry.event.sequence + 1;
    Recording::Entry& own = starts_[current_[process]].entries.emplace_back(entry);
    own.event.sequence -= base_[instance];
  }

  /// Transitions of agents, and what becomes of processes.
  void take_of_system(const Recording::Entry& entry) {
    const Event& event = entry.event;
    if (event.sequence != next_of_system_) ++missing_;
    next_of_system_ = event.sequence + 1;
    if (event.kind() == Event::Kind::process && event.version == 1) return take_start(entry.text);
    if (event.kind() != Event::Kind::firing) return;
    const ProcessId process = process_of_transition_[event.subject];
    if (!process.valid()) return;
    Recording::Entry& own = starts_[current_[process]].entries.emplace_back(entry);
    own.event.sequence = system_events_[current_[process]]++;
  }

  void take_start(std::string_view text) {
    const std::size_t line = std::min(text.find('\n'), text.size());
    const auto found = std::ranges::find(processes_.names, text.substr(0, line));
    std::uint64_t incarnation = 0;
    if (line < text.size()) std::from_chars(text.data() + line + 1, text.data() + text.size(), incarnation);
    if (found == processes_.names.end() || incarnation == 0)
      ++missing_;  // of an event that says nothing
    else
      begin({static_cast<std::uint32_t>(found - processes_.names.begin())}, incarnation);
  }

  const Recording& run_;
  const ProcessMap& processes_;
  std::vector<ProcessId> process_of_instance_, process_of_transition_;
  std::vector<std::uint32_t> next_,
      base_;  // per instance: sequences, in the whole run and where a start begins
  std::vector<Recording> starts_;
  Numbered<ProcessId, std::size_t> current_;  // into starts_
  std::vector<std::uint32_t> system_events_;  // per start
  std::uint32_t next_of_system_ = 0;
  std::uint64_t missing_ = 0;
};

}  // namespace

bool has_deaths(const Recording& run) {
  return std::ranges::any_of(
      run.entries, [](const Recording::Entry& entry) { return entry.event.kind() == Event::Kind::process; });
}

std::vector<Recording> recordings_of_starts(const Recording& run, const DeployedNet& net,
                                            const ProcessMap& processes) {
  return Splitter(run, net, processes).result();
}

}  // namespace tessera::replay
