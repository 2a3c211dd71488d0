// Every command of the documents is run as a reader would run it: page.hpp has the rules.
#include "tests/documents/page.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

namespace grainsweep::tests::commands_test {

using nlohmann::json;

namespace fs = std::filesystem;

/// A folder as a clone is, with the program built.
class Clone {
public:
    Clone() {
        for (const char* name : {"configs", "bootstrap.sh", "packaging"})
            fs::create_symlink(source(name), folder_ / name);
        fs::create_directory(folder_ / "build");
        fs::create_symlink(executable(), folder_ / "build/grainsweep");
        fs::create_directory(folder_ / "absent");
        // Programs that long commands would start, where they are not installed: `plan` asks them for their version.
        for (const char* program : {"liggghts", "lmp"}) {
            const auto file = folder_.write(std::string("absent/") + program,
                                            "#!/bin/sh\necho 'Version 0.0, Massively Parallel Simulator - none'\n");
            fs::permissions(file, fs::perms::owner_all);
        }
    }
    [[nodiscard]] Ended bash(const std::string& script) const {
        const std::string whole =
            "export PATH=\"$PWD/build:$PATH:$PWD/absent\" PYTHONPATH=\"$PWD/packaging/python\"\n" + script;
        return Process({"/bin/bash", "-e", "-u", "-o", "pipefail", "-c", whole}, folder_.path()).wait();
    }
    [[nodiscard]] Ended grainsweep(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder_.path());
    }
    [[nodiscard]] bool has(const std::string& command) const { return bash(command + " >/dev/null 2>&1").code == 0; }
    fs::path write(const std::string& name, const std::string& text) const { return folder_.write(name, text); }

private:
    Folder folder_;
};

std::string place(const Page& page, const Block& block) {
    return page.file.string() + ":" + std::to_string(block.line);
}

void expect_success(const Ended& ended, const std::string& where) {
    EXPECT_EQ(ended.code, 0) << where << "\n" << ended.out << ended.err;
}

/// Words of a line of shell, one command after another; quotes are taken off.
std::vector<std::vector<std::string>> commands_in(const std::string& script) {
    std::vector<std::vector<std::string>> commands(1);
    std::string word;
    char quote = 0;
    const auto end_word = [&] {
        if (!word.empty()) commands.back().push_back(std::exchange(word, {}));
    };
    const auto end_command = [&] {
        end_word();
        if (!commands.back().empty()) commands.emplace_back();
    };
    for (std::size_t k = 0; k < script.size(); ++k) {
        const char c = script[k];
        if (quote != 0) {
            if (c == quote)
                quote = 0;
            else
                word += c;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '#' && word.empty()) {
            k = std::min(script.find('\n', k), script.size()) - 1;
        } else if (c == ';' || c == '|' || c == '&' || c == '\n') {
            end_command();
        } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
            end_word();
        } else {
            word += c;
        }
    }
    end_command();
    return commands;
}

/// A command of the program that is not run here: it must exist with its options, and its campaign must be sound,
/// unless it is one that --next-file, here or in an earlier command, writes: `written`.
void check_grainsweep(const Clone& clone, std::span<const std::string> arguments, const std::string& where,
                      std::set<std::string>& written) {
    ASSERT_FALSE(arguments.empty()) << where;
    const auto known = command_names();
    const std::string& command = arguments.front();
    ASSERT_NE(std::ranges::find(known, command), known.end()) << where << ": no command " << command;
    const auto options = options_of(command);
    if (const auto option = std::ranges::find(arguments, "--next-file");
        option != arguments.end() && option + 1 != arguments.end())
        written.insert(*(option + 1));
    for (const auto& word : arguments.subspan(1)) {
        if (word.size() > 1 && word.front() == '-' && std::isalpha(static_cast<unsigned char>(word.back())) != 0) {
            EXPECT_NE(std::ranges::find(options, word), options.end())
                << where << ": " << command << " has no " << word;
        }
        if (word.ends_with(".json") && word.find('$') == std::string::npos && !written.contains(word))
            expect_success(clone.bash("grainsweep plan '" + word + "' --format json"), where + " " + word);
    }
}

