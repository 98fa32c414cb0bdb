#include "verify_circuits/naive_answers.hpp"

#include <algorithm>
#include <bitset>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

namespace tessera::test {
namespace {

using Marking = std::bitset<256>;
using Facts = std::uint64_t;  // bit s: subsystem s moves; bit 32 + c: channel c is read

class NaiveExploration {
 public:
  NaiveExploration(const net::Net& net, std::size_t most) : net_(net), most_(most) {
    if (net.places().size() > Marking{}.size()) throw std::invalid_argument("too many places");
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      if (net.transitions()[index].condition.truth != net::Condition::Truth::never) compile({index});
    for (std::uint32_t place = 0; place < net.places().size(); ++place) describe(place);
    for (const auto& [path, subsystem] : paths_) inside_[subsystem] |= entry(path);
  }

  std::optional<NaiveAnswers> result() {
    if (!search()) return std::nullopt;
    look_back();
    NaiveAnswers answers;
    answers.markings = markings_.size();
    answers.stuck.assign(inside_.size(), false);
    answers.dry.assign(readers_.size(), false);
    answers.reader_can_end.assign(readers_.size(), false);
    answers.deadlock = deadlock_;
    for (std::size_t index = 0; index < markings_.size(); ++index) judge(index, answers);
    return answers;
  }

 private:
  struct Rule {
    Marking takes, gives;
    Facts shows = 0;
  };

  void compile(net::TransitionId id) {
    Rule rule;
    for (const net::Arc& arc : net_.preset(id)) rule.takes.set(arc.place.value);
    for (const net::Arc& arc : net_.postset(id)) {
      rule.gives.set(arc.place.value);
      const net::Operation& operation = net_[arc.place].operation;
      if (operation.kind == net::Operation::Kind::read) rule.shows |= Facts{1} << (32 + operation.subject);
    }
    if (net_[id].subsystem != net::no_subsystem) rule.shows |= Facts{1} << net_[id].subsystem;
    rules_.push_back(rule);
  }

  void describe(std::uint32_t index) {
    const net::Place& place = net_.places()[index];
    if (place.tokens > 0) start_.set(index);
    if (place.layer == net::Layer::system && place.name == "out") final_.set(index);
    if (place.subsystem == net::no_subsystem) return;
    if (inside_.size() <= place.subsystem) inside_.resize(place.subsystem + 1);
    const bool exit = place.layer == net::Layer::subsystem && place.name.ends_with(".out");
    if (!exit)
      inside_[place.subsystem].set(index);
    else
      paths_.emplace_back(place.name.substr(0, place.name.size() - 4), place.subsystem);
    if (place.operation.kind == net::Operation::Kind::read) {
      const std::uint32_t channel = place.operation.subject;
      if (readers_.size() <= channel) readers_.resize(channel + 1, net::no_subsystem);
      readers_[channel] = place.subsystem;
    }
  }

  /// The places from which a subsystem is still to be started.
  [[nodiscard]] Marking entry(const std::string& path) const {
    Marking places;
    const std::string agent = path.substr(0, path.rfind('.'));
    for (std::uint32_t index = 0; index < net_.places().size(); ++index)
      if (net_.places()[index].name == "in" || net_.places()[index].name == agent + ".in") places.set(index);
    return places;
  }

  std::uint32_t number(const Marking& marking) {
    const auto [entry, added] = numbers_.emplace(marking, static_cast<std::uint32_t>(markings_.size()));
    if (added) {
      markings_.push_back(marking);
      facts_.push_back(0);
      predecessors_.emplace_back();
    }
    return entry->second;
  }

  bool search() {
    number(start_);
    for (std::uint32_t at = 0; at < markings_.size(); ++at) {
      if (markings_.size() > most_) return false;
      const Marking marking = markings_[at];
      bool dead = true;
      for (const Rule& rule : rules_) {
        if ((marking & rule.takes) != rule.takes) continue;
        dead = false;
        facts_[at] |= rule.shows;
        const Marking left = marking & ~rule.takes;
        if ((left & rule.gives).any()) throw std::invalid_argument("the net is not safe");
        const std::uint32_t next = number(left | rule.gives);
        if (next != at) predecessors_[next].push_back(at);
      }
      if (dead && (marking & final_).none()) deadlock_ = true;
    }
    return true;
  }

  /// What can happen later can happen from here.
  void look_back() {
    std::vector<std::uint32_t> open(markings_.size());
    for (std::uint32_t index = 0; index < open.size(); ++index) open[index] = index;
    while (!open.empty()) {
      const std::uint32_t at = open.back();
      open.pop_back();
      for (const std::uint32_t before : predecessors_[at]) {
        if ((facts_[before] | facts_[at]) == facts_[before]) continue;
        facts_[before] |= facts_[at];
        open.push_back(before);
      }
    }
  }

  [[nodiscard]] bool ended(std::uint32_t subsystem, const Marking& marking) const {
    return (marking & inside_[subsystem]).none();
  }

  void judge(std::size_t index, NaiveAnswers& answers) const {
    const Marking& marking = markings_[index];
    for (std::uint32_t subsystem = 0; subsystem < inside_.size(); ++subsystem)
      if ((facts_[index] >> subsystem & 1) == 0 && !ended(subsystem, marking))
        answers.stuck[subsystem] = true;
    for (std::uint32_t channel = 0; channel < readers_.size(); ++channel) {
      if (readers_[channel] == net::no_subsystem) continue;
      if (ended(readers_[channel], marking))
        answers.reader_can_end[channel] = true;
      else if ((facts_[index] >> (32 + channel) & 1) == 0)
        answers.dry[channel] = true;
    }
  }

  const net::Net& net_;
  std::size_t most_;
  std::vector<Rule> rules_;
  Marking start_, final_;
  std::vector<Marking> inside_;  // per subsystem: where a token says that it has not ended
  std::vector<std::pair<std::string, std::uint32_t>> paths_;  // of subsystems
  std::vector<std::uint32_t> readers_;                        // per channel
  std::unordered_map<Marking, std::uint32_t> numbers_;
  std::vector<Marking> markings_;
  std::vector<Facts> facts_;
  std::vector<std::vector<std::uint32_t>> predecessors_;
  bool deadlock_ = false;
};

}  // namespace

std::optional<NaiveAnswers> explore_naively(const net::Net& net, std::size_t most_markings) {
  return NaiveExploration(net, most_markings).result();
}

}  // namespace tessera::test
