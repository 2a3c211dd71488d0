// The main program is killed (SIGKILL) after the k-th thing it showed, for every k; the disk's quota ends in mid-write.
// The next main program needs no unlocking, finds what was shown, and ends with the undisturbed text.
#include "sweep/store/database.hpp"
#include "tests/support/failing_disk.hpp"
#include "tests/support/whole_campaign.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <utility>

namespace grainsweep::tests::store_kill_test {

/// Runs the campaign in a child that tells each number it shows through a pipe and then waits for leave to go on.
class Child {
public:
    Child(const WholeCampaign& whole, const std::filesystem::path& file) {
        int told[2] = {-1, -1};
        int leave[2] = {-1, -1};
        if (pipe(told) != 0 || pipe(leave) != 0) throw std::runtime_error("no pipe");
        process_ = fork();
        if (process_ == 0) {
            close(told[0]);
            close(leave[1]);
            try {
                whole.run(file, [&](std::size_t settled) {
                    auto byte = static_cast<unsigned char>(settled);
                    if (write(told[1], &byte, 1) != 1 || read(leave[0], &byte, 1) != 1) _exit(3);
                });
            } catch (const std::exception&) {
                _exit(2);
            }
            _exit(0);
        }
        close(told[1]);
        close(leave[0]);
        told_ = told[0];
        leave_ = leave[1];
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
        close(told_);
        close(leave_);
    }

