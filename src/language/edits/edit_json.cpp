#include "language/edits/edit_json.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

namespace tessera::language {
namespace {

using Json = nlohmann::ordered_json;  // keys of a new entry stay in their order

/// Deeper ones are no values of a specification.
constexpr int deepest_value = 16;
constexpr std::size_t longest_path = 64;

/// The words of Edit::Kind and of Writing, in their order.
constexpr std::array<std::string_view, 13> kinds{"set",    "insert",  "append",  "replace", "remove",
                                                 "rename", "connect", "channel", "next",    "make_template",
                                                 "move",   "copy",    "paste"};
constexpr std::array<std::string_view, 4> writings{"scalar", "list", "quoted", "as_is"};

template <class Word, std::size_t count>
bool read_word(const Json& edit, const char* key, const std::array<std::string_view, count>& words,
               Word& into) {
  const auto found = edit.find(key);
  if (found == edit.end()) return true;
  if (!found->is_string()) return false;
  for (std::size_t at = 0; at < count; ++at)
    if (words[at] == found->get_ref<const std::string&>()) {
      into = static_cast<Word>(at);
      return true;
    }
  return false;
}

bool read_text(const Json& edit, const char* key, std::string& into) {
  const auto found = edit.find(key);
  if (found == edit.end()) return true;
  if (!found->is_string()) return false;
  into = found->get<std::string>();
  return true;
}

bool read_path(const Json& edit, Path& into) {
  const auto found = edit.find("at");
  if (found == edit.end()) return true;
  if (!found->is_array() || found->size() > longest_path) return false;
  for (const Json& step : *found) {
    if (step.is_string())
      into.emplace_back(step.get<std::string>());
    else if (step.is_number_unsigned())
      into.emplace_back(step.get<std::size_t>());
    else
      return false;
  }
  return true;
}

bool read_value(const Json& given, Value& into, int depth = 0) {
  if (depth > deepest_value) return false;
  if (given.is_string()) {
    into = Value::scalar(scalar_text(given.get_ref<const std::string&>()));
    return true;
  }
  if (!given.is_array() && !given.is_object()) return false;
  into.kind = given.is_array() ? Value::Kind::list : Value::Kind::map;
  for (const auto& [key, one] : given.items()) {
    if (given.is_object()) into.keys.push_back(scalar_text(key));
    if (!read_value(one, into.items.emplace_back(), depth + 1)) return false;
  }
  return true;
}

bool read_fields(const Json& edit, std::map<std::string, std::string>& into) {
  const auto found = edit.find("fields");
  if (found == edit.end()) return true;
  if (!found->is_object()) return false;
  for (const auto& [key, value] : found->items()) {
    if (!value.is_string()) return false;
    into[key] = value.get<std::string>();
  }
  return true;
}

std::optional<Edit> edit_of(const Json& given) {
  Edit edit;
  if (!given.is_object() || !given.contains("do")) return std::nullopt;
  const bool read = read_word(given, "do", kinds, edit.kind) && read_word(given, "as", writings, edit.as) &&
                    read_path(given, edit.at) && read_text(given, "key", edit.key) &&
                    read_text(given, "text", edit.text) && read_fields(given, edit.fields) &&
                    (!given.contains("value") || read_value(given.at("value"), edit.value));
  return read ? std::optional(std::move(edit)) : std::nullopt;
}

}  // namespace

std::optional<std::vector<Edit>> edits_of(const Json& given) {
  std::vector<Edit> all;
  const Json list = given.is_array() ? given : Json::array({given});
  if (list.empty() || list.size() > 100) return std::nullopt;
  for (const Json& one : list) {
    std::optional<Edit> edit = edit_of(one);
    if (!edit) return std::nullopt;
    all.push_back(std::move(*edit));
  }
  return all;
}

}  // namespace tessera::language
