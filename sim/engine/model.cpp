#include "sim/engine/model.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <utility>

#include "sim/engine/complaint.hpp"
#include "sim/engine/engine_message.hpp"
#include "sim/engine/not_a_number.hpp"

namespace tessera::sim {
namespace {

/// Why no run can use this time step.
std::optional<Problem> problem_with_time_step(double step_s) {
  constexpr double shortest_s = 1e-6, longest_s = 0.1;
  if (step_s > longest_s) return Problem{"the time step is longer than 0.1 s"};
  if (step_s >= shortest_s) return std::nullopt;
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "the time step is %g s; it must be 1 us (1e-6 s) or longer",
                step_s);
  return Problem{text.data()};
}

/// Why it is no file that can be read. Reading a pipe would wait for ever.
std::optional<Problem> problem_with_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code problem;
  const fs::file_status status = fs::status(path, problem);
  if (!fs::exists(status)) return Problem{"there is no such file"};
  if (fs::is_directory(status)) return Problem{"is a folder; name the file in it"};
  if (!fs::is_regular_file(status)) return Problem{"is no regular file"};
  if (fs::file_size(path, problem) == 0 && !problem) return Problem{"the file is empty"};
  return std::nullopt;
}

/// The engine refuses what is not a number, but takes what is infinite.
std::optional<Problem> problem_with_sensors(const mjModel& model) {
  for (int id = 0; id < model.nsensor; ++id) {
    const bool good = std::isfinite(model.sensor_noise[id]) && std::isfinite(model.sensor_cutoff[id]);
    const char* const name = mj_id2name(&model, mjOBJ_SENSOR, id);
    if (!good)
      return Problem{"the `noise` or `cutoff` of sensor '" + std::string(name == nullptr ? "" : name) +
                     "' is infinite"};
  }
  return std::nullopt;
}

/// A NaN may also be in a file that this one includes.
std::string place_of_nan(const std::string& mjcf) {
  std::ifstream file(mjcf, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return not_a_number_in(text).value_or("a number is NaN, here or in a file that is included");
}

}  // namespace

Result<ModelPtr> load_model(const std::string& mjcf, const mjVFS* files) {
  if (const std::optional<Problem> problem = files == nullptr ? problem_with_file(mjcf) : std::nullopt)
    return Problem{mjcf + ": " + problem->text};
  static std::mutex loading;  // the engine's parser keeps global state
  const std::scoped_lock lock(loading);
  catch_complaints();
  std::array<char, 1024> message{};
  ModelPtr model;
  std::optional<Problem> complaint = complaint_of([&] {
    model.reset(mj_loadXML(mjcf.c_str(), files, message.data(), static_cast<int>(message.size())));
  });
  if (model && !complaint) complaint = problem_with_time_step(model->opt.timestep);
  if (model && !complaint) complaint = problem_with_sensors(*model);
  if (model && !complaint) return model;
  if (!complaint) return Problem{mjcf + ": " + explained(message.data())};
  if (files == nullptr && complaint->text.find("contains a 'NaN'") != std::string::npos)
    complaint = Problem{place_of_nan(mjcf)};
  return Problem{mjcf + ": " + explained(complaint->text)};
}

}  // namespace tessera::sim
