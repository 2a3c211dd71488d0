// completion, manual: texts for bash, zsh and man(1), generated from the table of commands, the scenes, the designs and
// the keys of a campaign file.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/keys.hpp"
#include "sweep/campaign/powder_export.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/program_keys.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/designs/design.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/catalogues.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

// ---- manual page

using Entry = std::pair<std::string_view, std::string_view>;
using TroffEscape = std::pair<char, std::string_view>;

constexpr TroffEscape troff_escapes[] = {{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"},
                                         {'^', "\\(ha"}, {'~', "\\(ti"}, {'`', "\\(ga"}};

/// Text as troff reads it: no character of it is a request, a dash is one that can be copied.
std::string plain(std::string_view text) {
    std::string out;
    bool line_start = true;
    for (const char c : text) {
        if (line_start && (c == '.' || c == '\'')) out += "\\&";
        line_start = c == '\n';
        const auto escape = std::ranges::find(troff_escapes, c, &TroffEscape::first);
        out += escape == std::end(troff_escapes) ? std::string_view(&c, 1) : escape->second;
    }
    return out;
}

std::string bold(std::string_view text) {
    return "\\fB" + plain(text) + "\\fR";
}
std::string italic(std::string_view text) {
    return "\\fI" + plain(text) + "\\fR";
}

std::string section(std::string_view title) {
    return fmt::format(".SH {}\n", title);
}
/// A tagged paragraph; both are troff already.
std::string item(const std::string& tag, const std::string& text) {
    return ".TP\n" + tag + "\n" + text + "\n";
}
std::string example(std::string_view lines) {
    return ".nf\n.RS\n" + plain(lines) + "\n.RE\n.fi\n";
}

std::string tag_of(const ArgumentInfo& argument) {
    if (!argument.place.empty()) return italic(argument.place);
    std::string tag;
    for (const auto& name : argument.names) tag += (tag.empty() ? "" : ", ") + bold(name);
    return argument.value.empty() ? tag : tag + " " + italic(argument.value);
}

std::string usage_of(const CommandInfo& command) {
    std::string usage = bold(command.name);
    for (const auto& argument : command.arguments) {
        if (argument.place.empty()) continue;
        usage += argument.required ? " " + italic(argument.place) : " [" + italic(argument.place) + "]";
    }
    return usage + " [" + italic("options") + "]";
}

bool everywhere(const ArgumentInfo& argument) {
    const auto& names = argument.names;
    return !names.empty() && (names.back() == "--help" || names.back() == "--format" || names.back() == "--wide");
}

std::string commands_section(std::span<const CommandInfo> commands) {
    std::string text = section("COMMANDS");
    for (const auto& command : commands) {
        text += fmt::format(".SS {}\n{}.\n", usage_of(command), plain(command.summary));
        for (const auto& argument : command.arguments)
            if (!everywhere(argument)) text += item(tag_of(argument), plain(argument.help) + ".");
    }
    text += ".SS Options of every command\n";
    for (const auto& argument : commands.front().arguments)
        if (everywhere(argument)) text += item(tag_of(argument), plain(argument.help) + ".");
    return text;
}

std::string keys_section() {
    std::string text = section("CAMPAIGN FILE");
    text += plain(
                "One JSON object, in SI units where a number has no unit. Any object may have \"notes\", a text or a "
                "list of texts. grainsweep schema "
                "prints the JSON Schema.") +
            "\n";
    const auto add = [&text](std::string_view title, std::span<const Field> keys) {
        text += fmt::format(".SS {}\n", title);
        for (const auto& key : keys) {
            std::string meaning(key.meaning);
            if (key.required) meaning += " (required)";
            if (!key.standard.empty()) meaning += fmt::format(" (default {})", key.standard);
            text += item(bold(std::string(key.name)), plain(meaning) + ".");
        }
    };
    add("The campaign", campaign::campaign_keys);
    add("A factor", campaign::factor_keys);
    add("Convergence", campaign::convergence_keys);
    add("A calibration", campaign::calibration_keys);
    add("An experiment of a calibration", campaign::experiment_keys);
    add("A target of a calibration", campaign::target_keys);
    add("Runs without a value of a target", campaign::without_value_keys);
    add("Program", campaign::program_keys);
    add("Limits", campaign::limits_keys);
    add("Execution", campaign::execution_keys);
    return text;
}

std::string catalogue_sections() {
    std::string text = section("SCENES");
    for (const auto& scene : campaign::named_scenes()) text += item(bold(scene->shown()), plain(scene->summary) + ".");
    text += item(bold(std::string(campaign::program_word)), plain(std::string(campaign::program_summary()) + "."));
    text += section("DESIGNS");
    for (const auto& design : designs::design_catalogue()) text += item(bold(design.name), plain(design.summary));
    return text;
}

std::string entries_section(std::string_view title, std::span<const Entry> entries) {
    std::string text = section(title);
    for (const auto& [tag, meaning] : entries) text += item(bold(tag), plain(meaning));
    return text;
}

constexpr Entry exit_codes[] = {
    {"0", "Success. run: every case is completed or skipped, or the campaign converged."},
    {"1",
     "run: finished, but cases failed or are left. solve, replay: no result, or a different one. converge --check: "
     "not converged."},
    {"2", "Invalid arguments or campaign file. Nothing was written."},
    {"3", "The disk is full, or the database is damaged or in use. Stored results are intact."},
    {"75", "Out of time, or ended by TERM or USR1. Run again to resume."},
    {"130", "Interrupted by Ctrl-C. Run again to resume."},
};

constexpr Entry variables[] = {{"COLUMNS", "Width of text where standard output is not a terminal."}};

constexpr Entry working_files[] = {
    {"NAME.db",
     "The database of campaign NAME, in SQLite's format: one file after every command. While a run "
     "writes it, NAME.db-wal and NAME.db-shm belong to it."},
    {"NAME.artefacts",
     "Folder beside the database with shared starting states and checkpoints. It may be removed while no "
     "run is active."},
    {"NAME.html", "The page that report writes."},
};

constexpr Entry functions_of_query[] = {
    {"sd(x), stddev_pop(x), var_pop(x)", "Standard deviation and variance, dividing by N."},
    {"stddev(x), stddev_samp(x), variance(x), var_samp(x)", "The same, dividing by N - 1."},
    {"median(x), quantile(x, p), percentile(x, P)", "p from 0 to 1, P from 0 to 100; linear between values."},
    {"above(x, t), below(x, t)", "Share of the values beyond t."},
    {"quantile_error(x, p, sequence), above_error(x, t, sequence), below_error(x, t, sequence)",
     "95 % half-widths of these, over the independent sequences of the design; a view of a campaign has the column "
     "sequence. NULL: too few values."},
    {"corr(x, y), covar_pop(x, y), covar_samp(x, y)", "Pearson's correlation, covariances."},
    {"pearson_skewness(x), g1(x), kurtosis(x)",
     "3 (mean - median) / sd, the moment skewness, the kurtosis (3 for a "
     "normal distribution)."},
};

/// Returns grainsweep.1 in the man macros of troff.
std::string manual_page(std::span<const CommandInfo> commands) {
    std::string text = fmt::format(".TH GRAINSWEEP 1 \"\" \"grainsweep {}\" \"User Commands\"\n.ad l\n.nh\n",
                                   plain(program_version()));
    text += section("NAME") + "grainsweep \\- parameter sweeps of granular processes\n";
    text += section("SYNOPSIS");
    for (const auto& command : commands)
        text += (&command == &commands.front() ? "" : ".br\n") + bold("grainsweep") + " " + usage_of(command) + "\n";
    text += section("DESCRIPTION");
    text +=
        "Describe a granular process, its factors and a design in one JSON file. grainsweep generates the points, runs "
        "every case in worker processes and stores the results in one SQLite database. Statistics, sensitivities and "
        "reports are computed from the database. Run a campaign again to resume it.\n";
    text += commands_section(commands);
    text += keys_section();
    text += catalogue_sections();
    text += entries_section("FUNCTIONS OF QUERY", functions_of_query);
    text += section("OUTPUT");
    text += plain(
                "Text is wrapped to the terminal, else to COLUMNS, else to 100 columns. Columns that do not fit are "
                "named below the table; --wide shows all of them. Numbers in csv and json read back as the same "
                "double. Whole numbers beyond 2^53, such as seeds, are text: \"5577006791947779410\" in json, "
                "5_577_006_791_947_779_410 in csv; --seed reads both.") +
            "\n";
    text += entries_section("EXIT STATUS", exit_codes);
    text += entries_section("ENVIRONMENT", variables);
    text += entries_section("FILES", working_files);
    text += section("EXAMPLES");
    text += example(
        "grainsweep plan configs/quickstart.json\ngrainsweep run configs/quickstart.json\n"
        "grainsweep query quickstart.db \"SELECT avg(mfr), stddev(mfr) FROM quickstart\"\n"
        "grainsweep report quickstart.db");
    text += section("SEE ALSO") + ".BR sqlite3 (1)\n";
    return text;
}

// ---- completion

/// Possible values: words, files with one of these endings, folders, or the answer of a database on the command line.
struct Values {
    std::vector<std::string> words = {};
    std::string ending = {};
    bool folder = false;
    std::string sql = {};  ///< query for one column of words; @ is replaced by the text typed so far
};

std::vector<std::string> design_names() {
    std::vector<std::string> names;
    for (const auto& design : designs::design_catalogue()) names.push_back(design.name);
    return names;
}

/// "friction=" and so on, every parameter of every scene once.
std::vector<std::string> settings() {
    std::set<std::string> names;
    for (const auto& scene : campaign::named_scenes())
        for (const auto& parameter : scene->parameters) names.insert(parameter.name + "=");
    return {names.begin(), names.end()};
}

std::vector<std::string> outcome_words() {
    std::vector<std::string> words;
    for (const auto outcome : campaign::outcomes) words.emplace_back(to_string(outcome));
    return words;
}

/// Values by "COMMAND OPTION", by an option's name, by "COMMAND PLACE", or by a place. Other values are not completed.
struct Rule {
    std::string argument;
    Values values;
};

const std::vector<Rule>& rules() {
    static const std::vector<Rule> table = {
        {"CONFIG", {.ending = ".json"}},
        {"DB", {.ending = ".db"}},
        {"--db", {.ending = ".db"}},
        {"--with", {.ending = ".db"}},
        {"powder --output", {.ending = ".csv"}},
        {"powder ACTION", {.words = {"import", "show"}}},
        {"powder --as", {.words = {campaign::export_as.begin(), campaign::export_as.end()}}},
        {"powder --by", {.words = {campaign::export_by.begin(), campaign::export_by.end()}}},
        {"powder --edge", {.words = {campaign::export_edges.begin(), campaign::export_edges.end()}}},
        {"--output", {.ending = ".html"}},
        {"--watch", {.ending = ".html"}},
        {"--points", {.ending = ".csv"}},
        {"--vtk", {.folder = true}},
        {"--artefacts", {.folder = true}},
        {"--format", {.words = {"text", "csv", "json"}}},
        {"figure --output", {.ending = ".pdf"}},
        {"query --format", {.words = {"text", "csv", "json", "xlsx"}}},
        {"query --output", {.ending = ".xlsx"}},
        {"--path", {.words = {instruction_path_words().begin(), instruction_path_words().end()}}},
        {"--again", {.words = outcome_words()}},
        {"--set", {.words = settings()}},
        {"scenes NAME", {.words = campaign::scene_words()}},
        {"designs NAME", {.words = design_names()}},
        {"completion SHELL", {.words = {"bash", "zsh"}}},
        {"--campaign", {.sql = "SELECT name FROM campaign LIMIT 256"}},
        {"--observable", {.sql = "SELECT DISTINCT name FROM observable WHERE shape = 'scalar' LIMIT 256"}},
        {"CASE", {.sql = "SELECT case_id FROM sim_case WHERE case_id GLOB '@*' LIMIT 64"}},
    };
    return table;
}

const Values* values_of(const CommandInfo& command, const ArgumentInfo& argument) {
    const auto found = [](const std::string& name) -> const Values* {
        const auto rule = std::ranges::find(rules(), name, &Rule::argument);
        return rule == rules().end() ? nullptr : &rule->values;
    };
    for (const auto& name : argument.names) {
        if (const auto* values = found(command.name + " " + name)) return values;
        if (const auto* values = found(name)) return values;
    }
    if (argument.place.empty()) return nullptr;
    if (const auto* values = found(command.name + " " + argument.place)) return values;
    return found(argument.place);
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
    return fmt::format("{}", fmt::join(words, between));
}

/// A word of the shell, whatever it holds.
std::string in_quotes(std::string_view text) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string(R"('\'')") : std::string(1, c);
    return quoted + "'";
}

