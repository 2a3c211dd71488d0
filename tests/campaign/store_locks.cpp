// Locks of a database are those of its process: closing another descriptor of the file would end them, and the next
// program would take itself for the last one and remove the write-ahead log.
#include "sweep/files/locked_files.hpp"
#include "sweep/files/whole_file.hpp"
#include "sweep/store/store.hpp"
#include "tests/support/archive.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace grainsweep::tests::store_locks_test {

namespace fs = std::filesystem;
using store::Store;

/// Descriptors of this process whose files have this name.
std::vector<std::string> descriptors(const std::string& name) {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
        std::error_code ended;
        const auto file = fs::read_symlink(entry.path(), ended).string();
        if (file.find("/" + name) != std::string::npos) found.push_back(file);
    }
    return found;
}

struct StoreLocks : testing::Test {
    Folder folder;
    fs::path file = folder / "a.db", log = folder / "a.db-wal";
    campaign::Campaign asked = small_campaign("first");
    std::vector<campaign::PlacedCase> cases = small_design(asked, 8);

    StoreLocks() {
        Store store(file, Store::Mode::create);
        (void)store.enrol(asked, cases, here());
        settle(store, cases[0].question, 1);
    }
    /// Another program opens the file, and is the last user where our locks are gone.
    void expect_that_others_see_us() const {
        EXPECT_EQ(run_program({"status", "a.db"}, folder.path()).code, 0);
        EXPECT_TRUE(fs::exists(log)) << "its log is still in use";
        for (const auto& one : descriptors("a.db")) EXPECT_EQ(one.find("(deleted)"), std::string::npos) << one;
    }
};

TEST_F(StoreLocks, AReaderKeepsThemWhileOthersOfItsProcessComeAndGo) {
    const Store reader(file, Store::Mode::read);
    expect_that_others_see_us();
    { const Store other(file, Store::Mode::read); }
    expect_that_others_see_us();
    {
        Store writer(file, Store::Mode::create);
        EXPECT_THROW(Store(file, Store::Mode::create), SystemError) << "one writer";
        (void)writer.enrol(asked, cases, here());
        settle(writer, cases[1].question, 1);
        expect_that_others_see_us();
    }
    expect_that_others_see_us();
    Store resumed(file, Store::Mode::create);
    (void)resumed.enrol(asked, cases, here());
    settle(resumed, cases[2].question, 1);
    EXPECT_EQ(only_cell(reader, "SELECT count(outcome) FROM sim_case"), "3");
    EXPECT_EQ(run_program({"verify", "a.db"}, folder.path()).code, 0);
}

TEST_F(StoreLocks, NobodyElseReadsTheBytesOfAnOpenDatabase) {
    fs::create_hard_link(file, folder / "other.name");
    const std::optional<Store> reader(std::in_place, file, Store::Mode::read);
    for (const auto* name : {"a.db", "other.name"}) {
        EXPECT_TRUE(files::is_locked_file(folder / name));
        std::error_code error;
        EXPECT_EQ(files::whole_file(folder / name, error), "");
        EXPECT_EQ(error, std::errc::device_or_resource_busy);
    }
    expect_that_others_see_us();
}

TEST_F(StoreLocks, AnyFileIsReadOnceNoConnectionIsLeft) {
    { const Store reader(file, Store::Mode::read); }
    EXPECT_FALSE(files::is_locked_file(file));
    std::error_code error;
    EXPECT_TRUE(files::whole_file(file, error).starts_with("SQLite format 3"));
    EXPECT_FALSE(error);
    EXPECT_FALSE(files::is_locked_file(folder / "none.db"));
}

TEST_F(StoreLocks, AWriterHasOneDescriptorOfItsFile) {
    const Store writer(file, Store::Mode::create);
    EXPECT_EQ(descriptors("a.db"),
              (std::vector<std::string>{file.string(), log.string(), (folder / "a.db-shm").string()}));
}

TEST_F(StoreLocks, AReaderKnowsWhetherARunIsUnderWay) {
    const Store reader(file, Store::Mode::read);
    EXPECT_FALSE(reader.is_being_written());
    {
        const Store writer(file, Store::Mode::create);
        EXPECT_TRUE(reader.is_being_written());
    }
    EXPECT_FALSE(reader.is_being_written());
}

}  // namespace grainsweep::tests::store_locks_test
