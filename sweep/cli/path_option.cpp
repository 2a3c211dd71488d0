#include "sweep/cli/path_option.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/wrong_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace grainsweep::cli {

void declare_path(Parser& parser, std::string& word, std::string_view otherwise) {
    parser.add_option(
        "--path WORD", word,
        fmt::format("instruction set of the particle loops: baseline, avx2 or avx512; default: {}", otherwise));
}

void use_path(const std::string& word) {
    if (word.empty()) return;
    const auto words = instruction_path_words();
    if (std::ranges::find(words, word) == words.end()) {
        const std::vector<std::string> known(words.begin(), words.end());
        throw campaign::wrong_question("--path", word, "must be 'baseline', 'avx2' or 'avx512'",
                                       campaign::nearest_word(word, known));
    }
    if (!choose_instruction_path(word))
        throw campaign::wrong_question(
            "--path", word,
            fmt::format("this processor lacks these instructions; its widest set is {}", instruction_path()));
}

void use_path_of_old(std::string_view path) {
    const std::string_view word = path == "x86-64-v2" ? "baseline" : path;
    if (std::ranges::find(instruction_path_words(), word) != instruction_path_words().end())
        (void)choose_instruction_path(word);  // a processor without it keeps its widest; the comparison says so
}

}  // namespace grainsweep::cli
