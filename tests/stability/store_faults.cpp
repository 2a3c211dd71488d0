// The N-th call of SQLite to the disk fails, N = 1, 2, ... until none is left: the program gets it as SystemError, the
// archive stays whole, what was shown is there, and running again ends with the same text.
#include "tests/support/failing_disk.hpp"
#include "tests/support/tried.hpp"
#include "tests/support/whole_campaign.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <string>

namespace grainsweep::tests::store_faults_test {

using Fault = FailingDisk::Fault;
using Calls = FailingDisk::Calls;
using Disk = store::Store::Disk;

struct Failing {
    Disk on;
    Calls calls;
    Fault fault;
    bool from_then_on;
    const char* name;
};

void PrintTo(const Failing& failing, std::ostream* stream) {
    *stream << failing.name;
}

/// "write-ahead log: each write, ... of SQLite fails once (EIO)"
std::string row_of(const Failing& failing) {
    return std::string(failing.on == Disk::local ? "write-ahead log: each " : "rollback journal: each ") +
           (failing.calls == Calls::changes ? "write, sync, truncation, removal" : "open, read, lock, size, map") +
           " of SQLite fails " + (failing.from_then_on ? "and all after it" : "once") +
           (failing.fault == Fault::full ? " (disk full)" : " (input/output error)");
}

class StoreFaults : public testing::TestWithParam<Failing> {};

bool is_sentence_of(const std::string& said, const Failing& failing) {
    if (failing.fault == Fault::full) return said.find("the disk is full") != std::string::npos;
    return said.find("failed") != std::string::npos ||
           (failing.calls == Calls::looks && said.find("cannot be opened") != std::string::npos);
}

TEST_P(StoreFaults, EveryFaultIsReportedAndSurvived) {
    const Failing& failing = GetParam();
    const WholeCampaign whole(5, failing.on);
    const std::string expected = whole.undisturbed();
    std::int64_t n = 1;
    int reported = 0;
    for (bool failed = true; failed; ++n) {
        ASSERT_LT(n, 5000) << "the run never gets by without meeting the fault";
        const Folder folder;
        const auto file = folder / "a.db";
        FailingDisk disk;
        disk.fail_at(n, failing.fault, failing.from_then_on, failing.calls);
        std::int64_t shown = -1;
        try {
            whole.run(file, [&](std::size_t settled) { shown = static_cast<std::int64_t>(settled); });
        } catch (const SystemError& broken) {
            ++reported;
            EXPECT_TRUE(is_sentence_of(broken.what(), failing)) << broken.what();
        }
        failed = disk.has_failed();
        disk.work_again();
        if (std::filesystem::exists(file)) {
            ASSERT_EQ(complaints(file), "ok") << "fault " << n;
            ASSERT_GE(completed_in(file), shown) << "fault " << n;
        } else {
            ASSERT_EQ(shown, -1) << "fault " << n << ": results were shown of an archive that was never made";
        }
        whole.run(file, [](std::size_t) {});
        ASSERT_EQ(dump_of(store::Store(file, store::Store::Mode::read)), expected) << "fault " << n;
    }
    EXPECT_GT(reported, 20) << "of " << n << " faults; those while closing cannot be reported";
    tried(row_of(failing), n - 2);
}

INSTANTIATE_TEST_SUITE_P(
    Disks, StoreFaults,
    testing::Values(Failing{Disk::local, Calls::changes, Fault::input_output, false, "LocalInputOutputOnce"},
                    Failing{Disk::local, Calls::changes, Fault::input_output, true, "LocalInputOutputFromThenOn"},
                    Failing{Disk::local, Calls::changes, Fault::full, false, "LocalFullOnce"},
                    Failing{Disk::local, Calls::changes, Fault::full, true, "LocalFullFromThenOn"},
                    Failing{Disk::local, Calls::looks, Fault::input_output, false, "LocalLookOnce"},
                    Failing{Disk::network, Calls::changes, Fault::input_output, false, "NetworkInputOutputOnce"},
                    Failing{Disk::network, Calls::changes, Fault::full, true, "NetworkFullFromThenOn"},
                    Failing{Disk::network, Calls::looks, Fault::input_output, false, "NetworkLookOnce"}),
    [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace grainsweep::tests::store_faults_test
