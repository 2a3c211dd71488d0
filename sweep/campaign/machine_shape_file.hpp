// Spheres that cover an STL file, for the command "shape"; shaped grains of a machine, for "plan".
#pragma once

#include "sweep/campaign/machine.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Cover of a closed surface. Lengths are in the unit of the file.
struct ShapeFile {
    std::string csv;           ///< x,y,z,diameter of the spheres, in the frame of the file
    std::size_t spheres = 0;   ///< number of them
    double overlap = 0;        ///< volume that body and spheres share, divided by the volume of either
    double volume = 0;         ///< of the body
    double diameter = 0;       ///< of the sphere of equal volume
    double smallest = 0;       ///< diameter of the smallest sphere divided by it: the time step follows it
    double cost = 0;           ///< spheres, times steps as many times as many: cost of a grain divided by a sphere's
    double inertia_error = 0;  ///< largest difference of a principal moment of the spheres from the body's, relative
};

/// Returns the cover by at most `spheres` of them (default 16), or until they share all but `error` of the volume.
/// Throws std::invalid_argument with one sentence for a file that is no closed surface.
[[nodiscard]] ShapeFile shape_of_stl(std::string_view contents, std::optional<std::int64_t> spheres,
                                     std::optional<double> error);

/// Shaped grains of a species.
struct Grain {
    std::string species;
    std::size_t spheres = 0;
    std::optional<double> cover;  ///< volume that an STL file and the spheres share, divided by the volume of either
    double smallest = 0;          ///< diameter of the smallest sphere divided by the grain's
    double cost = 0;              ///< as of ShapeFile
};
/// Returns the species with a shape in a case of a machine that is possible.
[[nodiscard]] std::vector<Grain> grains_of(const Machine& machine, const Inputs& inputs);

}  // namespace grainsweep::campaign
