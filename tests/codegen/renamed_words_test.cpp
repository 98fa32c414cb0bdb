// A word that the layers write into names may change: the generated files then hold other names, and are the
// same otherwise.
#include <gtest/gtest.h>

#include <regex>

#include "codegen/codegen.hpp"
#include "diagnostics/source.hpp"
#include "generated.hpp"
#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "renamed.hpp"
#include "spec/parser.hpp"
#include "verify/verify.hpp"

namespace tessera::test {
namespace {

std::vector<codegen::File> files_of(const spec::Model& model, const net::HierarchicalNet& pages,
                                    diagnostics::Diagnostics& out) {
  const auto net = net::flatten(pages, out);
  const auto verified = verify::accept(*net, verify::check(*net, layers::invariants(model, pages, *net)));
  return codegen::generate(*verified, model, "spec.yaml");
}

TEST(RenamedWords, AreNamesInGeneratedFilesAndNothingElse) {
  const std::regex hash("[0-9a-f]{32}");
  for (const char* example : {"01_line_follower", "02_gap", "03_two_slot_buffer", "04_arm"}) {
    SCOPED_TRACE(example);
    diagnostics::Diagnostics source("spec.yaml",
                                    read_file(source_folder / "examples" / example / "spec.yaml"));
    const auto model = spec::parse(source);
    const auto pages = model ? layers::build(*model, source) : std::nullopt;
    ASSERT_TRUE(pages) << diagnostics::render(source);
    const std::vector<codegen::File> files = files_of(*model, *pages, source);
    const std::vector<codegen::File> others = files_of(*model, renamed(*pages), source);
    ASSERT_EQ(files.size(), others.size());
    bool differ = false;
    for (std::size_t at = 0; at < files.size(); ++at) {
      differ = differ || files[at].text != others[at].text;
      EXPECT_EQ(without_strange_words(std::regex_replace(files[at].text, hash, "HASH")),
                without_strange_words(std::regex_replace(others[at].text, hash, "HASH")))
          << files[at].path;
    }
    EXPECT_TRUE(differ);
  }
}

}  // namespace
}  // namespace tessera::test
