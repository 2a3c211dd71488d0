// Files of VTK for one moment of a scene: particles and walls as poly data, a flow on its grid.
//
// XML with appended raw binary, little endian, 32-bit floats, each block after its length in bytes (64 bits).
// https://docs.vtk.org, "VTK XML formats".
//   VTP  particles: one point each and one cell for all of them; walls: lines and triangles; contacts: a line each
//   VTI  a flow on equal cells
//   VTR  a flow on clustered cells, without resampling, which would lose resolution; all filters of ParaView accept
//        both
#pragma once

#include "solver/scenes/values.hpp"

#include <string>
#include <string_view>

namespace grainsweep::report {

/// Returns whether a scene has particles; an empty cell still has their columns.
[[nodiscard]] bool shows_particles(const Snapshot& snapshot);

/// Returns the bytes of the file. Throws std::invalid_argument if a column has another length than the positions.
[[nodiscard]] std::string vtp(const Snapshot& snapshot, double time);
[[nodiscard]] std::string vtp(const WallSurface& wall, double time);
/// Returns a file of lines with a value of every column for each; the length of a column is checked likewise.
[[nodiscard]] std::string vtp(const ContactLines& contacts, double time);

/// Returns ".vti" if the cells are equal along each axis (to 1e-9 of it), else ".vtr".
[[nodiscard]] std::string_view extension_of(const FlowField& field);
/// Returns the bytes of such a file. Throws std::invalid_argument if a quantity has another length than the cells, or
/// an axis is not ascending.
[[nodiscard]] std::string vtk_grid(const FlowField& field, double time);

}  // namespace grainsweep::report
