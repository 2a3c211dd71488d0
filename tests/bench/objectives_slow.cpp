// Two objectives on published problems: the hypervolume of N cases that `window --next` chose against that of 5 N
// random ones, and what the window says of the front. Minutes: slow_objectives; the table of docs/two_objectives.md.
#include "sweep/study/response_models.hpp"
#include "tests/support/two_objectives.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <vector>

using namespace grainsweep;
using namespace grainsweep::tests;

namespace {

constexpr int batch = 4, most = 60;
constexpr std::uint64_t searches = 20, random_searches = 40;
constexpr std::array tolerances = {0.012, 0.02, 0.05, 0.1, 0.2, 0.5};

/// A search by batches: hypervolume after each, and what the window said of it, divided by the true one.
struct Searched {
    struct Said {
        int cases;
        double value, further;
    };
    std::map<int, double> volumes;
    std::vector<Said> said;
};

Searched search(const Problem& problem, std::uint64_t seed) {
    const Folder folder;
    store::Store store{folder / "a.db", store::Store::Mode::create};
    (void)answer_all_by(store, problem.campaign(problem.first, seed), problem.formulas());
    const double truth = problem.true_volume();
    Searched found;
    for (int cases = problem.first; cases <= most; cases += batch) {
        const auto known = study::read_model_cases(store, "c");
        const double volume = problem.volume_of(known);
        found.volumes[cases] = volume;
        const auto window = study::window_of(store, known, problem.request(batch));
        found.said.push_back({cases, window.volume->value / truth, window.volume->further / truth});
        if (window.next.empty()) {
            for (int later = cases + batch; later <= most; later += batch) found.volumes[later] = volume;
            break;
        }
        (void)answer_all_by(store, study::next_campaign(known, window, fmt::format("c_next{}", cases), cases),
                            problem.formulas());
    }
    return found;
}

TEST(TwoObjectives, NeedAFifthOfTheCasesOfARandomSearch) {
    for (const auto& problem : {bnh(), fonseca_fleming(), zdt1()}) {
        const double truth = problem.true_volume();
        std::vector<Searched> all;
        for (std::uint64_t seed = 1; seed <= searches; ++seed) all.push_back(search(problem, seed));
        const auto mean_of = [&](int cases) {
            double sum = 0;
            for (const auto& one : all) sum += one.volumes.at(cases) / searches;
            return sum;
        };
        const auto random = [&](int cases) {
            double sum = 0;
            for (std::uint64_t seed = 0; seed < random_searches; ++seed)
                sum += problem.random_search(cases, seed) / random_searches;
            return sum;
        };
        for (const int cases : {20, 28, 40, 60}) {
            int needed = cases;  // by a random search
            while (needed < 100000 && random(needed) < mean_of(cases)) needed = needed * 5 / 4;
            std::printf(
                "%-16s %3d cases: hypervolume %.4f of the true one; random %d: %.4f, %d: %.4f; as many by %s%d\n",
                problem.name.c_str(), cases, mean_of(cases) / truth, cases, random(cases) / truth, 5 * cases,
                random(5 * cases) / truth, needed >= 100000 ? "more than " : "", needed);
            if (cases >= 28) {
                EXPECT_GE(mean_of(cases), random(5 * cases)) << problem.name << ' ' << cases;
            }
        }
        int windows = 0, held = 0;
        double farthest = 0;
        for (const auto& one : all)
            for (const auto& said : one.said) {
                ++windows;
                held += said.value + said.further >= 1 ? 1 : 0;
                if (said.value > 0.5) farthest = std::max(farthest, 1 - said.value - said.further);
            }
        std::printf(
            "%-16s what may be lacking includes the true front in %d of %d windows; beyond half of it, short by "
            "%.2g of it at most\n",
            problem.name.c_str(), held, windows, farthest);
        int stops = 0, false_stops = 0;
        for (const double tolerance : tolerances) {
            std::vector<int> ends;
            int wrong = 0;
            for (const auto& one : all) {
                const auto end = std::ranges::find_if(
                    one.said, [&](const auto& said) { return said.further <= tolerance * said.value; });
                if (end == one.said.end()) continue;
                ends.push_back(end->cases);
                wrong += 1 - end->value > tolerance * end->value ? 1 : 0;
            }
            std::ranges::sort(ends);
            std::printf("%-16s tolerance %.3g: %zu of %zu end, %d of them wrongly, half of them by %d cases\n",
                        problem.name.c_str(), tolerance, ends.size(), all.size(), wrong,
                        ends.empty() ? 0 : ends[ends.size() / 2]);
            stops += static_cast<int>(ends.size()), false_stops += wrong;
        }
        EXPECT_LE(false_stops, 0.05 * stops) << problem.name;
        std::fflush(stdout);
    }
}

}  // namespace
