#include "net/pnml_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "net/pnml_elements.hpp"
#include "net/pnml_labels.hpp"
#include "net/pnml_vocabulary.hpp"

namespace tessera::net {
namespace {

using diagnostics::in_quotes;
using pugi::xml_node;

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
  explicit Reader(diagnostics::Diagnostics& out)
      : out_(out), positions_(out.text()), vocabulary_(out), labels_(out, positions_, vocabulary_) {}

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
      if (!labels_.is_read(PnmlOwner::document, candidate)) continue;
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
      if (!labels_.is_read(stack.size() > 1 ? PnmlOwner::page : PnmlOwner::net, node)) continue;
      const std::string_view kind = name_of(node);
      if (kind == "page") {
        vocabulary_.judge(PnmlOwner::page, node, positions_.of(node));
        stack.push_back(node.first_child());
      } else {
        add(node, kind);
      }
    }
  }

  void add(const xml_node& node, std::string_view kind) {
    if (kind == "place") {
      enter(node, {Element::Kind::place, static_cast<std::uint32_t>(places_.size())});
      judge(PnmlOwner::place, node);
      Place place;
      place.name = PnmlLabels::name(node);
      place.tokens = labels_.marking(node);
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
      transition.name = PnmlLabels::name(node);
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
      if (!labels_.is_read(owner, part)) continue;
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
    if (!labels_.is_plain(arc)) return;
    const std::uint32_t weight = labels_.weight(arc);
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
  PnmlPositions positions_;
  PnmlVocabulary vocabulary_;
  PnmlLabels labels_;
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
