#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "sim/compose/frame.hpp"
#include "sim/compose/naming.hpp"
#include "sim/compose/placement.hpp"
#include "sim/mjcf/model_file.hpp"

namespace tessera::sim {

/// Builds the document of a composed world: the world first, then each file and its instances.
class Composer {
 public:
  explicit Composer(bool exact_mesh_inertia);

  void add_world(const ModelFile& world);
  /// Adds assets and default classes, once per file. id: prefix of their names.
  void add_file(const ModelFile& file, const std::string& id);
  void add_instance(const ModelFile& file, const std::string& id, const Placement& placement);
  [[nodiscard]] std::string text();

 private:
  /// A file and its placement.
  struct Instance {
    const ModelFile& file;
    Naming naming;
    const Placement* placement;  ///< nullptr: the world itself
    Frame frame;
    pugi::xml_node fixed;  ///< the body that holds all parts that do not move freely; made when needed
  };
  void add_shared(const ModelFile& file, const Naming& naming);
  void add_elements(Instance instance);
  void put_in_world(Instance& instance, pugi::xml_node element);
  void put_free(const Instance& instance, pugi::xml_node element, const Frame& frame);
  void put_section(Instance& instance, const char* section);
  void hold_to_instance(Instance& instance, pugi::xml_node equality);
  [[nodiscard]] pugi::xml_node fixed_body(Instance& instance);

  pugi::xml_document document_;
  pugi::xml_document with_state_;  ///< actuators that the engine requires after all others
  pugi::xml_node root_, defaults_, assets_, world_;
};

}  // namespace tessera::sim
