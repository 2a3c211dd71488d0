// Hypervolume that a front of two objectives dominates, and its expected growth by a further case.
//
// In losses u_k: y_k of a minimised objective, -y_k of a maximised one. The front u^1 ... u^n ascends in u_1 and
// descends in u_2; the reference point r is worse in both.
//
//   H = sum_{i=1}^n (u_1^{i+1} - u_1^i) (r_2 - u_2^i),   u_1^{n+1} = r_1
//
// Expected hypervolume improvement (Emmerich, Deutz & Klinkenberg 2011, IEEE Congr. Evol. Comput. 2147) of a case
// with independent normal losses of mean m_k and standard deviation s_k, summed over the strips u_1^i ... u_1^{i+1}
// between neighbours of the front (u_1^0 = -infinity, u_2^0 = r_2):
//
//   EHVI = sum_{i=0}^n [G_1(u_1^{i+1}) - G_1(u_1^i)] G_2(u_2^i)
//   G_k(t) = E max(t - u_k, 0) = (t - m_k) Phi(z) + s_k phi(z),   z = (t - m_k)/s_k;   G_1(-infinity) = 0
#pragma once

#include "stats/response_model.hpp"

#include <array>
#include <vector>

namespace grainsweep::stats {

/// Returns E max(gain, 0) of a normal gain: gain Phi(gain/error) + error phi(gain/error). `error` may be 0.
[[nodiscard]] double expected_positive(double gain, double error);

class Hypervolume {
public:
    Hypervolume(std::array<double, 2> reference, std::array<bool, 2> maximise);

    /// Adds a point. It counts if it is better than the reference in both objectives.
    void add(std::array<double, 2> point);
    [[nodiscard]] double value() const;
    /// Returns how much more a front may dominate that has further points between these, at most.
    [[nodiscard]] double between_points() const;
    /// Returns EHVI of a case with these predictions of its means.
    [[nodiscard]] double expected_gain(const Prediction& first, const Prediction& second) const;

private:
    [[nodiscard]] double loss(std::size_t objective, double y) const { return maximise_[objective] ? -y : y; }

    std::array<bool, 2> maximise_;
    std::array<double, 2> reference_;           ///< as losses
    std::vector<std::array<double, 2>> front_;  ///< losses, ascending in the first
};

}  // namespace grainsweep::stats
