#include "language/names/sources.hpp"

#include <algorithm>
#include <set>
#include <string>

namespace tessera::language {
namespace {

/// Follows namespaces and braces through one source.
class CodeReader {
 public:
  CodeReader(const Index& index, std::string_view source)
      : index_(index), source_(source), tokens_(tokens_of(source)) {}

  std::vector<CodeUse> read() {
    for (at_ = 0; at_ < tokens_.size(); ++at_) {
      const std::string_view text = tokens_[at_].text;
      if (text == "namespace" && !is(at_ - 1, "using")) {
        enter_namespace();
      } else if (text == "{") {
        ++depth_;
      } else if (text == "}") {
        leave();
      } else if (tokens_[at_].kind == Token::Kind::name) {
        name();
      }
    }
    end_run();
    includes();
    members_of_others();
    return std::move(found_);
  }

 private:
  struct Scope {
    std::size_t depth = 0;  ///< of the braces inside
    std::size_t names = 0;  ///< how many this namespace added
  };

  [[nodiscard]] bool is(std::size_t at, std::string_view text) const {
    return at < tokens_.size() && tokens_[at].text == text;
  }
  [[nodiscard]] bool follows_access() const { return is(at_ - 1, ".") || is(at_ - 1, "->"); }

  void add(Extent extent, SymbolId symbol, bool defines = false, bool enumeration = false) {
    if (symbol.valid() && known_.insert(extent.begin).second)
      found_.push_back({extent, symbol, defines, true, enumeration});
  }

  void enter_namespace() {
    std::vector<std::size_t> parts;
    std::size_t next = at_ + 1;
    while (next < tokens_.size() && tokens_[next].kind == Token::Kind::name) {
      parts.push_back(next++);
      if (!is(next, "::")) break;
      ++next;
    }
    if (!is(next, "{")) return;  // an alias
    ++depth_;
    for (const std::size_t part : parts) {
      spaces_.push_back(tokens_[part].text);
      name_of_space(tokens_[part].extent, spaces_);
    }
    scopes_.push_back({depth_, parts.size()});
    at_ = next;
    change_unit();
  }

  void leave() {
    if (!scopes_.empty() && scopes_.back().depth == depth_) {
      spaces_.resize(spaces_.size() - scopes_.back().names);
      scopes_.pop_back();
      change_unit();
    }
    if (depth_ > 0) --depth_;
  }

  const DefinitionNames* definition(std::string_view name) const {
    const auto& all = index_.definitions();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
    return found == all.end() ? nullptr : &*found;
  }
  static const UnitNames* unit(const DefinitionNames* definition, std::string_view name) {
    if (definition == nullptr) return nullptr;
    const auto found = std::find_if(definition->units.begin(), definition->units.end(),
                                    [&](const UnitNames& one) { return one.name == name; });
    return found == definition->units.end() ? nullptr : &*found;
  }

  /// SYSTEM::DEFINITION::SUBSYSTEM: what the last of these names is.
  void name_of_space(Extent extent, const std::vector<std::string_view>& spaces) {
    if (spaces.size() < 2 || spaces[0] != index_.system()) return;
    const DefinitionNames* owner = definition(spaces[1]);
    if (owner == nullptr) return;
    if (spaces.size() == 2) add(extent, owner->symbol);
    if (const UnitNames* inside = spaces.size() == 3 ? unit(owner, spaces[2]) : nullptr)
      add(extent, inside->symbol);
  }

  void change_unit() {
    end_run();
    unit_ = spaces_.size() >= 3 && spaces_[0] == index_.system() ? unit(definition(spaces_[1]), spaces_[2])
                                                                 : nullptr;
    run_begin_ = at_ + 1;
  }

  /// The members in the code of a unit, from the last change of namespace to here.
  void end_run() {
    if (unit_ != nullptr && at_ > run_begin_) {
      const auto first = tokens_.begin() + static_cast<std::ptrdiff_t>(run_begin_);
      const auto last = tokens_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, tokens_.size()));
      resolve_members(index_, *unit_, {first, last},
                      [this](Extent extent, SymbolId symbol) { add(extent, symbol); });
    }
  }

