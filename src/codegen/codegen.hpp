#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spec/model/model.hpp"
#include "verify/verify.hpp"

namespace tessera::codegen {

/// A line of a generated file whose text stands in the specification.
struct SourceLine {
  std::uint32_t line = 0;  ///< of the generated file
  std::uint32_t spec_line = 0;
  std::uint32_t column = 0;  ///< in the specification, of the text that begins in column 1
};

/// A file of the project, in memory.
struct File {
  std::string path;  ///< relative to the folder of its kind
  std::string text;
  std::vector<SourceLine> lines = {};  ///< ascending; empty for Lines::marked
};

/// The place of the lines of conditions, for messages of the compiler.
enum class Lines : std::uint8_t {
  marked,  ///< in the source, as #line: for builds whose messages nobody translates
  listed   ///< in File::lines: a source does not change when its conditions move in the specification
};

/// The controller that executes exactly `net`: headers, tables and bindings to the user's functions, plus the
/// CMakeLists.txt that builds them. Paths are relative to `.tessera/generated`.
///
/// spec_path: the name of the specification in messages of the compiler about conditions (Lines::marked).
/// Threads:   pure; same input, same bytes. Linear in the net.
/// Source:    paper, sec. V-B: places, transitions, arcs and pages to C++.
[[nodiscard]] std::vector<File> generate(const verify::VerifiedNet& net, const spec::Model& model,
                                         const std::string& spec_path, Lines lines = Lines::marked);

/// A transition function the user has to write.
struct Stub {
  std::string file;       ///< relative to the project: "src/control.cpp"
  std::string function;   ///< "follow"
  std::string subsystem;  ///< "robot.control"
  std::string space;      ///< its namespace: "line_follower::robot::control"
  std::string signature;  ///< "void follow(Context& context, const Inputs& in, Memory& memory, Outputs& out)"
  std::string preamble;   ///< what a new file starts with: includes and the opening namespace
  std::string body;       ///< the whole definition, ready to paste into that namespace
  std::string closing;    ///< what a new file ends with
};

/// One per behaviour of each definition: void NAME(Context&, const Inputs&, Memory&, Outputs&).
[[nodiscard]] std::vector<Stub> stubs(const spec::Model& model);

}  // namespace tessera::codegen
