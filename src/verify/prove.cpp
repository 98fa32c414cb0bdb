#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "verify/abstraction.hpp"
#include "verify/circuits.hpp"
#include "verify/covered.hpp"
#include "verify/exploration.hpp"
#include "verify/hashes.hpp"
#include "verify/place_invariants.hpp"
#include "verify/verify.hpp"
#include "verify/waits.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::PlaceId;
using net::TransitionId;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// A verdict without its name, in the making.
using Result = PropertyResult;

constexpr const char* by_invariants = "place invariants";
constexpr const char* by_circuits = "circuits";
constexpr const char* by_structure = "communication structure";
constexpr const char* by_exploration = "reductions and explicit search";

/// Everything known about the net under one assumption.
struct Case {
  Assume assume;
  net::Net abstract;
  ProbedNet probed;
  CommunicationResult communication;
  std::optional<CircuitReport> circuits;

  Case(const Subject& subject, Assume assumed)
      : assume(assumed), abstract(abstract_net(subject.net, assumed)), probed(probed_net(abstract)) {
    if (subject.pages == nullptr) {
      communication.why_not = "the net is not made of the five layers";
      return;
    }
    communication = communication_structure(subject.net, assumed);
    if (communication.structure) circuits = judge_circuits(*communication.structure);
  }

  /// Why the circuit criterion says nothing.
  [[nodiscard]] std::string why_no_circuits() const {
    if (!communication.structure) return communication.why_not;
    for (const CircuitGroup& group : circuits->groups)
      if (!group.applies()) return group.why_not;
    return "the criterion does not tell";
  }
};

class Prover {
 public:
  Prover(const Subject& subject, const ProveOptions& options)
      : subject_(subject), options_(options), start_(Clock::now()) {
    wrong_ = wrong_invariants(subject.net, subject.invariants);
    if (wrong_.empty() && !subject.invariants.empty())
      safe_ = unbounded_places(subject.net, subject.invariants).empty();
  }

  std::vector<Result> result() {
    using Decide = Result (Prover::*)();
    static const std::map<std::string, Decide> deciders{
        {"safe", &Prover::safe},
        {"exclusive_channels", &Prover::exclusive_channels},
        {"deadlock_free", &Prover::deadlock_free},
        {"goes_on", &Prover::goes_on},
        {"channels_flow", &Prover::channels_flow},
        {"sound_pages", &Prover::sound_pages},
        {"live_behaviours", &Prover::live_behaviours},
        {"survives_exceptions", &Prover::survives_exceptions}};
    std::vector<std::string> names;
    for (const std::string& name : default_properties()) {
      const bool of_any_net = name == "safe" || name == "deadlock_free";
      const bool wanted = options_.only.empty() || std::ranges::count(options_.only, name) > 0;
      if (wanted && (subject_.pages != nullptr || of_any_net)) names.push_back(name);
    }
    left_ = names.size();
    std::vector<Result> results;
    Clock::time_point before = start_;  // checking the invariants counts for the first property
    for (const std::string& name : names) {
      name_ = name;
      Result result = (this->*deciders.at(name))();
      result.name = name;
      const Clock::time_point after = Clock::now();
      result.seconds = Seconds(after - before).count();
      before = after;
      results.push_back(std::move(result));
      --left_;
    }
    return results;
  }

 private:
  [[nodiscard]] bool may(Method method) const {
    return options_.method == Method::any || options_.method == method;
  }

  Case& under(Assume assume) {
    std::optional<Case>& wanted = assume == Assume::conditions ? conditions_ : exceptions_;
    if (!wanted) wanted.emplace(subject_, assume);
    return *wanted;
  }

  /// The time that is left is shared among the properties that are left.
  [[nodiscard]] explore::Limits limits(double share = 1) const {
    explore::Limits limits;
    const Seconds left = options_.time - Seconds(Clock::now() - start_);
    limits.time = std::max(Seconds(0), left * share / static_cast<double>(std::max<std::size_t>(left_, 1)));
    limits.bytes = options_.bytes;
    limits.stop = options_.stop;
    if (options_.progress)
      limits.progress = [this](const explore::Progress& progress) { options_.progress(name_, progress); };
    return limits;
  }

