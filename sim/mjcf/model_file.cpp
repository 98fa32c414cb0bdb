#include "sim/mjcf/model_file.hpp"

#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "sim/mjcf/compile.hpp"
#include "sim/mjcf/preparation.hpp"

namespace tessera::sim {
namespace {

CompilerSettings settings_of(pugi::xml_node root) {
  CompilerSettings settings;
  for (const pugi::xml_node compiler : root.children("compiler")) {
    for (const pugi::xml_attribute attribute : compiler.attributes()) {
      const std::string_view key = attribute.name(), value = attribute.value();
      const bool is_true = value == "true";
      if (key == "angle") settings.angles_in_degrees = value != "radian";
      if (key == "strippath") settings.strip_path = is_true;
      if (key == "exactmeshinertia") settings.exact_mesh_inertia = is_true;
      if (key == "fusestatic") settings.fuses_static_bodies = is_true;
      if (key == "eulerseq") settings.euler_sequence = value;
      if (key == "meshdir") settings.mesh_folder = value;
      if (key == "texturedir") settings.texture_folder = value;
    }
  }
  return settings;
}

bool has_global_coordinates(pugi::xml_node root) {
  bool global = false;
  for (const pugi::xml_node compiler : root.children("compiler")) {
    if (const pugi::xml_attribute way = compiler.attribute("coordinate"); way)
      global = std::string_view(way.value()) == "global";
  }
  return global;
}

std::string folder_of(const std::string& file) {
  std::error_code none;
  return std::filesystem::absolute(file, none).parent_path().string();
}

std::string text_of(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "", pugi::format_raw);
  return std::move(text).str();
}

/// The file itself is compiled again for its message, which names the lines of the file.
Problem why_not(const std::string& path, const std::string& complaint_of_prepared) {
  const Result<ModelPtr> model = load_model(path);
  if (model) return Problem{path + ": " + complaint_of_prepared};
  return Problem{model.problem()};
}

}  // namespace

Result<std::shared_ptr<const ModelFile>> read_model_file(const std::string& path) {
  Result<DocumentPtr> document = read_document(path);
  if (!document) return Problem{document.problem()};
  auto file = std::make_shared<ModelFile>();
  file->path = path;
  file->document = std::move(*document);
  file->settings = settings_of(file->root());
  make_files_absolute(file->root(), file->settings, folder_of(path));
  file->generated_names = name_all(file->root());
  Result<ModelPtr> alone = compile_text(text_of(*file->document));
  if (!alone) return why_not(path, alone.problem());
  if (has_global_coordinates(file->root()))
    return Problem{path + ": has global coordinates, which are not composed"};
  file->alone = std::move(*alone);
  write_derived_values(file->root(), file->settings, *file->alone);
  normalise_orientations(file->root(), file->settings);
  return std::shared_ptr<const ModelFile>(std::move(file));
}

}  // namespace tessera::sim
