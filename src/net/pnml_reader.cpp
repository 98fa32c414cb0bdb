#include "net/pnml_reader.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <pugixml.hpp>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "net/pnml_vocabulary.hpp"

namespace tessera::net {
namespace {

using diagnostics::in_quotes;
using pugi::xml_node;

std::string_view name_of(const xml_node& node) { return local_name(node.name()); }

xml_node child(const xml_node& node, std::string_view name) {
  for (const xml_node candidate : node.children())
    if (name_of(candidate) == name) return candidate;
  return {};
}

/// "[0,inf)", the interval of an arc of TAPAAL that any age satisfies.
bool is_any_time(std::string_view text) {
  std::string plain;
  for (const char c : text)
    if (c != ' ') plain += c;
  return plain == "[0,inf)";
}

/// Lines and columns of byte offsets.
class Positions {
 public:
  explicit Positions(std::string_view text) : size_(text.size()) {
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', end + 1))
      starts_.push_back(end + 1);
  }
  [[nodiscard]] Span at(std::ptrdiff_t offset, std::size_t length) const {
    if (offset < 0) return {};
    const std::size_t position = std::min(static_cast<std::size_t>(offset), size_);
    const auto line = std::prev(std::ranges::upper_bound(starts_, position));
    return {static_cast<std::uint32_t>(line - starts_.begin() + 1),
            static_cast<std::uint32_t>(position - *line + 1),
            static_cast<std::uint32_t>(std::max<std::size_t>(1, length))};
  }
  [[nodiscard]] Span of(const xml_node& node) const {
    const bool element = node.type() == pugi::node_element;
    return at(node.offset_debug(),
              element ? std::string_view(node.name()).size() : std::string_view(node.value()).size());
  }

 private:
  std::size_t size_;
  std::vector<std::size_t> starts_{0};
};

/// The element that an id of the document refers to.
struct Element {
  enum class Kind : std::uint8_t { place, transition, reference_place, reference_transition } kind;
  std::uint32_t index = 0;  ///< of the place or transition, or into the references
};

struct Reference {
  std::string target;
  Span span;
};

bool contains_ignoring_case(std::string_view text, std::string_view word) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  const auto same = [&](char a, char b) { return lower(a) == lower(b); };
  return std::search(text.begin(), text.end(), word.begin(), word.end(), same) != text.end();
}

constexpr std::array coloured_types =
    std::to_array<std::string_view>({"symmetric", "hlpn", "highlevel", "coloured", "colored"});

class Reader {
 public:
  explicit Reader(diagnostics::Diagnostics& out) : out_(out), positions_(out.text()), vocabulary_(out) {}

  std::optional<Net> result() {
    const std::size_t before = out_.error_count();
    pugi::xml_document document;
    if (!parse(document)) return std::nullopt;
    const xml_node net = only_net(document);
    if (!net || !is_place_transition_net(net)) return std::nullopt;
    collect(net);
    name_apart();
    for (const auto& [id, element] : elements_)
      if (is_reference(element)) static_cast<void>(resolved(element));
    for (const xml_node& arc : arcs_) connect(arc);
    static_cast<void>(vocabulary_.report());
    if (out_.error_count() > before) return std::nullopt;
    return build();
  }

 private:
  bool parse(pugi::xml_document& document) {
    const std::string& text = out_.text();
    const unsigned options = pugi::parse_default | pugi::parse_doctype | pugi::parse_trim_pcdata;
    const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size(), options);
    if (!result) {
      out_.error("E420", positions_.at(result.offset, 1),
                 std::string("this is not well-formed XML: ") + lowered(result.description()),
                 result.status == pugi::status_no_document_element ? "the file has no element at all" : "");
      return false;
    }
    for (const xml_node node : document.children())
      if (node.type() == pugi::node_doctype &&
          std::string_view(node.value()).find('[') != std::string_view::npos) {
        out_.error("E421", positions_.at(node.offset_debug(), 1),
                   "the document type declares entities or elements of its own",
                   "PNML needs no DOCTYPE; remove it");
        return false;
      }
    return true;
  }

