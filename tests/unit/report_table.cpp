// One table, three formats: aligned text, CSV, JSON; numbers read back as they were.
#include "sweep/report/document.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

namespace grainsweep::tests::report_table_test {

using namespace report;

using Cell = store::Table::Cell;

std::string written(const store::Table& table, Format format) {
    std::ostringstream out;
    write(out, table, format);
    return out.str();
}

const store::Table mixed{{"name", "count", "value"},
                         {{std::string("plain"), std::int64_t{12}, 0.1},
                          {std::string("a, \"b\"\nc"), Cell{}, -1e-300},
                          {std::string(), std::int64_t{-3}, std::numeric_limits<double>::quiet_NaN()},
                          {std::string("µm"), std::int64_t{9007199254740993}, 1.0 / 3}}};

TEST(Table, TextIsAlignedAndStaysOnOneLineARow) {
    EXPECT_EQ(written(mixed, Format::text),
              "name                  count     value\n"
              "plain                    12       0.1\n"
              "a, \"b\"\\nc                     -1e-300\n"
              "                         -3       nan\n"
              "µm         9007199254740993  0.333333\n");
}

TEST(Table, CsvIsQuotedWhereItMustBe) {
    EXPECT_EQ(written(mixed, Format::csv),
              "name,count,value\n"
              "plain,12,0.1\n"
              "\"a, \"\"b\"\"\nc\",,-1e-300\n"
              "\"\",-3,\n"
              "µm,9_007_199_254_740_993,0.3333333333333333\n");
}

TEST(Table, JsonIsOneValueWithKeysInOrder) {
    const std::string text = written(mixed, Format::json);
    EXPECT_EQ(text.find('\n'), text.size() - 1);
    EXPECT_TRUE(text.starts_with(R"([{"name":"plain","count":12,"value":0.1},)"));
    const auto rows = nlohmann::json::parse(text);
    EXPECT_EQ(rows[1]["name"], "a, \"b\"\nc");
    EXPECT_TRUE(rows[1]["count"].is_null());
    EXPECT_TRUE(rows[2]["value"].is_null());
    EXPECT_EQ(rows[3]["count"], "9007199254740993");
    EXPECT_EQ(rows[3]["value"].get<double>(), 1.0 / 3);
    EXPECT_EQ(written({{"a"}, {}}, Format::json), "[]\n");
    // A name that is there more than once loses no value.
    EXPECT_EQ(written({{"y", "y", "y_2", "y"}, {{1, 2, 3, 4}}}, Format::json),
              "[{\"y\":1,\"y_2\":2,\"y_2_2\":3,\"y_3\":4}]\n");
    EXPECT_EQ(written({{"y", "y", "y_2", "y"}, {{1, 2, 3, 4}}}, Format::csv), "y,y_2,y_2_2,y_3\n1,2,3,4\n");
}

// jq, R and spreadsheets read every number as a double.
TEST(Table, WholeNumbersThatNoDoubleHoldsAreText) {
    const std::int64_t last = std::int64_t{1} << 53U;
    const store::Table table{{"seed"}, {{last}, {last + 1}, {-last - 1}, {std::int64_t{5577006791947779410}}}};
    EXPECT_EQ(written(table, Format::json),
              "[{\"seed\":9007199254740992},{\"seed\":\"9007199254740993\"},{\"seed\":\"-9007199254740993\"},"
              "{\"seed\":\"5577006791947779410\"}]\n");
    EXPECT_EQ(written(table, Format::csv),
              "seed\n9007199254740992\n9_007_199_254_740_993\n-9_007_199_254_740_993\n5_577_006_791_947_779_410\n");
}

TEST(Table, NumbersRoundTrip) {
    for (const double x : {0.1, 1.0 / 3, 5e-324, 1.7976931348623157e308, 123456789.125, -2.5e-7}) {
        const store::Table table{{"x"}, {{x}}};
        EXPECT_EQ(std::strtod(written(table, Format::csv).c_str() + 2, nullptr), x);
        EXPECT_EQ(nlohmann::json::parse(written(table, Format::json))[0]["x"].get<double>(), x);
    }
}

TEST(Table, BytesThatAreNoUtf8DoNotBreakJson) {
    const store::Table table{{"x"}, {{std::string("\xFF\xFE")}}};
    EXPECT_TRUE(nlohmann::json::accept(written(table, Format::json)));
}

TEST(Table, CsvTextIsNoFormulaAndMovesNoCursor) {
    using Text = std::string;
    const store::Table table{{"=1+1"},
                             {{Text("=HYPERLINK(\"http://x\")")},
                              {Text("+1")},
                              {Text("-1")},
                              {Text("@SUM(A1)")},
                              {Text("\x1B[2Jgone\x07")},
                              {Text("caf\xC3\xA9 \xC2\x9B"
                                    "31m")},
                              {std::int64_t{-1}},
                              {-0.5}}};
    EXPECT_EQ(
        written(table, Format::csv),
        "'=1+1\n\"'=HYPERLINK(\"\"http://x\"\")\"\n'+1\n'-1\n'@SUM(A1)\n\\x1b[2Jgone\\x07\ncaf\xC3\xA9 \\x9b31m\n-1\n"
        "-0.5\n");
    const auto text = written(table, Format::json);
    const auto json = nlohmann::json::parse(text);
    EXPECT_EQ(json[1]["=1+1"], "+1") << "programs get the text as it is";
    EXPECT_EQ(json[5]["=1+1"],
              "caf\xC3\xA9 \xC2\x9B"
              "31m");
    EXPECT_EQ(text.find("\xC2\x9B"), std::string::npos) << "and no terminal obeys it";
}

TEST(Table, RowsWrittenAsTheyComeAreTheTable) {
    for (const auto format : {Format::csv, Format::json}) {
        for (const auto& table : {mixed, store::Table{{"y", "y"}, {}}}) {
            std::ostringstream out;
            report::RowWriter rows(out, format);
            rows.begin(table.columns);
            for (const auto& row : table.rows) rows.add(row);
            rows.end();
            EXPECT_EQ(out.str(), written(table, format));
        }
    }
}

TEST(Documents, StandOneBelowTheOtherInEveryFormat) {
    const auto made = [](const std::string& name, bool alone) {
        Document document{.rows = {{"campaign"}, {{name}}}, .value = {{"campaign", name}}, .alone = alone};
        return document.say(name + "\n").say_notes({"first", "second"}).show({{"x"}, {{0.5}}});
    };
    const auto written = [](const std::vector<Document>& documents, Format format) {
        std::ostringstream out;
        write(out, documents, format);
        return out.str();
    };
    const std::vector documents = {made("a", false), made("b", true), made("c", false)};
    EXPECT_EQ(written({documents[0], documents[2]}, Format::text),
              "a\nnote: first\nnote: second\n  x\n0.5\n\nc\nnote: first\nnote: second\n  x\n0.5\n");
    EXPECT_EQ(written(documents, Format::json), "[{\"campaign\":\"a\"},{\"campaign\":\"b\"},{\"campaign\":\"c\"}]\n");
    EXPECT_EQ(written(documents, Format::csv), "campaign\na\nc\n") << "what stands alone comes below nothing";
    EXPECT_EQ(written({documents[1], documents[0]}, Format::csv), "campaign\nb\n") << "and nothing below it";
    EXPECT_EQ(written({}, Format::json), "[]\n");
}

}  // namespace grainsweep::tests::report_table_test
