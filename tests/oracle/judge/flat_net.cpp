#include "flat_net.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "conditions.hpp"
#include "groups.hpp"
#include "memory.hpp"

namespace oracle {
namespace {

std::string member(const std::string& agent, const Fleet& fleet, int index) {
  return fleet.count == 0 ? agent : agent + "[" + std::to_string(index) + "]";
}

class Builder {
 public:
  explicit Builder(const Specification& specification) : specification_(specification) {}

  FlatNet build() {
    name_subsystems();
    expand_channels();
    find_facts();
    system_layer();
    for (std::size_t s = 0; s < net_.subsystems.size(); ++s) subsystem_layer(static_cast<int>(s));
    collect_pages();
    for (auto& behaviour : net_.behaviours) behaviour.waits = waits_.contains(behaviour.path);
    return std::move(net_);
  }

 private:
  int add_place(const std::string& name, bool marked = false, bool fused = false) {
    const auto [at, added] = net_.place_of.try_emplace(name, static_cast<int>(net_.places.size()));
    if (!added) throw std::logic_error("place twice: " + name);
    net_.places.push_back({name, marked, fused});
    return at->second;
  }
  FlatTransition& add_transition(const std::string& name, std::vector<int> pre, std::vector<int> post) {
    net_.transitions.push_back(
        {name, std::move(pre), std::move(post), Role::plain, subsystem_, behaviour_, -1});
    return net_.transitions.back();
  }
  void add_page(const std::string& path, int in, int out) { net_.pages.push_back({path, in, out, {}}); }

  void name_subsystems() {
    for (const Agent& agent : specification_.agents) {
      const Fleet fleet = fleet_of(specification_, agent.name);
      for (int i = 0; i < std::max(1, fleet.count); ++i) {
        agents_.push_back(member(agent.name, fleet, i));
        for (const Subsystem& of : subsystems_of(specification_, agent)) {
          by_path_[agents_.back() + "." + of.name] = static_cast<int>(net_.subsystems.size());
          net_.subsystems.push_back({agents_.back() + "." + of.name, -1, -1, -1, {}, &of});
          agent_of_.push_back(static_cast<int>(agents_.size()) - 1);
        }
      }
    }
  }

  /// The member that an end means where `i` is `index`; -1: past the end of a fleet that is no ring.
  int index_of(const End& end, int index) const {
    const Fleet fleet = fleet_of(specification_, end.agent);
    if (end.index.empty()) return 0;
    if (end.index == "i" || end.index == "*") return index;
    if (end.index != "i+1") return std::stoi(end.index);
    if (index + 1 < fleet.count) return index + 1;
    return fleet.ring ? 0 : -1;
  }

  void expand_channels() {
    for (const Channel& of : specification_.channels) {
      const auto varies = [](const End& end) { return end.index == "*" || end.index.starts_with("i"); };
      int times = 1;
      for (const End* end : {&of.from, &of.to})
        if (varies(*end)) times = fleet_of(specification_, end->agent).count;
      for (int i = 0; i < times; ++i) {
        const int from = index_of(of.from, i), to = index_of(of.to, i);
        if (from >= 0 && to >= 0) add_channel(of, from, to);
      }
    }
  }

  static std::string of_member(const std::string& buffer, int member) {
    const std::size_t at = buffer.find("[i]");
    return at == std::string::npos ? buffer : buffer.substr(0, at) + "[" + std::to_string(member) + "]";
  }

  void add_channel(const Channel& of, int from, int to) {
    const auto path = [&](const End& end, int index) {
      return member(end.agent, fleet_of(specification_, end.agent), index) + "." + end.subsystem;
    };
    FlatNet::ChannelInfo channel;
    channel.of = &of;
    channel.sender = by_path_.at(path(of.from, from));
    channel.receiver = by_path_.at(path(of.to, to));
    // One buffer for each member: its number is that of the agent at the other end.
    channel.output = of_member(of.from.buffer, to);
    channel.input = of_member(of.to.buffer, from);
    channel.name = path(of.from, from) + "." + channel.output + "->" + path(of.to, to) + "." + channel.input;
    net_.channels.push_back(channel);
  }

