#include <array>
#include <nlohmann/json.hpp>
#include <span>

#include "drawing/drawing.hpp"
#include "drawing/json_writer.hpp"
#include "net/counts.hpp"

namespace tessera::drawing {
namespace {

/// Writes a net. Each function `value` writes one part as one JSON value.
class NetWriter : public JsonWriter {
 public:
  void span(const net::Span& span) {
    object([&] {
      member("line", span.line);
      member("column", span.column);
      member("length", span.length);
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
        member("subject", operation.channel);
    });
  }

  void condition(const net::Condition& condition) {
    constexpr std::array<const char*, 6> kinds{"none", "go_on", "terminal", "error", "next", "elapsed"};
    constexpr std::array<const char*, 3> truths{"free", "always", "never"};
    if (condition.kind == net::Condition::Kind::none) return null();
    object([&] {
      member("kind", kinds[static_cast<std::size_t>(condition.kind)]);
      member("truth", truths[static_cast<std::size_t>(condition.truth)]);
      member("truth_with_failures", truths[static_cast<std::size_t>(condition.known(true).truth)]);
      if (condition.entry)
        member("subject", *condition.entry);
      else
        member("subject", condition.channel);
      member("text", std::string_view(condition.text));
    });
  }

  void page(const net::HierarchicalNet& net, net::PageId id) {
    const net::Page& page = net.pages[id.value];
    object([&] {
      member("path", std::string_view(net.path(id)));
      member("name", std::string_view(page.name));
      member("layer", net::name_of(page.layer));
      member("parent", page.parent);
      member("subsystem", page.subsystem);
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
      member("channel", set.channel);
      member("span", [&] { span(set.span); });
    });
  }

  void place(const net::Place& place) {
    object([&] {
      member("name", std::string_view(place.name));
      member("tokens", place.tokens);
      member("operation", [&] { operation(place.operation); });
      member("layer", net::name_of(place.layer));
      member("page", place.page);
      member("subsystem", place.subsystem);
      member("channel", place.channel);
      member("span", [&] { span(place.span); });
    });
  }

  void transition(const net::Net& net, net::TransitionId id) {
    const net::Transition& transition = net[id];
    object([&] {
      member("name", std::string_view(transition.name));
      member("inputs", [&] { arcs(net.preset(id)); });
      member("outputs", [&] { arcs(net.postset(id)); });
      member("condition", [&] { condition(transition.condition); });
      member("layer", net::name_of(transition.layer));
      member("page", transition.page);
      member("subsystem", transition.subsystem);
      member("span", [&] { span(transition.span); });
    });
  }

 private:
  void node(const net::Node& node) {
    object([&] {
      member("name", std::string_view(node.name));
      member("page", node.page);
      member("fusion", node.fusion);
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
      member("span", [&] { span(transition.span); });
    });
  }

  void arcs(std::span<const net::Arc> arcs) {
    list(arcs, [&](const net::Arc& arc) {
      object([&] {
        member("place", arc.place);
        member("weight", arc.weight);
      });
    });
  }
};

}  // namespace

std::string to_json(const net::HierarchicalNet& pages, const net::Net& net, int indent) {
  constexpr std::size_t bytes_per_element = 400;
  NetWriter all;
  all.reserve((net.places().size() + net.transitions().size()) * bytes_per_element);
  all.object([&] {
    std::uint32_t index = 0;
    all.member("pages", [&] {
      all.list(pages.pages, [&](const net::Page&) { all.page(pages, net::PageId{index++}); });
    });
    all.member("fusions",
               [&] { all.list(pages.fusions, [&](const net::FusionSet& one) { all.fusion(one); }); });
    all.member("flat", [&] {
      all.object([&] {
        all.member("places", [&] { all.list(net.places(), [&](const net::Place& one) { all.place(one); }); });
        index = 0;
        all.member("transitions", [&] {
          all.list(net.transitions(),
                   [&](const net::Transition&) { all.transition(net, net::TransitionId{index++}); });
        });
      });
    });
    all.member("counts",
               [&] { all.raw(nlohmann::ordered_json::parse(net::to_json(net::count(pages, net))).dump()); });
  });
  const std::string text = all.take();
  return (indent < 0 ? text : nlohmann::ordered_json::parse(text).dump(indent)) + "\n";
}

}  // namespace tessera::drawing
