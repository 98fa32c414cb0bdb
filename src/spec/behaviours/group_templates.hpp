#pragma once

#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

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

  /// Warnings: W319 a template that no behaviour uses.
  void complain_about_unused(Diagnostics& out) const;

 private:
  struct Template {
    const Entry* entry = nullptr;
    bool used = false;
  };
  using Texts = std::map<std::string, std::string>;  ///< for the names that a template takes

  std::vector<Entry> expand(const std::vector<Entry>& entries, std::vector<std::string>& chain,
                            Diagnostics& out);
  /// The group that a use stands for; null after an error.
  const Node* group_of(const Entry& behaviour, const Entry& use, std::vector<std::string>& chain,
                       Diagnostics& out);
  [[nodiscard]] Texts texts_for(const Entry& behaviour, const Template& from, Diagnostics& out) const;
  /// gives: a map `with`, whose keys are names of another template.
  const Node* replaced(const Node& node, const Texts& texts, std::set<std::string>& found,
                       bool gives = false);
  const Node* map_of(const Node& at, std::vector<Entry> entries);

  std::map<std::string, Template> by_name_;
  std::deque<Node> nodes_;
  std::deque<std::vector<Entry>> lists_;
  bool one_is_unknown_ = false;
};

}  // namespace tessera::spec
