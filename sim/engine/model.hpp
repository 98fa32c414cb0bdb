#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "tessera/result.hpp"

namespace tessera::sim {

struct ReleaseModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct ReleaseData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPtr = std::unique_ptr<mjModel, ReleaseModel>;
using DataPtr = std::unique_ptr<mjData, ReleaseData>;

/// Compiles a model. files: files that the engine finds in memory; nullptr: all are on disk.
///
/// Errors: the file is missing, empty, no regular file or no valid MJCF, its time step is not between 1 us and
///         100 ms, or the noise of a sensor is infinite.
///         The text begins with the name of the file.
/// Threads: any; calls run one after the other, because the engine's parser has global state.
[[nodiscard]] Result<ModelPtr> load_model(const std::string& mjcf, const mjVFS* files = nullptr);

}  // namespace tessera::sim
