#include <array>

#include "layers/built_in.hpp"
#include "layers/condition_truth.hpp"
#include "layers/sheet.hpp"
#include "tessera/goal_life.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {
namespace {

/// One channel of a snd or rcv page.
struct Block {
  net::ChannelId channel;
  std::string name;
  const spec::Skippable* skippable = nullptr;  ///< whether an iteration may skip it
  net::BlockId id{};
};

/// Blocks are named after their buffers; those of an output that feeds several channels are numbered.
std::vector<Block> blocks_of(const spec::Model& model, const std::vector<spec::ChannelId>& channels,
                             const Numbered<spec::BufferId, spec::Field>& buffers,
                             const spec::Behaviour& behaviour, Direction direction) {
  Numbered<spec::BufferId, std::uint32_t> count(buffers.size(), 0), number(buffers.size(), 0);
  const auto buffer_of = [&](spec::ChannelId channel) {
    return end_of(model.channels[channel], direction).buffer;
  };
  for (const spec::ChannelId channel : channels) ++count[buffer_of(channel)];
  std::vector<Block> blocks;
  for (const spec::ChannelId channel : channels) {
    const spec::BufferId buffer = buffer_of(channel);
    std::string name = buffers[buffer].name;
    if (count[buffer] > 1) name += "#" + std::to_string(++number[buffer]);
    const bool sends = direction == Direction::send;
    blocks.push_back({channel, std::move(name), sends ? behaviour.skips(buffer) : nullptr});
  }
  return blocks;
}

/// Numbers the blocks of a page.
void enlist(std::vector<Block>& blocks, net::Parts& parts, net::SubsystemId subsystem,
            net::BehaviourId behaviour, Direction direction) {
  for (Block& block : blocks) {
    block.id = {static_cast<std::uint32_t>(parts.blocks.size())};
    parts.blocks.push_back({subsystem, behaviour, block.channel, direction == Direction::send, block.name});
  }
}

std::string in_words(spec::Duration duration) {
  constexpr std::array<std::pair<std::int64_t, const char*>, 3> units{
      {{1'000'000'000, " s"}, {1'000'000, " ms"}, {1'000, " us"}}};
  for (const auto& [nanoseconds, unit] : units)
    if (duration.count() % nanoseconds == 0) return std::to_string(duration.count() / nanoseconds) + unit;
  return std::to_string(duration.count()) + " ns";
}

/// "memory.ask", "asking or late".
std::string text_of(const spec::Skippable& skippable) {
  std::string text;
  for (const spec::Expression& expression : skippable.when.expressions)
    text += (text.empty() ? "" : " or ") + (expression.name.empty() ? expression.text : expression.name);
  return text;
}

/// Whether a block is begun or skipped with certain values of the facts that its condition asks for.
struct Choice {
  KnownFacts::Values values;
  net::Condition sends, skips;
};

/// A state of a goal, and one that a receive may tell of then.
struct Told {
  KnownFacts::Values before, after;
  std::string name;  ///< of the state after it, if it is another one
};

/// The states of a goal in which it may be told to be, for each state before. fact: invalid: no goal is told of.
std::vector<Told> told_of(net::FactId fact) {
  if (!fact.valid()) return {{}};
  std::vector<Told> all;
  for (std::uint32_t before = 0; before < goal_state_count; ++before)
    for (std::uint32_t after = 0; after < goal_state_count; ++after) {
      if (!can_follow(GoalState{static_cast<std::uint8_t>(before)},
                      GoalState{static_cast<std::uint8_t>(after)}))
        continue;
      all.push_back({{{fact, before}}, {{fact, after}}, {}});
      if (after != before) all.back().name = '.' + std::string(goal_state_names.at(after));
    }
  return all;
}

/// Draws the blocks of one page.
class BlockPen {
 public:
  BlockPen(const Draft& draft, Sheet& sheet, net::SubsystemId subsystem, spec::BehaviourId behaviour,
           Direction direction)
      : draft_(draft),
        facts_(draft.facts[subsystem]),
        sheet_(sheet),
        behaviour_(behaviour),
        direction_(direction) {}

