#include "counterexample.hpp"

#include <algorithm>
#include <set>

#include "oracle/judge/conditions.hpp"

namespace oracle {
namespace {

using nlohmann::json;

class Checker {
 public:
  Checker(const Shown& shown, const json& verdict)
      : shown_(shown), judge_(shown.judge), net_(shown.judge.net()), verdict_(verdict) {}

  Complaints check() {
    if (!play()) return complaints_;
    const std::string name = verdict_.at("name");
    if (shown_.property != nullptr)
      own_property();
    else if (name == "deadlock_free")
      dead_end();
    else if (name == "channels_flow")
      dry_end();
    else if (name == "goes_on")
      stuck_end();
    else if (name == "survives_exceptions" && !dead())
      stuck_end();
    for (const json& wait : verdict_.at("waits")) check_wait(wait.get<std::string>());
    return complaints_;
  }

 private:
  void complain(const std::string& text) { complaints_.push_back(text); }
  const Marking& end() const { return path_.back(); }
  bool dead() const { return judge_.graph().dead(end_state_) && !judge_.final(end()); }

  int transition_named(const std::string& name) const {
    for (std::size_t t = 0; t < net_.transitions.size(); ++t)
      if (net_.transitions[t].name == name) return static_cast<int>(t);
    return -1;
  }

  bool play() {
    path_.push_back(judge_.graph().marking(0));
    for (const json& step : verdict_.at("trace")) {
      const std::string name = step.at("transition");
      const int t = transition_named(name);
      const auto after = t < 0 ? std::nullopt : judge_.fire(t, end());
      if (!after) {
        complain("illegal: firing " + std::to_string(path_.size()) + ", " + name +
                 (t < 0 ? ", is not in the net" : ", is not enabled"));
        return false;
      }
      follow_conditions(net_.transitions[static_cast<std::size_t>(t)]);
      path_.push_back(*after);
    }
    end_state_ = judge_.graph().find(end()).value();
    return true;
  }

  /// An entry of `next` must be possible after the way in which its behaviour has just ended. An entry that leaves a
  /// group says how the group has ended; one that is taken after both endings leaves it as its behaviour has ended.
  void follow_conditions(const FlatTransition& fired) {
    if (fired.role == Role::t5 || fired.role == Role::t6) by_error_[fired.subsystem] = fired.role == Role::t6;
    if (fired.role != Role::next && fired.role != Role::none) return;
    const Ways ways = ways_of(net_, fired.behaviour, shown_.exceptions, fired.facts);
    bool& by_error = by_error_[fired.subsystem];
    const auto fits = [&](const Following& following) {
      return fired.role == Role::none ? following.none
                                      : following.entries[static_cast<std::size_t>(fired.entry)];
    };
    // For the proof it is a free choice how a group was left.
    const bool is_free = net_.behaviours[static_cast<std::size_t>(fired.behaviour)].of->is_group;
    const bool other_fits = is_free && fits(by_error ? ways.after_terminal : ways.after_error);
    if (!fits(by_error ? ways.after_error : ways.after_terminal) && !other_fits)
      complain("conditions: " + fired.name + " cannot follow " + (by_error ? "t6" : "t5"));
    if (fired.role == Role::none) return;
    const auto k = static_cast<std::size_t>(fired.entry);
    if (!ways.after_error.entries[k]) by_error = false;
    if (!ways.after_terminal.entries[k]) by_error = true;
  }

  void own_property() {
    for (const CompiledProperty& one : compile(shown_.specification, net_, *shown_.property)) {
      if (shown_.property->kind == Property::Kind::leads_to
              ? lost(one)
              : judge_.bad(one, shown_.property->kind)[end_state_] != 0)
        return;
    }
    complain("end: it does not end where the property is violated");
  }

  /// F somewhere, no G from there to the end, and none can follow the end.
  bool lost(const CompiledProperty& one) const {
    CompiledProperty never = one;
    never.first = one.second;  // always_reachable: G
    if (judge_.bad(never, Property::Kind::always_reachable)[end_state_] == 0) return false;
    for (auto marking = path_.rbegin(); marking != path_.rend() && !one.second.holds(*marking); ++marking)
      if (one.first.holds(*marking)) return true;
    return false;
  }

  void dead_end() {
    if (!dead()) complain("end: the marking is not dead, or it is final");
  }

  void dry_end() {
    const std::string why = verdict_.at("why");
    for (std::size_t c = 0; c < net_.channels.size(); ++c) {
      if (!why.starts_with(net_.channels[c].name + " ")) continue;
      if (judge_.dry(static_cast<int>(c))[end_state_] == 0)
        complain("end: the channel can be read again, or its reader can end");
      return;
    }
    complain("end: no channel is named in: " + why);
  }

