#include "net/pnml_vocabulary.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "diagnostics/utf8.hpp"

namespace tessera::net {
namespace {

using diagnostics::in_quotes;
using pugi::xml_node;
using Words = std::span<const std::string_view>;

template <std::size_t size>
constexpr std::array<std::string_view, size> words(const std::string_view (&all)[size]) {
  return std::to_array(all);
}

bool is_among(std::string_view word, Words all) {
  return std::any_of(all.begin(), all.end(), [word](std::string_view one) {
    return one.size() == word.size() && one == word;  // the size first: most words differ in it
  });
}

/// Parts of any element that say where and how it is drawn, and what it is called.
constexpr auto drawn = words({"id", "name", "graphics", "toolspecific", "x", "y", "positionX", "positionY",
                              "nameOffsetX", "nameOffsetY", "markingOffsetX", "markingOffsetY", "displayName",
                              "angle", "orientation", "arcpath"});

// Parts that the reader reads itself.
constexpr auto of_document = words({"net"});
constexpr auto of_net = words(
    {"page", "place", "transition", "arc", "inputArc", "outputArc", "referencePlace", "referenceTransition"});
constexpr auto of_place = words({"initialMarking"});
constexpr auto of_arc = words({"source", "target", "inscription", "weight", "type", "arctype"});
constexpr auto of_reference = words({"ref"});
constexpr auto of_label = words({"text", "value"});

/// Parts of files of TAPAAL and PIPE that belong to no net: queries, notes, what the file needs of the tool.
constexpr auto of_tools = words({"query", "queries", "k-bound", "feature", "constant", "labels"});

constexpr auto coloured = words({"declaration", "hlinitialMarking", "hlinscription", "condition", "structure",
                                 "guard", "colorinvariant", "token"});
constexpr auto kinds_of_arcs = words({"inhibitor", "inhibitorArc", "resetArc", "reset", "readArc", "testArc",
                                      "transportArc", "inhibitorarc", "test"});
constexpr auto rates =
    words({"rate", "weight", "value", "distribution", "firingMode", "infiniteServer", "player"});
constexpr auto usual_rates = words({"1", "1.0", "constant", "Random", "Oldest", "Youngest", "false"});

Words read_parts_of(PnmlOwner owner) {
  switch (owner) {
    case PnmlOwner::document:
      return of_document;
    case PnmlOwner::net:
    case PnmlOwner::page:
      return of_net;
    case PnmlOwner::place:
      return of_place;
    case PnmlOwner::arc:
      return of_arc;
    case PnmlOwner::reference:
      return of_reference;
    case PnmlOwner::label:
      return of_label;
    case PnmlOwner::transition:
      break;
  }
  return {};
}

std::string without_blanks(std::string_view text) {
  std::string rest;
  for (const char c : text)
    if (c != ' ' && c != '\t' && c != '\n' && c != '\r') rest += c;
  return rest;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

constexpr const char* unknown_hint =
    "only names, graphics and toolspecific are ignored; if it changes nothing, remove it";

}  // namespace

std::string_view local_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

bool is_place_transition_type(std::string_view type) {
  constexpr auto known = words({"ptnet", "ptnetb", "ptnet.pntd", "p/t net", "p/t", "p/t-net", "pt-net",
                                "pt net", "place/transition net", "pnmlcoremodel"});
  const std::string whole = lower(type);
  const std::string last = whole.substr(whole.find_last_of("/#") + 1);  // npos + 1 is 0
  return is_among(whole, known) || is_among(last, known);
}

void PnmlVocabulary::find(bool is_error, const char* code, std::string key, Span at, std::string message,
                          std::string hint) {
  const auto [known, is_new] = known_.emplace(std::move(key), findings_.size());
  if (is_new) findings_.push_back({is_error, code, at, std::move(message), std::move(hint), 0});
  ++findings_[known->second].count;
}

void PnmlVocabulary::refuse(const char* code, std::string key, Span at, std::string message,
                            std::string hint) {
  find(true, code, std::move(key), at, std::move(message), std::move(hint));
}

void PnmlVocabulary::refuse_arc(std::string_view kind, const xml_node& arc, Span at) {
  const std::string name = lower(kind);
  const std::string source = arc.attribute("source").value(), target = arc.attribute("target").value();
  std::string hint = "write what it means with plain arcs";
  if (name.find("inhibitor") != std::string::npos)
    hint =
        "if the place can hold n tokens, give it a partner of n minus its tokens, filled where it is "
        "emptied, and "
        "read the partner with weight n";
  if (name == "test" || name == "read" || name.find("test") == 0 || name.find("read") == 0)
    hint = "an arc in each direction says the same";
  refuse("E423", "arc " + name, at,
         "the arc " + (source.empty() ? "" : "from " + in_quotes(source) + " to " + in_quotes(target) + " ") +
             "is of the kind " + in_quotes(kind) + ", which place/transition nets do not have",
         hint);
}

void PnmlVocabulary::judge(PnmlOwner owner, const xml_node& node, Span at) {
  for (const pugi::xml_attribute attribute : node.attributes()) {
    const std::string_view whole = attribute.name(), name = local_name(whole);
    if (node.attribute(attribute.name()) != attribute)
      refuse("E428", std::string("twice ") + attribute.name(), at,
             "the attribute " + in_quotes(whole) + " of " + in_quotes(node.name()) + " is given twice",
             "keep one");
    if (whole == "xmlns" || whole.starts_with("xmlns:") || whole.starts_with("xsi:") ||
        whole.starts_with("xml:"))
      continue;
    if (owner == PnmlOwner::net && name == "type") continue;
    if (owner == PnmlOwner::label && name != "value" && !is_among(name, drawn)) {
      refuse("E428", std::string("attribute ") + attribute.name(), at,
             "the attribute " + in_quotes(whole) + " of " + in_quotes(node.name()) + " is not known",
             unknown_hint);
      continue;
    }
    if (is_among(name, drawn) || is_among(name, read_parts_of(owner))) continue;
    if (!judge_value(owner, name, attribute.value(), at))
      refuse("E428", std::string("attribute ") + attribute.name() + " of " + node.name(), at,
             "the attribute " + in_quotes(whole) + " of " + in_quotes(node.name()) + " is not known",
             unknown_hint);
  }
}

bool PnmlVocabulary::is_read(PnmlOwner owner, const xml_node& child, Span at, const std::string& value) {
  if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
    refuse("E428", std::string("text in ") + child.parent().name(), at,
           "the text " + in_quotes(child.value()) + " in " + in_quotes(child.parent().name()) +
               " has no meaning",
           owner == PnmlOwner::label ? "a value stands in a <text>" : unknown_hint);
  if (child.type() != pugi::node_element) return false;
  const std::string_view name = local_name(child.name());
  if (is_among(name, read_parts_of(owner))) return true;
  if (is_among(name, drawn)) return false;
  const std::string quoted = in_quotes(child.name());
  const bool is_around = owner == PnmlOwner::document || owner == PnmlOwner::net || owner == PnmlOwner::page;
  if (is_around && is_among(name, of_tools)) return false;
  if (is_around && is_among(name, kinds_of_arcs)) {
    const xml_node inner = child.child("arc");
    refuse_arc(name, inner ? inner : child, at);
    return false;
  }
  if (owner == PnmlOwner::arc && is_among(name, kinds_of_arcs)) {
    refuse_arc(name, child.parent(), at);
    return false;
  }
  if (is_around && name == "finalmarkings") {
    find(false, "W422", "final markings", at, "the final markings of the file are not read",
         "a marking in which nothing can fire is a deadlock here, final or not");
    return false;
  }
  if (is_around && name == "token") {  // a class of tokens of PIPE
    if (std::string_view(child.attribute("enabled").value()) != "false")
      judge_same("class of tokens", child.attribute("id").value(), at);
    return false;
  }
  if (is_among(name, coloured) || (owner == PnmlOwner::place && name == "type")) {
    refuse("E423", "coloured", at, "this is a coloured net: it has " + quoted,
           "unfold it to a place/transition net first");
    return false;
  }
  if (has_value(owner, child) && judge_value(owner, name, value, at)) return false;
  refuse("E428", "element " + std::string(name) + " of " + child.parent().name(), at,
         "the element " + quoted + " of " + in_quotes(child.parent().name()) + " is not known", unknown_hint);
  return false;
}

bool PnmlVocabulary::has_value(PnmlOwner owner, const xml_node& child) {
  const std::string_view name = local_name(child.name());
  if (owner == PnmlOwner::place) return name == "invariant" || name == "capacity";
  if (owner == PnmlOwner::arc) return name == "tagged";
  return owner == PnmlOwner::transition &&
         (name == "urgent" || name == "timed" || name == "priority" || is_among(name, rates));
}

bool PnmlVocabulary::judge_value(PnmlOwner owner, std::string_view name, std::string_view value, Span at) {
  const std::string plain = without_blanks(value);
  const auto differs = [&](std::string what, std::string hint) {
    refuse("E429", std::string(name), at,
           in_quotes(name) + " " + in_quotes(value) + ": place/transition nets have no " + std::move(what),
           std::move(hint));
  };
  if (owner == PnmlOwner::net && name == "active") {
    if (plain != "true") differs("parts that are switched off", "activate the net or remove it");
    return true;
  }
  if (owner == PnmlOwner::place && name == "invariant") {
    if (plain != "<inf" && plain != "<=inf")
      differs("time", "without invariants and intervals it can be read");
    return true;
  }
  if (owner == PnmlOwner::place && name == "capacity") {
    const std::string_view number = std::string_view(plain).substr(plain.rfind(',') + 1);  // "Default,0"
    if (number != "0")
      differs(
          "capacities",
          "add a place of the free room: it loses a token where this one gets one, and gets one where this "
          "one loses one; or write 0 for no capacity");
    return true;
  }
  if (owner == PnmlOwner::arc && name == "tagged") {
    if (plain != "false") differs("tagged tokens", "write false");
    return true;
  }
  if (owner != PnmlOwner::transition) return false;
  if (name == "urgent") {
    if (plain != "false") differs("time", "without urgent transitions it can be read");
    return true;
  }
  if (name == "timed" || name == "priority") {
    judge_same(name, plain, at);
    return true;
  }
  if (!is_among(name, rates)) return false;
  if (name == "player" ? plain != "0" : !is_among(plain, usual_rates))
    find(false, "W421", std::string(name), at,
         in_quotes(name) + " " + in_quotes(value) + " is not read: it does not change what can happen",
         "every order of firings that the tokens allow is judged, however improbable it is");
  return true;
}

/// Priorities and immediate transitions change which transition may fire, unless all are alike.
void PnmlVocabulary::judge_same(std::string_view name, std::string_view value, Span at) {
  const auto [first, is_new] = same_.emplace(std::string(name), std::string(value));
  if (is_new || first->second == value) return;
  if (name == "class of tokens")
    refuse("E423", "coloured", at, "this is a coloured net: it has tokens of the class " + in_quotes(value),
           "unfold it to a place/transition net first");
  else
    refuse("E429", std::string(name), at,
           in_quotes(name) + " is " + in_quotes(value) + " here and " + in_quotes(first->second) +
               " elsewhere: place/transition nets have no priorities",
           "give all transitions the same");
}

bool PnmlVocabulary::report() {
  bool failed = false;
  for (Finding& one : findings_) {
    if (one.count > 1) one.message += " (" + std::to_string(one.count) + " times in the file)";
    if (one.is_error)
      out_.error(one.code, one.span, std::move(one.message), std::move(one.hint));
    else
      out_.warning(one.code, one.span, std::move(one.message), std::move(one.hint));
    failed = failed || one.is_error;
  }
  findings_.clear();
  return failed;
}

}  // namespace tessera::net
