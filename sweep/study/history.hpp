// Moments of a response along its design, recomputed from the stored values, with a verdict.
#pragma once

#include "stats/convergence.hpp"
#include "sweep/study/responses.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

struct History {
    stats::ConvergenceSettings settings;    ///< of the campaign; else of the default rule, or of all_change if the
                                            ///< default cannot be used
    bool has_rule = false;                  ///< the campaign gives a rule
    std::vector<stats::Checkpoint> checks;  ///< one per complete block of the settled prefix
    /// All settled points: the numbers to quote. If the points are no multiple of the block, it is shown but not
    /// judged. Errors are NaN for a lattice or a list.
    stats::Checkpoint all;
    /// All finished cases, also behind an unfinished one. Not judged and not to be quoted. `points` counts the points
    /// with a finished case. Empty if `all` already has all of them.
    std::optional<stats::Checkpoint> provisional;
    std::int64_t beyond = 0;            ///< completed cases without a value that count in `all.levels`
    std::string verdict;                ///< one line
    std::optional<bool> converged;      ///< by the campaign's rule; empty: the campaign has no rule
    std::vector<std::string> warnings;  ///< to be read before the numbers are quoted
};

/// Returns pointers to about `most` of the checks, evenly thinned, including the last and the converged one; then `all`
/// if it is no check.
[[nodiscard]] std::vector<const stats::Checkpoint*> checks_to_show(const History& history, std::size_t most);

/// Returns a sentence if the last run of a campaign had fewer points than are stored, with both numbers; else empty.
[[nodiscard]] std::string extent_note(const store::CampaignRecord& campaign);
/// Returns in one line the candidates, the points that the `where` clause excludes, and the cases requested and
/// finished.
[[nodiscard]] std::string points_line(const Responses& responses);

/// What a completed case without a value, such as a jam, counts as in quantiles and probabilities: nothing, or more or
/// less than every value and threshold (a censored value).
enum class WithoutValue { left_out, above, below };

/// `levels`: estimated of all settled points, beside those among the gates.
[[nodiscard]] History history_of(const Responses& responses, const ResponseColumn& response,
                                 std::span<const stats::Level> levels = {},
                                 WithoutValue without = WithoutValue::left_out);
/// Returns the same without the intermediate checks and their verdict, which take most of the time.
[[nodiscard]] History figures_of(const Responses& responses, const ResponseColumn& response,
                                 std::span<const stats::Level> levels = {},
                                 WithoutValue without = WithoutValue::left_out);

/// The quantiles that are shown where no other levels are wanted: 5, 25, 50, 75, 95 %.
inline constexpr std::array<stats::Level, 5> shown_levels = {
    stats::Quantile{0.05}, stats::Quantile{0.25}, stats::Quantile{0.5}, stats::Quantile{0.75}, stats::Quantile{0.95}};

/// Lattice of a family (same scene, factors and ranges) and the changes of its moments since the coarser one.
struct LatticeStep {
    std::string campaign;
    std::int64_t points = 0;
    stats::Summary summary;
    std::vector<double> changes;  ///< one per stats::statistics, as a rule compares them; NaN for the first lattice
};

/// Returns the lattices of the database with the same scene, factors and ranges, by ascending number of points: a
/// lattice is judged by the finer and coarser ones. Empty if there is no second one.
[[nodiscard]] std::vector<LatticeStep> lattice_family(const store::Store& store, const Responses& responses,
                                                      const ResponseColumn& response);

}  // namespace grainsweep::study
