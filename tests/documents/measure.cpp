// Prints the length of every page, its long sentences and its vague turns; only the length is a gate.
//   build/tests/test_documents --gtest_filter='Prose.*'
#include "tests/documents/page.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <iostream>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::measure_test {

constexpr std::size_t longest_sentence = 35;
constexpr std::size_t longest_page = 200;  ///< lines, without blocks and generated tables

/// A paragraph, a list item, a heading or a cell of a table, on one line; a code span or a link is its visible text.
struct Passage {
    std::size_t line = 0;
    std::string text;
};

struct Measure {
    std::size_t words = 0, lines = 0, warnings = 0;
};

std::vector<std::string> words_in(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
        if (word.find_first_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789`") != std::string::npos)
            words.push_back(word);
    return words;
}

/// Lines outside of fenced blocks and of generated tables.
std::vector<std::pair<std::size_t, std::string>> written_lines(const Page& page) {
    std::vector<std::pair<std::size_t, std::string>> lines;
    bool generated = false;
    for (const auto& [number, line] : page.prose()) {
        generated = generated || line.starts_with("<!-- table:");
        if (!generated) lines.emplace_back(number, line);
        if (line.starts_with("<!-- end")) generated = false;
    }
    return lines;
}

/// Of a code span the first word stays.
std::string without_marks(const std::string& text) {
    static const std::regex span("`([^` ]*)[^`]*`"), link(R"(!?\[([^\]]*)\]\([^)]*\))"), mark(R"(\*\*|<!--.*?-->)");
    return std::regex_replace(std::regex_replace(std::regex_replace(text, span, "$1"), link, "$1"), mark, "");
}

std::vector<Passage> passages_of(const Page& page) {
    static const std::regex starts_anew(R"(^(#+ |- |[0-9]+\. ).*)");
    std::vector<Passage> passages(1);
    for (const auto& [number, line] : written_lines(page)) {
        if (line.starts_with('|')) {
            std::istringstream cells(line);
            for (std::string cell; std::getline(cells, cell, '|');) passages.push_back({number, cell});
            passages.emplace_back();
        } else if (line.empty() || std::regex_match(line, starts_anew)) {
            passages.push_back({number, line});
            if (line.starts_with('#')) passages.emplace_back();
        } else {
            if (passages.back().text.empty()) passages.back().line = number;
            passages.back().text += ' ' + line;
        }
    }
    for (auto& passage : passages) passage.text = without_marks(passage.text);
    return passages;
}

std::vector<std::string> sentences_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> sentences(1);
    for (std::string word; stream >> word;) {
        sentences.back() += (sentences.back().empty() ? "" : " ") + word;
        if (std::string(".!?").find(word.back()) != std::string::npos) sentences.emplace_back();
    }
    return sentences;
}

std::size_t warn(const Page& page, const Passage& passage) {
    static const std::regex vague(
        R"(\b(what [^.]* is what|that of|those (that|of)|of which|is (said|told)|asks|knows|goes|has it|has to say|)"
        R"(as many as|so many|of (its|their) own accord)\b)");
    std::size_t warnings = 0;
    const auto print = [&](const std::string& what, const std::string& sentence) {
        std::cout << fmt::format("{}:{}: {}: {}\n", page.file.string(), passage.line, what, sentence.substr(0, 90));
        ++warnings;
    };
    for (const auto& sentence : sentences_of(passage.text)) {
        if (const auto count = words_in(sentence).size(); count > longest_sentence)
            print(fmt::format("{} words", count), sentence);
        std::smatch turn;
        if (std::regex_search(sentence, turn, vague)) print('"' + turn[0].str() + '"', sentence);
    }
    return warnings;
}

Measure measured(const Page& page) {
    Measure measure;
    measure.lines = written_lines(page).size();
    for (const auto& passage : passages_of(page)) {
        measure.words += words_in(passage.text).size();
        measure.warnings += warn(page, passage);
    }
    return measure;
}

TEST(Prose, IsMeasured) {
    std::string table = fmt::format("{:36} {:>6} {:>6} {:>9}\n", "page", "words", "lines", "warnings");
    const auto add = [&](const std::string& name, const Measure& measure) {
        table += fmt::format("{:36} {:6} {:6} {:9}\n", name, measure.words, measure.lines, measure.warnings);
    };
    Measure all;
    for (const auto& page : user_pages()) {
        const auto one = measured(page);
        add(page.file.string(), one);
        EXPECT_LE(one.lines, longest_page) << page.file << ": split it by the question that a reader has";
        all = {all.words + one.words, all.lines + one.lines, all.warnings + one.warnings};
    }
    add("all", all);
    std::cout << table;
    EXPECT_GT(all.words, 10'000U) << "pages are not read";
}

}  // namespace grainsweep::tests::measure_test
