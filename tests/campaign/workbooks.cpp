// Workbooks, through the real program; read by Python's zipfile, which knows nothing of how they were written.
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::workbooks_test {

using nlohmann::json;
using testing::HasSubstr;

/// Prints {"sheets": names, "rows": [[cells of the first sheet]], "second": [[...]], "frozen": rows in view}.
const char* reader = R"(
import json, re, sys, zipfile
import xml.etree.ElementTree as xml
book = zipfile.ZipFile(sys.argv[1])
assert book.testzip() is None
space = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
def tree(name): return xml.fromstring(book.read(name))
def cells(name):
    rows = []
    for row in tree(name).iter(space + "row"):
        cells = {}
        for cell in row.iter(space + "c"):
            column = re.match("[A-Z]+", cell.get("r")).group()
            text = "".join(one.text or "" for one in cell.iter(space + "t"))
            value = cell.find(space + "v")
            cells[column] = text if cell.get("t") == "inlineStr" else float(value.text)
        rows.append(cells)
    return rows
first = "xl/worksheets/sheet1.xml"
print(json.dumps({"sheets": [one.get("name") for one in tree("xl/workbook.xml").iter(space + "sheet")],
    "rows": cells(first), "second": cells("xl/worksheets/sheet2.xml"),
    "frozen": [one.get("ySplit") for one in tree(first).iter(space + "pane")],
    "widths": [float(one.get("width")) for one in tree(first).iter(space + "col")],
    "created": book.read("docProps/core.xml").decode()}))
)";

struct Workbooks : testing::Test {
    Folder folder;

