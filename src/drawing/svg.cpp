#include <algorithm>
#include <array>
#include <cstdio>

#include "drawing/layout.hpp"
#include "net/counts.hpp"
#include "net/xml_text.hpp"

namespace tessera::drawing {
namespace {

constexpr double margin = 24;
constexpr double title_height = 40;
constexpr double legend_row = 26;
constexpr double least_width = 460;

struct Tint {
  const char *fill, *stroke;
};
constexpr std::array<Tint, net::layer_count> tints{{{"#f5f7fa", "#9aa5b1"},
                                                    {"#eaf2fb", "#7b9cc4"},
                                                    {"#ebf6ee", "#79ab87"},
                                                    {"#fdf6e6", "#c9a94f"},
                                                    {"#f7eefa", "#ae86bd"}}};

constexpr const char* style =
    "<style>\n"
    "text{font-family:'DejaVu Sans',Verdana,Helvetica,Arial,sans-serif;fill:#1f2933;paint-order:stroke;"
    "white-space:pre;stroke:#fff;stroke-width:3px;stroke-opacity:.85;stroke-linejoin:round}\n"
    ".name{font-size:12px}.detail{font-size:10px;fill:#3d6b35}.condition{font-size:10px;fill:#2450a4}\n"
    ".frame{font-size:12px;font-weight:600;stroke:none;fill:#52606d}.title{font-size:16px;font-weight:600}\n"
    ".subtitle,.legend{font-size:11px;fill:#616e7c}.count{font-size:11px;font-weight:600;text-anchor:middle}"
    "\n"
    ".place{fill:#fff;stroke:#1f2933;stroke-width:1.4}.ring{fill:none;stroke:#1f2933;stroke-width:1.2}\n"
    ".fused{fill:#fffbf0;stroke:#b4540a;stroke-dasharray:4 2.5}.token{fill:#1f2933}\n"
    ".bar{fill:#1f2933}.arc{fill:none;stroke:#52606d;stroke-width:1.1;marker-end:url(#tip)}\n"
    ".never{fill:#b8c2cc}.failure{fill:#fff;stroke:#8693a0}.arc.faint{stroke:#c5ced6;fill:none;marker-end:"
    "url(#faint-tip)}text.faint{fill:#"
    "8693a0}\n"
    ".arc.memory{stroke:#d09a63;marker-end:url(#memory-tip)}\n"
    "</style>\n";

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  std::string short_text = text;
  if (short_text.ends_with(".0")) short_text.resize(short_text.size() - 2);
  return short_text;
}

std::string at(double x, double y) { return "x=\"" + number(x) + "\" y=\"" + number(y) + "\""; }

/// The runs of a label as tspans. A subscript after a superscript is drawn under it, as in the paper.
std::string spans(const Label& label, double font_size) {
  std::string text;
  double shift = 0;    // current shift of the baseline
  double advance = 0;  // advance that is due after a stacked pair
  for (std::size_t index = 0; index < label.runs.size(); ++index) {
    const Label::Run& run = label.runs[index];
    const double level = run.level == Label::Level::raised    ? -0.42 * font_size
                         : run.level == Label::Level::lowered ? 0.24 * font_size
                                                              : 0;
    double dx = advance;
    advance = 0;
    if (index > 0 && run.level == Label::Level::lowered &&
        label.runs[index - 1].level == Label::Level::raised) {
      const double small = font_size * script_scale * 0.92;
      const double above = width_of(label.runs[index - 1].text, small), below = width_of(run.text, small);
      dx = -above;
      advance = std::max(0.0, above - below);
    }
    text += "<tspan";
    if (dx != 0) text += " dx=\"" + number(dx) + "\"";
    if (level != shift) text += " dy=\"" + number(level - shift) + "\"";
    if (run.level != Label::Level::base) text += " font-size=\"" + number(font_size * script_scale) + "\"";
    if (run.italic) text += " font-style=\"italic\"";
    text += ">" + net::xml_text(run.text) + "</tspan>";
    shift = level;
  }
  return text;
}

class SvgPen {
 public:
  SvgPen(const Picture& picture, const Layout& layout) : picture_(picture), layout_(layout) {}