  int subsystem_at(const std::string& text) const {
    for (std::size_t s = 0; s < net_.subsystems.size(); ++s)
      if (text.starts_with(net_.subsystems[s].path + " ")) return static_cast<int>(s);
    return -1;
  }
  bool stuck(int subsystem) const { return judge_.stuck(subsystem)[end_state_] != 0; }

  void stuck_end() {
    const std::string why = verdict_.at("why");
    const int subsystem = subsystem_at(why);
    if (subsystem < 0)
      complain("end: no subsystem is named in: " + why);
    else if (!stuck(subsystem))
      complain("end: " + net_.subsystems[static_cast<std::size_t>(subsystem)].path + " goes on or has ended");
  }

  /// "S waits for a value of CHANNEL from P", "... for the acknowledgement of ...", "S left BEHAVIOUR, and
  /// none ...", "S has ended", "S goes on and sends CHANNEL no more".
  void check_wait(const std::string& text) {
    const int subsystem = subsystem_at(text);
    if (subsystem < 0) return complain("waits: unknown subsystem in: " + text);
    const std::string rest =
        text.substr(net_.subsystems[static_cast<std::size_t>(subsystem)].path.size() + 1);
    if (rest.starts_with("left ") && rest.ends_with(", and none of its initial conditions held")) {
      if (!left_with_none(subsystem)) complain("waits: not so: " + text);
      return;
    }
    if (rest == "has ended") {
      if (!judge_.has_ended(end(), subsystem)) complain("waits: not so: " + text);
      return;
    }
    // A reason may follow: ": b.control never leaves look ...".
    const std::string what = rest.substr(0, rest.find(": "));
    if (what.starts_with("goes on and ") && what.ends_with(" no more")) {
      if (!goes_on_without(subsystem, what)) complain("waits: not so: " + text);
      return;
    }
    for (const auto& channel : net_.channels) {
      const std::size_t at = rest.find(" of " + channel.name);
      if (at == std::string::npos) continue;
      const std::string tail = rest.substr(at + 4 + channel.name.size());
      if (!tail.empty() && tail[0] != ' ' && tail[0] != ',') continue;
      bool sends = rest.find("acknowledgement") < at;
      if (rest.find("memory") < at)
        sends = channel.sender == subsystem && (channel.receiver != subsystem || blocked(channel, true));
      if ((sends ? channel.sender : channel.receiver) != subsystem)
        return complain("waits: not at that end of the channel: " + text);
      if (!blocked(channel, sends)) return complain("waits: it does not wait there for ever: " + text);
      const int other = sends ? channel.receiver : channel.sender;
      const std::string& peer = net_.subsystems[static_cast<std::size_t>(other)].path;
      // A subsystem that waits for a token from nobody has no peer whose end would have to be shown.
      const bool for_nobody = tail.find("nobody") != std::string::npos;
      if (!for_nobody && !settled(other))
        complain("waits: the run stops before " + peer + " is stuck or has ended: " + text);
      const bool itself = other == subsystem && tail.starts_with(" from itself");
      if (tail.starts_with(" from ") && !itself &&
          !(tail.substr(6) == peer || tail.substr(6).starts_with(peer + ",") ||
            tail.substr(6).starts_with(peer + " ")))
        complain("waits: the wrong peer: " + text);
      // A subsystem that waits for itself has no peer.
      if (for_nobody && channel.sender != channel.receiver && somebody(channel, sends))
        complain("waits: there is somebody: " + text);
      return;
    }
    complain("waits: not understood: " + text);
  }

  /// The awaited peer is stuck too, has ended, or may go on for ever.
  bool settled(int subsystem) const {
    return stuck(subsystem) || judge_.has_ended(end(), subsystem) || for_ever(subsystem);
  }
  bool for_ever(int subsystem) const {
    std::vector<char> own(net_.transitions.size());
    for (std::size_t t = 0; t < own.size(); ++t) own[t] = net_.transitions[t].subsystem == subsystem ? 1 : 0;
    return judge_.graph().can_fire_for_ever(own)[end_state_] != 0;
  }

