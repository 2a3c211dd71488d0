#include "sweep/campaign/program_keys.hpp"

#include <limits>

namespace grainsweep::campaign {
namespace {

using KeyKind = Key::Kind;

constexpr Interval positive{0, std::numeric_limits<double>::infinity(), true, true};

Key text_key(std::string name, std::string meaning, bool required = false) {
    return {std::move(name), std::move(meaning), KeyKind::text, required, {}, {}, {}};
}

}  // namespace

std::span<const Key> program_keys() {
    static const std::vector<Key> keys = {
        {"command",
         "the program and its arguments, no shell: {name} is replaced by the value of a factor or fixed value, {seed}, "
         "{seed31} (1 to 2^31 - 2), {case}, {threads}; {{name}} stays as {name}",
         KeyKind::words,
         true,
         {},
         {},
         {}},
        {"files",
         "files beside the campaign file that are copied into the folder of every case, under the same names; their "
         "contents are part of the case's identity",
         KeyKind::words,
         false,
         {},
         {},
         "[]"},
        {"templates",
         "the same, text files in which {{ name }} is replaced as in the command",
         KeyKind::words,
         false,
         {},
         {},
         "[]"},
        {"parameters",
         "of factors and fixed values: unit, bounds, meaning, whole",
         KeyKind::object,
         false,
         {},
         {},
         "{}"},
        {"observables",
         "what a case measures, by name, and where its value is found",
         KeyKind::object,
         false,
         {},
         {},
         "{}"},
        {"version", "a command that says which version of the program it is", KeyKind::object, false, {}, {}, {}},
        {"protocol",
         "files: the command runs once per case, its question in inputs.json; lines: the program stays alive and "
         "answers "
         "a line of JSON by a line of JSON",
         KeyKind::word,
         false,
         {},
         {"files", "lines"},
         "\"files\""},
        {"environment",
         "variables set for the program; {threads} and the names of the command are replaced",
         KeyKind::object,
         false,
         {},
         {},
         "{}"},
        {"cores", "processors that a case uses; {threads}", KeyKind::whole, false, {1, 4096}, {}, "1"},
        text_key("memory",
                 "address space that each process of a case may take, \"4 GB\"; B, kB, MB, GB, TB, KiB, MiB, GiB, TiB; "
                 "without it no limit"),
        {"disk", "what a case may write into its folder", KeyKind::text, false, {}, {}, "\"1 GB\""},
        {"keep",
         "which folders of cases stay beside the database: those of cases that brought no answer (at most 100), all, "
         "none",
         KeyKind::word,
         false,
         {},
         {"failed", "all", "none"},
         "\"failed\""},
        {"cost_seconds",
         "about how long a case takes on a core, s: for predictions and the order of cases; default: 1, with lines "
         "0.001",
         KeyKind::number,
         false,
         positive,
         {},
         {}},
        {"tolerance",
         "relative difference up to which a repeated case agrees (replay)",
         KeyKind::number,
         false,
         {0, 1},
         {},
         "0"},
    };
    return keys;
}

std::span<const Key> program_parameter_keys() {
    static const std::vector<Key> keys = {
        text_key("unit", "of its values"),
        {"bounds",
         "of a number [low, high], null: open; of a word the list of what it may be",
         KeyKind::array,
         false,
         {},
         {},
         {}},
        text_key("meaning", "in words"),
        {"whole",
         "true: a number of whole things; it is varied by \"levels\", and another number is refused",
         KeyKind::flag,
         false,
         {},
         {},
         "false"},
    };
    return keys;
}

std::span<const Key> program_observable_keys() {
    static const std::vector<Key> keys = {
        text_key("unit", "of its values"),
        text_key("meaning", "in words"),
        {"shape",
         "scalar, or values over a coordinate (profile) or over time (series); default: scalar, with \"over\" profile",
         KeyKind::word,
         false,
         {},
         {"scalar", "series", "profile"},
         {}},
        {"bounds",
         "[low, high], null: open; a case with a value outside is rejected",
         KeyKind::array,
         false,
         {},
         {},
         {}},
        {"from", "where its value is found; needed with files, absent with lines", KeyKind::object, false, {}, {}, {}},
    };
    return keys;
}

std::span<const Key> program_from_keys() {
    static const std::vector<Key> keys = {
        text_key("json", "a JSON file that the program writes"),
        text_key("path",
                 "of json: JSON pointer (RFC 6901) of a number, or of a list of numbers where there is an over"),
        text_key("csv", "a table that the program writes, its first line the names of the columns"),
        text_key("column", "of csv: the column of the value"),
        {"row",
         "of csv: \"last\", \"first\" or a number from 0, negative from the end; default: last",
         KeyKind::value,
         false,
         {},
         {},
         {}},
        text_key("over", "of csv the column, of json the pointer of the coordinates: all rows are read"),
        {"separator",
         "of csv: what stands between columns",
         KeyKind::word,
         false,
         {},
         {"comma", "semicolon", "tab", "blank"},
         {}},
        text_key(
            "output",
            "a regular expression (ECMAScript, no back-references) whose first group is the value, in the last line of standard output "
            "that has it"),
    };
    return keys;
}

std::span<const Key> program_version_keys() {
    static const std::vector<Key> keys = {
        {"command", "the program and its arguments", KeyKind::words, true, {}, {}, {}},
        text_key("match", "regular expression (ECMAScript, no back-references) whose first group in what it writes is the version", true),
    };
    return keys;
}

}  // namespace grainsweep::campaign
