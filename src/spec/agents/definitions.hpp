#pragma once

#include "spec/agents/fleets.hpp"

namespace tessera::spec {

/// Reads the body of an agent or template: control, receptors, effectors. `count` and `ring` of an agent are left to
/// read_agents().
///
/// Errors: E103 no control subsystem, a template with `count`; E107 two subsystems of one name; those of subsystems.
[[nodiscard]] Definition read_definition(const Entry& entry, bool is_template, const SystemScope& around,
                                         Diagnostics& out);

/// The templates of a file. A template may be another name for a template (`b: { use: a }`).
class Templates {
 public:
  /// Reads the section into model.definitions. section may be null.
  void read(const Entry* section, const SystemScope& around, Model& model, Diagnostics& out);
  /// The definition behind a name, none after an error. Errors: E101 unknown template.
  [[nodiscard]] DefinitionId find(const Node& name, Diagnostics& out);
  /// Warnings: W319.
  void complain_about_unused(Diagnostics& out) const;

 private:
  struct Template {
    const Entry* entry = nullptr;
    const Node* alias_of = nullptr;
    DefinitionId definition{};
    bool used = false;
  };

  void resolve_aliases(Diagnostics& out);
  void resolve(const std::string& name, Diagnostics& out);

  std::unordered_map<std::string, Template> by_name_;
  std::vector<std::string> order_;
  const GroupTemplates* groups_ = nullptr;
  bool one_is_unknown_ = false;  ///< a name was looked up in vain
};

}  // namespace tessera::spec
