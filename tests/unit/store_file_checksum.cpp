// A file that is as the last run left it is known by one checksum; any other is checked row by row.
#include "sweep/store/database.hpp"
#include "sweep/store/file_checksum.hpp"
#include "tests/support/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace grainsweep::tests::store_file_checksum_test {

using campaign::Outcome;
using store::Store;

bool remembered(const std::filesystem::path& file) {
    store::Connection db(file, store::Connection::Access::read);
    const store::Transaction one_state(db, store::Transaction::Kind::read);
    return store::is_as_remembered(db, file);
}

void flip_bit(const std::filesystem::path& file, std::int64_t byte) {
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekg(byte);
    const char held = static_cast<char>(stream.get());
    stream.seekp(byte);
    stream.put(static_cast<char>(held ^ 4));
}

struct FileChecksum : testing::Test {
    Folder folder;
    std::filesystem::path file = folder / "a.db";
    campaign::Campaign asked = small_campaign("c");
    std::vector<campaign::PlacedCase> cases = small_design(asked, 12);

    void run(Store::Disk disk = Store::Disk::found_out) {
        Store store(file, Store::Mode::create, disk);
        store.enrol(asked, cases, here());
        for (const auto& placed : cases) settle(store, placed.question, 1);
        store.remember_file();
    }
};

TEST_F(FileChecksum, IsThatOfTheFileUntilItChanges) {
    for (const auto disk : {Store::Disk::local, Store::Disk::network}) {
        run(disk);
        EXPECT_TRUE(remembered(file));
        EXPECT_TRUE(remembered(file)) << "to look changes nothing";
        const auto text = dump_of(Store(file, Store::Mode::read));
        {
            Store again(file, Store::Mode::create, disk);
            EXPECT_TRUE(remembered(file)) << "to open it to write changes nothing either";
            EXPECT_EQ(again.enrol(asked, cases, here())[5].outcome, Outcome::completed);
        }
        EXPECT_FALSE(remembered(file)) << "a run was recorded";
        EXPECT_EQ(dump_of(Store(file, Store::Mode::read)), text);
        std::filesystem::remove(file);
    }
}

TEST_F(FileChecksum, TellsAnyBitThatChanged) {
    run();
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(file));
    std::int64_t own = 0;
    {
        const store::Connection db(file, store::Connection::Access::read);
        auto rows = db.prepare("SELECT rootpage FROM sqlite_schema WHERE name = 'file_checksum'");
        ASSERT_TRUE(rows.step());
        own = rows.get<std::int64_t>(0) - 1;
    }
    constexpr std::int64_t page = 4096;
    for (std::int64_t byte = 101; byte < bytes; byte += 1009) {
        if (byte / page == own || byte / page == 0) continue;  // the first page tells SQLite what the file is
        flip_bit(file, byte);
        try {
            EXPECT_FALSE(remembered(file)) << byte;
        } catch (const SystemError&) {  // SQLite told it: the schema no longer reads
        }
        flip_bit(file, byte);
    }
    EXPECT_TRUE(remembered(file));
}

TEST_F(FileChecksum, DamageElsewhereIsNotRemembered) {
    run();
    auto other = small_campaign("other", 1);
    const auto others = small_design(other, 3);
    {
        Store store(file, Store::Mode::create);
        store.enrol(other, others, here());
        store.remember_file();
    }
    EXPECT_TRUE(remembered(file));
    {
        store::Connection db(file, store::Connection::Access::write);
        db.execute("UPDATE observation SET value = 7 WHERE case_key = 2");
    }
    EXPECT_FALSE(remembered(file));
    {
        Store store(file, Store::Mode::create);
        store.enrol(other, others, here());
        store.remember_file();
    }
    EXPECT_FALSE(remembered(file)) << "a case of the first campaign is damaged";
    EXPECT_THROW((void)dump_of(Store(file, Store::Mode::read)), SystemError);
    {
        Store store(file, Store::Mode::create);
        EXPECT_EQ(store.enrol(asked, cases, here())[1].outcome, Outcome::abandoned);
        settle(store, cases[1].question, 2);
        store.remember_file();
    }
    EXPECT_TRUE(remembered(file)) << "it was asked again";
}

TEST_F(FileChecksum, AReaderOfAnOlderStateOnlyCostsTheChecksum) {
    run();
    store::Connection reader(file, store::Connection::Access::read);
    {
        Store store(file, Store::Mode::create, Store::Disk::local);
        const store::Transaction older(reader, store::Transaction::Kind::read);
        reader.run("SELECT count(*) FROM sim_case");
        asked.replicates = 2;
        store.enrol(asked, small_design(asked, 12), here());
        store.remember_file();
    }
    EXPECT_FALSE(remembered(file));
    EXPECT_TRUE(Store(file, Store::Mode::read).verify().empty());
}

TEST_F(FileChecksum, APartOfACampaignIsNotRemembered) {
    Store store(file, Store::Mode::create);
    store.enrol(asked, cases, here(), 3);
    store.remember_file();
    store.enrol_more(100);
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM file_checksum"), "0");
    store.remember_file();
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM file_checksum"), "1");
}

}  // namespace grainsweep::tests::store_file_checksum_test
