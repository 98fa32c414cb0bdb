#include "generated.hpp"

#include <stdlib.h>  // mkdtemp
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "diagnostics/source.hpp"
#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"
#include "verify/verify.hpp"

namespace tessera::test {
namespace fs = std::filesystem;

const std::string& Generated::operator[](const std::string& path) const {
  for (const codegen::File& file : files)
    if (file.path == path) return file.text;
  throw std::runtime_error("no file " + path);
}

Generated generate(const std::string& text, const std::string& spec_path, codegen::Lines lines) {
  diagnostics::Diagnostics diagnostics(spec_path, text, std::filesystem::path(spec_path).parent_path());
  const auto refuse = [&] { throw std::runtime_error(diagnostics::render(diagnostics)); };
  std::optional<spec::Model> model = spec::parse(diagnostics);
  if (!model) refuse();
  std::optional<net::HierarchicalNet> pages = layers::build(*model, diagnostics);
  if (!pages) refuse();
  std::optional<net::Net> net = net::flatten(*pages, diagnostics);
  if (!net) refuse();
  const auto verified = verify::accept(*net, verify::check(*net, layers::invariants(*model, *pages, *net)));
  if (!verified) throw std::runtime_error("the net did not pass");
  std::vector<codegen::File> files = codegen::generate(*verified, *model, spec_path, lines);
  return {std::move(*model), std::move(*pages), std::move(*net), verified->report().net_hash,
          std::move(files)};
}

Generated generate_file(const fs::path& spec) { return generate(read_file(spec), spec.string()); }

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

Folder::Folder() {
  std::string name = (fs::temp_directory_path() / "tessera_codegen_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void Folder::write(const std::string& path, const std::string& text) const {
  fs::create_directories((path_ / path).parent_path());
  std::ofstream(path_ / path, std::ios::binary) << text;
}

void Folder::write(const std::vector<codegen::File>& files) const {
  for (const codegen::File& file : files) write(file.path, file.text);
}

Ran run(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
  Ran ran;
  std::array<char, 4096> bytes{};
  while (const std::size_t count = fread(bytes.data(), 1, bytes.size(), pipe))
    ran.output.append(bytes.data(), count);
  const int status = pclose(pipe);
  ran.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

}  // namespace tessera::test
