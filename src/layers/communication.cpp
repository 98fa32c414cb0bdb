#include <array>

#include "layers/sheet.hpp"

namespace tessera::layers {
namespace {

using spec::Mode;

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

  /// Returns the output place, which is the last to be drawn of those that are the page's own.
  std::uint32_t draw(const Block& block, std::uint32_t in, std::string out_name) {
    block_ = &block;
    in_ = in;
    const spec::Channel& channel = draft_.model.channels[block.channel];
    const bool sends = direction_ == Direction::send;
    work_ = sheet_.place(local("2"),
                         {sends ? net::Operation::Kind::write : net::Operation::Kind::read, block.channel});
    if (sends && channel.send == Mode::blocking) wait_ = sheet_.place(local("wait"));
    out_ = sheet_.place(std::move(out_name));
    const ChannelPlaces& memory = draft_.memory[block.channel];
    if (memory.channel.valid())
      exchange(memory);
    else
      hand_over(channel, memory);
    return out_;
  }

 private:
  /// Both sides non-blocking, the paper's fully asynchronous model.
  void exchange(const ChannelPlaces& memory) {
    const std::uint32_t free = sheet_.fused(local("channel"), memory.channel);
    sheet_.transition(local("t1"), {in_, free}, {work_});
    sheet_.transition(local("t2"), {work_}, {out_, free});
  }

  void hand_over(const spec::Channel& channel, const ChannelPlaces& memory) {
    empty_ = sheet_.fused(local("empty"), memory.empty);
    full_ = sheet_.fused(local("full"), memory.full);
    if (memory.ack.valid()) ack_ = sheet_.fused(local("ack"), memory.ack);
    if (direction_ == Direction::receive)
      receive(channel);
    else if (channel.send == Mode::blocking)
      send_and_wait(channel);
    else
      send_or_overwrite();
  }

  void send_or_overwrite() {
    sheet_.transition(local("t1"), {in_, empty_}, {work_});
    sheet_.transition(local("t1o"), {in_, full_}, {work_});
    sheet_.transition(local("t2"), {work_}, {out_, full_});
  }

  void send_and_wait(const spec::Channel& channel) {
    sheet_.transition(local("t1"), {in_, empty_}, {work_});
    sheet_.transition(local("t2"), {work_}, {wait_, full_});
    sheet_.transition(local("t3"), {wait_, ack_}, {out_});
    if (channel.send_timeout)
      sheet_.transition(local("timeout"), {wait_, full_}, {out_, empty_}, elapsed(*channel.send_timeout));
  }

  void receive(const spec::Channel& channel) {
    sheet_.transition(local("t1"), {in_, full_}, {work_});
    std::vector<std::uint32_t> released{out_, empty_};
    if (channel.send == Mode::blocking) released.push_back(ack_);
    sheet_.transition(local("t2"), {work_}, std::move(released));
    if (channel.receive == Mode::non_blocking)
      sheet_.transition(local("skip"), {in_, empty_}, {out_, empty_});
    else if (channel.receive_timeout)
      sheet_.transition(local("timeout"), {in_, empty_}, {out_, empty_}, elapsed(*channel.receive_timeout));
  }

  [[nodiscard]] net::Condition elapsed(spec::Duration timeout) const {
    return {net::Condition::Kind::elapsed, net::Condition::Truth::free, block_->channel, in_words(timeout)};
  }

  [[nodiscard]] std::string local(const char* part) const { return block_->name + "." + part; }

  const Draft& draft_;
  Sheet& sheet_;
  Direction direction_;
  // Of the block at hand:
  const Block* block_ = nullptr;
  std::uint32_t in_ = 0, work_ = 0, wait_ = 0, out_ = 0;
  std::uint32_t empty_ = 0, full_ = 0, ack_ = 0;
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
