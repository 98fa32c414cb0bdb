#include "project/verification/run_files.hpp"

#include "project/verification/pipeline.hpp"
#include "project/verification/violation.hpp"
#include "verify/counterexample/narrative.hpp"
#include "verify/counterexample/waits.hpp"

namespace tessera::project {

namespace {

using nlohmann::json;

void add_line(json& to, std::uint32_t line, const std::string& included) {
  to["line"] = line;
  if (!included.empty()) to["included"] = included;
}

json names_of(const net::Net& net, std::span<const net::Arc> arcs) {
  json names = json::array();
  for (const net::Arc& arc : arcs)
    for (std::uint32_t token = 0; token < arc.weight; ++token) names.push_back(net[arc.place].name);
  return names;
}

}  // namespace

json firings_json(const net::Net& net, const net::HierarchicalNet* pages,
                  const std::vector<net::TransitionId>& run) {
  json firings = json::array();
  for (const net::TransitionId id : run) {
    const net::Transition& transition = net[id];
    json firing{{"transition", transition.name},
                {"takes", names_of(net, net.preset(id))},
                {"gives", names_of(net, net.postset(id))}};
    if (transition.subsystem.value < net.parts().subsystems.size())
      firing["subsystem"] = net.parts()[transition.subsystem].path;
    if (pages != nullptr && transition.page.valid()) firing["page"] = pages->path(transition.page);
    if (transition.span.line > 0) {
      const diagnostics::Sources& sources = net.parts().sources;
      add_line(firing, sources.own_line(transition.span.line), sources.included_line(transition.span.line));
    }
    firings.push_back(std::move(firing));
  }
  return firings;
}

json story_json(const net::Net& net, const std::vector<net::TransitionId>& run, verify::Wording wording) {
  json story = json::array();
  for (const verify::Act& act : verify::narrate(net, run, wording)) {
    story.push_back({{"first", act.first}, {"last", act.last}, {"who", act.who}, {"text", act.text}});
    add_line(story.back(), act.line, act.included);
  }
  return story;
}

/// In words.
json waits_json(const verify::PropertyResult& property) {
  json waits = json::array();
  for (const verify::SubsystemAtEnd& one : property.waits) waits.push_back(one.text);
  return waits;
}

json at_end_json(const std::vector<verify::SubsystemAtEnd>& waits) {
  json all = json::array();
  for (const verify::SubsystemAtEnd& one : waits)
    all.push_back({{"path", one.path},
                   {"state", verify::name_of(one.state)},
                   {"awaited", verify::name_of(one.awaited)},
                   {"behaviour", one.behaviour},
                   {"channel", one.channel},
                   {"from", one.from},
                   {"text", one.text}});
  return all;
}

std::vector<verify::SubsystemAtEnd> at_end_from(const json& waits) {
  using State = verify::SubsystemAtEnd::State;
  using Awaited = verify::SubsystemAtEnd::Awaited;
  // The first of a list that has the name.
  const auto named = [](const json& name, auto last) {
    using Named = decltype(last);
    for (int value = 0; value <= static_cast<int>(last); ++value)
      if (name == verify::name_of(static_cast<Named>(value))) return static_cast<Named>(value);
    throw std::runtime_error("unknown name " + name.dump());
  };
  std::vector<verify::SubsystemAtEnd> all;
  for (const json& one : waits)
    all.push_back({.state = named(one.at("state"), State::takes_no_more),
                   .awaited = named(one.at("awaited"), Awaited::memory),
                   .path = one.at("path").get<std::string>(),
                   .behaviour = one.at("behaviour").get<std::string>(),
                   .channel = one.at("channel").get<std::string>(),
                   .from = one.at("from").get<std::vector<std::string>>(),
                   .text = one.at("text").get<std::string>()});
  return all;
}

json behaviours_json(const verify::PropertyResult& property) {
  json behaviours = json::array();
  for (const verify::PropertyResult::Behaviour& one : property.behaviours) {
    behaviours.push_back({{"path", one.path}});
    add_line(behaviours.back(), one.line, one.included);
  }
  return behaviours;
}

json report_json(const net::Net& net, const net::HierarchicalNet* pages, const verify::Report& report) {
  json properties = json::array();
  for (const verify::PropertyResult& property : report.properties) {
    json one{{"name", property.name},
             {"asks", property.asks},
             {"verdict", name_of(property.verdict)},
             {"method", property.method},
             {"why", property.why},
             {"meaning", property.meaning},
             {"explanation", property.explanation},
             {"seconds", property.seconds},
             {"states", property.states},
             {"warning", property.warning},
             {"waits", waits_json(property)},
             {"behaviours", behaviours_json(property)},
             {"trace", nullptr}};
    if (!property.hint.empty()) one["hint"] = property.hint;
    if (!property.cut_off.empty()) one["cut_off"] = property.cut_off;
    if (property.has_trace) one["trace"] = firings_json(net_of_run(net, property), pages, property.trace);
    properties.push_back(std::move(one));
  }
  return {{"properties", properties},
          {"net_hash", report.net_hash},
          {"verification_hash", report.verification_hash}};
}

json traces_json(const std::string& file, const net::Net& net, const net::HierarchicalNet* pages,
                 const verify::Report& report) {
  json traces = json::array();
  for (const verify::PropertyResult& property : report.properties) {
    if (!property.has_trace) continue;
    const net::Net its_net = net_of_run(net, property);
    json trace{{"property", property.name},
               {"verdict", name_of(property.verdict)},
               {"method", property.method},
               {"why", property.why},
               {"exceptions", property.exceptions},
               {"firings", firings_json(its_net, pages, property.trace)},
               {"end", marked_after(its_net, property.trace, false)},
               {"channels", marked_after(its_net, property.trace, true)},
               {"waits", waits_json(property)}};
    if (pages != nullptr) trace["story"] = story_json(its_net, property.trace);
    traces.push_back(std::move(trace));
  }
  json initial = json::array();
  for (const net::Place& place : net.places())
    for (std::uint32_t token = 0; token < place.tokens; ++token) initial.push_back(place.name);
  return {{"net", file}, {"net_hash", report.net_hash}, {"initial", initial}, {"traces", traces}};
}

json scenario_json(const net::Net& net, const verify::Report& report,
                   const verify::PropertyResult& property) {
  const net::Net its_net = net_of_run(net, property);
  json firings = json::array();
  for (const net::TransitionId id : property.trace) {
    const net::Transition& transition = its_net[id];
    if (transition.role == tessera::Step::no_successor)
      firings.push_back(
          {{"name", transition.name}, {"none_holds", its_net.parts()[transition.subsystem].path}});
    else
      firings.push_back(transition.name);
  }
  return {{"scenario", 1},       {"net_hash", report.net_hash}, {"property", property.name},
          {"why", property.why}, {"firings", firings},          {"waits", waits_json(property)}};
}

}  // namespace tessera::project
