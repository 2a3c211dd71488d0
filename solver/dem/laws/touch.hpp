// Kinematics of one touching pair, the input of contact laws, and their response.
//
// Signs: overlap d > 0, unit normal n from j (or wall) to i, v = v_i - v_j at the contact; the computed
// force acts on i, its reaction on j.
#pragma once

#include "solver/dem/laws/arithmetic.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::dem {

struct Material;
using geometry::Vec3;

/// Partner of particle i. A wall has R* = R and m* = m for any curvature.
enum class Partner { particle, wall };

/// Kinematics in double precision; fast/contact.hpp has the same names for lanes.
template <Partner of>
struct Touch {
    static constexpr Partner partner = of;
    using Arithmetic = dem::Arithmetic<double>;
    double overlap = 0;           ///< d, m
    double distance = 0;          ///< between centres, or from the centre to the wall, m
    double radius_i = 0;          ///< m
    double radius_j = 0;          ///< m; not used for a wall
    double effective_radius = 0;  ///< R*, m
    double reduced_mass = 0;      ///< m*, kg
    double root = 0;              ///< radius of the contact, Hertz's: sqrt(R* d), m
    double damping_root = 0;      ///< sqrt(m* root): damping is proportional to it
    Vec3 normal{};                ///< from j to i
    double normal_velocity = 0;   ///< v . n, negative while approaching, m/s
    Vec3 slip{};                  ///< tangential velocity of i relative to j at the contact, m/s; only if a law needs
                                  ///< spin
    Vec3 turning{};               ///< w_i - w_j, rad/s; only if a law resists rolling
    double rolling_inertia = 0;   ///< 1/(1/I_i + 1/I_j), I = 7/5 m R^2 about the contact, kg m2; only if a law resists
                                  ///< rolling
    double time_step = 0;         ///< s, by which memories advance
    bool touching = true;         ///< false: the pair is near, but no law makes it a contact
    bool apart = false;           ///< the bodies do not touch, but a law acts at a distance
    double rounding = 0;          ///< relative error of the forces by which a step has already cut the springs
    double rounded_speed = 0;     ///< speed of the bodies, of which this error is a share too, m/s

    /// Returns the limit above which a spring yields, `share` of the normal force. A spring that a step has cut equals
    /// its limit to the rounding error of the terms of this force, which may cancel. In a step itself there is no
    /// error.
    template <bool in_step, class R>
    [[nodiscard, gnu::always_inline]] double limit(double l, [[maybe_unused]] double share,
                                                   [[maybe_unused]] const R& r) const {
        if constexpr (in_step) return l;
        const double terms = std::max(std::abs(r.elastic), std::abs(r.seen)) + r.damping * rounded_speed;
        return std::max(l - rounding * (share * terms), 0.0);
    }

    /// Returns the damper of a coefficient, N s/m.
    [[nodiscard]] double damped(const Arithmetic::Damping& d) const { return d.coefficient * damping_root; }
    /// Returns a damper that is proportional to sqrt(m*) alone, N s/m.
    [[nodiscard]] double damped_by_mass(const Arithmetic::Damping& d) const {
        return d.coefficient * std::sqrt(reduced_mass);
    }
    /// Returns the same as damped(); lanes derive it from the known normal damper.
    [[nodiscard]] double damped_beside(const Arithmetic::Damping& d, double) const { return damped(d); }
    /// Returns strength times area, N. `lens`: the area has only a disc (at a wall: a cap).
    template <bool lens>
    [[nodiscard]] double over_area(const Arithmetic::AreaForce& f) const {
        const double cap = 2 * effective_radius - overlap;
        if constexpr (partner == Partner::wall) {
            const double area = f.form.wall_cap * cap * overlap;
            return f.strength * (lens ? area : area + f.form.wall_band * effective_radius * overlap);
        } else {
            const double sum = radius_i + radius_j, difference = radius_i - radius_j, r = distance;
            // (r - Ri - Rj) is minus the overlap, which is more accurate.
            const double disc = f.form.disc * overlap * (r + sum) * (r - difference) * (r + difference) / (r * r);
            if constexpr (lens) return f.strength * disc;
            return f.strength * (disc + f.form.band * effective_radius * overlap + f.form.cap * cap * overlap);
        }
    }
    /// Makes the pair a contact only if `holds`; for laws that reach beyond touch.
    void hold(bool holds) { touching = touching && holds; }
    /// Sets the radius of the contact instead of Hertz's.
    void touch_over(double contact_radius) {
        root = contact_radius;
        damping_root = std::sqrt(root * reduced_mass);
    }
    /// Sets whether the bodies are apart and have no springs; for laws that act at a distance.
    void part(double gap) { apart = gap > 0; }
    /// Returns x if the bodies touch or stick together, else 0.
    template <class X>
    [[nodiscard]] X kept(const X& x) const {
        return apart ? X{} : x;
    }
    /// Returns x if the pair is a contact, which is always true when laws are applied.
    [[nodiscard]] static double lasting(double x) { return x; }
};