  std::string result() {
    width_ = std::max(layout_.width, least_width) + 2 * margin;
    left_ = (width_ - layout_.width) / 2;
    top_ = margin + title_height;
    const std::string legend = legend_rows();
    const double height = top_ + layout_.height + margin + rows_ * legend_row + margin / 2;
    std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" xml:space=\"preserve\" width=\"" +
                      number(width_) + "\" height=\"" + number(height) + "\" viewBox=\"0 0 " +
                      number(width_) + " " + number(height) + "\">\n";
    svg += style;
    svg += tip("tip", "#52606d") + tip("faint-tip", "#c5ced6") + tip("memory-tip", "#bb7430");
    svg += "<rect width=\"100%\" height=\"100%\" fill=\"#fdfdfc\"/>\n";
    add_title();
    text_ += "<g transform=\"translate(" + number(left_) + " " + number(top_) + ")\">\n";
    for (std::size_t index = 0; index < picture_.frames.size(); ++index) add_frame(index);
    for (std::size_t index = 0; index < picture_.arrows.size(); ++index) add_arrow(index);
    for (std::size_t index = 0; index < picture_.bars.size(); ++index) add_bar(index);
    for (std::size_t index = 0; index < picture_.circles.size(); ++index) add_circle(index);
    text_ += "</g>\n<g transform=\"translate(" + number(margin) + " " +
             number(top_ + layout_.height + margin) + ")\">\n" + legend + "</g>\n";
    return svg + text_ + "</svg>\n";
  }

 private:
  static std::string tip(const char* id, const char* colour) {
    return std::string("<marker id=\"") + id +
           "\" viewBox=\"0 0 10 8\" refX=\"9.5\" refY=\"4\" markerWidth=\"8\" markerHeight=\"6.4\" "
           "markerUnits=\"userSpaceOnUse\" orient=\"auto\"><path d=\"M0 0L10 4L0 8L2.5 4Z\" fill=\"" +
           colour + "\"/></marker>\n";
  }

  void add_title() {
    const std::size_t pages = static_cast<std::size_t>(
        std::ranges::count_if(picture_.circles, [](const Circle& c) { return c.page; }));
    const std::size_t fused = static_cast<std::size_t>(
        std::ranges::count_if(picture_.circles, [](const Circle& c) { return c.fused; }));
    const auto counted = [](std::size_t count, const char* noun) {
      return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
    };
    std::string subtitle = std::string(net::name_of(picture_.layer)) + " layer \u00b7 " +
                           counted(picture_.circles.size() - pages - fused, "place");
    if (!picture_.frames.empty()) subtitle.erase(0, subtitle.find("\u00b7") + 3);
    if (pages > 0) subtitle += " \u00b7 " + counted(pages, "page");
    if (fused > 0) subtitle += " \u00b7 " + std::to_string(fused) + " fused";
    subtitle += " \u00b7 " + counted(picture_.bars.size(), "transition");
    add_text("title", picture_.title, margin, margin + 8, 16);
    text_ +=
        "<text class=\"subtitle\" " + at(margin, margin + 26) + ">" + net::xml_text(subtitle) + "</text>\n";
  }

  void add_frame(std::size_t index) {
    const Frame& frame = picture_.frames[index];
    const Box& box = layout_.frames[index];
    const Tint& tint = tints[static_cast<std::size_t>(frame.layer)];
    text_ += "<rect " + at(box.left, box.top) + " width=\"" + number(box.right - box.left) + "\" height=\"" +
             number(box.bottom - box.top) + "\" rx=\"8\" fill=\"" + tint.fill + "\" stroke=\"" + tint.stroke +
             "\"/>\n";
    add_text("frame", frame.name, box.left + 10, box.top + 17, Sizes::frame_font);
  }

  void add_arrow(std::size_t index) {
    const Curve& curve = layout_.arrows[index];
    if (curve.empty()) return;
    std::string path = "M" + number(curve[0].x) + " " + number(curve[0].y);
    for (std::size_t point = 1; point < curve.size(); ++point)
      path += (point % 3 == 1 ? "C" : " ") + number(curve[point].x) + " " + number(curve[point].y);
    const Arrow& arrow = picture_.arrows[index];
    std::string kind = picture_.circles[arrow.circle].fused ? " memory" : "";
    if (picture_.bars[arrow.bar].fires != Fires::by_condition) kind = " faint";
    text_ += "<path class=\"arc" + kind + "\" d=\"" + path + "\"/>\n";
  }

  void add_bar(std::size_t index) {
    const Bar& bar = picture_.bars[index];
    const Point centre = layout_.bars[index];
    text_ += "<g><title>" + net::xml_text(bar.path) + "</title>" + bar_symbol(centre, bar.fires) + "</g>\n";
    const bool faint = bar.fires != Fires::by_condition;
    add_beside(centre, bar.name, bar.details, faint ? "condition faint" : "condition",
               faint ? "name faint" : "name");
  }

