// Files of pictures, read back as the format is described: tags, offsets and lengths must all fit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "sweep/report/vtk_series.hpp"
#include "sweep/store/broken_world.hpp"
#include "tests/support/process.hpp"

using namespace grainsweep;

namespace {

/// What a VTP file says, read strictly: every byte of the appended section belongs to one array.
struct Read {
    std::size_t points = 0;
    std::map<std::string, std::vector<float>> columns;
    std::map<std::string, int> components;
    std::vector<std::int64_t> connectivity, offsets;
    double time = 0;
};

template <class T>
std::vector<T> block(const std::string& bytes, std::size_t at, std::size_t& used) {
    std::uint64_t length = 0;
    EXPECT_LE(at + sizeof length, bytes.size());
    std::memcpy(&length, bytes.data() + at, sizeof length);
    EXPECT_LE(at + sizeof length + length, bytes.size());
    EXPECT_EQ(length % sizeof(T), 0U);
    std::vector<T> values(length / sizeof(T));
    if (length > 0) std::memcpy(values.data(), bytes.data() + at + sizeof length, length);
    used += sizeof length + length;
    return values;
}

Read read(const std::string& file) {
    Read r;
    const std::string opening = "<AppendedData encoding=\"raw\">\n_", closing = "\n</AppendedData>\n</VTKFile>\n";
    const std::size_t begin = file.find(opening);
    EXPECT_NE(begin, std::string::npos);
    EXPECT_TRUE(file.ends_with(closing));
    const std::string text = file.substr(0, begin);
    const std::string bytes =
        file.substr(begin + opening.size(), file.size() - begin - opening.size() - closing.size());
    EXPECT_NE(text.find("byte_order=\"LittleEndian\" header_type=\"UInt64\""), std::string::npos);
    std::smatch match;
    EXPECT_TRUE(std::regex_search(text, match, std::regex("NumberOfPoints=\"(\\d+)\" NumberOfVerts=\"1\"")));
    r.points = std::stoul(match[1]);
    EXPECT_TRUE(std::regex_search(text, match, std::regex("Name=\"TimeValue\"[^>]*>([^<]*)<")));
    r.time = std::stod(match[1]);
    const std::regex array(
        "<DataArray type=\"(\\w+)\" Name=\"(\\w+)\" NumberOfComponents=\"(\\d)\" format=\"appended\" "
        "offset=\"(\\d+)\"/>");
    std::size_t used = 0;
    for (std::sregex_iterator a(text.begin(), text.end(), array), end; a != end; ++a) {
        const std::string type = (*a)[1], name = (*a)[2];
        const std::size_t at = std::stoul((*a)[4]);
        if (type == "Float32") {
            r.columns[name] = block<float>(bytes, at, used);
            r.components[name] = std::stoi((*a)[3]);
        } else {
            EXPECT_EQ(type, "Int64");
            (name == "connectivity" ? r.connectivity : r.offsets) = block<std::int64_t>(bytes, at, used);
        }
    }
    EXPECT_EQ(used, bytes.size());
    return r;
}

Snapshot three_particles() {
    Snapshot s;
    s.positions = {{0, 1, 2}, {1e-6, -2e-6, 3e-6}, {1.0 / 3, 2.0 / 3, 1}};
    s.scalars["diameter"] = {1, 2, std::numeric_limits<double>::quiet_NaN()};
    s.vectors["velocity"] = {{1, 0, 0}, {0, -1e30, 0}, {0, 0, 0.1}};
    return s;
}

std::string contents(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST(Vtp, SaysWhatTheSnapshotHolds) {
    const Snapshot s = three_particles();
    const Read r = read(report::vtp(s, 0.1));
    EXPECT_EQ(r.points, 3U);
    EXPECT_EQ(r.time, 0.1);
    EXPECT_EQ(r.connectivity, (std::vector<std::int64_t>{0, 1, 2}));
    EXPECT_EQ(r.offsets, (std::vector<std::int64_t>{3}));
    EXPECT_EQ(r.components, (std::map<std::string, int>{{"Points", 3}, {"diameter", 1}, {"velocity", 3}}));
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_EQ(r.columns.at("Points")[3 * i + a], static_cast<float>(s.positions[i][a]));
            EXPECT_EQ(r.columns.at("velocity")[3 * i + a], static_cast<float>(s.vectors.at("velocity")[i][a]));
        }
    EXPECT_EQ(r.columns.at("diameter")[1], 2);
    EXPECT_TRUE(std::isnan(r.columns.at("diameter")[2]));
}

TEST(Vtp, ACellThatRanEmptyIsAPictureToo) {
    Snapshot s;
    s.scalars["diameter"] = {};
    const Read r = read(report::vtp(s, 1));
    EXPECT_EQ(r.points, 0U);
    EXPECT_TRUE(r.columns.at("Points").empty());
    EXPECT_EQ(r.offsets, (std::vector<std::int64_t>{0}));
}

TEST(Vtp, ColumnsOfAnotherLengthAreRefused) {
    Snapshot s = three_particles();
    s.scalars["diameter"].pop_back();
    EXPECT_THROW((void)report::vtp(s, 0), std::invalid_argument);
}

TEST(VtkSeries, NamesEveryMomentInTheCollection) {
    const test::Folder folder;
    report::VtkSeries series(folder / "deep/inside", "cell");
    series.add(three_particles(), 0);
    series.add(three_particles(), 0.25);
    const std::string collection = contents(series.collection());
    EXPECT_NE(collection.find("<DataSet timestep=\"0\" part=\"0\" file=\"cell_0000.vtp\"/>"), std::string::npos);
    EXPECT_NE(collection.find("<DataSet timestep=\"0.25\" part=\"0\" file=\"cell_0001.vtp\"/>"), std::string::npos);
    EXPECT_EQ(read(contents(folder / "deep/inside/cell_0001.vtp")).time, 0.25);
}

TEST(VtkSeries, ReplacesALongerSeriesOfItsName) {
    const test::Folder folder;
    report::VtkSeries longer(folder / "p", "cell"), other(folder / "p", "bed"), shorter(folder / "p", "cell");
    for (const double t : {0.0, 1.0, 2.0, 3.0}) longer.add(three_particles(), t);
    for (const double t : {0.0, 1.0, 2.0}) other.add(three_particles(), t);
    for (const double t : {0.0, 0.5}) shorter.add(three_particles(), t);
    const auto there = [&](const char* name) { return std::filesystem::exists(folder / "p" / name); };
    EXPECT_TRUE(there("cell_0000.vtp") && there("cell_0001.vtp") && there("bed_0002.vtp"));
    EXPECT_FALSE(there("cell_0002.vtp") || there("cell_0003.vtp"));
    EXPECT_EQ(read(contents(folder / "p/cell_0001.vtp")).time, 0.5);
}

TEST(VtkSeries, AFolderThatCannotBeMadeIsSaid) {
    const test::Folder folder;
    folder.write("file", "in the way");
    report::VtkSeries series(folder / "file/inside", "cell");
    EXPECT_THROW(series.add(three_particles(), 0), store::BrokenWorld);
    report::VtkSeries empty(folder / "other", "cell");  // a series without a picture leaves no folder
    EXPECT_FALSE(std::filesystem::exists(folder / "other"));
}
