#include "specification_mutator.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Names, paths and numbers: "in", "left", "float64", "0.5".
std::vector<std::pair<std::size_t, std::size_t>> words_of(const std::string& text, bool numbers) {
  std::vector<std::pair<std::size_t, std::size_t>> words;
  bool comment = false;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '\n') comment = false;
    if (text[at] == '#') comment = true;
    if (comment || !is_word(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && is_word(text[end])) ++end;
    const bool number = std::isdigit(static_cast<unsigned char>(text[at])) != 0;
    if (number == numbers) words.emplace_back(at, end);
    at = end;
  }
  return words;
}

std::size_t line_end(const std::string& text, std::size_t at) {
  const std::size_t end = text.find('\n', at);
  return end == std::string::npos ? text.size() : end + 1;
}

std::size_t indent_at(const std::string& text, std::size_t line) {
  std::size_t at = line;
  while (at < text.size() && text[at] == ' ') ++at;
  return at - line;
}

/// The end of the lines that belong to the one that begins here: those that are indented further.
std::size_t block_end(const std::string& text, std::size_t line) {
  const std::size_t indent = indent_at(text, line);
  std::size_t at = line_end(text, line);
  while (at < text.size() && (text[at] == '\n' || indent_at(text, at) > indent)) at = line_end(text, at);
  return at;
}

std::vector<std::size_t> line_starts(const std::string& text) {
  std::vector<std::size_t> starts;
  for (std::size_t at = 0; at < text.size(); at = line_end(text, at)) starts.push_back(at);
  return starts;
}

/// The end of a value on one line: a comma or a bracket that closes what began before, or the end of the line.
std::size_t inline_end(const std::string& text, std::size_t at) {
  int depth = 0;
  for (char quote = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
      continue;
    }
    if (c == '"' || c == '\'') quote = c;
    if (c == '{' || c == '[' || c == '(') ++depth;
    if (c == '}' || c == ']' || c == ')') --depth;
    if (depth < 0 || (depth == 0 && (c == ',' || c == '\n'))) return at;
  }
  return at;
}

template <class Pairs>
void collect_pairs(const std::string& text, Pairs& pairs) {
  for (const auto& [begin, end] : words_of(text, false)) {
    if (end + 1 >= text.size() || text[end] != ':' || (text[end + 1] != ' ' && text[end + 1] != '\n'))
      continue;
    std::size_t value = end + 1;
    while (value < text.size() && text[value] == ' ') ++value;
    std::size_t stop = 0;
    if (value < text.size() && text[value] == '\n') {
      const std::size_t line = text.rfind('\n', begin) + 1;
      stop = block_end(text, line);
      if (stop > value) --stop;  // the line break of the last line stays
    } else {
      stop = inline_end(text, value);
    }
    pairs.push_back({text.substr(begin, end - begin), {begin, stop}, {value, stop}});
  }
}

constexpr std::array numbers = std::to_array<const char*>({"0",          "1",
                                                           "-1",         "2",
                                                           "3",          "7",
                                                           "0.5",        "-0.0",
                                                           "1e9",        "1e-9",
                                                           "1e308",      "1e999",
                                                           ".nan",       ".inf",
                                                           "255",        "256",
                                                           "257",        "999",
                                                           "2147483648", "4294967295",
                                                           "4294967296", "18446744073709551616",
                                                           "0x10",       "1_000",
                                                           "00"});
constexpr std::array texts = std::to_array<const char*>({"",
                                                         "5 ms",
                                                         "20 Hz",
                                                         "1 h",
                                                         "90 deg",
                                                         "0.1 m",
                                                         "0 s",
                                                         "-1 s",
                                                         "1e30 s",
                                                         "in.a.b > 0",
                                                         "elapsed > 5 s",
                                                         "true",
                                                         "false",
                                                         "~",
                                                         "{}",
                                                         "[]",
                                                         "[[], {}]",
                                                         "memory.x == 1 && out.y",
                                                         "a => b",
                                                         "std_msgs/Float64",
                                                         "/cmd_vel",
                                                         "/r{i}/x",
                                                         "robot[*].body.x",
                                                         "robot[i+1].control.x",
                                                         "a[*].b.c -> d[i].e.f",
                                                         "contact(a, b)",
                                                         "float64[3] m/s",
                                                         "string<=8",
                                                         "*x",
                                                         "&x 1",
                                                         "!!int 3",
                                                         "'",
                                                         "\"a: b\"",
                                                         "|",
                                                         "{{i}}",
                                                         "\"\\u0000\"",
                                                         "\"\xc3\xa4\"",
                                                         "a.b",
                                                         "a.b.c",
                                                         "a.b.c.d",
                                                         "never: x",
                                                         "end",
                                                         "error",
                                                         "control",
                                                         "index",
                                                         "3",
                                                         "clamp",
                                                         "fault"});
constexpr std::array type_words = std::to_array<const char*>(
    {"bool", "int8", "int64", "uint8", "uint64", "float32", "float64", "string", "string<=3", "Typo",
     "float64[3]", "float64 m/s", "Typo[4]", "bool m", "string[2]", "float64[0]", "float64[99999999]",
     "float64<=3", "{ x: float64 }"});

}  // namespace

