#pragma once

#include "diagnostics/diagnostics.hpp"

namespace YAML {
class Exception;
}

namespace tessera::spec {

/// Reports what yaml-cpp found in words that help: E007 for nesting, otherwise E005.
void report_syntax_error(const YAML::Exception& problem, diagnostics::Diagnostics& out);

}  // namespace tessera::spec
