#include "server/analysis/language_answers.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "diagnostics/utf8.hpp"
#include "language/edits/edit_json.hpp"
#include "project/files/files.hpp"
#include "server/http/answer.hpp"

namespace tessera::server {

using nlohmann::json;

namespace {

constexpr std::array kinds_of_proposals{"key", "word", "type", "name", "example"};

json place_in_text(const language::Position& position) {
  return {{"line", position.line}, {"character", position.character}};
}

json proposal_json(const language::Proposal& proposal) {
  return {{"kind", kinds_of_proposals[static_cast<std::size_t>(proposal.kind)]},
          {"label", proposal.label},
          {"detail", proposal.detail},
          {"documentation", proposal.documentation},
          {"insert", proposal.insert},
          {"from", place_in_text(proposal.range.start)},
          {"to", place_in_text(proposal.range.end)}};
}

}  // namespace

LanguageAnswers::LanguageAnswers(const std::string& schema) {
  const std::string text = project::content_of(schema);
  grammar_ = std::make_unique<const language::Grammar>(text.empty() ? "{}" : text);
}

void LanguageAnswers::handle(const httplib::Request& request, httplib::Response& response) const {
  RequestBody body(request, response);
  const std::string text = body.text("text");
  const std::string ask = body.text("ask");
  const std::optional<double> line = body.number("line"), character = body.number("character");
  if (!body.good()) return;
  const auto is_count = [](const std::optional<double>& one) { return one && *one >= 0 && *one <= 1e8; };
  const bool known = ask == "completion" || ask == "meaning" || ask == "definition";
  if (!is_count(line) || !is_count(character) || !known)
    return answer_error(response, 400, "'line' and 'character' are numbers from 0",
                        "'ask' is completion, meaning or definition");
  const language::Position position{static_cast<std::uint32_t>(*line),
                                    static_cast<std::uint32_t>(*character)};
  const language::Document document(text, *grammar_);
  json all{{"proposals", json::array()}, {"meaning", nullptr}, {"definition", nullptr}};
  if (ask == "completion")
    for (const language::Proposal& proposal : language::complete(document, position))
      all["proposals"].push_back(proposal_json(proposal));
  if (ask == "meaning")
    if (const auto meaning = language::explain(document, position))
      all["meaning"] = {{"text", meaning->markdown},
                        {"from", place_in_text(meaning->range.start)},
                        {"to", place_in_text(meaning->range.end)}};
  if (ask == "definition")
    if (const auto found = language::definition(document, position, {}); !found.empty())
      all["definition"] = place_in_text(found.front().range.start);
  answer(response, text_of(all));
}

namespace {

/// Whether an edit changes names, which other files have too.
bool renames(const std::vector<language::Edit>& edits) {
  return edits.size() == 1 && edits.front().kind == language::Edit::Kind::rename;
}

/// The change of a file of the project by a rename.
json file_json(const language::Source& source, const std::vector<language::TextEdit>& edits,
               std::string after) {
  json places = json::array(), unsure = json::array();
  for (const language::TextEdit& edit : edits)
    if (edit.path == source.path) (edit.sure ? places : unsure).push_back(edit.range.start.line + 1);
  return {{"file", source.path},   {"lines", std::move(places)}, {"unsure", std::move(unsure)},
          {"before", source.text}, {"after", std::move(after)},  {"revision", revision_of(source.text)}};
}

}  // namespace

void LanguageAnswers::edit(const httplib::Request& request, httplib::Response& response,
                           const Sources& sources) const {
  RequestBody body(request, response);
  const std::string text = body.text("text");
  if (!body.good()) return;
  // Keys of a new entry stay in their order.
  const auto whole = nlohmann::ordered_json::parse(request.body, nullptr, false);
  const auto given = whole.find("edit");
  const auto edits = given == whole.end() ? std::nullopt : language::edits_of(*given);
  if (!edits) return answer_error(response, 400, "'edit' is no edit, and no list of edits");
  const language::Document document(text, *grammar_);
  const std::vector<language::Source> files =
      renames(*edits) ? sources.all() : std::vector<language::Source>();
  const language::Renaming done = language::edit(document, *edits, files);
  if (done.problem) return answer_error(response, 422, *done.problem);
  json all{{"edits", json::array()}, {"files", json::array()}};
  for (const language::TextEdit& edit : done.edits)
    if (edit.path.empty())
      all["edits"].push_back({{"from", place_in_text(edit.range.start)},
                              {"to", place_in_text(edit.range.end)},
                              {"text", edit.text}});
  for (const language::Source& source : files) {
    const bool named = std::any_of(done.edits.begin(), done.edits.end(),
                                   [&](const language::TextEdit& edit) { return edit.path == source.path; });
    if (!named) continue;
    std::string after = language::edited(source, done.edits);
    if (diagnostics::first_invalid_byte(source.text))
      return answer_error(response, 422, source.path + " names it, and has bytes that are not UTF-8",
                          "save this file in the encoding UTF-8 first");
    all["files"].push_back(file_json(source, done.edits, std::move(after)));
  }
  answer(response, text_of(all));
}

}  // namespace tessera::server
