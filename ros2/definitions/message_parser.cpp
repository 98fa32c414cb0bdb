#include "ros2/definitions/message_parser.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

#include "ros2/definitions/literals.hpp"
#include "tessera/nearest.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::uint32_t most_elements = 1U << 28;
constexpr std::size_t longest_text = 1U << 20;

struct NamedPrimitive {
  std::string_view name;
  Primitive primitive;
};
constexpr std::array named_primitives = std::to_array<NamedPrimitive>({{"bool", Primitive::boolean},
                                                                       {"byte", Primitive::uint8},
                                                                       {"char", Primitive::uint8},
                                                                       {"int8", Primitive::int8},
                                                                       {"uint8", Primitive::uint8},
                                                                       {"int16", Primitive::int16},
                                                                       {"uint16", Primitive::uint16},
                                                                       {"int32", Primitive::int32},
                                                                       {"uint32", Primitive::uint32},
                                                                       {"int64", Primitive::int64},
                                                                       {"uint64", Primitive::uint64},
                                                                       {"float32", Primitive::float32},
                                                                       {"float64", Primitive::float64},
                                                                       {"string", Primitive::string},
                                                                       {"wstring", Primitive::wstring}});

bool is_word(std::string_view text, bool upper_first, bool underscores, bool upper_rest) {
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
  if (text.empty() || !(upper_first ? is_upper(text[0]) : is_lower(text[0]))) return false;
  return std::ranges::all_of(text, [&](char c) {
    return is_lower(c) || (c >= '0' && c <= '9') || (underscores && c == '_') || (upper_rest && is_upper(c));
  });
}
bool is_field_name(std::string_view text) {
  return is_word(text, false, true, false) && text.find("__") == std::string_view::npos &&
         !text.ends_with('_');
}
std::string in_small_letters(std::string name) {
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return is_field_name(name) ? name : "to_the_left";
}
bool is_constant_name(std::string_view text) {
  if (text.empty() || text[0] < 'A' || text[0] > 'Z') return false;
  return std::ranges::all_of(
      text, [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; });
}
bool is_package_name(std::string_view text) { return is_word(text, false, true, false); }
bool is_message_name(std::string_view text) { return is_word(text, true, true, true); }

std::optional<std::uint32_t> bound_of(std::string_view digits) {
  std::uint32_t number = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (problem != std::errc() || end != digits.data() + digits.size() || number == 0 || number > most_elements)
    return std::nullopt;
  return number;
}

/// Reads the lines of one message.
class MessageReader {
 public:
  MessageReader(std::string_view name, std::string_view file, std::vector<Mistake>& mistakes)
      : file_(file), mistakes_(mistakes) {
    structure_.name = name;
  }

