// How likely a case at a setting has an answer, from where cases failed.
//
// Outcomes that a case earns by itself (unstable, rejected, crashed, timed out) are failures. Two things are known:
//
//   the scene's own check   settings whose inputs do not go together (a particle larger than the gap) are rejected;
//   where
//                           it explains a rejected case the border is known exactly, and the probability beyond it is 0
//   a model of the rest     stats/probability_model.hpp on the features of the response models (the default ones where
//   a
//                           written feature has no number at a failed case); cases that the check explains are left out
//
// Cases near a setting are the five nearest by the lengths that this model learned, so that a factor which does not
// decide where cases fail brings none nearer. They are shown and decide nothing.
#pragma once

#include "stats/probability_model.hpp"
#include "sweep/study/response_models.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

/// Failed cases near a setting.
struct Near {
    std::size_t cases = 0;            ///< nearest cases that were counted; as near as the fifth counts, too
    std::vector<std::size_t> failed;  ///< those that failed: indices of ModelCases::failed, growing
};

/// Cheap to copy, but for the rows of the cases.
class Answers {
public:
    explicit Answers(const ModelCases& cases);

    struct Answer {
        double probability = 1;
        double low = 1;  ///< lower end of its 95 % interval
    };
    /// Both are 1 everywhere where no case failed.
    [[nodiscard]] std::vector<Answer> at(std::span<const Setting> settings) const;
    /// Whether an answer is likelier than none, which is faster.
    [[nodiscard]] std::vector<bool> expected(std::span<const Setting> settings) const;
    [[nodiscard]] Near near(const Setting& setting) const;

private:
    [[nodiscard]] std::vector<double> rows(std::span<const Setting> settings) const;

    Features features_;
    std::function<bool(const Setting&)> possible_;
    std::optional<stats::ProbabilityModel> model_;  ///< none: no failure is left to be explained
    std::size_t failed_ = 0;
    std::vector<double> rows_, lengths_;  ///< of the failed cases, then of the answered ones
};

/// "4 of the 5 nearest cases failed (3 crashed, 1 unstable)"
[[nodiscard]] std::string near_text(const ModelCases& cases, const Near& near);
/// "12 of 40 cases failed (12 crashed)"; empty where none did.
[[nodiscard]] std::string failed_text(const ModelCases& cases);

}  // namespace grainsweep::study
