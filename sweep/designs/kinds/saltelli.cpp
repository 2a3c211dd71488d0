// Saltelli's radial design (Saltelli et al. 2010, Comput. Phys. Commun. 181, 259-270) for first-order and
// total sensitivity indices.
//
// Base row k is row k of a randomly scrambled Halton set of 2d columns, split into A_k | B_k. It becomes a
// block of d + 2 consecutive points:
//   A_k, B_k, AB_k1, ..., AB_kd,   AB_kj = A_k with column j from B_k
// The set counts d + 2 sequences, so that a point's sequence says its part: 0 A, 1 B, 1 + j AB_j.
// (These are parts of one estimate, not independent repetitions.)
// Factors in groups (Saltelli et al. 2008, Global Sensitivity Analysis: The Primer): a block of g + 2
// points for g groups, AB_kj with all columns of group j from B_k.
#include "sweep/designs/kinds.hpp"
#include "sweep/designs/radical_inverse.hpp"

namespace grainsweep::designs {
namespace {

std::size_t block_of(std::size_t groups) {
    return groups + 2;
}

std::int64_t saltelli_size(const DesignRequest& request) {
    return request.count("base_points") * static_cast<std::int64_t>(block_of(request.group_count()));
}

PointSet saltelli_points(const DesignRequest& request) {
    const std::int64_t base_rows = request.count("base_points");
    const std::size_t d = request.dimensions();
    const std::size_t block = block_of(request.group_count());
    PointSet set{
        .dimensions = d, .sequences = block, .coordinates = room_for(base_rows * static_cast<std::int64_t>(block), d)};
    const auto bases = primes(2 * d);
    for (std::size_t j = 0; j < d; ++j) {
        const auto a_column = RadicalInverse::random(bases[j], request.seed, 0, j);
        const auto b_column = RadicalInverse::random(bases[d + j], request.seed, 0, d + j);
        for (std::size_t k = 0; k < static_cast<std::size_t>(base_rows); ++k) {
            const double a = a_column(k);
            const double b = b_column(k);
            const auto at = [&](std::size_t part) -> double& { return set.coordinates[(k * block + part) * d + j]; };
            for (std::size_t part = 0; part < block; ++part) at(part) = a;
            at(1) = b;
            at(2 + request.group(j)) = b;
        }
    }
    return set;
}

}  // namespace

DesignInfo saltelli_design() {
    return {.name = "saltelli",
            .summary =
                "For total sensitivity indices (interactions included): base_points x (factors + 2) cases, groups "
                "counted as factors. First-order "
                "indices alone need no such design: any halton campaign gives them about ten times more accurately at "
                "equal cost.",
            .options = {{count_field("base_points", 1, 1e7, "", "number of base rows; each costs factors + 2 cases"),
                         true}},
            .extends = true,
            .purpose = Purpose::saltelli,
            .size = saltelli_size,
            .block = block_of,
            .sample = saltelli_points};
}

}  // namespace grainsweep::designs
