// The setup of a DEM calculation, and the interface of the engines that compute it.
//
// Velocity Verlet over spheres with translational and rotational freedom (signs: overlap > 0 in contact,
// n points from j or wall to i, the computed force acts on i). The interface is virtual but coarse: one call
// runs many steps. It has a clear double-precision engine and fast mixed-precision ones, each instantiated
// for the laws a case needs; make_engine chooses once per case.
#pragma once

#include "solver/dem/limits.hpp"
#include "solver/dem/material.hpp"
#include "solver/dem/walls/wall.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::dem {

/// One sphere at the start, or one that is added. At the start its index in Setup::spheres is its id for ever.
struct Sphere {
    Vec3 position{};          ///< m
    Vec3 velocity{};          ///< m/s
    Vec3 angular_velocity{};  ///< rad/s
    double radius = 0;        ///< m
    bool mobile = true;       ///< false: frozen, an obstacle of infinite mass
    std::uint8_t kind = 0;    ///< of Setup::kinds
};

/// Periodic faces wrap; a particle whose centre passes an open face is removed.
struct Domain {
    Vec3 low{};
    Vec3 high{};
    std::array<bool, 3> periodic{};
};

/// Everything frozen, the walls and the domain together are a vessel that is shaken: its displacement is
/// amplitude sin(2 pi frequency t), t since the start. Positions and velocities in this interface, those of the start
/// too, are in the vessel's frame, where frozen spheres rest and shaking is a body force (solver/dem/shaking.hpp).
struct Shaking {
    Vec3 amplitude{};      ///< m
    double frequency = 0;  ///< Hz; a period lasts at least twenty time steps
};

/// Place of the pair of two kinds, in any order, in a list of all pairs.
[[nodiscard]] constexpr std::size_t place_of_pair(std::size_t a, std::size_t b) {
    return a < b ? b * (b + 1) / 2 + a : a * (a + 1) / 2 + b;
}

/// Powder of several kinds of spheres.
struct Kinds {
    std::vector<double> densities;  ///< of each, kg/m3
    std::vector<Material> pairs;    ///< of their contacts, at place_of_pair(); the density in them counts for nothing
};

/// Mobile spheres that Engine::add may add: of one kind, within a range of radii.
struct ToCome {
    double smallest = 0, largest = 0;  ///< radius, m
    std::uint8_t kind = 0;             ///< of Setup::kinds
};

struct Setup {
    Domain domain;
    Material material;  ///< of all spheres, unless there are kinds
    Kinds kinds;
    Vec3 gravity{0, 0, -9.81};  ///< m/s2
    Shaking shaking;
    double time_step = 1e-5;  ///< s
    std::vector<Sphere> spheres;
    std::vector<ToCome> to_come;  ///< what is not announced here cannot be added
    std::vector<Wall> walls;
    Surface frozen;  ///< what differs from the material in contacts with frozen spheres; without kinds
    /// Overlap with a wall over the diameter beyond which the state is not sound. Bodies that pinch a particle between
    /// them, as a screw and its trough do, drive it deeper than the law means; at 0.5 the centre passes the wall.
    double deepest_in_walls = largest_sound_overlap;
};

/// How to compute a Setup; never changes the result beyond the stated error of the precision.
struct Method {
    enum class Precision { mixed, double_precision };
    enum class Path { best, baseline, avx2, avx512 };  ///< best: what this processor has
    Precision precision = Precision::double_precision;
    Path path = Path::best;
    double skin = 0;  ///< m; neighbour-list skin, 0: the engine's own choice
    /// m/s; mixed precision: powder slower than this for a while and touched by nothing faster is not advanced, until
    /// something faster comes near or half its weight pushes it (solver/dem/fast/resting.hpp); 0: all is advanced.
    /// Not with a vessel that is shaken or blades, nor without gravity.
    double rest_speed = 0;
    int threads = 1;  ///< mixed precision: see Engine::set_threads
};

/// State of the particles still present, in order of id.
struct State {
    std::vector<std::int32_t> id;
    std::vector<Vec3> position, velocity, angular_velocity;  ///< velocities of the full step
    std::vector<double> radius;
    std::vector<char> mobile;
};

/// A contact of the present state: the response of the laws at the velocities of the full step, with the tangential
/// displacement that the contact has by now. The force normal_force normal + tangential_force acts on `first`, its
/// reaction on `second`. (A step uses the velocities of the half step before: a damping force differs by O(dt).)
struct ContactForce {
    std::int32_t first = 0;   ///< id
    std::int32_t second = 0;  ///< id, or -1 - w for wall w
    double overlap = 0;       ///< m
    Vec3 normal{};            ///< unit, from second to first
    double normal_force = 0;  ///< N, with damping and cohesion; positive repels
    Vec3 tangential_force{};  ///< N
    Vec3 rolling_moment{};    ///< N m on `first` besides that of the forces, minus that on `second`
    Vec3 slip{};              ///< tangential velocity of `first` over `second`, m/s
    bool slides = false;      ///< friction is at its limit, or there is none
    /// What the normal force, and all the rest, take out of the motion of both bodies, W.
    double normal_power = 0, tangential_power = 0;
    double stored = 0;  ///< energy in the springs, and of cohesion, J
};

