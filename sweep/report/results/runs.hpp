// Fields of plan, run, work, import, status, explain, replay and solve.
#pragma once

#include "sweep/report/results/shared.hpp"

namespace grainsweep::report::results {

// ---- plan

inline constexpr auto planned_design = std::to_array<Field>({
    {"kind", word, "name of the design"},
    {"NAME", value, "value of an option of the design"},
});
inline constexpr auto stored_extent = std::to_array<Field>({
    database_file,
    {"candidates", whole, "points of the design in the database"},
    {"replicates", whole, "cases per point in the database"},
});
inline constexpr auto probed_case = std::to_array<Field>({
    {"point", whole, "point of the case"},
    case_hash,
    {"outcome", word, "outcome of the case"},
    {"message", text, "reason of the outcome"},
    amount("predicted_seconds", "s", "core time before the probe"),
    amount("measured_seconds", "s", "core time of a scene, duration of a program"),
});
inline constexpr auto planned_factor = std::to_array<Field>({
    factor_name,
    {"unit", text, "unit of the factor; in brackets the unit of expressions"},
    {"low", number, "lower end of the range"},
    {"high", number, "upper end of the range"},
    {"scale", text, "linear, log, or the distribution in words"},
    {"levels", text, "levels, separated by commas; null: a range"},
    sometimes({"rules", text, "step, share, group and condition, if a factor has one"}),
});
inline constexpr auto planned_distribution = std::to_array<Field>({
    factor_name,
    amount("cut %", "%", "probability outside the bounds of the parameter"),
    {"5 %", number, "quantile"},
    {"50 %", number, "quantile"},
    {"95 %", number, "quantile"},
    {"low to high", text, "density as a row of bars"},
});
inline constexpr auto planned_grain = std::to_array<Field>({
    {"grain", text, "name of the species"},
    {"spheres", whole, "spheres of a grain"},
    {"shared volume", number, "volume shared with the body of the STL file, divided by the body's"},
    {"smallest sphere", number, "diameter divided by the grain's"},
    {"cost", number, "cost divided by that of a sphere"},
});
inline constexpr auto planned_case = std::to_array<Field>({
    {"point", whole, "number of the point, from 0"},
    {"sequence", whole, "number of the sequence, from 0"},
    {"replicate", whole, "number of the replicate, from 0"},
    case_hash,
    case_seed,
    {"NAME", value, "value of a factor"},
});
inline constexpr auto plan = std::to_array<Field>({
    campaign_name,
    scene_name,
    scene_revision,
    holding({"design", object, "design with its options"}, planned_design),
    {"seed", whole, "seed of the campaign"},
    {"replicates", whole, "cases per point"},
    candidate_points,
    dropped_points,
    {"points", whole, "points that remain"},
    {"cases", whole, "cases: points times replicates"},
    {"finished", whole, "cases with a result in the database"},
    holding({"stored", object, "extent of the campaign in the database; null: not there"}, stored_extent),
    {"warnings", words, "one sentence each"},
    {"questions", whole, "distinct cases"},
    {"proven", whole, "distinct cases whose answer is known without simulation"},
    {"impossible", whole, "distinct cases with impossible inputs, which will be rejected"},
    amount("predicted_seconds", "s", "core time of all cases"),
    amount("longest_seconds", "s", "core time of the most expensive case"),
    amount("left_seconds", "s", "core time of the cases without a result"),
    holding({"probe", object, "case that `--probe` computed; it scales the predictions"}, probed_case),
    amount("all_waves_seconds", "s", "core time of all waves of a calibration, at most"),
    amount("largest_bytes", "bytes", "memory of the case that needs most"),
    {"threads", value, "threads per case, or auto; null: a program"},
    {"powder", text, "sentence on the inputs that the powder file sets; null: none"},
    holding({"factors", array, "one per factor"}, planned_factor),
    holding({"fixed", object, "inputs that the campaign fixes"}, input_values),
    sometimes(holding({"distributions", array, "one per factor with a distribution"}, planned_distribution)),
    sometimes(holding({"grains", array, "one per species with a shape, in the first case"}, planned_grain)),
    holding({"rows", array, "one per case, in the order of the design"}, planned_case),
});

// ---- run, work, import

inline constexpr auto run = std::to_array<Field>({
    campaign_name,
    database_file,
    file_size,
    {"ending", text, "sentence on how the run ended"},
    {"converged", flag, "whether the campaign has converged; null: it has no rule"},
    exit_code,
});
inline constexpr auto work = std::to_array<Field>({
    campaign_name,
    {"share", text, "share of the task, such as 1/4"},
    {"cases", whole, "distinct cases of the campaign"},
    {"answered", whole, "cases with a result in the shared folder"},
    {"computed", whole, "cases that this task computed"},
    {"ending", text, "sentence on how the task ended"},
    exit_code,
});
inline constexpr auto import = std::to_array<Field>({
    campaign_name,
    database_file,
    {"imported", whole, "cases that were stored: of_design and beside"},
    {"of_design", whole, "cases that are points of the design"},
    {"beside", whole, "cases at other settings, which models use and moments do not"},
    {"known", whole, "cases that were there before"},
    {"unanswered", whole, "lines without an answer, which are left out"},
});

// ---- status, explain, replay

inline constexpr auto running_case = std::to_array<Field>({
    {"case", text, "id of the case"},
    {"point", whole, "number of its point"},
    {"NAME", value, "value of a factor"},
    amount("done", "1", "share that is done; null: unknown"),
    amount("seconds", "s", "time since the case was given to a worker"),
    {"attempt", whole, "number of the attempt"},
    {"host", text, "host of the worker"},
});
inline constexpr auto status = std::to_array<Field>({
    campaign_name,
    scene_name,
    {"cases", whole, "cases of the campaign"},
    {"completed", whole, "cases with an answer"},
    {"skipped", whole, "cases whose answer is proven without simulation"},
    {"unstable", whole, "cases whose computation diverged"},
    {"rejected", whole, "cases with impossible inputs"},
    {"crashed", whole, "cases whose worker ended unexpectedly"},
    {"timed_out", whole, "cases beyond the limit of time"},
    {"abandoned", whole, "cases that were interrupted; the next run continues them"},
    {"waiting", whole, "cases that have not been tried"},
    {"stopped_at", whole, "points at which the campaign converged and stopped; null: it did not"},
    amount("rate", "1/s", "cases per second in the last run"),
    amount("time_left", "s", "time for the remaining cases at this rate"),
    candidate_points,
    dropped_points,
    {"points", whole, "points with stored cases"},
    {"replicates", whole, "cases per point"},
    {"finished", whole, "cases with a result"},
    {"asked_points", whole, "points of the design in the last run"},
    {"asked_replicates", whole, "cases per point in the last run"},
    {"imported", whole, "cases that were computed elsewhere"},
    {"converged", flag, "whether the campaign has converged; null: it has no rule"},
    {"verdict", text, "sentence on the convergence; null: it has no rule"},
    sometimes(holding({"running", array, "running cases, while a run is under way"}, running_case)),
    sometimes(amount("expected_seconds", "s", "time to the end of the run, while it is under way")),
    sometimes({"expected_at_most", flag, "the run may end sooner"}),
});
inline constexpr auto stored_files = std::to_array<Field>({
    {"file", text, "name of the file"},
    {"named at", text, "place in the campaign file that names it"},
    file_size,
    {"hash", text, "hash of its contents"},
});
inline constexpr auto attempts = std::to_array<Field>({
    {"attempt", whole, "number of the attempt"},
    {"outcome", word, "outcome, or running"},
    {"started", text, "date and time, UTC"},
    wall_seconds,
    {"threads", number, "threads of the case, on average"},
    {"host", text, "name of the host"},
    {"processor", text, "name of the processor"},
    sometimes({"instruction_path", word, "vector instructions, of a scene"}),
    sometimes({"program_version", text, "version, of a program"}),
    {"build", text, "version, commit and hash of the executable"},
    sometimes(peak_memory),
    sometimes(exit_status),
    {"message", text, "reason of the outcome"},
});
inline constexpr auto explain = std::to_array<Field>({
    case_hash,
    scene_name,
    scene_revision,
    case_seed,
    inputs,
    holding({"files", array, "files among the inputs"}, stored_files),
    holding({"attempts", array, "one per attempt"}, attempts),
    {"why", text, "sentence on why the case will or will not run again"},
});
inline constexpr auto compared_scalar = std::to_array<Field>({
    observable_name,
    {"archive", number, "stored value"},
    {"replay", number, "value of the new computation"},
    amount("relative_difference", "1", "difference divided by the larger value"),
});
inline constexpr auto replay = std::to_array<Field>({
    case_hash,
    {"same_path", flag, "whether sources and instruction path are those of the stored result"},
    {"agrees", flag, "whether both results agree within the tolerance"},
    {"verdict", text, "sentence on the agreement"},
    holding({"scalars", array, "one per scalar"}, compared_scalar),
});

// ---- solve

inline constexpr auto solved_program = std::to_array<Field>({
    {"version", text, "version that the program states"},
    peak_memory,
    exit_status,
});
inline constexpr auto scalar_values = std::to_array<Field>({{"NAME", number, "value of a scalar; null: undefined"}});
inline constexpr auto absent_scalars = std::to_array<Field>({{"NAME", text, "reason of an undefined scalar"}});
inline constexpr auto sample = std::to_array<Field>({
    sometimes(amount("time", "s", "time of a series")),
    sometimes({"bin", number, "place of a profile or curve"}),
    {"value", number, "value"},
});
inline constexpr auto sample_lists =
    std::to_array<Field>({holding({"NAME", array, "samples of a series, profile or curve"}, sample)});
inline constexpr auto phases = std::to_array<Field>({amount("NAME", "s", "time of a phase of the computation")});
inline constexpr auto cost = std::to_array<Field>({
    wall_seconds,
    amount("cpu_seconds", "s", "processor time"),
    {"particle_steps", number, "particles times time steps"},
    {"threads", number, "threads of the case, on average"},
    holding({"phases", object, "times of the phases"}, phases),
});
inline constexpr auto solve = std::to_array<Field>({
    scene_name,
    scene_revision,
    case_hash,
    case_seed,
    sometimes(holding({"program", object, "of a program"}, solved_program)),
    sometimes({"instruction_path", word, "vector instructions, of a scene"}),
    inputs,
    {"outcome", word, "outcome of the case"},
    {"message", text, "reason of the outcome"},
    holding({"scalars", object, "scalars, in their units"}, scalar_values),
    holding({"absent", object, "undefined scalars"}, absent_scalars),
    holding({"series", object, "series, profiles and curves"}, sample_lists),
    holding({"cost", object, "cost of the computation"}, cost),
});

}  // namespace grainsweep::report::results
