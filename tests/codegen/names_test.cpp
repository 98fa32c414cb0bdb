#include "spec/document/names.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "../environment.hpp"
#include "diagnostics/diagnostics.hpp"
#include "generated.hpp"
#include "spec/parser.hpp"

/// Every identifier in generated files, and words that libraries use, may be a name of the
/// user, or `check` refuses it.
namespace tessera::test {
namespace {

using Words = std::set<std::string>;

/// Text without comments, literals and lines of the preprocessor.
std::string code_of(const std::string& text) {
  std::string code;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool line_begins = at == 0 || text[at - 1] == '\n';
    if (text.compare(at, 2, "//") == 0 || (line_begins && text[at] == '#')) {
      at = std::min(text.find('\n', at), text.size());
    } else if (text[at] == '"') {
      for (++at; at < text.size() && text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    } else {
      code += text[at];
      continue;
    }
    code += '\n';
  }
  return code;
}

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

void add_words(const std::string& code, Words& words) {
  for (std::size_t at = 0; at < code.size();) {
    std::size_t end = at;
    while (end < code.size() && in_word(code[end])) ++end;
    if (end > at && std::isdigit(static_cast<unsigned char>(code[at])) == 0)
      words.insert(code.substr(at, end - at));
    at = std::max(end, at + 1);
  }
}

/// Words of generated files, and of C, C++ and their libraries.
const Words& words() {
  static const Words all = [] {
    Words words{"main",    "errno",   "while",     "NULL",   "EOF",    "assert", "INT_MAX",   "linux",
                "unix",    "time",    "read",      "write",  "log",    "index",  "exit",      "abs",
                "signal",  "remove",  "import",    "final",  "module", "system", "types",     "all",
                "test",    "tests",   "functions", "T",      "Type",   "Status", "Buffer",    "string",
                "payload", "y0",      "gamma",     "printf", "value",  "it",     "sin",       "stdin",
                "fmt",     "testing", "Part",      "net",    "make",   "robot",  "controller"};
    for (const auto& spec : {features_spec, line_follower_spec})
      for (const codegen::File& file : generate_file(spec).files)
        if (file.path.ends_with("pp")) add_words(code_of(file.text), words);
    return words;
  }();
  return all;
}

/// The things that a word can name in a specification.
enum class Role : std::uint8_t {
  type,
  field,
  agent,
  subsystem,
  buffer,
  memory,
  parameter,
  behaviour,
  condition,
  model
};
constexpr std::array roles{Role::type,   Role::field,     Role::agent,     Role::subsystem, Role::buffer,
                           Role::memory, Role::parameter, Role::behaviour, Role::condition, Role::model};

/// A specification in which `words` name things of one role, as many as there are.
std::string specification(Role role, const Words& words) {
  const auto each = [&](const std::function<std::string(const std::string&)>& text) {
    std::string out;
    for (const std::string& word : words) out += text("'" + word + "'");
    return out;
  };
  // Each has a name of its own, so that all roles fit into one program.
  const std::string head = "tessera: 1\nsystem: zsystem" + std::to_string(static_cast<int>(role)) + '\n';
  const std::string control = "control: { rate: 9 Hz, behaviours: { zrun: {} } }";
  const std::string alone = "agents: { zagent: { " + control + " } }\n";
  const auto with_control = [&](const std::string& rest) {
    return head + "agents:\n  zagent:\n    control:\n      rate: 9 Hz\n" + rest;
  };
  switch (role) {
    case Role::type:
      return head + "types:\n" + each([](auto& word) { return "  " + word + ": { zvalue: float64 }\n"; }) +
             "agents:\n  zagent:\n    control:\n      rate: 9 Hz\n      behaviours: { zrun: {} }\n" +
             "      outputs:\n" + each([](auto& word) { return "        " + word + ": " + word + "\n"; }) +
             "      memory:\n" + each([](auto& word) { return "        " + word + ": " + word + "\n"; }) +
             "    effectors:\n      zeffector:\n        rate: 9 Hz\n        behaviours: { zrun: {} }\n" +
             "        inputs:\n" + each([](auto& word) { return "          " + word + ": " + word + "\n"; }) +
             "        real:\n" + each([](auto& word) {
               return "          z" + word.substr(1, word.size() - 2) + ": " + word + "\n";
             }) +
             "channels:\n" + each([](auto& quoted) {
               const std::string word = quoted.substr(1, quoted.size() - 2);
               return "  - zagent.control." + word + " -> zagent.zeffector." + word + "\n";
             });
    case Role::field:
      return head + "types:\n  Zmany:\n" + each([](auto& word) { return "    " + word + ": int8\n"; }) +
             "agents: { zagent: { control: { rate: 9 Hz, memory: { zmany: Zmany }, behaviours: { zrun: {} } "
             "} } }\n";
    case Role::agent:
      return head + "agents:\n" + each([&](auto& word) { return "  " + word + ": { " + control + " }\n"; });
    case Role::subsystem:
      return head + "agents:\n  zagent:\n    " + control + "\n    receptors:\n" + each([](auto& word) {
               return "      " + word + ": { rate: 9 Hz, behaviours: { zrun: {} } }\n";
             });
    case Role::buffer:
      return head + "agents:\n  zagent:\n    " + control +
             "\n    receptors:\n      zreceptor:\n        rate: 9 Hz\n        behaviours: { zrun: {} }\n" +
             "        real:\n" + each([](auto& word) { return "          " + word + ": float64\n"; }) +
             "    effectors:\n      zeffector:\n        rate: 9 Hz\n        behaviours: { zrun: {} }\n" +
             "        real:\n" + each([](auto& word) { return "          " + word + ": bool\n"; });
    case Role::memory:
      return with_control("      behaviours: { zrun: {} }\n      memory:\n" + each([](auto& word) {
                            return "        " + word + ": { type: float64, initial: 1 }\n";
                          }));
    case Role::parameter:
      return head + "parameters:\n" +
             each([](auto& word) { return "  " + word + ": { type: float64, default: 1, min: 0 }\n"; }) +
             alone;
    case Role::behaviour:
      return with_control("      memory: { zcount: int8 }\n      behaviours:\n" + each([](auto& word) {
                            return "        " + word + ": { terminal: memory.zcount > 3, next: [" + word +
                                   "] }\n";
                          }));
    case Role::condition:
      return with_control(
          "      memory: { zcount: int8 }\n      behaviours:\n        zrun:\n          next: zrun\n" +
          std::string("          terminal:\n") +
          each([](auto& word) { return "            " + word + ": memory.zcount > 3\n"; }));
    case Role::model:
      return head + "models:\n" + each([](auto& word) {
               return "  " + word + R"(:
    shared: { free: 1, there: 0 }
    send:
      places: { in, work: { write: 1 }, out }
      transitions: { t1: { from: [in, free], to: work }, t2: { from: work, to: [out, there] } }
    receive:
      places: { in, work: { read: 1 }, out }
      transitions: { t1: { from: [in, there], to: work }, t2: { from: work, to: [out, free] } }
)";
             }) +
             alone;
  }
  return {};
}

/// One word in all roles at once.
std::string everything(const std::string& word) {
  std::string text = R"(tessera: 1
system: @
types: { Z@: { @: float64 } }
parameters: { @: 1.5 }
agents:
  @:
    control:
      rate: 9 Hz
      outputs: { @: Z@ }
      memory: { @: Z@ }
      behaviours: { @: { terminal: { @: "memory.@.@ > parameters.@" }, next: ['@'] } }
    effectors:
      @: { rate: 9 Hz, inputs: { @: Z@ }, real: { z@: Z@ }, memory: { @: Z@ }, behaviours: { @: {} } }
channels: [ @.control.@ -> @.@.@ ]
)";
  for (std::size_t at = 0; (at = text.find('@', at)) != std::string::npos;) text.replace(at, 1, word);
  return text;
}

