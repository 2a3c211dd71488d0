#include "tests/documents/page.hpp"

#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace grainsweep::tests {

namespace fs = std::filesystem;

namespace {

std::vector<Page> pages_under(const std::vector<fs::path>& roots) {
    std::vector<fs::path> files;
    for (const auto& root : roots) {
        if (fs::is_regular_file(tests::source() / root)) files.push_back(root);
        if (!fs::is_directory(tests::source() / root)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(tests::source() / root))
            if (entry.path().extension() == ".md") files.push_back(fs::relative(entry.path(), tests::source()));
    }
    std::ranges::sort(files);
    std::vector<Page> pages;
    for (const auto& file : files) pages.push_back(read_page(file));
    return pages;
}

bool is_fence(const std::string& line) {
    return line.starts_with("```");
}

/// As GitHub makes them: lower case, letters, digits, - and _; spaces become -.
std::string anchor_of(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 || c == '-' || c == '_') anchor += static_cast<char>(std::tolower(byte));
        if (c == ' ') anchor += '-';
    }
    return anchor;
}

}  // namespace

fs::path Page::path() const {
    return tests::source() / file;
}

std::vector<std::pair<std::size_t, std::string>> Page::prose() const {
    std::vector<std::pair<std::size_t, std::string>> lines;
    std::istringstream stream(text);
    bool inside = false;
    std::size_t number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        if (is_fence(line)) {
            inside = !inside;
        } else if (!inside) {
            lines.emplace_back(number, line);
        }
    }
    return lines;
}

std::vector<std::string> Page::code_spans() const {
    static const std::regex span("`([^`]+)`");
    std::string whole;
    for (const auto& [number, line] : prose()) whole += line + '\n';
    std::vector<std::string> spans;
    for (std::sregex_iterator it(whole.begin(), whole.end(), span), end; it != end; ++it) spans.push_back((*it)[1]);
    return spans;
}

std::vector<std::string> Page::anchors() const {
    static const std::regex heading("^#+ +(.*)$");
    std::vector<std::string> anchors;
    for (const auto& [number, line] : prose()) {
        std::smatch match;
        if (std::regex_match(line, match, heading)) anchors.push_back(anchor_of(match[1]));
    }
    return anchors;
}

void PrintTo(const Page& page, std::ostream* stream) {
    *stream << page.file;
}

Page read_page(const fs::path& file) {
    Page page{file, {}, {}};
    std::ifstream stream(tests::source() / file, std::ios::binary);
    page.text.assign(std::istreambuf_iterator<char>(stream), {});
    std::istringstream lines(page.text);
    Block* open = nullptr;
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (!is_fence(line)) {
            if (open != nullptr) open->text += line + '\n';
        } else if (open != nullptr) {
            open = nullptr;
        } else {
            std::istringstream words(line.substr(3));
            open = &page.blocks.emplace_back();
            open->line = number;
            words >> open->language >> open->what;
        }
    }
    EXPECT_EQ(open, nullptr) << file << " ends inside a fenced block";
    return page;
}

std::vector<Page> user_pages() {
    return pages_under({"README.md", "docs"});
}

std::vector<Page> all_pages() {
    return pages_under({"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs", "stats", "solver", "sweep", "configs",
                        "results_schema", "tests"});
}

std::string answer_of(const std::vector<std::string>& arguments) {
    const Folder folder;
    const auto ended = run_program(arguments, folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.out;
}

std::vector<std::string> command_names() {
    static const std::regex entry("^  ([a-z]+)  .*$");
    std::istringstream help(answer_of({"--help"}));
    std::vector<std::string> names;
    bool listed = false;
    for (std::string line; std::getline(help, line);) {
        listed = listed || line.starts_with("Subcommands:");
        std::smatch match;
        if (listed && std::regex_match(line, match, entry)) names.push_back(match[1]);
    }
    EXPECT_GE(names.size(), 10U) << help.str();
    return names;
}

std::vector<std::string> options_of(const std::string& command) {
    static const std::regex entry("^  (-[^ ]*)");
    static const std::regex name("-{1,2}[A-Za-z][A-Za-z-]*");
    std::istringstream help(
        answer_of(command.empty() ? std::vector<std::string>{"--help"} : std::vector<std::string>{command, "--help"}));
    std::vector<std::string> options;
    for (std::string line; std::getline(help, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, entry)) continue;
        const std::string names = match[1];
        for (std::sregex_iterator it(names.begin(), names.end(), name), end; it != end; ++it)
            options.push_back(it->str());
    }
    return options;
}

}  // namespace grainsweep::tests
