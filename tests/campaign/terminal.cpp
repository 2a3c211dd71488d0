// What a person sees: text that fits the terminal, units, files that are named when they are written.
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace grainsweep::tests::terminal_test {

using nlohmann::json;

namespace fs = std::filesystem;

/// Eight factors, so that no row fits a terminal.
const char* config = R"({"campaign": "wide", "scene": "rehearsal", "factors": [
  {"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": [0, 1]},
  {"name": "x4", "between": [0, 1]}, {"name": "x5", "between": [0, 1]}, {"name": "x6", "between": [0, 1]},
  {"name": "x7", "between": [0, 1]}, {"name": "x8", "between": [0.001, 1], "scale": "log"}],
  "where": "x1 + x2 < 1.9", "design": {"kind": "halton", "points": 96, "sequences": 8},
  "convergence": {"observable": "y", "block": 32, "tolerance": 0.001}, "replicates": 2})";

struct Terminal : testing::Test {
    Folder folder;

    Terminal() {
        folder.write("c.json", config);
        EXPECT_EQ(run({"run", "c.json", "--quiet", "-j", "2"}).code, 0);
    }
    [[nodiscard]] Ended run(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    [[nodiscard]] Ended at_width(const std::string& columns, const std::vector<std::string>& arguments) const {
        auto command = program_command(arguments);
        command.insert(command.begin(), {"/usr/bin/env", "COLUMNS=" + columns});
        return Process(command, folder.path()).wait();
    }
    [[nodiscard]] std::string cell(const std::string& sql) const {
        const auto out = run({"query", "wide.db", sql, "--format", "csv"}).out;
        return out.substr(out.find('\n') + 1, out.rfind('\n') - out.find('\n') - 1);
    }
    [[nodiscard]] std::vector<std::vector<std::string>> commands_of_text() const {
        const auto id = cell("SELECT case_id FROM wide LIMIT 1");
        return {{"status", "wide.db"},
                {"explain", "wide.db", id},
                {"query", "wide.db", "SELECT * FROM wide"},
                {"query", "wide.db", "SELECT * FROM wide LIMIT 2"},
                {"query", "wide.db", "SELECT * FROM campaign"},
                {"query", "wide.db", "SELECT * FROM provenance"},
                {"converge", "wide.db"},
                {"sensitivity", "wide.db"},
                {"plan", "c.json"},
                {"run", "c.json"},
                {"replay", "wide.db", id},
                {"scenes"},
                {"scenes", "powder_spreading"},
                {"scenes", "tpms_discharge"},
                {"scenes", "thermovibration"},
                {"scenes", "rehearsal"},
                {"designs"},
                {"designs", "halton"},
                {"designs", "lattice"},
                {"solve", "c.json"}};
    }
};

/// Characters, not bytes.
std::size_t width_of(const std::string& line) {
    return static_cast<std::size_t>(
        std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::size_t widest_line(const std::string& text) {
    std::size_t widest = 0;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) widest = std::max(widest, width_of(line));
    return widest;
}

TEST_F(Terminal, NoLineOfTextIsWiderThan80Or100Columns) {
    for (const auto& command : commands_of_text()) {
        for (const std::size_t width : {80U, 100U}) {
            const auto ended = at_width(std::to_string(width), command);
            EXPECT_EQ(ended.code, 0) << command.front() << ended.err;
            EXPECT_FALSE(ended.out.empty()) << command.front();
            EXPECT_LE(widest_line(ended.out), width) << command.front() << '\n' << ended.out;
        }
    }
}

TEST_F(Terminal, HelpFitsTheTerminal) {
    const auto help = at_width("80", {"--help"}).out;
    EXPECT_LE(widest_line(help), 80U) << help;
    EXPECT_NE(help.find("\n  sensitivity "), std::string::npos) << help;
    for (const char* command : {"plan", "run", "replay", "converge", "report", "solve"}) {
        for (const std::size_t width : {80U, 100U}) {
            const auto text = at_width(std::to_string(width), {command, "--help"}).out;
            EXPECT_LE(widest_line(text), width) << text;
        }
    }
}

// An id may begin like the number of another point.
TEST_F(Terminal, ACaseIsShownWithItsPoint) {
    const auto id = cell("SELECT case_id FROM wide WHERE point = 1 LIMIT 1");
    for (const char* command : {"explain", "replay"}) {
        const auto text = run({command, "wide.db", id}).out;
        EXPECT_EQ(text.substr(0, text.find('\n')), "case " + id + ", point 1 of wide") << command;
    }
}

// What stands out at the end of a run can be replayed without a query.
TEST_F(Terminal, TheTableOfExtremesNamesTheCases) {
    const auto text = run({"run", "c.json", "--wide"}).out;
    std::istringstream lines(text.substr(text.find("\nlargest")));
    std::string line;
    ASSERT_TRUE(std::getline(lines, line) && std::getline(lines, line));
    const auto id = line.substr(line.find_last_of(' ', line.find_last_not_of(' ')) + 1);
    EXPECT_EQ(run({"explain", "wide.db", id}).code, 0) << line;
}

TEST_F(Terminal, APipeHas100ColumnsAndWideAsManyAsItTakes) {
    const std::vector<std::string> command = {"query", "wide.db", "SELECT * FROM wide"};
    auto unset = program_command(command);
    unset.insert(unset.begin(), {"/usr/bin/env", "-u", "COLUMNS"});
    const auto piped = Process(unset, folder.path()).wait();
    EXPECT_LE(widest_line(piped.out), 100U);
    EXPECT_NE(piped.out.find("left out: "), std::string::npos) << piped.out;
    EXPECT_NE(piped.out.find("--wide"), std::string::npos);

    auto asked = command;
    asked.emplace_back("--wide");
    const auto wide = run(asked);
    EXPECT_GT(widest_line(wide.out), 150U);
    EXPECT_EQ(wide.out.find("left out"), std::string::npos);
    EXPECT_EQ(std::ranges::count(wide.out, '\n'), 1 + std::stol(cell("SELECT count(*) FROM wide")));
}

// csv and json are for programs: no width changes them.
TEST_F(Terminal, FormatsForProgramsHaveNoWidth) {
    for (const char* format : {"csv", "json"}) {
        const std::vector<std::string> command = {"query", "wide.db", "SELECT * FROM wide", "--format", format};
        EXPECT_EQ(at_width("40", command).out, at_width("400", command).out);
    }
    EXPECT_EQ(at_width("40", {"dump", "wide.db"}).out, at_width("400", {"dump", "wide.db"}).out);
    EXPECT_TRUE(json::accept(at_width("40", {"schema"}).out));
}

TEST_F(Terminal, TheWidthIsThatOfTheTerminal) {
    for (const std::uint16_t width : {std::uint16_t{60}, std::uint16_t{90}}) {
        int terminal = -1;
        const winsize size{.ws_row = 24, .ws_col = width, .ws_xpixel = 0, .ws_ypixel = 0};
        const std::string program = grainsweep::tests::executable().string();
        const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &size);
        ASSERT_GE(child, 0);
        if (child == 0) {
            if (::chdir(folder.path().c_str()) != 0) ::_exit(126);
            ::setenv("COLUMNS", "200", 1);  // of a window that was larger once
            ::execl(program.c_str(), program.c_str(), "query", "wide.db", "SELECT * FROM wide", nullptr);
            ::_exit(127);
        }
        std::string seen;
        std::array<char, 4096> bytes{};
        for (ssize_t count = 0; (count = ::read(terminal, bytes.data(), bytes.size())) > 0;)
            seen.append(bytes.data(), static_cast<std::size_t>(count));
        ::close(terminal);
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        std::erase(seen, '\r');
        EXPECT_LE(widest_line(seen), width);
        EXPECT_GT(widest_line(seen), width * 2U / 3) << seen;
    }
}

/// What a run writes to a terminal of so many columns.
std::string seen_on_terminal(const std::filesystem::path& folder, std::uint16_t width, const char* no_colour) {
    int terminal = -1;
    const winsize size{.ws_row = 24, .ws_col = width, .ws_xpixel = 0, .ws_ypixel = 0};
    const std::string program = executable().string();
    const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &size);
    if (child == 0) {
        if (::chdir(folder.c_str()) != 0) ::_exit(126);
        ::setenv("TERM", "xterm", 1);
        ::setenv("NO_COLOR", no_colour, 1);
        ::execl(program.c_str(), program.c_str(), "run", "slow.json", "-j", "1", nullptr);
        ::_exit(127);
    }
    std::string seen;
    std::array<char, 4096> bytes{};
    for (ssize_t count = 0; (count = ::read(terminal, bytes.data(), bytes.size())) > 0;)
        seen.append(bytes.data(), static_cast<std::size_t>(count));
    ::close(terminal);
    ::waitpid(child, nullptr, 0);
    return seen;
}

