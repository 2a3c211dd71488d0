// Factors and responses of a campaign, column by column.
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

/// Factor and its values. Continuous: `values` in its unit. With levels: `values` are indices into `seen`.
struct FactorColumn : campaign::Factor {
    std::string meaning = {};
    std::vector<Value> seen = {};  ///< levels that occur, in the order of the campaign file, then others
    /// One per row. Where the factor does not count, its default, which may lie outside the range.
    std::vector<double> values = {};
    std::vector<double> shares = {};  ///< its coordinate per row, if the value alone does not determine it
    std::vector<double> places = {};  ///< coordinate of each level in the campaign's list: 0 the first, 1 the last

    /// Returns the position of the row's value in the range, 0 to 1; for a distribution, the cumulative probability. A
    /// default outside the range is at the nearer end. A level has its position in the campaign's list, whether its
    /// cases have run or not.
    [[nodiscard]] double coordinate(std::size_t row) const;
    /// Returns the levels that occur as text: numbers with 6 digits, files by their names.
    [[nodiscard]] std::vector<std::string> seen_texts() const;
    /// Returns the levels that occur as numbers; empty if one is a word.
    [[nodiscard]] std::vector<double> seen_numbers() const;
};

/// Values of one scalar observable; NaN where a case has none.
struct ResponseColumn {
    std::string name, unit, meaning;
    std::vector<double> values;
};

/// Place of the design whose case also stands at an earlier place.
struct RepeatedPlace {
    std::int64_t point = 0;
    std::size_t row = 0;  ///< row of the case
};

/// Responses of a campaign: one row per case, at its first place, ordered by (point, replicate). A case that stands at
/// several points is one run and counts once. For a lattice or a list, whose order has no meaning, rows with a final
/// outcome come first.
struct Responses {
    store::CampaignRecord campaign;
    std::vector<std::int64_t> points, replicates;
    std::vector<RepeatedPlace> repeated;  ///< ordered by point
    std::vector<std::string> case_ids;
    std::vector<std::optional<campaign::Outcome>> outcomes;
    std::vector<FactorColumn> factors;
    std::vector<std::size_t> groups;       ///< number of each factor's group in saltelli and morris
    std::vector<std::string> group_names;  ///< a single factor has its own name
    bool repeats_weigh = false;            ///< in moments, the weight of a case is the number of its places
    bool folds = false;  ///< steps, shares or conditions: the values of a point do not determine its place in the
                         ///< design
    std::vector<ResponseColumn> observables;
    /// Checks of a campaign with the rule `assisted`, as stored by the run. Their models are not fitted again for
    /// display.
    std::vector<store::ConvergenceRow> judged_checks;
    std::vector<Responses> imported;  ///< cases computed elsewhere that the design does not place; for models alone
    std::int64_t candidates = 0;      ///< points of the design, including those that `where` excludes
    /// Number of rows from which statistics are computed: the prefix in which every case has a final outcome, at most
    /// to the point of convergence. For a lattice or a list: all rows with a final outcome. A case given up after
    /// crashes has a final outcome.
    std::size_t settled = 0;
    std::int64_t settled_points = 0;  ///< number of design points in that prefix

    /// Returns the number of points behind the statistics: for a design with an order the candidates before
    /// `settled_points`, else the points with settled rows.
    [[nodiscard]] std::int64_t counted_points() const;
    [[nodiscard]] std::size_t rows() const { return points.size(); }
    /// Returns the first `settled` values of a response.
    [[nodiscard]] std::span<const double> judged(const ResponseColumn& response) const {
        return std::span(response.values).first(settled);
    }
    /// Returns the places before `settled_points` that repeat a settled row.
    [[nodiscard]] std::vector<RepeatedPlace> settled_repeats() const;
    /// Returns the number of settled rows without a value.
    [[nodiscard]] std::size_t without_value(const ResponseColumn& response) const;
    /// Returns the number of rows with a final outcome, at any place.
    [[nodiscard]] std::size_t finished() const;
    /// Returns all values: the judged ones and, unless the campaign stopped, those of finished cases behind an
    /// unfinished one.
    [[nodiscard]] std::span<const double> known(const ResponseColumn& response) const {
        return std::span(response.values).first(campaign.stopped_at ? settled : rows());
    }
    /// Returns the number of points of the design that the `where` clause excludes.
    [[nodiscard]] std::int64_t dropped() const;
    [[nodiscard]] const designs::DesignInfo& design() const;
    /// Returns the observable of the convergence rule. Without a rule it is the observable that decides later points of
    /// the design (a calibration's first target). nullptr: nothing decides.
    [[nodiscard]] const ResponseColumn* deciding_observable() const;
    /// Returns the main observable; nullptr without scalars. It is the deciding observable, else the scene's first
    /// observable with a value, else its first.
    [[nodiscard]] const ResponseColumn* main_observable() const;
    /// Returns the observable of this name; empty name: the main observable. Throws InputError with the nearest
    /// name.
    [[nodiscard]] const ResponseColumn& observable(std::string_view name) const;
    /// Returns whether there is a scalar of this name; empty name: any scalar.
    [[nodiscard]] bool measures(std::string_view name) const;
    /// Returns whether statistics can converge along the design: its prefixes are samples, or it is a list with a
    /// convergence rule.
    [[nodiscard]] bool ordered_sample() const;
};

/// Returns the observable of this name. Throws InputError with the nearest name, or, for an empty name, with the
/// message that there is none.
[[nodiscard]] const ResponseColumn& named_observable(std::span<const ResponseColumn> observables, std::string_view name,
                                                     const store::CampaignRecord& campaign);

/// Returns whether the outcome is final: the case is not computed again in this run.
[[nodiscard]] bool has_final_outcome(const std::optional<campaign::Outcome>& outcome);
/// Returns whether the outcome is final and no answer.
[[nodiscard]] bool has_failed(const std::optional<campaign::Outcome>& outcome);

/// Returns whether the sequences of the design are independent replicates of one another.
[[nodiscard]] bool repeats(const Responses& responses);

[[nodiscard]] Responses read_responses(const store::Store& store, const store::CampaignRecord& campaign);

/// Reads one observable without factors and case ids, which is enough for a verdict and much faster.
[[nodiscard]] Responses read_response(const store::Store& store, const store::CampaignRecord& campaign,
                                      const std::string& observable);

/// Returns the record of the named campaign; empty name: of all campaigns. Throws InputError with the nearest name,
/// or if the database has no campaign.
[[nodiscard]] std::vector<store::CampaignRecord> find_campaigns(const store::Store& store, std::string_view name);

/// Returns the number of rows with each outcome, in the order of campaign::outcomes. The last entry counts rows without
/// an outcome.
[[nodiscard]] std::vector<std::pair<std::string, std::int64_t>> count_outcomes(const Responses& responses);

/// Returns all rows, or `most` of them at random (always the same), in their order. Every k-th point of a
/// low-discrepancy sequence would show a pattern that the sequence does not have.
[[nodiscard]] std::vector<std::size_t> random_rows(std::vector<std::size_t> rows, std::size_t most);
/// Returns the `count` rows with the largest (or smallest) finite values, best first; equal values by row.
[[nodiscard]] std::vector<std::size_t> extreme_rows(std::span<const double> values, std::size_t count, bool largest);

/// Returns the number in a cell; NaN if it is no number.
[[nodiscard]] double number_of(const store::Table::Cell& cell);

/// Returns a factor's value at a row as text: the word of the level, or the number with 6 digits.
[[nodiscard]] std::string factor_text(const FactorColumn& factor, std::size_t row);

}  // namespace grainsweep::study
