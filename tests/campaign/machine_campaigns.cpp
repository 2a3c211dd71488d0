// Machines through the real program: swept, killed, resumed, replayed from the database alone, verified, shown.
#include "stats/random.hpp"
#include "tests/support/machines.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>

namespace grainsweep::tests::machine_campaigns_test {

using nlohmann::json;
using testing::HasSubstr;

namespace fs = std::filesystem;

constexpr const char* triangle = R"(solid one
facet normal 0 0 1
outer loop
vertex 5 5 1
vertex 15 5 1
vertex 10 15 1
endloop
endfacet
endsolid one
)";
constexpr const char* sizes = "diameter,volume_fraction\n2.6e-3,0.25\n3.0e-3,0.5\n3.2e-3,0.25\n";

/// The small machine with an STL file and a file of sizes.
json machine_with_files() {
    json machine = small_machine();
    machine["walls"]["plate"] = {{"stl", "plate.stl"}, {"scale", "1 mm"}, {"material", "steel"}};
    machine["species"]["light"]["sizes"] = {{"file", "sizes.csv"}};
    machine["phases"] = json::parse(R"([{"name": "fall", "for": 0.06, "frames": 3},
                                        {"name": "turn", "for": 0.05, "frames": 4},
                                        {"name": "stop", "for": 0.01, "frames": 2}])");
    return machine;
}

json campaign_of(const json& machine, const std::string& name = "m") {
    return {{"campaign", name},
            {"scene", "machine"},
            {"machine", machine},
            {"factors", {{{"name", "friction"}, {"between", {0.1, 0.9}}}, {{"name", "speed"}, {"levels", {30, 90}}}}},
            {"design", {{"kind", "halton"}, {"points", 12}}},
            {"limits", {{"attempts", 1000}}}};
}

/// A folder with the machine, its files and a campaign over it.
struct Workshop : Folder {
    explicit Workshop(const json& machine = machine_with_files()) : Folder(in_memory()) {
        write("plate.stl", triangle);
        write("sizes.csv", sizes);
        write("machine.json", machine.dump(1));
        write("c.json", campaign_of("machine.json").dump(1));
    }
    Ended run(const std::vector<std::string>& arguments) const { return run_program(arguments, path()); }
    /// Runs a campaign file to its end.
    void complete(const std::string& database = "m.db", const std::string& file = "c.json",
                  const std::string& workers = "2") const {
        const auto ended = run({"run", file, "--db", database, "-j", workers, "--quiet"});
        EXPECT_EQ(ended.code, 0) << ended.err << ended.out;
    }
    std::string dump(const std::string& database = "m.db") const {
        const auto ended = run({"dump", database});
        EXPECT_EQ(ended.code, 0) << ended.err;
        return ended.out;
    }
    json rows(const std::string& sql, const std::string& database = "m.db") const {
        const auto ended = run({"query", database, sql, "--format", "json"});
        return ended.code == 0 ? json::parse(ended.out) : json(ended.err);
    }
    std::set<std::string> ids(const std::string& database = "m.db") const {
        std::set<std::string> all;
        for (const auto& row : rows("SELECT case_id FROM sim_case", database)) all.insert(row["case_id"]);
        return all;
    }
};

