#pragma once

#include <memory>
#include <pugixml.hpp>
#include <set>
#include <string>

#include "sim/engine/model.hpp"
#include "sim/mjcf/document.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// The settings of <compiler> that change what the numbers of a file mean.
struct CompilerSettings {
  bool angles_in_degrees = true;
  bool strip_path = false;
  bool exact_mesh_inertia = false;
  bool fuses_static_bodies = false;
  std::string euler_sequence = "xyz";
  std::string mesh_folder, texture_folder;
};

/// An MJCF file, prepared to be inserted into another, and the same file compiled alone.
///
/// In the document every body, geom, joint and so on has a name, all numbers have their meaning without a
/// <compiler>, and file names are absolute. References are as in the file; `Naming` renames them.
struct ModelFile {
  std::string path;
  DocumentPtr document;
  CompilerSettings settings;
  std::shared_ptr<const mjModel> alone;
  /// The names given to elements that had none.
  std::set<std::string> generated_names;

  [[nodiscard]] pugi::xml_node root() const { return document->document_element(); }
};

/// Errors: as read_document; the engine refuses the file; global coordinates. The text begins with the name
/// of the file.
[[nodiscard]] Result<std::shared_ptr<const ModelFile>> read_model_file(const std::string& path);

}  // namespace tessera::sim