  static std::string lowered(std::string text) {
    if (!text.empty() && text.front() >= 'A' && text.front() <= 'Z')
      text.front() = static_cast<char>(text.front() - 'A' + 'a');
    return text;
  }

  xml_node only_net(const pugi::xml_document& document) {
    const xml_node root = document.document_element();
    if (name_of(root) != "pnml") {
      out_.error("E422", positions_.of(root),
                 "this is not PNML: the root element is " + in_quotes(root.name()),
                 "a PNML file starts with <pnml>");
      return {};
    }
    xml_node found;
    vocabulary_.judge(PnmlOwner::document, root, positions_.of(root));
    for (const xml_node candidate : root.children()) {
      if (!is_read(PnmlOwner::document, candidate)) continue;
      if (found) {
        out_.error("E422", positions_.of(candidate), "the file has more than one net",
                   "keep one net per file");
        return {};
      }
      found = candidate;
    }
    if (!found) out_.error("E422", positions_.of(root), "the file has no net");
    return found;
  }

  bool is_place_transition_net(const xml_node& net) {
    const std::string_view type = net.attribute("type").value();
    if (type.empty() || is_place_transition_type(type)) return true;
    const bool coloured = std::ranges::any_of(
        coloured_types, [&](std::string_view word) { return contains_ignoring_case(type, word); });
    out_.error("E423", positions_.of(net),
               std::string(coloured ? "this is a coloured net" : "this is not a place/transition net") +
                   ": its type is " + in_quotes(type),
               coloured ? "unfold it to a place/transition net first"
                        : "if it is one, its type is http://www.pnml.org/version-2009/grammar/ptnet");
    return false;
  }

  /// Walks the pages in document order. An explicit stack: a file may nest pages as deep as it likes.
  void collect(const xml_node& net) {
    vocabulary_.judge(PnmlOwner::net, net, positions_.of(net));
    std::vector<xml_node> stack{net.first_child()};
    while (!stack.empty()) {
      const xml_node node = stack.back();
      if (!node) {
        stack.pop_back();
        continue;
      }
      stack.back() = node.next_sibling();
      if (!is_read(stack.size() > 1 ? PnmlOwner::page : PnmlOwner::net, node)) continue;
      const std::string_view kind = name_of(node);
      if (kind == "page") {
        vocabulary_.judge(PnmlOwner::page, node, positions_.of(node));
        stack.push_back(node.first_child());
      } else {
        add(node, kind);
      }
    }
  }

  /// A child that has no meaning for the net has been judged then.
  bool is_read(PnmlOwner owner, const xml_node& node) {
    std::string value;
    if (PnmlVocabulary::has_value(owner, node)) {
      std::optional<Value> given = value_of(node);
      if (!given) return false;
      value = std::move(given->text);
    }
    return vocabulary_.is_read(owner, node, positions_.of(node), value);
  }

  void add(const xml_node& node, std::string_view kind) {
    if (kind == "place") {
      enter(node, {Element::Kind::place, static_cast<std::uint32_t>(places_.size())});
      judge(PnmlOwner::place, node);
      Place place;
      place.name = label(node, "name");
      place.tokens = marking(node);
      place.span = positions_.of(node);
      places_.push_back(std::move(place));
      place_ids_.emplace_back(node.attribute("id").value());
    } else if (kind == "transition") {
      enter(node, {Element::Kind::transition, static_cast<std::uint32_t>(transitions_.size())});
      judge(PnmlOwner::transition, node);
      for (const char* part : {"timed", "priority"})
        if (!node.attribute(part) && !child(node, part))
          vocabulary_.judge_same(part, "not given", positions_.of(node));
      Transition transition;
      transition.name = label(node, "name");
      transition.span = positions_.of(node);
      transitions_.push_back(std::move(transition));
      transition_ids_.emplace_back(node.attribute("id").value());
    } else if (kind == "referencePlace" || kind == "referenceTransition") {
      enter(node,
            {kind == "referencePlace" ? Element::Kind::reference_place : Element::Kind::reference_transition,
             static_cast<std::uint32_t>(references_.size())});
      judge(PnmlOwner::reference, node);
      references_.push_back({node.attribute("ref").value(), positions_.of(node)});
    } else {
      judge(PnmlOwner::arc, node);
      arcs_.push_back(node);
    }
  }