TEST_F(Terminal, TheProgressLineFitsAndHasColourWhereItIsWanted) {
    folder.write("slow.json", R"({"campaign": "slow", "scene": "rehearsal", "fixed": {"wait_seconds": 0.02},
        "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}], "design": {"kind": "halton",
        "points": 64, "sequences": 8}, "convergence": {"observable": "y", "tolerance": 1e-9}})");
    for (const auto& [width, no_colour] : {std::pair(std::uint16_t{80}, ""), {std::uint16_t{40}, "1"}}) {
        std::filesystem::remove(folder / "slow.db");
        auto seen = seen_on_terminal(folder.path(), width, no_colour);
        EXPECT_EQ(seen.find("\033[32m") != std::string::npos, *no_colour == '\0') << seen;
        for (const std::string code : {"\033[32m", "\033[31m", "\033[0m", "\033[K"})
            for (auto at = seen.find(code); at != std::string::npos; at = seen.find(code)) seen.erase(at, code.size());
        std::istringstream lines(seen);
        bool left = false;
        for (std::string line; std::getline(lines, line, '\r');) {
            if (line.find("/64 cases") == std::string::npos) continue;
            EXPECT_LT(width_of(line), width) << line;
            left = left || line.find(" left") != std::string::npos;
        }
        EXPECT_TRUE(left) << "the time left is shown before the verdict: " << seen;
    }
}

