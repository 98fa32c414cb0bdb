#include <fmt/format.h>

#include <algorithm>

#include "language/language.hpp"
#include "language/questions/place.hpp"

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

std::string about(const Document& document, SymbolId id) {
  const Index& index = document.index();
  const Symbol& symbol = index[id];
  std::string text = fmt::format("**{}** — {}", symbol.path, words_of(symbol.kind));
  if (!symbol.type.empty()) text += fmt::format("\n\n{}", code(symbol.type));
  if (const NamesOf* fields = index.fields_of(symbol.kind == Kind::type ? symbol.name : symbol.type))
    text += " " + code(fields_text(index, *fields));
  if (symbol.kind == Kind::behaviour)
    text += fmt::format(
        "\n\nTransition function: `void {}(Context& context, const Inputs& in, Memory& memory, Outputs& "
        "out)`",
        symbol.name);
  if (symbol.kind == Kind::condition) {
    const Node& expression = node_at(document.outline(), symbol.way);
    if (expression.is_scalar()) text += "\n\n" + code(expression.text);
  }
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
    if (symbol.kind == Kind::behaviour || symbol.kind == Kind::subsystem || symbol.kind == Kind::agent)
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
                symbol.type.empty() ? std::string(words_of(symbol.kind)) : symbol.type,
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
