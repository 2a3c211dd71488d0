// Exports of instruments and sieve sheets, as they come, and the questions they leave open.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/powder_export.hpp"

#include "solver/particles/size_table.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "tests/support/powder_exports.hpp"

#include <cmath>
#include <map>
#include <ostream>
#include <sstream>
#include <string>

namespace grainsweep::tests::campaign_powder_export_test {

using campaign::ExportChoices;
using testing::HasSubstr;

/// One of the exports, and the table that must come of it.
struct Export {
    std::string name, bytes;
    ExportChoices choices;
    std::string header;
    std::map<double, double> below;  ///< some of its lines: um -> share
    std::size_t lines = 0;
    std::string note = {};
};

void PrintTo(const Export& given, std::ostream* out) {
    *out << given.name;
}

std::string utf16(const std::string& text) {
    std::string bytes = "\xFF\xFE";
    for (const char c : text) bytes += c, bytes += '\0';
    return bytes;
}

const std::vector<Export>& exports() {
    static const std::vector<Export> all = {
        {"LaserSemicolonsAndDecimalCommas",
         "Probe;Ti64 Charge 7\nMessung;12.03.2026 10:12:44\nVerteilungsart;Volumen\n\nx [\xC2\xB5m];Q3 [%]\n"
         "15,0;0,0\n20,0;10,0\n34,0;50,0\n52,0;90,0\n63,0;99,8\n\nEnde;1\n",
         {},
         "diameter,volume_below",
         {{15, 0}, {20, 0.1 / 0.998}, {34, 0.5 / 0.998}, {63, 1}},
         5,
         "end at 99.8 %"},
        {"SampleByItsWholeName",
         "Volume\n,A,,B,\nSize [um],Cumulative undersize [%],Freq [%],Cumulative undersize [%],Freq [%]\n"
         "10,0,0,0,0\n20,30,30,60,60\n40,100,70,100,40\n",
         {.sample = "A"},
         "diameter,volume_below",
         {{20, 0.3}},
         3},
        {"LaserInLatin1",
         "Gr\xF6\xDF"
         "e (\xB5m);Volumen kumulativ (%)\r\n10;0\r\n20;30\r\n40;100\r\n",
         {},
         "diameter,volume_below",
         {{20, 0.3}},
         3},
        {"LaserWithByteOrderMark",
         "\xEF\xBB\xBF"
         "Size (\xCE\xBCm),Volume Under (%)\n5,0\n10,42.5\n20,100\n",
         {},
         "diameter,volume_below",
         {{10, 0.425}},
         3},
        {"LaserAsUtf16",
         utf16("Size (um)\tVolume Undersize %\r\n1\t0\r\n10\t20\r\n100\t100\r\n"),
         {},
         "diameter,volume_below",
         {{10, 0.2}},
         3},
        {"LaserClassesByLowerEdge",
         "Sample: A12\nResult units: Volume\nSize (um),Volume In %\n10,20\n20,50\n40,30\n80,0\n",
         {},
         "diameter,volume_below",
         {{10, 0}, {20, 0.2}, {40, 0.7}, {80, 1}},
         4},
        {"LaserClassesByUpperEdge",
         "by volume\nDiameter (um)\tChan %\n0.5\t0\n1\t40\n2\t60\n",
         {},
         "diameter,volume_below",
         {{0.5, 0}, {1, 0.4}, {2, 1}},
         3},
        {"ChannelsAndPassingTakesPassing",
         "Volume distribution\nSize(um),%Chan,%Pass\n88,5,100\n62.2,25,95\n44,50,70\n31.1,20,20\n22,0,0\n",
         {},
         "diameter,volume_below",
         {{22, 0}, {44, 0.7}, {88, 1}},
         5},
        {"FrequencyAndUndersize",
         "Distribution base;Volume\nDiameter (um);q (%);Undersize "
         "(%)\n10,5;0,00;0,00\n12,0;33,30;33,30\n13,5;66,70;100,00\n",
         {},
         "diameter,volume_below",
         {{12, 0.333}},
         3},
        {"SieveRetainedGrams",
         "Sieve analysis ISO 3310\nSample;sand 3\nAperture (mm);Retained (g)\n2;0\n1;12,5\n0,5;25\n0,25;12,5\nPan;0\n",
         {},
         "diameter,volume_below",
         {{250, 0}, {500, 0.25}, {1000, 0.75}, {2000, 1}},
         4,
         "add up to 50"},
        {"SieveWithAFullPan",
         "Sieve (um),Mass retained (g)\n125,0\n90,20\n63,60\npan,20\n",
         {.smallest = "20 um"},
         "diameter,volume_below",
         {{20, 0}, {63, 0.2}, {90, 0.8}, {125, 1}},
         4},
        {"SieveCumulativePassing",
         "Siebanalyse\nMaschenweite mm;Durchgang %\n4;100\n2;85\n1;40\n0,5;0\n",
         {},
         "diameter,volume_below",
         {{500, 0}, {1000, 0.4}, {2000, 0.85}, {4000, 1}},
         4},
        {"SieveCumulativeRetained",
         "Sieve mm\tCumulative retained %\n0.5\t100\n1\t60\n2\t15\n4\t0\n",
         {},
         "diameter,volume_below",
         {{500, 0}, {1000, 0.4}, {2000, 0.85}},
         4},
        {"SieveClasses",
         "Siebklasse (um);Masse-Anteil (%)\n<45;0,5\n45-63;39,5\n63-90;50\n90-125;10\n",
         {},
         "diameter,volume_below",
         {{45, 0}, {63, 0.395 / 0.995}, {125, 1}},
         4,
         "0.5 % below the first size"},
        {"LowerAndUpperColumns",
         "Lower (um),Upper (um),Number (%)\n10,20,25\n20,30,50\n30,40,25\n",
         {},
         "diameter,number_below",
         {{10, 0}, {20, 0.25}, {30, 0.75}, {40, 1}},
         4},
        {"ImageAnalysisByNumber",
         "x [\xC2\xB5m]\tQ0 [-]\n10\t0\n15\t0.61\n30\t1\n",
         {},
         "diameter,number_below",
         {{15, 0.61}},
         3},
        {"FractionsWithoutPercent",
         "Particle size (um);Cumulative volume\n10;0\n20;0,31\n40;0,999\n",
         {},
         "diameter,volume_below",
         {{20, 0.31 / 0.999}},
         3,
         "99.9 %"},
        {"BlanksBetweenColumns",
         "# by volume, sizes in um\n#  size     below\n  10.0      0.0\n  20.0     55.5\n  30.0    100.0\n",
         {},
         "diameter,volume_below",
         {{20, 0.555}},
         3},
        {"QuotedDecimalCommas",
         "\"Size (mm)\",\"Volume Under %\"\n\"0,010\",\"0,0\"\n\"0,020\",\"12,5\"\n\"0,050\",\"100,0\"\n",
         {},
         "diameter,volume_below",
         {{10, 0}, {20, 0.125}, {50, 1}},
         3},
        {"UnitsInTheCells",
         "Korngroesse;Durchgang (Vol.-%)\n20 um;0,0 %\n40 um;50,0 %\n60 um;100,0 %\n",
         {},
         "diameter,volume_below",
         {{40, 0.5}},
         3},
        {"UnitLineBelowTheNames",
         "Size;Volume Below;Volume Density\num;%;%/um\n5;0;0\n10;80;16\n20;100;2\n",
         {},
         "diameter,volume_below",
         {{10, 0.8}},
         3},
        {"RepeatedGroupsOfColumns",
         "Size (um),Vol Under %,Size (um),Vol Under %\n1,0,8,70\n2,10,16,90\n4,40,32,100\n",
         {},
         "diameter,volume_below",
         {{1, 0}, {4, 0.4}, {8, 0.7}, {32, 1}},
         6},
        {"SeveralSamplesNeedAChoice",
         "Size (um),Sample A Vol Under %,Sample B Vol Under %\n1,0,0\n2,50,40\n4,100,100\n",
         {.shares = "Sample B Vol Under %"},
         "diameter,volume_below",
         {{2, 0.4}},
         3},
        {"ClassesByTheirMiddle",
         "d_mean (um);Volume (%)\n10;25\n20;50\n40;25\n",
         {.edge = "middle"},
         "diameter,volume_below",
         {},
         4},
        {"EmptyEndsAreTrimmed",
         "Size (nm),Volume Under %\n10,0\n20,0\n5000,0\n10000,60\n20000,100\n40000,100\n",
         {},
         "diameter,volume_below",
         {{5, 0}, {10, 0.6}, {20, 1}},
         3},
        {"PercentilesAroundTheTable",
         "D10;20,1\nD50;33,8\nD90;51,9\nSpan;0,94\nDichte;4,43\n\nx/um;Q3/%\n15;0\n30;40\n60;100\n",
         {},
         "diameter,volume_below",
         {{30, 0.4}},
         3},
    };
    return all;
}

struct Exports : testing::TestWithParam<Export> {};

TEST_P(Exports, AreRecognised) {
    const Export& given = GetParam();
    const auto imported = campaign::import_sizes(given.bytes, given.choices);
    std::istringstream lines(imported.csv);
    std::string header;
    std::getline(lines, header);
    EXPECT_EQ(header, given.header) << imported.sentence;
    std::map<double, double> table;
    double size = 0, share = 0;
    for (char comma = 0; lines >> size >> comma >> share;) table[size] = share;
    EXPECT_EQ(table.size(), given.lines) << imported.csv;
    for (const auto& [um, below] : given.below) {
        const auto line = table.lower_bound(um * 1e-6 * (1 - 1e-12));
        ASSERT_NE(line, table.end()) << um << "\n" << imported.csv;
        EXPECT_NEAR(line->first, um * 1e-6, 1e-18) << imported.csv;
        EXPECT_NEAR(line->second, below, 1e-12) << um << "\n" << imported.csv;
    }
    EXPECT_EQ(table.begin()->second, 0);
    EXPECT_EQ(table.rbegin()->second, 1);
    EXPECT_EQ(imported.notes.empty(), given.note.empty());
    if (!given.note.empty()) {
        EXPECT_THAT(imported.notes.front(), HasSubstr(given.note));
    }
    EXPECT_NO_THROW((void)particles::SizeTable::read(imported.csv));
}
INSTANTIATE_TEST_SUITE_P(PowderExport, Exports, testing::ValuesIn(exports()),
                         [](const auto& given) { return given.param.name; });

TEST(PowderExport, AsksForWhatItCannotKnow) {
    EXPECT_THAT(refusal("Size,Volume Under %\n1,0\n2,100\n4,100\n"), HasSubstr("by --unit"));
    EXPECT_THAT(refusal("Size (um),Undersize %\n1,0\n2,50\n4,100\n"), HasSubstr("by --by"));
    EXPECT_THAT(refusal("Size (um),Volume %\n1,0\n2,100\n"), HasSubstr("state by --as"));
    EXPECT_THAT(refusal("Size (um),Volume In %\n1,0\n2,100\n4,0\n"), HasSubstr("by --edge"));
    EXPECT_THAT(refusal("Sieve (um),Retained (g)\n125,0\n90,20\n63,60\npan,20\n"),
                HasSubstr("20 % lie below the first size, 63 um, without a lower end: give one by --smallest"));
    EXPECT_THAT(refusal("Sieve (um),Passing %\n63,0\n90,50\n125,93\n"), HasSubstr("--largest"));
    EXPECT_THAT(refusal("Size (um),Sample A Vol Under %,Sample B Vol Under %\n1,0,0\n2,50,40\n4,100,100\n"),
                HasSubstr("state it by --shares, of 2 'Sample A Vol Under %', 3 'Sample B Vol Under %'"));
    EXPECT_THAT(refusal("1,2,3\n2,3,4\n4,5,6\n"), HasSubstr("state it by --sizes"));
}

// Middles of classes whose counts fade to 0 were taken for lower edges, half a class too coarse, and no line doubted
// it.
TEST(PowderExport, DoubtsAnEdgeThatAFadingTailSuggests) {
    const auto fading = campaign::import_sizes("CE diameter (um),Count\n10,3\n20,997\n40,998\n80,2\n160,0\n", {}).notes;
    ASSERT_FALSE(fading.empty());
    EXPECT_THAT(fading.back(), HasSubstr("the edge is a guess from shares that fade to 0; with --edge "));
    EXPECT_THAT(fading.back(), HasSubstr("with --edge middle d50 is 28.28 um"));
    const std::string classes = "Size (um),Volume In %\n10,0.5\n20,49.5\n40,49.5\n80,0.5\n160,";
    for (const char* bare : {"\n", "0\n"}) {
        const auto imported = campaign::import_sizes(classes + bare, {});
        EXPECT_EQ(imported.csv, campaign::import_sizes(classes + "\n", {.edge = "lower"}).csv);
        EXPECT_EQ(imported.notes.empty(), std::string(bare) == "\n");
    }
}

// Two samples of 25 sizes were within a hundredth of the sum of their sums, and the last one was taken without a word.
TEST(PowderExport, TakesNoSampleForAnother) {
    std::string sums = "Size (um),Lot A volume under %,Lot B volume under %\n",
                classes = "Size (um),Lot A volume in %,";
    classes += "Lot B volume in %\n";
    for (int k = 0; k < 25; ++k) {
        const auto below = [](double x) { return 100 / (1 + std::pow(x, -4)); };
        const double size = 10 * std::pow(1.12, k), next = 1.12 * size;
        sums +=
            fmt::format("{},{:.2f},{:.2f}\n", size, k == 24 ? 100 : below(size / 34), k == 24 ? 100 : below(size / 30));
        const double shift = k % 2 == 0 ? 0.3 : -0.3;
        const double share = k == 24 ? 0 : below(next / 34) - below(size / 34);
        classes += fmt::format("{},{:.3f},{:.3f}\n", size, share, share > 1 ? share + shift : share);
    }
    EXPECT_THAT(refusal(sums), HasSubstr("state it by --shares"));
    EXPECT_THAT(refusal(classes), HasSubstr("state it by --shares"));
}

TEST(PowderExport, TakesSizesForWhatTheirHeaderSays) {
    EXPECT_THAT(refusal("log10 d (um),Q3 (%)\n1,0\n1.5,50\n2,100\n", {.sizes = "1"}), HasSubstr("holds logarithms"));
    const std::string between = "Passing (um),Retained on (um),Mass (g)\n";
    const auto both = campaign::import_sizes(between + "20,10,25\n40,20,50\n80,40,25\n", {}).csv;
    EXPECT_EQ(campaign::import_sizes("Size (um),Volume under %\n10,0\n20,25\n40,75\n80,100\n", {}).csv, both);
}

TEST(PowderExport, RefusesWeightsWithTheirSieve) {
    const std::string weighed = "Maschenweite [mm];Leergewicht [g];Bruttogewicht [g]\n0,5;400;410\n0,25;390;420\n";
    const auto rule = HasSubstr("weighs the sieve too: add a column of what each sieve retained");
    EXPECT_THAT(refusal(weighed), rule);
    EXPECT_THAT(refusal(weighed, {.shares = "Bruttogewicht"}), rule);
}

TEST(PowderExport, RefusesWhatIsNoDistribution) {
    EXPECT_THAT(refusal(""), HasSubstr("no table of sizes and shares is in it"));
    EXPECT_THAT(refusal("D10;20\n"), HasSubstr("no table"));
    EXPECT_THAT(refusal("Size (um),Volume Under %\n1,0\n2,80\n4,70\n8,100\n"), HasSubstr("its numbers are not"));
    EXPECT_THAT(refusal("Size (um),Volume In %\n1,0\n2,30\n4,30\n"), HasSubstr("its numbers are not"));
    EXPECT_THAT(refusal("Size (um),q3 [1/um]\n1,0\n2,0.5\n4,0.25\n"), HasSubstr("is a density"));
    EXPECT_THAT(refusal("Size (um),Volume Under %\n1,0\n2,50\n2,60\n4,100\n"),
                HasSubstr("line 4: the size 2 is there twice"));
    EXPECT_THAT(refusal("Size (um),Volume Under %\n1,0\n2,100\n", {.as = "pasing"}),
                HasSubstr("Did you mean 'passing'?"));
    EXPECT_THAT(refusal("Size (um),Volume Under %\n1,0\n2,100\n", {.unit = "s"}), HasSubstr("'s' does not fit 'm'"));
    EXPECT_THAT(refusal("Size (um),Volume Under %\n1,0\n2,100\n", {.shares = "7"}), HasSubstr("must be a column"));
}

// A row that is left out would end the table early, and what is missing then looks like a coarse tail.
TEST(PowderExport, RefusesARowThatIsNoNumber) {
    const std::string head = "Size (um),Volume passing (%)\n10,0\n";
    EXPECT_THAT(refusal(head + "20,50\n25*,60\n30,90\n40,100\n"), HasSubstr("line 4: '25*' is no number"));
    EXPECT_THAT(refusal(head + "20,50\nnan,60\n30,90\n40,100\n"), HasSubstr("line 4: 'nan' is no number"));
    EXPECT_THAT(refusal(head + "4D1,60\n45,90\n50,100\n"), HasSubstr("line 3: '4D1' is no number"));
    EXPECT_THAT(refusal(head + "20,50\n40*,100\n"), HasSubstr("line 4: '40*' is no number"));
    // words end a table
    EXPECT_THAT(refusal(head + "20,50\n30,80\nTotal,100\n"), HasSubstr("--largest"));
}

TEST(PowderExport, TakesRadiiAsHalfDiameters) {
    const auto sizes = campaign::import_sizes("Radius (um),Q3 (%)\n10,0\n20,50\n40,100\n", {});
    EXPECT_THAT(sizes.sentence, HasSubstr("from 20 um to 80 um"));
    EXPECT_THAT(sizes.sentence, HasSubstr("d50 40 um"));
    EXPECT_THAT(sizes.notes, testing::ElementsAre(HasSubstr("column 1 holds radii")));
}

TEST(PowderExport, RefusesSizesOfNoPowder) {
    for (const auto* sizes : {"1e302,0\n2e302,50\n4e302,100\n", "1,0\n2,50\n1e9,100\n", "1e-9,0\n2,50\n4,100\n"})
        EXPECT_THAT(refusal("Size (um),Volume Under %\n" + std::string(sizes)), HasSubstr("from 10 nm to 100 mm"));
}

// No export has lines of a hundred thousand numbers, and reading them as all that they might be would take minutes.
TEST(PowderExport, LooksAtNoLineThatIsTooLong) {
    std::string line;
    while (line.size() < 1U << 20U) line += "1,2;3 4\t";
    EXPECT_THAT(refusal(line + "\n" + line + "\n"), HasSubstr("no table"));
}

}  // namespace grainsweep::tests::campaign_powder_export_test
