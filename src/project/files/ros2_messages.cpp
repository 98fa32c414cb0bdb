#include "project/files/ros2_messages.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "project/files/installation.hpp"
#include "project/files/ros2_services.hpp"
#include "ros2/codec/translator.hpp"
#include "ros2/codec/value_type.hpp"
#include "ros2/codec/written_mapping.hpp"
#include "ros2/definitions/resolver.hpp"
#include "ros2/naming/names.hpp"
#include "ros2/tf/transform_value.hpp"
#include "tessera/units.hpp"

namespace tessera::project {

namespace fs = std::filesystem;

/// Beside the specification.
constexpr const char* messages_folder = "msg";

std::string text_option(const spec::Driver& driver, const char* name) {
  const auto found = driver.options.find(name);
  const auto* const text =
      found == driver.options.end() ? nullptr : std::get_if<std::string>(&found->second.value);
  return text == nullptr ? std::string() : *text;
}

bool has_role(const spec::Driver& driver) { return !text_option(driver, "role").empty(); }
bool is_action(const spec::Driver& driver) { return ros2::is_action_type(text_option(driver, "type")); }

bool is_transform(const spec::Driver& driver) { return driver.options.contains("frame"); }

bool is_effector(const spec::Model& model, const spec::Driver& driver) {
  return model.subsystem(driver.instance).kind == spec::SubsystemKind::effector;
}

namespace {

diagnostics::Span place_in(const spec::Driver& driver, const std::string& option) {
  for (const std::string& name : {"fields." + option, option, std::string("fields"), std::string("type")})
    if (const auto found = driver.option_spans.find(name); found != driver.option_spans.end())
      return found->second;
  return driver.span;
}

/// Packages whose messages are in SI units (REP 103). Messages of others, such as px4_msgs, choose their own.
constexpr auto packages_in_si = std::to_array<std::string_view>(
    {"control_msgs", "geometry_msgs", "nav_msgs", "sensor_msgs", "tf2_msgs", "trajectory_msgs"});

bool is_in_si(std::string_view type) {
  if (type.ends_with("/NavSatFix")) return false;  // latitude and longitude are in degrees
  return std::ranges::find(packages_in_si, type.substr(0, type.find('/'))) != packages_in_si.end();
}

/// A number of a buffer, and its unit.
struct UnitOfField {
  std::string field, unit;
};

/// The first one that has a known unit, which is none of SI.
std::optional<UnitOfField> unit_beside_si(const spec::Model& model, const spec::Type& type,
                                          const std::string& field) {
  if (type.kind != spec::Type::Kind::structure) {
    const std::optional<Unit> unit = read_unit(type.unit);
    if (type.unit.empty() || !unit || unit->factor() == 1) return std::nullopt;
    return UnitOfField{field, type.unit};
  }
  for (const spec::Field& member : model.structures[type.structure].fields)
    if (auto found = unit_beside_si(model, member.type, field + "." + member.name)) return found;
  return std::nullopt;
}

/// One message for a whole fleet.
class MessageFinder {
 public:
  MessageFinder(const spec::Model& model, const std::vector<fs::path>& folders, diagnostics::Diagnostics& out)
      : model_(model), definitions_(folders), out_(out) {}

  bool find(spec::Driver& driver) {
    const std::string name = text_option(driver, "type");
    std::vector<ros2::Mistake> mistakes;
    const auto message = message_of(driver, name, definitions_, mistakes);
    for (const ros2::Mistake& mistake : mistakes) {
      const std::string file =
          mistake.line == 0 ? mistake.file : mistake.file + ":" + std::to_string(mistake.line);
      complain("E320", place_in(driver, "type"), (file.empty() ? "" : file + ": ") + mistake.text,
               mistake.file.empty() ? mistake.hint : mistake.hint.text);
    }
    if (message == nullptr) return false;
    compare_with_installations(driver, name, *message);
    driver.options["definition"] = spec::DriverOption{ros2::bundle_of(*message), ""};
    return fits(driver, message);
  }

