// One moment of a scene in the files of VTK: particles and walls as poly data, a flow as the grid it lives on.
//
// XML with appended raw binary, little endian, 32-bit floats, each block after its length in bytes (64 bits).
// https://docs.vtk.org, "VTK XML formats".
//   VTP  particles: one point each and one cell that shows them all; walls: lines and triangles
//   VTI  a flow on equal cells; VTR a flow on clustered ones, as they are: resampling would smear what clustering
//        resolves, and every filter of ParaView takes both
#pragma once

#include "solver/scenes/values.hpp"

#include <string>
#include <string_view>

namespace grainsweep::report {

/// Whether a scene has particles at all: a cell that ran empty has none any more, but has their columns.
[[nodiscard]] bool shows_particles(const Snapshot& snapshot);

/// The file's bytes. Columns of another length than the positions: std::invalid_argument.
[[nodiscard]] std::string vtp(const Snapshot& snapshot, double time);
[[nodiscard]] std::string vtp(const WallSurface& wall, double time);

/// ".vti" where the cells are equal along each axis (to 1e-9 of it), else ".vtr".
[[nodiscard]] std::string_view extension_of(const FlowField& field);
/// The bytes of such a file. Quantities of another length than the cells, axes that do not grow: std::invalid_argument.
[[nodiscard]] std::string vtk_grid(const FlowField& field, double time);

}  // namespace grainsweep::report
