// "calibration": measurements and their conditions. The section replaces "design": conditions become factors with
// levels, and the waves are a design of their own.
#include "solver/plain_text.hpp"
#include "sweep/campaign/csv_table.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/joint_column.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/designs/calibration.hpp"
#include "sweep/designs/curve_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

constexpr std::size_t most_points = 100;   // of a curve, each with a response model of its own
constexpr std::size_t most_targets = 200;  // in all
constexpr double largest = 1e100;          // whose square, and the sum of such squares, is a number

/// The level of a condition's value; a value that is new becomes one.
std::size_t level_of(ParameterSpace& space, const std::string& name, Value value) {
    auto found = std::ranges::find(space.factors, name, &Factor::name);
    if (found == space.factors.end()) {
        space.factors.push_back({.name = name, .range = Levels{}, .unit = space.scene->find_parameter(name)->unit});
        found = space.factors.end() - 1;
    }
    auto& values = std::get<Levels>(found->range).values;
    const auto level = std::ranges::find(values, value);
    const auto number = static_cast<std::size_t>(level - values.begin());
    if (level == values.end()) values.push_back(std::move(value));
    return number;
}

std::map<std::string, std::size_t> read_condition(const Cursor& inputs, ParameterSpace& space, std::size_t calibrated,
                                                  const std::filesystem::path& folder) {
    if (!inputs.json().is_object()) inputs.refuse("must be an object of parameter names and values");
    std::map<std::string, std::size_t> levels;
    for (const auto& [name, json] : inputs.json().items()) {
        const Cursor place(json, path_of(inputs.path(), name));
        const Json word = name;
        const auto& parameter = read_parameter(Cursor(word, place.path()), *space.scene);
        const auto own = std::span(space.factors).first(calibrated);
        if (std::ranges::find(own, name, &Factor::name) != own.end())
            place.refuse(fmt::format("'{}' is calibrated; a condition states another parameter", name));
        if (fixed_as_stated(space).contains(name))
            place.refuse(fmt::format("'{}' is fixed as well; give it in one place", name));
        levels[name] = level_of(space, name, read_value(place, parameter, folder));
    }
    return levels;
}

/// A number in the unit of the observable, or a text with a unit that fits.
double measured_number(const Cursor& place, const ObservableSpec& observable, const Interval& bounds,
                       Reads reads = Reads::value) {
    if (!place.json().is_string()) return place.number(bounds);
    return std::get<double>(read_value(place, {observable.name, observable.unit, {}, 0.0, bounds, {}}, {}, reads));
}

double cell_number(const Cursor& file, std::size_t record, const std::string& cell) {
    const auto x = grainsweep::number_in(cell);
    if (!x) file.refuse(fmt::format("record {} has {} where a number is expected", record, shown(cell)));
    if (std::abs(*x) > largest)
        file.refuse(fmt::format("record {} has {}; a number of at most {} is expected", record, cell, largest));
    return *x;
}

