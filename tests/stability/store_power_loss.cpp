// The power goes after any write or sync. What was not synced is lost, kept, or reached the disk in scattered
// sectors; whatever was shown before is there, and the archive is whole.
#include "tests/support/failing_disk.hpp"
#include "tests/support/tried.hpp"
#include "tests/support/whole_campaign.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace grainsweep::tests::store_power_loss_test {

using Kind = FailingDisk::Event::Kind;

struct Recorded {
    WholeCampaign whole;
    std::vector<FailingDisk::Event> events;

    /// Two runs over one file, the second over the log's checkpoint, each shown count acknowledged.
    explicit Recorded(store::Store::Disk on) : whole(12, on) {
        const Folder folder;
        FailingDisk disk;
        const WholeCampaign first(6, on);
        first.run(folder / "a.db", [&](std::size_t settled) { disk.acknowledge(static_cast<std::int64_t>(settled)); });
        whole.run(folder / "a.db", [&](std::size_t settled) { disk.acknowledge(static_cast<std::int64_t>(settled)); });
        events = disk.events();
        std::erase_if(events, [](const auto& event) {
            return event.kind != Kind::acknowledge && !event.file.starts_with("a.db");
        });
    }
};

class StorePowerLoss : public testing::TestWithParam<std::tuple<store::Store::Disk, Unsynced>> {};

TEST_P(StorePowerLoss, WhatWasShownIsThere) {
    const auto [on, unsynced] = GetParam();
    const Recorded recorded(on);
    ASSERT_GT(recorded.events.size(), 100u);
    const std::string expected = recorded.whole.undisturbed();
    std::int64_t shown = -1;
    int resumed = 0;
    for (std::size_t count = 0; count <= recorded.events.size(); ++count) {
        if (count > 0 && recorded.events[count - 1].kind == Kind::acknowledge)
            shown = recorded.events[count - 1].offset;
        const Folder folder;
        const auto file = folder / "a.db";
        const auto disk = after_power_loss(recorded.events, count, unsynced, 7);
        write_disk(disk, folder.path());
        if (!disk.contains("a.db")) {
            EXPECT_EQ(shown, -1);
            continue;
        }
        ASSERT_EQ(complaints(file), "ok") << "after event " << count;
        ASSERT_GE(completed_in(file), shown) << "after event " << count;
        if (count % 8 != 0) continue;  // going on is dearer than looking
        recorded.whole.run(file, [](std::size_t) {});
        ASSERT_EQ(dump_of(store::Store(file, store::Store::Mode::read)), expected) << "after event " << count;
        ++resumed;
    }
    EXPECT_EQ(shown, 12);
    EXPECT_GT(resumed, 10);
    tried(std::string(on == store::Store::Disk::local ? "write-ahead log" : "rollback journal") +
              ": power lost after each write and sync, what was not synced " +
              (unsynced == Unsynced::lost   ? "lost"
               : unsynced == Unsynced::kept ? "kept"
                                            : "torn by sectors"),
          static_cast<std::int64_t>(recorded.events.size()) + 1);
}

std::string kind_name(const testing::TestParamInfo<StorePowerLoss::ParamType>& kind) {
    const auto [on, unsynced] = kind.param;
    return std::string(on == store::Store::Disk::local ? "Local" : "Network") + (unsynced == Unsynced::lost   ? "Lost"
                                                                                 : unsynced == Unsynced::kept ? "Kept"
                                                                                                              : "Torn");
}

INSTANTIATE_TEST_SUITE_P(Disks, StorePowerLoss,
                         testing::Combine(testing::Values(store::Store::Disk::local, store::Store::Disk::network),
                                          testing::Values(Unsynced::lost, Unsynced::kept, Unsynced::torn)),
                         kind_name);

}  // namespace grainsweep::tests::store_power_loss_test
