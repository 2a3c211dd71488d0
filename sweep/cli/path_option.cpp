#include "sweep/cli/path_option.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/wrong_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace grainsweep::cli {

void declare_path(CLI::App& parser, std::string& word) {
    parser
        .add_option("--path", word,
                    "instruction set of the particle loops: baseline, avx2 or avx512; default: the widest there is")
        ->type_name("WORD");
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
            fmt::format("this processor lacks these instructions; the widest it has are {}", instruction_path()));
}

}  // namespace grainsweep::cli
