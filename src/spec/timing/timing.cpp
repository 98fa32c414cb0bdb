#include "spec/timing/timing.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include "diagnostics/utf8.hpp"
#include "spec/agents/paths.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;
using Kind = Selector::Kind;

constexpr const char* chain_hint =
    "for example { name: line to wheels, path: [robot.sensor, robot.control, robot.motor], age: 100 ms }";
constexpr const char* list_hint =
    "for example chains: [{ name: line to wheels, path: [robot.sensor, robot.control, robot.motor] }]";
constexpr const char* stops_hint =
    "a path names subsystems, receptor first: [robot.sensor, robot.control, robot.motor]";

constexpr const char* foreign_hint =
    "for example path: [robot.sensor, robot.control, robot.goal, { node: planner, takes: 5..20 ms }, "
    "robot.plan, "
    "robot.drive, robot.motor]";

/// A subsystem of a path, and the buffers of it that the path names.
struct Stop {
  BufferPath path;
  PathTarget target;
  std::optional<BufferPath> in, out;
  BufferId arrives, leaves;  ///< none: whichever channel there is; of a family: the first
};

class TimingReader {
 public:
  TimingReader(const Model& model, const AgentGroups& groups, Diagnostics& out)
      : lookup_(model, groups), model_(model), out_(out), connects_(!out.has_errors()) {
    for (const ChannelId id : model.channels.ids())
      channels_[{model.channels[id].from.instance.value, model.channels[id].to.instance.value}].push_back(id);
  }

  Timing read(const Entry& entry) {
    Timing timing;
    const Section section(*entry.value, entry.span, "timing", {"latency", "network", "chains"}, out_);
    if (const Entry* latency = section.find("latency"))
      timing.latency =
          read_moment(*latency->value, latency->span, "latency", out_).value_or(std::chrono::nanoseconds{0});
    if (const Entry* network = section.find("network")) {
      timing.network = read_moment(*network->value, network->span, "network", out_);
      const bool crosses = std::ranges::any_of(
          model_.channels, [&](const Channel& channel) { return model_.crosses_processes(channel); });
      if (timing.network && connects_ && !crosses)
        out_.warning("W344", network->span,
                     "no channel leads from one process to another, so `network` has no effect",
                     "`deploy: { processes: ... }` says which agents run in which process");
    }
    if (const Entry* chains = section.find("chains")) {
      timing.chains.emplace();
      for (const Node* item : items_of(*chains->value, chains->span, "chains", out_, list_hint))
        read_chain(*item, item->is_null() ? chains->span : item->span, *timing.chains);
    }
    return timing;
  }

 private:
  void read_chain(const Node& node, Span at, std::vector<TimedChain>& chains) {
    const Section section(node, at, "a chain", {"name", "path", "age", "reaction"}, out_);
    if (!section.readable()) return;
    TimedChain chain;
    chain.span = at;
    const Entry* name = section.require("name", chain_hint);
    if (const Node* text = name == nullptr ? nullptr : text_of(*name->value, name->span, "a name", out_)) {
      chain.name = text->text;
      chain.span = text->span;
      const auto [first, added] = lines_.emplace(text->text, text->span.line);
      if (!added)
        out_.error("E107", text->span, "chain " + in_quotes(text->text) + " exists already",
                   "the first is on " + out_.words(first->second));
    }
    if (const Entry* age = section.find("age"))
      chain.age = read_duration(*age->value, age->span, "age", out_);
    if (const Entry* reaction = section.find("reaction"))
      chain.reaction = read_duration(*reaction->value, reaction->span, "reaction", out_);
    const Entry* path = section.require("path", stops_hint);
    if (path == nullptr) return;
    const std::optional<std::vector<Stop>> stops = read_path(*path, chain.foreign);
    if (stops) expand(*stops, chain, chains);
  }

  std::optional<std::vector<Stop>> read_path(const Entry& entry, std::vector<ForeignNode>& foreign) {
    std::vector<Stop> stops;
    const std::vector<const Node*>& items = items_of(*entry.value, entry.span, "path", out_, stops_hint);
    if (!entry.value->is_sequence() && !entry.value->is_null()) return std::nullopt;
    bool good = true;
    for (std::size_t at = 0; at < items.size(); ++at) {
      const Node& item = *items[at];
      const Span span = item.is_null() ? entry.span : item.span;
      const bool is_first = at == 0 || items[at - 1]->is_map(),
                 is_last = at + 1 == items.size() || items[at + 1]->is_map();
      const bool follows = !foreign.empty() && foreign.back().after == stops.size();
      good = (item.is_map() ? read_foreign(item, span, is_first || is_last, stops.size(), foreign)
                            : read_stop(item, span, is_first, is_last, follows, stops)) &&
             good;
    }
    if (!good) return std::nullopt;
    for (const ForeignNode& node : foreign)
      if (!joins(node, stops)) return std::nullopt;
    if (stops.size() < 2) {
      out_.error("E382", entry.span, "a path needs at least two subsystems", stops_hint);
      return std::nullopt;
    }
    const bool begins = check_kind(stops.front(), SubsystemKind::receptor, "begins at a receptor");
    const bool ends = check_kind(stops.back(), SubsystemKind::effector, "ends at an effector");
    return begins && ends ? std::optional(std::move(stops)) : std::nullopt;
  }

