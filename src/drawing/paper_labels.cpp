#include "drawing/paper_labels.hpp"

#include <algorithm>

namespace tessera::drawing {
namespace {

using Level = Label::Level;

const char* letter_of(spec::SubsystemKind kind) {
  switch (kind) {
    case spec::SubsystemKind::control:
      return "c";
    case spec::SubsystemKind::receptor:
      return "r";
    case spec::SubsystemKind::effector:
      return "e";
  }
  return "";
}

/// The letter of a subsystem and its indices, "1" or "1,2".
struct Symbol {
  std::string letter, agent, own;
  [[nodiscard]] std::string indices() const { return own.empty() ? agent : agent + "," + own; }
};

class PaperLabels : public Labels {
 public:
  PaperLabels(const net::HierarchicalNet& net, const spec::Model& model) : net_(net), model_(model) {}

  [[nodiscard]] Label page(net::PageId id) const override {
    const net::Page& page = net_.pages[id.value];
    Label label;
    switch (page.layer) {
      case net::Layer::system:
        return label.add("system");
      case net::Layer::agent:
        return label.add("a", Level::base, true).add(agent_number(id), Level::lowered);
      case net::Layer::subsystem:
        if (page.is_group())
          return raised_letter(page).add("B", Level::base, true).add(indices(id), Level::lowered);
        return subsystem(page.subsystem);
      case net::Layer::behaviour:
        return raised_letter(page).add("B", Level::base, true).add(indices(id), Level::lowered);
      case net::Layer::communication:
        return raised_letter(page)
            .add("P", Level::base, true)
            .add(page.name, Level::raised)
            .add(indices(id), Level::lowered);
    }
    return label;
  }

  [[nodiscard]] Label node(net::PageId id, std::uint32_t node) const override {
    const net::Node& drawn = net_.pages[id.value].nodes[node];
    if (drawn.fusion.valid()) return fused(drawn.fusion);
    Label label = raised_letter(net_.pages[id.value]);
    return label.add("p", Level::base, true).add(drawn.name, Level::raised).add(indices(id), Level::lowered);
  }

  [[nodiscard]] Label fused(net::FusionId id) const override {
    const net::FusionSet& set = net_.fusions[id.value];
    if (set.fact.valid()) {
      const net::Parts::Fact& fact = net_.parts[set.fact];
      return Label(fact.name + " " + fact.values[set.value]);
    }
    Label label = buffer(set.channel, true);
    label.add(" \u2192 ").add(buffer(set.channel, false));
    return label.add(" " + set.name.substr(net_.parts[set.channel].size() + 1));
  }

  [[nodiscard]] std::vector<Label> operation(net::PageId id, const net::Operation& operation) const override {
    using Kind = net::Operation::Kind;
    switch (operation.kind) {
      case Kind::none:
        return {};
      case Kind::transition_function:
        return {function(id, "")};
      case Kind::next_iteration:
        return {Label("i := i + 1")};
      case Kind::write:
        return {Label("write ").add(buffer(operation.channel, true))};
      case Kind::read:
        return {Label("read ").add(buffer(operation.channel, false))};
    }
    return {};
  }

  [[nodiscard]] Label transition(net::PageId id, std::uint32_t transition) const override {
    std::string name = net_.pages[id.value].transitions[transition].name;
    if (name.starts_with("t_"))
      name.erase(0, 2);
    else if (name.starts_with("t") && name.size() == 2)
      name.erase(0, 1);
    return Label().add("t", Level::base, true).add(name, Level::lowered);
  }

  [[nodiscard]] std::vector<Label> condition(net::PageId id, const net::Condition& condition) const override {
    using Kind = net::Condition::Kind;
    if (condition.text.empty()) return {};
    if (condition.known(true).truth == net::Condition::Truth::never) return {Label("never")};
    switch (condition.kind) {
      case Kind::none:
        return {};
      case Kind::go_on:
        return {
            Label("\u00ac").add(function(id, "\u03c4")).add(" \u2227 \u00ac").add(function(id, "\u03b5"))};
      case Kind::terminal:
        return {function(id, "\u03c4").add(" \u2227 \u00ac").add(function(id, "\u03b5"))};
      case Kind::error:
        if (condition.truth == net::Condition::Truth::never) return {Label("failure")};
        return {function(id, "\u03b5")};
      case Kind::next: {
        Label label = raised_letter(net_.pages[id.value]);
        label.add("f", Level::base, true).add("\u03c3", Level::raised).add(indices(id), Level::lowered);
        return {label.add(": " + wrapped(condition.text, 22, 1).front())};
      }
      case Kind::elapsed:
        return {Label("t > " + condition.text)};
      case Kind::send:
      case Kind::skip:
        return {Label(wrapped(condition.text, 22, 1).front())};
    }
    return {};
  }

