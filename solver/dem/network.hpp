// Linearised network of the present contacts, and the longest time step at which explicit stepping of it is stable.
//
//     M x'' + C x' + K x = 0      x: translations and rotations of all mobile spheres, clumps and free walls
//
// Velocity Verlet with dampers that see the velocity of the half step before is stable as long as the largest
// eigenvalue of M^-1 (dt^2 K + 2 dt C) is below 4. For one degree of freedom this is dt w < 2 (sqrt(1 + z^2) - z), with
// the frequency w and the damping ratio z. A grain with several loaded contacts oscillates 2.4 to 2.6 times as fast as
// the fastest pair of spheres alone (O'Sullivan & Bray 2004, Eng. Comput. 21, 278; Otsubo, O'Sullivan & Shire 2017,
// Comput. Geotech. 86, 67).
//
// Springs and dampers are those of the laws (Springs in laws/touch.hpp). Attraction adds none. A contact that slides
// has no tangential spring. All in SI.
#pragma once

#include "solver/dem/body.hpp"
#include "solver/dem/laws/touch.hpp"
#include "solver/dem/walls/moving_wall.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::dem {

/// Contact of the network.
struct Bond {
    std::uint64_t key = 0;  ///< of the two bodies: the same in every step, see key_of()
    std::int32_t first = 0;
    std::int32_t second = -1;                     ///< sphere; -1: a wall, or a frozen sphere
    std::int32_t columns = -1, columns_end = -1;  ///< range of Network::columns, if the partner is a free wall
    Vec3 normal{};                                ///< from second to first
    double lever_first = 0, lever_second = 0;     ///< distances of the contact from the centres, m
    Springs springs{};
};

/// Returns the key of a contact, from the ids of its bodies in any order; -1 - w for wall w.
[[nodiscard]] constexpr std::uint64_t key_of(std::int32_t one, std::int32_t other) {
    const auto low = static_cast<std::uint32_t>(one < other ? one : other);
    const auto high = static_cast<std::uint32_t>(one < other ? other : one);
    return static_cast<std::uint64_t>(low) << 32U | high;
}

/// Degree of freedom of a free wall: velocity + spin x (x - pivot) is the velocity of its point x at unit speed.
struct Freedom {
    double inertia = 1;  ///< kg, or kg m2
    Vec3 velocity{}, spin{}, pivot{};
};

/// Returns the degrees of freedom of a wall at a time, s; none if the powder does not move it.
[[nodiscard]] std::vector<Freedom> freedoms_of(const MovingWall& wall, double time);

/// Share of the longest stable step, and the sphere that moves most in the mode that limits it.
struct StepShare {
    double share = 0;  ///< time step divided by the longest stable one
    std::int32_t sphere = 0;
};

class Network {
public:
    /// Restarts the network, without contacts, for spheres that add_sphere() gives. It takes only contacts whose keys
    /// are in the ascending list `lasting`, unless that is empty.
    void clear(std::vector<std::uint64_t> lasting = {});
    /// Adds a sphere; its number is the count of those before. `inverse_mass` 0: it does not move.
    void add_sphere(double inverse_mass, double radius) {
        inverse_mass_.push_back(inverse_mass);
        inverse_inertia_.push_back(inverse_mass / (0.4 * radius * radius));
    }
    /// Adds a clump after all spheres: it moves its members, which have no motions of their own. `lever_of(i)`: from
    /// the clump's centre of mass to the sphere with this number, m.
    template <class LeverOf>
    void add_body(double mass, const Vec3& inertia, const Axes& axes, std::span<const std::uint32_t> members,
                  LeverOf&& lever_of) {
        if (bodies_.empty()) carriers_.assign(inverse_mass_.size(), Carrier{});
        for (const std::uint32_t i : members) {
            carriers_[i] = {static_cast<std::int32_t>(bodies_.size()), lever_of(i)};
            inverse_mass_[i] = inverse_inertia_[i] = 0;
        }
        bodies_.push_back({1 / mass, inertia, inverse_of(inertia), axes,
                           members.empty() ? 0 : static_cast<std::int32_t>(members.front())});
    }
    /// Adds the degrees of freedom of a wall; returns the first one's number.
    void add_wall(const std::vector<Freedom>& freedoms);
    /// Returns whether contacts with this key may be added.
    [[nodiscard]] bool takes(std::uint64_t key) const {
        return lasting_.empty() || std::ranges::binary_search(lasting_, key);
    }
    /// Adds a contact with a sphere, or with what does not move (second -1).
    void add(const Bond& bond) { bonds_.push_back(bond); }
    /// Adds a contact at a point with the wall added last.
    void add_at_wall(Bond bond, const Vec3& point);

