#include "sweep/campaign/old_results.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/csv_table.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/designs/calibration_layout.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <system_error>
#include <utility>

namespace grainsweep::campaign {
namespace {

constexpr std::size_t largest_file_of_results = 64U << 20U;
constexpr double rounding_of_conversion = 1e-9;  // relative
// A number that is written with fewer digits than these could be the number of several points of a design.
constexpr double coarsest_input = 1e-6, coarsest_output = 1e-3;

/// Columns of a campaign's view that describe a computation, not a case.
constexpr std::array<std::string_view, 6> of_a_run = {"point", "sequence", "case_id",
                                                      "seed",  "attempts", "wall_seconds"};

/// Role of a column.
struct OldColumn {
    enum class Role { factor, parameter, scalar, outcome, repeat, ignored };
    std::string name, unit;  ///< without and of its header's unit; empty: none
    Role role = Role::ignored;
    std::size_t factor = 0;  ///< number of the factor
};

/// Half a unit of the last decimal of a number, relative to it; 0 for a number without decimals.
double written_precision(std::string_view number, double value) {
    const auto mark = std::min(number.find_first_of("eEdD"), number.size());
    const auto point = number.substr(0, mark).find('.');
    if (value == 0 || point == std::string_view::npos) return 0;
    const auto decimals = static_cast<double>(mark - point - 1);
    const auto mantissa = number_in(number.substr(number.starts_with('+') ? 1 : 0, mark));
    if (!mantissa || *mantissa == 0) return 0;
    return 0.5 * std::pow(10.0, -decimals) / std::abs(*mantissa);
}

class OldResultsReader {
public:
    OldResultsReader(const OldResultsRequest& request, const Campaign& campaign, const Filter& accepts)
        : request_(request), campaign_(campaign), accepts_(accepts), name_(request.file.filename().string()) {}

    OldResults read() {
        std::error_code error;
        found_.text = files::whole_file(request_.file, error, largest_file_of_results);
        if (error)
            throw input_error("FILE.csv", request_.file.string(),
                              error == std::errc::file_too_large ? "the file must have at most 64 MiB"
                                                                 : "cannot be read: " + error.message());
        found_.hash = content_hash(found_.text);
        CsvTable table(
            found_.text, [this](const std::string& rule) { throw input_error(name_, "", rule); }, std::nullopt);
        read_header(table.header());
        while (const auto record = table.next()) read_line(*record, table.number());
        if (found_.results.empty() && found_.unanswered == 0) refuse_file("it has no line below its header");
        return std::move(found_);
    }

private:
    [[noreturn]] void refuse_file(const std::string& rule, std::string_view nearest = {}) const {
        throw input_error(name_, "", rule, nearest);
    }
    [[nodiscard]] std::string place(std::size_t column) const {
        return fmt::format("{}: line {}, column '{}'", name_, line_, columns_[column].name);
    }
    [[noreturn]] void refuse(std::size_t column, const std::string& cell, const std::string& rule) const {
        throw input_error(place(column), shown(cell), rule);
    }

