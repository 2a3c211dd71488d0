// Walls of the mixed engine: their places in its units, the laws of their surfaces, and their loads.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/checkpoint.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/kinds.hpp"
#include "solver/dem/laws/any_contact.hpp"
#include "solver/dem/laws/compiled.hpp"
#include "solver/dem/walls/moving_wall.hpp"

namespace grainsweep::dem::fast {

class Walls {
public:
    /// `materials`: all materials of the start. Throws std::invalid_argument with one sentence for impossible walls.
    Walls(const std::vector<Wall>& walls, const Domain& domain, const Scale& scale, std::int32_t combination,
          const ContactTable& table, std::span<const Material> materials);

    [[nodiscard]] std::size_t count() const { return moving_.size(); }
    [[nodiscard]] const MovingWall& operator[](std::size_t w) const { return moving_[w]; }
    [[nodiscard]] std::span<const MovingWall> all() const { return moving_; }
    /// Returns whether forces move a wall.
    [[nodiscard]] bool any_free() const { return any_free_; }
    /// Returns whether a wall can be touched in one place only, which is found over lanes.
    [[nodiscard]] bool is_single(std::size_t w) const { return single_[w]; }
    /// Returns the laws of a wall's contacts with a kind of particles, in SI.
    [[nodiscard]] const AnyContact& laws(std::size_t w, std::size_t kind) const { return *laws_[w][kind]; }

    /// Returns the same bodies with other motions and presence, see Engine::change_walls.
    [[nodiscard]] std::vector<MovingWall> moving_as(const std::vector<Wall>& walls, const Domain& domain) const;
    /// Takes the result of moving_as(), `time` after the walls were set, s.
    void take(std::vector<MovingWall> changed, double time);

    /// Sets the units of another length of steps; place() completes it.
    void use_scale(const Scale& scale, const ContactTable& table);

    /// Sets places and velocities of the walls at `time` after they were set, s.
    void place(double time);
    /// Changes the speeds of free walls by their loads, acting for `steps` steps from `time` on.
    void kick(double time, double steps);
    /// Moves free walls by a step; place() completes the motion.
    void drift();
    /// Selects the walls with sums from now on: all, or only walls that move and do work, or whose loads are
    /// integrated.
    void sum_up(bool all);
    [[nodiscard]] const PlacedWall* placed() const { return placed_.data(); }
    /// Extends the extremes of velocity by the surface velocities during the step after `time`, of the free walls or of
    /// the others.
    void bound_velocities(double time, bool free, Tally& tally) const;
    /// Returns a sentence on the first wall that moves farther than a particle's radius (m) in a step; empty: none.
    [[nodiscard]] std::string too_fast(double smallest_radius, std::int64_t steps) const;

    /// Stores the sums of a sweep over the walls. `of_step`: the sweep was part of a step, so its work counts. Returns
    /// the work of all walls on the particles in the sweep, in the engine's units.
    double book(const WallSums* sums, bool of_step);
    [[nodiscard]] WallLoad load(std::size_t w, const Vec3& about) const;

    void save(Writer& archive) const;
    /// Returns saved walls; place() completes them.
    [[nodiscard]] static Walls restored(Reader& archive, const Domain& domain, const Scale& scale,
                                        std::int32_t combination, const ContactTable& table,
                                        std::span<const Material> materials);

private:
    [[nodiscard]] bool moves(std::size_t w) const { return moving_[w].present() && !moving_[w].at_rest(); }
    [[nodiscard]] bool integrates(std::size_t w) const { return moving_[w].present() && moving_[w].wall().integrated; }
    void place(std::size_t w, double time);

    std::int32_t combination_;
    Scale scale_;
    bool any_free_ = false;
    std::vector<MovingWall> moving_;
    std::vector<std::vector<std::unique_ptr<const AnyContact>>> laws_;
    std::vector<std::vector<double>> constants_;  // of the laws, a row of constants_at_most each
    std::vector<bool> single_;
    std::vector<PlacedWall> placed_;
    std::vector<WallSums> sums_;  // of the last step
    std::vector<Vec3> pivot_;     // reference points of their torques, m
    std::vector<double> work_;    // work since they were set, engine's units
};

}  // namespace grainsweep::dem::fast
