#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"
#include "net/property.hpp"
#include "project/process/listener.hpp"
#include "spec/model/model.hpp"
#include "verify/verify.hpp"

/// The pipeline: text of a specification -> Model -> hierarchical net -> flat net -> verified net. Each stage
/// has two forms: one reports to Diagnostics, the other tells a listener.
namespace tessera::project {

/// A specification that was read without errors.
struct Specification {
  std::filesystem::path file;     ///< absolute
  std::filesystem::path project;  ///< its folder
  diagnostics::Diagnostics diagnostics;
  spec::Model model;
};

/// The file that `given` means: `given` itself, or the spec.yaml of a folder.
[[nodiscard]] std::filesystem::path spec_file(const std::filesystem::path& given);

/// The absolute path of a file, in the folder where it is named: a specification that is a symbolic link belongs to
/// the project of the link, whose sources and parameters are beside it.
[[nodiscard]] std::filesystem::path located(const std::filesystem::path& file);

/// given: a file, or a folder that holds spec.yaml. nullopt after its diagnostics have been reported.
[[nodiscard]] std::optional<Specification> read(const std::filesystem::path& given, Listener& listener);
/// The same of a text that has been loaded from `file`: a pipe can be read once.
[[nodiscard]] std::optional<Specification> read(diagnostics::Diagnostics loaded,
                                                const std::filesystem::path& file, Listener& listener);

/// Judges every communication model of the specification by itself. false: one is not
/// sound, which has been reported.
bool judge_models(const spec::Model& model, diagnostics::Diagnostics& out);
/// The same, with the diagnostics reported to the listener.
[[nodiscard]] bool models_are_sound(const Specification& specification, Listener& listener);

/// check_simulation_files, told (src/project/files/assets.hpp), and then check_world
/// (src/project/files/world_check.hpp). world: as there.
[[nodiscard]] bool simulation_is_possible(const Specification& specification, Listener& listener,
                                          const std::string& world = {});

/// The nets of a model, as far as the stages got: an error is reported, and what
/// follows from it is missing.
struct PartialNets {
  std::optional<net::HierarchicalNet> pages;
  std::optional<net::Net> flat;
  std::optional<std::vector<net::Property>> properties;  ///< of the author
};
/// Errors: those of layers::build, net::flatten and layers::properties.
[[nodiscard]] PartialNets build_what_is_possible(const spec::Model& model, diagnostics::Diagnostics& out);

/// A text that may be wrong, as far as the pipeline gets with it.
struct Draft {
  std::optional<spec::Model> model;  ///< nullopt: reading the text finds errors
  PartialNets nets;                  ///< of a model; those of unsound communication models too
};
/// text: loaded, not read. project: the folder of the specification, in which messages of ROS 2 are looked
/// up; empty: they are not.
/// Errors: those of spec::parse, find_messages, read_measured_times, judge_models and build_what_is_possible.
///
/// Threads: any; it reads definitions of messages.
[[nodiscard]] Draft draft_of(diagnostics::Diagnostics& text, const std::filesystem::path& project = {});

struct Nets {
  net::HierarchicalNet pages;
  net::Net flat;
  std::vector<net::Property> properties;  ///< from the specification
};
/// All of them, or nullopt after an error. Errors: those of build_what_is_possible; E106 a property of the
/// author's with the name of a default one.
[[nodiscard]] std::optional<Nets> build(const spec::Model& model, diagnostics::Diagnostics& out);
/// The same, with the diagnostics reported to the listener.
[[nodiscard]] std::optional<Nets> build(const Specification& specification, Listener& listener);

/// "holds", "violated", "unknown"
[[nodiscard]] const char* name_of(verify::Verdict verdict);

/// A model that may pass on to generation.
struct VerificationGate {
  std::string timeout = "10s";     ///< for the verdicts
  bool accept_violations = false;  ///< a violated net may pass, too
};

struct Verified {
  Specification specification;
  verify::VerifiedNet net;
};
/// The whole pipeline: read, models_are_sound, build, verdicts. Only a net without violations passes, unless
/// the gate is open. An unknown verdict is reported and passes.
[[nodiscard]] std::optional<Verified> run_pipeline(const std::filesystem::path& given,
                                                   const VerificationGate& gate, Listener& listener);

}  // namespace tessera::project
