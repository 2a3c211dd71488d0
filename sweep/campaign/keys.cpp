#include "sweep/campaign/keys.hpp"

#include "stats/convergence_rule.hpp"
#include "stats/distribution.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace grainsweep::campaign {

namespace {

using Kind = Field::Kind;

constexpr double largest_seed = 9223372036854774784.0;  // the last double below 2^63
constexpr Interval not_negative{0, std::numeric_limits<double>::infinity(), false, true};
constexpr Interval counts{1, 1e6};
constexpr Interval measurable{-1e100, 1e100};  // squares of it, and sums of them, are numbers

constexpr std::array<std::string_view, 5> accuracy_words = {"survey", "fast", "balanced", "fine", "reference"};
constexpr std::array<std::string_view, 2> goal_words = {"mean", "sd"};
constexpr std::array<std::string_view, 2> scale_words = {"linear", "log"};
constexpr std::array<std::string_view, 2> role_words = {"control", "noise"};
constexpr std::array<std::string_view, 8> gate_words = {"mean",     "sd",        "skewness", "g1",
                                                        "kurtosis", "quantile:", "above:",   "below:"};
constexpr std::array<std::string_view, 1> thread_words = {"auto"};
constexpr Field truncated_low = {"low", Kind::value, "truncates: no smaller value; more than 5 % may be cut off"};
constexpr Field truncated_high = {"high", Kind::value, "truncates: no larger value"};
constexpr auto rule_words = [] {
    std::array<std::string_view, stats::convergence_rules.size()> words{};
    std::ranges::transform(stats::convergence_rules, words.begin(), &stats::RuleInfo::name);
    return words;
}();

/// Returns the field with its member.
template <auto member>
constexpr Field of(Field field) {
    field.at = fields::at<member>;
    return field;
}

}  // namespace

constexpr auto campaign_table = std::to_array<Field>({
    needed({"campaign", Kind::text, "name of the campaign and of its view in the database"}),
    {"scene", Kind::word, "the experiment every case runs; needed unless a calibration has several"},
    needed({"factors", Kind::array, "what varies; their order fixes the dimensions of the design"}),
    {"fixed", Kind::object, "parameters held at a value other than their default, or following others by an expression",
     "{}"},
    {"simplex", Kind::words, "factors that are shares and add to one; uniform over all mixtures"},
    {"where", Kind::text, "SQL expression over parameters: a point for which it is not true is left out"},
    {"design", Kind::object, "which points of the factor space are asked; needed unless there is a calibration"},
    {"calibration", Kind::object,
     "in place of a design: measurements, and waves of points towards the settings that reproduce them"},
    {"replicates", Kind::whole, "repeats of each point with other seeds", "1", counts},
    {"seed", Kind::whole, "seed of the design's scrambling and of every case", "1", {0, largest_seed}},
    {"common_random_numbers", Kind::words,
     "parameters that change no seed: cases that differ in these alone draw the same random numbers, so that their "
     "difference is that of the parameter",
     "[]"},
    {"convergence", Kind::object, "when the statistics are good enough"},
    {"accuracy", Kind::value,
     "a named set of numerical inputs of the scene: survey, fast, balanced, fine or reference; or an object "
     "with the error that the answer may have"},
    {"model", Kind::object, "how responses are learned from the cases; changes no result"},
    {"program", Kind::object, "with \"scene\": \"program\": the command that answers a case"},
    {"machine", Kind::value, "with \"scene\": \"machine\": a machine file beside the campaign file, or its object"},
    {"powder", Kind::text,
     "a powder file beside the campaign file: gives the scene what it says of the powder and the campaign does "
     "not"},
    {"limits", Kind::object, "what one case may cost"},
    {"execution", Kind::object, "how the cases run; changes no result"},
});
constinit const std::span<const Field> campaign_keys = campaign_table;

