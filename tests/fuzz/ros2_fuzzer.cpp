#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "ros2/codec/request_header.hpp"
#include "ros2/codec/translator.hpp"
#include "ros2/codec/value_type.hpp"
#include "ros2/codec/written_mapping.hpp"
#include "ros2/definitions/resolver.hpp"
#include "ros2/naming/names.hpp"

namespace {

using namespace tessera::ros2;

/// A definition with everything that definitions can have.
constexpr const char* rich_message = R"(bool flag
string<=8 word
string[] name
float64[] position
Part[] parts
Part[2] pair
int16[<=3] few
float32[3] three
uint8[] bytes
Nothing nothing
int64 last
================================================================================
MSG: fuzz/Part
int8 a
string b
float64 c 0.5
================================================================================
MSG: fuzz/Nothing
)";
constexpr const char* rich_value =
    "{flag: bool, word: string(8), position: float64[2], pair: {a: int16, b: string(4), c: float64}[2], "
    "three: float64[3], parts: {b: string(4), a: int16}[<=3], few: int16[<=5], bytes: uint8[<=8], last: "
    "int64}";
/// With the types of the message, so that it can be sent.
constexpr const char* same_value =
    "{flag: bool, word: string(8), position: float64[2], pair: {a: int8, b: string(4), c: float64}[2], "
    "three: float32[3], parts: {b: string(4), a: int8}[<=3], few: int16[<=3], bytes: uint8[<=8], last: "
    "int64}";

/// One definition, under any name.
class OneText final : public Definitions {
 public:
  explicit OneText(std::string text) : text_(std::move(text)) {}
  [[nodiscard]] std::optional<Text> find(const std::string& name) const override {
    return name == "fuzz/srv/Any" ? std::optional(Text{text_, name}) : std::nullopt;
  }
  [[nodiscard]] std::vector<std::string> names() const override { return {"fuzz/srv/Any"}; }

 private:
  std::string text_;
};

struct Case {
  Translator receive, send;
};
const Case& rich_case() {
  static const Case made = [] {
    std::vector<Mistake> mistakes;
    std::vector<MappingProblem> problems;
    const auto message = resolve("fuzz/msg/Rich", DefinitionBundle("fuzz/msg/Rich", rich_message), mistakes);
    const auto value = parse_value_type(rich_value);
    if (message == nullptr || !value) std::abort();
    const Mapping mapping{};  // names do not go together with sequences of the buffer
    auto receive = Translator::make(message, *value, mapping, Direction::receive, problems);
    const auto same = parse_value_type(same_value);
    auto send = Translator::make(message, *same, mapping, Direction::send, problems);
    if (!receive || !send) std::abort();
    return Case{*receive, *send};
  }();
  return made;
}

/// A message that is accepted can be sent on, and gives the same value again.
void try_message(std::span<const std::byte> bytes) {
  static const Translator back = [] {
    std::vector<Mistake> mistakes;
    std::vector<MappingProblem> problems;
    const auto message = resolve("fuzz/msg/Rich", DefinitionBundle("fuzz/msg/Rich", rich_message), mistakes);
    auto plan = Translator::make(message, *parse_value_type(same_value), {}, Direction::receive, problems);
    return plan ? *plan : rich_case().receive;
  }();
  std::vector<std::byte> value, again, other;
  static_cast<void>(rich_case().receive.decode(bytes, other));
  if (back.decode(bytes, value) != Translator::Outcome::good) return;
  std::vector<std::byte> message;
  if (!rich_case().send.encode(value, {}, message)) std::abort();
  if (back.decode(message, again) != Translator::Outcome::good || again != value) std::abort();
}

/// A message of a service: the header comes off and goes back, and the rest becomes a value with own fields.
void try_service_message(std::span<const std::byte> bytes) {
  static const Translator plan = [] {
    std::vector<Mistake> mistakes;
    std::vector<MappingProblem> problems;
    const auto message = resolve("fuzz/msg/Rich", DefinitionBundle("fuzz/msg/Rich", rich_message), mistakes);
    Mapping mapping{{}, {"left", "right"}, ""};
    mapping.own = own_fields_of_service(/*has_outcome=*/true);
    auto made =
        Translator::make(message,
                         *parse_value_type("{outcome: uint8, flag: bool, position: float64[2], call: uint64, "
                                           "word: string(8)}"),
                         mapping, Direction::receive, problems);
    if (!made) std::abort();
    return *made;
  }();
  std::vector<std::byte> message(bytes.begin(), bytes.end());
  const auto header = take_header(message);
  if (!header) return;
  std::vector<std::byte> again = message, same, value;
  put_header(*header, again);
  // The header is little-endian afterwards, whatever it was before.
  again[1] = std::byte{1};
  if (again.size() != bytes.size() || take_header(again) != header) std::abort();
  if (plan.decode(message, value, std::array<std::uint64_t, 2>{header->client, 3}) !=
      Translator::Outcome::good)
    return;
  if (plan.own_number(value, call_field) != header->client || plan.own_number(value, outcome_field) != 3)
    std::abort();
}

/// Both halves of a service are refused with a mistake, or are the same after they were written.
void try_service(const std::string& text) {
  std::vector<Mistake> mistakes;
  const auto service = resolve_service("fuzz/srv/Any", OneText(text), mistakes);
  if (service.has_value() != mistakes.empty()) std::abort();
  if (!service) return;
  for (const auto& [half, name] : {std::pair{service->request, request_type("fuzz/srv/Any")},
                                   {service->response, response_type("fuzz/srv/Any")}}) {
    const std::string written = bundle_of(*half);
    std::vector<Mistake> none;
    const auto again = resolve(name, DefinitionBundle(name, written), none);
    if (again == nullptr || bundle_of(*again) != written) std::abort();
  }
}

/// A definition is refused with a mistake, or is the same after it was written.
void try_definition(const std::string& text) {
  std::vector<Mistake> mistakes;
  const auto message = resolve("fuzz/msg/Any", DefinitionBundle("fuzz/msg/Any", text), mistakes);
  if ((message == nullptr) == mistakes.empty()) std::abort();
  if (message == nullptr) return;
  const std::string written = bundle_of(*message);
  std::vector<Mistake> none;
  const auto again = resolve("fuzz/msg/Any", DefinitionBundle("fuzz/msg/Any", written), none);
  if (again == nullptr || bundle_of(*again) != written) std::abort();
}

}  // namespace

/// The first byte chooses: a message, a value to be sent, a definition, a service, the type of a value, or a
/// message of a service.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data) + 1, size - 1);
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::vector<std::byte> message;
  switch (data[0] % 6) {
    case 0:
      try_message(bytes);
      break;
    case 1:
      static_cast<void>(rich_case().send.encode(bytes, {1, 2}, message));
      break;
    case 2:
      try_definition(text);
      break;
    case 3:
      try_service(text);
      break;
    case 5:
      try_service_message(bytes);
      break;
    default:
      static_cast<void>(parse_value_type(text));
  }
  return 0;
}