/// In small letters, without blanks and signs: "Std. Err" becomes "stderr".
std::string plain_name(std::string_view name) {
    std::string plain;
    for (const char c : name) {
        const bool capital = c >= 'A' && c <= 'Z';
        const bool kept = capital || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '#' || (c & 0x80) != 0;
        if (kept) plain += capital ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return plain;
}

/// Whether data frames and tables give this name to the numbers of their rows.
bool names_rows(std::string_view name) {
    static constexpr auto names =
        std::to_array<std::string_view>({"#", "index", "unnamed0", "level0", "row", "rows", "rowid", "rowname",
                                         "rownames", "rowindex", "rownumber", "rownum", "line", "no", "nr", "id"});
    return std::ranges::find(names, plain_name(name)) != names.end();
}

bool names_errors(std::string_view name) {
    static constexpr auto whole = std::to_array<std::string_view>({"u", "s", "e", "ci", "ci95", "95ci"});
    static constexpr auto parts =
        std::to_array<std::string_view>({"err", "std", "sd", "se", "sigma", "dev", "unc", "tol", "delta", "accuracy",
                                         "precision", "rms", "noise", "\u00b1", "\u03c3"});
    const std::string plain = plain_name(name);
    return name.starts_with("u(") || std::ranges::find(whole, plain) != whole.end() ||
           std::ranges::any_of(parts, [&](std::string_view part) { return plain.find(part) != plain.npos; });
}

using CurveRow = std::array<double, 3>;  // where, value, error

/// Refuses row numbers in the column of places: whole numbers under a name of row numbers, and 0, 1, 2, ... or
/// 1, 2, 3, ... before places and values without errors. (A column without a name is refused with the header.)
void refuse_row_numbers(const Cursor& file, const CsvRecord& header, std::span<const CurveRow> rows) {
    bool whole = true, counts = rows.front()[0] == 0 || rows.front()[0] == 1, second_grows = true;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        whole = whole && rows[k][0] == std::floor(rows[k][0]);
        counts = counts && rows[k][0] == rows.front()[0] + static_cast<double>(k);
        second_grows = second_grows && (k == 0 || rows[k][1] > rows[k - 1][1]);
    }
    if (whole && names_rows(header[0]))
        file.refuse(
            fmt::format("its first column, {}, has row numbers, where places along the curve are expected: "
                        "leave it out, or name it as the place that it is (bin, time)",
                        shown(header[0])));
    if (header.size() == 3 && counts && second_grows && !names_errors(header[2]))
        file.refuse(
            fmt::format("its first column, {}, counts the rows, its second, {}, grows as places do, and its "
                        "third, {}, is not named as an error: leave out row numbers, or name the third 'error'",
                        shown(header[0]), shown(header[1]), shown(header[2])));
}

/// Converts column k to `unit` where its head states another one. Refuses a unit that does not fit.
void convert_column(const Cursor& file, const std::string& head, std::size_t k, const std::string& unit,
                    std::vector<CurveRow>& rows) {
    const std::string stated = column_head(head).unit;
    if (!resembles_united_number("1 " + stated)) return;  // brackets hold other words
    for (auto& row : rows) {
        const auto value = in_si(fmt::format("{} {}", shortest_text(row[k]), stated), unit);
        if (const auto* why = std::get_if<std::string>(&value))
            file.refuse(fmt::format("the head {} states a unit that cannot be taken: {}", shown(head), *why));
        row[k] = std::get<double>(value);
    }
}

/// Returns a target for each line "where,value[,error]" below the header.
std::vector<designs::MeasuredTarget> read_curve(const Cursor& file, const ObservableSpec& measured,
                                                const designs::MeasuredTarget& alike, bool has_error,
                                                const std::filesystem::path& folder) {
    const std::string text = read_csv_text(file, folder / file.text());
    CsvTable table(text, [&](const std::string& rule) { file.refuse(rule); });
    const auto columns = table.header().size();
    if (columns != 2 && columns != 3)
        file.refuse(
            fmt::format("its header has {} columns: where along the curve, the value and, if it differs from "
                        "line to line, its error are expected",
                        columns));
    std::vector<CurveRow> rows;
    std::vector<std::size_t> numbers;  // of the records
    while (const auto record = table.next()) {
        CurveRow row{0, 0, alike.error};
        for (std::size_t k = 0; k < columns; ++k) row[k] = cell_number(file, table.number(), (*record)[k]);
        rows.push_back(row);
        numbers.push_back(table.number());
    }
    if (rows.size() < 2 || rows.size() > most_points)
        file.refuse(
            fmt::format("it has {} lines; a curve of 2 to {} points is expected: some ten say what a smooth "
                        "curve has to say",
                        rows.size(), most_points));
    refuse_row_numbers(file, table.header(), rows);
    const auto comma = measured.over.rfind(", ");  // "time, s"
    const std::string along = comma != std::string::npos        ? measured.over.substr(comma + 2)
                              : measured.shape == Shape::series ? "s"
                                                                : "1";
    convert_column(file, table.header()[0], 0, along, rows);
    for (std::size_t k = 1; k < columns; ++k) convert_column(file, table.header()[k], k, measured.unit, rows);
    if ((columns == 3) == has_error)
        file.refuse(columns == 3
                        ? "it has a column of errors, and there is an \"error\" as well; give them in one place"
                        : "its lines have no error, and there is no \"error\" for them all");
    std::vector<designs::MeasuredTarget> targets;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (k > 0 && !(rows[k][0] > rows[k - 1][0]))
            file.refuse(fmt::format("record {}: places along the curve must grow", numbers[k]));
        if (rows[k][2] < 0) file.refuse(fmt::format("record {}: an error is at least 0", numbers[k]));
        auto& target = targets.emplace_back(alike);
        target.observable = designs::word_of({alike.observable, rows[k][0]});
        target.value = rows[k][1];
        target.error = rows[k][2];
    }
    return targets;
}

