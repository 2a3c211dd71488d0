#include "sweep/report/calibration_tables.hpp"

#include "sweep/report/table.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace grainsweep::report {

using namespace study;

namespace {

using Cell = store::Table::Cell;

constexpr std::size_t drawn_on_page = 800;

}  // namespace

std::string calibration_line(const CalibrationReport& report) {
    const auto& found = report.found;
    if (found.waves.empty()) return "calibration: the first wave is not answered yet";
    const auto& last = found.waves.back();
    const auto done = fmt::format("calibration: {} wave{}, {} cases, {:.3g} % of the box kept", found.waves.size(),
                                  found.waves.size() == 1 ? "" : "s", last.cases, 100 * last.kept);
    if (!found.waves_end) return done + "; the next wave is not answered yet";
    return fmt::format("{}; {}", done, found.why_they_end);
}

store::Table waves_table(const CalibrationReport& report) {
    store::Table table{{"wave", "settings", "cases", "failed", "kept"}, {}};
    for (const auto& target : report.targets) table.columns.push_back(fmt::format("model error of {}", target.name()));
    for (std::size_t w = 0; w < report.found.waves.size(); ++w) {
        const auto& wave = report.found.waves[w];
        std::vector<Cell> row = {static_cast<std::int64_t>(w + 1), static_cast<std::int64_t>(wave.settings),
                                 static_cast<std::int64_t>(wave.cases), static_cast<std::int64_t>(wave.failed),
                                 fmt::format("{:.3g} %", 100 * wave.kept)};
        for (const double error : wave.model_error)
            row.emplace_back(std::isfinite(error) ? fmt::format("{:.2g} sd", error) : std::string("no model"));
        table.rows.push_back(std::move(row));
    }
    return table;
}

store::Table posterior_table(const CalibrationReport& report) {
    store::Table table{{"factor", "unit", "mean", "sd", "5 %", "95 %", "width over range's"}, {}};
    for (const auto& factor : report.factors)
        table.rows.push_back({factor.name, factor.unit, fmt::format("{:.4g}", factor.mean),
                              fmt::format("{:.2g}", factor.sd), fmt::format("{:.4g}", factor.low),
                              fmt::format("{:.4g}", factor.high), fmt::format("{:.2f}", factor.share_of_range)});
    return table;
}

store::Table targets_table(const CalibrationReport& report) {
    store::Table table{{"target", "unit", "measured", "discrepancy", "model", "fresh runs", "runs", "z"}, {}};
    const auto pair = [](double value, double error) {
        return std::isfinite(value) ? with_error(value, error) : std::string("-");
    };
    for (const auto& target : report.targets)
        table.rows.push_back({target.name(), target.unit, with_error(target.value, target.error),
                              fmt::format("{:.3g}", target.discrepancy), pair(target.predicted, target.predicted_error),
                              pair(target.checked, target.checked_sd), static_cast<std::int64_t>(target.runs),
                              std::isfinite(target.z()) ? fmt::format("{:+.1f}", target.z()) : std::string("-")});
    return table;
}

std::string calibration_text(const CalibrationReport& report) {
    std::ostringstream text;
    text << calibration_line(report) << "\n";
    if (!report.found.waves.empty()) {
        text << '\n';
        write(text, waves_table(report), Format::text);
    }
    if (!report.factors.empty()) {
        text << "\nposterior\n";
        write(text, posterior_table(report), Format::text);
    }
    text << "\ntargets (standard deviations: measurement, spread over the posterior, scatter of fresh runs)\n";
    write(text, targets_table(report), Format::text);
    for (const auto& note : report.notes) text << "note: " << note << '\n';
    return text.str();
}

nlohmann::ordered_json page_of(const CalibrationReport& report) {
    using Json = nlohmann::ordered_json;
    const auto json_of = [](const store::Table& table) {
        Json value = {{"columns", table.columns}, {"rows", Json::array()}};
        for (const auto& row : table.rows) {
            Json cells = Json::array();
            for (const auto& cell : row) cells.push_back(to_json(cell));
            value["rows"].push_back(std::move(cells));
        }
        return value;
    };
    const auto& found = report.found;
    Json value = {{"says", calibration_line(report)},
                  {"notes", report.notes},
                  {"posterior", found.posterior ? json_of(posterior_table(report)) : Json(nullptr)},
                  {"targets", json_of(targets_table(report))},
                  {"waves", json_of(waves_table(report))},
                  {"factors", Json::array()},
                  {"draws", Json::array()},
                  {"settings", Json::array()}};
    for (std::size_t j = 0; j < found.factors.size(); ++j) {
        const auto& range = found.ranges[j];
        const double low = range.value_at(0), high = range.value_at(1);
        const bool logarithmic = std::abs(range.value_at(0.5) - (low + high) / 2) > 1e-6 * (high - low);
        const std::string unit = j < report.factors.size() ? report.factors[j].unit : "1";
        value["factors"].push_back({{"name", found.factors[j]},
                                    {"unit", unit},
                                    {"levels", Json::array()},
                                    {"low", low},
                                    {"high", high},
                                    {"log", logarithmic},
                                    {"values", {low, high}}});
    }
    const auto add = [&](Json& rows, std::span<const double> coordinates) {
        Json row = Json::array();
        for (std::size_t j = 0; j < found.factors.size(); ++j) row.push_back(found.ranges[j].value_at(coordinates[j]));
        rows.push_back(std::move(row));
    };
    if (found.posterior) {
        const auto draws = found.posterior->rows();
        const std::size_t step = std::max<std::size_t>(1, draws.size() / drawn_on_page);
        for (std::size_t i = 0; i < draws.size(); i += step) add(value["draws"], draws.row(i));
    }
    for (std::size_t i = 0; i + found.factors.size() <= found.settings.size(); i += found.factors.size())
        add(value["settings"], std::span(found.settings).subspan(i));
    return value;
}

nlohmann::ordered_json to_json(const CalibrationReport& report) {
    using Json = nlohmann::ordered_json;
    Json value = {{"ended", report.found.waves_end},
                  {"why", report.found.why_they_end},
                  {"waves", Json::array()},
                  {"posterior", Json::array()},
                  {"correlation", Json::array()},
                  {"targets", Json::array()},
                  {"notes", report.notes}};
    for (const auto& wave : report.found.waves) {
        Json errors = Json::array();
        for (const double error : wave.model_error) errors.push_back(json_number(error));
        value["waves"].push_back({{"settings", wave.settings},
                                  {"cases", wave.cases},
                                  {"failed", wave.failed},
                                  {"kept", wave.kept},
                                  {"model_errors", errors}});
    }
    for (const auto& factor : report.factors)
        value["posterior"].push_back({{"factor", factor.name},
                                      {"mean", factor.mean},
                                      {"sd", factor.sd},
                                      {"q05", factor.low},
                                      {"q95", factor.high},
                                      {"share_of_range", factor.share_of_range}});
    if (report.found.shape) value["correlation"] = report.found.shape->correlation;
    for (const auto& target : report.targets)
        value["targets"].push_back({{"observable", target.observable},
                                    {"condition", target.condition},
                                    {"value", target.value},
                                    {"error", target.error},
                                    {"discrepancy", target.discrepancy},
                                    {"predicted", json_number(target.predicted)},
                                    {"predicted_sd", json_number(target.predicted_error)},
                                    {"checked", json_number(target.checked)},
                                    {"checked_sd", json_number(target.checked_sd)},
                                    {"runs", target.runs},
                                    {"z", json_number(target.z())}});
    return value;
}

}  // namespace grainsweep::report
