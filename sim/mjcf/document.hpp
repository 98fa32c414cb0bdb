#pragma once

#include <memory>
#include <pugixml.hpp>
#include <string>

#include "tessera/result.hpp"

namespace tessera::sim {

using DocumentPtr = std::unique_ptr<pugi::xml_document>;

/// Reads an MJCF file and replaces its includes by the content of the included files.
///
/// Errors: a file is missing, empty, no XML, larger than 64 MB or included twice; the root is not <mujoco>;
/// elements are nested too deeply, or a count in it is gigantic. The text begins with the name of the file.
[[nodiscard]] Result<DocumentPtr> read_document(const std::string& file);

}  // namespace tessera::sim
