#include "ros2/definitions/resolver.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "ros2/naming/names.hpp"
#include "tessera/nearest.hpp"

namespace tessera::ros2 {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t deepest_nesting = 32;
const std::string bundle_separator(80, '=');

/// "geometry_msgs/Vector3"
std::string short_name(std::string name) {
  if (const std::size_t at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
  return name;
}

/// A kind of definition: the name of its folder, which is the ending of its files, too, and its name in texts.
struct Kind {
  const char* ending;
  const char* word;
  bool operator==(const Kind&) const = default;
};
constexpr std::array kinds =
    std::to_array<Kind>({{"msg", "message"}, {"srv", "service"}, {"action", "action"}});

const Kind& kind_of(const std::string& name) {
  return kinds[is_action_type(name) ? 2 : is_service_type(name) ? 1 : 0];
}

class Resolver {
 public:
  Resolver(const Definitions& definitions, std::vector<Mistake>& mistakes)
      : definitions_(definitions), mistakes_(mistakes) {}

  std::shared_ptr<const Structure> resolve(const std::string& name, const std::string& used_by) {
    if (const auto known = known_.find(name); known != known_.end()) return known->second;
    if (std::ranges::find(open_, name) != open_.end() || open_.size() >= deepest_nesting)
      return wrong({}, short_name(name) +
                           (open_.size() >= deepest_nesting ? " is nested too deeply" : " contains itself"));
    const auto text = definitions_.find(name);
    if (!text) return unknown(name, used_by);
    auto parsed = parse_message(name, text->text, text->file, mistakes_);
    return parsed ? complete(name, std::move(*parsed), text->file) : nullptr;
  }

  std::optional<ResolvedService> resolve_service(const std::string& name) {
    const auto text = definitions_.find(name);
    if (!text) {
      unknown(name, "");
      return std::nullopt;
    }
    auto parsed = parse_service(name, text->text, text->file, mistakes_);
    if (!parsed) return std::nullopt;
    ResolvedService service{complete(request_type(name), std::move(parsed->request), text->file),
                            complete(response_type(name), std::move(parsed->response), text->file)};
    if (service.request == nullptr || service.response == nullptr) return std::nullopt;
    return service;
  }

  std::optional<ResolvedAction> resolve_action(const std::string& name) {
    const auto text = definitions_.find(name);
    if (!text) {
      unknown(name, "");
      return std::nullopt;
    }
    auto parsed = parse_action(name, text->text, text->file, mistakes_);
    if (!parsed) return std::nullopt;
    // The two parts get names of messages, as a bundle of definitions needs them.
    const std::string base = name.substr(name.rfind('/') + 1);
    const std::string package = name.substr(0, name.find('/'));
    const auto add = [&](const std::string& ending, Structure part) {
      return complete(package + "/msg/" + base + ending, std::move(part), text->file) != nullptr;
    };
    const bool has_feedback = add("_Feedback", std::move(parsed->feedback));
    const bool has_result = add("_Result", std::move(parsed->result));
    ResolvedAction action{complete(goal_type(name), std::move(parsed->goal), text->file), nullptr};
    if (!has_feedback || !has_result || action.goal == nullptr) return std::nullopt;
    auto progress =
        parse_message(name, base + "_Feedback feedback\n" + base + "_Result result\n", text->file, mistakes_);
    if (progress) action.progress = complete(progress_type(name), std::move(*progress), text->file);
    if (action.progress == nullptr) return std::nullopt;
    return action;
  }

 private:
  /// Looks up the messages that it uses.
  std::shared_ptr<const Structure> complete(const std::string& name, Structure parsed,
                                            const std::string& file) {
    open_.push_back(name);
    bool whole = true;
    for (Field& field : parsed.fields) {
      if (field.type.primitive != Primitive::structure) continue;
      field.type.structure = resolve(field.type.refers, file);
      whole = whole && field.type.structure != nullptr;
    }
    open_.pop_back();
    if (!whole) return nullptr;
    return known_[name] = std::make_shared<const Structure>(std::move(parsed));
  }

  std::shared_ptr<const Structure> wrong(std::string file, std::string text, Hint hint = {}) {
    mistakes_.push_back({std::move(file), 0, std::move(text), std::move(hint)});
    return nullptr;
  }

  std::shared_ptr<const Structure> unknown(const std::string& name, const std::string& used_by) {
    const Kind& kind = kind_of(name);
    std::vector<std::string> names;
    for (const std::string& one : definitions_.names())
      if (kind_of(one) == kind) names.push_back(short_name(one));
    Hint hint = did_you_mean(short_name(name), names);
    if (name.ends_with("/msg/Header"))
      hint = "a definition of ROS 2 has std_msgs/Header; that of ROS 1 has Header";
    if (hint.empty()) hint = definitions_.remedy(name + "." + kind.ending);
    return wrong(used_by, std::string("there is no ") + kind.word + " '" + short_name(name) + "'", hint);
  }

  const Definitions& definitions_;
  std::vector<Mistake>& mistakes_;
  std::map<std::string, std::shared_ptr<const Structure>> known_;
  std::vector<std::string> open_;
};

}  // namespace

std::string Definitions::remedy(const std::string& file) const {
  return "write its definition into msg/" + file + " beside the specification";
}

std::string DefinitionFolders::remedy(const std::string& file) const {
  const DefinitionFolders installations = of_installations();
  const std::string begin = Definitions::remedy(file);
  if (installations.empty()) return begin + ", or source a ROS 2 installation that has it";
  constexpr std::size_t most = 3;
  std::string list;
  for (std::size_t at = 0; at < installations.folders_.size() && at < most; ++at)
    list += (at == 0 ? "" : ", ") + installations.folders_[at].path.string();
  if (installations.folders_.size() > most)
    list += " and " + std::to_string(installations.folders_.size() - most) + " more";
  return begin + ", or source a ROS 2 installation that has it; looked in msg, " + list +
         ", and Tessera's own";
}

DefinitionFolders DefinitionFolders::of_installations() const {
  DefinitionFolders installations({});
  std::ranges::copy_if(folders_, std::back_inserter(installations.folders_), &Folder::is_installation);
  return installations;
}

DefinitionFolders::DefinitionFolders(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders)
    folders_.push_back({folder, &folder != &folders.front() && &folder != &folders.back()});
}