  /// Whether every transform at the stamps of another buffer has such a buffer beside it. The messages are found.
  bool check_stamps(const std::vector<spec::Driver>& drivers) {
    bool good = true;
    for (const spec::Driver& driver : drivers) {
      const std::string at = text_option(driver, "at");
      if (driver.kind != "ros2" || !is_transform(driver) || at.empty() || is_effector(model_, driver))
        continue;
      const auto has_stamps = [&](const spec::Driver& other) { return gives_stamps(driver, at, other); };
      if (std::ranges::any_of(drivers, has_stamps)) continue;
      complain("E321", place_in(driver, "at"),
               "'" + at + "' is no real buffer beside it whose messages begin with a `header`",
               "name one of the same receptor with a topic such as sensor_msgs/msg/LaserScan");
      good = false;
    }
    return good;
  }

 private:
  [[nodiscard]] bool gives_stamps(const spec::Driver& driver, const std::string& at,
                                  const spec::Driver& other) const {
    if (other.instance != driver.instance || other.kind != "ros2" || !other.real.valid() || has_role(other) ||
        is_transform(other) || model_.subsystem(other.instance).real[other.real].name != at)
      return false;
    const std::string type = text_option(other, "type");
    std::vector<ros2::Mistake> told_before;
    const auto message =
        ros2::resolve(type, ros2::DefinitionBundle(type, text_option(other, "definition")), told_before);
    return message == nullptr || ros2::begins_with_header(*message);
  }

  /// For a service or action: the message of the buffer.
  [[nodiscard]] std::shared_ptr<const ros2::Structure> message_of(
      const spec::Driver& driver, const std::string& name, const ros2::Definitions& definitions,
      std::vector<ros2::Mistake>& mistakes) const {
    if (is_transform(driver)) return ros2::transform_structure();
    if (!has_role(driver)) return ros2::resolve(name, definitions, mistakes);
    if (is_action(driver)) {
      const auto action = ros2::resolve_action(name, definitions, mistakes);
      if (!action) return nullptr;
      return asks(driver) ? action->goal : action->progress;
    }
    const auto service = ros2::resolve_service(name, definitions, mistakes);
    if (!service) return nullptr;
    return asks(driver) ? service->request : service->response;
  }
  /// Nodes of an installation misread messages of another definition, and the project's is used.
  void compare_with_installations(const spec::Driver& driver, const std::string& name,
                                  const ros2::Structure& message) {
    const ros2::DefinitionFolders installations = definitions_.of_installations();
    const auto file = installations.find(name);
    if (!file) return;
    std::vector<ros2::Mistake> unasked;
    const auto other = message_of(driver, name, installations, unasked);
    if (other == nullptr || have_same_bytes(message, *other)) return;
    const diagnostics::Span place = place_in(driver, "type");
    if (said_.insert({place, "W341"}).second)
      out_.warning("W341", place,
                   "the definition in msg beside the specification is not that of " + file->file,
                   "nodes of that installation drop or misread the messages: make both equal");
  }
  static bool is_client(const spec::Driver& driver) { return text_option(driver, "role") == "client"; }
  /// Whether its messages go from client to server.
  [[nodiscard]] bool asks(const spec::Driver& driver) const {
    return is_client(driver) == is_effector(model_, driver);
  }

  void complain(const char* code, const diagnostics::Span& place, const std::string& text, const Hint& hint) {
    if (said_.insert({place, text}).second) out_.error(code, place, text, hint);
  }

  bool fits(const spec::Driver& driver, std::shared_ptr<const ros2::Structure> message) {
    const spec::Subsystem& subsystem = model_.subsystem(driver.instance);
    const auto value = ros2::parse_value_type(model_.layout_of(subsystem.real[driver.real].type));
    if (!value) return true;  // a type that is wrong in itself, which another function reports
    ros2::Mapping mapping = ros2::written_mapping(text_option(driver, "fields"), text_option(driver, "names"),
                                                  text_option(driver, "frame_id"));
    const bool sends = is_effector(model_, driver);
    if (sends && driver.options.contains("publishers")) {
      complain("E321", place_in(driver, "publishers"), "an effector has no 'publishers'",
               "it publishes itself; the controller warns of others (docs/use/ros2.md)");
      return false;
    }
    const auto direction = sends ? ros2::Direction::send : ros2::Direction::receive;
    if (is_action(driver))
      mapping = ros2::mapping_of_action(std::move(mapping), asks(driver), direction);
    else if (has_role(driver))
      mapping.own = ros2::own_fields_of_service(is_client(driver) && !sends);
    if (is_transform(driver) && !check_transform(driver, mapping, *value)) return false;
    if (is_transform(driver) && sends) mapping.own = ros2::own_fields_of_transform();
    std::vector<ros2::MappingProblem> problems;
    if (ros2::Translator::make(std::move(message), *value, mapping, direction, problems))
      return has_its_units(driver);
    for (const ros2::MappingProblem& problem : problems)
      complain("E321", place_in(driver, problem.subject), problem.text, problem.hint);
    return false;
  }

