#include "sim/coppelia/client.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <utility>

#include "sim/coppelia/link_error.hpp"

namespace tessera::coppelia {
namespace {

using nlohmann::json;
using SteadyClock = std::chrono::steady_clock;

constexpr int protocol_version = 2;
/// CoppeliaSim forgets a client after this time without a request, and its simulation then goes on by itself.
/// So a run can be paused for this long, and the simulation of a killed controller stands still for this
/// long.
constexpr int forgotten_after_s = 60;
constexpr auto pause_before_repeating = std::chrono::milliseconds(1);

/// Reads a reply of limited nesting: the library recurses once per level, on the stack.
class BoundedReader : public nlohmann::detail::json_sax_dom_parser<json> {
 public:
  explicit BoundedReader(json& value) : json_sax_dom_parser(value, /*allow_exceptions_=*/false) {}
  bool start_object(std::size_t size) {
    return ++depth_ <= deepest && json_sax_dom_parser::start_object(size);
  }
  bool start_array(std::size_t size) { return ++depth_ <= deepest && json_sax_dom_parser::start_array(size); }
  bool end_object() { return --depth_, json_sax_dom_parser::end_object(); }
  bool end_array() { return --depth_, json_sax_dom_parser::end_array(); }

 private:
  static constexpr int deepest = 32;
  int depth_ = 0;
};

/// Null: these bytes are no CBOR, or nested too deeply.
template <class Bytes>
json from_bounded_cbor(const Bytes& bytes) {
  json value;
  BoundedReader reader(value);
  const bool good = json::sax_parse(bytes, &reader, json::input_format_t::cbor, /*strict=*/true);
  return good ? value : json(nullptr);
}

/// A random UUID of version 4.
std::string random_uuid() {
  std::random_device random;
  std::uniform_int_distribution<int> digit(0, 15);
  std::string uuid = "xxxxxxxx-xxxx-4xxx-8xxx-xxxxxxxxxxxx";
  for (char& letter : uuid)
    if (letter == 'x') letter = "0123456789abcdef"[digit(random)];
  return uuid;
}

/// The message of an error, without the traceback that the server appends: in it, words replace line feeds
/// and tabs.
std::string first_line(std::string text) {
  for (const char* mark : {"_=NL=_", "\n", "stack traceback"})
    if (const std::size_t at = text.find(mark); at != std::string::npos && at > 0) text.resize(at);
  return text;
}

std::string text_or_nothing(const json& map, const char* key) {
  const auto found = map.find(key);
  return found != map.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// A function without a result returns an empty map.
json returned(const json& values) { return values.is_array() ? values : json::array(); }

}  // namespace

Client::Client(const WorldServer& server)
    : socket_(server.host, server.port, server.timeout),
      name_(server.host + ":" + std::to_string(server.port)),
      uuid_(random_uuid()) {}

Client::~Client() {
  if (lost_ || !introduced_) return;
  try {
    static_cast<void>(exchange({{"func", "_*end*_"}, {"args", json::array()}}, std::chrono::seconds(1)));
  } catch (const LinkError&) {  // the client leaves in any case
  }
}

json Client::exchange(json request, Duration patience) {
  request["uuid"] = uuid_;
  request["argsL"] = request["args"].size();
  if (!std::exchange(introduced_, true)) {
    request["ver"] = protocol_version;
    request["lang"] = "cpp";
    request["timeout"] = forgotten_after_s;
  }
  json reply = from_bounded_cbor(socket_.ask(json::to_cbor(request), patience));
  if (reply.is_object()) return reply;
  throw LinkError("the program at " + name_ + " speaks another protocol: the reply is no map in CBOR");
}

json Client::call(const std::string& function, json arguments, Duration patience) try {
  if (lost_) throw LinkError("the connection to " + name_ + " was lost before");
  const auto end = SteadyClock::now() + patience;
  const json request{{"func", function}, {"args", std::move(arguments)}};
  const json executed{{"func", "_*executed*_"}, {"args", json::array()}};
  const auto unfinished = [&] {
    return LinkError("the server at " + name_ + " has not finished " + function + " for " +
                     std::to_string(std::chrono::ceil<std::chrono::seconds>(patience).count()) + " s");
  };
  json reply = exchange(request, patience);
  for (;;) {
    if (const auto values = reply.find("ret"); values != reply.end()) return returned(*values);
    if (const std::string error = text_or_nothing(reply, "err"); !error.empty())
      throw RefusedCall(first_line(error));
    const std::string next = text_or_nothing(reply, "func");
    if (next.empty())
      throw LinkError("the server at " + name_ + " speaks another version of the remote API" +
                      (reply.contains("success") ? " (1; CoppeliaSim before 4.5): it says '" +
                                                       first_line(text_or_nothing(reply, "error")) + "'"
                                                 : ""));
    const bool again = next == "_*repeat*_";
    if (again) std::this_thread::sleep_for(pause_before_repeating);
    const Duration left = end - SteadyClock::now();
    if (left <= Duration::zero()) throw unfinished();
    // We have no callbacks, so a request for one is answered like a request to wait.
    try {
      reply = exchange(again ? request : executed, left);
    } catch (const NoReply&) {  // it has answered before, even if little time was left for this reply
      throw unfinished();
    }
  }
} catch (const LinkError&) {
  lost_ = true;
  throw;
}

}  // namespace tessera::coppelia
