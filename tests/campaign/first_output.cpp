// Outputs that a new user sees first fit one screen and lead on; every command loads only the libraries that it needs.
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests::first_output_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

constexpr std::ptrdiff_t screen = 25;

/// Powder under a blade, small enough for a test.
const char* layers = R"({"campaign": "layers", "scene": "powder_spreading", "factors": [
  {"name": "friction", "between": [0.1, 0.3]}, {"name": "gap", "between": ["3.6 mm", "7.5 mm"]}],
  "fixed": {"diameter": "3 mm", "width": 5, "settle_time": "80 ms", "time_step_fraction": 0.4},
  "design": {"kind": "halton", "sequences": 4, "points": 8}})";

struct FirstOutput : testing::Test {
    Folder folder;

    FirstOutput() { folder.write("c.json", layers); }
    [[nodiscard]] Ended run(std::vector<std::string> arguments) const {
        const auto ended = run_program(arguments, folder.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
        return ended;
    }
};

TEST_F(FirstOutput, OfSolveFitsAScreenAndLeadsOn) {
    const auto text = run({"solve", "c.json"}).out;
    EXPECT_LE(std::ranges::count(text, '\n'), screen) << text;
    EXPECT_THAT(text, HasSubstr("powder_spreading: completed"));
    EXPECT_THAT(text, HasSubstr("5.55 mm")) << "the factor in the middle of its range";
    EXPECT_LT(text.find("packing_fraction"), text.find("mfr")) << text;
    EXPECT_THAT(text, HasSubstr("solid share of the layer"));
    EXPECT_THAT(text, Not(HasSubstr("mfr_thesis")));
    EXPECT_THAT(text, HasSubstr(" run c.json\n"));

    const auto all = run({"solve", "c.json", "--all"}).out;
    EXPECT_THAT(all, HasSubstr("mfr_thesis"));
    EXPECT_THAT(all, HasSubstr("time_step_fraction"));
    EXPECT_GT(std::ranges::count(all, '\n'), 2 * screen);
}

// The rate of a screen with too small holes was 0, and only plan and run warned.
TEST_F(FirstOutput, OfSolveWarnsAsPlanDoes) {
    folder.write("m.json", R"({"name": "falling", "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}},
      "parameters": {"diameter": {"unit": "mm", "default": 3, "bounds": [1, 5]}},
      "species": {"bead": {"diameter": "diameter"}}, "walls": {"floor": {"plane": {"normal": [0, 0, 1]}}},
      "fill": [{"species": "bead", "spheres": [{"at": [0, 0, "3 mm"]}]}],
      "phases": [{"name": "fall", "for": "1 ms"}], "measure": {"top": {"height": {}, "as": "last"}},
      "checks": [{"when": "diameter > 0.002", "warn": "large", "that": "{1000*diameter} mm does not pass"}]})");
    EXPECT_EQ(run({"solve", "m.json"}).err, "warning: large: 3 mm does not pass\n");
    EXPECT_EQ(run({"solve", "m.json", "--set", "diameter=1.5"}).err, "");
}

TEST_F(FirstOutput, OfSolveOfAMachineFitsAScreen) {
    const auto text = run({"solve", "hopper", "--set", "particles=200"}).out;
    EXPECT_LE(std::ranges::count(text, '\n'), screen) << text;
    EXPECT_THAT(text, HasSubstr("\nrate "));
    EXPECT_THAT(text, HasSubstr(" draw hopper "));
}

TEST_F(FirstOutput, OfAFailedCaseIsItsReason) {
    folder.write("f.json", R"({"campaign": "f", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "fixed": {"behaviour": "unstable"}, "design": {"kind": "halton", "points": 4}})");
    const auto ended = run_program({"solve", "f.json"}, folder.path());
    EXPECT_EQ(ended.code, 1);
    EXPECT_THAT(ended.out, HasSubstr("rehearsal: unstable: "));
    EXPECT_THAT(ended.out, Not(HasSubstr("--all")));
}

TEST_F(FirstOutput, OfRunFitsAScreenAndLeadsOn) {
    const auto text = run({"run", "c.json", "-j", "2"}).out;
    EXPECT_LE(std::ranges::count(text, '\n'), screen) << text;
    EXPECT_THAT(text, HasSubstr("mean and standard deviation of 8 points"));
    EXPECT_LT(text.find("packing_fraction"), text.find("mfr")) << text;
    EXPECT_THAT(text, Not(HasSubstr("mfr_thesis")));
    EXPECT_THAT(text, HasSubstr(" report layers.db\n"));

    const auto all = run({"run", "c.json", "--all"}).out;
    EXPECT_THAT(all, HasSubstr("mfr_thesis"));
    EXPECT_THAT(all, HasSubstr("kurtosis"));
}

TEST_F(FirstOutput, ForProgramsIsWholeWithoutAWord) {
    const auto answer = json::parse(run({"solve", "c.json", "--format", "json"}).out);
    EXPECT_TRUE(answer["scalars"].contains("mfr_thesis"));
    EXPECT_GT(answer["inputs"].size(), 20U);
    EXPECT_THAT(run({"solve", "c.json", "--format", "csv"}).out, HasSubstr("mfr_thesis"));
}

// Commands and workers start often: the libraries of figures, workbooks and the live page come with their first use.
TEST_F(FirstOutput, NeedsNoLibraryOfFiguresWorkbooksOrServers) {
    const auto loaded =
        Process({"/usr/bin/env", "LD_TRACE_LOADED_OBJECTS=1", executable().string()}, folder.path()).wait();
    for (const char* name : {"libcairo", "libxlsxwriter", "libmicrohttpd", "libgnutls", "libX11", "libcrypto"})
        EXPECT_THAT(loaded.out, Not(HasSubstr(name)));
    EXPECT_LE(std::ranges::count(loaded.out, '\n'), 20) << loaded.out;
}

TEST_F(FirstOutput, AProgramWithoutItsModuleSaysWhereItBelongs) {
    const auto program = folder / "grainsweep";
    fs::copy_file(executable(), program);
    ASSERT_EQ(run({"run", "c.json", "--quiet"}).code, 0);
    const auto draw = [&] {
        return Process({program.string(), "figure", "layers.db", "effects", "-o", "effects.svg"}, folder.path()).wait();
    };
    const auto alone = draw();
    EXPECT_EQ(alone.code, 3);
    EXPECT_THAT(alone.err, HasSubstr("grainsweep_media.so, which belongs beside the program"));
    fs::copy_file(executable().parent_path() / "grainsweep_media.so", folder / "grainsweep_media.so");
    const auto together = draw();
    EXPECT_EQ(together.code, 0) << together.err;
    EXPECT_TRUE(fs::exists(folder / "effects.svg"));
}

}  // namespace grainsweep::tests::first_output_test