  static Result verdict(Verdict verdict, const char* method, std::string why = {}) {
    Result result;
    result.verdict = verdict;
    result.method = method;
    result.why = std::move(why);
    return result;
  }

  [[nodiscard]] static std::string not_allowed() { return "the methods that were allowed do not apply"; }

  Result safe() {
    Result result = verdict(Verdict::unknown, by_invariants, not_allowed());
    if (may(Method::invariants) && !subject_.invariants.empty()) {
      if (safe_) result = verdict(Verdict::holds, by_invariants);
      if (!wrong_.empty()) result.why = wrong_.front();
    }
    if (result.verdict == Verdict::unknown && may(Method::exploration)) result = safe_by_exploration();
    return with_meaning(std::move(result), Sort::universal);
  }

  /// Reductions do not keep safety, so the net itself is explored.
  Result safe_by_exploration() {
    std::vector<TransitionId> original;
    const net::Net possible = possible_part(under(Assume::conditions).abstract, &original);
    const explore::PtNet net(possible);
    const explore::Count count = explore::count(net, limits(0.8));
    Result result = verdict(Verdict::unknown, "explicit search", count.why);
    result.states = count.markings;
    result.explanation =
        std::to_string(count.markings) + " markings, " + std::to_string(count.edges) + " edges";
    if (count.complete && count.most_tokens <= 1) result.verdict = Verdict::holds;
    if (count.most_tokens <= 1) return result;
    std::vector<Formula> two;
    for (std::uint32_t place = 0; place < possible.places().size(); ++place)
      two.push_back(Formula::at_least({place}, 2));
    const explore::Answer answer = explore::find(net, Formula::any(std::move(two)), limits());
    result.verdict = Verdict::violated;
    result.why = "a place holds two tokens";
    if (answer.kind != explore::Answer::Kind::yes) return result;
    result.has_trace = true;
    for (const TransitionId id : answer.trace.firings) result.trace.push_back(original[id.value]);
    for (std::uint32_t place = 0; place < possible.places().size(); ++place)
      if (answer.trace.end[place] > 1)
        result.why = "place '" + possible.places()[place].name + "' holds " +
                     std::to_string(answer.trace.end[place]) + " tokens";
    return result;
  }

  Result by_covering(const std::function<std::string()>& gap) {
    if (!may(Method::invariants)) return verdict(Verdict::unknown, by_invariants, not_allowed());
    if (!wrong_.empty()) return verdict(Verdict::unknown, by_invariants, wrong_.front());
    const std::string found = gap();
    return verdict(found.empty() ? Verdict::holds : Verdict::unknown, by_invariants, found);
  }

  Result exclusive_channels() {
    return with_meaning(by_covering([&] { return shared_memory(subject_.net, subject_.invariants); }),
                        Sort::universal);
  }

  Result sound_pages() {
    return with_meaning(
        by_covering([&] { return unsound_page(*subject_.pages, subject_.net, subject_.invariants); }),
        Sort::universal);
  }

  Result deadlock_free() { return with_meaning(deadlock_free(Assume::conditions), Sort::completeness); }

  Result deadlock_free(Assume assume) {
    Case& given = under(assume);
    Result result = verdict(Verdict::unknown, by_circuits, not_allowed());
    if (may(Method::circuits)) {
      result = by_circuit(given, given.circuits ? given.circuits->deadlock_free : Answer::unknown);
      if (result.verdict == Verdict::holds) return result;
    }
    if (!may(Method::exploration)) return result;
    PlaceId final_place;
    if (subject_.pages != nullptr)
      for (std::uint32_t place = 0; place < given.abstract.places().size(); ++place)
        if (given.abstract.places()[place].layer == net::Layer::system &&
            given.abstract.places()[place].name == "out")
          final_place = {place};
    const Found found = find_dead(given.abstract, final_place, safe_, limits());
    return show(std::move(result), found, Found::Kind::no, given, {},
                final_place.valid() ? "a dead marking is reachable that is not final"
                                    : "a dead marking is reachable");
  }

  Result goes_on() { return with_meaning(goes_on(Assume::conditions), Sort::always_can); }

