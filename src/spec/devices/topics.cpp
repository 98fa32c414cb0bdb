#include "spec/devices/topics.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>

#include "diagnostics/utf8.hpp"
#include "ros2/naming/names.hpp"
#include "spec/devices/driver_options.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

constexpr const char* topic_hint = "for example { ros2: /cmd_vel, type: geometry_msgs/msg/Twist }";
constexpr const char* service_hint =
    "role: client sends requests and gets replies; role: server gets requests and sends replies";
constexpr const char* action_hint =
    "role: client orders goals and gets what becomes of them; role: server gets goals and says what becomes "
    "of them";
constexpr const char* transform_hint =
    "for example { ros2: /tf, frame: base_link, in: map }, the pose of base_link in map";
constexpr const char* at_hint =
    "at: scan gives the transform at the stamps of the real buffer scan beside it";
constexpr int highest_domain = 232;

/// Words and dots: "linear.x".
bool is_field_path(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  });
}
/// Without what separates the parts of lists and options.
bool is_plain(std::string_view text) { return text.find_first_of(",=\n\r\t\"") == std::string_view::npos; }

/// A name without blanks. tf2 refuses those that begin with a slash.
bool is_frame(std::string_view text) {
  return is_plain(text) && !text.empty() && text.find_first_of(" '") == std::string_view::npos &&
         text[0] != '/';
}

enum class Use : std::uint8_t { topic, service, action, transform };

bool is_transform_topic(std::string_view topic) {
  const std::string_view name = topic.substr(topic.rfind('/') + 1);
  return name == "tf" || name == "tf_static";
}

class TopicReader {
 public:
  TopicReader(const Section& section, Use use, Driver& driver, Diagnostics& out)
      : section_(section), use_(use), driver_(driver), out_(out) {}

  void read() {
    read_name();
    if (use_ == Use::topic) read_message();
    if (use_ == Use::service) read_service();
    if (use_ == Use::action) read_action();
    if (use_ == Use::transform) read_transform();
    if (const Entry* fields = section_.find("fields")) read_fields(*fields);
    if (const Entry* names = section_.find("names")) put(*names, list_of(*names, "the names"));
    if (const Entry* qos = section_.find("qos")) read_qos(*qos);
    for (const char* option : {"frame_id", "interface"}) read_text(option);
    if (const Entry* publishers = section_.find("publishers")) read_publishers(*publishers);
    if (const Entry* peers = section_.find("peers")) put(*peers, list_of(*peers, "the peers"));
    read_node();
    if (const Entry* domain = section_.find("domain")) read_domain(*domain);
    for (const char* option : {"wait", "timeout"}) read_time(option);
  }

 private:
  void put(const Entry& entry, std::string text) {
    driver_.option_spans.emplace(entry.key, entry.value->is_scalar() ? entry.value->span : entry.span);
    if (!text.empty()) driver_.options.emplace(entry.key, DriverOption{std::move(text), ""});
  }

  void read_name() {
    const Entry* const entry = section_.require("ros2", topic_hint);
    const Node* const text =
        entry == nullptr ? nullptr : text_of(*entry->value, entry->span, "the topic", out_, topic_hint);
    if (text == nullptr) return;
    std::string error;
    const std::string name = with_agent_number(text->text, 0);
    // The longest name of the topics and services of an action.
    const std::string longest =
        use_ == Use::action ? ros2::names_of_action(name, "").cancel_goal + "Request" : name;
    if (ros2::full_topic_name(name, error).empty() || ros2::full_topic_name(longest, error).empty())
      out_.error("E105", text->span, error,
                 "for example /cmd_vel, or /robot{i}/cmd_vel for each agent of a fleet");
    driver_.targets.push_back({text->text, text->span});
  }

  void read_message() {
    const Entry* const entry = section_.require("type", topic_hint);
    const Node* const text =
        entry == nullptr ? nullptr : text_of(*entry->value, entry->span, "the type", out_, topic_hint);
    if (text == nullptr) return;
    const auto name = ros2::full_message_name(text->text);
    if (!name)
      out_.error("E105", text->span, in_quotes(text->text) + " is no name of a message",
                 "for example geometry_msgs/msg/Twist");
    put(*entry, name.value_or(""));
  }