  static void collect(const Asked& asked, std::vector<Asked>& all) {
    if (!asked.buffer.empty()) all.push_back(asked);
    for (const Asked& part : asked.parts) collect(part, all);
  }

  /// The facts that conditions of the subsystem ask for and its net knows: those of built-in models that tell.
  void find_facts() {
    for (std::size_t s = 0; s < net_.subsystems.size(); ++s) {
      std::vector<Asked> all;
      for (const Behaviour& behaviour : net_.subsystems[s].of->behaviours)
        for (const Asked* asked : expressions_of(behaviour)) collect(*asked, all);
      for (const bool sends : {false, true}) {
        const Subsystem& of = *net_.subsystems[s].of;
        for (const std::string& buffer : sends ? of.outputs : of.inputs)
          if (std::any_of(all.begin(), all.end(), [&](const Asked& one) {
                return one.buffer == buffer && (one.kind == Asked::Kind::late_output) == sends;
              }))
            find_fact(static_cast<int>(s), buffer, sends);
      }
      const std::vector<Cell>& cells = net_.subsystems[s].of->memory;
      for (std::size_t c = 0; c < cells.size(); ++c) {
        FlatNet::FactInfo fact;
        fact.subsystem = static_cast<int>(s);
        fact.buffer = "memory." + cells[c].name;
        fact.cell = static_cast<int>(c);
        fact.values = cells[c].values;
        net_.facts.push_back(fact);
      }
    }
  }

  void find_fact(int s, const std::string& buffer, bool sends) {
    FlatNet::FactInfo fact;
    fact.subsystem = s;
    fact.buffer = buffer;
    fact.sends = sends;
    for (std::size_t c = 0; c < net_.channels.size(); ++c) {
      const FlatNet::ChannelInfo& channel = net_.channels[c];
      if ((sends ? channel.sender : channel.receiver) != s) continue;
      if ((sends ? channel.output : channel.input) != buffer) continue;
      const Channel& of = *channel.of;
      if (!of.model.empty()) return;
      if (sends ? of.send_timeout : of.send_blocking || of.receive_blocking)
        fact.channels.push_back(static_cast<int>(c));
      fact.blocks = of.receive_blocking;
    }
    if (fact.channels.empty()) return;
    using Values = std::vector<std::string>;
    fact.values = sends ? Values{"in_time", "timed_out"} : Values{"came", "missed"};
    net_.facts.push_back(fact);
  }

  [[nodiscard]] int initial_value(const FlatNet::FactInfo& cell) const {
    return net_.subsystems[static_cast<std::size_t>(cell.subsystem)]
        .of->memory[static_cast<std::size_t>(cell.cell)]
        .initial;
  }

  /// Their places, which belong to no page.
  void fact_places() {
    for (FlatNet::FactInfo& fact : net_.facts) {
      const std::string path = net_.subsystems[static_cast<std::size_t>(fact.subsystem)].path;
      const int initial = fact.cell >= 0 ? initial_value(fact) : fact.sends ? 0 : 1;
      for (std::size_t value = 0; value < fact.values.size(); ++value)
        fact.places.push_back(add_place(path + "." + fact.buffer + "." + fact.values[value],
                                        static_cast<int>(value) == initial, true));
    }
  }

  /// Adds a transition, with the values of facts that its condition asks for.
  void add_asking(const std::string& name, int from, int to, Role role, int entry,
                  const std::map<int, int>& values) {
    FlatTransition& made = add_transition(name + suffix(net_, values), {from}, {to});
    made.role = role;
    made.entry = entry;
    made.facts = values;
    for (const auto& [fact, value] : values) {
      const int place = net_.facts[static_cast<std::size_t>(fact)].places[static_cast<std::size_t>(value)];
      made.pre.push_back(place);
      made.post.push_back(place);
    }
  }

  int place_of(int fact, int value) const {
    return net_.facts[static_cast<std::size_t>(fact)].places[static_cast<std::size_t>(value)];
  }

