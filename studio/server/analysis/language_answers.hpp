#pragma once

#include <httplib.h>

#include <memory>
#include <string>

#include "language/language.hpp"

namespace tessera::server {

/// The answers to the editor's questions about a text (docs/reference/studio.md, `POST /api/language`).
///
/// Threads: any.
class LanguageAnswers {
 public:
  /// schema: spec.schema.json. If it cannot be read, there are no completions and explanations.
  explicit LanguageAnswers(const std::string& schema);

  void handle(const httplib::Request& request, httplib::Response& response) const;

  [[nodiscard]] const language::Grammar& grammar() const { return *grammar_; }

 private:
  std::unique_ptr<const language::Grammar> grammar_;
};

}  // namespace tessera::server
