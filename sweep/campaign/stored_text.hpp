// Texts that an archive keeps as they are and does not interpret: the campaign file, and an attempt's seconds by phase.
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

/// What a campaign file says beside what is in the identity of its campaign.
struct Remarks {
    std::string notes;                     ///< at its top level, one line for each text of a list
    std::optional<std::int64_t> attempts;  ///< limits.attempts, where it says so
    std::vector<std::string> features;     ///< model.features; empty: it says nothing of them
    std::vector<std::string> noise;        ///< factors with "role": "noise"
    std::optional<AccuracyGoal> goal;      ///< "accuracy" as an object
};
/// Of a campaign file that was read and stored by this program or an older one; empty where it is none.
[[nodiscard]] Remarks remarks_in(std::string_view campaign_file);

/// Writes a campaign file with further points of another campaign: its scene, factors, fixed values, condition,
/// accuracy, features, limits and execution, with a design of kind `list`. One row per point, one value per factor in
/// the order of the file. Its seed is the other's plus `number`, so that a repeated setting is a new run.
/// Paths of files stay as they were written. Throws std::invalid_argument for a text that is no campaign file.
[[nodiscard]] std::string further_points(std::string_view campaign_file, std::string_view name, std::string_view notes,
                                         std::span<const std::vector<Value>> rows, std::uint64_t number);

/// The same question asked with other numerics: an accuracy setting, and single inputs beside it.
struct OtherNumerics {
    std::string name, notes;
    std::string accuracy;
    Inputs fixed = {};                   ///< of those alone that the file does not vary
    std::vector<std::string> numerical;  ///< inputs that change no seed
};
/// Writes a campaign file with these points of another in that way: a design of kind `list`, the seed of the other, one
/// replicate. Throws std::invalid_argument for a text that is no campaign file.
[[nodiscard]] std::string with_other_numerics(std::string_view campaign_file, const OtherNumerics& numerics,
                                              std::span<const std::vector<Value>> rows);

/// The same question at one setting of the numerics, over the first points of the design.
struct AtSetting {
    std::string name, setting;
    std::int64_t points = 0;
    std::vector<std::string> numerical = {};  ///< inputs that change no seed
    bool keeps_goal = false;                  ///< its "accuracy" stays an object, with this setting
};
/// A campaign file that asks so what another asks whose design has "points" for its extent. Throws
/// std::invalid_argument for a text that is no campaign file.
[[nodiscard]] std::string at_setting(std::string_view campaign_file, const AtSetting& at);

/// The campaign file of a calibration's experiment as one of that experiment alone; any other text as it is.
[[nodiscard]] std::string text_of_experiment(std::string_view campaign_file, const Identity& campaign);

using PhaseSeconds = decltype(Cost::phases);
/// As a JSON object; phases whose time is no number are left out. None where there are no phases.
[[nodiscard]] std::optional<std::string> phases_text(const PhaseSeconds& phases);
/// What phases_text wrote; none where it is something else.
[[nodiscard]] std::optional<PhaseSeconds> phases_in(std::string_view text);

}  // namespace grainsweep::campaign