  bool check_transform(const spec::Driver& driver, const ros2::Mapping& mapping,
                       const ros2::ValueType& value) {
    if (is_effector(model_, driver)) {
      if (driver.options.contains("at")) {
        complain("E321", place_in(driver, "at"), "an effector has no 'at'",
                 "its stamp is the time of sending, or the field `stamp` of the transform");
        return false;
      }
      const auto problem = ros2::problem_of_sent_transform(mapping, value);
      if (problem) complain("E321", place_in(driver, problem->subject), problem->text, problem->hint);
      return !problem;
    }
    const std::string& topic = driver.target();
    if (!ros2::is_static_topic("/" + topic)) return true;
    complain("E321", driver.targets.front().span, "a receptor reads /tf and /tf_static together",
             "write `ros2: " + topic.substr(0, topic.rfind('_')) + "`");
    return false;
  }

  bool has_its_units(const spec::Driver& driver) {
    const spec::Field& buffer = model_.subsystem(driver.instance).real[driver.real];
    const std::string type = text_option(driver, "type");
    const auto found = is_in_si(type) ? unit_beside_si(model_, buffer.type, buffer.name) : std::nullopt;
    if (!found) return true;
    const std::string si = si_name(*read_unit(found->unit));
    complain("E218", place_in(driver, "type"),
             "messages of " + type.substr(0, type.find('/')) + " are in SI units, and " + found->field +
                 " is declared in " + found->unit,
             "declare it in " + si + ", and convert it in the transition function");
    return false;
  }

  const spec::Model& model_;
  ros2::DefinitionFolders definitions_;
  diagnostics::Diagnostics& out_;
  std::set<std::pair<diagnostics::Span, std::string>> said_;
};

}  // namespace

bool find_messages_in(spec::Model& model, const std::vector<fs::path>& folders,
                      diagnostics::Diagnostics& out) {
  std::vector<spec::Driver> drivers = std::move(model.drivers);
  MessageFinder finder(model, folders, out);
  bool found = true;
  for (spec::Driver& driver : drivers)
    if (driver.kind == "ros2") found = finder.find(driver) && found;
  found = finder.check_stamps(drivers) && found;
  found = check_services(model, drivers, out) && found;
  model.drivers = std::move(drivers);
  return found;
}

std::string state_of_messages(const fs::path& project) {
  std::set<std::string> files;
  std::error_code gone;
  for (fs::recursive_directory_iterator file(project / messages_folder, gone), end; !gone && file != end;
       file.increment(gone)) {
    std::error_code ignored;
    const auto changed = fs::last_write_time(file->path(), ignored).time_since_epoch().count();
    files.insert(file->path().string() + " " + std::to_string(changed));
  }
  std::string state;
  for (const std::string& file : files) state += file + "\n";
  return state;
}

bool find_messages(spec::Model& model, const fs::path& project, diagnostics::Diagnostics& out) {
  const auto is_topic = [](const spec::Driver& driver) { return driver.kind == "ros2"; };
  if (std::ranges::none_of(model.drivers, is_topic)) return true;
  std::vector<fs::path> folders{project / messages_folder};
  const char* const prefixes = std::getenv("AMENT_PREFIX_PATH");
  for (fs::path& folder : ros2::folders_of_installations(prefixes == nullptr ? "" : prefixes))
    folders.push_back(std::move(folder));
  folders.push_back(Installation::find().share / "ros2");
  return find_messages_in(model, folders, out);
}

}  // namespace tessera::project
