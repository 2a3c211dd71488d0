// The N-th write, sync, truncation or removal fails, N = 1, 2, ...: the program hears of it as BrokenWorld, the
// archive stays whole, what was shown is there, and running again ends with the same text.
#include "tests/support/failing_disk.hpp"
#include "tests/support/whole_campaign.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace grainsweep::tests {
namespace {

class StoreFaults : public testing::TestWithParam<std::tuple<FailingDisk::Fault, bool>> {};

TEST_P(StoreFaults, EveryFaultIsReportedAndSurvived) {
    const auto [fault, from_then_on] = GetParam();
    const WholeCampaign whole(7);
    const std::string expected = whole.undisturbed();
    std::int64_t n = 1;
    int reported = 0;
    for (bool failed = true; failed; ++n) {
        ASSERT_LT(n, 2000) << "the run never gets by without meeting the fault";
        const Folder folder;
        const auto file = folder / "a.db";
        FailingDisk disk;
        disk.fail_at(n, fault, from_then_on);
        std::int64_t shown = -1;
        try {
            whole.run(file, [&](std::size_t settled) { shown = static_cast<std::int64_t>(settled); });
        } catch (const store::BrokenWorld& broken) {
            ++reported;
            EXPECT_NE(
                std::string(broken.what()).find(fault == FailingDisk::Fault::full ? "the disk is full" : "failed"),
                std::string::npos)
                << broken.what();
        }
        failed = disk.has_failed();
        disk.work_again();
        ASSERT_EQ(complaints(file), "ok") << "fault " << n;
        ASSERT_GE(completed_in(file), shown) << "fault " << n;
        whole.run(file, [](std::size_t) {});
        ASSERT_EQ(dump_of(store::Store(file, store::Store::Mode::read)), expected) << "fault " << n;
    }
    EXPECT_GT(reported, 20) << "of " << n << " faults; those while closing have nobody to hear them";
}

INSTANTIATE_TEST_SUITE_P(Kinds, StoreFaults,
                         testing::Combine(testing::Values(FailingDisk::Fault::input_output, FailingDisk::Fault::full),
                                          testing::Bool()),
                         [](const auto& kind) {
                             return std::string(std::get<0>(kind.param) == FailingDisk::Fault::full ? "Full"
                                                                                                    : "InputOutput") +
                                    (std::get<1>(kind.param) ? "FromThenOn" : "Once");
                         });

}  // namespace
}  // namespace grainsweep::tests
