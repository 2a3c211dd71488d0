// Limit of a spring and the dashpot beside it: Coulomb's of the tangential force, and the limit of a rolling moment.
//
//     spring := spring min(1, L/|spring|)                       L: friction times the normal force
//     sum:      F = spring + dashpot min(1, (L - |spring|)/|dashpot|)
//     spring:   F = spring + dashpot, without the dashpot where the spring was cut
//
// By `sum` the dashpot has what the spring leaves, so |F| <= L, and |F| = L in gross sliding from touch to separation.
// Luding (2008), Granular Matter 10, 235, and LAMMPS give the spring what the dashpot leaves: the same F in gross
// sliding. But a dashpot beyond L then reverses the spring, which stores energy without any work. By `spring` the sum
// is not limited (LIGGGHTS 3.8): an impact in gross sliding has a tangential impulse of 1.17 mu times the normal one at
// a restitution of 0.5, and 1.68 mu at 0.2.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/dem/material.hpp"

namespace grainsweep::dem {

template <class Real>
class SlidingLimit {
    using A = Arithmetic<Real>;

public:
    /// Returns the number that a law stores among its constants.
    static Quantity constant_of(const Material& m) {
        return {m.tangential_limit == TangentialLimit::sum ? 1.0 : 0.0, number};
    }
    explicit SlidingLimit(double sum) : least(A::number(sum > 0 ? 0 : 1e15)), tension_(A::number(sum - 1)) {}

    Real least;  ///< least that a spring leaves to its dashpot: 0, or any force if the sum is not limited

    /// Returns the size of the normal force of the limit: an attractive one counts as 0; by `spring`, by its size.
    [[gnu::always_inline]] Real normal(Real seen) const { return A::larger(seen, tension_ * seen); }
    /// Returns the damper that acts beside a spring at this velocity.
    template <class Cut>
    [[gnu::always_inline]] Real damper(const Cut& spring, Real whole, const typename A::Vector& velocity) const {
        return A::smaller(A::drop(spring.exceeds, whole), A::over_length(spring.left, velocity));
    }

private:
    Real tension_;  // factor of an attractive normal force: 0, or -1
};

}  // namespace grainsweep::dem
