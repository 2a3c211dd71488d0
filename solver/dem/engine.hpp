// The setup of a DEM calculation, and the interface of the engines that compute it.
//
// Velocity Verlet over spheres with translational and rotational freedom (signs: overlap > 0 in contact,
// n points from j or wall to i, the computed force acts on i). One call of the virtual interface runs many steps. There
// are a clear double-precision engine and fast mixed-precision ones, each compiled for combinations of laws;
// make_engine chooses once per case.
#pragma once

#include "solver/dem/body.hpp"
#include "solver/dem/crossings.hpp"
#include "solver/dem/limits.hpp"
#include "solver/dem/material.hpp"
#include "solver/dem/walls/wall.hpp"
#include "solver/geometry/domain.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::dem {

/// Sphere at the start, or a sphere that is added. At the start, its index in Setup::spheres is its permanent id.
struct Sphere {
    Vec3 position{};          ///< m
    Vec3 velocity{};          ///< m/s
    Vec3 angular_velocity{};  ///< rad/s
    double radius = 0;        ///< m
    bool mobile = true;       ///< false: frozen, an obstacle of infinite mass
    std::uint8_t kind = 0;    ///< of Setup::kinds
};

using geometry::Domain;  // a particle whose centre passes an open face is removed

/// Shaking of the vessel, which consists of frozen spheres, walls and domain. Its displacement is amplitude sin(2 pi
/// frequency t), t since the start. All positions and velocities in this interface are in the frame of the vessel. In
/// this frame frozen spheres rest and shaking is a body force (solver/dem/shaking.hpp).
struct Shaking {
    Vec3 amplitude{};      ///< m
    double frequency = 0;  ///< Hz; a period lasts at least twenty time steps
};

/// Returns the place of a pair of kinds, in any order, in a list of all pairs.
[[nodiscard]] constexpr std::size_t place_of_pair(std::size_t a, std::size_t b) {
    return a < b ? b * (b + 1) / 2 + a : a * (a + 1) / 2 + b;
}

/// Kinds of spheres of a powder.
struct Kinds {
    std::vector<double> densities;  ///< of each, kg/m3
    std::vector<Material> pairs;    ///< materials of their contacts, at place_of_pair(); the density in them is not
                                    ///< used
};

/// Range of mobile spheres that Engine::add may add: one kind, and a range of radii.
struct ToCome {
    double smallest = 0, largest = 0;  ///< radius, m
    std::uint8_t kind = 0;             ///< of Setup::kinds
};

/// Returns the member spheres of a clump where it is, all of one kind.
[[nodiscard]] std::vector<Sphere> members_of(const BodyShape& shape, const Body& body, std::uint8_t kind = 0);

struct Setup {
    Domain domain;
    Material material;  ///< of all spheres, unless there are kinds
    Kinds kinds;
    Vec3 gravity{0, 0, -9.81};  ///< m/s2
    Shaking shaking;
    double time_step = 1e-5;  ///< s
    /// Largest share, in (0, 1], of the longest stable step of the contacts: the engine computes a step in parts where
    /// it is longer (step_control.hpp). Empty: the step is fixed, and a step beyond the limit is a fault.
    std::optional<double> step_share{};
    std::vector<Sphere> spheres;
    std::vector<ToCome> to_come;      ///< spheres that may be added later, also as members of clumps
    std::vector<BodyShape> shapes{};  ///< of clumps
    std::vector<Body> bodies{};       ///< clumps; their members are among the spheres
    std::vector<Wall> walls;
    std::vector<CountingPlane> counting;  ///< planes whose crossings are recorded
    Surface frozen;  ///< deviations from the material in contacts with frozen spheres; only without kinds
    /// Overlap with a wall, divided by the diameter, above which the state is not sound. Bodies that pinch a particle,
    /// such as a screw and its trough, press it deeper than the law is valid; at 0.5 the centre passes the wall.
    double deepest_in_walls = largest_sound_overlap;
};

/// Method of computing a Setup. It does not change the result beyond the stated error of the precision.
struct Method {
    enum class Precision { mixed, double_precision };
    enum class Path { best, baseline, avx2, avx512 };  ///< best: the widest of this processor; baseline: not on x86
    Precision precision = Precision::double_precision;
    Path path = Path::best;
    double skin = 0;  ///< m; skin of the neighbour list, 0: chosen by the engine
    /// m/s; mixed precision only. Particles that have been slower than this for a while are not advanced, until a
    /// faster body comes near or a force above half their weight acts (solver/dem/fast/resting.hpp). 0: all particles
    /// are advanced. Not possible with shaking, blades, or without gravity.
    double rest_speed = 0;
    int threads = 1;  ///< mixed precision: see Engine::set_threads
};