  Result goes_on(Assume assume) {
    Case& given = under(assume);
    Result result = verdict(Verdict::unknown, by_circuits, not_allowed());
    std::vector<ProbedNet::Set> sets = given.probed.subsystems;
    if (may(Method::circuits)) {
      result = by_circuit(given, given.circuits ? given.circuits->goes_on : Answer::unknown);
      if (result.verdict == Verdict::holds) return result;
      if (result.verdict == Verdict::violated)
        keep_stuck(given, sets);
      else if (given.circuits)
        keep_undecided(given, sets);
    }
    if (!may(Method::exploration)) return result;
    return by_sets(std::move(result), given, sets, [&](std::uint32_t subsystem) {
      return subsystem_names(given.abstract)[subsystem] + " can get stuck for ever";
    });
  }

  /// One subsystem that the circuits call stuck is enough for a run.
  static void keep_stuck(const Case& given, std::vector<ProbedNet::Set>& sets) {
    for (const CircuitGroup& group : given.circuits->groups) {
      if (group.stuck.empty()) continue;
      const std::uint32_t id = given.communication.structure->subsystems[group.stuck.front()].id;
      std::erase_if(sets, [&](const ProbedNet::Set& set) { return set.id != id; });
      return;
    }
  }

  /// Groups to which the criterion applies are done.
  static void keep_undecided(const Case& given, std::vector<ProbedNet::Set>& sets) {
    std::set<std::uint32_t> decided;
    for (const CircuitGroup& group : given.circuits->groups)
      if (group.applies())
        for (const std::uint32_t subsystem : group.subsystems)
          decided.insert(given.communication.structure->subsystems[subsystem].id);
    std::erase_if(sets, [&](const ProbedNet::Set& set) { return decided.contains(set.id); });
  }

  Result channels_flow() {
    Case& given = under(Assume::conditions);
    Result result = verdict(Verdict::unknown, by_circuits, not_allowed());
    std::vector<ProbedNet::Set> sets = given.probed.channels;
    if (may(Method::circuits) && given.circuits) {
      const std::vector<ChannelFlow>& channels = given.communication.structure->channels;
      std::set<std::uint32_t> clear, dry;
      for (const ChannelFlow& channel : channels) clear.insert(channel.id);
      for (const std::uint32_t channel : given.circuits->unclear) clear.erase(channels[channel].id);
      for (const std::uint32_t channel : given.circuits->dry) dry.insert(channels[channel].id);
      if (!dry.empty()) {
        std::erase_if(sets, [&](const ProbedNet::Set& set) { return !dry.contains(set.id); });
        result = verdict(Verdict::violated, by_circuits,
                         channels[given.circuits->dry.front()].name + " can run dry for ever");
      } else {
        std::erase_if(sets, [&](const ProbedNet::Set& set) { return clear.contains(set.id); });
        if (sets.empty()) return with_meaning(verdict(Verdict::holds, by_circuits), Sort::always_can);
      }
    }
    if (may(Method::exploration)) {
      const std::map<std::uint32_t, std::string> names = channel_names(given.abstract);
      result = by_sets(std::move(result), given, sets,
                       [&](std::uint32_t channel) { return names.at(channel) + " can run dry for ever"; });
    }
    return with_meaning(std::move(result), Sort::always_can);
  }

  static std::map<std::uint32_t, std::string> channel_names(const net::Net& net) {
    std::map<std::uint32_t, std::string> names;
    for (const net::Place& place : net.places())
      if (place.fused()) names.emplace(place.channel, place.name.substr(0, place.name.rfind('.')));
    return names;
  }

  Result by_circuit(const Case& given, Answer answer) const {
    Result result = verdict(Verdict::unknown, by_circuits, given.why_no_circuits());
    if (answer == Answer::yes) return verdict(Verdict::holds, by_circuits);
    if (answer == Answer::unknown) return result;
    result.verdict = Verdict::violated;
    for (const CircuitGroup& group : given.circuits->groups) {
      if (group.stuck.empty()) continue;
      result.why = in_words(*given.communication.structure, group);
      if (result.why.empty())
        result.why =
            given.communication.structure->subsystems[group.stuck.front()].name + " can get stuck for ever";
      break;
    }
    return result;
  }

