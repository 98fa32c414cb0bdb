#include "sim/engine/model.hpp"

#include <array>
#include <mutex>
#include <utility>

#include "sim/engine/complaint.hpp"

namespace tessera::sim {

Result<ModelPtr> load_model(const std::string& mjcf, const mjVFS* files) {
  static std::mutex loading;  // the engine's parser keeps global state
  const std::scoped_lock lock(loading);
  catch_complaints();
  std::array<char, 1024> message{};
  ModelPtr model;
  std::string complaint = complaint_of([&] {
    model.reset(mj_loadXML(mjcf.c_str(), files, message.data(), static_cast<int>(message.size())));
  });
  if (model && complaint.empty() && model->opt.timestep > 0.1)
    complaint = "the time step is longer than 0.1 s";
  if (model && complaint.empty()) return model;
  if (complaint.empty()) complaint = message.data();
  return Problem{mjcf + ": " + complaint};
}

}  // namespace tessera::sim