  void name() {
    if (follows_access()) return;
    const Token& token = tokens_[at_];
    if (is(at_ - 1, "::")) {
      qualified();
      return;
    }
    if (const auto type = index_.types().find(token.text);
        type != index_.types().end() && !spaces_.empty() && spaces_[0] == index_.system())
      add(token.extent, type->second);
    if (unit_ != nullptr && token.text == "Memory") in_memory(*unit_);
    if (unit_ == nullptr || !is(at_ + 1, "(")) return;
    const auto behaviour = unit_->functions.find(token.text);
    if (behaviour == unit_->functions.end()) return;
    const bool declared = is(at_ - 1, "void");
    if (declared && !is(at_ + 2, "Context")) return;
    const bool other_type = at_ > 0 && tokens_[at_ - 1].kind == Token::Kind::name && !declared &&
                            tokens_[at_ - 1].text != "return" && tokens_[at_ - 1].text != "else";
    if (other_type) return;
    add_function(token.extent, behaviour->second, declared && has_body());
  }

  /// "charge_ask": the groups around the behaviour, then the behaviour itself.
  void add_function(Extent extent, const std::vector<SymbolId>& path, bool defines) {
    std::size_t begin = extent.begin;
    for (const SymbolId part : path) {
      const std::size_t end = begin + index_[part].name.size();
      add({begin, end}, part, defines && part == path.back());
      begin = end + 1;
    }
  }

  /// Whether the parameters from here on are followed by a body.
  [[nodiscard]] bool has_body() const {
    int open = 0;
    for (std::size_t at = at_ + 1; at < tokens_.size(); ++at) {
      if (tokens_[at].text == "(") ++open;
      if (tokens_[at].text == ")" && --open == 0) return is(at + 1, "{") || is(at + 1, "try");
    }
    return false;
  }

  /// SYSTEM::Type, SYSTEM::DEFINITION::SUBSYSTEM::behaviour.
  void qualified() {
    std::size_t first = at_;
    while (first >= 2 && is(first - 1, "::") && tokens_[first - 2].kind == Token::Kind::name) first -= 2;
    std::vector<std::string_view> path;
    for (std::size_t part = first; part <= at_; part += 2) path.push_back(tokens_[part].text);
    if (path.front() != index_.system()) return;
    const Token& token = tokens_[at_];
    if (path.size() == 2)
      if (const auto type = index_.types().find(token.text); type != index_.types().end())
        return add(token.extent, type->second);
    name_of_space(token.extent, path);
    const UnitNames* inside = path.size() == 4 ? unit(definition(path[1]), path[2]) : nullptr;
    if (inside == nullptr) return;
    if (token.text == "Memory") in_memory(*inside);
    if (const auto behaviour = inside->functions.find(token.text); behaviour != inside->functions.end())
      add_function(token.extent, behaviour->second, false);
  }

  /// Memory::LentTo::nobody, from `Memory` on.
  void in_memory(const UnitNames& unit) {
    if (!is(at_ + 1, "::") || at_ + 2 >= tokens_.size()) return;
    for (const auto& [cell, values] : unit.values) {
      const SymbolId symbol = unit.memory.find(cell)->second;
      if (index_.enumeration_of(symbol) != tokens_[at_ + 2].text) continue;
      add(tokens_[at_ + 2].extent, symbol, false, true);
      if (!is(at_ + 3, "::") || at_ + 4 >= tokens_.size()) return;
      if (const auto value = values.find(tokens_[at_ + 4].text); value != values.end())
        add(tokens_[at_ + 4].extent, value->second);
    }
  }

  /// #include "robot/control.hpp"
  void includes() {
    constexpr std::string_view word = "#include \"";
    for (std::size_t at = source_.find(word); at != std::string_view::npos; at = source_.find(word, at + 1)) {
      const std::size_t begin = at + word.size();
      const std::size_t end = source_.find_first_of("\"\n", begin);
      if (end == std::string_view::npos) return;
      const std::string_view file = source_.substr(begin, end - begin);
      const std::size_t slash = file.find('/');
      if (slash == std::string_view::npos || !file.ends_with(".hpp")) continue;
      const DefinitionNames* owner = definition(file.substr(0, slash));
      const UnitNames* inside = unit(owner, file.substr(slash + 1, file.size() - slash - 5));
      if (inside == nullptr) continue;
      add({begin, begin + slash}, owner->symbol);
      add({begin + slash + 1, end - 4}, inside->symbol);
    }
  }

