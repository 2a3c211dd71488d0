// Conversion of a machine file to a Spec, section by section. Internal to the reader of machines.
#pragma once

#include "solver/machine/spec.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_scope.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::campaign {

inline constexpr double endless = std::numeric_limits<double>::infinity();

/// State of the reading of a machine: names read so far, and the incomplete Spec.
struct MachineReading {
    MachineReading(MachineScope names, std::span<const ObservableSpec> all)
        : scope(std::move(names)), observables(all) {}

    MachineScope scope;
    std::span<const ObservableSpec> observables;  ///< of the machine
    double particles_scale = 1, stiffness_scale = 1, aspect_ratio = 1;

    machine::Spec spec;
    std::vector<std::string> materials;                ///< all materials, including those of walls
    std::vector<dem::Elasticity> elasticities;         ///< of each
    std::vector<double> densities;                     ///< of each material; 0: not given
    std::vector<std::size_t> of_particles;             ///< materials of particles, in the order of Spec::densities
    std::vector<std::vector<dem::Material>> contacts;  ///< by material and material
    std::vector<std::string> species;
    std::vector<std::string> phases;                    ///< names in the file
    std::vector<machine::Phases> copies;                ///< phases of the Spec for each of them, in their order
    std::vector<std::string> phase_paths;               ///< in the file, of each phase of the Spec
    std::vector<std::string> named_particles;           ///< in the order of the fillings
    std::vector<std::string> walls;                     ///< names in the file
    std::vector<std::vector<std::size_t>> repeats;      ///< walls of the Spec for each of them
    std::vector<std::string> measures;                  ///< measures with a probe, in the order of the Spec
    std::vector<std::pair<std::string, double>> timed;  ///< motions that start at a time: path in the file, s

    /// Returns the contents of a file that a text names.
    [[nodiscard]] std::string_view contents(const Cursor& place) const { return scope.contents(place); }
    /// Returns the phases of the Spec that one name or a list of names means, ascending.
    [[nodiscard]] machine::Phases phases_in(const Cursor& place) const;
};

/// Refuses names other than letters, digits and _, not a digit first, at most 64 characters.
void require_name(const Cursor& place, std::string_view name);

inline constexpr std::size_t most_repeats = 1000;

/// Calls `read` with the number of a copy and the number of copies, for every copy that "repeat" makes. Within it the
/// counter "as" is known.
template <class Read>
void for_every_one(const Section& section, MachineReading& reading, Read read) {
    const auto repeat = section.find("repeat"), as = section.find("as");
    if (as && !repeat) as->refuse("without \"repeat\" it has no effect");
    const std::int64_t count = repeat ? reading.scope.whole(*repeat, {0, most_repeats}) : 1;
    const MachineScope outer = reading.scope;
    for (std::int64_t k = 0; k < count; ++k) {
        if (as) {
            const std::string counter = as->text();
            require_name(*as, counter);
            if (counter == "pi" || outer.knows(counter)) as->refuse("a parameter or \"let\" has this name");
            reading.scope.set(counter, static_cast<double>(k));
        }
        read(k, count);
        reading.scope = outer;
    }
}

void read_materials(const Section& top, MachineReading& reading);
void read_species(const Section& top, MachineReading& reading);
void read_contacts(const Section& top, MachineReading& reading);
void read_phase_names(const Section& top, MachineReading& reading);
void read_walls(const Section& top, MachineReading& reading);
void read_fills(const Section& top, MachineReading& reading);
void read_removals(const Section& top, MachineReading& reading);
void read_feeds(const Section& top, MachineReading& reading);
void read_phases(const Section& top, MachineReading& reading);
void read_measures(const Section& top, MachineReading& reading);
void read_surroundings(const Section& top, MachineReading& reading);
void read_checks(const Section& top, MachineReading& reading);

inline constexpr double longest_row = 20;  ///< aspect ratio

/// Reads the "shape" of a species with material and, unless its spheres have one, diameter.
void read_grain_shape(const Cursor& place, const MachineReading& reading, machine::Species& species);
/// Shapes resist rolling themselves. Refuses a rolling friction of species with a shape of their own; sets that of
/// species which the parameter aspect_ratio makes elongated to 0, with a warning.
void settle_rolling_of_shapes(const Section& top, MachineReading& reading);
[[nodiscard]] geometry::Shape read_shape(const Section& wall, const MachineReading& reading);
/// Reads a motion of a wall, which has its shape and earlier motions, and appends it: one for each run of successive
/// phases. A motion that does not act in this case, or moves nothing, is left out.
void read_motion(const Cursor& place, MachineReading& reading, machine::MachineWall& wall);
/// Refuses motions of one wall that contradict each other, and warns of those that start after all phases.
void check_motions(const Section& top, MachineReading& reading);
/// Reads the load of a press or a drive: `constant`, or its course in time.
[[nodiscard]] geometry::LoadCourse read_load(const Section& motion, std::string_view name, std::string_view unit,
                                             const MachineScope& scope, double& constant);
/// Reads a motion with "follow" as motions of constant velocity.
[[nodiscard]] std::vector<machine::WallMotion> read_follow(const Section& motion, MachineReading& reading);
/// Reads the phases of "during"; empty: all.
[[nodiscard]] machine::Phases read_during(const Section& section, const MachineReading& reading);
/// Returns the index of a measurement of one value, by its name.
[[nodiscard]] std::size_t measure_named(const Cursor& place, const MachineReading& reading);
/// Returns the value of "above" or "below", and whether it is "above".
[[nodiscard]] std::pair<double, bool> threshold_of(const Section& section, const MachineReading& reading,
                                                   std::string_view unit);
[[nodiscard]] std::string_view unit_of_measure(const MachineReading& reading, std::size_t measure);
/// Reads "scale" of a measurement or its time.
void read_scale(const Cursor& place, const MachineReading& reading, machine::Scale& into);
/// Reads what counts of a measurement and how it is shown, after all measurements have their numbers.
void read_counting(const Cursor& place, const MachineReading& reading, machine::Measure& into);
/// Returns the measurements that short tables show; none if they are not stated.
[[nodiscard]] std::vector<MainObservable> shown_observables(const Section& top);
/// Returns names and observables of "measure", in the order of the names.
[[nodiscard]] std::vector<ObservableSpec> machine_observables(const Section& top);

}  // namespace grainsweep::campaign