  /// Draws the side of the channel's model between the given input place and the output place it returns.
  std::uint32_t draw(const Block& block, std::uint32_t in, std::string_view out_name, PlaceRole out_role) {
    sheet_.in_block(block.id);
    const spec::Channel& channel = draft_.model.channels[block.channel];
    const spec::CommunicationModel& model = model_of(draft_.model, channel);
    const spec::ModelSide& side = direction_ == Direction::send ? model.send : model.receive;
    const auto local = [&](const std::string& part) { return block.name + "." + part; };
    std::vector<std::uint32_t> nodes(side.places.size()), shared;
    for (std::size_t place = ModelSide::out + 1; place < side.places.size(); ++place)
      nodes[place] = sheet_.place(local(side.places[place].name), operation(side.places[place], block),
                                  role_of(side.places[place]));
    nodes[ModelSide::in] = in;
    nodes[ModelSide::out] = sheet_.place(out_name, {}, out_role);
    for (std::size_t place = 0; place < model.shared.size(); ++place)
      shared.push_back(sheet_.fused(local(model.shared[place].name), draft_.memory[block.channel][place]));
    const std::vector<Choice> choices = choices_of(block);
    for (const Choice& choice : choices)
      if (choice.skips.known(true).truth != net::Condition::Truth::never) draw_skip(block, choice, nodes);
    for (const ModelSide::Transition& transition : side.transitions) {
      std::vector<std::uint32_t> from{nodes[transition.from]}, to{nodes[transition.to]};
      for (const std::uint32_t place : transition.takes) from.push_back(shared[place]);
      for (const std::uint32_t place : transition.gives) to.push_back(shared[place]);
      const std::vector<Told> told = told_of(goal_told_by(side, transition, block));
      const auto draw = [&](const KnownFacts::Values& reads, const net::Condition& condition) {
        for (const Told& one : told)
          FactPen(sheet_, facts_)
              .draw(local(transition.name), both(reads, one.before),
                    both(outcome(side, transition, block), one.after),
                    [&](const std::string& name, const Nodes& inputs, const Nodes& outputs) {
                      sheet_.transition(name + one.name, joined(from, inputs), joined(to, outputs), condition)
                          .role = role_of(transition);
                    });
      };
      if (choices.empty() || transition.from != ModelSide::in) {
        draw({}, transition.elapsed ? elapsed(channel, block) : net::Condition{});
        continue;
      }
      for (const Choice& choice : choices)
        if (choice.sends.known(true).truth != net::Condition::Truth::never) draw(choice.values, choice.sends);
    }
    sheet_.in_block({});
    return nodes[ModelSide::out];
  }

 private:
  using ModelSide = spec::ModelSide;
  using Nodes = std::vector<std::uint32_t>;

  /// Empty: every iteration sends.
  [[nodiscard]] std::vector<Choice> choices_of(const Block& block) const {
    if (block.skippable == nullptr) return {};
    KnownFacts::Expressions asked;
    for (const spec::Expression& expression : block.skippable->when.expressions) asked.push_back(&expression);
    std::vector<Choice> choices;
    for (KnownFacts::Values& values : facts_.assignments(asked, behaviour_)) {
      const auto sends = [&](bool failures) {
        if (block.skippable->by_function) return net::Condition::Truth::free;
        return truth(spec::truth_of(block.skippable->when, facts_.truths(behaviour_, values, failures)));
      };
      const auto made = [&](net::Condition::Kind kind, bool positive, std::string text) {
        net::Condition condition{.kind = kind, .text = std::move(text)};
        condition.truth = positive ? sends(false) : negation(sends(false));
        condition.set_with_failures({positive ? sends(true) : negation(sends(true)), condition.exhaustive});
        return condition;
      };
      const bool by_function = block.skippable->by_function;
      const std::string text = by_function ? "not skipped" : text_of(*block.skippable);
      net::Condition goes = made(net::Condition::Kind::send, true, text);
      net::Condition skips =
          made(net::Condition::Kind::skip, false, by_function ? "skipped" : "not (" + text + ")");
      choices.push_back({std::move(values), std::move(goes), std::move(skips)});
    }
    return choices;
  }

  /// Nothing is sent: the token passes the block without a look at the channel. A send that was skipped has not
  /// timed out.
  void draw_skip(const Block& block, const Choice& choice, const Nodes& nodes) {
    const net::FactId fact = facts_.set_by(block.channel, direction_);
    KnownFacts::Values sets;
    if (fact.valid()) sets.emplace_back(fact, KnownFacts::succeeded);
    FactPen(sheet_, facts_)
        .draw(block.name + "." + std::string(words::skip), choice.values, sets,
              [&](const std::string& name, const Nodes& inputs, const Nodes& outputs) {
                net::PageTransition& made =
                    sheet_.transition(name, joined({nodes[ModelSide::in]}, inputs),
                                      joined({nodes[ModelSide::out]}, outputs), choice.skips);
                made.role = Step::skip;
                made.span = block.skippable->span;
              });
  }

  static Nodes joined(Nodes nodes, const Nodes& more) {
    nodes.insert(nodes.end(), more.begin(), more.end());
    return nodes;
  }

