#include "tessera/context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "console.hpp"

namespace tessera {

void Context::print(LogLevel level, fmt::string_view format, fmt::format_args args) {
  std::array<char, 512> text;
  const auto end = fmt::vformat_to_n(text.data(), text.size(), format, args);
  const std::string_view cut(text.data(), std::min(end.size, text.size()));
  if (services_ != nullptr)
    services_->log(level, cut);
  else
    console::print(level, now, "test", cut);
}

}  // namespace tessera
