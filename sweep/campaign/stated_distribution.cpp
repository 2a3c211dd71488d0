#include "sweep/campaign/stated_distribution.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace grainsweep::campaign {

namespace {

using Form = stats::Distribution::Form;

std::string values_text(std::span<const double> values) {
    std::string text;
    for (const double x : values) text.append(" ").append(shortest(x));
    return text;
}

std::string hash_of_columns(const stats::JointSample& sample) {
    std::string text;
    for (std::size_t k = 0; k < sample.columns(); ++k) text += values_text(sample.column(k)) + '\n';
    return content_hash(text);
}

/// Returns the words of a text as numbers; NaN for a word that is no number.
std::vector<double> numbers_in_words(std::string_view text) {
    std::vector<double> numbers;
    for (const char* at = text.data(); at != text.data() + text.size();) {
        const char* const end = text.data() + text.size();
        const char* stop = std::find(at, end, ' ');
        if (stop == at) {
            ++at;
            continue;
        }
        double number = std::numeric_limits<double>::quiet_NaN();
        std::from_chars(at, stop, number);
        numbers.push_back(number);
        at = stop;
    }
    return numbers;
}

StatedColumn column_in(std::string_view text) {
    StatedColumn stated;
    const auto colon = std::min(text.find(':'), text.size());
    std::istringstream words{std::string(text.substr(0, colon))};
    std::string of, in;
    std::size_t count = 0;
    words >> stated.column >> of >> count >> in >> stated.sample;
    stated.column -= 1;
    stated.values = numbers_in_words(text.substr(std::min(colon + 1, text.size())));
    return stated;
}

const Type& type_of(const stats::Distribution& distribution) {
    return distribution_types()[distribution.form().index()];
}

using Members = std::vector<std::pair<std::string_view, double*>>;

/// Returns the members of an object of the type, in the order of its fields.
Members members_of(const Type& type, void* object) {
    Members members;
    for (const auto& field : type.fields)
        if (field.at != nullptr) members.emplace_back(field.name, static_cast<double*>(field.at(object)));
    return members;
}

/// Returns the figures of a distribution, in the order of its fields.
std::vector<std::pair<std::string_view, double>> figures(const stats::Distribution& distribution) {
    Form form = distribution.form();
    std::vector<std::pair<std::string_view, double>> found;
    void* const object = std::visit([](auto& own) -> void* { return &own; }, form);
    for (const auto& [name, number] : members_of(type_of(distribution), object)) found.emplace_back(name, *number);
    return found;
}

const stats::SampleColumn* sampled(const stats::Distribution& distribution) {
    return std::get_if<stats::SampleColumn>(&distribution.form());
}

}  // namespace

std::string stated_text(const stats::Distribution& distribution) {
    if (const auto column = stated_column(distribution))
        return fmt::format("sample {} of {} in {}:{}", column->column + 1, sampled(distribution)->sample->columns(),
                           column->sample, values_text(column->values));
    std::string text(name_of(distribution));
    for (const auto& [name, number] : figures(distribution)) text.append(" ").append(shortest(number));
    if (!distribution.has_ends())
        text += fmt::format(" within {} {}", shortest(distribution.low()), shortest(distribution.high()));
    return text;
}

std::optional<StatedColumn> stated_column(const stats::Distribution& distribution) {
    const auto* column = sampled(distribution);
    if (column == nullptr) return std::nullopt;
    const auto values = column->sample->column(column->column);
    return StatedColumn{column->column, hash_of_columns(*column->sample), {values.begin(), values.end()}};
}

std::variant<std::monostate, stats::Distribution, StatedColumn> distribution_in(std::string_view text) {
    const auto space = std::min(text.find(' '), text.size());
    const auto kind = text.substr(0, space);
    const auto rest = text.substr(space);
    if (kind == "sample") return column_in(rest);
    const auto type = std::ranges::find(distribution_types(), kind, &Type::name);
    if (type == distribution_types().end()) return {};
    const auto numbers = numbers_in_words(rest);  // "within" is none
    Form form;
    const auto members = members_of(*type, type->make(&form));
    const bool truncated = numbers.size() == members.size() + 3;
    if (!truncated && numbers.size() != members.size()) return {};
    for (std::size_t k = 0; k < members.size(); ++k) *members[k].second = numbers[k];
    if (!truncated) return stats::Distribution(form);
    return stats::Distribution(form, numbers[members.size() + 1], numbers[members.size() + 2]);
}

std::string_view name_of(const stats::Distribution& distribution) {
    return type_of(distribution).name;
}

std::map<std::string, double> figures_of(const stats::Distribution& distribution) {
    std::map<std::string, double> named;
    for (const auto& [name, number] : figures(distribution)) named.emplace(name, number);
    if (std::isfinite(distribution.low())) named.emplace("low", distribution.low());
    if (std::isfinite(distribution.high())) named.emplace("high", distribution.high());
    return named;
}

std::string_view without_values(std::string_view text) {
    return text.find(" sample ") == std::string_view::npos ? text : text.substr(0, text.find(':'));
}

std::string described(const stats::Distribution& distribution) {
    if (const auto* column = sampled(distribution))
        return column->sample->columns() == 1
                   ? fmt::format("sample of {} values", column->sample->rows())
                   : fmt::format("column {} of {} of a sample of {} rows", column->column + 1,
                                 column->sample->columns(), column->sample->rows());
    std::string text(name_of(distribution));
    for (const auto& [name, number] : figures(distribution)) text += fmt::format(", {} {:.6g}", name, number);
    return text;
}

}  // namespace grainsweep::campaign
