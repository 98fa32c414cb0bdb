#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "project/files/trust.hpp"
#include "project/process/process.hpp"
#include "server/api.hpp"
#include "server/http/answer.hpp"

namespace tessera::server {

using nlohmann::json;

bool Api::holds_nothing_to_build() const {
  std::error_code ignored;
  for (const char* const part : {"src", "test", "project.cmake", "CMakeLists.txt", ".tessera"})
    if (std::filesystem::exists(std::filesystem::symlink_status(parts_.file.folder() / part, ignored)))
      return false;
  return true;
}
bool Api::trust_folder() {
  const bool kept = project::trust(parts_.file.folder());
  if (!kept) trusted_here_ = true;
  return kept;
}
bool Api::is_trusted() const { return trusted_here_ || project::is_trusted(parts_.file.folder()); }

void Api::answer_command(const std::vector<std::string>& arguments, Response& response) {
  // The command may have been replaced since this process began.
  const std::string own = fmt::format("/proc/{}/exe", getpid());
  project::Command command{options_.command.empty() ? own : options_.command.string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const std::atomic<bool> never{false};
  json lines = json::array();
  const project::Exit exit = project::capture_apart(
      command, never, [&](std::string_view line) { lines.push_back(std::string(line)); });
  parts_.driving.look_soon();
  answer(response, text_of(json{{"done", exit.code == 0}, {"lines", std::move(lines)}}));
}

void Api::serve_consent(HttpServer& server) {
  server.Post("/api/trust", [this](const Request&, Response& response) {
    answer(response, text_of(json{{"kept", trust_folder()}}));
  });
  server.Get("/api/driving", [this](const Request&, Response& response) {
    answer(response, text_of(parts_.driving.last()));
  });
  // The command of the command line: in an emergency there is one way, and it is the one that is tested.
  server.Post("/api/emergency_stop", [this](const Request&, Response& response) {
    answer_command({"emergency-stop", "--why", "the studio's page"}, response);
  });
  server.Post("/api/emergency_reset", [this](const Request& request, Response& response) {
    RequestBody body(request, response);
    const std::string controller = body.text("controller");
    if (!body.good()) return;
    const json controllers = parts_.driving.last().at("controllers");
    const auto found =
        std::ranges::find(controllers, json(controller), [](const json& one) { return one.at("name"); });
    if (found == controllers.end()) return answer_error(response, 404, "there is no such controller");
    // The end of a tunnel has no name that the command knows; alone, it needs none.
    if (controllers.size() == 1) return answer_command({"reset"}, response);
    const bool deployed = found->at("deployed").get<bool>();
    answer_command({"reset", deployed ? found->at("system").get<std::string>()
                                      : std::to_string(found->at("process").get<std::int64_t>())},
                   response);
  });
}

}  // namespace tessera::server