  /// The sets that have to be possible again and again, by exploration. A verdict that another method gave
  /// stays, and only a run is looked for.
  Result by_sets(Result result, Case& given, const std::vector<ProbedNet::Set>& sets,
                 const std::function<std::string(std::uint32_t)>& complaint) {
    std::vector<std::vector<TransitionId>> transitions;
    for (const ProbedNet::Set& set : sets) transitions.push_back(set.any_of);
    const bool decided = result.verdict == Verdict::violated;
    const std::vector<Found> all =
        find_stuck(given.probed.net, transitions, safe_, limits(decided ? 0.3 : 1));
    const Found* worst = nullptr;
    std::size_t which = 0;
    for (std::size_t index = 0; index < all.size(); ++index) {
      const bool worse =
          all[index].kind == Found::Kind::no || (all[index].kind == Found::Kind::unknown && worst == nullptr);
      if (!worse) continue;
      worst = &all[index];
      which = index;
      if (all[index].kind == Found::Kind::no) break;
    }
    Found found;
    found.kind = Found::Kind::yes;
    if (!all.empty()) found = all.front();
    if (worst != nullptr) found = *worst;
    // Probes change nothing, and the net that is shown has none.
    std::erase_if(found.trace, [&](TransitionId id) { return id.value >= given.probed.transitions; });
    std::vector<std::uint32_t> who;
    if (worst != nullptr) {
      const TransitionId first = sets[which].any_of.front();
      who.push_back(given.probed.net[first].subsystem);
    }
    return show(std::move(result), found, Found::Kind::yes, given, who,
                worst == nullptr ? std::string() : complaint(sets[which].id));
  }

  Result show(Result result, const Found& found, Found::Kind good, const Case& given,
              const std::vector<std::uint32_t>& who, const std::string& complaint) const {
    result.states = found.states;
    result.explanation = found.explanation;
    const bool decided = result.verdict != Verdict::unknown;
    if (found.kind == Found::Kind::unknown) {
      if (decided) return result;
      result.why = result.why.empty() || result.why == not_allowed()
                       ? found.why
                       : found.why + " (and circuits: " + result.why + ")";
      result.method = by_exploration;
      return result;
    }
    if (!decided) {
      result.method = by_exploration;
      result.verdict = found.kind == good ? Verdict::holds : Verdict::violated;
      result.why = found.kind == good ? std::string() : complaint;
    }
    if (result.verdict == Verdict::violated && found.kind != good) {
      result.has_trace = true;
      result.trace = found.trace;
      result.waits = waits_after(given.abstract, found.trace, who);
    }
    return result;
  }

  Result live_behaviours() {
    Case& given = under(Assume::conditions);
    std::vector<PlaceId> open;
    for (std::uint32_t place = 0; place < given.abstract.places().size(); ++place)
      if (given.abstract.places()[place].operation.kind == net::Operation::Kind::transition_function)
        open.push_back({place});
    if (may(Method::circuits) && given.circuits) {
      if (const std::string unreachable = never_follows(given, open); !unreachable.empty())
        return with_meaning(
            verdict(Verdict::violated, by_structure, unreachable + " follows no behaviour that can run"),
            Sort::existential);
      drop_reached(given, open);
      if (open.empty()) return with_meaning(verdict(Verdict::holds, by_structure), Sort::existential);
    }
    if (!may(Method::exploration)) return verdict(Verdict::unknown, by_structure, given.why_no_circuits());
    return with_meaning(explore_behaviours(given, open), Sort::existential);
  }

  static std::string behaviour_of(const net::Net& net, PlaceId place) {
    return net[place].name.substr(0, net[place].name.rfind('.'));
  }

  static std::string never_follows(const Case& given, const std::vector<PlaceId>& places) {
    std::set<std::string> reached;
    for (const SubsystemFlow& subsystem : given.communication.structure->subsystems)
      for (const BehaviourFlow& behaviour : subsystem.behaviours) reached.insert(behaviour.name);
    for (const PlaceId place : places)
      if (const std::string name = behaviour_of(given.abstract, place); !reached.contains(name)) return name;
    return {};
  }

