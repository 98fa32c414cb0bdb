#include "verify_circuits/naive_answers.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "oracle/nets/of_net.hpp"
#include "oracle/nets/reachability_graph.hpp"

namespace tessera::test {
namespace {

using oracle::Marking;
using oracle::ReachabilityGraph;
using Places = std::vector<std::size_t>;

class NaiveJudge {
 public:
  NaiveJudge(const net::Net& net, const ReachabilityGraph& graph) : net_(net), graph_(graph) {
    for (std::uint32_t place = 0; place < net.places().size(); ++place) describe(place);
    for (const auto& [path, subsystem] : paths_) add_entry(path, subsystem);
  }

  NaiveAnswers result() const {
    NaiveAnswers answers;
    answers.markings = graph_.size();
    answers.deadlock = deadlock();
    for (std::uint32_t index = 0; index < inside_.size(); ++index)
      answers.stuck.push_back(never_again(moves_of({index}), {index}));
    for (std::uint32_t channel = 0; channel < readers_.size(); ++channel) {
      const bool is_read = readers_[channel].valid();
      answers.dry.push_back(is_read && never_again(reads_of({channel}), readers_[channel]));
      answers.reader_can_end.push_back(is_read && can_end(readers_[channel]));
    }
    return answers;
  }

 private:
  void describe(std::uint32_t index) {
    const net::Place& place = net_.places()[index];
    if (place.layer == net::Layer::system && place.name == "out") final_.push_back(index);
    if (!place.subsystem.valid()) return;
    if (inside_.size() <= place.subsystem.value) inside_.resize(place.subsystem.value + 1);
    const bool exit = place.layer == net::Layer::subsystem && place.name.ends_with(".out");
    if (!exit)
      inside_[place.subsystem.value].push_back(index);
    else
      paths_.emplace_back(place.name.substr(0, place.name.size() - 4), place.subsystem);
    if (place.operation.kind == net::Operation::Kind::read) {
      const std::uint32_t channel = place.operation.channel.value;
      if (readers_.size() <= channel) readers_.resize(channel + 1);
      readers_[channel] = place.subsystem;
    }
  }

  /// The places from which a subsystem is still to be started.
  void add_entry(const std::string& path, net::SubsystemId subsystem) {
    const std::string agent = path.substr(0, path.rfind('.'));
    for (std::uint32_t index = 0; index < net_.places().size(); ++index)
      if (net_.places()[index].name == "in" || net_.places()[index].name == agent + ".in")
        inside_[subsystem.value].push_back(index);
  }

  static bool empty(const Places& places, const Marking& marking) {
    return std::ranges::all_of(places, [&](std::size_t place) { return marking[place] == 0; });
  }

  [[nodiscard]] ReachabilityGraph::States ended(net::SubsystemId subsystem) const {
    return graph_.where([&](const Marking& marking) { return empty(inside_[subsystem.value], marking); });
  }
  [[nodiscard]] bool can_end(net::SubsystemId subsystem) const { return oracle::some(ended(subsystem)); }

  [[nodiscard]] bool deadlock() const {
    for (ReachabilityGraph::State state = 0; state < graph_.size(); ++state)
      if (graph_.dead(state) && empty(final_, graph_.marking(state))) return true;
    return false;
  }

  /// Is there a marking in which the subsystem has not ended, and from which none of these can ever fire?
  [[nodiscard]] bool never_again(const ReachabilityGraph::Transitions& any_of,
                                 net::SubsystemId subsystem) const {
    const ReachabilityGraph::States again = graph_.can_reach(graph_.where_enabled(any_of));
    const ReachabilityGraph::States has_ended = ended(subsystem);
    for (ReachabilityGraph::State state = 0; state < graph_.size(); ++state)
      if (again[state] == 0 && has_ended[state] == 0) return true;
    return false;
  }

  [[nodiscard]] ReachabilityGraph::Transitions moves_of(net::SubsystemId subsystem) const {
    ReachabilityGraph::Transitions set;
    for (const net::Transition& transition : net_.transitions())
      set.push_back(transition.subsystem == subsystem ? 1 : 0);
    return set;
  }

  [[nodiscard]] ReachabilityGraph::Transitions reads_of(net::ChannelId channel) const {
    const auto is_read = [&](const net::Arc& arc) {
      const net::Operation& operation = net_[arc.place].operation;
      return operation.kind == net::Operation::Kind::read && operation.channel == channel;
    };
    ReachabilityGraph::Transitions set;
    for (std::uint32_t index = 0; index < net_.transitions().size(); ++index)
      set.push_back(std::ranges::any_of(net_.postset({index}), is_read) ? 1 : 0);
    return set;
  }

  const net::Net& net_;
  const ReachabilityGraph& graph_;
  Places final_;
  std::vector<Places> inside_;  // per subsystem: places with a token as long as it has not ended
  std::vector<std::pair<std::string, net::SubsystemId>> paths_;  // of subsystems
  std::vector<net::SubsystemId> readers_;                        // per channel
};

}  // namespace

std::optional<NaiveAnswers> explore_naively(const net::Net& net, std::size_t most_markings) {
  const auto graph = ReachabilityGraph::of(oracle::petri_net(net), most_markings);
  if (!graph) return std::nullopt;
  if (!graph->safe()) throw std::invalid_argument("the net is not safe");
  return NaiveJudge(net, *graph).result();
}

}  // namespace tessera::test
