#pragma once

#include <string>

#include "project/build/compiler_messages.hpp"
#include "project/build/transition_functions.hpp"
#include "spec/model/model.hpp"

namespace tessera::project {

/// A mistake in C++ in terms of the project.
struct CppMistake {
  std::string code;     ///< E500 - E509; E500: only the compiler explains it
  std::string message;  ///< one line
  std::string hint;     ///< may be empty
};

/// The form of a driver in C++, as a hint.
inline constexpr const char* driver_rule =
    "a receptor derives from tessera::Receptor<T> with `std::optional<T> read() override`, an effector "
    "from tessera::Effector<T> with `bool write(const T&) override`; T is the type of the real buffer";

/// The meaning of a compiler error in a project with that model.
[[nodiscard]] CppMistake understand(const CompilerError& error, const spec::Model& model,
                                    const TransitionFunctions& functions);

}  // namespace tessera::project