 private:
  /// The number of the agent, from the order of the pages in the system.
  [[nodiscard]] std::string agent_number(net::PageId id) const {
    std::size_t number = 0;
    for (const net::Node& node : net_.pages[0].nodes) {
      number += node.page.valid();
      if (node.page == id) break;
    }
    return std::to_string(number);
  }

  [[nodiscard]] Symbol symbol(net::SubsystemId id) const {
    const spec::Instance& given = model_.instances[id];
    const auto& subsystems = model_.definition_of(model_.agents[given.agent]).subsystems;
    const spec::SubsystemKind kind = subsystems[given.subsystem].kind;
    const auto before = std::count_if(subsystems.begin(), subsystems.begin() + given.subsystem.value + 1,
                                      [&](const spec::Subsystem& other) { return other.kind == kind; });
    return {letter_of(kind), std::to_string(given.agent.value + 1),
            kind == spec::SubsystemKind::control ? "" : std::to_string(before)};
  }

  [[nodiscard]] Label subsystem(net::SubsystemId id) const {
    const Symbol is = symbol(id);
    return Label().add(is.letter, Level::base, true).add(is.indices(), Level::lowered);
  }

  [[nodiscard]] Label raised_letter(const net::Page& page) const {
    Label label;
    if (page.subsystem.valid()) label.add(symbol(page.subsystem).letter, Level::raised);
    return label;
  }

  /// The indices of the agent, subsystem or behaviour to which a page belongs.
  [[nodiscard]] std::string indices(net::PageId id) const {
    const net::Page& page = net_.pages[id.value];
    switch (page.layer) {
      case net::Layer::system:
        return "";
      case net::Layer::agent:
        return agent_number(id);
      case net::Layer::subsystem:
        if (page.is_group()) return symbol(page.subsystem).indices() + "," + behaviour_number(id);
        return symbol(page.subsystem).indices();
      case net::Layer::behaviour:
        return symbol(page.subsystem).indices() + "," + behaviour_number(id);
      case net::Layer::communication:
        return indices(page.parent);
    }
    return "";
  }

  [[nodiscard]] std::string behaviour_number(net::PageId id) const {
    return std::to_string(net_.pages[id.value].behaviour.value + 1);
  }

  [[nodiscard]] Label function(net::PageId id, const char* condition) const {
    Label label = raised_letter(net_.pages[id.value]);
    return label.add("f", Level::base, true).add(condition, Level::raised).add(indices(id), Level::lowered);
  }

  /// The buffer at one end of a channel.
  [[nodiscard]] Label buffer(net::ChannelId id, bool output) const {
    const spec::Channel& channel = model_.channels[id];
    const spec::ChannelEnd& own = output ? channel.from : channel.to;
    const spec::ChannelEnd& other = output ? channel.to : channel.from;
    const Symbol here = symbol(own.instance), there = symbol(other.instance);
    const bool transmission = here.letter == "c" && there.letter == "c";
    const std::string& far = there.own.empty() || here.agent != there.agent ? there.agent : there.own;
    // A receptor has only one control subsystem as a partner.
    const bool implied = there.own.empty() && !transmission;
    Label label;
    label.add(transmission ? "T" : there.letter, Level::raised).add(output ? "y" : "x", Level::lowered);
    label.add(here.letter, Level::base, true)
        .add(implied ? here.indices() : here.indices() + "," + far, Level::lowered);
    if (neighbours(own.instance, other.instance) > 1) {
      const spec::Subsystem& owner = model_.subsystem(own.instance);
      label.add(" (" + (output ? owner.outputs : owner.inputs)[own.buffer].name + ")");
    }
    return label;
  }

  [[nodiscard]] std::ptrdiff_t neighbours(net::SubsystemId a, net::SubsystemId b) const {
    return std::ranges::count_if(model_.channels, [&](const spec::Channel& channel) {
      return (channel.from.instance == a && channel.to.instance == b) ||
             (channel.from.instance == b && channel.to.instance == a);
    });
  }

  const net::HierarchicalNet& net_;
  const spec::Model& model_;
};

}  // namespace

std::unique_ptr<Labels> paper_labels(const net::HierarchicalNet& net, const spec::Model& model) {
  return std::make_unique<PaperLabels>(net, model);
}

}  // namespace tessera::drawing
