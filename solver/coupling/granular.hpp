// Kinetic theory of a granular phase: pressure, viscosity and conductivity of randomly colliding particles.
//
// Units: L, L^2/alpha, density of the fluid; Theta in (alpha/L)^2. a = phi_p, xi density ratio, d diameter, e
// restitution, a_max random close packing.
//   radial distribution  g0 = 1/(1 - (a/a_max)^(1/3))                        (Ogawa, Umemura & Oshima 1980)
//   solids pressure      p_s = xi a Theta (1 + 2 (1 + e) a g0)
//                                                             (Lun et al. 1984, doi 10.1017/S0022112084000586)
//   shear viscosity      mu = 4/5 xi a^2 d g0 (1 + e) sqrt(Theta/pi)
//                           + xi a d sqrt(pi Theta)/(6 (3 - e)) (1 + 2/5 (1 + e)(3 e - 1) a g0)
//                                                                 (Syamlal, Rogers & O'Brien 1993, DOE/METC-94/1004)
//   conductivity         k = 15 xi a d sqrt(pi Theta)/(4 (41 - 33 h))
//                            (1 + 12/5 h^2 (4 h - 3) a g0 + 16/(15 pi) (41 - 33 h) h a g0),  h = (1 + e)/2   (ibid.)
//   dissipation          gamma = 12 (1 - e^2) g0 xi a^2 Theta^(3/2)/(d sqrt(pi))                        (Lun et al.)
//   drag                 3 K Theta,  K = a Pr/St                                                      (Stokes)
// Each function returns its quantity divided by its power of Theta, so that the balance can be solved for Theta.
#pragma once

#include "solver/coupling/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::coupling {

struct Granular {
    double density_ratio = 1;     ///< xi
    double diameter = 0;          ///< d
    double restitution = 0.9;     ///< e of particle collisions, 0 ... 1
    double packing_limit = 0.63;  ///< a_max
    double drag = 0;              ///< K/a = Pr/St; 0: no fluid between the particles

    [[nodiscard]] static Granular of(const Sphere& sphere, double restitution, double packing_limit) {
        return {sphere.density_ratio, 2 * sphere.radius(), restitution, packing_limit, sphere.prandtl / sphere.stokes};
    }

    /// Returns g0, with a limited to below a_max: at most 3e4.
    [[nodiscard]] double radial_distribution(double a) const {
        return 1 / (1 - std::cbrt(std::min(a / packing_limit, 0.9999)));
    }
    /// Returns p_s/Theta.
    [[nodiscard]] double pressure(double a) const {
        return density_ratio * a * (1 + 2 * (1 + restitution) * a * radial_distribution(a));
    }
    /// Returns mu/sqrt(Theta).
    [[nodiscard]] double viscosity(double a) const {
        const double ag = a * radial_distribution(a);
        const double e = restitution;
        const double colliding = 0.8 * ag * (1 + e) * std::numbers::inv_sqrtpi;
        const double flying = root_pi / (6 * (3 - e)) * (1 + 0.4 * (1 + e) * (3 * e - 1) * ag);
        return density_ratio * a * diameter * (colliding + flying);
    }
    /// Returns k/sqrt(Theta).
    [[nodiscard]] double conductivity(double a) const {
        const double ag = a * radial_distribution(a);
        const double h = 0.5 * (1 + restitution);
        const double slow = 41 - 33 * h;
        return 15 * density_ratio * a * diameter * root_pi / (4 * slow) *
               (1 + 2.4 * h * h * (4 * h - 3) * ag + 16 / (15 * std::numbers::pi) * slow * h * ag);
    }
    /// Returns gamma/Theta^(3/2).
    [[nodiscard]] double dissipation(double a) const {
        const double e = restitution;
        return 12 * (1 - e * e) * radial_distribution(a) * density_ratio * a * a * std::numbers::inv_sqrtpi / diameter;
    }

    /// Returns Theta at which production equals dissipation, for strain S = sym grad v with S:S = `shear` and div v =
    /// `expansion`: the positive root s = sqrt(Theta) of
    ///   G s^2 + (P div v + 3 K) s - Q = 0,   Q = 2 M (S:S - (div v)^2/3),
    /// written without cancellation. 0 without production; `most` if Theta is unlimited.
    [[nodiscard]] double balance(double a, double shear, double expansion, double most) const {
        const double q = 2 * viscosity(a) * std::max(0.0, shear - expansion * expansion / 3);
        if (!(q > 0)) return 0;
        const double linear = pressure(a) * expansion + 3 * drag * a;
        const double root = linear + std::sqrt(linear * linear + 4 * dissipation(a) * q);
        if (!(root > 0)) return most;
        const double s = 2 * q / root;
        return std::min(s * s, most);
    }

private:
    static constexpr double root_pi = 1 / std::numbers::inv_sqrtpi;
};

}  // namespace grainsweep::coupling