/// Cases with an outcome in a database that a program is writing; -1 where there is none yet.
int settled(const fs::path& file) {
    sqlite3* db = nullptr;
    int count = -1;
    if (sqlite3_open_v2(file.c_str(), &db, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK) {
        sqlite3_busy_timeout(db, 1000);
        sqlite3_stmt* statement = nullptr;
        if (sqlite3_prepare_v2(db, "SELECT count(outcome) FROM sim_case", -1, &statement, nullptr) == SQLITE_OK &&
            sqlite3_step(statement) == SQLITE_ROW)
            count = sqlite3_column_int(statement, 0);
        sqlite3_finalize(statement);
    }
    sqlite3_close(db);
    return count;
}

TEST(MachineCampaigns, OneAndTwoWorkersGiveTheSameDump) {
    const Workshop shop;
    shop.complete("one.db", "c.json", "1");
    shop.complete("two.db", "c.json", "2");
    const std::string dump = shop.dump("one.db");
    EXPECT_GT(dump.size(), 2000U);
    EXPECT_TRUE(dump == shop.dump("two.db"));
    EXPECT_EQ(shop.rows("SELECT count(*) AS n FROM sim_case WHERE outcome = 'completed'", "two.db")[0]["n"], 12);
}

TEST(MachineCampaigns, AKilledCampaignIsResumedToTheSameDump) {
    const Workshop shop;
    shop.complete("calm.db");
    const std::string calm = shop.dump("calm.db");
    for (std::uint64_t moment = 0; moment < 3; ++moment) {
        const std::string database = "killed" + std::to_string(moment) + ".db";
        const auto command = program_command({"run", "c.json", "--db", database, "-j", "2", "--quiet"});
        {
            Process run(command, shop.path());
            const int until = static_cast<int>(stats::Stream(21, moment).uniform(0) * 12);
            while (run.running() && settled(shop / database) < until)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            run.signal(SIGKILL);
            run.wait();
        }
        shop.complete(database);
        EXPECT_TRUE(shop.dump(database) == calm) << moment;
    }
}

TEST(MachineCampaigns, ACaseIsReplayedFromTheDatabaseAlone) {
    const Workshop shop;
    shop.complete();
    const Folder empty(in_memory());
    fs::copy_file(shop / "m.db", empty / "m.db");
    const auto id = *shop.ids().begin();
    const auto replayed = run_program({"replay", "m.db", id}, empty.path());
    EXPECT_EQ(replayed.code, 0) << replayed.err;
    EXPECT_THAT(replayed.out, HasSubstr("equal to the last bit"));
    const auto film = run_program({"replay", "m.db", id, "--vtk", "film", "--frames", "3"}, empty.path());
    EXPECT_EQ(film.code, 0) << film.err;
    EXPECT_GE(std::distance(fs::directory_iterator(empty / "film"), fs::directory_iterator()), 4);
    const auto explained = run_program({"explain", "m.db", id}, empty.path());
    EXPECT_EQ(explained.code, 0) << explained.err;
    EXPECT_THAT(explained.out, HasSubstr("bin"));
    EXPECT_THAT(explained.out, HasSubstr("friction"));
    EXPECT_EQ(run_program({"report", "m.db"}, empty.path()).code, 0);
    std::ifstream page(empty.path() / "m.html", std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(page), {});
    EXPECT_NE(text.find(R"(data-case="" data-says="the machine before it runs")"), std::string::npos);
    EXPECT_TRUE(fs::exists(empty / "m.html"));
    EXPECT_EQ(run_program({"verify", "m.db"}, empty.path()).code, 0);
    EXPECT_EQ(run_program({"status", "m.db"}, empty.path()).code, 0);
}

TEST(MachineCampaigns, TasksOfASpoolFindTheRowsOfARun) {
    const Workshop shop;
    const auto worked = shop.run({"work", "c.json", "--spool", "spool", "-j", "2", "--quiet"});
    EXPECT_EQ(worked.code, 0) << worked.err;
    const auto collected = shop.run({"collect", "spooled.db", "spool", "--quiet"});
    EXPECT_EQ(collected.code, 0) << collected.err;
    shop.complete();
    EXPECT_TRUE(shop.dump("spooled.db") == shop.dump());
    EXPECT_EQ(shop.run({"verify", "spooled.db"}).code, 0);
}

TEST(MachineCampaigns, WhatChangesNoAnswerChangesNoId) {
    const auto id_of = [](json machine, const std::string& stl = triangle, const std::string& spread = sizes,
                          const std::string& stl_name = "plate.stl") {
        return campaign::machine_scene_name(*machine_of(machine, {{stl_name, stl}, {"sizes.csv", spread}}));
    };
    const json machine = machine_with_files();
    const std::string id = id_of(machine);
    json same = machine;
    same["name"] = "other", same["summary"] = "in other words", same["notes"] = {"a", "b"};
    same["parameters"]["friction"]["meaning"] = "of them all";
    same["parameters"]["friction"]["bounds"] = {0, 3};
    same["walls"]["box"]["notes"] = "five faces", same["fill"][0]["in"]["box"]["notes"] = "above";
    same["measure"]["force"]["meaning"] = "upwards";
    same["walls"]["plate"]["stl"] = "p.stl";
    EXPECT_EQ(id_of(same, triangle, sizes, "p.stl"), id);

    EXPECT_NE(id_of(machine, std::string(triangle) + " "), id) << "contents of the STL file";
    EXPECT_NE(id_of(machine, triangle, "diameter,volume_fraction\n2.6e-3,0.5\n3.2e-3,0.5\n"), id)
        << "contents of the size file";
    for (const char* patch :
         {R"({"let": {"side": "21 mm"}})", R"({"let": {"meaning": 1}})", R"({"let": {"bounds": 1}})",
          R"({"walls": {"meaning": {"plane": {"normal": [0, 0, 1]}, "material": "steel"}}})",
          R"({"walls": {"bounds": {"plane": {"normal": [0, 0, 1]}, "material": "steel"}}})",
          R"({"parameters": {"meaning": {"default": 1}}})", R"({"contacts": {"friction": 0.1}})",
          R"({"measure": {"meaning": {"count": {}}}})", R"({"phases": [{"name": "fall", "for": 1},
             {"name": "turn", "for": 1}, {"name": "stop", "for": 1}]})",
          R"({"gravity": [0, 0, -9.8]})"}) {
        json other = machine;
        other.merge_patch(json::parse(patch));
        EXPECT_NE(id_of(other), id) << patch;
    }
}

