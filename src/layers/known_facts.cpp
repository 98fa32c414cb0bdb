#include "layers/known_facts.hpp"

#include <algorithm>

#include "layers/built_in.hpp"
#include "layers/sheet.hpp"
#include "spec/conditions/memory_part.hpp"
#include "spec/conditions/quantified_part.hpp"
#include "spec/model/member.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {
namespace {

using spec::Token;
using FactKind = net::Parts::Fact::Kind;

/// Calls `visit` with every expression of the conditions of a subsystem.
template <class Visit>
void each_expression(const spec::Subsystem& subsystem, Visit visit) {
  for (const spec::Behaviour& behaviour : subsystem.behaviours) {
    for (const spec::Condition* condition : {&behaviour.terminal, &behaviour.error})
      for (const spec::Expression& expression : condition->expressions) visit(expression);
    for (const spec::Next& next : behaviour.next)
      if (next.when.kind == spec::When::Kind::expression) visit(next.when.text);
    for (const spec::Skippable& output : behaviour.skippable)
      for (const spec::Expression& expression : output.when.expressions) visit(expression);
  }
}

/// Most expressions ask for no fact; they are not cut into tokens.
bool may_ask(const spec::Expression& expression) {
  return expression.text.find("memory") != std::string::npos ||
         expression.text.find("fresh") != std::string::npos ||
         expression.text.find("timed_out") != std::string::npos;
}

/// Visits the parts of an expression.
template <class Visit>
void each_part(const spec::Expression& expression, Visit visit) {
  if (!may_ask(expression)) return;
  static_cast<void>(spec::truth_of(expression.text, [&](std::span<const Token> part) {
    visit(part);
    return spec::Truth::free;
  }));
}

using Index = std::optional<std::uint32_t>;

/// "grant" for "in.grant.fresh", "grant[2]" for "in.grant[i].fresh" with member 2, if it is of that form.
std::string buffer_in(std::span<const Token> part, std::string_view owner, std::string_view status,
                      Index member) {
  const bool fits = (part.size() == 5 || part.size() == 8) && part[0].is(owner) && part[1].is(".") &&
                    part[part.size() - 2].is(".") && part.back().is(status) &&
                    part[2].kind == Token::Kind::name;
  if (!fits) return {};
  if (part.size() == 5) return std::string(part[2].text);
  const Index number = spec::index_at_end(part.first(6), member);
  return number ? spec::name_of_member(std::string(part[2].text), *number) : std::string();
}

/// A number that no buffer has, if the name is none.
std::uint32_t number_in(const std::unordered_map<std::string, std::uint32_t>& buffers,
                        const std::string& name) {
  const auto found = buffers.find(name);
  return found == buffers.end() ? static_cast<std::uint32_t>(buffers.size()) : found->second;
}

/// The names of the buffers that the part asks for; none: there are more than the net looks at.
std::vector<std::string> members_of(const spec::Subsystem& subsystem, const spec::QuantifiedPart& part) {
  std::vector<std::string> names;
  for (const spec::Field& field : part.owner == "in" ? subsystem.inputs : subsystem.outputs) {
    if (!field.member || field.member->family != part.family) continue;
    if (field.member->count > KnownFacts::most_members) return {};
    names.push_back(field.name);
  }
  return names;
}

}  // namespace

/// The inputs and outputs whose outcome a part asks for.
struct AskedBuffers {
  std::string fresh, late_input, late_output;
  AskedBuffers(std::span<const Token> part, Index member)
      : fresh(buffer_in(part, "in", "fresh", member)),
        late_input(buffer_in(part, "in", "timed_out", member)),
        late_output(buffer_in(part, "out", "timed_out", member)) {}
  /// name: of the buffer of one member.
  AskedBuffers(const spec::QuantifiedPart& part, const std::string& name) {
    if (part.owner == "in" && part.status == "fresh") fresh = name;
    if (part.owner == "in" && part.status == "timed_out") late_input = name;
    if (part.owner == "out" && part.status == "timed_out") late_output = name;
  }
};