  /// An entry of `next`: once for each way in which the memory that it changes may be before. If it cannot be
  /// taken with these values, it is drawn once, and changes nothing.
  void add_entry(const std::string& name, int from, int to, int entry, const std::vector<Change>& changes,
                 const std::map<int, int>& values) {
    bool drawn = false;
    for (const std::map<int, int>& before : with_changed(net_, subsystem_, changes, values)) {
      const auto after = changed(net_, subsystem_, changes, before);
      if (!after) continue;
      drawn = true;
      FlatTransition& made = add_transition(name + suffix(net_, before), {from}, {to});
      made.role = Role::next;
      made.entry = entry;
      made.facts = values;
      for (const auto& [fact, value] : before) made.pre.push_back(place_of(fact, value));
      for (const auto& [fact, value] : *after) made.post.push_back(place_of(fact, value));
      net_.layers["subsystem"].transitions += 1;
    }
    if (drawn) return;
    add_asking(name, from, to, Role::next, entry, values);
    net_.layers["subsystem"].transitions += 1;
  }

  /// The goal of which a receive over that channel tells; -1: of none.
  int goal_told_by(int c) const {
    const FlatNet::ChannelInfo& channel = net_.channels[static_cast<std::size_t>(c)];
    for (std::size_t f = 0; f < net_.facts.size(); ++f) {
      const FlatNet::FactInfo& fact = net_.facts[f];
      if (fact.cell < 0 || fact.subsystem != channel.receiver) continue;
      const FlatNet::SubsystemInfo& owner = net_.subsystems[static_cast<std::size_t>(fact.subsystem)];
      const Cell& cell = owner.of->memory[static_cast<std::size_t>(fact.cell)];
      if (!cell.goal.empty() && cell.progress == channel.input) return static_cast<int>(f);
    }
    return -1;
  }

  /// A transition behind a value that was read: if it tells of a goal, one for each state and itself or one that may
  /// come later in its life.
  void add_reading(int c, const std::string& name, const std::vector<int>& pre, const std::vector<int>& post,
                   const std::map<int, int>& before = {}) {
    const int goal = goal_told_by(c);
    if (goal < 0) {
      add_transition(name + suffix(net_, before), pre, post);
      return;
    }
    for (int state = 0; state < static_cast<int>(goal_states().size()); ++state)
      for (int later = 0; later < static_cast<int>(goal_states().size()); ++later) {
        if (state != later && !comes_later(state, later)) continue;
        std::map<int, int> all = before;
        all[goal] = state;
        const std::string after = state == later ? "" : "." + goal_states()[static_cast<std::size_t>(later)];
        FlatTransition& made = add_transition(name + suffix(net_, all) + after, pre, post);
        made.pre.push_back(place_of(goal, state));
        made.post.push_back(place_of(goal, later));
      }
  }

  /// By the table of the specification.
  static bool comes_later(int state, int later) {
    static const std::map<std::string, std::set<std::string>> life{
        {"ordered",
         {"accepted", "executing", "canceling", "succeeded", "canceled", "aborted", "rejected", "gone"}},
        {"accepted", {"executing", "canceling", "succeeded", "canceled", "aborted", "gone"}},
        {"executing", {"canceling", "succeeded", "canceled", "aborted", "gone"}},
        {"canceling", {"succeeded", "canceled", "aborted", "gone"}}};
    const auto found = life.find(goal_states()[static_cast<std::size_t>(state)]);
    return found != life.end() && found->second.contains(goal_states()[static_cast<std::size_t>(later)]);
  }

  /// A transition that ends a block: one for each value that the fact had before.
  void add_end(int c, bool send, bool well, const std::string& name, const std::vector<int>& pre,
               const std::vector<int>& post) {
    for (std::size_t f = 0; f < net_.facts.size(); ++f) {
      const FlatNet::FactInfo& fact = net_.facts[f];
      if (fact.sends != send ||
          std::find(fact.channels.begin(), fact.channels.end(), c) == fact.channels.end())
        continue;
      for (int before = 0; before < 2; ++before) {
        std::vector<int> from = pre, to = post;
        from.push_back(fact.places[static_cast<std::size_t>(before)]);
        to.push_back(fact.places[well ? 0 : 1]);
        const std::map<int, int> values{{static_cast<int>(f), before}};
        if (!send && well)
          add_reading(c, name, from, to, values);
        else
          add_transition(name + suffix(net_, values), from, to);
      }
      return;
    }
    if (!send && well)
      add_reading(c, name, pre, post);
    else
      add_transition(name, pre, post);
  }