/// State of the particles present, in order of id.
struct State {
    std::vector<std::int32_t> id;
    std::vector<Vec3> position, velocity, angular_velocity;  ///< velocities at the full step
    std::vector<double> radius;
    std::vector<char> mobile;
    std::vector<BodyState> bodies{};  ///< clumps present, in order of id
};

/// Contact of the present state: response of the laws at full-step velocities, with the present tangential
/// displacement. The force normal_force normal + tangential_force acts on `first`, its reaction on `second`. A step
/// uses the velocities of the half step before, so its damping force differs by O(dt).
struct ContactForce {
    std::int32_t first = 0;   ///< id
    std::int32_t second = 0;  ///< id, or -1 - w for wall w
    double overlap = 0;       ///< m
    Vec3 normal{};            ///< unit, from second to first
    double normal_force = 0;  ///< N, with damping and cohesion; positive repels
    Vec3 tangential_force{};  ///< N
    Vec3 rolling_moment{};    ///< N m, moment on `first` in addition to the moments of the forces; on `second` with the
                              ///< opposite sign
    Vec3 slip{};              ///< tangential velocity of `first` relative to `second`, m/s
    bool slides = false;      ///< the tangential force is at the limit of friction, or there is no friction
    /// Power that the normal force, and all other forces and moments, remove from the motion of both bodies, W.
    double normal_power = 0, tangential_power = 0;
    double stored = 0;  ///< energy in the springs, and of cohesion, J
};

/// Load of the particles on a wall in the last step of a run (after a fault: of moving walls). It is the reaction to
/// the forces and moments on the particles, so momentum and angular momentum are conserved. The work is the work of the
/// force on the wall's material at the closest point, with the velocity that the laws use.
struct WallLoad {
    Vec3 force{};     ///< on the wall, N
    Vec3 torque{};    ///< on the wall about the given point, N m
    double work = 0;  ///< work of the wall on the particles since the walls were set, J
    /// Integrals of force and torque over all steps since the walls were set, N s and N m s; 0 unless
    /// Wall::integrated.
    Vec3 impulse{}, angular_impulse{};
};

/// Counts of work, for cost and benchmarks.
struct Work {
    std::int64_t steps = 0;       ///< time steps completed
    std::int64_t most_parts = 1;  ///< largest number of parts of a step
    double particle_steps = 0;    ///< mobile particles times steps, or parts of steps
    double resting_steps = 0;     ///< of these, steps of particles at rest (Method::rest_speed)
    double pair_visits = 0;       ///< list entries evaluated
    std::int64_t rebuilds = 0;
    std::map<std::string, double, std::less<>> seconds;  ///< by phase, if measured
};

class Engine {
public:
    Engine() = default;
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;
    virtual ~Engine() = default;

    /// Advances by `steps` time steps; stops as soon as the state is not sound (fault()).
    virtual void run(std::int64_t steps) = 0;
    /// Advances by one part of a time step, the whole step if it has one part (Setup::step_share).
    virtual void run_part() = 0;
    /// Returns the length of the last part, s.
    [[nodiscard]] virtual double part() const = 0;
    /// Returns whether the last part has completed a step.
    [[nodiscard]] virtual bool at_step() const = 0;
    /// Sets the largest number of threads of the next run(), including the calling thread; 0: one for each core. With
    /// few particles, fewer threads are used. No bit depends on the number. The double-precision engine always uses
    /// one. Returns the number that suits the present particles.
    virtual int set_threads(int count) { return static_cast<void>(count), 1; }
    /// Sets new walls. Wall time starts at 0, histories of wall contacts are removed, histories of pairs stay. Forces
    /// are recomputed once without changing histories. Throws std::invalid_argument with one sentence for impossible
    /// walls, and for walls with friction or rolling friction if no material of the Setup has any.
    virtual void set_walls(std::vector<Wall> walls) = 0;
    /// Changes motions and presence of the walls, but not their shapes, surfaces and materials. Wall time, the work of
    /// each wall, and the histories of contacts with walls that stay present continue. Forces are recomputed once
    /// without changing histories. The new motions of a wall that stays present must give its present place. Throws
    /// std::invalid_argument with one sentence for other bodies or impossible motions.
    virtual void change_walls(std::vector<Wall> walls) = 0;
    /// Adds spheres. Their ids follow all earlier ids in order, including ids of removed particles. Each call rebuilds
    /// the lists and recomputes the forces once, without changing histories, so one call for many spheres costs less. A
    /// sphere beyond an open face is removed at once. Overlaps produce forces. Throws std::invalid_argument with one
    /// sentence for an impossible sphere, or one that Setup::to_come does not include. After a fault nothing is added.
    /// `bodies`: clumps whose members are among these spheres; Body::first counts from the first of them.
    virtual void add(std::span<const Sphere> spheres, std::span<const Body> bodies = {}) = 0;
    /// Removes particles by id; absent ids are ignored. A clump leaves as a whole: by the id of any member, and when
    /// its centre of mass passes an open face.
    virtual void remove(std::span<const std::int32_t> ids) = 0;

