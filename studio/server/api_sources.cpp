#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "server/analysis/examples.hpp"
#include "server/analysis/sources.hpp"
#include "server/analysis/world_targets.hpp"
#include "server/api.hpp"
#include "server/http/answer.hpp"

namespace tessera::server {

namespace {

constexpr const char* no_source =
    "this is no source of the project: those are the C++ files in src/ and test/, and params.yaml";

nlohmann::json content_json(const SpecFile::Content& content) {
  return {{"text", content.text}, {"revision", content.revision}};
}

}  // namespace

void Api::serve_sources(HttpServer& server) {
  const auto model_of = [this](const std::string& text, Response& response) {
    std::shared_ptr<const Analysis> analysis = parts_.analyses.of(text);
    if (!analysis->model) {
      answer_error(response, 422, "the specification has errors");
      analysis = nullptr;
    }
    return analysis;
  };
  server.Post("/api/functions", [this, model_of](const Request& request, Response& response) {
    RequestBody body(request, response);
    const std::string text = body.text("text");
    if (!body.good()) return;
    if (const auto analysis = model_of(text, response))
      answer(response, text_of(Sources(parts_.file.folder()).functions(*analysis->model)));
  });
  server.Post("/api/functions/add", [this, model_of](const Request& request, Response& response) {
    RequestBody body(request, response);
    const std::string text = body.text("text"), subsystem = body.text("subsystem"),
                      function = body.text("function");
    if (!body.good()) return;
    const auto analysis = model_of(text, response);
    if (!analysis) return;
    const Sources::Added added = Sources(parts_.file.folder()).add(*analysis->model, subsystem, function);
    if (added.problem) return answer_error(response, 409, added.problem->text);
    answer(response, text_of(nlohmann::json{{"file", added.file}}));
  });
  server.Post("/api/functions/rename", [this](const Request& request, Response& response) {
    RequestBody body(request, response);
    const std::string text = body.text("text"), subsystem = body.text("subsystem"), from = body.text("from"),
                      function = body.text("function");
    if (!body.good()) return;
    const Sources::Renamed renamed =
        Sources(parts_.file.folder()).rename(text, language_.grammar(), subsystem, from, function);
    if (renamed.problem) return answer_error(response, 409, renamed.problem->text);
    answer(response, text_of(nlohmann::json{{"files", renamed.files}}));
  });
  server.Post("/api/world", [this, model_of](const Request& request, Response& response) {
    RequestBody body(request, response);
    const std::string text = body.text("text");
    if (!body.good()) return;
    const auto analysis = model_of(text, response);
    if (!analysis) return;
    const Result<nlohmann::json> targets = world_targets(*analysis->model, parts_.file.folder());
    if (!targets) return answer_error(response, 422, "the world cannot be asked: " + targets.problem());
    answer(response, text_of(nlohmann::json{{"targets", *targets}}));
  });
  server.Get("/api/sources", [this](const Request& request, Response& response) {
    const auto content = Sources(parts_.file.folder()).read(request.get_param_value("file"));
    if (!content || !content->error.empty())
      return answer_error(response, 404, no_source, content ? content->error : "");
    answer(response, text_of(content_json(*content)));
  });
  server.Put("/api/sources", [this](const Request& request, Response& response) {
    RequestBody body(request, response);
    const std::string file = body.text("file"), text = body.text("text"), revision = body.text("revision");
    if (!body.good()) return;
    const auto outcome = Sources(parts_.file.folder()).write(file, text, revision);
    if (!outcome) return answer_error(response, 404, no_source);
    if (outcome->written == SpecFile::Written::failed)
      return answer_error(response, 500, "the file cannot be written: " + outcome->now.error);
    if (outcome->written == SpecFile::Written::yes)
      return answer(response, text_of(nlohmann::json{{"revision", outcome->now.revision}}));
    nlohmann::json conflict = content_json(outcome->now);
    conflict["error"] = file + " was changed by another program";
    conflict["hint"] = "look at both, then save again with the revision that is there now";
    answer(response, text_of(conflict), 409);
  });
  server.Post("/api/edit", [this](const Request& request, Response& response) {
    language_.edit(request, response, Sources(parts_.file.folder()));
  });
  server.Post("/api/files", by(&Api::write_files));
  server.Get("/api/examples", [this](const Request&, Response& response) {
    answer(response, text_of(examples_in(options_.share / "examples")));
  });
  server.Post("/api/begin", by(&Api::begin_project));
}

void Api::write_files(const Request& request, Response& response) {
  const auto body = nlohmann::json::parse(request.body, nullptr, false);
  const auto list = body.is_object() ? body.find("files") : body.end();
  std::vector<Sources::Written> files;
  bool good =
      body.is_object() && list != body.end() && list->is_array() && !list->empty() && list->size() <= 1001;
  for (std::size_t at = 0; good && at < list->size(); ++at) {
    const nlohmann::json& one = (*list)[at];
    for (const char* key : {"file", "text", "revision"})
      good = good && one.is_object() && one.contains(key) && one[key].is_string();
    if (good) files.push_back({one["file"], one["text"], one["revision"]});
  }
  if (!good) return answer_error(response, 400, "'files' is a list of { file, text, revision }");
  const Sources sources(parts_.file.folder(), parts_.file.path().filename().string());
  if (const auto problem = sources.write_together(files))
    return answer_error(response, 409, "nothing was written: " + *problem,
                        "look at both, then change it again");
  nlohmann::json written = nlohmann::json::array();
  for (const Sources::Written& one : files)
    written.push_back({{"file", one.file}, {"revision", revision_of(one.text)}});
  answer(response, text_of(nlohmann::json{{"files", std::move(written)}}));
}

void Api::begin_project(const Request& request, Response& response) {
  RequestBody body(request, response);
  const std::string name = body.text("example");
  if (!body.good()) return;
  const bool is_new = holds_nothing_to_build();
  const Begun begun = begin_with(options_.share / "examples", name, parts_.file.path());
  if (begun.problem) return answer_error(response, 409, begun.problem->text);
  if (is_new && begun.kept.empty()) static_cast<void>(trust_folder());
  answer(response, text_of(nlohmann::json{{"files", begun.files}, {"kept", begun.kept}}));
}

}  // namespace tessera::server
