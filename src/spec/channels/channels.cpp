#include "spec/channels/channels.hpp"

#include <algorithm>

#include "diagnostics/utf8.hpp"
#include "spec/channels/channel_ends.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* channel_hint =
    "write AGENT.SUBSYSTEM.OUTPUT -> AGENT.SUBSYSTEM.INPUT, or a map { from, to, send, receive, model, "
    "timeout }";

/// A type without its unit.
Type bare(Type type) {
  type.unit.clear();
  return type;
}

bool is_usual(SubsystemKind from, SubsystemKind to, bool same_agent) {
  if (from == SubsystemKind::control && to == SubsystemKind::control) return !same_agent;
  if (!same_agent) return false;
  return (from == SubsystemKind::receptor && to == SubsystemKind::control) ||
         (from == SubsystemKind::control && to == SubsystemKind::effector);
}

class ChannelReader {
 public:
  ChannelReader(const Types& types, const AgentGroups& groups, CommunicationModels& models, Model& model,
                Diagnostics& out)
      : types_(types), lookup_(model, groups), models_(models), model_(model), out_(out) {}

  void read(const Entry& section) {
    for (const Node* item : items_of(*section.value, section.span, "channels", out_)) {
      if (item->is_map()) {
        read_map(*item);
      } else {
        read_arrow(*item, section.span);
      }
    }
  }

  WiringExcuses take_excuses() { return std::move(excuses_); }

 private:
  void read_arrow(const Node& item, Span at) {
    const Node* text = text_of(item, at, "a channel", out_, channel_hint);
    const std::size_t arrow = text == nullptr ? std::string::npos : text->text.find("->");
    if (arrow == std::string::npos || text->text.find("->", arrow + 2) != std::string::npos) {
      if (text != nullptr) out_.error("E112", text->span, "a channel needs one '->'", channel_hint);
      excuse_all();
      return;
    }
    const auto from = split_part(*text, 0, arrow);
    const auto to = split_part(*text, arrow + 2, text->text.size());
    Channel channel;
    channel.span = text->span;
    join(from, to, channel);
  }

  void read_map(const Node& item) {
    const Section section(
        item, item.span, "a channel",
        {"from", "to", "send", "receive", "model", "timeout", "send_timeout", "receive_timeout"}, out_);
    const auto from = read_path(section, "from");
    const auto to = read_path(section, "to");
    Channel channel;
    channel.span = from ? from->whole : item.span;
    if (const Entry* model = section.find("model")) {
      read_model(section, *model, channel);
    } else {
      channel.send = read_mode(section.find("send"), {"non_blocking", "blocking"});
      channel.receive = read_mode(section.find("receive"), {"non_blocking", "blocking", "blocking_once"});
      check_modes(section, channel);
      read_timeouts(section, channel);
    }
    join(from, to, channel);
  }

  std::optional<BufferPath> read_path(const Section& section, std::string_view key) {
    const Entry* entry = section.require(key, channel_hint);
    const Node* text =
        entry == nullptr ? nullptr : text_of(*entry->value, entry->span, in_quotes(key), out_, channel_hint);
    return text == nullptr ? std::nullopt : split_part(*text, 0, text->text.size());
  }

  /// The path in [begin, end) of a text, without surrounding blanks.
  std::optional<BufferPath> split_part(const Node& text, std::size_t begin, std::size_t end) {
    while (begin < end && text.text[begin] == ' ') ++begin;
    while (begin < end && text.text[end - 1] == ' ') --end;
    return split_path(text, begin, end - begin, out_);
  }

  /// words: of the modes, in the order of the enumerators.
  Mode read_mode(const Entry* entry, const std::vector<std::string>& words) {
    if (entry == nullptr) return Mode::non_blocking;
    std::string all = words.back();
    for (std::size_t left = words.size() - 1; left-- > 0;)
      all = words[left] + (left + 2 == words.size() ? " or " : ", ") + all;
    const Node* text = text_of(*entry->value, entry->span, in_quotes(entry->key), out_, "write " + all);
    if (text == nullptr) return Mode::non_blocking;
    const auto found = std::ranges::find(words, text->text);
    if (found != words.end()) return static_cast<Mode>(found - words.begin());
    Hint hint = did_you_mean(text->text, {words[0], words[1]});  // the usual ones first
    if (hint.text.empty()) hint = did_you_mean(text->text, words);
    if (text->text == "first" || text->text == "last")
      hint = "'receive: " + text->text + "' belongs to a subsystem, beside 'rate'";
    out_.error("E104", text->span,
               in_quotes(entry->key) + " must be " + all + ", not " + in_quotes(text->text), hint);
    return Mode::blocking;
  }

  void check_modes(const Section& section, const Channel& channel) {
    if (channel.receive != Mode::blocking_once || channel.send != Mode::blocking) return;
    out_.error("E241", section.find("send")->span, "'send: blocking' beside 'receive: blocking_once'",
               "a value that may be read again is never taken: leave out 'send', or write receive: blocking");
  }

