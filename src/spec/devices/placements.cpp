#include "spec/devices/placements.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "diagnostics/utf8.hpp"
#include "spec/agents/paths.hpp"
#include "spec/document/names.hpp"
#include "spec/document/section.hpp"
#include "spec/values/quantities.hpp"
#include "tessera/nearest.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;
using Point = std::array<double, 3>;

constexpr std::uint32_t most_things = 10'000;

/// The subject of an entry.
struct Members {
  std::string name;
  bool is_agent = false, indexed = false;
  std::uint32_t first = 0, count = 1;

  [[nodiscard]] std::string instance(std::uint32_t number) const {
    return indexed ? name + "[" + std::to_string(first + number) + "]" : name;
  }
};

/// A square grid, filled row by row.
struct Grid {
  Point at{};
  std::uint32_t columns = 1;
  double spacing_m = 1;

  [[nodiscard]] Point point(std::uint32_t number) const {
    return {at[0] + spacing_m * static_cast<double>(number % columns),
            at[1] + spacing_m * static_cast<double>(number / columns), at[2]};
  }
};

/// The models of which the first stands at the angle `from`, the others to the left of it, as seen from the centre.
struct Circle {
  Point at{};
  double radius_m = 1, from_rad = 0;

  [[nodiscard]] double angle(std::uint32_t number, std::uint32_t count) const {
    return from_rad + 2 * std::numbers::pi * number / count;
  }
  [[nodiscard]] Point point(double angle) const {
    return {at[0] + radius_m * std::cos(angle), at[1] + radius_m * std::sin(angle), at[2]};
  }
};

/// One point for each member, one for all, or none; and what is added to the heading of each.
struct Places {
  std::vector<Point> points;
  std::vector<double> turned_rad{};  ///< empty: nothing
};

class PlacementReader {
 public:
  PlacementReader(const Model& model, const AgentGroups& groups, Diagnostics& out)
      : lookup_(model, groups), out_(out) {}

  std::vector<ModelPlacement> read(const Entry& section) {
    for (const Entry& entry : entries_of(*section.value, section.span, "models", out_)) read_one(entry);
    return std::move(placements_);
  }

 private:
  void read_one(const Entry& entry) {
    const Section section(
        *entry.value, entry.span, "a placed model",
        {"model", "at", "heading", "grid", "circle", "scatter", "apart", "count", "pose", "vary"}, out_);
    if (!section.readable()) return;
    const auto members = members_of(entry, section);
    ModelPlacement common;
    common.span = entry.span;
    read_common(section, common);
    if (!members) return;
    const auto [points, turned] = read_places(section, *members);
    const std::vector<double> headings = read_headings(section, *members);
    for (std::uint32_t number = 0; number < members->count; ++number) {
      ModelPlacement one = common;
      one.instance = members->instance(number);
      one.is_agent = members->is_agent;
      if (!points.empty()) one.at_m = points[std::min<std::size_t>(number, points.size() - 1)];
      if (!headings.empty()) one.heading_rad = headings[std::min<std::size_t>(number, headings.size() - 1)];
      if (!turned.empty()) one.heading_rad += turned[number];
      if (!is_first(one)) return;
      placements_.push_back(std::move(one));
    }
  }

  std::optional<Members> members_of(const Entry& entry, const Section& section) {
    Members members;
    std::optional<Selector> selector;
    const std::size_t bracket = entry.key.find('[');
    members.name = entry.key.substr(0, bracket);
    members.indexed = bracket != std::string::npos;
    if (members.indexed) {
      const bool closed = entry.key.ends_with(']');
      if (closed)
        selector =
            read_index(std::string_view(entry.key).substr(bracket + 1, entry.key.size() - bracket - 2));
      if (!selector || selector->kind == Selector::Kind::variable) {
        out_.error("E112", entry.span, in_quotes(entry.key) + " names no agents",
                   "write robot[3] or robot[*]");
        return std::nullopt;
      }
    }
    const auto group = lookup_.groups().find(members.name);
    const bool known = group != lookup_.groups().end();
    return known ? agents(entry, section, group->second, selector, members)
                 : things(entry, section, selector, members);
  }

  std::optional<Members> agents(const Entry& entry, const Section& section, const AgentGroup& group,
                                const std::optional<Selector>& selector, Members members) {
    members.is_agent = true;
    if (const Entry* count = section.find("count"))
      out_.error("E107", count->span,
                 in_quotes(members.name) + " names agents, whose number is given under `agents`",
                 "leave out `count`");
    if (!PathLookup::check_index(selector.value_or(Selector{}), group, entry.span, entry.span, out_))
      return std::nullopt;
    if (!selector) return members;
    const bool all = selector->kind == Selector::Kind::all;
    members.first = all ? 0 : static_cast<std::uint32_t>(selector->number);
    members.count = all ? group.count : 1;
    return members;
  }

