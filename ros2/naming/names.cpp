#include "ros2/naming/names.hpp"

#include <algorithm>
#include <charconv>

namespace tessera::ros2 {
namespace {

constexpr std::size_t longest_dds_name = 256;
constexpr int deepest_history = 10000;
constexpr std::string_view service_folder = "/srv/";
constexpr std::string_view action_folder = "/action/";

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A part of a topic between two slashes.
bool is_token(std::string_view token) {
  return !token.empty() && !is_digit(token[0]) && token.find("__") == std::string_view::npos &&
         std::ranges::all_of(token, [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
}

/// Whether it can be the name of a package or a type.
bool is_name(std::string_view part) {
  return !part.empty() &&
         std::ranges::all_of(part, [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
}

/// PACKAGE, the folder and NAME.
std::optional<std::string> name_in(std::string_view folder, std::string_view written) {
  const std::size_t at = written.find(folder);
  if (at == std::string_view::npos || !is_name(written.substr(0, at)) ||
      !is_name(written.substr(at + folder.size())))
    return std::nullopt;
  return std::string(written);
}

std::string_view without_blanks(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

bool read_depth(std::string_view digits, Qos& qos) {
  digits = without_blanks(digits);
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), qos.depth);
  return problem == std::errc() && end == digits.data() + digits.size() && qos.depth > 0 &&
         qos.depth <= deepest_history;
}

bool read_part(std::string_view part, Qos& qos) {
  if (part == "default" || part == "sensor") {
    qos = part == "sensor" ? Qos{.reliable = false, .depth = 5} : Qos{};
    return true;
  }
  if (part == "reliable" || part == "best_effort") {
    qos.reliable = part == "reliable";
    return true;
  }
  if (part == "volatile" || part == "transient_local") {
    qos.transient_local = part == "transient_local";
    return true;
  }
  return part.starts_with("depth ") && read_depth(part.substr(6), qos);
}

}  // namespace

std::string full_topic_name(std::string_view written, std::string& error) {
  const std::string topic = (written.starts_with('/') ? "" : "/") + std::string(written);
  std::string_view left = std::string_view(topic).substr(1);
  bool good = dds_topic_name(topic).size() <= longest_dds_name;
  while (good) {
    const std::size_t slash = std::min(left.find('/'), left.size());
    good = is_token(left.substr(0, slash));
    if (slash == left.size()) break;
    left.remove_prefix(slash + 1);
  }
  if (good) return topic;
  error = "'" + std::string(written) +
          "' is no name of a topic: its parts have letters, digits and single underscores, and begin with no "
          "digit";
  return {};
}

std::string dds_topic_name(std::string_view topic) { return "rt" + std::string(topic); }

std::string dds_type_name(std::string_view message) {
  std::string name;
  while (!message.empty()) {
    const std::size_t slash = std::min(message.find('/'), message.size());
    const bool last = slash == message.size();
    name += last ? "dds_::" + std::string(message) + "_" : std::string(message.substr(0, slash)) + "::";
    message.remove_prefix(std::min(slash + 1, message.size()));
  }
  return name;
}

std::string dds_request_name(std::string_view service) { return "rq" + std::string(service) + "Request"; }
std::string dds_reply_name(std::string_view service) { return "rr" + std::string(service) + "Reply"; }

std::string request_type(std::string_view service_type) { return std::string(service_type) + "_Request"; }
std::string response_type(std::string_view service_type) { return std::string(service_type) + "_Response"; }

std::string goal_type(std::string_view action_type) { return std::string(action_type) + "_Goal"; }
std::string progress_type(std::string_view action_type) { return std::string(action_type); }

ActionNames names_of_action(std::string_view action, std::string_view action_type) {
  const std::string name = std::string(action) + "/_action/", type(action_type);
  return {name + "send_goal",        name + "get_result",
          name + "cancel_goal",      type + "_SendGoal",
          type + "_GetResult",       "action_msgs/srv/CancelGoal",
          name + "feedback",         name + "status",
          type + "_FeedbackMessage", "action_msgs/msg/GoalStatusArray"};
}

bool is_service_type(std::string_view type) { return type.find(service_folder) != std::string_view::npos; }

bool is_action_type(std::string_view type) { return type.find(action_folder) != std::string_view::npos; }

std::optional<std::string> full_service_name(std::string_view written) {
  return name_in(service_folder, written);
}
std::optional<std::string> full_action_name(std::string_view written) {
  return name_in(action_folder, written);
}

std::optional<std::string> full_message_name(std::string_view written) {
  const std::size_t slash = written.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const std::string_view package = written.substr(0, slash);
  std::string_view message = written.substr(slash + 1);
  if (message.starts_with("msg/")) message.remove_prefix(4);
  if (!is_name(package) || !is_name(message)) return std::nullopt;
  return std::string(package) + "/msg/" + std::string(message);
}

bool is_node_name(std::string_view name) { return is_token(name) && name.size() <= 255; }

std::string node_name_of(std::string_view system) {
  std::string name;
  for (const char c : system)
    if (is_letter(c) || is_digit(c) || (!name.empty() && name.back() != '_'))
      name += is_letter(c) || is_digit(c) ? c : '_';
  while (name.ends_with('_')) name.pop_back();
  return name.empty() || is_digit(name[0]) ? "tessera_" + name : name;
}

std::optional<Qos> parse_qos(std::string_view text, std::string& error) {
  Qos qos;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const std::string_view part = without_blanks(text.substr(0, comma));
    if (!read_part(part, qos)) {
      error = "'" + std::string(part) + "' is no quality of service";
      return std::nullopt;
    }
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return qos;
}

}  // namespace tessera::ros2
