#include "sim/compose/naming.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "sim/mjcf/xml.hpp"

namespace tessera::sim {
namespace {

/// Attributes that name an element of the same instance.
constexpr auto instance_references = std::to_array<std::string_view>(
    {"target", "geom",    "geom1",      "geom2",         "body",     "body1",   "body2",
     "joint",  "joint1",  "joint2",     "jointinparent", "tendon",   "tendon1", "tendon2",
     "site",   "refsite", "slidersite", "cranksite",     "sidesite", "actuator"});
/// Attributes that name an asset of the same file.
constexpr auto asset_references = std::to_array<std::string_view>({"mesh", "hfield", "material", "texture"});
constexpr auto shared_assets = asset_references;
constexpr auto elements_with_class = std::to_array<std::string_view>(
    {"joint",       "geom",     "site",     "camera", "light",    "pair",  "connect",  "weld",
     "tendon",      "distance", "spatial",  "fixed",  "general",  "motor", "position", "velocity",
     "intvelocity", "damper",   "cylinder", "muscle", "adhesion", "mesh",  "material"});

template <std::size_t N>
bool among(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

void prepend(pugi::xml_attribute attribute, const std::string& prefix) {
  attribute.set_value((prefix + attribute.value()).c_str());
}

/// `objname` and `refname` name an element of the kind in `objtype` and `reftype`.
bool names_an_asset(pugi::xml_node element, std::string_view key) {
  return among(shared_assets, element.attribute(key == "objname" ? "objtype" : "reftype").value());
}

}  // namespace

bool is_shared_asset(pugi::xml_node element) { return among(shared_assets, element.name()); }

Naming::Naming(std::string instance, std::string asset, std::string classes, std::string main_class)
    : instance_(std::move(instance)),
      asset_(std::move(asset)),
      classes_(std::move(classes)),
      main_class_(std::move(main_class)) {}

void Naming::rename(pugi::xml_node element) const {
  for_each_element(element, [this](pugi::xml_node each) { rename_attributes(each); });
}

void Naming::rename_attributes(pugi::xml_node element) const {
  const bool is_asset = is_shared_asset(element);
  for (const pugi::xml_attribute attribute : element.attributes()) {
    const std::string_view key = attribute.name(), value = attribute.value();
    if (value.empty()) continue;
    if (key == "name") {
      prepend(attribute, is_asset ? asset_ : instance_);
    } else if (key == "class" || key == "childclass") {
      prepend(attribute, classes_);
    } else if (among(asset_references, key)) {
      prepend(attribute, asset_);
    } else if (value == "world") {
      continue;  // the one body that all instances share
    } else if (key == "objname" || key == "refname") {
      prepend(attribute, names_an_asset(element, key) ? asset_ : instance_);
    } else if (among(instance_references, key)) {
      prepend(attribute, instance_);
    }
  }
  if (std::string_view(element.name()) == "composite")
    set_attribute(element, "prefix", instance_ + element.attribute("prefix").value());
}

void Naming::give_main_class(pugi::xml_node element) const {
  if (!is_element(element)) return;
  const std::string_view name = element.name();
  if (name == "body") {
    if (*element.attribute("childclass").value() == '\0') set_attribute(element, "childclass", main_class_);
  } else if (among(elements_with_class, name) && *element.attribute("class").value() == '\0') {
    set_attribute(element, "class", main_class_);
  }
}

}  // namespace tessera::sim