/// Whether `check` accepts it; it refuses a name with one of the codes of names.
bool accepted(const std::string& text, const std::string& word) {
  diagnostics::Diagnostics out("spec.yaml", text);
  if (spec::parse(out)) return true;
  bool about_names = false;
  for (const diagnostics::Diagnostic& one : out.sorted())
    about_names = about_names || one.code == "E105" || one.code == "E106" || one.code == "E107" ||
                  one.code == "E010";  // NULL, which YAML reads as nothing
  EXPECT_TRUE(about_names) << word << '\n' << diagnostics::render(out) << text;
  return false;
}

/// Generated controllers of many systems, compiled as one.
class Batch {
 public:
  void add(const std::string& text) {
    const std::string number = std::to_string(systems_++);
    const Generated generated = generate(text, "spec.yaml");
    for (codegen::File file : generated.files) {
      if (!file.path.ends_with("pp")) continue;
      // Several controllers cannot be in one program otherwise.
      for (const char* name : {"tessera_generated", "int main"})
        for (std::size_t at = 0; (at = file.text.find(name, at)) != std::string::npos;)
          file.text.insert(at += std::string_view(name).size(), number);
      folder_.write("s" + number + "/" + file.path, file.text);
      if (file.path.ends_with(".cpp")) all_ += "#include \"s" + number + "/" + file.path + "\"\n";
    }
  }
  [[nodiscard]] Ran compile() const {
    folder_.write("all.cpp", all_);
    return run(
        "cd " + folder_.path().string() +
        " && LC_ALL=C " TESSERA_CXX
        " -std=c++20 -fsyntax-only -fmax-errors=5 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror "
        "-I" TESSERA_RUNTIME_HEADERS " all.cpp");
  }
  [[nodiscard]] std::size_t systems() const { return systems_; }

