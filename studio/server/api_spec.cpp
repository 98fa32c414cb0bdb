#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "server/api.hpp"
#include "server/http/answer.hpp"

namespace tessera::server {

using nlohmann::json;

namespace {

/// {members, "analysis": ...}
void answer_with_analysis(const httplib::Request& request, httplib::Response& response,
                          const std::string& members, const Analysis& analysis) {
  static const auto end = std::make_shared<const std::string>("}");
  answer_packed(request, response,
                {std::make_shared<const std::string>("{" + members + ",\"analysis\":"), analysis.json, end});
}

}  // namespace

void Api::serve_spec(HttpServer& server) {
  server.Get("/api/spec", by(&Api::get_spec));
  server.Put("/api/spec", by(&Api::put_spec));
  server.Post("/api/check", [this](const Request& request, Response& response) {
    RequestBody body(request, response);
    const std::string text = body.text("text");
    if (body.good()) answer_packed(request, response, {parts_.analyses.of(text)->json});
  });
}

void Api::get_spec(const Request& request, Response& response) {
  const SpecFile::Content content = parts_.file.read();
  answer_with_analysis(
      request, response,
      fmt::format(R"("text":{},"revision":"{}","error":{})", text_of(json(content.text)), content.revision,
                  content.error.empty() ? "null" : text_of(json(content.error))),
      *parts_.analyses.of(content.text));
}

void Api::put_spec(const Request& request, Response& response) {
  RequestBody body(request, response);
  const std::string text = body.text("text"), revision = body.text("revision");
  if (!body.good()) return;
  const bool begins = holds_nothing_to_build() && parts_.file.read().text.empty();
  const SpecFile::Outcome outcome = parts_.file.write_shown(text, revision);
  switch (outcome.written) {
    case SpecFile::Written::yes:
      if (begins) static_cast<void>(trust_folder());
      return answer_with_analysis(request, response, fmt::format(R"("revision":"{}")", outcome.now.revision),
                                  *parts_.analyses.of(text));
    case SpecFile::Written::conflict:
      return answer(
          response,
          text_of(json{{"text", outcome.now.text},
                       {"revision", outcome.now.revision},
                       {"error", "the file on disk was changed by another program"},
                       {"hint", "look at both, then save again with the revision that is there now"}}),
          409);
    case SpecFile::Written::failed:
      return answer_error(response, 500, "the file cannot be written: " + outcome.now.error);
  }
}

}  // namespace tessera::server
