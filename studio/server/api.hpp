#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/analysis/analysis.hpp"
#include "server/analysis/arrangement.hpp"
#include "server/analysis/language_answers.hpp"
#include "server/analysis/layout_file.hpp"
#include "server/analysis/spec_file.hpp"
#include "server/analysis/verify_jobs.hpp"
#include "server/http/events.hpp"
#include "server/http/http.hpp"
#include "server/recordings/recordings.hpp"
#include "server/runs/driving_watch.hpp"
#include "server/runs/runs.hpp"
#include "server/runs/sweeps.hpp"
#include "server/studio.hpp"

namespace tessera::server {

/// Handles the requests under /api/ (docs/reference/studio.md).
class Api {
 public:
  struct Parts {
    SpecFile& file;
    LayoutFile& layout;
    Analyses& analyses;
    Events& events;
    VerifyJobs& jobs;
    Runs& runs;
    Sweeps& sweeps;
    Recordings& recordings;
    DrivingWatch& driving;
  };
  Api(const StudioOptions& options, Parts parts);
  /// Declares the handlers. The server must not outlive this object.
  void serve_on(HttpServer& server);

 private:
  using Request = httplib::Request;
  using Response = httplib::Response;
  using Method = void (Api::*)(const Request&, Response&);
  using PartOfRecording = std::optional<std::string> (Recordings::*)(const std::string&,
                                                                     Recordings::Span) const;
  [[nodiscard]] httplib::Server::Handler by(Method method);
  [[nodiscard]] httplib::Server::Handler by(PartOfRecording part);
  /// Refuses a request whose run does not exist.
  [[nodiscard]] httplib::Server::Handler with_run(std::function<void(Run&, const Request&, Response&)> use);
  void get_project(const Request& request, Response& response);
  void get_spec(const Request& request, Response& response);
  void put_spec(const Request& request, Response& response);
  void start_verify(const Request& request, Response& response);
  void get_waits(const Request& request, Response& response);
  void get_timing(const Request& request, Response& response);
  void get_changes_of_chain(const Request& request, Response& response);
  void get_worst_run_of_chain(const Request& request, Response& response);
  void start_run(const Request& request, Response& response);
  void serve_sweeps(HttpServer& server);
  void start_sweep(const Request& request, Response& response);
  void put_notes(const Request& request, Response& response);
  static void control_run(Run& run, const Request& request, Response& response);
  [[nodiscard]] static std::optional<Recordings::Span> span_of(const Request& request, Response& response);
  void get_views(const Request& request, Response& response);
  void get_scene(const Request& request, Response& response);
  void get_track(const Request& request, Response& response);
  /// nullopt: the response says what is wrong.
  [[nodiscard]] std::optional<RunRequest> run_request(const Request& request, Response& response) const;
  void serve_files(HttpServer& server);
  /// The specification and its analysis.
  void serve_spec(HttpServer& server);
  void serve_work(HttpServer& server);
  /// The C++ beside the specification, and examples to start from.
  void serve_sources(HttpServer& server);
  /// The positions of boxes that a user has moved.
  void serve_layout(HttpServer& server);
  void put_layout(const Request& request, Response& response);
  /// How the user has arranged the page.
  void serve_arrangement(HttpServer& server);
  /// Trust in the project, and the emergency stop.
  void serve_consent(HttpServer& server);
  [[nodiscard]] bool is_trusted() const;
  /// Whether a build would take nothing from the folder. A project that the page begins there is the user's own, and
  /// needs no question.
  [[nodiscard]] bool holds_nothing_to_build() const;
  /// Returns whether a note of it is kept; otherwise it counts until the server ends.
  bool trust_folder();
  void write_files(const Request& request, Response& response);
  void begin_project(const Request& request, Response& response);
  /// Answers what `tessera` prints for these arguments.
  void answer_command(const std::vector<std::string>& arguments, Response& response);
  void stream_events(HttpServer& server, Response& response);

  const StudioOptions& options_;
  Parts parts_;
  std::string server_start_;
  LanguageAnswers language_;
  Arrangement arrangement_;
  std::atomic<bool> trusted_here_{false};  ///< until the server ends, since no note of it could be kept
};

}  // namespace tessera::server
