// Opening: what is no database, who writes, where the journal belongs.
#include "sweep/campaign/input_error.hpp"
#include "sweep/store/database.hpp"
#include "sweep/store/writer_lock.hpp"
#include "tests/support/archive.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainsweep::tests::store_files_test {

using campaign::InputError;
using store::Store;
using testing::AllOf;
using testing::ElementsAre;
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
    EXPECT_THAT(sentence<InputError>(folder / "none.db", Store::Mode::read), HasSubstr("there is no database"));
    EXPECT_THAT(sentence<InputError>(folder.path(), Store::Mode::read), HasSubstr("is not a file"));
    EXPECT_FALSE(std::filesystem::exists(folder / "none.db")) << "reading makes no file";
    write(folder / "empty.db", "");
    EXPECT_THAT(sentence<InputError>(folder / "empty.db", Store::Mode::read),
                AllOf(HasSubstr("is empty"), HasSubstr("copied without its log, ")));
    EXPECT_EQ(sentence<InputError>(folder / "empty.db", Store::Mode::create), "opened");
}

TEST(StoreFiles, AStrangersFileIsLeftAlone) {
    const Folder folder;
    const std::string config = "{\"campaign\": \"quickstart\", \"scene\": \"powder_spreading\"}";
    write(folder / "config.json", config);
    auto foreign = store::Connection(folder / "foreign.db", store::Connection::Access::write);
    foreign.execute("CREATE TABLE t (x); INSERT INTO t VALUES (1)");
    for (const auto mode : {Store::Mode::read, Store::Mode::create}) {
        EXPECT_THAT(sentence<InputError>(folder / "config.json", mode), HasSubstr("not a grainsweep database"));
        EXPECT_THAT(sentence<InputError>(folder / "foreign.db", mode), HasSubstr("another program"));
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
        EXPECT_THAT(sentence<InputError>(folder / "a.db", mode), HasSubstr("newer grainsweep"));
    }
}

TEST(StoreFiles, AFolderThatIsMissingIsABrokenWorld) {
    const Folder folder;
    EXPECT_THAT(sentence<SystemError>(folder.path() / "no" / "a.db", Store::Mode::create), HasSubstr("No such file"));
}