SpecificationMutator::SpecificationMutator(const std::string& schema) : schema_(json::parse(schema)) {
  collect_keys(schema_);
}

void SpecificationMutator::collect_keys(const json& schema) {
  if (schema.is_object()) {
    if (const auto found = schema.find("properties"); found != schema.end() && found->is_object()) {
      std::vector<std::string> keys;
      for (const auto& [key, value] : found->items())
        if (value.is_object()) keys.push_back(key);
      for (const std::string& key : keys) {
        values_[key].push_back(&(*found)[key]);
        siblings_[key].insert(siblings_[key].end(), keys.begin(), keys.end());
      }
    }
  }
  if (schema.is_structured())
    for (const json& part : schema) collect_keys(part);
}

std::size_t SpecificationMutator::below(std::size_t count) { return count == 0 ? 0 : random_() % count; }

std::string SpecificationMutator::mutated(std::string text, std::uint32_t seed) {
  random_.seed(seed);
  names_.clear();
  for (const auto& [begin, end] : words_of(text, false)) names_.push_back(text.substr(begin, end - begin));
  if (names_.empty()) names_.emplace_back("a");
  for (std::size_t left = 1 + below(4); left > 0; --left) change(text);
  return text;
}

void SpecificationMutator::change(std::string& text) {
  switch (below(16)) {
    case 0:
    case 1:
    case 2:
      return cross_names(text);
    case 3:
    case 4:
    case 5:
      return misspell(text);
    case 6:
      return change_number(text);
    case 7:
      return change_type(text);
    case 8:
    case 9:
      return cross_values(text);
    case 10:
    case 11:
      return generate_value(text);
    case 12:
    case 13:
      return generate_sibling(text);
    case 14:
      return generate_section(text);
    default:
      return move_lines(text);
  }
}

void SpecificationMutator::cross_names(std::string& text) {
  const auto words = words_of(text, false);
  if (words.empty()) return;
  const auto [begin, end] = one_of(words);
  text.replace(begin, end - begin, one_of(names_));
}

void SpecificationMutator::misspell(std::string& text) {
  const auto words = words_of(text, false);
  if (words.empty()) return;
  const auto [begin, end] = one_of(words);
  const std::size_t at = begin + below(end - begin);
  switch (below(4)) {
    case 0:
      text.erase(at, 1);
      break;
    case 1:
      text.insert(at, 1, text[at]);
      break;
    case 2:
      text[at] = static_cast<char>('a' + below(26));
      break;
    default:
      text.insert(end, "_2");
  }
}

void SpecificationMutator::change_number(std::string& text) {
  const auto words = words_of(text, true);
  if (words.empty()) return;
  const auto [begin, end] = one_of(words);
  text.replace(begin, end - begin, one_of(numbers));
}

/// Types stand where a built-in one stands, or a name that begins with a capital letter.
void SpecificationMutator::change_type(std::string& text) {
  std::vector<std::pair<std::size_t, std::size_t>> types;
  for (const auto& [begin, end] : words_of(text, false)) {
    const std::string word = text.substr(begin, end - begin);
    const bool built_in = word == "bool" || word == "string" || word.starts_with("int") ||
                          word.starts_with("uint") || word.starts_with("float");
    if (built_in || (word.front() >= 'A' && word.front() <= 'Z')) types.emplace_back(begin, end);
  }
  if (types.empty()) return;
  const auto [begin, end] = one_of(types);
  const auto [other, stop] = one_of(types);
  const std::string taken =
      below(3) == 0 ? text.substr(other, stop - other) : std::string(one_of(type_words));
  text.replace(begin, end - begin, taken);
}

void SpecificationMutator::cross_values(std::string& text) {
  std::vector<Pair> pairs;
  collect_pairs(text, pairs);
  if (pairs.empty()) return;
  const Pair& to = one_of(pairs);
  const Pair& from = one_of(pairs);
  std::string value = text.substr(from.value.begin, from.value.end - from.value.begin);
  if (below(4) == 0) value = one_of(texts);
  if (below(8) == 0) value = "[" + value + ", " + value + "]";
  if (value.size() < 2000) text.replace(to.value.begin, to.value.end - to.value.begin, value);
}

void SpecificationMutator::generate_value(std::string& text) {
  std::vector<Pair> pairs;
  collect_pairs(text, pairs);
  std::erase_if(pairs, [&](const Pair& one) { return !values_.contains(one.key); });
  if (pairs.empty()) return;
  const Pair& pair = one_of(pairs);
  const std::string value = generated(*one_of(values_[pair.key]), 0);
  text.replace(pair.value.begin, pair.value.end - pair.value.begin, value);
}

