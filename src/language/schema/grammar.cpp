#include "language/schema/grammar.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace tessera::language {

using nlohmann::json;

struct Grammar::Schema {
  json root;

  /// A schema and all that it refers to or combines.
  void expand(const json& node, std::vector<const json*>& all, int depth = 0) const {
    if (!node.is_object() || depth > 8 || std::find(all.begin(), all.end(), &node) != all.end()) return;
    all.push_back(&node);
    if (const auto ref = node.find("$ref"); ref != node.end() && ref->is_string()) {
      const auto name = ref->get<std::string>();
      constexpr std::string_view prefix = "#/$defs/";
      if (name.starts_with(prefix) && root.contains("$defs")) {
        const auto found = root["$defs"].find(name.substr(prefix.size()));
        if (found != root["$defs"].end()) expand(*found, all, depth + 1);
      }
    }
    for (const char* word : {"anyOf", "oneOf", "allOf"})
      if (const auto parts = node.find(word); parts != node.end() && parts->is_array())
        for (const json& part : *parts) expand(part, all, depth + 1);
    for (const char* word : {"then", "else"})
      if (const auto part = node.find(word); part != node.end()) expand(*part, all, depth + 1);
  }

  [[nodiscard]] std::vector<const json*> at(const Way& way) const {
    std::vector<const json*> here;
    expand(root, here);
    for (const std::string& step : way) {
      std::vector<const json*> next;
      for (const json* node : here) {
        if (step.empty()) {
          if (const auto items = node->find("items"); items != node->end()) expand(*items, next);
          continue;
        }
        const auto properties = node->find("properties");
        if (properties != node->end() && properties->contains(step)) {
          expand((*properties)[step], next);
        } else if (const auto more = node->find("additionalProperties"); more != node->end()) {
          expand(*more, next);
        }
      }
      here = std::move(next);
    }
    return here;
  }

  [[nodiscard]] std::string description_of(const json& node) const {
    std::vector<const json*> all;
    expand(node, all);
    for (const json* one : all)
      if (const auto text = one->find("description"); text != one->end() && text->is_string()) return *text;
    return {};
  }

  [[nodiscard]] bool holds_lines(const json& node) const {
    std::vector<const json*> all;
    expand(node, all);
    return std::any_of(all.begin(), all.end(), [](const json* one) {
      const auto type = one->find("type");
      if (type == one->end()) return false;
      const auto is = [&](const char* word) {
        return *type == word ||
               (type->is_array() && std::find(type->begin(), type->end(), word) != type->end());
      };
      return is("object") && !one->contains("enum");
    });
  }
};

namespace {

void add_words(const json& words, std::vector<std::string>& all) {
  for (const json& word : words) {
    std::string text = word.is_string() ? word.get<std::string>() : word.dump();
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(std::move(text));
  }
}

}  // namespace

Grammar::Grammar(const std::string& schema) : schema_(std::make_unique<Schema>()) {
  try {
    schema_->root = json::parse(schema);
  } catch (const json::exception& error) {
    throw std::runtime_error(std::string("the schema of the specification cannot be read: ") + error.what());
  }
}

Grammar::~Grammar() = default;

std::vector<Grammar::Key> Grammar::keys(const Way& way) const {
  std::vector<Key> all;
  for (const json* node : schema_->at(way)) {
    const auto properties = node->find("properties");
    if (properties == node->end() || !properties->is_object()) continue;
    std::set<std::string> needed;
    if (const auto names = node->find("required"); names != node->end())
      for (const json& name : *names) needed.insert(name.get<std::string>());
    for (const auto& property : properties->items()) {
      const std::string& name = property.key();
      const json& value = property.value();
      if (!value.is_object()) continue;
      const bool known =
          std::any_of(all.begin(), all.end(), [&](const Key& key) { return key.name == name; });
      if (!known)
        all.push_back(
            {name, schema_->description_of(value), needed.contains(name), schema_->holds_lines(value)});
    }
  }
  return all;
}

std::vector<std::string> Grammar::values(const Way& way) const {
  std::vector<std::string> all;
  for (const json* node : schema_->at(way)) {
    if (const auto words = node->find("enum"); words != node->end()) add_words(*words, all);
    if (const auto word = node->find("const"); word != node->end()) add_words(json::array({*word}), all);
    const auto type = node->find("type");
    if (type != node->end() &&
        (*type == "boolean" || (type->is_array() && type->dump().find("boolean") != std::string::npos)))
      add_words({"true", "false"}, all);
  }
  return all;
}

std::vector<std::string> Grammar::examples(const Way& way) const {
  std::vector<std::string> all;
  for (const json* node : schema_->at(way))
    if (const auto words = node->find("examples"); words != node->end()) add_words(*words, all);
  return all;
}

std::string Grammar::description(const Way& way) const {
  for (const json* node : schema_->at(way))
    if (const auto text = node->find("description"); text != node->end() && text->is_string()) return *text;
  return {};
}

}  // namespace tessera::language
