#include <algorithm>
#include <numeric>
#include <utility>

#include "explore/budget.hpp"
#include "verify/answering.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/communication/free_net.hpp"
#include "verify/counterexample/fitting_endings.hpp"
#include "verify/counterexample/tidy_run.hpp"
#include "verify/deciders/decider.hpp"
#include "verify/deciders/free_answers.hpp"
#include "verify/hashes.hpp"
#include "verify/meaning.hpp"
#include "verify/verify.hpp"

namespace tessera::verify {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// A property as questions, all of which have to be answered with yes.
struct Property {
  std::string name;
  Sort sort = Sort::universal;
  std::vector<Question::Kind> questions;
  Assume assume = Assume::conditions;
  bool of_any_net = false;                ///< also of one that is not made of the five layers
  const net::Property* author = nullptr;  ///< of a property of the author
};

const std::vector<Property>& defaults() {
  static const std::vector<Property> all{
      {.name = "safe", .questions = {Question::Kind::safe}, .of_any_net = true},
      {.name = "exclusive_channels", .questions = {Question::Kind::exclusive_channels}},
      {.name = "deadlock_free",
       .sort = Sort::completeness,
       .questions = {Question::Kind::deadlock_free},
       .of_any_net = true},
      {.name = "goes_on", .sort = Sort::always_can, .questions = {Question::Kind::goes_on}},
      {.name = "channels_flow", .sort = Sort::always_can, .questions = {Question::Kind::channels_flow}},
      {.name = "sound_pages", .questions = {Question::Kind::sound_pages}},
      {.name = "live_behaviours", .sort = Sort::existential, .questions = {Question::Kind::live_behaviours}},
      {.name = "survives_exceptions",
       .sort = Sort::always_can,
       .questions = {Question::Kind::deadlock_free, Question::Kind::goes_on},
       .assume = Assume::exceptions},
      {.name = "survives_partition",
       .sort = Sort::always_can,
       .questions = {Question::Kind::goes_on, Question::Kind::deadlock_free},
       .assume = Assume::partition},
  };
  return all;
}

Sort sort_of(net::Property::Kind kind) {
  switch (kind) {
    case net::Property::Kind::never:
    case net::Property::Kind::always:
      return Sort::universal;
    case net::Property::Kind::reachable:
      return Sort::existential;
    case net::Property::Kind::always_reachable:
      return Sort::always_can;
    case net::Property::Kind::leads_to:
      return Sort::follows;
  }
  return Sort::universal;
}

Property of_author(const net::Property& property) {
  return {.name = property.name,
          .sort = sort_of(property.kind),
          .questions = {Question::Kind::claims},
          .author = &property};
}

/// Is the property violated by where a run ends, whatever came before?
bool shown_by_end(const Subject& subject, const PropertyResult& result) {
  const auto author = std::ranges::find(subject.properties, result.name, &net::Property::name);
  return author == subject.properties.end() || author->kind != net::Property::Kind::leads_to;
}

class Prover {
 public:
  Prover(const Subject& subject, const ProveOptions& options)
      : options_(options),
        start_(Clock::now()),
        budget_({.time = options.time, .stop = options.stop}),
        facts_(subject, options.rules),
        free_(free_net(subject.net, subject.invariants)) {
    if (!free_) return;
    free_subject_.emplace(Subject{free_->net, subject.pages, free_->invariants, subject.properties});
    free_facts_.emplace(*free_subject_, options.rules);
  }

  std::vector<PropertyResult> results() {
    std::vector<Property> wanted = defaults();
    for (const net::Property& property : facts_.subject().properties) wanted.push_back(of_author(property));
    std::erase_if(wanted, [&](const Property& property) { return !asked_for(property); });
    left_ = wanted.size();
    std::vector<PropertyResult> results;
    Clock::time_point before = start_;  // checking the invariants counts for the first property
    for (const Property& property : wanted) {
      results.push_back(judge(property));
      const Clock::time_point after = Clock::now();
      results.back().seconds = Seconds(after - before).count();
      before = after;
      --left_;
    }
    return results;
  }

