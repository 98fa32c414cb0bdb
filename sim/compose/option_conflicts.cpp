#include "sim/compose/option_conflicts.hpp"

#include <algorithm>
#include <array>

#include "sim/mjcf/xml.hpp"

namespace tessera::sim {
namespace {

class OptionConflicts {
 public:
  OptionConflicts(const ModelFile& file, std::vector<std::string>& warnings)
      : file_(file), warnings_(warnings) {}

  void compare(const char* option, const mjtNum* wanted, const mjtNum* given, std::size_t count = 1) {
    if (!std::equal(wanted, wanted + count, given))
      warn(option, numbers_text(wanted, count), numbers_text(given, count));
  }
  void compare(const char* option, int wanted, int given, const auto& words) {
    if (wanted != given)
      warn(option, words[static_cast<std::size_t>(wanted)], words[static_cast<std::size_t>(given)]);
  }
  /// Only an option that the file sets counts.
  [[nodiscard]] bool sets(const char* option) const {
    for (const pugi::xml_node options : file_.root().children("option")) {
      if (options.attribute(option)) return true;
    }
    return false;
  }

 private:
  void warn(const std::string& option, const std::string& wanted, const std::string& given) {
    warnings_.push_back(file_.path + ": wants the option " + option + "=\"" + wanted +
                        "\"; the world has \"" + given + "\"");
  }
  const ModelFile& file_;
  std::vector<std::string>& warnings_;
};

}  // namespace

void add_option_conflicts(const ModelFile& file, const ModelFile& world, std::vector<std::string>& warnings) {
  static constexpr std::array integrators{"Euler", "RK4", "implicit"};
  static constexpr std::array cones{"pyramidal", "elliptic"};
  const mjOption &wanted = file.alone->opt, &given = world.alone->opt;
  OptionConflicts conflicts(file, warnings);
  if (conflicts.sets("timestep") && wanted.timestep < given.timestep)
    conflicts.compare("timestep", &wanted.timestep, &given.timestep);
  if (conflicts.sets("gravity")) conflicts.compare("gravity", wanted.gravity, given.gravity, 3);
  if (conflicts.sets("density")) conflicts.compare("density", &wanted.density, &given.density);
  if (conflicts.sets("viscosity")) conflicts.compare("viscosity", &wanted.viscosity, &given.viscosity);
  if (conflicts.sets("wind")) conflicts.compare("wind", wanted.wind, given.wind, 3);
  if (conflicts.sets("impratio")) conflicts.compare("impratio", &wanted.impratio, &given.impratio);
  if (conflicts.sets("integrator"))
    conflicts.compare("integrator", wanted.integrator, given.integrator, integrators);
  if (conflicts.sets("cone")) conflicts.compare("cone", wanted.cone, given.cone, cones);
  if (file.settings.fuses_static_bodies)
    warnings.push_back(file.path + ": `fusestatic` has no effect, its bodies stay as they are");
}

}  // namespace tessera::sim
