#pragma once

#include <stdexcept>
#include <string>

#include "net/net.hpp"
#include "spec/model/model.hpp"

/// Pictures of nets in the paper's graphic language: a circle is a place, a double circle a page, a bar a
/// transition, a dot a token. Conditions are in square brackets; fused places are dashed.
namespace tessera::drawing {

struct TreeOptions {
  bool colour = false;           ///< ANSI colours
  unsigned levels = UINT32_MAX;  ///< number of levels below the system to show
};

/// The pages as an indented tree with box-drawing characters, each with its numbers
/// of places and transitions.
[[nodiscard]] std::string tree(const net::HierarchicalNet& net, const TreeOptions& options = {});

/// The labels beside the nodes.
enum class Notation : std::uint8_t {
  paths,  ///< names of the specification
  paper   ///< the paper's symbols, see paper_labels.hpp
};

struct Options {
  Notation notation = Notation::paths;
  const spec::Model* model = nullptr;  ///< of the net; Notation::paper needs it
  /// How many levels of pages below the drawn one are replaced by their nets, in nested rectangles. 0: the
  /// page as one sheet, with double circles; `all` for the root: the flat net.
  unsigned levels = 0;
  static constexpr unsigned all = UINT32_MAX;
};

/// One page, or with `levels` its contents, as a graph for graphviz.
///
/// Precondition: net.pages contains page; model is given for Notation::paper.
[[nodiscard]] std::string to_dot(const net::HierarchicalNet& net, net::PageId page,
                                 const Options& options = {});

/// Thrown if a picture cannot be laid out: the program `dot` is missing or failed, or there
/// are too many nodes to read.
struct LayoutError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The same as an SVG picture, laid out by graphviz's `dot`, which runs as a child process.
///
/// Throws LayoutError.
[[nodiscard]] std::string to_svg(const net::HierarchicalNet& net, net::PageId page,
                                 const Options& options = {});

/// The whole net for programs: pages with their nodes and transitions, fusion sets, the flat net with the
/// origin of every element, and the counts. Indices refer to the arrays of the same object.
///
/// indent: of nested lines, in spaces; -1: all on one line.
[[nodiscard]] std::string to_json(const net::HierarchicalNet& pages, const net::Net& net, int indent = 1);

/// The same for the page of the studio, on one line: agents that are alike are written once, as `FoldedNet` of
/// share/tessera/net.schema.json says. Ten thousand agents of one template take 5 MB instead of 420.
///
/// Precondition: made by layers::build and net::flatten.
[[nodiscard]] std::string to_folded_json(const net::HierarchicalNet& pages, const net::Net& net);

}  // namespace tessera::drawing
