#include "tessera/context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "system/console.hpp"

namespace tessera {

namespace {

using Text = std::array<char, 512>;

/// The formatted text, cut to the available space.
[[nodiscard]] std::string_view format_into(Text& text, fmt::string_view format, fmt::format_args args) {
  const auto end = fmt::vformat_to_n(text.data(), text.size(), format, args);
  return {text.data(), std::min(end.size, text.size())};
}

}  // namespace

void Context::report_broken(fmt::string_view format, fmt::format_args args) {
  Text text;
  const std::string_view cut = format_into(text, format, args);
  if (services_ == nullptr) throw BrokenAssertion(std::string(cut));
  services_->broken(cut);
}

void Context::print(LogLevel level, fmt::string_view format, fmt::format_args args) {
  Text text;
  const std::string_view cut = format_into(text, format, args);
  if (services_ != nullptr)
    services_->log(level, cut);
  else
    console::print(level, now, "test", cut);
}

}  // namespace tessera