  /// The element and its children, each of which may stand there once.
  void judge(PnmlOwner owner, const xml_node& node) {
    vocabulary_.judge(owner, node, positions_.of(node));
    std::vector<std::string_view> seen;
    for (const xml_node part : node.children()) {
      if (!is_read(owner, part)) continue;
      if (std::ranges::find(seen, name_of(part)) != seen.end())
        vocabulary_.refuse("E428", "twice " + std::string(name_of(part)), positions_.of(part),
                           in_quotes(part.name()) + " is given twice to one " + std::string(name_of(node)),
                           "keep one");
      seen.push_back(name_of(part));
    }
  }

  /// Nothing refers to arcs and pages: they need no id, and one that is taken does no harm.
  void enter(const xml_node& node, Element element) {
    const std::string_view id = node.attribute("id").value();
    if (id.empty())
      out_.error("E424", positions_.of(node), "this " + std::string(name_of(node)) + " has no id");
    else if (!elements_.emplace(id, element).second)
      out_.error("E424", positions_.of(node), "the id " + in_quotes(id) + " is given twice");
  }

  /// The name of an element: its label, as the standard says and as PIPE does, or its attribute, as TAPAAL does.
  static std::string label(const xml_node& node, std::string_view name) {
    const xml_node holder = child(node, name);
    if (const xml_node text = child(holder, "text")) return text.text().get();
    if (const xml_node text = child(holder, "value")) return text.text().get();
    return holder ? "" : node.attribute(std::string(name).c_str()).value();
  }

  /// The text of a label, and where it stands. nullopt: it is not clear, which has been said.
  struct Value {
    std::string text;
    Span span;
  };
  std::optional<Value> value_of(const xml_node& holder) {
    vocabulary_.judge(PnmlOwner::label, holder, positions_.of(holder));
    std::optional<Value> value;
    std::size_t count = 0;
    if (const pugi::xml_attribute attribute = holder.attribute("value")) {
      value = {attribute.value(), positions_.of(holder)};
      ++count;
    }
    for (const xml_node part : holder.children()) {
      if (!is_read(PnmlOwner::label, part)) continue;
      const xml_node text = part.first_child();
      if (text && (text.next_sibling() || text.type() == pugi::node_element)) count = 2;
      value = {text.value(), positions_.of(text ? text : part)};
      ++count;
    }
    if (count == 1) return value;
    vocabulary_.refuse("E428", "no single value", positions_.of(holder),
                       in_quotes(holder.name()) + (count == 0 ? " has no value" : " has more than one value"),
                       "a value stands in a <text>");
    return std::nullopt;
  }

  std::uint32_t marking(const xml_node& place) {
    return number(place, "initialMarking", place.attribute("initialMarking"), "marking", 0, 0);
  }

  /// owner: has the number as a label, or as an attribute of its own.
  std::uint32_t number(const xml_node& owner, const char* label, const pugi::xml_attribute& attribute,
                       const char* what, std::uint32_t missing, std::uint32_t least) {
    const xml_node holder = child(owner, label);
    if (holder && attribute)
      vocabulary_.refuse("E428", std::string("twice ") + label, positions_.of(holder),
                         in_quotes(label) + " is given twice to one " + std::string(name_of(owner)),
                         "keep one");
    std::optional<Value> value;
    if (holder)
      value = value_of(holder);
    else if (attribute)
      value = {attribute.value(), positions_.of(owner)};
    if (!value || (holder && is_any_time(value->text))) return missing;
    return whole_number(*value, what, missing, least);
  }