  /// first_line: its line number.
  std::optional<Structure> read(std::string_view text, std::size_t first_line) {
    const std::size_t before = mistakes_.size();
    line_ = first_line;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      read_line(trimmed(without_comment(text.substr(0, end))));
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line_;
    }
    if (mistakes_.size() != before) return std::nullopt;
    return std::move(structure_);
  }

 private:
  void wrong(std::string text, Hint hint = {}) {
    mistakes_.push_back({file_, line_, std::move(text), std::move(hint)});
  }

  void read_line(std::string_view line) {
    if (line.empty()) return;
    const std::size_t blank = line.find_first_of(" \t");
    if (blank == std::string_view::npos) return wrong("a field needs a name: '" + std::string(line) + "'");
    std::string_view written = line.substr(0, blank), rest = trimmed(line.substr(blank));
    // "string<= 5 x" and "string <=5" are not valid; without this check both would be reported as a strange
    // name below.
    const auto type = read_type(written);
    if (!type) return;
    structure_.text += std::string(line) + '\n';
    const std::size_t name_end = std::min(rest.find_first_of(" \t="), rest.size());
    const std::string name(rest.substr(0, name_end));
    rest = trimmed(rest.substr(name_end));
    if (!taken_.insert(name).second) return wrong("there is a '" + name + "' already");
    if (rest.starts_with('='))
      read_constant(name, *type, trimmed(rest.substr(1)));
    else
      read_field(name, *type, rest);
  }

  std::optional<Type> read_type(std::string_view written) {
    Type type;
    if (const std::size_t bracket = written.find('['); bracket != std::string_view::npos) {
      if (!read_repeat(written.substr(bracket), type)) return std::nullopt;
      written = written.substr(0, bracket);
    }
    std::string_view name = written;
    if (const std::size_t sign = written.find("<="); sign != std::string_view::npos) {
      name = written.substr(0, sign);
      const auto bound = bound_of(written.substr(sign + 2));
      if (!bound || (name != "string" && name != "wstring")) {
        wrong("'" + std::string(written) + "' is no type", "for example string<=64");
        return std::nullopt;
      }
      type.string_bound = *bound;
    }
    const auto* const known = std::ranges::find(named_primitives, name, &NamedPrimitive::name);
    if (known != named_primitives.end()) {
      type.primitive = known->primitive;
      return type;
    }
    type.primitive = Primitive::structure;
    type.refers = full_name(name);
    return type.refers.empty() ? std::nullopt : std::optional(type);
  }

  bool read_repeat(std::string_view brackets, Type& type) {
    if (brackets == "[]") {
      type.repeat = Type::Repeat::sequence;
      return true;
    }
    const bool bounded = brackets.starts_with("[<=");
    const std::size_t first = bounded ? 3 : 1;
    const auto count = brackets.ends_with(']') && brackets.size() > first + 1
                           ? bound_of(brackets.substr(first, brackets.size() - first - 1))
                           : std::nullopt;
    if (!count) {
      wrong("'" + std::string(brackets) + "' is no size of an array", "write [], [8] or [<=8]");
      return false;
    }
    type.repeat = bounded ? Type::Repeat::sequence : Type::Repeat::array;
    type.count = *count;
    return true;
  }

  /// "Vector3" and "geometry_msgs/Vector3" are "geometry_msgs/msg/Vector3"; empty after a mistake.
  std::string full_name(std::string_view name) {
    std::string_view package = std::string_view(structure_.name).substr(0, structure_.name.find('/'));
    std::string_view message = name;
    if (const std::size_t slash = name.find('/'); slash != std::string_view::npos) {
      package = name.substr(0, slash);
      message = name.substr(slash + 1);
      if (message.starts_with("msg/")) message.remove_prefix(4);
    }
    if (is_package_name(package) && is_message_name(message))
      return std::string(package) + "/msg/" + std::string(message);
    if (name == "time" || name == "duration") {
      wrong("unknown type '" + std::string(name) + "', which only ROS 1 has",
            std::string("a definition of ROS 2 has builtin_interfaces/") +
                (name == "time" ? "Time" : "Duration"));
      return {};
    }
    std::vector<std::string> names;
    for (const NamedPrimitive& one : named_primitives) names.emplace_back(one.name);
    wrong("unknown type '" + std::string(name) + "'", did_you_mean(name, names));
    return {};
  }

  void read_constant(const std::string& name, const Type& type, std::string_view value) {
    if (!is_constant_name(name))
      return wrong("'" + name + "' is no name of a constant", "write it in capital letters: TO_THE_LEFT");
    if (type.primitive == Primitive::structure || type.repeat != Type::Repeat::once)
      return wrong("the constant '" + name + "' must be a number, a bool or a string");
    std::string error;
    const auto literal = parse_literal(type.primitive, value, true, error);
    if (!literal) return wrong(error);
    structure_.constants.push_back({name, type.primitive, *literal});
  }

  void read_field(const std::string& name, const Type& type, std::string_view value) {
    if (!is_field_name(name))
      return wrong("'" + name + "' is no name of a field",
                   "write it in small letters: " + in_small_letters(name));
    Field field{name, type};
    if (!value.empty() && !read_default(value, field)) return;
    structure_.fields.push_back(std::move(field));
  }

  bool read_default(std::string_view value, Field& field) {
    std::string error = "a message has no default value";
    field.has_default = true;
    if (field.type.repeat == Type::Repeat::once) {
      const auto one = parse_literal(field.type.primitive, value, true, error);
      if (one) field.defaults.push_back(*one);
    } else if (field.type.primitive != Primitive::structure) {
      const auto all = parse_literals(field.type.primitive, value, error);
      if (all) field.defaults = *all;
      const bool fits = field.type.repeat == Type::Repeat::array
                            ? field.defaults.size() == field.type.count
                            : field.type.count == 0 || field.defaults.size() <= field.type.count;
      if (all && !fits) error = "the default has " + std::to_string(field.defaults.size()) + " elements";
      if (all && fits) return true;
      wrong(error);
      return false;
    }
    if (!field.defaults.empty() && is_short_enough(field)) return true;
    wrong(field.defaults.empty() ? error : "the default is longer than the string");
    return false;
  }

  static bool is_short_enough(const Field& field) {
    const auto* const text = std::get_if<std::string>(&field.defaults.front());
    return text == nullptr || field.type.string_bound == 0 || text->size() <= field.type.string_bound;
  }

  Structure structure_;
  std::string file_;
  std::vector<Mistake>& mistakes_;
  std::size_t line_ = 1;
  std::set<std::string> taken_;
};

