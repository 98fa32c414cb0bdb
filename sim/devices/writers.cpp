#include "sim/devices/writers.hpp"

#include <set>
#include <string_view>

#include "sim/devices/device_error.hpp"

namespace tessera::sim {
namespace {

/// "robot" of "robot[3].base.command"; empty: no agent of a fleet.
std::string_view fleet_of(std::string_view path) {
  const std::string_view agent = path.substr(0, path.find('.'));
  return agent.ends_with(']') ? agent.substr(0, agent.find('[')) : std::string_view();
}

DriverProblem two_writers(const Writers::Element& element, const std::string& first,
                          const DriverRequest& second) {
  const bool fleet = !fleet_of(first).empty() && fleet_of(first) == fleet_of(second.path);
  DriverProblem problem{element.text + " is driven by " + first + " and by " + second.path,
                        fleet ? "name another one for each agent, such as " + element.name +
                                    "{i}, or place a model of its own for each (simulation: models)"
                              : "let one subsystem command it, and send it what the others wish",
                        element.name};
  problem.second_writer = true;
  return problem;
}

}  // namespace

void Writers::claim(const DriverRequest& request, std::span<const Element> elements) {
  std::set<std::string_view> own;
  for (const Element& element : elements) {
    if (own.insert(element.identity).second) continue;
    DriverProblem problem{element.text + " stands twice in the list of " + request.path,
                          "name each element once; the buffer has one number for each", element.name};
    problem.second_writer = true;
    throw DeviceError(std::move(problem));
  }
  const std::scoped_lock lock(mutex_);
  for (const Element& element : elements)
    if (const auto writer = writers_.find(element.identity);
        writer != writers_.end() && writer->second != request.path)
      throw DeviceError(two_writers(element, writer->second, request));
  for (const Element& element : elements) writers_.emplace(element.identity, request.path);
}

}  // namespace tessera::sim
