#include <array>

#include "layers/built_in.hpp"
#include "layers/sheet.hpp"

namespace tessera::layers {
namespace {

/// One channel of a snd or rcv page.
struct Block {
  spec::Index channel = 0;
  std::string name;
};

/// Blocks are named after their buffers; those of an output that feeds several channels are numbered.
std::vector<Block> blocks_of(const spec::Model& model, const std::vector<spec::Index>& channels,
                             const std::vector<spec::Field>& buffers, Direction direction) {
  std::vector<std::uint32_t> count(buffers.size(), 0), number(buffers.size(), 0);
  const auto buffer_of = [&](spec::Index channel) {
    return end_of(model.channels[channel], direction).buffer;
  };
  for (const spec::Index channel : channels) ++count[buffer_of(channel)];
  std::vector<Block> blocks;
  for (const spec::Index channel : channels) {
    const spec::Index buffer = buffer_of(channel);
    std::string name = buffers[buffer].name;
    if (count[buffer] > 1) name += "#" + std::to_string(++number[buffer]);
    blocks.push_back({channel, std::move(name)});
  }
  return blocks;
}

std::string in_words(spec::Duration duration) {
  constexpr std::array<std::pair<std::int64_t, const char*>, 3> units{
      {{1'000'000'000, " s"}, {1'000'000, " ms"}, {1'000, " us"}}};
  for (const auto& [nanoseconds, unit] : units)
    if (duration.count() % nanoseconds == 0) return std::to_string(duration.count() / nanoseconds) + unit;
  return std::to_string(duration.count()) + " ns";
}

/// Draws the blocks of one page.
class BlockPen {
 public:
  BlockPen(const Draft& draft, Sheet& sheet, Direction direction)
      : draft_(draft), sheet_(sheet), direction_(direction) {}

  /// Draws the side of the channel's model between the given input place and the output place it returns.
  std::uint32_t draw(const Block& block, std::uint32_t in, std::string out_name) {
    const spec::Channel& channel = draft_.model.channels[block.channel];
    const spec::CommunicationModel& model = model_of(draft_.model, channel);
    const spec::ModelSide& side = direction_ == Direction::send ? model.send : model.receive;
    const auto local = [&](const std::string& part) { return block.name + "." + part; };
    std::vector<std::uint32_t> nodes(side.places.size()), shared;
    for (std::size_t place = ModelSide::out + 1; place < side.places.size(); ++place)
      nodes[place] = sheet_.place(local(side.places[place].name), operation(side.places[place], block));
    nodes[ModelSide::in] = in;
    nodes[ModelSide::out] = sheet_.place(std::move(out_name));
    for (std::size_t place = 0; place < model.shared.size(); ++place)
      shared.push_back(sheet_.fused(local(model.shared[place].name), draft_.memory[block.channel][place]));
    for (const ModelSide::Transition& transition : side.transitions) {
      std::vector<std::uint32_t> from{nodes[transition.from]}, to{nodes[transition.to]};
      for (const std::uint32_t place : transition.takes) from.push_back(shared[place]);
      for (const std::uint32_t place : transition.gives) to.push_back(shared[place]);
      sheet_.transition(local(transition.name), std::move(from), std::move(to),
                        transition.elapsed ? elapsed(channel, block) : net::Condition{});
    }
    return nodes[ModelSide::out];
  }

 private:
  using ModelSide = spec::ModelSide;

  [[nodiscard]] net::Operation operation(const ModelSide::Place& place, const Block& block) const {
    if (place.slot == ModelSide::no_slot) return {};
    const auto kind =
        direction_ == Direction::send ? net::Operation::Kind::write : net::Operation::Kind::read;
    return {kind, block.channel, place.slot};
  }

  [[nodiscard]] net::Condition elapsed(const spec::Channel& channel, const Block& block) const {
    const auto timeout = direction_ == Direction::send ? channel.send_timeout : channel.receive_timeout;
    return {net::Condition::Kind::elapsed, net::Condition::Truth::free, block.channel, in_words(*timeout)};
  }

  const Draft& draft_;
  Sheet& sheet_;
  Direction direction_;
};

/// The output place of a block is the input place of the next.
net::PageId draw_chain(Sheet& sheet, BlockPen& pen, const std::vector<Block>& blocks) {
  const std::uint32_t in = sheet.place("in");
  std::uint32_t at = in;
  for (const Block& block : blocks)
    at = pen.draw(block, at, &block == &blocks.back() ? "out" : block.name + ".out");
  return sheet.finish(in, at);
}

net::PageId draw_side_by_side(Sheet& sheet, BlockPen& pen, const std::vector<Block>& blocks) {
  const std::uint32_t in = sheet.place("in");
  std::vector<std::uint32_t> starts, ends;
  for (const Block& block : blocks) {
    starts.push_back(sheet.place(block.name + ".in"));
    ends.push_back(pen.draw(block, starts.back(), block.name + ".out"));
  }
  const std::uint32_t out = sheet.place("out");
  sheet.transition("fork", {in}, starts);
  sheet.transition("join", ends, {out});
  return sheet.finish(in, out);
}

net::PageId draw_nothing(Sheet& sheet) {
  const std::uint32_t in = sheet.place("in");
  const std::uint32_t out = sheet.place("out");
  sheet.transition("t1", {in}, {out});
  return sheet.finish(in, out);
}

}  // namespace

/// Layer 5, communication (paper, sec. IV-E): the snd or rcv page of a behaviour, one block per channel it
/// uses.
net::PageId draw_communication(Draft& draft, net::PageId parent, spec::Index instance,
                               const spec::Behaviour& behaviour, Direction direction) {
  const bool sends = direction == Direction::send;
  Sheet sheet(draft, parent, net::Layer::communication, sends ? "snd" : "rcv", instance, behaviour.span);
  const spec::Subsystem& subsystem = draft.model.subsystem(instance);
  const std::vector<Block> blocks = blocks_of(draft.model, draft.wiring.used(instance, behaviour, direction),
                                              sends ? subsystem.outputs : subsystem.inputs, direction);
  if (blocks.empty()) return draw_nothing(sheet);
  BlockPen pen(draft, sheet, direction);
  if (behaviour.transfer == spec::Transfer::parallel && blocks.size() > 1)
    return draw_side_by_side(sheet, pen, blocks);
  return draw_chain(sheet, pen, blocks);
}

}  // namespace tessera::layers
