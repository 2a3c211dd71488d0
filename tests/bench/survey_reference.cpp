// Moments of a response at one set of numerical inputs against those at another, case by case at the same points: the
// bias of a cheaper set. Scatter of single runs, which the cheaper set has more of, is taken out of both.
//
//   grainsweep query --format csv DB "SELECT a.mfr, a.mfr_standard_error, b.mfr, b.mfr_standard_error FROM survey AS a
//       JOIN standard AS b USING (point) WHERE a.mfr IS NOT NULL AND b.mfr IS NOT NULL" > PAIRS.csv
//   bench_survey_reference PAIRS.csv
//
// y = m + e with e of variance v, the square of the standard error (nothing: 0), symmetric and independent of m:
//   E m = E y,  E m^2 = E y^2 - E v,  E m^3 = E y^3 - 3 E[y v],  E m^4 = E y^4 - 6 E[y^2 v] + 3 E v^2
// One JSON line per statistic: both values, the difference in per cent of the second and its 95 % half-width from the
// jackknife that leaves out one pair at a time.
#include "stats/confidence.hpp"
#include "stats/moment_statistics.hpp"
#include "tests/support/table_of_cases.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <vector>

using namespace grainsweep::stats;
using namespace grainsweep::tests;

namespace {

constexpr std::array names = {"mean", "sd", "g1", "kurtosis"};

/// Contributions of one case to the sums of E m ... E m^4.
RawMoments terms(double y, double error) {
    const double v = std::isfinite(error) ? error * error : 0;
    return {y, y * y - v, y * y * y - 3 * y * v, y * y * y * y - 6 * y * y * v + 3 * v * v};
}

struct Level {
    std::vector<RawMoments> cases;
    RawMoments sum{};
    void add(double y, double error) {
        cases.push_back(terms(y, error));
        for (std::size_t p = 0; p < 4; ++p) sum[p] += cases.back()[p];
    }
    /// Of all cases, or all but one.
    [[nodiscard]] std::array<double, 4> statistics(const RawMoments* without = nullptr) const {
        RawMoments raw = sum;
        const auto n = static_cast<double>(cases.size()) - (without == nullptr ? 0 : 1);
        for (std::size_t p = 0; p < 4; ++p) raw[p] = (raw[p] - (without == nullptr ? 0 : (*without)[p])) / n;
        const auto all = moment_statistics(raw);
        return {all[0].value, all[1].value, all[2].value, all[3].value};
    }
};

void compare(const TableOfCases& table) {
    if (table.columns.size() != 4) throw std::runtime_error("four columns are needed");
    Level a, b;
    for (std::size_t i = 0; i < table.columns[0].size(); ++i) {
        if (!std::isfinite(table.columns[0][i]) || !std::isfinite(table.columns[2][i])) continue;
        a.add(table.columns[0][i], table.columns[1][i]);
        b.add(table.columns[2][i], table.columns[3][i]);
    }
    const auto of_a = a.statistics(), of_b = b.statistics();
    for (std::size_t k = 0; k < names.size(); ++k) {
        std::vector<double> differences;
        for (std::size_t i = 0; i < a.cases.size(); ++i)
            differences.push_back(a.statistics(&a.cases[i])[k] - b.statistics(&b.cases[i])[k]);
        const double unit = 100 / std::abs(of_b[k]);
        std::printf(
            "{\"statistic\": \"%s\", \"pairs\": %zu, \"first\": %.5f, \"second\": %.5f, \"difference_percent\": %.2f, "
            "\"half_width_percent\": %.2f}\n",
            names[k], a.cases.size(), of_a[k], of_b[k], unit * (of_a[k] - of_b[k]),
            unit * jackknife_half_width(differences));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::printf("{\"skipped\": \"bench_survey_reference PAIRS.csv: no pairs were given\"}\n");
        return 0;
    }
    try {
        compare(read_cases(argv[1]));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
