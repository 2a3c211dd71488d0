#include "sweep/cli/compute_options.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/workers/job_cores.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace grainsweep::cli {

void declare_path(Parser& parser, std::string& word, std::string_view otherwise) {
    parser.add_option("--path WORD", word,
                      fmt::format("instruction set of the particle loops: {}; default: {}",
                                  fmt::join(instruction_path_words(), " or "), otherwise));
}

void use_path(const std::string& word) {
    if (word.empty()) return;
    const auto words = instruction_path_words();
    if (std::ranges::find(words, word) == words.end()) {
        const std::vector<std::string> known(words.begin(), words.end());
        throw campaign::input_error("--path", word, fmt::format("must be '{}'", fmt::join(known, "' or '")),
                                    campaign::nearest_word(word, known));
    }
    if (!choose_instruction_path(word))
        throw campaign::input_error(
            "--path", word,
            fmt::format("this processor lacks these instructions; its widest set is {}", instruction_path()));
}

void use_path_of_old(std::string_view path) {
    if (std::ranges::find(instruction_path_words(), path) != instruction_path_words().end())
        (void)choose_instruction_path(path);  // a processor without it keeps its widest; the comparison says so
}

void declare_threads(Parser& parser, std::int64_t& count) {
    parser
        .add_option("--threads N", count,
                    "threads for the case; 0, the default: one per core of the job; results do not depend on it")
        ->check(whole_number(0, 1024));
}

void use_threads(std::int64_t count) {
    allow_threads(static_cast<int>(count > 0 ? count : static_cast<std::int64_t>(workers::job_cores())));
}

}  // namespace grainsweep::cli
