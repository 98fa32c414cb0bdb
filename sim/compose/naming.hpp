#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace tessera::sim {

/// The names of one model file in the composed world. Bodies, joints and the like belong to an instance;
/// assets and default classes belong to the file, so its instances share them.
class Naming {
 public:
  /// instance: prefix of the names of elements, such as "robot[3]/"; empty for those of the world itself.
  /// asset: prefix of the names of assets; empty for those of the world itself.
  /// classes: prefix of the names of default classes, never empty.
  /// main_class: the name of the file's outermost class.
  Naming(std::string instance, std::string asset, std::string classes, std::string main_class);

  /// Renames an element and all elements below it, with the references to other elements.
  void rename(pugi::xml_node element) const;
  [[nodiscard]] std::string element(std::string_view name) const { return instance_ + std::string(name); }
  [[nodiscard]] std::string main_class() const { return classes_ + main_class_; }
  /// Gives the outermost class of the file to elements that have no class, because no body around them has
  /// one. The engine would do the same. Call it before rename().
  void give_main_class(pugi::xml_node element) const;

 private:
  void rename_attributes(pugi::xml_node element) const;

  std::string instance_, asset_, classes_, main_class_;
};

/// Whether the element is an asset that instances share.
[[nodiscard]] bool is_shared_asset(pugi::xml_node element);

}  // namespace tessera::sim