  void system_layer() {
    fact_places();
    const int in = add_place("in", true), out = add_place("out");
    net_.system_out = out;
    add_page("", in, out);
    std::vector<int> ins, outs;
    for (std::size_t a = 0; a < agents_.size(); ++a) {
      ins.push_back(add_place(agents_[a] + ".in"));
      outs.push_back(add_place(agents_[a] + ".out"));
      add_page(agents_[a], ins.back(), outs.back());
      agent_layer(static_cast<int>(a), ins.back(), outs.back());
    }
    add_transition("t_in", {in}, ins);
    add_transition("t_out", outs, {out});
    net_.layers["system"] = {2, 2, static_cast<int>(agents_.size())};
    net_.layers["agent"] = {2 * static_cast<int>(agents_.size()), 2 * static_cast<int>(agents_.size()),
                            static_cast<int>(net_.subsystems.size())};
  }

  void agent_layer(int agent, int in, int out) {
    std::vector<int> ins, outs;
    for (std::size_t s = 0; s < net_.subsystems.size(); ++s) {
      if (agent_of_[s] != agent) continue;
      FlatNet::SubsystemInfo& subsystem = net_.subsystems[s];
      ins.push_back(subsystem.in = add_place(subsystem.path + ".in"));
      outs.push_back(subsystem.out = add_place(subsystem.path + ".out"));
      subsystem.agent_out = out;
      add_page(subsystem.path, subsystem.in, subsystem.out);
    }
    add_transition(agents_[static_cast<std::size_t>(agent)] + ".t_in", {in}, ins);
    add_transition(agents_[static_cast<std::size_t>(agent)] + ".t_out", outs, {out});
  }

  void subsystem_layer(int s) {
    subsystem_ = s;
    FlatNet::SubsystemInfo& subsystem = net_.subsystems[static_cast<std::size_t>(s)];
    std::map<std::string, int> in_of, out_of{{"", subsystem.out}};
    for (const Behaviour& of : subsystem.of->behaviours) {
      const std::string path = subsystem.path + "." + path_in(*subsystem.of, of);
      const int in = add_place(path + ".in"), out = add_place(path + ".out");
      in_of[of.name] = in;
      out_of[of.name] = out;
      subsystem.behaviours.push_back(static_cast<int>(net_.behaviours.size()));
      net_.behaviours.push_back({path, s, &of, written_out(*subsystem.of, of), in, out});
      if (!of.is_group) net_.behaviours.back().received = channels_of(net_.behaviours.back(), false);
      add_page(path, in, out);
    }
    const std::string& start = first_in(*subsystem.of, "").name;
    FlatTransition& begin = add_transition(subsystem.path + ".t_in", {subsystem.in}, {in_of.at(start)});
    std::map<int, int> first;  // memory that the first behaviour changes
    const std::vector<Change> begun =
        changes_of(*subsystem.of, {start, Entry::When::always, "", Truth::open});
    for (const Change& change : begun) {
      const int fact = fact_of_cell(net_, s, change.cell);
      first[fact] = initial_value(net_.facts[static_cast<std::size_t>(fact)]);
    }
    for (const auto& [fact, value] : first) begin.pre.push_back(place_of(fact, value));
    const std::map<int, int> later = changed(net_, s, begun, first).value();
    for (const auto& [fact, value] : later) begin.post.push_back(place_of(fact, value));
    FlatNet::Counts& counts = net_.layers["subsystem"];
    counts.places += 2;
    counts.transitions += 1;
    for (const int b : subsystem.behaviours) {
      counts.pages += 1;
      behaviour_ = b;
      const FlatNet::BehaviourInfo& info = net_.behaviours[static_cast<std::size_t>(b)];
      const std::vector<Entry>& next = info.whole.next;
      const std::string in_page = subsystem.path + "." + page_of(*info.of, *subsystem.of);
      const std::vector<std::map<int, int>> all = values_of_next(net_, b);
      std::set<std::size_t> has_way;
      for (std::size_t k = 0; k < next.size(); ++k)
        for (std::size_t a = 0; a < all.size(); ++a) {
          const Ways ways = ways_of(net_, b, true, all[a]);
          const bool possible = ways.after_terminal.entries[k] || ways.after_error.entries[k];
          const bool needed = all[a].empty() || (k + 1 == next.size() && !has_way.contains(a));
          if (!possible && !needed) continue;
          has_way.insert(a);
          add_entry(in_page + "t_" + info.of->name + "_" + std::to_string(k + 1), info.out,
                    next[k].to == "end" ? out_of.at(info.of->group) : in_of.at(next[k].to),
                    static_cast<int>(k), changes_of(*subsystem.of, next[k]), all[a]);
        }
      if (info.of->is_group) {
        add_transition(info.path + ".t_in", {info.in},
                       {in_of.at(first_in(*subsystem.of, info.of->name).name)});
        counts.places += 2;
        counts.transitions += 1;
      } else {
        behaviour_layer(info, b);
      }
    }
    behaviour_ = subsystem_ = -1;
  }

