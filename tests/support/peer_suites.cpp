#include "tests/support/peer_suites.hpp"

#include "solver/machine/run.hpp"
#include "tests/support/machines.hpp"
#include "tests/support/reference.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <utility>

namespace grainsweep::tests {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::filesystem::path peers_file(const std::string& name) {
    return reference("peers/" + name);
}

ordered_json peers_json(const std::string& name) {
    std::ifstream in(peers_file(name));
    return ordered_json::parse(in, nullptr, true, true);
}

/// What a check found: the figure, and its distance from the reference divided by the tolerance.
struct PeerFigure {
    std::string shown;
    double used = 0;
};

/// By suite, case and observable.
using PeerFigures = std::map<std::array<std::string, 3>, PeerFigure>;

PeerFigures measured() {
    PeerFigures figures;
    std::ifstream in(peers_file("measured.csv"));
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::array<std::string, 5> cells;
        std::istringstream row(line);
        for (auto& cell : cells) std::getline(row, cell, ',');
        figures[{cells[0], cells[1], cells[2]}] = {cells[3], std::stod(cells[4])};
    }
    return figures;
}

void remember(const PeerFigures& fresh) {
    PeerFigures all = measured();
    for (const auto& [of, figure] : fresh) all[of] = figure;
    std::ofstream out(peers_file("measured.csv"), std::ios::binary);
    out << "suite,case,observable,measured,share_of_tolerance\n";
    for (const auto& [of, figure] : all)
        out << fmt::format("{},{},{},{},{:.2g}\n", of[0], of[1], of[2], figure.shown, figure.used);
}

/// Scalars are means over the seeds, series those of the last.
Observations peer_answer(const json& given, const json& suite) {
    json document = peers_json(given.value("machine", suite.value("machine", std::string())) + ".json");
    if (given.contains("change")) document.merge_patch(given["change"]);
    const auto machine = campaign::make_machine(document, "$", campaign::beside(peers_file("")));
    Inputs chosen;
    for (const json& set : {suite.value("set", json::object()), given.value("set", json::object())})
        for (const auto& [name, value] : set.items())
            if (value.is_string())
                chosen.insert_or_assign(name, value.get<std::string>());
            else
                chosen.insert_or_assign(name, value.get<double>());
    const auto seeds = given.value("seeds", 1U);
    Observations means;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        machine::Run run(campaign::machine_spec(*machine, inputs_of(*machine, chosen)), seed);
        while (!run.finished() && run.health().stable()) run.advance(run.time() + 0.5);
        EXPECT_TRUE(run.health().stable()) << run.health().reason;
        Observations one;
        run.observe(one);
        means.series = one.series;
        for (const auto& [name, value] : one.scalars) means.scalars[name] += value / seeds;
    }
    return means;
}

/// The worst sample of a series outside of a band of two columns, relative to what is allowed outside of it.
PeerFigure outside_of_band(const std::vector<Sample>& series, const json& check) {
    const Table band = read_table(peers_file(check["band"]));
    const double within = check["within"];
    double worst = 0;
    for (std::size_t row = 0; row < band.rows; ++row) {
        const auto sample = std::ranges::find_if(
            series, [&](const Sample& one) { return std::abs(one.time - band.at("time", row)) < 1e-5; });
        if (sample == series.end()) return {"-", machine::undefined};
        worst = std::max({worst, band.at("low", row) - sample->value, sample->value - band.at("high", row)});
    }
    return {fmt::format("{:.2g}", worst), worst / within};
}

/// Where a profile falls below a value and stays there, between the centres of two bins.
double reach_of(const std::vector<Sample>& profile, double value) {
    for (std::size_t k = profile.size(); k-- > 1;) {
        const auto &inner = profile[k - 1], &outer = profile[k];
        const double beyond = std::isfinite(outer.value) ? outer.value : 0;
        if (inner.value > value)
            return inner.bin + (inner.value - value) / (inner.value - beyond) * (outer.bin - inner.bin);
    }
    return machine::undefined;
}

PeerFigure looked_up(const Observations& answer, const json& check) {
    const std::string observable = check["observable"];
    if (check.contains("band")) return outside_of_band(answer.series.at(observable), check);
    const double value = check.contains("reaches") ? reach_of(answer.series.at(observable), check["reaches"])
                                                   : answer.scalars.at(observable);
    const std::string shown = fmt::format("{:.3g}", value);
    if (check.contains("between")) {
        const double low = check["between"][0], high = check["between"][1];
        return {shown, value >= low && value <= high ? 0.0 : 2.0};
    }
    const json& reference = check["reference"];
    const double expected =
        reference.is_string() ? answer.scalars.at(reference.get<std::string>()) : reference.get<double>();
    const double allowed = check.contains("relative") ? check["relative"].get<double>() * std::abs(expected)
                                                      : check["within"].get<double>();
    return {shown, std::abs(value - expected) / allowed};
}

}  // namespace

std::vector<PeerCase> peer_cases(bool slow) {
    std::vector<PeerCase> cases;
    const ordered_json suites = peers_json("cases.json");
    for (const auto& [name, suite] : suites.items())
        for (const auto& given : suite["cases"]) {
            PeerCase one{name, given["name"], given.value("slow", suite.value("slow", false)), given};
            if (!given.contains("checks")) one.given["checks"] = suite["checks"];
            if (one.slow == slow) cases.push_back(std::move(one));
        }
    return cases;
}

void compare_with_peers(const PeerCase& asked) {
    const json suite = peers_json("cases.json")[asked.suite];
    const Observations answer = peer_answer(asked.given, suite);
    PeerFigures figures;
    for (const json& check : asked.given["checks"]) {
        const std::string observable = check["observable"];
        const PeerFigure figure = looked_up(answer, check);
        EXPECT_LE(figure.used, 1) << check << ": measured " << figure.shown;
        std::printf("%-20s %-22s %-22s %10s  %.2g of the tolerance\n", asked.suite.c_str(), asked.name.c_str(),
                    observable.c_str(), figure.shown.c_str(), figure.used);
        figures[{asked.suite, asked.name, observable}] = figure;
    }
    if (std::getenv("GRAINSWEEP_WRITE_DOCUMENTS") != nullptr && !testing::Test::HasFailure()) remember(figures);
}

std::vector<std::vector<std::string>> peer_rows() {
    const PeerFigures figures = measured();
    const ordered_json suites = peers_json("cases.json");
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, suite] : suites.items()) {
        double worst = 0;
        int numbers = 0, slow = 0;
        for (const auto& [of, figure] : figures)
            if (of[0] == name) worst = std::max(worst, figure.used), ++numbers;
        if (numbers == 0) continue;  // prepared, not computed
        for (const auto& given : suite["cases"]) slow += given.value("slow", suite.value("slow", false));
        std::string shows = suite["shows"];
        static const std::regex place(R"(\{(\w+)\.(\w+)\})");
        for (std::smatch found; std::regex_search(shows, found, place);)
            shows = found.prefix().str() + figures.at({name, found[1], found[2]}).shown + found.suffix().str();
        rows.push_back({suite["title"], shows, fmt::format("{}", numbers), fmt::format("{:.2g}", worst),
                        slow > 0 ? "`slow_peers_suites`" : "`test_physics`"});
    }
    return rows;
}

}  // namespace grainsweep::tests
