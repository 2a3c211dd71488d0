// Whether the statistics of the campaign are good enough: values in, verdict out.
//
// Only gapless beginnings of the design are judged, block by block, so the verdict does not depend on the
// number of workers or on who finished first.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/store/store.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace grainsweep::schedule {

class Judge {
public:
    /// `placed` in the order of the plan; `known` values of what the archive already has (NaN: none).
    Judge(const campaign::Convergence& wanted, std::span<const campaign::PlacedCase> placed, std::size_t sequences,
          std::span<const double> known);

    /// The answer to a question, at every place where it is asked.
    void learn(const campaign::CaseId& id, const Observations& observations);
    /// Judges every block that lies within the first `settled` placed cases and was not judged before.
    [[nodiscard]] std::vector<store::ConvergenceRow> judge(std::size_t settled);
    /// Points of the prefix at which the statistics converged.
    [[nodiscard]] std::optional<std::int64_t> converged_at() const { return converged_at_; }
    [[nodiscard]] bool stops() const { return wanted_.stop; }
    /// The last verdict in one line: what holds it back and how many more points it probably takes.
    [[nodiscard]] const std::string& verdict() const { return verdict_; }

private:
    campaign::Convergence wanted_;
    std::size_t sequences_;
    std::vector<std::int64_t> points_;
    std::vector<std::size_t> sequence_of_;
    std::vector<double> values_;
    std::unordered_map<campaign::CaseId, std::vector<std::size_t>> places_;
    std::int64_t judged_blocks_ = 0;
    std::optional<std::int64_t> converged_at_;
    std::string verdict_;
};

}  // namespace grainsweep::schedule
