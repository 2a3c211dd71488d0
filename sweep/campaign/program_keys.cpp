#include "sweep/campaign/program_keys.hpp"

#include <array>
#include <limits>

namespace grainsweep::campaign {
namespace {

using KeyKind = Field::Kind;

constexpr Interval positive{0, std::numeric_limits<double>::infinity(), true, true};

constexpr std::array<std::string_view, 2> protocol_names = {"files", "lines"};
constexpr std::array<std::string_view, 3> keep_names = {"failed", "all", "none"};
constexpr std::array<std::string_view, 3> shape_names = {"scalar", "series", "profile"};
constexpr std::array<std::string_view, 4> separator_names = {"comma", "semicolon", "tab", "blank"};
}  // namespace

constexpr auto program_table = std::to_array<Field>({
    needed({"command", KeyKind::words,
            "the program and its arguments, no shell: {name} is replaced by the value of a factor or fixed "
            "value, {seed}, {seed31} (1 to 2^31 - 2), {seed_prime} (a prime of 31 bits), {case}, {threads}; "
            "{name:%.3e} in a format of C; {{name}} stays as {name}"}),
    {"files", KeyKind::words,
     "files beside the campaign file that are copied into the folder of every case, under the same names; their "
     "contents are part of the case's identity",
     "[]"},
    {"templates", KeyKind::words, "the same, text files in which {{ name }} is replaced as in the command", "[]"},
    {"does_not_count", KeyKind::words,
     "files and templates whose contents change no result, such as a read-me: they are no part of the identity", "[]"},
    {"parameters", KeyKind::object, "of factors and fixed values: unit, bounds, meaning, whole, default", "{}"},
    {"observables", KeyKind::object, "what a case measures, by name, and where its value is found", "{}"},
    {"version", KeyKind::object, "a command that says which version of the program it is"},
    {"protocol",
     KeyKind::word,
     "files: the command runs once per case, its question in inputs.json; lines: the program stays alive and "
     "answers a line of JSON by a line of JSON",
     "\"files\"",
     {},
     protocol_names},
    {"environment", KeyKind::object,
     "variables set for the program; {threads} and the names of the command are replaced", "{}"},
    {"cores", KeyKind::whole, "processors that a process of a case uses; {threads}", "1", {1, 4096}},
    {"processes",
     KeyKind::whole,
     "processes that the command of a case starts, such as the ranks of MPI; {processes}; a case uses processes "
     "times cores processors",
     "1",
     {1, 65536}},
    {"accuracy", KeyKind::object,
     "settings by name, each with values of parameters that decide error and cost, and about how long a case takes "
     "on a core (cost_seconds, s); \"reference\" names the one whose results are the standard"},
    {"memory", KeyKind::text,
     "address space that each process of a case may take, \"4 GB\"; B, kB, MB, GB, TB, KiB, MiB, GiB, TiB; without "
     "it no limit"},
    {"disk", KeyKind::text, "what a case may write into its folder", "\"1 GB\""},
    {"keep",
     KeyKind::word,
     "which folders of cases stay beside the database: those of cases that brought no answer (at most 100), all, "
     "none",
     "\"failed\"",
     {},
     keep_names},
    {"cost_seconds",
     KeyKind::number,
     "about how long a case takes on a core, s: for predictions and the order of cases; default: 1, with lines "
     "0.001",
     {},
     positive},
    {"tolerance", KeyKind::number, "relative difference up to which a repeated case agrees (replay)", "0", {0, 1}},
});
constinit const std::span<const Field> program_keys = program_table;

constexpr auto program_parameter_table = std::to_array<Field>({
    {"unit", KeyKind::text,
     "of its values; texts with other units are converted to it, and expressions are numbers in it"},
    {"bounds", KeyKind::array, "of a number [low, high], null: open; of a word the list of what it may be"},
    {"meaning", KeyKind::text, "in words"},
    {"whole", KeyKind::flag,
     "true: a number of whole things; it is varied by \"levels\", and another number is refused", "false"},
    {"default", KeyKind::value,
     "what is sent where the \"when\" of its factor is false; without it 0, of a word the empty text"},
});
constinit const std::span<const Field> program_parameter_keys = program_parameter_table;

constexpr auto program_observable_table = std::to_array<Field>({
    {"unit", KeyKind::text, "of its values"},
    {"meaning", KeyKind::text, "in words"},
    {"shape",
     KeyKind::word,
     "scalar, or values over a coordinate (profile) or over time (series); default: scalar, with \"over\" profile",
     {},
     {},
     shape_names},
    {"bounds", KeyKind::array, "[low, high], null: open; a case with a value outside is rejected"},
    {"optional", KeyKind::flag, "true: a case without a value is completed all the same", "false"},
    {"from", KeyKind::object, "where its value is found; needed with files, absent with lines"},
});
constinit const std::span<const Field> program_observable_keys = program_observable_table;

constexpr auto program_from_table = std::to_array<Field>({
    {"json", KeyKind::text, "a JSON file that the program writes"},
    {"path", KeyKind::text,
     "of json: JSON pointer (RFC 6901) of a number, or of a list of numbers where there is an over"},
    {"csv", KeyKind::text, "a table that the program writes, its first line the names of the columns"},
    {"column", KeyKind::text, "of csv: the column of the value"},
    {"row", KeyKind::value, "of csv: \"last\", \"first\" or a number from 0, negative from the end; default: last"},
    {"over", KeyKind::text, "of csv the column, of json the pointer of the coordinates: all rows are read"},
    {"separator", KeyKind::word, "of csv: what stands between columns", {}, {}, separator_names},
    {"output", KeyKind::text,
     "a regular expression (ECMAScript, no back-references) whose first group is the value, in the last line of "
     "standard output that has it"},
});
constinit const std::span<const Field> program_from_keys = program_from_table;

constexpr auto program_version_table = std::to_array<Field>({
    needed({"command", KeyKind::words, "the program and its arguments"}),
    needed({"match", KeyKind::text,
            "regular expression (ECMAScript, no back-references) whose first group in what it writes is the version"}),
});
constinit const std::span<const Field> program_version_keys = program_version_table;

}  // namespace grainsweep::campaign
