#include "sweep/study/factor_reader.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/joint_column.hpp"
#include "sweep/campaign/stored_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

namespace grainsweep::study {
namespace {

using Cell = store::Table::Cell;

/// Returns a level's text; of a file, its name.
std::string column_level(const Cell& cell) {
    if (const auto* word = std::get_if<std::string>(&cell)) {
        const auto file = file_word(*word);
        return file ? std::filesystem::path(file->path).filename().string() : *word;
    }
    return fmt::format("{:.6g}", number_of(cell));
}

/// Equal for equal levels of any type in a view or an identity: numbers by value, files by contents.
std::string key_of_level(std::string_view word) {
    const auto number = any_number_in(word);
    return number ? campaign::shortest(*number) : std::string(word);
}

std::string key_of_cell(const Cell& cell) {
    const auto* word = std::get_if<std::string>(&cell);
    return word == nullptr ? campaign::shortest(number_of(cell)) : key_of_level(campaign::identity_text(*word));
}

/// Levels that occur, in the order of the campaign file, and their places among all.
void read_levels(FactorColumn& factor, const std::vector<Cell>& cells, const std::vector<std::string>& listed) {
    std::map<std::string, std::string> texts;
    std::vector<std::string> keys;
    keys.reserve(cells.size());
    for (const auto& cell : cells) {
        keys.push_back(key_of_cell(cell));
        texts.try_emplace(keys.back(), column_level(cell));
    }
    std::map<std::string, std::size_t> index, place_of;
    for (const auto& level : listed) {
        const auto key = key_of_level(level);
        place_of.try_emplace(key, place_of.size());
        if (texts.contains(key)) index.try_emplace(key, index.size());
    }
    for (const auto& key : keys) {
        index.try_emplace(key, index.size());
        place_of.try_emplace(key, place_of.size());
    }
    factor.levels.resize(index.size());
    factor.places.resize(index.size());
    const auto last = static_cast<double>(std::max<std::size_t>(place_of.size(), 2) - 1);
    for (const auto& [key, place] : index) {
        factor.levels[place] = texts.at(key);
        factor.places[place] = static_cast<double>(place_of.at(key)) / last;
    }
    for (const auto& key : keys) factor.values.push_back(static_cast<double>(index.at(key)));
}

const stats::SampleColumn* joint_column(const FactorColumn& factor) {
    return campaign::column_of(factor.distribution ? &*factor.distribution : nullptr);
}

/// The points of a campaign's design; none where its rows were listed, or followed from answers.
designs::PointSet points_of_design(const Responses& responses) {
    const auto& design = responses.design();
    const bool listed = std::ranges::any_of(design.options, [](const designs::OptionSpec& option) {
        return option.kind == designs::OptionSpec::Kind::rows;
    });
    if (listed || design.grows || !design.sample) return {};
    return design.sample(campaign::request_of(responses.campaign));
}

/// The middle of the box of the row at which the factors stand; without such a row the share of the column alone.
double share_of_row(const Responses& responses, const stats::SampleColumn& own, std::size_t row, double value) {
    std::vector<double> values(own.sample->columns());
    for (const auto& factor : responses.factors)
        if (const auto* other = joint_column(factor); other != nullptr && other->sample == own.sample)
            values[other->column] = factor.values[row];
    const auto place = own.sample->place_of(values);
    return place ? (*place)[own.column] : own.sample->cumulative(own.column, value);
}

}  // namespace

FactorReader::FactorReader(campaign::StatedFactor stated, const SceneInfo* scene) : stated_(std::move(stated)) {
    factor_.name = stated_.name;
    factor_.conditional = !stated_.when.empty();
    factor_.stepped = stated_.step.has_value();
    if (const auto* parameter = scene == nullptr ? nullptr : scene->find_parameter(factor_.name)) {
        factor_.unit = parameter->unit;
        factor_.meaning = parameter->meaning;
    }
    if (stated_.between) {
        factor_.log = stated_.between->scale == campaign::Scale::log;
        factor_.low = stated_.between->low;
        factor_.high = stated_.between->high;
    }
    if (stated_.distribution) {
        factor_.distribution = stated_.distribution;
        factor_.log = std::holds_alternative<stats::Lognormal>(stated_.distribution->form());
        std::tie(factor_.low, factor_.high) = stated_.distribution->range();
    }
}

void FactorReader::add(const Cell& cell) {
    if (stated_.continuous())
        factor_.values.push_back(number_of(cell));
    else
        cells_.push_back(cell);
}

FactorColumn FactorReader::take() {
    if (!stated_.continuous()) read_levels(factor_, cells_, stated_.levels);
    return std::move(factor_);
}

void add_joint_shares(Responses& responses) {
    designs::PointSet points;
    for (std::size_t j = 0; j < responses.factors.size(); ++j) {
        auto& factor = responses.factors[j];
        const auto* column = joint_column(factor);
        if (column == nullptr) continue;
        if (points.size() == 0) points = points_of_design(responses);
        for (std::size_t row = 0; row < responses.rows(); ++row) {
            const auto point = static_cast<std::size_t>(responses.points[row]);
            factor.shares.push_back(point < points.size() ? points.point(point)[j]
                                                          : share_of_row(responses, *column, row, factor.values[row]));
        }
    }
}

double FactorColumn::coordinate(std::size_t row) const {
    const double value = values[row];
    if (!shares.empty()) return shares[row];
    if (!continuous()) return places[static_cast<std::size_t>(value)];
    if (distribution) return distribution->cumulative(value);
    const double place = log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return conditional ? std::clamp(place, 0.0, 1.0) : place;
}

std::string factor_text(const FactorColumn& factor, std::size_t row) {
    const double value = factor.values[row];
    if (factor.continuous()) return std::isnan(value) ? "" : fmt::format("{:.6g}", value);
    return factor.levels[static_cast<std::size_t>(value)];
}

}  // namespace grainsweep::study
