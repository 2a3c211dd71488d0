// How the moments of a response settled over its design, recomputed from the stored values, and what to make of it.
#pragma once

#include "stats/convergence.hpp"
#include "sweep/study/responses.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grainsweep::study {

struct History {
    stats::ConvergenceSettings
        settings;           ///< the campaign's; else the default rule, or all_change where it cannot be used
    bool has_rule = false;  ///< the campaign gives a rule
    std::vector<stats::Checkpoint> checks;  ///< every complete block of the settled beginning
    /// All settled points: the figures to quote. Where the points are no multiple of the block it is shown, never
    /// judged. Errors are NaN for a lattice or a list.
    stats::Checkpoint all;
    /// Over every finished case, wherever it stands: what is known while finished cases lie behind one that is not.
    /// Not judged and not to be quoted. `points` counts the points with such a case. None where `all` has them all.
    std::optional<stats::Checkpoint> provisional;
    std::string verdict;                ///< one line
    std::optional<bool> converged;      ///< by the campaign's rule; none: it gives no rule
    std::vector<std::string> warnings;  ///< what a reader must know before quoting the figures
};

/// At most about `most` of the checks, evenly thinned, the last and the one that converged among them; after them `all`
/// where it is no check. Pointers into the history.
[[nodiscard]] std::vector<const stats::Checkpoint*> checks_to_show(const History& history, std::size_t most);

/// Sentence on a campaign whose last run had fewer points than are stored, with both numbers; else empty.
[[nodiscard]] std::string extent_note(const store::CampaignRecord& campaign);
/// Candidates, those left out by the `where` clause, cases asked and finished, in one line.
[[nodiscard]] std::string points_line(const Responses& responses);

[[nodiscard]] History history_of(const Responses& responses, const ResponseColumn& response);
/// The same without the checks on the way and their verdict, which take most of the time.
[[nodiscard]] History figures_of(const Responses& responses, const ResponseColumn& response);

/// One lattice of a family (same scene, factors and ranges) and how far its moments moved since the one before.
struct LatticeStep {
    std::string campaign;
    std::int64_t points = 0;
    stats::Summary summary;
    std::vector<double> changes;  ///< per stats::statistics, as a rule compares them; NaN at the first
};

/// A lattice is judged by its finer and coarser siblings: all lattices of the database that ask the same scene about
/// the same factors and ranges, by growing number of points. Empty where there is no second one.
[[nodiscard]] std::vector<LatticeStep> lattice_family(const store::Store& store, const Responses& responses,
                                                      const ResponseColumn& response);

}  // namespace grainsweep::study
