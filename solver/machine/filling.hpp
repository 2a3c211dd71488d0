// Particles at the start.
#pragma once

#include "solver/dem/walls/moving_wall.hpp"
#include "solver/machine/spec.hpp"
#include "solver/scenes/scene.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::machine {

/// Largest overlap of a placed sphere with a wall at the start, divided by its diameter, and of a particle with a wall
/// that appears: the flights of a rheometer's blade or the rim of a plate do so in a bed. Deeper ones would throw
/// particles out.
inline constexpr double deepest_at_start = 0.15;

struct Filled {
    std::vector<dem::Sphere> spheres;   ///< members of clumps, too
    std::vector<std::uint8_t> species;  ///< of each sphere
    std::vector<dem::Body> bodies{};    ///< clumps that move
    std::vector<std::int32_t> named{};  ///< index of the (first) sphere of each named particle
    /// Numbers of spheres that cuts with a name have, also of those left out, and that their whole packings have.
    std::map<std::string, std::int64_t> counts{};

    /// Adds a particle of a species; of a clump `sphere` is the sphere of equal volume, and `orientation` that of the
    /// frame in which its shape is described. One that does not move becomes single spheres.
    void add(const Spec& spec, std::size_t of, const dem::Sphere& sphere, const geometry::Quaternion& orientation);
};

/// Fills the machine, one filling after the other. Particles lie completely in their region, and touch no wall that is
/// present in the first phase and no particle of another filling. The result depends on the spec and the seed alone.
/// Throws std::invalid_argument with one sentence if a filling does not fit. `artefacts` may have its packings;
/// nullptr: they are made.
[[nodiscard]] Filled filled(const Spec& spec, std::uint64_t seed, Artefacts* artefacts = nullptr);

/// Returns what is filled at the beginning of a later phase, where particles and walls are as given. Throws as above.
[[nodiscard]] Filled filled_later(const Spec& spec, std::uint64_t seed, std::size_t phase, const dem::State& present,
                                  const std::vector<dem::Wall>& walls, double time);

/// Throws std::invalid_argument with one sentence unless a text is the file of a packing, of any edge.
void require_packing(std::string_view csv);

/// Throws std::invalid_argument with one sentence if a placed sphere starts deeper in a wall than deepest_at_start.
void require_out_of_walls(const Spec& spec);

/// Random draws of the particles of a mix, species and diameter, addressed by (seed, stream, counter).
class Draws {
public:
    Draws(const Spec& spec, const Mix& mix, std::uint64_t seed, std::uint64_t number);

    struct Particle {
        std::size_t species = 0;
        double radius = 0;
    };
    /// Returns the n-th particle of a feed: its size is random, the species follow their shares for any number of
    /// particles.
    [[nodiscard]] Particle of_feed(std::uint64_t n) const;
    /// Returns all particles of a filling: species in exact numbers, in random order; or particles until their volume,
    /// m3, is nearest to a given one.
    [[nodiscard]] std::vector<Particle> in_numbers(std::int64_t count) const;
    [[nodiscard]] std::vector<Particle> to_volume(double volume) const;
    /// Returns the orientation of the n-th particle, of a uniform distribution; of a sphere no turn.
    [[nodiscard]] geometry::Quaternion orientation(std::size_t species, std::uint64_t n) const;
    /// Returns a uniform number in [0, 1).
    [[nodiscard]] double uniform(std::uint64_t purpose, std::uint64_t counter) const;

private:
    [[nodiscard]] double radius_of(std::size_t species, std::uint64_t n) const;

    const Spec& spec_;
    const Mix& mix_;
    std::uint64_t seed_, number_;
};

/// Returns the spheres of a particle at a place: one, or the members of a clump with this orientation.
[[nodiscard]] std::vector<geometry::Ball> balls_of(const Spec& spec, const Draws::Particle& particle,
                                                   const Vec3& centre, const geometry::Quaternion& orientation);

/// Purposes of Draws::uniform().
enum : std::uint64_t { size_draw = 0, species_draw, place_draw, velocity_draw, order_draw, draws_of_one };
/// Stream of the first feed; fillings have the streams before it.
inline constexpr std::uint64_t first_feed = 1000;

/// Returns whether a species of a mix touches a wall.
[[nodiscard]] bool touches(const Spec& spec, const MachineWall& wall, const Mix& mix);

/// Walls that a particle of a mix must not touch: those that touch one of its species.
class Obstacles {
public:
    /// Takes the present walls of `walls`, which are those of the spec, at a time, for spheres of up to the largest
    /// diameter.
    Obstacles(const Spec& spec, const Mix& mix, const std::vector<dem::Wall>& walls, double largest, double time,
              dem::MovingWall::Searches searches = dem::MovingWall::Searches::many);
    /// Returns whether a sphere touches a wall.
    [[nodiscard]] bool touch(const Vec3& centre, double radius) const { return touched(centre, radius).has_value(); }
    /// Returns the number of the first wall that a sphere touches.
    [[nodiscard]] std::optional<std::size_t> touched(const Vec3& centre, double radius) const;

private:
    std::vector<dem::MovingWall> walls_;
    std::vector<std::size_t> numbers_;  ///< of each, in the spec
};

}  // namespace grainsweep::machine
