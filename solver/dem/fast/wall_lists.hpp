// Which particles are near which wall: a segment of the list for each, histories following their contacts.
#pragma once

#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/rebuild.hpp"
#include "solver/dem/fast/walls.hpp"

namespace grainsweep::dem::fast {

/// `keep`: histories follow their contacts, by columns.place; else they start at zero.
void list_wall_contacts(Field& field, Columns& columns, const Kernels& kernels, const ListSpace& space,
                        const Walls& walls, bool keep);

/// Position of a particle as forces see it, m.
[[nodiscard]] Vec3 position_of(const Record& record, const Scale& scale);

}  // namespace grainsweep::dem::fast
