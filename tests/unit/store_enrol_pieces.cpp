// A campaign entered piece by piece is the one entered at once, whatever ends in between.
#include "sweep/store/database.hpp"
#include "tests/support/archive.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grainsweep::tests::store_enrol_pieces_test {

using campaign::Campaign;
using campaign::Outcome;
using store::Store;

/// Every row that does not say when it was written.
std::string contents_of(const std::filesystem::path& file) {
    std::string text;
    for (const char* sql :
         {"SELECT * FROM sim_case", "SELECT * FROM case_input", "SELECT * FROM campaign_case", "SELECT * FROM campaign",
          "SELECT case_key, number, outcome FROM attempt", "SELECT * FROM observation",
          "SELECT * FROM table_checksum WHERE name <> 'provenance' AND rows > 0 ORDER BY name, part"}) {
        store::Connection db(file, store::Connection::Access::read);
        auto rows = db.prepare(sql);
        while (rows.step()) {
            for (int column = 0; column < rows.columns(); ++column) text += rows.get<std::string>(column) + '|';
            text += '\n';
        }
    }
    return text;
}

struct PieceByPiece : testing::Test {
    Folder folder;
    Campaign campaign = [] {
        auto asked = small_campaign("c");
        asked.replicates = 2;
        return asked;
    }();
    std::vector<campaign::PlacedCase> cases = [this] {
        auto made = small_design(campaign, 10);
        made[13].question = made[4].question;  // one question at two places
        return made;
    }();

    std::string at_once() {
        const auto file = folder / "whole.db";
        {
            Store store(file, Store::Mode::create);
            store.enrol(campaign, cases, here());
            settle(store, cases[7].question, 1);
        }
        return contents_of(file);
    }
};

TEST_F(PieceByPiece, ALongCampaignIsTheSameAsOneEnteredAtOnce) {
    for (const std::size_t piece : {1U, 3U, 19U, 20U}) {
        const auto file = folder / (std::to_string(piece) + ".db");
        {
            Store store(file, Store::Mode::create);
            EXPECT_EQ(store.enrol(campaign, cases, here(), piece).size(), cases.size());
            EXPECT_EQ(store.enrols(), piece < cases.size());
            EXPECT_EQ(only_cell(store, "SELECT count(*) FROM c"), std::to_string(piece));
            EXPECT_TRUE(store.verify().empty());
            while (store.enrols()) store.enrol_more(piece);
            settle(store, cases[7].question, 1);
            EXPECT_TRUE(store.verify().empty());
        }
        EXPECT_EQ(contents_of(file), at_once());
        std::filesystem::remove(folder / "whole.db");
    }
}

TEST_F(PieceByPiece, ACaseThatBeginsEarlyBringsTheRestWithIt) {
    const auto file = folder / "early.db";
    {
        Store store(file, Store::Mode::create);
        store.enrol(campaign, cases, here(), 2);
        settle(store, cases[7].question, 1);
        EXPECT_FALSE(store.enrols());
    }
    EXPECT_EQ(contents_of(file), at_once());
}

TEST_F(PieceByPiece, WhatIsMissingWhenAProgramEndsIsEnteredByTheNext) {
    const auto file = folder / "cut.db";
    {
        Store store(file, Store::Mode::create);
        store.enrol(campaign, cases, here(), 5);
        store.enrol_more(4);
        settle(store, cases[7].question, 1);
        EXPECT_TRUE(store.enrols());
    }
    {
        Store store(file, Store::Mode::create);
        const auto states = store.enrol(campaign, cases, here(), 3);
        EXPECT_EQ(states[7].outcome, Outcome::completed);
        EXPECT_EQ(states[8].attempts, 0);
        EXPECT_TRUE(store.enrols());
        EXPECT_EQ(only_cell(store, "SELECT count(*) FROM c"), "12");
        store.enrol_more(100);
        EXPECT_FALSE(store.enrols());
        EXPECT_TRUE(store.verify().empty());
    }
    EXPECT_EQ(contents_of(file), at_once());
}

TEST_F(PieceByPiece, AFailedGroupLeavesTheRestToTheNextRun) {
    Store store(folder / "failed.db", Store::Mode::create);
    store.enrol(campaign, cases, here(), 2);
    const auto fail = [&] {
        store.begin({cases[7].question.id, 1});
        throw std::runtime_error("power");
    };
    EXPECT_THROW(store.group(fail), std::runtime_error);
    EXPECT_FALSE(store.enrols());
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM c"), "2");
    store.enrol(campaign, cases, here());
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM c"), "20");
    EXPECT_TRUE(store.verify().empty());
}

}  // namespace grainsweep::tests::store_enrol_pieces_test
