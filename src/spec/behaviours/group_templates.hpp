#pragma once

#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "spec/behaviours/replacements.hpp"
#include "spec/document/document.hpp"

/// Groups of behaviours that are written once under `templates`, and used in several places: `charge: { use: docking }`.
namespace tessera::spec {

/// The templates of groups of a specification. After `expanded`, nothing tells such a group from one that is written
/// out.
///
/// Threads: one at a time.
class GroupTemplates {
 public:
  /// templates: the section; may be null. Those that have no `behaviours` are of agents, and left to Templates.
  explicit GroupTemplates(const Entry* templates);

  /// Whether an entry of `templates` describes a group.
  [[nodiscard]] static bool is_group(const Entry& entry);
  [[nodiscard]] bool contains(const std::string& name) const { return by_name_.contains(name); }

  /// Behaviours and groups in which every `use` has been replaced by what it names.
  ///
  /// entries: of the file; they and this object outlive the result. Errors: E351 no such template; E352 a key that
  ///          belongs to the other of a use and its template; E353 templates that use each other in a circle; E354
  ///          the names that a template takes by `with`; E355 a `with` that does not give them.
  [[nodiscard]] const std::vector<Entry>& expanded(const std::vector<Entry>& entries, Diagnostics& out);

  /// The texts of templates in which the last call of `expanded` or `unused` has put something of a `with`.
  [[nodiscard]] const std::vector<Replacement>& replacements() const { return replacements_; }

  /// The groups of the templates that nothing has used, as if a subsystem had them, with the names of `with` as they
  /// stand. This object outlives them.
  ///
  /// Warnings: W319 for those of the given file. Errors: those of `expanded`.
  [[nodiscard]] std::vector<Entry> unused(Diagnostics& out);

 private:
  struct Template {
    const Entry* entry = nullptr;
    bool used = false;
  };
  using Texts = std::map<std::string, Given>;  ///< for the names that a template takes

  std::vector<Entry> expand(const std::vector<Entry>& entries, std::vector<std::string>& chain,
                            Diagnostics& out);
  /// The group that a use stands for; null after an error.
  const Node* group_of(const Entry& behaviour, const Entry& use, std::vector<std::string>& chain,
                       Diagnostics& out);
  /// The group of a template with these texts. behaviour: what stands beside `use`.
  const Node* body_of(const Entry& behaviour, const Template& from, const Texts& texts,
                      std::vector<std::string>& chain, Diagnostics& out);
  [[nodiscard]] Texts texts_for(const Entry& behaviour, const Template& from, Diagnostics& out) const;
  /// A template while its names are replaced.
  struct Replacing {
    const std::string& name;
    const Texts& texts;
    std::set<std::string> found{};
  };
  /// gives: a map `with`, whose keys are names of another template.
  const Node* replaced(const Node& node, Replacing& with, bool gives = false);
  /// at: where the text stands in the template.
  std::string replaced(const std::string& text, Span at, Replacing& with);
  const Node* map_of(const Node& at, std::vector<Entry> entries);

  std::map<std::string, Template> by_name_;
  std::deque<Node> nodes_;
  std::deque<std::vector<Entry>> lists_;
  std::vector<Replacement> replacements_;      // since the last call of `expanded`
  std::map<const Node*, Given> given_before_;  // a `with` in a template whose text another `with` has given
  bool one_is_unknown_ = false;
  std::size_t expansions_ = 0;
};

}  // namespace tessera::spec
