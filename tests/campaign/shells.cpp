// Completion and manual page: what shells and man(1) make of them.
#include "sweep/store/database.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace grainsweep::tests::shells_test {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

struct Shells : testing::Test {
    Folder folder;

    [[nodiscard]] Ended run(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    [[nodiscard]] Ended bash(const std::string& script) const {
        return Process({"/bin/bash", "-c", script}, folder.path()).wait();
    }
    [[nodiscard]] bool has(const std::string& program) const {
        return bash("command -v " + program + " >/dev/null").code == 0;
    }
    /// What bash offers for the last of the words.
    [[nodiscard]] std::vector<std::string> offered(const std::vector<std::string>& words) const {
        folder.write("completion.bash", run({"completion", "bash"}).out);
        std::string script = "source completion.bash\nCOMP_WORDS=('" + grainsweep::tests::executable().string() + "'";
        for (const auto& word : words) script += " '" + word + "'";
        script += ")\nCOMP_CWORD=" + std::to_string(words.size()) +
                  "\n_grainsweep\nfor word in \"${COMPREPLY[@]}\"; do echo \"$word\"; done";
        const auto ended = bash(script);
        EXPECT_EQ(ended.err, "");
        std::vector<std::string> list;
        std::istringstream stream(ended.out);
        for (std::string line; std::getline(stream, line);) list.push_back(line);
        std::ranges::sort(list);
        return list;
    }
    /// Names in the catalogue that a command lists.
    [[nodiscard]] std::vector<std::string> listed(const std::string& command, const std::string& key) const {
        std::vector<std::string> names;
        for (const auto& row : nlohmann::json::parse(run({command, "--format", "json"}).out)) names.push_back(row[key]);
        std::ranges::sort(names);
        return names;
    }
};

TEST_F(Shells, BashCompletesCommandsOptionsAndWords) {
    EXPECT_EQ(bash("'" + grainsweep::tests::executable().string() + "' completion bash | bash -n").err, "");
    EXPECT_THAT(offered({""}), IsSupersetOf({"plan", "run", "solve", "status", "query", "report", "completion"}));
    EXPECT_THAT(offered({""}), Not(Contains("worker"))) << "the program's own";
    EXPECT_THAT(offered({"st"}), ElementsAre("status"));
    EXPECT_THAT(offered({"run", "--ma"}), ElementsAre("--max-cases"));
    EXPECT_THAT(offered({"run", "-"}), IsSupersetOf({"-j", "-k", "--db", "--quiet", "--format", "--wide"}));
    EXPECT_THAT(offered({"query", "a.db", "--format", ""}), ElementsAre("csv", "json", "text", "xlsx"));
    EXPECT_THAT(offered({"run", "c.json", "--again", "c"}), ElementsAre("completed", "crashed"));
    EXPECT_THAT(offered({"solve", "c.json", "--set", "frict"}),
                ElementsAre("friction=", "friction_a=", "friction_b=", "friction_hard=", "friction_limit="));
    EXPECT_THAT(offered({"completion", ""}), ElementsAre("bash", "zsh"));
}

TEST_F(Shells, BashCompletesScenesAndDesignsOfTheCatalogues) {
    EXPECT_EQ(offered({"scenes", ""}), listed("scenes", "scene"));
    EXPECT_EQ(offered({"designs", ""}), listed("designs", "design"));
    EXPECT_THAT(offered({"scenes", "powder"}), ElementsAre("powder_spreading"));
}

TEST_F(Shells, BashCompletesFilesAndWhatADatabaseHolds) {
    folder.write("c.json", R"({"campaign": "first_one", "scene": "rehearsal",
        "factors": [{"name": "x1", "between": [0, 1]}], "design": {"kind": "halton", "points": 5}})");
    ASSERT_EQ(run({"run", "c.json", "--quiet"}).code, 0);
    folder.write("notes.txt", "");
    EXPECT_THAT(offered({"plan", ""}), ElementsAre("c.json"));
    EXPECT_THAT(offered({"status", ""}), ElementsAre("first_one.db"));
    EXPECT_THAT(offered({"run", "c.json", "--db", "fi"}), ElementsAre("first_one.db"));
    EXPECT_THAT(offered({"run", "-j", "2", ""}), ElementsAre("c.json")) << "the value of an option is no argument";
    EXPECT_THAT(offered({"converge", "first_one.db", "--campaign", ""}), ElementsAre("first_one"));
    EXPECT_THAT(offered({"converge", "first_one.db", "--observable", ""}), ElementsAre("y"));
    const auto ids = offered({"explain", "first_one.db", ""});
    ASSERT_EQ(ids.size(), 5U);
    EXPECT_THAT(offered({"explain", "first_one.db", ids[2].substr(0, 6)}), ElementsAre(ids[2]));
}

