#include <gtest/gtest.h>

#include <string>

#include "generated.hpp"

namespace tessera::test {
namespace {

// clang-format is part of the test's equipment: without it this fails.
void expect_formatted(const std::vector<codegen::File>& files) {
  const Folder folder;
  folder.write(files);
  std::string names;
  for (const codegen::File& file : files)
    if (file.path.ends_with("pp")) names += " '" + file.path + '\'';
  const Ran ran = run("cd " + folder.path().string() + " && clang-format --dry-run -Werror" + names);
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
}

TEST(Format, ExamplesAreClangFormatClean) {
  for (const auto& spec : {line_follower_spec, gap_spec, features_spec}) {
    SCOPED_TRACE(spec);
    expect_formatted(generate_file(spec).files);
  }
}

// Nothing but names as long as specifications allow.
TEST(Format, LongNamesAreClangFormatClean) {
  const auto name = [](const std::string& prefix) { return prefix + std::string(60 - prefix.size(), 'x'); };
  std::string text = "tessera: 1\nsystem: " + name("s") + "\ntypes:\n  " + name("T") + ":\n    " + name("f") +
                     ": \"string<=100000[1000]\"\n    " + name("g") + ": float64 m/s\n";
  text += "agents:\n  " + name("a") + ":\n    control:\n      rate: 7 Hz\n      inputs: { " + name("i") +
          ": " + name("T") + " }\n      outputs: { " + name("o") + ": " + name("T") + " }\n      memory: { " +
          name("m") + ": \"" + name("T") + "[100000]\" }\n      parameters: { " + name("p") +
          ": { default: 1, max: 2, unit: " + name("u").substr(0, 32) + " } }\n      behaviours:\n";
  for (const char* behaviour : {"b", "c"})
    text += "        " + name(behaviour) + ":\n          terminal:\n            " + name("n") + ": in." +
            name("i") + ".fresh\n          next: [ { to: " + name("b") + ", when: " + name("n") + " }, " +
            name("c") + " ]\n";
  text += "channels: [ \"" + name("a") + ".control." + name("o") + " -> " + name("a") + ".control." +
          name("i") + "\" ]\n";
  expect_formatted(generate(text).files);
}

}  // namespace
}  // namespace tessera::test
