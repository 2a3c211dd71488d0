#include "sweep/cli/completion.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/powder_export.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/designs/design.hpp"

#include "solver/scenes/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

namespace grainsweep::cli {

namespace {

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
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : std::string(between)) + word;
    return text;
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

}  // namespace

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

}  // namespace grainsweep::cli