/// Reads how many of the measured runs had no value, and the discrepancy of their share.
void read_without_value(const Cursor& place, designs::MeasuredTarget& target) {
    const Section section(place, without_value_keys);
    const auto count = static_cast<double>(section.whole("count", 0)), of = static_cast<double>(section.whole("of", 1));
    if (count > of) section.at("count").refuse(fmt::format("must be at most the number of measured runs, {}", of));
    const double share = (count + 0.5) / (of + 1);  // neither 0 nor 1
    target.observable = designs::word_of({target.observable, std::nullopt, true});
    target.value = count / of;
    target.of = static_cast<std::size_t>(of);
    target.error = std::sqrt(share * (1 - share) / of);
    target.discrepancy = section.number("discrepancy", 0);
}

/// One, or as many as its curve has lines.
std::vector<designs::MeasuredTarget> read_target(const Cursor& element, Campaign& campaign, std::size_t calibrated,
                                                 const std::filesystem::path& folder, std::size_t curve) {
    const Section section(element, target_keys);
    if (const auto of = section.find("of")) of->refuse("the calibration has no \"experiments\"");
    const auto& scene = campaign.scene();
    designs::MeasuredTarget target;
    target.observable = section.at("observable").word(names_of(scene.observables));
    const bool scalar = scene.find_observable(target.observable)->shape == Shape::scalar;
    const auto value = section.find("value"), file = section.find("file"), error = section.find("error");
    const auto inputs = section.find("inputs");
    if (inputs) target.level = read_condition(*inputs, campaign.space, calibrated, folder);
    if (const auto without = section.find("without_value")) {
        if (!scalar) without->refuse("is for scalars, and the observable is a curve");
        for (const auto& other : {value, error, file})
            if (other)
                other->refuse(
                    "has no place beside \"without_value\"; the values of the other runs are a target of "
                    "their own");
        read_without_value(*without, target);
        return {target};
    }
    if (scalar && (file || !value))
        throw input_error(element.path(), target.observable,
                          "is a scalar: what was measured is its \"value\", or \"without_value\"");
    if (!scalar && (value || !file))
        throw input_error(element.path(), target.observable,
                          "is a curve: what was measured stands in a \"file\" of lines where,value[,error]");
    if (scalar && !error) throw input_error(element.path(), "", "'error' is missing: of what was measured");
    const auto& measured = *scene.find_observable(target.observable);
    if (value) target.value = measured_number(*value, measured, {-largest, largest});
    if (error) target.error = measured_number(*error, measured, {0, largest}, Reads::difference);
    if (scalar) return {target};
    target.curve = curve;
    return read_curve(*file, measured, target, error.has_value(), folder);
}

