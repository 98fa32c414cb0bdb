#include "net/xml_text.hpp"

#include <gtest/gtest.h>

namespace tessera::net {
namespace {

TEST(XmlText, EscapesMarkupAndReplacesControlCharacters) {
  EXPECT_EQ(xml_text("a<b & \"c\">\x01"), "a&lt;b &amp; &quot;c&quot;&gt;?");
}

}  // namespace
}  // namespace tessera::net