  void read_service() {
    read_type("std_srvs/srv/SetBool", "service", ros2::full_service_name);
    if (const Entry* const role = section_.require("role", service_hint)) read_role(*role, service_hint);
  }

  /// An action has clients more often than servers.
  void read_action() {
    read_type("nav2_msgs/action/NavigateToPose", "action", ros2::full_action_name);
    if (const Entry* const role = section_.find("role"))
      read_role(*role, action_hint);
    else
      driver_.options.emplace("role", DriverOption{std::string("client"), ""});
  }

  void read_type(const std::string& example, const std::string& what,
                 std::optional<std::string> (*full_name)(std::string_view)) {
    const Entry* const type = section_.require("type", "for example type: " + example);
    const Node* const name = type == nullptr ? nullptr : text_of(*type->value, type->span, "the type", out_);
    if (name == nullptr) return;
    if (!full_name(name->text))
      out_.error("E105", name->span,
                 in_quotes(name->text) + " is no name of " + (what == "action" ? "an " : "a ") + what,
                 "for example " + example);
    put(*type, name->text);
  }

  void read_role(const Entry& role, const char* hint) {
    const Node* const text = text_of(*role.value, role.span, "the role", out_);
    if (text == nullptr) return;
    if (text->text != "client" && text->text != "server")
      out_.error("E204", text->span, "the role must be client or server, not " + in_quotes(text->text), hint);
    if (const Entry* const wait = section_.find("wait"); wait != nullptr && text->text == "server")
      out_.error("E102", wait->span, "a server has no 'wait'", "it answers clients whenever they come");
    put(role, text->text);
  }

  void read_transform() {
    static const std::string type = "tf2_msgs/msg/TFMessage";
    if (const Entry* const given = section_.find("type"); given != nullptr)
      if (const Node* const text = text_of(*given->value, given->span, "the type", out_);
          text != nullptr && ros2::full_message_name(text->text) != type)
        out_.error("E204", text->span,
                   "transforms are messages of " + type + ", not " + in_quotes(text->text),
                   "leave it out, or leave out `frame` and `in` to read messages of another type");
    driver_.options.emplace("type", DriverOption{type, ""});
    const Entry* const name = section_.find("ros2");
    if (name != nullptr && name->value->is_scalar() && !is_transform_topic(name->value->text))
      out_.error("E105", name->value->span, in_quotes(name->value->text) + " is no topic of transforms",
                 "/tf, or /tf_static for those that never change; /robot{i}/tf for each agent of a fleet");
    const std::string frame = read_frame("frame"), in = read_frame("in");
    if (const Entry* const at = section_.find("at"))
      if (const Node* const text = text_of(*at->value, at->span, "the buffer", out_, at_hint);
          text != nullptr) {
        if (!is_field_path(text->text) || text->text.find('.') != std::string::npos)
          out_.error("E105", text->span, in_quotes(text->text) + " is no name of a real buffer", at_hint);
        else
          put(*at, text->text);
      }
    if (!frame.empty() && frame == in)
      out_.error("E204", section_.find("in")->value->span, "a frame is not transformed into itself",
                 transform_hint);
  }

  std::string read_frame(const char* key) {
    const Entry* const entry = section_.require(key, transform_hint);
    const Node* const text =
        entry == nullptr ? nullptr : text_of(*entry->value, entry->span, "the frame", out_, transform_hint);
    if (text == nullptr) return {};
    if (!is_frame(text->text)) {
      out_.error("E105", text->span, in_quotes(text->text) + " is no name of a frame",
                 text->text.starts_with('/') ? "frames of ROS 2 have no slash at the beginning"
                                             : "for example base_link, or robot{i}/base_link for a fleet");
      return {};
    }
    put(*entry, text->text);
    return text->text;
  }

