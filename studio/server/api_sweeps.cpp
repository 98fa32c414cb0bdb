#include <fmt/core.h>

#include <charconv>
#include <cmath>

#include "project/verification/verdicts.hpp"
#include "server/api.hpp"
#include "server/http/answer.hpp"

namespace tessera::server {

using nlohmann::json;

namespace {

/// Whole numbers that JSON carries exactly; nullopt: it is none, or out of these bounds.
std::optional<std::uint64_t> whole(std::optional<double> given, double usual, double least, double greatest) {
  const double number = given.value_or(usual);
  if (!(number >= least && number <= greatest) || number != std::floor(number)) return std::nullopt;
  return static_cast<std::uint64_t>(number);
}

std::uint64_t sweep_in(const httplib::Request& request) {
  const std::string digits = request.matches[1];
  return digits.size() > 18 ? 0 : std::stoull(digits);
}

}  // namespace

void Api::serve_sweeps(HttpServer& server) {
  server.Post("/api/sweeps", by(&Api::start_sweep));
  server.Get("/api/sweeps",
             [this](const Request&, Response& response) { answer(response, text_of(parts_.sweeps.list())); });
  server.Get("/api/sweeps/(\\d+)", [this](const Request& request, Response& response) {
    const std::optional<json> info = parts_.sweeps.info(sweep_in(request));
    if (!info) return answer_error(response, 404, "there is no such sweep");
    answer(response, text_of(*info));
  });
  server.Delete("/api/sweeps/(\\d+)", [this](const Request& request, Response& response) {
    if (!parts_.sweeps.stop(sweep_in(request))) return answer_error(response, 404, "there is no such sweep");
    answer(response, "{}");
  });
}

void Api::start_sweep(const Request& request, Response& response) {
  RequestBody body(request, response);
  SweepRequest wanted{.parameter = body.text_or("parameter", ""),
                      .values = body.texts("values"),
                      .duration = body.text_or("for", "10s"),
                      .interleave = body.flag("interleave")};
  const auto runs = whole(body.number("runs"), 1, 1, Sweeps::most_runs);
  const auto seed = whole(body.number("seed"), 1, 0, 9e15);
  if (!body.good()) return;
  if (!runs)
    return answer_error(response, 400, fmt::format("the runs are a number from 1 to {}", Sweeps::most_runs));
  if (!seed) return answer_error(response, 400, "a seed is a whole number from 0 to 9e15");
  wanted.runs = *runs;
  wanted.seed = *seed;
  try {
    const double seconds = project::parse_seconds(wanted.duration, "for");
    if (!(seconds > 0 && seconds <= Sweeps::longest_s))
      return answer_error(response, 400, fmt::format("a run of a sweep lasts up to {} s", Sweeps::longest_s));
    wanted.duration = fmt::format("{}s", seconds);
  } catch (const std::exception& error) {
    return answer_error(response, 400, error.what());
  }
  if (!is_trusted())
    return answer_error(response, 403,
                        "a run compiles and executes the code of this folder, which is not trusted yet",
                        "look at it, then say that you trust its authors");
  const Sweeps::Started started = parts_.sweeps.start(std::move(wanted));
  if (started.status != 202) return answer_error(response, started.status, started.error, started.hint);
  answer(response, text_of(json{{"sweep", std::to_string(started.sweep)}}), 202);
}

void Api::put_notes(const Request& request, Response& response) {
  RequestBody body(request, response);
  Notes notes{body.text("title"), body.text("text"), {}};
  const std::string revision = body.text("revision");
  for (const json& mark : body.objects("marks")) {
    const auto time = mark.find("t"), text = mark.find("text");
    if (time == mark.end() || text == mark.end() || !time->is_number_integer() || !text->is_string())
      return answer_error(response, 400, "a mark has a time 't' in nanoseconds and a 'text'");
    notes.marks.push_back({time->get<std::int64_t>(), text->get<std::string>()});
  }
  if (!body.good()) return;
  if (const std::string wrong = notes.problem(); !wrong.empty()) return answer_error(response, 400, wrong);
  const std::optional<RecordingNotes::Outcome> outcome =
      parts_.recordings.write_notes(request.matches[1], notes, revision);
  if (!outcome) return answer_error(response, 404, "there is no such recording");
  if (!outcome->conflict) return answer(response, text_of(json{{"notes", outcome->now}}));
  const std::string problem = outcome->now.is_null() ? "" : outcome->now.value("problem", "");
  const std::string error = problem.empty() ? "somebody else has changed these notes meanwhile" : problem;
  answer(response, text_of(json{{"error", error}, {"hint", ""}, {"notes", outcome->now}}), 409);
}

}  // namespace tessera::server
