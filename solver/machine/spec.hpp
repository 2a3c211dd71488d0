// Machine as numbers in SI: the complete input of a Run.
//
// It contains no expression and no file: the reader of machine files resolves these for the parameters of a case. Names
// are for messages and pictures only.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/region.hpp"
#include "solver/particles/clump.hpp"
#include "solver/particles/size_distribution.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <ranges>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace grainsweep::machine {

/// Species: particles that the user distinguishes. Several species may have one material.
struct Species {
    std::string name;
    std::uint8_t material = 0;                ///< index in Spec::densities
    double diameter = 0;                      ///< D, m; of a clump: of the sphere of equal volume
    particles::SizeDistribution sizes;        ///< of d/D
    std::optional<particles::Clump> shape{};  ///< empty: spheres
    std::optional<double>
        cover{};  ///< volume that the file of a shape and its spheres share, divided by that of either
    dem::DampingMass damping_mass = dem::DampingMass::contact;

    [[nodiscard]] double largest() const { return diameter * sizes.largest(); }
    [[nodiscard]] double smallest() const { return diameter * sizes.smallest(); }
    /// Returns the diameter of the sphere around a particle's centre of mass that holds it, divided by d.
    [[nodiscard]] double girth() const { return shape ? 2 * shape->reach() : 1; }
    /// Returns the diameters of the largest sphere around a particle, and of the smallest sphere of any, m.
    [[nodiscard]] double widest() const { return largest() * girth(); }
    [[nodiscard]] double finest() const { return shape ? 2 * shape->smallest() * smallest() : smallest(); }
    /// Returns a particle's mass divided by density and volume: 1 unless the shape has a mass of its own.
    [[nodiscard]] double mass_factor() const { return shape ? shape->mass / particles::sphere_volume(1) : 1; }
    /// Returns the mean volume of a particle, m3.
    [[nodiscard]] double mean_volume() const { return particles::sphere_volume(diameter) * sizes.moment(3); }
    /// Returns a particle's mass divided by its volume, kg/m3; `densities`: of the materials.
    [[nodiscard]] double density(const std::vector<double>& densities) const {
        return densities[material] * mass_factor();
    }
};

/// Numbers of the phases in which something is present; empty: all.
using Phases = std::vector<std::size_t>;
[[nodiscard]] bool holds(const Phases& phases, std::size_t phase);

/// Range from the beginning of one phase to the end of another.
struct WhileIn {
    std::size_t first = 0, last = 0;
};

struct WallMotion {
    geometry::Motion motion;  ///< its start and end apply, unless phases are given
    std::optional<WhileIn> phases;
};

/// Each time that a phase comes again, a wall starts anew where it is drawn, moved on.
struct Again {
    Phases each;             ///< copies of the phase
    Vec3 by{};               ///< m, each time but the first
    std::int64_t first = 0;  ///< time of the phase from which on it is there
};

struct MachineWall {
    std::string name;
    geometry::Shape shape;
    std::vector<WallMotion> motions;
    std::vector<dem::Material> materials;  ///< one for its contacts with each material of the particles
    Phases during;
    std::uint8_t passing = 0;  ///< materials of particles that pass through it, bit by bit
    std::optional<Again> again{};
    Vec3 scattered{};     ///< m: it is drawn away from its place by a random share of this, another one in each case
    bool fitted = false;  ///< a surface of a file that was made to repeat itself across

    /// Returns how often the phase of `again` has come back up to a phase.
    [[nodiscard]] std::size_t times(std::size_t phase) const;
    /// Returns whether it starts anew at the beginning of a phase.
    [[nodiscard]] bool starts_anew(std::size_t phase) const { return phase > 0 && times(phase) != times(phase - 1); }
    /// Returns whether it is there in a phase.
    [[nodiscard]] bool present(std::size_t phase) const {
        return holds(during, phase) && (!again || static_cast<std::int64_t>(times(phase)) >= again->first);
    }
    [[nodiscard]] bool touches(const Species& species) const { return (passing >> species.material & 1U) == 0; }
};

/// Shares of species in a filling or feed, by number of particles; their sum is 1.
using Mix = std::vector<std::pair<std::size_t, double>>;

struct Fill {
    enum class As { lattice, random, rain, packed, cells };
    Mix mix;
    std::int64_t count = 0;
    Region in;
    As as = As::lattice;
    Vec3 velocity{};    ///< m/s
    double shaken = 0;  ///< m/s: random velocities up to this in each direction
    bool glued = false;
    std::size_t at = 0;                ///< phase at whose beginning they appear
    bool on_top = false;               ///< the region is raised above what lies in it
    double spacing = 1.1;              ///< of cells, largest diameters
    std::optional<double> drawn_to{};  ///< m3: particles are drawn until their volume is nearest to it
};

/// Particles taken away at the beginning of a phase.
struct Removal {
    enum class Of { centre, part, whole };
    Region in;
    Of of = Of::centre;  ///< what of a particle lies in the region
    std::size_t at = 0;
};

/// Individually placed particle: a sphere, or the sphere of equal volume at a clump's centre of mass.
struct Placed {
    std::size_t species = 0;
    dem::Sphere sphere;
    std::optional<geometry::Quaternion> orientation{};  ///< of a clump, in the frame in which its shape is described
    bool named = false;                                 ///< probes may select it alone
};

/// Spheres cut from a random close packing of equal ones in a cube: those with centres in a region.
struct Cut {
    std::string name;  ///< of its observables; empty: none
    std::size_t species = 0;
    double edge = 0;         ///< of the cube, whose lowest corner is the origin, m
    double fraction = 0.62;  ///< of the volume
    double seed = 0;         ///< of the packing; 0: that of the case
    std::string centres;     ///< contents of the packing's file (particles/packing.hpp); empty: it is made
    Region in;
    bool glued = false;
    /// Of glued spheres those that no mobile one can touch are left out, as long as overlaps stay below this share of
    /// the diameter; a larger one ends the case as not sound. Empty: all are there.
    std::optional<double> tight{};
};

