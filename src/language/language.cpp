#include "language/language.hpp"

#include <utility>

namespace tessera::language {

Document::Document(std::string text, const Grammar& grammar)
    : text_(std::move(text)), grammar_(grammar), lines_(text_), outline_(text_), index_(text_, outline_) {}

}  // namespace tessera::language
