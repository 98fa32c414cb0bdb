#include "server/studio.hpp"

#include <fmt/core.h>

#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "server/analysis/analysis.hpp"
#include "server/analysis/file_watch.hpp"
#include "server/analysis/layout_file.hpp"
#include "server/analysis/spec_file.hpp"
#include "server/analysis/verify_jobs.hpp"
#include "server/api.hpp"
#include "server/http/answer.hpp"
#include "server/http/assets.hpp"
#include "server/http/events.hpp"
#include "server/http/guard.hpp"
#include "server/recordings/recordings.hpp"
#include "server/runs/driving_watch.hpp"
#include "server/runs/runs.hpp"
#include "server/runs/sweeps.hpp"

namespace tessera::server {

namespace {

using httplib::Request;
using httplib::Response;

/// Allows no foreign script, no foreign frame, and no content from elsewhere.
httplib::Headers headers_of_all() {
  return {{"Content-Security-Policy",
           "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src "
           "'self' blob:; "
           "worker-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'none'; "
           "frame-ancestors 'none'"},
          {"X-Content-Type-Options", "nosniff"},
          {"Referrer-Policy", "no-referrer"},
          {"Cross-Origin-Resource-Policy", "same-origin"}};
}

}  // namespace

struct Studio::Parts {
  explicit Parts(const StudioOptions& given)
      : options(given),
        file(given.spec),
        layout(file.folder()),
        analyses(file.path()),
        jobs(analyses, events),
        runs(file, analyses, events),
        sweeps(file, analyses, events),
        recordings(file, analyses),
        driving(events),
        assets(given.page),
        api(options, {file, layout, analyses, events, jobs, runs, sweeps, recordings, driving}),
        http(given.limits),
        port(http.bind(given.port, given.tries)),
        guard(port, token) {
    if (port == 0)
      throw std::runtime_error(
          fmt::format("no port is free from {} to {}", given.port, given.port + given.tries - 1));
  }

  void serve_page(const Request& request, Response& response) const {
    const Assets::Asset* asset = assets.find(request.path);
    if (asset == nullptr) return answer_error(response, 404, "there is no such page");
    const bool packed = asset->packed != nullptr && accepts_gzip(request);
    answer_pieces(response, {packed ? asset->packed : asset->bytes}, asset->type);
    if (packed) response.set_header("Content-Encoding", "gzip");
    response.set_header("Vary", "Accept-Encoding");
    response.set_header("Cache-Control", "no-cache");
  }

  void declare() {
    http.set_default_headers(headers_of_all());
    http.set_pre_routing_handler([this](const Request& request, Response& response) {
      const std::optional<Refusal> refusal = guard.refuse(request);
      if (!refusal) return httplib::Server::HandlerResponse::Unhandled;
      answer_error(response, refusal->status, refusal->error, refusal->hint);
      return httplib::Server::HandlerResponse::Handled;
    });
    http.set_exception_handler([](const Request&, Response& response, const std::exception_ptr& thrown) {
      try {
        std::rethrow_exception(thrown);
      } catch (const std::exception& error) {
        answer_error(response, 500, error.what());
      } catch (...) {
        answer_error(response, 500, "the server failed");
      }
    });
    http.set_error_handler([](const Request&, Response& response) {
      if (response.body.empty() && !response.content_provider_)
        answer_error(response, response.status, "this cannot be answered");
    });
    api.serve_on(http);
    http.Get("/.*", [this](const Request& request, Response& response) { serve_page(request, response); });
  }

  /// Publishes only changes: the same text written again is none. A change of an included file has the revision of
  /// the text that includes it.
  void look_at_file() {
    const std::lock_guard lock(looking);
    look_at_layout();
    const SpecFile::Content now = file.read();
    const bool included_changed = state_of(included) != seen_included;
    if (now.revision == seen_revision && !included_changed) return;
    seen_revision = now.revision;
    events.publish("spec", text_of(nlohmann::json{{"revision", seen_revision}}));
    look_at_included(now.text);
  }

  /// Precondition: `looking` is locked.
  void look_at_layout() {
    const std::string now = layout.read().revision;
    if (now == seen_layout) return;
    seen_layout = now;
    events.publish("layout", text_of(nlohmann::json{{"revision", now}}));
  }

  /// Watches the files that the text includes. Precondition: `looking` is locked.
  void look_at_included(const std::string& text) {
    const std::shared_ptr<const Analysis> analysis = analyses.of(text);
    included = analysis->included;
    seen_included = analysis->state_of_included;
    for (const std::filesystem::path& one : included) watch->add(one);
  }

  StudioOptions options;
  SpecFile file;
  LayoutFile layout;
  Analyses analyses;
  Events events;
  VerifyJobs jobs;
  Runs runs;
  Sweeps sweeps;
  Recordings recordings;
  DrivingWatch driving;
  Assets assets;
  Api api;
  std::string token = random_token();
  HttpServer http;
  int port;
  RequestGuard guard;
  std::mutex looking;  ///< guards what follows
  std::string seen_revision = file.read().revision;
  std::string seen_layout = layout.read().revision;
  std::vector<std::filesystem::path> included;
  std::string seen_included;
  std::optional<FileWatch> watch;
  std::thread serving;
  std::thread looking_ahead;
};

Studio::Studio(const StudioOptions& options) : parts_(std::make_unique<Parts>(options)) {
  Parts& parts = *parts_;
  parts.declare();
  parts.watch.emplace(parts.file.path(), [&parts] { parts.look_at_file(); });
  parts.watch->add(parts.layout.path());
  parts.serving = std::thread([&parts] { parts.http.serve(); });
  // The first requests of every page are answered without a wait.
  parts.looking_ahead = std::thread([&parts] {
    try {
      const std::lock_guard lock(parts.looking);
      parts.look_at_included(parts.file.read().text);
    } catch (const std::exception&) {
      // The request for it fails, too, and says why.
    }
  });
  while (!parts.http.is_running()) std::this_thread::yield();
}

Studio::~Studio() {
  parts_->looking_ahead.join();  // it adds files to the watch
  parts_->watch.reset();
  parts_->runs.stop_all();
  parts_->events.close();
  parts_->http.shut_down();
  parts_->serving.join();
}

int Studio::port() const { return parts_->port; }
const std::string& Studio::token() const { return parts_->token; }
std::string Studio::url() const {
  return fmt::format("http://127.0.0.1:{}/#token={}", parts_->port, parts_->token);
}

}  // namespace tessera::server
