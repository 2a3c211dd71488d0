// A machine as numbers: everything that a Run needs to know of an experiment. SI.
//
// No text that needs an interpreter, no file, no expression: the reader of machine files resolves all of them for the
// parameters of a case. Names serve messages and pictures only.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/region.hpp"
#include "solver/particles/size_distribution.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace grainsweep::machine {

/// One kind of particles as the user tells them apart; several may be of one material.
struct Species {
    std::string name;
    std::uint8_t material = 0;          ///< of Spec::densities
    double diameter = 0;                ///< D, m
    particles::SizeDistribution sizes;  ///< of d/D

    [[nodiscard]] double largest() const { return diameter * sizes.largest(); }
    [[nodiscard]] double smallest() const { return diameter * sizes.smallest(); }
    /// Mean volume of a sphere, m3.
    [[nodiscard]] double mean_volume() const { return particles::sphere_volume(diameter) * sizes.moment(3); }
};

/// Phases by number, in which something is there; empty: in all.
using Phases = std::vector<std::size_t>;
[[nodiscard]] bool holds(const Phases& phases, std::size_t phase);

/// From the beginning of one phase to the end of another one.
struct WhileIn {
    std::size_t first = 0, last = 0;
};

struct WallMotion {
    geometry::Motion motion;  ///< its start and end count, unless there are phases
    std::optional<WhileIn> phases;
};

struct MachineWall {
    std::string name;
    geometry::Shape shape;
    std::vector<WallMotion> motions;
    std::vector<dem::Material> materials;  ///< of its contacts with each material of the particles
    Phases during;
};

/// Shares of species in a filling or feed, by number of particles; their sum is 1.
using Mix = std::vector<std::pair<std::size_t, double>>;

struct Fill {
    enum class As { lattice, random, rain, packed };
    Mix mix;
    std::int64_t count = 0;
    Region in;
    As as = As::lattice;
    Vec3 velocity{};    ///< m/s
    double shaken = 0;  ///< m/s: random velocities up to this in each direction
    bool glued = false;
};

/// Spheres one by one.
struct Placed {
    std::size_t species = 0;
    dem::Sphere sphere;
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

/// What ends a phase early.
struct AtRest {};
/// No particle in the region.
struct Empty {
    Region region;
};
/// The mass in the region has not changed for a time, s.
struct FlowStops {
    Region region;
    double quiet = 0;
};
/// A measurement above or below a value.
struct Passes {
    std::size_t measure = 0;
    double value = 0;
    bool above = true;
};
using Until = std::variant<AtRest, Empty, FlowStops, Passes>;

struct Phase {
    std::string name;
    double duration = 0;             ///< s, at most; 0: one step
    std::optional<double> expected;  ///< s, where it may end sooner; for predictions of cost alone
    std::vector<Until> until;        ///< whatever holds first
    std::int64_t frames = 100;       ///< intervals between measurements
    bool ends_at_frames = false;     ///< its conditions are looked at where probes look, and at no other time
};

/// Only at frames at which another measurement lies within bounds.
struct While {
    std::size_t measure = 0;
    double low = 0, high = 0;
};

struct Measure {
    std::string name;
    std::string probe;  ///< of probe_catalogue()
    Options options;
    std::string reduction;  ///< of reduction_catalogue()
    Phases during;
    std::optional<std::pair<double, double>> shares;  ///< only values between these shares of the first one count
    std::vector<While> only;
    std::optional<std::size_t> since;  ///< phase from whose beginning the times of a series count
};

/// The first time at which a measurement is above or below a value.
struct TimeOf {
    std::string name;
    std::size_t measure = 0;
    double value = 0;
    bool above = true;
};

/// Calculated from other observables; what it needs may be absent, and then it is.
struct Derived {
    std::string name;
    std::vector<std::string> needs;
    std::function<double(const std::map<std::string, double, std::less<>>&)> value;
};

struct Spec {
    Vec3 gravity{0, 0, -9.81};
    geometry::Domain domain;
    std::vector<std::string> materials;  ///< of particles
    std::vector<double> densities;       ///< of each, kg/m3
    std::vector<dem::Material> pairs;    ///< of their contacts, at dem::place_of_pair()
    std::vector<Species> species;
    std::vector<MachineWall> walls;
    std::vector<std::variant<Fill, std::vector<Placed>>> fills;
    std::vector<Feed> feeds;
    std::vector<Phase> phases;
    std::vector<Measure> measures;
    std::vector<TimeOf> times;
    std::vector<Derived> derived;
    std::vector<Warning> warnings;  ///< what the machine file warns of
    double time_step = 0;           ///< s
    dem::Method method;
};

}  // namespace grainsweep::machine
