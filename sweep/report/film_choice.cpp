#include "sweep/report/film_choice.hpp"

#include "sweep/study/responses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::report {

using namespace study;

namespace {

std::string says(const ResponseColumn& response, double value, double quantile) {
    const std::string unit = response.unit.empty() || response.unit == "1" ? "" : " " + response.unit;
    const std::string place = quantile == 0     ? "smallest"
                              : quantile == 1   ? "largest"
                              : quantile == 0.5 ? "median"
                                                : fmt::format("{:.0f} % quantile of", 100 * quantile);
    return fmt::format("{} {}, {:.4g}{}", place, response.name, value, unit);
}

std::vector<FilmChoice> spanning(const Responses& responses, std::size_t count) {
    const auto* response = responses.main_observable();
    if (response == nullptr || count == 0) return {};
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < responses.rows(); ++row)
        if (responses.outcomes[row] == campaign::Outcome::completed && std::isfinite(response->values[row]))
            rows.push_back(row);
    std::ranges::stable_sort(rows, {}, [&](std::size_t row) { return response->values[row]; });
    std::vector<FilmChoice> chosen;
    for (std::size_t k = 0; k < count && !rows.empty(); ++k) {
        const double quantile = count == 1 ? 0.5 : static_cast<double>(k) / static_cast<double>(count - 1);
        const auto rank = static_cast<std::size_t>(std::lround(quantile * static_cast<double>(rows.size() - 1)));
        const std::string& id = responses.case_ids[rows[rank]];
        if (std::ranges::find(chosen, id, &FilmChoice::case_id) != chosen.end()) continue;
        chosen.push_back({responses.campaign.name, id, says(*response, response->values[rows[rank]], quantile)});
    }
    return chosen;
}

}  // namespace

std::vector<FilmChoice> cases_to_watch(const store::Store& store, std::size_t count) {
    const auto records = find_campaigns(store, "");
    std::vector<FilmChoice> all;
    for (std::size_t c = 0; c < records.size(); ++c) {
        const std::size_t share = count / records.size() + (c < count % records.size() ? 1 : 0);
        for (auto& one : spanning(read_responses(store, records[c]), share)) all.push_back(std::move(one));
    }
    return all;
}

}  // namespace grainsweep::report
