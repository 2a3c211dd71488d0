// --vtk of solve and replay, through the real executable.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

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