bool mentioned_in(const fs::path& file, const std::string& word) {
    return read_page(file).text.find(word) != std::string::npos;
}

/// A target or executable of the tests: test_KIND, bench_NAME or slow_NAME.
void check_test_program(const std::string& name, const std::string& where) {
    const fs::path tests = source("tests");
    const auto cut = name.find('_');
    const std::string kind = name.substr(0, cut);
    const std::string rest = name.substr(cut + 1);
    const bool there = kind == "test"   ? fs::is_directory(tests / rest)
                       : kind == "slow" ? fs::exists(tests / "bench" / (rest + "_slow.cpp"))
                                        : fs::exists(tests / "bench" / (rest + "_speed.cpp")) ||
                                              fs::exists(tests / "bench" / (rest + ".cpp"));
    EXPECT_TRUE(there) << where << ": no " << name;
}

void check_bootstrap(const Clone& clone, std::span<const std::string> arguments, const std::string& where) {
    ASSERT_FALSE(arguments.empty()) << where;
    EXPECT_TRUE(mentioned_in("bootstrap.sh", "./bootstrap.sh " + arguments.front())) << where;
    if (arguments.front() == "run") {
        std::vector<std::string> run(arguments.begin(), arguments.end());
        std::set<std::string> written;
        check_grainsweep(clone, run, where, written);
    }
    if (arguments.front() != "bench") return;
    for (const auto& name : arguments.subspan(1)) check_test_program("bench_" + name, where);
}

/// Not run: what it names must be there.
void check_long(const Clone& clone, const Block& block, const std::string& where) {
    expect_success(clone.bash("bash -n <<'END_OF_BLOCK'\n" + block.text + "END_OF_BLOCK\n"), where);
    static const std::set<std::string> keywords = {"do", "then", "time", "sudo"};
    std::set<std::string> written;
    for (const auto& command : commands_in(block.text)) {
        const auto first = std::ranges::find_if(command, [](const auto& word) { return !keywords.contains(word); });
        if (first == command.end()) continue;
        const std::string program = fs::path(*first).filename();
        const std::span<const std::string> arguments(first + 1, command.end());
        if (program == "grainsweep")
            check_grainsweep(clone, arguments, where, written);
        else if (program == "bootstrap.sh")
            check_bootstrap(clone, arguments, where);
        else if (program.starts_with("test_") || program.starts_with("slow_") || program.starts_with("bench_"))
            check_test_program(program, where);
    }
}

void run_python(const Clone& clone, const Block& block, const std::string& where) {
    clone.write("block.py", block.text);
    static const std::regex import(R"((?:^|\n)import ([a-z0-9_, ]+))");
    std::string libraries = "import sys";
    for (std::sregex_iterator it(block.text.begin(), block.text.end(), import), end; it != end; ++it)
        libraries += ", " + (*it)[1].str();
    if (clone.has("python3 -c '" + libraries + "'")) return expect_success(clone.bash("python3 block.py"), where);
    if (clone.has("python3 --version"))
        expect_success(clone.bash("python3 -c 'compile(open(\"block.py\").read(), \"block.py\", \"exec\")'"), where);
}

void run_r(const Clone& clone, const Block& block, const std::string& where) {
    clone.write("block.R", block.text);
    if (clone.has("Rscript --version")) expect_success(clone.bash("Rscript block.R"), where);
}

/// The keys of a part in the place of those of the page's campaign; what is null there is left out.
json replaced(json campaign, const json& part) {
    for (const auto& [key, value] : part.items()) {
        campaign[key] = value;
        if (value.is_null()) campaign.erase(key);
    }
    return campaign;
}

class Commands : public ::testing::TestWithParam<Page> {};

