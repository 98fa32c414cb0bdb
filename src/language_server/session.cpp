#include "language_server/session.hpp"

#include <algorithm>
#include <exception>

namespace tessera::language_server {

using nlohmann::json;

namespace {

constexpr int parse_error = -32700, invalid_request = -32600, method_not_found = -32601,
              invalid_params = -32602, internal_error = -32603, not_initialized = -32002;
/// After the last key: long enough that a word is written, short enough to be felt as at once.
constexpr std::chrono::milliseconds check_delay{150};

bool has(const json& object, std::initializer_list<const char*> keys) {
  const json* at = &object;
  for (const char* key : keys) {
    if (!at->is_object() || !at->contains(key)) return false;
    at = &(*at)[key];
  }
  return !at->is_boolean() || at->get<bool>();
}

/// A value of the options that an editor may give: {"pictures": "embedded"}.
PictureForm picture_form(const json& options) {
  const json form = options.is_object() ? options.value("pictures", json()) : json();
  return form == "embedded" ? PictureForm::embedded : form == "none" ? PictureForm::none : PictureForm::file;
}

}  // namespace

Session::Session(Connection& connection, const language::Grammar& grammar)
    : connection_(connection),
      workspace_(grammar),
      requests_{{"textDocument/completion", &Session::completion},
                {"textDocument/hover", &Session::hover},
                {"textDocument/definition", &Session::definition},
                {"textDocument/references", &Session::references},
                {"textDocument/prepareRename", &Session::prepare_rename},
                {"textDocument/rename", &Session::rename},
                {"textDocument/codeAction", &Session::code_actions},
                {"textDocument/documentSymbol", &Session::symbols}},
      grammar_(grammar),
      checker_(check_delay,
               [this](const Checker::Text& text, const Checked& checked) { publish(text, checked); }) {}

std::optional<int> Session::handle(const Connection::Incoming& incoming) {
  const json& message = incoming.message;
  if (!incoming.readable) {
    answer_error(nullptr, parse_error, "this is not JSON");
    return std::nullopt;
  }
  if (!message.is_object() || !message.contains("method") || !message["method"].is_string()) {
    // Answers to requests of ours need none; there are no such requests.
    if (!message.is_object() || !(message.contains("result") || message.contains("error")))
      answer_error(nullptr, invalid_request, "this is no message of JSON-RPC");
    return std::nullopt;
  }
  const auto method = message["method"].get<std::string>();
  if (method == "exit") return shut_down_ ? 0 : 1;
  const json parameters = message.value("params", json::object());
  if (message.contains("id")) {
    request(message["id"], method, parameters);
  } else {
    notification(method, parameters);
  }
  return std::nullopt;
}

void Session::answer_error(const json& id, int code, const std::string& message) {
  connection_.write({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", message}}}});
}

void Session::request(const json& id, const std::string& method, const json& parameters) {
  try {
    if (shut_down_) throw RequestError{invalid_request, "the server was shut down"};
    json result;
    if (method == "initialize") {
      result = initialize(parameters);
    } else if (!initialized_) {
      throw RequestError{not_initialized, "the first request is initialize"};
    } else if (method == "shutdown") {
      shut_down_ = true;
    } else {
      const auto known = requests_.find(method);
      if (known == requests_.end())
        throw RequestError{method_not_found, "this server has no method " + method};
      result = (this->*known->second)(parameters);
    }
    connection_.write({{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}});
  } catch (const RequestError& error) {
    answer_error(id, error.code, error.message);
  } catch (const json::exception& error) {
    answer_error(id, invalid_params, error.what());
  } catch (const std::exception& error) {
    answer_error(id, internal_error, error.what());
  }
}

void Session::notification(const std::string& method, const json& parameters) {
  if (!initialized_) return;
  try {
    if (method == "textDocument/didOpen") did_open(parameters);
    if (method == "textDocument/didChange") did_change(parameters);
    if (method == "textDocument/didClose") did_close(parameters);
    if (method == "textDocument/didSave") did_save(parameters);
  } catch (const std::exception& error) {
    // A notification has no answer. The editor shows this in its log.
    connection_.write({{"jsonrpc", "2.0"},
                       {"method", "window/logMessage"},
                       {"params", {{"type", 1}, {"message", method + ": " + error.what()}}}});
  }
}

json Session::initialize(const json& parameters) {
  const json abilities = parameters.value("capabilities", json::object());
  edits_.document_changes = has(abilities, {"workspace", "workspaceEdit", "documentChanges"});
  edits_.annotations =
      edits_.document_changes && has(abilities, {"workspace", "workspaceEdit", "changeAnnotationSupport"});
  if (has(abilities, {"workspace", "workspaceEdit", "resourceOperations"})) {
    const json& operations = abilities["workspace"]["workspaceEdit"]["resourceOperations"];
    edits_.new_files = edits_.document_changes && operations.is_array() &&
                       std::find(operations.begin(), operations.end(), "create") != operations.end();
  }
  if (has(abilities, {"textDocument", "hover", "contentFormat"})) {
    const json& formats = abilities["textDocument"]["hover"]["contentFormat"];
    markdown_ = formats.is_array() && std::find(formats.begin(), formats.end(), "markdown") != formats.end();
  }
  if (markdown_) pictures_form_ = picture_form(parameters.value("initializationOptions", json()));
  initialized_ = true;
  return {{"capabilities",
           {{"positionEncoding", "utf-16"},
            {"textDocumentSync", {{"openClose", true}, {"change", 2}, {"save", true}}},
            {"completionProvider", {{"triggerCharacters", {".", " ", ":", ">", "[", "{"}}}},
            {"hoverProvider", true},
            {"definitionProvider", true},
            {"referencesProvider", true},
            {"renameProvider", {{"prepareProvider", true}}},
            {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
            {"documentSymbolProvider", true}}},
          {"serverInfo", {{"name", "tessera"}}}};
}

void Session::did_open(const json& parameters) {
  const json& document = parameters.at("textDocument");
  Workspace::Open open{document.at("uri"), document.at("text"), document.value("version", std::int64_t{0})};
  check_later(open);
  workspace_.open(std::move(open));
}

void Session::did_change(const json& parameters) {
  const json& document = parameters.at("textDocument");
  Workspace::Open* open = workspace_.find(document.at("uri"));
  if (open == nullptr) return;
  for (const json& change : parameters.at("contentChanges")) {
    const auto text = change.at("text").get<std::string>();
    if (change.contains("range")) {
      language::replace(open->text, range_of(change.at("range")), text);
    } else {
      open->text = text;
    }
  }
  if (document.contains("version") && document["version"].is_number_integer())
    open->version = document["version"];
  check_later(*open);
}

void Session::did_close(const json& parameters) {
  const auto uri = parameters.at("textDocument").at("uri").get<std::string>();
  workspace_.close(uri);
  take_back(uri);
}

/// Specifications that include the file are checked again: they read it as it is saved.
void Session::did_save(const json& parameters) {
  const auto uri = parameters.at("textDocument").at("uri").get<std::string>();
  if (checked_.contains(uri)) return;  // checked as it is typed
  for (const auto& [specification, document] : workspace_.all())
    if (checked_.contains(specification) &&
        language::Document(document.text, grammar_).outline().root().find("include"))
      check_later(document);
}

/// The mistakes of a text that is no specification any more.
void Session::take_back(const std::string& uri) {
  if (checked_.erase(uri) == 0) return;
  checker_.forget(uri);
  publish_included(uri, {});
  pictures_.forget(uri);
  connection_.write({{"jsonrpc", "2.0"},
                     {"method", "textDocument/publishDiagnostics"},
                     {"params", {{"uri", uri}, {"diagnostics", json::array()}}}});
}

void Session::check_later(const Workspace::Open& document) {
  if (!workspace_.is_specification(path_of(document.uri), document.text)) return take_back(document.uri);
  checked_.insert(document.uri);
  checker_.changed({document.uri, document.text, document.version});
}

void Session::publish(const Checker::Text& text, const Checked& checked) {
  pictures_.keep(text.uri, text.text, checked.pages);
  const language::Document document(text.text, grammar_);
  json list = json::array();
  for (const diagnostics::Diagnostic& one : checked.found) list.push_back(to_json(one, document));
  publish_included(text.uri, checked);
  connection_.write(
      {{"jsonrpc", "2.0"},
       {"method", "textDocument/publishDiagnostics"},
       {"params", {{"uri", text.uri}, {"version", text.version}, {"diagnostics", std::move(list)}}}});
}

/// Mistakes are shown in the file in which they are. Those that are not there any more are taken back.
void Session::publish_included(const std::string& uri, const Checked& checked) {
  const std::lock_guard lock(mistakes_);
  std::set<std::string> with_mistakes;
  const auto write = [&](const std::string& file, json list) {
    connection_.write({{"jsonrpc", "2.0"},
                       {"method", "textDocument/publishDiagnostics"},
                       {"params", {{"uri", file}, {"diagnostics", std::move(list)}}}});
  };
  for (const IncludedFile& one : checked.included) {
    if (one.found.empty()) continue;
    const language::Document document(one.text, grammar_);
    json list = json::array();
    for (const diagnostics::Diagnostic& mistake : one.found) list.push_back(to_json(mistake, document));
    const std::string file = uri_of(one.path);
    with_mistakes.insert(file);
    write(file, std::move(list));
  }
  std::set<std::string>& before = included_mistakes_[uri];
  for (const std::string& file : before)
    if (!with_mistakes.contains(file)) write(file, json::array());
  before = std::move(with_mistakes);
}

}  // namespace tessera::language_server