// ---- bash

std::string bash_action(const Values* values) {
    if (values == nullptr) return "return 0";
    if (!values->words.empty()) return "_grainsweep_words " + in_quotes(joined(values->words, " "));
    if (!values->ending.empty()) return "_grainsweep_files " + in_quotes(values->ending);
    if (values->folder) return "_grainsweep_files /";
    return "_grainsweep_ask " + in_quotes(values->sql);
}

constexpr std::string_view bash_head =
    R"sh(# Completion of grainsweep for bash; printed by `grainsweep completion bash`.

# Of the words, which white space separates, those that begin so. They are compared and never expanded, as `compgen -W`
# would; what is no plain word is left out, because it would be expanded where the command is entered.
_grainsweep_words() {
    local word
    while IFS= read -r word; do
        [[ $word == "$cur"* && $word != *[!A-Za-z0-9_=-]* ]] && COMPREPLY+=("$word")
    done <<< "${1//[[:space:]]/$'\n'}"
    [[ ${COMPREPLY[0]} == *= ]] && compopt -o nospace 2>/dev/null
    return 0
}

# Files that end so, and folders on the way to them; "/": folders only.
_grainsweep_files() {
    local name
    compopt -o filenames 2>/dev/null
    while read -r name; do COMPREPLY+=("$name"); done < <(compgen -d -- "$cur")
    [[ $1 == / ]] && return 0
    while read -r name; do [[ -d $name ]] || COMPREPLY+=("$name"); done < <(compgen -f -X "!*$1" -- "$cur")
}

