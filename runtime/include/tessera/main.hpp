#pragma once

/// For the file with the function `main` alone: the other headers would take most of the time of its compilation.
namespace tessera {

struct System;

/// The command line of a generated controller: `controller simulate|run [options]`, see --help. Returns
/// the exit code of the process.
[[nodiscard]] int controller_main(const System& system, int argc, char** argv);

}  // namespace tessera
