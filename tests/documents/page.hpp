// The documents as the tests read them: README.md and every page under docs/.
//
// Fenced blocks say by the words behind the three backticks what a test does with them; a reader sees only the first:
//   sh            run with bash, stopping at the first failure, in a new folder per page that holds configs/,
//                 build/grainsweep and bootstrap.sh as a clone does; grainsweep is on the search path
//   sh long       too long to run: the commands, options and campaign files it names must exist, `run` is planned
//   sql FILE      one statement, asked of that database with `grainsweep query`; it must return rows
//   json FILE     written to the folder under that name
//   json FILE+    a JSON merge patch of that file, as an earlier block of the page wrote it
//   json part     keys that replace those of the page's first campaign file; the result must pass `plan`
//   json          must be JSON
//   python, r     run where the interpreter and its libraries are installed, else only parsed, where it is installed
//   text          what a program prints, or a sketch: left alone
// Blocks of a page run in their order and share its folder. Other words fail.
//
// A table between `<!-- table: WHAT -->` and `<!-- end -->` is generated (tables.cpp).
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests {

struct Block {
    std::string language;
    std::string what;      ///< the second word behind the backticks, may be empty
    std::string text;      ///< without the fences
    std::size_t line = 0;  ///< of the opening fence, from 1
};

struct Page {
    std::filesystem::path file;  ///< relative to the repository
    std::string text;
    std::vector<Block> blocks;

    [[nodiscard]] std::filesystem::path path() const;  ///< absolute
    /// Lines outside of fenced blocks, with their number from 1.
    [[nodiscard]] std::vector<std::pair<std::size_t, std::string>> prose() const;
    /// What stands between single backticks in the prose, in its order.
    [[nodiscard]] std::vector<std::string> code_spans() const;
    /// Headings as the anchors that links use.
    [[nodiscard]] std::vector<std::string> anchors() const;
};

/// What GoogleTest calls a page in its messages.
void PrintTo(const Page& page, std::ostream* stream);

[[nodiscard]] Page read_page(const std::filesystem::path& file);
/// README.md and docs/**/*.md, sorted.
[[nodiscard]] std::vector<Page> user_pages();
/// Every Markdown file of the repository, sorted.
[[nodiscard]] std::vector<Page> all_pages();

/// Standard output of the real executable; a failure of the test where it does not exit with 0.
[[nodiscard]] std::string answer_of(const std::vector<std::string>& arguments);
/// Names of the commands that `grainsweep --help` lists.
[[nodiscard]] std::vector<std::string> command_names();
/// Options that `grainsweep COMMAND --help` lists, with their dashes; an empty command: those of the program.
[[nodiscard]] std::vector<std::string> options_of(const std::string& command);

}  // namespace grainsweep::tests
