#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drawing/json_writer.hpp"
#include "net/counts.hpp"
#include "net/net.hpp"

namespace tessera::drawing {

/// Writes a net. Each function writes one part as one JSON value.
class NetWriter : public JsonWriter {
 public:
  /// sources: of the lines of spans; they outlive the writer.
  explicit NetWriter(const diagnostics::Sources& sources) : sources_(sources) {}
  virtual ~NetWriter() = default;
  NetWriter(const NetWriter&) = delete;
  NetWriter& operator=(const NetWriter&) = delete;

  void span(const net::Span& span) {
    // A reader that knows nothing of included files would look up their lines in the specification.
    const std::string included = sources_.included_line(span.line);
    object([&] {
      member("line", sources_.own_line(span.line));
      member("column", span.column);
      member("length", span.length);
      if (!included.empty()) member("included", std::string_view(included));
    });
  }

  void operation(const net::Operation& operation) {
    constexpr std::array<const char*, 5> kinds{"none", "transition_function", "next_iteration", "write",
                                               "read"};
    if (operation.kind == net::Operation::Kind::none) return null();
    object([&] {
      member("kind", kinds[static_cast<std::size_t>(operation.kind)]);
      if (operation.behaviour.valid())
        member("subject", operation.behaviour);
      else
        number("subject", operation.channel);
    });
  }

  void condition(const net::Condition& condition) {
    constexpr std::array<const char*, 8> kinds{"none", "go_on",   "terminal", "error",
                                               "next", "elapsed", "send",     "skip"};
    constexpr std::array<const char*, 3> truths{"free", "always", "never"};
    if (condition.kind == net::Condition::Kind::none) return null();
    object([&] {
      member("kind", kinds[static_cast<std::size_t>(condition.kind)]);
      member("truth", truths[static_cast<std::size_t>(condition.truth)]);
      member("truth_with_failures", truths[static_cast<std::size_t>(condition.known(true).truth)]);
      if (condition.entry)
        member("subject", *condition.entry);
      else
        number("subject", condition.channel);
      member("text", std::string_view(condition.text));
    });
  }

  void page(const net::HierarchicalNet& net, net::PageId id) {
    const net::Page& page = net.pages[id.value];
    object([&] {
      const std::string path = net.path(id);
      member("path", name(path));
      member("name", path.size() == page.name.size() ? name(path) : std::string_view(page.name));
      member("layer", net::name_of(page.layer));
      number("parent", page.parent);
      number("subsystem", page.subsystem);
      member("input", page.input);
      member("output", page.output);
      member("span", [&] { span(page.span); });
      member("nodes", [&] { list(page.nodes, [&](const net::Node& one) { node(one); }); });
      member("transitions",
             [&] { list(page.transitions, [&](const net::PageTransition& one) { page_transition(one); }); });
    });
  }

  void fusion(const net::FusionSet& set) {
    object([&] {
      member("name", std::string_view(set.name));
      member("tokens", set.tokens);
      number("channel", set.channel);
      member("span", [&] { span(set.span); });
    });
  }

  void place(const net::Place& place) {
    object([&] {
      member("name", name(place.name));
      member("tokens", place.tokens);
      member("operation", [&] { operation(place.operation); });
      member("layer", net::name_of(place.layer));
      number("page", place.page);
      number("subsystem", place.subsystem);
      number("channel", place.channel);
      member("span", [&] { span(place.span); });
    });
  }

  void transition(const net::Net& net, net::TransitionId id) {
    const net::Transition& transition = net[id];
    object([&] {
      member("name", name(transition.name));
      member("inputs", [&] { arcs(net.preset(id)); });
      member("outputs", [&] { arcs(net.postset(id)); });
      member("condition", [&] { condition(transition.condition); });
      member("layer", net::name_of(transition.layer));
      number("page", transition.page);
      number("subsystem", transition.subsystem);
      member("span", [&] { span(transition.span); });
    });
  }

 protected:
  /// The elements' numbers and names as they are written: those of the net. nullopt is written as null.
  [[nodiscard]] virtual std::optional<std::uint32_t> written(net::PageId id) const { return id.value; }
  [[nodiscard]] virtual std::optional<std::uint32_t> written(net::PlaceId id) const { return id.value; }
  [[nodiscard]] virtual std::optional<std::uint32_t> written(net::FusionId id) const { return id.value; }
  [[nodiscard]] virtual std::optional<std::uint32_t> written(net::SubsystemId id) const { return id.value; }
  [[nodiscard]] virtual std::optional<std::uint32_t> written(net::ChannelId id) const { return id.value; }
  [[nodiscard]] virtual std::string_view name(std::string_view path) const { return path; }

 private:
  template <class Id>
  void number(std::string_view member_name, Id id) {
    member(member_name, [&] {
      const std::optional<std::uint32_t> number = id.valid() ? written(id) : std::nullopt;
      number ? value(*number) : null();
    });
  }

  void node(const net::Node& node) {
    object([&] {
      member("name", std::string_view(node.name));
      number("page", node.page);
      number("fusion", node.fusion);
      member("tokens", node.tokens);
      member("operation", [&] { operation(node.operation); });
    });
  }

  void page_transition(const net::PageTransition& transition) {
    const auto numbers = [&](const auto& indices) {
      list(indices, [&](std::uint32_t index) { value(index); });
    };
    object([&] {
      member("name", std::string_view(transition.name));
      member("inputs", [&] { numbers(transition.inputs); });
      member("outputs", [&] { numbers(transition.outputs); });
      member("condition", [&] { condition(transition.condition); });
      member("role", [&] { role(transition.role); });
      member("span", [&] { span(transition.span); });
    });
  }

  void role(Step role) { role == Step::other ? null() : value(name_of(role)); }

  void arcs(std::span<const net::Arc> arcs) {
    list(arcs, [&](const net::Arc& arc) {
      object([&] {
        number("place", arc.place);
        member("weight", arc.weight);
      });
    });
  }

 private:
  const diagnostics::Sources& sources_;
};

}  // namespace tessera::drawing
