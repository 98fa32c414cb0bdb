#pragma once

#include <httplib.h>

#include <memory>
#include <string>

#include "language/language.hpp"
#include "server/analysis/sources.hpp"

namespace tessera::server {

/// The answers to the editor's questions about a text (docs/reference/studio.md, `POST /api/language`).
///
/// Threads: any.
class LanguageAnswers {
 public:
  /// schema: spec.schema.json. If it cannot be read, there are no completions and explanations.
  explicit LanguageAnswers(const std::string& schema);

  void handle(const httplib::Request& request, httplib::Response& response) const;

  /// `POST /api/edit`: the edits of the text, and what a rename changes in the files of `sources`. Writes nothing.
  void edit(const httplib::Request& request, httplib::Response& response, const Sources& sources) const;

  [[nodiscard]] const language::Grammar& grammar() const { return *grammar_; }

 private:
  std::unique_ptr<const language::Grammar> grammar_;
};

}  // namespace tessera::server
