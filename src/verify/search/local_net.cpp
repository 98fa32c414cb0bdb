#include "verify/search/local_net.hpp"

#include <algorithm>
#include <deque>
#include <set>
#include <unordered_map>
#include <utility>

namespace tessera::verify {
namespace {

using explore::Formula;

constexpr unsigned char most_tokens = 4;

std::string bytes_of(const std::vector<std::uint32_t>& numbers) {
  std::string text;
  for (const std::uint32_t number : numbers) text += std::to_string(number) + ' ';
  return text + '|';
}

std::string written(const Formula& formula) {
  std::string text = std::to_string(static_cast<int>(formula.kind));
  if (formula.kind == Formula::Kind::at_least)
    return text + ':' + std::to_string(formula.node) + ':' + std::to_string(formula.tokens);
  for (const Formula& part : formula.parts) text += '(' + written(part) + ')';
  return text;
}

/// The markings of a local net.
class LocalMarkings {
 public:
  LocalMarkings(const LocalNet& net, std::size_t most_markings) : net_(net), most_markings_(most_markings) {}

  std::optional<LocalNet::Doubts> doubts(const explore::Budget& budget) {
    if (!explore(budget)) return std::nullopt;
    std::vector<char> doubtful(markings_.size(), 0);
    if (net_.kind == LocalNet::Kind::never) {
      for (std::size_t at = 0; at < markings_.size(); ++at)
        doubtful[at] = holds(net_.what, *markings_[at]) ? 1 : 0;
    } else {
      const std::vector<char> asked =
          net_.kind == LocalNet::Kind::leads_to ? waiting() : std::vector<char>(markings_.size(), 1);
      const std::vector<char> good = can_certainly();
      for (std::size_t at = 0; at < markings_.size(); ++at)
        doubtful[at] = asked[at] != 0 && good[at] == 0 ? 1 : 0;
    }
    std::set<std::uint32_t> marked;
    bool any = false;
    for (std::size_t at = 0; at < markings_.size(); ++at) {
      if (doubtful[at] == 0) continue;
      any = true;
      for (std::uint32_t place = 0; place < net_.initial.size(); ++place)
        if ((*markings_[at])[place] != 0) marked.insert(place);
    }
    return LocalNet::Doubts{any, {marked.begin(), marked.end()}};
  }

 private:
  [[nodiscard]] static bool holds(const Formula& formula, const std::string& marking) {
    const auto part = [&](const Formula& one) { return holds(one, marking); };
    switch (formula.kind) {
      case Formula::Kind::at_least:
        return static_cast<unsigned char>(marking[formula.node]) >= formula.tokens;
      case Formula::Kind::negation:
        return !holds(formula.parts.front(), marking);
      case Formula::Kind::all:
        return std::ranges::all_of(formula.parts, part);
      case Formula::Kind::any:
        return std::ranges::any_of(formula.parts, part);
      default:
        return false;
    }
  }
  static bool is_enabled(const LocalNet::Step& step, const std::string& marking) {
    for (std::size_t at = 0; at < step.takes.size(); ++at) {
      const auto wanted = std::ranges::count(step.takes, step.takes[at]);
      if (static_cast<unsigned char>(marking[step.takes[at]]) < wanted) return false;
    }
    return true;
  }

  bool explore(const explore::Budget& budget) {
    std::vector<std::vector<std::uint32_t>> by_place(net_.initial.size());  // steps that take from it first
    std::vector<std::uint32_t> free;
    for (std::uint32_t at = 0; at < net_.steps.size(); ++at)
      (net_.steps[at].takes.empty() ? free : by_place[net_.steps[at].takes.front()]).push_back(at);
    const auto found = [&](const std::string& marking) {
      const auto [entry, added] = numbers_.emplace(marking, static_cast<std::uint32_t>(markings_.size()));
      if (added) markings_.push_back(&entry->first);
      return entry->second;
    };
    static_cast<void>(found(net_.initial));
    for (std::uint32_t from = 0; from < markings_.size(); ++from) {
      if (markings_.size() > most_markings_) return false;
      if (from % 512 == 0) budget.check();
      const std::string marking = *markings_[from];
      bool small = true;
      const auto fire = [&](std::uint32_t number) {
        const LocalNet::Step& step = net_.steps[number];
        if (!is_enabled(step, marking)) return;
        if (step.certain && step.counts) fires_.push_back(from);
        std::string next = marking;
        for (const std::uint32_t place : step.takes) next[place] = static_cast<char>(next[place] - 1);
        for (const std::uint32_t place : step.gives) {
          next[place] = static_cast<char>(next[place] + 1);
          small = small && static_cast<unsigned char>(next[place]) <= most_tokens;
        }
        edges_.push_back({from, found(next), step.certain});
      };
      for (const std::uint32_t number : free) fire(number);
      for (std::uint32_t place = 0; place < marking.size(); ++place)
        if (marking[place] != 0)
          for (const std::uint32_t number : by_place[place]) fire(number);
      if (!small) return false;
    }
    return true;
  }

  /// Markings from which certain steps lead to where it is fulfilled.
  std::vector<char> can_certainly() const {
    std::vector<std::vector<std::uint32_t>> before(markings_.size());
    for (const Edge& edge : edges_)
      if (edge.certain) before[edge.to].push_back(edge.from);
    std::vector<char> good(markings_.size(), 0);
    std::deque<std::uint32_t> open;
    const auto add = [&](std::uint32_t at) {
      if (good[at] == 0) open.push_back(at);
      good[at] = 1;
    };
    if (!net_.counts) {
      for (std::uint32_t at = 0; at < markings_.size(); ++at)
        if (holds(net_.then, *markings_[at])) add(at);
    } else {
      for (const std::uint32_t at : fires_) add(at);
    }
    for (; !open.empty(); open.pop_front())
      for (const std::uint32_t from : before[open.front()]) add(from);
    return good;
  }

  /// Markings after `what`, with no `then` since.
  std::vector<char> waiting() const {
    std::vector<std::vector<std::uint32_t>> behind(markings_.size());
    for (const Edge& edge : edges_) behind[edge.from].push_back(edge.to);
    std::vector<char> waits(markings_.size(), 0);
    std::deque<std::uint32_t> open;
    const auto add = [&](std::uint32_t at) {
      if (waits[at] != 0 || holds(net_.then, *markings_[at])) return;
      waits[at] = 1;
      open.push_back(at);
    };
    for (std::uint32_t at = 0; at < markings_.size(); ++at)
      if (holds(net_.what, *markings_[at])) add(at);
    for (; !open.empty(); open.pop_front())
      for (const std::uint32_t to : behind[open.front()]) add(to);
    return waits;
  }

  struct Edge {
    std::uint32_t from, to;
    bool certain;
  };

  const LocalNet& net_;
  std::size_t most_markings_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::vector<const std::string*> markings_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> fires_;  // markings in which a certain step that counts can be made
};

}  // namespace

std::string LocalNet::key() const {
  std::string text = std::to_string(static_cast<int>(kind)) + ';' + written(what) + ';' + written(then) +
                     ';' + std::to_string(counts) + ';' + initial;
  for (const Step& step : steps)
    text +=
        bytes_of(step.takes) + bytes_of(step.gives) + static_cast<char>('0' + 2 * step.certain + step.counts);
  return text;
}

std::optional<LocalNet::Doubts> LocalNet::doubts(const explore::Budget& budget,
                                                 std::size_t most_markings) const {
  return LocalMarkings(*this, most_markings).doubts(budget);
}

}  // namespace tessera::verify
