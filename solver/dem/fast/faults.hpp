// Why a state is not trusted any more, in one sentence: what, where and when. Called once, when it happened.
#pragma once

#include <string>

#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/scale.hpp"

namespace grainsweep::dem::fast {

/// What a description needs to see.
struct Sight {
    const Field& field;
    const std::int32_t* id;
    const Scale& scale;
    float smallest_diameter;
    std::int64_t steps;
};

[[nodiscard]] std::string describe_fast_particle(const Sight& sight);
[[nodiscard]] std::string describe_overlap(const Sight& sight, const Tally& tally);

}  // namespace grainsweep::dem::fast
