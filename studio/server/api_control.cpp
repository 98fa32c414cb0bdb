#include "server/api.hpp"
#include "server/http/answer.hpp"

namespace tessera::server {

void Api::control_run(Run& run, const Request& request, Response& response) {
  RequestBody body(request, response);
  const RunControl wanted{.command = body.text("command"),
                          .subsystem = body.text_or("subsystem", ""),
                          .speed = body.number("value"),
                          .path = body.text_or("path", ""),
                          .text = body.text_or("text", ""),
                          .who = body.text_or("operator", ""),
                          .inputs = body.inputs("inputs"),
                          .after_s = body.number("after"),
                          .within_s = body.number("within"),
                          .places = body.indices("breakpoints", "place"),
                          .transitions = body.indices("breakpoints", "transition"),
                          .conditions = body.indices("breakpoints", "condition")};
  if (!body.good()) return;
  const bool operates = wanted.command == "panel";
  // To let go is never too late.
  const bool late = operates && wanted.inputs && RunOperators::is_late(wanted.input(), stamp_now());
  if (!late)
    if (const std::optional<Problem> problem = run.control(wanted))
      return answer_error(response, 409, problem->text);
  nlohmann::json done = operates ? run.operators() : nlohmann::json::object();
  if (late) done["late"] = true;
  answer(response, text_of(done));
}

}  // namespace tessera::server