struct Feed {
    std::string name;
    Mix mix;
    double rate = 0;  ///< kg/s
    Region through;
    Vec3 velocity{};
    double interval = 0;  ///< s, between two batches
    Phases during;
};

/// Conditions that end a phase early.
struct AtRest {};
/// Condition: no particle is in the region.
struct Empty {
    Region region;
};
/// Condition: the mass in the region has not changed for a time, s.
struct FlowStops {
    Region region;
    double quiet = 0;
};
/// Condition: for a time at most a share of the mobile particles in a region, or one, was faster than a speed at each
/// check, and the number of all in it changed by no more.
struct Quiet {
    Region region;
    double speed = 0;  ///< m/s
    double share = 0;
    double time = 0;  ///< s
};
/// Condition: a measurement is above or below a value.
struct Passes {
    std::size_t measure = 0;
    double value = 0;
    bool above = true;
};
/// Condition, at a frame: the standard error of a measurement is below a value, or it has not changed at all.
struct Known {
    std::size_t measure = 0;
    double error = 0;
    double from = 0.5;        ///< share of the frames of the phase before the first look
    std::int64_t every = 10;  ///< frames from look to look: chance does not end a phase that is seldom looked at
};
using Until = std::variant<AtRest, Empty, FlowStops, Quiet, Passes, Known>;

struct Phase {
    std::string name;
    double duration = 0;             ///< longest duration, s; 0: one step
    std::optional<double> expected;  ///< s, if the phase may end early; used only to predict the cost
    std::vector<Until> until;        ///< the first condition that holds ends the phase
    std::int64_t frames = 100;       ///< intervals between measurements
    std::optional<double> every{};   ///< s, of these, in whole time steps; empty: the phase is divided evenly
    bool frames_given = false;       ///< by the user: they are equal then, even in step with a motion (frames.hpp)
    bool ends_at_frames = false;     ///< its conditions are checked only at frames
};

/// Restriction to frames at which another measurement lies within bounds.
struct While {
    std::size_t measure = 0;
    double low = 0, high = 0;
};

/// Units in which a measurement is shown: values, times and bins are divided by these.
struct Scale {
    double value = 1, time = 1, bin = 1;
};

struct Measure {
    std::string name;
    std::string probe;  ///< name in probe_catalogue()
    Options options;
    std::string reduction;  ///< name in reduction_catalogue()
    Phases during;
    std::optional<std::pair<double, double>> shares;  ///< only values between these shares of the first one count
    std::vector<While> only;
    std::optional<std::size_t> since;  ///< the times of a series are measured from the beginning of this phase
    /// How phases that repeat count: all together, only the last time, or each time by itself, as a profile.
    enum class Repeats { all, last, each };
    Repeats repeats = Repeats::all;
    std::string error;       ///< name of the observable that is its standard error
    bool relative = false;   ///< values are divided by the first one, of a profile bin by bin
    std::int64_t every = 1;  ///< measured at each frame whose number is a multiple, and at the last of a phase
    Scale scale;
};

/// Result: first time at which a measurement is above or below a value.
struct TimeOf {
    std::string name;
    std::size_t measure = 0;
    double value = 0;
    bool above = true;
    Scale scale;
};

/// Result calculated from other observables; absent if one of these is absent.
struct Derived {
    std::string name;
    std::vector<std::string> needs;
    std::function<double(const std::map<std::string, double, std::less<>>&)> value;
    std::string error{};  ///< observable that is absent with it
};

/// First phases, which prepare the powder: they are not measured, and behind them contacts with walls begin anew.
struct Start {
    std::size_t phases = 0;  ///< 0: there is none
    std::optional<double>
        seed{};  ///< of its random numbers: cases with the same start share it; empty: that of the case
};

struct Spec {
    Vec3 gravity{0, 0, -9.81};
    dem::Shaking shaking;  ///< of the whole machine, in whose frame everything is given
    geometry::Domain domain;
    /// Materials of particles. One that several species have is there several times if a wall tells these apart.
    std::vector<std::string> materials;
    std::vector<double> densities;     ///< of each, kg/m3
    std::vector<dem::Material> pairs;  ///< of their contacts, at dem::place_of_pair()
    dem::Surface glued;                ///< how contacts with glued particles differ; only with one material
    std::vector<Species> species;
    std::vector<MachineWall> walls;
    std::vector<std::variant<Fill, std::vector<Placed>, Cut>> fills;
    std::vector<Removal> removals;
    std::vector<Feed> feeds;
    std::vector<Phase> phases;
    Start start;
    std::vector<Measure> measures;
    std::vector<TimeOf> times;
    std::vector<Derived> derived;
    std::vector<Warning> warnings;         ///< warnings about the machine file
    std::optional<double> impact_speed{};  ///< m/s, from which the time step follows; empty: fastest_of()
    double time_step = 0;                  ///< s
    std::optional<double> step_share;      ///< of dem::Setup
    dem::Method method;
};

/// Returns the region as far as it is in the domain.
[[nodiscard]] inline Bounds bounds_in(const Spec& spec, const Region& region) {
    return shared(region.bounds(), {spec.domain.low, spec.domain.high});
}

/// Returns the fillings of one kind, in their order.
template <class Kind, class Fills>
[[nodiscard]] auto of_kind(Fills& fills) {
    return fills | std::views::filter([](const auto& fill) { return std::holds_alternative<Kind>(fill); }) |
           std::views::transform([](auto& fill) -> auto& { return std::get<Kind>(fill); });
}

}  // namespace grainsweep::machine