  /// A subsystem that always goes on comes to the end of every round, where everything that may follow can;
  /// and each starts with its first behaviour.
  static void drop_reached(const Case& given, std::vector<PlaceId>& open) {
    std::set<std::string> reached;
    const CommunicationStructure& structure = *given.communication.structure;
    for (const CircuitGroup& group : given.circuits->groups)
      for (const std::uint32_t subsystem : group.subsystems) {
        const SubsystemFlow& flow = structure.subsystems[subsystem];
        reached.insert(flow.behaviours.front().name);
        if (group.applies() && std::ranges::count(group.stuck, subsystem) == 0)
          for (const BehaviourFlow& behaviour : flow.behaviours) reached.insert(behaviour.name);
      }
    std::erase_if(open, [&](PlaceId place) { return reached.contains(behaviour_of(given.abstract, place)); });
  }

  Result explore_behaviours(const Case& given, const std::vector<PlaceId>& open) {
    Result result = verdict(Verdict::holds, by_exploration);
    const Budget budget{limits().time, Clock::now()};
    for (const PlaceId place : open) {
      explore::Limits left = limits();
      left.time = budget.left();
      const Found found = find_marking(given.abstract, Formula::marked(place), safe_, left);
      result.states += found.states;
      result.explanation = found.explanation;
      if (found.kind == Found::Kind::yes) continue;
      const bool never = found.kind == Found::Kind::no;
      result.verdict = never ? Verdict::violated : Verdict::unknown;
      result.why = behaviour_of(given.abstract, place) + (never ? " can never run" : ": " + found.why);
      if (never) return result;
    }
    return result;
  }

  struct Budget {
    Seconds time;
    Clock::time_point start;
    [[nodiscard]] Seconds left() const { return std::max(Seconds(0), time - Seconds(Clock::now() - start)); }
  };

  Result survives_exceptions() {
    Result result = deadlock_free(Assume::exceptions);
    if (result.verdict == Verdict::holds) {
      const std::uint64_t states = result.states;
      result = goes_on(Assume::exceptions);
      result.states += states;
    }
    result.warning = true;
    result.exceptions = true;
    return with_meaning(std::move(result), Sort::always_can);
  }

  enum class Sort : std::uint8_t { universal, completeness, always_can, existential };

  /// What a verdict on free choices says about a net whose conditions choose.
  static Result with_meaning(Result result, Sort sort) {
    const bool holds = result.verdict == Verdict::holds;
    if (result.verdict == Verdict::unknown) return result;
    if (!holds)
      result.meaning =
          sort == Sort::existential
              ? "this is so with conditions too"
              : "conditions may exclude the run: it is one only if they allow each of its choices";
    else if (sort == Sort::universal)
      result.meaning = "this is so with conditions too";
    else if (sort == Sort::completeness)
      result.meaning = "this is so with conditions too, as long as one holds wherever a choice is due";
    else if (sort == Sort::always_can)
      result.meaning = "this is so with conditions too, if every branch that is offered is taken eventually";
    else
      result.meaning = "conditions may still exclude what the net allows";
    return result;
  }

  const Subject& subject_;
  const ProveOptions& options_;
  Clock::time_point start_;
  std::vector<std::string> wrong_;  // mistakes in the invariants
  bool safe_ = false;
  std::optional<Case> conditions_, exceptions_;
  std::vector<TransitionId>
      possible_;          // of the net without what never fires: transitions of the abstract net
  std::string name_;      // of the property at hand
  std::size_t left_ = 1;  // properties that are not decided yet
};

}  // namespace

const std::vector<std::string>& default_properties() {
  static const std::vector<std::string> names{
      "safe",          "exclusive_channels", "deadlock_free",   "goes_on",
      "channels_flow", "sound_pages",        "live_behaviours", "survives_exceptions"};
  return names;
}

Report prove(const Subject& subject, const ProveOptions& options) {
  Report report;
  report.properties = Prover(subject, options).result();
  report.net_hash = hash_of(subject.net);
  report.verification_hash = hash_of_verification(subject.net, report);
  return report;
}

}  // namespace tessera::verify
