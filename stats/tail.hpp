// The end of a distribution, continued beyond the values that were seen, and what it adds to the error of a mean.
//
// Of n values the m farthest at one end follow a generalised Pareto distribution: at the share p from the end
//
//   y(p) = y_m + beta/xi ((p n/m)^-xi - 1)
//
// with xi and beta from probability-weighted moments (Hosking & Wallis 1987, Technometrics 29, 339, with k = -xi). The
// estimate of xi is raised by 3.5 m^(-3/4), 1.5 standard errors for m = 32 and 1 for 128: the fewer values, the sooner
// the tail counts as endless. A design of R even sequences draws each of the outermost shares
// R/n from R independent places, so that the mean of f(y) has at least the variance
//
//   sum over these shares k of (1/R) (R/n)^2 Var[f(y) within share k]
//
// Unlike the scatter between the sequences, this variance hardly depends on whether a rare large value was drawn.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// Half-width of a 95 % interval in standard errors of such a sum of few values; the least that holds for exponential
/// tails.
inline constexpr double tail_95 = 2.8;

class Tail {
public:
    /// Returns the upper or lower tail of ascending values of which `together` (R) share a stratum; none of fewer than
    /// 120 values, if the farthest are all equal, or if they seem to end (xi <= 0). `endless`: the caller has other
    /// evidence that they do not end; xi is then 0.05 at least.
    [[nodiscard]] static std::optional<Tail> of(std::span<const double> sorted, bool upper, std::size_t together,
                                                bool endless = false);

    /// Returns the variance above. `f` is called at places of the tail, whole strata at a time.
    template <class Function>
    [[nodiscard]] double variance_of_mean(const Function& f) const {
        double variance = 0;
        for (std::size_t k = 0; k < strata; ++k) {
            double sum = 0, squares = 0;
            for (std::size_t i = 0; i < places; ++i) {
                const double y = f(values_[k * places + i]);
                sum += y / places;
                squares += y * y / places;
            }
            variance += weight_ * (squares - sum * sum);
        }
        return variance > 0 ? variance : 0;
    }

    [[nodiscard]] double shape() const { return shape_; }
    /// Returns whether xi is above 0.1 without what is added to it.
    [[nodiscard]] bool surely_endless() const { return surely_endless_; }

private:
    static constexpr std::size_t strata = 4, places = 64;

    double shape_ = 0, weight_ = 0;
    bool surely_endless_ = false;
    std::vector<double> values_;  ///< (strata, places)
};

/// Returns the lower and the upper tail of ascending values, as far as there are any; arguments as of Tail::of.
[[nodiscard]] std::vector<Tail> tails_of(std::span<const double> sorted, std::size_t together, bool endless = false);

}  // namespace grainsweep::stats
