#include "drawing/layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "drawing/child.hpp"

namespace tessera::drawing {
namespace {

/// More than a person can read, and than dot lays out in a minute.
constexpr std::size_t most_nodes = 2500;

struct Size {
  double width = 0, height = 0;
};

Size text_size(const Label& name, const std::vector<Label>& details) {
  Size size{width_of(name, Sizes::name_font), Sizes::line * (1.0 + double(details.size()))};
  for (const Label& detail : details) size.width = std::max(size.width, width_of(detail, Sizes::detail_font));
  return {std::ceil(size.width + Sizes::gap), std::ceil(size.height) + (details.size() > 1 ? 14 : 6)};
}

std::string cell(const char* attributes, double width, double height) {
  char text[160];
  std::snprintf(text, sizeof text, "<TD %sFIXEDSIZE=\"TRUE\" WIDTH=\"%d\" HEIGHT=\"%d\"></TD>", attributes,
                int(width), int(height));
  return text;
}

/// A graph of boxes with the size of symbol and text. Its edges meet at the symbol (port s).
class Graph {
 public:
  explicit Graph(const Picture& picture) : picture_(picture) {}

  std::string result() {
    text_ =
        "digraph g {\n"
        "graph [rankdir=TB, nodesep=0.25, ranksep=0.22, fontname=\"Helvetica\", fontsize=12, labeljust=l, "
        "margin=12];\n"
        "node [shape=plain];\n"
        "edge [dir=none, headclip=false, tailclip=false];\n";
    add_frame({});
    for (std::size_t index = 0; index < picture_.arrows.size(); ++index) add_arrow(index);
    return std::move(text_) + "}\n";
  }

 private:
  void add_frame(FrameId frame) {
    for (std::size_t index = 0; index < picture_.circles.size(); ++index)
      if (const Circle& circle = picture_.circles[index]; circle.frame == frame)
        add_node("p" + std::to_string(index), Sizes::cell, text_size(circle.name, circle.details));
    for (std::size_t index = 0; index < picture_.bars.size(); ++index)
      if (const Bar& bar = picture_.bars[index]; bar.frame == frame)
        add_node("t" + std::to_string(index), 2 * Sizes::bar_height, text_size(bar.name, bar.details));
    for (std::uint32_t index = 0; index < picture_.frames.size(); ++index) {
      if (picture_.frames[index].parent != frame) continue;
      text_ += "subgraph cluster_" + std::to_string(index) + " { label=\"" +
               std::string(picture_.frames[index].name.plain().size(), 'n') + "\";\n";
      add_frame({index});
      text_ += "}\n";
    }
  }

  void add_node(const std::string& name, double symbol_height, Size text) {
    text_ += name + " [label=<<TABLE BORDER=\"0\" CELLBORDER=\"0\" CELLSPACING=\"0\" CELLPADDING=\"0\"><TR>" +
             cell("PORT=\"s\" ", Sizes::cell, symbol_height) + cell("", text.width, text.height) +
             "</TR></TABLE>>];\n";
  }

  /// The main direction is downwards, from the bottom to the top of the symbols. Texts stand to the right
  /// of the symbols, so arrows that go back run on the left; dot treats them as leading down, too. In
  /// nested frames, fused places have no rank in the main direction.
  void add_arrow(std::size_t index) {
    const Arrow& arrow = picture_.arrows[index];
    const std::string circle = "p" + std::to_string(arrow.circle), bar = "t" + std::to_string(arrow.bar);
    std::string edge = bar + ":s:s -> " + circle + ":s:n";
    if (arrow.to_bar) edge = circle + ":s:s -> " + bar + ":s:n";
    if (arrow.back) edge = circle + ":s:w -> " + bar + ":s:w";
    const bool fused = picture_.circles[arrow.circle].fused;
    const bool way = !fused && !arrow.back;
    text_ += edge + " [id=" + std::to_string(index) + ", weight=" + (way ? "8" : "1") +
             (fused && !picture_.frames.empty() ? ", constraint=false" : "") + "];\n";
  }

