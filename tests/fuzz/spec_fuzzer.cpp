#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "spec/parser.hpp"

/// For any text, the parser gives a model or reports the mistakes, and can show them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tessera::diagnostics::Diagnostics out("fuzz.yaml", std::string(reinterpret_cast<const char*>(data), size));
  const auto model = tessera::spec::parse(out);
  if (model.has_value() == out.has_errors()) std::abort();
  if (render(out).empty() && !model) std::abort();
  if (render_json(out).empty()) std::abort();
  if (!model) return 0;
  for (const auto& channel : model->channels) {
    if (model->channel_name(channel).empty()) std::abort();
  }
  return 0;
}
