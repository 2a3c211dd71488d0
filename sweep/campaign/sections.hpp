// The sections of a campaign file, each read by its own file. Internal to the reader.
#pragma once

#include "sweep/campaign/accuracy_goal.hpp"
#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/cursor.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

/// A value of a parameter, of its declared type and within its bounds; a number may be a text with a unit. A file is
/// looked for in `folder` and becomes "file:<hash of its contents>:<absolute path>".
[[nodiscard]] Value read_value(const Cursor& place, const ParameterSpec& parameter,
                               const std::filesystem::path& folder);

/// "'gap' must be a number above 0 m": what a number of the parameter must be.
[[nodiscard]] std::string rule_of(const ParameterSpec& parameter);

/// The parameter a name means; refuses unknown ones with the nearest.
[[nodiscard]] const ParameterSpec& read_parameter(const Cursor& name, const SceneInfo& scene);

[[nodiscard]] std::vector<Factor> read_factors(const Cursor& place, const SceneInfo& scene,
                                               const std::filesystem::path& folder);
/// The distribution under `key` of a factor. Throws WrongQuestion where the bounds of the parameter cut off more than
/// 5 % of it.
[[nodiscard]] std::variant<Between, stats::Distribution> read_distribution(const Section& factor, std::string_view key,
                                                                           const ParameterSpec& parameter,
                                                                           const std::filesystem::path& folder);
/// A column of a CSV file that a factor samples.
struct NamedColumn {
    std::size_t factor = 0;
    Cursor place;
    std::string file, column;
};
/// What the factor's "sample" names, without reading the file.
[[nodiscard]] NamedColumn read_named_column(const Section& section, std::size_t factor, const ParameterSpec& parameter);
/// Reads the files and gives the factors their columns; those of one file share its rows.
void read_samples(std::span<const NamedColumn> columns, std::vector<Factor>& factors, const SceneInfo& scene,
                  const std::filesystem::path& folder);
/// "step" or "whole" of a factor with a range.
[[nodiscard]] std::optional<double> read_step(const Section& factor, const ParameterSpec& parameter,
                                              const Between& range);
/// Refuses both of a factor without a range, for the reason `why`.
void refuse_steps(const Section& factor, std::string_view why);
/// "group" and "when" of a factor, the condition unread: store::compile_conditions reads it.
void read_ties(const Section& section, Factor& factor);
/// "simplex": marks the factors that it names as shares.
void read_simplex(const Cursor& place, ParameterSpace& space);
/// Refuses what the design cannot do: groups, shares, rows whose shares do not add to one.
void check_groups(const Cursor& factors, const Campaign& campaign);
void check_simplex(const Cursor& place, const Campaign& campaign);
/// Refuses steps, shares and conditions where the design or the rule of convergence needs independent real numbers.
void check_unfit(const Campaign& campaign);
/// Values, quantities and expressions over the numbers of other parameters.
void read_fixed(const Cursor& place, ParameterSpace& space, const std::filesystem::path& folder);

/// The scene that a campaign file or one of its experiments names: with a program or a machine, made from its section.
[[nodiscard]] const SceneInfo& read_scene(const Section& top, const std::filesystem::path& folder);
/// A campaign file of one experiment, without its text.
[[nodiscard]] Campaign campaign_in(const Json& document, const std::filesystem::path& folder);
/// The experiments of "calibration"; empty: the campaign file is of one.
[[nodiscard]] std::vector<std::string> experiment_names(const Json& document);
/// The campaign of each experiment, in the order of experiment_names.
[[nodiscard]] std::vector<Campaign> read_experiments(const Json& document, const std::filesystem::path& folder);

/// The campaign's design: checks options against the design's OptionSpecs and fills in defaults.
void read_design(const Cursor& place, Campaign& campaign, const std::filesystem::path& folder);
/// "calibration" in the place of a design: adds the conditions of its targets to the factors, as levels.
void read_calibration(const Cursor& place, Campaign& campaign, const std::filesystem::path& folder);
/// Puts into the request what a design may know of the factors, and the seed.
void set_factors(Campaign& campaign);
/// A design that grows chooses what comes next itself: what would choose beside it is refused.
void check_growing(const Cursor& place, const Campaign& campaign);
/// Rows of factor values from a CSV file whose header names the factors, in any order.
[[nodiscard]] designs::Rows read_rows_file(const Cursor& file, const ParameterSpace& space,
                                           const std::filesystem::path& folder);
/// A listed row must lie within the declared range of its factor.
void check_in_range(const Cursor& place, const Factor& factor, const Value& value);

/// One of the scene's scalar observables.
[[nodiscard]] std::string read_scalar(const Cursor& place, const SceneInfo& scene);
/// Statistics that are judged, each once.
[[nodiscard]] std::vector<std::string> read_gates(const Section& section, const std::vector<std::string>& standard);
/// "accuracy": the setting, or the goal; beside a goal the numerical inputs change no seed.
std::optional<AccuracyGoal> read_accuracy(const Cursor& place, Campaign& campaign);
/// Refuses a design whose points are no independent sequences of different cases, and what would stop beside the goal.
void check_accuracy(const Cursor& place, const Campaign& campaign);
[[nodiscard]] Convergence read_convergence(const Cursor& place, const Campaign& campaign);
/// "model": the features, as written; whether they can be evaluated is for report::check_features.
[[nodiscard]] std::vector<std::string> read_features(const Cursor& place);
[[nodiscard]] Limits read_limits(const Cursor& place);
[[nodiscard]] Execution read_execution(const Cursor& place);

}  // namespace grainsweep::campaign
