// What listing particles near walls made of pieces and finding their contacts share.
#pragma once

#include <cstddef>
#include <variant>

#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/fast/wall_lists.hpp"

namespace grainsweep::dem::fast {

inline std::size_t record_index(Place place) {
    return place / places_per_index;
}

/// A particle's centre in the frame of the wall's body, m.
inline Vec3 in_body(const MovingWall& wall, const Record& record, const Scale& scale) {
    return wall.pose().to_body(wall.image().of(position_of(record, scale)));
}

inline double radius_of(const Record& record, const Scale& scale) {
    return static_cast<double>(record.radius) * scale.length;
}

/// Calls visit(shape) if the wall's shape is made of pieces.
template <class Visit>
void if_pieced(const MovingWall& wall, Visit&& visit) {
    std::visit(
        [&]<class S>(const S& shape) {
            if constexpr (geometry::Pieced<S>) visit(shape);
        },
        wall.found());
}

}  // namespace grainsweep::dem::fast
