#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "server/analysis/arrangement.hpp"
#include "server/api.hpp"
#include "server/http/answer.hpp"

namespace tessera::server {

using nlohmann::json;

void Api::serve_arrangement(HttpServer& server) {
  server.Get("/api/arrangement", [this](const Request&, Response& response) {
    answer(response, text_of(json{{"entries", arrangement_.read()}}));
  });
  server.Put("/api/arrangement", [this](const Request& request, Response& response) {
    RequestBody body(request, response);
    const std::string name = body.text("name"), text = body.text("text");
    if (!body.good()) return;
    const auto is_of_name = [](char one) { return (one >= 'a' && one <= 'z') || one == '_'; };
    if (name.empty() || name.size() > Arrangement::longest_name || !std::ranges::all_of(name, is_of_name))
      return answer_error(response, 400,
                          fmt::format("a 'name' has up to {} small letters", Arrangement::longest_name));
    if (text.size() > Arrangement::longest_text)
      return answer_error(response, 400,
                          fmt::format("a 'text' has up to {} bytes", Arrangement::longest_text));
    answer(response, text_of(json{{"kept", arrangement_.keep(name, text)}}));
  });
}

}  // namespace tessera::server
