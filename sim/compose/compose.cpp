#include "sim/compose/compose.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "sim/compose/composer.hpp"
#include "sim/compose/keyframe.hpp"
#include "sim/compose/option_conflicts.hpp"
#include "sim/mjcf/model_file.hpp"

namespace tessera::sim {
namespace {

constexpr std::size_t most_placements = 10'000;
/// The engine numbers the bodies of a pair with 16 bits each, and does not notice an overflow.
constexpr int most_bodies = 32'000;
constexpr std::size_t longest_name = 200;
/// Beyond this distance, the numbers of the engine and its pictures are too coarse.
constexpr double farthest_m = 1e6;

bool is_usual(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("_-.[]").find(c) != std::string_view::npos;
}

std::optional<Problem> wrong_name(const std::string& name) {
  if (name.empty()) return Problem{"a placement has no name"};
  if (name.size() > longest_name) return Problem{"'" + name.substr(0, 40) + "...': the name is too long"};
  if (name == "world") return Problem{"'world': only the world itself has that name"};
  if (!std::ranges::all_of(name, is_usual))
    return Problem{"'" + name + "': a placement's name has letters, digits and _ - . [ ] only"};
  return std::nullopt;
}

std::optional<Problem> wrong_placement(const Placement& placement) {
  if (auto problem = wrong_name(placement.name)) return problem;
  for (const double number : {placement.x_m, placement.y_m, placement.z_m, placement.heading_rad}) {
    if (!(std::abs(number) <= farthest_m))
      return Problem{placement.name + ": its place is no number, or is farther than 1000 km"};
  }
  return std::nullopt;
}

std::optional<Problem> wrong_placements(const std::vector<Placement>& placements) {
  if (placements.size() > most_placements)
    return Problem{std::to_string(placements.size()) + " placements: at most " +
                   std::to_string(most_placements) + " are possible"};
  std::set<std::string_view> names;
  for (const Placement& placement : placements) {
    if (auto problem = wrong_placement(placement)) return problem;
    if (!names.insert(placement.name).second) return Problem{placement.name + ": is placed twice"};
  }
  return std::nullopt;
}

/// A name of the world that an instance would take: its own as a body, or one that begins with it.
std::optional<Problem> clash(const ModelFile& world, const std::set<std::string_view>& instances) {
  std::optional<Problem> problem;
  const auto visit = [&](pugi::xml_node element) {
    const std::string_view name = element.attribute("name").value();
    const auto slash = name.find('/');
    const bool is_body = std::string_view(element.name()) == "body";
    if (problem || (slash == std::string_view::npos && !is_body)) return;
    const std::string_view first = name.substr(0, slash);
    if (instances.contains(first))
      problem = Problem{std::string(first) + ": " + world.path + " has an element '" + std::string(name) +
                        "'; the placement needs another name"};
  };
  const auto walk = [&](const auto& self, pugi::xml_node node) -> void {
    visit(node);
    for (const pugi::xml_node child : node.children()) self(self, child);
  };
  walk(walk, world.root());
  return problem;
}

/// The model files. Each is read once and gets a name that no other has.
class Library {
 public:
  struct Entry {
    std::shared_ptr<const ModelFile> file;
    std::string id;
  };
  [[nodiscard]] Result<const Entry*> get(const std::string& path) {
    std::error_code none;
    const std::string key = std::filesystem::weakly_canonical(path, none).string();
    if (const auto found = entries_.find(key); found != entries_.end()) return &found->second;
    Result<std::shared_ptr<const ModelFile>> file = read_model_file(path);
    if (!file) return Problem{file.problem()};
    const Entry& entry = entries_[key] = {std::move(*file), unused_id(path)};
    return &entry;
  }

