// Plain and model-assisted moments of part of a stored campaign against those of all of it: how large their errors are.
//
//   grainsweep query --format csv DB "SELECT sequence, friction, diameter, gap, speed, mfr, mfr_standard_error
//       FROM wu2020_lds WHERE mfr IS NOT NULL ORDER BY point" > FILE.csv
//   bench_assisted_reference FILE.csv 0.1:0.3,0.001:0.003,0.001:0.005,1:1.5 [CASES [DESIGNS]]
//
// The first column is the sequence, the last but one the response, the last its standard error (nothing: no scatter),
// the others factors, whose ranges come second: points fill them evenly. A part is one stretch of each sequence, of
// random place: a scrambled Halton sequence may be begun anywhere. One JSON line for each statistic and estimator: the
// 95 % quantile of the errors and the mean half-width in per cent of the whole's value, and how many half-widths reach
// it. The whole is what its own assisted estimate says; a part of its cases differs from it with the variance of the
// part less that of the whole, so that the half-width counts as sqrt(h^2 - h_whole^2).
#include "stats/assisted_moments.hpp"
#include "tests/support/known_responses.hpp"
#include "tests/support/table_of_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

using namespace grainsweep::stats;
using namespace grainsweep::tests;

namespace {

struct Stored {
    std::vector<double> features, values, noise;
    std::vector<std::size_t> sequences;
    std::size_t dimensions = 0;
};

Stored read(const std::string& path, const std::vector<FactorScale>& box) {
    const auto table = read_cases(path);
    if (table.columns.size() != box.size() + 3) throw std::runtime_error("not one range for each factor");
    Stored s{features_of(table, 1, box), table.columns[box.size() + 1], table.columns.back(), {}, box.size()};
    for (double& e : s.noise) e = std::isfinite(e) ? e * e : 0;
    for (const double sequence : table.columns.front()) s.sequences.push_back(static_cast<std::size_t>(sequence));
    return s;
}

/// Even over the factors, not over their features.
std::vector<double> integration_over(const std::vector<FactorScale>& box) {
    std::vector<double> points = integration_points(box.size(), 12);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const FactorScale& factor = box[i % box.size()];
        points[i] = factor.feature(factor.at(points[i]));
    }
    return points;
}

/// One stretch of `each` rows of every sequence.
Stored part_of(const Stored& all, std::size_t each, const Stream& stream) {
    const std::size_t sequences = *std::max_element(all.sequences.begin(), all.sequences.end()) + 1;
    std::vector<std::vector<std::size_t>> rows(sequences), chosen(sequences);
    for (std::size_t i = 0; i < all.sequences.size(); ++i) rows[all.sequences[i]].push_back(i);
    Stored part;
    part.dimensions = all.dimensions;
    for (std::size_t s = 0; s < sequences; ++s) {
        if (rows[s].size() < each) throw std::runtime_error("a sequence has fewer cases than a part takes of it");
        const auto places = static_cast<double>(rows[s].size() - each + 1);
        const auto first = static_cast<std::size_t>(stream.uniform(s) * places);
        chosen[s].assign(rows[s].begin() + static_cast<std::ptrdiff_t>(first),
                         rows[s].begin() + static_cast<std::ptrdiff_t>(first + each));
    }
    for (std::size_t k = 0; k < each; ++k)  // in the order of a design's points
        for (std::size_t s = 0; s < sequences; ++s) {
            const std::size_t i = chosen[s][k];
            const auto* row = all.features.data() + i * all.dimensions;
            part.features.insert(part.features.end(), row, row + all.dimensions);
            part.values.push_back(all.values[i]);
            part.noise.push_back(all.noise[i]);
            part.sequences.push_back(s);
        }
    return part;
}

AssistedMoments moments(const Stored& s, const std::vector<double>& integration) {
    const auto answer = assisted_moments(
        {{s.features, s.dimensions}, s.values, s.sequences, {integration, s.dimensions}, 8, s.noise, 0});
    if (const auto* refusal = std::get_if<Refusal>(&answer)) throw std::runtime_error(refusal->sentence);
    return std::get<AssistedMoments>(answer);
}

struct Tally {
    std::vector<double> misses;
    double widths = 0;
    int covered = 0;
    void add(const AssistedEstimate& e, const AssistedEstimate& whole) {
        const double miss = std::abs(e.value - whole.value);
        misses.push_back(100 * miss / std::abs(whole.value));
        widths += 100 * e.half_width / std::abs(whole.value);
        covered += std::hypot(miss, whole.half_width) <= e.half_width ? 1 : 0;
    }
    void show(const char* estimator, std::size_t statistic, const AssistedEstimate& truth, std::size_t cases) {
        std::sort(misses.begin(), misses.end());
        const auto n = static_cast<double>(misses.size());
        const double actual = misses[std::min(misses.size() - 1, static_cast<std::size_t>(0.95 * n))];
        std::printf(
            "{\"estimator\": \"%s\", \"statistic\": \"%s\", \"cases\": %zu, \"designs\": %zu, \"actual_95_percent\": "
            "%.3f, "
            "\"half_width_percent\": %.3f, \"covered\": %d, \"whole\": %.5f, \"whole_half_width\": %.5f}\n",
            estimator, std::string(to_string(assisted_statistics[statistic])).c_str(), cases, misses.size(), actual,
            widths / n, covered, truth.value, truth.half_width);
    }
};

void compare(const Stored& all, const std::vector<double>& integration, std::size_t cases, std::uint64_t designs) {
    const AssistedMoments whole = moments(all, integration);
    std::array<std::array<Tally, 4>, 4> tallies;
    double error = 0;
    for (std::uint64_t seed = 1; seed <= designs; ++seed) {
        const auto a = moments(part_of(all, cases / 8, Stream(seed, 21)), integration);
        error += a.model_error / static_cast<double>(designs);
        for (std::size_t k = 0; k < 4; ++k) {
            const auto& s = a.statistics[k];
            tallies[0][k].add(s.plain, whole.statistics[k].assisted);
            tallies[1][k].add(s.assisted, whole.statistics[k].assisted);
            tallies[2][k].add(s.chosen(), whole.statistics[k].assisted);
            tallies[3][k].add(s.without_scatter, whole.statistics[k].without_scatter);
        }
    }
    if (!whole.remark.empty()) throw std::runtime_error(whole.remark);
    std::printf("{\"whole_cases\": %zu, \"whole_model_error\": %.4f, \"model_error\": %.4f}\n", whole.cases,
                whole.model_error, error);
    const char* const names[] = {"plain", "assisted", "chosen", "without_scatter"};
    for (std::size_t e = 0; e < 4; ++e)
        for (std::size_t k = 0; k < 4; ++k)
            tallies[e][k].show(names[e], k, e == 3 ? whole.statistics[k].without_scatter : whole.statistics[k].assisted,
                               cases);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::printf(
            "{\"skipped\": \"bench_assisted_reference FILE.csv LOW:HIGH,... [CASES [DESIGNS]]: no stored campaign was "
            "given\"}\n");
        return 0;
    }
    try {
        const auto box = read_box(argv[2]);
        compare(read(argv[1], box), integration_over(box),
                argc > 3 ? static_cast<std::size_t>(std::atoi(argv[3])) : 400,
                argc > 4 ? static_cast<std::uint64_t>(std::atoi(argv[4])) : 100);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
