#include "server/api.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "project/files/files.hpp"
#include "project/verification/run_files.hpp"
#include "project/verification/verdicts.hpp"
#include "server/analysis/views.hpp"
#include "server/analysis/waits.hpp"
#include "server/http/answer.hpp"
#include "server/http/guard.hpp"
#include "server/runs/controller_link.hpp"
#include "tessera/monitor.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// The worlds or tracks that a run may name: those of the installation, and those beside the specification.
std::map<std::string, fs::path> assets_named(const fs::path& shipped, const fs::path& project,
                                             const char* ending) {
  std::map<std::string, fs::path> found;
  for (const fs::path& folder : {project, shipped}) {
    std::error_code ignored;
    for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
         entry.increment(ignored))
      if (entry->path().extension() == ending && entry->is_regular_file(ignored) &&
          (folder == shipped || !entry->is_symlink(ignored)))
        found.emplace(entry->path().filename().string(), entry->path());
  }
  return found;
}

json names_of(const std::map<std::string, fs::path>& assets) {
  json names = json::array();
  for (const auto& [name, path] : assets) names.push_back(name);
  return names;
}

/// The text, if there is such a thing.
void answer_found(httplib::Response& response, std::optional<std::string> text, const char* what) {
  if (!text) return answer_error(response, 404, fmt::format("there is no such {}", what));
  answer(response, std::move(*text));
}

/// The number at the end of an address.
std::uint64_t number_in(const httplib::Request& request) {
  const std::string digits = request.matches[1];
  return digits.size() > 18 ? 0 : std::stoull(digits);
}

}  // namespace

Api::Api(const StudioOptions& options, Parts parts)
    : options_(options),
      parts_(parts),
      server_start_(random_token()),
      language_(options.share / "spec.schema.json"),
      arrangement_(parts_.file.path()) {}

void Api::serve_on(HttpServer& server) {
  serve_files(server);
  serve_spec(server);
  serve_work(server);
  serve_sources(server);
  serve_layout(server);
  serve_arrangement(server);
  serve_consent(server);
  serve_sweeps(server);
  server.Get("/api/events",
             [this, &server](const Request&, Response& response) { stream_events(server, response); });
}

void Api::serve_files(HttpServer& server) {
  server.Get("/api/project", by(&Api::get_project));
  server.Post("/api/language",
              [this](const Request& request, Response& response) { language_.handle(request, response); });
  server.Get("/api/recordings",
             [this](const Request&, Response& response) { answer(response, parts_.recordings.list()); });
  server.Get("/api/recordings/([^/]+)", by(&Recordings::content));
  server.Get("/api/views", by(&Api::get_views));
  server.Get("/api/recordings/([^/]+)/arrays", by(&Recordings::arrays));
  server.Get("/api/recordings/([^/]+)/coverage", [this](const Request& request, Response& response) {
    answer_found(response, parts_.recordings.coverage(request.matches[1]), "recording");
  });
  server.Put("/api/recordings/([^/]+)/notes", by(&Api::put_notes));
  server.Get("/api/recordings/([^/]+)/poses", by(&Recordings::poses));
  server.Get("/api/scenes/([0-9a-f]{16})\\.glb", by(&Api::get_scene));
  server.Get("/api/tracks/([^/]+)", by(&Api::get_track));
}

void Api::serve_work(HttpServer& server) {
  server.Post("/api/verify", by(&Api::start_verify));
  server.Get("/api/verify/(\\d+)", [this](const Request& request, Response& response) {
    answer_found(response, parts_.jobs.state(number_in(request)), "job");
  });
  server.Delete("/api/verify/(\\d+)", [this](const Request& request, Response& response) {
    if (!parts_.jobs.stop(number_in(request))) return answer_error(response, 404, "there is no such job");
    answer(response, "{}");
  });
  server.Post("/api/waits", by(&Api::get_waits));
  server.Post("/api/runs", by(&Api::start_run));
  server.Get("/api/runs",
             [this](const Request&, Response& response) { answer(response, text_of(parts_.runs.list())); });
  server.Get("/api/controllers", [](const Request&, Response& response) {
    if (const std::optional<Problem> wrong = wrong_with_monitor_folder())
      return answer_error(response, 409, "it is unknown whether a controller is running: " + wrong->text);
    answer(response, text_of(json(listening_sockets())));
  });
  server.Get("/api/runs/(\\d+)", with_run([](Run& run, const Request&, Response& response) {
               answer(response, text_of(run.info(/*all=*/true)));
             }));
  server.Get("/api/runs/(\\d+)/coverage", with_run([](Run& run, const Request&, Response& response) {
               answer(response, text_of(run.coverage()));
             }));
  server.Get("/api/runs/(\\d+)/operators", with_run([](Run& run, const Request&, Response& response) {
               answer(response, text_of(run.operators()));
             }));
  server.Post("/api/runs/(\\d+)/control", with_run(control_run));
}