constexpr auto factor_table = std::to_array<Field>({
    needed({"name", Kind::word, "a parameter of the scene"}),
    {"between", Kind::array, "[low, high] of a real parameter, numbers or texts with a unit"},
    {"levels", Kind::array, "the values it takes, numbers, texts with a unit, or words"},
    {"scale",
     Kind::word,
     "of between; linear: low + u (high - low); log: low (high/low)^u",
     "\"linear\"",
     {},
     scale_words},
    {"uniform", Kind::object, "the same as between: low, high"},
    {"normal", Kind::object, "normal distribution: mean, sd"},
    {"lognormal", Kind::object, "lognormal distribution: median and sigma, the sd of ln x, or ratio, exp(sigma)"},
    {"weibull", Kind::object, "Weibull distribution: scale, shape"},
    {"gumbel", Kind::object, "Gumbel distribution of largest values: location, scale"},
    {"triangular", Kind::object, "triangular distribution: low, mode, high"},
    {"beta", Kind::object, "beta distribution from low to high: low, high, a, b"},
    {"sample", Kind::value,
     "CSV file with values in SI units under the name of the parameter; or file or powder, column"},
    {"step", Kind::value, "values are multiples of it, counted from 0: a number or a text with a unit"},
    {"whole", Kind::flag, "true: values are whole numbers, as by a step of 1"},
    {"group", Kind::text, "factors of one group move together in saltelli and morris, and have one index"},
    {"when", Kind::text, "SQL condition over other factors: where it is not true, the parameter has its default"},
    {"role",
     Kind::word,
     "control: it can be set; noise: it varies and cannot be set, window averages over it; changes no result",
     "\"control\"",
     {},
     role_words},
});
constinit const std::span<const Field> factor_keys = factor_table;

constexpr std::array<std::string_view, 10> range_table = {"between", "levels", "uniform",    "normal", "lognormal",
                                                          "weibull", "gumbel", "triangular", "beta",   "sample"};
constinit const std::span<const std::string_view> range_keys = range_table;

constexpr auto uniform_table = std::to_array<Field>({
    needed({"low", Kind::value, "smallest value, a number or a text with a unit"}),
    needed({"high", Kind::value, "largest value"}),
});
constinit const std::span<const Field> uniform_keys = uniform_table;

constexpr auto normal_table = std::to_array<Field>({
    needed(of<&stats::Normal::mean>({"mean", Kind::value, "mean, a number or a text with a unit"})),
    needed(of<&stats::Normal::sd>({"sd", Kind::value, "standard deviation, above 0"})),
    truncated_low,
    truncated_high,
});
constinit const std::span<const Field> normal_keys = normal_table;

