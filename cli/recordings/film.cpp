#include "cli/recordings/film.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cli/recordings/film_file.hpp"
#include "cli/terminal.hpp"
#include "project/files/chosen_world.hpp"
#include "project/files/file_names.hpp"
#include "project/files/simulation_file.hpp"
#include "project/files/world_check.hpp"
#include "project/launch.hpp"
#include "project/verification/pipeline.hpp"
#include "replay/robots.hpp"
#include "report/film.hpp"

namespace tessera::cli {

using namespace project;

namespace {

namespace fs = std::filesystem;

constexpr int frames_per_s = 25;

/// The facts about a recording that are needed before drawing.
struct Survey {
  std::string system;
  Recording::Scene scene;
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max(), last_ns = 0;
  std::array<double, 3> least{}, greatest{};  ///< of the positions of all parts of robots, in the shown time
  std::vector<BodyPose> last;                 ///< poses
  struct Alarm {
    std::int64_t time_ns;
    std::string text;
  };
  std::vector<Alarm> alarms;  ///< failed checks
  /// Time of the first entry, if the beginning of the recording is gone.
  std::optional<std::int64_t> begins_late_ns;
};

[[nodiscard]] std::int64_t nanoseconds_of(double seconds) {
  return static_cast<std::int64_t>(std::clamp(seconds * 1e9, -9e18, 9e18));
}

/// "NAME: at 12.400 s, ..." of a failed check.
[[nodiscard]] Survey::Alarm alarm_of(const Recording::Entry& entry) {
  const std::size_t at = entry.text.find(": at ");
  std::int64_t time_ns = entry.event.time_ns;
  double time_s = 0;
  if (at != std::string::npos) {
    const char* const begin = entry.text.data() + at + 5;
    if (std::from_chars(begin, entry.text.data() + entry.text.size(), time_s).ec == std::errc{})
      time_ns = nanoseconds_of(time_s);
  }
  return {time_ns, "failed: " + entry.text};
}

[[nodiscard]] Survey survey(const std::string& recording, std::int64_t from_ns, std::int64_t to_ns) {
  Survey found;
  replay::PoseReader reader(recording);
  std::vector<std::size_t> parts;
  bool has_entries = false;
  while (const Recording::Entry* const entry = reader.next()) {
    const Event& event = entry->event;
    if (!std::exchange(has_entries, true) && lacks_beginning(*reader.header()))
      found.begins_late_ns = event.time_ns;
    if (event.kind() == Event::Kind::fault && event.instance() == system_instance &&
        event.version == static_cast<std::uint32_t>(Fault::assertion))
      found.alarms.push_back(alarm_of(*entry));
    if (event.kind() != Event::Kind::poses || reader.poses().empty()) continue;
    if (found.scene.bodies.empty()) {
      found.scene = *reader.header()->scene;
      found.system = reader.header()->system;
      parts = replay::parts_of_robots(found.scene);
    }
    if (event.time_ns > to_ns && found.first_ns <= found.last_ns) continue;
    const bool first = found.first_ns > found.last_ns;
    if (event.time_ns < from_ns) {
      found.last = reader.poses();
      continue;
    }
    found.first_ns = std::min(found.first_ns, event.time_ns);
    found.last_ns = std::max(found.last_ns, event.time_ns);
    found.last = reader.poses();
    for (const std::size_t part : parts)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double here = found.last[part].position_m[axis];
        const bool begins = first && part == parts.front();
        found.least[axis] = begins ? here : std::min(found.least[axis], here);
        found.greatest[axis] = begins ? here : std::max(found.greatest[axis], here);
      }
  }
  if (!has_entries)
    throw std::runtime_error(fmt::format("'{}' is no recording of Tessera, or it is empty", recording));
  if (found.scene.bodies.empty())
    throw std::runtime_error(
        "the recording has no poses of bodies: its run had no simulated world of MuJoCo, or an older Tessera "
        "made it\n"
        "hint: `tessera simulate` records them if `simulation` names a world");
  if (found.last.empty() || found.first_ns > found.last_ns)
    throw std::runtime_error("nothing of the recording is between --from and --to");
  return found;
}

[[nodiscard]] PictureOptions view_of(const Survey& found, int width, int height) {
  PictureOptions picture;
  picture.width = width;
  picture.height = height;
  for (const Recording::Scene::Body& body : found.scene.bodies) picture.bodies.push_back(body.name);
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    picture.middle_m[axis] = (found.least[axis] + found.greatest[axis]) / 2;
    square += std::pow((found.greatest[axis] - found.least[axis]) / 2, 2);
  }
  constexpr double around_m = 0.35;  // robots have a size of their own
  picture.radius_m = std::sqrt(square) * 1.05 + around_m;
  return picture;
}

