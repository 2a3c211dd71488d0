// A campaign as the study needs it: factors and responses, column by column.
#pragma once

#include "sweep/designs/design.hpp"
#include "sweep/store/store.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::study {

/// What was varied. Continuous: `values` in its unit. With levels: `values` are indices into `levels`.
struct FactorColumn {
    std::string name, unit, meaning;
    std::vector<std::string> levels;  ///< as text, in the order of the campaign file; empty: continuous
    double low = 0, high = 0;         ///< continuous: the range (stats::Distribution::range)
    bool log = false;                 ///< the range is divided logarithmically
    std::optional<stats::Distribution> distribution = {};  ///< none: levels, or a range
    bool stepped = false;                                  ///< values of the range are multiples of a step
    bool conditional = false;         ///< where it does not count it has its default, which may be out of the range
    std::vector<double> values;       ///< one per row
    std::vector<double> shares = {};  ///< its coordinate per row, where values alone have none
    std::vector<double> places;       ///< of the levels among those of the campaign: 0 the first, 1 the last

    [[nodiscard]] bool continuous() const { return levels.empty(); }
    /// Place of the row in the range, 0 to 1; of a distribution the probability of less. A default outside
    /// of the range is at the nearer end. A level counts by its place among the campaign's levels, run or
    /// not.
    [[nodiscard]] double coordinate(std::size_t row) const;
};

/// What was measured: one scalar observable, NaN where a case has none.
struct ResponseColumn {
    std::string name, unit, meaning;
    std::vector<double> values;
};

/// A place of the design whose case stands at an earlier place, too.
struct RepeatedPlace {
    std::int64_t point = 0;
    std::size_t row = 0;  ///< of that case
};

/// One row per case, at the first place where it stands, ordered by (point, replicate): a case that several points ask
/// about is one run, and counts once. A lattice or a list, whose order means nothing, has first the rows with a final
/// outcome, then the others.
struct Responses {
    store::CampaignRecord campaign;
    std::vector<std::int64_t> points, replicates;
    std::vector<RepeatedPlace> repeated;  ///< ordered by point
    std::vector<std::string> case_ids;
    std::vector<std::optional<campaign::Outcome>> outcomes;
    std::vector<FactorColumn> factors;
    std::vector<std::size_t> groups;       ///< number of each factor's group in saltelli and morris
    std::vector<std::string> group_names;  ///< of a factor by itself its own
    bool repeats_weigh = false;            ///< in moments, a case weighs as many places as hold it
    bool folds = false;  ///< steps, shares or conditions: a point's values do not tell its place in the design
    std::vector<ResponseColumn> observables;
    /// Of a campaign under the rule `assisted`: its checks, as they were judged in the run. Their models are not fitted
    /// again to be shown.
    std::vector<store::ConvergenceRow> judged_checks;
    std::int64_t candidates = 0;  ///< points the design numbers, those filtered out by `where` included
    /// Rows of the gapless beginning (a lattice, a list: all those) with a final outcome, cut where the campaign
    /// converged and stopped: what statistics are over. A case given up after crashes has one.
    std::size_t settled = 0;
    std::int64_t settled_points = 0;  ///< end of the design points in that beginning

    /// What statistics are over: of a design with an order the candidates before `settled_points`, else the points
    /// that have settled rows.
    [[nodiscard]] std::int64_t counted_points() const;
    [[nodiscard]] std::size_t rows() const { return points.size(); }
    /// The first `settled` values of a response.
    [[nodiscard]] std::span<const double> judged(const ResponseColumn& response) const {
        return std::span(response.values).first(settled);
    }
    /// Places before `settled_points` that repeat a settled row.
    [[nodiscard]] std::vector<RepeatedPlace> settled_repeats() const;
    /// Settled rows without a value.
    [[nodiscard]] std::size_t without_value(const ResponseColumn& response) const;
    /// Rows with a final outcome, wherever they stand.
    [[nodiscard]] std::size_t finished() const;
    /// Every value there is: the judged ones and, unless the campaign stopped, those of finished cases behind one that
    /// is not.
    [[nodiscard]] std::span<const double> known(const ResponseColumn& response) const {
        return std::span(response.values).first(campaign.stopped_at ? settled : rows());
    }
    /// Points the design numbers that the `where` clause leaves out.
    [[nodiscard]] std::int64_t dropped() const;
    [[nodiscard]] const designs::DesignInfo& design() const;
    /// Main observable: the one of the convergence rule, else the first on which later points of the design rest (a
    /// calibration's first target), else the scene's first with a value, else its first. None without scalars.
    [[nodiscard]] const ResponseColumn* main_observable() const;
    /// Throws WrongQuestion with the nearest name. Empty: the main observable.
    [[nodiscard]] const ResponseColumn& observable(std::string_view name) const;
    /// Whether it has a scalar of this name; any, where the name is empty.
    [[nodiscard]] bool measures(std::string_view name) const;
    /// Whether statistics can settle along the design: its beginnings are samples, or listed and judged by a rule.
    [[nodiscard]] bool ordered_sample() const;
};

/// Throws WrongQuestion with the nearest name, or that there is none where the name is empty.
[[nodiscard]] const ResponseColumn& named_observable(std::span<const ResponseColumn> observables, std::string_view name,
                                                     const store::CampaignRecord& campaign);

/// Whether a case will not be computed any more in this run of its campaign.
[[nodiscard]] bool has_final_outcome(const std::optional<campaign::Outcome>& outcome);

/// Whether the sequences of the design repeat one another independently.
[[nodiscard]] bool repeats(const Responses& responses);

[[nodiscard]] Responses read_responses(const store::Store& store, const store::CampaignRecord& campaign);

/// One observable alone, without factors and case ids: what a verdict needs, in a fraction of the time.
[[nodiscard]] Responses read_response(const store::Store& store, const store::CampaignRecord& campaign,
                                      const std::string& observable);

/// The records of the named campaign, or of all where the name is empty. Throws WrongQuestion with the nearest name,
/// or where the database holds no campaign.
[[nodiscard]] std::vector<store::CampaignRecord> find_campaigns(const store::Store& store, std::string_view name);

/// Number of rows with each outcome, in the order of campaign::outcomes; the last entry counts rows not there yet.
[[nodiscard]] std::vector<std::pair<std::string, std::int64_t>> count_outcomes(const Responses& responses);

/// All rows, or so many of them at random (the same every time), in their order. Every k-th point of a low-discrepancy
/// sequence would show a pattern that the sequence has not.
[[nodiscard]] std::vector<std::size_t> random_rows(std::vector<std::size_t> rows, std::size_t most);
/// The `count` rows with the largest (or smallest) finite values, best first; equal values by row.
[[nodiscard]] std::vector<std::size_t> extreme_rows(std::span<const double> values, std::size_t count, bool largest);

/// NaN where it is no number.
[[nodiscard]] double number_of(const store::Table::Cell& cell);

/// A factor's value at a row as text: the level's word, or the number to 6 digits.
[[nodiscard]] std::string factor_text(const FactorColumn& factor, std::size_t row);

}  // namespace grainsweep::study