 private:
  [[nodiscard]] bool asked_for(const Property& property) const {
    const bool named = options_.only.empty() || std::ranges::count(options_.only, property.name) > 0;
    if (property.assume == Assume::partition && !is_deployed(facts_.subject().net)) return false;
    return named && (facts_.subject().pages != nullptr || property.of_any_net);
  }

  PropertyResult judge(const Property& property) {
    PropertyResult result;
    std::uint64_t states = 0;
    for (const Question::Kind kind : property.questions) {
      result = kind == Question::Kind::live_behaviours
                   ? live_behaviours(question(property, kind), property.name)
                   : answer(question(property, kind), property.name);
      states += result.states;
      if (result.verdict != Verdict::holds) break;
      if (kind != Question::Kind::deadlock_free) continue;
      facts_.exclude_dead_ends(property.assume);
    }
    result.name = property.name;
    if (property.author != nullptr) result.asks = property.author->text;
    result.states = states;
    result.exceptions = property.assume == Assume::exceptions;
    result.partition = property.assume == Assume::partition;
    result.warning = result.exceptions || result.partition;
    result.meaning = meaning_of(result.verdict, property.sort);
    make_readable(result);
    return result;
  }

  Question question(const Property& property, Question::Kind kind) {
    if (property.author == nullptr) return {kind, property.assume, facts_.subjects(kind, property.assume)};
    std::vector<std::uint32_t> claims(property.author->claims.size());
    std::iota(claims.begin(), claims.end(), 0U);
    return {kind, property.assume, std::move(claims), property.author};
  }

  /// Whether behaviours run, and which of them do not.
  struct Running {
    PropertyResult result;
    std::vector<std::uint32_t> dead;  ///< certainly
    std::vector<std::uint32_t> open;  ///< it is not known
  };

  /// A method may know of some behaviours only that they never run: then the others are asked about.
  Running running(Question question, const std::string& name) {
    Running found;
    while (true) {
      std::vector<std::uint32_t> dead;
      PropertyResult result = answer(question, name, &dead);
      if (result.verdict != Verdict::violated) {
        if (result.verdict == Verdict::unknown) found.open = question.subjects;
        if (found.dead.empty())
          found.result = std::move(result);
        else
          found.result.states += result.states;
        break;
      }
      if (found.dead.empty()) found.result = std::move(result);
      found.dead.insert(found.dead.end(), dead.begin(), dead.end());
      std::erase_if(question.subjects,
                    [&](std::uint32_t place) { return std::ranges::count(dead, place) > 0; });
      if (dead.empty() || question.subjects.empty()) break;
    }
    std::ranges::sort(found.dead);
    return found;
  }

  /// A behaviour that does not run without a failure may still be reached after one, and may be meant for
  /// that.
  PropertyResult live_behaviours(Question question, const std::string& name) {
    Running by_itself = running(question, name);
    if (by_itself.result.verdict == Verdict::holds) return std::move(by_itself.result);
    question.assume = Assume::exceptions;
    question.subjects = by_itself.dead;
    question.subjects.insert(question.subjects.end(), by_itself.open.begin(), by_itself.open.end());
    std::ranges::sort(question.subjects);
    Running failing = running(std::move(question), name);
    PropertyResult result = std::move(failing.result);
    result.states += by_itself.result.states;
    const bool holds = result.verdict == Verdict::holds;
    for (const std::uint32_t place : holds ? by_itself.dead : failing.dead)
      result.behaviours.push_back(behaviour_at(facts_.subject().net, place));
    if (holds && !result.behaviours.empty())
      result.why = named(result.behaviours, "is reachable only after a failure",
                         "behaviours are reachable only after a failure");
    if (!holds && failing.dead.size() > 1)
      result.why = named(result.behaviours, "can never run", "behaviours can never run");
    return result;
  }

  static PropertyResult::Behaviour behaviour_at(const net::Net& net, std::uint32_t place) {
    const diagnostics::Sources& sources = net.parts().sources;
    const std::uint32_t line = net.places()[place].span.line;
    return {behaviour_of(net, {place}), sources.own_line(line), sources.included_line(line)};
  }