  const Picture& picture_;
  std::string text_;
};

/// Reads positions out of dot's answer, whose y axis points upwards.
class Reader {
 public:
  Reader(const Picture& picture, const std::string& answer) : picture_(picture) {
    json_ = nlohmann::json::parse(answer);
    const std::vector<double> bounds = numbers(json_.at("bb"));
    layout_.width = bounds.at(2);
    layout_.height = bounds.at(3);
    layout_.circles.resize(picture.circles.size());
    layout_.bars.resize(picture.bars.size());
    layout_.arrows.resize(picture.arrows.size());
    layout_.frames.resize(picture.frames.size());
  }

  Layout result() {
    if (json_.contains("objects"))
      for (const auto& object : json_["objects"]) read_object(object);
    if (json_.contains("edges"))
      for (const auto& edge : json_["edges"]) read_arrow(edge);
    return std::move(layout_);
  }

 private:
  /// "1.5,2 3,4" as 1.5, 2, 3, 4.
  static std::vector<double> numbers(std::string text) {
    std::ranges::replace(text, ',', ' ');
    std::vector<double> all;
    const char* at = text.c_str();
    for (char* end = nullptr;; at = end) {
      const double number = std::strtod(at, &end);
      if (end == at) return all;
      all.push_back(number);
    }
  }

  [[nodiscard]] Point point(double x, double y) const { return {x, layout_.height - y}; }

  void read_object(const nlohmann::json& object) {
    const std::string name = object.at("name");
    if (name.starts_with("cluster_")) {
      const std::vector<double> bounds = numbers(object.at("bb"));
      const Point low = point(bounds.at(0), bounds.at(1)), high = point(bounds.at(2), bounds.at(3));
      layout_.frames.at(std::stoul(name.substr(8))) = {low.x, high.y, high.x, low.y};
      return;
    }
    const std::vector<double> position = numbers(object.at("pos"));
    const double width = 72 * std::stod(object.at("width").get<std::string>());
    const Point symbol = point(position.at(0) - width / 2 + Sizes::cell / 2, position.at(1));
    (name[0] == 'p' ? layout_.circles : layout_.bars).at(std::stoul(name.substr(1))) = symbol;
  }

  void read_arrow(const nlohmann::json& edge) {
    const std::size_t index = std::stoul(edge.at("id").get<std::string>());
    const Arrow& arrow = picture_.arrows.at(index);
    Curve curve;
    const std::vector<double> all = numbers(edge.at("pos"));
    for (std::size_t at = 0; at + 1 < all.size(); at += 2) curve.push_back(point(all[at], all[at + 1]));

    const Point centre = layout_.circles[arrow.circle];
    const double radius = picture_.circles[arrow.circle].page ? Sizes::page_radius : Sizes::circle_radius;
    const auto in_circle = [&](Point at) {
      return std::hypot(at.x - centre.x, at.y - centre.y) <= radius + 1;
    };
    Point bar = layout_.bars[arrow.bar];
    if (arrow.back)
      bar.x -= Sizes::bar_width / 2;
    else
      bar.y += (arrow.to_bar ? -1 : 1) * Sizes::bar_height / 2;
    // dot ends the curve at the edge of a symbol's cell; this leads it on to the symbol.
    if (arrow.to_bar || arrow.back) curve = reversed(std::move(curve));
    curve = cut_at_end(reversed(extended(reversed(extended(std::move(curve), centre)), bar)), in_circle);
    if (arrow.to_bar) curve = reversed(std::move(curve));
    layout_.arrows.at(index) = std::move(curve);
  }

  const Picture& picture_;
  nlohmann::json json_;
  Layout layout_;
};

}  // namespace

Layout lay_out(const Picture& picture) {
  if (const std::size_t nodes = picture.circles.size() + picture.bars.size(); nodes > most_nodes)
    throw LayoutError("a picture of " + std::to_string(nodes) +
                      " places and transitions is too large to read; draw one page");
  const std::string answer = run_dot(Graph(picture).result());
  try {
    return Reader(picture, answer).result();
  } catch (const std::exception& problem) {
    throw LayoutError(std::string("graphviz's 'dot' gave an answer we cannot read: ") + problem.what());
  }
}

}  // namespace tessera::drawing