TEST_F(Terminal, StatusHasAUnitOnEveryNumber) {
    const auto text = run({"status", "wide.db"}).out;
    std::istringstream lines(text);
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(line, "wide: rehearsal");
    bool rate = false;
    while (std::getline(lines, line)) {
        const auto digit = line.find_first_of("0123456789");
        if (digit == std::string::npos) continue;
        const auto unit = line.find(' ', digit);
        ASSERT_NE(unit, std::string::npos) << line;
        rate = rate || line.find("cases/s") != std::string::npos;
    }
    EXPECT_TRUE(rate) << text;
    // For programs the columns stay, in cases, cases per second and seconds.
    const auto rows = json::parse(run({"status", "wide.db", "--format", "json"}).out);
    EXPECT_GT(rows[0]["rate"].get<double>(), 0);
    EXPECT_EQ(rows[0]["time_left"], 0);
}

TEST_F(Terminal, ASeedSurvivesJsonAndCsvAndIsTakenBack) {
    const auto text = run({"query", "wide.db", "SELECT seed FROM wide ORDER BY point, replicate LIMIT 1", "--wide"});
    const auto digits = text.out.substr(text.out.find('\n') + 1, text.out.rfind('\n') - text.out.find('\n') - 1);
    const auto id = cell("SELECT case_id FROM wide ORDER BY point, replicate LIMIT 1");
    const auto rows = json::parse(
        run({"query", "wide.db", "SELECT seed FROM wide ORDER BY point, replicate LIMIT 1", "--format", "json"}).out);
    EXPECT_EQ(rows[0]["seed"], digits);
    EXPECT_EQ(json::parse(run({"explain", "wide.db", id, "--format", "json"}).out)["seed"], digits);
    EXPECT_EQ(json::parse(run({"plan", "c.json", "--format", "json"}).out)["rows"][0]["seed"], digits);
    auto grouped = cell("SELECT seed FROM wide ORDER BY point, replicate LIMIT 1");
    EXPECT_NE(grouped.find('_'), std::string::npos);
    for (const auto& seed : {digits, grouped}) {
        const auto solved = run({"solve", "c.json", "--seed", seed, "--format", "json"});
        ASSERT_EQ(solved.code, 0) << solved.err;
        EXPECT_EQ(json::parse(solved.out)["seed"], digits);
    }
    std::erase(grouped, '_');
    EXPECT_EQ(grouped, digits);
    EXPECT_EQ(run({"solve", "c.json", "--seed", "12x"}).code, 2);
}

TEST_F(Terminal, WhatIsWrittenIsSaidWithItsSize) {
    const auto ran = run({"run", "c.json"});
    EXPECT_NE(ran.out.find("database wide.db ("), std::string::npos) << ran.out;
    const auto told = json::parse(run({"run", "c.json", "--format", "json"}).out);
    EXPECT_EQ(told["bytes"], fs::file_size(folder / "wide.db"));
    const auto reported = run({"report", "wide.db"});
    EXPECT_NE(reported.out.find("wide.html ("), std::string::npos) << reported.out;
}

TEST_F(Terminal, ThePageGoesToStandardOutput) {
    ASSERT_EQ(run({"report", "wide.db"}).code, 0);
    const auto page = run({"report", "wide.db", "-o", "-"});
    EXPECT_EQ(page.code, 0) << page.err;
    EXPECT_EQ(page.out.size(), fs::file_size(folder / "wide.html"));
    EXPECT_TRUE(page.out.starts_with("<!doctype html>"));
    EXPECT_FALSE(fs::exists(folder / "-"));
}

}  // namespace grainsweep::tests::terminal_test
