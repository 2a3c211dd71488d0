// Exports of instruments and sieve sheets, as they come, and the questions they leave open.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/powder_export.hpp"

#include "solver/particles/size_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "tests/support/powder_exports.hpp"

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