KnownFacts::KnownFacts(const spec::Model& model, const Wiring& wiring, net::SubsystemId subsystem,
                       net::HierarchicalNet& net)
    : model_(model),
      id_(subsystem),
      subsystem_(model.subsystem(subsystem)),
      net_(net),
      first_{static_cast<std::uint32_t>(net.parts.facts.size())} {
  list_buffers();
  const Asked wanted = asked();
  find(wiring, Direction::receive, wanted.inputs);
  find(wiring, Direction::send, wanted.outputs);
  find_memory();
}

void KnownFacts::list_buffers() {
  for (const spec::BufferId id : subsystem_.inputs.ids())
    inputs_.emplace(subsystem_.inputs[id].name, id.value);
  for (const spec::BufferId id : subsystem_.outputs.ids())
    outputs_.emplace(subsystem_.outputs[id].name, id.value);
}

KnownFacts::Asked KnownFacts::asked() const {
  Asked found{std::vector<bool>(subsystem_.inputs.size() + 1),
              std::vector<bool>(subsystem_.outputs.size() + 1)};
  each_expression(subsystem_, [&](const spec::Expression& expression) {
    each_part(expression, [&](std::span<const Token> part) {
      const auto add = [&](const AskedBuffers& asks) {
        for (const std::string& input : {asks.fresh, asks.late_input})
          if (!input.empty()) found.inputs[number_in(inputs_, input)] = true;
        if (!asks.late_output.empty()) found.outputs[number_in(outputs_, asks.late_output)] = true;
      };
      if (const auto quantified = spec::quantified_part(part))
        for (const std::string& name : members_of(subsystem_, *quantified))
          add(AskedBuffers(*quantified, name));
      else
        add(AskedBuffers(part, expression.member));
    });
  });
  asked_by_properties(found);
  return found;
}

/// robot.control.grant.fresh, robot.control.request.timed_out
void KnownFacts::asked_by_properties(Asked& found) const {
  std::string path;
  const auto ask = [&](const spec::Statement& statement, const auto& self) -> void {
    const std::vector<spec::PathPart>& parts = statement.path.parts;
    if (statement.kind == spec::Statement::Kind::token && parts.size() == 3 && !statement.to) {
      const bool fresh = parts[2].name == spec::fresh_in_paths,
                 late = parts[2].name == spec::timed_out_in_paths;
      if (!fresh && !late) return;
      if (path.empty()) path = model_.instance_path(id_);
      if (path != statement.path.agent + "." + parts[0].name) return;
      if (fresh) found.inputs[number_in(inputs_, parts[1].name)] = true;
      if (late) found.outputs[number_in(outputs_, parts[1].name)] = true;
    }
    for (const spec::Statement& part : statement.parts) self(part, self);
  };
  for (const spec::Property& property : model_.properties) {
    const auto says = [&](std::string_view word) { return property.text.find(word) != std::string::npos; };
    if (!says(spec::fresh_in_paths) && !says(spec::timed_out_in_paths)) continue;
    for (const spec::Claim& claim : property.claims) {
      ask(claim.what, ask);
      if (claim.then) ask(*claim.then, ask);
    }
  }
}

/// Whether the net tells how that side of the channel ends.
bool KnownFacts::is_known(const spec::Channel& channel, Direction direction) const {
  if (channel.model.valid()) return false;
  if (direction == Direction::send) return channel.send == spec::Mode::blocking && channel.send_timeout;
  if (channel.receive == spec::Mode::blocking_once) return false;
  return channel.send != spec::Mode::non_blocking || channel.receive != spec::Mode::non_blocking;
}