/// Load on a wall by the particles in the last step of a run (after a fault: of walls that move): the reaction to their
/// forces, moments and torques. It conserves momentum and angular momentum. The work is that of
/// the force on the material of the wall at the closest point, with the velocity that the laws see.
struct WallLoad {
    Vec3 force{};     ///< on the wall, N
    Vec3 torque{};    ///< on the wall about the point asked for, N m
    double work = 0;  ///< of the wall on the particles since the walls were set, J
};

/// Work done, for cost and benchmarks.
struct Work {
    std::int64_t steps = 0;
    double particle_steps = 0;  ///< mobile particles times steps
    double resting_steps = 0;   ///< of these, of particles at rest (Method::rest_speed)
    double pair_visits = 0;     ///< list entries evaluated
    std::int64_t rebuilds = 0;
    std::map<std::string, double, std::less<>> seconds;  ///< by phase, where measured
};

class Engine {
public:
    Engine() = default;
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;
    virtual ~Engine() = default;

    /// Advances by `steps` time steps; stops at once when the state is no longer sound (fault()).
    virtual void run(std::int64_t steps) = 0;
    /// Uses up to `count` threads from the next run() on, the calling one among them; 0: one for each core. Where there
    /// are too few particles for it, fewer. No bit depends on it; the double-precision engine always uses one. Returns
    /// how many the particles that are there now are enough for.
    virtual int set_threads(int count) { return static_cast<void>(count), 1; }
    /// New walls: wall time starts at 0, wall histories are dropped, particle histories stay; forces are
    /// recomputed once without touching histories. Throws std::invalid_argument with one sentence on walls that cannot
    /// be, or whose surface has friction or rolling friction where nothing in the Setup had.
    virtual void set_walls(std::vector<Wall> walls) = 0;
    /// Gives the same bodies (shapes, surfaces and materials) other motions and presence. Wall time, the work of each
    /// wall, and the histories of contacts with walls that stay present continue. Forces are recomputed once without
    /// touching histories. Each wall that stays present must stand by its new motions where it stands now.
    /// Throws std::invalid_argument with one sentence on other bodies or motions that cannot be.
    virtual void change_walls(std::vector<Wall> walls) = 0;
    /// Adds spheres: their ids follow all earlier ids, also of particles that are gone, in order. Lists are made
    /// anew and forces recomputed once without touching histories, so that one call for many costs less. A sphere
    /// beyond an open face is gone at once; what it overlaps pushes it. Throws std::invalid_argument with one sentence
    /// on a sphere that cannot be or that Setup::to_come does not announce. After a fault nothing is added.
    virtual void add(std::span<const Sphere> spheres) = 0;
    /// Removes particles by id; absent ids are ignored.
    virtual void remove(std::span<const std::int32_t> ids) = 0;

    [[nodiscard]] virtual std::size_t size() const = 0;  ///< particles present
    [[nodiscard]] virtual double wall_time() const = 0;  ///< s since the walls were set
    virtual void state(State& into) const = 0;           ///< reuses the vectors' memory
    /// Largest particle-particle overlap over the smaller diameter among the contacts of the last step.
    [[nodiscard]] virtual double largest_overlap() const = 0;
    /// The largest value of largest_overlap() after any step since the start, or since forget_peak_overlap().
    [[nodiscard]] virtual double peak_overlap() const = 0;
    virtual void forget_peak_overlap() = 0;
    /// Every touching pair with a mobile partner, and every wall touched; the order depends on the state only.
    virtual void contacts(std::vector<ContactForce>& into) const = 0;
    /// The same with the forces of the last step, which the laws computed at the velocities of the half step before.
    /// Times the time step, the powers are the loss of a step: kinetic energy at half steps changes by them, by the
    /// work of the walls and by the work of body forces. This holds to rounding in double precision, and to 3e-3 in
    /// mixed precision, which judges anew whether springs yield. After a step only.
    virtual void step_contacts(std::vector<ContactForce>& into) const = 0;
    /// The wall with this number as it is, with way and speed of its free motions.
    [[nodiscard]] virtual const Wall& wall(std::size_t wall) const = 0;
    /// Of the wall with this number, about a point.
    [[nodiscard]] virtual WallLoad wall_load(std::size_t wall, const Vec3& about) const = 0;
    /// What changed the kinetic energy of a wall that the powder moves, to rounding. Speeds and energy are those of the
    /// full step in double precision, and in mixed precision those half a step later.
    [[nodiscard]] virtual const geometry::BodyEnergy& wall_energy(std::size_t wall) const = 0;
    /// What became unsound, where and when; empty: the state is sound.
    [[nodiscard]] virtual const std::string& fault() const = 0;
    [[nodiscard]] virtual Work work() const = 0;
    /// Everything: an engine made from the same Setup and Method and restored continues bit for bit.
    virtual void save(std::vector<std::byte>& into) const = 0;
    virtual void restore(std::span<const std::byte> from) = 0;
};

/// Throws std::invalid_argument with one sentence on a setup that no engine computes.
void require_possible(const Setup& setup);
/// The same on spheres that were not announced, or too many to be numbered behind the `given` ids.
void require_announced(const std::vector<ToCome>& to_come, std::span<const Sphere> spheres, std::size_t given);
/// The same on a method that does not go with a possible setup.
void require_possible(const Setup& setup, const Method& method);

/// Chooses laws and instruction path once. Throws std::invalid_argument with one sentence on an impossible setup.
[[nodiscard]] std::unique_ptr<Engine> make_engine(const Setup& setup, const Method& method);

}  // namespace grainsweep::dem
