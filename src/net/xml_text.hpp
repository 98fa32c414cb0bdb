#pragma once

#include <string>
#include <string_view>

namespace tessera::net {

/// Escapes a text for an XML element or a quoted attribute. UTF-8 stays as it is; characters that XML
/// 1.0 cannot hold become '?'.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace tessera::net