void KnownFacts::find(const Wiring& wiring, Direction direction, const std::vector<bool>& asked) {
  const bool sends = direction == Direction::send;
  const auto& buffers = sends ? subsystem_.outputs : subsystem_.inputs;
  if (std::ranges::none_of(asked, [](bool one) { return one; })) return;
  std::vector<std::vector<spec::ChannelId>> of_buffer(buffers.size());
  for (const spec::ChannelId channel : model_.channels.ids())
    if (const spec::ChannelEnd& end = end_of(model_.channels[channel], direction); end.instance == id_)
      of_buffer[end.buffer.value].push_back(channel);
  std::vector<std::vector<spec::ChannelId>> used;  // per behaviour, sorted
  for (const spec::Behaviour& behaviour : subsystem_.behaviours) {
    used.push_back(wiring.used(id_, behaviour, direction));
    std::ranges::sort(used.back());
  }
  for (std::uint32_t number = 0; number < buffers.size(); ++number) {
    if (!asked[number]) continue;
    Fact fact{.kind = sends ? FactKind::sent : FactKind::received, .subject = number};
    bool own_model = false;
    for (const spec::ChannelId channel : of_buffer[number]) {
      own_model = own_model || model_.channels[channel].model.valid();
      if (is_known(model_.channels[channel], direction)) fact.channels.push_back(channel);
    }
    if (own_model || fact.channels.empty()) continue;
    for (const std::vector<spec::ChannelId>& channels : used)
      fact.set_in.push_back(std::ranges::binary_search(channels, fact.channels.front()));
    const net::Span span = model_.channels[fact.channels.front()].span;
    using Names = std::vector<std::string>;
    add(std::move(fact), buffers[spec::BufferId{number}].name,
        sends ? Names{std::string(words::in_time), std::string(words::timed_out)}
              : Names{std::string(words::came), std::string(words::missed)},
        span);
  }
}

void KnownFacts::add(Fact fact, const std::string& name, std::vector<std::string> values, net::Span span) {
  fact.first = {static_cast<std::uint32_t>(net_.fusions.size())};
  const net::FactId id{static_cast<std::uint32_t>(net_.parts.facts.size())};
  // At the start nothing is fresh, and nothing has timed out.
  const std::uint32_t initial = fact.kind == FactKind::memory ? subsystem_.memory[fact.subject].few->initial
                                : fact.kind == FactKind::received ? failed
                                                                  : succeeded;
  for (std::uint32_t value = 0; value < values.size(); ++value)
    net_.fusions.push_back({.name = net_.parts[id_].path + "." + name + "." + values[value],
                            .tokens = value == initial ? 1U : 0U,
                            .span = span,
                            .role = PlaceRole::fact,
                            .fact = id,
                            .value = value});
  by_subject_.at(static_cast<std::size_t>(fact.kind)).emplace(fact.subject, id);
  net_.parts.facts.push_back({fact.kind, id_, fact.subject, name, std::move(values)});
  facts_.push_back(std::move(fact));
}

std::string KnownFacts::name_of(net::FactId fact, std::uint32_t value) const {
  return net_.parts[fact].name + "." + net_.parts[fact].values[value];
}

net::FactId KnownFacts::set_by(net::ChannelId channel, Direction direction) const {
  const FactKind kind = direction == Direction::send ? FactKind::sent : FactKind::received;
  for (std::uint32_t number = 0; number < facts_.size(); ++number)
    if (facts_[number].kind == kind &&
        std::ranges::find(facts_[number].channels, channel) != facts_[number].channels.end())
      return {first_.value + number};
  return {};
}

KnownFacts::Question KnownFacts::question_of(const AskedBuffers& asks) const {
  for (const std::string& input : {asks.fresh, asks.late_input})
    if (!input.empty()) return {fact_of(FactKind::received, number_in(inputs_, input)), !asks.fresh.empty()};
  if (!asks.late_output.empty())
    return {fact_of(FactKind::sent, number_in(outputs_, asks.late_output)), false};
  return {};
}

std::vector<KnownFacts::Question> KnownFacts::questions_of(std::span<const Token> part, Index member) const {
  std::vector<Question> all;
  if (const auto quantified = spec::quantified_part(part)) {
    for (const std::string& name : members_of(subsystem_, *quantified))
      all.push_back(question_of(AskedBuffers(*quantified, name)));
    return all;
  }
  all.push_back(question_of(AskedBuffers(part, member)));
  if (!all.front().fact.valid()) all.front() = memory_in(part, member);
  return all;
}

