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

#include "sweep/files/system_error.hpp"
#include "sweep/report/vtk_file.hpp"
#include "sweep/report/vtk_series.hpp"
#include "tests/support/process.hpp"

namespace grainsweep::tests::report_vtk_test {

/// What a VTP file says, read strictly: every byte of the appended section belongs to one array.
struct Read {
    std::size_t points = 0;
    std::map<std::string, std::vector<float>> columns;
    std::map<std::string, int> components;
    std::vector<std::int64_t> connectivity, offsets;
    std::string kind, grid;  // of a flow: ImageData or RectilinearGrid, and its attributes
    std::map<std::string, std::vector<double>> coordinates;
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
    if (std::regex_search(text, match, std::regex("NumberOfPoints=\"(\\d+)\" NumberOfVerts=\"(\\d+)\"")))
        r.points = std::stoul(match[1]);
    if (std::regex_search(text, match, std::regex("<(ImageData|RectilinearGrid) ([^>]*)>"))) {
        r.kind = match[1];
        r.grid = match[2];
    }
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
        } else if (type == "Float64") {
            r.coordinates[name] = block<double>(bytes, at, used);
        } else {  // of walls the lines, then the triangles
            EXPECT_EQ(type, "Int64");
            auto& list = name == "connectivity" ? r.connectivity : r.offsets;
            const auto more = block<std::int64_t>(bytes, at, used);
            list.insert(list.end(), more.begin(), more.end());
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

TEST(Vtp, OfAWallHoldsItsLinesAndTriangles) {
    const WallSurface wall{"blade", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}}, {{0, 1, 2}, {0, 2, 3}}, {{3, 0}}};
    const std::string file = report::vtp(wall, 0.5);
    const Read r = read(file);
    EXPECT_NE(file.find("NumberOfVerts=\"0\" NumberOfLines=\"1\" NumberOfStrips=\"0\" NumberOfPolys=\"2\""),
              std::string::npos);
    EXPECT_EQ(r.points, 4U);
    EXPECT_EQ(r.time, 0.5);
    EXPECT_EQ(r.columns.at("Points"), (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5F}));
    EXPECT_EQ(r.connectivity, (std::vector<std::int64_t>{3, 0, 0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(r.offsets, (std::vector<std::int64_t>{2, 3, 6}));
}

TEST(Vtp, OfContactsHoldsALineForEach) {
    ContactLines contacts;
    contacts.ends = {{{{0, 0, 0}, {1, 0, 0}}}, {{{0, 0, 0}, {0, 0, -0.5}}}};
    contacts.scalars["first"] = {0, 0};
    contacts.scalars["second"] = {7, -1};
    contacts.scalars["normal_force"] = {0.25, 2};
    contacts.vectors["force"] = {{-0.25, 0, 0}, {0, 0, 2}};
    const std::string file = report::vtp(contacts, 0.5);
    const Read r = read(file);
    EXPECT_NE(file.find("NumberOfVerts=\"0\" NumberOfLines=\"2\" NumberOfStrips=\"0\" NumberOfPolys=\"0\""),
              std::string::npos);
    EXPECT_LT(file.find("<CellData>"), file.find("Name=\"normal_force\"")) << "a value per line";
    EXPECT_EQ(r.points, 4U);
    EXPECT_EQ(r.time, 0.5);
    EXPECT_EQ(r.columns.at("Points"), (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, -0.5F}));
    EXPECT_EQ(r.connectivity, (std::vector<std::int64_t>{0, 1, 2, 3}));
    EXPECT_EQ(r.offsets, (std::vector<std::int64_t>{2, 4}));
    EXPECT_EQ(r.columns.at("second"), (std::vector<float>{7, -1}));
    EXPECT_EQ(r.columns.at("force"), (std::vector<float>{-0.25F, 0, 0, 0, 0, 2}));
    contacts.scalars["first"].pop_back();
    EXPECT_THROW((void)report::vtp(contacts, 0), std::invalid_argument);
}

FlowField two_cells(std::vector<double> x) {
    FlowField field;
    field.name = "flow";
    field.faces = {std::move(x), {-0.5, 0.5}, {0, 2}};
    field.scalars["temperature"] = {0.25, -0.25};
    field.vectors["velocity"] = {{1, 2, 3}, {4, 5, 6}};
    return field;
}

TEST(VtkGrid, OfEqualCellsIsAnImage) {
    const FlowField field = two_cells({-0.5, 0, 0.5});
    EXPECT_EQ(report::extension_of(field), ".vti");
    const Read r = read(report::vtk_grid(field, 0.125));
    EXPECT_EQ(r.kind, "ImageData");
    EXPECT_EQ(r.grid, "WholeExtent=\"0 2 0 1 0 1\" Origin=\"-0.5 -0.5 0\" Spacing=\"0.5 1 2\"");
    EXPECT_EQ(r.time, 0.125);
    EXPECT_EQ(r.components, (std::map<std::string, int>{{"temperature", 1}, {"velocity", 3}}));
    EXPECT_EQ(r.columns.at("temperature"), (std::vector<float>{0.25F, -0.25F}));
    EXPECT_EQ(r.columns.at("velocity"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_TRUE(r.coordinates.empty());
}

TEST(VtkGrid, OfClusteredCellsIsExact) {
    const FlowField field = two_cells({-0.5, -0.4, 0.5});
    EXPECT_EQ(report::extension_of(field), ".vtr");
    const Read r = read(report::vtk_grid(field, 0));
    EXPECT_EQ(r.kind, "RectilinearGrid");
    EXPECT_EQ(r.grid, "WholeExtent=\"0 2 0 1 0 1\"");
    EXPECT_EQ(r.coordinates.at("x"), field.faces[0]);
    EXPECT_EQ(r.coordinates.at("y"), field.faces[1]);
    EXPECT_EQ(r.coordinates.at("z"), field.faces[2]);
    EXPECT_EQ(r.columns.at("velocity").size(), 6U);
}

TEST(VtkGrid, ThatIsNoneIsRefused) {
    FlowField field = two_cells({-0.5, 0, 0.5});
    field.scalars["temperature"].push_back(1);
    EXPECT_THROW((void)report::vtk_grid(field, 0), std::invalid_argument);
    EXPECT_THROW((void)report::extension_of(two_cells({0, 0, 1})), std::invalid_argument);
    EXPECT_THROW((void)report::extension_of(two_cells({0})), std::invalid_argument);
}

TEST(VtkSeries, WritesAStandingWallOnceAndAMovingOneAtEveryMoment) {
    const tests::Folder folder;
    report::VtkSeries series(folder.path(), "bed");
    WallSurface base{"base", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}};
    WallSurface blade = base, gate = base;
    blade.name = "blade";
    gate.name = "gate";
    for (const double t : {0.0, 1.0, 2.0}) {
        Snapshot moment = three_particles();
        for (auto& corner : blade.corners) corner[0] += 0.5;
        moment.walls = {base, blade};
        if (t == 0) moment.walls.push_back(gate);
        moment.fields = {two_cells({0, 1, 2})};
        series.add(moment, t);
    }
    const auto there = [&](const char* name) { return std::filesystem::exists(folder / name); };
    EXPECT_TRUE(there("bed_base_0000.vtp") && !there("bed_base_0001.vtp"));
    EXPECT_TRUE(there("bed_blade_0000.vtp") && there("bed_blade_0001.vtp") && there("bed_blade_0002.vtp"));
    EXPECT_TRUE(there("bed_flow_0000.vti") && there("bed_flow_0002.vti"));
    const std::string collection = contents(series.collection());
    const auto listed = [&](const std::string& entry) { return collection.find(entry) != std::string::npos; };
    EXPECT_TRUE(listed("<DataSet timestep=\"2\" part=\"1\" file=\"bed_base_0000.vtp\" name=\"base\"/>"));
    EXPECT_TRUE(listed("<DataSet timestep=\"2\" part=\"2\" file=\"bed_blade_0002.vtp\" name=\"blade\"/>"));
    EXPECT_TRUE(listed("<DataSet timestep=\"0\" part=\"3\" file=\"bed_gate_0000.vtp\" name=\"gate\"/>"));
    EXPECT_FALSE(listed("<DataSet timestep=\"1\" part=\"3\""));  // the gate is gone
    EXPECT_TRUE(listed("<DataSet timestep=\"1\" part=\"4\" file=\"bed_flow_0001.vti\" name=\"flow\"/>"));
}

TEST(VtkSeries, OfAFlowAloneHasNoParticles) {
    const tests::Folder folder;
    report::VtkSeries series(folder.path(), "cavity");
    Snapshot moment;
    moment.fields = {two_cells({0, 1, 3})};
    EXPECT_FALSE(report::shows_particles(moment));
    series.add(moment, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "cavity_0000.vtp"));
    EXPECT_NE(contents(series.collection()).find("part=\"0\" file=\"cavity_flow_0000.vtr\""), std::string::npos);
}

TEST(VtkSeries, NamesEveryMomentInTheCollection) {
    const tests::Folder folder;
    report::VtkSeries series(folder / "deep/inside", "cell");
    series.add(three_particles(), 0);
    series.add(three_particles(), 0.25);
    const std::string collection = contents(series.collection());
    EXPECT_NE(collection.find("<DataSet timestep=\"0\" part=\"0\" file=\"cell_0000.vtp\" name=\"particles\"/>"),
              std::string::npos);
    EXPECT_NE(collection.find("<DataSet timestep=\"0.25\" part=\"0\" file=\"cell_0001.vtp\" name=\"particles\"/>"),
              std::string::npos);
    EXPECT_EQ(read(contents(folder / "deep/inside/cell_0001.vtp")).time, 0.25);
}

TEST(VtkSeries, ReplacesALongerSeriesOfItsName) {
    const tests::Folder folder;
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
    const tests::Folder folder;
    folder.write("file", "in the way");
    report::VtkSeries series(folder / "file/inside", "cell");
    EXPECT_THROW(series.add(three_particles(), 0), SystemError);
    report::VtkSeries empty(folder / "other", "cell");  // a series without a picture leaves no folder
    EXPECT_FALSE(std::filesystem::exists(folder / "other"));
}

TEST(VtkSeries, ReplacesNothingThroughASymbolicLink) {
    const tests::Folder folder;
    std::filesystem::create_directory(folder / "p");
    folder.write("precious", "kept");
    for (const char* name : {"cell_0000.vtp", "cell_0001.vtp"})
        std::filesystem::create_symlink(folder / "precious", folder / "p" / name);
    report::VtkSeries series(folder / "p", "cell");
    EXPECT_THROW(series.add(three_particles(), 0), SystemError);
    EXPECT_EQ(contents(folder / "precious"), "kept");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "p/cell_0000.vtp"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "p/cell_0001.vtp"));
}

}  // namespace grainsweep::tests::report_vtk_test
