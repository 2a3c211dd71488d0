// The end of a campaign whose cases cost very unlike amounts: one JSON line per way of running it.
//
//   bench_tail [--cases N] [--seconds S] [--seed K] [--mode auto|one|in_order]
//
// N (64) drums of 20,000 spheres turn for times of a lognormal distribution with sigma = 1, S (120) seconds of
// computing on one core in all. `auto`: cores that no case needs go to those that run. `one`: every case has one
// thread. Both hand out the cases as campaigns do, long ones first near the end. `in_order`: as GNU Parallel would,
// each core takes the next case of the list and runs `solve` on it. `ideal` is what cores that are never idle need: the
// seconds of all cases, one thread each and all cores busy, over the cores (from the mode `one`, which must therefore
// be run, too); `ratio` the elapsed time over it. `same`: all answers are equal to the last bit. One order may be
// lucky: `any_order` is the mean ratio of in_order over 10,000 orders, by arithmetic from the seconds of the cases, and
// `worst_order` the largest of them.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "stats/random.hpp"
#include "tests/support/process.hpp"

using nlohmann::json;
using namespace grainsweep;

namespace {

struct Options {
    std::size_t cases = 64;
    double seconds = 120;
    std::uint64_t seed = 1;
    std::string mode;
};

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// exp(z), z normal (Box & Muller 1958).
double lognormal(const stats::Stream& draws, std::uint64_t k) {
    const double radius = std::sqrt(-2 * std::log(1 - draws.uniform(2 * k)));
    return std::exp(radius * std::cos(2 * std::numbers::pi * draws.uniform(2 * k + 1)));
}

/// Times the drums turn, s.
std::vector<double> turning_times(const Options& o) {
    constexpr double seconds_of_a_second = 12;  // of computing, on the machine of docs/cost.md
    const stats::Stream draws(o.seed, 1);
    std::vector<double> times;
    for (std::size_t k = 0; k < o.cases; ++k) times.push_back(lognormal(draws, k));
    const double scale = o.seconds / seconds_of_a_second / std::accumulate(times.begin(), times.end(), 0.0);
    for (double& time : times) time *= scale;
    return times;
}

json campaign(const std::vector<double>& times, const json& threads) {
    json rows = json::array();
    for (const double time : times) rows.push_back({time});
    return {{"campaign", "tail"},
            {"scene", "rotating_drum"},
            {"factors", {{{"name", "turning_time"}, {"between", {0, 1000}}}}},
            {"fixed",
             {{"particles", 20000},
              {"drum_diameter", 0.3},
              {"length", 0.08},
              {"measured_time", 0.01},
              {"frame_interval", 0.01}}},
            {"design", {{"kind", "list"}, {"rows", rows}}},
            {"execution", {{"threads", threads}}}};
}

class Tail {
public:
    explicit Tail(const Options& options) : options_(options), times_(turning_times(options)) {}

    void run(const std::string& mode, const json& threads) {
        if (!options_.mode.empty() && options_.mode != mode && mode != "one") return;
        folder_.write(mode + ".json", campaign(times_, threads).dump());
        const double start = now();
        const auto ended = tests::run_program({"run", mode + ".json", "--db", mode + ".db", "--quiet"}, folder_.path());
        const double seconds = now() - start;
        if (ended.code != 0) std::fprintf(stderr, "%s\n", ended.err.c_str());
        if (mode == "one") {
            for (const auto& row : query("SELECT wall_seconds FROM attempt", mode))
                of_cases_.push_back(row.at("wall_seconds"));
            work_ = std::accumulate(of_cases_.begin(), of_cases_.end(), 0.0);
            dump_ = tests::run_program({"dump", "one.db"}, folder_.path()).out;
        }
        const double most = query("SELECT max(threads) AS most FROM attempt", mode).at(0).at("most");
        show(mode, seconds, most, tests::run_program({"dump", mode + ".db"}, folder_.path()).out == dump_);
    }
    void run_in_order() {
        if (!options_.mode.empty() && options_.mode != "in_order") return;
        std::atomic<std::size_t> next = 0, failed = 0;
        const double start = now();
        {
            std::vector<std::jthread> cores;
            for (unsigned core = 0; core < cores_; ++core)
                cores.emplace_back([&] {
                    for (std::size_t k = next++; k < times_.size(); k = next++) {
                        const auto set = "turning_time=" + json(times_[k]).dump();
                        failed +=
                            tests::run_program({"solve", "one.json", "--set", set, "--threads", "1"}, folder_.path())
                                .code != 0;
                    }
                });
        }
        show("in_order", now() - start, 1, failed == 0);
        show_orders();
    }

private:
    [[nodiscard]] json query(const std::string& sql, const std::string& mode) const {
        return json::parse(tests::run_program({"query", mode + ".db", sql, "--format", "json"}, folder_.path()).out);
    }
    /// Seconds until the last case is done where each core takes the next of the list.
    [[nodiscard]] double in_order(const std::vector<double>& cases) const {
        std::vector<double> busy(cores_, 0.0);
        for (const double seconds : cases) *std::ranges::min_element(busy) += seconds;
        return *std::ranges::max_element(busy);
    }
    void show_orders() const {
        auto cases = of_cases_;
        const stats::Stream draws(options_.seed, 2);
        constexpr int orders = 10'000;
        const double ideal = work_ / cores_;
        double sum = 0, worst = 0;
        std::uint64_t draw = 0;
        for (int k = 0; k < orders; ++k) {
            for (std::size_t i = cases.size() - 1; i > 0; --i)
                std::swap(cases[i],
                          cases[static_cast<std::size_t>(draws.uniform(draw++) * static_cast<double>(i + 1))]);
            const double seconds = in_order(cases);
            sum += seconds;
            worst = std::max(worst, seconds);
        }
        std::printf(
            "{\"bench\": \"tail\", \"mode\": \"any_order\", \"cases\": %zu, \"ideal\": %.2f, \"ratio\": %.4f, "
            "\"worst_order\": %.4f}\n",
            cases.size(), ideal, sum / orders / ideal, worst / ideal);
    }
    void show(const std::string& mode, double seconds, double most, bool same) const {
        const double ideal = work_ / cores_;
        std::printf(
            "{\"bench\": \"tail\", \"mode\": \"%s\", \"cases\": %zu, \"cores\": %u, \"seconds\": %.2f, \"ideal\": "
            "%.2f, "
            "\"ratio\": %.4f, \"longest_case\": %.2f, \"most_threads\": %.2f, \"same\": %s}\n",
            mode.c_str(), times_.size(), cores_, seconds, ideal, seconds / ideal, *std::ranges::max_element(of_cases_),
            most, same ? "true" : "false");
        std::fflush(stdout);
    }

    Options options_;
    std::vector<double> times_;
    unsigned cores_ = std::max(1U, std::thread::hardware_concurrency());
    tests::Folder folder_;
    std::vector<double> of_cases_;  ///< seconds, one thread each
    double work_ = 0;               ///< their sum
    std::string dump_;
};

}  // namespace

int main(int argc, char** argv) {
    Options o;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string name = argv[i];
        if (name == "--cases") o.cases = static_cast<std::size_t>(std::max(1, std::atoi(argv[i + 1])));
        if (name == "--seconds") o.seconds = std::atof(argv[i + 1]);
        if (name == "--seed") o.seed = static_cast<std::uint64_t>(std::atoll(argv[i + 1]));
        if (name == "--mode") o.mode = argv[i + 1];
    }
    Tail tail(o);
    tail.run("one", 1);
    tail.run("auto", "auto");
    tail.run_in_order();
    return 0;
}
