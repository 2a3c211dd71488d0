// Bits of touching pairs and padding of a list of pairs.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "solver/dem/fast/layout.hpp"

namespace grainsweep::dem::fast {

inline std::int32_t index_at(Place place) {
    return static_cast<std::int32_t>(place / places_per_index);
}
inline Place place_at(std::int32_t index) {
    return static_cast<Place>(index * places_per_index);
}

inline bool bit_at(const std::uint16_t* bits, std::int32_t k, std::int32_t width) {
    return (static_cast<unsigned>(bits[k / width]) >> static_cast<unsigned>(k % width) & 1U) != 0;
}
inline void set_bit(std::uint16_t* bits, std::int32_t k, std::int32_t width) {
    bits[k / width] = static_cast<std::uint16_t>(bits[k / width] | 1U << static_cast<unsigned>(k % width));
}

/// Returns the number of pairs of a sorted list whose first particle comes before this one.
inline std::int32_t pairs_before(const Place* first, std::int32_t count, std::int32_t particle) {
    return static_cast<std::int32_t>(std::lower_bound(first, first + count, place_at(particle)) - first);
}

/// Returns the number of inner pairs without padding.
inline std::int32_t true_pairs(const Field& f) {
    std::int32_t k = f.inner_count;
    while (k > 0 && f.inner_first[k - 1] == place_at(f.filler)) --k;
    return k;
}

/// Returns Field::fetch_ahead for an inner list. For each group of adjacent pairs, the farthest partner has a distance
/// in places. The result is the median of these distances, enlarged because pairs are sifted before particles are
/// integrated. Pairs across periodic faces and copies of other subdomains' particles do not count. 0 if particles have
/// fewer than one pair each: prefetching then costs more than it saves.
inline std::int32_t distance_to_fetch(const Field& f) {
    constexpr std::int32_t group = 16, groups_at_most = 64;
    if (f.inner_count < f.end - f.begin) return 0;
    const std::int32_t stride = (f.inner_count / group / groups_at_most + 1) * group;
    std::array<std::int32_t, groups_at_most> distances{};
    std::int32_t count = 0;
    for (std::int32_t k = 0; k + group <= f.inner_count; k += stride) {
        std::int32_t farthest = 0;
        for (std::int32_t q = k; q < k + group; ++q)
            if (f.inner_second[q] < place_at(f.filler))
                farthest = std::max(farthest, index_at(f.inner_second[q]) - index_at(f.inner_first[q]));
        if (farthest > 0) distances[static_cast<std::size_t>(count++)] = farthest;
    }
    if (count == 0) return 0;
    const auto median = distances.begin() + count / 2;
    std::nth_element(distances.begin(), median, distances.begin() + count);
    return *median + *median / 8 + tile / 2;
}

/// Pads an inner list as the refresh kernel does. Returns the padded count.
inline std::int32_t fill_up(const Field& f, std::int32_t count, std::int32_t width) {
    const std::int32_t padded = (count + width - 1) / width * width;
    for (std::int32_t k = count; k < padded + 2 * tile; ++k) {
        f.inner_first[k] = place_at(f.filler);
        f.inner_second[k] = place_at(f.filler + 1);
        f.inner_reach[k] = 0;
        f.inner_source[k] = 0;
    }
    return padded;
}

}  // namespace grainsweep::dem::fast
