// Powder at rest: particles that are not advanced, and the parked contacts between them.
//
// A pair of two particles that are not advanced is not listed, so it costs time only in a rebuild. For all other
// particles, a particle at rest is a partner of the same mass as before. Every rebuild decides:
//
//   rests     a particle slower than the rest speed, v and |w| R, for 256 steps and as long as a free fall takes to
//   turn
//             that speed around, with no faster body within the outer list: nothing that moves can touch it before the
//             next rebuild. Around a body 30 times faster, two more layers of contacts stay advanced, to absorb its
//             impact
//   advanced  again, when a faster body comes within the outer list, or when the net force on the particle, or the net
//             torque divided by R, averaged since the last rebuild, exceeds half its weight
//
// Neglected effects: a net force below half the weight, creep slower than the rest speed, and an impact's effect on the
// fourth layer. The rebound from a pile at rest differs by 1 % (without the two layers: by 17 %).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/contact_reader.hpp"
#include "solver/dem/fast/rebuild.hpp"
#include "solver/dem/fast/scale.hpp"

namespace grainsweep::dem::fast {

/// Largest number of steps between two rebuilds, so that particles at rest are checked.
inline constexpr std::int64_t rest_interval = 128;

class Resting {
public:
    /// rest_speed: m/s; 0: all particles are always advanced.
    Resting(const Setup& setup, const PairContacts& laws, const Scale& scale, double rest_speed);

    [[nodiscard]] bool wanted() const { return speed_ > 0; }
    /// Sets the units; `rest_speed` and `gravity` in SI.
    void use_scale(const Scale& scale, double rest_speed, double gravity);
    /// Multiplies the parked forces by `force`, and each of their memories by `memory`, for other units.
    void convert_parked(float force, std::span<const float> memory);
    [[nodiscard]] bool holds(std::int32_t particle) const { return held_[static_cast<std::size_t>(particle)] != 0; }
    /// Advances all particles from the next rebuild on.
    void advance_all(const Field& f);
    /// Advances particles that were added behind the others.
    void advance_also(std::size_t count);
    /// Returns the parked contacts, by index of the records.
    [[nodiscard]] std::span<const ParkedContact> parked() const { return parked_; }
    /// Returns the number of particles at rest.
    [[nodiscard]] std::int64_t count() const { return count_; }
    /// Returns the largest overlap among parked contacts, divided by the smaller diameter.
    [[nodiscard]] float overlap() const { return overlap_; }

    /// Returns whether this state is valid for `particles` particles.
    [[nodiscard]] bool fits(std::int32_t particles) const;

    // Steps of a rebuild, in this order.
    /// Finds the particles that the forces of the last `steps` steps have pushed; before particles are sorted.
    void compare_forces(const Field& f, std::int64_t steps);
    /// Puts all data in the order of columns.place; after particles are sorted.
    void reorder(const Field& f, const Columns& c);
    /// Decides which particles rest from now on; after contacts are assigned to pairs of the outer list (columns.owner;
    /// parked contacts have numbers from `live` on). Pairs of two particles that are not advanced leave the list, and
    /// their contacts are parked.
    void update(Field& f, Columns& c, const ListSpace& space, std::int32_t live);

    /// Passes the complete state to an archive.
    template <class Archive>
    static void pass(auto& self, Archive& archive) {
        archive.list(self.held_);
        archive.list(self.quiet_);
        archive.list(self.parked_);
        archive.value(self.count_);
        archive.value(self.overlap_);
    }

private:
    void measure_motion(const Field& f);
    void spread_disturbance(const Field& f, const Columns& c);
    void decide(Field& f);
    [[nodiscard]] ParkedContact parked_from(const Columns& c, const ContactReader& reader, std::size_t pair,
                                            std::int32_t live) const;

    const PairContacts* laws_;
    double speed_ = 0;             ///< engine's units
    double gravity_ = 0;           ///< change of velocity per step
    std::int64_t quiet_time_ = 0;  ///< steps for which a particle must have been slow

    std::vector<std::uint8_t> held_;    ///< 1: frozen or at rest
    std::vector<std::uint32_t> quiet_;  ///< steps for which a particle has been slow
    std::vector<ParkedContact> parked_;
    std::int64_t count_ = 0;
    float overlap_ = 0;

    // Of one rebuild.
    std::int64_t steps_ = 0;
    std::vector<std::uint8_t> pushed_;
    std::vector<std::uint8_t> disturbs_;   ///< layers of particles that a particle keeps advanced: none, those in
                                           ///< reach, more
    std::vector<std::uint8_t> disturbed_;  ///< remaining layers of the disturbance by others
    std::vector<ParkedContact> before_;
};

}  // namespace grainsweep::dem::fast
