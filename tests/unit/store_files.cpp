// Opening: what is no database, who writes, where the journal belongs.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/database.hpp"
#include "sweep/store/writer_lock.hpp"
#include "tests/support/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

namespace grainsweep::tests {
namespace {

using campaign::WrongQuestion;
using store::BrokenWorld;
using store::Store;
using testing::HasSubstr;

void write(const std::filesystem::path& file, std::string_view text) {
    std::ofstream(file, std::ios::binary) << text;
}

template <class Error>
std::string sentence(const std::filesystem::path& file, Store::Mode mode) {
    try {
        const Store store(file, mode);
    } catch (const Error& error) {
        return error.what();
    }
    return "opened";
}

TEST(StoreFiles, WhatIsNotThereCannotBeRead) {
    const Folder folder;
    EXPECT_THAT(sentence<WrongQuestion>(folder / "none.db", Store::Mode::read), HasSubstr("there is no database"));
    EXPECT_THAT(sentence<WrongQuestion>(folder.path(), Store::Mode::read), HasSubstr("is not a file"));
    EXPECT_FALSE(std::filesystem::exists(folder / "none.db")) << "reading makes no file";
    write(folder / "empty.db", "");
    EXPECT_THAT(sentence<WrongQuestion>(folder / "empty.db", Store::Mode::read), HasSubstr("is empty"));
    EXPECT_EQ(sentence<WrongQuestion>(folder / "empty.db", Store::Mode::create), "opened");
}

TEST(StoreFiles, AStrangersFileIsLeftAlone) {
    const Folder folder;
    const std::string config = "{\"campaign\": \"quickstart\", \"scene\": \"powder_spreading\"}";
    write(folder / "config.json", config);
    auto foreign = store::Connection(folder / "foreign.db", store::Connection::Access::write);
    foreign.execute("CREATE TABLE t (x); INSERT INTO t VALUES (1)");
    for (const auto mode : {Store::Mode::read, Store::Mode::create}) {
        EXPECT_THAT(sentence<WrongQuestion>(folder / "config.json", mode), HasSubstr("not a grainsweep database"));
        EXPECT_THAT(sentence<WrongQuestion>(folder / "foreign.db", mode), HasSubstr("another program"));
    }
    EXPECT_EQ(std::filesystem::file_size(folder / "config.json"), config.size());
    EXPECT_FALSE(std::filesystem::exists(folder / "foreign.db-wal")) << "its journal stays as it was";
}

TEST(StoreFiles, ANewerSchemaIsNotTouched) {
    const Folder folder;
    { const Store store(folder / "a.db", Store::Mode::create); }
    {
        store::Connection db(folder / "a.db", store::Connection::Access::write);
        db.execute("PRAGMA user_version = 999");
    }
    for (const auto mode : {Store::Mode::read, Store::Mode::create}) {
        EXPECT_THAT(sentence<WrongQuestion>(folder / "a.db", mode), HasSubstr("newer grainsweep"));
    }
}

TEST(StoreFiles, AFolderThatIsMissingIsABrokenWorld) {
    const Folder folder;
    EXPECT_THAT(sentence<BrokenWorld>(folder.path() / "no" / "a.db", Store::Mode::create), HasSubstr("No such file"));
}

TEST(StoreFiles, TheSecondWriterIsToldWhoTheFirstIs) {
    const Folder folder;
    const auto link = folder / "link.db";
    {
        const Store first(folder / "a.db", Store::Mode::create);
        std::filesystem::create_symlink(folder / "a.db", link);
        for (const auto& name : {folder / "a.db", link}) {
            EXPECT_THAT(sentence<BrokenWorld>(name, Store::Mode::create),
                        AllOf(HasSubstr("process " + std::to_string(getpid())), HasSubstr("since"),
                              HasSubstr("one run at a time")));
        }
        EXPECT_EQ(sentence<BrokenWorld>(folder / "a.db", Store::Mode::read), "opened");
    }
    EXPECT_EQ(sentence<BrokenWorld>(folder / "a.db", Store::Mode::create), "opened") << "the lock goes with its holder";
}

TEST(StoreFiles, TheJournalFitsTheFileSystem) {
    EXPECT_TRUE(store::is_network_file_system(0x6969));                         // NFS
    EXPECT_TRUE(store::is_network_file_system(0x0BD00BD0));                     // Lustre
    EXPECT_TRUE(store::is_network_file_system(static_cast<long>(0xFE534D42)));  // SMB 2
    EXPECT_FALSE(store::is_network_file_system(0xEF53));                        // ext4
    EXPECT_FALSE(store::is_network_file_system(0x01021994));                    // tmpfs
    EXPECT_FALSE(store::is_network_file_system(0x58465342));                    // XFS
}

TEST(StoreFiles, BothJournalsAreFullySynced) {
    const Folder folder;
    store::Connection db(folder / "a.db", store::Connection::Access::write);
    const auto ask = [&](const char* sql) {
        auto statement = db.prepare(sql);
        return statement.step() ? statement.get<std::string>(0) : "";
    };
    db.use(store::Connection::Journal::write_ahead);
    EXPECT_EQ(ask("PRAGMA journal_mode"), "wal");
    EXPECT_EQ(ask("PRAGMA synchronous"), "2");
    db.use(store::Connection::Journal::rollback);
    EXPECT_EQ(ask("PRAGMA journal_mode"), "delete");
    EXPECT_EQ(ask("PRAGMA synchronous"), "2");
    EXPECT_EQ(ask("PRAGMA foreign_keys"), "1");
}

TEST(StoreFiles, ADatabaseInAFolderThatCannotBeWrittenIsRead) {
    if (geteuid() == 0) GTEST_SKIP() << "root writes everywhere";
    const Folder folder;
    const auto closed = folder / "with space #%?";
    std::filesystem::create_directory(closed);
    {
        Store store(closed / "a.db", Store::Mode::create);
        const auto campaign = small_campaign("c");
        store.enrol(campaign, small_design(campaign, 3), here());
    }
    chmod(closed.c_str(), 0555);
    {
        const Store store(closed / "a.db", Store::Mode::read);
        EXPECT_EQ(only_cell(store, "SELECT count(*) FROM c"), "3");
    }
    chmod(closed.c_str(), 0755);
}

}  // namespace
}  // namespace grainsweep::tests
