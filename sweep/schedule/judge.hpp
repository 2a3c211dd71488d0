// Decides from the values of a campaign whether its statistics are good enough.
//
// Only prefixes of the design are judged, block by block, so the verdict depends neither on the number of workers nor
// on the order in which cases finish. A block is `block` design points; points that the `where` clause excludes
// contribute nothing. A case that stands at several points counts once, at the first of them. A case without an answer
// (unstable, rejected, given up) is left out and counted. The rules and their errors are in stats/convergence.hpp. The
// rule `assisted` has fewer checks, which take time: stats/assisted_convergence.hpp and assisted_judge.hpp.
#pragma once

#include "stats/convergence.hpp"
#include "sweep/campaign/campaign.hpp"
#include "sweep/schedule/assisted_judge.hpp"
#include "sweep/store/store.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::schedule {

class Judge {
public:
    /// `placed`: cases in the order of the plan (point, replicate). `known`: their stored values (NaN: none).
    /// `sequences`: number of independent sequences, see independent_sequences(). `candidates`: number of points of the
    /// design before `where` filters them. Without it, a last block whose last points were filtered out is not judged.
    /// `view`: only for the rule `assisted`.
    /// `repeats_weigh`: a run weighs as many places as hold it (campaign::repeats_weigh); else it counts once.
    /// Throws std::invalid_argument for settings that cannot be judged (`replicates` with fewer than 4 sequences,
    /// `assisted` without a view).
    Judge(const campaign::Convergence& wanted, campaign::Cases placed, std::size_t sequences, std::vector<double> known,
          std::optional<std::int64_t> candidates = {}, std::optional<ModelView> view = {}, bool repeats_weigh = false);

    /// Stores the answer of a case at every place where the case stands. Without the judged scalar it counts as no
    /// answer.
    void learn(const campaign::CaseId& id, const Observations& observations);
    /// Judges every block that lies within the first `settled` placed cases and was not judged before. If convergence
    /// stops the campaign, no block after the converged one is judged. `Models`: wait for checks that fit models, or
    /// make them on a thread; a later call then takes their results.
    enum class Models { awaited, beside };
    [[nodiscard]] std::vector<store::ConvergenceRow> judge(std::size_t settled, Models models = Models::awaited);
    /// Returns whether a check is being made.
    [[nodiscard]] bool busy() const { return assisted_ && assisted_->busy(); }
    /// Returns the points of the prefix at which the statistics converged.
    [[nodiscard]] std::optional<std::int64_t> converged_at() const;
    [[nodiscard]] bool stops() const { return wanted_.stop; }
    /// Returns the share of the design's points after which convergence is expected to stop the campaign. Empty:
    /// convergence does not stop the campaign, or no check gives an estimate yet.
    [[nodiscard]] std::optional<double> expected_share() const;
    /// Returns whether checks of more points than `stop` have not converged: the earlier stop there came from another
    /// rule.
    [[nodiscard]] bool overturns(std::int64_t stop) const;
    /// Returns the last verdict in one line: the statistic that is not converged yet, and how many more points it
    /// probably needs.
    [[nodiscard]] const std::string& verdict() const { return verdict_; }

private:
    void feed(std::size_t settled);
    [[nodiscard]] std::span<const stats::Checkpoint> checkpoints() const;

    campaign::Convergence wanted_;
    stats::ConvergenceSettings settings_;
    std::unique_ptr<stats::Convergence> plain_;  ///< either this or assisted_
    std::unique_ptr<AssistedJudge> assisted_;
    std::int64_t candidates_;
    campaign::Cases placed_;
    std::vector<double> values_;     ///< of each place
    std::vector<std::int64_t> met_;  ///< places seen of each run, by the first place of the run; empty: a run counts
                                     ///< once
    std::size_t fed_ = 0;            ///< placed cases the statistics have seen
    std::size_t judged_ = 0;         ///< blocks judged
    std::string verdict_;
};

/// Returns how many sequences of a design are independent replicates of one another. For `saltelli` and `morris`, whose
/// sequences are parts of one estimate: 1.
[[nodiscard]] std::size_t independent_sequences(std::string_view design, std::size_t sequences);

/// Returns the settings of the rule that the campaign file names. Throws std::invalid_argument for an unknown word.
[[nodiscard]] stats::ConvergenceSettings settings_of(const campaign::Convergence& wanted, std::size_t sequences);

/// Returns a check as a row of the database.
[[nodiscard]] store::ConvergenceRow row_of(const stats::Checkpoint& check, std::string_view observable);

/// Returns a check in one line: "kurtosis 1.4 % > 1 %, about 800 more points". `candidates`: points of the design.
[[nodiscard]] std::string verdict_of(const stats::Checkpoint& check, const stats::ConvergenceSettings& settings,
                                     std::int64_t candidates);

}  // namespace grainsweep::schedule