// A file that a word chooses: each of its contents is part of the identity, its name is not.
TEST(MachineCampaigns, AFileMayDependOnAWord) {
    json machine = machine_with_files();
    machine["walls"]["plate"]["stl"] = "{kind}_{kind}.stl";
    const auto id_of = [&](const std::string& coarse, const std::string& fine) {
        return campaign::machine_scene_name(
            *machine_of(machine, {{"coarse_coarse.stl", coarse}, {"fine_fine.stl", fine}, {"sizes.csv", sizes}}));
    };
    const std::string other = std::string(triangle) + "\n";
    EXPECT_NE(id_of(triangle, triangle), id_of(triangle, other));
    EXPECT_NE(id_of(triangle, other), id_of(other, triangle));
    machine["let"]["file"] = "2*half", machine["let"]["stl"] = "3*half", machine["let"]["spheres"] = 3;
    EXPECT_NO_THROW((void)id_of(triangle, triangle)) << "names of numbers, not of files";
}

// A file that a case names, not the machine: its contents are part of the question, and the database keeps them.
TEST(MachineCampaigns, ACaseMayNameAFile) {
    json machine = machine_with_files();
    machine["parameters"]["measured"] = {{"file", "sizes"}, {"default", "none"}};
    machine["parameters"]["law"] = {{"words", {"monodisperse", "file"}}, {"default", "monodisperse"}};
    machine["species"]["light"]["sizes"] = {{"spread", "{law}"}, {"file", "{measured}"}};
    const Workshop shop(machine);
    json campaign = campaign_of("machine.json");
    campaign["fixed"] = {{"law", "file"}, {"measured", "sizes.csv"}};
    campaign["design"]["points"] = 4;
    shop.write("c.json", campaign.dump());
    shop.complete();
    const auto ids = shop.ids();
    ASSERT_EQ(ids.size(), 4U);

    const Folder empty(in_memory());
    fs::copy_file(shop / "m.db", empty / "m.db");
    const auto replayed = run_program({"replay", "m.db", *ids.begin()}, empty.path());
    EXPECT_EQ(replayed.code, 0) << replayed.err;
    EXPECT_THAT(replayed.out, HasSubstr("equal to the last bit"));

    shop.write("other.csv", "diameter,volume_fraction\n2.6e-3,0.5\n3.1e-3,0.5\n");
    campaign["fixed"]["measured"] = "other.csv";
    shop.write("c.json", campaign.dump());
    shop.complete("other.db");
    EXPECT_EQ(shop.ids("other.db").count(*ids.begin()), 0U);

    campaign["fixed"]["measured"] = "c.json";
    shop.write("wrong.json", campaign.dump());
    const auto wrong = shop.run({"run", "wrong.json", "--db", "wrong.db"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("$.fixed.measured: got \"c.json\"; the file is none of the kind asked for"));
}

TEST(MachineCampaigns, OneDatabaseHoldsTwoMachines) {
    const Workshop shop;
    shop.complete();
    json second = machine_with_files();
    second["name"] = "wide_bin";
    second["let"]["side"] = "24 mm";
    shop.write("second.json", second.dump());
    json campaign = campaign_of("second.json", "wide");
    campaign["design"]["points"] = 4;
    shop.write("wide.json", campaign.dump());
    shop.complete("m.db", "wide.json");
    EXPECT_EQ(shop.rows("SELECT count(*) AS n FROM machine")[0]["n"], 2);
    EXPECT_EQ(shop.rows("SELECT count(*) AS n FROM wide")[0]["n"], 4);
    EXPECT_EQ(shop.ids().size(), 16U);
    EXPECT_EQ(shop.run({"verify", "m.db"}).code, 0);
    EXPECT_EQ(shop.run({"report", "m.db"}).code, 0);

    // The same machine under another name asks the same cases: nothing is computed again.
    json renamed = machine_with_files();
    renamed["name"] = "renamed", renamed["notes"] = "the same", renamed["walls"]["plate"]["stl"] = "copy.stl";
    shop.write("copy.stl", triangle);
    shop.write("renamed.json", renamed.dump());
    shop.write("again.json", campaign_of("renamed.json", "again").dump());
    shop.complete("m.db", "again.json");
    EXPECT_EQ(shop.ids().size(), 16U);
    EXPECT_EQ(shop.rows("SELECT count(outcome) AS n FROM again")[0]["n"], 12);
}

TEST(MachineCampaigns, AMachineMayStandInTheCampaignFile) {
    const Workshop shop;
    shop.complete();
    shop.write("inside.json", campaign_of(machine_with_files(), "m").dump());
    shop.complete("inside.db", "inside.json");
    EXPECT_EQ(shop.ids("inside.db"), shop.ids());
    EXPECT_TRUE(shop.dump("inside.db") == shop.dump());
}

TEST(MachineCampaigns, VerifyFindsADamagedDefinition) {
    const Workshop shop;
    shop.complete();
    const auto damaged = [&](const std::string& sql) {
        fs::copy_file(shop / "m.db", shop / "damaged.db", fs::copy_options::overwrite_existing);
        sqlite3* db = nullptr;
        EXPECT_EQ(sqlite3_open((shop / "damaged.db").c_str(), &db), SQLITE_OK);
        char* why = nullptr;
        EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, &why), SQLITE_OK) << (why != nullptr ? why : "");
        sqlite3_free(why);
        sqlite3_close(db);
        const auto ended = shop.run({"verify", "damaged.db", "--format", "csv"});
        EXPECT_NE(ended.code, 0) << sql;
        return ended.out + ended.err;
    };
    EXPECT_THAT(
        damaged("UPDATE machine SET definition = replace(definition, '\"side\":\"20 mm\"', '\"side\":\"21 mm\"')"),
        HasSubstr("is not as written"));
    EXPECT_THAT(damaged("UPDATE machine SET definition = substr(definition, 1, 100)"), HasSubstr("is refused"));
    EXPECT_THAT(damaged("UPDATE machine SET definition = ''"), HasSubstr("is refused"));
    EXPECT_THAT(damaged("UPDATE machine SET definition = replace(hex(zeroblob(200000)), '0', '[')"),
                HasSubstr("is refused"));
    EXPECT_THAT(damaged("UPDATE program_content SET contents = CAST(contents || ' ' AS BLOB)"),
                HasSubstr("not as written"));
    EXPECT_THAT(damaged("DELETE FROM program_content"), HasSubstr("not as written"));
}