    /// Returns the keys of all contacts, ascending.
    [[nodiscard]] std::vector<std::uint64_t> keys() const;

    /// Returns an upper bound of the largest eigenvalue for a time step, s: that of the single contacts with the masses
    /// of their partners shared out among all their contacts (Fried 1972, Comput. Struct. 2, 125).
    [[nodiscard]] double bound(double time_step) const;
    /// Returns the share, from below to about 2 %, by Lanczos's iteration with a fixed start, of the contacts about
    /// those with the largest bound. Call bound() before.
    [[nodiscard]] StepShare share(double time_step) const;

private:
    struct Column {
        std::int32_t freedom;
        Vec3 velocity;  ///< of the contact point at unit speed
    };

    /// Clump: its rotations are about its axes of inertia.
    struct BodyNode {
        double inverse_mass;
        Vec3 inertia, inverse_inertia;
        Axes axes;
        std::int32_t first;  ///< a member
    };
    /// What moves a sphere: itself, or a clump.
    struct Carrier {
        std::int32_t body = -1;
        Vec3 lever{};
    };
    /// Motion of a sphere's centre.
    struct Moved {
        Vec3 velocity, turning;
    };
    /// Motion of the two sides of a contact against each other.
    struct Relative {
        double along;
        Vec3 sliding, rolling;
    };
    struct Energies {
        double springs = 0, dampers = 0;
    };
    struct Weighted;

    /// Returns the number of spheres and clumps: six degrees of freedom each.
    [[nodiscard]] std::size_t nodes() const { return inverse_mass_.size() + bodies_.size(); }
    [[nodiscard]] const Carrier* carrier(std::int32_t sphere) const {
        if (bodies_.empty() || carriers_[static_cast<std::size_t>(sphere)].body < 0) return nullptr;
        return &carriers_[static_cast<std::size_t>(sphere)];
    }
    [[nodiscard]] std::size_t node_of(std::int32_t sphere) const {
        const Carrier* const by = carrier(sphere);
        return by == nullptr ? static_cast<std::size_t>(sphere)
                             : inverse_mass_.size() + static_cast<std::size_t>(by->body);
    }
    /// Returns the sum of the loads of a contact's partners.
    [[nodiscard]] double load_at(const Bond& bond) const;
    /// Finds the stiffest part of the network: the contacts with 0.7 of the largest sum of loads or more, and those
    /// that are up to two contacts away. The fastest mode dies out within them. Sets places_ and part_.
    void find_part() const;
    /// Returns the place of a node's coordinates.
    template <bool clumped>
    [[nodiscard]] std::size_t place_of(std::int32_t sphere) const {
        const std::size_t node = clumped ? node_of(sphere) : static_cast<std::size_t>(sphere);
        return 6 * static_cast<std::size_t>(places_[node]);
    }
    template <bool clumped>
    [[nodiscard]] Moved motion_of(std::int32_t sphere, const double* speeds) const;
    template <bool clumped>
    void push(std::int32_t sphere, const Vec3& force, const Vec3& moment, double* forces) const;
    /// Returns the load of a contact on a node, for bound(): `strength` divided by its mass for a sphere.
    [[nodiscard]] double load_of(const Bond& bond, std::int32_t sphere, double strength, double normal,
                                 double tangential, double rolling) const;
    /// Adds A u of the part to `force`; the entries of A in `weighted`. Without clumps a node is a sphere.
    template <bool clumped>
    void apply(const std::vector<Weighted>& weighted, const double* speeds, double* force) const;
    /// Returns `of_springs` u K u and `of_dampers` u C u of the part.
    template <bool clumped>
    [[nodiscard]] Energies energies(double of_springs, double of_dampers, const double* speeds) const;
    template <bool clumped>
    [[nodiscard]] Relative relative(const Bond& bond, const double* speeds) const;

    std::vector<double> inverse_mass_, inverse_inertia_;
    std::vector<Freedom> freedoms_;
    std::size_t wall_begin_ = 0;  ///< first freedom of the last wall
    std::vector<BodyNode> bodies_;
    std::vector<Carrier> carriers_;  ///< by sphere, if there are clumps
    std::vector<Bond> bonds_;
    std::vector<std::uint64_t> lasting_;
    std::vector<Column> columns_;
    // Scratch.
    mutable std::vector<double> load_;          ///< of each node and freedom, by bound(): strengths of its contacts
    mutable std::vector<std::uint32_t> part_;   ///< contacts of the stiffest part
    mutable std::vector<std::int32_t> places_;  ///< of nodes in that part; -1: none
    mutable std::vector<std::size_t> in_part_;  ///< nodes of that part
};

}  // namespace grainsweep::dem