    void read_header(const CsvRecord& header) {
        for (const auto& cell : header) columns_.push_back(column_of(cell));
        for (const auto& ignored : request_.ignored)
            if (std::ranges::find(columns_, ignored, &OldColumn::name) == columns_.end())
                throw input_error("--ignore", ignored, fmt::format("'{}' has no such column", name_),
                                  nearest_word(ignored, names_of(columns_)));
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            const auto same = std::ranges::find(columns_, columns_[k].name, &OldColumn::name);
            if (columns_[k].role != OldColumn::Role::ignored && same - columns_.begin() != static_cast<long>(k))
                refuse_file(fmt::format("its header names '{}' twice", columns_[k].name));
        }
        for (std::size_t j = 0; j < campaign_.space.factors.size(); ++j)
            if (std::ranges::none_of(
                    columns_, [&](const auto& one) { return one.role == OldColumn::Role::factor && one.factor == j; }))
                refuse_file(fmt::format("its header has no column for factor '{}'", campaign_.space.factors[j].name),
                            nearest_word(campaign_.space.factors[j].name, names_of(columns_)));
        check_scalars();
    }
    void check_scalars() const {
        std::vector<std::string> absent;
        bool any = false;
        for (const auto& observable : campaign_.scene().observables) {
            if (observable.shape != Shape::scalar) continue;
            const bool found = std::ranges::any_of(columns_, [&](const auto& one) {
                return one.role == OldColumn::Role::scalar && one.name == observable.name;
            });
            any = any || found;
            if (!found) absent.push_back(observable.name);
        }
        if (!any) refuse_file(fmt::format("it has no column of an observable; they are {}", listed(absent)));
        for (const auto& name : counted_observables())
            if (std::ranges::find(absent, name) != absent.end())
                refuse_file(
                    fmt::format("it has no column for '{}', whose missing values the calibration counts", name));
        if (!absent.empty() && !request_.partial)
            refuse_file(fmt::format("it has no column for {}; --partial imports cases without a value of {}",
                                    listed(absent), absent.size() == 1 ? "it" : "them"));
    }
    /// Returns the observables of a calibration's targets that count missing values.
    [[nodiscard]] std::vector<std::string> counted_observables() const {
        std::vector<std::string> names;
        const auto& options = campaign_.request.options;
        if (!options.contains("targets")) return names;
        for (const auto& target : designs::targets_in(campaign_.request.word("targets")))
            if (target.of && target.experiment == designs::experiment_of(campaign_.request))
                names.push_back(designs::place_on_curve(target.observable).observable);
        return names;
    }
    [[nodiscard]] OldColumn column_of(const std::string& cell) const {
        using Role = OldColumn::Role;
        const auto head = column_head(cell);
        OldColumn column{.name = head.name, .unit = head.unit};
        const auto& name = column.name;
        const auto ignored = [&](const auto& word) { return word == name || word == cell; };
        if (std::ranges::any_of(request_.ignored, ignored)) return column;
        const auto factor = std::ranges::find(campaign_.space.factors, name, &Factor::name);
        const auto* const observable = campaign_.scene().find_observable(name);
        if (factor != campaign_.space.factors.end()) {
            column.role = Role::factor;
            column.factor = static_cast<std::size_t>(factor - campaign_.space.factors.begin());
        } else if (campaign_.scene().find_parameter(name) != nullptr) {
            column.role = Role::parameter;
        } else if (observable != nullptr && observable->shape == Shape::scalar) {
            column.role = Role::scalar;
        } else if (name == "outcome") {
            column.role = Role::outcome;
        } else if (name == "replicate") {
            column.role = Role::repeat;
        } else if (observable != nullptr) {
            refuse_file(fmt::format("column '{}' is a curve; only scalars are imported: add --ignore {}", name, name));
        } else if (std::ranges::find(of_a_run, name) == of_a_run.end()) {
            refuse_unknown(name);
        }
        return column;
    }
    [[noreturn]] void refuse_unknown(const std::string& name) const {
        std::vector<std::string> known;
        for (const auto& factor : campaign_.space.factors) known.push_back(factor.name);
        for (const auto& observable : campaign_.scene().observables)
            if (observable.shape == Shape::scalar) known.push_back(observable.name);
        for (const auto& parameter : campaign_.scene().parameters) known.push_back(parameter.name);
        refuse_file(fmt::format("column '{}' is no parameter and no scalar of the campaign; --ignore {} leaves it out",
                                name, name),
                    nearest_word(name, known));
    }