 private:
  Folder folder_;
  std::string all_;
  std::size_t systems_ = 0;
};

/// The words that a test tries: each of so many. TESSERA_ALL_NAMES=1: all.
std::size_t each_of(std::size_t words) {
  if (std::getenv("TESSERA_ALL_NAMES") != nullptr) return 1;
  return sanitized ? 10 * words : words;
}

/// Each role gets a third of the words, and another third than the role before.
TEST(Names, WhatWeEmitMayBeANameOfTheUserOrIsRefused) {
  Batch batch;
  for (const Role role : roles) {
    Words good;
    std::size_t tried = 0;
    for (std::size_t at = static_cast<std::size_t>(role); const std::string& word : words()) {
      if (at++ % each_of(3) != 0) continue;
      ++tried;
      if (accepted(specification(role, {word}), word)) good.insert(word);
    }
    EXPECT_GT(good.size(), tried / 2) << "role " << static_cast<int>(role);
    batch.add(specification(role, good));
  }
  const Ran ran = batch.compile();
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
}

/// The names that come with the headers of the runtime, which generated files include.
std::string preprocessed(const std::string& option) {
  const Folder folder;
  std::string all;
  for (const auto& header : std::filesystem::directory_iterator(TESSERA_RUNTIME_HEADERS "/tessera"))
    if (header.path().extension() == ".hpp")
      all += "#include <tessera/" + header.path().filename().string() + ">\n";
  folder.write("all.cpp", all);
  const Ran ran = run("cd " + folder.path().string() + " && " TESSERA_CXX " -std=c++20 -E " + option +
                      " -I" TESSERA_RUNTIME_HEADERS " all.cpp");
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
  return ran.output;
}

TEST(NamesOfCpp, MacrosAreRefused) {
  std::istringstream lines(preprocessed("-dM"));
  std::size_t macros = 0;
  for (std::string define, name; lines >> define >> name; std::getline(lines, define)) {
    name = name.substr(0, name.find('('));
    diagnostics::Diagnostics out("spec.yaml", name);
    EXPECT_FALSE(spec::check_name(name, {}, "buffer", out)) << name;
    ++macros;
  }
  EXPECT_GT(macros, 1000U);
}

TEST(NamesOfCpp, EachWordOfTheHeadersIsRefusedOrMayNameASystem) {
  Words words;
  add_words(code_of(preprocessed("-P")), words);
  std::string program = "#include <bits/stdc++.h>\n";
  std::size_t accepted = 0;
  for (const std::string& word : words) {
    diagnostics::Diagnostics out("spec.yaml", word);
    if (!spec::check_system_name(word, {}, out)) continue;
    program += "namespace " + word + " {}\n";
    ++accepted;
  }
  EXPECT_GT(accepted, 1000U);
  const Folder folder;
  folder.write("all.cpp", program);
  const Ran ran = run("cd " + folder.path().string() +
                      " && LC_ALL=C " TESSERA_CXX " -std=c++20 -fsyntax-only -fmax-errors=20 all.cpp");
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
}

TEST(Names, OneWordMayBeEverythingAtOnceOrIsRefused) {
  Batch batch;
  for (std::size_t at = 0; const std::string& word : words()) {
    if (at++ % each_of(8) != 0) continue;
    if (accepted(everything(word), word)) batch.add(everything(word));
  }
  EXPECT_GE(batch.systems(), share_of(10));
  const Ran ran = batch.compile();
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
}

}  // namespace
}  // namespace tessera::test
