// CSV under a header: what is read, and what is refused before a number is taken for a name.
#include "sweep/campaign/csv_table.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace grainsweep::tests::campaign_csv_test {

using namespace campaign;

void throw_rule(const std::string& rule) {
    throw std::invalid_argument(rule);
}

std::string refusal(const std::string& text) {
    try {
        CsvTable table(text, throw_rule);
        while (table.next()) {
        }
    } catch (const std::invalid_argument& why) {
        return why.what();
    }
    return "no refusal";
}

TEST(CsvTable, PassesOverEmptyLinesAndCountsRecords) {
    const std::string text = "\xEF\xBB\xBF\r\n\"x, m\",y\r\n\r\n1,2\r\n\n3,4";
    CsvTable table(text, throw_rule);
    EXPECT_EQ(table.header(), (CsvRecord{"x, m", "y"}));
    EXPECT_EQ(table.next(), (CsvRecord{"1", "2"}));
    EXPECT_EQ(table.number(), 4U);
    EXPECT_EQ(table.next(), (CsvRecord{"3", "4"}));
    EXPECT_FALSE(table.next());
}

TEST(CsvTable, RefusesWhatIsNoHeader) {
    for (const std::string number : {"0", "-1.5", "+2", "1e-3", "1.0D+03", "nan", "inf", ".5"})
        EXPECT_EQ(refusal("x," + number + "\n1,2\n"),
                  "its first line has the number \"" + number + "\"; a header that names the columns is expected");
    EXPECT_EQ(refusal("d50,D10\n1,2\n"), "no refusal") << "names";
    EXPECT_EQ(refusal("\"\",x\n1,2\n"), "column 1 of its header has no name; leave out row names and empty columns");
    EXPECT_EQ(refusal("x,x\n1,2\n"), "its header names 'x' twice");
    EXPECT_EQ(refusal("x;y\n0,5;2\n"),
              "its header has semicolons between the columns; commas are expected, and points in numbers");
    EXPECT_EQ(refusal("x\ty\n1\t2\n"),
              "its header has tabs between the columns; commas are expected, and points in numbers");
    EXPECT_EQ(refusal("x,y\nrow 1,1,2\n"), "record 2 has 3 cells and the header 2");
    EXPECT_EQ(refusal("\xFF\xFE"), "the file must be UTF-8 text, not UTF-16");
    EXPECT_EQ(refusal("\n\n"), "the file is empty; a header and records are expected");
}

TEST(CsvTable, ReadsWordsAsQueryWritesThem) {
    const std::string text = "word,x\n'-x,'+1\n'=a,'@b\n'a','\n";
    CsvTable table(text, throw_rule);
    EXPECT_EQ(table.next(), (CsvRecord{"-x", "+1"}));
    EXPECT_EQ(table.next(), (CsvRecord{"=a", "@b"}));
    EXPECT_EQ(table.next(), (CsvRecord{"'a'", "'"}));
}

}  // namespace grainsweep::tests::campaign_csv_test
