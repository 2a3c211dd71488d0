// Conversion of a Spec to the setup of an engine.
#pragma once

#include "solver/machine/filling.hpp"
#include "solver/machine/spec.hpp"

#include <functional>
#include <vector>

namespace grainsweep::machine {

/// Begin and end of each phase, as far as it has begun or ended, s.
struct PhaseTimes {
    std::vector<double> begin, end;
};

/// Calls visit for the regions in which particles are looked for: of measurements, conditions and removals.
void each_region(Spec& spec, const std::function<void(Region&)>& visit);
/// Returns whether the value of a measurement is integrated over every step.
[[nodiscard]] bool is_integrated(const Measure& measure);
/// Returns the runs of successive phases in which it is measured.
[[nodiscard]] std::vector<WhileIn> runs_of(const Spec& spec, const Measure& measure);
/// Returns the way of a wall until a time by its motions other than turns, m; `along`: of it, if given.
[[nodiscard]] Vec3 way_of(const dem::Wall& wall, const std::optional<Vec3>& along, double time);
/// Returns the walls in a phase, with their presence and their motion from now on. Motions of phases that have not
/// begun are left out. `zero`: time at which the walls were set, s. In the start, walls that it is without are planes.
[[nodiscard]] std::vector<dem::Wall> walls_in(const Spec& spec, std::size_t phase, const PhaseTimes& times,
                                              double zero = 0);
/// Returns the shape of a species of clumps for an engine: at scale 1 it has the volume of a sphere of 1 m, so that a
/// clump's diameter is its scale.
[[nodiscard]] dem::BodyShape body_shape(const Spec& spec, const Species& species);
/// Returns the number of a species among those with a shape: of dem::Setup::shapes.
[[nodiscard]] std::size_t shape_number(const Spec& spec, std::size_t species);
/// Returns the setup at the start, in the first phase.
[[nodiscard]] dem::Setup setup_of(const Spec& spec, const Filled& filled);
/// Returns the time step: a fraction of the shortest Rayleigh time and of the shortest Hertz contact time of any two
/// particles that meet at `speed`, and of what the springs of walls allow, s.
[[nodiscard]] double time_step_of(const Spec& spec, double fraction, double speed);
/// Sets the time step to a fraction of the longest one, s, and lets it follow the load (dem::Setup::step_share).
void take_own_step(Spec& spec, double fraction, double longest);
/// Returns the fastest impact to be expected: the fall from the top of the fillings and feeds to the lower end of the
/// domain, with the fastest wall or feed, m/s.
[[nodiscard]] double fastest_of(const Spec& spec);
/// Returns a box around walls, fillings and feeds at all times, enlarged by two of the largest diameters. Throws
/// std::invalid_argument if nothing bounds it along an axis whose ends are not given.
[[nodiscard]] geometry::Domain domain_around(const Spec& spec, const std::array<bool, 3>& given = {});

}  // namespace grainsweep::machine
