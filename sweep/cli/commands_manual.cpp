// completion, manual: texts for shells and for man(1), generated from the tables of commands.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/completion.hpp"
#include "sweep/cli/manual.hpp"

#include <array>
#include <iostream>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::cli {

namespace {

struct Shell {
    const char* name;
    std::string (*completion)(std::span<const CommandInfo>);
};
constexpr std::array shells = {Shell{"bash", bash_completion}, Shell{"zsh", zsh_completion}};

std::string completion_for(const std::string& name) {
    std::vector<std::string> known;
    for (const auto& shell : shells) {
        if (name == shell.name) return shell.completion(describe(all_commands()));
        known.emplace_back(shell.name);
    }
    throw campaign::wrong_question("SHELL", name, "must be 'bash' or 'zsh'", campaign::nearest_word(name, known));
}

/// Text as it is; as one value where a program asks for one.
int print(const std::string& column, const std::string& text, report::Format format) {
    if (format == report::Format::text)
        std::cout << text;
    else
        report::write(std::cout, store::Table{{column}, {{text}}}, format);
    return 0;
}

}  // namespace

std::vector<Command> manual_commands() {
    struct Nothing {};
    return {
        verbatim(command<std::string>(
            "completion", "prints a completion script for a shell",
            [](Parser& parser, std::string& shell) { parser.add_option("SHELL", shell, "bash or zsh"); },
            [](const std::string& shell, report::Format format) {
                return print("completion", completion_for(shell), format);
            })),
        verbatim(command<Nothing>(
            "manual", "prints the manual page for man(1)", [](Parser&, Nothing) {},
            [](Nothing, report::Format format) {
                return print("manual", manual_page(describe(all_commands())), format);
            })),
    };
}

}  // namespace grainsweep::cli