/// Response: sum of the laws applied so far, in their order.
template <class Real>
struct Response {
    using Vector = typename Arithmetic<Real>::Vector;
    Real normal{};                             ///< along n, N; positive repels
    Real seen{};                               ///< normal force in the limits of friction and rolling, N
    Real elastic{};                            ///< part of it from the overlap alone, without damping and attraction, N
    Real damping{};                            ///< the normal damper, N s/m
    Vector resistance{};                       ///< minus the tangential force, N
    typename Arithmetic<Real>::Mask slides{};  ///< friction is at its limit
    Vector rolling{};  ///< minus the moment on i in addition to the moments of the forces; opposite sign on j, N m
};

/// Springs and dampers of a contact for small motions about its present state.
struct Springs {
    double normal = 0, tangential = 0, rolling = 0;                       ///< N/m, N/m, N m
    double normal_damper = 0, tangential_damper = 0, rolling_damper = 0;  ///< N s/m, N s/m, N m s
};

/// Moment of inertia of a sphere about a point of its surface, 7/5 m R^2, divided by m R^2.
inline constexpr double inertia_about_contact = 1.4;

/// Exponents of the units of a quantity. `inertia`: exponent of a moment of inertia about a contact, whose unit in
/// lanes is 7/5 m R^2.
struct Dimension {
    double length = 0, mass = 0, time = 0, inertia = 0;
};
inline constexpr Dimension number{}, length{.length = 1}, pressure{.length = -1, .mass = 1, .time = -2},
    root_of_pressure{.length = -0.5, .mass = 0.5, .time = -1}, energy_per_area{.mass = 1, .time = -2},
    force_per_length = energy_per_area, root_of_force_per_length{.mass = 0.5, .time = -1},
    moment{.length = 2, .mass = 1, .time = -2};

/// Constant of a law, in SI.
struct Quantity {
    double value = 0;
    Dimension dimension{};
};

/// Memory of a contact for a law, from step to step.
struct MemoryKind {
    int components = 0;
    double exchanged = 1;  ///< factor when i and j are exchanged: -1 for vectors from j to i
    Dimension dimension{};
};

/// Aspect of a contact that a law describes; a combination has at most one law for each.
enum class Aspect { normal, cohesion, sliding, rolling };

/// Default traits of a law.
struct LawTraits {
    static constexpr bool spin = false;   ///< needs the slip, and applies torques
    static constexpr bool rolls = false;  ///< resists rolling: needs `turning`
    static constexpr MemoryKind memory_kind{};
    /// Whether contacts may last beyond touch (negative overlap), up to beyond(material, R*), m. begin(touch, memory)
    /// then decides, before laws are applied, whether a near pair is a contact, and computes its radius. Only for
    /// combinations compiled for any spheres.
    static constexpr bool reaches = false;
    /// Whether only this law acts beyond touch.
    static constexpr bool acts_apart = false;
    static double beyond(const Material&, double) { return 0; }
    template <class T>
    void begin(T&, const void*) const {}
    /// Adds the springs and dampers of the law; in the order of the laws.
    template <class T>
    static void add_springs(const T&, Springs&) {}
    /// Whether the memory of a pair survives a separation: until the neighbour list is rebuilt, and longer if the pair
    /// touches again at that moment.
    static constexpr bool remembers_separation = false;
};

}  // namespace grainsweep::dem