  std::optional<Members> things(const Entry& entry, const Section& section,
                                const std::optional<Selector>& selector, Members members) {
    if (!check_name(members.name, entry.span, "placed model", out_)) return std::nullopt;
    if (!selector) {
      if (const Entry* count = section.find("count"))
        out_.error("E112", count->span, "several things are named " + in_quotes(members.name + "[*]"));
      return members;
    }
    const Entry* const count = section.find("count");
    if (selector->kind != Selector::Kind::all || count == nullptr) {
      std::vector<std::string> names;
      for (const auto& [name, group] : lookup_.groups()) names.push_back(name);
      std::ranges::sort(names);
      const Hint near = did_you_mean(members.name, names);
      out_.error("E101", entry.span, "there are no agents " + in_quotes(members.name),
                 near.empty() ? "things that are no agents are named " + members.name + "[*], with a `count`"
                              : near);
      return std::nullopt;
    }
    const auto number = read_number(*count->value, count->span, "count", out_);
    if (!number) return std::nullopt;
    if (*number < 1 || *number > most_things || *number != std::floor(*number)) {
      out_.error("E206", count->value->span, "count must be a whole number from 1 to 10000");
      return std::nullopt;
    }
    members.count = static_cast<std::uint32_t>(*number);
    return members;
  }

  void read_common(const Section& section, ModelPlacement& placement) {
    const Entry* const file = section.require("model", "for example model: rover.xml");
    if (const Node* text = file == nullptr ? nullptr : text_of(*file->value, file->span, "the model", out_)) {
      placement.model = text->text;
      placement.model_span = text->span;
    }
    if (const Entry* pose = section.find("pose"))
      if (const Node* text = text_of(*pose->value, pose->span, "pose", out_, "name a keyframe of the model"))
        placement.pose = text->text;
    if (const Entry* scatter = section.find("scatter"))
      if (const Node* text =
              text_of(*scatter->value, scatter->span, "scatter", out_, "name a site of the world"))
        placement.scatter = text->text;
    if (const Entry* apart = section.find("apart")) {
      placement.apart_m = read_length(*apart->value, apart->span, "apart", out_).value_or(0);
      if (placement.apart_m < 0) out_.error("E206", apart->value->span, "apart must not be negative");
      if (section.find("scatter") == nullptr)
        out_.error("E103", apart->span, "`apart` is for models that are scattered",
                   "for example scatter: store");
    }
    if (const Entry* vary = section.find("vary")) read_vary(*vary, placement);
  }

  void read_vary(const Entry& vary, ModelPlacement& placement) {
    for (const Entry& entry : entries_of(*vary.value, vary.span, "vary", out_)) {
      const auto& ends = items_of(*entry.value, entry.span, in_quotes(entry.key), out_);
      if (!entry.value->is_sequence()) continue;
      if (ends.size() != 2) {
        out_.error("E104", entry.span, in_quotes(entry.key) + " needs the least and the most",
                   "for example box.mass: [0.04, 0.06]");
        continue;
      }
      const auto least = read_any_quantity(*ends[0], entry.span, in_quotes(entry.key), out_);
      const auto most = read_any_quantity(*ends[1], entry.span, in_quotes(entry.key), out_);
      if (!least || !most) continue;
      if (least->number > most->number)
        out_.error("E206", entry.span, "the least of " + in_quotes(entry.key) + " is more than the most");
      placement.vary.emplace(entry.key, std::pair(least->number, most->number));
    }
  }

  Places read_places(const Section& section, const Members& members) {
    const Entry *const at = section.find("at"), *const grid = section.find("grid"),
                       *const circle = section.find("circle"), *const scatter = section.find("scatter");
    const Entry* first = nullptr;
    for (const Entry* way : {at, grid, circle, scatter}) {
      if (way == nullptr) continue;
      if (first != nullptr)
        out_.error("E107", way->span, "a model is placed in one way",
                   "keep one of " + first->key + ", " + way->key);
      else
        first = way;
    }
    if (first == nullptr && members.count > 1)
      out_.error("E103", section.find("model") != nullptr ? section.find("model")->span : Span{},
                 std::to_string(members.count) + " models need places",
                 "write grid, circle, scatter, or a list for `at`");
    if (first == nullptr || first == scatter) return {};
    if (first == at) return {read_at(*at, members)};
    if (first == grid) return {read_grid(*grid, members)};
    return read_circle(*circle, members);
  }

  std::vector<Point> read_at(const Entry& at, const Members& members) {
    const Node& node = *at.value;
    if (node.is_sequence() && !node.items.empty() && node.items[0]->is_sequence()) {
      std::vector<Point> points;
      for (const Node* item : node.items)
        if (const auto point = read_point(*item, at.span)) points.push_back(*point);
      if (points.size() == node.items.size() && node.items.size() != members.count)
        out_.error(
            "E307", at.span,
            std::to_string(node.items.size()) + " places for " + std::to_string(members.count) + " models");
      return points;
    }
    const auto point = read_point(node, at.span);
    if (!point) return {};
    if (members.count > 1)
      out_.error("E307", at.span, "1 place for " + std::to_string(members.count) + " models",
                 "write grid, circle, scatter, or a list of places");
    return {*point};
  }

