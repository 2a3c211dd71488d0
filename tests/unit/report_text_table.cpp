// Text fits a width: what is wrapped, what is told below the table, what is left out and named.
#include "sweep/report/file_size.hpp"
#include "sweep/report/text_layout.hpp"
#include "sweep/report/text_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace grainsweep::tests::report_text_table_test {

using namespace report;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using Cell = store::Table::Cell;

std::string written(const store::Table& table, std::size_t width) {
    std::ostringstream out;
    write_text(out, table, width);
    return out.str();
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// As the view of a campaign: `rows` rows, eight columns of the archive, `factors` factors (Afactor, Bfactor, ...) and
/// a response.
store::Table campaign_view(std::int64_t rows, int factors) {
    store::Table table{{"point", "sequence", "replicate", "case_id", "seed", "outcome", "attempts", "wall_seconds"},
                       {}};
    for (int j = 0; j < factors; ++j) table.columns.push_back(std::string(1, static_cast<char>('A' + j)) + "factor");
    table.columns.emplace_back("mfr");
    for (std::int64_t row = 0; row < rows; ++row) {
        std::string id = "8cb4b0c72635602c648c8cc27870" + std::to_string(1000 + row);
        std::vector<Cell> cells = {row,
                                   row % 4,
                                   std::int64_t{0},
                                   id,
                                   std::int64_t{5577006791947779410} + row,
                                   std::string("completed"),
                                   std::int64_t{1},
                                   0.25 + static_cast<double>(row)};
        for (int j = 0; j < factors; ++j) cells.emplace_back(0.123456 + j + static_cast<double>(row));
        cells.emplace_back(0.5 + static_cast<double>(row));
        table.rows.push_back(std::move(cells));
    }
    return table;
}

TEST(TextTable, NoLineIsWiderThanTheTerminal) {
    for (const std::int64_t rows : {0, 1, 2, 3, 4, 40})
        for (const int factors : {1, 3, 8, 30})
            for (const std::size_t width : {20U, 40U, 80U, 100U, 132U})
                for (const auto& line : lines_of(written(campaign_view(rows, factors), width)))
                    EXPECT_LE(columns_of(line), width) << rows << " rows, " << factors << " factors: " << line;
}

TEST(TextTable, ALongCellIsWrappedAndNumbersStayAligned) {
    const store::Table table{{"name", "value", "meaning"},
                             {{std::string("friction"), 0.2, std::string("Coulomb friction of particles and base")},
                              {std::string("gap"), 12.5, std::string("height")}}};
    EXPECT_EQ(written(table, 34),
              "name      value  meaning\n"
              "friction    0.2  Coulomb friction\n"
              "                 of particles and\n"
              "                 base\n"
              "gap        12.5  height\n");
}

TEST(TextTable, NeighboursOfAColumnDoNotLookAlike) {
    store::Table table{{"near", "far", "rounded"}, {}};
    for (int k = 0; k < 4; ++k) table.rows.push_back({1e9 + 0.25 * k, 1e9 / (k + 3), 0.1 * (1 + k * 1e-15)});
    const auto lines = lines_of(written(table, 80));
    EXPECT_THAT(lines[1], StartsWith("  1000000000  3.33333e+08      0.1"));
    EXPECT_THAT(lines[2], StartsWith("1000000000.2      2.5e+08      0.1"));
    EXPECT_THAT(lines[4], StartsWith("1000000000.8  1.66667e+08      0.1"));
    // Twelve digits are the most.
    table = {{"y"}, {{1e13}, {1e13 + 1e3}, {1e13 + 1.001e3}}};
    EXPECT_EQ(written(table, 80), "               y\n           1e+13\n1.0000000001e+13\n1.0000000001e+13\n");
}

TEST(TextTable, AHeadingIsWrappedAtItsUnderscores) {
    const store::Table table{{"relative_difference", "text"}, {{1.5, std::string("some words")}}};
    EXPECT_EQ(written(table, 24),
              "   relative_\n"
              "  difference  text\n"
              "         1.5  some words\n");
}

TEST(TextTable, WhatIsTheSameInEveryRowIsSaidOnce) {
    const auto text = written(campaign_view(10, 3), 66);
    EXPECT_THAT(text, HasSubstr("the same in every row: replicate 0, outcome completed, attempts 1\n"));
    EXPECT_THAT(text, HasSubstr("case_id: the first 12 of 32 digits"));
    EXPECT_THAT(text, Not(HasSubstr("8cb4b0c72635602c")));
    EXPECT_THAT(text, HasSubstr("left out: seed, wall_seconds"));
    EXPECT_THAT(text, HasSubstr("--wide"));
    EXPECT_THAT(text, HasSubstr("mfr\n")) << "the answer is not what is left out";
}

TEST(TextTable, EveryColumnIsShownOrNamed) {
    const auto table = campaign_view(10, 30);
    const auto text = written(table, 80);
    for (const auto& column : table.columns) EXPECT_THAT(text, HasSubstr(column));
    EXPECT_THAT(text, HasSubstr("left out: seed, wall_seconds, sequence, case_id, "));
    EXPECT_THAT(text, Not(HasSubstr("32 digits"))) << "of a column that is left out nothing is said";
}

TEST(TextTable, AValueAndItsErrorStandBelowEachOtherRatherThanGoMissing) {
    store::Table table{{"points", "mean", "sd", "kurtosis"}, {}};
    for (std::int64_t row = 0; row < 5; ++row)
        table.rows.push_back({row, std::string("3.498 ± 0.053"), std::string("3.81 ± 0.14"),
                              std::string("3.40 ± 0.2") + std::to_string(row)});
    const auto lines = lines_of(written(table, 36));
    EXPECT_THAT(lines, testing::Contains(HasSubstr("3.40")));
    for (const auto& line : lines) {
        EXPECT_LE(columns_of(line), 36U) << line;
        EXPECT_THAT(line, Not(testing::EndsWith("±")));
        EXPECT_THAT(line, Not(HasSubstr("left out")));
    }
}

TEST(TextTable, WidthsAreThoseOfCharacters) {
    EXPECT_EQ(columns_of("0.27 ± 0.01"), 11U);
    EXPECT_EQ(columns_of("\xFF\xFE"), 2U) << "bytes that are no UTF-8";
    const store::Table table{{"a", "b"}, {{std::string("µ"), 1.0}, {std::string("ab"), 2.0}}};
    EXPECT_EQ(written(table, 80), "a   b\nµ   1\nab  2\n");
}

TEST(TextLayout, WordsStayWholeWhereTheyCan) {
    EXPECT_THAT(wrapped("one two three", 7), ElementsAre("one two", "three"));
    EXPECT_THAT(wrapped("vibration_frequency", 12), ElementsAre("vibration_", "frequency"));
    EXPECT_THAT(wrapped("abcdefghij", 4), ElementsAre("abcd", "efgh", "ij"));
    EXPECT_THAT(wrapped("0.27 ± 0.01", 8), ElementsAre("0.27", "± 0.01"));
    EXPECT_THAT(wrapped("", 8), ElementsAre(""));
    EXPECT_THAT(wrapped("to /a/long/path", 4, false), ElementsAre("to", "/a/long/path"));
}

TEST(TextLayout, ProseIsBrokenUnderWhereItBegan) {
    std::ostringstream out;
    {
        const WrappedOutput wrapping(out, 20);
        out << "design   halton with eight sequences\n  indented text that goes "
               "on\nshort\n/a/path/longer/than/the/width\nopen";
    }
    out << " end\n";
    EXPECT_EQ(out.str(),
              "design   halton with\n         eight\n         sequences\n  indented text that\n  goes on\nshort\n"
              "/a/path/longer/than/the/width\nopen end\n");
}

TEST(TextLayout, AnOutputThatTakesNothingStaysAnError) {
    std::ostringstream out;
    {
        const WrappedOutput wrapping(out, 20);
        out.setstate(std::ios::badbit);
    }
    EXPECT_TRUE(out.bad());
}

TEST(TextLayout, TheWidthIsThatOfTheEnvironmentWhereThereIsNoTerminal) {
    ::setenv("COLUMNS", "77", 1);
    set_text_width(50);
    EXPECT_EQ(text_width(), 50U);
    set_text_width(0);
    if (::isatty(STDOUT_FILENO) == 0) {
        EXPECT_EQ(text_width(), 77U);
        for (const char* nonsense : {"", "wide", "-5", "80x24"}) {
            ::setenv("COLUMNS", nonsense, 1);
            EXPECT_EQ(text_width(), 100U) << nonsense;
        }
    }
    ::unsetenv("COLUMNS");
}

TEST(FileSize, IsSaidInDecimalUnits) {
    EXPECT_EQ(size_text(0), "0 B");
    EXPECT_EQ(size_text(999), "999 B");
    EXPECT_EQ(size_text(1000), "1.0 kB");
    EXPECT_EQ(size_text(851968), "852 kB");
    EXPECT_EQ(size_text(999'600), "1.0 MB");
    EXPECT_EQ(size_text(12'345'678'901), "12 GB");
}

}  // namespace grainsweep::tests::report_text_table_test
