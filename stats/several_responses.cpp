#include "stats/several_responses.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <optional>
#include <utility>

namespace grainsweep::stats {
namespace {

std::atomic<std::size_t>& fits_at_once() {
    static std::atomic<std::size_t> allowed = 1;
    return allowed;
}

}  // namespace

void allow_fits_at_once(std::size_t count) {
    fits_at_once() = count;
}

std::vector<std::variant<ResponseModel, Refusal>> fit_responses(Rows points,
                                                                std::span<const std::vector<double>> values,
                                                                const ResponseModelOptions& options) {
    std::vector<std::optional<std::variant<ResponseModel, Refusal>>> fits(values.size());
    std::atomic<std::size_t> next = 0;
    const auto fit_what_is_left = [&] {
        for (std::size_t k = next++; k < values.size(); k = next++) fits[k] = fit_response(points, values[k], options);
    };
    std::vector<std::future<void>> threads;  // whose destructors wait, and which hand on what is thrown
    for (std::size_t k = 1; k < std::min(fits_at_once().load(), values.size()); ++k)
        threads.push_back(std::async(std::launch::async, fit_what_is_left));
    fit_what_is_left();
    for (auto& thread : threads) thread.get();
    std::vector<std::variant<ResponseModel, Refusal>> all;
    for (auto& fit : fits) all.push_back(std::move(fit.value()));
    return all;
}

}  // namespace grainsweep::stats
