#include "codegen/shared_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include "codegen/cpp_text.hpp"

namespace tessera::codegen {
namespace {

using net::Arc;
using net::Net;
using net::PlaceId;
using net::TransitionId;

/// A list in braces; end(arc) is the text of one end.
template <class End>
std::string ends(std::span<const Arc> arcs, End end) {
  std::vector<std::string> all;
  for (const Arc& arc : arcs) all.push_back(end(arc.place));
  return fmt::format("{{{}}}", fmt::join(all, ", "));
}

/// The rows of the memory of one channel, and of its medium.
struct Form {
  std::vector<std::string> words;  ///< the names of the places
  std::string places, medium;
};

class ChannelTables {
 public:
  explicit ChannelTables(const Net& net)
      : net_(net), forms_(net.parts().channels.size()), numbers_(net.places().size()) {
    for (std::uint32_t index = 0; index < net.places().size(); ++index)
      if (net.places()[index].fused()) add(PlaceId{index});
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
      if (const TransitionId id{index}; is_of_medium(net[id].role)) add(id);
  }

  void write(SharedTables& tables) {
    for (const Form& form : forms_)
      tables.of_channel.push_back({name(form, form.places, "memory", "FusedPlace", tables.channels),
                                   name(form, form.medium, "medium", "MediumTransition", tables.channels)});
  }

 private:
  [[nodiscard]] std::string_view local(std::string_view name, net::ChannelId channel) const {
    return name.substr(net_.parts()[channel].size() + 1);
  }

  void add(PlaceId id) {
    const net::Place& place = net_[id];
    Form& form = forms_[place.channel];
    numbers_[id.value] = form.words.size();
    const std::string name(local(place.name, place.channel));
    form.words.push_back(name);
    form.places += fmt::format("{}{{{}, {}, tessera::PlaceRole::{}}}", form.places.empty() ? "" : ", ",
                               string_literal(name), place.tokens, name_of(place.role));
  }

  void add(TransitionId id) {
    const net::ChannelId channel = net_.channel_of(id);
    const auto number = [&](PlaceId place) { return std::to_string(numbers_[place.value]); };
    const auto word = [&](PlaceId place) { return std::string(local(net_[place].name, channel)); };
    const auto words = [&](std::span<const Arc> arcs) {
      std::vector<std::string> all;
      for (const Arc& arc : arcs) all.push_back(word(arc.place));
      return fmt::format("{}", fmt::join(all, ", "));
    };
    std::string& rows = forms_[channel].medium;
    rows += fmt::format("{}{{{}, tessera::Step::{}, {}, {}}},  // {} -> {}\n", rows.empty() ? "" : "    ",
                        string_literal(local(net_[id].name, channel)), name_of(net_[id].role),
                        ends(net_.preset(id), number), ends(net_.postset(id), number), words(net_.preset(id)),
                        words(net_.postset(id)));
  }

  /// The name of the table with these rows, which is defined if it is the first one. It is made of the names
  /// of the places, and numbered if another table has it.
  std::string name(const Form& form, const std::string& rows, std::string_view what, std::string_view type,
                   std::string& definitions) {
    if (rows.empty()) return {};
    const auto [found, is_new] = names_.try_emplace(rows);
    if (!is_new) return found->second;
    std::string name = fmt::format("{}_{}", what, fmt::join(form.words, "_"));
    if (name.size() > longest_name) name = what;
    found->second = name;
    for (int number = 2; !taken_.insert(found->second).second; ++number)
      found->second = fmt::format("{}_{}", name, number);
    definitions += fmt::format("const tessera::{} {}[] = {{\n    {}}};\n", type, found->second, rows);
    return found->second;
  }

  static constexpr std::size_t longest_name = 50;
  const Net& net_;
  Numbered<net::ChannelId, Form> forms_;
  std::vector<std::size_t> numbers_;  // per place: of a fused one in the memory of its channel
  std::map<std::string, std::string> names_;
  std::set<std::string> taken_;
};

/// The net of a page above the subsystems: its places and transitions, and the places where the pages in it
/// are entered.
class UpperPage {
 public:
  UpperPage(const Net& net, net::Layer layer, net::AgentId agent) : net_(net) {
    for (std::uint32_t index = 0; index < net.places().size(); ++index)
      if (net.places()[index].layer == layer && net.places()[index].agent == agent)
        places_.push_back({index});
    if (agent.valid()) prefix_ = net.parts()[agent].size() + 1;
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
      const net::Transition& transition = net.transitions()[index];
      if (transition.layer == layer && transition.agent == agent && !is_of_medium(transition.role))
        transitions_.push_back({index});
    }
  }

  [[nodiscard]] std::string definition(std::string_view name) const {
    std::string places, transitions;
    std::size_t in = 0, out = 0;
    for (std::size_t place = 0; place < places_.size(); ++place) {
      const net::Place& its = net_[places_[place]];
      if (its.role == PlaceRole::input) in = place;
      if (its.role == PlaceRole::output) out = place;
      places += fmt::format("{}{{{}, {}}}", places.empty() ? "" : ", ",
                            string_literal(std::string_view(its.name).substr(prefix_)), its.tokens);
    }
    for (const TransitionId id : transitions_)
      transitions += fmt::format("{}{{{}, tessera::Step::{}, {}, {}}}", transitions.empty() ? "" : ",\n    ",
                                 string_literal(std::string_view(net_[id].name).substr(prefix_)),
                                 name_of(net_[id].role), list(net_.preset(id)), list(net_.postset(id)));
    return fmt::format(
        "constexpr tessera::PagePlace {0}_places[] = {{{1}}};\n"
        "const tessera::PageTransition {0}_transitions[] = {{\n    {2}}};\n"
        "const tessera::UpperPage {0}_page{{{0}_places, {0}_transitions, {3}, {4}}};\n",
        name, places, transitions, in, out);
  }

 private:
  /// The ends of one kind in all pages below are one: there are as many of them as pages.
  [[nodiscard]] std::string list(std::span<const Arc> arcs) const {
    std::vector<std::string> all;
    for (const Arc& arc : arcs) {
      const auto own = std::ranges::find(places_, arc.place);
      std::string end = own != places_.end()                       ? std::to_string(own - places_.begin())
                        : net_[arc.place].role == PlaceRole::input ? "tessera::entries"
                                                                   : "tessera::exits";
      if (all.empty() || all.back() != end) all.push_back(std::move(end));
    }
    return fmt::format("{{{}}}", fmt::join(all, ", "));
  }

  const Net& net_;
  std::size_t prefix_ = 0;  // of names: the path of the page and a full stop
  std::vector<PlaceId> places_;
  std::vector<TransitionId> transitions_;
};

}  // namespace

SharedTables shared_tables(const Net& net) {
  SharedTables tables;
  ChannelTables(net).write(tables);
  tables.pages = UpperPage(net, net::Layer::system, {}).definition("system") +
                 UpperPage(net, net::Layer::agent, net::AgentId{0}).definition("agent");
  return tables;
}

}  // namespace tessera::codegen