# The words a database answers: of the first argument behind the command that is a file.
_grainsweep_ask() {
    local word database=
    [[ $cur == *[!A-Za-z0-9_]* ]] && return 0
    for word in "${COMP_WORDS[@]:2}"; do
        [[ -f $word ]] && { database=$word; break; }
    done
    [[ -n $database ]] || return 0
    _grainsweep_words "$("${COMP_WORDS[0]}" query "$database" "${1//@/$cur}" --format csv --limit-seconds 2 2>/dev/null |
        tail -n +2)"
}

_grainsweep() {
    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]}
    local options valued place=0 k
    COMPREPLY=()
)sh";

std::string bash_command(const CommandInfo& command) {
    std::vector<std::string> options, valued;
    std::string by_option, by_place;
    int place = 0;
    for (const auto& argument : command.arguments) {
        options.insert(options.end(), argument.names.begin(), argument.names.end());
        if (!argument.place.empty()) {
            by_place += fmt::format("                {}) {} ;;\n", place++, bash_action(values_of(command, argument)));
        } else if (!argument.value.empty()) {
            valued.insert(valued.end(), argument.names.begin(), argument.names.end());
            by_option += fmt::format("                {}) {}; return 0 ;;\n", joined(argument.names, "|"),
                                     bash_action(values_of(command, argument)));
        }
    }
    std::string text = fmt::format("        {})\n            options={}\n            valued={}\n", command.name,
                                   in_quotes(joined(options, " ")), in_quotes(" " + joined(valued, " ") + " "));
    text += "            case $prev in\n" + by_option + "            esac\n";
    text += "            _grainsweep_place\n            case $place in\n" + by_place + "            esac ;;\n";
    return text;
}

