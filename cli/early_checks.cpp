#include "cli/early_checks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/terminal.hpp"
#include "diagnostics/source.hpp"
#include "project/verification/pipeline.hpp"
#include "spec/parser.hpp"
#include "tessera/given_values.hpp"

namespace tessera::cli {

using namespace project;

namespace {

/// Reads the specification without printing anything: the build reports its mistakes.
std::optional<Specification> read_quietly(const std::filesystem::path& given) {
  const std::filesystem::path file = spec_file(given);
  diagnostics::Diagnostics found = diagnostics::load(file);
  std::optional<spec::Model> model;
  if (!found.has_errors()) model = spec::parse(found);
  if (!model) return std::nullopt;
  const std::filesystem::path absolute = located(file);
  return Specification{absolute, absolute.parent_path(), std::move(found), std::move(*model)};
}

/// The parameters of a model as the controller's code would have them, so that values can be tried.
class Parameters {
 public:
  explicit Parameters(const spec::Model& model) {
    std::size_t largest = 0;
    for (const spec::Instance& instance : model.instances) {
      const spec::Subsystem& subsystem =
          model.definitions[model.agents[instance.agent].definition].subsystems[instance.subsystem];
      for (const auto* parameters : {&model.parameters, &subsystem.parameters})
        for (const spec::Parameter& parameter : *parameters)
          largest = std::max(largest, bytes_of(parameter.type));
    }
    storage_.resize(largest);
    for (const spec::InstanceId index : model.instances.ids()) {
      std::vector<Bindings::Parameter>& own = of_instance_.emplace_back();
      for (const auto* parameters : {&model.parameters, &model.subsystem(index).parameters})
        for (const spec::Parameter& parameter : *parameters) own.push_back(bound(parameter));
    }
    for (const spec::InstanceId index : model.instances.ids())
      owners_.push_back({model.instance_path(index), of_instance_[index]});
  }

  [[nodiscard]] const std::vector<ParameterOwner>& owners() const { return owners_; }

 private:
  [[nodiscard]] static std::size_t bytes_of(const spec::Type& type) {
    const std::size_t one = type.kind == spec::Type::Kind::string
                                ? std::size_t{type.capacity} + sizeof(std::uint32_t)
                                : sizeof(double);
    return one * std::max<std::size_t>(type.extent, 1);
  }

  /// All share their storage: the values are only written, never used.
  [[nodiscard]] Bindings::Parameter bound(const spec::Parameter& parameter) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const bool text = parameter.type.kind == spec::Type::Kind::string;
    return {parameter.name,
            text ? std::nullopt : std::optional(parameter.type.scalar),
            storage_.data(),
            bytes_of(parameter.type),
            parameter.minimum.value_or(-infinity),
            parameter.maximum.value_or(infinity),
            text ? parameter.type.capacity : 0,
            parameter.type.extent,
            parameter.type.unit};
  }

  std::vector<std::byte> storage_;
  Numbered<spec::InstanceId, std::vector<Bindings::Parameter>> of_instance_;
  std::vector<ParameterOwner> owners_;
};

bool parameters_fit(const Specification& specification, const LaunchOptions& options) {
  const Parameters parameters(specification.model);
  bool all_fit = true;
  for (const GivenParameter& one : given_parameters(specification, options)) {
    const std::pair<std::string, std::string> value{one.path, one.value};
    std::string error;
    if (set_parameters(parameters.owners(), {&value, 1}, error)) continue;
    complain(one.where + error);
    all_fit = false;
  }
  return all_fit;
}

bool times_are_times(const LaunchOptions& options) {
  if (!options.duration.empty() && !parse_duration(options.duration))
    return complain(fmt::format("--for {}: expected a time such as 60s, 2min or 500ms", options.duration)),
           false;
  if (!options.record_limit.empty() && options.record_limit != "none" &&
      !parse_record_limit(options.record_limit))
    return complain(fmt::format("--record-limit {}: expected a size such as 500MB or 100MBx5, or none",
                                options.record_limit)),
           false;
  return true;
}

}  // namespace

int check_run(const LaunchOptions& options, bool with_world) {
  if (!times_are_times(options)) return usage;
  const std::optional<Specification> specification = read_quietly(options.spec);
  if (!specification) return ok;
  if (!parameters_fit(*specification, options)) return failed;
  if (!with_world || !specification->model.simulation) return ok;
  if (!simulation_is_possible(*specification, terminal(), options.world)) return failed;
  static_cast<void>(floor_of(*specification, options));  // throws for a --track that does not exist
  return ok;
}

}  // namespace tessera::cli