  static std::string named(const std::vector<PropertyResult::Behaviour>& behaviours, const std::string& one,
                           const std::string& several) {
    constexpr std::size_t shown = 20;
    const auto with_line = [](const PropertyResult::Behaviour& behaviour) {
      const std::string own = "line " + std::to_string(behaviour.line);
      return behaviour.path + " (" + (behaviour.included.empty() ? own : behaviour.included) + ")";
    };
    if (behaviours.size() == 1) return with_line(behaviours.front()) + " " + one;
    std::string text = std::to_string(behaviours.size()) + " " + several + ": ";
    for (std::size_t index = 0; index < std::min(shown, behaviours.size()); ++index)
      text += (index > 0 ? ", " : "") + with_line(behaviours[index]);
    if (behaviours.size() > shown) text += " and " + std::to_string(behaviours.size() - shown) + " more";
    return text;
  }

  /// If subsystems know something, an answer about the net without that is tried first, since quick methods
  /// apply to it; it is the answer if it carries over. A search is made on the net itself, and only if that has no
  /// answer also on the other one.
  /// to_blame: if given, the subjects that a violation is about.
  PropertyResult answer(const Question& question, const std::string& name,
                        std::vector<std::uint32_t>* to_blame = nullptr) {
    if (!free_facts_) return answer(question, name, facts_, Searches::all, to_blame);
    if (std::optional<PropertyResult> quick = answer_of_free(question, name, Searches::none, to_blame))
      return *std::move(quick);
    PropertyResult exact = answer(question, name, facts_, Searches::all, to_blame);
    if (exact.verdict != Verdict::unknown) return exact;
    std::optional<PropertyResult> searched = answer_of_free(question, name, Searches::all, to_blame);
    return searched ? *std::move(searched) : std::move(exact);
  }

  enum class Searches : std::uint8_t { none, all };

  /// The answer about the net without facts; nullopt: it does not carry over.
  std::optional<PropertyResult> answer_of_free(const Question& question, const std::string& name,
                                               Searches searches, std::vector<std::uint32_t>* to_blame) {
    if (question.property != nullptr && asks_facts(facts_.subject().net, *question.property))
      return std::nullopt;
    std::vector<std::uint32_t> blamed;
    PropertyResult result = answer(question, name, *free_facts_, searches, &blamed);
    if (result.verdict == Verdict::unknown) return std::nullopt;
    if (result.verdict == Verdict::holds && !carries_over(question, *free_facts_, facts_.subject().net))
      return std::nullopt;
    if (result.verdict == Verdict::violated && has_runs(question)) {
      if (!result.has_trace) return std::nullopt;
      auto run = lifted(free_facts_->under(question.assume).abstract, facts_.under(question.assume).abstract,
                        result.trace);
      if (!run) return std::nullopt;
      result.trace = *std::move(run);
    }
    if (to_blame != nullptr) *to_blame = std::move(blamed);
    return result;
  }

  PropertyResult answer(Question question, const std::string& name, Facts& facts, Searches searches,
                        std::vector<std::uint32_t>* to_blame) {
    Answering answering(std::move(question));
    for (const auto& decider : portfolio()) {
      const bool allowed = (options_.method.empty() ? decider->suits(facts.subject().net)
                                                    : options_.method == decider->name()) &&
                           (searches == Searches::all || !decider->finds_runs());
      if (!allowed || !answering.wants(*decider)) continue;
      if (budget_.stopped() || (decider->searches() && budget_.spent())) {
        give_up(answering, *decider);
        continue;
      }
      const explore::Limits limits =
          answering.only_run() ? limits_for_run(name, answering.question().assume) : limits_for(name);
      const explore::Budget budget(limits);
      try {
        if (std::optional<Finding> finding = decider->decide(answering.question(), facts, limits))
          answering.hear(std::move(*finding), *decider);
      } catch (const explore::CutOff& cut) {
        answering.hear({.why = cut.what(), .subjects = answering.question().subjects}, *decider);
      }
      if (answering.lacks_run() && decider->finds_runs() && budget.spent())
        answering.cut_off(reason() + ": no run is shown");
    }
    if (to_blame != nullptr) *to_blame = answering.question().subjects;
    return std::move(answering).result();
  }

