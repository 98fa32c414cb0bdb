#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "sim/mjcf/preparation.hpp"
#include "sim/mjcf/xml.hpp"

namespace tessera::sim {
namespace {

namespace fs = std::filesystem;

void make_absolute(pugi::xml_node asset, const CompilerSettings& settings, const fs::path& folder) {
  const bool is_texture = std::string_view(asset.name()) == "texture";
  for (pugi::xml_attribute attribute : asset.attributes()) {
    const std::string_view key = attribute.name();
    if (!key.starts_with("file") || *attribute.value() == '\0') continue;
    fs::path file = attribute.value();
    if (settings.strip_path) file = file.filename();
    if (file.is_relative())
      file = folder / (is_texture ? settings.texture_folder : settings.mesh_folder) / file;
    attribute.set_value(file.c_str());
  }
}

/// Elements of a section, or of a body, that can have a name.
bool can_have_name(pugi::xml_node element, std::string_view section) {
  static constexpr std::array<std::string_view, 7> in_bodies{"body", "joint",  "freejoint", "geom",
                                                             "site", "camera", "light"};
  if (section == "worldbody") {
    return stands_in_body(element) &&
           std::ranges::find(in_bodies, std::string_view(element.name())) != in_bodies.end();
  }
  return std::string_view(element.parent().name()) == section;
}

}  // namespace

void make_files_absolute(pugi::xml_node root, const CompilerSettings& settings, const std::string& folder) {
  for (const pugi::xml_node section : root.children("asset")) {
    for (const pugi::xml_node asset : section.children()) {
      const fs::path file = asset.attribute("file").value();
      if (!file.empty() && *asset.attribute("name").value() == '\0')
        set_attribute(asset, "name", file.stem().string());
      make_absolute(asset, settings, folder);
    }
  }
  for (pugi::xml_node compiler : root.children("compiler")) {
    for (const char* attribute : {"meshdir", "texturedir", "strippath", "fusestatic"})
      compiler.remove_attribute(attribute);
  }
}

std::set<std::string> name_all(pugi::xml_node root) {
  static constexpr std::array<const char*, 6> sections{"worldbody", "contact",  "equality",
                                                       "tendon",    "actuator", "sensor"};
  std::set<std::string> taken, made;
  for_each_element(root, [&](pugi::xml_node element) { taken.insert(element.attribute("name").value()); });
  std::size_t count = 0;
  for (const char* section : sections) {
    for (const pugi::xml_node part : root.children(section)) {
      for_each_element(part, [&](pugi::xml_node element) {
        if (!can_have_name(element, section) || *element.attribute("name").value() != '\0') return;
        std::string name;
        do name = "(" + std::to_string(++count) + ")";
        while (taken.contains(name));
        set_attribute(element, "name", name);
        made.insert(name);
      });
    }
  }
  return made;
}

}  // namespace tessera::sim
