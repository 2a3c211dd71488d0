// Sobol points in Gray-code order with the direction numbers of Joe & Kuo (2008), SIAM J. Sci. Comput. 30,
// 2635-2654, as Boost.Random carries them. The point of index 0 (all zero before scrambling) is kept: the
// balance of the first 2^k points depends on it (Owen 2020, arXiv:2008.08051).
//
// random: Owen's (1995) nested uniform scrambling, addressed by (seed, sequence, factor), so points extend and
// sequences are independent.
#include "stats/sobol_sequence.hpp"
#include "sweep/designs/kinds.hpp"

#include <array>
#include <stdexcept>

namespace grainsweep::designs {
namespace {

PointSet sobol_points(const DesignRequest& request) {
    const auto sequences = static_cast<std::size_t>(request.count("sequences"));
    const bool random = request.word("scramble") == "random";
    if (sequences > 1 && !random)
        throw std::invalid_argument(
            "several sequences need \"scramble\": \"random\": unscrambled ones are all the same");
    const std::size_t d = request.dimensions();
    const std::size_t most = stats::SobolSequence::most_dimensions();
    if (d > most)
        throw std::invalid_argument("there are direction numbers for " + std::to_string(most) + " factors, not " +
                                    std::to_string(d));
    PointSet set{.dimensions = d, .sequences = sequences, .coordinates = room_for(request.count("points"), d)};
    if (d == 0) return set;
    std::vector<std::uint64_t> keys(sequences * d);
    for (std::size_t s = 0; s < sequences; ++s)
        for (std::size_t j = 0; j < d; ++j) keys[s * d + j] = draw_key(request.seed, DrawPurpose::sobol, s, j);

    stats::SobolSequence engine(d);  // starts behind the point of index 0
    std::vector<std::uint64_t> fractions(d, 0);
    for (std::size_t p = 0; p < set.size(); ++p) {
        const std::size_t sequence = p % sequences;
        if (p >= sequences && sequence == 0)
            for (auto& fraction : fractions) fraction = engine.next() >> (64U - stats::scrambled_digits);
        for (std::size_t j = 0; j < d; ++j) {
            const std::uint64_t x = random ? stats::owen_scrambled(fractions[j], keys[sequence * d + j]) : fractions[j];
            set.coordinates[p * d + j] = static_cast<double>(x) * 0x1.0p-53;
        }
    }
    return set;
}

}  // namespace

DesignInfo sobol_design() {
    static constexpr auto scrambles = std::to_array<std::string_view>({"none", "random"});
    return {.name = "sobol",
            .summary =
                "The most even coverage where the number of points per sequence is a power of two; in between, random "
                "halton is as good. Worst two-dimensional projection of 8 factors at 100 points (star discrepancy, "
                "smaller is more even): 0.064 (random halton 0.079).",
            .other_names = {"lptau"},
            .options = {points_option("number of points, all sequences together; best a power of two per sequence"),
                        {{"scramble", Field::Kind::word,
                          "none: begins in the corner where every factor is at its low end; random: Owen's nested "
                          "uniform scrambling from the campaign's seed",
                          R"("random")", any_number, scrambles}},
                        {count_field("sequences", 1, 1e4, "1",
                                     "independently scrambled sequences that advance together ('random' only)")}},
            .extends = true,
            .independent_sequences = true,
            .size = points_asked,
            .sample = sobol_points};
}

}  // namespace grainsweep::designs
