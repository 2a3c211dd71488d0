// Published benchmark suites (tests/reference/peers), those of minutes; the others: test_physics, PeerSuites.
#include "tests/support/peer_suites.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests::peers_suites_slow {

class SlowPeerSuites : public testing::TestWithParam<PeerCase> {};

TEST_P(SlowPeerSuites, AgreeWithinTheirTolerances) {
    compare_with_peers(GetParam());
}

INSTANTIATE_TEST_SUITE_P(, SlowPeerSuites, testing::ValuesIn(peer_cases(true)),
                         [](const auto& one) { return one.param.suite + "_" + one.param.name; });

}  // namespace grainsweep::tests::peers_suites_slow
