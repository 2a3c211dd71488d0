// Laws whose constants differ from lane to lane. The files of the instruction paths include this file after their
// lanes; it has internal linkage on purpose.
#pragma once

#include <cstring>
#include <type_traits>

#include "solver/dem/fast/contact.hpp"

namespace grainsweep::dem::fast {
namespace {

/// Table of laws, one row each. A law consists of constants in lanes.
template <class Laws>
class LawTable {
    static_assert(std::is_trivially_copyable_v<Laws> && sizeof(Laws) % sizeof(F) == 0);
    static constexpr std::size_t count = sizeof(Laws) / sizeof(F);
    static constexpr std::size_t rows_at_most = materials_at_most * materials_at_most;

public:
    /// Takes `rows` of constants_at_most constants each.
    GRAINSWEEP_LANES LawTable(const double* constants, std::int32_t rows) : first_(constants), fits_(rows <= width) {
        for (std::int32_t r = 0; r < rows; ++r) {
            const Laws laws(constants + r * constants_at_most);
            F of_row[count];
            std::memcpy(static_cast<void*>(of_row), &laws, sizeof(Laws));
            for (std::size_t k = 0; k < count; ++k) {
                float lane[width];
                store(lane, of_row[k]);
                number_[k][r] = lane[0];
            }
        }
    }
    /// Returns the laws of these rows.
    GRAINSWEEP_LANES Laws at(I row) const {
        F of_lanes[count];
        if (fits_)
            for (std::size_t k = 0; k < count; ++k) of_lanes[k] = looked_up(load(number_[k]), row);
        else
            for (std::size_t k = 0; k < count; ++k) of_lanes[k] = gathered(number_[k], row);
        Laws laws = first_;
        std::memcpy(static_cast<void*>(&laws), of_lanes, sizeof(Laws));
        return laws;
    }

private:
    Laws first_;
    bool fits_;  // there are not more rows than lanes
    float number_[count][rows_at_most] = {};
};

}  // namespace
}  // namespace grainsweep::dem::fast