TEST(MachineCampaigns, AWrongMachineEndsWithOneSentence) {
    const auto refusal = [](const std::function<void(json&)>& change) {
        json machine = machine_with_files();
        change(machine);
        const Workshop shop(machine);
        const auto ended = shop.run({"run", "c.json", "--quiet"});
        EXPECT_EQ(ended.code, 2) << ended.out;
        EXPECT_EQ(ended.out, "");
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
        EXPECT_FALSE(fs::exists(shop / "m.db"));
        EXPECT_EQ(std::distance(fs::directory_iterator(shop.path()), fs::directory_iterator()), 4 + 2)
            << "nothing written besides the output of this test";
        return ended.err;
    };
    EXPECT_THAT(refusal([](json& m) { m["walls"]["box"]["material"] = "stel"; }),
                HasSubstr("machine.json: $.walls.box.material: got \"stel\""));
    EXPECT_THAT(refusal([](json& m) { m["walls"]["plate"]["stl"] = "plat.stl"; }), HasSubstr("$.walls.plate.stl"));
    EXPECT_THAT(refusal([](json& m) { m["walls"]["plate"]["stl"] = "."; }), HasSubstr("$.walls.plate.stl"));
    EXPECT_THAT(refusal([](json& m) { m["species"]["light"]["sizes"]["file"] = "plate.stl"; }),
                HasSubstr("$.species.light.sizes.file"));
    EXPECT_THAT(refusal([](json& m) {
                    json deep = {{"ball", {{"centre", {0, 0, 0}}, {"radius", 1}}}};
                    for (int k = 0; k < 60; ++k) deep = {{"not", deep}};
                    m["fill"][0]["in"] = deep;
                }),
                HasSubstr("nested deeper"));
    EXPECT_THAT(refusal([](json& m) { m["contacts"]["surface_energy"] = "10 J/m2"; }),
                HasSubstr("machine.json: $.contacts.surface_energy: got \"10 J/m2\"; 10 has no effect"));
    for (const char* text : {"1e400", "NaN", "[1, 2", "\"\\u0000\"", ""}) {
        const Workshop shop;
        std::string machine = machine_with_files().dump();
        machine.replace(machine.find("2500"), 4, text);
        shop.write("machine.json", machine);
        const auto ended = shop.run({"run", "c.json", "--quiet"});
        EXPECT_EQ(ended.code, 2) << text;
        EXPECT_THAT(ended.err, HasSubstr("machine.json: ")) << text;
        EXPECT_FALSE(fs::exists(shop / "m.db"));
    }
}

