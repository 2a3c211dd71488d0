// Figures for print, through the real program: every figure that a campaign has, at both widths of a journal.
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::figures_test {

using nlohmann::json;
using testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Numbers on two scales, words of which one makes cases fail, a rule, series.
const char* mixed = R"({"campaign": "mixed", "scene": "rehearsal", "factors": [
  {"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0.001, 1], "scale": "log"},
  {"name": "behaviour", "levels": ["normal", "unstable"]}],
  "fixed": {"noise": 0.02}, "design": {"kind": "halton", "points": 96, "sequences": 4},
  "convergence": {"observable": "y", "block": 16, "tolerance": 0.001}})";

struct Figures : testing::Test {
    Folder folder;

    void run(const char* config, const std::string& name) {
        folder.write(name + ".json", config);
        const auto ended = program({"run", name + ".json", "--quiet", "-j", "2"});
        ASSERT_LE(ended.code, 1) << ended.err;
    }
    [[nodiscard]] Ended program(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    /// Draws a figure and returns the bytes of the file.
    [[nodiscard]] std::string drawn(const std::string& database, const std::string& name, const std::string& file,
                                    std::vector<std::string> options = {}) const {
        options.insert(options.begin(), {"figure", database, name, "-o", file});
        const auto ended = program(options);
        EXPECT_EQ(ended.code, 0) << name << ": " << ended.err;
        return bytes_of(folder / file);
    }
    void expect_refused(const std::vector<std::string>& arguments, const std::string& sentence) const {
        const auto ended = program(arguments);
        EXPECT_EQ(ended.code, 2) << sentence;
        EXPECT_THAT(ended.err, HasSubstr(sentence));
        EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    }
};

TEST_F(Figures, EveryOneIsDrawnInEveryFormAndTheSameAgain) {
    run(mixed, "mixed");
    const auto listed = program({"figure", "mixed.db", "--format", "json"});
    ASSERT_EQ(listed.code, 0) << listed.err;
    const auto figures = json::parse(listed.out);
    std::vector<std::string> names;
    for (const auto& figure : figures) names.push_back(figure.at("figure"));
    EXPECT_THAT(names, testing::ElementsAre("distribution", "convergence", "effects", "sensitivity", "variance",
                                            "model", "model-map", "cases", "map", "against"));
    for (const auto& name : names) {
        for (const std::string width : {"85mm", "170mm"}) {
            const auto pdf = drawn("mixed.db", name, "a.pdf", {"--width", width});
            EXPECT_TRUE(pdf.starts_with("%PDF-")) << name;
            EXPECT_TRUE(pdf == drawn("mixed.db", name, "b.pdf", {"--width", width})) << name;
        }
        const auto svg = drawn("mixed.db", name, "a.svg");
        EXPECT_TRUE(svg.starts_with("<?xml")) << name;
        EXPECT_TRUE(svg == drawn("mixed.db", name, "b.svg")) << name;
    }
    const auto png = drawn("mixed.db", "effects:x1", "a.png");
    EXPECT_TRUE(png.starts_with("\x89PNG"));
    EXPECT_TRUE(png == drawn("mixed.db", "effects:x1", "b.png", {"--width", "8.5 cm"}));
}

TEST_F(Figures, VariablesAreChosen) {
    run(mixed, "mixed");
    const auto usual = drawn("mixed.db", "cases", "a.pdf");
    const auto other = drawn("mixed.db", "cases", "b.pdf", {"--across", "x1", "--up", "x2", "--colour", "y"});
    EXPECT_TRUE(usual != other);
    EXPECT_TRUE(drawn("mixed.db", "map", "a.pdf", {"--across", "x1", "--up", "x2"}) !=
                drawn("mixed.db", "map", "b.pdf", {"--across", "x2", "--up", "x1"}));
}

/// A lattice with three replicates: a line per level, with the scatter of the replicates.
const char* levels = R"({"campaign": "levels", "scene": "rehearsal", "factors": [
  {"name": "x1", "levels": [0.01, 0.1, 1]}, {"name": "x2", "levels": [0.2, 0.8]}],
  "fixed": {"noise": 0.02}, "design": {"kind": "lattice"}, "replicates": 3})";

