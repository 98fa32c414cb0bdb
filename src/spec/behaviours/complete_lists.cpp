#include "spec/behaviours/complete_lists.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "spec/conditions/known_truth.hpp"
#include "spec/conditions/memory_part.hpp"
#include "spec/conditions/quantified_part.hpp"
#include "spec/model/endings.hpp"
#include "spec/model/member.hpp"

namespace tessera::spec {
namespace {

using diagnostics::Diagnostics;
using diagnostics::in_quotes;

constexpr std::size_t most_answers = 4096;  // combinations that are looked at

bool has_word(const Expression& expression) {
  for (const char* word : {"memory", "fresh", "timed_out"})
    if (expression.text.find(word) != std::string::npos) return true;
  return false;
}

/// Something that is asked for: a buffer, or a memory cell.
struct Subject {
  enum class Kind : std::uint8_t { input, output, memory };
  Kind kind = Kind::memory;
  std::uint32_t number = 0;
  friend auto operator<=>(const Subject&, const Subject&) = default;
};

/// The outcomes of the last receive of an input.
enum Outcome : std::uint32_t { came, timed_out, neither };

/// One list `next`, with the answers to its questions.
class List {
 public:
  List(const Subsystem& subsystem, const Behaviour& behaviour)
      : subsystem_(subsystem), behaviour_(behaviour) {
    for (const Condition* condition : {&behaviour.terminal, &behaviour.error})
      for (const Expression& one : condition->expressions) find(one);
    for (const Next& next : behaviour.next)
      if (next.when.kind == When::Kind::expression) find(next.when.text);
    for (const auto& [subject, values] : possible_) {
      if (count_ * values.size() > most_answers) continue;
      asked_.push_back(subject);
      count_ *= values.size();
    }
  }

  /// Whether possibly no entry holds.
  bool is_incomplete() {
    for (std::size_t number = 0; number < count_; ++number) {
      std::size_t rest = number;
      for (const Subject& subject : asked_) {
        const std::vector<std::uint32_t>& values = possible_[subject];
        now_[subject] = values[rest % values.size()];
        rest /= values.size();
      }
      const Endings endings(
          behaviour_, [this](const Expression& one) { return truth(one); },
          [](const Next&) { return Truth::always; });  // counters that stop an entry: check_counters
      if (endings.none_possible(Ending::terminal)) return true;
    }
    return false;
  }

 private:
  using Asked = std::vector<std::pair<Subject, std::string>>;  // with "fresh" or "timed_out"

  void find(const Expression& expression) {
    if (!has_word(expression)) return;
    static_cast<void>(truth_of(expression.text, [&](std::span<const Token> part) {
      if (const auto memory = memory_part(part, subsystem_.memory, expression.member)) {
        std::vector<std::uint32_t>& values = possible_[{Subject::Kind::memory, memory->cell}];
        for (auto value = static_cast<std::uint32_t>(values.size()); value < memory->holds.size(); ++value)
          values.push_back(value);
      }
      for (const auto& [subject, status] : questions(part, expression.member))
        possible_[subject] = outcomes(subject);
      return Truth::free;
    }));
  }

  /// An invalid value, of a sender that has failed or never wrote, is neither fresh, nor has the wait timed out.
  static std::vector<std::uint32_t> outcomes(const Subject& subject) {
    if (subject.kind == Subject::Kind::output) return {came, timed_out};
    return {came, timed_out, neither};
  }

  [[nodiscard]] Asked questions(std::span<const Token> part, std::optional<std::uint32_t> member) const {
    Asked all;
    const auto add = [&](std::string_view owner, const std::string& name, std::string_view status) {
      const bool is_input = owner == "in";
      if ((!is_input && owner != "out") || (status != "timed_out" && (!is_input || status != "fresh")))
        return;
      const auto& buffers = is_input ? subsystem_.inputs : subsystem_.outputs;
      const auto found = std::ranges::find(buffers, name, &Field::name);
      if (found == buffers.end()) return;
      all.push_back({{is_input ? Subject::Kind::input : Subject::Kind::output,
                      static_cast<std::uint32_t>(found - buffers.begin())},
                     std::string(status)});
    };
    if (const auto quantified = quantified_part(part)) {
      for (const Field& field : quantified->owner == "in" ? subsystem_.inputs : subsystem_.outputs)
        if (field.member && field.member->family == quantified->family)
          add(quantified->owner, field.name, quantified->status);
      return all;
    }
    if ((part.size() != 5 && part.size() != 8) || !part[1].is(".") || !part[part.size() - 2].is("."))
      return all;
    std::string name(part[2].text);
    if (part.size() == 8) {
      const auto index = index_at_end(part.first(6), member);
      if (!index) return all;
      name = name_of_member(name, *index);
    }
    add(part[0].text, name, part.back().text);
    return all;
  }

  [[nodiscard]] std::optional<std::uint32_t> value(const Subject& subject) const {
    const auto found = now_.find(subject);
    return found == now_.end() ? std::nullopt : std::optional(found->second);
  }

  [[nodiscard]] Truth truth(const Expression& expression) const {
    if (const Truth constant = truth_of(expression); constant != Truth::free) return constant;
    if (!has_word(expression)) return Truth::free;
    return truth_of(expression.text, [&](std::span<const Token> part) {
      if (const auto memory = memory_part(part, subsystem_.memory, expression.member)) {
        const auto known = value({Subject::Kind::memory, memory->cell});
        return !known ? Truth::free : memory->holds[*known] ? Truth::always : Truth::never;
      }
      std::vector<Truth> answers;
      for (const auto& [subject, status] : questions(part, expression.member)) {
        const auto known = value(subject);
        const Outcome asked = status == "fresh" ? came : timed_out;
        answers.push_back(!known ? Truth::free : *known == asked ? Truth::always : Truth::never);
      }
      if (answers.empty()) return Truth::free;
      const auto quantified = quantified_part(part);
      return quantified ? quantified->truth(answers) : answers.front();
    });
  }

  const Subsystem& subsystem_;
  const Behaviour& behaviour_;
  std::map<Subject, std::vector<std::uint32_t>> possible_;
  std::vector<Subject> asked_;
  std::map<Subject, std::uint32_t> now_;
  std::size_t count_ = 1;
};

}  // namespace

bool asks_what_is_known(const Behaviour& behaviour) {
  return std::ranges::any_of(behaviour.next, [](const Next& next) {
    return next.when.kind == When::Kind::expression && has_word(next.when.text);
  });
}

void check_complete_lists(const Model& model, Diagnostics& out) {
  for (const Definition& definition : model.definitions)
    for (const Subsystem& subsystem : definition.subsystems)
      for (const Behaviour& behaviour : subsystem.behaviours) {
        // The members of a fleet have the same text.
        const bool is_other = behaviour.member && behaviour.member->number > 0;
        const bool has_written =
            std::ranges::any_of(behaviour.next, [](const Next& n) { return !n.implied; });
        if (is_other || !has_written || !asks_what_is_known(behaviour)) continue;
        if (!List(subsystem, behaviour).is_incomplete()) continue;
        const auto last = std::ranges::find_if(behaviour.next.rbegin(), behaviour.next.rend(),
                                               [](const Next& next) { return !next.implied; });
        out.warning(
            "W312", last->span,
            "behaviour " + in_quotes(behaviour.name) + " may end as terminal with no entry of 'next' to take",
            "end the list with an entry without 'when'");
      }
}

}  // namespace tessera::spec