httplib::Server::Handler Api::by(Method method) {
  return [this, method](const Request& request, Response& response) { (this->*method)(request, response); };
}

httplib::Server::Handler Api::by(PartOfRecording part) {
  return [this, part](const Request& request, Response& response) {
    if (const std::optional<Recordings::Span> span = span_of(request, response))
      answer_found(response, (parts_.recordings.*part)(request.matches[1], *span), "recording");
  };
}

httplib::Server::Handler Api::with_run(std::function<void(Run&, const Request&, Response&)> use) {
  return [this, use = std::move(use)](const Request& request, Response& response) {
    const std::shared_ptr<Run> run = parts_.runs.find(request.matches[1]);
    if (run == nullptr) return answer_error(response, 404, "there is no such run");
    use(*run, request, response);
  };
}

void Api::get_project(const Request& /*request*/, Response& response) {
  const fs::path folder = parts_.file.folder();
  json worlds = json::array();
  const json tracks = names_of(assets_named(options_.share / "tracks", folder, ".png"));
  for (const auto& [name, path] : assets_named(options_.share / "worlds", folder, ".xml"))
    worlds.push_back({{"name", name}, {"tracks", tracks}});
  json project{{"name", folder.filename().string()},
               {"folder", folder.string()},
               {"file", parts_.file.path().filename().string()},
               {"version", options_.version},
               {"worlds", worlds},
               {"simulation", nullptr},
               {"processes", json::array()},
               {"server_start", server_start_},
               {"trusted", is_trusted()},
               {"examples_hint", (options_.share / "examples").string()}};
  const std::shared_ptr<const Analysis> analysis = parts_.analyses.of(parts_.file.read().text);
  if (analysis->model) project["name"] = analysis->model->system;
  if (analysis->model && analysis->model->deployment)
    for (const spec::Process& process : analysis->model->deployment->processes)
      project["processes"].push_back(process.name);
  if (analysis->model && analysis->model->simulation && analysis->model->simulation->has_world()) {
    const spec::Simulation& simulation = *analysis->model->simulation;
    project["simulation"] = {{"world", simulation.coppelia ? "CoppeliaSim" : simulation.world},
                             {"track", nullptr}};
    if (simulation.track)
      project["simulation"]["track"] = {{"image", simulation.track->image},
                                        {"metres_per_pixel", simulation.track->metres_per_pixel}};
  }
  answer(response, text_of(project));
}

void Api::start_verify(const Request& request, Response& response) {
  RequestBody body(request, response);
  VerifyJobs::Request wanted{body.text("text"), body.texts("properties")};
  const std::string timeout = body.text_or("timeout", "60s");
  if (!body.good()) return;
  try {
    wanted.seconds = std::min(project::parse_seconds(timeout, "timeout"), 24 * 3600.0);
  } catch (const std::exception& error) {
    return answer_error(response, 400, error.what());
  }
  const VerifyJobs::Started started = parts_.jobs.start(std::move(wanted));
  if (started.status != 202) return answer_error(response, started.status, started.error, started.hint);
  answer(response, text_of(json{{"job", std::to_string(started.job)}}), 202);
}

void Api::get_waits(const Request& request, Response& response) {
  RequestBody body(request, response);
  const std::string text = body.text("text");
  const std::vector<std::uint32_t> marked = body.indices("marking", "place");
  if (!body.good()) return;
  const std::shared_ptr<const Analysis> analysis = parts_.analyses.of(text);
  if (!analysis->net) return answer_error(response, 422, "a specification with errors has no net");
  answer(response, text_of(json{{"at_end", project::at_end_json(waits_in(*analysis->net, marked))}}));
}

