// From a machine file to a Spec, section by section. Internal to the reader of machines.
#pragma once

#include "solver/machine/spec.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_scope.hpp"

#include <limits>
#include <string>
#include <vector>

namespace grainsweep::campaign {

inline constexpr double endless = std::numeric_limits<double>::infinity();
inline constexpr Interval positive_number{0, endless, true, true};
inline constexpr Interval no_negative_number{0, endless, false, true};

/// A machine being read: names of what has been read so far, and the Spec that grows.
struct MachineReading {
    MachineReading(const std::map<std::string, std::string, std::less<>>& given, MachineScope names)
        : files(given), scope(std::move(names)) {}

    const std::map<std::string, std::string, std::less<>>& files;
    std::map<std::string, std::string_view, std::less<>> chosen;  ///< contents of parameters that are files, by value
    MachineScope scope;
    double particles_scale = 1, stiffness_scale = 1;

    machine::Spec spec;
    std::vector<std::string> materials;                ///< all of them, those of walls too
    std::vector<dem::Elasticity> elasticities;         ///< of each
    std::vector<double> densities;                     ///< of each, 0: not given
    std::vector<std::size_t> of_particles;             ///< materials of particles, by Spec::densities
    std::vector<std::vector<dem::Material>> contacts;  ///< by material and material
    std::vector<std::string> species, phases;
    std::vector<std::string> walls;                 ///< as the file names them
    std::vector<std::vector<std::size_t>> repeats;  ///< of each the walls of the Spec
    std::vector<std::string> measures;              ///< those with a probe, as the Spec has them

    /// Contents of a file that a text names.
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

[[nodiscard]] geometry::Shape read_shape(const Section& wall, const MachineReading& reading);
/// The next motion of a wall, which has its shape and the motions before it. `present`: whether it acts in this case.
[[nodiscard]] machine::WallMotion read_motion(const Cursor& place, const MachineReading& reading,
                                              const machine::MachineWall& wall, bool& present);
/// Phases of "during"; empty: all.
[[nodiscard]] machine::Phases read_during(const Section& section, const MachineReading& reading);
/// A measurement of one value, by its name.
[[nodiscard]] std::size_t measure_named(const Cursor& place, const MachineReading& reading);
[[nodiscard]] std::string_view unit_of_measure(const MachineReading& reading, std::size_t measure);
/// "shares", "while" and "since" of a measurement, once all measurements have their numbers.
void read_counting(const Cursor& place, const MachineReading& reading, machine::Measure& into);
/// Names and observables of "measure", in the order of the names.
[[nodiscard]] std::vector<ObservableSpec> machine_observables(const Section& top);

/// Letters, digits and _, not a digit first, at most 64 of them. Refuses other names.
void require_name(const Cursor& place, std::string_view name);

}  // namespace grainsweep::campaign
