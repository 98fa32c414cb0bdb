#pragma once

#include <httplib.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "server/http/json_text.hpp"

/// Requests and answers in JSON.
namespace tessera::server {

/// Sends the text without compression: most answers are short, and the connection is local.
void answer(httplib::Response& response, std::string text, int status = 200);
/// Sends the pieces one after the other. They are shared, not copied.
void answer_pieces(httplib::Response& response, std::vector<std::shared_ptr<const std::string>> pieces,
                   const std::string& type = "application/json");
/// The same, packed if they are long and the client accepts it.
void answer_packed(const httplib::Request& request, httplib::Response& response,
                   const std::vector<std::shared_ptr<const std::string>>& pieces);
[[nodiscard]] bool accepts_gzip(const httplib::Request& request);
/// {"error", "hint"}
void answer_error(httplib::Response& response, int status, std::string_view error,
                  std::string_view hint = {});

/// The body of a request: an object with members of known types. Mistakes in it go into the response.
class RequestBody {
 public:
  RequestBody(const httplib::Request& request, httplib::Response& response);
  /// false: it is no object, or a required member is missing or of another type; the response says so.
  [[nodiscard]] bool good() const { return good_; }

  [[nodiscard]] std::string text(const char* name);
  [[nodiscard]] std::string text_or(const char* name, std::string otherwise);
  [[nodiscard]] std::optional<double> number(const char* name);
  [[nodiscard]] bool flag(const char* name);
  /// Collects a member (numbers from 0 up) of the objects in a list of at most 10,000; skips objects without
  /// it.
  [[nodiscard]] std::vector<std::uint32_t> indices(const char* list, const char* member);
  [[nodiscard]] std::vector<std::string> texts(const char* name);
  /// A list of at most 10,000 objects; none if it is not given.
  [[nodiscard]] std::vector<nlohmann::json> objects(const char* name);
  /// An object of numbers and truth values; nullopt: it is none.
  [[nodiscard]] std::optional<std::map<std::string, std::variant<double, bool>>> inputs(const char* name);

 private:
  void complain(const std::string& what);
  [[nodiscard]] const nlohmann::json* find(const char* name) const;
  httplib::Response& response_;
  nlohmann::json json_;
  bool good_ = true;
};

}  // namespace tessera::server