std::optional<RunRequest> Api::run_request(const Request& request, Response& response) const {
  const auto refuse = [&](const std::string& what, const std::string& hint = {}) {
    answer_error(response, 400, what, hint);
    return std::nullopt;
  };
  RequestBody body(request, response);
  RunRequest wanted;
  const std::string kind = body.text_or("kind", "simulate");
  wanted.kind = kind == "run"          ? RunRequest::Kind::run
                : kind == "attach"     ? RunRequest::Kind::attach
                : kind == "deployment" ? RunRequest::Kind::deployment
                                       : RunRequest::Kind::simulate;
  wanted.socket = body.text_or("socket", "");
  wanted.world = body.text_or("world", "");
  wanted.track = body.text_or("track", "");
  wanted.duration = body.text_or("for", kind == "simulate" ? "600s" : "");
  wanted.seed = static_cast<std::uint64_t>(std::clamp(body.number("seed").value_or(1), 0.0, 9e15));
  wanted.speed = body.number("speed").value_or(1);
  wanted.paused = body.flag("paused");
  wanted.skip_to_s = body.number("skip_to").value_or(0);
  wanted.records_all = body.text_or("values", "small") == "all";
  if (!body.good()) return std::nullopt;
  if (kind != "simulate" && kind != "run" && kind != "attach" && kind != "deployment")
    return refuse("a run is of kind simulate, run, attach or deployment");
  if (kind == "attach" && std::ranges::count(listening_sockets(), wanted.socket) == 0)
    return refuse("no program listens at " + wanted.socket, "/api/controllers names the sockets that do");
  if (!(wanted.speed >= 0 && wanted.speed <= 1000)) return refuse("a speed is a number from 0 to 1000");
  try {
    double end_s = 1e9;
    if (!wanted.duration.empty())
      wanted.duration = fmt::format("{}s", end_s = project::parse_seconds(wanted.duration, "for"));
    if (!(wanted.skip_to_s >= 0 && wanted.skip_to_s < end_s))
      return refuse(fmt::format("skip_to is a number of seconds, at least 0 and less than {}", end_s));
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
  if (!wanted.world.empty() &&
      !assets_named(options_.share / "worlds", parts_.file.folder(), ".xml").contains(wanted.world))
    return refuse("there is no world " + wanted.world, "/api/project names them");
  if (!wanted.track.empty() &&
      !assets_named(options_.share / "tracks", parts_.file.folder(), ".png").contains(wanted.track))
    return refuse("there is no track " + wanted.track, "/api/project names them");
  return wanted;
}

void Api::start_run(const Request& request, Response& response) {
  std::optional<RunRequest> wanted = run_request(request, response);
  if (!wanted) return;
  const bool runs_code = wanted->kind == RunRequest::Kind::simulate || wanted->kind == RunRequest::Kind::run;
  if (runs_code && !is_trusted())
    return answer_error(response, 403,
                        "a run compiles and executes the code of this folder, which is not trusted yet",
                        "look at it, then say that you trust its authors");
  const Runs::Started started = parts_.runs.start(std::move(*wanted));
  if (started.status != 202) return answer_error(response, started.status, started.error, started.hint);
  answer(response, text_of(json{{"run", started.run}}), 202);
}

/// nullopt: the request is refused.
std::optional<Recordings::Span> Api::span_of(const Request& request, Response& response) {
  Recordings::Span span;
  for (const auto& [name, end] : {std::pair{"from", &span.from_ns}, std::pair{"to", &span.to_ns}}) {
    if (!request.has_param(name)) continue;
    const std::string text = request.get_param_value(name);
    if (std::from_chars(text.data(), text.data() + text.size(), *end).ptr == text.data() + text.size())
      continue;
    answer_error(response, 400, std::string(name) + " is a time in nanoseconds");
    return std::nullopt;
  }
  return span;
}

void Api::get_views(const Request& /*request*/, Response& response) {
  const std::shared_ptr<const Analysis> analysis = parts_.analyses.of(parts_.file.read().text);
  if (!analysis->model) return answer_error(response, 422, "the specification has errors");
  const Result<std::vector<project::WorldView>> views =
      project::world_views(*analysis->model, parts_.file.folder());
  if (!views) return answer_error(response, 422, "the world cannot be asked: " + views.problem());
  answer(response, text_of(json_of(*views)));
}

/// The name of a scene is a hash of its content, so a browser need not ask again.
void Api::get_scene(const Request& request, Response& response) {
  const std::string hash = request.matches[1];
  std::optional<std::string> glb = parts_.recordings.scene(hash);
  if (!glb) glb = parts_.runs.scene(hash);
  if (!glb) return answer_error(response, 404, "there is no such scene");
  response.set_header("Cache-Control", "private, max-age=31536000, immutable");
  response.set_content(std::move(*glb), "model/gltf-binary");
}

void Api::get_track(const Request& request, Response& response) {
  const auto tracks = assets_named(options_.share / "tracks", parts_.file.folder(), ".png");
  const auto found = tracks.find(request.matches[1]);
  if (found == tracks.end()) return answer_error(response, 404, "there is no such track");
  response.set_content(project::content_of(found->second), "image/png");
}

void Api::stream_events(HttpServer& server, Response& response) {
  const std::string revision = parts_.file.read().revision;
  const std::shared_ptr<Events::Subscription> subscription = parts_.events.subscribe(
      "hello", text_of(json{{"server_start", server_start_}, {"revision", revision}}));
  if (subscription == nullptr)
    return answer_error(response, 503, "too many pages are open", "close one of them");
  // A change between the reading and the subscription was published before.
  if (const std::string now = parts_.file.read().revision; now != revision)
    parts_.events.publish("spec", text_of(json{{"revision", now}}));
  response.status = 200;
  response.set_header("Cache-Control", "no-store");
  response.set_chunked_content_provider("text/event-stream",
                                        [subscription, &server](std::size_t, httplib::DataSink& sink) {
                                          if (server.shutting_down() || !sink.is_writable()) return false;
                                          const std::string text = subscription->next();
                                          return !text.empty() && sink.write(text.data(), text.size());
                                        });
}

}  // namespace tessera::server
