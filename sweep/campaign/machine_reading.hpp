// Conversion of a machine file to a Spec, section by section. Internal to the reader of machines.
#pragma once

#include "solver/machine/spec.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_scope.hpp"

#include <limits>
#include <string>
#include <vector>

namespace grainsweep::campaign {

inline constexpr double endless = std::numeric_limits<double>::infinity();

/// State of the reading of a machine: names read so far, and the incomplete Spec.
struct MachineReading {
    MachineReading(const std::map<std::string, std::string, std::less<>>& given, MachineScope names)
        : files(given), scope(std::move(names)) {}

    const std::map<std::string, std::string, std::less<>>& files;
    std::map<std::string, std::string_view, std::less<>> chosen;  ///< contents of parameters that are files, by value
                                                                  ///< of the parameter
    MachineScope scope;
    double particles_scale = 1, stiffness_scale = 1;

    machine::Spec spec;
    std::vector<std::string> materials;                ///< all materials, including those of walls
    std::vector<dem::Elasticity> elasticities;         ///< of each
    std::vector<double> densities;                     ///< of each material; 0: not given
    std::vector<std::size_t> of_particles;             ///< materials of particles, in the order of Spec::densities
    std::vector<std::vector<dem::Material>> contacts;  ///< by material and material
    std::vector<std::string> species, phases;
    std::vector<std::string> walls;                 ///< names in the file
    std::vector<std::vector<std::size_t>> repeats;  ///< walls of the Spec for each of them
    std::vector<std::string> measures;              ///< measures with a probe, in the order of the Spec

    /// Returns the contents of a file that a text names.
    [[nodiscard]] std::string_view contents(const Cursor& place) const;
};

void read_materials(const Section& top, MachineReading& reading);
void read_species(const Section& top, MachineReading& reading);
void read_contacts(const Section& top, MachineReading& reading);
void read_phase_names(const Section& top, MachineReading& reading);
void read_walls(const Section& top, MachineReading& reading);
void read_fills(const Section& top, MachineReading& reading);
void read_feeds(const Section& top, MachineReading& reading);
void read_phases(const Section& top, MachineReading& reading);
void read_measures(const Section& top, MachineReading& reading);
void read_surroundings(const Section& top, MachineReading& reading);
void read_checks(const Section& top, MachineReading& reading);

/// Reads the "shape" of a species with material and, unless its spheres have one, diameter.
void read_grain_shape(const Cursor& place, const MachineReading& reading, machine::Species& species);
/// Refuses rolling friction of species with a shape.
void refuse_rolling_shapes(const Section& top, const MachineReading& reading);
[[nodiscard]] geometry::Shape read_shape(const Section& wall, const MachineReading& reading);
/// Reads the next motion of a wall, which has its shape and earlier motions. `present`: whether the motion acts in this
/// case.
[[nodiscard]] machine::WallMotion read_motion(const Cursor& place, const MachineReading& reading,
                                              const machine::MachineWall& wall, bool& present);
/// Reads a motion with "follow" as motions of constant velocity.
[[nodiscard]] std::vector<machine::WallMotion> read_follow(const Section& motion, const MachineReading& reading);
/// Reads the phases of "during"; empty: all.
[[nodiscard]] machine::Phases read_during(const Section& section, const MachineReading& reading);
/// Returns the index of a measurement of one value, by its name.
[[nodiscard]] std::size_t measure_named(const Cursor& place, const MachineReading& reading);
[[nodiscard]] std::string_view unit_of_measure(const MachineReading& reading, std::size_t measure);
/// Reads "scale" of a measurement or its time.
void read_scale(const Cursor& place, const MachineReading& reading, machine::Scale& into);
/// Reads what counts of a measurement and how it is shown, after all measurements have their numbers.
void read_counting(const Cursor& place, const MachineReading& reading, machine::Measure& into);
/// Returns names and observables of "measure", in the order of the names.
[[nodiscard]] std::vector<ObservableSpec> machine_observables(const Section& top);

/// Refuses names other than letters, digits and _, not a digit first, at most 64 characters.
void require_name(const Cursor& place, std::string_view name);

}  // namespace grainsweep::campaign
