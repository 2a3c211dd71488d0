// How long a response model takes to be made and asked, at 400, 2,400 and 10,000 cases of the spreading response with
// its noise; one JSON line each. With a table of cases (see table_of_cases.hpp) its leave-one-out figures instead:
//   bench_response FILE.csv LOW:HIGH,LOW:HIGH,... RESPONSE...      the first columns are factors with these ranges
#include "stats/response_model.hpp"
#include "tests/support/known_responses.hpp"
#include "tests/support/table_of_cases.hpp"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <variant>
#include <vector>

using namespace grainsweep::stats;
using namespace grainsweep::tests;

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void show(const std::string& name, Rows points, const std::vector<double>& values) {
    const auto start = std::chrono::steady_clock::now();
    const auto cpu = std::clock();
    ResponseModelOptions options;
    options.logarithm = LogResponse::where_better;  // as `predict` does
    const auto fit = fit_response(points, values, options);
    const double fitting = seconds_since(start);
    const double cpu_seconds = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    if (const auto* refusal = std::get_if<Refusal>(&fit)) {
        std::printf("{\"response\": \"%s\", \"refused\": \"%s\"}\n", name.c_str(), refusal->sentence.c_str());
        return;
    }
    const auto& model = std::get<ResponseModel>(fit);
    const auto fresh = ask_design("random", points.dimensions, {{"points", std::int64_t{1000}}}, 5);
    const auto asked = std::chrono::steady_clock::now();
    (void)model.predict(Rows{fresh.coordinates, points.dimensions});
    const ModelQuality& q = model.quality();
    std::printf(
        "{\"response\": \"%s\", \"cases\": %zu, \"rests_on\": %zu, \"fit_seconds\": %.3f, \"fit_cpu_seconds\": %.3f, "
        "\"predict_1000_seconds\": %.3f, \"leave_one_out_error\": %.4f, \"coverage_50\": %.3f, \"coverage_95\": %.3f, "
        "\"noise_share\": %.4f, \"learned_map\": %s, \"logarithm\": %s, \"compared\": [%.4f, %.4f]}\n",
        name.c_str(), q.cases, q.rests_on, fitting, cpu_seconds, seconds_since(asked), q.leave_one_out_error,
        q.coverage_50, q.coverage_95, q.noise_share, q.learned_map ? "true" : "false", q.logarithm ? "true" : "false",
        q.error_without_logarithm, q.error_with_logarithm);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        for (const std::int64_t n : {400, 2400, 10000}) {
            const auto c = ask_known(known_responses().front(), n, 1);
            show("spreading", {c.points, 4}, c.values);
        }
        return 0;
    }
    try {
        const auto table = read_cases(argv[1]);
        const auto box = read_box(argv[2]);
        const auto features = features_of(table, 0, box);
        for (int k = 3; k < argc; ++k) show(argv[k], {features, box.size()}, table.of(argv[k]));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
