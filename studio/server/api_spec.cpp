#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <variant>

#include "server/analysis/chain_bounds.hpp"
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

/// The answer, or why there is none.
void answer_found(httplib::Response& response, const std::variant<json, std::string>& found) {
  if (const auto* const why = std::get_if<std::string>(&found)) return answer_error(response, 422, *why);
  answer(response, text_of(std::get<json>(found)));
}

/// nullopt: it is not understood.
std::optional<OtherTimes> other_times(const json& given) {
  OtherTimes result;
  for (const auto& [name, value] : given.items()) {
    if (name == "path") {
      if (!value.is_string()) return std::nullopt;
      result.path = value.get<std::string>();
      continue;
    }
    std::int64_t* const time = name == "period_ns"     ? &result.period
                               : name == "shortest_ns" ? &result.shortest
                               : name == "longest_ns"  ? &result.longest
                                                       : nullptr;
    constexpr double hour_ns = 3600e9;
    if (time == nullptr || !value.is_number()) return std::nullopt;
    const double ns = value.get<double>();
    if (!(ns >= 0 && ns <= hour_ns)) return std::nullopt;
    *time = std::llround(ns);
  }
  if (result.path.empty()) return std::nullopt;
  return result;
}

/// nullopt: one of them is not understood, and that was answered.
std::optional<std::vector<OtherTimes>> other_times(RequestBody& body, httplib::Response& response) {
  std::vector<OtherTimes> others;
  for (const json& one : body.objects("what_if")) {
    const std::optional<OtherTimes> other = other_times(one);
    if (!other) {
      answer_error(response, 400,
                   "an entry of what_if has a path, and times in nanoseconds from 0 to an hour");
      return std::nullopt;
    }
    others.push_back(*other);
  }
  return others;
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
  server.Post("/api/timing", by(&Api::get_timing));
  server.Post("/api/timing/changes", by(&Api::get_changes_of_chain));
  server.Post("/api/timing/worst", by(&Api::get_worst_run_of_chain));
}

void Api::get_timing(const Request& request, Response& response) {
  RequestBody body(request, response);
  const std::string text = body.text("text"), explained = body.text_or("chain", "");
  const std::optional<std::vector<OtherTimes>> others = other_times(body, response);
  if (!others) return;
  if (!body.good()) return;
  const std::shared_ptr<const Analysis> analysis = parts_.analyses.of(text);
  if (!analysis->model) return answer_error(response, 422, "a specification with errors has no times");
  answer_found(response, chain_bounds(*analysis->model, *others, explained));
}

void Api::get_changes_of_chain(const Request& request, Response& response) {
  RequestBody body(request, response);
  const std::string text = body.text("text"), chain = body.text("chain");
  if (!body.good()) return;
  const std::shared_ptr<const Analysis> analysis = parts_.analyses.of(text);
  if (!analysis->model) return answer_error(response, 422, "a specification with errors has no times");
  answer_found(response, chain_changes(*analysis->model, chain));
}

void Api::get_worst_run_of_chain(const Request& request, Response& response) {
  RequestBody body(request, response);
  const std::string text = body.text("text"), chain = body.text("chain"), of = body.text("of");
  const std::optional<std::vector<OtherTimes>> others = other_times(body, response);
  if (!others || !body.good()) return;
  if (of != "age" && of != "reaction") return answer_error(response, 400, "`of` is age or reaction");
  const std::shared_ptr<const Analysis> analysis = parts_.analyses.of(text);
  if (!analysis->model) return answer_error(response, 422, "a specification with errors has no times");
  answer_found(response, chain_worst_run(*analysis->model, *others, chain, of == "age"));
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