  /// A field of the message for all of the buffer, or a map of fields.
  void read_fields(const Entry& entry) {
    if (entry.value->is_scalar()) {
      driver_.option_spans.emplace("fields." + entry.value->text, entry.value->span);
      if (check_path(entry.value->text, entry.value->span)) put(entry, entry.value->text);
      return;
    }
    std::string all;
    for (const Entry& one : entries_of(*entry.value, entry.span, "fields", out_)) {
      driver_.option_spans.emplace("fields." + one.key, one.span);
      const Node* const text = text_of(*one.value, one.span, "the field of the buffer", out_,
                                       "for example fields: { linear.x: v, angular.z: omega }");
      if (text == nullptr || !check_path(one.key, one.span) || !check_path(text->text, text->span)) continue;
      all += (all.empty() ? "" : ", ") + one.key + "=" + text->text;
    }
    put(entry, all);
  }

  bool check_path(const std::string& path, const Span& at) {
    if (is_field_path(path)) return true;
    out_.error("E105", at, in_quotes(path) + " is no name of a field", "for example linear.x");
    return false;
  }

  std::string list_of(const Entry& entry, const char* what) {
    std::string all;
    if (entry.value->is_scalar()) return plain_text(*entry.value, entry.span, what);
    for (const Node* item : items_of(*entry.value, entry.span, what, out_)) {
      const std::string one = plain_text(*item, entry.span, what);
      if (!one.empty()) all += (all.empty() ? "" : ", ") + one;
    }
    return all;
  }

  std::string plain_text(const Node& node, const Span& at, const char* what) {
    const Node* const text = text_of(node, at, what, out_);
    if (text == nullptr) return {};
    if (is_plain(text->text)) return text->text;
    out_.error("E105", text->span, std::string(what) + " may not contain commas, quotes or =");
    return {};
  }

  void read_text(const char* option) {
    const Entry* const entry = section_.find(option);
    if (entry != nullptr) put(*entry, plain_text(*entry->value, entry->span, option));
  }

  void read_node() {
    const Entry* const entry = section_.find("node");
    const Node* const text =
        entry == nullptr ? nullptr : text_of(*entry->value, entry->span, "the node", out_);
    if (text == nullptr) return;
    if (!ros2::is_node_name(with_agent_number(text->text, 0)))
      out_.error("E105", text->span, in_quotes(text->text) + " is no name of a node",
                 "letters, digits and single underscores, for example base_driver");
    put(*entry, text->text);
  }

  /// qos: sensor, or qos: { reliability: best_effort, durability: volatile, depth: 5 }.
  void read_qos(const Entry& entry) {
    if (entry.value->is_map()) return read_policies(entry);
    const Node* const text = text_of(*entry.value, entry.span, "qos", out_);
    if (text == nullptr) return;
    if (text->text != "sensor" && text->text != "default")
      out_.error("E204", text->span, "qos must be default or sensor, not " + in_quotes(text->text),
                 "or its parts: qos: { reliability: best_effort, durability: volatile, depth: 5 }");
    put(entry, text->text);
  }

  void read_publishers(const Entry& entry) {
    const Node* const text = text_of(*entry.value, entry.span, "publishers", out_);
    if (text == nullptr) return;
    if (text->text != "one")
      out_.error("E204", text->span, "'publishers' must be one, not " + in_quotes(text->text),
                 "without it, messages of any number of publishers are taken");
    put(entry, text->text);
  }

  void read_policies(const Entry& entry) {
    const Section policies(*entry.value, entry.span, "qos", {"reliability", "durability", "depth"}, out_);
    std::string all;
    const auto add = [&](const std::string& part) { all += (all.empty() ? "" : ", ") + part; };
    for (const auto& [key, first, second] : {std::tuple{"reliability", "reliable", "best_effort"},
                                             {"durability", "volatile", "transient_local"}})
      if (const Entry* policy = policies.find(key)) {
        const Node* const text = text_of(*policy->value, policy->span, key, out_);
        if (text == nullptr) continue;
        if (text->text != first && text->text != second)
          out_.error(
              "E204", text->span,
              std::string(key) + " must be " + first + " or " + second + ", not " + in_quotes(text->text));
        add(text->text);
      }
    if (const Entry* depth = policies.find("depth"))
      if (const auto number = whole(*depth, "the depth", 1, 10000)) add("depth " + std::to_string(*number));
    put(entry, all);
  }

