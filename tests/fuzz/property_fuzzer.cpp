#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "layers/layers.hpp"
#include "layers/properties.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"

namespace {

const std::string system_text = R"(
tessera: 1
system: s
templates:
  unit: { control: { rate: 1 Hz, inputs: { x: bool }, outputs: { y: bool }, behaviours: { go: {} } } }
agents:
  robot: { use: unit, count: 3, ring: true }
  lone: { control: { rate: 1 Hz, behaviours: { wait: { terminal: true, next: go }, go: {} } } }
channels:
  - robot[i].control.y -> robot[i+1].control.x
properties:
)";

const char* const kinds[] = {"never", "always", "reachable", "always_reachable", "leads_to"};

}  // namespace

/// Any text of a property is either found in the net or reported as a mistake, and can be shown.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const nlohmann::json quoted = text;
  const std::string property = quoted.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  tessera::diagnostics::Diagnostics out(
      "fuzz.yaml", system_text + "  - { " + kinds[data[0] % 5] + ": " + property + " }\n");
  const auto model = tessera::spec::parse(out);
  if (model.has_value() == out.has_errors()) std::abort();
  if (render(out).empty() && !model) std::abort();
  if (!model) return 0;
  const auto pages = tessera::layers::build(*model, out);
  const auto net = pages ? tessera::net::flatten(*pages, out) : std::nullopt;
  if (!net) std::abort();
  const auto properties = tessera::layers::properties(*model, *pages, *net, out);
  if (properties.has_value() == out.has_errors()) std::abort();
  if (render(out).empty() && !properties) std::abort();
  return 0;
}
