#include "tests/documents/measured_tables.hpp"

#include "tests/documents/table_rows.hpp"
#include "tests/support/measured.hpp"
#include "tests/support/reference_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainsweep::tests {
namespace {

struct Ensemble {
    double mean = 0, sd = 0, pooled_sd = 0;
    int seeds = 0;
};

/// LIGGGHTS, by case and quantity. The tolerance of a difference is 3 sd sqrt(1/n + 1/m).
std::map<std::pair<std::string, std::string>, Ensemble> ensembles() {
    std::map<std::pair<std::string, std::string>, Ensemble> found;
    for (const char* folder : {"machines", "laboratory"}) {
        const ReferenceTable table(std::string(folder) + "/ensembles.csv");
        for (std::size_t row = 0; row < table.size(); ++row) {
            if (table.cell(row, "tolerance").empty()) continue;
            const auto seeds = static_cast<int>(table.whole(row, "seeds"));
            found[{table.cell(row, "case"), table.cell(row, "quantity")}] = {
                table.number(row, "mean"), table.number(row, "sd"),
                table.number(row, "tolerance") / 3 / std::sqrt(2.0 / seeds), seeds};
        }
    }
    return found;
}

/// As an engineer writes it, where the unit takes a prefix.
struct Prefix {
    double factor = 1;
    std::string sign;
};

Prefix prefix_for(double value, const std::string& unit) {
    if (unit != "J" && unit != "N" && unit != "N m" && unit != "Pa" && unit != "m") return {};
    for (const auto& [factor, sign] : {std::pair{1e6, "M"}, {1e3, "k"}, {1.0, ""}, {1e-3, "m"}})
        if (std::abs(value) >= factor) return {factor, sign};
    return {1e-6, "u"};
}

/// Both to the place of the second digit of the standard deviation.
std::string with_scatter(double mean, double sd) {
    const int places = std::max(0, 1 - static_cast<int>(std::floor(std::log10(sd))));
    return fmt::format("{:.{}f} +- {:.{}f}", mean, places, sd, places);
}

}  // namespace

std::string measured_table(const std::string& name, bool crossed) {
    const auto rows = read_measured(name);
    if (!crossed) {
        std::string table = head(rows.front());
        for (auto line = rows.begin() + 1; line != rows.end(); ++line) table += row(*line);
        return table;
    }
    std::vector<std::string> lines, columns = {rows.front()[0]};
    std::map<std::pair<std::string, std::string>, std::string> cells;
    const auto add = [](std::vector<std::string>& names, const std::string& one) {
        if (std::ranges::find(names, one) == names.end()) names.push_back(one);
    };
    for (auto line = rows.begin() + 1; line != rows.end(); ++line) {
        add(lines, (*line)[0]);
        add(columns, (*line)[1]);
        cells[{(*line)[0], (*line)[1]}] = (*line)[2];
    }
    std::string table = head(columns);
    for (const auto& line : lines) {
        std::vector<std::string> shown = {line};
        for (auto column = columns.begin() + 1; column != columns.end(); ++column)
            shown.push_back(cells[{line, *column}]);
        table += row(shown);
    }
    return table;
}

std::string liggghts_table(const std::vector<std::string>& cases,
                           const std::map<std::pair<std::string, std::string>, std::string>& unit_of) {
    static const auto theirs = ensembles();
    std::string table = head({"case", "number", "LIGGGHTS", "here", "seeds", "difference divided by its tolerance"});
    for (const auto& name : cases) {
        const std::string before = table;
        for (const auto& line : read_measured("machines")) {
            if (line[0] != name) continue;
            const auto& peer = theirs.at({name, line[1]});
            const double mean = std::stod(line[5]), sd = std::stod(line[6]);
            const int seeds = std::stoi(line[4]);
            const double tolerance = 3 * peer.pooled_sd * std::sqrt(1.0 / seeds + 1.0 / peer.seeds);
            const std::string& unit = unit_of.at({line[2], line[3]});
            const auto [factor, sign] = prefix_for(peer.mean, unit);
            table +=
                row({code(name), code(line[3]) + (unit == "1" ? "" : ", " + sign + unit),
                     with_scatter(peer.mean / factor, peer.sd / factor), with_scatter(mean / factor, sd / factor),
                     fmt::format("{}, {}", peer.seeds, seeds), fmt::format("{:.2f}", (mean - peer.mean) / tolerance)});
        }
        if (table == before) throw std::invalid_argument("no figures of '" + name + "': run slow_machines");
    }
    return table;
}

}  // namespace grainsweep::tests