  /// is_outside: nothing of the system comes before it, or behind it.
  bool read_foreign(const Node& node, Span at, bool is_outside, std::size_t after,
                    std::vector<ForeignNode>& foreign) {
    const Section section(node, at, "a foreign node", {"node", "takes"}, out_);
    if (!section.readable()) return false;
    ForeignNode read{{}, {}, {}, after, at};
    const Entry* name = section.require("node", foreign_hint);
    const Node* text = name == nullptr ? nullptr : text_of(*name->value, name->span, "a name", out_);
    const Entry* takes = section.require("takes", foreign_hint);
    const std::optional<Takes> time =
        takes == nullptr ? std::nullopt : read_takes(*takes->value, takes->span, out_);
    if (text == nullptr || !time) return false;
    read.name = text->text;
    read.shortest = time->shortest;
    read.longest = time->longest;
    if (is_outside) {
      out_.error("E387", at, in_quotes(read.name) + " stands at an end of the path, or beside another node",
                 "a node that is not of this system stands between an effector and a receptor of this one");
      return false;
    }
    foreign.push_back(std::move(read));
    return true;
  }

  bool joins(const ForeignNode& node, const std::vector<Stop>& stops) {
    const Subsystem &before = lookup_.subsystem(stops[node.after - 1].target),
                    &behind = lookup_.subsystem(stops[node.after].target);
    if (before.kind == SubsystemKind::effector && behind.kind == SubsystemKind::receptor) return true;
    const bool is_before = before.kind != SubsystemKind::effector;
    out_.error("E388", stops[is_before ? node.after - 1 : node.after].path.whole,
               is_before ? "before " + in_quotes(node.name) + " stands no effector, which commands it"
                         : "behind " + in_quotes(node.name) + " stands no receptor, which reads its answers",
               foreign_hint);
    return false;
  }

  /// follows: the item before it is a foreign node.
  bool read_stop(const Node& node, Span at, bool is_first, bool is_last, bool follows,
                 std::vector<Stop>& stops) {
    const Node* text = text_of(node, at, "a subsystem of a path", out_, stops_hint);
    if (text == nullptr) return false;
    if (text->text.find('.') == std::string::npos) {
      out_.error("E112", text->span, in_quotes(text->text) + " does not name a subsystem", stops_hint);
      return false;
    }
    const std::optional<BufferPath> path = split_device_path(*text, out_);
    if (!path) return false;
    Stop stop;
    stop.path = *path;
    KnownUpTo known = KnownUpTo::nothing;
    if (!lookup_.find(*path, stop.target, known, out_)) return false;
    if (path->selector.kind == Kind::all) {
      out_.error("E307", path->index_span, "'*' stands for every agent, and a chain leads through one",
                 "write [i]: there is then a chain for each member");
      return false;
    }
    if (!path->buffer.empty() && !find_buffer(stop, is_first, is_last)) return false;
    // [..., robot.control.line, robot.control.motion, ...]: in and out of one subsystem.
    if (!follows && !stops.empty() && is_same(stops.back(), stop) && stops.back().in && !stops.back().out &&
        stop.out) {
      stops.back().out = stop.out;
      stops.back().leaves = stop.leaves;
    } else {
      stops.push_back(std::move(stop));
    }
    return true;
  }

  static bool is_same(const Stop& a, const Stop& b) {
    return a.target.group == b.target.group && a.target.subsystem == b.target.subsystem &&
           a.path.selector.kind == b.path.selector.kind && a.path.selector.number == b.path.selector.number;
  }

  /// The buffer that an item names: a receptor has an output on the way, an effector an input, others both.
  bool find_buffer(Stop& stop, bool is_first, bool is_last) {
    const Subsystem& subsystem = lookup_.subsystem(stop.target);
    Numbered<BufferId, Field> buffers;
    if (!is_first) buffers = subsystem.inputs;
    const std::size_t inputs = buffers.size();
    if (!is_last)
      for (const Field& output : subsystem.outputs) buffers.push_back(output);
    const char* const what = is_first ? "output" : is_last ? "input" : "input or output";
    const BufferId found = lookup_.find_buffer(stop.path, stop.target, buffers, what, out_);
    if (!found.valid()) return false;
    if (found.value < inputs) {
      stop.arrives = found;
      stop.in = stop.path;
    } else {
      stop.leaves = BufferId{static_cast<std::uint32_t>(found.value - inputs)};
      stop.out = stop.path;
    }
    return true;
  }

