// Powder at rest: particles that are not advanced, and the contacts between them, which are parked meanwhile.
//
// A pair of two that are not advanced is not listed: they cost nothing but their part of a rebuild. To all others a
// particle at rest is the partner it was, of the same mass. Decided at every rebuild:
//
//   rests     what has been slower than the rest speed, v and |w| R, for 256 steps, with nothing faster in reach of the
//             outer list: nothing that moves can touch it before the next rebuild. Around what is 30 times faster two
//             more layers of contacts stay advanced, to take up its impact
//   advanced  again, when something faster comes into that reach, or the net force on it, or the net torque over R,
//             averaged since the last rebuild, exceeds half its weight
//
// Neglected are a net force below half the weight, creep slower than the rest speed, and the effect of an impact on the
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

/// Steps after which lists are made anew though nothing else requires it, so that particles at rest are checked.
inline constexpr std::int64_t rest_interval = 128;

class Resting {
public:
    /// rest_speed: m/s; 0: all particles are always advanced.
    Resting(const Setup& setup, const PairContacts& laws, const Scale& scale, double rest_speed);

    [[nodiscard]] bool wanted() const { return speed_ > 0; }
    [[nodiscard]] bool holds(std::int32_t particle) const { return held_[static_cast<std::size_t>(particle)] != 0; }
    /// All are advanced from the next rebuild on.
    void advance_all(const Field& f);
    /// So are particles that were added behind the others.
    void advance_also(std::size_t count);
    /// The parked contacts, by index of the records.
    [[nodiscard]] std::span<const ParkedContact> parked() const { return parked_; }
    /// Particles at rest.
    [[nodiscard]] std::int64_t count() const { return count_; }
    /// Largest overlap among them, over the smaller diameter.
    [[nodiscard]] float overlap() const { return overlap_; }

    /// Whether this can be the rest of `particles` particles.
    [[nodiscard]] bool fits(std::int32_t particles) const;

    // The parts of a rebuild, in this order.
    /// Before particles are sorted: which of them the forces of the last `steps` steps have pushed.
    void compare_forces(const Field& f, std::int64_t steps);
    /// After they are sorted: everything here is put in the order of columns.place.
    void reorder(const Field& f, const Columns& c);
    /// After contacts have found their pairs in the outer list (columns.owner; parked ones number from `live` on):
    /// what rests from now on. Pairs neither of which is advanced leave the list, their contacts are parked.
    void update(Field& f, Columns& c, const ListSpace& space, std::int32_t live);

    /// Everything that changes.
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
    double speed_ = 0;    ///< engine's units
    double gravity_ = 0;  ///< change of velocity per step

    std::vector<std::uint8_t> held_;    ///< 1: frozen or at rest
    std::vector<std::uint16_t> quiet_;  ///< steps for which a particle has been slow
    std::vector<ParkedContact> parked_;
    std::int64_t count_ = 0;
    float overlap_ = 0;

    // Of one rebuild.
    std::int64_t steps_ = 0;
    std::vector<std::uint8_t> pushed_;
    std::vector<std::uint8_t> disturbs_;   ///< layers that a particle keeps advanced: none, those in reach, more
    std::vector<std::uint8_t> disturbed_;  ///< layers left where the motion of others reaches
    std::vector<ParkedContact> before_;
};

}  // namespace grainsweep::dem::fast