/// Names as a database from elsewhere may have them.
const std::vector<std::string>& hostile_names() {
    static const std::vector<std::string> names = {"$(touch RAN)",
                                                   "`touch RAN`",
                                                   "x';touch RAN;'",
                                                   "a$(touch RAN)b",
                                                   "\"; touch RAN; \"",
                                                   "a:b$(touch RAN)",
                                                   "two words",
                                                   "<(touch RAN)",
                                                   "x\n$(touch RAN)",
                                                   "x\ntouch RAN",
                                                   "${x:=$(touch RAN)}",
                                                   "*",
                                                   "~",
                                                   "a&b",
                                                   "-n",
                                                   "(e:touch RAN:)",
                                                   "=ls",
                                                   "$((RAN[$(touch RAN)]))",
                                                   "\x1b]0;x\x07"};
    return names;
}

TEST_F(Shells, TabRunsNothingThatADatabaseHolds) {
    folder.write("c.json", R"({"campaign": "first_one", "scene": "rehearsal",
        "factors": [{"name": "x1", "between": [0, 1]}], "design": {"kind": "halton", "points": 5}})");
    ASSERT_EQ(run({"run", "c.json", "--quiet"}).code, 0);
    std::filesystem::create_symlink(grainsweep::tests::executable(), folder / "grainsweep");
    folder.write("_grainsweep", run({"completion", "zsh"}).out);
    folder.write("ask.zsh", R"(zmodload zsh/zpty
zpty asked zsh -f -i
zpty -w asked 'PS1=; PS2=; path=('$PWD' $path); fpath=('$PWD' $fpath); autoload -U compinit; compinit -u -D; LISTMAX=0; print ready-$((40+2))'
zpty -r asked answer '*ready-42*'
zpty -w -n asked $'grainsweep converge first_one.db --campaign \t\t\C-ugrainsweep explain first_one.db \t\t\C-uprint end-$((40+2))\n'
zpty -r asked answer '*end-42*'
zpty -d asked
)");
    {
        grainsweep::store::Connection db(folder / "first_one.db", grainsweep::store::Connection::Access::write);
        for (const auto& [table, key, name] :
             {std::array{"campaign", "campaign_id", "name"}, std::array{"observable", "observable_id", "name"},
              std::array{"sim_case", "case_key", "case_id"}}) {
            db.execute(fmt::format("CREATE TEMP TABLE one AS SELECT * FROM {} LIMIT 1", table));
            std::int64_t row = 1000;
            for (const auto& hostile : hostile_names()) {
                auto rename = db.prepare(fmt::format("UPDATE one SET {} = ?, {} = ?", key, name));
                rename.bind(1, ++row);
                rename.bind(2, hostile);
                (void)rename.step();
                db.execute(fmt::format("INSERT INTO {} SELECT * FROM one", table));
            }
            db.execute("DROP TABLE one");
        }
    }
    for (const auto& words : {std::vector<std::string>{"converge", "first_one.db", "--campaign", ""},
                              {"converge", "first_one.db", "--observable", ""},
                              {"explain", "first_one.db", ""}}) {
        const auto all = offered(words);
        EXPECT_FALSE(all.empty());
        // What would be entered with the command is a plain word, too.
        for (const auto& offer : all)
            EXPECT_EQ(offer.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyz_"), std::string::npos) << offer;
        EXPECT_FALSE(std::filesystem::exists(folder / "RAN")) << words.front();
    }
    if (!has("zsh")) return;  // what follows asks zsh itself, where it is installed
    EXPECT_EQ(bash("timeout 20 zsh -f ask.zsh").code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "RAN"));
}

