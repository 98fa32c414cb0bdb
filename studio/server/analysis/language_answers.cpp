#include "server/analysis/language_answers.hpp"

#include <array>
#include <nlohmann/json.hpp>

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

}  // namespace tessera::server