 private:
  std::string unused_id(const std::string& path) {
    std::string stem = std::filesystem::path(path).stem().string();
    std::ranges::replace_if(
        stem, [](char c) { return !is_usual(c); }, '_');
    if (stem.empty()) stem = "model";
    std::string id = stem;
    for (int i = 2; !ids_.insert(id).second; ++i) id = stem + "~" + std::to_string(i);
    return id;
  }
  std::map<std::string, Entry> entries_;
  std::set<std::string> ids_;
};

std::optional<Problem> too_many_bodies(const ModelFile& world, const std::vector<PlacedModel>& placed) {
  std::int64_t bodies = world.alone->nbody;
  for (const PlacedModel& each : placed) bodies += each.alone->nbody;
  if (bodies <= most_bodies) return std::nullopt;
  return Problem{"all models together have " + std::to_string(bodies) + " bodies; MuJoCo 2.2.2 can have " +
                 std::to_string(most_bodies)};
}

/// The engine has one setting for the inertia of meshes, which decides how they lie in their geoms.
std::optional<Problem> mixed_mesh_inertia(const std::vector<const ModelFile*>& files) {
  const ModelFile* first = nullptr;
  for (const ModelFile* file : files) {
    if (file->alone->nmesh == 0) continue;
    if (first == nullptr) first = file;
    if (first->settings.exact_mesh_inertia != file->settings.exact_mesh_inertia)
      return Problem{file->path + " and " + first->path +
                     ": one has `exactmeshinertia`, the other has not; both have meshes"};
  }
  return std::nullopt;
}

bool has_exact_mesh_inertia(const std::vector<const ModelFile*>& files) {
  return std::ranges::any_of(files, [](const ModelFile* file) {
    return file->alone->nmesh > 0 && file->settings.exact_mesh_inertia;
  });
}

/// The file of each placement, and all files, the world first.
struct Chosen {
  std::vector<const Library::Entry*> of_placement;
  std::vector<const ModelFile*> files;
};

/// Reads the files of all placements, and their keyframes.
std::optional<Problem> choose(Library& library, const std::vector<Placement>& placements, Chosen& chosen,
                              Composition& composition) {
  for (const Placement& placement : placements) {
    const Result<const Library::Entry*> entry = library.get(placement.model);
    if (!entry) return Problem{entry.problem()};
    const ModelFile& file = *(*entry)->file;
    chosen.of_placement.push_back(*entry);
    if (std::ranges::find(chosen.files, &file) == chosen.files.end()) chosen.files.push_back(&file);
    if (auto problem = add_initial_values(file, placement, composition.initial)) return problem;
    composition.placed.push_back({placement, file.alone});
  }
  return std::nullopt;
}

std::string composed_text(const Chosen& chosen, const std::vector<Placement>& placements) {
  Composer composer(has_exact_mesh_inertia(chosen.files));
  composer.add_world(*chosen.files.front());
  std::set<const Library::Entry*> added;
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const Library::Entry& entry = *chosen.of_placement[i];
    if (added.insert(&entry).second) composer.add_file(*entry.file, entry.id);
    composer.add_instance(*entry.file, entry.id, placements[i]);
  }
  return composer.text();
}

}  // namespace

Result<Composition> compose(const std::string& world_file, const std::vector<Placement>& placements) {
  if (auto problem = wrong_placements(placements)) return *std::move(problem);
  const Result<std::shared_ptr<const ModelFile>> world = read_model_file(world_file);
  if (!world) return Problem{world.problem()};
  std::set<std::string_view> names;
  for (const Placement& placement : placements) names.insert(placement.name);
  if (auto problem = clash(**world, names)) return *std::move(problem);

  Library library;
  Composition composition;
  Chosen chosen{{}, {world->get()}};
  if (auto problem = choose(library, placements, chosen, composition)) return *std::move(problem);
  if (auto problem = too_many_bodies(**world, composition.placed)) return *std::move(problem);
  if (auto problem = mixed_mesh_inertia(chosen.files)) return *std::move(problem);
  for (const ModelFile* file : chosen.files) add_option_conflicts(*file, **world, composition.warnings);
  composition.mjcf = composed_text(chosen, placements);
  return composition;
}

}  // namespace tessera::sim
