// Sections of a campaign file, each with a reader in its own file. Internal to the reader.
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

struct Powder;

/// Whether a text with a unit is a value, or the difference of two, such as a standard deviation: 5 degC are 5 K then.
enum class Reads { value, difference };
/// Reads a value of a parameter, of its declared type and within its bounds; a number may be a text with a unit. A file
/// in `folder` becomes "file:<hash of its contents>:<absolute path>".
[[nodiscard]] Value read_value(const Cursor& place, const ParameterSpec& parameter, const std::filesystem::path& folder,
                               Reads reads = Reads::value);

/// Returns the rule for a number of the parameter, such as "'gap' must be a number above 0 m".
[[nodiscard]] std::string rule_of(const ParameterSpec& parameter);

/// Returns the parameter of a name; refuses unknown names with the nearest one.
[[nodiscard]] const ParameterSpec& read_parameter(const Cursor& name, const SceneInfo& scene);

/// Reads one factor, but not the values of a sample.
[[nodiscard]] Factor read_factor(const Section& section, const ParameterSpec& parameter,
                                 const std::filesystem::path& folder);
[[nodiscard]] std::vector<Factor> read_factors(const Cursor& place, const SceneInfo& scene,
                                               const std::filesystem::path& folder);
/// Reads the distribution under `key` of a factor. Throws InputError if the bounds of the parameter cut off more
/// than 5 % of it.
[[nodiscard]] std::variant<Between, stats::Distribution> read_distribution(const Section& factor, std::string_view key,
                                                                           const ParameterSpec& parameter,
                                                                           const std::filesystem::path& folder);
/// Column of a CSV file that a factor samples.
struct NamedColumn {
    std::size_t factor = 0;
    Cursor place;
    std::string file, column;
};
/// Reads the "sample" of a factor, without reading the file.
[[nodiscard]] NamedColumn read_named_column(const Section& section, std::size_t factor, const ParameterSpec& parameter,
                                            const std::filesystem::path& folder);
/// Reads the powder file that a key names beside the campaign file.
[[nodiscard]] Powder powder_beside(const Cursor& place, const std::filesystem::path& folder);
/// Reads the files and sets the columns of the factors; columns of one file share its rows.
void read_samples(std::span<const NamedColumn> columns, std::vector<Factor>& factors, const SceneInfo& scene,
                  const std::filesystem::path& folder);
/// Reads "step" or "whole" of a factor with a range or a distribution.
[[nodiscard]] std::optional<double> read_step(const Section& section, const ParameterSpec& parameter,
                                              const Factor& factor);
/// Refuses "step" and "whole" of other factors, for the reason `why`.
void refuse_steps(const Section& factor, std::string_view why);
/// Reads "group" and "when" of a factor; store::compile_conditions parses the condition.
void read_ties(const Section& section, Factor& factor);
/// Reads "simplex" and marks its factors as shares.
void read_simplex(const Cursor& place, ParameterSpace& space);
/// Refuses groups and shares that the design does not support, and rows whose shares do not add to one.
void check_groups(const Cursor& factors, const Campaign& campaign);
void check_simplex(const Cursor& place, const Campaign& campaign);
/// Refuses steps, shares and conditions if the design or the convergence rule needs independent real numbers.
void check_unfit(const Campaign& campaign);
/// Reads fixed values, quantities and expressions of other parameters.
void read_fixed(const Cursor& place, ParameterSpace& space, const std::filesystem::path& folder);

/// Returns the scene of a campaign file or of one of its experiments; a program or machine is made from its section.
[[nodiscard]] SharedScene read_scene(const Section& top, const std::filesystem::path& folder);
/// Reads a campaign file of one experiment, without its text.
[[nodiscard]] Campaign campaign_in(const Json& document, const std::filesystem::path& folder);
/// Returns the experiments of "calibration"; empty: there is only one.
[[nodiscard]] std::vector<std::string> experiment_names(const Json& document);
/// Reads the campaign of each experiment, in the order of experiment_names.
[[nodiscard]] std::vector<Campaign> read_experiments(const Json& document, const std::filesystem::path& folder);

/// Reads the design: checks options against the design's OptionSpecs and adds defaults.
void read_design(const Cursor& place, Campaign& campaign, const std::filesystem::path& folder);
/// Reads "calibration", which replaces a design, and adds the conditions of its targets to the factors, as levels.
void read_calibration(const Cursor& place, Campaign& campaign, const std::filesystem::path& folder);
/// Writes the data of the factors that a design may use, and the seed, to the request.
void set_factors(Campaign& campaign);
/// Refuses keys that conflict with a growing design, which chooses its next points itself.
void check_growing(const Cursor& place, const Campaign& campaign);
/// Returns the contents of a CSV file. Refuses a missing file, one larger than 256 MiB, and one that cannot be read to
/// its end. `file`: its place in the campaign file.
[[nodiscard]] std::string read_csv_text(const Cursor& file, const std::filesystem::path& path);
/// Reads rows of factor values from a CSV file whose header names the factors, in any order.
[[nodiscard]] designs::Rows read_rows_file(const Cursor& file, const ParameterSpace& space,
                                           const std::filesystem::path& folder);
/// Refuses a value of a listed row outside the declared range of its factor.
void check_in_range(const Cursor& place, const Factor& factor, const Value& value);

/// Reads the name of a scalar observable of the scene.
[[nodiscard]] std::string read_scalar(const Cursor& place, const SceneInfo& scene);
/// Reads the judged statistics, each once.
[[nodiscard]] std::vector<std::string> read_gates(const Section& section, const std::vector<std::string>& standard);
/// Reads "accuracy": the setting, or the goal. With a goal the numerical inputs do not change the seed.
std::optional<AccuracyGoal> read_accuracy(const Cursor& place, Campaign& campaign);
/// Refuses, for an error goal, a design without independent sequences of distinct cases, and other conditions that stop
/// the campaign.
void check_accuracy(const Cursor& place, const Campaign& campaign);
[[nodiscard]] Convergence read_convergence(const Cursor& place, const Campaign& campaign);
/// Reads the features of "model" as text; report::check_features checks that they can be evaluated.
[[nodiscard]] std::vector<std::string> read_features(const Cursor& place);
[[nodiscard]] Limits read_limits(const Cursor& place);
[[nodiscard]] Execution read_execution(const Cursor& place);

}  // namespace grainsweep::campaign
