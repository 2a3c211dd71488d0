// The only file that includes CLI11.
#include "sweep/campaign/input_error.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/report/text_layout.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <iostream>
#include <memory>
#include <sstream>
#include <system_error>

namespace grainsweep::cli {
namespace {

/// Returns the complaint about a word; empty if it obeys the rule.
std::string complaint(const std::string& word, const WholeNumber& rule) {
    std::int64_t number = 0;
    const auto* end = word.data() + word.size();
    const auto read = std::from_chars(word.data(), end, number);
    if (read.ec == std::errc() && read.ptr == end && number >= rule.least && number <= rule.most) return {};
    const bool open = rule.most == std::numeric_limits<std::int64_t>::max();
    return fmt::format(
        "got '{}'; must be a whole number{}", word,
        open ? fmt::format(", {} or more", rule.least) : fmt::format(" from {} to {}", rule.least, rule.most));
}

/// Help in lines that fit the terminal.
class Help : public CLI::Formatter {
public:
    std::string make_option_desc(const CLI::Option* option) const override { return fitted(option->get_description()); }
    std::string make_subcommand(const CLI::App* command) const override {
        std::ostringstream text;
        CLI::detail::format_help(text, command->get_display_name(true), fitted(command->get_description()),
                                 get_column_width());
        return text.str();
    }

private:
    [[nodiscard]] std::string fitted(const std::string& description) const {
        constexpr std::size_t narrowest = 20;
        const std::size_t width = std::max(report::text_width(), get_column_width() + narrowest) - get_column_width();
        return fmt::format("{}", fmt::join(report::wrapped(description, width), "\n"));
    }
};

/// The commands as subcommands of `app`. The chosen one's action is in `chosen` after parsing.
void declare(CLI::App& app, const std::vector<Command>& commands, std::deque<Parser>& parsers, Action& chosen) {
    for (const auto& command : commands) {
        CLI::App* subcommand = app.add_subcommand(command.name, command.summary);
        if (command.hidden) subcommand->group("");
        if (!command.example.empty()) subcommand->footer("Example:\n  grainsweep " + command.example);
        auto format = std::make_shared<report::Format>(report::Format::text);
        subcommand
            ->add_option_function<std::string>(
                "--format", [format](const std::string& word) { *format = *report::format_named(word); },
                command.workbook ? "text, csv, json or xlsx" : "text, csv or json")
            ->check([workbook = command.workbook](const std::string& word) {
                const auto named = report::format_named(word);
                if (named && (workbook || *named != report::Format::xlsx)) return std::string();
                return fmt::format("must be {}, not '{}'",
                                   workbook ? "'text', 'csv', 'json' or 'xlsx'" : "'text', 'csv' or 'json'", word);
            })
            ->type_name("FORMAT");
        const auto wide = std::make_shared<bool>(false);
        if (!command.verbatim) subcommand->add_flag("--wide", *wide, "do not wrap text to the width of the terminal");
        parsers.emplace_back(*subcommand);
        subcommand->callback(
            [&chosen, format, wide, verbatim = command.verbatim, action = command.declare(parsers.back(), *format)] {
                chosen = [format, wide, verbatim, action] {  // the action refers to the format
                    if (verbatim || *format != report::Format::text) return action();
                    if (*wide) report::set_text_width(report::unlimited_width);
                    const report::WrappedOutput wrapped(std::cout, report::text_width());
                    return action();
                };
            });
    }
}

/// The first argument that is no option must name a command: else InputError with the nearest.
void check_command(const std::vector<Command>& commands, const char* const* argv) {
    const std::string word = argv[1];
    if (word.starts_with('-') || std::ranges::find(commands, word, &Command::name) != commands.end()) return;
    std::vector<std::string> names;
    for (const auto& command : commands) {
        if (!command.hidden) names.push_back(command.name);
    }
    throw campaign::input_error("", "", fmt::format("there is no command '{}'; grainsweep --help lists them", word),
                                campaign::nearest_word(word, names));
}

/// Returns a parse error as one sentence, with the nearest option if an option is unknown.
std::string sentence_of(const CLI::ParseError& error, const CLI::App& app) {
    std::vector<std::string> known;
    std::vector<std::string> extras = app.remaining(true);
    std::string command = "grainsweep";
    for (const auto* parser : app.get_subcommands()) {
        command = parser->get_name();
        for (const auto* option : parser->get_options()) {
            for (const auto& name : option->get_lnames()) known.push_back("--" + name);
            for (const auto& name : option->get_snames()) known.push_back("-" + name);
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

}  // namespace

Option* Option::required() {
    option_->required();
    return this;
}

Option* Option::check(WholeNumber rule) {
    option_->check([rule](const std::string& word) { return complaint(word, rule); });
    return this;
}

Option* Option::allow_extra_args(bool allowed) {
    option_->allow_extra_args(allowed);
    return this;
}

Option* Option::grouped_digits() {
    option_->transform([](std::string word) {
        std::erase(word, '_');
        return word;
    });
    return this;
}

Option* Option::capture_default_str() {
    option_->capture_default_str();
    return this;
}

template <class T>
Option* Parser::add_option(const std::string& names, T& into, const std::string& help) {
    const bool may_be_empty = names.starts_with('[');
    const auto space = names.find(' ');
    auto* option =
        app_->add_option(may_be_empty ? names.substr(1, names.size() - 2) : names.substr(0, space), into, help);
    if (space != std::string::npos) option->type_name(names.substr(space + 1));
    option->required(!may_be_empty && !names.starts_with('-'));
    return &options_.emplace_back(option);
}
template Option* Parser::add_option(const std::string&, std::string&, const std::string&);
template Option* Parser::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option* Parser::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option* Parser::add_option(const std::string&, double&, const std::string&);
template Option* Parser::add_option(const std::string&, std::int64_t&, const std::string&);
template Option* Parser::add_option(const std::string&, std::optional<std::int64_t>&, const std::string&);
template Option* Parser::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option* Parser::add_option(const std::string&, std::optional<std::uint64_t>&, const std::string&);

Option* Parser::add_flag(const std::string& names, bool& into, const std::string& help) {
    return &options_.emplace_back(app_->add_flag(names, into, help));
}

std::vector<CommandInfo> describe(const std::vector<Command>& commands) {
    CLI::App app;
    std::deque<Parser> parsers;
    Action chosen;
    declare(app, commands, parsers, chosen);
    std::vector<CommandInfo> infos;
    for (const auto& command : commands) {
        if (command.hidden) continue;
        auto& info = infos.emplace_back(CommandInfo{command.name, command.summary, {}});
        for (const auto* option : app.get_subcommand(command.name)->get_options()) {
            ArgumentInfo argument;
            for (const auto& name : option->get_snames()) argument.names.push_back("-" + name);
            for (const auto& name : option->get_lnames()) argument.names.push_back("--" + name);
            argument.place = option->get_positional() ? option->get_name(true, false) : "";
            argument.help = option->get_description();
            argument.required = option->get_required();
            argument.repeated = option->get_expected_max() > 1;
            const bool takes_value = option->get_items_expected_max() > 0;
            if (takes_value) argument.value = option->get_type_name().empty() ? "VALUE" : option->get_type_name();
            info.arguments.push_back(std::move(argument));
        }
    }
    return infos;
}

Action parse_command_line(const std::vector<Command>& commands, int argc, const char* const* argv) {
    CLI::App app("Parameter sweeps of granular processes, described in one JSON file.", "grainsweep");
    std::deque<Parser> parsers;
    Action chosen;
    try {
        app.formatter(std::make_shared<Help>());
        app.set_version_flag("--version", version_text, "print version, commit, compiler, flags and instruction path");
        app.require_subcommand(0, 1);
        declare(app, commands, parsers, chosen);
        app.footer("Example:\n  grainsweep run --help");
        if (argc < 2)
            return [help = app.help()] {
                std::cout << help;
                return 2;
            };
        check_command(commands, argv);
        app.parse(argc, argv);
        return chosen ? chosen : [] { return 0; };
    } catch (const CLI::Success& asked) {  // --help and --version
        const int code = app.exit(asked);
        return [code] { return code; };
    } catch (const CLI::ParseError& error) {
        throw campaign::InputError(sentence_of(error, app));
    }
}

}  // namespace grainsweep::cli
