#include "net/xml_text.hpp"

namespace tessera::net {

std::string xml_text(std::string_view text) {
  std::string safe;
  for (const char character : text) {
    switch (character) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default: {
        const auto byte = static_cast<unsigned char>(character);
        const bool control = byte < 0x20 && byte != '\t' && byte != '\n';
        safe += control ? '?' : character;
      }
    }
  }
  return safe;
}

}  // namespace tessera::net