constexpr std::string_view bash_place = R"sh(
# Which argument without a dash stands here, from 0; -1: an option is being typed. Reads and sets the caller's variables.
_grainsweep_place() {
    place=0
    if [[ $cur == -* ]]; then
        place=-1
        _grainsweep_words "$options"
        return 0
    fi
    for ((k = 2; k < COMP_CWORD; ++k)); do
        if [[ ${COMP_WORDS[k]} == -* ]]; then
            [[ $valued == *" ${COMP_WORDS[k]} "* ]] && ((++k))
        else
            ((++place))
        fi
    done
    return 0
}

complete -F _grainsweep grainsweep
)sh";

// ---- zsh

/// In a specification of _arguments these characters have a meaning.
std::string escaped(std::string_view text, std::string_view special) {
    std::string out;
    for (const char c : text) {
        if (special.find(c) != std::string_view::npos) out += '\\';
        out += c;
    }
    return out;
}

std::string zsh_action(const Values* values) {
    if (values == nullptr) return " ";
    if (!values->words.empty()) return "(" + escaped(joined(values->words, " "), ":") + ")";
    if (!values->ending.empty()) return fmt::format("_files -g \"*{}\"", values->ending);
    if (values->folder) return "_files -/";
    return fmt::format("{{_grainsweep_ask \"{}\"}}", escaped(values->sql, ":\""));
}