TEST(MachineCampaigns, AnUnknownParameterNamesTheCommandThatListsThem) {
    const Workshop shop;
    json campaign = campaign_of("machine.json");
    campaign["factors"][0]["name"] = "frictoin";
    shop.write("c.json", campaign.dump());
    const auto ended = shop.run({"plan", "c.json"});
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("machine 'bin' has no parameter of this name (grainsweep machines FILE lists "
                                     "them). Did you mean 'friction'?"));
}

// What is wrong for a case's values only is the answer of that case.
TEST(MachineCampaigns, AnImpossibleCaseIsRejected) {
    json machine = machine_with_files();
    machine["parameters"]["number"] = {{"whole", true}, {"default", 10}, {"bounds", {1, 5000}}};
    machine["fill"][0]["count"] = "number";
    machine["let"]["gap"] = "1/(number - 11)";
    const Workshop shop(machine);
    json campaign = campaign_of("machine.json");
    campaign["factors"] = {{{"name", "number"}, {"levels", {10, 11, 4000}}}};
    campaign["design"] = {{"kind", "list"}, {"rows", {{10}, {11}, {4000}}}};
    shop.write("c.json", campaign.dump());
    const auto ended = shop.run({"run", "c.json", "--quiet", "-j", "1"});
    const auto rows = shop.rows(
        "SELECT m.number, c.outcome, coalesce(t.message, '') AS message FROM m JOIN sim_case AS c USING (case_id) JOIN "
        "attempt AS t USING (case_key) ORDER BY m.number");
    ASSERT_EQ(rows.size(), 3U) << rows << ended.err;
    EXPECT_EQ(rows[0]["outcome"], "completed");
    EXPECT_EQ(rows[1]["outcome"], "rejected");
    EXPECT_THAT(rows[1]["message"].get<std::string>(), HasSubstr("$.let.gap"));
    EXPECT_EQ(rows[2]["outcome"], "rejected");
    EXPECT_THAT(rows[2]["message"].get<std::string>(), HasSubstr("of 4000 particles fit"));
}

// As `shape` says of the same file.
TEST(MachineCampaigns, APlanStatesHowSpheresCoverAShape) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "c", "scene": "stones", "fixed": {"spheres": 12},
                               "factors": [{"name": "friction", "between": [0.1, 0.5]}],
                               "design": {"kind": "halton", "points": 2}})");
    const auto planned = run_program({"plan", "c.json", "--format", "json"}, folder.path());
    const auto grain = json::parse(planned.out).at("grains").at(0);
    const auto asked = run_program(
        {"shape", source("configs/machines/stone.stl"), "--spheres", "12", "-o", "s.csv", "--format", "json"},
        folder.path());
    std::map<std::string, double> fact;
    for (const auto& row : json::parse(asked.out)) fact[row["quantity"]] = row["value"];
    EXPECT_EQ(grain["grain"], "stone");
    EXPECT_EQ(grain["spheres"], fact.at("spheres"));
    EXPECT_NEAR(grain["shared volume"], fact.at("shared volume divided by the volume"), 1e-12);
    EXPECT_NEAR(grain["smallest sphere"], fact.at("smallest sphere divided by this diameter"), 1e-12);
    EXPECT_NEAR(grain["cost"], fact.at("cost of a grain divided by a sphere's, about"), 1e-9);
}

}  // namespace grainsweep::tests::machine_campaigns_test