  void read_model(const Section& section, const Entry& entry, Channel& channel) {
    for (const std::string_view key : {"send", "receive"})
      if (const Entry* mode = section.find(key))
        out_.error("E309", mode->span, in_quotes(key) + " beside 'model'",
                   "the model says how both sides wait");
    const Node* name = text_of(*entry.value, entry.span, "'model'", out_, "the name of an entry of 'models'");
    if (name == nullptr) return;
    channel.model = models_.find(*name, out_);
    if (channel.model.valid()) read_timeouts_of_model(section, *name, channel);
  }

  /// Reads a timeout for every side that has a transition for it, and for no other.
  void read_timeouts_of_model(const Section& section, const Node& name, Channel& channel) {
    const CommunicationModel& model = model_.models[channel.model];
    const bool sends = model.send.has_timeout(), receives = model.receive.has_timeout();
    const auto refuse = [&](std::string_view key, bool has, const std::string& who) {
      const Entry* entry = section.find(key);
      if (entry != nullptr && !has)
        out_.error("E306", entry->span,
                   in_quotes(key) + " where " + who + " of model " + in_quotes(name.text) + " waits for it",
                   "write it at a transition as when: elapsed");
    };
    refuse("timeout", sends || receives, "no side");
    refuse("send_timeout", sends, "no transition of 'send'");
    refuse("receive_timeout", receives, "no transition of 'receive'");
    const auto both = read_timeout(section, "timeout");
    const auto send = read_timeout(section, "send_timeout");
    const auto receive = read_timeout(section, "receive_timeout");
    const auto require = [&](bool has, const std::string& side) {
      if (!has || section.find("timeout") != nullptr || section.find(side + "_timeout") != nullptr) return;
      out_.error("E309", name.span,
                 in_quotes(side) + " of model " + in_quotes(name.text) + " needs a timeout",
                 "write timeout: 200 ms, or " + side + "_timeout: 200 ms");
    };
    require(sends, "send");
    require(receives, "receive");
    if (sends) channel.send_timeout = send ? send : both;
    if (receives) channel.receive_timeout = receive ? receive : both;
  }

  std::optional<Duration> read_timeout(const Section& section, std::string_view key) {
    const Entry* entry = section.find(key);
    return entry == nullptr ? std::nullopt
                            : read_duration(*entry->value, entry->span, std::string(key), out_);
  }

  void read_timeouts(const Section& section, Channel& channel) {
    const auto needs_blocking = [&](std::string_view key, bool blocks, const std::string& problem) {
      const Entry* entry = section.find(key);
      if (entry == nullptr || blocks) return;
      out_.error("E306", entry->span, in_quotes(key) + " where " + problem,
                 "a side that does not block never waits; write " +
                     std::string(key == "send_timeout" ? "send" : "receive") + ": blocking");
    };
    const bool sends = channel.send == Mode::blocking;
    const bool receives = channel.receive != Mode::non_blocking;
    needs_blocking("timeout", sends || receives, "neither side blocks");
    needs_blocking("send_timeout", sends, "the sender does not block");
    needs_blocking("receive_timeout", receives, "the receiver does not block");
    const auto both = read_timeout(section, "timeout");
    const auto send = read_timeout(section, "send_timeout");
    const auto receive = read_timeout(section, "receive_timeout");
    if (sends) channel.send_timeout = send ? send : both;
    if (receives) channel.receive_timeout = receive ? receive : both;
  }

  void excuse_all() { excuses_.everything = excuses_.outputs = true; }

  /// One end, looked up. is_output: the end that channels begin at.
  std::optional<WrittenEnd> find_end(const std::optional<BufferPath>& path, bool is_output, KnownUpTo& known,
                                     PathTarget& target) {
    if (!path) return std::nullopt;
    const bool good = lookup_.find(*path, target, known, out_);
    if (known != KnownUpTo::subsystem) return std::nullopt;
    const Subsystem& subsystem = lookup_.subsystem(target);
    const auto buffer = lookup_.find_buffer(*path, target, is_output ? subsystem.outputs : subsystem.inputs,
                                            is_output ? "output" : "input", out_);
    if (!good || !buffer.valid()) return std::nullopt;
    const auto& buffers = is_output ? subsystem.outputs : subsystem.inputs;
    return WrittenEnd{*path, target, buffer, buffers[buffer].member};
  }

  /// A mistake in a channel must not also count as an input without source.
  void excuse(const std::optional<WrittenEnd>& to, KnownUpTo known, const PathTarget& target) {
    excuses_.outputs = true;
    if (known == KnownUpTo::nothing) {
      excuses_.everything = true;
      return;
    }
    if (!target.group->definition.valid()) return;
    for (std::uint32_t number = 0; number < target.group->count; ++number) {
      if (known == KnownUpTo::agent) {
        excuses_.agents.insert(target.group->agent(number));
      } else if (to) {
        const std::uint32_t members = to->family ? to->family->count : 1;
        for (std::uint32_t member = 0; member < members; ++member)
          excuses_.inputs.emplace(lookup_.instance(target, number), BufferId{to->buffer.value + member});
      } else {
        excuses_.instances.insert(lookup_.instance(target, number));
      }
    }
  }