  bool check_kind(const Stop& stop, SubsystemKind kind, const char* rule) {
    const SubsystemKind found = lookup_.subsystem(stop.target).kind;
    if (found == kind) return true;
    const char* const is = found == SubsystemKind::control    ? "the control subsystem"
                           : found == SubsystemKind::receptor ? "a receptor"
                                                              : "an effector";
    out_.error("E382", stop.path.whole,
               std::string("a chain ") + rule + ", but " + in_quotes(stop.path.subsystem) + " is " + is,
               stops_hint);
    return false;
  }

  /// The number of chains that the indices of a path stand for; nullopt: they do not go together.
  std::optional<std::uint32_t> members(const std::vector<Stop>& stops, bool& is_fleet) {
    std::optional<std::uint32_t> count;
    const AgentGroup* first = nullptr;
    for (const Stop& stop : stops) {
      if (stop.path.selector.kind != Kind::variable) continue;
      is_fleet = true;
      if (count && *count != stop.target.group->count) {
        out_.error("E307", stop.path.index_span,
                   "i counts over " + in_quotes(first->name) + " (" + std::to_string(*count) + "), and " +
                       in_quotes(stop.target.group->name) + " has " +
                       std::to_string(stop.target.group->count) + " agents",
                   "name the agents by number");
        return std::nullopt;
      }
      count = stop.target.group->count;
      first = stop.target.group;
    }
    return count.value_or(1);
  }

  void expand(const std::vector<Stop>& stops, const TimedChain& like, std::vector<TimedChain>& chains) {
    bool is_fleet = false;
    const std::optional<std::uint32_t> count = members(stops, is_fleet);
    if (!count) return;
    for (std::uint32_t i = 0; i < *count; ++i) {
      TimedChain chain = like;
      if (is_fleet) chain.name += '[' + std::to_string(i) + ']';
      for (const Stop& stop : stops)
        if (const auto agent = agent_number(stop.path.selector, *stop.target.group, i))
          chain.path.push_back(lookup_.instance(stop.target, *agent));
      if (chain.path.size() < stops.size()) continue;  // past the end of a fleet, as channels are
      if (!connects_) continue;                        // channels may be missing that could not be read
      if (!connect(stops, i, chain)) return;
      chains.push_back(std::move(chain));
    }
  }

  /// false: there is no channel between two subsystems of the path.
  bool connect(const std::vector<Stop>& stops, std::uint32_t i, TimedChain& chain) {
    for (std::size_t at = 0; at + 1 < stops.size(); ++at) {
      const Stop &from = stops[at], &to = stops[at + 1];
      std::vector<ChannelId> hop;
      if (std::ranges::find(chain.foreign, at + 1, &ForeignNode::after) != chain.foreign.end()) {
        chain.hops.emplace_back();
        continue;
      }
      if (const auto found = channels_.find({chain.path[at].value, chain.path[at + 1].value});
          found != channels_.end())
        hop = found->second;
      std::erase_if(hop, [&](ChannelId id) {
        const Channel& channel = model_.channels[id];
        return !is_meant(from.leaves, from.out, i, channel.from.buffer) ||
               !is_meant(to.arrives, to.in, i, channel.to.buffer);
      });
      if (hop.empty()) {
        out_.error("E381", to.path.whole,
                   "no channel leads from " + shown(chain.path[at], from.out) + " to " +
                       shown(chain.path[at + 1], to.in),
                   hint_for(chain.path[at]));
        return false;
      }
      chain.hops.push_back(std::move(hop));
    }
    return true;
  }

  static bool is_meant(BufferId first, const std::optional<BufferPath>& path, std::uint32_t i,
                       BufferId buffer) {
    if (!first.valid()) return true;
    std::int64_t number = first.value;
    if (path->member.kind == Kind::constant) number += path->member.number;
    if (path->member.kind == Kind::variable) number += i + path->member.number;
    return number == static_cast<std::int64_t>(buffer.value);
  }

  [[nodiscard]] std::string shown(InstanceId instance, const std::optional<BufferPath>& buffer) const {
    return model_.instance_path(instance) + (buffer ? "." + buffer->buffer : "");
  }

  [[nodiscard]] std::string hint_for(InstanceId from) const {
    constexpr std::size_t most = 4;
    std::vector<std::string> names;
    for (const auto& [ends, all] : channels_)
      if (ends.first == from.value) names.push_back(model_.instance_path(InstanceId{ends.second}));
    const std::string name = model_.instance_path(from);
    if (names.empty()) return "no channel begins at " + name;
    std::string text;
    for (std::size_t at = 0; at < std::min(most, names.size()); ++at)
      text += (at > 0 ? ", " : "") + names[at];
    return "channels lead from " + name + " to " + text + (names.size() > most ? " and others" : "");
  }

  PathLookup lookup_;
  const Model& model_;
  Diagnostics& out_;
  bool connects_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<ChannelId>> channels_;  ///< by their ends
  std::unordered_map<std::string, std::uint32_t> lines_;
};

}  // namespace

Timing read_timing(const Entry* entry, const Model& model, const AgentGroups& groups, Diagnostics& out) {
  return entry == nullptr ? Timing{} : TimingReader(model, groups, out).read(*entry);
}

}  // namespace tessera::spec
