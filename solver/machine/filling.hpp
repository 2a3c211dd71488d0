// The particles at the start.
#pragma once

#include "solver/dem/walls/moving_wall.hpp"
#include "solver/machine/spec.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::machine {

struct Filled {
    std::vector<dem::Sphere> spheres;
    std::vector<std::uint8_t> species;  ///< of each
};

/// Fills the machine, one filling after the other: particles lie wholly in their region, touch no wall that is present
/// in the first phase, and none of another filling. Pure: everything follows from the spec and the seed. Throws
/// std::invalid_argument with one sentence where a filling does not fit.
[[nodiscard]] Filled filled(const Spec& spec, std::uint64_t seed);

/// Draws species and diameters, addressed by (seed, stream, counter): one particle of a mix.
class Draws {
public:
    Draws(const Spec& spec, const Mix& mix, std::uint64_t seed, std::uint64_t number);

    struct Particle {
        std::size_t species = 0;
        double radius = 0;
    };
    /// The n-th particle of a feed: its size by chance, species in their shares whatever the number of particles.
    [[nodiscard]] Particle of_feed(std::uint64_t n) const;
    /// All particles of a filling: species in exact numbers, in random order.
    [[nodiscard]] std::vector<Particle> in_numbers(std::int64_t count) const;
    /// Uniform in [0, 1).
    [[nodiscard]] double uniform(std::uint64_t purpose, std::uint64_t counter) const;

private:
    [[nodiscard]] double radius_of(std::size_t species, std::uint64_t n) const;

    const Spec& spec_;
    const Mix& mix_;
    std::uint64_t seed_, number_;
};

/// Purposes of Draws::uniform().
enum : std::uint64_t { size_draw = 0, species_draw, place_draw, velocity_draw, order_draw, draws_of_one };
/// Number of a feed's draws: those of fillings come first.
inline constexpr std::uint64_t first_feed = 1000;

/// Walls that are in the way of a particle.
class Obstacles {
public:
    /// Those present among `walls`, where they stand at a time, for spheres of up to the largest diameter.
    Obstacles(const std::vector<dem::Wall>& walls, const geometry::Domain& domain, double largest, double time);
    /// Whether a sphere there touches a wall.
    [[nodiscard]] bool touch(const Vec3& centre, double radius) const;

private:
    std::vector<dem::MovingWall> walls_;
};

}  // namespace grainsweep::machine
