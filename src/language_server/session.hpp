#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "language_server/checker.hpp"
#include "language_server/connection.hpp"
#include "language_server/pictures.hpp"
#include "language_server/wire.hpp"
#include "language_server/workspace.hpp"

namespace tessera::language_server {

/// A request that gets an error as its answer.
struct RequestError {
  int code = 0;  ///< of JSON-RPC or of the protocol
  std::string message;
};

/// One editor's connection: its state, and a function for each method.
///
/// Threads: one; `checker_` writes diagnostics from its own.
class Session {
 public:
  Session(Connection& connection, const language::Grammar& grammar);

  /// Handles a message. nullopt: go on. A number: the exit code.
  [[nodiscard]] std::optional<int> handle(const Connection::Incoming& incoming);

 private:
  using json = nlohmann::json;
  using Specification = Workspace::Specification;

  void request(const json& id, const std::string& method, const json& parameters);
  void notification(const std::string& method, const json& parameters);
  void answer_error(const json& id, int code, const std::string& message);

  json initialize(const json& parameters);
  void did_open(const json& parameters);
  void did_change(const json& parameters);
  void did_close(const json& parameters);
  void did_save(const json& parameters);
  void check_later(const Workspace::Open& document);
  void take_back(const std::string& uri);
  void publish(const Checker::Text& text, const Checked& checked);
  void publish_included(const std::string& uri, const Checked& checked);

  json completion(const json& parameters);
  json hover(const json& parameters);
  json definition(const json& parameters);
  json references(const json& parameters);
  json prepare_rename(const json& parameters);
  json rename(const json& parameters);
  json code_actions(const json& parameters);
  json symbols(const json& parameters);

  /// The subject of a request about a position.
  struct Asked {
    Specification specification;
    language::Position position;
    std::vector<language::Source> sources;
    const language::Source* source = nullptr;  ///< the cursor is there; nullptr: in the specification
  };
  [[nodiscard]] std::optional<Asked> asked(const json& parameters, bool with_sources);
  void add_function_fixes(const Specification& specification, language::Range range, json& actions) const;
  [[nodiscard]] json action_of(const language::Fix& fix, const std::string& uri) const;

  Connection& connection_;
  Workspace workspace_;
  std::map<std::string, json (Session::*)(const json&)> requests_;
  EditAbilities edits_;
  std::set<std::string> checked_;  ///< texts whose mistakes the editor may show
  std::mutex mistakes_;
  std::map<std::string, std::set<std::string>>
      included_mistakes_;  ///< included files with mistakes, per text
  bool markdown_ = false;
  PictureForm pictures_form_ = PictureForm::none;
  Pictures pictures_;
  bool initialized_ = false;
  bool shut_down_ = false;
  const language::Grammar& grammar_;
  Checker checker_;  ///< last: its thread uses the rest
};

}  // namespace tessera::language_server
