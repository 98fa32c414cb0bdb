#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "codegen/codegen.hpp"
#include "language_server/session.hpp"
#include "project/build/transition_functions.hpp"
#include "project/files/files.hpp"
#include "spec/parser.hpp"

namespace tessera::language_server {

using nlohmann::json;

namespace {

constexpr int request_failed = -32803;
/// A hover waits so long for a picture that is being drawn.
constexpr std::chrono::milliseconds picture_patience{40};

/// Markdown as plain text, for an editor that shows none.
std::string plain(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == '*' || c == '`'; }),
             text.end());
  return text;
}

bool overlaps(const language::Range& a, const language::Range& b) {
  return a.start <= b.end && b.start <= a.end;
}

}  // namespace

std::optional<Session::Asked> Session::asked(const json& parameters, bool with_sources) {
  const auto uri = parameters.at("textDocument").at("uri").get<std::string>();
  std::optional<Specification> specification = workspace_.specification_of(uri);
  if (!specification) return std::nullopt;
  Asked asked;
  asked.specification = std::move(*specification);
  asked.position = position_of(parameters.at("position"));
  const bool in_code = asked.specification.uri != uri;
  if (!with_sources && !in_code) return asked;
  asked.sources = workspace_.sources_of(asked.specification.project);
  if (in_code) {
    const auto own =
        std::find_if(asked.sources.begin(), asked.sources.end(),
                     [&](const language::Source& source) { return path_of(source.path) == path_of(uri); });
    if (own == asked.sources.end()) return std::nullopt;
    asked.source = &*own;
  }
  return asked;
}

json Session::completion(const json& parameters) {
  const std::optional<Asked> about = asked(parameters, false);
  json items = json::array();
  if (about && about->source == nullptr)
    for (const language::Proposal& proposal :
         language::complete(*about->specification.document, about->position))
      items.push_back(to_json(proposal, items.size()));
  return {{"isIncomplete", false}, {"items", std::move(items)}};
}

json Session::hover(const json& parameters) {
  const std::optional<Asked> about = asked(parameters, false);
  if (!about) return nullptr;
  const language::Document& document = *about->specification.document;
  std::optional<language::Explanation> explanation;
  if (about->source == nullptr) {
    explanation = language::explain(document, about->position);
  } else if (const auto where = language::definition_from_code(document, *about->source, about->position);
             !where.empty()) {
    explanation = language::explain(document, where.front().range.start);
    if (explanation) explanation->range = {about->position, about->position};
  }
  if (!explanation) return nullptr;
  if (const std::string picture = pictures_.markdown(about->specification.uri, document.text(),
                                                     explanation->page, pictures_form_, picture_patience);
      !picture.empty())
    explanation->markdown += "\n\n" + picture;
  json hover{{"contents",
              {{"kind", markdown_ ? "markdown" : "plaintext"},
               {"value", markdown_ ? explanation->markdown : plain(explanation->markdown)}}}};
  if (about->source == nullptr) hover["range"] = to_json(explanation->range);
  return hover;
}

json Session::definition(const json& parameters) {
  const std::optional<Asked> about = asked(parameters, true);
  json places = json::array();
  if (!about) return places;
  const language::Document& document = *about->specification.document;
  const std::vector<language::Location> found =
      about->source == nullptr ? language::definition(document, about->position, about->sources)
                               : language::definition_from_code(document, *about->source, about->position);
  for (const language::Location& one : found) places.push_back(to_json(one, about->specification.uri));
  return places;
}

json Session::references(const json& parameters) {
  const std::optional<Asked> about = asked(parameters, true);
  json places = json::array();
  if (!about) return places;
  const bool with_definition = parameters.value("context", json::object()).value("includeDeclaration", true);
  for (const language::Location& one : language::references(*about->specification.document, about->source,
                                                            about->position, about->sources, with_definition))
    places.push_back(to_json(one, about->specification.uri));
  return places;
}