  /// The facts after a transition that ends the block: whether a value was taken, or acknowledged in time.
  [[nodiscard]] KnownFacts::Values outcome(const ModelSide& side, const ModelSide::Transition& transition,
                                           const Block& block) const {
    const net::FactId fact = facts_.set_by(block.channel, direction_);
    if (!fact.valid() || transition.to != ModelSide::out) return {};
    const bool success =
        direction_ == Direction::send ? !transition.elapsed : side.places[transition.from].slot.has_value();
    return {{fact, success ? KnownFacts::succeeded : KnownFacts::failed}};
  }

  static KnownFacts::Values both(KnownFacts::Values values, const KnownFacts::Values& more) {
    values.insert(values.end(), more.begin(), more.end());
    return values;
  }

  /// The memory of the goal that a transition behind a read value changes as the value tells; invalid: of none.
  [[nodiscard]] net::FactId goal_told_by(const ModelSide& side, const ModelSide::Transition& transition,
                                         const Block& block) const {
    if (direction_ == Direction::send || transition.elapsed || !side.places[transition.from].slot) return {};
    return facts_.goal_told_by(block.channel);
  }

  [[nodiscard]] net::Operation operation(const ModelSide::Place& place, const Block& block) const {
    if (!place.slot) return {};
    const auto kind =
        direction_ == Direction::send ? net::Operation::Kind::write : net::Operation::Kind::read;
    return {.kind = kind, .channel = block.channel, .slot = *place.slot};
  }

  [[nodiscard]] net::Condition elapsed(const spec::Channel& channel, const Block& block) const {
    const auto timeout = direction_ == Direction::send ? channel.send_timeout : channel.receive_timeout;
    return {.kind = net::Condition::Kind::elapsed,
            .truth = net::Condition::Truth::free,
            .channel = block.channel,
            .text = in_words(*timeout)};
  }

  const Draft& draft_;
  const KnownFacts& facts_;
  Sheet& sheet_;
  spec::BehaviourId behaviour_;
  Direction direction_;
};

/// The output place of a block is the input place of the next.
net::PageId draw_chain(Sheet& sheet, BlockPen& pen, const std::vector<Block>& blocks) {
  const std::uint32_t in = sheet.input();
  std::uint32_t at = in;
  for (const Block& block : blocks) {
    const bool last = &block == &blocks.back();
    at =
        pen.draw(block, at, last ? std::string(words::output) : block.name + "." + std::string(words::output),
                 last ? PlaceRole::output : PlaceRole::none);
  }
  return sheet.finish(in, at);
}

net::PageId draw_side_by_side(Sheet& sheet, BlockPen& pen, const std::vector<Block>& blocks) {
  const std::uint32_t in = sheet.input();
  std::vector<std::uint32_t> starts, ends;
  for (const Block& block : blocks) {
    starts.push_back(sheet.place(block.name + "." + std::string(words::input)));
    ends.push_back(
        pen.draw(block, starts.back(), block.name + "." + std::string(words::output), PlaceRole::none));
  }
  const std::uint32_t out = sheet.output();
  sheet.transition(words::fork, {in}, starts).role = Step::page;
  sheet.transition(words::join, ends, {out}).role = Step::page;
  return sheet.finish(in, out);
}

net::PageId draw_nothing(Sheet& sheet) {
  const std::uint32_t in = sheet.input();
  const std::uint32_t out = sheet.output();
  sheet.transition(words::pass, {in}, {out}).role = Step::page;
  return sheet.finish(in, out);
}

}  // namespace

/// Layer 5, communication (paper, sec. IV-E): the snd or rcv page of a behaviour, one block per
/// channel it uses.
net::PageId draw_communication(Draft& draft, net::PageId parent, net::SubsystemId id,
                               net::BehaviourId behaviour_id, Direction direction) {
  const bool sends = direction == Direction::send;
  const spec::Subsystem& subsystem = draft.model.subsystem(id);
  const spec::Behaviour& behaviour = subsystem.behaviours[behaviour_id];
  Sheet sheet(draft, parent, net::Layer::communication,
              std::string(sends ? words::send_page : words::receive_page), id, behaviour.span);
  sheet.drawn().behaviour = behaviour_id;
  std::vector<Block> blocks = blocks_of(draft.model, draft.wiring.used(id, behaviour, direction),
                                        sends ? subsystem.outputs : subsystem.inputs, behaviour, direction);
  if (blocks.empty()) return draw_nothing(sheet);
  enlist(blocks, draft.net.parts, id, behaviour_id, direction);
  BlockPen pen(draft, sheet, id, behaviour_id, direction);
  if (behaviour.transfer == spec::Transfer::parallel && blocks.size() > 1)
    return draw_side_by_side(sheet, pen, blocks);
  return draw_chain(sheet, pen, blocks);
}

}  // namespace tessera::layers
