#include "layers/net_paths.hpp"

#include <algorithm>
#include <string_view>

#include "diagnostics/utf8.hpp"
#include "tessera/nearest.hpp"
#include "tessera/net_words.hpp"

namespace tessera::layers {
namespace {

using diagnostics::Diagnostics;
using diagnostics::in_quotes;
using net::PageId;
using net::PlaceId;
using Found = std::optional<net::Statement>;

net::Statement marked(PlaceId place) {
  net::Statement statement;
  statement.places = {place};
  return statement;
}

const char* what_is_in(net::Layer layer) {
  switch (layer) {
    case net::Layer::system:
      return "agent";
    case net::Layer::agent:
      return "subsystem";
    case net::Layer::subsystem:
      return "behaviour or buffer";
    case net::Layer::behaviour:
    case net::Layer::communication:
      return "place";
  }
  return "place";
}

/// "motion.2" of the parts from the given one on.
std::string joined(const std::vector<spec::PathPart>& parts, std::size_t from) {
  std::string text;
  for (std::size_t part = from; part < parts.size(); ++part)
    text += (part > from ? "." : "") + parts[part].name;
  return text;
}

}  // namespace

NetPaths::NetPaths(const spec::Model& model, const net::HierarchicalNet& pages, const net::Net& net)
    : model_(model),
      pages_(pages),
      own_(pages.pages.size()),
      below_(pages.pages.size()),
      channels_(model.instances.size()) {
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    const net::Place& place = net.places()[index];
    places_.emplace(place.name, PlaceId{index});
    if (place.page.valid()) own_[place.page.value].push_back({index});
  }
  for (std::uint32_t index = 0; index < pages.pages.size(); ++index) {
    const net::Page& page = pages.pages[index];
    if (!page.parent.valid()) continue;
    below_[page.parent.value].push_back({index});
    if (page.layer == net::Layer::agent) agents_.emplace(page.name, PageId{index});
  }
  for (const net::ChannelId id : model.channels.ids()) {
    const spec::Channel& channel = model.channels[id];
    channels_[channel.from.instance].push_back(id);
    if (channel.to.instance != channel.from.instance) channels_[channel.to.instance].push_back(id);
  }
}

Found NetPaths::find(const spec::Statement& token, Diagnostics& out) const {
  if (token.to) return of_channel(token.path, *token.to, out);
  if (const PageId owner = owner_of_memory(token); owner.valid()) return of_memory(owner, token, out);
  if (token.compared) {
    out.error("E114", token.compared->at, "only a memory cell is compared",
              "for example dock.control.memory.lent_to == nobody; a path alone says that a token is there");
    return std::nullopt;
  }
  const auto agent = agents_.find(token.path.agent);
  if (agent != agents_.end()) return in_page(agent->second, token.path, 0, out);
  if (const auto place = places_.find(token.path.agent); place != places_.end()) return marked(place->second);
  out.error("E101", token.path.span, "the net has no " + in_quotes(token.path.agent));
  return std::nullopt;
}

Found NetPaths::in_page(PageId page, const spec::NetPath& path, std::size_t part, Diagnostics& out) const {
  if (part == path.parts.size()) return whole_page(page);
  for (const PageId below : below_[page.value])
    if (pages_.pages[below.value].name == path.parts[part].name) return in_page(below, path, part + 1, out);
  if (const auto place = own_place(page, joined(path.parts, part))) return marked(*place);
  if (pages_.pages[page.value].layer == net::Layer::subsystem && !pages_.pages[page.value].is_group()) {
    const net::SubsystemId id = pages_.pages[page.value].subsystem;
    const spec::Subsystem& subsystem = model_.subsystem(id);
    for (const auto* buffers : {&subsystem.inputs, &subsystem.outputs})
      if (std::ranges::count(*buffers, path.parts[part].name, &spec::Field::name) > 0)
        return of_buffer(id, path, out);
  }
  complain(page, path.parts[part], out);
  return std::nullopt;
}

/// AGENT.SUBSYSTEM.BUFFER.STATE
Found NetPaths::of_buffer(net::SubsystemId subsystem, const spec::NetPath& path, Diagnostics& out) const {
  const spec::PathPart& buffer = path.parts[1];
  const std::string_view last = path.parts.back().name;
  if (path.parts.size() == 3 && (last == spec::fresh_in_paths || last == spec::timed_out_in_paths))
    return of_outcome(subsystem, path, out);
  std::vector<std::string> names;
  for (const net::ChannelId id : channels_[subsystem]) {
    const spec::Channel& channel = model_.channels[id];
    const auto is = [&](const spec::ChannelEnd& end, const Numbered<spec::BufferId, spec::Field>& buffers) {
      return end.instance == subsystem && buffers[end.buffer].name == buffer.name;
    };
    if (is(channel.to, model_.subsystem(channel.to.instance).inputs) ||
        is(channel.from, model_.subsystem(channel.from.instance).outputs))
      names.push_back(model_.channel_name(channel));
  }
  if (path.parts.size() == 2 || path.parts.size() > 3) {
    out.error("E112", buffer.span, in_quotes(buffer.name) + " is a buffer: which state of its channel?",
              "write " + path.agent + "." + joined(path.parts, 0) +
                  ".full, .empty, .ack or .channel; or .fresh of an input");
    return std::nullopt;
  }
  if (names.size() == 1) return state(names.front(), path.parts[2], out);
  const std::string none = names.empty() ? "no channel" : std::to_string(names.size()) + " channels";
  out.error("E112", buffer.span, in_quotes(buffer.name) + " belongs to " + none,
            names.empty() ? "" : "name one: " + names.front() + "." + path.parts[2].name);
  return std::nullopt;
}

