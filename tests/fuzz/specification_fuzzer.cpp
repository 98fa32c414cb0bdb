#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>

#include "language/language.hpp"
#include "server/analysis/analysis.hpp"
#include "specification_mutator.hpp"

/// Specifications with mistakes that people make, through everything that `tessera check`, the language server and the
/// studio do with the text alone. A crash, a text that takes more than TESSERA_FUZZ_CPU_SECONDS of processor time, and
/// an answer that is none are findings.

namespace {

std::string schema_text() {
  std::ostringstream text;
  text << std::ifstream(TESSERA_SOURCE_DIR "/share/tessera/spec.schema.json").rdbuf();
  return text.str();
}

SpecificationMutator& mutator() {
  static SpecificationMutator the(schema_text());
  return the;
}

/// How long a text may take at most. Sanitizers and builds without optimisation take longer than the product.
double most_seconds() {
  static const double seconds = [] {
    const char* given = std::getenv("TESSERA_FUZZ_CPU_SECONDS");
    return given == nullptr ? 20.0 : std::atof(given);
  }();
  return seconds;
}

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// Whether a fleet of the text is so large that it takes long by right.
bool has_large_fleet(const std::string& text) {
  for (std::size_t at = text.find("count:"); at != std::string::npos; at = text.find("count:", at + 1))
    if (std::atof(text.c_str() + at + 6) > 64) return true;
  return false;
}

void ask_as_an_editor(const std::string& text, std::size_t offset) {
  using namespace tessera::language;
  static const Grammar grammar(schema_text());
  const Document document(text, grammar);
  const Position at = document.lines().position(offset % (text.size() + 1));
  for (const Use& use : document.index().uses())
    if (use.extent.begin > use.extent.end || use.extent.end > text.size()) std::abort();
  (void)complete(document, at);
  (void)explain(document, at);
  (void)definition(document, at, {});
  (void)references(document, nullptr, at, {}, true);
  (void)fixes(document, {at, at}, {});
  (void)headings(document);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed) {
  if (seed % 16 == 0) return LLVMFuzzerMutate(data, size, most);
  const std::string text = mutator().mutated(std::string(reinterpret_cast<const char*>(data), size), seed);
  const std::size_t taken = std::min(most, text.size());
  std::memcpy(data, text.data(), taken);
  return taken;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (has_large_fleet(text)) return -1;
  const double begin = processor_time();
  const server::Analysis analysis = server::analyse("spec.yaml", text, {});
  if (analysis.net && !analysis.model) std::abort();
  ask_as_an_editor(text, size * 7919);
  const double seconds = processor_time() - begin;
  if (seconds > most_seconds()) {
    std::fprintf(stderr, "the text took %.1f s of processor time\n", seconds);
    std::abort();
  }
  return 0;
}