  /// "", or "g0.g1."
  static std::string page_of(const Behaviour& of, const Subsystem& subsystem) {
    return of.group.empty() ? "" : path_in(subsystem, behaviour_named(subsystem, of.group)) + ".";
  }

  void behaviour_layer(const FlatNet::BehaviourInfo info, int b) {
    const std::string& path = info.path;
    const int two = add_place(path + ".2");
    const int snd_in = add_place(path + ".snd.in"), snd_out = add_place(path + ".snd.out");
    const int rcv_in = add_place(path + ".rcv.in"), rcv_out = add_place(path + ".rcv.out");
    add_page(path + ".snd", snd_in, snd_out);
    add_page(path + ".rcv", rcv_in, rcv_out);
    add_transition(path + ".t1", {info.in}, {snd_in});
    add_transition(path + ".t2", {snd_out}, {two});
    add_transition(path + ".t3", {two}, {rcv_in});
    FlatNet::Counts& counts = net_.layers["behaviour"];
    counts.places += 3;
    counts.transitions += 3;
    const std::vector<std::map<int, int>> all = values_of_ending(net_, b);
    for (const Role role : {Role::t4, Role::t5, Role::t6}) {
      bool drawn = false;
      for (std::size_t a = 0; a < all.size(); ++a) {
        const Ways ways = ways_of(net_, b, true, all[a]);
        const bool possible = role == Role::t4 ? ways.go_on : role == Role::t5 ? ways.terminal : ways.error;
        if (!possible && (drawn || a + 1 < all.size())) continue;
        drawn = true;
        add_asking(path + (role == Role::t4   ? ".t4"
                           : role == Role::t5 ? ".t5"
                                              : ".t6"),
                   rcv_out, role == Role::t4 ? info.in : info.out, role, -1, all[a]);
        counts.transitions += 1;
      }
    }
    counts.pages += 2;
    communication(info, true, path + ".snd", snd_in, snd_out);
    communication(info, false, path + ".rcv", rcv_in, rcv_out);
  }

  /// The channels of one side of a behaviour, in the order of its blocks.
  std::vector<int> channels_of(const FlatNet::BehaviourInfo& info, bool send) const {
    const auto& listed = send ? info.of->send : info.of->receive;
    std::vector<int> all;
    for (std::size_t c = 0; c < net_.channels.size(); ++c)
      if ((send ? net_.channels[c].sender : net_.channels[c].receiver) == info.subsystem)
        all.push_back(static_cast<int>(c));
    if (!listed) return all;
    std::vector<int> ordered;
    for (const std::string& buffer : *listed)
      for (const int c : all)
        if (buffer_of(c, send) == buffer) ordered.push_back(c);
    return ordered;
  }
  const std::string& buffer_of(int c, bool send) const {
    const FlatNet::ChannelInfo& channel = net_.channels[static_cast<std::size_t>(c)];
    return send ? channel.output : channel.input;
  }

