#include "net/pnml.hpp"

#include <utility>

#include "net/xml_text.hpp"

namespace tessera::net {
namespace {

std::string labelled(const char* element, const std::string& text) {
  return std::string("<") + element + "><text>" + text + "</text></" + element + ">";
}

class Writer {
 public:
  explicit Writer(const Net& net) : net_(net) {}

  std::string result(const PnmlOptions& options) {
    text_ +=
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<pnml xmlns=\"http://www.pnml.org/version-2009/grammar/pnml\">\n"
        "  <net id=\"net\" type=\"http://www.pnml.org/version-2009/grammar/ptnet\">\n    " +
        labelled("name", xml_text(options.name)) + "\n    <page id=\"page\">\n";
    for (std::uint32_t place = 0; place < net_.places().size(); ++place) add_place(place);
    for (std::uint32_t transition = 0; transition < net_.transitions().size(); ++transition)
      text_ += "      <transition id=\"t" + std::to_string(transition) + "\">" +
               labelled("name", xml_text(net_.transitions()[transition].name)) + "</transition>\n";
    for (std::uint32_t transition = 0; transition < net_.transitions().size(); ++transition)
      add_arcs(transition);
    text_ += "    </page>\n  </net>\n</pnml>\n";
    return std::move(text_);
  }

 private:
  void add_place(std::uint32_t index) {
    const Place& place = net_.places()[index];
    text_ += "      <place id=\"p" + std::to_string(index) + "\">" + labelled("name", xml_text(place.name));
    if (place.tokens > 0) text_ += labelled("initialMarking", std::to_string(place.tokens));
    text_ += "</place>\n";
  }

  void add_arcs(std::uint32_t transition) {
    const std::string bar = "t" + std::to_string(transition);
    for (const Arc& arc : net_.preset(TransitionId{transition}))
      add_arc("p" + std::to_string(arc.place.value), bar, arc.weight);
    for (const Arc& arc : net_.postset(TransitionId{transition}))
      add_arc(bar, "p" + std::to_string(arc.place.value), arc.weight);
  }

  void add_arc(const std::string& source, const std::string& target, std::uint32_t weight) {
    text_ += "      <arc id=\"a" + std::to_string(arcs_++) + "\" source=\"" + source + "\" target=\"" +
             target + "\"";
    if (weight == 1)
      text_ += "/>\n";
    else
      text_ += ">" + labelled("inscription", std::to_string(weight)) + "</arc>\n";
  }

  const Net& net_;
  std::string text_;
  std::size_t arcs_ = 0;
};

}  // namespace

std::string to_pnml(const Net& net, const PnmlOptions& options) { return Writer(net).result(options); }

}  // namespace tessera::net
