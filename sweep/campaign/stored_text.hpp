// Texts that the database stores without interpreting them: the campaign file, and an attempt's seconds by phase.
#pragma once

#include "sweep/campaign/accuracy_goal.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/identity.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Content of a campaign file that is not in the identity of its campaign.
struct Remarks {
    std::string notes;                     ///< of its top level, one line for each text of a list
    std::optional<std::int64_t> attempts;  ///< limits.attempts, if given
    std::vector<std::string> features;     ///< model.features; empty: not given
    std::vector<std::string> noise;        ///< factors with "role": "noise"
    std::optional<AccuracyGoal> goal;      ///< "accuracy" as an object
    std::optional<double> wall_seconds;    ///< limits.wall_seconds, if given
};
/// Returns the remarks in a campaign file stored by this program or an older one; empty if the text is none.
[[nodiscard]] Remarks remarks_in(std::string_view campaign_file);

/// Returns the observables of a program in the order of the campaign file; empty for a file without a program, or a
/// text that is none.
[[nodiscard]] std::vector<std::string> observables_as_written(std::string_view campaign_file);

/// Writes a campaign file with further points of another campaign: its scene, factors, fixed values, condition,
/// accuracy, features, limits and execution, with a design of kind `list`. One row per point, one value per factor in
/// the order of the file. Its seed is the other seed plus `number`, so that a repeated setting is a new run. Paths of
/// files do not change. Throws std::invalid_argument for a text that is no campaign file.
[[nodiscard]] std::string further_points(std::string_view campaign_file, std::string_view name, std::string_view notes,
                                         std::span<const std::vector<Value>> rows, std::uint64_t number);

/// Other numerics for the same points: an accuracy setting, and single inputs.
struct OtherNumerics {
    std::string name, notes;
    std::string accuracy;
    Inputs fixed = {};                   ///< only inputs that the file does not vary
    std::vector<std::string> numerical;  ///< inputs that do not change the seed
};
/// Writes a campaign file with these points of another and with other numerics: a design of kind `list`, the same seed,
/// one replicate. Throws std::invalid_argument for a text that is no campaign file.
[[nodiscard]] std::string with_other_numerics(std::string_view campaign_file, const OtherNumerics& numerics,
                                              std::span<const std::vector<Value>> rows);

/// One setting of the numerics for the first points of the design.
struct AtSetting {
    std::string name, setting;
    std::int64_t points = 0;
    std::vector<std::string> numerical = {};  ///< inputs that do not change the seed
    bool keeps_goal = false;                  ///< "accuracy" stays an object, with this setting
};
/// Returns another campaign file at this setting; its design must have the option "points". Throws
/// std::invalid_argument for a text that is no campaign file.
[[nodiscard]] std::string at_setting(std::string_view campaign_file, const AtSetting& at);

/// Returns the campaign file of a calibration reduced to one experiment; any other text unchanged.
[[nodiscard]] std::string text_of_experiment(std::string_view campaign_file, const Identity& campaign);

using PhaseSeconds = decltype(Cost::phases);
/// Returns the phases as a JSON object, without NaN; empty if there are no phases.
[[nodiscard]] std::optional<std::string> phases_text(const PhaseSeconds& phases);
/// Returns the phases in a text of phases_text; empty for another text.
[[nodiscard]] std::optional<PhaseSeconds> phases_in(std::string_view text);

}  // namespace grainsweep::campaign
