#include "sweep/study/sample_parts.hpp"

#include "stats/random.hpp"
#include "sweep/schedule/judge.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace grainsweep::study {
namespace {

constexpr std::size_t batches = 8;

/// Consecutive points that belong together.
std::int64_t block_of(const Responses& responses) {
    return static_cast<std::int64_t>(responses.design().block(responses.group_names.size()));
}

}  // namespace

SampleParts sample_parts(const Responses& responses) {
    const auto& design = responses.design();
    const auto sequences = schedule::independent_sequences(responses.campaign.design,
                                                           static_cast<std::size_t>(responses.campaign.sequences));
    const std::int64_t block = block_of(responses);
    const std::int64_t blocks = responses.settled_points / block + 1;
    SampleParts parts;
    parts.independent = sequences >= 4 || design.independent_points;
    if (sequences >= 4) {
        parts.what = fmt::format("the {} independent sequences", sequences);
    } else if (design.beginning == designs::Beginning::sample) {
        parts.what = fmt::format("{} batches of the design{}", batches,
                                 parts.independent ? "" : ", which makes them rough, rather too large");
    }
    parts.labels.resize(responses.settled);
    for (std::size_t row = 0; row < parts.labels.size(); ++row) {
        const std::int64_t point = responses.points[row];
        if (sequences >= 4) {
            parts.labels[row] = static_cast<std::size_t>(point) % sequences;
        } else if (design.beginning == designs::Beginning::listed) {
            parts.labels[row] =
                static_cast<std::size_t>(stats::bits_at(1, 0, static_cast<std::uint64_t>(point)) % batches);
        } else {
            parts.labels[row] = static_cast<std::size_t>(point / block) * batches / static_cast<std::size_t>(blocks);
        }
    }
    return parts;
}

}  // namespace grainsweep::study
