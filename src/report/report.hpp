#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "replay/times/ages.hpp"
#include "report/frame.hpp"
#include "report/paths.hpp"
#include "report/plots.hpp"
#include "sim/trace.hpp"
#include "sim/track.hpp"
#include "tessera/recording.hpp"

namespace tessera::report {

/// The drive of a robot over a floor.
struct DrivenPath {
  sim::Track floor;
  sim::Skeleton line;  ///< may be empty; the report then shows no error
  sim::Trace trace;
  sim::LineMetrics metrics;  ///< of line and trace
  bool is_whole = true;  ///< false: the beginning is not recorded, so the metrics are not those of the run
};

/// A picture of the world.
struct Poster {
  Frame picture;
  double time_s = 0;
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

/// How old the readings were that the commands of a chain acted on.
struct ChainTimes {
  struct Measured {
    replay::MeasuredTimes times{};
    std::optional<std::int64_t> bound_ns{};  ///< proved
  };
  std::string name;
  std::uint64_t chains = 1;  ///< that are measured together
  Measured age{}, reaction{};
  std::string no_bound{};  ///< why; empty: there is one
  std::string left_out{};  ///< by the measured times; may be empty
};

/// Calls of one behaviour that took longer than its `takes`.
struct SlowCalls {
  std::string behaviour;  ///< "robot.control.follow"
  std::uint64_t slow = 0, calls = 0;
  std::int64_t declared_ns = 0, longest_ns = 0, longest_at_ns = 0;
};

/// The content of a report. Unknown parts stay empty and are left out of the page.
struct ReportInput {
  Recording recording;
  std::optional<DrivenPath> drive;
  /// For a simulated world: the positions of the robots. Without poses in the recording, the page says so.
  std::optional<RunPaths> paths;
  std::optional<sim::Track> floor;  ///< under the paths of several robots
  std::optional<Poster> poster;
  std::string why_no_poster;        ///< empty: there is one, or no world
  std::vector<JudgedCurve> judged;  ///< checks and measures
  double simulated_s = 0, wall_s = 0;
  std::uint64_t firings = 0;
  std::string ended;                         ///< why the run ended
  std::vector<SubsystemFigures> subsystems;  ///< empty: counted from the recording, without overruns
  std::vector<Verdict> verdicts;
  std::vector<ChainTimes> chains{};
  std::vector<SlowCalls> slow_calls{};
};

/// It is near the beginning of every page and distinguishes it from pages of other programs.
inline constexpr std::string_view generator_tag = R"(<meta name="generator" content="Tessera">)";

struct File {
  std::string name;  ///< "index.html", "path.png", "poster.png"
  std::string bytes;
};

/// A page without external parts (pictures inline, no scripts, no network; light and dark, suitable
/// for printing): index.html. With a drive also the picture of the path over the floor, path.png, and with a
/// poster that one, poster.png.
/// All text from outside is escaped, and data that is no text is not shown. The same input gives the
/// same bytes. Memory and size stay bounded for long runs and large fleets: curves and time lines
/// are thinned to what a page can show; of many subsystems the first ones are shown, and of many
/// messages the most important ones.
///
/// Errors:  none of its own; throws std::bad_alloc.
/// Threads: pure.
[[nodiscard]] std::vector<File> render(const ReportInput& input);

}  // namespace tessera::report