TEST_P(Commands, OfThePageRun) {
    const auto& page = GetParam();
    const Clone clone;
    json base;
    std::map<std::string, json> written;
    for (const auto& block : page.blocks) {
        const std::string where = place(page, block);
        const std::string kind = block.language + (block.what.empty() ? "" : " " + block.what);
        if (kind == "sh") {
            expect_success(clone.bash(block.text), where);
        } else if (kind == "sh long") {
            check_long(clone, block, where);
        } else if (block.language == "sql") {
            const auto ended = clone.grainsweep({"query", block.what, block.text, "--format", "csv"});
            expect_success(ended, where);
            EXPECT_GE(std::ranges::count(ended.out, '\n'), 2) << where << " returns nothing:\n" << ended.out;
        } else if (block.language == "json") {
            const auto value = json::parse(block.text, nullptr, false);
            ASSERT_FALSE(value.is_discarded()) << where << " is no JSON";
            if (block.what == "part") {
                clone.write("part.json", replaced(base, value).dump(1));
                expect_success(clone.grainsweep({"plan", "part.json", "--format", "json"}), where);
            } else if (block.what.ends_with('+')) {
                const auto name = block.what.substr(0, block.what.size() - 1);
                ASSERT_TRUE(written.contains(name)) << where << ": no block wrote " << name << " before";
                written[name].merge_patch(value);
                clone.write(name, written[name].dump(1));
            } else if (!block.what.empty()) {
                written[block.what] = value;
                clone.write(block.what, block.text);
                if (base.is_null()) base = value;
            }
        } else if (block.language == "python") {
            run_python(clone, block, where);
        } else if (block.language == "r") {
            run_r(clone, block, where);
        } else {
            EXPECT_EQ(block.language, "text") << where << ": page.hpp says what a block may be";
        }
    }
}

std::vector<Page> pages_with_blocks() {
    auto pages = user_pages();
    std::erase_if(pages, [](const Page& page) { return page.blocks.empty(); });
    return pages;
}

std::string name_of(const ::testing::TestParamInfo<Page>& info) {
    std::string name = info.param.file.string();
    std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
    return name;
}

INSTANTIATE_TEST_SUITE_P(Documents, Commands, ::testing::ValuesIn(pages_with_blocks()), name_of);

// Only the compiler is left out: what the run prints must lead to the page, also where a name has a space.
TEST(Bootstrap, RunsACampaignAndWritesItsPage) {
    const Clone clone;
    expect_success(clone.bash("mkdir tools\n"
                              "printf '#!/bin/sh\\n' > tools/cmake\n"
                              "chmod +x tools/cmake\n"
                              "export PATH=\"$PWD/tools:$PATH\"\n"
                              "./bootstrap.sh run configs/rehearsal_small.json -j 1 > printed\n"
                              "test -s rehearsal_small.html\n"
                              "grep -q '^next: build/grainsweep report rehearsal_small.db$' printed\n"
                              "grep -q '^rehearsal_small.html .*: open it in a browser$' printed\n"
                              "grep -q '^then type: build/grainsweep solve configs/rehearsal_small.json' printed\n"
                              "test \"$(wc -l < printed)\" -le 25\n"
                              "./bootstrap.sh run configs/rehearsal_small.json -j 1 --db 'a first try.db'\n"
                              "test -s 'a first try.html'\n"),
                   "bootstrap.sh run");
}

TEST(Options, InTheDocumentsExist) {
    // Of other programs, as the documents use them.
    std::set<std::string> known = {"--gtest_filter", "--preset", "--build",  "--target", "--install",
                                   "--prefix",       "--part",   "--signal", "--mpi"};
    for (const auto& command : command_names())
        for (const auto& option : options_of(command)) known.insert(option);
    for (const auto& option : options_of("")) known.insert(option);
    static const std::regex option("(^|[^A-Za-z0-9_-])(--[a-z][a-z_-]*)");
    for (const auto& page : user_pages()) {
        auto texts = page.code_spans();
        for (const auto& block : page.blocks)
            if (block.language == "sh") texts.push_back(block.text);
        for (const auto& text : texts)
            for (std::sregex_iterator it(text.begin(), text.end(), option), end; it != end; ++it)
                EXPECT_TRUE(known.contains((*it)[2])) << page.file << ": no option " << (*it)[2];
    }
}

}  // namespace grainsweep::tests::commands_test
