#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "net/pnml.hpp"
#include "net/pnml_reader.hpp"

/// For every text, the reader returns a net or an error; and writing and reading preserves the net.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using tessera::diagnostics::Diagnostics;
  Diagnostics out("fuzz.pnml", std::string(reinterpret_cast<const char*>(data), size));
  const auto net = tessera::net::read_pnml(out);
  if (net.has_value() == out.has_errors()) std::abort();
  if (!net && render(out).empty()) std::abort();
  if (!net) return 0;
  Diagnostics written("again.pnml", to_pnml(*net));
  const auto again = tessera::net::read_pnml(written);
  if (!again || again->places().size() != net->places().size()) std::abort();
  if (again->transitions().size() != net->transitions().size()) std::abort();
  if (again->arc_count() != net->arc_count()) std::abort();
  return 0;
}
