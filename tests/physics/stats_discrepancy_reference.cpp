// Discrepancies of the project's own designs against those of independent programs: figures and designs at once.
#include "stats/random.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/discrepancy.hpp"
#include "tests/support/reference_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::tests::stats_discrepancy_reference_test {

/// The points of a reference design, where the catalogue makes it.
std::optional<std::vector<double>> points_of(const std::string& design, std::size_t d, std::int64_t n,
                                             std::int64_t first) {
    const Options start = {{"points", n}, {"first", first}};
    const auto halton = [&](const std::string& scramble) {
        Options options = start;
        options.emplace("scramble", scramble);
        return ask_design("halton", d, options).coordinates;
    };
    if (design == "halton") return halton("none");
    if (design == "bw1979") return halton("braaten_weller");
    if (design == "rhalton") return halton("random");
    if (design == "sobol" && first == 0)
        return ask_design("sobol", d, {{"points", n}, {"scramble", "none"}}).coordinates;
    if (design == "random_sm") {
        stats::Generator generator(1);
        std::vector<double> points(static_cast<std::size_t>(n) * d);
        for (auto& u : points) u = generator.uniform();
        return points;
    }
    if (design == "lattice_endpoints" || design == "lattice_centred") {
        const auto k = std::llround(std::pow(static_cast<double>(n), 1.0 / static_cast<double>(d)));
        return ask_design("lattice", d, {{"levels", std::int64_t{k}}, {"placement", design.substr(8)}}).coordinates;
    }
    return std::nullopt;
}

TEST(DiscrepancyReference, SquaredL2Measures) {
    const ReferenceTable table("designs/discrepancy.csv");
    int compared = 0;
    for (std::size_t r = 0; r < table.size(); ++r) {
        const std::size_t d = table.whole(r, "d");
        const std::size_t n = table.whole(r, "n");
        if (n > 1000) continue;  // quadratic in n
        const auto points = points_of(table.cell(r, "design"), d, static_cast<std::int64_t>(n),
                                      static_cast<std::int64_t>(table.whole(r, "first_index")));
        if (!points) continue;
        ASSERT_EQ(points->size(), n * d);
        const auto near = [&](double got, const std::string& column) {
            EXPECT_NEAR(got, table.number(r, column), 1e-6 * table.number(r, column))
                << column << " of " << table.cell(r, "design") << " d = " << d << " n = " << n;
        };
        near(squared_l2_star_discrepancy(*points, d), "l2star_sq");
        near(squared_centred_discrepancy(*points, d), "cd_sq");
        near(squared_wraparound_discrepancy(*points, d), "wd_sq");
        ++compared;
    }
    EXPECT_GT(compared, 50);
}

TEST(DiscrepancyReference, StarDiscrepancyOfEveryPair) {
    const ReferenceTable table("designs/star_pairs.csv");
    int compared = 0;
    for (std::size_t r = 0; r < table.size(); ++r) {
        const auto points = points_of(table.cell(r, "design"), 8, static_cast<std::int64_t>(table.whole(r, "n")),
                                      static_cast<std::int64_t>(table.whole(r, "first_index")));
        if (!points) continue;
        double mean = 0;
        for (std::size_t i = 0; i < 8; ++i)
            for (std::size_t j = i + 1; j < 8; ++j) mean += star_discrepancy_of_pair(*points, 8, i, j) / 28;
        EXPECT_NEAR(mean, table.number(r, "mean_over_28_pairs"), 1e-12) << table.cell(r, "design");
        EXPECT_NEAR(worst_pair_star_discrepancy(*points, 8), table.number(r, "worst_pair_value"), 1e-12)
            << table.cell(r, "design");
        ++compared;
    }
    EXPECT_EQ(compared, 10);  // five designs, 100 and 400 points: the figures the catalogue quotes
}

}  // namespace grainsweep::tests::stats_discrepancy_reference_test