  /// "o", or "o#2" where the output feeds several channels.
  std::string block_name(int c, bool send) const {
    if (!send) return buffer_of(c, send);
    int number = 0, of = 0;
    for (int d = 0; d < static_cast<int>(net_.channels.size()); ++d) {
      const FlatNet::ChannelInfo& other = net_.channels[static_cast<std::size_t>(d)];
      if (other.sender != net_.channels[static_cast<std::size_t>(c)].sender ||
          other.output != buffer_of(c, send))
        continue;
      ++of;
      if (d <= c) ++number;
    }
    return of == 1 ? buffer_of(c, send) : buffer_of(c, send) + "#" + std::to_string(number);
  }

  const Skip* skip_of(const FlatNet::BehaviourInfo& info, int c) const {
    for (const Skip& skip : info.of->skips)
      if (skip.output == buffer_of(c, true)) return &skip;
    return nullptr;
  }

  /// A transition that begins a block. If the iteration may skip it: one for each value of the facts that its
  /// condition asks for, with which it may be sent.
  void add_begin(const std::string& name, const std::vector<int>& pre, const std::vector<int>& post) {
    if (skip_ == nullptr) {
      add_transition(name, pre, post);
      return;
    }
    for (const std::map<int, int>& values : values_of_skip(net_, behaviour_, *skip_)) {
      if (sends(net_, behaviour_, *skip_, true, values) == Truth::no) continue;
      FlatTransition& made = add_transition(name + suffix(net_, values), pre, post);
      made.role = Role::sends;
      read_facts(made, values);
    }
  }

  void read_facts(FlatTransition& made, const std::map<int, int>& values) {
    made.skip = skip_;
    made.facts = values;
    for (const auto& [fact, value] : values) {
      const int place = net_.facts[static_cast<std::size_t>(fact)].places[static_cast<std::size_t>(value)];
      made.pre.push_back(place);
      made.post.push_back(place);
    }
  }

  /// The way past a block, without a look at the channel. A value that was not sent has not timed out.
  void add_skip(int c, const std::string& prefix, int in, int out) {
    int own = -1;
    for (std::size_t f = 0; f < net_.facts.size(); ++f) {
      const std::vector<int>& set_by = net_.facts[f].channels;
      if (net_.facts[f].sends && std::find(set_by.begin(), set_by.end(), c) != set_by.end())
        own = static_cast<int>(f);
    }
    for (const std::map<int, int>& values : values_of_skip(net_, behaviour_, *skip_)) {
      if (sends(net_, behaviour_, *skip_, true, values) == Truth::yes) continue;
      for (int before = 0; before < 2; ++before) {
        std::map<int, int> taken = values;
        if (own >= 0 && values.contains(own) && values.at(own) != before) continue;
        if (own >= 0) taken[own] = before;
        FlatTransition& made = add_transition(prefix + ".skip" + suffix(net_, taken), {in}, {out});
        made.role = Role::skips;
        std::map<int, int> read = taken;
        if (own >= 0) read.erase(own);
        read_facts(made, read);
        made.facts = values;
        if (own < 0) break;
        made.pre.push_back(
            net_.facts[static_cast<std::size_t>(own)].places[static_cast<std::size_t>(before)]);
        made.post.push_back(net_.facts[static_cast<std::size_t>(own)].places[0]);
      }
    }
  }

