// Tables that programs leave: where the head stands, the four separators, rows from either end, and one sentence for
// what is not there.
#include "sweep/workers/program_tables.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace grainsweep::tests::tables_of_programs_test {

using workers::ProgramTable;

using Values = std::vector<double>;

std::string refusal(const ProgramTable& table, const std::string& column, std::int64_t row = 0) {
    try {
        (void)table.value(column, row);
    } catch (const std::invalid_argument& why) {
        return why.what();
    }
    return "no refusal";
}

TEST(ProgramTables, SeparatorsDivideCells) {
    EXPECT_EQ(ProgramTable("f", "t,\"rate, kg/s\"\n0,1.5\n1,2e-3\n", "comma").column("rate, kg/s"),
              (Values{1.5, 2e-3}));
    EXPECT_EQ(ProgramTable("f", "t;rate\n0; +1.5\n", "semicolon").column("rate"), Values{1.5});
    EXPECT_EQ(ProgramTable("f", "t\trate\r\n0\t1.5\r\n", "tab").column("rate"), Values{1.5});
    EXPECT_EQ(ProgramTable("f", "  t   rate\n  0 \t 1.5  \n\n", "blank").column("rate"), Values{1.5});
}

TEST(ProgramTables, RowsCountFromEitherEnd) {
    const ProgramTable table("f", "t,v\n0,5\n1,6\n2,7", "comma");
    EXPECT_EQ(table.value("v", 0), 5);
    EXPECT_EQ(table.value("v", -1), 7);
    EXPECT_EQ(table.value("v", -3), 5);
    EXPECT_EQ(refusal(table, "v", 3), "f has 3 rows, and row 3 is asked");
    EXPECT_EQ(refusal(table, "v", -4), "f has 3 rows, and row -4 is asked");
}

// LAMMPS and LIGGGHTS write two remarks, the second with the names.
TEST(ProgramTables, TheLastRemarkBeforeNumbersIsTheHead) {
    const ProgramTable table(
        "f", "# Time-averaged data for fix weigh\n# TimeStep v_t v_out\n200 0.01 0\n400 0.02 nan\n# end\n", "blank");
    EXPECT_EQ(table.column("v_t"), (Values{0.01, 0.02}));
    EXPECT_EQ(table.column("TimeStep"), (Values{200, 400}));
    EXPECT_EQ(refusal(table, "v_out", -1), "f: 'v_out' in row 1 is 'nan', which is no number");
    EXPECT_EQ(refusal(table, "data"), "f has no column 'data'; it has TimeStep, v_t, v_out");
    EXPECT_EQ(ProgramTable("f", "# t v\nnan 1\n", "blank").value("v", 0), 1);
}

TEST(ProgramTables, AHeadOfWordsNeedsNoRemark) {
    EXPECT_EQ(ProgramTable("f", "# made by x 2\n\n# on a day\nt,v\n0,5\n", "comma").column("v"), Values{5});
    EXPECT_EQ(ProgramTable("f", "\xEF\xBB\xBFt,v\n0,5\n", "comma").column("t"), Values{0});
    EXPECT_EQ(ProgramTable("f", "1,2\n3,4\n", "comma").column("2"), Values{4});
}

TEST(ProgramTables, NumbersOfFortranAreRead) {
    const ProgramTable table("f", "a,b,a b\n1.0D+03,-2.5d-3,1.5-103\n+1.E+2,1.0Q0,1e-400\n", "comma");
    EXPECT_EQ(table.column("a"), (Values{1000, 100}));
    EXPECT_EQ(table.column("b"), (Values{-2.5e-3, 1}));
    EXPECT_EQ(table.column("a b"), (Values{1.5e-103, 0}));
    for (const char* none : {"1.0D", "D+03", "1.0DD3", "1-2-3", "1-2", "3-005", "1.5-10", "1e400", "-1.0D+400", "0x10"})
        EXPECT_EQ(refusal(ProgramTable("f", std::string("v\n") + none + "\n", "comma"), "v"),
                  std::string("f: 'v' in row 0 is '") + none + "', which is no number");
}

TEST(ProgramTables, AColumnThatIsThereTwiceIsRefused) {
    EXPECT_EQ(refusal(ProgramTable("f", "t,v,v\n0,5,6\n", "comma"), "v"), "f has two columns 'v'");
    EXPECT_EQ(ProgramTable("f", "t,v,v\n0,5,6\n", "comma").value("t", 0), 0);
}

TEST(ProgramTables, ATableWithoutRowsHasItsNames) {
    EXPECT_TRUE(ProgramTable("f", "# t v\n", "blank").column("v").empty());
    EXPECT_TRUE(ProgramTable("f", "t v\n", "blank").column("v").empty());
    EXPECT_EQ(refusal(ProgramTable("f", "", "comma"), "v"), "f has no column 'v'; it has none");
    EXPECT_EQ(refusal(ProgramTable("f", "#\n", "comma"), "v"), "f has no column 'v'; it has none");
}

TEST(ProgramTables, ARowWithMoreCellsThanNamesIsRefused) {
    const ProgramTable commas("f", "t,y\n0,1,5\n", "comma"), ends("f", "t,y\n0,2.5,\n", "comma");
    EXPECT_THROW((void)commas.value("y", -1), std::invalid_argument) << "1,5 is one number with a decimal comma";
    EXPECT_EQ(ends.value("y", -1), 2.5) << "a comma behind each line";
}

// A program that is started again, or writes two tables, may append below other names.
TEST(ProgramTables, RowsBelowOtherNamesAreRefused) {
    const ProgramTable two("f", "t,y\n0,5\n1,6\nu,v\n7,8\n", "comma");
    EXPECT_EQ(refusal(two, "y", -1), "f: row 3 stands below other names, 'u,v': the file has two tables");
    EXPECT_EQ(two.value("y", 1), 6);
    EXPECT_THROW((void)two.column("y"), std::invalid_argument);
    const ProgramTable turned("f", "# t y\n0 5\n# y t\n8 1\n", "blank");
    EXPECT_EQ(refusal(turned, "y", -1), "f: row 1 stands below other names, 'y t': the file has two tables");
    EXPECT_EQ(turned.value("y", 0), 5);
    EXPECT_EQ(ProgramTable("f", "# t y\n0 5\n# t y\n1 8\n", "blank").value("y", -1), 8) << "the same names";
    EXPECT_EQ(ProgramTable("f", "# t y\n0 5\n# in between\n1 8\n#\n", "blank").value("y", -1), 8);
    EXPECT_EQ(ProgramTable("f", "name,y\na,nan\nb,8\n", "comma").value("y", -1), 8);
}

}  // namespace grainsweep::tests::tables_of_programs_test