std::string zsh_command(const CommandInfo& command) {
    std::string text = fmt::format("        {})\n            _arguments", command.name);
    for (const auto& argument : command.arguments) {
        const auto help = escaped(argument.help, "[]:");
        std::string value;
        if (!argument.value.empty() && argument.place.empty())
            value = fmt::format(":{}:{}", escaped(argument.value, ":"), zsh_action(values_of(command, argument)));
        if (!argument.place.empty()) {
            text += " \\\n                " +
                    in_quotes(fmt::format("{}{}:{}", argument.required ? ":" : "::", argument.place,
                                          zsh_action(values_of(command, argument))));
        }
        for (const auto& name : argument.names) {
            // The names of one option exclude each other.
            const std::string others = argument.repeated ? "*" : "(" + joined(argument.names, " ") + ")";
            text += " \\\n                " + in_quotes(others + name + "[" + help + "]" + value);
        }
    }
    return text + " ;;\n";
}

constexpr std::string_view zsh_head = R"sh(#compdef grainsweep
# Completion of grainsweep for zsh; printed by `grainsweep completion zsh`.

# The words a database answers: of the first argument behind the command that is a file.
_grainsweep_ask() {
    local word database typed=$PREFIX
    local -a answers
    [[ $typed == *[^A-Za-z0-9_]* ]] && return 1
    for word in $words[2,-1]; do
        [[ -f $word ]] && { database=$word; break; }
    done
    [[ -n $database ]] || return 1
    answers=(${(f)"$(grainsweep query $database "${1//@/$typed}" --format csv --limit-seconds 2 2>/dev/null | tail -n +2)"})
    answers=(${answers:#*[^A-Za-z0-9_]*})  # what is no plain word is left out
    compadd -a answers
}

_grainsweep() {
    local curcontext=$curcontext
    local -a commands
)sh";

constexpr std::string_view zsh_tail = R"sh(    esac
}

if [[ $funcstack[1] == _grainsweep ]]; then
    _grainsweep "$@"
else
    compdef _grainsweep grainsweep
fi
)sh";

/// Returns a script to be sourced, or to be installed as share/bash-completion/completions/grainsweep.
std::string bash_completion(std::span<const CommandInfo> commands) {
    std::vector<std::string> names;
    std::string cases;
    for (const auto& command : commands) {
        names.push_back(command.name);
        cases += bash_command(command);
    }
    return fmt::format(
        "{}    if ((COMP_CWORD == 1)); then\n        _grainsweep_words {}\n        return 0\n    fi\n"
        "    case $command in\n{}    esac\n    return 0\n}}\n{}",
        bash_head, in_quotes(joined(names, " ") + " --help --version"), cases, bash_place);
}

/// Returns a function to be installed as _grainsweep in a folder of fpath, or to be sourced.
std::string zsh_completion(std::span<const CommandInfo> commands) {
    std::string list, cases;
    for (const auto& command : commands) {
        list += "        " + in_quotes(escaped(command.name, ":") + ":" + command.summary) + "\n";
        cases += zsh_command(command);
    }
    return fmt::format(
        "{}    commands=(\n{}    )\n    if ((CURRENT == 2)); then\n        _describe command commands\n        return\n"
        "    fi\n    shift words\n    ((CURRENT--))\n    case $words[1] in\n{}{}",
        zsh_head, list, cases, zsh_tail);
}

// ---- commands

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
    throw campaign::input_error("SHELL", name, "must be 'bash' or 'zsh'", campaign::nearest_word(name, known));
}

/// Text as it is; as one value where a program asks for one.
int print(std::span<const Field> column, const std::string& text, report::Format format) {
    if (format == report::Format::text)
        std::cout << text;
    else
        report::write(std::cout, store::Table{report::columns_of(column), {{text}}}, format);
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
                return print(report::results::completion, completion_for(shell), format);
            })),
        verbatim(command<Nothing>(
            "manual", "prints the manual page for man(1)", [](Parser&, Nothing) {},
            [](Nothing, report::Format format) {
                return print(report::results::manual, manual_page(describe(all_commands())), format);
            })),
    };
}

}  // namespace grainsweep::cli
