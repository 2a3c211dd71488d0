// Checks of the mixed engine's speeds and energy, with the limits of dem/limits.hpp.
//
// Energy minus the work of gravity and of moving walls must not grow, because contacts only store or dissipate energy.
// The sum is computed in double precision every energy_interval steps. A check costs about as much as seven steps, so
// many particles are checked less often; their laws cannot spin all of them up at the same time. The work of gravity
// uses the displacements since the last check, which are known up to whole periods. If gravity acts along a periodic
// axis, a check is made before any particle covers a quarter of a period. A shaken vessel has no balance, because the
// work of shaking would need the momentum of every step.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "solver/dem/energy_balance.hpp"
#include "solver/dem/engine.hpp"
#include "solver/dem/fast/contact_reader.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/rebuild.hpp"

namespace grainsweep::dem::fast {

/// Steps between two checks of the energy, for few particles and for many.
inline constexpr std::int64_t energy_interval_of_few = 128, energy_interval = 1024;
inline constexpr std::size_t few_particles = 100;

/// Input of a check: the state at a full step.
struct Moment {
    const Field& field;
    const ListSpace& space;
    const std::int32_t* id;
    std::span<const Velocities> motions;  ///< in the order of the records
    StoredEnergy stored;
    std::int64_t steps = 0;  ///< so far
    double of_clumps = 0;    ///< kinetic energy of clumps, J
    double fallen = 0;       ///< work of gravity on clumps since the last check, J
};

class Watch {
public:
    Watch(const Setup& setup, const Scale& scale);

    /// Sets the largest possible speed, from the state at the start or after a change of walls or particles.
    void set_limit(const Moment& now, std::span<const MovingWall> walls);
    /// Adds a particle; its id follows the earlier ids.
    void begin(const Record& record) { seen_.push_back({record.position[0], record.position[1], record.position[2]}); }
    /// Sets the units of another length of steps.
    void use_scale(const Scale& scale) {
        speed_unit_ = scale.speed();
        energy_unit_ = scale.mass * scale.speed() * scale.speed();
    }
    /// Restarts the work of the walls.
    void forget_wall_work() { work_of_walls_ = 0; }
    /// Adds a step by the largest component of its velocities, engine's units.
    void add_travel(double fastest);
    /// Adds work of the walls on the particles, engine's units.
    void add_wall_work(double work) { work_of_walls_ += work * energy_unit_; }
    /// Restarts the balance after particles with their energy have left.
    void restart_balance() { balance_.restart(); }

    /// Returns whether the largest velocity component may exceed the speed limit.
    [[nodiscard]] bool too_fast(double fastest) const;
    [[nodiscard]] bool due(std::int64_t steps) const;
    /// Returns the fault of the balance and sets its particle; empty: the balance is sound.
    [[nodiscard]] std::string check(const Moment& now, std::int32_t& particle);

    [[nodiscard]] std::size_t spheres() const { return seen_.size(); }  ///< number of spheres so far
    [[nodiscard]] double speed_limit() const { return speed_limit_; }   ///< m/s

    /// Passes the complete state to an archive.
    template <class Archive>
    static void pass(auto& self, Archive& archive) {
        archive.value(self.balance_);
        archive.value(self.work_of_walls_);
        archive.value(self.work_of_gravity_);
        archive.value(self.speed_limit_);
        archive.value(self.covered_);
        archive.list(self.seen_);
    }

private:
    using Place3 = std::array<std::int32_t, 3>;

    [[nodiscard]] double kinetic(const Moment& now) const;
    void add_gravity_work(const Moment& now);

    Vec3 gravity_;
    Domain domain_;
    double speed_unit_, energy_unit_;
    double shaking_speed_;                                             ///< m/s, of the vessel
    double quarter_period_ = std::numeric_limits<double>::infinity();  ///< shortest along gravity, in lengths
    bool balanced_;                                                    ///< false: a shaken vessel

    EnergyBalance balance_;
    double work_of_walls_ = 0, work_of_gravity_ = 0;  ///< J
    double speed_limit_ = std::numeric_limits<double>::infinity();
    double covered_ = 0;        ///< largest possible displacement since the last check, in lengths
    std::vector<Place3> seen_;  ///< positions of the last check, by id
};

}  // namespace grainsweep::dem::fast
