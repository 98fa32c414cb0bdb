#include "server/http/answer.hpp"

#include <algorithm>
#include <utility>

#include "server/http/packing.hpp"

namespace tessera::server {

using nlohmann::json;

void answer(httplib::Response& response, std::string text, int status) {
  answer_pieces(response, {std::make_shared<const std::string>(std::move(text))});
  response.status = status;
}

void answer_pieces(httplib::Response& response, std::vector<std::shared_ptr<const std::string>> pieces,
                   const std::string& type) {
  std::size_t size = 0;
  for (const auto& piece : pieces) size += piece->size();
  response.status = 200;
  response.set_content_provider(
      size, type,
      [pieces = std::move(pieces)](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        for (const auto& piece : pieces) {
          if (offset < piece->size())
            return sink.write(piece->data() + offset, std::min(length, piece->size() - offset));
          offset -= piece->size();
        }
        return false;
      });
}

bool accepts_gzip(const httplib::Request& request) {
  return request.get_header_value("Accept-Encoding").find("gzip") != std::string::npos;
}

void answer_packed(const httplib::Request& request, httplib::Response& response,
                   const std::vector<std::shared_ptr<const std::string>>& pieces) {
  constexpr std::size_t long_answer = std::size_t{64} << 10U;
  std::size_t size = 0;
  for (const auto& piece : pieces) size += piece->size();
  std::string packed;
  if (size >= long_answer && accepts_gzip(request)) packed = gzip(pieces, Effort::quick);
  if (packed.empty()) return answer_pieces(response, pieces);
  answer_pieces(response, {std::make_shared<const std::string>(std::move(packed))});
  response.set_header("Content-Encoding", "gzip");
}

void answer_error(httplib::Response& response, int status, std::string_view error, std::string_view hint) {
  response.status = status;
  response.set_content(text_of(json{{"error", error}, {"hint", hint}}), "application/json");
}

RequestBody::RequestBody(const httplib::Request& request, httplib::Response& response)
    : response_(response), json_(json::parse(request.body, nullptr, /*allow_exceptions=*/false)) {
  if (!json_.is_object()) complain("the body is no JSON object");
}

void RequestBody::complain(const std::string& what) {
  if (good_) answer_error(response_, 400, what);
  good_ = false;
}

const json* RequestBody::find(const char* name) const {
  if (!json_.is_object()) return nullptr;
  const auto found = json_.find(name);
  return found == json_.end() || found->is_null() ? nullptr : &*found;
}

std::string RequestBody::text(const char* name) {
  const json* member = find(name);
  if (member != nullptr && member->is_string()) return member->get<std::string>();
  complain(std::string("'") + name + "' has to be a text");
  return {};
}

std::string RequestBody::text_or(const char* name, std::string otherwise) {
  return find(name) == nullptr ? std::move(otherwise) : text(name);
}

std::optional<double> RequestBody::number(const char* name) {
  const json* member = find(name);
  if (member == nullptr) return std::nullopt;
  if (member->is_number()) return member->get<double>();
  complain(std::string("'") + name + "' has to be a number");
  return std::nullopt;
}

bool RequestBody::flag(const char* name) {
  const json* member = find(name);
  if (member == nullptr) return false;
  if (member->is_boolean()) return member->get<bool>();
  complain(std::string("'") + name + "' has to be true or false");
  return false;
}

std::vector<std::uint32_t> RequestBody::indices(const char* list, const char* member) {
  constexpr std::size_t most = 10'000;
  std::vector<std::uint32_t> numbers;
  const json* given = find(list);
  if (given == nullptr) return numbers;
  if (!given->is_array() || given->size() > most) {
    complain(std::string("'") + list + "' has to be a list");
    return numbers;
  }
  for (const json& one : *given) {
    if (!one.is_object()) complain(std::string("'") + list + "' has to be a list of objects");
    const auto found = one.is_object() ? one.find(member) : one.end();
    if (found == one.end()) continue;
    if (found->is_number_unsigned() && found->get<std::uint64_t>() < UINT32_MAX)
      numbers.push_back(found->get<std::uint32_t>());
    else
      complain(std::string("'") + member + "' has to be an index");
  }
  return numbers;
}

std::vector<json> RequestBody::objects(const char* name) {
  constexpr std::size_t most = 10'000;
  const json* member = find(name);
  if (member == nullptr) return {};
  if (member->is_array() && member->size() <= most && std::ranges::all_of(*member, &json::is_object))
    return member->get<std::vector<json>>();
  complain(std::string("'") + name + "' has to be a list of objects");
  return {};
}

std::optional<std::map<std::string, std::variant<double, bool>>> RequestBody::inputs(const char* name) {
  const json* member = find(name);
  if (member == nullptr) return std::nullopt;
  std::map<std::string, std::variant<double, bool>> inputs;
  if (!member->is_object()) complain(std::string("'") + name + "' has to be an object");
  for (const auto& [field, value] : member->items()) {
    if (value.is_boolean())
      inputs[field] = value.get<bool>();
    else if (value.is_number())
      inputs[field] = value.get<double>();
    else
      complain(std::string("'") + name + "' has to hold numbers and truth values");
  }
  return inputs;
}

std::vector<std::string> RequestBody::texts(const char* name) {
  const json* member = find(name);
  std::vector<std::string> texts;
  if (member == nullptr) return texts;
  if (member->is_array())
    for (const json& one : *member)
      if (one.is_string()) texts.push_back(one.get<std::string>());
  if (!member->is_array() || texts.size() != member->size())
    complain(std::string("'") + name + "' has to be a list of texts");
  return texts;
}

}  // namespace tessera::server