    Workbooks() {
        folder.write("r.json",
                     R"({"campaign": "r", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
            "fixed": {"wait_seconds": 0.001}, "design": {"kind": "halton", "points": 3, "scramble": "none"}})");
        EXPECT_EQ(program({"run", "r.json", "--quiet"}).code, 0);
        folder.write("read.py", reader);
    }
    [[nodiscard]] Ended program(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    [[nodiscard]] json read(const std::string& file) const {
        const auto ended = Process({"/usr/bin/python3", "read.py", file}, folder.path()).wait();
        EXPECT_EQ(ended.code, 0) << ended.err;
        return ended.code == 0 ? json::parse(ended.out) : json();
    }
    [[nodiscard]] json asked(const std::string& sql) const {
        const auto ended = program({"query", "r.db", sql, "--format", "xlsx", "-o", "a.xlsx"});
        EXPECT_EQ(ended.code, 0) << ended.err;
        return read("a.xlsx");
    }
    [[nodiscard]] std::string bytes(const std::string& file) const {
        std::ifstream stream(folder / file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
};

TEST_F(Workbooks, HoldNumbersAsNumbersUnitsAndWhereTheyComeFrom) {
    const auto book =
        asked("SELECT point, x1, y, wait_seconds, outcome, NULL AS blank FROM r, (SELECT 0.001 AS wait_seconds)");
    EXPECT_EQ(book["sheets"], json({"rows", "provenance"}));
    EXPECT_EQ(book["frozen"], json({"1"}));
    const auto& rows = book["rows"];
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(
        rows[0],
        json({{"A", "point"}, {"B", "x1"}, {"C", "y"}, {"D", "wait_seconds (s)"}, {"E", "outcome"}, {"F", "blank"}}));
    EXPECT_EQ(rows[1]["A"], 0);
    EXPECT_EQ(rows[1]["B"], 0.5);
    EXPECT_TRUE(rows[1]["C"].is_number());
    EXPECT_EQ(rows[1]["E"], "completed");
    EXPECT_FALSE(rows[1].contains("F")) << "NULL is an empty cell";
    EXPECT_GT(book["widths"][4].get<double>(), book["widths"][0].get<double>());
    std::string provenance = book["second"].dump();
    EXPECT_THAT(provenance, HasSubstr("SELECT point, x1"));
    EXPECT_THAT(provenance, HasSubstr("r.db"));
    EXPECT_THAT(provenance, HasSubstr("name r; scene rehearsal"));
    EXPECT_THAT(provenance, HasSubstr("grainsweep "));
    EXPECT_THAT(book["created"].get<std::string>(), HasSubstr("1980-01-01"));
}

TEST_F(Workbooks, KeepWhatNoCellHoldsAsText) {
    const auto book = asked(
        "SELECT 5577006791947779410 AS seed, -9007199254740992 AS exact, 1e999 AS high, -1e999 AS low, '=1+1' AS "
        "formula, "
        "char(7) || 'x' AS bell, CAST(x'ff41' AS TEXT) AS broken, '' AS empty, 0.1 AS tenth, "
        "char(65534) || 'y' || char(65535) AS \"no\uFFFF xml\"");
    const auto& row = book["rows"][1];
    EXPECT_EQ(row["A"], "5577006791947779410");
    EXPECT_EQ(row["B"], -9007199254740992.0);
    EXPECT_EQ(row["C"], "inf");
    EXPECT_EQ(row["D"], "-inf");
    EXPECT_EQ(row["E"], "=1+1");
    EXPECT_EQ(row["F"], "\\x07x");
    EXPECT_EQ(row["G"],
              "\xEF\xBF\xBD"
              "A");
    EXPECT_EQ(row["I"], 0.1);
    EXPECT_EQ(row["J"], "\uFFFDy\uFFFD") << "no text of XML";
    EXPECT_EQ(book["rows"][0]["J"], "no\uFFFD xml");
}

TEST_F(Workbooks, CutATextThatNoCellHolds) {
    const auto ended = program({"query", "r.db", "SELECT replace(hex(zeroblob(20000)), '00', 'ab') AS long", "--format",
                                "xlsx", "-o", "a.xlsx"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("1 texts are cut at 32767 characters"));
    EXPECT_EQ(read("a.xlsx")["rows"][1]["A"].get<std::string>().size(), 32'767U);
}

TEST_F(Workbooks, HaveTheSameBytesAgainAndGoThroughAPipe) {
    const std::vector<std::string> ask = {"query", "r.db", "SELECT * FROM r", "--format", "xlsx"};
    auto to_file = ask;
    to_file.insert(to_file.end(), {"-o", "a.xlsx"});
    EXPECT_EQ(program(to_file).code, 0);
    const auto first = bytes("a.xlsx");
    EXPECT_EQ(program(to_file).code, 0);
    EXPECT_EQ(first, bytes("a.xlsx"));
    EXPECT_EQ(program(ask).out, first);
}

TEST_F(Workbooks, AreRefusedWhereTheyCannotBe) {
    const auto refused = [&](const std::vector<std::string>& arguments, const std::string& sentence) {
        const auto ended = program(arguments);
        EXPECT_EQ(ended.code, 2);
        EXPECT_THAT(ended.err, HasSubstr(sentence));
    };
    refused({"query", "r.db", "SELECT 1", "-o", "a.csv"}, "only a workbook (--format xlsx) is written to a file");
    refused({"query", "r.db", "SELECT 1", "--format", "xls"}, "must be 'text', 'csv', 'json' or 'xlsx', not 'xls'");
    refused({"status", "r.db", "--format", "xlsx"}, "must be 'text', 'csv' or 'json', not 'xlsx'");
    refused({"query", "r.db", "SELECT 1", "--format", "xlsx", "-o", "r.db"}, "this belongs to the database");
    refused({"query", "r.db", "SELECT 1", "--format", "xlsx", "-o", "r.json"},
            "this file exists and is not a workbook");
    refused({"query", "r.db", "SELECT gap2", "--format", "xlsx", "-o", "b.xlsx"}, "no such column");
    EXPECT_FALSE(std::filesystem::exists(folder / "b.xlsx"));
}

TEST_F(Workbooks, AreNotShownOnATerminal) {
    int terminal = -1;
    const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    ASSERT_GE(child, 0);
    if (child == 0) {
        const auto command = program_command({"query", "r.db", "SELECT 1", "--format", "xlsx"});
        std::vector<char*> argv;
        for (const auto& word : command) argv.push_back(const_cast<char*>(word.c_str()));
        argv.push_back(nullptr);
        if (::chdir(folder.path().c_str()) == 0) ::execv(argv.front(), argv.data());
        std::_Exit(127);
    }
    std::string shown;
    char piece[256];
    for (ssize_t count = 0; (count = ::read(terminal, piece, sizeof piece)) > 0;)
        shown.append(piece, static_cast<std::size_t>(count));
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(terminal);
    EXPECT_EQ(WEXITSTATUS(status), 2);
    EXPECT_THAT(shown, HasSubstr("a workbook is not shown on a terminal; name a file with -o"));
}

}  // namespace grainsweep::tests::workbooks_test
