// Whether the statistics of the campaign are good enough: values in, verdict out.
//
// Only gapless beginnings of the design are judged, block by block, so the verdict does not depend on the
// number of workers or on the order of finishing. A block is `block` design points; those that the `where` clause
// filtered out contribute nothing. A case that stands at several points counts once, at the first of them. A case
// without an answer (unstable, rejected, given up) is left out and counted. The rules and their errors:
// stats/convergence.hpp; of `assisted`, whose checks are fewer and take time: stats/assisted_convergence.hpp and
// assisted_judge.hpp.
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
    /// `placed` in the order of the plan (point, replicate); `known` values of what the archive already has
    /// (NaN: none). `sequences` that repeat one another independently, see independent_sequences().
    /// `candidates`: how many points the design numbers, before `where` filters them; where it is not given,
    /// a last block whose last points were filtered out is not judged.
    /// `view`: what the rule `assisted` needs, and no other.
    /// `repeats_weigh`: a run weighs as many places as hold it (campaign::repeats_weigh); else it counts once.
    /// Throws std::invalid_argument for settings that cannot be judged (`replicates` with fewer than 4 sequences,
    /// `assisted` without a view).
    Judge(const campaign::Convergence& wanted, campaign::Cases placed, std::size_t sequences, std::vector<double> known,
          std::optional<std::int64_t> candidates = {}, std::optional<ModelView> view = {}, bool repeats_weigh = false);

    /// The answer to a question, at every place where it is asked. No such scalar: no answer.
    void learn(const campaign::CaseId& id, const Observations& observations);
    /// Judges every block that lies within the first `settled` placed cases and was not judged before. Where
    /// convergence stops the campaign, nothing after the block that converged. Checks that fit models are waited for,
    /// or made beside: then a later call brings what they say.
    enum class Models { awaited, beside };
    [[nodiscard]] std::vector<store::ConvergenceRow> judge(std::size_t settled, Models models = Models::awaited);
    /// A check is under way.
    [[nodiscard]] bool busy() const { return assisted_ && assisted_->busy(); }
    /// Points of the prefix at which the statistics converged.
    [[nodiscard]] std::optional<std::int64_t> converged_at() const;
    [[nodiscard]] bool stops() const { return wanted_.stop; }
    /// Share of the design's points after which convergence is expected to stop the campaign; none: it stops nothing,
    /// or no check has said yet.
    [[nodiscard]] std::optional<double> expected_share() const;
    /// Whether checks have come past so many points without convergence: an earlier stop there was of another rule.
    [[nodiscard]] bool overturns(std::int64_t stop) const;
    /// The last verdict in one line: what holds it back and how many more points it probably takes.
    [[nodiscard]] const std::string& verdict() const { return verdict_; }

private:
    void feed(std::size_t settled);
    [[nodiscard]] std::span<const stats::Checkpoint> checkpoints() const;

    campaign::Convergence wanted_;
    stats::ConvergenceSettings settings_;
    std::unique_ptr<stats::Convergence> plain_;  ///< one of the two
    std::unique_ptr<AssistedJudge> assisted_;
    std::int64_t candidates_;
    campaign::Cases placed_;
    std::vector<double> values_;     ///< of each place
    std::vector<std::int64_t> met_;  ///< of each run, by its first place: places seen; empty: a run counts once
    std::size_t fed_ = 0;            ///< placed cases the statistics have seen
    std::size_t judged_ = 0;         ///< blocks judged
    std::string verdict_;
};

/// How many sequences of a design repeat one another independently. Those of `saltelli` and `morris` are parts of
/// one estimate: 1.
[[nodiscard]] std::size_t independent_sequences(std::string_view design, std::size_t sequences);

/// The words of a campaign file -> the settings of the rule. Throws std::invalid_argument for an unknown word.
[[nodiscard]] stats::ConvergenceSettings settings_of(const campaign::Convergence& wanted, std::size_t sequences);

/// A check as the archive keeps it.
[[nodiscard]] store::ConvergenceRow row_of(const stats::Checkpoint& check, std::string_view observable);

/// A check in one line: "kurtosis 1.4 % > 1 %, about 800 more points". `candidates`: points of the design.
[[nodiscard]] std::string verdict_of(const stats::Checkpoint& check, const stats::ConvergenceSettings& settings,
                                     std::int64_t candidates);

}  // namespace grainsweep::schedule
