// Reader of the contacts of the mixed engine's present state, in SI and double precision, by the same laws.
//
// It uses the exact integer positions from which forces are computed, and the springs after the last step. It is no
// part of a step.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/clumps.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/rebuild.hpp"
#include "solver/dem/fast/walls.hpp"
#include "solver/dem/laws/any_contact.hpp"
#include "solver/dem/laws/compiled.hpp"
#include "solver/dem/network.hpp"
#include "solver/dem/reading.hpp"

namespace grainsweep::dem::fast {

/// Energy in contacts, J: the sum, and the sum of absolute values (the energy of cohesion is negative).
struct StoredEnergy {
    double sum = 0;
    double squeezed = 0;
};

/// Laws of the contacts of each pair of kinds, at place_of_pair().
using PairContacts = std::vector<std::unique_ptr<const AnyContact>>;

class ContactReader {
public:
    /// All views must outlive the reader. `motions`: at the full step, in the order of the records; empty if only
    /// energy is needed. `before`: at the half step before; if given, the forces are the forces of the last step.
    /// `overlap_rounding`: error of the overlaps of that step, as a share of the distances.
    ContactReader(const PairContacts& laws, const ListSpace& space, const Field& field, const std::int32_t* id,
                  std::span<const Velocities> motions, std::int32_t width, std::span<const ParkedContact> parked = {},
                  std::span<const Velocities> before = {}, const Clumps* clumps = nullptr, double overlap_rounding = 0);

    /// Computes overlap, force and torques of a contact of two particles at rest.
    void stand_still(ParkedContact& contact) const;
    /// Appends the touching pairs, in list order, then the parked ones.
    void pairs(std::vector<ContactForce>& into) const;
    /// Appends the particles that touch wall number w.
    void wall(const Walls& walls, std::size_t w, std::vector<ContactForce>& into) const;
    /// Writes the network of all contacts, with spheres in the order of the records. `time`: wall time, s. If `lasting`
    /// is not empty, only of contacts with these keys, and those that the last step has cut have no tangential spring;
    /// then `before` must be given.
    void network(const Walls& walls, double time, const std::vector<std::uint64_t>& lasting, Network& into) const;
    /// Returns the energy of all contacts.
    [[nodiscard]] StoredEnergy stored(const Walls& walls) const;

private:
    using Memory = std::array<double, memories_at_most>;
    /// Place on a wall, and the velocity of its material there.
    struct WallPoint {
        Vec3 place, velocity;
    };

    [[nodiscard]] const AnyContact& laws_of(std::int32_t i, std::int32_t j) const;
    [[nodiscard]] double radius(std::int32_t i) const;
    [[nodiscard]] double mass(std::int32_t i) const;  ///< kg; infinite if frozen
    /// Returns 1/m* of a particle's side of a contact, 1/kg.
    [[nodiscard]] double inverse_mass_at(std::int32_t i, const Vec3& normal) const;
    [[nodiscard]] Memory memory(const float* const* column, std::int64_t at) const;
    [[nodiscard]] bool near(std::int32_t i, std::int32_t j, Touch<Partner::particle>& t) const;
    [[nodiscard]] bool touches(std::int32_t i, std::int32_t j, const Memory& memory, Touch<Partner::particle>& t) const;
    /// Calls visit(i, j, touch, memory) if pair k of the list touches; `place`: of its memory, if it has one.
    template <class Visit>
    void look_at(std::int32_t k, std::optional<std::int64_t> place, Visit&& visit) const;
    /// Calls visit(i, j, touch, memory) for touching pairs; only the geometry of the touch is set.
    template <class Visit>
    void for_each_pair(Visit&& visit) const;
    /// As for_each_pair(), for laws with memory, of the pairs that touched in the last step: the others of the list are
    /// not read, so that a pair whose overlap is within rounding may be missing.
    template <class Visit>
    void for_each_remembered(Visit&& visit) const;
    template <class Visit>
    void for_each_parked(Visit&& visit) const;
    /// Calls visit(i, point, touch, memory) for the particles that touch the wall.
    template <class Visit>
    void for_each_at_wall(const Walls& walls, std::size_t w, Visit&& visit) const;
    [[nodiscard]] Memory memory_at_wall(const Walls& walls, std::size_t w, std::int32_t i, std::int32_t slot) const;
    void complete(std::int32_t i, std::int32_t j, Touch<Partner::particle>& t) const;
    void complete(std::int32_t i, Touch<Partner::wall>& t) const;
    [[nodiscard]] Memory memory(const ParkedContact& contact) const;
    template <Partner partner, class MotionIn>
    [[nodiscard]] ContactForce read(const AnyContact& laws, Touch<partner> t, std::int32_t i, std::int32_t second,
                                    const Memory& memory, MotionIn&& motion_in) const;

    const PairContacts& laws_;
    const ListSpace& space_;
    const Field& field_;
    const std::int32_t* id_;
    std::span<const Velocities> motions_;
    std::int32_t width_;
    std::span<const ParkedContact> parked_;
    std::span<const Velocities> before_;
    const Clumps* clumps_;
    double overlap_rounding_;
    double beyond_pair_ = 0, beyond_wall_ = 0;  // m
    Memory memory_unit_{};
};

}  // namespace grainsweep::dem::fast