TEST_F(Figures, LinesJoinMeansOfALevel) {
    run(levels, "levels");
    const std::vector<std::string> chosen = {"--across", "x1", "--up", "y", "--colour", "x2"};
    auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), chosen.begin(), chosen.end());
        return more;
    };
    const auto points = drawn("levels.db", "cases", "a.svg", chosen);
    const auto lines = drawn("levels.db", "cases", "b.svg", with({"--lines"}));
    const auto logarithmic = drawn("levels.db", "cases", "c.svg", with({"--lines", "--across-axis", "log"}));
    EXPECT_TRUE(points != lines);
    EXPECT_TRUE(lines != logarithmic);
    expect_refused({"figure", "levels.db", "map", "-o", "f.svg", "--lines"},
                   "--lines: the figure 'map' has no such choice");
    expect_refused({"figure", "levels.db", "map", "-o", "f.svg", "--across-axis", "log"},
                   "the figure 'map' has no such choice");
    expect_refused({"figure", "levels.db", "cases", "-o", "f.svg", "--across-axis", "lin"}, "must be log or linear");
    expect_refused({"figure", "levels.db", "cases", "-o", "f.svg", "--lines", "--across", "y"},
                   "lines run over a factor: x1, x2");
    expect_refused({"figure", "levels.db", "cases", "-o", "f.svg", "--lines", "--up", "x2", "--across", "x1"},
                   "lines are means of an observable");
}

TEST_F(Figures, WrongUsesAreOneSentenceAndWriteNothing) {
    run(mixed, "mixed");
    expect_refused({"figure", "mixed.db", "cases", "-o", "f.pdf", "--across", "x1", "--across-axis", "log"},
                   "'x1' reaches down to 0");
    expect_refused({"figure", "mixed.db", "cases", "-o", "f.pdf", "--lines", "--colour", "x2"},
                   "lines differ by a factor with levels");
    expect_refused({"figure", "mixed.db", "efects", "-o", "f.pdf"}, "Did you mean 'effects'?");
    expect_refused({"figure", "mixed.db", "effects:x3", "-o", "f.pdf"},
                   "the panels of 'effects' are x1, x2, behaviour");
    expect_refused({"figure", "mixed.db", "map:x1", "-o", "f.pdf"}, "the figure 'map' is one panel");
    expect_refused({"figure", "mixed.db", "posterior", "-o", "f.pdf"}, "campaign 'mixed' has no such figure");
    expect_refused({"figure", "mixed.db", "effects"}, "-o: name a file that ends in .pdf, .svg or .png");
    expect_refused({"figure", "mixed.db", "effects", "-o", "f.jpg"}, "must end in .pdf, .svg or .png");
    expect_refused({"figure", "mixed.db", "-o", "f.pdf"}, "name a figure");
    expect_refused({"figure", "mixed.db", "effects", "-o", "f.pdf", "--width", "85"},
                   "must be a length from 40 to 400 mm");
    expect_refused({"figure", "mixed.db", "effects", "-o", "f.pdf", "--width", "8 kg"}, "must be a length");
    expect_refused({"figure", "mixed.db", "effects", "-o", "f.pdf", "--width", "2mm"}, "must be a length");
    expect_refused({"figure", "mixed.db", "effects", "-o", "f.pdf", "--up", "x1"},
                   "the figure 'effects' has no such choice");
    expect_refused({"figure", "mixed.db", "map", "-o", "f.pdf", "--up", "y"}, "a map is over two factors");
    expect_refused({"figure", "mixed.db", "cases", "-o", "f.pdf", "--up", "x4"}, "is none of");
    EXPECT_FALSE(std::filesystem::exists(folder / "f.pdf"));
    folder.write("mine.pdf", "my notes");
    expect_refused({"figure", "mixed.db", "effects", "-o", "mine.pdf"}, "this file exists and is not a PDF file");
    EXPECT_EQ(bytes_of(folder / "mine.pdf"), "my notes");
}

TEST_F(Figures, OfScreeningDesignsAndCalibrations) {
    run(R"({"campaign": "screen", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 1]}], "design": {"kind": "morris", "trajectories": 8, "grid": 4}})",
        "screen");
    EXPECT_FALSE(drawn("screen.db", "sensitivity", "a.pdf").empty());
    run(R"({"campaign": "fit", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 1]}], "fixed": {"noise": 0.01},
        "calibration": {"targets": [{"observable": "y", "value": 1.0, "error": 0.05}], "discrepancy": {"y": 0.02},
                        "waves": 2, "points_per_wave": 20}})",
        "fit");
    EXPECT_FALSE(drawn("fit.db", "posterior", "a.pdf").empty());
    EXPECT_FALSE(drawn("fit.db", "posterior:x1,x2", "a.pdf").empty());
    // A campaign without a result has nothing to draw.
    folder.write("none.json",
                 R"({"campaign": "none", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "fixed": {"behaviour": "unstable"}, "design": {"kind": "halton", "points": 4}})");
    EXPECT_EQ(program({"run", "none.json", "--quiet"}).code, 1);
    expect_refused({"figure", "none.db"}, "campaign 'none' has no result to draw yet");
}

}  // namespace grainsweep::tests::figures_test