    [[nodiscard]] virtual std::size_t size() const = 0;  ///< spheres present, members of clumps included
    [[nodiscard]] virtual double wall_time() const = 0;  ///< s since the walls were set
    virtual void state(State& into) const = 0;           ///< reuses the vectors' memory
    /// Returns the largest particle-particle overlap divided by the smaller diameter, among the contacts of the last
    /// step.
    [[nodiscard]] virtual double largest_overlap() const = 0;
    /// Returns the largest value of largest_overlap() after any step since the start, or since
    /// forget_peak_overlap().
    [[nodiscard]] virtual double peak_overlap() const = 0;
    /// Returns the same of overlaps with walls, divided by the particle's diameter.
    [[nodiscard]] virtual double peak_wall_overlap() const = 0;
    /// Forgets both peaks.
    virtual void forget_peak_overlap() = 0;
    /// Lists every touching pair with a mobile particle, and every touch of a wall. The order depends on the state
    /// only.
    virtual void contacts(std::vector<ContactForce>& into) const = 0;
    /// Lists the same contacts with the forces of the last step, which use the velocities of the half step before. The
    /// powers times the time step are the loss of the step. The kinetic energy at half steps changes by this loss, the
    /// work of the walls and the work of body forces. This is exact to rounding in double precision. In mixed
    /// precision the loss of an impact is exact to 1e-3, where it is more than the rounding of the motion, 1e-7 of the
    /// kinetic energy. Valid only after a step.
    virtual void step_contacts(std::vector<ContactForce>& into) const = 0;
    /// Returns the wall with this number, with travel and speed of its free motions.
    [[nodiscard]] virtual const Wall& wall(std::size_t wall) const = 0;
    /// Returns the load on the wall with this number, about a point.
    [[nodiscard]] virtual WallLoad wall_load(std::size_t wall, const Vec3& about) const = 0;
    /// Returns the booked changes of the kinetic energy of a wall that the powder moves, exact to rounding. Speeds and
    /// energy are those of the full step in double precision, and in mixed precision those half a step later.
    [[nodiscard]] virtual const geometry::BodyEnergy& wall_energy(std::size_t wall) const = 0;
    /// Appends the crossings of Setup::counting since the last call to `into`, in the order of the steps, and forgets
    /// them. save() does not store crossings: call this function before it.
    virtual void take_crossings(std::vector<Crossing>& into) = 0;
    /// Returns the fault of an unsound state, with place and time; empty: the state is sound.
    [[nodiscard]] virtual const std::string& fault() const = 0;
    [[nodiscard]] virtual Work work() const = 0;
    /// Saves the complete state. An engine of the same Setup and Method restored from it continues with the same bits.
    /// restore() forgets crossings that were not taken.
    virtual void save(std::vector<std::byte>& into) const = 0;
    virtual void restore(std::span<const std::byte> from) = 0;
};

/// Throws std::invalid_argument with one sentence for a setup that no engine can compute.
void require_possible(const Setup& setup);
/// Throws the same for spheres that `to_come` does not include, or too many to be numbered after the `given` ids.
void require_announced(const std::vector<ToCome>& to_come, std::span<const Sphere> spheres, std::size_t given);
/// Throws the same for clumps that do not fit the shapes, the spheres or the domain.
void require_possible(std::span<const Body> bodies, const Setup& setup, std::span<const Sphere> spheres);
/// Throws the same for a method that does not suit a possible setup.
void require_possible(const Setup& setup, const Method& method);

/// Returns an engine, with laws and instruction path chosen. Throws std::invalid_argument with one sentence for an
/// impossible setup.
[[nodiscard]] std::unique_ptr<Engine> make_engine(const Setup& setup, const Method& method);

}  // namespace grainsweep::dem