TEST_F(Shells, ZshReadsItsCompletion) {
    const auto script = run({"completion", "zsh"});
    EXPECT_EQ(script.code, 0);
    EXPECT_TRUE(script.out.starts_with("#compdef grainsweep\n"));
    for (const auto& scene : listed("scenes", "scene")) EXPECT_THAT(script.out, HasSubstr(scene));
    EXPECT_THAT(script.out, HasSubstr("'(--format)--format[text, csv or json]:FORMAT:(text csv json)'"));
    EXPECT_EQ(std::ranges::count(script.out, '{'), std::ranges::count(script.out, '}'));
    if (!has("zsh")) return;  // what follows asks zsh itself, where it is installed
    folder.write("_grainsweep", script.out);
    const auto checked = bash("zsh -n _grainsweep");
    EXPECT_EQ(checked.code, 0) << checked.err;
    // zpty types into a shell of its own; the menu it shows holds the words.
    folder.write("ask.zsh", R"(zmodload zsh/zpty
zpty asked zsh -f -i
zpty -w asked 'PS1=; PS2=; fpath=('$PWD' $fpath); autoload -U compinit; compinit -u -D; LISTMAX=0; setopt list_rows_first; bindkey "^I" list-choices; print ready-$((40+2))'
zpty -r asked answer '*ready-42*'
zpty -w -n asked $'grainsweep scenes \t'
zpty -r asked answer '*)" + listed("scenes", "scene").back() +
                                R"(*'
print -r -- "$answer"
zpty -d asked
)");
    const auto answered = bash("timeout 20 zsh -f ask.zsh");
    EXPECT_EQ(answered.code, 0) << answered.err;
    for (const auto& scene : listed("scenes", "scene")) EXPECT_THAT(answered.out, HasSubstr(scene));
}

TEST_F(Shells, TheManualNamesEveryCommandSceneDesignAndOption) {
    const auto page = run({"manual"});
    EXPECT_EQ(page.code, 0);
    EXPECT_TRUE(page.out.starts_with(".TH GRAINSWEEP 1 "));
    for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "COMMANDS", "CAMPAIGN FILE", "SCENES", "DESIGNS",
                                "EXIT STATUS", "ENVIRONMENT", "FILES", "EXAMPLES", "SEE ALSO"})
        EXPECT_THAT(page.out, HasSubstr(std::string("\n.SH ") + section + "\n"));
    for (const auto& scene : listed("scenes", "scene")) EXPECT_THAT(page.out, HasSubstr("\\fB" + scene + "\\fR"));
    for (const auto& design : listed("designs", "design")) EXPECT_THAT(page.out, HasSubstr("\\fB" + design + "\\fR"));
    for (const char* option : {"\\-\\-max\\-cases", "\\-\\-wide", "\\-j", "\\-\\-observable", "\\-\\-vtk"})
        EXPECT_THAT(page.out, HasSubstr(option));
    EXPECT_THAT(page.out, Not(HasSubstr("\\fBworker\\fR")));

    // Every line is text or a request that the man macros have.
    std::istringstream lines(page.out);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with('.')) continue;
        const auto request = line.substr(0, line.find(' '));
        EXPECT_THAT((std::vector<std::string>{".TH", ".SH", ".SS", ".PP", ".TP", ".br", ".BR", ".nf", ".fi", ".RS",
                                              ".RE", ".ad", ".nh"}),
                    Contains(request));
    }
    folder.write("grainsweep.1", page.out);
    if (has("groff")) {
        const auto typeset = bash("groff -man -ww -Tutf8 -Kutf8 grainsweep.1");
        EXPECT_EQ(typeset.code, 0);
        EXPECT_EQ(typeset.err, "");
        EXPECT_THAT(typeset.out, HasSubstr("parameter sweeps of granular processes"));
    }
    if (has("mandoc")) {
        EXPECT_EQ(bash("mandoc -Tlint -Wwarning grainsweep.1 | grep -v 'missing date'").out, "")
            << "a page has no clock";
    }
}

}  // namespace grainsweep::tests::shells_test