  /// "3", or "Default,3" as PIPE writes it: the number of tokens of a class.
  std::uint32_t whole_number(const Value& given, const char* what, std::uint32_t missing,
                             std::uint32_t least) {
    std::string_view digits = trimmed(given.text);
    for (std::size_t comma = digits.find(','); comma != std::string_view::npos; comma = digits.find(',')) {
      const std::string_view name = trimmed(digits.substr(0, comma)), rest = digits.substr(comma + 1);
      const std::size_t next = rest.find(',');
      const std::string_view count = trimmed(rest.substr(0, next));
      if (name.empty()) break;
      if (next == std::string_view::npos || count != "0") {
        if (count != "0") vocabulary_.judge_same("class of tokens", name, given.span);
        if (next != std::string_view::npos && !only_zeros(rest.substr(next + 1))) break;
        digits = count;
      } else {
        digits = rest.substr(next + 1);
      }
    }
    std::uint32_t value = 0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (problem == std::errc{} && end == digits.data() + digits.size() && value >= least &&
        value <= largest_pnml_number)
      return value;
    out_.error("E425", given.span,
               std::string(what) + " " + in_quotes(given.text) + " is not a whole number from " +
                   std::to_string(least) + " to " + std::to_string(largest_pnml_number));
    return missing;
  }

  /// "Red,0,Blue,0": no token of these classes.
  static bool only_zeros(std::string_view text) {
    while (!text.empty()) {
      const std::size_t comma = text.find(',');
      if (comma == std::string_view::npos) return false;
      text.remove_prefix(comma + 1);
      const std::size_t end = std::min(text.find(','), text.size());
      if (trimmed(text.substr(0, end)) != "0") return false;
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    return true;
  }

  static std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
  }

  /// Keeps names that exist and are unique; otherwise uses the id, which is unique.
  void name_apart() {
    std::unordered_map<std::string, int> uses;
    for (const Place& place : places_) ++uses[place.name];
    for (const Transition& transition : transitions_) ++uses[transition.name];
    const auto choose = [&](auto& elements, const std::vector<std::string>& ids) {
      for (std::size_t index = 0; index < elements.size(); ++index) {
        std::string& name = elements[index].name;
        // The id must not be the name of another element, or traces could not tell the two apart.
        const bool unclear =
            name.empty() || uses[name] > 1 || (name != ids[index] && elements_.contains(name));
        if (unclear) name = ids[index];
      }
    };
    choose(places_, place_ids_);
    choose(transitions_, transition_ids_);
  }

  void connect(const xml_node& arc) {
    if (!is_plain(arc)) return;
    const std::uint32_t weight = weight_of(arc);
    const std::optional<Element> source = end_of(arc, "source"), target = end_of(arc, "target");
    if (!source || !target) return;
    if (source->kind == target->kind) {
      const char* kind = source->kind == Element::Kind::place ? "places" : "transitions";
      out_.error("E426", positions_.of(arc), std::string("this arc joins two ") + kind);
      return;
    }
    const bool consumes = source->kind == Element::Kind::place;
    const std::uint32_t place = (consumes ? source : target)->index;
    const std::uint32_t transition = (consumes ? target : source)->index;
    std::uint32_t& sum = weights_[{transition, !consumes, place}];
    if (sum > largest_pnml_number - weight) {
      out_.error("E425", positions_.of(arc), "the weights of parallel arcs are too large in sum");
      return;
    }
    sum += weight;
  }

  /// Whether tokens are taken or put. false: it is another kind of arc, which has been said.
  bool is_plain(const xml_node& arc) {
    std::string kind = arc.attribute("type").value();
    for (const char* name : {"type", "arctype"})
      if (const xml_node type = child(arc, name)) {
        const std::optional<Value> value = value_of(type);
        if (!value) return false;
        if (trimmed(value->text) != "normal") kind = trimmed(value->text);
      }
    const std::string_view interval = arc.attribute("inscription").value();
    if (kind == "timed" && !is_any_time(interval)) {
      vocabulary_.refuse(
          "E429", "interval", positions_.of(arc),
          "the interval " + in_quotes(interval) + " of an arc: place/transition nets have no time",
          "without invariants and intervals it can be read");
      return false;
    }
    if (kind.empty() || kind == "normal" || kind == "timed") return true;
    vocabulary_.refuse_arc(kind, arc, positions_.of(arc));
    return false;
  }