  void join(const std::optional<BufferPath>& from_path, const std::optional<BufferPath>& to_path,
            const Channel& channel) {
    KnownUpTo from_known = KnownUpTo::nothing;
    KnownUpTo to_known = KnownUpTo::nothing;
    PathTarget from_target;
    PathTarget to_target;
    const auto from = find_end(from_path, true, from_known, from_target);
    const auto to = find_end(to_path, false, to_known, to_target);
    ChannelExpansion expansion;
    if (!from || !to || !expand_channel(*from, *to, expansion, out_)) {
      excuse(to, to_known, to_target);
      return;
    }
    check_types(*from, *to);
    for (const ExpandedEnd& dropped : expansion.dropped)
      excuses_.inputs.emplace(lookup_.instance(to->target, dropped.agent), dropped.buffer);
    for (const auto& [source, target] : expansion.pairs) {
      Channel one = channel;
      one.from = {lookup_.instance(from->target, source.agent), source.buffer};
      one.to = {lookup_.instance(to->target, target.agent), target.buffer};
      if (!add(one, to->path)) return;
    }
  }

  void check_types(const WrittenEnd& from, const WrittenEnd& to) {
    const Field& output = lookup_.subsystem(from.target).outputs[from.buffer];
    const Field& input = lookup_.subsystem(to.target).inputs[to.buffer];
    if (Types::is_unknown(output.type) || Types::is_unknown(input.type)) return;
    const std::string both = types_.spelled(output.type) + " -> " + types_.spelled(input.type);
    const std::string where = "the output is declared on " + out_.words(output.span.line) +
                              ", the input on " + out_.words(input.span.line);
    if (bare(output.type) != bare(input.type)) {
      out_.error("E207", to.path.whole, "the ends of this channel differ in type: " + both, where);
    } else if (output.type.unit != input.type.unit && !output.type.unit.empty() && !input.type.unit.empty()) {
      out_.error("E208", to.path.whole, "the ends of this channel differ in unit: " + both, where);
    }
  }

  /// Returns false if the rest of the statement need not be checked.
  bool add(const Channel& channel, const BufferPath& to) {
    const auto key = std::pair(channel.to.instance, channel.to.buffer);
    const auto [source, added] = sources_.emplace(key, model_.channels.next_id());
    if (!added) {
      const Channel& first = model_.channels[source->second];
      const std::string name = model_.instance_path(channel.to.instance) + "." +
                               model_.subsystem(channel.to.instance).inputs[channel.to.buffer].name;
      out_.error("E301", to.whole,
                 "input " + in_quotes(name) + " has two sources: " + source_name(first) + " and " +
                     source_name(channel),
                 first.span.line == channel.span.line ? hint_for_fleet(channel, name)
                                                      : "the first is on " + out_.words(first.span.line));
      return false;
    }
    check_direction(channel);
    model_.channels.push_back(channel);
    return true;
  }

  /// How an input gets a value from each member of a fleet.
  std::string hint_for_fleet(const Channel& channel, const std::string& input) const {
    const std::string& sender = model_.agents[model_.instances[channel.from.instance].agent].path;
    const std::string fleet = sender.substr(0, sender.find('['));
    return "an input has one source; for a value of each " + fleet + ", add [each " + fleet +
           "] to its type, and write " + input + "[i] in the channel";
  }

  std::string source_name(const Channel& channel) const {
    return model_.instance_path(channel.from.instance) + "." +
           model_.subsystem(channel.from.instance).outputs[channel.from.buffer].name;
  }

  void check_direction(const Channel& channel) {
    const SubsystemKind from = model_.subsystem(channel.from.instance).kind;
    const SubsystemKind to = model_.subsystem(channel.to.instance).kind;
    const bool same =
        model_.instances[channel.from.instance].agent == model_.instances[channel.to.instance].agent;
    if (is_usual(from, to, same)) return;
    out_.warning("W310", channel.span,
                 "a channel from " + std::string(name_of(from)) + " to " + std::string(name_of(to)) + " of " +
                     (same ? "the same agent" : "another agent") + " is unusual",
                 "usual are receptor -> control -> effector of one agent, and control -> control of two");
  }

  const Types& types_;
  PathLookup lookup_;
  CommunicationModels& models_;
  Model& model_;
  Diagnostics& out_;
  WiringExcuses excuses_;
  std::map<std::pair<InstanceId, BufferId>, ChannelId> sources_;  ///< by the input
};

}  // namespace

WiringExcuses read_channels(const Entry* entry, const Types& types, const AgentGroups& groups,
                            CommunicationModels& models, Model& model, Diagnostics& out) {
  if (entry == nullptr) return {};
  ChannelReader reader(types, groups, models, model, out);
  reader.read(*entry);
  return reader.take_excuses();
}

}  // namespace tessera::spec
