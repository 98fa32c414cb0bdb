#include "drawing/picture.hpp"
#include "net/xml_text.hpp"

namespace tessera::drawing {
namespace {

/// A label in graphviz's HTML-like language.
std::string html(const Label& label) {
  std::string text;
  for (const Label::Run& run : label.runs) {
    std::string part = net::xml_text(run.text);
    if (run.italic) part = "<I>" + part + "</I>";
    if (run.level == Label::Level::raised) part = "<SUP>" + part + "</SUP>";
    if (run.level == Label::Level::lowered) part = "<SUB>" + part + "</SUB>";
    text += part;
  }
  return text;
}

std::string beside(const Label& name, const std::vector<Label>& details) {
  std::string text = "<" + html(name);
  for (const Label& detail : details) text += "<BR/><FONT POINT-SIZE=\"8\">" + html(detail) + "</FONT>";
  return text + ">";
}

std::string dots(std::uint32_t tokens) {
  if (tokens > 3) return std::to_string(tokens);
  std::string text;
  for (std::uint32_t token = 0; token < tokens; ++token) text += "\u25cf";
  return text;
}

class DotPen {
 public:
  explicit DotPen(const Picture& picture) : picture_(picture) {}

  std::string result() {
    text_ =
        "digraph net {\n"
        "  graph [rankdir=TB, nodesep=0.7, ranksep=0.35, forcelabels=true, fontname=\"Helvetica\", "
        "fontsize=11,\n"
        "         style=rounded, color=\"#9aa5b1\", labeljust=l];\n"
        "  node [fontname=\"Helvetica\", fontsize=10];\n"
        "  edge [arrowsize=0.6, color=\"#52606d\"];\n";
    add_frame({}, "  ");
    for (const Arrow& arrow : picture_.arrows) add_arrow(arrow);
    return std::move(text_) + "}\n";
  }

 private:
  void add_frame(FrameId frame, const std::string& indent) {
    for (std::uint32_t index = 0; index < picture_.circles.size(); ++index)
      if (picture_.circles[index].frame == frame) add_circle(index, indent);
    for (std::uint32_t index = 0; index < picture_.bars.size(); ++index)
      if (picture_.bars[index].frame == frame) add_bar(index, indent);
    for (std::uint32_t index = 0; index < picture_.frames.size(); ++index) {
      if (picture_.frames[index].parent != frame) continue;
      text_ += indent + "subgraph cluster_" + std::to_string(index) + " {\n" + indent + "  label=<" +
               html(picture_.frames[index].name) + ">;\n";
      add_frame({index}, indent + "  ");
      text_ += indent + "}\n";
    }
  }

  void add_circle(std::uint32_t index, const std::string& indent) {
    const Circle& circle = picture_.circles[index];
    text_ += indent + "p" + std::to_string(index) + " [shape=" + (circle.page ? "doublecircle" : "circle") +
             ", width=0.32, fixedsize=true, label=\"" + dots(circle.tokens) +
             "\", xlabel=" + beside(circle.name, circle.details) + (circle.fused ? ", style=dashed" : "") +
             "];\n";
  }

  static const char* colour(Fires fires) {
    switch (fires) {
      case Fires::by_condition:
        return "black";
      case Fires::after_failure:
        return "\"#ffffff\", color=\"#8693a0\"";
      case Fires::never:
        return "\"#cbd2d9\"";
    }
    return "black";
  }

  void add_bar(std::uint32_t index, const std::string& indent) {
    const Bar& bar = picture_.bars[index];
    text_ +=
        indent + "t" + std::to_string(index) +
        " [shape=box, width=0.4, height=0.05, fixedsize=true, style=filled, fillcolor=" + colour(bar.fires) +
        ", label=\"\", xlabel=" + beside(bar.name, bar.details) + "];\n";
  }

  void add_arrow(const Arrow& arrow) {
    const std::string circle = "p" + std::to_string(arrow.circle), bar = "t" + std::to_string(arrow.bar);
    text_ += "  " + (arrow.to_bar ? circle + " -> " + bar : bar + " -> " + circle) +
             (arrow.back ? " [constraint=false]" : "") + ";\n";
  }

  const Picture& picture_;
  std::string text_;
};

}  // namespace

std::string to_dot(const net::HierarchicalNet& net, net::PageId page, const Options& options) {
  return DotPen(picture_of(net, page, options)).result();
}

}  // namespace tessera::drawing
