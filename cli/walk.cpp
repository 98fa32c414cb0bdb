#include "cli/walk.hpp"

#include <fmt/core.h>

#include "cli/terminal.hpp"
#include "diagnostics/source.hpp"
#include "layers/closed_pair.hpp"
#include "layers/layers.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"
#include "verify/lone_model.hpp"

namespace tessera::cli {

namespace fs = std::filesystem;

fs::path spec_file(const fs::path& given) {
  fs::path inside = given / "spec.yaml";
  return fs::exists(inside) ? inside : given;
}

std::optional<Specification> read(const fs::path& given) {
  const fs::path file = spec_file(given);
  diagnostics::Diagnostics diagnostics = diagnostics::load(file);
  std::optional<spec::Model> model;
  if (!diagnostics.has_errors()) model = spec::parse(diagnostics);
  print(diagnostics);
  if (!model) return std::nullopt;
  const fs::path absolute = fs::weakly_canonical(fs::absolute(file));
  return Specification{absolute, absolute.parent_path(), std::move(diagnostics), std::move(*model)};
}

std::optional<Nets> build(Specification& specification) {
  diagnostics::Diagnostics found(specification.diagnostics.file(), specification.diagnostics.text());
  std::optional<net::HierarchicalNet> pages = layers::build(specification.model, found);
  std::optional<net::Net> flat;
  if (pages) flat = net::flatten(*pages, found);
  print(found);
  if (!flat) return std::nullopt;
  return Nets{std::move(*pages), std::move(*flat)};
}

bool judge_models(const spec::Model& model, diagnostics::Diagnostics& out) {
  bool sound = true;
  for (const spec::CommunicationModel& one : model.models) {
    const layers::ClosedPair pair = layers::closed_pair(one);
    sound = verify::judge_model({pair.net, pair.sends_again, pair.receives_again, one.name, one.span}, out) &&
            sound;
  }
  return sound;
}

bool models_are_sound(const Specification& specification) {
  diagnostics::Diagnostics found(specification.diagnostics.file(), specification.diagnostics.text());
  const bool sound = judge_models(specification.model, found);
  print(found);
  return sound;
}

verify::Report check(const Specification& specification, const Nets& nets) {
  return verify::check(nets.flat, layers::invariants(specification.model, nets.pages, nets.flat));
}

const char* name_of(verify::Verdict verdict) {
  switch (verdict) {
    case verify::Verdict::holds:
      return "holds";
    case verify::Verdict::violated:
      return "violated";
    case verify::Verdict::unknown:
      return "unknown";
  }
  return "";
}

void print(const verify::Report& report) {
  for (const verify::PropertyResult& property : report.properties)
    fmt::print("{}: {} ({})\n", property.name, name_of(property.verdict),
               property.verdict == verify::Verdict::holds ? property.method : property.why);
}

std::optional<Verified> walk(const fs::path& given) {
  std::optional<Specification> specification = read(given);
  if (!specification || !models_are_sound(*specification)) return std::nullopt;
  std::optional<Nets> nets = build(*specification);
  if (!nets) return std::nullopt;
  verify::Report report = check(*specification, *nets);
  std::optional<verify::VerifiedNet> verified = verify::accept(std::move(nets->flat), report);
  if (!verified) {
    print(report);
    complain("the net did not pass verification, so no controller is generated from it");
    return std::nullopt;
  }
  return Verified{std::move(*specification), std::move(*verified)};
}

}  // namespace tessera::cli
