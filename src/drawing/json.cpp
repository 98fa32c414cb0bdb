#include <array>
#include <nlohmann/json.hpp>
#include <span>

#include "drawing/drawing.hpp"
#include "net/counts.hpp"

namespace tessera::drawing {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(std::uint32_t number) { return number == UINT32_MAX ? Json(nullptr) : Json(number); }

Json span_json(const net::Span& span) {
  return {{"line", span.line}, {"column", span.column}, {"length", span.length}};
}

Json operation_json(const net::Operation& operation) {
  constexpr std::array<const char*, 5> kinds{"none", "transition_function", "next_iteration", "write",
                                             "read"};
  if (operation.kind == net::Operation::Kind::none) return nullptr;
  return {{"kind", kinds[static_cast<std::size_t>(operation.kind)]},
          {"subject", number_or_null(operation.subject)}};
}

Json condition_json(const net::Condition& condition) {
  constexpr std::array<const char*, 6> kinds{"none", "go_on", "terminal", "error", "next", "elapsed"};
  constexpr std::array<const char*, 3> truths{"free", "always", "never"};
  if (condition.kind == net::Condition::Kind::none) return nullptr;
  return {{"kind", kinds[static_cast<std::size_t>(condition.kind)]},
          {"truth", truths[static_cast<std::size_t>(condition.truth)]},
          {"subject", number_or_null(condition.subject)},
          {"text", condition.text}};
}

Json page_json(const net::HierarchicalNet& net, net::PageId id) {
  const net::Page& page = net.pages[id.value];
  Json json{{"path", net.path(id)},
            {"name", page.name},
            {"layer", net::name_of(page.layer)},
            {"parent", number_or_null(page.parent.value)},
            {"subsystem", number_or_null(page.subsystem)},
            {"input", page.input},
            {"output", page.output},
            {"span", span_json(page.span)},
            {"nodes", Json::array()},
            {"transitions", Json::array()}};
  for (const net::Node& node : page.nodes)
    json["nodes"].push_back({{"name", node.name},
                             {"page", number_or_null(node.page.value)},
                             {"fusion", number_or_null(node.fusion.value)},
                             {"tokens", node.tokens},
                             {"operation", operation_json(node.operation)}});
  for (const net::PageTransition& transition : page.transitions)
    json["transitions"].push_back({{"name", transition.name},
                                   {"inputs", transition.inputs},
                                   {"outputs", transition.outputs},
                                   {"condition", condition_json(transition.condition)},
                                   {"span", span_json(transition.span)}});
  return json;
}

Json arcs_json(std::span<const net::Arc> arcs) {
  Json json = Json::array();
  for (const net::Arc& arc : arcs) json.push_back({{"place", arc.place.value}, {"weight", arc.weight}});
  return json;
}

Json flat_json(const net::Net& net) {
  Json json{{"places", Json::array()}, {"transitions", Json::array()}};
  for (const net::Place& place : net.places())
    json["places"].push_back({{"name", place.name},
                              {"tokens", place.tokens},
                              {"operation", operation_json(place.operation)},
                              {"layer", net::name_of(place.layer)},
                              {"page", number_or_null(place.page.value)},
                              {"subsystem", number_or_null(place.subsystem)},
                              {"channel", number_or_null(place.channel)},
                              {"span", span_json(place.span)}});
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    const net::Transition& transition = net[id];
    json["transitions"].push_back({{"name", transition.name},
                                   {"inputs", arcs_json(net.preset(id))},
                                   {"outputs", arcs_json(net.postset(id))},
                                   {"condition", condition_json(transition.condition)},
                                   {"layer", net::name_of(transition.layer)},
                                   {"page", number_or_null(transition.page.value)},
                                   {"subsystem", number_or_null(transition.subsystem)},
                                   {"span", span_json(transition.span)}});
  }
  return json;
}

}  // namespace

std::string to_json(const net::HierarchicalNet& pages, const net::Net& net, int indent) {
  Json json{{"pages", Json::array()}, {"fusions", Json::array()}};
  for (std::uint32_t page = 0; page < pages.pages.size(); ++page)
    json["pages"].push_back(page_json(pages, net::PageId{page}));
  for (const net::FusionSet& set : pages.fusions)
    json["fusions"].push_back({{"name", set.name},
                               {"tokens", set.tokens},
                               {"channel", number_or_null(set.channel)},
                               {"span", span_json(set.span)}});
  json["flat"] = flat_json(net);
  json["counts"] = Json::parse(net::to_json(net::count(pages, net)));
  return json.dump(indent) + "\n";
}

}  // namespace tessera::drawing