void SpecificationMutator::generate_sibling(std::string& text) {
  std::vector<Pair> pairs;
  collect_pairs(text, pairs);
  std::erase_if(pairs, [&](const Pair& one) { return !siblings_.contains(one.key); });
  if (pairs.empty()) return;
  const Pair& pair = one_of(pairs);
  const std::string key = one_of(siblings_[pair.key]);
  const std::string made = key + ": " + generated(*one_of(values_[key]), 0);
  const std::size_t line = text.rfind('\n', pair.whole.begin) + 1;  // npos + 1 is 0
  const std::size_t indent = indent_at(text, line);
  if (line + indent == pair.whole.begin)
    text.insert(pair.whole.begin, made + "\n" + std::string(indent, ' '));
  else
    text.insert(pair.whole.begin, made + ", ");
}

void SpecificationMutator::generate_section(std::string& text) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : schema_["properties"].items()) keys.push_back(key);
  const std::string key = one_of(keys);
  std::vector<Pair> pairs;
  collect_pairs(text, pairs);
  const std::string value = generated(schema_["properties"][key], 0);
  const auto found = std::find_if(pairs.begin(), pairs.end(), [&](const Pair& one) {
    return one.key == key && (one.whole.begin == 0 || text[one.whole.begin - 1] == '\n');
  });
  if (found != pairs.end())
    text.replace(found->value.begin, found->value.end - found->value.begin, value);
  else
    text += "\n" + key + ": " + value + "\n";
}

void SpecificationMutator::move_lines(std::string& text) {
  const std::vector<std::size_t> starts = line_starts(text);
  if (starts.empty()) return;
  const std::size_t begin = one_of(starts);
  const std::size_t to = one_of(starts);
  const std::size_t indent = indent_at(text, begin), wanted = indent_at(text, to);
  std::string block = text.substr(begin, block_end(text, begin) - begin);
  const std::size_t what = below(3);
  std::string moved;  // the block with the indentation of its new place
  for (std::size_t at = 0; at < block.size(); at = line_end(block, at)) {
    const std::size_t own = std::min(indent_at(block, at), line_end(block, at) - at);
    moved += std::string(wanted + (own > indent ? own - indent : 0), ' ');
    moved += block.substr(at + own, line_end(block, at) - at - own);
  }
  if (what == 0) {
    text.erase(begin, block.size());
  } else if (to <= begin || to >= begin + block.size()) {
    if (what == 1 && to < begin) text.erase(begin, block.size());
    text.insert(to, moved);
  }
}

std::string SpecificationMutator::some_name() {
  std::string name = one_of(names_);
  for (std::size_t more = below(4); more > 1; --more) name += "." + one_of(names_);
  if (below(12) == 0) name += "x";
  return name;
}

std::string SpecificationMutator::generated(const json& schema, unsigned depth) {
  if (!schema.is_object() || depth > 6) return some_name();
  if (below(30) == 0) return one_of(texts);
  if (const auto found = schema.find("$ref"); found != schema.end()) {
    const std::string name = found->get<std::string>();
    return generated(schema_["$defs"][name.substr(name.rfind('/') + 1)], depth + 1);
  }
  for (const char* choice : {"anyOf", "oneOf"})
    if (const auto found = schema.find(choice); found != schema.end() && !schema.contains("properties"))
      return generated(one_of(*found), depth + 1);
  if (const auto found = schema.find("enum"); found != schema.end()) return one_of(*found).dump();
  if (const auto found = schema.find("const"); found != schema.end()) return found->dump();
  const json type = schema.value("type", json("string"));
  const std::string kind = type.is_array() ? one_of(type).get<std::string>() : type.get<std::string>();
  if (kind == "object") return generated_map(schema, depth);
  if (kind == "array") {
    std::string list;
    const json& items = schema.contains("items") ? schema["items"] : schema_["$defs"]["value"];
    std::size_t count = std::max<std::size_t>(schema.value("minItems", 0U), below(4));
    for (; count > 0; --count) list += (list.empty() ? "" : ", ") + generated(items, depth + 1);
    return "[" + list + "]";
  }
  if (kind == "integer" || kind == "number") return one_of(numbers);
  if (kind == "boolean") return below(2) == 0 ? "true" : "false";
  return generated_text(schema);
}

std::string SpecificationMutator::generated_map(const json& schema, unsigned depth) {
  std::string map;
  const auto add = [&](const std::string& key, const std::string& value) {
    map += (map.empty() ? "" : ", ") + key + ": " + value;
  };
  if (const auto found = schema.find("properties"); found != schema.end())
    for (const auto& [key, value] : found->items()) {
      bool required = false;
      if (const auto all = schema.find("required"); all != schema.end())
        required = std::find(all->begin(), all->end(), key) != all->end();
      if (required ? below(20) != 0 : below(depth + 2) == 0) add(key, generated(value, depth + 1));
    }
  const auto others = schema.find("additionalProperties");
  if (others != schema.end() && others->is_object())
    for (std::size_t count = 1 + below(3); count > 0; --count)
      add(some_name(), generated(*others, depth + 1));
  return "{ " + map + " }";
}

std::string SpecificationMutator::generated_text(const json& schema) {
  if (const auto found = schema.find("examples"); found != schema.end() && below(2) == 0)
    return one_of(*found).dump();
  switch (below(4)) {
    case 0:
      return one_of(texts);
    case 1:
      return one_of(type_words);
    default:
      return some_name();
  }
}
