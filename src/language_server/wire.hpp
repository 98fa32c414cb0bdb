#pragma once

#include <nlohmann/json.hpp>

#include "language/language.hpp"

/// The names of the Language Server Protocol for the answers of src/language.
namespace tessera::language_server {

[[nodiscard]] nlohmann::json to_json(const language::Range& range);
[[nodiscard]] language::Position position_of(const nlohmann::json& position);
[[nodiscard]] language::Range range_of(const nlohmann::json& range);
[[nodiscard]] nlohmann::json to_json(const language::Proposal& proposal, std::size_t number);
[[nodiscard]] nlohmann::json to_json(const language::Heading& heading);
/// specification: its URI, for locations that name no file.
[[nodiscard]] nlohmann::json to_json(const language::Location& location, const std::string& specification);
/// document: of which the diagnostic is.
[[nodiscard]] nlohmann::json to_json(const diagnostics::Diagnostic& diagnostic,
                                     const language::Document& document);

/// The capabilities of the client for a set of edits.
struct EditAbilities {
  bool document_changes = false;
  bool annotations = false;  ///< asks the user about edits that are not sure
  bool new_files = false;
};
/// A WorkspaceEdit. Without annotations, edits that are not sure are left out.
[[nodiscard]] nlohmann::json to_json(const std::vector<language::TextEdit>& edits,
                                     const std::string& specification, const EditAbilities& abilities);

}  // namespace tessera::language_server
