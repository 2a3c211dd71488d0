// Published benchmark suites (tests/reference/peers), those of a few seconds; the others: slow_peers_suites.
#include "tests/support/peer_suites.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests::peer_suites_test {

class PeerSuites : public testing::TestWithParam<PeerCase> {};

TEST_P(PeerSuites, AgreeWithinTheirTolerances) {
    compare_with_peers(GetParam());
}

INSTANTIATE_TEST_SUITE_P(, PeerSuites, testing::ValuesIn(peer_cases(false)),
                         [](const auto& one) { return one.param.suite + "_" + one.param.name; });

}  // namespace grainsweep::tests::peer_suites_test
