// --vtk of solve and replay, through the real executable.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.hpp"

namespace grainsweep::tests::pictures_test {

using nlohmann::json;

const char* cell = R"({"campaign": "c", "scene": "tpms_discharge", "factors": [{"name": "cohesion", "levels": [0]}],
  "fixed": {"edge": 8, "shell": 2, "gravity": 122.6, "end_time": 0.5}, "design": {"kind": "lattice"}})";

std::string contents(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Times named in a PVD file; every file it names must be there and as long as its own words say.
std::vector<double> moments(const std::filesystem::path& pvd) {
    const std::string text = contents(pvd);
    std::vector<double> times;
    const std::regex entry("timestep=\"([^\"]*)\" part=\"0\" file=\"([^\"]*)\"");
    for (std::sregex_iterator m(text.begin(), text.end(), entry), end; m != end; ++m) {
        times.push_back(std::stod((*m)[1]));
        const std::string file = contents(pvd.parent_path() / (*m)[2].str());
        EXPECT_TRUE(file.ends_with("</VTKFile>\n"));
        for (const char* column : {"mobile", "diameter", "overlap", "force", "velocity"})
            EXPECT_NE(file.find("Name=\"" + std::string(column) + "\""), std::string::npos) << column;
    }
    return times;
}

TEST(Pictures, AreEvenlySpacedAndChangeNoBit) {
    const Folder folder;
    folder.write("c.json", cell);
    const auto plain = run_program({"solve", "c.json", "--format", "json"}, folder.path());
    const auto seen =
        run_program({"solve", "c.json", "--format", "json", "--vtk", "film", "--frames", "6"}, folder.path());
    ASSERT_EQ(seen.code, 0) << seen.err;
    json a = json::parse(plain.out), b = json::parse(seen.out);
    a.erase("cost"), b.erase("cost");
    EXPECT_EQ(a, b);
    const auto times = moments(folder / "film/tpms_discharge.pvd");
    ASSERT_EQ(times.size(), 6U);
    EXPECT_EQ(times.front(), 0);
    for (std::size_t k = 1; k < times.size(); ++k) EXPECT_NEAR(times[k] - times[k - 1], times.back() / 5, 1.1e-6);
}

TEST(Pictures, OfACaseThatEndsEarlyAreAsManyAndShowItsWalls) {
    const Folder folder;
    const auto seen = run_program({"solve", "heap", "--set", "particles=60", "--frames", "24", "--watch", "heap.html",
                                   "--vtk", "film", "--format", "json"},
                                  folder.path());
    ASSERT_EQ(seen.code, 0) << seen.err;
    EXPECT_NE(seen.err.find("24 frames of"), std::string::npos) << seen.err;
    const auto times = moments(folder / "film/heap.pvd");
    ASSERT_EQ(times.size(), 24U);
    EXPECT_LT(times.back(), 2) << "of three seconds";
    const std::string collection = contents(folder / "film/heap.pvd");
    std::map<double, int> walls;  // by time
    const std::regex entry("timestep=\"([^\"]*)\" part=\"([1-9])\" file=\"([^\"]*)\"");
    for (std::sregex_iterator m(collection.begin(), collection.end(), entry), end; m != end; ++m) {
        ++walls[std::stod((*m)[1])];
        EXPECT_TRUE(std::filesystem::exists(folder / "film" / (*m)[3].str()));
    }
    EXPECT_EQ(walls.size(), 24U) << "in every picture, the last one included";
    std::size_t files = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder / "film"))
        if (std::regex_match(file.path().filename().string(), std::regex("heap_[0-9]+.vtp"))) ++files;
    EXPECT_EQ(files, 24U) << "no other picture is left";
}

TEST(Pictures, OfAStoredCase) {
    const Folder folder;
    folder.write("c.json", cell);
    ASSERT_EQ(run_program({"run", "c.json", "-j", "1"}, folder.path()).code, 0);
    const auto rows =
        json::parse(run_program({"query", "c.db", "SELECT case_id FROM c", "--format", "json"}, folder.path()).out);
    const std::string id = rows.at(0).at("case_id");
    const auto replayed = run_program({"replay", "c.db", id, "--vtk", "film", "--frames", "3"}, folder.path());
    EXPECT_EQ(replayed.code, 0) << replayed.out << replayed.err;
    EXPECT_NE(replayed.out.find("equal to the last bit"), std::string::npos);
    EXPECT_EQ(moments(folder / "film/tpms_discharge.pvd").size(), 3U);
}

/// A heavy sphere on a floor, and a light one on it.
const char* pile = R"json({"name": "pile",
  "domain": {"low": [-0.1, -0.1, -0.01], "high": [0.1, 0.1, 0.1]},
  "materials": {"rock": {"density": 2500, "youngs_modulus": "50 MPa", "poisson_ratio": 0.25}},
  "contacts": {"restitution": 0.1, "friction": 0.3},
  "species": {"ball": {"diameter": "4 mm"}},
  "walls": {"floor": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}},
  "fill": [{"species": "ball", "spheres": [{"at": [0, 0, 0.002]}, {"at": [0, 0, 0.006]}, {"at": [0.05, 0, 0.05]}]}],
  "phases": [{"name": "rest", "for": 0.4}],
  "measure": {"height": {"mean_height": {}, "as": "last"}}})json";

