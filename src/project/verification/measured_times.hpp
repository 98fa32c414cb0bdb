#pragma once

#include <filesystem>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::project {

/// Finds the distributions of `takes: { measured: run.tsr, within: ... }` in the recordings: those of all calls of the
/// behaviour that have not failed, in any subsystem that has it.
///
/// project: the folder of the specification, to which the names of recordings are relative.
/// Errors: E385 a recording that cannot be read, is of a simulated run, or does not have the behaviour, or calls of it
///         that are not within the given times. false after one of them. W343 too few calls.
///
/// Threads: any. Each recording is read once until its file changes.
bool read_measured_times(spec::Model& model, const std::filesystem::path& project,
                         diagnostics::Diagnostics& out);

}  // namespace tessera::project
