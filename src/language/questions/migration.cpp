#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "language/language.hpp"
#include "language/questions/place.hpp"
#include "spec/model/former_routes.hpp"
#include "spec/parser.hpp"

namespace tessera::language {
namespace {

using spec::Behaviour;
using spec::FormerRoute;

/// Writes the entries of `next` for one text.
class Migrator {
 public:
  explicit Migrator(const Document& document) : document_(document), text_(document.text()) {}

  std::optional<Migration> migrated(std::optional<diagnostics::Span> only) {
    diagnostics::Diagnostics out("spec.yaml", text_);
    const std::optional<spec::Model> model = spec::parse(out);
    if (!model || out.has_errors()) return std::nullopt;
    for (const spec::Definition& definition : model->definitions)
      for (const spec::Subsystem& subsystem : definition.subsystems)
        for (const Behaviour& behaviour : subsystem.behaviours)
          if (const auto route = former_route(subsystem, behaviour))
            add(definition.name + "." + subsystem.name, subsystem, behaviour, *route);
    if (only) keep(*model, *only);
    drop_wrong();
    return std::move(found_);
  }

 private:
  void by_hand(const std::string& path, const Behaviour& behaviour, std::string why) {
    found_.by_hand.push_back({path + "." + behaviour.name, behaviour.span, std::move(why)});
  }

  void add(const std::string& path, const spec::Subsystem& subsystem, const Behaviour& behaviour,
           const FormerRoute& route) {
    if (!route.certain) return by_hand(path, behaviour, "a condition of 'next' decided where a failure led");
    const std::string to = route.to.valid() ? subsystem.behaviours[route.to].name : "end";
    const Node* body = body_of(behaviour);
    const Entry* entry = body == nullptr ? nullptr : body->find("next");
    std::optional<TextEdit> edit;
    if (entry != nullptr) edit = edit_of(*entry, route, fmt::format("{{ to: {}, when: error }}", to));
    if (!edit)
      return by_hand(path, behaviour, fmt::format("add {{ to: {}, when: error }} to its 'next'", to));
    const bool known = std::ranges::any_of(
        found_.steps, [&](const Migration::Step& step) { return step.edit.range == edit->range; });
    if (!known)  // by an alias, a text may belong to several behaviours
      found_.steps.push_back({path + "." + behaviour.name, behaviour.span, to, std::move(*edit)});
  }

  const Node* body_of(const Behaviour& behaviour) const {
    const Position at = range_of(document_, behaviour.span).start;
    for (const Symbol& symbol : document_.index().symbols())
      if (symbol.kind == Kind::behaviour && document_.lines().position(symbol.definition.begin) == at)
        return &node_at(document_.outline(), symbol.way);
    return nullptr;
  }

  [[nodiscard]] TextEdit edit(Extent extent, std::string with) const {
    return {.path = "", .range = document_.lines().range(extent), .text = std::move(with)};
  }

  /// A new item before one of a list, or a list of the new item and the value.
  [[nodiscard]] std::optional<TextEdit> edit_of(const Entry& entry, const FormerRoute& route,
                                                const std::string& added) const {
    const Node& next = *entry.value;
    if (next.is_sequence()) {
      if ((next.flow && entry.is_alias) || route.before.value >= next.items.size()) return std::nullopt;
      const std::size_t item = next.items[route.before.value].whole.begin;
      if (next.flow) return edit({item, item}, added + ", ");
      const bool crlf = text_.find("\r\n") != std::string::npos;
      return edit({item, item},
                  fmt::format("- {}{}{}", added, crlf ? "\r\n" : "\n", std::string(next.column, ' ')));
    }
    if (next.is_map() && !next.flow && !entry.is_alias) return std::nullopt;
    // The value with its anchor or tag, if it begins on the line of its key.
    const std::size_t value = text_.find_first_not_of(" \t", entry.behind), end = entry.written.end;
    if (value >= end || std::string_view("\r\n#").find(text_[value]) != std::string_view::npos)
      return std::nullopt;
    if (route.no_terminal && text_[value] != '&') return edit({value, end}, added);
    return edit({value, end}, fmt::format("[{}, {}]", added, text_.substr(value, end - value)));
  }

  /// Only the steps of the subsystem in which the span lies.
  void keep(const spec::Model& model, const diagnostics::Span& span) {
    const auto is_of = [&](const diagnostics::Span& behaviour) {
      for (const spec::Definition& definition : model.definitions)
        for (const spec::Subsystem& subsystem : definition.subsystems) {
          const auto has = [&](const diagnostics::Span& one) {
            return std::ranges::any_of(subsystem.behaviours, [&](const Behaviour& own) {
              return own.span == one ||
                     std::ranges::any_of(own.next, [&](const spec::Next& next) { return next.span == one; });
            });
          };
          if (has(span) && has(behaviour)) return true;
        }
      return false;
    };
    std::erase_if(found_.steps, [&](const Migration::Step& step) { return !is_of(step.span); });
    std::erase_if(found_.by_hand, [&](const Migration::ByHand& one) { return !is_of(one.span); });
  }

  /// A text that YAML reads in another way than this class does is for its author to change.
  void drop_wrong() {
    if (is_right(found_.steps)) return;
    std::vector<Migration::Step> right;
    for (Migration::Step& step : found_.steps) {
      if (is_right({step}))
        right.push_back(std::move(step));
      else
        found_.by_hand.push_back(
            {step.behaviour, step.span, fmt::format("add {{ to: {}, when: error }} to its 'next'", step.to)});
    }
    found_.steps = std::move(right);
  }

  /// Whether the edited text is one specification in which these behaviours, and no others, lead an error where it
  /// has led.
  [[nodiscard]] bool is_right(const std::vector<Migration::Step>& steps) const {
    std::vector<TextEdit> edits;
    for (const Migration::Step& step : steps) edits.push_back(step.edit);
    diagnostics::Diagnostics before("spec.yaml", text_);
    diagnostics::Diagnostics after("spec.yaml", edited(document_, edits));
    const std::optional<spec::Model> was = spec::parse(before);
    const std::optional<spec::Model> is = spec::parse(after);
    if (!was || !is || after.has_errors() || was->definitions.size() != is->definitions.size()) return false;
    for (const spec::DefinitionId d : was->definitions.ids())
      for (std::uint32_t s = 0; s < was->definitions[d].subsystems.size(); ++s) {
        const spec::Subsystem& old = was->definitions[d].subsystems[s];
        const spec::Subsystem& now = is->definitions[d].subsystems[s];
        for (const spec::BehaviourId b : old.behaviours.ids())
          if (!fits(old, now, b, steps)) return false;
      }
    return true;
  }

  static bool fits(const spec::Subsystem& before, const spec::Subsystem& after, spec::BehaviourId id,
                   const std::vector<Migration::Step>& steps) {
    const Behaviour &old = before.behaviours[id], &now = after.behaviours[id];
    const std::optional<FormerRoute> route = former_route(before, old);
    const std::optional<FormerRoute> left = former_route(after, now);
    const bool is_meant =
        std::ranges::any_of(steps, [&](const Migration::Step& step) { return step.span == old.span; });
    if (!route || left) return route.has_value() == left.has_value() && !(is_meant && left && route->certain);
    const spec::Next& added = now.next[route->before];
    return route->certain && added.when.kind == spec::When::Kind::error && !added.implied &&
           added.behaviour == route->to;
  }

  const Document& document_;
  const std::string& text_;
  Migration found_;
};

}  // namespace

std::optional<Migration> migrate(const Document& document, std::optional<diagnostics::Span> only) {
  return Migrator(document).migrated(only);
}

}  // namespace tessera::language