  std::optional<Point> read_point(const Node& node, Span at) {
    const auto& items = items_of(node, at, "a place", out_);
    if (!node.is_sequence()) return std::nullopt;
    if (items.size() != 2 && items.size() != 3) {
      out_.error("E104", at, "a place is two or three lengths",
                 "[x, y] or [x, y, z], for example [0.4, 25 cm]");
      return std::nullopt;
    }
    Point point{};
    for (std::size_t index = 0; index < items.size(); ++index) {
      const auto value = read_length(*items[index], at, index == 0 ? "x" : index == 1 ? "y" : "z", out_);
      if (!value) return std::nullopt;
      point[index] = *value;
    }
    return point;
  }

  std::vector<Point> read_grid(const Entry& entry, const Members& members) {
    const Section section(*entry.value, entry.span, "a grid", {"at", "columns", "spacing"}, out_);
    if (!section.readable()) return {};
    Grid grid;
    if (const Entry* at = section.find("at")) grid.at = read_point(*at->value, at->span).value_or(grid.at);
    if (const Entry* columns = section.require("columns", "for example columns: 5")) {
      const auto number = read_number(*columns->value, columns->span, "columns", out_);
      if (number && (*number < 1 || *number > most_things || *number != std::floor(*number)))
        out_.error("E206", columns->value->span, "columns must be a whole number from 1 to 10000");
      else if (number)
        grid.columns = static_cast<std::uint32_t>(*number);
    }
    if (const Entry* spacing = section.require("spacing", "for example spacing: 0.8 m")) {
      const auto length = read_length(*spacing->value, spacing->span, "spacing", out_);
      if (length && *length <= 0)
        out_.error("E206", spacing->value->span, "spacing must be positive");
      else
        grid.spacing_m = length.value_or(grid.spacing_m);
    }
    std::vector<Point> points;
    for (std::uint32_t number = 0; number < members.count; ++number) points.push_back(grid.point(number));
    return points;
  }

  Places read_circle(const Entry& entry, const Members& members) {
    const Section section(*entry.value, entry.span, "a circle", {"at", "radius", "from"}, out_);
    if (!section.readable()) return {};
    Circle circle;
    if (const Entry* at = section.find("at"))
      circle.at = read_point(*at->value, at->span).value_or(circle.at);
    if (const Entry* radius = section.require("radius", "for example radius: 1.2 m")) {
      const auto length = read_length(*radius->value, radius->span, "radius", out_);
      if (length && *length <= 0) out_.error("E206", radius->value->span, "radius must be positive");
      circle.radius_m = length.value_or(circle.radius_m);
    }
    if (const Entry* from = section.find("from"))
      circle.from_rad = read_angle(*from->value, from->span, "from", out_).value_or(0);
    Places places;
    for (std::uint32_t number = 0; number < members.count; ++number) {
      const double angle = circle.angle(number, members.count);
      places.points.push_back(circle.point(angle));
      places.turned_rad.push_back(
          std::remainder(angle + std::numbers::pi, 2 * std::numbers::pi));  // to the centre
    }
    return places;
  }

  std::vector<double> read_headings(const Section& section, const Members& members) {
    const Entry* const entry = section.find("heading");
    if (entry == nullptr) return {};
    std::vector<const Node*> nodes{entry->value};
    if (entry->value->is_sequence()) {
      nodes = entry->value->items;
      if (nodes.size() != members.count)
        out_.error(
            "E307", entry->span,
            std::to_string(nodes.size()) + " headings for " + std::to_string(members.count) + " models");
    }
    std::vector<double> headings;
    for (const Node* node : nodes)
      if (const auto angle = read_angle(*node, entry->span, "the heading", out_)) headings.push_back(*angle);
    return headings;
  }

  bool is_first(const ModelPlacement& placement) {
    const auto [taken, added] = lines_.emplace(placement.instance, placement.span.line);
    if (!added)
      out_.error("E308", placement.span, "a second model for " + placement.instance,
                 "the first is on " + out_.words(taken->second));
    return added;
  }

  PathLookup lookup_;
  Diagnostics& out_;
  std::vector<ModelPlacement> placements_;
  std::map<std::string, std::uint32_t> lines_;  ///< instance -> line of its model
};

}  // namespace

std::vector<ModelPlacement> read_placements(const Entry* entry, const Model& model, const AgentGroups& groups,
                                            Diagnostics& out) {
  return entry == nullptr ? std::vector<ModelPlacement>() : PlacementReader(model, groups, out).read(*entry);
}

}  // namespace tessera::spec
