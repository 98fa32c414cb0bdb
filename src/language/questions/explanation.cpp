#include <fmt/format.h>

#include <algorithm>

#include "language/language.hpp"
#include "language/questions/place.hpp"
#include "spec/parser.hpp"

namespace tessera::language {
namespace {

/// `text` as code of markdown, on one line.
std::string code(std::string_view text) {
  std::string result;
  for (const char c : text.substr(0, 200)) result += c == '`' ? '\'' : c == '\n' || c == '\r' ? ' ' : c;
  return result.empty() ? "" : "`" + result + "`";
}

/// "{ left: bool, middle: bool }"
std::string fields_text(const Index& index, const NamesOf& fields) {
  std::vector<SymbolId> ids;
  for (const auto& [name, id] : fields) ids.push_back(id);
  std::sort(ids.begin(), ids.end());
  std::string text;
  for (const SymbolId id : ids)
    text += fmt::format("{}{}: {}", text.empty() ? "{ " : ", ", index[id].name, index[id].type);
  return text + " }";
}

/// The channels that begin or end at a buffer.
std::string channels_of(const Document& document, SymbolId id) {
  std::string text;
  std::size_t count = 0;
  const Node& channels = document.outline().root()["channels"];
  for (const Entry& item : channels.items) {
    const Node* channel = item.value;
    const auto& uses = document.index().uses();
    const auto first = std::lower_bound(uses.begin(), uses.end(), channel->extent.begin,
                                        [](const Use& use, std::size_t at) { return use.extent.begin < at; });
    for (auto use = first; use != uses.end() && use->extent.begin < channel->extent.end; ++use) {
      if (use->symbol != id) continue;
      if (++count > 5) return text + "\n\n…";
      text += "\n\n" + code(document.text().substr(channel->extent.begin,
                                                   channel->extent.end - channel->extent.begin));
      break;
    }
  }
  return text.empty() ? "" : "\n\nChannels:" + text;
}

std::string joined(const std::vector<spec::BufferId>& list,
                   const Numbered<spec::BufferId, spec::Field>& buffers) {
  std::string text;
  for (const spec::BufferId buffer : list)
    if (buffers.has(buffer)) text += (text.empty() ? "" : ", ") + code(buffers[buffer].name);
  return text.empty() ? "nothing" : text;
}

/// The line of a key, for people.
std::string line_of(const Document& document, const Entry& entry) {
  return fmt::format("line {}", document.lines().position(entry.extent.begin).line + 1);
}

/// The defaults that a behaviour has from `on_error`, `send` and `receive` around it; empty in a text with errors.
std::string inherited(const Document& document, const Symbol& symbol, const UnitNames& unit) {
  diagnostics::Diagnostics out("", document.text());
  const std::optional<spec::Model> model = spec::parse(out);
  const std::uint32_t line = document.lines().position(symbol.definition.begin).line + 1;
  const Node& body = node_at(document.outline(), unit.way);
  const Node& own = node_at(document.outline(), symbol.way);
  std::string text;
  const auto add = [&](const spec::Subsystem& subsystem, const spec::Behaviour& behaviour) {
    for (const spec::Next& next : behaviour.next)
      if (next.inherited && subsystem.behaviours.has(next.behaviour))
        text += fmt::format("\n\nA failure leads to {}: `on_error`, line {}.",
                            code(subsystem.behaviours[next.behaviour].name), next.span.line);
    const auto list = [&](const char* key, const char* does, const auto& used, const auto& buffers) {
      const Entry* around = body.find(key);
      const bool replaced = own[key].is_sequence() &&
                            std::none_of(own[key].items.begin(), own[key].items.end(), [](const Entry& one) {
                              return one.value->text.starts_with('+') || one.value->text.starts_with('-');
                            });
      if (!used || replaced || (around == nullptr && own.find(key) == nullptr)) return;
      text += fmt::format("\n\n{} {}: ", does, joined(*used, buffers));
      text += around == nullptr ? fmt::format("all but those that `{}` leaves out.", key)
                                : fmt::format("`{}` of the subsystem, {}{}.", key, line_of(document, *around),
                                              own.find(key) == nullptr ? "" : ", as changed here");
    };
    list("send", "Sends", behaviour.send, subsystem.outputs);
    list("receive", "Receives", behaviour.receive, subsystem.inputs);
  };
  if (!model) return text;
  for (const spec::Definition& definition : model->definitions)
    for (const spec::Subsystem& subsystem : definition.subsystems)
      for (const spec::Behaviour& behaviour : subsystem.behaviours)
        if (behaviour.label().substr(0, behaviour.label().find('[')) == symbol.name &&
            behaviour.span.line == line && text.empty())
          add(subsystem, behaviour);
  return text;
}

/// The lines where `sets` or `orders` changes a memory cell, or gives it a value: "Changed on lines 12, 17."
std::string changes_of(const Document& document, SymbolId id) {
  constexpr std::size_t most_shown = 8;
  std::string lines;
  std::size_t count = 0;
  for (const Use& use : document.index().uses()) {
    const auto place = use.symbol == id && !use.defines ? place_at(document.outline(), use.extent.begin)
                                                        : std::optional<PlaceInText>();
    const std::size_t above = place && place->key != nullptr ? 1 : 2;
    if (!place || place->way.size() < above) continue;
    if (place->way[place->way.size() - above] != "sets" && place->way.back() != "orders") continue;
    if (++count <= most_shown)
      lines += fmt::format("{}{}", lines.empty() ? "" : ", ",
                           document.lines().position(use.extent.begin).line + 1);
  }
  const bool is_cell = document.index()[id].kind == Kind::memory;
  const char* const does = is_cell ? "Changed" : "Set";
  if (count == 0) return is_cell ? "\n\nNothing changes it." : "\n\nNothing sets it.";
  return fmt::format("\n\n{} on line{} {}{}.", does, count == 1 ? "" : "s", lines,
                     count > most_shown ? " ..." : "");
}

/// A memory cell with few values, or one of its values.
std::string about_memory(const Document& document, SymbolId id) {
  const Index& index = document.index();
  const Symbol& symbol = index[id];
  const bool is_value = symbol.kind == Kind::value;
  const std::string name = index.enumeration_of(is_value ? symbol.owner : id);
  if (!is_value && !symbol.type.starts_with('{')) return {};
  std::string text;
  if (is_value)
    text += "\n\nIn C++: " + code("Memory::" + name + "::" + symbol.name);
  else
    text += "\n\nIn C++: " + code(name.empty() ? "int" : "Memory::" + name);
  return text + changes_of(document, id);
}

/// The functions of a behaviour that stands in a template of a group.
std::string functions_of_users(const Document& document, SymbolId id) {
  constexpr std::size_t most_shown = 8;
  std::string all;
  std::size_t count = 0;
  for (const DefinitionNames& definition : document.index().definitions())
    for (const UnitNames& unit : definition.units)
      for (const auto& [function, path] : unit.functions) {
        if (path.back() != id || ++count > most_shown) continue;
        all +=
            fmt::format("{}{} of {}.{}", all.empty() ? "" : ", ", code(function), definition.name, unit.name);
      }
  if (count == 0) return {};
  return fmt::format("\n\nTransition function{}: {}{}", count == 1 ? "" : "s", all,
                     count > most_shown ? " ..." : "");
}

/// A template of a group: what it takes, and where it is used.
std::string about_template(const Document& document, SymbolId id) {
  const Index& index = document.index();
  const GroupTemplateNames* found = index.group_template(index[id].name);
  if (found == nullptr) return {};
  std::string taken, lines;
  std::vector<SymbolId> names;
  for (const auto& [name, one] : found->taken) names.push_back(one);
  std::ranges::sort(names);
  for (const SymbolId one : names) taken += (taken.empty() ? "" : ", ") + code(index[one].name);
  std::string text = taken.empty() ? "" : "\n\nTakes " + taken + ".";
  std::size_t count = 0;
  for (const Use& use : index.uses())
    if (use.symbol == id && !use.defines && ++count <= 8)
      lines += fmt::format("{}{}", lines.empty() ? "" : ", ",
                           document.lines().position(use.extent.begin).line + 1);
  if (count == 0) return text + "\n\nNothing uses it.";
  return text +
         fmt::format("\n\nUsed on line{} {}{}.", count == 1 ? "" : "s", lines, count > 8 ? " ..." : "");
}

/// The texts that the uses of a template give for a name that it takes.
std::string about_taken(const Document& document, SymbolId id) {
  std::string all;
  std::size_t count = 0;
  for (const Use& use : document.index().uses()) {
    if (use.symbol != id || use.defines) continue;
    const auto place = place_at(document.outline(), use.extent.begin);
    const bool gives = place && place->key != nullptr && !place->way.empty() && place->way.back() == "with";
    if (!gives || ++count > 8) continue;
    all += fmt::format("\n\n{} on {}", code(place->key->value->text), line_of(document, *place->key));
  }
  return all.empty() ? "\n\nNothing gives it." : "\n\nStands for:" + all + (count > 8 ? "\n\n…" : "");
}

std::string about_function(const Document& document, SymbolId id, const UnitNames& unit) {
  const auto function =
      std::ranges::find_if(unit.functions, [&](const auto& one) { return one.second.back() == id; });
  if (function == unit.functions.end()) return functions_of_users(document, id);
  std::string text = fmt::format(
      "\n\nTransition function: `void {}(Context& context, const Inputs& in, Memory& memory, Outputs& out)`",
      function->first);
  if (!document.index()[id].fleet.empty()) text += "\n\nThe number of the member: `context.member`";
  return text;
}

/// Begins with, contains, is left by.
std::string about_group(const Document& document, SymbolId id, const UnitNames& unit) {
  constexpr std::size_t most_shown = 12;
  const Index& index = document.index();
  const Node& body = node_at(document.outline(), index[id].way);
  std::vector<SymbolId> inside;
  for (const auto& [name, one] : unit.behaviours_in(id)) inside.push_back(one);
  std::ranges::sort(inside);
  if (inside.empty()) return {};
  const std::string start = body["start"].text.empty() ? index[inside.front()].name : body["start"].text;
  std::string text = "\n\nBegins with " + code(start) + ". In it: ";
  for (std::size_t at = 0; at < std::min(inside.size(), most_shown); ++at)
    text += (at == 0 ? "" : ", ") + code(index[inside[at]].name);
  text += inside.size() > most_shown ? " …" : ".";
  if (body["until"].is_scalar()) text += "\n\nLeft after the iteration in which " + code(body["until"].text);
  if (body["on_error"].is_scalar()) text += "\n\nA failure in it leads to " + code(body["on_error"].text);
  return text;
}

std::string about(const Document& document, SymbolId id) {
  const Index& index = document.index();
  const Symbol& symbol = index[id];
  std::string text = fmt::format("**{}** — {}", symbol.path, words_of(symbol));
  if (!symbol.fleet.empty()) text += fmt::format(", one for each member of {}", code(symbol.fleet));
  if (!symbol.type.empty()) text += fmt::format("\n\n{}", code(symbol.type));
  if (const NamesOf* fields = index.fields_of(symbol.kind == Kind::type ? symbol.name : symbol.type))
    text += " " + code(fields_text(index, *fields));
  if (const UnitNames* unit = index.unit_at(symbol.way); unit != nullptr && symbol.kind == Kind::behaviour)
    text += symbol.is_group ? about_group(document, id, *unit)
                            : about_function(document, id, *unit) + inherited(document, symbol, *unit);
  if (symbol.kind == Kind::agent_template && symbol.is_group) text += about_template(document, id);
  if (symbol.kind == Kind::taken) text += about_taken(document, id);
  if (symbol.kind == Kind::condition) {
    const Node& expression = node_at(document.outline(), symbol.way);
    if (expression.is_scalar()) text += "\n\n" + code(expression.text);
  }
  if (symbol.kind == Kind::memory || symbol.kind == Kind::value) text += about_memory(document, id);
  if (symbol.kind == Kind::input || symbol.kind == Kind::output) text += channels_of(document, id);
  return text;
}

}  // namespace

std::optional<Explanation> explain(const Document& document, Position position) {
  const std::size_t offset = document.lines().offset(position);
  const std::optional<PlaceInText> place = place_at(document.outline(), offset);
  Explanation explanation;
  if (const Use* use = document.index().at(offset)) {
    explanation.markdown = about(document, use->symbol);
    explanation.range = document.lines().range(use->extent);
    const Symbol& symbol = document.index()[use->symbol];
    const bool in_template =
        symbol.way.size() > 1 && document.index().group_template(symbol.way[1]) != nullptr;
    if (!in_template &&
        (symbol.kind == Kind::behaviour || symbol.kind == Kind::subsystem || symbol.kind == Kind::agent))
      explanation.page = {symbol.path, document.lines().position(symbol.definition.begin).line + 1};
  }
  if (place && place->key != nullptr) {
    Way way = place->way;
    way.push_back(place->key->key);
    const std::string says = document.grammar().description(way);
    if (!says.empty()) {
      const bool known = !explanation.markdown.empty();
      explanation.markdown += known ? "\n\n" + says : fmt::format("**{}**\n\n{}", place->key->key, says);
      explanation.range = document.lines().range(place->key->extent);
    }
  }
  if (explanation.markdown.empty()) return std::nullopt;
  return explanation;
}

std::vector<Heading> headings(const Document& document) {
  const auto& symbols = document.index().symbols();
  Numbered<SymbolId, std::vector<SymbolId>> inside(symbols.size());
  std::vector<SymbolId> top;
  for (const SymbolId id : symbols.ids())
    (symbols[id].owner.valid() ? inside[symbols[id].owner] : top).push_back(id);
  const auto heading = [&](const auto& self, SymbolId id) -> Heading {
    const Symbol& symbol = symbols[id];
    Heading one{symbol.name,
                symbol.type.empty() ? std::string(words_of(symbol)) : symbol.type,
                symbol.kind,
                document.lines().range(symbol.whole),
                document.lines().range(symbol.definition),
                {}};
    for (const SymbolId child : inside[id]) one.inside.push_back(self(self, child));
    return one;
  };
  std::vector<Heading> all;
  for (const SymbolId id : top) all.push_back(heading(heading, id));
  std::sort(all.begin(), all.end(), [](const Heading& a, const Heading& b) { return a.whole < b.whole; });
  return all;
}

}  // namespace tessera::language
