// Values that change in the database while a run writes to it: no command gives them, and the next run puts them right.
#include "sweep/store/database.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <thread>

namespace grainsweep::tests::tampered_run_test {

using store::Connection;
using testing::HasSubstr;

struct TamperedRun : testing::Test {
    Folder folder;
    std::filesystem::path file = folder / "t.db";

    void SetUp() override { ask(200, 0.02); }
    void ask(int points, double wait_seconds) const {
        folder.write(
            "t.json",
            nlohmann::json({{"campaign", "t"},
                            {"scene", "rehearsal"},
                            {"factors", {{{"name", "x1"}, {"between", {0, 1}}}, {{"name", "x2"}, {"between", {0, 1}}}}},
                            {"fixed", {{"response", "sum"}, {"wait_seconds", wait_seconds}}},
                            {"design", {{"kind", "halton"}, {"points", points}}}})
                .dump());
    }
    [[nodiscard]] Ended run(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    [[nodiscard]] std::string dump(const std::string& database) const { return run({"dump", database}).out; }
    /// Waits until the run that goes on has stored so many cases.
    void wait_for_cases(std::int64_t cases) const {
        const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (std::chrono::steady_clock::now() < until) {
            if (std::filesystem::exists(file)) {
                try {
                    const Connection db(file, Connection::Access::read);
                    auto rows = db.prepare("SELECT count(*) FROM sim_case WHERE outcome IS NOT NULL");
                    if (rows.step() && rows.get<std::int64_t>(0) >= cases) return;
                } catch (const grainsweep::SystemError&) {  // not made yet
                }
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        FAIL() << "no answer within a minute";
    }
    void expect_nothing_wrong(const std::function<void()>& tamper, const std::string& what, std::int64_t after = 20) {
        std::filesystem::remove(file);
        {
            Process campaign({executable_path(), "run", "t.json", "--db", "t.db", "-j", "2", "--quiet"}, folder.path());
            wait_for_cases(after);
            tamper();
            const auto ended = campaign.wait();
            EXPECT_EQ(ended.code, 3) << what;
            EXPECT_THAT(ended.err, HasSubstr("damaged")) << what;
        }
        for (const auto& command : {std::vector<std::string>{"dump", "t.db"},
                                    {"converge", "t.db"},
                                    {"report", "t.db", "-o", "t.html"},
                                    {"verify", "t.db"}})
            EXPECT_NE(run(command).code, 0) << what << ": " << command.front();
    }
    static std::string executable_path() { return grainsweep::tests::executable().string(); }
};

TEST_F(TamperedRun, NoCommandGivesAValueThatAnotherProgramChanged) {
    ASSERT_EQ(run({"run", "t.json", "--db", "sound.db", "--quiet"}).code, 0);
    const auto sound = dump("sound.db");
    for (const char* change :
         {"UPDATE observation SET value = value + 0.5 WHERE case_key = 7", "DELETE FROM observation WHERE case_key = 7",
          "DELETE FROM attempt WHERE case_key = 7"}) {
        expect_nothing_wrong([&] { Connection(file, Connection::Access::write).execute(change); }, change);
        EXPECT_EQ(run({"run", "t.json", "--db", "t.db", "--quiet"}).code, 0) << change;
        EXPECT_EQ(dump("t.db"), sound) << change;
        EXPECT_EQ(run({"verify", "t.db"}).code, 0) << change;
    }
}

TEST_F(TamperedRun, NoCommandGivesAValueThatChangedOnTheDisk) {
    ask(1500, 0.005);  // the page of the first cases is not written again
    ASSERT_EQ(run({"run", "t.json", "--db", "sound.db", "--quiet"}).code, 0);
    expect_nothing_wrong(
        [&] {
            std::vector<std::string> places;
            {
                Connection db(file, Connection::Access::write);
                db.execute("PRAGMA wal_checkpoint(PASSIVE)");
                auto rows = db.prepare("SELECT value FROM observation WHERE case_key <= 8");
                while (rows.step()) {
                    const double value = rows.get<double>(0);
                    std::string bytes(sizeof value, '\0');
                    std::memcpy(bytes.data(), &value, sizeof value);
                    std::ranges::reverse(bytes);
                    places.push_back(bytes);
                }
            }
            std::ifstream stream(file, std::ios::binary);
            const std::string all(std::istreambuf_iterator<char>(stream), {});
            bool flipped = false;
            for (const auto& bytes : places) {
                const auto at = all.find(bytes);
                if (at == std::string::npos) continue;
                std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
                out.seekp(static_cast<std::streamoff>(at) + 3);
                out.put(static_cast<char>(all[at + 3] ^ 0x10));
                flipped = true;
                break;
            }
            EXPECT_TRUE(flipped);
        },
        "a bit", 700);
    EXPECT_EQ(run({"run", "t.json", "--db", "t.db", "--quiet"}).code, 0);
    EXPECT_EQ(dump("t.db"), dump("sound.db"));
}

TEST_F(TamperedRun, WhatChangesWhileARunResumesIsFoundToo) {
    EXPECT_EQ(run({"run", "t.json", "--db", "t.db", "--quiet", "--max-cases", "60"}).code, 1);
    Process campaign({executable_path(), "run", "t.json", "--db", "t.db", "-j", "2", "--quiet"}, folder.path());
    wait_for_cases(80);
    Connection(file, Connection::Access::write).execute("UPDATE observation SET value = 0.5 WHERE case_key = 3");
    EXPECT_EQ(campaign.wait().code, 3);
    EXPECT_EQ(run({"dump", "t.db"}).code, 3);
}

}  // namespace grainsweep::tests::tampered_run_test