  /// LentTo::nobody, where only a compiler knows whose LentTo it is.
  void value_of_others(std::size_t at) {
    if (at < 2 || !is(at - 1, "::") || tokens_[at - 2].kind != Token::Kind::name) return;
    for (const DefinitionNames& definition : index_.definitions())
      for (const UnitNames& unit : definition.units)
        for (const auto& [cell, values] : unit.values) {
          const SymbolId symbol = unit.memory.find(cell)->second;
          const auto value = values.find(tokens_[at].text);
          if (value == values.end() || index_.enumeration_of(symbol) != tokens_[at - 2].text) continue;
          found_.push_back({tokens_[at].extent, value->second, false, false});
          if (!known_.contains(tokens_[at - 2].extent.begin))
            found_.push_back({tokens_[at - 2].extent, symbol, false, false, true});
        }
  }

  /// `.left` of something that only a compiler knows. Only where the system is used at all.
  void members_of_others() {
    if (std::none_of(tokens_.begin(), tokens_.end(),
                     [this](const Token& one) { return one.text == index_.system(); }))
      return;
    for (std::size_t at = 1; at < tokens_.size(); ++at) {
      if (tokens_[at].kind != Token::Kind::name || known_.contains(tokens_[at].extent.begin)) continue;
      value_of_others(at);
      if (!is(at - 1, ".") && !is(at - 1, "->")) continue;
      for (const auto& [name, type] : index_.types()) {
        const NamesOf* fields = index_.fields_of(name);
        if (fields == nullptr) continue;
        if (const auto field = fields->find(tokens_[at].text); field != fields->end())
          found_.push_back({tokens_[at].extent, field->second, false, false});
      }
    }
  }

  const Index& index_;
  std::string_view source_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::size_t depth_ = 0;
  std::size_t run_begin_ = 0;
  std::vector<std::string_view> spaces_;
  std::vector<Scope> scopes_;
  const UnitNames* unit_ = nullptr;
  std::vector<CodeUse> found_;
  std::set<std::size_t> known_;  ///< where sure uses begin
};

}  // namespace

std::vector<CodeUse> uses_in_code(const Index& index, std::string_view source) {
  return CodeReader(index, source).read();
}

namespace {

/// The uses in the keys of the map that a text is. `read` looks at the words of a key, and adds what they name.
template <class Read>
std::vector<CodeUse> uses_in_keys(std::string_view text, const Read& read) {
  std::vector<CodeUse> found;
  const Outline outline(text);
  for (const Entry& entry : outline.root().entries) {
    if (entry.extent.end - entry.extent.begin != entry.key.size()) continue;
    const auto add = [&](const PathWord& word, SymbolId symbol) {
      found.push_back({{entry.extent.begin + word.extent.begin, entry.extent.begin + word.extent.end},
                       symbol,
                       false,
                       true});
    };
    for (const DottedPath& path : paths_in(entry.key)) read(path.words, add);
  }
  return found;
}

/// The words "robot.motor" at the beginning of a path. nullptr: the second names no subsystem, or is missing.
template <class Add>
const UnitNames* subsystem_at(const Index& index, const std::vector<PathWord>& words, const Add& add) {
  const auto agent = index.agents().find(words[0].name);
  if (agent == index.agents().end()) return nullptr;
  add(words[0], agent->second);
  const DefinitionNames* definition = index.definition_of(words[0].name);
  if (definition == nullptr || words.size() < 2) return nullptr;
  for (const UnitNames& unit : definition->units) {
    if (unit.name != words[1].name) continue;
    add(words[1], unit.symbol);
    return &unit;
  }
  return nullptr;
}

}  // namespace

std::vector<CodeUse> uses_in_parameter_file(const Index& index, std::string_view text) {
  return uses_in_keys(text, [&](const std::vector<PathWord>& words, const auto& add) {
    const auto system = index.parameters().find(words.back().name);
    if (words.size() == 1 && system != index.parameters().end()) add(words[0], system->second);
    if (words.size() < 3) return;
    const UnitNames* unit = subsystem_at(index, words, add);
    if (unit == nullptr) return;
    if (const auto own = unit->parameters.find(words[2].name); own != unit->parameters.end())
      add(words[2], own->second);
  });
}

std::vector<CodeUse> uses_in_layout_file(const Index& index, std::string_view text) {
  return uses_in_keys(text, [&](const std::vector<PathWord>& words, const auto& add) {
    if (words.size() <= 2) (void)subsystem_at(index, words, add);
  });
}

}  // namespace tessera::language
