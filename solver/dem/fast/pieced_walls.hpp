// Shared functions for walls made of pieces: listing nearby particles, and finding contacts.
#pragma once

#include <cmath>
#include <cstddef>
#include <variant>

#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/fast/wall_lists.hpp"

namespace grainsweep::dem::fast {

inline std::size_t record_index(Place place) {
    return place / places_per_index;
}

/// Returns a particle's centre in the frame of the wall's body, m.
inline Vec3 in_body(const MovingWall& wall, const Record& record, const Scale& scale) {
    return wall.pose().to_body(wall.image().of(position_of(record, scale)));
}

/// Calls visit(centre as of in_body) for the nearest image of the wall, and for images that can become the nearest
/// after a displacement of less than `way`, m. Those are needed because other pieces are near on the other side of the
/// plane halfway between two images.
template <class Visit>
void each_image(const MovingWall& wall, const Record& record, const Scale& scale, double way, Visit&& visit) {
    const NearestImage& image = wall.image();
    const Vec3 nearest = image.of(position_of(record, scale));
    Vec3 next{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double off = nearest[k] - image.middle[k];
        if (image.period[k] > 0 && std::abs(off) + way > image.period[k] / 2)
            next[k] = off > 0 ? -image.period[k] : image.period[k];
    }
    for (unsigned chosen = 0; chosen < 8; ++chosen) {
        Vec3 x = nearest;
        bool there = true;
        for (std::size_t k = 0; k < 3; ++k)
            if ((chosen >> k & 1U) != 0) {
                there = there && next[k] != 0;
                x[k] += next[k];
            }
        if (there) visit(wall.pose().to_body(x));
    }
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