/// AGENT.SUBSYSTEM.INPUT.fresh, AGENT.SUBSYSTEM.OUTPUT.timed_out: what the net knows of the last communication.
Found NetPaths::of_outcome(net::SubsystemId subsystem, const spec::NetPath& path, Diagnostics& out) const {
  const spec::PathPart &buffer = path.parts[1], &status = path.parts[2];
  const std::string written = path.agent + "." + path.parts[0].name + "." + buffer.name;
  const auto& inputs = model_.subsystem(subsystem).inputs;
  const bool is_input = std::ranges::count(inputs, buffer.name, &spec::Field::name) > 0;
  const bool fresh = status.name == spec::fresh_in_paths;
  if (fresh != is_input) {
    out.error("E112", status.span,
              is_input ? "properties do not ask whether the last wait for an input timed out"
                       : "an output is never fresh",
              is_input
                  ? "write not " + written + ".fresh: its last receive took no value"
                  : "ask .timed_out of an output, or .fresh of the input at the other end of its channel");
    return std::nullopt;
  }
  const std::string name = model_.instance_path(subsystem) + "." + buffer.name + ".";
  const auto place = places_.find(name + std::string(fresh ? words::came : words::timed_out));
  if (place != places_.end()) return marked(place->second);
  out.error("E112", status.span, "the net does not know " + in_quotes(buffer.name + "." + status.name),
            fresh ? "it does for a channel on which a side waits: receive: blocking, timeout: 1 s"
                  : "it does if all its channels send with a timeout: send: blocking, timeout: 1 s");
  return std::nullopt;
}

/// AGENT.SUBSYSTEM.OUTPUT -> AGENT.SUBSYSTEM.INPUT.STATE
Found NetPaths::of_channel(const spec::NetPath& from, const spec::NetPath& to, Diagnostics& out) const {
  if (from.parts.size() != 2 || to.parts.size() != 3) {
    out.error("E112", from.parts.size() != 2 ? from.span : to.span, "not a state of a channel",
              "for example robot.control.motion->robot.motor.velocity.full");
    return std::nullopt;
  }
  const std::string channel = from.agent + "." + joined(from.parts, 0) + "->" + to.agent + "." +
                              to.parts[0].name + "." + to.parts[1].name;
  for (const spec::Channel& one : model_.channels)
    if (model_.channel_name(one) == channel) return state(channel, to.parts[2], out);
  std::vector<std::string> names;
  for (const spec::Channel& one : model_.channels) names.push_back(model_.channel_name(one));
  out.error("E101", from.span, "unknown channel " + in_quotes(channel), did_you_mean(channel, names));
  return std::nullopt;
}

Found NetPaths::state(const std::string& channel, const spec::PathPart& part, Diagnostics& out) const {
  const auto place = places_.find(channel + "." + part.name);
  if (place != places_.end()) return marked(place->second);
  std::string others;
  for (const std::string_view other : {words::full, words::empty, words::acknowledged, words::lock})
    if (places_.contains(channel + "." + std::string(other)))
      others += (others.empty() ? "" : ", ") + std::string(other);
  out.error("E101", part.span, "channel " + in_quotes(channel) + " has no state " + in_quotes(part.name),
            others.empty() ? "no behaviour uses it" : "it has " + others);
  return std::nullopt;
}

net::Statement NetPaths::whole_page(PageId page) const {
  net::Statement statement;
  statement.page = page;
  std::vector<PageId> open{page};
  while (!open.empty()) {
    const PageId at = open.back();
    open.pop_back();
    statement.places.insert(statement.places.end(), own_[at.value].begin(), own_[at.value].end());
    open.insert(open.end(), below_[at.value].begin(), below_[at.value].end());
  }
  std::ranges::sort(statement.places);
  return statement;
}

/// A place that the page draws, under its name there; a fused one too.
std::optional<PlaceId> NetPaths::own_place(PageId page, const std::string& local) const {
  for (const net::Node& node : pages_.pages[page.value].nodes) {
    if (node.page.valid() || node.name != local) continue;
    const std::string name =
        node.fusion.valid() ? pages_.fusions[node.fusion.value].name : pages_.path(page) + "." + local;
    if (const auto place = places_.find(name); place != places_.end()) return place->second;
  }
  return std::nullopt;
}

void NetPaths::complain(PageId page, const spec::PathPart& part, Diagnostics& out) const {
  std::vector<std::string> names;
  for (const PageId below : below_[page.value]) names.push_back(pages_.pages[below.value].name);
  for (const net::Node& node : pages_.pages[page.value].nodes)
    if (!node.page.valid()) names.push_back(node.name);
  const net::Layer layer = pages_.pages[page.value].layer;
  if (layer == net::Layer::subsystem && !pages_.pages[page.value].is_group()) {
    const spec::Subsystem& subsystem = model_.subsystem(pages_.pages[page.value].subsystem);
    for (const auto* buffers : {&subsystem.inputs, &subsystem.outputs})
      for (const spec::Field& buffer : *buffers) names.push_back(buffer.name);
  }
  Hint hint = did_you_mean(part.name, names);
  if (hint.empty()) {
    hint.text = "here are ";
    for (const std::string& name : names) hint.text += (&name == &names.front() ? "" : ", ") + name;
  }
  out.error("E101", part.span,
            std::string("unknown ") + what_is_in(layer) + " " + in_quotes(part.name) + " in " +
                in_quotes(pages_.path(page)),
            hint);
}

}  // namespace tessera::layers
