// Two objectives on published problems: the hypervolume of N cases that `window --next` chose against that of 5 N
// random ones, and what the window says of the front. Minutes: slow_objectives; the table of docs/two_objectives.md.
#include "sweep/study/response_models.hpp"
#include "tests/support/two_objectives.hpp"

#include <gtest/gtest.h>

#include <cstdio>

using namespace grainsweep;
using namespace grainsweep::tests;

namespace {

constexpr int batch = 4, most = 60;
constexpr std::uint64_t searches = 5, random_searches = 40;

/// A search by batches: hypervolume after each, and the end by a tolerance of 1 %.
struct Searched {
    std::map<int, double> volumes;
    int end = 0;         ///< cases at the end
    double lacking = 0;  ///< part of the true hypervolume that was lacking then
    int promises = 0, kept = 0;
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
        ++found.promises;
        found.kept += window.volume->value + window.volume->further >= truth ? 1 : 0;
        if (found.end == 0 && window.volume->further <= 0.01 * window.volume->value) {
            found.end = cases;
            found.lacking = 1 - volume / truth;
        }
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
        int promises = 0, kept = 0;
        for (const auto& one : all) {
            std::printf("%-16s ends by 1 %% at %d cases (0: not by %d), lacking %.2g %%\n", problem.name.c_str(),
                        one.end, most, 100 * one.lacking);
            EXPECT_LE(one.lacking, 0.02);
            promises += one.promises;
            kept += one.kept;
        }
        std::printf("%-16s the true hypervolume is within what the window allows in %d of %d\n", problem.name.c_str(),
                    kept, promises);
        std::fflush(stdout);
    }
}

}  // namespace