  static std::string bar_symbol(Point centre, Fires fires) {
    const char* kind = fires == Fires::never ? " never" : fires == Fires::after_failure ? " failure" : "";
    return std::string("<rect class=\"bar") + kind + "\" " +
           at(centre.x - Sizes::bar_width / 2, centre.y - Sizes::bar_height / 2) + " width=\"" +
           number(Sizes::bar_width) + "\" height=\"" + number(Sizes::bar_height) + "\" rx=\"1\"/>";
  }

  void add_circle(std::size_t index) {
    const Circle& circle = picture_.circles[index];
    const Point centre = layout_.circles[index];
    text_ +=
        "<g><title>" + net::xml_text(circle.path) + "</title>" + circle_symbol(centre, circle) + "</g>\n";
    add_beside(centre, circle.name, circle.details, "detail", "name");
  }

  static std::string ring(const char* name, Point centre, double radius) {
    return std::string("<circle class=\"") + name + "\" cx=\"" + number(centre.x) + "\" cy=\"" +
           number(centre.y) + "\" r=\"" + number(radius) + "\"/>";
  }

  static std::string circle_symbol(Point centre, const Circle& circle) {
    std::string symbol = ring(circle.fused ? "place fused" : "place", centre,
                              circle.page ? Sizes::page_radius : Sizes::circle_radius);
    if (circle.page) symbol += ring("ring", centre, Sizes::page_radius - 4);
    if (circle.tokens > 3)
      return symbol + "<text class=\"count\" " + at(centre.x, centre.y + 4) + ">" +
             std::to_string(circle.tokens) + "</text>";
    for (std::uint32_t token = 0; token < circle.tokens; ++token) {
      const double offset = (double(token) - (double(circle.tokens) - 1) / 2) * 7;
      symbol += ring("token", {centre.x + offset, centre.y}, circle.tokens == 1 ? 4.5 : 3);
    }
    return symbol;
  }

  /// Name and details to the right of a symbol, as a block centred on it.
  void add_beside(Point centre, const Label& name, const std::vector<Label>& details,
                  const char* detail_class, const char* name_class) {
    const double x = centre.x + Sizes::cell / 2 + Sizes::gap / 2;
    double y = centre.y + 4 - Sizes::line * double(details.size()) / 2;
    add_text(name_class, name, x, y, Sizes::name_font);
    for (const Label& detail : details)
      add_text(detail_class, detail, x, y += Sizes::line, Sizes::detail_font);
  }

  void add_text(const std::string& classes, const Label& label, double x, double y, double font_size) {
    if (!label.empty())
      text_ += "<text class=\"" + classes + "\" " + at(x, y) + ">" + spans(label, font_size) + "</text>\n";
  }

  /// The legend of the symbols, in as many rows as the width requires.
  std::string legend_rows() {
    Circle place, page, fused, token;
    page.page = fused.fused = true;
    token.tokens = 1;
    const Point origin{16, 0};
    const std::vector<std::pair<std::string, std::string>> items{
        {circle_symbol(origin, place), "place"},
        {circle_symbol(origin, page), "page"},
        {circle_symbol(origin, fused), "fused place"},
        {circle_symbol(origin, token), "marked"},
        {bar_symbol(origin, Fires::by_condition), "transition"},
        {bar_symbol(origin, Fires::after_failure), "fires only after a failure"},
        {bar_symbol(origin, Fires::never), "never fires"},
        {"<text class=\"condition\" x=\"4\" y=\"4\">[c]</text>", "condition"}};
    std::string text;
    double x = 0, y = legend_row / 2;
    rows_ = 1;
    for (const auto& [symbol, meaning] : items) {
      const double advance = 38 + width_of(meaning, 11) + 14;
      if (x + advance > width_ - 2 * margin) {
        x = 0;
        y += legend_row;
        ++rows_;
      }
      text += "<g transform=\"translate(" + number(x) + " " + number(y) + ") scale(.8)\">" + symbol +
              "</g><text class=\"legend\" " + at(x + 32, y + 4) + ">" + meaning + "</text>\n";
      x += advance;
    }
    return text;
  }

  const Picture& picture_;
  const Layout& layout_;
  std::string text_;
  double width_ = 0, left_ = 0, top_ = 0;
  int rows_ = 1;
};

}  // namespace

std::string to_svg(const net::HierarchicalNet& net, net::PageId page, const Options& options) {
  const Picture picture = picture_of(net, page, options);
  return SvgPen(picture, lay_out(picture)).result();
}

}  // namespace tessera::drawing