template <class T>
[[nodiscard]] T needed(Result<T> result) {
  if (!result) throw std::runtime_error(result.problem());
  return std::move(*result);
}

/// Even numbers from 16 on. nullopt: it is not a size.
[[nodiscard]] std::optional<std::pair<int, int>> size_of(const std::string& text) {
  int width = 0, height = 0;
  const char* const end = text.data() + text.size();
  const auto [x, problem] = std::from_chars(text.data(), end, width);
  if (problem != std::errc{} || x == end || *x != 'x') return std::nullopt;
  const auto [rest, other] = std::from_chars(x + 1, end, height);
  if (other != std::errc{} || rest != end) return std::nullopt;
  const auto fits = [](int pixels) { return pixels >= 16 && pixels <= 2048 && pixels % 2 == 0; };
  return fits(width) && fits(height) ? std::optional(std::pair(width, height)) : std::nullopt;
}

// ---------------------------------------------------------------------------------------------- the frames

/// The poses of a recording at ascending times.
class PoseTimes {
 public:
  explicit PoseTimes(const std::string& recording) : reader_(recording) {}
  [[nodiscard]] const std::vector<BodyPose>& at(std::int64_t time_ns) {
    while (!ended_ && next_ns_ <= time_ns) {
      if (!next_.empty()) now_ = std::move(next_);
      advance();
    }
    return now_.empty() ? next_ : now_;
  }

 private:
  void advance() {
    next_.clear();
    while (const Recording::Entry* const entry = reader_.next()) {
      if (entry->event.kind() != Event::Kind::poses || reader_.poses().empty()) continue;
      next_ = reader_.poses();
      next_ns_ = entry->event.time_ns;
      return;
    }
    ended_ = true;
  }
  replay::PoseReader reader_;
  std::vector<BodyPose> now_, next_;
  std::int64_t next_ns_ = std::numeric_limits<std::int64_t>::min();
  bool ended_ = false;
};

[[nodiscard]] report::Caption caption_at(const Survey& found, std::int64_t time_ns, double speed) {
  report::Caption caption;
  caption.title = found.system;
  caption.time = fmt::format("{:.2f} s", static_cast<double>(time_ns) * 1e-9);
  if (speed != 1) caption.time += fmt::format("   {:g} x", speed);
  for (const Survey::Alarm& alarm : found.alarms)
    if (alarm.time_ns <= time_ns) caption.alarms.push_back(alarm.text);
  return caption;
}

