#include "cli/candidates.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "cli/watching/running_controller.hpp"
#include "diagnostics/source.hpp"
#include "net/net.hpp"
#include "project/process/control_connection.hpp"
#include "project/verification/pipeline.hpp"
#include "spec/model/model.hpp"
#include "tessera/monitor.hpp"
#include "verify/verify.hpp"

namespace tessera::cli {

namespace {

constexpr std::size_t most_candidates = 2000;

/// A word as the program gets it: without the quotes and backslashes of the shell.
std::string unquoted(const std::string& word) {
  std::string text;
  for (std::size_t at = 0; at < word.size(); ++at) {
    if (word[at] == '"' || word[at] == '\'') continue;
    if (word[at] == '\\' && at + 1 < word.size()) ++at;
    text += word[at];
  }
  return text;
}

project::Draft specification_of(const std::string& given) {
  diagnostics::Diagnostics text = diagnostics::load(project::spec_file(given));
  return project::draft_of(text);
}

std::vector<std::string> page_values(const std::string& given) {
  const project::Draft known = specification_of(given);
  std::vector<std::string> paths;
  if (!known.nets.pages) return paths;
  const net::HierarchicalNet& net = *known.nets.pages;
  for (std::uint32_t page = 0; page < net.pages.size() && paths.size() < most_candidates; ++page)
    paths.push_back(net.path(net::PageId{page}));
  return paths;
}

/// "v=", "robot.control.gain="
std::vector<std::string> parameter_values(const std::string& given) {
  const project::Draft known = specification_of(given);
  std::vector<std::string> names;
  if (!known.model) return names;
  const spec::Model& model = *known.model;
  for (const spec::Parameter& parameter : model.parameters) names.push_back(parameter.name + "=");
  for (const spec::InstanceId instance : model.instances.ids())
    for (const spec::Parameter& parameter : model.subsystem(instance).parameters)
      if (names.size() < most_candidates)
        names.push_back(model.instance_path(instance) + "." + parameter.name + "=");
  return names;
}

std::vector<std::string> property_values(const std::string& given) {
  const project::Draft known = specification_of(given);
  std::vector<std::string> names;
  if (!known.nets.flat) return names;
  for (std::string& name : verify::default_properties_of(*known.nets.flat)) names.push_back(std::move(name));
  if (known.nets.properties)
    for (const net::Property& property : *known.nets.properties) names.push_back(property.name);
  return names;
}

/// The real buffers with panels of this project; after the name of one of them, its fields: "forward=".
std::vector<std::string> panel_values(const std::string& path) {
  const project::Draft known = specification_of(".");
  std::set<std::string> words;
  if (!known.model) return {};
  std::vector<spec::Driver> drivers = known.model->drivers;
  if (known.model->simulation)
    drivers.insert(drivers.end(), known.model->simulation->drivers.begin(),
                   known.model->simulation->drivers.end());
  for (const spec::Driver& driver : drivers) {
    if (!driver.panel || words.size() >= most_candidates) continue;
    if (path.empty()) words.insert(known.model->driver_path(driver));
    if (known.model->driver_path(driver) != path) continue;
    for (const spec::PanelControl& control : driver.panel->controls) words.insert(control.field + "=");
  }
  return {words.begin(), words.end()};
}

/// The running systems, and processes of them: names like "SYSTEM.PROCESS.PID".
std::vector<std::string> running_systems() {
  std::set<std::string> names;
  for (const std::filesystem::path& file : project::control_sockets(monitor_folder())) {
    std::string name = file.stem().string();
    if (has_shortened_name(file.native())) {
      std::optional<RunningController> one = RunningController::attach(file);
      if (!one) continue;
      one->learn_name();
      name = one->name();
    }
    name.erase(std::min(name.rfind('.'), name.size()));
    if (const std::size_t dot = name.find('.'); dot != std::string::npos) names.insert(name.substr(0, dot));
    names.insert(name);
  }
  return {names.begin(), names.end()};
}

using ValueSource = std::function<std::vector<std::string>(const std::string&)>;

/// The values of an option that come from the project.
const std::map<std::string, ValueSource>& sources_of_values() {
  static const std::map<std::string, ValueSource> sources{
      {"page", page_values}, {"set", parameter_values}, {"property", property_values}};
  return sources;
}

/// The words of the line typed so far.
struct TypedLine {
  const CommandLine::Words* command = nullptr;
  const CommandLine::Word* awaits_value = nullptr;  ///< the option whose value is being typed
  std::vector<std::string> arguments;               ///< without options and their values
};

const CommandLine::Word* find_word(const std::vector<CommandLine::Word>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

TypedLine read_typed_line(const std::vector<CommandLine::Words>& commands,
                          const std::vector<std::string>& before) {
  static const CommandLine::Word state{"state", true, {}};
  TypedLine line;
  for (const std::string& word : before) {
    if (line.awaits_value != nullptr) {
      line.awaits_value = nullptr;
    } else if (word.starts_with("--") && word.find('=') == std::string::npos) {
      const std::string name = word.substr(2);
      const CommandLine::Word* option =
          line.command == nullptr ? nullptr : find_word(line.command->options, name);
      if (name == "state") option = &state;
      if (option != nullptr && option->takes_value) line.awaits_value = option;
    } else if (word.starts_with("-")) {
      continue;
    } else if (line.command == nullptr) {
      const auto found = std::find_if(commands.begin(), commands.end(),
                                      [&](const auto& one) { return one.command == word; });
      if (found == commands.end()) return line;
      line.command = &*found;
    } else {
      line.arguments.push_back(word);
    }
  }
  return line;
}

Candidates all_of(const std::vector<CommandLine::Words>& commands, const TypedLine& line,
                  const std::string& last) {
  Candidates all;
  if (line.awaits_value != nullptr) {
    const auto source = sources_of_values().find(line.awaits_value->name);
    const bool from_project = source != sources_of_values().end() && line.command->command != "set";
    if (from_project) {
      const std::size_t spec = line.command->spec;
      all.words = source->second(line.arguments.size() > spec ? line.arguments[spec] : ".");
    } else {
      all.words = line.awaits_value->values;
      all.files = all.words.empty();
    }
  } else if (line.command == nullptr) {
    for (const CommandLine::Words& one : commands) all.words.push_back(one.command);
    for (const char* option : {"--help", "--version", "--state"}) all.words.emplace_back(option);
  } else if (last.starts_with("-")) {
    for (const CommandLine::Word& option : line.command->options) all.words.push_back("--" + option.name);
    all.words.emplace_back("--state");
  } else if (const std::string& name = line.command->command;
             name == "top" || name == "set" || name == "reset" || name == "emergency-stop") {
    all.words = running_systems();
  } else if (line.command->command == "panel") {
    all.words = panel_values(line.arguments.empty() ? "" : line.arguments.front());
  } else if (!line.command->values.empty() && line.arguments.empty()) {
    all.words = line.command->values;
  } else {
    all.files = true;
  }
  return all;
}

}  // namespace

Candidates candidates(const CommandLine& line, std::vector<std::string> typed) {
  if (typed.empty()) typed.emplace_back();
  // bash splits --page=robot at the sign.
  std::erase(typed, "=");
  for (std::string& word : typed) word = unquoted(word);
  std::string last = typed.back();
  typed.pop_back();
  if (const std::size_t sign = last.find('='); last.starts_with("--") && sign != std::string::npos) {
    typed.push_back(last.substr(0, sign));
    last.erase(0, sign + 1);
  }
  const std::vector<CommandLine::Words> commands = line.words();
  Candidates all = all_of(commands, read_typed_line(commands, typed), last);
  std::erase_if(all.words, [&](const std::string& word) { return !word.starts_with(last) || word.empty(); });
  return all;
}

}  // namespace tessera::cli
