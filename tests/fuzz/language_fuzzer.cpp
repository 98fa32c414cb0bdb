#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "language/language.hpp"
#include "language/names/sources.hpp"

namespace {

const tessera::language::Grammar& grammar() {
  static const tessera::language::Grammar the = [] {
    std::ostringstream text;
    text << std::ifstream(TESSERA_SOURCE_DIR "/share/tessera/spec.schema.json").rdbuf();
    return tessera::language::Grammar(text.str());
  }();
  return the;
}

}  // namespace

/// Whatever the text, every question has an answer, and its ranges lie in the text.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera::language;
  if (size < 2 || size > 20000) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 2, size - 2);
  const Document document(text, grammar());
  const std::size_t offset = (static_cast<std::size_t>(data[0]) * 256 + data[1]) % (text.size() + 1);
  const Position at = document.lines().position(offset);
  for (const Use& use : document.index().uses())
    if (use.extent.begin > use.extent.end || use.extent.end > text.size()) std::abort();
  for (const Proposal& one : complete(document, at))
    if (one.range.end < one.range.start || one.insert.empty()) std::abort();
  (void)explain(document, at);
  (void)definition(document, at, {});
  (void)references(document, nullptr, at, {}, true);
  (void)fixes(document, {at, at}, {});
  (void)headings(document);
  (void)uses_in_code(document.index(), text);
  (void)uses_in_parameter_file(document.index(), text);
  (void)uses_in_layout_file(document.index(), text);
  return 0;
}