std::vector<KnownFacts::Values> KnownFacts::assignments(const Expressions& expressions,
                                                        spec::BehaviourId behaviour,
                                                        const std::vector<const spec::Next*>& counted,
                                                        const Expressions& last) const {
  std::vector<Values> all{{}};
  if (facts_.empty()) return all;
  std::vector<net::FactId> asked;
  const auto ask = [&](const spec::Expression* expression) {
    each_part(*expression, [&](std::span<const Token> part) {
      for (const Question& question : questions_of(part, expression->member))
        if (question.fact.valid() && std::ranges::find(asked, question.fact) == asked.end())
          asked.push_back(question.fact);
    });
  };
  std::ranges::for_each(expressions, ask);
  for (const spec::Next* entry : counted)
    for (const spec::Change& change : entry->sets) {
      const net::FactId fact = fact_of(FactKind::memory, change.cell);
      if (change.step != 0 && std::ranges::find(asked, fact) == asked.end()) asked.push_back(fact);
    }
  std::ranges::for_each(last, ask);
  std::size_t count = 1, kept = 0;
  while (kept < asked.size() && count * values_in(asked[kept], behaviour).size() <= most_assignments)
    count *= values_in(asked[kept++], behaviour).size();
  asked.resize(kept);
  std::ranges::sort(asked);
  for (const net::FactId fact : asked) {
    const std::vector<std::uint32_t> values = values_in(fact, behaviour);
    std::vector<Values> more;
    for (const Values& before : all)
      for (const std::uint32_t value : values) more.emplace_back(before).emplace_back(fact, value);
    all = std::move(more);
  }
  return all;
}

spec::Truth KnownFacts::answer(const Question& question, spec::BehaviourId behaviour, const Values& values,
                               bool failures) const {
  const auto known = std::ranges::find(values, question.fact, &Values::value_type::first);
  if (!question.fact.valid() || known == values.end()) return spec::Truth::free;
  const Fact& fact = of(question.fact);
  if (fact.kind == FactKind::memory)
    return question.holds[known->second] ? spec::Truth::always : spec::Truth::never;
  const bool success = known->second == succeeded;
  if (question.fresh)
    return !success ? spec::Truth::never : failures ? spec::Truth::free : spec::Truth::always;
  if (success) return spec::Truth::never;
  if (fact.kind == FactKind::sent) return spec::Truth::always;
  // Nothing has been received yet, or the receive ended without a value.
  if (model_.channels[fact.channels.front()].receive == spec::Mode::non_blocking) return spec::Truth::never;
  return fact.set_in[behaviour.value] ? spec::Truth::always : spec::Truth::free;
}

spec::TruthOf KnownFacts::truths(spec::BehaviourId behaviour, const Values& values, bool failures) const {
  return [this, behaviour, values, failures](const spec::Expression& expression) {
    const spec::Truth constant = spec::truth_of(expression);
    if (constant != spec::Truth::free || values.empty() || !may_ask(expression)) return constant;
    return spec::truth_of(expression.text, [&](std::span<const Token> part) {
      std::vector<spec::Truth> answers;
      for (const Question& question : questions_of(part, expression.member))
        answers.push_back(answer(question, behaviour, values, failures));
      if (answers.empty()) return spec::Truth::free;
      const auto quantified = spec::quantified_part(part);
      return quantified ? quantified->truth(answers) : answers.front();
    });
  };
}

void FactPen::draw(const std::string& name, const KnownFacts::Values& reads, const KnownFacts::Values& sets,
                   const Draw& draw) const {
  std::vector<KnownFacts::Values> befores{reads};
  for (const auto& [fact, given] : sets) {
    if (std::ranges::find(reads, fact, &KnownFacts::Values::value_type::first) != reads.end()) continue;
    std::vector<KnownFacts::Values> more;
    for (const KnownFacts::Values& before : befores)
      for (std::uint32_t value = 0; value < facts_.value_count(fact); ++value)
        more.emplace_back(before).emplace_back(fact, value);
    befores = std::move(more);
  }
  const auto node = [&](net::FactId fact, std::uint32_t value) {
    return sheet_.member(facts_.name_of(fact, value), facts_.place_of(fact, value));
  };
  for (KnownFacts::Values& before : befores) {
    std::ranges::sort(before);
    std::string full = name;
    Nodes inputs, outputs;
    for (const auto& [fact, value] : before) {
      full += "." + facts_.name_of(fact, value);
      const auto set = std::ranges::find(sets, fact, &KnownFacts::Values::value_type::first);
      inputs.push_back(node(fact, value));
      outputs.push_back(node(fact, set != sets.end() ? set->second : value));
    }
    draw(full, inputs, outputs);
  }
}

}  // namespace tessera::layers