  /// The reason why the work as a whole has ended.
  [[nodiscard]] std::string reason() const {
    return budget_.stopped() ? "it was interrupted" : "the time limit is reached";
  }

  /// The decider is not asked any more.
  void give_up(Answering& answering, const Decider& decider) const {
    if (answering.lacks_run()) return answering.cut_off(reason() + ": no run is shown");
    if (answering.only_run()) return;
    answering.hear({.why = reason(), .subjects = answering.question().subjects}, decider);
  }

  /// A run that is easy to follow.
  void make_readable(PropertyResult& result) {
    const Subject& subject = facts_.subject();
    if (!result.has_trace || subject.pages == nullptr) return;
    const net::Net& net = facts_.under(assumed_by(result)).abstract;
    try {
      if (shown_by_end(subject, result)) result.trace = tidy(net, result.trace, budget_);
    } catch (const explore::CutOff& cut) {
      if (result.cut_off.empty()) result.cut_off = std::string(cut.what()) + ": the run is not shortened";
    }
    result.trace = with_fitting_endings(net, std::move(result.trace));
  }

  /// For a violation that is decided: the effort for its run is limited by steps, so that it does not depend on
  /// the machine. A cut link is easy to imagine, so the run that shows it is worth little effort.
  [[nodiscard]] explore::Limits limits_for_run(const std::string& name, Assume assume) const {
    constexpr std::uint64_t most = 300'000, fewest = 2'000, work = 600'000'000, most_of_cut = 30'000;
    explore::Limits limits = limits_for(name);
    // In a large net each marking is more work.
    const std::size_t transitions = std::max<std::size_t>(facts_.subject().net.transitions().size(), 1);
    limits.markings =
        std::clamp(work / transitions, fewest, assume == Assume::partition ? most_of_cut : most);
    limits.bytes /= 4;
    return limits;
  }

  /// The time that is left is shared among the properties that are left.
  [[nodiscard]] explore::Limits limits_for(const std::string& name) const {
    explore::Limits limits;
    const Seconds left = options_.time - Seconds(Clock::now() - start_);
    limits.time = std::max(Seconds(0), left / static_cast<double>(std::max<std::size_t>(left_, 1)));
    limits.bytes = options_.bytes;
    limits.stop = options_.stop;
    if (options_.progress)
      limits.progress = [this, &name](const explore::Progress& progress) {
        options_.progress(name, progress);
      };
    return limits;
  }

  const ProveOptions& options_;
  Clock::time_point start_;
  explore::Budget budget_;  // for all of it
  Facts facts_;
  std::optional<FreeNet> free_;  // if some subsystem knows something
  std::optional<Subject> free_subject_;
  std::optional<Facts> free_facts_;
  std::size_t left_ = 1;  // properties that are not decided yet
};

}  // namespace

Assume assumed_by(const PropertyResult& property) {
  if (property.partition) return Assume::partition;
  return property.exceptions ? Assume::exceptions : Assume::conditions;
}

std::vector<std::string> default_properties_of(const net::Net& net) {
  std::vector<std::string> names;
  for (const Property& property : defaults())
    if (property.assume != Assume::partition || is_deployed(net)) names.push_back(property.name);
  return names;
}

const std::vector<std::string>& default_properties() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Property& property : defaults()) all.push_back(property.name);
    return all;
  }();
  return names;
}

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& decider : portfolio()) all.emplace_back(decider->name());
    return all;
  }();
  return names;
}

Report prove(const Subject& subject, const ProveOptions& options) {
  Report report;
  report.properties = Prover(subject, options).results();
  report.net_hash = hash_of(subject.net);
  std::vector<std::string> names;
  for (const PropertyResult& property : report.properties) {
    if (property.asks.empty()) names.push_back(property.name);
  }
  report.verification_hash = verification_hash(subject, names);
  return report;
}

}  // namespace tessera::verify
