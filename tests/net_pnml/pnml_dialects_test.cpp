// Parts of PNML that other tools write. Each is read as what it means, or an error names it: a part that is passed
// over would make another net of the file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "diagnostics/source.hpp"
#include "net/pnml_reader.hpp"

namespace tessera::net {
namespace {

using testing::HasSubstr;

struct Read {
  std::optional<Net> net;
  std::vector<diagnostics::Diagnostic> messages;
};

Read read_document(const std::string& text) {
  diagnostics::Diagnostics out("net.pnml", text);
  Read result;
  result.net = read_pnml(out);
  result.messages = out.sorted();
  return result;
}

/// The net of these parts beside a place p with a token, a place q, and a transition t.
Read read_with(const std::string& parts, const std::string& net_attributes = "type='P/T net'") {
  return read_document("<pnml><net id='n' " + net_attributes +
                       ">\n<place id='p'><initialMarking><text>1</text></initialMarking>" +
                       "</place><place id='q'/><transition id='t'/>\n" + parts + "\n</net></pnml>");
}

struct Part {
  const char* name;
  const char* code;   ///< of the only message; "": there is none
  const char* names;  ///< in its text
  std::string text;   ///< on the third line
  bool is_read = false;
};

std::string arc(const std::string& attributes, const std::string& inside = "") {
  return "<arc id='a' source='p' target='t' " + attributes + ">" + inside + "</arc>";
}
std::string place(const std::string& attributes, const std::string& inside = "") {
  return "<place id='o' " + attributes + ">" + inside + "</place>";
}
std::string transition(const std::string& attributes, const std::string& inside = "") {
  return "<transition id='u' " + attributes + ">" + inside + "</transition>";
}

const Part parts[] = {
    {"InhibitorOfTapaal", "E423", "'tapnInhibitor'",
     arc("type='tapnInhibitor' inscription='[0,inf)' weight='1'")},
    {"InhibitorOfVerifypn", "E423", "'inhibitor'", arc("type='inhibitor'")},
    {"InhibitorInCapitals", "E423", "'INHIBITOR'", arc("type='INHIBITOR'")},
    {"InhibitorAsText", "E423", "'inhibitor'", arc("", "<type><text>inhibitor</text></type>")},
    {"InhibitorAsValue", "E423", "'inhibitor'", arc("", "<type><value>inhibitor</value></type>")},
    {"InhibitorOfPipe", "E423", "'inhibitor'", arc("", "<type value='inhibitor'/>")},
    {"InhibitorAsArctype", "E423", "'inhibitor'", arc("", "<arctype><text>inhibitor</text></arctype>")},
    {"InhibitorInside", "E423", "'inhibitor'", arc("", "<inhibitor/>")},
    {"InhibitorElement", "E423", "'inhibitorArc'", "<inhibitorArc source='p' target='t'/>"},
    {"InhibitorWrapped", "E423", "from 'p' to 't'", "<inhibitor>" + arc("") + "</inhibitor>"},
    {"NormalBesideInhibitor", "E423", "'inhibitor'", arc("type='inhibitor'", "<type value='normal'/>")},
    {"Reset", "E423", "'reset'", arc("type='reset'")},
    {"ResetAsText", "E423", "'reset'", arc("", "<type><text>reset</text></type>")},
    {"Test", "E423", "'test'", arc("type='test'")},
    {"ReadAsText", "E423", "'read'", arc("", "<type><text>read</text></type>")},
    {"Transport", "E423", "'transport'", arc("type='transport' inscription='[0,inf):1'")},
    {"TransportElement", "E423", "'transportArc'", "<transportArc source='p' transition='t' target='q'/>"},
    {"SnakesMultiset", "E428", "'multiset'",
     place("", "<initialMarking><multiset><token><object>1</object></token></multiset></initialMarking>")},
    {"SnakesInscription", "E428", "'inscription'",
     arc("",
         "<inscription><value><object type='int'>1</object></value>"
         "</inscription>")},
    {"Wrapper", "E428", "'group'", "<group>" + arc("") + "</group>"},
    {"UnknownOfPlace", "E428", "'bound'", place("", "<bound><text>2</text></bound>")},
    {"UnknownAttribute", "E428", "'guard'", arc("guard='x'")},
    {"UnknownOfTransition", "E428", "'delay'", transition("", "<delay><interval/></delay>")},
    {"UnknownOfNet", "E428", "'semantics'", "<semantics/>"},
    {"TextWithoutElement", "E428", "'3' in 'initialMarking'",
     place("", "<initialMarking>3</initialMarking>")},
    {"TextInNet", "E428", "'stray'", "stray"},
    {"TwoMarkings", "E428", "given twice",
     place("",
           "<initialMarking><text>1</text></initialMarking><initialMarking><text>2</text></initialMarking>")},
    {"MarkingTwice", "E428", "given twice",
     place("initialMarking='1'", "<initialMarking><text>2</text></initialMarking>")},
    {"TwoTexts", "E428", "more than one",
     place("", "<initialMarking><text>1</text><text>2</text></initialMarking>")},
    {"TextInTwoParts", "E428", "more than one",
     place("", "<initialMarking><text>1<!-- a comment -->2</text></initialMarking>")},
    {"NoText", "E428", "no value", place("", "<initialMarking/>")},
    {"AttributeTwice", "E428", "given twice", arc("type='normal' type='inhibitor'")},
    {"WeightAndInscription", "E428", "disagree", arc("weight='2' inscription='3'")},
    {"MarkedReference", "E428", "'initialMarking'",
     "<referencePlace id='r' ref='p'><initialMarking><text>1</text></initialMarking></referencePlace>"},
    {"Coloured", "E423", "'hlinitialMarking'",
     place("", "<hlinitialMarking><text>1'dot</text></hlinitialMarking>")},
    {"ColouredArc", "E423", "'hlinscription'", arc("", "<hlinscription><text>x</text></hlinscription>")},
    {"Sorts", "E423", "'declaration'", "<declaration><structure/></declaration>"},
    {"SortOfPlace", "E423", "'type'", place("", "<type><text>dot</text></type>")},
    {"GuardOfColours", "E423", "'condition'", transition("", "<condition><text>x</text></condition>")},
    {"TwoCapacities", "E428", "more than one",
     place("", "<capacity><text>0</text><text>1</text></capacity>")},
    {"CapacityWithMore", "E428", "'limit'", place("", "<capacity><text>0</text><limit>1</limit></capacity>")},
    {"TwoClasses", "E423", "'Default'",
     place("", "<initialMarking><value>Red,1</value></initialMarking>") +
         "<place id='o2'><initialMarking><value>"
         "Default,1</value></initialMarking></place><token id='Red'/>"},
    {"SharedPlaces", "E428", "'shared-place'", "<shared-place name='s' initialMarking='1'/>"},
    {"Capacity", "E429", "'capacity' '1'", place("", "<capacity><text>1</text></capacity>")},
    {"CapacityOfPipe", "E429", "'capacity'", place("", "<capacity><value>3</value></capacity>")},
    {"CapacityAttribute", "E429", "'capacity'", place("capacity='1'")},
    {"Invariant", "E429", "'invariant' '<= 5'", place("invariant='&lt;= 5'")},
    {"Interval", "E429", "'[2,4]'", arc("type='timed' inscription='[2,4]'")},
    {"IntervalWithoutEnd", "E429", "'[1,inf)'", arc("type='timed' inscription='[1,inf)'")},
    {"Urgent", "E429", "'urgent'", transition("urgent='true'")},
    {"Priority", "E429", "'priority'", transition("priority='2'")},
    {"Immediate", "E429", "'timed'", transition("", "<timed><value>true</value></timed>")},
    {"InactiveTagged", "E429", "'tagged'", arc("", "<tagged><value>true</value></tagged>")},
    {"WrongWeight", "E425", "weight 'x'", arc("weight='x'")},
    // These pass, with or without a word.
    {"Rate", "W421", "'rate' '0.3'", transition("", "<rate><value>0.3</value></rate>"), true},
    {"Player", "W421", "'player' '1'", transition("player='1'"), true},
    {"FinalMarkings", "W422", "final markings",
     "<finalmarkings><marking><place idref='q'><text>1</text></place></marking></finalmarkings>", true},
    {"Normal", "", "", arc("type='normal'"), true},
    {"TimedForEver", "", "", arc("type='timed' inscription='[0,inf)' weight='1'"), true},
    {"NormalOfTapaal", "", "", arc("type='normal' inscription='1' weight='1'"), true},
    {"NoCapacity", "", "", place("", "<capacity><value>0</value></capacity>"), true},
    {"NoInvariant", "", "", place("invariant='&lt; inf' initialMarking='0'"), true},
    {"ToolSpecific", "", "", place("", "<toolspecific tool='x'><capacity>1</capacity></toolspecific>"), true},
    {"Graphics", "", "", arc("", "<graphics><position x='1' y='2'/></graphics><arcpath id='0'/>"), true},
    {"ExponentialOfTapaal", "", "", transition("distribution='constant' value='1.0' weight='1.0' player='0'"),
     true},
};

class PnmlParts : public testing::TestWithParam<Part> {};

TEST_P(PnmlParts, AreReadOrNamed) {
  const Part& part = GetParam();
  const Read result = read_with(part.text);
  EXPECT_EQ(result.net.has_value(), part.is_read);
  if (part.code[0] == '\0') {
    EXPECT_TRUE(result.messages.empty()) << result.messages.front().message;
    return;
  }
  ASSERT_FALSE(result.messages.empty());
  const diagnostics::Diagnostic& first = result.messages.front();
  EXPECT_EQ(std::string(first.code), part.code) << first.message;
  EXPECT_THAT(first.message, HasSubstr(part.names));
  EXPECT_EQ(first.span.line, 3U) << first.message;
}

INSTANTIATE_TEST_SUITE_P(Dialects, PnmlParts, testing::ValuesIn(parts),
                         [](const testing::TestParamInfo<Part>& info) { return info.param.name; });

TEST(PnmlDialects, AnArcOfAllTransitionsMayHaveTheSamePriority) {
  const Read result = read_document(
      "<pnml><net id='n' type='P/T net'><transition id='t' priority='2'/><transition id='u' priority='2'/>"
      "</net></pnml>");
  EXPECT_TRUE(result.net);
}

TEST(PnmlDialects, MarkingsAndWeightsOfPipe) {
  const Read result = read_with(
      "<token id='Default' enabled='true' red='0'/><token id='Red' enabled='false'/>"
      "<place id='r'><initialMarking><value>Default,3,Red,0</value></initialMarking></place>"
      "<place id='s'><initialMarking><value>Red,0,Default,2</value></initialMarking></place>"
      "<arc id='a' source='r' target='t'><inscription><value>Default,2</value></inscription></arc>");
  ASSERT_TRUE(result.net) << result.messages.front().message;
  EXPECT_EQ(result.net->places()[2].tokens, 3U);
  EXPECT_EQ(result.net->places()[3].tokens, 2U);
  EXPECT_EQ(result.net->preset(TransitionId{0})[0].weight, 2U);
}

TEST(PnmlDialects, NamesMarkingsAndWeightsOfTapaal) {
  const Read result = read_document(
      "<pnml xmlns='http://www.informatik.hu-berlin.de/top/pnml/ptNetb'><net active='true' id='n' type='P/T "
      "net'>"
      "<place displayName='true' id='P0' initialMarking='2' invariant='&lt; inf' name='first' "
      "nameOffsetX='1' "
      "positionX='1'/><transition angle='0' id='T0' infiniteServer='false' name='go' priority='0' "
      "urgent='false'/>"
      "<arc id='P0 to T0' inscription='[0,inf)' source='P0' target='T0' type='timed' weight='2'>"
      "<arcpath arcPointType='false' id='0' xCoord='1' yCoord='1'/></arc></net>"
      "<query name='q'/><k-bound bound='3'/><feature isGame='false' isTimed='true'/></pnml>");
  ASSERT_TRUE(result.net) << result.messages.front().message;
  EXPECT_EQ(result.net->places()[0].name, "first");
  EXPECT_EQ(result.net->places()[0].tokens, 2U);
  EXPECT_EQ(result.net->transitions()[0].name, "go");
  EXPECT_EQ(result.net->preset(TransitionId{0})[0].weight, 2U);
}

TEST(PnmlDialects, ArcsOfVerifypn) {
  const Read result = read_with(
      "<inputArc source='p' target='t'><inscription><value>1</value></inscription></inputArc>"
      "<outputArc source='t' target='q'><inscription><value>3</value></inscription></outputArc>");
  ASSERT_TRUE(result.net) << result.messages.front().message;
  EXPECT_EQ(result.net->postset(TransitionId{0})[0].weight, 3U);
}

TEST(PnmlDialects, IdsOfArcsAndPagesMayRepeat) {
  const Read result = read_with(
      "<page id='p'/><arc id='a' source='p' target='t'/><arc id='a' source='t' target='q'/>"
      "<arc id='q' source='t' target='q'/>");
  ASSERT_TRUE(result.net) << result.messages.front().message;
  EXPECT_EQ(result.net->postset(TransitionId{0})[0].weight, 2U);
}

TEST(PnmlDialects, TypesOfNets) {
  for (const char* type : {"", "ptnet", "PTNet", "P/T net", "http://www.pnml.org/version-2009/grammar/ptnet",
                           "http://www.informatik.hu-berlin.de/top/pntd/ptNetb",
                           "http://www.pnml.org/version-2009/grammar/pnmlcoremodel"})
    EXPECT_TRUE(read_with("", std::string("type='") + type + "'").net) << type;
  for (const char* type : {"http://www.pnml.org/version-2009/grammar/inhibitorptnet", "timedptnet", "ptnetx",
                           "http://www.pnml.org/version-2009/grammar/highlevelnet", "stochastic"})
    EXPECT_FALSE(read_with("", std::string("type='") + type + "'").net) << type;
}

TEST(PnmlDialects, TheSameIsSaidOnce) {
  std::string arcs;
  for (int i = 0; i < 5; ++i) arcs += arc("type='inhibitor'");
  const Read result = read_with(arcs);
  ASSERT_EQ(result.messages.size(), 1U);
  EXPECT_THAT(result.messages[0].message, HasSubstr("(5 times in the file)"));
}

/// Nets of the field, with the outcomes that their README gives.
TEST(PnmlDialects, FilesOfTheField) {
  const char* data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const std::filesystem::path folder = std::filesystem::path(data) / "field/pnml";
  struct File {
    const char* name;
    const char* code;  ///< of the error; "": it is read
    const char* names;
  };
  for (const File& file :
       {File{"arc_ids.pnml", "", ""}, File{"core_prom.pnml", "", ""},
        File{"inhibitor_child.pnml", "E423", "'stop' to 'go'"},
        File{"inhibitor_childtext.pnml", "E423", "'stop' to 'go'"},
        File{"inhibitor_net.pnml", "E423", "'stop' to 'go'"},
        File{"inhibitor_nettype.pnml", "E423", "inhibitorptnet"},
        File{"inhibitor_reset.pnml", "E423", "'reset'"},
        File{"inhibitor_tapn.pnml", "E423", "'tapnInhibitor'"}, File{"inhibitor_test.pnml", "E423", "'test'"},
        File{"inhibitor_wrapped.pnml", "E423", "'stop' to 'go'"},
        File{"marking_capacity.pnml", "E429", "'capacity' '1'"},
        File{"marking_hl-untyped.pnml", "E423", "'hlinitialMarking'"}, File{"marking_pipe.pnml", "", ""},
        File{"marking_pipe5-coloured.pnml", "E429", "'capacity' '1'"},
        File{"marking_tapaal.pnml", "E429", "'invariant' '<= 5'"}, File{"suffix_net.PNML", "", ""},
        File{"suffix_net.xml", "", ""}, File{"suffix_plain.tapn", "", ""}}) {
    diagnostics::Diagnostics out = diagnostics::load(folder / file.name);
    ASSERT_FALSE(out.has_errors()) << file.name;
    EXPECT_TRUE(diagnostics::is_xml(out.text())) << file.name;
    const std::optional<Net> net = read_pnml(out);
    EXPECT_EQ(net.has_value(), file.code[0] == '\0') << file.name << "\n" << render(out);
    if (net) continue;
    EXPECT_EQ(std::string(out.sorted().front().code), file.code) << file.name;
    EXPECT_THAT(out.sorted().front().message, HasSubstr(file.names)) << file.name;
  }
}

}  // namespace
}  // namespace tessera::net
