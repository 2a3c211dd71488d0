#include "sweep/campaign/keys.hpp"

#include "sweep/campaign/campaign.hpp"

#include <fmt/format.h>

#include <limits>

namespace grainsweep::campaign {

namespace {

using Kind = Key::Kind;

constexpr double largest_seed = 9223372036854774784.0;  // the last double below 2^63
constexpr Interval not_negative{0, std::numeric_limits<double>::infinity(), false, true};
constexpr Interval counts{1, 1e6};
constexpr Interval measurable{-1e100, 1e100};  // squares of it, and sums of them, are numbers

std::string json_word(std::string_view word) {
    return fmt::format("\"{}\"", word);
}

std::string json_list(std::span<const std::string> words) {
    std::string list;
    for (const auto& word : words) list += (list.empty() ? "" : ", ") + json_word(word);
    return "[" + list + "]";
}

Key key_of(const designs::OptionSpec& option) {
    using OptionKind = designs::OptionSpec::Kind;
    Key key{option.name, option.meaning, Kind::whole, !option.default_value.has_value(), {}, {}, {}};
    key.bounds = {static_cast<double>(option.minimum), static_cast<double>(option.maximum)};
    if (option.kind == OptionKind::word) {
        key.kind = Kind::word;
        key.words = option.words;
        if (!key.required) key.standard = json_word(std::get<std::string>(*option.default_value));
    } else if (option.kind == OptionKind::factor || option.kind == OptionKind::observable) {
        key.kind = Kind::text;
    } else if (option.kind == OptionKind::number) {
        key.kind = Kind::number;
        key.bounds = option.bounds;
        if (!key.required) key.standard = shortest(std::get<double>(*option.default_value));
    } else if (option.kind == OptionKind::count) {
        if (!key.required) key.standard = std::to_string(std::get<std::int64_t>(*option.default_value));
    } else {
        // A single count may stand for a list of equal ones, and a file for rows: the design section reads both.
        key.kind = option.kind == OptionKind::counts ? Kind::value : Kind::array;
        if (option.kind == OptionKind::rows) key.required = false;
    }
    return key;
}

}  // namespace

std::span<const Key> campaign_keys() {
    static const std::vector<Key> keys = {
        {"campaign", "name of the campaign and of its view in the database", Kind::text, true, {}, {}, {}},
        {"scene", "the experiment every case runs", Kind::word, true, {}, {}, {}},
        {"factors", "what varies; their order fixes the dimensions of the design", Kind::array, true, {}, {}, {}},
        {"fixed", "parameters held at a value other than their default", Kind::object, false, {}, {}, "{}"},
        {"where",
         "SQL expression over parameters: a point for which it is not true is left out",
         Kind::text,
         false,
         {},
         {},
         {}},
        {"design",
         "which points of the factor space are asked; needed unless there is a calibration",
         Kind::object,
         false,
         {},
         {},
         {}},
        {"calibration",
         "in place of a design: measurements, and waves of points towards the settings that reproduce them",
         Kind::object,
         false,
         {},
         {},
         {}},
        {"replicates", "repeats of each point with other seeds", Kind::whole, false, counts, {}, "1"},
        {"seed", "seed of the design's scrambling and of every case", Kind::whole, false, {0, largest_seed}, {}, "1"},
        {"convergence", "when the statistics are good enough", Kind::object, false, {}, {}, {}},
        {"accuracy",
         "a named set of numerical inputs of the scene",
         Kind::word,
         false,
         {},
         {"survey", "fast", "balanced", "reference"},
         {}},
        {"model", "how responses are learned from the cases; changes no result", Kind::object, false, {}, {}, {}},
        {"program", "with \"scene\": \"program\": the command that answers a case", Kind::object, false, {}, {}, {}},
        {"limits", "what one case may cost", Kind::object, false, {}, {}, {}},
        {"execution", "how the cases run; changes no result", Kind::object, false, {}, {}, {}},
    };
    return keys;
}

std::span<const Key> factor_keys() {
    static const std::vector<Key> keys = {
        {"name", "a parameter of the scene", Kind::word, true, {}, {}, {}},
        {"between", "[low, high] of a real parameter", Kind::array, false, {}, {}, {}},
        {"levels", "the values it takes, numbers or words", Kind::array, false, {}, {}, {}},
        {"scale",
         "linear: low + u (high - low); log: low (high/low)^u",
         Kind::word,
         false,
         {},
         {"linear", "log"},
         json_word("linear")},
    };
    return keys;
}

std::span<const Key> convergence_keys() {
    static const Convergence standard;
    static const std::vector<Key> keys = {
        {"observable", "a scalar observable of the scene", Kind::word, true, {}, {}, {}},
        {"rule",
         "replicates: 95 % half-widths over the random sequences below the tolerance at two consecutive checks; "
         "assisted: the same with a model of the response as control variate, which needs fewer points; "
         "any_change, all_change: any or all statistics changed by less than the tolerance between two blocks",
         Kind::word,
         false,
         {},
         {"replicates", "assisted", "any_change", "all_change"},
         json_word(standard.rule)},
        {"gates",
         "the statistics that are judged",
         Kind::words,
         false,
         {},
         {"mean", "sd", "skewness", "g1", "kurtosis"},
         json_list(standard.gates)},
        {"tolerance", "relative", Kind::number, false, {0, 1, true, true}, {}, fmt::format("{}", standard.tolerance)},
        {"block",
         "points between two checks; without it an eighth of the design's points, at most 400, a multiple of the "
         "random sequences with at least 4 points for each",
         Kind::whole,
         false,
         {4, 1e9},
         {},
         {}},
        {"stop", "whether a converged campaign starts no further case", Kind::flag, false, {}, {}, "true"},
    };
    return keys;
}

std::span<const Key> model_keys() {
    static const std::vector<Key> keys = {
        {"features",
         "what a response model sees of a case: SQL expressions over factors, e.g. log(diameter), gap/diameter; "
         "without "
         "it every factor, its logarithm where the range spans a factor of 2.5 or more",
         Kind::words,
         true,
         {},
         {},
         {}},
    };
    return keys;
}

std::span<const Key> calibration_keys() {
    static const std::vector<Key> keys = {
        {"targets", "what was measured, one entry each", Kind::array, true, {}, {}, {}},
        {"discrepancy",
         "of each observable measured: how far the simulation itself may be from the experiment, as a standard "
         "deviation",
         Kind::object,
         true,
         {},
         {},
         {}},
        {"waves", "waves of points at most", Kind::whole, false, {1, 100}, {}, "4"},
        {"points_per_wave",
         "settings of a wave; each is run under every condition",
         Kind::whole,
         false,
         {12, 10'000},
         {},
         "40"},
        {"checks",
         "settings drawn from the posterior that are run to check it",
         Kind::whole,
         false,
         {1, 1000},
         {},
         "8"},
        {"stop", "when the waves end early", Kind::object, false, {}, {}, {}},
    };
    return keys;
}

std::span<const Key> target_keys() {
    static const std::vector<Key> keys = {
        {"observable", "an observable of the scene", Kind::word, true, {}, {}, {}},
        {"value", "of a scalar: what was measured, in its unit", Kind::number, false, measurable, {}, {}},
        {"file",
         "of a series or profile: CSV file of a measured curve, a header and lines of where, value and, where it "
         "differs from line to line, error",
         Kind::text,
         false,
         {},
         {},
         {}},
        {"error",
         "standard error of the measurement; of a curve that of every line without one of its own",
         Kind::number,
         false,
         Interval{0, measurable.high},
         {},
         {}},
        {"inputs", "the condition it was measured under: parameters of the scene", Kind::object, false, {}, {}, {}},
    };
    return keys;
}

std::span<const Key> stop_keys() {
    static const std::vector<Key> keys = {
        {"shrink",
         "a wave that rules out less than this share of what was kept is the last",
         Kind::number,
         false,
         {0, 1},
         {},
         "0.02"},
    };
    return keys;
}

std::span<const Key> limits_keys() {
    static const std::vector<Key> keys = {
        {"wall_seconds",
         fmt::format("time an attempt may take, s; at least {}, or 0: no limit", shortest_limit),
         Kind::number,
         false,
         not_negative,
         {},
         "0"},
        {"attempts",
         "tries of a case that crashes or runs out of time",
         Kind::whole,
         false,
         {1, 1000},
         {},
         std::to_string(Limits{}.attempts)},
    };
    return keys;
}

std::span<const Key> execution_keys() {
    static const std::vector<Key> keys = {
        {"workers", "worker processes; 0: one per core of the job", Kind::whole, false, {0, 100'000}, {}, "0"},
        {"launcher",
         "argument vector put before a worker, or before a host, e.g. srun -N1 -n1 --exact; {host} in a word is the "
         "number of the host, from 1 on",
         Kind::words,
         false,
         {},
         {},
         "[]"},
        {"hosts",
         "processes on other nodes, each started by one call of the launcher, that run the workers; 0: the launcher "
         "starts every worker",
         Kind::whole,
         false,
         {0, 10'000},
         {},
         "0"},
        {"workers_per_host",
         "workers that each host runs; 0: one per core that the main program's job has on its node",
         Kind::whole,
         false,
         {0, 4096},
         {},
         "0"},
        {"threads",
         "threads of a case, which change no bit of it; \"auto\": one, and where fewer cases are left than cores, the "
         "cores left over go to those that run; a number: so many for every case, and by default so many times fewer "
         "workers",
         Kind::whole,
         false,
         {1, 1024},
         {"auto"},
         json_word("auto")},
        {"walltime",
         fmt::format("time that the main program may take, s; at least {}, or 0: until SLURM_JOB_END_TIME where that "
                     "is set",
                     shortest_limit),
         Kind::number,
         false,
         not_negative,
         {},
         "0"},
        {"start_seconds",
         fmt::format("a worker that is not ready after so long is replaced, s; at least {}, or 0: no limit",
                     shortest_limit),
         Kind::number,
         false,
         not_negative,
         {},
         fmt::format("{}", Execution{}.start_seconds)},
        {"silence_seconds",
         fmt::format("a worker that computes and gives no sign of life for so long is replaced, s (a sign comes every "
                     "second); at least {}, or 0: no limit",
                     shortest_silence),
         Kind::number,
         false,
         not_negative,
         {},
         fmt::format("{}", Execution{}.silence_seconds)},
    };
    return keys;
}

std::vector<Key> design_keys(const designs::DesignInfo& design) {
    std::vector<Key> keys = {{"kind", design.summary, Kind::word, true, {}, {design.name}, {}}};
    for (const auto& option : design.options) {
        keys.push_back(key_of(option));
        if (option.kind == designs::OptionSpec::Kind::rows) {
            keys.push_back({"file",
                            "CSV beside the campaign file, one column per factor, its header the names",
                            Kind::text,
                            false,
                            {},
                            {},
                            {}});
        }
    }
    return keys;
}

std::span<const std::string> reserved_names() {
    static const std::vector<std::string> names = {"campaign",
                                                   "sim_case",
                                                   "case_input",
                                                   "campaign_case",
                                                   "attempt",
                                                   "observable",
                                                   "observation",
                                                   "convergence",
                                                   "provenance",
                                                   "series",
                                                   "convergence_history",
                                                   "parameter",
                                                   "inputs",
                                                   "json_each",
                                                   "json_tree",
                                                   "attempt_computer",
                                                   "table_checksum",
                                                   "file_checksum",
                                                   "program",
                                                   "program_content",
                                                   "attempt_program"};  // json_ ...: SQLite's own
    return names;
}

}  // namespace grainsweep::campaign
