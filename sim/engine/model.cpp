#include "sim/engine/model.hpp"

#include <array>
#include <cstdio>
#include <mutex>
#include <utility>

#include "sim/engine/complaint.hpp"
#include "sim/engine/engine_message.hpp"

namespace tessera::sim {
namespace {

/// Empty: a run can use this time step.
std::string problem_with_time_step(double step_s) {
  constexpr double shortest_s = 1e-6, longest_s = 0.1;
  if (step_s > longest_s) return "the time step is longer than 0.1 s";
  if (step_s >= shortest_s) return {};
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "the time step is %g s; it must be 1 us (1e-6 s) or longer",
                step_s);
  return text.data();
}

}  // namespace

Result<ModelPtr> load_model(const std::string& mjcf, const mjVFS* files) {
  static std::mutex loading;  // the engine's parser keeps global state
  const std::scoped_lock lock(loading);
  catch_complaints();
  std::array<char, 1024> message{};
  ModelPtr model;
  std::string complaint = complaint_of([&] {
    model.reset(mj_loadXML(mjcf.c_str(), files, message.data(), static_cast<int>(message.size())));
  });
  if (model && complaint.empty()) complaint = problem_with_time_step(model->opt.timestep);
  if (model && complaint.empty()) return model;
  if (complaint.empty()) complaint = message.data();
  return Problem{mjcf + ": " + explained(complaint)};
}

}  // namespace tessera::sim
