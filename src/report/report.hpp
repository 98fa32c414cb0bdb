#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/trace.hpp"
#include "sim/track.hpp"
#include "tessera/recording.hpp"

namespace tessera::report {

/// What a robot did on a floor.
struct DrivenPath {
  sim::Track floor;
  sim::Skeleton line;  ///< may be empty; the report then shows no error
  sim::Trace trace;
  sim::LineMetrics metrics;  ///< of line and trace
};

struct SubsystemFigures {
  std::string path;  ///< "robot.control"
  std::uint64_t iterations = 0, overruns = 0, errors = 0;
};

struct Verdict {
  std::string property;  ///< "safe"
  std::string result;    ///< "holds", "violated", "unknown"; holds is shown as good, violated as bad
  std::string note;      ///< may be empty
};

/// The content of a report. Unknown parts stay empty and are left out of the page.
struct ReportInput {
  Recording recording;
  std::optional<DrivenPath> drive;
  std::string robots;  ///< "rover, rover_2": there is no drive because several robots move; empty: one
  double simulated_s = 0, wall_s = 0;
  std::uint64_t firings = 0;
  std::string ended;                         ///< why the run ended
  std::vector<SubsystemFigures> subsystems;  ///< empty: counted from the recording, without overruns
  std::vector<Verdict> verdicts;
};

/// Near the beginning of every page, so that a page of somebody else's is told from one.
inline constexpr std::string_view generator_tag = R"(<meta name="generator" content="Tessera">)";

struct File {
  std::string name;  ///< "index.html", "path.png"
  std::string bytes;
};

/// "Several robots move in this world (rover, rover_2): ...", in one sentence.
[[nodiscard]] std::string several_robots(const std::string& names);

/// A page without external parts (pictures inline, no scripts, no network; light and dark, suitable
/// for printing), and with a drive the picture of the path over the floor: index.html and path.png.
/// All text from outside is escaped, and data that is no text is not shown. The same input gives the
/// same bytes. Memory and size stay bounded for long runs and large fleets: curves and time lines
/// are thinned to what a page can show; of many subsystems the first ones are shown, and of many
/// messages the most important ones.
///
/// Errors:  none of its own; throws std::bad_alloc.
/// Threads: pure.
[[nodiscard]] std::vector<File> render(const ReportInput& input);

}  // namespace tessera::report