  void communication(const FlatNet::BehaviourInfo& info, bool send, const std::string& path, int in,
                     int out) {
    const std::size_t places_before = net_.places.size(), transitions_before = net_.transitions.size();
    const std::vector<int> channels = channels_of(info, send);
    std::size_t fused = 0;
    for (const int c : channels) {
      fused += share(c);
      const Channel& of = *net_.channels[static_cast<std::size_t>(c)].of;
      if (send ? of.send_blocking && skip_of(info, c) == nullptr : of.receive_blocking)
        waits_.insert(path.substr(0, path.size() - 4));
    }
    if (channels.empty()) {
      add_transition(path + ".t1", {in}, {out});
    } else if (info.of->parallel && channels.size() > 1) {
      std::vector<int> ins, outs;
      for (const int c : channels) {
        const std::string prefix = path + "." + block_name(c, send);
        ins.push_back(add_place(prefix + ".in"));
        outs.push_back(add_place(prefix + ".out"));
        skip_ = send ? skip_of(info, c) : nullptr;
        block(c, send, prefix, ins.back(), outs.back());
      }
      add_transition(path + ".fork", {in}, ins);
      add_transition(path + ".join", outs, {out});
    } else {
      for (std::size_t k = 0; k < channels.size(); ++k) {
        const std::string prefix = path + "." + block_name(channels[k], send);
        const int after = k + 1 == channels.size() ? out : add_place(prefix + ".out");
        skip_ = send ? skip_of(info, channels[k]) : nullptr;
        block(channels[k], send, prefix, in, after);
        in = after;
      }
    }
    FlatNet::Counts& counts = net_.layers["communication"];
    counts.places += 2 + static_cast<int>(net_.places.size() - places_before - fused);
    counts.transitions += static_cast<int>(net_.transitions.size() - transitions_before);
  }

  const Model* model_of(const Channel& channel) const {
    for (const Model& model : specification_.models)
      if (model.name == channel.model) return &model;
    return nullptr;
  }

  /// Makes the fused places of a channel when its first block is made; how many.
  std::size_t share(int c) {
    FlatNet::ChannelInfo& channel = net_.channels[static_cast<std::size_t>(c)];
    if (!channel.shared.empty()) return 0;
    const auto add = [&](const std::string& name, bool marked) {
      channel.shared[name] = add_place(channel.name + "." + name, marked, true);
    };
    if (const Model* model = model_of(*channel.of)) {
      for (const auto& [name, tokens] : model->shared) add(name, tokens > 0);
    } else if (!channel.of->send_blocking && !channel.of->receive_blocking) {
      add("channel", true);
    } else {
      add("empty", true);
      add("full", false);
      if (channel.of->send_blocking) add("ack", false);
    }
    return channel.shared.size();
  }

  void block(int c, bool send, const std::string& prefix, int in, int out) {
    FlatNet::ChannelInfo& channel = net_.channels[static_cast<std::size_t>(c)];
    if (!send) channel.received = true;
    if (skip_ != nullptr) add_skip(c, prefix, in, out);
    if (const Model* model = model_of(*channel.of))
      return model_block(c, channel, send ? model->send : model->receive, send, prefix, in, out);
    const int two = add_place(prefix + ".2");
    (send ? channel.writing : channel.reading)[1].push_back(two);
    if (!send) channel.reads.push_back(static_cast<int>(net_.transitions.size()));
    if (channel.shared.contains("channel")) {
      const int memory = channel.shared.at("channel");
      add_begin(prefix + ".t1", {in, memory}, {two});
      if (send)
        add_transition(prefix + ".t2", {two}, {out, memory});
      else
        add_reading(c, prefix + ".t2", {two}, {out, memory});
    } else if (send) {
      send_block(c, channel, prefix, in, two, out);
    } else {
      receive_block(c, channel, prefix, in, two, out);
    }
  }

  void send_block(int c, const FlatNet::ChannelInfo& channel, const std::string& prefix, int in, int two,
                  int out) {
    const int empty = channel.shared.at("empty"), full = channel.shared.at("full");
    add_begin(prefix + ".t1", {in, empty}, {two});
    if (!channel.of->send_blocking) {
      add_begin(prefix + ".t1o", {in, full}, {two});
      add_transition(prefix + ".t2", {two}, {out, full});
      return;
    }
    const int wait = add_place(prefix + ".wait");
    add_transition(prefix + ".t2", {two}, {wait, full});
    add_end(c, true, true, prefix + ".t3", {wait, channel.shared.at("ack")}, {out});
    if (channel.of->send_timeout) add_end(c, true, false, prefix + ".timeout", {wait, full}, {out, empty});
  }

