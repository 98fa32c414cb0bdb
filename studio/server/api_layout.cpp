#include <nlohmann/json.hpp>

#include "server/analysis/layout_file.hpp"
#include "server/api.hpp"
#include "server/http/answer.hpp"

namespace tessera::server {

using nlohmann::json;

void Api::serve_layout(HttpServer& server) {
  server.Get("/api/layout", [this](const Request&, Response& response) {
    const LayoutFile::Content content = parts_.layout.read();
    json boxes = json::object();
    for (const auto& [path, at] : content.boxes) boxes[path] = {at.x, at.y};
    answer(response, text_of(json{{"boxes", std::move(boxes)},
                                  {"revision", content.revision},
                                  {"error", content.error.empty() ? json(nullptr) : json(content.error)}}));
  });
  server.Put("/api/layout", by(&Api::put_layout));
}

void Api::put_layout(const Request& request, Response& response) {
  const json body = json::parse(request.body, nullptr, false);
  const auto given = body.is_object() ? body.find("boxes") : body.end();
  const auto revision = body.is_object() ? body.find("revision") : body.end();
  if (!body.is_object() || given == body.end() || revision == body.end() || !revision->is_string())
    return answer_error(response, 400, "'boxes' are { path: [x, y] }, with the 'revision' that they replace");
  const Result<BoxPositions> boxes = read_layout(given->dump());
  if (!boxes) return answer_error(response, 400, boxes.problem());
  if (layout_text(*boxes).size() > LayoutFile::largest)
    return answer_error(response, 400, "these are too many boxes: the file would be larger than 1 MB");
  const SpecFile::Outcome outcome = parts_.layout.write(*boxes, revision->get_ref<const std::string&>());
  switch (outcome.written) {
    case SpecFile::Written::yes:
      return answer(response, text_of(json{{"revision", outcome.now.revision}}));
    case SpecFile::Written::conflict:
      return answer(response,
                    text_of(json{{"text", outcome.now.text},
                                 {"revision", outcome.now.revision},
                                 {"error", "another program has changed " + std::string(LayoutFile::name)},
                                 {"hint", "read it again, and join both"}}),
                    409);
    case SpecFile::Written::failed:
      return answer_error(response, 500,
                          std::string(LayoutFile::name) + " cannot be written: " + outcome.now.error);
  }
}

}  // namespace tessera::server