  /// "goes on and sends CHANNEL no more": it may fire for ever, and uses its side of the channel never again.
  /// "receives": it reads no value any more.
  bool goes_on_without(int subsystem, const std::string& text) const {
    if (!for_ever(subsystem)) return false;
    for (const auto& channel : net_.channels) {
      if (text.find(" " + channel.name + " ") == std::string::npos) continue;
      // "gives the memory" does not say at which end, and one subsystem may have both.
      const bool gives = text.find(" gives ") != std::string::npos;
      if (gives && channel.sender == subsystem && never_more(users(channel, true))) return true;
      if (gives) return channel.receiver == subsystem && never_more(users(channel, false));
      // A skipped read receives no value, although it has looked at the channel.
      if (text.find(" receives ") != std::string::npos) return never_more(channel.reads);
      if (text.find(" sends ") != std::string::npos) return never_more(sending(channel));
      return never_more(users(channel, false));
    }
    return false;
  }
  bool never_more(const std::vector<int>& transitions) const {
    std::vector<char> uses(net_.transitions.size());
    for (const int t : transitions) uses[static_cast<std::size_t>(t)] = 1;
    const auto& graph = judge_.graph();
    return graph.can_reach(graph.where_enabled(uses))[end_state_] == 0;
  }

  bool left_with_none(int subsystem) const {
    for (const int b : net_.subsystems[static_cast<std::size_t>(subsystem)].behaviours) {
      // One place for all values of the facts that decide, or one for each.
      const std::string none = net_.behaviours[static_cast<std::size_t>(b)].path + ".out.none";
      for (const auto& [name, place] : net_.place_of)
        if ((name == none || name.starts_with(none + ".")) && has_token(end(), place)) return true;
    }
    return false;
  }

  /// The transitions of one side of a channel: they touch its shared places.
  std::vector<int> users(const FlatNet::ChannelInfo& channel, bool sends) const {
    std::set<int> shared;
    for (const auto& [name, place] : channel.shared) shared.insert(place);
    std::vector<int> all;
    const std::string side = sends ? ".snd." : ".rcv.";
    const int subsystem = sends ? channel.sender : channel.receiver;
    for (std::size_t t = 0; t < net_.transitions.size(); ++t) {
      const FlatTransition& transition = net_.transitions[t];
      const auto touches = [&](const std::vector<int>& places) {
        return std::any_of(places.begin(), places.end(), [&](int place) { return shared.contains(place); });
      };
      if (transition.subsystem == subsystem && transition.name.find(side) != std::string::npos &&
          (touches(transition.pre) || touches(transition.post)))
        all.push_back(static_cast<int>(t));
    }
    return all;
  }
  /// Those of the sender that do more than take the acknowledgement of what it has sent already.
  std::vector<int> sending(const FlatNet::ChannelInfo& channel) const {
    std::vector<int> all = users(channel, true);
    const auto ack = channel.shared.find("ack");
    if (ack == channel.shared.end()) return all;
    std::erase_if(all, [&](int t) {
      const FlatTransition& transition = net_.transitions[static_cast<std::size_t>(t)];
      const auto is_other = [&](int place) {
        return place != ack->second &&
               std::ranges::any_of(channel.shared, [&](const auto& one) { return one.second == place; });
      };
      return std::ranges::none_of(transition.pre, is_other) &&
             std::ranges::none_of(transition.post, is_other);
    });
    return all;
  }
  bool somebody(const FlatNet::ChannelInfo& channel, bool sends) const {
    return !users(channel, !sends).empty();
  }

  /// A token of this side waits before a transition of the channel, and no continuation takes it from there.
  bool blocked(const FlatNet::ChannelInfo& channel, bool sends) const {
    for (const int t : users(channel, sends)) {
      for (const int place : net_.transitions[static_cast<std::size_t>(t)].pre) {
        if (net_.places[static_cast<std::size_t>(place)].fused || !has_token(end(), place)) continue;
        std::vector<char> leaving(net_.transitions.size());
        for (std::size_t u = 0; u < leaving.size(); ++u)
          leaving[u] =
              std::count(net_.transitions[u].pre.begin(), net_.transitions[u].pre.end(), place) > 0 ? 1 : 0;
        const auto& graph = judge_.graph();
        if (graph.can_reach(graph.where_enabled(leaving))[end_state_] == 0) return true;
      }
    }
    return false;
  }

  const Shown& shown_;
  const Judge& judge_;
  const FlatNet& net_;
  const json& verdict_;
  std::vector<Marking> path_;
  ReachabilityGraph::State end_state_ = 0;
  std::map<int, bool> by_error_;
  Complaints complaints_;
};

}  // namespace

Complaints check_run(const Shown& shown, const json& verdict) { return Checker(shown, verdict).check(); }

}  // namespace oracle