json Session::prepare_rename(const json& parameters) {
  const std::optional<Asked> about = asked(parameters, false);
  if (!about) return nullptr;
  const std::optional<language::Range> range =
      language::renameable(*about->specification.document, about->source, about->position);
  return range ? to_json(*range) : json(nullptr);
}

json Session::rename(const json& parameters) {
  const std::optional<Asked> about = asked(parameters, true);
  if (!about) throw RequestError{request_failed, "this file belongs to no specification"};
  const language::Renaming renaming =
      language::rename(*about->specification.document, about->source, about->position, about->sources,
                       parameters.at("newName"));
  if (renaming.problem) throw RequestError{request_failed, *renaming.problem};
  return to_json(renaming.edits, about->specification.uri, edits_);
}

json Session::action_of(const language::Fix& fix, const std::string& uri) const {
  json action{{"title", fix.title}, {"kind", "quickfix"}, {"edit", to_json(fix.edits, uri, edits_)}};
  if (!fix.code.empty()) action["isPreferred"] = fix.title.starts_with("Replace by");
  return action;
}

json Session::code_actions(const json& parameters) {
  json actions = json::array();
  const auto uri = parameters.at("textDocument").at("uri").get<std::string>();
  const std::optional<Specification> specification = workspace_.specification_of(uri);
  if (!specification || specification->uri != uri) return actions;
  const language::Document& document = *specification->document;
  const language::Range range = range_of(parameters.at("range"));
  for (const language::Fix& fix : language::fixes(document, range, check(uri, document.text()).found))
    actions.push_back(action_of(fix, uri));
  add_function_fixes(*specification, range, actions);
  return actions;
}

void Session::add_function_fixes(const Specification& specification, language::Range range,
                                 json& actions) const {
  const language::Document& document = *specification.document;
  const language::Index& index = document.index();
  for (const language::DefinitionNames& definition : index.definitions())
    for (const language::UnitNames& unit : definition.units)
      for (const auto& [name, path] : unit.functions) {
        const language::SymbolId id = path.back();
        if (!overlaps(document.lines().range(index[id].definition), range)) continue;
        diagnostics::Diagnostics out(specification.uri, document.text(), specification.project);
        const std::optional<spec::Model> model = spec::parse(out);
        if (!model || specification.project.empty()) return;
        const project::TransitionFunctions functions(specification.project, codegen::stubs(*model));
        for (const codegen::Stub& stub : functions.wanted()) {
          if (stub.function != name || stub.subsystem != definition.name + "." + unit.name) continue;
          if (functions.presence(stub) != project::TransitionFunctions::Presence::missing) return;
          const std::filesystem::path file = specification.project / functions.file_for(stub);
          const std::string before = workspace_.text_of(file);
          const std::string after = project::with_function(before, stub);
          std::error_code ignored;
          const bool exists = std::filesystem::exists(file, ignored);
          if (!exists && !edits_.new_files) return;
          // Only what is added, so that a cursor in the file stays where it is.
          std::size_t same = 0;
          while (same < before.size() && before[same] == after[same]) ++same;
          const language::Position at = language::Lines(before).position(same);
          language::Fix fix;
          fix.title = fmt::format("Write the transition function {} into {}", name,
                                  functions.file_for(stub).string());
          fix.edits.push_back(
              {uri_of(file), {at, at}, after.substr(same, after.size() - before.size()), true});
          json action = action_of(fix, specification.uri);
          if (!exists)
            action["edit"]["documentChanges"].insert(action["edit"]["documentChanges"].begin(),
                                                     {{"kind", "create"}, {"uri", uri_of(file)}});
          actions.push_back(std::move(action));
          return;
        }
      }
}

json Session::symbols(const json& parameters) {
  const auto uri = parameters.at("textDocument").at("uri").get<std::string>();
  const std::optional<Specification> specification = workspace_.specification_of(uri);
  json all = json::array();
  if (!specification || specification->uri != uri) return all;
  for (const language::Heading& heading : language::headings(*specification->document))
    all.push_back(to_json(heading));
  return all;
}

}  // namespace tessera::language_server
