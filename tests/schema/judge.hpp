#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// Judges messages of a test by the schemas of share/tessera, which judge.js reads. A message that does not
/// fit fails the test. Without Node.js, no message is judged.
///
/// Threads: any.
namespace tessera::schema_test {

/// A request to the server of the studio and its answer. target: path and query.
void judge_exchange(const std::string& method, const std::string& target, const std::string& body, int status,
                    const std::string& answer);
/// A server-sent event.
void judge_event(const std::string& name, const nlohmann::json& data);
/// A line that a controller sends on its control socket.
void judge_line(const nlohmann::json& data);
/// A command to a controller, which it has taken.
void judge_command(const nlohmann::json& data);
/// The summary of a run, as its controller writes it.
void judge_summary(const nlohmann::json& data);

}  // namespace tessera::schema_test