std::vector<std::string> names_in(const Folder& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

TEST(StoreFiles, TheSecondWriterIsToldWhoTheFirstIs) {
    const Folder folder;
    const auto link = folder / "link.db";
    const auto hard_link = folder / "hard.db";
    {
        Store first(folder / "a.db", Store::Mode::create);
        EXPECT_THAT(sentence<SystemError>(folder / "a.db", Store::Mode::create),
                    HasSubstr("another run is writing to it; one run at a time"));
        std::filesystem::create_symlink(folder / "a.db", link);
        std::filesystem::create_hard_link(folder / "a.db", hard_link);
        const auto campaign = small_campaign("c");
        first.enrol(campaign, small_design(campaign, 3), here());
        for (const auto& name : {folder / "a.db", link}) {
            EXPECT_THAT(sentence<SystemError>(name, Store::Mode::create),
                        AllOf(HasSubstr("process " + std::to_string(getpid()) + " on a host"), HasSubstr("since"),
                              HasSubstr("one run at a time")));
        }
        // Under another name the journal of the first is not found, and the lock is.
        EXPECT_THAT(sentence<SystemError>(hard_link, Store::Mode::create), HasSubstr("one run at a time"));
        EXPECT_EQ(sentence<SystemError>(folder / "a.db", Store::Mode::read), "opened");
    }
    EXPECT_THAT(sentence<InputError>(folder / "a.db", Store::Mode::create), HasSubstr("2 names (hard links)"));
    EXPECT_THAT(sentence<InputError>(hard_link, Store::Mode::create), HasSubstr("2 names (hard links)"));
    std::filesystem::remove(hard_link);
    EXPECT_EQ(sentence<SystemError>(folder / "a.db", Store::Mode::create), "opened") << "the lock goes with its holder";
}

TEST(StoreFiles, WhatIsNoFileNameIsAWrongQuestion) {
    for (const auto mode : {Store::Mode::read, Store::Mode::create}) {
        EXPECT_THAT(sentence<InputError>(":memory:", mode), HasSubstr("no database file"));
        EXPECT_THAT(sentence<InputError>("file:a.db?mode=rwc", mode), HasSubstr("is an address"));
        EXPECT_THAT(sentence<InputError>("", mode), HasSubstr("needs a file name"));
    }
}

TEST(StoreFiles, ADatabaseThatIsNoLongerInItsPlaceEndsTheRun) {
    const auto campaign = small_campaign("c");
    const auto cases = small_design(campaign, 3);
    for (const auto disk : {Store::Disk::local, Store::Disk::network}) {
        for (const std::string how : {"moved", "deleted", "replaced"}) {
            const Folder folder;
            const auto file = folder / "a.db";
            {
                Store store(file, Store::Mode::create, disk);
                store.enrol(campaign, cases, here());
                settle(store, cases[0].question, 1);
                EXPECT_NO_THROW(store.require_in_place());
                if (how == "deleted") std::filesystem::remove(file);
                if (how != "deleted") std::filesystem::rename(file, folder / "elsewhere.db");
                if (how == "replaced") write(file, "another file");
                EXPECT_THROW(store.require_in_place(), SystemError) << how;
                try {
                    settle(store, cases[1].question, 1);
                    ADD_FAILURE() << how;
                } catch (const SystemError& broken) {
                    EXPECT_THAT(broken.what(),
                                AllOf(HasSubstr(file.string()), HasSubstr("moved, deleted or replaced")));
                }
            }
            if (how != "moved") continue;
            std::filesystem::rename(folder / "elsewhere.db", file);
            Store store(file, Store::Mode::create, disk);
            EXPECT_EQ(store.enrol(campaign, cases, here())[0].outcome, campaign::Outcome::completed)
                << "put back, nothing is lost";
        }
    }
}

TEST(StoreFiles, WriterAndReadersLeaveOneFile) {
    const Folder folder;
    {
        Store writer(folder / "a.db", Store::Mode::create);
        const auto campaign = small_campaign("c");
        writer.enrol(campaign, small_design(campaign, 3), here());
        EXPECT_THAT(names_in(folder), ElementsAre("a.db", "a.db-shm", "a.db-wal"));
    }
    EXPECT_THAT(names_in(folder), ElementsAre("a.db"));
    { const Store reader(folder / "a.db", Store::Mode::read); }
    EXPECT_THAT(names_in(folder), ElementsAre("a.db"));
}

TEST(StoreFiles, AReaderChangesNothing) {
    const Folder folder;
    { const Store writer(folder / "a.db", Store::Mode::create); }
    store::Connection reader(folder / "a.db", store::Connection::Access::read);
    EXPECT_THROW(reader.execute("DELETE FROM campaign"), SystemError);
    EXPECT_THROW(reader.execute("CREATE TABLE t (x)"), SystemError);
}

TEST(StoreFiles, AnOlderSchemaIsReadAsItIsAndBroughtUpToDateByTheNextRun) {
    const Folder folder;
    const auto file = folder / "a.db";
    const auto campaign = small_campaign("c");
    const auto cases = small_design(campaign, 3);
    {
        Store store(file, Store::Mode::create);
        store.enrol(campaign, cases, here());
        settle(store, cases[1].question, 1);
    }
    const std::string before = dump_of(Store(file, Store::Mode::read));
    take_back_to_schema(1, file);
    const std::string indexed = "SELECT count(*) FROM sqlite_schema WHERE name = 'campaign_case_by_case'";
    {
        const Store store(file, Store::Mode::read);
        EXPECT_EQ(dump_of(store), before);
        EXPECT_EQ(only_cell(store, "SELECT count(*) FROM c JOIN series USING (case_id)"), "0");
        EXPECT_EQ(only_cell(store, indexed), "0");
        EXPECT_EQ(store.attempts(cases[1].question.id).at(0).computer.host, here().host);
    }
    {
        Store store(file, Store::Mode::create);
        EXPECT_EQ(store.enrol(campaign, cases, here())[1].outcome, campaign::Outcome::completed);
    }
    const Store store(file, Store::Mode::read);
    EXPECT_EQ(dump_of(store), before);
    EXPECT_EQ(only_cell(store, indexed), "1");
    EXPECT_EQ(store.attempts(cases[1].question.id).at(0).computer.host, here().host);
}

TEST(StoreFiles, TheJournalFitsTheFileSystem) {
    EXPECT_EQ(store::network_file_system(0x6969), "NFS");
    EXPECT_EQ(store::network_file_system(0x0BD00BD0), "Lustre");
    EXPECT_EQ(store::network_file_system(static_cast<long>(0xFE534D42)), "SMB 2");
    EXPECT_EQ(store::network_file_system(0xEF53), "") << "ext4";
    EXPECT_EQ(store::network_file_system(0x01021994), "") << "tmpfs";
    EXPECT_EQ(store::network_file_system(0x58465342), "") << "XFS";
}

TEST(StoreFiles, ADatabaseOnANetworkDiskIsRefusedWithWhatToDo) {
    const tests::Folder folder;
    EXPECT_NO_THROW(store::refuse_network(folder / "x.db", store::file_system_of(folder / "x.db")));
    EXPECT_NO_THROW(store::refuse_network(folder / "x.db", 0xEF53));
    try {
        store::refuse_network("shared/x.db", 0x47504653);
        FAIL();
    } catch (const campaign::InputError& wrong) {
        const std::string sentence = wrong.what();
        for (const char* part : {"shared/x.db", "GPFS", "--db", "grainsweep work", "--network-disk"})
            EXPECT_NE(sentence.find(part), std::string::npos) << part;
    }
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

/// Root writes everywhere: as another user for as long as this lives, where it is root who asks.
class NotRoot {
public:
    NotRoot() : was_(geteuid()) {
        if (was_ == 0 && seteuid(65534) != 0) throw std::runtime_error("seteuid");
    }
    ~NotRoot() { EXPECT_EQ(seteuid(was_), 0); }
    NotRoot(const NotRoot&) = delete;
    NotRoot& operator=(const NotRoot&) = delete;

private:
    uid_t was_;
};

TEST(StoreFiles, ADatabaseInAFolderThatCannotBeWrittenIsRead) {
    const Folder folder;
    chmod(folder.path().c_str(), 0755);
    const auto closed = folder / "with space #%?";
    std::filesystem::create_directory(closed);
    {
        Store store(closed / "a.db", Store::Mode::create);
        const auto campaign = small_campaign("c");
        store.enrol(campaign, small_design(campaign, 3), here());
    }
    chmod(closed.c_str(), 0555);
    {
        const NotRoot reader;
        ASSERT_NE(faccessat(AT_FDCWD, closed.c_str(), W_OK, AT_EACCESS), 0);
        const Store store(closed / "a.db", Store::Mode::read);
        EXPECT_EQ(only_cell(store, "SELECT count(*) FROM c"), "3");
    }
    chmod(closed.c_str(), 0755);
}

}  // namespace grainsweep::tests::store_files_test