bool is_text(std::string_view text, std::string_view file, std::vector<Mistake>& mistakes) {
  if (text.size() <= longest_text && text.find('\0') == std::string_view::npos) return true;
  mistakes.push_back(
      {std::string(file), 0, "this is no definition of a message: it is too long, or no text"});
  return false;
}

/// A part of a file, and its first line, counted from 1.
struct Part {
  std::string_view text;
  std::size_t line = 1;
};

/// The parts of a file that lines of three dashes separate; at most `most`, the last of which has the rest.
std::vector<Part> parts_between_dashes(std::string_view text, std::size_t most) {
  std::vector<Part> parts{{text}};
  std::size_t line = 1, at = 0, begin = 0;
  while (at < text.size() && parts.size() < most) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const bool dashes = trimmed(without_comment(text.substr(at, end - at))) == "---";
    if (dashes) parts.back().text = text.substr(begin, at - begin);
    at = std::min(end + 1, text.size());
    ++line;
    if (!dashes) continue;
    begin = at;
    parts.push_back({text.substr(begin), line});
  }
  return parts;
}

std::optional<Structure> read_part(std::string_view name, const char* ending, const Part& part,
                                   std::string_view file, std::vector<Mistake>& mistakes) {
  return MessageReader(std::string(name) + ending, file, mistakes).read(part.text, part.line);
}

}  // namespace

std::string Mistake::shown() const {
  const std::string place = file.empty() ? ""
                            : line == 0  ? file + ": "
                                         : file + ":" + std::to_string(line) + ": ";
  return with_hint(place + text, hint);
}

std::optional<Structure> parse_message(std::string_view name, std::string_view text, std::string_view file,
                                       std::vector<Mistake>& mistakes) {
  if (!is_text(text, file, mistakes)) return std::nullopt;
  return MessageReader(name, file, mistakes).read(text, 1);
}

std::optional<Service> parse_service(std::string_view name, std::string_view text, std::string_view file,
                                     std::vector<Mistake>& mistakes) {
  if (!is_text(text, file, mistakes)) return std::nullopt;
  const auto parts = parts_between_dashes(text, 2);
  if (parts.size() != 2) {
    mistakes.push_back({std::string(file), 0, "a service needs a line --- between request and response"});
    return std::nullopt;
  }
  auto request = read_part(name, "_Request", parts[0], file, mistakes);
  auto response = read_part(name, "_Response", parts[1], file, mistakes);
  if (!request || !response) return std::nullopt;
  return Service{std::move(*request), std::move(*response)};
}

std::optional<Action> parse_action(std::string_view name, std::string_view text, std::string_view file,
                                   std::vector<Mistake>& mistakes) {
  if (!is_text(text, file, mistakes)) return std::nullopt;
  const auto parts = parts_between_dashes(text, 3);
  if (parts.size() != 3) {
    mistakes.push_back(
        {std::string(file), 0, "an action needs two lines ---: behind the goal, and behind the result"});
    return std::nullopt;
  }
  auto goal = read_part(name, "_Goal", parts[0], file, mistakes);
  auto result = read_part(name, "_Result", parts[1], file, mistakes);
  auto feedback = read_part(name, "_Feedback", parts[2], file, mistakes);
  if (!goal || !result || !feedback) return std::nullopt;
  return Action{std::move(*goal), std::move(*result), std::move(*feedback)};
}

}  // namespace tessera::ros2