TEST(Pictures, ContactsOfOneInstantAreATable) {
    const Folder folder;
    folder.write("pile.json", pile);
    const auto seen = run_program(
        {"solve", "pile.json", "--contacts", "early.csv", "--contacts-at", "50ms", "--vtk", "film", "--frames", "3"},
        folder.path());
    ASSERT_EQ(seen.code, 0) << seen.err;
    EXPECT_NE(seen.out.find("early.csv: 2 contacts at 0.05"), std::string::npos) << seen.out;
    std::istringstream table(contents(folder / "early.csv"));
    std::string header, line;
    std::getline(table, header);
    EXPECT_EQ(header,
              "first,second,wall,x,y,z,to_x,to_y,to_z,normal_force,overlap,slides,tangential_force,force_x,"
              "force_y,force_z");
    const double weight = 2500 * 3.14159265 / 6 * 0.004 * 0.004 * 0.004 * 9.81;
    int of_floor = 0, of_pair = 0;
    while (std::getline(table, line)) {
        std::vector<std::string> cells;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
        ASSERT_EQ(cells.size(), 16u);
        const bool floor = cells[2] == "floor";
        ++(floor ? of_floor : of_pair);
        EXPECT_EQ(cells[1].empty(), floor) << line;
        EXPECT_NEAR(std::stod(cells[9]) / weight, floor ? 2 : 1, 0.05) << line;
        // To the floor, or to the centre of the other sphere.
        EXPECT_NEAR(floor ? std::stod(cells[8]) : std::abs(std::stod(cells[8]) - std::stod(cells[5])),
                    floor ? 0 : 0.004, 1e-4)
            << line;
    }
    EXPECT_EQ(of_floor, 1);
    EXPECT_EQ(of_pair, 1);
    EXPECT_NE(contents(folder / "film/pile_0002_contacts.vtp").find("NumberOfLines=\"3\""), std::string::npos);
    // At the end all have come to rest.
    EXPECT_NE(run_program({"solve", "pile.json", "--contacts", "end.csv"}, folder.path())
                  .out.find("end.csv: 3 contacts at 0.4"),
              std::string::npos);
    const auto late =
        run_program({"solve", "pile.json", "--contacts", "late.csv", "--contacts-at", "3"}, folder.path());
    EXPECT_NE(late.out.find(", where the case ended"), std::string::npos) << late.out;
    const auto expect_refused = [&](std::vector<std::string> options, const char* sentence) {
        options.insert(options.begin(), {"solve", "pile.json"});
        const auto ended = run_program(options, folder.path());
        EXPECT_EQ(ended.code, 2);
        EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
    };
    expect_refused({"--contacts-at", "1"}, "--contacts-at: got 1; needs --contacts.");
    expect_refused({"--contacts", "c.csv", "--contacts-at", "3kg"}, "must be a time, such as 0.2s or 150ms");
    expect_refused({"--contacts", "pile.json"}, "this file exists and is not a table of contacts");
}

TEST(Pictures, AMachineIsDrawnWhoseFillingDoesNotFit) {
    const Folder folder;
    json machine = json::parse(pile);
    machine["name"] = "full";
    machine["fill"] = json::parse(R"([{"species": "ball", "count": 1000,
        "in": {"box": {"low": [0, 0, 0.01], "high": [0.02, 0.02, 0.03]}}}])");
    folder.write("full.json", machine.dump().c_str());
    const auto full = run_program({"draw", "full.json", "-o", "full.html"}, folder.path());
    EXPECT_EQ(full.code, 0) << full.err;
    EXPECT_NE(full.err.find("grainsweep: full: drawn without particles: ball: "), std::string::npos) << full.err;
    EXPECT_NE(full.err.find("of 1000 particles fit into the region"), std::string::npos) << full.err;
    EXPECT_NE(full.out.find("with 0 spheres"), std::string::npos) << full.out;
    EXPECT_TRUE(std::filesystem::exists(folder / "full.html"));
}

TEST(Pictures, OfTheMachineOfACampaignHaveItsSettings) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "c", "scene": "hopper", "fixed": {"particles": 500}, "factors": [
      {"name": "diameter", "between": ["4 mm", "6 mm"]}], "design": {"kind": "halton", "points": 2}})");
    const auto drawn = run_program({"draw", "c.json", "-o", "c.html", "--format", "json"}, folder.path());
    EXPECT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_EQ(json::parse(drawn.out)["particles"], 500);
    folder.write("r.json", R"({"campaign": "r", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "halton", "points": 2}})");
    const auto refused = run_program({"draw", "r.json", "-o", "r.html"}, folder.path());
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("scene 'rehearsal' is no machine"), std::string::npos) << refused.err;
}

TEST(Pictures, OfNothingAreRefused) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "halton", "points": 2}})");
    const auto ended = run_program({"solve", "c.json", "--vtk", "film"}, folder.path());
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.err.find("shows no particles"), std::string::npos) << ended.err;
    EXPECT_EQ(run_program({"solve", "c.json", "--frames", "5"}, folder.path()).code, 2);
}

}  // namespace grainsweep::tests::pictures_test
