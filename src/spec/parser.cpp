#include "spec/parser.hpp"

#include "spec/agents/buffers.hpp"
#include "spec/agents/deployment.hpp"
#include "spec/agents/fleets.hpp"
#include "spec/behaviours/complete_lists.hpp"
#include "spec/behaviours/defaults.hpp"
#include "spec/behaviours/group_templates.hpp"
#include "spec/behaviours/unused_templates.hpp"
#include "spec/channels/channels.hpp"
#include "spec/channels/models.hpp"
#include "spec/channels/waits.hpp"
#include "spec/channels/wiring.hpp"
#include "spec/devices/drivers.hpp"
#include "spec/devices/simulation.hpp"
#include "spec/devices/writers.hpp"
#include "spec/document/document.hpp"
#include "spec/document/includes.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/document/text_checks.hpp"
#include "spec/properties/properties.hpp"
#include "spec/timing/timing.hpp"
#include "spec/values/takes.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {
namespace {

/// It has no system and no agents: perhaps it is meant for `include`.
bool is_part(const Section& file) {
  return file.find("system") == nullptr && file.find("agents") == nullptr &&
         (file.find("types") != nullptr || file.find("templates") != nullptr);
}

std::string read_system(const Section& file, Diagnostics& out) {
  const Entry* system = file.require(
      "system", is_part(file) ? "check the specification that includes this file, or give it a system"
                              : "for example system: line_follower");
  if (system == nullptr) return {};
  const Node* text = text_of(*system->value, system->span, "the name of the system", out);
  if (text == nullptr) return {};
  check_system_name(text->text, text->span, out);
  return text->text;
}

Model read_model(const Node& root, Diagnostics& out) {
  const Section file(
      root, root.span, "a specification",
      {"tessera", "system", "include", "types", "parameters", "templates", "agents", "channels", "drivers",
       "properties", "timing", "simulation", "models", "deploy", "on_error"},
      out);
  Model model;
  if (!file.readable()) return model;
  if (const Entry* version = file.require("tessera", "begin the file with 'tessera: 1'"))
    check_version(*version, out);
  model.system = read_system(file, out);
  Types types;
  types.read(file.find("types"), out);
  model.structures = types.structures();
  model.parameters = read_parameters(file.find("parameters"), types, out);
  const Entry* agents = file.require("agents", "a system is made of agents");
  std::optional<OnError> on_error = read_on_error(file, out);
  const FleetSizes fleets(agents);
  GroupTemplates group_templates(file.find("templates"));
  const SystemScope scope{types, model.parameters, on_error ? &*on_error : nullptr, &fleets,
                          &group_templates};
  const AgentGroups groups = read_agents(file.find("templates"), agents, scope, model, out);
  check_unused(group_templates, types, out);
  if (on_error) check_used(*on_error, out);
  CommunicationModels models;
  models.read(file.find("models"), model, out);
  const WiringExcuses excuses = read_channels(file.find("channels"), types, groups, models, model, out);
  models.complain_about_unused(model, out);
  check_wiring(model, excuses, out);
  check_waits(model, out);
  check_complete_lists(model, out);
  model.drivers = read_drivers(file.find("drivers"), Devices::real, model, groups, out);
  model.properties = read_properties(file.find("properties"), model, groups, out);
  model.simulation = read_simulation(file.find("simulation"), model, groups, out);
  check_uses(model, out);
  read_deployment(file.find("deploy"), groups, model, out);
  model.timing = read_timing(file.find("timing"), model, groups, out);
  check_writers(model, out);
  return model;
}

}  // namespace

std::optional<Model> parse(diagnostics::Diagnostics& out) {
  if (out.has_errors() || !check_text(out)) return std::nullopt;
  const auto document = read_document(out);
  if (!document) return std::nullopt;
  Includes includes;
  const Node& root = includes.whole(*document, out);
  if (!includes.complete()) return std::nullopt;
  std::optional<Model> model = read_model(root, out);
  model->sources = out.sources();
  if (out.has_errors()) model.reset();
  return model;
}

}  // namespace tessera::spec