bool DefinitionFolders::Folder::has(const std::string& package) const {
  std::error_code ignored;
  return !is_installation ||
         fs::exists(path / "ament_index/resource_index/rosidl_interfaces" / package, ignored);
}

std::vector<fs::path> folders_of_installations(std::string_view ament_prefix_path) {
  std::vector<fs::path> folders;
  while (!ament_prefix_path.empty()) {
    const std::size_t colon = std::min(ament_prefix_path.find(':'), ament_prefix_path.size());
    const fs::path folder = fs::path(ament_prefix_path.substr(0, colon)) / "share";
    ament_prefix_path.remove_prefix(std::min(colon + 1, ament_prefix_path.size()));
    std::error_code ignored;
    if (folder.is_absolute() && fs::is_directory(folder, ignored) &&
        std::ranges::find(folders, folder) == folders.end())
      folders.push_back(folder);
  }
  return folders;
}

bool have_same_bytes(const Structure& a, const Structure& b) {
  return std::ranges::equal(a.fields, b.fields, [](const Field& one, const Field& other) {
    if (one.name != other.name || one.type.text() != other.type.text()) return false;
    return one.type.structure == nullptr || have_same_bytes(*one.type.structure, *other.type.structure);
  });
}

std::optional<DefinitionFolders::Text> DefinitionFolders::find(const std::string& name) const {
  for (const Folder& folder : folders_) {
    const fs::path file = folder.path / (name + "." + kind_of(name).ending);
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored) || !folder.has(name.substr(0, name.find('/')))) continue;
    std::ifstream stream(file, std::ios::binary);
    return Text{{std::istreambuf_iterator<char>(stream), {}}, file.string()};
  }
  return std::nullopt;
}

std::vector<std::string> DefinitionFolders::names() const {
  std::set<std::string> found;
  std::error_code ignored;
  for (const Folder& folder : folders_)
    for (const auto& package : fs::directory_iterator(folder.path, ignored))
      for (const auto& [ending, word] : kinds)
        for (const auto& file : fs::directory_iterator(package.path() / ending, ignored))
          if (file.path().extension() == std::string(".") + ending &&
              folder.has(package.path().filename().string()))
            found.insert(package.path().filename().string() + "/" + ending + "/" +
                         file.path().stem().string());
  return {found.begin(), found.end()};
}

DefinitionBundle::DefinitionBundle(std::string name, std::string_view text) {
  messages_.emplace_back(std::move(name), "");
  bool names_next = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (names_next && line.starts_with("MSG: "))
      messages_.emplace_back(full_message_name(line.substr(5)).value_or(line.substr(5)), "");
    else if (line != bundle_separator)
      messages_.back().second += line + '\n';
    names_next = line == bundle_separator;
  }
}

std::optional<DefinitionBundle::Text> DefinitionBundle::find(const std::string& name) const {
  for (const auto& [known, text] : messages_)
    if (known == name) return Text{text, name};
  return std::nullopt;
}

std::vector<std::string> DefinitionBundle::names() const {
  std::vector<std::string> names;
  for (const auto& message : messages_) names.push_back(message.first);
  return names;
}

std::shared_ptr<const Structure> resolve(const std::string& name, const Definitions& definitions,
                                         std::vector<Mistake>& mistakes) {
  return Resolver(definitions, mistakes).resolve(name, "");
}

std::optional<ResolvedService> resolve_service(const std::string& name, const Definitions& definitions,
                                               std::vector<Mistake>& mistakes) {
  return Resolver(definitions, mistakes).resolve_service(name);
}

std::optional<ResolvedAction> resolve_action(const std::string& name, const Definitions& definitions,
                                             std::vector<Mistake>& mistakes) {
  return Resolver(definitions, mistakes).resolve_action(name);
}

std::string bundle_of(const Structure& message) {
  std::string text = message.text;
  std::set<std::string> said;
  const std::function<void(const Structure&)> add = [&](const Structure& structure) {
    for (const Field& field : structure.fields) {
      if (field.type.structure == nullptr || !said.insert(field.type.refers).second) continue;
      text +=
          bundle_separator + "\nMSG: " + short_name(field.type.refers) + '\n' + field.type.structure->text;
      add(*field.type.structure);
    }
  };
  add(message);
  return text;
}

}  // namespace tessera::ros2
