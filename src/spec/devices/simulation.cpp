#include "spec/devices/simulation.hpp"

#include <algorithm>

#include "spec/devices/coppelia.hpp"
#include "spec/devices/drivers.hpp"
#include "spec/devices/placements.hpp"
#include "spec/devices/script.hpp"
#include "spec/devices/world_checks.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"

namespace tessera::spec {
namespace {

/// at: receives the position of the name.
std::string read_file_name(const Entry* entry, std::string_view what, Span& at, Diagnostics& out) {
  if (entry == nullptr) return {};
  const Node* text = text_of(*entry->value, entry->span, what, out, "name a file");
  if (text == nullptr) return {};
  at = text->span;
  return text->text;
}

std::optional<double> positive(std::optional<double> value, const Entry& entry, std::string_view what,
                               Diagnostics& out) {
  if (!value || *value > 0) return value;
  out.error("E206", entry.value->span, std::string(what) + " must be positive");
  return std::nullopt;
}

void read_start(const Entry& entry, Track& track, Diagnostics& out) {
  const auto& items = items_of(*entry.value, entry.span, "start", out);
  if (!entry.value->is_sequence()) return;
  if (items.size() != 3) {
    out.error("E104", entry.span, "start must be three values",
              "[x, y, heading], for example [0.4, 0.2, 90 deg]");
    return;
  }
  track.start_x_m = read_length(*items[0], entry.span, "x", out);
  track.start_y_m = read_length(*items[1], entry.span, "y", out);
  track.start_heading_rad = read_angle(*items[2], entry.span, "the heading", out);
}

Track read_track(const Entry& entry, Diagnostics& out) {
  const Section section(*entry.value, entry.span, "a track",
                        {"image", "metres_per_pixel", "start", "footprint"}, out);
  Track track;
  track.image = read_file_name(section.require("image", "for example image: oval.png"), "the image",
                               track.image_span, out);
  if (const Entry* scale = section.find("metres_per_pixel")) {
    const auto value = read_number(*scale->value, scale->span, "metres_per_pixel", out);
    track.metres_per_pixel =
        positive(value, *scale, "metres_per_pixel", out).value_or(track.metres_per_pixel);
  }
  if (const Entry* start = section.find("start")) read_start(*start, track, out);
  if (const Entry* footprint = section.find("footprint")) {
    const auto value = read_length(*footprint->value, footprint->span, "footprint", out);
    track.footprint_m = positive(value, *footprint, "footprint", out).value_or(track.footprint_m);
  }
  return track;
}

/// Simulated drivers that are C++ classes need no world. A device of the world needs one, and so does a
/// track, which is its floor.
void require_world(const Section& section, const Simulation& simulation) {
  const bool of_world = std::any_of(simulation.drivers.begin(), simulation.drivers.end(),
                                    [](const Driver& driver) { return driver.is_of_world(); });
  if (of_world || simulation.track || !simulation.checks.empty() || !simulation.measures.empty() ||
      !simulation.models.empty() || (simulation.drivers.empty() && simulation.use_checks.empty()))
    section.require("world", "for example world: line_world.xml");
}

}  // namespace

std::optional<Simulation> read_simulation(const Entry* entry, const Model& model, const AgentGroups& groups,
                                          Diagnostics& out) {
  if (entry == nullptr) return std::nullopt;
  const Section section(*entry->value, entry->span, "the simulation",
                        {"world", "coppelia", "track", "models", "drivers", "script", "checks", "measures"},
                        out);
  Simulation simulation;
  simulation.span = entry->span;
  simulation.world = read_file_name(section.find("world"), "the world", simulation.world_span, out);
  if (const Entry* coppelia = section.find("coppelia")) {
    simulation.coppelia = read_coppelia(*coppelia, out);
    refuse_beside_coppelia(section, out);
  }
  if (const Entry* track = section.find("track")) simulation.track = read_track(*track, out);
  simulation.models = read_placements(section.find("models"), model, groups, out);
  simulation.drivers = read_drivers(section.find("drivers"), Devices::simulated, model, groups, out);
  read_script(section.find("script"), model, groups, simulation.drivers, out);
  read_checks(section.find("checks"), simulation, out);
  simulation.measures = read_world_measures(section.find("measures"), out);
  if (section.find("world") == nullptr && !simulation.coppelia) require_world(section, simulation);
  return simulation;
}

}  // namespace tessera::spec
