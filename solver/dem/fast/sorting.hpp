// Counting sort of the particles by cell. A cell is not smaller than the largest distance of a listed pair.
#pragma once

#include <span>

#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/parts.hpp"
#include "solver/dem/fast/rebuild.hpp"

namespace grainsweep::dem::fast {

/// Marks in `place` the particles that stay (0) and those removed (-1: left through a face, or in `ids`). Returns the
/// number that stay.
std::int32_t take_out(const Field& field, Columns& columns, const ListSpace& space, std::span<const std::int32_t> ids,
                      const Parts& parts);

/// Sorts by cell, stable within a cell, and fills the columns that the search reads. Afterwards `place` maps old to new
/// indices.
void sort_particles(Field& field, Columns& columns, const ListSpace& space, std::int32_t kept, const Parts& parts);

}  // namespace grainsweep::dem::fast
