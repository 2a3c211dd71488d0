// Powder files: sizes of laws, percentiles and files, cuts, numbers of a powder.
#include "sweep/campaign/powder.hpp"
#include "sweep/campaign/powder_result.hpp"

#include "solver/particles/size_laws.hpp"
#include "solver/particles/size_table.hpp"
#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/file_contents.hpp"
#include "sweep/campaign/input_error.hpp"
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

namespace grainsweep::tests::campaign_powder_test {

using particles::SizeTable;
using testing::HasSubstr;

double normal_share(double z) {
    return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

campaign::Powder read_sizes(const Folder& folder, const std::string& sizes) {
    return campaign::read_powder(folder.write("p.json", R"({"powder": "p", "sizes": )" + sizes + "}"));
}

TEST(SizeTables, GiveSharesQuantilesAndParts) {
    const auto table = SizeTable::read("diameter,volume_below\n1e-5,0\n2e-5,0.25\n4e-5,1\n");
    EXPECT_NEAR(table.share_below(2e-5, 3), 0.25, 1e-12);
    EXPECT_NEAR(table.share_below(3e-5, 3), 0.625, 1e-12);
    EXPECT_NEAR(table.quantile(0.625, 3), 3e-5, 1e-17);
    EXPECT_EQ(table.share_below(1e-5, 0), 0);
    EXPECT_NEAR(table.share_below(5e-5, 0), 1, 1e-12);
    // Number falls as d^-3: half of the particles between 10 and 20 um lie below the d with d^-2 half way.
    const auto part = table.between(1e-5, 2e-5);
    EXPECT_NEAR(part.quantile(0.5, 0), 1 / std::sqrt((1e10 + 0.25e10) / 2), 1e-13);
    EXPECT_NEAR(part.quantile(0.5, 3), 1.5e-5, 1e-15);
    const auto cut = table.between(1.5e-5, 3e-5);
    EXPECT_NEAR(cut.share_below(2e-5, 3), 0.125 / 0.5, 1e-12);
    EXPECT_EQ(SizeTable::read(cut.text()).text(), cut.text());
    EXPECT_THROW((void)table.between(5e-5, 6e-5), std::invalid_argument);
    const auto classes = SizeTable::read("diameter,number_fraction\n1e-5,0.5\n2e-5,0.5\n");
    EXPECT_NEAR(classes.share_below(1.5e-5, 3), 1.0 / 9, 1e-12);
    EXPECT_EQ(classes.between(1.5e-5, 1).text(), "diameter,number_fraction\n2e-05,1\n");
}

TEST(SizeTables, OfLawsHaveTheirPercentiles) {
    const double spread = 0.3;
    const auto table = SizeTable::read(particles::lognormal_table(34e-6, spread, spread, 3));
    for (const double z : {-1.28155156554, -0.52440051271, 0.0, 0.52440051271, 1.28155156554})
        EXPECT_NEAR(table.share_below(34e-6 * std::exp(spread * z), 3), normal_share(z), 1e-6) << z;
    const auto coarse = SizeTable::read(particles::rosin_rammler_table(40e-6, 3, 3));
    EXPECT_NEAR(coarse.share_below(40e-6 * std::cbrt(std::log(2)), 3), 0.5, 1e-7);
}

// Hatch and Choate (1929): of a lognormal law by d^r, the law by volume has the same spread about
// exp((3 - r) sigma^2) times its median.
TEST(SizeTables, OfLawsByNumberAndAreaKeepTheirVolume) {
    for (const int power : {0, 2})
        for (const double ratio : {1.5, 2.0, 2.5}) {
            const double sigma = std::log(ratio), median = 30e-6 * std::exp((3 - power) * sigma * sigma);
            const auto table = SizeTable::read(particles::lognormal_table(30e-6, sigma, sigma, power));
            for (const double z : {-1.28155156554, 0.0, 1.28155156554})
                EXPECT_NEAR(table.quantile(normal_share(z), 3) / (median * std::exp(sigma * z)), 1, 0.01)
                    << power << " " << ratio << " " << z;
            EXPECT_NEAR(table.quantile(0.5, power) / 30e-6, 1, 0.02) << power << " " << ratio;
        }
    // Rosin and Rammler with n = 1 by number: the volume below d is the incomplete gamma function of 4.
    const auto coarse = SizeTable::read(particles::rosin_rammler_table(40e-6, 1, 0));
    EXPECT_NEAR(coarse.quantile(0.5, 3) / (40e-6 * 3.672060749), 1, 0.01);
}

TEST(SizeTables, TakeSharesOfTheSurface) {
    const auto table = SizeTable::read("diameter,area_below\n1e-5,0\n2e-5,0.5\n4e-5,1\n");
    EXPECT_NEAR(table.quantile(0.5, 2), 2e-5, 1e-12);
    EXPECT_NEAR(table.share_below(1.5e-5, 2), 0.25, 1e-9);
    // A surface that is uniform in d has a volume proportional to the integral of d.
    EXPECT_NEAR(table.share_below(2e-5, 3), 15.0 / (15.0 + 30.0), 1e-9);
    EXPECT_EQ(SizeTable::read(table.between(1e-5, 3e-5).text()).text(), table.between(1e-5, 3e-5).text());
    double u = 0.37;
    EXPECT_NEAR(table.share_below(table.diameter(u), 0), u, 1e-9);
}

TEST(PowderFiles, TakePercentilesAndCuts) {
    const Folder folder;
    const auto whole = read_sizes(folder, R"({"d10": "20 um", "d50": "34 um", "d90": "52 um"})");
    ASSERT_TRUE(whole.sizes);
    EXPECT_NEAR(whole.sizes->d10, 20e-6, 1e-11);
    EXPECT_NEAR(whole.sizes->d50, 34e-6, 1e-11);
    EXPECT_NEAR(whole.sizes->d90, 52e-6, 1e-11);
    EXPECT_EQ(whole.unit(), 34e-6);
    EXPECT_TRUE(whole.sizes->file.empty());
    const auto cut = campaign::read_powder(folder.write(
        "cut.json",
        R"({"powder": "p", "sizes": {"d10": "20 um", "d50": "34 um", "d90": "52 um"}, "cut": {"below": "20 um", "above": 52e-6}})"));
    EXPECT_NEAR(cut.sizes->cut_below, 0.1, 1e-6);
    EXPECT_NEAR(cut.sizes->cut_above, 0.1, 1e-6);
    EXPECT_NEAR(cut.sizes->smallest, 20e-6, 1e-13);
    EXPECT_NEAR(cut.sizes->largest, 52e-6, 1e-13);
    double volume = 0, number = 0;
    for (const auto& one : campaign::size_classes(*cut.sizes, 12)) volume += one.volume, number += one.number;
    EXPECT_NEAR(volume, 1, 1e-9);
    EXPECT_NEAR(number, 1, 1e-9);
}

TEST(PowderFiles, KeepTheBytesOfASizeFile) {
    const Folder folder;
    const std::string csv = "diameter,volume_below\n1.50e-5,0\n3e-5,1\n";
    const auto path = folder.write("s.csv", csv);
    const auto powder = read_sizes(folder, R"({"file": "s.csv"})");
    EXPECT_EQ(powder.sizes->csv, csv);
    EXPECT_EQ(powder.sizes->file, path);
}

TEST(PowderFiles, RefuseWrongSizes) {
    const Folder folder;
    const auto refusal = [&](const std::string& sizes) -> std::string {
        try {
            (void)read_sizes(folder, sizes);
        } catch (const campaign::InputError& wrong) {
            return wrong.what();
        }
        return "accepted";
    };
    EXPECT_THAT(refusal("{}"), HasSubstr("sizes are given by one of"));
    EXPECT_THAT(refusal(R"({"d10": "20 um", "d50": "34 um"})"), HasSubstr("key 'd90' is missing"));
    EXPECT_THAT(refusal(R"({"d10": "40 um", "d50": "34 um", "d90": "52 um"})"), HasSubstr("must rise"));
    EXPECT_THAT(refusal(R"({"lognormal": {"median": "34 um"}})"), HasSubstr("either \"sigma\" or \"ratio\""));
    EXPECT_THAT(refusal(R"({"lognormal": {"median": "34 um", "ratio": 1}})"), HasSubstr("must be above 0"));
    EXPECT_THAT(refusal(R"({"lognormal": {"median": "34 s", "sigma": 0.3}})"), HasSubstr("'s' does not fit 'm'"));
    EXPECT_THAT(refusal(R"({"rosin_rammler": {"d63": "34 um", "n": 0.1}})"), HasSubstr("from 0.5 to 50"));
    EXPECT_THAT(refusal(R"({"file": "none.csv"})"), HasSubstr("cannot be read"));
    EXPECT_THAT(refusal(R"({"diameter": "3 mm"}, "cut": {"below": "1 mm"})"), HasSubstr("nothing to cut"));
}

TEST(PowderFiles, GiveBondNumberAndTime) {
    const Folder folder;
    const auto powder = campaign::read_powder(folder.write("p.json", R"({"powder": "p",
        "material": {"density": 4430, "youngs_modulus": 1e7, "poisson_ratio": 0.3}, "sizes": {"diameter": "40 um"},
        "contacts": {"cohesion_law": "jkr", "surface_energy": 1e-4}})"));
    const auto numbers = campaign::numbers_of(powder);
    const double pi = std::acos(-1.0), radius = 20e-6, mass = 4430 * 4.0 / 3 * pi * radius * radius * radius;
    EXPECT_NEAR(numbers.bond_number, 0.75 * pi * 1e-4 * radius / (mass * 9.81), 1e-9 * numbers.bond_number);
    const double shear = 1e7 / 2.6;
    EXPECT_NEAR(numbers.rayleigh_time, pi * radius * std::sqrt(4430 / shear) / (0.1631 * 0.3 + 0.8766), 1e-15);
    EXPECT_GT(numbers.seconds, 0);
}

TEST(FileContents, StandBeforeTheFileAtTheirPath) {
    const std::string word = campaign::made_file_word("p.json sizes", "made by the program");
    const auto file = file_word(word);
    ASSERT_TRUE(file);
    EXPECT_TRUE(campaign::is_made(*file));
    const auto files = campaign::files_named({{"size_file", word}, {"gap", 0.1}});
    EXPECT_EQ(std::get<Files>(files).at("size_file"), "made by the program");
    const auto none = campaign::files_named({{"tool", std::string("file:0123456789abcdef0123456789abcdef:/nowhere")}});
    EXPECT_EQ(std::get<std::string>(none), "tool: cannot read /nowhere");
}

// The file of a calibration is the powder with which it ran, what the campaign fixes, and the result over both.
TEST(PowderResults, AreWholePowders) {
    const Folder folder;
    folder.write("sizes.csv", "diameter,volume_below\n1e-3,0\n2e-3,1\n");
    folder.write("sand.json", R"({"powder": "sand", "notes": "lot 12", "material": {"density": "2650 kg/m3"},
        "sizes": {"file": "sizes.csv"}, "contacts": {"restitution": 0.5, "friction": 0.3},
        "measured": [{"what": "bulk density", "value": "1500 kg/m3"}]})");
    folder.write("p.csv", "friction\n0.4\n");
    const campaign::PowderResult result{{{"friction", 0.4}}, {{"angle", "deg", 33, 1}}, "p.csv"};
    const auto written = [&](const char* campaign_text, const std::filesystem::path& into) {
        const auto config = folder.write("c.json", campaign_text);
        const auto text = campaign::powder_with(config, "fit", result, into);
        folder.write("fit_powder.json", text.json);
        return text;
    };
    const auto beside =
        written(R"({"campaign": "c", "powder": "sand.json", "fixed": {"wall_friction": "20 %"}})", folder.path());
    EXPECT_FALSE(beside.sizes);
    const auto powder = campaign::read_powder(folder.path() / "fit_powder.json");
    ASSERT_TRUE(powder.sizes);
    EXPECT_EQ(campaign::lacks_of(powder), "");
    const auto& document = *powder.document;
    EXPECT_EQ(document["material"]["density"], "2650 kg/m3");
    EXPECT_EQ(document["contacts"]["friction"], 0.4);
    EXPECT_EQ(document["contacts"]["restitution"], 0.5);
    EXPECT_EQ(document["contacts"]["wall_friction"], "20 %");
    EXPECT_EQ(document["measured"].size(), 2U);
    EXPECT_THAT(document["notes"].get<std::string>(),
                testing::AllOf(HasSubstr("sand.json (lot 12)"), HasSubstr("friction at the setting of highest density"),
                               HasSubstr("wall_friction from the campaign c.json")));
    const auto apart = written(R"({"campaign": "c", "powder": "sand.json"})", folder.path() / "elsewhere");
    ASSERT_TRUE(apart.sizes);
    EXPECT_EQ(apart.sizes->first, "fit_sizes.csv");
    EXPECT_THAT(apart.json, HasSubstr("\"file\": \"fit_sizes.csv\""));
    // Without a powder file: the campaign's own numbers; what is missing stays missing.
    (void)written(R"({"campaign": "c", "fixed": {"diameter": "3 mm", "friction": "2*x"}})", folder.path());
    const auto bare = campaign::read_powder(folder.path() / "fit_powder.json");
    EXPECT_EQ(bare.diameter, 0.003);
    EXPECT_EQ(campaign::lacks_of(bare), "density");
    EXPECT_EQ((*bare.document)["contacts"]["friction"], 0.4);
    // The powder of a species.
    (void)written(R"({"campaign": "c", "machine": {"species": {"a": {"powder": "sand.json"}}}})", folder.path());
    EXPECT_TRUE(campaign::read_powder(folder.path() / "fit_powder.json").sizes);
}

}  // namespace grainsweep::tests::campaign_powder_test