  void receive_block(int c, const FlatNet::ChannelInfo& channel, const std::string& prefix, int in, int two,
                     int out) {
    const int empty = channel.shared.at("empty"), full = channel.shared.at("full");
    add_transition(prefix + ".t1", {in, full}, {two});
    std::vector<int> after{out, empty};
    if (channel.of->send_blocking) after.push_back(channel.shared.at("ack"));
    add_end(c, false, true, prefix + ".t2", {two}, after);
    if (!channel.of->receive_blocking) add_end(c, false, false, prefix + ".skip", {in, empty}, {out, empty});
    if (channel.of->receive_timeout) add_end(c, false, false, prefix + ".timeout", {in, empty}, {out, empty});
  }

  void model_block(int c, FlatNet::ChannelInfo& channel, const ModelSide& side, bool send,
                   const std::string& prefix, int in, int out) {
    std::map<std::string, int> place = channel.shared;
    std::map<std::string, int> slot_of;
    for (const auto& one : side.places) {
      place[one.name] = one.name == "in" ? in : one.name == "out" ? out : add_place(prefix + "." + one.name);
      slot_of[one.name] = one.slot;
      if (one.slot > 0) (send ? channel.writing : channel.reading)[one.slot].push_back(place[one.name]);
    }
    for (const auto& one : side.transitions) {
      std::vector<int> pre, post;
      bool reads = false;
      bool has_read = false;
      for (const std::string& name : one.from) {
        pre.push_back(place.at(name));
        has_read = has_read || (!send && slot_of[name] > 0);
      }
      for (const std::string& name : one.to) {
        post.push_back(place.at(name));
        reads = reads || (!send && slot_of[name] > 0);
      }
      if (reads) channel.reads.push_back(static_cast<int>(net_.transitions.size()));
      const bool begins = std::find(one.from.begin(), one.from.end(), "in") != one.from.end();
      if (begins)
        add_begin(prefix + "." + one.name, pre, post);
      else if (has_read && !one.elapsed)
        add_reading(c, prefix + "." + one.name, pre, post);
      else
        add_transition(prefix + "." + one.name, pre, post);
    }
  }

  void collect_pages() {
    for (FlatNet::Page& page : net_.pages)
      for (std::size_t p = 0; p < net_.places.size(); ++p)
        if (!net_.places[p].fused && (page.path.empty() || net_.places[p].name.starts_with(page.path + ".")))
          page.places.push_back(static_cast<int>(p));
  }

  const Specification& specification_;
  FlatNet net_;
  std::vector<std::string> agents_;
  std::vector<int> agent_of_;
  std::map<std::string, int> by_path_;
  std::set<std::string> waits_;
  int subsystem_ = -1, behaviour_ = -1;
  const Skip* skip_ = nullptr;  // of the block that is drawn
};

}  // namespace

Fleet fleet_of(const Specification& specification, const std::string& agent) {
  for (const Agent& one : specification.agents)
    if (one.name == agent) return {one.count, one.ring};
  throw std::logic_error("no agent " + agent);
}

FlatNet flat_net(const Specification& specification) { return Builder(specification).build(); }

PetriNet petri_net(const FlatNet& net) {
  const auto arcs = [](const std::vector<int>& places) {
    std::vector<Arc> all;
    for (const int place : places) all.push_back({static_cast<std::uint32_t>(place)});
    return all;
  };
  PetriNet plain;
  for (const FlatNet::PlaceInfo& place : net.places) plain.initial.push_back(place.marked ? 1 : 0);
  for (const FlatTransition& transition : net.transitions)
    plain.transitions.push_back({arcs(transition.pre), arcs(transition.post)});
  return plain;
}

std::uint32_t tokens_in(const Marking& marking, const std::vector<int>& places) {
  std::uint32_t tokens = 0;
  for (const int place : places) tokens += marking[static_cast<std::size_t>(place)];
  return tokens;
}

}  // namespace oracle
