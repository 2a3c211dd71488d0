#include "sweep/cli/command.hpp"

#include "sweep/campaign/wrong_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <string_view>
#include <system_error>

namespace grainsweep::cli {

CLI::Validator whole_number(std::int64_t least, std::int64_t most) {
    const bool open = most == std::numeric_limits<std::int64_t>::max();
    const std::string rule = open ? fmt::format("a whole number, {} or more", least)
                                  : fmt::format("a whole number from {} to {}", least, most);
    return {[=](const std::string& word) {
                std::int64_t number = 0;
                const auto* end = word.data() + word.size();
                const auto read = std::from_chars(word.data(), end, number);
                const bool good = read.ec == std::errc() && read.ptr == end && number >= least && number <= most;
                return good ? std::string() : fmt::format("got '{}'; must be {}", word, rule);
            },
            ""};
}

void declare(CLI::App& app, const std::vector<Command>& commands, Action& chosen) {
    for (const auto& command : commands) {
        CLI::App* parser = app.add_subcommand(command.name, command.summary);
        if (command.hidden) parser->group("");
        auto format = std::make_shared<report::Format>(report::Format::text);
        parser
            ->add_option_function<std::string>(
                "--format", [format](const std::string& word) { *format = *report::format_named(word); },
                "text, csv or json")
            ->check([](const std::string& word) {
                return report::format_named(word) ? std::string()
                                                  : "must be 'text', 'csv' or 'json', not '" + word + "'";
            })
            ->type_name("FORMAT");
        parser->callback([&chosen, format, action = command.declare(*parser, *format)] { chosen = action; });
    }
}

void check_command(const std::vector<Command>& commands, int argc, const char* const* argv) {
    if (argc < 2) throw campaign::WrongQuestion("name a command; grainsweep --help lists them.");
    const std::string word = argv[1];
    if (word.starts_with('-') || std::ranges::find(commands, word, &Command::name) != commands.end()) return;
    std::vector<std::string> names;
    for (const auto& command : commands) {
        if (!command.hidden) names.push_back(command.name);
    }
    throw campaign::wrong_question("", "", fmt::format("there is no command '{}'; grainsweep --help lists them", word),
                                   campaign::nearest_word(word, names));
}

std::string sentence_of(const CLI::ParseError& error, const CLI::App& app) {
    std::vector<std::string> known;
    std::vector<std::string> extras = app.remaining(true);
    std::string command = "grainsweep";
    for (const auto* parser : app.get_subcommands()) {
        command = parser->get_name();
        for (const auto* option : parser->get_options()) {
            for (const auto& name : option->get_lnames()) known.push_back("--" + name);
        }
    }
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !extras.empty()) {
        const auto option = std::ranges::find_if(extras, [](const auto& extra) { return extra.starts_with("-"); });
        if (option == extras.end())
            return fmt::format("{}: there is one argument too many: '{}'.", command, extras.front());
        const auto nearest = campaign::nearest_word(*option, known);
        return fmt::format("{} has no option '{}'.{}", command, *option,
                           nearest.empty() ? "" : fmt::format(" Did you mean '{}'?", nearest));
    }
    std::string sentence = error.what();
    std::ranges::replace(sentence, '\n', ' ');
    if (!sentence.ends_with('.')) sentence += '.';
    return sentence;
}

}  // namespace grainsweep::cli