[[nodiscard]] std::optional<Problem> write_film(const FilmOptions& options, const Survey& found,
                                                WorldPainter& painter, int width, int height) {
  const std::string ending = ending_of(options.file);
  const auto length_s = static_cast<double>(found.last_ns - found.first_ns) * 1e-9;
  const auto count = static_cast<std::size_t>(length_s / options.speed * frames_per_s) + 1;
  FilmFile file(options.file, ending);
  const report::FilmSink sink = [&](std::string_view bytes) { return file.write(bytes); };
  const bool is_png = ending == ".png" || ending == ".apng";
  const std::unique_ptr<report::FilmWriter> writer =
      is_png ? report::apng_writer(count, frames_per_s, sink)
             : report::y4m_writer(width, height, frames_per_s, sink);
  PoseTimes poses(options.recording);
  report::Frame frame{width, height, std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width * height))};
  bool good = true;
  for (std::size_t number = 0; good && number < count; ++number) {
    const std::int64_t time_ns =
        found.first_ns + nanoseconds_of(static_cast<double>(number) * options.speed / frames_per_s);
    painter.paint(poses.at(time_ns), frame.rgb);
    report::put_caption(frame, caption_at(found, time_ns, options.speed));
    good = writer->add(frame);
    if (isatty(STDERR_FILENO) != 0 && number % frames_per_s == 0)
      fmt::print(stderr, "\r\033[Kframe {} of {}", number, count);
  }
  if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r\033[K");
  good = good && writer->finish();
  if (std::optional<Problem> problem = file.finish(good)) return problem;
  fmt::print("{}: {} frames, {:.1f} s of the run\n", options.file, count, length_s);
  return std::nullopt;
}

}  // namespace

WorldOptions world_of_recording(const std::string& recording, const std::string& spec) {
  if (spec.empty()) {
    const fs::path folder =
        fs::is_directory(recording) ? fs::path(recording) : fs::path(recording).parent_path();
    if (const auto world = world_of_run(folder / file_names::simulation)) return *world;
    throw std::runtime_error(
        fmt::format("there is no {} beside the recording, which says what its world was\nhint: name the "
                    "specification of the run "
                    "with --spec",
                    file_names::simulation));
  }
  const std::optional<Specification> specification = read(spec, terminal());
  if (!specification) throw std::runtime_error("the world of the recording is not known");
  const auto& simulation = specification->model.simulation;
  if (!simulation || !simulation->has_world())
    throw std::runtime_error("the specification names no world under `simulation`");
  if (simulation->coppelia)
    throw std::runtime_error(
        "the world of the specification is a scene of CoppeliaSim, which cannot be drawn");
  const auto world = world_of(*simulation, specification->project);
  if (!world) throw std::runtime_error("there is no world " + simulation->world);
  WorldOptions options = world->options;
  if (const std::optional<Floor> floor = floor_of(*specification, LaunchOptions{})) {
    options.track = floor->image.string();
    options.metres_per_pixel = floor->metres_per_pixel;
  }
  return options;
}

report::Frame poster_of(const std::string& recording, const WorldOptions& world, int width, int height) {
  const Survey found = survey(recording, 0, std::numeric_limits<std::int64_t>::max());
  const auto painter = needed(open_painter(world, view_of(found, width, height)));
  report::Frame frame{width, height, std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width * height))};
  painter->paint(found.last, frame.rgb);
  return frame;
}

int make_film(const FilmOptions& options) {
  const std::string ending = ending_of(options.file);
  if (!is_known_ending(ending))
    return complain(fmt::format("'{}' is no name of a film: it ends in .mp4, .webm, .gif, .png or .y4m",
                                options.file)),
           usage;
  const auto size = size_of(options.size);
  if (!size)
    return complain(fmt::format(
               "'{}' is no size of a film: two even numbers from 16 to 2048, such as 960x540", options.size)),
           usage;
  if (!(options.speed > 0) || !std::isfinite(options.speed))
    return complain("--speed is a number above 0"), usage;
  check_film_file(options.file, ending);
  const Survey found =
      survey(options.recording, nanoseconds_of(options.from_s), nanoseconds_of(options.to_s));
  const WorldOptions world = world_of_recording(options.recording, options.spec);
  PictureOptions picture = view_of(found, size->first, size->second);
  picture.camera = options.camera;
  const auto painter = needed(open_painter(world, picture));
  if (found.begins_late_ns && nanoseconds_of(options.from_s) < *found.begins_late_ns)
    fmt::print(stderr, "note: the recording: {}\n", note_on_lost_beginning(found.begins_late_ns));
  const std::optional<Problem> problem = write_film(options, found, *painter, size->first, size->second);
  return problem ? complain(problem->text) : ok;
}

}  // namespace tessera::cli