  std::optional<int> whole(const Entry& entry, const char* what, int least, int most) {
    const Node* const text = text_of(*entry.value, entry.span, what, out_);
    if (text == nullptr) return std::nullopt;
    const char* const end = text->text.data() + text->text.size();
    int number = 0;
    const auto [behind, problem] = std::from_chars(text->text.data(), end, number);
    if (problem == std::errc() && behind == end && number >= least && number <= most) return number;
    out_.error("E204", text->span,
               std::string(what) + " must be a whole number from " + std::to_string(least) + " to " +
                   std::to_string(most) + ", not " + in_quotes(text->text));
    return std::nullopt;
  }

  void read_domain(const Entry& entry) {
    driver_.option_spans.emplace("domain", entry.value->is_scalar() ? entry.value->span : entry.span);
    const auto domain = whole(entry, "the domain", 0, highest_domain);
    if (domain) driver_.options.emplace("domain", DriverOption{static_cast<double>(*domain), ""});
  }

  void read_time(const char* option) {
    const Entry* const entry = section_.find(option);
    if (entry == nullptr) return;
    const auto time = read_duration(*entry->value, entry->span, option, out_);
    driver_.option_spans.emplace(option, entry->value->is_scalar() ? entry->value->span : entry->span);
    if (!time) return;
    const double seconds = std::chrono::duration<double>(*time).count();
    driver_.options.emplace(option, DriverOption{seconds, "s"});
  }

  const Section& section_;
  Use use_;
  Driver& driver_;
  Diagnostics& out_;
};

/// A transform has frames. On a topic of transforms it may be meant if nothing is said of the messages.
bool is_transform(const Entry& entry) {
  bool is_topic = false, has_type = false;
  for (const Entry& key : entry.value->entries) {
    if (key.key == "frame" || key.key == "in") return true;
    if (key.key == "ros2") is_topic = is_transform_topic(key.value->text);
    if (key.key == "type") has_type = true;
  }
  return is_topic && !has_type;
}

/// A topic has no role, and services and actions have types of their own kinds.
Use use_of(const Entry& entry) {
  if (is_transform(entry)) return Use::transform;
  Use use = Use::topic;
  for (const Entry& key : entry.value->entries) {
    if (key.key == "type" && ros2::is_action_type(key.value->text)) return Use::action;
    if (key.key == "role" || (key.key == "type" && ros2::is_service_type(key.value->text)))
      use = Use::service;
  }
  return use;
}

}  // namespace

void read_topic(const Entry& entry, Driver& driver, Diagnostics& out) {
  driver.kind = topic_kind;
  const Use use = use_of(entry);
  if (use == Use::action) {
    const Section section(*entry.value, entry.span, "an action of ROS 2",
                          {"ros2", "type", "role", "fields", "names", "frame_id", "node", "domain",
                           "interface", "peers", "wait", "timeout"},
                          out);
    if (section.readable()) TopicReader(section, use, driver, out).read();
    return;
  }
  if (use == Use::transform) {
    const Section section(
        *entry.value, entry.span, "a transform of ROS 2",
        {"ros2", "type", "frame", "in", "at", "fields", "node", "domain", "interface", "peers", "wait"}, out);
    if (section.readable()) TopicReader(section, use, driver, out).read();
    return;
  }
  if (use == Use::service) {
    const Section section(
        *entry.value, entry.span, "a service of ROS 2",
        {"ros2", "type", "role", "fields", "node", "domain", "interface", "peers", "wait", "timeout"}, out);
    if (section.readable()) TopicReader(section, use, driver, out).read();
    return;
  }
  const Section section(*entry.value, entry.span, "a topic of ROS 2",
                        {"ros2", "type", "fields", "names", "qos", "publishers", "frame_id", "node", "domain",
                         "interface", "peers", "wait"},
                        out);
  if (section.readable()) TopicReader(section, use, driver, out).read();
}

}  // namespace tessera::spec
