// Probability that a case at a setting has an answer, from the settings where cases failed.
//
// The outcomes unstable, rejected, crashed and timed out are failures. Two sources are used:
//
//   the scene's check   rejects impossible inputs, such as a particle larger than the gap. If it explains a rejected
//                       case, the border is known exactly and the probability beyond it is 0
//   a model             stats/probability_model.hpp of all other cases, on the features of the response models (the
//                       default features if a written feature has no number at a failed case)
//
// The nearest cases of a setting are the five nearest by the lengths of this model, so a factor that does not affect
// failures does not count in the distance. They are shown only.
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

/// Cases near a setting, with those that failed.
struct Near {
    std::size_t cases = 0;            ///< number of nearest cases; ties with the fifth are included
    std::vector<std::size_t> failed;  ///< indices of ModelCases::failed, ascending
};

/// Test whether failures of one outcome depend on the factors (stats/group_test.hpp).
struct OutcomeTest {
    campaign::Outcome outcome = campaign::Outcome::crashed;
    std::size_t cases = 0;  ///< failed ones with this outcome, without those that the scene's check explains
    double p_value = 1;
    std::vector<std::string> features;  ///< that differ by themselves; empty: none, or only several together

    [[nodiscard]] bool depends() const;
    /// Returns a sentence such as "unstable (24 cases) depends on d and u (p = 0.001)".
    [[nodiscard]] std::string text() const;
};

/// Probability model of answers. Cheap to copy, except for the rows of the cases.
class Answers {
public:
    explicit Answers(const ModelCases& cases);

    struct Answer {
        double probability = 1;
        double low = 1, high = 1;  ///< ends of its 95 % interval
    };
    /// Returns the probability of an answer at each setting; 1 everywhere if no case failed.
    [[nodiscard]] std::vector<Answer> at(std::span<const Setting> settings) const;
    /// Returns whether the probability of an answer is above 1/2; faster than at().
    [[nodiscard]] std::vector<bool> expected(std::span<const Setting> settings) const;
    [[nodiscard]] Near near(const Setting& setting) const;
    /// Returns one test for each outcome of failed cases, against the answered cases.
    [[nodiscard]] std::vector<OutcomeTest> tests(const ModelCases& cases) const;

private:
    [[nodiscard]] std::vector<double> rows(std::span<const Setting> settings) const;

    Features features_;
    std::function<bool(const Setting&)> possible_;
    std::optional<stats::ProbabilityModel> model_;  ///< empty: no failure is left that the check does not explain
    std::size_t failed_ = 0;
    std::vector<double> rows_, lengths_;  ///< of the failed cases, then of the answered ones
};

/// Returns a text such as "4 of the 5 nearest cases failed (3 crashed, 1 unstable)".
[[nodiscard]] std::string near_text(const ModelCases& cases, const Near& near);
/// Returns a text such as "12 of 40 cases failed (12 crashed)"; empty if no case failed. Cases that are left out do not
/// count.
[[nodiscard]] std::string failed_text(const ModelCases& cases);

/// Returns the outcomes that are left out, as a list.
[[nodiscard]] std::string left_out_text(const ModelCases& cases);

}  // namespace grainsweep::study