    /// The next number shown, -1 at the end.
    [[nodiscard]] int next() const {
        unsigned char byte = 0;
        return read(told_, &byte, 1) == 1 ? byte : -1;
    }
    void go_on() const {
        const unsigned char byte = 0;
        EXPECT_EQ(write(leave_, &byte, 1), 1);
    }
    /// Kills it in the midst of what it does after going on; returns the last number shown before death.
    [[nodiscard]] int kill_under_way(int shown) const {
        go_on();
        kill(process_, SIGKILL);
        const int later = next();
        return later >= 0 ? later : shown;
    }

private:
    pid_t process_ = -1;
    int told_ = -1, leave_ = -1;
};

class StoreKillAnywhere : public testing::TestWithParam<store::Store::Disk> {};

TEST_P(StoreKillAnywhere, AfterEveryNumberShown) {
    const WholeCampaign whole(24, GetParam());
    const std::string expected = whole.undisturbed();
    for (int k = 1; k <= 9; ++k) {
        const Folder folder;
        const auto file = folder / "a.db";
        int shown = -1;
        {
            const Child child(whole, file);
            for (int told = 0; told < k; ++told) {
                if (told > 0) child.go_on();
                shown = child.next();
            }
            shown = child.kill_under_way(shown);
        }
        ASSERT_EQ(complaints(file), "ok") << k;
        ASSERT_GE(completed_in(file), shown) << k;
        whole.run(file, [](std::size_t) {});
        ASSERT_EQ(dump_of(store::Store(file, store::Store::Mode::read)), expected) << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Disks, StoreKillAnywhere,
                         testing::Values(store::Store::Disk::local, store::Store::Disk::network), [](const auto& disk) {
                             return disk.param == store::Store::Disk::local ? "Local" : "Network";
                         });

TEST(StoreKill, AgainAndAgainUntilItIsDone) {
    WholeCampaign whole(60);
    whole.group_size = 1;
    const Folder folder;
    const auto file = folder / "a.db";
    int shown = 0;
    int deaths = 0;
    while (shown < 60) {
        ASSERT_LT(++deaths, 60) << "no progress";
        const Child child(whole, file);
        const int first = child.next();
        ASSERT_GE(first, shown) << "what was shown is not done twice";
        shown = first;
        for (int told = 0; told < 3 && shown < 60; ++told) {
            child.go_on();
            shown = child.next();
        }
        if (shown < 60) shown = child.kill_under_way(shown);
    }
    EXPECT_GE(deaths, 60 / 4) << "at most four groups a life";
    EXPECT_EQ(complaints(file), "ok");
    EXPECT_EQ(dump_of(store::Store(file, store::Store::Mode::read)), whole.undisturbed());
}

TEST(StoreKill, ReadersAndASecondWriter) {
    const WholeCampaign whole(24);
    const Folder folder;
    const auto file = folder / "a.db";
    const Child child(whole, file);
    child.go_on();
    const int shown = child.next();  // and there it waits, in the midst of its campaign
    EXPECT_GE(completed_in(file), shown) << "a writer does not stop readers";
    EXPECT_THROW(store::Store(file, store::Store::Mode::create), SystemError) << "it has the lock";
}

/// Schema of the file, and its campaigns without the JSON of schema 12, or without its column.
std::pair<std::int64_t, std::int64_t> schema_of(const std::filesystem::path& file) {
    const store::Connection db(file, store::Connection::Access::read);
    const auto number = [&](const char* sql) {
        auto statement = db.prepare(sql);
        return statement.step() ? statement.get<std::int64_t>(0) : -1;
    };
    const bool column = number("SELECT count(*) FROM pragma_table_info('campaign') WHERE name = 'resolved'") == 1;
    return {number("PRAGMA user_version"),
            number(column ? "SELECT count(*) FROM campaign WHERE resolved IS NULL" : "SELECT count(*) FROM campaign")};
}

// A run brings the file of an older program to the present schema. Killed at its k-th write, sync, truncation or
// removal it leaves the old file or the new one, and both have the same results.
TEST(StoreKill, AtEveryWriteOfAMigration) {
    const WholeCampaign whole(24);
    const Folder folder;
    const auto made = folder / "made.db", file = folder / "a.db";
    whole.run(made, [](std::size_t) {});
    const auto present = schema_of(made);
    const std::string expected = dump_of(store::Store(made, store::Store::Mode::read));
    take_back_to_schema(1, made);
    const auto old = schema_of(made);
    ASSERT_NE(old, present);
    int of_old = 0, of_new = 0;
    for (bool killed = true; killed;) {
        for (const char* part : {"", "-wal", "-shm"}) std::filesystem::remove(file.string() + part);
        std::filesystem::copy_file(made, file);
        const pid_t process = fork();
        if (process == 0) {
            FailingDisk disk;
            disk.fail_at(of_old + of_new + 1, FailingDisk::Fault::killed, false);
            whole.run(file, [](std::size_t) {});
            _exit(0);
        }
        int status = 0;
        waitpid(process, &status, 0);
        killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
        const auto left = schema_of(file);
        ASSERT_TRUE(left == old || left == present) << left.first << ", " << left.second << " without JSON";
        (left == old ? of_old : of_new) += killed ? 1 : 0;
        ASSERT_EQ(complaints(file), "ok");
        ASSERT_EQ(dump_of(store::Store(file, store::Store::Mode::read)), expected);
        whole.run(file, [](std::size_t) {});
        ASSERT_EQ(schema_of(file), present);
        ASSERT_EQ(dump_of(store::Store(file, store::Store::Mode::read)), expected);
    }
    EXPECT_GE(of_old, 25);
    EXPECT_GE(of_old + of_new, 50);
    EXPECT_GE(of_new, 1);
}

TEST(StoreKill, TheQuotaEndsInMidWrite) {
    const WholeCampaign whole(24);
    const std::string expected = whole.undisturbed();
    int broken = 0;
    for (rlim_t limit = 1; limit < 400'000; limit += 23'456) {
        const Folder folder;
        const auto file = folder / "a.db";
        const pid_t process = fork();
        if (process == 0) {
            const rlimit quota{limit, limit};
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &quota);
            try {
                whole.run(file, [](std::size_t) {});
            } catch (const SystemError&) {
                _exit(3);
            } catch (...) {
                _exit(4);
            }
            _exit(0);
        }
        int status = 0;
        waitpid(process, &status, 0);
        ASSERT_TRUE(WIFEXITED(status));
        ASSERT_NE(WEXITSTATUS(status), 4) << limit;
        broken += WEXITSTATUS(status) == 3 ? 1 : 0;
        whole.run(file, [](std::size_t) {});
        EXPECT_EQ(complaints(file), "ok") << limit;
        EXPECT_EQ(dump_of(store::Store(file, store::Store::Mode::read)), expected) << limit;
    }
    EXPECT_GT(broken, 3);
}

}  // namespace grainsweep::tests::store_kill_test
