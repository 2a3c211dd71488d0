// Error against cost: settings of a calculation, what they cost, how far their answers are off, and which of them no
// other beats in both.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace grainsweep::tests {

struct Setting {
    std::string scene, name;    ///< e.g. "spreading", "time step 0.2"
    std::string measured;       ///< the figure whose error is meant
    double cost = 0;            ///< processor seconds
    double error = 0;           ///< relative, of the mean
    double uncertainty = 0;     ///< standard error of `error`; 0: exact comparison
    bool is_reference = false;  ///< the one the others are measured against
    bool unstable = false;      ///< stopped with a reason: it has no error, and no place in the figure
    bool dominated = false;     ///< another of its scene costs less and errs less
};

/// One figure per seed.
using Runs = std::vector<double>;

[[nodiscard]] double mean(const Runs& runs);
[[nodiscard]] double error_of_mean(const Runs& runs);
/// Fills in errors against the setting marked as the reference: means of the differences from seed to seed, since what
/// a start has in common with itself does not count.
void compare_means(std::vector<Setting>& settings, const std::vector<Runs>& runs);

/// Of this thread.
[[nodiscard]] double processor_seconds();

/// Marks the settings for which another one of the same scene is both cheaper and closer; an error counts as no less
/// than its uncertainty.
void mark_dominated(std::vector<Setting>& settings);

[[nodiscard]] std::string json_line(const Setting& setting);

/// One panel per scene: cost across, error up, both logarithmic; the settings no other beats filled and joined.
/// Where a scene has more than twenty settings only those are named.
void draw(const std::vector<Setting>& settings, const std::filesystem::path& svg);

}  // namespace grainsweep::tests
