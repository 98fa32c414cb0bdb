#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spec/model/model.hpp"

namespace tessera::server {

/// The parameters of a run and their values: from the specification, from the start of the run, and taken
/// since.
class RunParameters {
 public:
  explicit RunParameters(const spec::Model& model);

  /// path, value: as `--set` and the recording have them: "v", "robot.v" or "robot.control.v". A path that
  /// names no parameter changes nothing.
  void set(std::string_view path, const std::string& value);

  /// Makes all values unknown.
  void forget();

  /// [{"path", "type", "unit", "minimum", "maximum", "initial", "value", "differs"}] of docs/reference/studio.md. Those
  /// of the system come first, then those of subsystems.
  [[nodiscard]] nlohmann::json shown() const;

 private:
  struct Shown {
    std::string path, name, type, unit;
    std::optional<double> minimum, maximum;
    std::string initial;
    /// By path of subsystem; nullopt: not known.
    std::map<std::string, std::optional<std::string>, std::less<>> values;
  };
  void add(const spec::Model& model, const spec::Parameter& parameter, const std::vector<std::string>& owners,
           std::string path);
  std::vector<Shown> all_;
};

}  // namespace tessera::server
