#include "faults.hpp"

#include <gmock/gmock.h>

#include "explore/explore.hpp"
#include "proved.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/verify.hpp"

namespace tessera::verify {
namespace {

TEST(Faults, AreFoundAndTheirCorrectedTwinsPass) {
  for (const Fault& fault : faults()) {
    SCOPED_TRACE(fault.name);
    const Proved faulty = proved(fault.faulty);
    const PropertyResult& bad = faulty[fault.property];
    EXPECT_EQ(bad.verdict, Verdict::violated) << bad.method << ": " << bad.why;
    EXPECT_NE(bad.why, "");
    if (std::string(fault.property) != "live_behaviours") {
      EXPECT_TRUE(bad.has_trace) << bad.why;
      const net::Net net = abstract_net(faulty.net, bad.exceptions ? Assume::exceptions : Assume::conditions);
      EXPECT_TRUE(explore::replay(explore::PtNet(net), bad.trace)) << "the run is none of the net";
      const bool tells_who_waits = bad.asks.empty() && std::string(fault.property) != "channels_flow";
      EXPECT_FALSE(bad.waits.empty() && tells_who_waits) << bad.why;
    }
    const Proved corrected = proved(fault.corrected);
    const PropertyResult& good = corrected[fault.property];
    EXPECT_EQ(good.verdict, Verdict::holds) << good.method << ": " << good.why;
  }
}

TEST(Faults, OneStuckAgentIsNoDeadlock) {
  const Proved fleet_of_51 = proved(fault("one stuck agent of 51").faulty);
  EXPECT_EQ(fleet_of_51["deadlock_free"].verdict, Verdict::holds);
  EXPECT_EQ(fleet_of_51["goes_on"].verdict, Verdict::violated);
  EXPECT_THAT(
      texts_of(fleet_of_51["goes_on"]),
      testing::Contains(testing::HasSubstr("odd.control waits for a value of odd.eye.y->odd.control.x")));
}

TEST(Faults, AWarningIsNoViolation) {
  const Proved pair = proved(fault("an error that ends what others wait for").faulty);
  EXPECT_EQ(pair["survives_exceptions"].verdict, Verdict::violated);
  EXPECT_EQ(pair.report.overall(), Verdict::holds);
}

TEST(Faults, AStoppedProofSaysSo) {
  const std::atomic<bool> stop{true};
  net::Net net;
  net::Place place;
  place.name = "p";
  place.tokens = 1;
  net.add(place);
  net::Transition loop;
  loop.name = "t";
  const std::vector<net::Arc> arcs{{net::PlaceId{0}, 1}};
  net.add(loop, arcs, arcs);
  ProveOptions options;
  options.stop = &stop;
  options.only = {"safe"};
  options.method = "explicit";
  const std::vector<net::Invariant> none;
  const Report report = prove({net, nullptr, none}, options);
  ASSERT_EQ(report.properties.size(), 1U);
  EXPECT_EQ(report.properties[0].verdict, Verdict::unknown);
  EXPECT_EQ(report.properties[0].why, "it was interrupted");
}

}  // namespace
}  // namespace tessera::verify
