// Databases that somebody else made: what they hold is refused or shown, never obeyed.
#include "sweep/campaign/case.hpp"
#include "sweep/store/database.hpp"
#include "tests/support/places.hpp"
#include "tests/support/program_campaigns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>

namespace grainsweep::tests::strangers_database_test {

using nlohmann::json;
using store::Connection;
using testing::HasSubstr;
using testing::Not;

struct StrangersDatabase : testing::Test {
    Folder folder;
    std::string case_id;

    [[nodiscard]] Ended run(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    /// A database of a campaign that a script answers, its definition altered and its hash right.
    void craft(const std::function<void(json& definition)>& alter) {
        std::filesystem::remove(folder / "p.db");
        folder.write("p.sh", "echo '{\"y\": 1}' > out.json\n");
        folder.write("p.json", json({{"campaign", "p"},
                                     {"scene", "program"},
                                     {"program",
                                      {{"command", {"sh", "p.sh"}},
                                       {"files", {"p.sh"}},
                                       {"observables", {{"y", {{"from", {{"json", "out.json"}, {"path", "/y"}}}}}}}}},
                                     {"factors", {{{"name", "x"}, {"between", {0, 1}}}}},
                                     {"design", {{"kind", "halton"}, {"points", 2}}}})
                                   .dump());
        ASSERT_EQ(run({"run", "p.json", "--quiet"}).code, 0);
        Connection db(folder / "p.db", Connection::Access::write);
        json definition;
        {
            auto rows = db.prepare("SELECT definition, (SELECT case_id FROM sim_case LIMIT 1) FROM program");
            ASSERT_TRUE(rows.step());
            definition = json::parse(rows.get<std::string>(0));
            case_id = rows.get<std::string>(1);
        }
        alter(definition);
        const auto scene = "program:" + grainsweep::campaign::content_hash(definition["answer"].dump());
        db.run("UPDATE program SET scene = ?, definition = ?", scene, definition.dump());
        for (const std::string table : {"campaign", "parameter", "observable", "sim_case"})
            db.run("UPDATE " + table + " SET scene = ?", scene);
        db.execute("DROP TABLE table_checksum; DROP TABLE file_checksum; PRAGMA user_version = 4");
    }
    void expect_refused(const std::string& why) {
        EXPECT_EQ(run({"replay", "p.db", case_id}).code, 3);
        EXPECT_THAT(run({"replay", "p.db", case_id}).err, HasSubstr(why));
        for (const auto& command : {std::vector<std::string>{"status", "p.db"},
                                    {"explain", "p.db", case_id},
                                    {"converge", "p.db"},
                                    {"report", "p.db", "-o", "p.html"},
                                    {"dump", "p.db"},
                                    {"verify", "p.db"}})
            EXPECT_LE(run(command).code, 3) << command.front() << ": a signal ended it";
    }
};

TEST_F(StrangersDatabase, NothingIsWrittenOutsideOfACasesFolder) {
    const auto outside = folder / "OWNED";
    const auto hash = grainsweep::campaign::content_hash("echo '{\"y\": 1}' > out.json\n");
    std::string up;
    for (int k = 0; k < 12; ++k) up += "../";
    for (const auto& name : {up + outside.string().substr(1), outside.string(), std::string("../OWNED"),
                             "sub/../" + up + outside.string().substr(1)}) {
        for (const char* kind : {"files", "templates"}) {
            craft([&](json& definition) { definition["answer"][kind][name] = hash; });
            expect_refused("outside of the case's folder");
            EXPECT_FALSE(std::filesystem::exists(outside)) << name;
        }
    }
}

TEST_F(StrangersDatabase, AnEmptyCommandIsRefused) {
    craft([](json& definition) { definition["answer"]["command"] = json::array(); });
    expect_refused("its command is empty");
}

TEST_F(StrangersDatabase, ReplayNamesTheCommandThatItRuns) {
    craft([](json&) {});
    EXPECT_THAT(run({"replay", "p.db", case_id}).err, HasSubstr("runs the stored command of this case: sh p.sh"));
    EXPECT_THAT(run({"replay", "--help"}).out, HasSubstr("runs the stored command"));
}

TEST_F(StrangersDatabase, ControlCharactersDoNotReachTheTerminal) {
    folder.write("c.json", R"({"campaign": "c", "scene": "rehearsal", 
        "factors": [{"name": "behaviour", "levels": ["normal", "unstable", "crash"]}], "limits": {"attempts": 1},
        "design": {"kind": "lattice"}})");
    EXPECT_EQ(run({"run", "c.json", "--quiet"}).code, 1);
    const std::string evil =
        "\x1b]0;OWNED\x07\x1b[2J\xc2\x9b"
        "31m\r";
    {
        Connection db(folder / "c.db", Connection::Access::write);
        for (const char* change :
             {"UPDATE attempt SET message = coalesce(message, '') || ?", "UPDATE campaign SET name = name || ?",
              "UPDATE observable SET name = name || ?, unit = ?1, meaning = ?1",
              "UPDATE sim_case SET scene = scene || ?", "UPDATE parameter SET scene = scene || ?, unit = ?1",
              "UPDATE observable SET scene = scene || ?",
              "UPDATE campaign SET scene = scene || ?, design = design || ?1",
              "UPDATE attempt_computer SET host = ?, processor = ?1, version = ?1"})
            db.run(change, evil);
        db.execute("DROP TABLE table_checksum; DROP TABLE file_checksum; PRAGMA user_version = 4");
    }
    const auto id =
        run({"query", "c.db", "SELECT case_id FROM sim_case WHERE outcome = 'unstable'", "--format", "csv"}).out;
    for (auto command :
         std::vector<std::vector<std::string>>{{"dump", "c.db"},
                                               {"status", "c.db"},
                                               {"explain", "c.db", id.substr(8, 32)},
                                               {"replay", "c.db", id.substr(8, 32)},
                                               {"converge", "c.db"},
                                               {"sensitivity", "c.db"},
                                               {"verify", "c.db"},
                                               {"query", "c.db", "SELECT * FROM attempt"},
                                               {"query", "c.db", "SELECT message AS \"\x1b[2J\" FROM attempt"},
                                               {"query", "c.db", "SELECT nothing FROM \"\x1b[2J\""},
                                               {"predict", "c.db", "--at", "x1=\x1b[2J"},
                                               {"run", "c.json", "--db", "c.db"},
                                               {"plan", "no\x1b[2Jfile.json"}}) {
        for (const char* format : {"text", "csv", "json"}) {
            const auto ended = [&] {
                auto words = command;
                words.insert(words.end(), {"--format", format});
                return run(words);
            }();
            for (const auto& text : {ended.out, ended.err}) {
                EXPECT_THAT(text, Not(HasSubstr("\x1b"))) << command.front() << ' ' << format;
                EXPECT_THAT(text, Not(HasSubstr("\x07"))) << command.front() << ' ' << format;
                EXPECT_THAT(text, Not(HasSubstr("\xc2\x9b"))) << command.front() << ' ' << format;
                EXPECT_THAT(text, Not(HasSubstr("\r"))) << command.front() << ' ' << format;
            }
        }
    }
}

TEST_F(StrangersDatabase, ALongFunctionEndsAtTheLimitOfAQuery) {
    folder.write("c.json", R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "design": {"kind": "halton", "points": 2}})");
    ASSERT_EQ(run({"run", "c.json", "--quiet"}).code, 0);
    for (const char* sql : {"SELECT instr(hex(zeroblob(30000000)), hex(zeroblob(10000000)) || 'X')",
                            "SELECT replace(hex(zeroblob(30000000)), hex(zeroblob(10000000)) || 'X', '')"}) {
        const auto began = std::chrono::steady_clock::now();
        const auto ended = run({"query", "c.db", sql, "--limit-seconds", "0.3"});
        EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(20)) << sql;
        EXPECT_EQ(ended.code, 2) << sql;
        EXPECT_THAT(ended.err, HasSubstr("SQL: it takes too long (limits: 0.3 s of processor time, 1024 MiB)")) << sql;
    }
    EXPECT_EQ(run({"query", "c.db", "SELECT count(*) FROM c", "--limit-seconds", "0.3"}).code, 0);
}

}  // namespace grainsweep::tests::strangers_database_test
