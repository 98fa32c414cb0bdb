#include <nlohmann/json.hpp>

#include "diagnostics/diagnostics.hpp"

namespace tessera::diagnostics {
namespace {

const char* word(Severity severity) {
  switch (severity) {
    case Severity::error:
      return "error";
    case Severity::warning:
      return "warning";
    case Severity::note:
      break;
  }
  return "note";
}

}  // namespace

std::string render_json(const Diagnostics& diagnostics) {
  auto list = nlohmann::ordered_json::array();
  for (const Diagnostic& one : diagnostics.sorted()) {
    list.push_back({{"severity", word(one.severity)},
                    {"code", one.code},
                    {"file", diagnostics.file_of(one.span.line)},
                    {"line", diagnostics.sources().at(one.span.line).line},
                    {"column", one.span.column},
                    {"length", one.span.length},
                    {"message", one.message},
                    {"hint", one.hint}});
  }
  // The messages quote the user's bytes, and those need not be UTF-8.
  return list.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace tessera::diagnostics
