// Coverage of the 95 % intervals of sensitivity indices over campaigns of known responses: of the response model, of
// bins, and of the split of the variance; minutes: slow_indices. GRAINSWEEP_CAMPAIGNS sets another number of campaigns.
// With GRAINSWEEP_WRITE_DOCUMENTS the table of docs/coverage.md is written to tests/reference/measured/indices.csv.
#include "stats/model_indices.hpp"
#include "stats/random.hpp"
#include "stats/sensitivity.hpp"
#include "stats/variance_split.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/known_indices.hpp"
#include "tests/support/known_responses.hpp"
#include "tests/support/measured.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <variant>
#include <vector>

using namespace grainsweep::stats;
using namespace grainsweep::tests;

namespace {

constexpr double rounding = 1e-12;

using Range = std::pair<double, double>;

std::uint64_t campaigns() {
    const char* text = std::getenv("GRAINSWEEP_CAMPAIGNS");
    return text == nullptr ? 200 : std::strtoull(text, nullptr, 10);
}

/// Of one index over the campaigns.
struct Tally {
    int covered = 0, asked = 0;
    double truth = 0, miss = 0, width = 0;
};

class Tallies {
public:
    void add(const std::string& name, const SensitivityIndex& index, double truth) {
        Tally& t = tallies_[name];
        if (std::isnan(index.value)) return;
        ++t.asked;
        t.truth = truth;
        t.covered += std::abs(index.value - truth) <= index.half_width + rounding ? 1 : 0;
        t.miss += index.value - truth;
        t.width += index.half_width;
    }
    /// One line of JSON each; every coverage is 0.9 or more, less two standard errors of a share of 0.9.
    void print(const std::string& response, std::int64_t cases, const std::string& estimator) const {
        for (const auto& [name, t] : tallies_) {
            if (t.asked == 0) continue;
            std::printf(
                "{\"response\": \"%s\", \"cases\": %lld, \"estimator\": \"%s\", \"index\": \"%s\", \"campaigns\": %d, "
                "\"covered\": %.3f, \"truth\": %.4f, \"mean_error\": %.5f, \"half_width\": %.5f}\n",
                response.c_str(), static_cast<long long>(cases), estimator.c_str(), name.c_str(), t.asked,
                static_cast<double>(t.covered) / t.asked, t.truth, t.miss / t.asked, t.width / t.asked);
            EXPECT_GE(static_cast<double>(t.covered) / t.asked, 0.9 - 2 * std::sqrt(0.09 / t.asked))
                << response << ' ' << estimator << ' ' << name;
        }
        std::fflush(stdout);
    }
    /// Lowest and highest share of intervals that hold.
    void widen(Range& range) const {
        for (const auto& [name, t] : tallies_) {
            if (t.asked == 0) continue;
            const double share = static_cast<double>(t.covered) / t.asked;
            range = {std::min(range.first, share), std::max(range.second, share)};
        }
    }

private:
    std::map<std::string, Tally> tallies_;
};

void remember(const KnownIndices& known, const std::string& estimator, Range range) {
    const auto [low, high] = range;
    remember_measured(
        "indices", {"response", "estimator", "share of intervals that hold"},
        {{known.name, estimator, low < high ? fmt::format("{:.2g} to {:.2g}", low, high) : fmt::format("{:.2g}", low)}},
        2);
}

struct Campaign {
    std::vector<double> points, values;
    std::vector<std::size_t> groups;
};

/// Halton points in so many random sequences; parts as in sweep/study/sample_parts.hpp.
Campaign ask(const KnownIndices& known, std::int64_t n, std::int64_t sequences, std::uint64_t seed) {
    const auto set = ask_design("halton", known.dimensions, {{"points", n}, {"sequences", sequences}}, seed);
    Campaign campaign{set.coordinates, {}, {}};
    const Stream stream(seed, 78);
    for (std::size_t i = 0; i < set.size(); ++i) {
        campaign.values.push_back(known.mean(set.point(i)) + known.noise * normal_at(stream, i));
        campaign.groups.push_back(sequences >= 4 ? i % static_cast<std::size_t>(sequences) : i * 8 / set.size());
    }
    return campaign;
}

void count_models(const KnownIndices& known, std::int64_t n, Range& range) {
    Tallies tallies;
    for (std::uint64_t seed = 1; seed <= campaigns(); ++seed) {
        const auto campaign = ask(known, n, 8, seed);
        const auto fit = fit_response({campaign.points, known.dimensions}, campaign.values);
        if (!std::holds_alternative<ResponseModel>(fit)) continue;
        const auto found = model_indices(std::get<ResponseModel>(fit), known.dimensions, campaign.groups);
        std::size_t pair = 0;
        for (std::size_t j = 0; j < known.dimensions; ++j) {
            const std::string x = "x" + std::to_string(j + 1);
            tallies.add("first " + x, found.first[j], known.first[j]);
            tallies.add("total " + x, found.total[j], known.total[j]);
            tallies.add("interactions " + x, found.interactions[j], known.total[j] - known.first[j]);
            for (std::size_t k = j + 1; k < known.dimensions; ++k, ++pair)
                tallies.add("pair " + x + " x" + std::to_string(k + 1), found.pairs[pair], known.pairs[pair]);
        }
    }
    tallies.widen(range);
    tallies.print(known.name, n, "model");
}

void count_bins(const KnownIndices& known, std::int64_t n, std::int64_t sequences, Range& range) {
    Tallies tallies;
    for (std::uint64_t seed = 1; seed <= campaigns(); ++seed) {
        const auto campaign = ask(known, n, sequences, seed);
        const auto found =
            first_order_indices(campaign.points, known.dimensions, campaign.values, campaign.groups, n < 256 ? 8 : 16);
        for (std::size_t j = 0; j < known.dimensions; ++j)
            tallies.add("first x" + std::to_string(j + 1), found.first[j], known.share * known.first[j]);
    }
    tallies.widen(range);
    tallies.print(known.name, n, sequences > 1 ? "bins, 8 sequences" : "bins, 1 sequence");
}

void count_splits(const KnownIndices& known, std::int64_t n, std::int64_t sequences, Range& range) {
    Tallies tallies;
    const double main = std::accumulate(known.first.begin(), known.first.end(), 0.0) * known.share;
    for (std::uint64_t seed = 1; seed <= campaigns(); ++seed) {
        const auto campaign = ask(known, n, sequences, seed);
        std::vector<std::int64_t> points(campaign.values.size());
        std::iota(points.begin(), points.end(), 0);
        std::vector<std::vector<double>> columns(known.dimensions);
        std::vector<SplitFactor> factors;
        for (std::size_t j = 0; j < known.dimensions; ++j) {
            for (std::size_t i = 0; i < points.size(); ++i)
                columns[j].push_back(campaign.points[i * known.dimensions + j]);
            factors.push_back({columns[j], std::clamp<std::size_t>(points.size() / (5 * known.dimensions), 2, 15)});
        }
        const auto found = split_variance(points, factors, campaign.values, campaign.groups, false);
        tallies.add("main effects", found.main_effects, main);
        tallies.add("unexplained", found.unexplained, 1 - main);
    }
    tallies.widen(range);
    tallies.print(known.name, n, sequences > 1 ? "split, 8 sequences" : "split, 1 sequence");
}

}  // namespace

class IndexCoverage : public ::testing::TestWithParam<std::size_t> {};

TEST_P(IndexCoverage, OfTheModel) {
    const auto known = known_indices()[GetParam()];
    Range range{1, 0};
    count_models(known, known.cases, range);
    remember(known, "model", range);
}

TEST_P(IndexCoverage, OfBins) {
    const auto known = known_indices()[GetParam()];
    for (const std::int64_t sequences : {1, 8}) {
        Range range{1, 0};
        for (const std::int64_t n : {192, 512, 2048}) count_bins(known, n, sequences, range);
        remember(known, sequences > 1 ? "bins, 8 sequences" : "bins, 1 sequence", range);
    }
}

TEST_P(IndexCoverage, OfTheSplit) {
    const auto known = known_indices()[GetParam()];
    Range range{1, 0};
    for (const std::int64_t n : {128, 512, 1024})
        for (const std::int64_t sequences : {1, 8}) count_splits(known, n, sequences, range);
    remember(known, "split of the variance", range);
}

INSTANTIATE_TEST_SUITE_P(Responses, IndexCoverage, ::testing::Range(std::size_t{0}, known_indices().size()),
                         [](const auto& response) { return known_indices()[response.param].name; });
