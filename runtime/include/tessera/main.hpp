#pragma once

/// Include this header only in the file with `main`: it is small, and the other headers take long to compile.
namespace tessera {

struct System;

/// The command line of a generated controller: `controller simulate|run [options]`, see --help. Returns
/// the exit code of the process.
[[nodiscard]] int controller_main(const System& system, int argc, char** argv);

}  // namespace tessera
