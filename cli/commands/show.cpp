#include <fmt/core.h>
#include <unistd.h>

#include "cli/commands/commands.hpp"
#include "cli/launch.hpp"
#include "cli/terminal.hpp"
#include "drawing/drawing.hpp"
#include "net/counts.hpp"
#include "project/verification/pipeline.hpp"
#include "tessera/nearest.hpp"

namespace tessera::cli {

using namespace project;

namespace {

struct ShowOptions {
  std::string spec = ".", page, notation = "paths", svg, dot, json;
  unsigned levels = 0;
  bool counts = false;
};

std::vector<std::string> page_paths(const net::HierarchicalNet& pages) {
  std::vector<std::string> paths;
  for (std::uint32_t page = 0; page < pages.pages.size(); ++page)
    paths.push_back(pages.path(net::PageId{page}));
  return paths;
}

// Without --page: the whole system in nested rectangles.
drawing::Options picture_options(const ShowOptions& options, const spec::Model& model) {
  drawing::Options picture;
  picture.model = &model;
  picture.notation = options.notation == "paper" ? drawing::Notation::paper : drawing::Notation::paths;
  picture.levels = options.levels > 0 ? options.levels : options.page.empty() ? drawing::Options::all : 0;
  return picture;
}

void print_counts(const net::Counts& counts) {
  fmt::print("{:<14}{:>8}{:>13}{:>8}\n", "layer", "places", "transitions", "pages");
  for (std::size_t layer = 0; layer < net::layer_count; ++layer)
    fmt::print("{:<14}{:>8}{:>13}{:>8}\n", net::name_of(static_cast<net::Layer>(layer)),
               counts.layers[layer].places, counts.layers[layer].transitions, counts.layers[layer].pages);
  fmt::print("flat: {} places ({} fused), {} transitions, {} arcs\n", counts.places, counts.fused,
             counts.transitions, counts.arcs);
}

// Writes one or two pictures, if they are requested.
bool draw(const ShowOptions& options, const Specification& specification, const Nets& nets,
          net::PageId page) {
  const drawing::Options picture = picture_options(options, specification.model);
  if (!options.svg.empty()) write_output(options.svg, drawing::to_svg(nets.pages, page, picture));
  if (!options.dot.empty()) write_output(options.dot, drawing::to_dot(nets.pages, page, picture));
  return !options.svg.empty() || !options.dot.empty();
}

int show_command(const ShowOptions& options) {
  std::optional<Specification> specification = read(options.spec, terminal());
  if (!specification) return exit_code_without_net();
  const std::optional<Nets> nets = build(*specification, terminal());
  if (!nets) return failed;
  const net::PageId page = nets->pages.find(options.page);
  if (!page.valid())
    return complain(with_hint("there is no page '" + options.page + "'",
                              did_you_mean(options.page, page_paths(nets->pages))));
  const bool drawn = draw(options, *specification, *nets, page);
  if (options.counts) {
    const net::Counts counts = net::count(nets->pages, nets->flat);
    if (options.json.empty())
      print_counts(counts);
    else
      write_output(options.json, net::to_json(counts) + "\n");
  } else if (!options.json.empty()) {
    write_output(options.json, drawing::to_json(nets->pages, nets->flat) + "\n");
  } else if (!drawn) {
    drawing::TreeOptions tree;
    tree.colour = isatty(STDOUT_FILENO) != 0 && colour();
    if (options.levels > 0) tree.levels = options.levels;
    fmt::print("{}", drawing::tree(nets->pages, tree));
  }
  return ok;
}

}  // namespace

void add_show(CommandLine& app) {
  Subcommand command = app.add("show", "Show the hierarchical Petri net: as a tree, a drawing or numbers");
  ShowOptions& options = command.runs(show_command);
  declare_specification(command, options.spec);
  command.option("--page", options.page,
                 "Path of one page, e.g. robot.control.follow (default: the whole system)");
  command.option("--svg", options.svg, "Draw to this file (- is standard output)");
  command.option("--dot", options.dot, "Draw for graphviz to this file");
  command.option(
      "--levels", options.levels,
      "How many levels of pages below the drawn one to open (default: all of the system, none of a page)");
  command.option("--notation", options.notation, "Labels: paths, or the paper's symbols")
      .one_of({"paths", "paper"})
      .shows_default();
  command.flag("--counts", options.counts, "Numbers of places, transitions, pages and arcs");
  command.option("--json", options.json,
                 "The net, or with --counts the numbers, as JSON (- is standard output)");
  command.footer(
      "Examples:\n"
      "  tessera show                                         the tree of pages\n"
      "  tessera show --page robot.control.follow --svg follow.svg\n"
      "  tessera show --svg net.svg --notation paper\n"
      "  tessera show --counts --json -");
}

}  // namespace tessera::cli