constexpr auto lognormal_table = std::to_array<Field>({
    needed(of<&stats::Lognormal::median>({"median", Kind::value, "median, a number or a text with a unit, above 0"})),
    of<&stats::Lognormal::sigma>(
        {"sigma", Kind::number, "standard deviation of the natural logarithm", {}, {0, 10, true}}),
    {"ratio", Kind::number, "exp(sigma): 68 % lie between median/ratio and median*ratio", {}, {1, 20'000, true}},
    truncated_low,
    truncated_high,
});
constinit const std::span<const Field> lognormal_keys = lognormal_table;

constexpr auto weibull_table = std::to_array<Field>({
    needed(of<&stats::Weibull::scale>(
        {"scale", Kind::value, "63.2 % are smaller: a number or a text with a unit, above 0"})),
    needed(of<&stats::Weibull::shape>(
        {"shape", Kind::number, "exponent: P(value > x) = exp(-(x/scale)^shape)", {}, {0, 1000, true}})),
    truncated_low,
    truncated_high,
});
constinit const std::span<const Field> weibull_keys = weibull_table;

constexpr auto gumbel_table = std::to_array<Field>({
    needed(of<&stats::Gumbel::location>(
        {"location", Kind::value, "likeliest value, a number or a text with a unit; 36.8 % are smaller"})),
    needed(of<&stats::Gumbel::scale>({"scale", Kind::value, "width, above 0: sd times sqrt(6)/pi"})),
    truncated_low,
    truncated_high,
});
constinit const std::span<const Field> gumbel_keys = gumbel_table;

constexpr auto triangular_table = std::to_array<Field>({
    needed(of<&stats::Triangular::low>({"low", Kind::value, "smallest value, a number or a text with a unit"})),
    needed(of<&stats::Triangular::mode>({"mode", Kind::value, "likeliest value, from low to high"})),
    needed(of<&stats::Triangular::high>({"high", Kind::value, "largest value"})),
});
constinit const std::span<const Field> triangular_keys = triangular_table;

constexpr auto beta_table = std::to_array<Field>({
    needed(of<&stats::Beta::low>({"low", Kind::value, "smallest value, a number or a text with a unit"})),
    needed(of<&stats::Beta::high>({"high", Kind::value, "largest value"})),
    needed(of<&stats::Beta::a>(
        {"a", Kind::number, "first shape parameter: the density grows as (x - low)^(a-1)", {}, shapes_of_beta})),
    needed(of<&stats::Beta::b>(
        {"b", Kind::number, "second shape parameter: it falls as (high - x)^(b-1)", {}, shapes_of_beta})),
});
constinit const std::span<const Field> beta_keys = beta_table;

constexpr auto sample_table = std::to_array<Field>({
    {"file", Kind::text, "CSV file beside the campaign file, a row per draw"},
    {"powder", Kind::text, "or a powder file beside it, whose \"posterior\" is such a CSV file"},
    {"column", Kind::text, "its column; without it the name of the factor"},
});
constinit const std::span<const Field> sample_keys = sample_table;

std::span<const Type> distribution_types() {
    using Form = stats::Distribution::Form;
    static const auto types = std::to_array<Type>(
        {fields::alternative<Form, stats::Normal>("normal", "normal distribution", normal_keys),
         fields::alternative<Form, stats::Lognormal>("lognormal", "lognormal distribution", lognormal_keys),
         fields::alternative<Form, stats::Weibull>("weibull", "Weibull distribution", weibull_keys),
         fields::alternative<Form, stats::Gumbel>("gumbel", "Gumbel distribution", gumbel_keys),
         fields::alternative<Form, stats::Triangular>("triangular", "triangular distribution", triangular_keys),
         fields::alternative<Form, stats::Beta>("beta", "beta distribution", beta_keys)});
    return types;
}

constexpr auto convergence_table = std::to_array<Field>({
    needed({"observable", Kind::word, "a scalar observable of the scene"}),
    {"rule",
     Kind::word,
     "replicates: 95 % half-widths over the random sequences below the tolerance at two consecutive checks; "
     "assisted: the same with a model of the response as control variate, which needs fewer points; any_change, "
     "all_change: any or all statistics changed by less than the tolerance between two blocks",
     "\"replicates\"",
     {},
     rule_words},
    {"gates",
     Kind::words,
     "the statistics that are judged; \"quantile:0.9\" is a quantile, \"above:2\" and \"below:2\" the probability "
     "to "
     "lie beyond a threshold, in the unit of the observable",
     R"(["mean", "sd", "kurtosis", "g1"])",
     {},
     gate_words},
    {"tolerance", Kind::number, "relative", "0.01", {0, 1, true, true}},
    {"block",
     Kind::whole,
     "points between two checks; without it an eighth of the design's points, at most 400, a multiple of the "
     "random sequences with at least 4 points for each",
     {},
     {4, 1e9}},
    {"stop", Kind::flag, "whether a converged campaign starts no further case", "true"},
});
constinit const std::span<const Field> convergence_keys = convergence_table;

constexpr auto accuracy_table = std::to_array<Field>({
    needed({"observable", Kind::word, "a scalar observable of the scene"}),
    {"gates", Kind::words, "the statistics that are judged", R"(["mean", "sd"])", {}, goal_words},
    {"tolerance",
     Kind::number,
     "largest error against reference, numerics and statistics together, relative, with 95 %",
     "0.01",
     {0, 1, true, true}},
    {"setting",
     Kind::word,
     "the setting of most cases; without it a pilot chooses the one that costs least",
     {},
     {},
     accuracy_words},
});
constinit const std::span<const Field> accuracy_keys = accuracy_table;

constexpr auto model_table = std::to_array<Field>({
    needed({"features", Kind::words,
            "what a response model sees of a case: SQL expressions over factors, e.g. log(diameter), gap/diameter; "
            "without it every factor, its logarithm where the range spans a factor of 2.5 or more"}),
});
constinit const std::span<const Field> model_keys = model_table;

constexpr auto calibration_table = std::to_array<Field>({
    {"experiments", Kind::object,
     "several experiments with the same factors, each a scene or machine with its fixed values"},
    needed({"targets", Kind::array, "what was measured, one entry each"}),
    {"discrepancy", Kind::object,
     "of each observable with a measured value: how far the simulation itself may be from the experiment, as a "
     "standard deviation; with experiments an object of these for each"},
    {"waves", Kind::whole, "waves of points at most", "4", {1, 100}},
    {"points_per_wave", Kind::whole, "settings of a wave; each is run under every condition", "40", {12, 10'000}},
    {"checks", Kind::whole, "settings drawn from the posterior that are run to check it", "8", {1, 1000}},
    {"stop", Kind::object, "when the waves end early"},
});
constinit const std::span<const Field> calibration_keys = calibration_table;

constexpr auto experiment_table = std::to_array<Field>({
    {"scene", Kind::word, "the scene; not needed with a machine or a program"},
    {"machine", Kind::value, "a machine file beside the campaign file, an installed machine, or its object"},
    {"program", Kind::object, "the command that answers a case"},
    {"fixed", Kind::object, "as in the campaign file, for this experiment", "{}"},
});
constinit const std::span<const Field> experiment_keys = experiment_table;

constexpr auto target_table = std::to_array<Field>({
    {"of", Kind::word, "the experiment in which it was measured, where there are several"},
    needed({"observable", Kind::word, "an observable of the scene"}),
    {"value",
     Kind::number,
     "of a scalar: what was measured, a number in its unit or a text with a unit",
     {},
     measurable},
    {"file", Kind::text,
     "of a series or profile: CSV file of a measured curve, a header and lines of where, value and, where it "
     "differs from line to line, error"},
    {"error",
     Kind::number,
     "standard error of the measurement; of a curve that of every line without one of its own",
     {},
     {0, measurable.high}},
    {"without_value", Kind::object, "of a scalar: how many of the measured runs had no value, such as jams"},
    {"inputs", Kind::object, "the condition it was measured under: parameters of the scene"},
});
constinit const std::span<const Field> target_keys = target_table;

constexpr auto without_value_table = std::to_array<Field>({
    needed({"count", Kind::whole, "measured runs without a value", {}, {0, 1000}}),
    needed({"of", Kind::whole, "measured runs", {}, {1, 1000}}),
    needed({"discrepancy",
            Kind::number,
            "how far the simulation's probability may be from the experiment's where it is 1/2, as a standard "
            "deviation",
            {},
            {0, 0.45}}),
});
constinit const std::span<const Field> without_value_keys = without_value_table;

constexpr auto stop_table = std::to_array<Field>({
    {"shrink", Kind::number, "a wave that rules out less than this share of what was kept is the last", "0.02", {0, 1}},
});
constinit const std::span<const Field> stop_keys = stop_table;

constexpr auto limits_table = std::to_array<Field>({
    {"wall_seconds", Kind::number, "time an attempt may take, s; at least 0.1, or 0: no limit", "0", not_negative},
    {"attempts", Kind::whole, "tries of a case that crashes or runs out of time", "3", {1, 1000}},
});
constinit const std::span<const Field> limits_keys = limits_table;

constexpr auto execution_table = std::to_array<Field>({
    {"workers", Kind::whole, "worker processes; 0: one per core of the job", "0", {0, 100'000}},
    {"launcher", Kind::words,
     "argument vector put before a worker, or before a host, e.g. srun -N1 -n1 --exact; {host} in a word is the "
     "number of the host, from 1 on",
     "[]"},
    {"hosts",
     Kind::whole,
     "processes on other nodes, each started by one call of the launcher, that run the workers; 0: the launcher "
     "starts every worker",
     "0",
     {0, 10'000}},
    {"workers_per_host",
     Kind::whole,
     "workers that each host runs; 0: one per core that the main program's job has on its node",
     "0",
     {0, 4096}},
    {"threads",
     Kind::whole,
     "threads of a case, which change no bit of it; \"auto\": one, and where fewer cases are left than cores, the "
     "cores left over go to those that run; a number: so many for every case, and by default so many times fewer "
     "workers",
     "\"auto\"",
     {1, 1024},
     thread_words},
    {"walltime", Kind::number,
     "time that the main program may take, s; at least 0.1, or 0: until SLURM_JOB_END_TIME where that is set", "0",
     not_negative},
    {"start_seconds", Kind::number,
     "a worker that is not ready after so long is replaced, s; at least 0.1, or 0: no limit", "300", not_negative},
    {"silence_seconds", Kind::number,
     "a worker that computes and gives no sign of life for so long is replaced, s (a sign comes every second); at "
     "least 3, or 0: no limit",
     "60", not_negative},
});
constinit const std::span<const Field> execution_keys = execution_table;

std::vector<Field> design_keys(const designs::DesignInfo& design) {
    std::vector<Field> keys = {needed({"kind", Kind::word, design.summary})};
    for (const auto& option : design.options) {
        keys.push_back(option);
        if (option.kind == Kind::array)  // a file may stand for rows
            keys.push_back(
                {"file", Kind::text, "CSV beside the campaign file, one column per factor, its header the names"});
    }
    return keys;
}

constexpr auto reserved_names_table = std::to_array<std::string_view>({"campaign",
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
                                                                       "campaign_file",
                                                                       "attempt_computer",
                                                                       "table_checksum",
                                                                       "file_checksum",
                                                                       "program",
                                                                       "program_content",
                                                                       "attempt_program",
                                                                       "machine"});  // json_ ...: SQLite's own
constinit const std::span<const std::string_view> reserved_names = reserved_names_table;

}  // namespace grainsweep::campaign
