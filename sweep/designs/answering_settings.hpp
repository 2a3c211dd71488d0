// Settings of a calibration at which a case has an answer to every target.
//
// A failed case may have nothing to do with its setting: a licence, a node, a bug. Failures are used only if they
// depend on the factors (stats/group_test.hpp, p <= 0.01), and then as a model of the factors on which they depend
// (stats/probability_model.hpp), all of them if no factor by itself is significant. The model gives P(answer) with its
// error:
//
//   ruled out            P plus 1.96 standard errors is below 1/2
//   weight of the rest   P, because the measured process has an answer
#pragma once

#include "stats/probability_model.hpp"
#include "stats/response_model.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace grainsweep::designs {

/// Largest probability, of a difference as large by chance, at which failures count as dependent on the factors.
inline constexpr double dependence_level = 0.01;

class AnsweringSettings {
public:
    /// Every setting has an answer.
    AnsweringSettings() = default;
    /// `settings`: in [0, 1]^d; `failed`: whether a setting has no answer to some target.
    AnsweringSettings(stats::Rows settings, const std::vector<bool>& failed);

    /// Returns log P(answer) at each point; 0 if failures do not depend on the factors, minus infinity where a setting
    /// is ruled out.
    [[nodiscard]] std::vector<double> log_weights(stats::Rows points) const;
    /// Returns whether some settings have a smaller weight than others.
    [[nodiscard]] bool decides() const { return model_.has_value(); }
    /// Returns the p value of the test; empty: no setting failed.
    [[nodiscard]] std::optional<double> p_value() const { return p_value_; }
    /// Returns the indices of the factors on which failures depend.
    [[nodiscard]] const std::vector<std::size_t>& factors() const { return factors_; }

private:
    [[nodiscard]] std::vector<double> features(stats::Rows points) const;

    std::optional<double> p_value_;
    std::vector<std::size_t> factors_;
    std::optional<stats::ProbabilityModel> model_;
};

}  // namespace grainsweep::designs
