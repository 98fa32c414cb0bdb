#include "language_server/wire.hpp"

#include <fmt/format.h>

#include <map>

namespace tessera::language_server {

using language::Kind;
using nlohmann::json;

namespace {

json position_json(const language::Position& position) {
  return {{"line", position.line}, {"character", position.character}};
}

/// SymbolKind of the protocol.
int symbol_kind(Kind kind) {
  switch (kind) {
    case Kind::type:
      return 23;  // Struct
    case Kind::field:
      return 8;  // Field
    case Kind::parameter:
      return 14;  // Constant
    case Kind::memory:
      return 13;  // Variable
    case Kind::value:
      return 22;  // EnumMember
    case Kind::input:
    case Kind::output:
    case Kind::real:
      return 7;  // Property
    case Kind::behaviour:
      return 12;  // Function
    case Kind::condition:
      return 17;  // Boolean
    case Kind::subsystem:
      return 2;  // Module
    case Kind::model:
      return 11;  // Interface
    default:
      return 5;  // Class
  }
}

/// CompletionItemKind of the protocol.
int completion_kind(language::Proposal::Kind kind) {
  switch (kind) {
    case language::Proposal::Kind::key:
      return 10;  // Property
    case language::Proposal::Kind::type:
      return 22;  // Struct
    case language::Proposal::Kind::name:
      return 6;  // Variable
    case language::Proposal::Kind::example:
      return 12;  // Value
    default:
      return 14;  // Keyword
  }
}

constexpr const char* unsure = "unsure";

}  // namespace

json to_json(const language::Range& range) {
  return {{"start", position_json(range.start)}, {"end", position_json(range.end)}};
}

language::Position position_of(const json& position) {
  return {position.at("line").get<std::uint32_t>(), position.at("character").get<std::uint32_t>()};
}

language::Range range_of(const json& range) {
  return {position_of(range.at("start")), position_of(range.at("end"))};
}

json to_json(const language::Proposal& proposal, std::size_t number) {
  json item{{"label", proposal.label},
            {"kind", completion_kind(proposal.kind)},
            {"sortText", fmt::format("{:04}", number)},
            {"textEdit", {{"range", to_json(proposal.range)}, {"newText", proposal.insert}}}};
  if (!proposal.detail.empty()) item["detail"] = proposal.detail;
  if (!proposal.documentation.empty()) item["documentation"] = proposal.documentation;
  return item;
}

json to_json(const language::Heading& heading) {
  json inside = json::array();
  for (const language::Heading& one : heading.inside) inside.push_back(to_json(one));
  return {{"name", heading.name},
          {"detail", heading.detail},
          {"kind", symbol_kind(heading.kind)},
          {"range", to_json(heading.whole)},
          {"selectionRange", to_json(heading.name_range)},
          {"children", std::move(inside)}};
}

json to_json(const language::Location& location, const std::string& specification) {
  return {{"uri", location.path.empty() ? specification : location.path}, {"range", to_json(location.range)}};
}

json to_json(const diagnostics::Diagnostic& diagnostic, const language::Document& document) {
  const int severity = diagnostic.severity == diagnostics::Severity::error     ? 1
                       : diagnostic.severity == diagnostics::Severity::warning ? 2
                                                                               : 3;
  return {{"range", to_json(language::range_of(document, diagnostic.span))},
          {"severity", severity},
          {"code", diagnostic.code},
          {"source", "tessera"},
          {"message",
           diagnostic.hint.empty() ? diagnostic.message : diagnostic.message + "\n" + diagnostic.hint}};
}

json to_json(const std::vector<language::TextEdit>& edits, const std::string& specification,
             const EditAbilities& abilities) {
  std::map<std::string, json> of_file;
  bool asks = false;
  for (const language::TextEdit& edit : edits) {
    if (!edit.sure && !abilities.annotations) continue;
    json one{{"range", to_json(edit.range)}, {"newText", edit.text}};
    if (!edit.sure) {
      one["annotationId"] = unsure;
      asks = true;
    }
    json& file = of_file[edit.path.empty() ? specification : edit.path];
    if (file.is_null()) file = json::array();
    file.push_back(std::move(one));
  }
  if (!abilities.document_changes) {
    json changes = json::object();
    for (auto& [uri, list] : of_file) changes[uri] = std::move(list);
    return {{"changes", std::move(changes)}};
  }
  json changes = json::array();
  for (auto& [uri, list] : of_file)
    changes.push_back({{"textDocument", {{"uri", uri}, {"version", nullptr}}}, {"edits", std::move(list)}});
  json result{{"documentChanges", std::move(changes)}};
  if (asks)
    result["changeAnnotations"] = {
        {unsure,
         {{"label", "Perhaps another thing of the same name"},
          {"description", "Only a compiler knows whether this member is the one that is renamed"},
          {"needsConfirmation", true}}}};
  return result;
}

}  // namespace tessera::language_server
