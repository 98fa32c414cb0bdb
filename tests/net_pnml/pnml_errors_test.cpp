#include <gtest/gtest.h>

#include "net/pnml_reader.hpp"

namespace tessera::net {
namespace {

/// A wrong document and all its messages.
struct Wrong {
  const char* name;
  std::string text;
  std::string complaints;
};

std::string document(const std::string& inside) {
  return "<pnml>\n<net id='n' type='ptnet'>\n" + inside + "\n</net>\n</pnml>\n";
}

class PnmlErrors : public testing::TestWithParam<Wrong> {};

TEST_P(PnmlErrors, AreNamedWithTheirPlace) {
  diagnostics::Diagnostics out("net.pnml", GetParam().text);
  EXPECT_FALSE(read_pnml(out));
  std::string complaints;
  for (const auto& one : out.sorted())
    complaints += std::to_string(one.span.line) + ":" + std::to_string(one.span.column) + ": " + one.code +
                  ": " + one.message + (one.hint.empty() ? "" : " (" + one.hint + ")") + "\n";
  EXPECT_EQ(complaints, GetParam().complaints);
}

std::string bomb() {
  std::string text = "<!DOCTYPE pnml [\n<!ENTITY a 'aaaaaaaaaa'>\n";
  for (char name = 'b'; name < 'k'; ++name) {
    const std::string before(1, static_cast<char>(name - 1));
    text += std::string("<!ENTITY ") + name + " '";
    for (int times = 0; times < 10; ++times) text += "&" + before + ";";
    text += "'>\n";
  }
  return text + "]>\n<pnml><net id='n'><place id='a'><name><text>&j;</text></name></place></net></pnml>";
}

const Wrong cases[] = {
    {"Empty", "",
     "1:1: E420: this is not well-formed XML: no document element found (the file has no element at all)\n"},
    {"NotXml", "places: 3\n",
     "2:1: E420: this is not well-formed XML: no document element found (the file has no element at all)\n"},
    {"Truncated", "<pnml>\n<net id='n'>\n<place id='a'",
     "3:13: E420: this is not well-formed XML: error parsing start element tag\n"},
    {"TruncatedBetweenElements", "<pnml>\n<net id='n'>\n<place id='a'/>\n",
     "3:16: E420: this is not well-formed XML: start-end tags mismatch\n"},
    {"EntityBomb", bomb(),
     "1:11: E421: the document type declares entities or elements of its own (PNML needs no DOCTYPE; remove "
     "it)\n"},
    {"OtherRoot", "<html/>\n",
     "1:2: E422: this is not PNML: the root element is 'html' (a PNML file starts with <pnml>)\n"},
    {"NoNet", "<pnml>\n</pnml>\n", "1:2: E422: the file has no net\n"},
    {"TwoNets", "<pnml>\n<net id='a'/>\n<net id='b'/>\n</pnml>\n",
     "3:2: E422: the file has more than one net (keep one net per file)\n"},
    {"Coloured", "<pnml><net id='n' type='http://www.pnml.org/version-2009/grammar/symmetricnet'/></pnml>",
     "1:8: E423: this is a coloured net: its type is 'http://www.pnml.org/version-2009/grammar/symmetricnet' "
     "(unfold it "
     "to a place/transition net first)\n"},
    {"OtherType", "<pnml><net id='n' type='timed'/></pnml>",
     "1:8: E423: this is not a place/transition net: its type is 'timed' (if it is one, its type is "
     "http://www.pnml.org/version-2009/grammar/ptnet)\n"},
    {"TypeThatContainsTheWord", "<pnml><net id='n' type='http://x/inhibitorptnet'/></pnml>",
     "1:8: E423: this is not a place/transition net: its type is 'http://x/inhibitorptnet' (if it is one, "
     "its type "
     "is http://www.pnml.org/version-2009/grammar/ptnet)\n"},
    {"InhibitorArc",
     document("<place id='p'/><transition id='t'/>\n<arc id='a' source='p' target='t'><type "
              "value='inhibitor'/></arc>"),
     "4:2: E423: the arc from 'p' to 't' is of the kind 'inhibitor', which place/transition nets do not have "
     "(if the place can hold n tokens, give it a partner of n minus its tokens, filled where it is emptied, "
     "and "
     "read the partner with weight n)\n"},
    {"MissingIds", document("<place/>\n<transition id=''/>"),
     "3:2: E424: this place has no id\n4:2: E424: this transition has no id\n"},
    {"DuplicateIds", document("<place id='a'/>\n<transition id='a'/>\n<page id='a'/>"),
     "4:2: E424: the id 'a' is given twice\n"},
    {"Markings",
     document("<place id='a'><initialMarking><text>-1</text></initialMarking></place>\n"
              "<place id='b'><initialMarking><text>99999999999999999999</text></initialMarking></place>\n"
              "<place id='c'><initialMarking><text>2147483648</text></initialMarking></place>\n"
              "<place id='d'><initialMarking><text>1.5</text></initialMarking></place>\n"
              "<place id='e'><initialMarking><text/></initialMarking></place>"),
     "3:37: E425: marking '-1' is not a whole number from 0 to 2147483647\n"
     "4:37: E425: marking '99999999999999999999' is not a whole number from 0 to 2147483647\n"
     "5:37: E425: marking '2147483648' is not a whole number from 0 to 2147483647\n"
     "6:37: E425: marking '1.5' is not a whole number from 0 to 2147483647\n"
     "7:32: E425: marking '' is not a whole number from 0 to 2147483647\n"},
    {"Weights",
     document("<place id='p'/><transition id='t'/>\n"
              "<arc id='a' source='p' target='t'><inscription><text>0</text></inscription></arc>\n"
              "<arc id='b' source='t' target='p'><inscription><text>2147483647</text></inscription></arc>\n"
              "<arc id='c' source='t' target='p'/>"),
     "4:54: E425: weight '0' is not a whole number from 1 to 2147483647\n"
     "6:2: E425: the weights of parallel arcs are too large in sum\n"},
    {"Arcs",
     document("<place id='p'/><place id='q'/><transition id='t'/><transition id='u'/><page id='g'/>\n"
              "<arc id='a' source='p' target='q'/>\n<arc id='b' source='t' target='u'/>\n"
              "<arc id='c' source='p' target='nowhere'/>\n<arc id='d' target='t'/>\n"
              "<arc id='e' source='g' target='t'/>"),
     "4:2: E426: this arc joins two places\n5:2: E426: this arc joins two transitions\n"
     "6:2: E426: the target of this arc, 'nowhere', is no place or transition\n"
     "7:2: E426: the source of this arc, '', is no place or transition\n"
     "8:2: E426: the source of this arc, 'g', is no place or transition\n"},
    {"References",
     document("<place id='p'/><transition id='t'/>\n<referencePlace id='r' ref='gone'/>\n"
              "<referencePlace id='s' ref='t'/>\n<referenceTransition id='u' ref='p'/>\n"
              "<referencePlace id='v' ref='v'/>"),
     "4:2: E427: this reference leads to 'gone', which is no place or transition\n"
     "5:2: E427: this reference place refers to a transition\n"
     "6:2: E427: this reference transition refers to a place\n7:2: E427: this reference leads back to "
     "itself\n"},
};

std::string name_of(const testing::TestParamInfo<Wrong>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Corpus, PnmlErrors, testing::ValuesIn(cases), name_of);

}  // namespace
}  // namespace tessera::net