    void read_line(const CsvRecord& record, std::size_t line) {
        line_ = line;
        OldResult result;
        result.line = line;
        if (!read_outcome(record, result.outcome)) {
            ++found_.unanswered;
            return;
        }
        result.row.resize(campaign_.space.factors.size());
        result.tolerances.resize(campaign_.space.factors.size());
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            const auto& column = columns_[k];
            if (column.role == OldColumn::Role::factor) read_factor(k, record[k], result);
            if (column.role == OldColumn::Role::scalar) read_scalar(k, record[k], result);
            if (column.role == OldColumn::Role::repeat) read_repeat(k, record[k], result);
        }
        if (result.outcome == Outcome::completed && result.scalars.empty())
            throw input_error(fmt::format("{}: line {}", name_, line_), "", "a completed case has at least one value");
        check_other_parameters(record, result);
        found_.results.push_back(std::move(result));
    }
    /// Returns false for a case without an answer.
    [[nodiscard]] bool read_outcome(const CsvRecord& record, Outcome& outcome) const {
        const auto column = std::ranges::find(columns_, OldColumn::Role::outcome, &OldColumn::role);
        if (column == columns_.end()) return true;
        const auto k = static_cast<std::size_t>(column - columns_.begin());
        if (record[k].empty()) return false;
        const auto known = outcome_named(record[k]);
        if (!known) {
            std::vector<std::string> words;
            for (const auto one : outcomes) words.emplace_back(to_string(one));
            throw input_error(place(k), shown(record[k]), "must be one of " + listed(words),
                              nearest_word(record[k], words));
        }
        outcome = *known;
        return settles(*known);
    }
    void read_repeat(std::size_t k, const std::string& cell, OldResult& result) const {
        constexpr double most = 1e6;
        const auto number = number_in(cell);
        if (!number || *number < 0 || *number > most || *number != std::floor(*number))
            refuse(k, cell, "must be a whole number from 0");
        result.repeat = static_cast<std::int64_t>(*number);
    }
    /// Returns the number as a program writes it, with a decimal point.
    [[nodiscard]] std::string with_point(std::size_t k, std::string cell) const {
        static const std::regex comma(R"(^[-+]?[0-9.]*,[0-9]+([eE][-+]?[0-9]+)?(\s.*)?$)");
        if (!request_.decimal_comma) {
            if (std::regex_match(cell, comma))
                refuse(k, cell, "must have a decimal point; --decimal comma reads decimal commas");
            return cell;
        }
        if (cell.find('.') != std::string::npos && cell.find_first_of("0123456789") != std::string::npos)
            refuse(k, cell, "has a point, and --decimal comma is given");
        if (std::ranges::count(cell, ',') == 1) std::ranges::replace(cell, ',', '.');
        return cell;
    }
    /// Reads a number in `unit`, with the unit of its column or its own.
    [[nodiscard]] WrittenNumber number_of(std::size_t k, const std::string& cell, const std::string& unit,
                                          double coarsest) const {
        const auto text = with_point(k, cell);
        const auto& in_header = columns_[k].unit;
        const bool plain = any_number_in(text.starts_with('+') ? std::string_view(text).substr(1) : text).has_value();
        if (!in_header.empty() && in_header != unit && (unit.empty() || (unit == "1" && in_header != "%")))
            refuse_file(fmt::format("column '{}' has the unit [{}], and the campaign states {} for it",
                                    columns_[k].name, in_header, unit.empty() ? "none" : "a pure number"));
        const bool converts = plain && !in_header.empty() && in_header != "1" && in_header != unit;
        const auto read = in_si(converts ? text + " " + in_header : text, unit);
        if (const auto* why = std::get_if<std::string>(&read)) {
            if (plain && converts) refuse_file(fmt::format("column '{}': [{}]: {}", columns_[k].name, in_header, *why));
            refuse(k, cell,
                   fmt::format("must be a number{}: {}", unit.empty() || unit == "1" ? "" : " in " + unit, *why));
        }
        const double value = std::get<double>(read);
        if (!std::isfinite(value)) refuse(k, cell, "must be a finite number");
        const double precision = std::min(written_precision(text, value), coarsest);
        return {value, std::max(precision, rounding_of_conversion) * std::abs(value)};
    }
    void read_factor(std::size_t k, const std::string& cell, OldResult& result) const {
        const auto j = columns_[k].factor;
        const auto& factor = campaign_.space.factors[j];
        const auto& parameter = *campaign_.scene().find_parameter(factor.name);
        if (cell.empty()) {
            if (factor.when.empty()) refuse(k, cell, fmt::format("factor '{}' needs a value", factor.name));
            result.row[j] = default_of(campaign_.scene(), factor.name);
            return;
        }
        if (std::holds_alternative<std::string>(parameter.default_value)) {
            result.row[j] = parse_value(parameter, cell, request_.folder, place(k));
        } else {
            const auto number = number_of(k, cell, parameter.unit, coarsest_input);
            result.row[j] = snapped(factor, number);
            result.tolerances[j] = number.tolerance;
            const Json json = cell;
            check_value(Cursor(json, place(k)), parameter, result.row[j]);
        }
        const Json json = cell;
        if (factor.when.empty()) check_in_range(Cursor(json, place(k)), factor, result.row[j]);
    }
    void check_value(const Cursor& where, const ParameterSpec& parameter, Value& value) const {
        value = coerced(value, parameter.default_value);
        const double number = std::get<double>(coerced(value, Value{0.0}));
        if (value.index() != parameter.default_value.index() || !std::get<Interval>(parameter.bounds).contains(number))
            where.refuse(rule_of(parameter));
    }
    /// Returns the level, or end of a range, that the number is written for; else the number.
    [[nodiscard]] static Value snapped(const Factor& factor, const WrittenNumber& number) {
        std::vector<double> marks;
        if (const auto* levels = std::get_if<Levels>(&factor.range)) {
            for (const auto& level : levels->values) {
                const auto real = coerced(level, Value{0.0});
                if (std::holds_alternative<double>(real)) marks.push_back(std::get<double>(real));
            }
        } else if (const auto* range = std::get_if<Between>(&factor.range)) {
            marks = {range->low, range->high};
        }
        for (const double mark : marks)
            if (std::abs(mark - number.value) <= number.tolerance) return mark;
        return number.value;
    }
    void read_scalar(std::size_t k, const std::string& cell, OldResult& result) const {
        const auto& observable = *campaign_.scene().find_observable(columns_[k].name);
        if (cell.empty() || cell == "NA" || cell == "nan" || cell == "NaN" || cell == "NULL") return;
        if (result.outcome == Outcome::unstable || result.outcome == Outcome::rejected)
            refuse(k, cell,
                   fmt::format("the case is {}, and moments would count its value: leave the cell empty",
                               to_string(result.outcome)));
        const auto number = number_of(k, cell, observable.unit, coarsest_output);
        if (const auto program = known_program(campaign_.scene().name)) {
            const auto declared = std::ranges::find(program->observables, observable.name, &ProgramObservable::name);
            if (declared != program->observables.end() && !declared->bounds.contains(number.value))
                refuse(k, cell, fmt::format("'{}' must be a number{}", observable.name, in_words(declared->bounds)));
        }
        result.scalars.emplace(observable.name, number);
    }
    /// Refuses parameters that are not as in the campaign, and settings that its `where` excludes.
    void check_other_parameters(const CsvRecord& record, const OldResult& result) const {
        const auto inputs = campaign_.space.at(std::span<const Value>(result.row));
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            if (columns_[k].role != OldColumn::Role::parameter || record[k].empty()) continue;
            const auto& parameter = *campaign_.scene().find_parameter(columns_[k].name);
            const auto found = inputs.find(parameter.name);
            const auto& here = found == inputs.end() ? parameter.default_value : found->second;
            const bool same = std::holds_alternative<std::string>(here) ? to_text(here) == record[k]
                                                                        : is_number_here(k, record[k], parameter, here);
            if (!same)
                refuse(k, record[k],
                       fmt::format("the campaign has {} = {}: cases with another value belong to another campaign",
                                   parameter.name, to_text(here)));
        }
        if (accepts_ && !accepts_(inputs))
            throw input_error(fmt::format("{}: line {}", name_, line_), "",
                              fmt::format("the campaign's `where`, {}, excludes this setting", campaign_.where));
    }
    [[nodiscard]] bool is_number_here(std::size_t k, const std::string& cell, const ParameterSpec& parameter,
                                      const Value& here) const {
        const auto number = number_of(k, cell, parameter.unit, coarsest_input);
        return std::abs(number.value - std::get<double>(coerced(here, Value{0.0}))) <= number.tolerance;
    }

    const OldResultsRequest& request_;
    const Campaign& campaign_;
    const Filter& accepts_;
    std::string name_;
    std::vector<OldColumn> columns_;
    std::size_t line_ = 1;
    OldResults found_;
};

}  // namespace

OldResults read_old_results(const OldResultsRequest& request, const Campaign& campaign, const Filter& accepts) {
    return OldResultsReader(request, campaign, accepts).read();
}

}  // namespace grainsweep::campaign
