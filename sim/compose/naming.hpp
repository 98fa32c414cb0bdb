#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace tessera::sim {

/// How the names of one model file appear in the composed world. Bodies, joints and the like belong to an
/// instance; assets and default classes belong to the file, so that its instances share them.
class Naming {
 public:
  /// instance: in front of names of elements, such as "robot[3]/"; empty for those of the world itself.
  /// asset: in front of names of assets; empty for those of the world itself.
  /// classes: in front of names of default classes, never empty.
  /// main_class: what the file calls its outermost class.
  Naming(std::string instance, std::string asset, std::string classes, std::string main_class);

  /// Renames an element and all below it, with the references to other elements.
  void rename(pugi::xml_node element) const;
  [[nodiscard]] std::string element(std::string_view name) const { return instance_ + std::string(name); }
  [[nodiscard]] std::string main_class() const { return classes_ + main_class_; }
  /// Elements that have no class, because no body around them has one, get the outermost of their file,
  /// which the engine would give them. Done before rename().
  void give_main_class(pugi::xml_node element) const;

 private:
  void rename_attributes(pugi::xml_node element) const;

  std::string instance_, asset_, classes_, main_class_;
};

/// Whether the element is an asset that instances share.
[[nodiscard]] bool is_shared_asset(pugi::xml_node element);

}  // namespace tessera::sim
