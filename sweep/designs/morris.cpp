// Morris' screening (Morris 1991, Technometrics 33, 161-174): trajectories of d + 1 points on a grid of L
// levels per factor, i/(L-1); each step moves one factor, in random order, by Delta = L/(2(L-1)).
//
// Trajectory t is points t (d+1) ... t (d+1) + d. The set counts d + 1 sequences: a point's sequence is its
// place in its trajectory. L is even, so that every level is as likely as every other.
#include "stats/random.hpp"
#include "sweep/designs/kinds.hpp"

#include <stdexcept>

namespace grainsweep::designs {
namespace {

std::size_t block_of(std::size_t factors) {
    return factors + 1;
}

std::int64_t size(const DesignRequest& request) {
    return request.count("trajectories") * static_cast<std::int64_t>(block_of(request.dimensions()));
}

PointSet morris_points(const DesignRequest& request) {
    const std::int64_t trajectories = request.count("trajectories");
    const std::int64_t grid = request.count("grid");
    if (grid % 2 != 0)
        throw std::invalid_argument("a Morris grid has an even number of levels, not " + std::to_string(grid));
    const std::size_t d = request.dimensions();
    const std::size_t length = block_of(d);
    PointSet set{.dimensions = d,
                 .sequences = length,
                 .coordinates = room_for(trajectories * static_cast<std::int64_t>(length), d),
                 .rows = {}};
    const auto coordinate = [&](std::uint64_t level) {
        return static_cast<double>(level) / static_cast<double>(grid - 1);
    };
    const auto half = static_cast<std::uint64_t>(grid) / 2;
    std::vector<std::uint64_t> level(d);
    for (std::size_t t = 0; t < static_cast<std::size_t>(trajectories); ++t) {
        stats::Generator generator(draw_key(request.seed, DrawPurpose::morris, t, 0));
        for (auto& l : level) l = generator.below(static_cast<std::uint64_t>(grid));
        const stats::Generator shuffler(draw_key(request.seed, DrawPurpose::morris, t, 1));
        const auto order = stats::permutation(static_cast<std::uint32_t>(d), shuffler);
        for (std::size_t step = 0; step < length; ++step) {
            if (step > 0) {
                auto& moved = level[order[step - 1]];
                moved = moved < half ? moved + half : moved - half;
            }
            for (std::size_t j = 0; j < d; ++j) set.coordinates[(t * length + step) * d + j] = coordinate(level[j]);
        }
    }
    return set;
}

}  // namespace

DesignInfo morris_design() {
    return {
        .name = "morris",
        .summary =
            "Screening of many factors with few cases: trajectories x (factors + 1) cases tell which factors matter "
            "(mu*) and which act non-linearly or jointly (sigma). For shares of the variance use halton or saltelli.",
        .options = {{.name = "trajectories",
                     .meaning = "number of trajectories, 10 to 50 as a rule; each costs factors + 1 cases",
                     .kind = OptionSpec::Kind::count,
                     .default_value = std::nullopt,
                     .minimum = 1,
                     .maximum = 1'000'000,
                     .words = {},
                     .extent = true},
                    {.name = "grid",
                     .meaning = "levels per factor, even",
                     .kind = OptionSpec::Kind::count,
                     .default_value = std::int64_t{4},
                     .minimum = 2,
                     .maximum = 1'000,
                     .words = {}}},
        .extends = true,
        .independent_sequences = false,
        .purpose = Purpose::morris,
        .size = size,
        .block = block_of,
        .sample = morris_points};
}

}  // namespace grainsweep::designs