/// How far the simulation may be from the experiment, per observable: to be stated, be it 0. Shares state their own.
void read_discrepancies(const Section& section, const SceneInfo& scene, std::vector<designs::MeasuredTarget>& targets) {
    const bool only_shares = std::ranges::all_of(targets, [](const auto& target) { return target.of.has_value(); });
    const auto given = section.find("discrepancy");
    if (only_shares && !given) return;
    if (!given) throw input_error(section.place().path(), "", "key 'discrepancy' is missing");
    const Cursor& place = *given;
    if (!place.json().is_object()) place.refuse("must be an object of observables and standard deviations");
    std::vector<std::string> measured;  // of each target; a share has none
    for (const auto& target : targets)
        measured.push_back(target.of ? "" : designs::place_on_curve(target.observable).observable);
    for (const auto& [name, json] : place.json().items()) {
        const Cursor here(json, path_of(place.path(), name));
        if (std::ranges::find(measured, name) == measured.end())
            here.refuse("no target measures a value of this observable", nearest_word(name, measured));
        const double discrepancy = measured_number(here, *scene.find_observable(name), {0, largest}, Reads::difference);
        for (std::size_t k = 0; k < targets.size(); ++k)
            if (measured[k] == name) targets[k].discrepancy = discrepancy;
    }
    for (std::size_t k = 0; k < targets.size(); ++k) {
        if (targets[k].of) continue;
        if (!place.json().contains(measured[k])) {
            throw input_error(place.path(), "",
                              fmt::format("'{0}' is missing: how far the simulation itself may be from the experiment "
                                          "in {0}, as a standard deviation; 0 is allowed and warned of",
                                          measured[k]));
        }
        if (!(std::pow(targets[k].error, 2) + std::pow(targets[k].discrepancy, 2) > 0))
            throw input_error(section.at("targets").path(), targets[k].observable,
                              "has neither an error nor a discrepancy: no simulation meets it exactly");
    }
}

}  // namespace

void read_calibration(const Cursor& place, Campaign& campaign, const std::filesystem::path& folder) {
    const Section section(place, calibration_keys);
    auto& space = campaign.space;
    const std::size_t calibrated = space.factors.size();
    for (const auto& factor : space.factors) {
        if (const auto* levels = std::get_if<Levels>(&factor.range); levels != nullptr && levels->values.size() < 2)
            throw input_error("$.factors", factor.name,
                              "has one level: nothing to calibrate; what differs from target to target stands in its "
                              "\"inputs\"");
        if (column_of(std::get_if<stats::Distribution>(&factor.range)) != nullptr)
            throw input_error("$.factors", factor.name,
                              "a calibration begins from factors that are independent; give each a distribution of "
                              "its own, not a column of one file with another");
    }
    std::vector<designs::MeasuredTarget> targets;
    const auto elements = section.at("targets").elements();
    std::vector<std::string> places;  // of each target
    for (const auto& element : elements) {
        const auto read = read_target(element, campaign, calibrated, folder, places.size() + 1);
        targets.insert(targets.end(), read.begin(), read.end());
        places.insert(places.end(), read.size(), element.path());
        if (targets.size() > most_targets)
            element.refuse(
                fmt::format("at most {} measurements, points of curves counted, can be calibrated to", most_targets));
    }
    if (targets.empty()) section.at("targets").refuse("a calibration needs at least one target");
    for (std::size_t k = 0; k < targets.size(); ++k) {
        if (!std::ranges::equal(
                targets[k].level, targets.front().level, {}, [](const auto& x) { return x.first; },
                [](const auto& x) { return x.first; }))
            throw input_error(places[k], "", "every target states the same \"inputs\", each with its values");
        for (std::size_t j = 0; j < k; ++j)
            if (targets[j].observable == targets[k].observable && targets[j].level == targets[k].level)
                throw input_error(places[k], targets[k].observable, "is a target twice under the same condition");
    }
    read_discrepancies(section, campaign.scene(), targets);

    campaign.design = "calibration";
    auto& options = campaign.request.options;
    options["targets"] = designs::text_of(targets);
    options["waves"] = section.whole("waves", 4);
    options["points_per_wave"] = section.whole("points_per_wave", 40);
    options["checks"] = section.whole("checks", 8);
    options["shrink"] = 0.02;
    if (const auto stop = section.find("stop")) options["shrink"] = Section(*stop, stop_keys).number("shrink", 0.02);
    set_factors(campaign);
    check_growing(place, campaign);
}

}  // namespace grainsweep::campaign
