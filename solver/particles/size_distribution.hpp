// Diameters of powder particles, as a distribution by number of d/D.
//
//     equal      d = D
//     classes    d = d_k with share p_k: the five classes of Wu (2020), tables 3.2 and 3.3, there a discretised
//                Weibull distribution: 4.44, 22.76, 40.78, 26.91, 5.11 % with d = (1 + k w) D, k = -2 ... 2,
//                w = 0.15 (wide) or 0.1 (narrow). Their mean is (1 + 0.0549 w) D.
//     lognormal  ln d normal with standard deviation s, without the 0.5 % smallest and 0.5 % largest; the median is
//                chosen so that the mean of the truncated distribution is D
//     uniform    d uniform between (1 - w) D and (1 + w) D
//     table      a measured table: size_table.hpp
// With a = Phi^-1(0.995) and median m the moments of the truncated lognormal are
//     E[d^k] = m^k exp(k^2 s^2/2) (Phi(a - k s) - Phi(-a - k s))/0.99.
#pragma once

#include "solver/particles/size_table.hpp"

#include <numbers>
#include <variant>

namespace grainsweep::particles {

[[nodiscard]] inline double sphere_volume(double diameter) {
    return std::numbers::pi / 6 * diameter * diameter * diameter;
}

class SizeDistribution {
public:
    /// Makes equal sizes.
    SizeDistribution() = default;
    /// Returns Wu's five classes, `width` D apart; 0 < width < 0.5.
    [[nodiscard]] static SizeDistribution weibull_classes(double width);
    /// Returns a lognormal distribution; spread >= 0: standard deviation of ln d before truncation.
    [[nodiscard]] static SizeDistribution lognormal(double spread);
    /// Returns a uniform distribution; 0 <= half_width < 1, relative to D.
    [[nodiscard]] static SizeDistribution uniform(double half_width);
    /// Returns the distribution of a table with diameters in units of D.
    [[nodiscard]] static SizeDistribution table(SizeTable sizes);

    /// Returns whether there is one size without draws. False for a lognormal without spread, which draws and always
    /// gets D.
    [[nodiscard]] bool equal() const { return std::holds_alternative<Equal>(law_); }
    /// Returns d/D below which the share u of all particles lies, 0 <= u < 1. A uniform u gives a draw.
    [[nodiscard]] double diameter(double u) const;
    [[nodiscard]] double smallest() const;
    [[nodiscard]] double largest() const;
    /// Returns E[(d/D)^power], power >= 0.
    [[nodiscard]] double moment(int power) const;

private:
    struct Equal {};
    struct Classes {
        double width = 0;
    };
    struct Lognormal {
        double spread = 0, median = 1;
    };
    struct Uniform {
        double half_width = 0;
    };
    std::variant<Equal, Classes, Lognormal, Uniform, SizeTable> law_;
};

}  // namespace grainsweep::particles
