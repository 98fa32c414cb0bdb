#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"
#include "net/property.hpp"
#include "project/process/listener.hpp"
#include "spec/model/model.hpp"
#include "verify/verify.hpp"

/// The walk of the data: specification -> Model -> hierarchical net -> flat net -> verified net. Every stage
/// says what it has to say to a listener.
namespace tessera::project {

/// A specification that was read without error.
struct Specification {
  std::filesystem::path file;     ///< absolute
  std::filesystem::path project;  ///< its folder
  diagnostics::Diagnostics diagnostics;
  spec::Model model;
};

/// The file that `given` means: itself, or the spec.yaml of a folder.
[[nodiscard]] std::filesystem::path spec_file(const std::filesystem::path& given);

/// given: a file, or a folder that holds spec.yaml. nullopt after its diagnostics have been told.
[[nodiscard]] std::optional<Specification> read(const std::filesystem::path& given, Listener& listener);

/// Judges every communication model of the author's by itself. false: one is not sound, and was complained
/// about.
bool judge_models(const spec::Model& model, diagnostics::Diagnostics& out);
/// The same, told.
[[nodiscard]] bool models_are_sound(const Specification& specification, Listener& listener);

/// check_simulation_files, told (src/project/files/assets.hpp).
[[nodiscard]] bool simulation_files_exist(const Specification& specification, Listener& listener);

struct Nets {
  net::HierarchicalNet pages;
  net::Net flat;
  std::vector<net::Property> properties;  ///< of the author
};
/// Errors: those of layers::build, net::flatten and layers::properties; E106 a property of the author's with
/// the name of a default one. nullopt after an error.
[[nodiscard]] std::optional<Nets> build(const spec::Model& model, diagnostics::Diagnostics& out);
/// The same, told.
[[nodiscard]] std::optional<Nets> build(const Specification& specification, Listener& listener);

/// "holds", "violated", "unknown"
[[nodiscard]] const char* name_of(verify::Verdict verdict);

/// What may pass on to generation.
struct VerificationGate {
  std::string timeout = "10s";     ///< for the verdicts
  bool accept_violations = false;  ///< a violated net too
};

/// read, judge_models, build, verify; only a net without violations gets through, unless the gate is open.
/// What is unknown is told of and gets through. Uses up the nets.
struct Verified {
  Specification specification;
  verify::VerifiedNet net;
};
[[nodiscard]] std::optional<Verified> read_and_verify(const std::filesystem::path& given,
                                                      const VerificationGate& gate, Listener& listener);

}  // namespace tessera::project
