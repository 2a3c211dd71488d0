// The N-th write, sync, truncation or removal fails, N = 1, 2, ...: the program gets it as BrokenWorld, the
// archive stays whole, what was shown is there, and running again ends with the same text.
#include "tests/support/failing_disk.hpp"
#include "tests/support/whole_campaign.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace grainsweep::tests {
namespace {

class StoreFaults : public testing::TestWithParam<std::tuple<store::Store::Disk, FailingDisk::Fault, bool>> {};

TEST_P(StoreFaults, EveryFaultIsReportedAndSurvived) {
    const auto [on, fault, from_then_on] = GetParam();
    const WholeCampaign whole(5, on);
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
    EXPECT_GT(reported, 20) << "of " << n << " faults; those while closing cannot be reported";
}

std::string kind_name(const testing::TestParamInfo<StoreFaults::ParamType>& kind) {
    const auto [on, fault, from_then_on] = kind.param;
    return std::string(on == store::Store::Disk::local ? "Local" : "Network") +
           (fault == FailingDisk::Fault::full ? "Full" : "InputOutput") + (from_then_on ? "FromThenOn" : "Once");
}

using Fault = FailingDisk::Fault;
using Disk = store::Store::Disk;
INSTANTIATE_TEST_SUITE_P(Disks, StoreFaults,
                         testing::Values(std::tuple(Disk::local, Fault::input_output, false),
                                         std::tuple(Disk::local, Fault::input_output, true),
                                         std::tuple(Disk::local, Fault::full, true),
                                         std::tuple(Disk::network, Fault::input_output, false),
                                         std::tuple(Disk::network, Fault::full, true)),
                         kind_name);

}  // namespace
}  // namespace grainsweep::tests
