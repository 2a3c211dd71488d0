// Four-way coupling by soft spheres with repulsive contacts (CFD-DEM).
//
// Contacts are hysteretic springs with friction (hysteretic_spring.hpp), in addition to the fluid's force:
//   (xi + 1/2) dV/dt = ... + F/v_p,   (2/5) xi v_p R^2 dw/dt = T - 8 pi Pr R^3 (w - rot u/2)
// (Stokes torque: Happel & Brenner 1965, ch. 5-9). Contacts are much shorter than the fluid's step. So only particles
// that can have a contact are advanced in sub-steps of a twentieth of a contact, with forces in the middle of each
// (leapfrog). In a sub-step drag relaxes exponentially, with the factor of the slip at its beginning.
//
// Candidates are pairs whose gap is smaller than their relative free path, particles whose free path reaches a wall,
// and particles that a candidate could then hit. All others follow the free path of motion.hpp.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/hysteretic_spring.hpp"
#include "solver/coupling/march.hpp"
#include "solver/coupling/motion.hpp"
#include "solver/coupling/near_pairs.hpp"
#include "solver/coupling/solids_volume.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::coupling {

/// Forces of contacts among particles and with walls in one fluid step.
class SpringContacts {
public:
    /// steps_per_contact: sub-steps in the shortest contact; 20 keep the restitution to 0.1 %.
    SpringContacts(const Sphere& sphere, const Walls& walls, const HystereticSpring& spring, std::size_t particles,
                   double steps_per_contact = 20);

    /// Returns the stiffness of the softest suitable spring. Overlaps stay below the share `overlap` of a diameter,
    /// under the vibrational force and under an impact at its slip speed. Contacts last at most one step.
    [[nodiscard]] static double stiffness(const Sphere& sphere, double overlap, double time_step);

    /// Sets the threads that compute; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }

    /// Advances every particle; `around(p)` is the fluid at its place, around.rotation(x) half its vorticity.
    /// transmitted[p]: force of the contacts minus inertia of the particle, per volume.
    template <class Motion, class Stencils, class Around>
    void move(Cloud& cloud, const Motion& motion, const Walls&, SolidsVolume&, const Stencils&, const Around& around,
              std::vector<Vec3>& transmitted) {
        begin(cloud);
        march_all(
            cloud, motion, around.vibration, [&](std::size_t p) { return surroundings_[p] = around(p); },
            [](std::size_t, const Vec3&) {}, slabs_);
        find_active(cloud);
        for (Active& one : active_) {
            one.tau = motion.relaxation(surroundings_[one.particle].velocity, velocity_[one.particle]);
            one.rotation = around.rotation(position_[one.particle]);
        }
        advance_active(cloud, motion.time_step(), transmitted);
    }
    void settle(Cloud&, const Walls&, SolidsVolume&) {}

    [[nodiscard]] std::int64_t substeps(double time_step) const;
    [[nodiscard]] const std::vector<Vec3>& spins() const { return spin_; }

    void save(std::vector<std::byte>& into) const;
    void restore(std::span<const std::byte>& from);

private:
    struct Active {
        std::uint32_t particle = 0;
        double tau = 0;
        Vec3 rotation{};
        Vec3 limit{}, force{}, torque{}, middle{}, total{};
    };
    struct Contact {
        std::uint32_t i = 0, j = 0;  // j: a particle, or wall_base + 2 axis + side
        std::uint32_t slot_i = 0, slot_j = 0;
        SpringMemory memory;
    };
    static constexpr std::uint32_t wall_base = 0xFFFFFFF0U;

    void begin(const Cloud& cloud);
    void find_active(const Cloud& freely_moved);
    void list_contacts(const std::vector<Pair>& pairs, double reach);
    void advance_active(Cloud& cloud, double time_step, std::vector<Vec3>& transmitted);
    void push(Contact& contact, const Cloud& cloud, double h);
    void touch(Contact& contact, const Vec3& n, double overlap, const Vec3& relative, double h);

    Sphere sphere_;
    Walls walls_;
    HystereticSpring spring_;
    NearPairs near_;
    double steps_per_contact_;
    double mass_, inertia_, rotation_drag_;  // effective mass (xi + 1/2) v_p; (2/5) xi v_p R^2; 8 pi Pr R^3
    std::vector<Vec3> position_, velocity_;  // before the step
    std::vector<Vec3> spin_;
    std::vector<std::int64_t> idle_;  // steps since the last contact of a particle, in which its spin relaxes
    std::vector<Surroundings> surroundings_;
    std::vector<Active> active_;
    std::vector<std::uint32_t> slot_;  // per particle, index among the active ones + 1, or 0
    std::vector<Contact> contacts_;
    std::vector<Contact> remembered_;
    Slabs slabs_;
};

}  // namespace grainsweep::coupling
