#include "mcap/byte_order.hpp"

#include <utility>

namespace tessera::mcap {

void put_text(std::string& to, std::string_view text) {
  put_number(to, static_cast<std::uint32_t>(text.size()));
  to += text;
}

void put_map(std::string& to, const std::map<std::string, std::string>& map) {
  std::string entries;
  for (const auto& [key, value] : map) {
    put_text(entries, key);
    put_text(entries, value);
  }
  put_text(to, entries);
}

std::string_view Cursor::take(std::uint64_t count) {
  if (!ok_ || count > rest_.size()) {
    ok_ = false;
    return {};
  }
  const std::string_view taken = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return taken;
}

std::map<std::string, std::string> Cursor::map() {
  std::map<std::string, std::string> map;
  Cursor entries(take(number<std::uint32_t>()));
  while (entries.ok() && !entries.rest().empty()) {
    std::string key = entries.text();
    map[std::move(key)] = entries.text();
  }
  ok_ = ok_ && entries.ok();
  return map;
}

}  // namespace tessera::mcap
