// Kinematics of one touching pair, the input of contact laws, and their response.
//
// Signs: overlap d > 0, unit normal n from j (or wall) to i, v = v_i - v_j at the contact; the computed
// force acts on i, its reaction on j.
#pragma once

#include "solver/dem/laws/arithmetic.hpp"

#include <numbers>

namespace grainsweep::dem {

struct Material;
using geometry::Vec3;

/// What touches particle i. A wall has R* = R and m* = m, whatever its curvature.
enum class Partner { particle, wall };

/// In double precision; fast/contact.hpp has the same words for lanes.
template <Partner of>
struct Touch {
    static constexpr Partner partner = of;
    using Arithmetic = dem::Arithmetic<double>;
    double overlap = 0;           ///< d, m
    double distance = 0;          ///< between centres, or from the centre to the wall, m
    double radius_i = 0;          ///< m
    double radius_j = 0;          ///< m; a wall has none
    double effective_radius = 0;  ///< R*, m
    double reduced_mass = 0;      ///< m*, kg
    double root = 0;              ///< radius of the contact, Hertz's: sqrt(R* d), m
    double damping_root = 0;      ///< sqrt(m* root): damping is proportional to it
    Vec3 normal{};                ///< from j to i
    double normal_velocity = 0;   ///< v . n, negative while approaching, m/s
    Vec3 slip{};                  ///< tangential velocity of i over j at the contact, m/s; only where a law needs spin
    Vec3 turning{};               ///< w_i - w_j, rad/s; only where a law resists rolling
    double rolling_inertia = 0;   ///< 1/(1/I_i + 1/I_j), I = 7/5 m R^2 about the contact, kg m2; likewise
    double time_step = 0;         ///< s, by which memories advance
    bool touching = true;         ///< false: near, and no law makes it a contact
    bool apart = false;           ///< the bodies do not touch, and a law acts at a distance
    double cut_before = 0;        ///< share of a limit: springs this near to it were cut by the step, and yield

    /// Of a spring, where its size exceeds it.
    [[nodiscard]] double limit(double l) const { return l - cut_before * l; }

    /// The damper of a coefficient, N s/m.
    [[nodiscard]] double damped(const Arithmetic::Damping& d) const { return d.coefficient * damping_root; }
    /// A damper of a coefficient that is proportional to sqrt(m*) alone, N s/m.
    [[nodiscard]] double damped_by_mass(const Arithmetic::Damping& d) const {
        return d.coefficient * std::sqrt(reduced_mass);
    }
    /// The same where the normal damper is known already.
    [[nodiscard]] double damped_beside(const Arithmetic::Damping& d, double) const { return damped(d); }
    /// Strength times the area, N; `lens`: its disc (wall: cap) is all there is.
    template <bool lens>
    [[nodiscard]] double over_area(const Arithmetic::AreaForce& f) const {
        const double cap = 2 * effective_radius - overlap;
        if constexpr (partner == Partner::wall) {
            const double area = f.form.wall_cap * cap * overlap;
            return f.strength * (lens ? area : area + f.form.wall_band * effective_radius * overlap);
        } else {
            const double sum = radius_i + radius_j, difference = radius_i - radius_j, r = distance;
            // (r - Ri - Rj) is minus the overlap, which is known more precisely.
            const double disc = f.form.disc * overlap * (r + sum) * (r - difference) * (r + difference) / (r * r);
            if constexpr (lens) return f.strength * disc;
            return f.strength * (disc + f.form.band * effective_radius * overlap + f.form.cap * cap * overlap);
        }
    }
    /// For laws that reach beyond touch: it is a contact only where `holds`.
    void hold(bool holds) { touching = touching && holds; }
    /// Its radius is not Hertz's but this.
    void touch_over(double contact_radius) {
        root = contact_radius;
        damping_root = std::sqrt(root * reduced_mass);
    }
    /// For laws that act at a distance: bodies with a gap between them have no springs.
    void part(double gap) { apart = gap > 0; }
    /// x where the bodies touch, or stick together; else 0.
    template <class X>
    [[nodiscard]] X kept(const X& x) const {
        return apart ? X{} : x;
    }
    /// x where the contact is one: always, when laws are applied.
    [[nodiscard]] static double lasting(double x) { return x; }
};

/// Sum of the laws applied so far, in their order.
template <class Real>
struct Response {
    using Vector = typename Arithmetic<Real>::Vector;
    Real normal{};        ///< along n, N; positive repels
    Real seen{};          ///< what of it Coulomb's limit and that of rolling take, N
    Real elastic{};       ///< the part of it that the overlap alone makes, without damping and attraction, N
    Real damping{};       ///< the normal damper, N s/m
    Vector resistance{};  ///< minus the tangential force, N
    typename Arithmetic<Real>::Mask slides{};  ///< friction is at its limit
    Vector rolling{};  ///< minus the moment on i besides that of the forces; on j the same with the other sign, N m
};

/// 7/5 m R^2: moment of inertia of a sphere about a point of its surface, over m R^2.
inline constexpr double inertia_about_contact = 1.4;

/// Exponents of the units of a quantity; `inertia` counts moments of inertia about a contact, which lanes measure in
/// 7/5 m R^2.
struct Dimension {
    double length = 0, mass = 0, time = 0, inertia = 0;
};
inline constexpr Dimension number{}, length{.length = 1}, pressure{.length = -1, .mass = 1, .time = -2},
    root_of_pressure{.length = -0.5, .mass = 0.5, .time = -1}, energy_per_area{.mass = 1, .time = -2},
    force_per_length = energy_per_area, root_of_force_per_length{.mass = 0.5, .time = -1},
    moment{.length = 2, .mass = 1, .time = -2};

/// A constant of a law, in SI.
struct Quantity {
    double value = 0;
    Dimension dimension{};
};

/// What a contact remembers for a law from step to step.
struct MemoryKind {
    int components = 0;
    double exchanged = 1;  ///< their factor when i and j change places: -1 for what is measured from j to i
    Dimension dimension{};
};

/// What a law decides for a material; a combination of laws has at most one of each.
enum class Aspect { normal, cohesion, sliding, rolling };

/// What a law is unless it says otherwise.
struct LawTraits {
    static constexpr bool spin = false;   ///< needs the slip, and turns particles
    static constexpr bool rolls = false;  ///< resists rolling: needs `turning`
    static constexpr MemoryKind memory_kind{};
    /// Contacts may last beyond touch, by beyond(material, R*), m, where the overlap is negative: begin(touch, memory)
    /// says whether a near pair is a contact and what its radius is, before laws are applied. Only for combinations
    /// that are compiled for any spheres.
    static constexpr bool reaches = false;
    /// Beyond touch bodies are apart, and nothing but this law acts.
    static constexpr bool acts_apart = false;
    static double beyond(const Material&, double) { return 0; }
    template <class T>
    void begin(T&, const void*) const {}
    /// The memory of a pair outlives a separation: until the neighbour list is rebuilt, and beyond if the pair touches
    /// again at that moment.
    static constexpr bool remembers_separation = false;
};

}  // namespace grainsweep::dem