  /// TAPAAL has the weight beside the inscription, which is an interval of time or 1.
  std::uint32_t weight_of(const xml_node& arc) {
    const pugi::xml_attribute weight = arc.attribute("weight"), inscription = arc.attribute("inscription");
    const std::string_view text = inscription.value();
    const bool says_nothing =
        !inscription || is_any_time(text) || (weight && (text == "1" || text == weight.value()));
    if (says_nothing) return number(arc, "inscription", weight, "weight", 1, 1);
    if (weight) {
      vocabulary_.refuse("E428", "weight and inscription", positions_.of(arc),
                         "the weight " + in_quotes(weight.value()) + " and the inscription " +
                             in_quotes(text) + " of an arc disagree",
                         "keep one");
      return 1;
    }
    return number(arc, "inscription", inscription, "weight", 1, 1);
  }

  std::optional<Element> end_of(const xml_node& arc, const char* side) {
    const std::string_view id = arc.attribute(side).value();
    const auto found = elements_.find(std::string(id));
    if (found == elements_.end()) {
      out_.error(
          "E426", positions_.of(arc),
          "the " + std::string(side) + " of this arc, " + in_quotes(id) + ", is no place or transition");
      return std::nullopt;
    }
    return resolved(found->second);
  }

  static bool is_reference(const Element& element) {
    return element.kind == Element::Kind::reference_place ||
           element.kind == Element::Kind::reference_transition;
  }

  /// The end of a chain of references. A chain is followed once; then every link stores its end.
  std::optional<Element> resolved(Element element) {
    std::vector<std::uint32_t> chain;
    std::unordered_set<std::uint32_t> seen;
    std::optional<Element> end = element;
    while (end && is_reference(*end)) {
      if (const auto known = resolutions_.find(end->index); known != resolutions_.end()) {
        end = known->second;
        break;
      }
      chain.push_back(end->index);
      end = seen.insert(end->index).second ? target_of(*end) : circular(end->index);
    }
    for (const std::uint32_t link : chain) resolutions_.emplace(link, end);
    return end;
  }

  std::optional<Element> circular(std::uint32_t reference) {
    out_.error("E427", references_[reference].span, "this reference leads back to itself");
    return std::nullopt;
  }

  std::optional<Element> target_of(const Element& element) {
    const Reference& reference = references_[element.index];
    const auto target = elements_.find(reference.target);
    if (target == elements_.end()) {
      out_.error(
          "E427", reference.span,
          "this reference leads to " + in_quotes(reference.target) + ", which is no place or transition");
      return std::nullopt;
    }
    const auto of_place = [](const Element& one) {
      return one.kind == Element::Kind::place || one.kind == Element::Kind::reference_place;
    };
    if (of_place(element) != of_place(target->second)) {
      out_.error("E427", reference.span,
                 of_place(element) ? "this reference place refers to a transition"
                                   : "this reference transition refers to a place");
      return std::nullopt;
    }
    return target->second;
  }

  Net build() {
    Net net;
    for (Place& place : places_) net.add(std::move(place));
    auto arc = weights_.begin();
    for (std::uint32_t transition = 0; transition < transitions_.size(); ++transition) {
      std::vector<Arc> ends[2];
      for (; arc != weights_.end() && arc->first.transition == transition; ++arc)
        ends[arc->first.produces].push_back({PlaceId{arc->first.place}, arc->second});
      net.add(std::move(transitions_[transition]), ends[0], ends[1]);
    }
    return net;
  }

  struct ArcKey {
    std::uint32_t transition;
    bool produces;
    std::uint32_t place;
    auto operator<=>(const ArcKey&) const = default;
  };

  diagnostics::Diagnostics& out_;
  Positions positions_;
  PnmlVocabulary vocabulary_;
  std::unordered_map<std::string, Element> elements_;
  std::vector<Place> places_;
  std::vector<Transition> transitions_;
  std::vector<std::string> place_ids_, transition_ids_;
  std::vector<Reference> references_;
  // References that have been followed; empty if the end does not exist, which has been reported.
  std::unordered_map<std::uint32_t, std::optional<Element>> resolutions_;
  std::vector<xml_node> arcs_;
  std::map<ArcKey, std::uint32_t> weights_;
};

}  // namespace

std::optional<Net> read_pnml(diagnostics::Diagnostics& out) { return Reader(out).result(); }

}  // namespace tessera::net
