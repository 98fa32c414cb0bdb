#include "language/language.hpp"

#include <utility>

namespace tessera::language {

Document::Document(std::string text, const Grammar& grammar, std::filesystem::path folder)
    : text_(std::move(text)),
      folder_(std::move(folder)),
      grammar_(grammar),
      lines_(text_),
      outline_(text_),
      index_(text_, outline_) {}

}  // namespace tessera::language
