// Fields of the commands that list what there is, or write a file.
#pragma once

#include "sweep/report/results/shared.hpp"

namespace grainsweep::report::results {

// ---- scenes, machines, designs

inline constexpr Field summary_of_it{"summary", text, "sentence on its purpose"};
inline constexpr Field parameter_count{"parameters", whole, "number of parameters; null: a file states them"};
inline constexpr Field observable_count{"observables", whole, "number of observables; null: a file states them"};
inline constexpr auto listed_scene =
    std::to_array<Field>({scene_name, scene_revision, parameter_count, observable_count, summary_of_it});
inline constexpr auto listed_machine = std::to_array<Field>({
    {"machine", text, "name of the machine"},
    {"kind", word, "kind of machine"},
    parameter_count,
    observable_count,
    summary_of_it,
});
inline constexpr auto listed_design = std::to_array<Field>({
    {"design", text, "name of the design"},
    {"extends", word, "yes: a larger design begins with the same points"},
    summary_of_it,
});
inline constexpr auto parameter = std::to_array<Field>({
    {"name", text, "name of the parameter"},
    {"unit", text, "SI unit"},
    {"meaning", text, "meaning"},
    {"type", word, "number, integer or word"},
    {"default", value, "default"},
    sometimes({"low", number, "lower bound of a number; null: none"}),
    sometimes({"high", number, "upper bound of a number; null: none"}),
    sometimes({"low_open", flag, "whether the lower bound is excluded"}),
    sometimes({"high_open", flag, "whether the upper bound is excluded"}),
    sometimes({"words", words, "allowed words"}),
    sometimes({"file_allowed", flag, "whether it may be a file"}),
    {"matters_if", words, "conditions on other parameters; it matters if all hold"},
});
inline constexpr auto observable = std::to_array<Field>({
    {"name", text, "name of the observable"},
    {"unit", text, "SI unit"},
    {"meaning", text, "meaning"},
    {"shape", word, "scalar, series or profile"},
    {"over", text, "axis of a profile; empty: none"},
});
inline constexpr auto accuracy_settings =
    std::to_array<Field>({{"NAME", object, "values of the inputs that an accuracy setting decides"}});
inline constexpr auto section_key = std::to_array<Field>({
    {"object", text, "object of the file"},
    {"key", text, "key of the object"},
    {"default", text, "default; null: none"},
    {"meaning", text, "meaning"},
});
inline constexpr auto scene = std::to_array<Field>({
    {"name", text, "name of the scene or machine"},
    summary_of_it,
    scene_revision,
    holding({"parameters", array, "one per parameter"}, parameter),
    holding({"observables", array, "one per observable"}, observable),
    holding({"accuracy", object, "accuracy settings"}, accuracy_settings),
    sometimes(holding({"section", array, "of `machine` and `program`: keys of their files"}, section_key)),
});
inline constexpr auto option = std::to_array<Field>({
    {"option", text, "key of the option"},
    {"default", text, "default, or required"},
    {"allowed", text, "allowed values"},
    {"meaning", text, "meaning"},
});
inline constexpr auto design = std::to_array<Field>({
    {"name", text, "name of the design"},
    summary_of_it,
    {"extends", flag, "whether a larger design begins with the same points"},
    holding({"options", array, "one per option"}, option),
});

// ---- files

inline constexpr auto report_file = std::to_array<Field>({{"report", text, "file of the page"}, file_size});
inline constexpr auto figure_file = std::to_array<Field>({{"figure", text, "file of the figure"}, file_size});
inline constexpr auto listed_figure = std::to_array<Field>({
    {"figure", text, "name of the figure"},
    {"panels", text, "names of its panels; null: only one"},
    {"shows", text, "content of the figure"},
});
inline constexpr auto drawing = std::to_array<Field>({
    {"machine", text, "name of the machine"},
    {"page", text, "file of the page"},
    {"particles", whole, "spheres that are drawn"},
});

// ---- powder, shape

inline constexpr auto powder_numbers = std::to_array<Field>({
    sometimes(amount("d10 by volume", "m", "10 % of the volume is finer")),
    sometimes(amount("d50 by volume", "m", "half of the volume is finer")),
    sometimes(amount("d90 by volume", "m", "90 % of the volume is finer")),
    sometimes(amount("d10 by number", "m", "10 % of the particles are finer")),
    sometimes(amount("d50 by number", "m", "half of the particles are finer")),
    sometimes(amount("d90 by number", "m", "90 % of the particles are finer")),
    sometimes(amount("smallest", "m", "smallest diameter")),
    sometimes(amount("largest", "m", "largest diameter")),
    sometimes(amount("mass cut off below", "1", "share of the mass below the smallest diameter")),
    sometimes(amount("mass cut off above", "1", "share of the mass above the largest diameter")),
    sometimes(amount("diameter that stands for it", "m", "common diameter, or d50 by volume")),
    amount("bond number", "1", "pull-off force divided by the weight, at this diameter"),
    amount("Rayleigh time of the smallest", "s", "time of a Rayleigh wave through the smallest particle"),
    amount("time step at 1 m/s", "s", "time step of the scenes at an impact speed of 1 m/s"),
    amount("core time of 1,000 particles for 1 s", "s", "of one core"),
});
inline constexpr auto powder = std::to_array<Field>({
    {"powder", text, "name of the powder"},
    holding({"values", object, "sizes, numbers and cost"}, powder_numbers),
    {"lacks", text, "sizes and density that the file does not state; empty: none"},
});
inline constexpr auto import_facts = std::to_array<Field>({{"NAME", text, "how a part of the export was read"}});
inline constexpr auto powder_import = std::to_array<Field>({
    {"output", text, "file of sizes"},
    {"sentence", text, "sizes in one sentence"},
    holding({"taken", object, "how the export was read"}, import_facts),
    {"notes", words, "alternatives that were considered"},
    {"warnings", words, "one sentence each"},
});
inline constexpr auto shape_number = std::to_array<Field>({
    {"quantity", text, "number of spheres, volume, diameter, errors or cost, with its unit"},
    {"value", number, "value"},
});

// ---- verify, query, dump, completion, manual

inline constexpr auto damage = std::to_array<Field>({
    {"kind", text, "kind of entry"},
    case_hash,
    campaign_name,
    observable_name,
    {"damage", text, "difference from what was written"},
});
inline constexpr auto query_row = std::to_array<Field>({{"NAME", value, "value of a column of the statement"}});
inline constexpr auto dump_line = std::to_array<Field>({{"line", text, "line of the canonical text"}});
inline constexpr auto completion = std::to_array<Field>({{"completion", text, "script for the shell"}});
inline constexpr auto manual = std::to_array<Field>({{"manual", text, "manual page in roff"}});

}  // namespace grainsweep::report::results
