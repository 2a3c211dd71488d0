// Designs against points of independent programs, bit for bit: every reference value is the nearest double of
// an exact rational, so there is nothing to tolerate.
#include "stats/random.hpp"
#include "sweep/designs/radical_inverse.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/reference_table.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace grainsweep::tests::designs_reference_test {

/// Compares a design that starts at `first` with a table "index,x1,...,xd". Returns the numbers compared.
std::size_t expect_same_bits(const ReferenceTable& table, const std::string& kind, const Options& options) {
    const std::size_t d = table.columns() - 1;
    const auto set = ask_design(kind, d, options);
    std::size_t compared = 0;
    for (std::size_t p = 0; p < table.size(); ++p)
        for (std::size_t j = 0; j < d; ++j, ++compared)
            EXPECT_EQ(set.point(p)[j], table.number(p, j + 1)) << kind << " point " << p << " factor " << j + 1;
    return compared;
}

TEST(DesignsReference, PlainHalton) {
    const ReferenceTable table("designs/halton_plain.csv");
    EXPECT_EQ(expect_same_bits(table, "halton", {{"points", 100}, {"first", 0}, {"scramble", "none"}}), 800U);
}

TEST(DesignsReference, BraatenWellerHalton) {
    const ReferenceTable original("designs/halton_bw1979.csv");
    EXPECT_EQ(expect_same_bits(original, "halton", {{"points", 100}, {"first", 0}, {"scramble", "braaten_weller"}}),
              1600U);
    const ReferenceTable vc2006("designs/halton_bw_vc2006.csv");
    EXPECT_EQ(
        expect_same_bits(vc2006, "halton", {{"points", 100}, {"first", 0}, {"scramble", "braaten_weller_vc2006"}}),
        1600U);
}

TEST(DesignsReference, BraatenWellerTables) {
    const ReferenceTable table("designs/permutations.csv");
    // The digit permuted is the coordinate of index d times the base: read back through the design itself.
    const auto original = ask_design("halton", 25, {{"points", 97}, {"first", 0}, {"scramble", "braaten_weller"}});
    const auto vc2006 = ask_design("halton", 16, {{"points", 97}, {"first", 0}, {"scramble", "braaten_weller_vc2006"}});
    for (std::size_t r = 0; r < table.size(); ++r) {
        const std::size_t factor = table.whole(r, "dim") - 1;
        const std::size_t digit = table.whole(r, "digit");
        const double base = table.number(r, "base");
        EXPECT_EQ(original.point(digit)[factor], table.number(r, "bw1979") / base);
        if (factor < 16) {
            EXPECT_EQ(vc2006.point(digit)[factor], table.number(r, "bw_vc2006") / base);
        }
    }
}

TEST(DesignsReference, LargeIndices) {
    const ReferenceTable table("designs/halton_large_index.csv");
    ASSERT_EQ(table.size(), 30U);
    for (std::size_t r = 0; r < table.size(); ++r) {
        const std::string scramble = table.cell(r, "kind") == "plain" ? "none" : "braaten_weller";
        const auto index = static_cast<std::int64_t>(table.whole(r, "index"));
        const auto set = ask_design("halton", 8, {{"points", 1}, {"first", index}, {"scramble", scramble}});
        for (std::size_t j = 0; j < 8; ++j)
            EXPECT_EQ(set.point(0)[j], table.number(r, j + 2)) << scramble << " index " << index << " factor " << j + 1;
    }
}

TEST(DesignsReference, RandomHalton) {
    const ReferenceTable table("designs/rhalton_proposed.csv");
    for (std::size_t r = 0; r < table.size(); ++r) {
        const std::uint64_t seed = table.whole(r, "seed");
        const std::size_t sequence = table.whole(r, "replicate");
        const auto index = static_cast<std::int64_t>(table.whole(r, "index"));
        const auto sequences = static_cast<std::int64_t>(sequence + 1);
        const auto set =
            ask_design("halton", 8, {{"points", sequences}, {"first", index}, {"sequences", sequences}}, seed);
        for (std::size_t j = 0; j < 8; ++j)
            EXPECT_EQ(set.point(sequence)[j], table.number(r, j + 3))
                << "seed " << seed << " sequence " << sequence << " index " << index << " factor " << j + 1;
    }
}

TEST(DesignsReference, RandomHaltonInternals) {
    const ReferenceTable table("designs/rhalton_proposed_internals.csv");
    for (std::size_t r = 0; r < table.size(); ++r) {
        const std::string& what = table.cell(r, "what");
        const std::string& key = table.cell(r, "key");
        if (what == "splitmix64") {
            stats::Generator generator(table.whole(r, "key"));
            for (std::uint64_t k = 0; k < table.whole(r, "k"); ++k) (void)generator.next();
            EXPECT_EQ(generator.next(), table.whole(r, "value"));
        } else if (what == "mix_key") {
            std::uint64_t seed = 0, sequence = 0, factor = 0, level = 0;
            char bar = 0;
            std::istringstream(key) >> seed >> bar >> sequence >> bar >> factor >> bar >> level;
            EXPECT_EQ(designs::scrambling_key(seed, sequence, factor, level), table.whole(r, "value"));
        } else if (what == "rperm_seed1_rep0") {
            unsigned factor = 0, level = 0, base = 0;
            ASSERT_EQ(std::sscanf(key.c_str(), "dim%u|level%u|base%u", &factor, &level, &base), 3);
            std::ostringstream digits;
            for (const auto digit :
                 stats::permutation(base, stats::Generator(designs::scrambling_key(1, 0, factor, level))))
                digits << (digits.tellp() > 0 ? " " : "") << digit;
            EXPECT_EQ(digits.str(), table.cell(r, "value"));
        } else {
            ASSERT_EQ(what, "levels");
            const auto inverse = designs::RadicalInverse::plain(static_cast<std::uint32_t>(table.whole(r, "key")));
            EXPECT_EQ(inverse.levels(), table.whole(r, "k"));
            EXPECT_EQ(inverse.denominator(), table.whole(r, "value"));
        }
    }
}

TEST(DesignsReference, Sobol) {
    const ReferenceTable table("designs/sobol_joekuo_64x8.csv");
    EXPECT_EQ(expect_same_bits(table, "sobol", {{"points", 64}, {"scramble", "none"}}), 512U);
}

}  // namespace grainsweep::tests::designs_reference_test
