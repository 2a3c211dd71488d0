#include "sweep/study/responses.hpp"

#include "solver/plain_text.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/joint_column.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/schedule/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace grainsweep::study {
namespace {

using Cell = store::Table::Cell;

Value value_of(const Cell& cell) {
    const auto* word = std::get_if<std::string>(&cell);
    return word != nullptr ? Value{*word} : Value{number_of(cell)};
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

/// Reads the levels that occur, in the order of the campaign file, and their places among all.
void read_levels(FactorColumn& factor, const std::vector<Cell>& cells) {
    std::map<std::string, Value> values;
    std::vector<std::string> keys;
    keys.reserve(cells.size());
    for (const auto& cell : cells) {
        keys.push_back(key_of_cell(cell));
        values.try_emplace(keys.back(), value_of(cell));
    }
    std::map<std::string, std::size_t> index, place_of;
    for (const auto& level : factor.level_texts()) {
        const auto key = key_of_level(level);
        place_of.try_emplace(key, place_of.size());
        if (values.contains(key)) index.try_emplace(key, index.size());
    }
    for (const auto& key : keys) {
        index.try_emplace(key, index.size());
        place_of.try_emplace(key, place_of.size());
    }
    factor.seen.resize(index.size());
    factor.places.resize(index.size());
    const auto last = static_cast<double>(std::max<std::size_t>(place_of.size(), 2) - 1);
    for (const auto& [key, place] : index) {
        factor.seen[place] = values.at(key);
        factor.places[place] = static_cast<double>(place_of.at(key)) / last;
    }
    for (const auto& key : keys) factor.values.push_back(static_cast<double>(index.at(key)));
}

/// Reader of one factor, row by row: numbers if it is continuous, else cells until all rows are read.
class FactorReader {
public:
    /// `scene`: null if this program does not have the scene.
    FactorReader(const campaign::Factor& stated, const SceneInfo* scene) : factor_{stated} {
        if (const auto* parameter = scene == nullptr ? nullptr : scene->find_parameter(stated.name))
            factor_.meaning = parameter->meaning;
    }
    void add(const Cell& cell) {
        if (factor_.continuous())
            factor_.values.push_back(number_of(cell));
        else
            cells_.push_back(cell);
    }
    [[nodiscard]] FactorColumn take() {
        if (!factor_.continuous()) read_levels(factor_, cells_);
        return std::move(factor_);
    }

private:
    FactorColumn factor_;
    std::vector<Cell> cells_;
};

/// The points of a campaign's design; none where its rows were listed, or followed from answers.
designs::PointSet points_of_design(const Responses& responses) {
    const auto& design = responses.design();
    const bool listed = std::ranges::any_of(
        design.options, [](const designs::OptionSpec& option) { return option.kind == Field::Kind::array; });
    if (listed || design.grows || !design.sample) return {};
    return design.sample(campaign::request_of(responses.campaign));
}

/// The middle of the box of the row at which the factors stand; without such a row the share of the column alone.
double share_of_row(const Responses& responses, const stats::SampleColumn& own, std::size_t row, double value) {
    std::vector<double> values(own.sample->columns());
    for (const auto& factor : responses.factors)
        if (const auto* other = campaign::column_of(factor.distribution());
            other != nullptr && other->sample == own.sample)
            values[other->column] = factor.values[row];
    const auto place = own.sample->place_of(values);
    return place ? (*place)[own.column] : own.sample->cumulative(own.column, value);
}

/// Sets the coordinates of factors that take columns of one sample. They are the coordinates of the design's points.
/// For a setting that is not of the design they are the middle of the box of its row.
void add_joint_shares(Responses& responses) {
    designs::PointSet points;
    for (std::size_t j = 0; j < responses.factors.size(); ++j) {
        auto& factor = responses.factors[j];
        const auto* column = campaign::column_of(factor.distribution());
        if (column == nullptr) continue;
        if (points.size() == 0) points = points_of_design(responses);
        for (std::size_t row = 0; row < responses.rows(); ++row) {
            const auto point = static_cast<std::size_t>(responses.points[row]);
            factor.shares.push_back(point < points.size() ? points.point(point)[j]
                                                          : share_of_row(responses, *column, row, factor.values[row]));
        }
    }
}

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

// Columns of a campaign's view before its factors: point, sequence, replicate, case_id, seed, outcome, attempts,
// wall_seconds.
constexpr std::size_t point_column = 0, replicate_column = 2, case_column = 3, outcome_column = 5, first_factor = 8;

std::int64_t integer(const Cell& cell) {
    const auto* value = std::get_if<std::int64_t>(&cell);
    return value == nullptr ? 0 : *value;
}

/// A view calls an observable that bears the name of a factor "NAME_observed".
std::string observable_name(const std::string& column, const SceneInfo* scene) {
    constexpr std::string_view suffix = "_observed";
    if (scene == nullptr || scene->find_observable(column) != nullptr || !column.ends_with(suffix)) return column;
    return column.substr(0, column.size() - suffix.size());
}

std::optional<campaign::Outcome> outcome_of(const std::vector<Cell>& row) {
    const auto* outcome = std::get_if<std::string>(&row[outcome_column]);
    return outcome == nullptr ? std::nullopt : campaign::outcome_named(*outcome);
}

template <class T>
void reorder(std::vector<T>& column, std::span<const std::size_t> rows) {
    std::vector<T> moved;
    moved.reserve(column.size());
    for (const std::size_t row : rows) moved.push_back(std::move(column[row]));
    column = std::move(moved);
}

/// Rows with a final outcome before the others, each part in its old order.
void bring_settled_forward(Responses& responses) {
    std::vector<std::size_t> rows(responses.rows());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    std::ranges::stable_partition(rows, [&](std::size_t row) { return has_final_outcome(responses.outcomes[row]); });
    reorder(responses.points, rows);
    reorder(responses.replicates, rows);
    if (!responses.case_ids.empty()) reorder(responses.case_ids, rows);
    reorder(responses.outcomes, rows);
    for (auto& factor : responses.factors) reorder(factor.values, rows);
    for (auto& response : responses.observables) reorder(response.values, rows);
    std::vector<std::size_t> places(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) places[rows[i]] = i;
    for (auto& place : responses.repeated) place.row = places[place.row];
}

/// Rows of cases, by key. A place whose case was read before becomes one of the repeated places.
template <class Key>
class FirstPlaces {
public:
    bool is_first(const Key& key, std::int64_t point, Responses& responses) {
        const auto [known, fresh] = rows_.try_emplace(key, responses.rows());
        if (!fresh) responses.repeated.push_back({point, known->second});
        return fresh;
    }

private:
    std::unordered_map<Key, std::size_t> rows_;
};

void find_settled(Responses& responses) {
    const auto& record = responses.campaign;
    if (record.stopped_at) {
        responses.settled_points = *record.stopped_at;
        const auto end = std::ranges::lower_bound(responses.points, *record.stopped_at);
        responses.settled = static_cast<std::size_t>(end - responses.points.begin());
        return;
    }
    if (!responses.ordered_sample()) bring_settled_forward(responses);
    const auto open = std::ranges::find_if_not(responses.outcomes, has_final_outcome);
    responses.settled = static_cast<std::size_t>(open - responses.outcomes.begin());
    if (!responses.ordered_sample()) {
        responses.settled_points = responses.settled == 0 ? 0 : responses.points[responses.settled - 1] + 1;
        return;
    }
    responses.settled_points =
        open == responses.outcomes.end() ? responses.candidates : responses.points[responses.settled];
    // A point counts when all its repeats are there.
    while (responses.settled > 0 && responses.points[responses.settled - 1] >= responses.settled_points)
        --responses.settled;
}

}  // namespace

double FactorColumn::coordinate(std::size_t row) const {
    if (!shares.empty()) return shares[row];
    if (!continuous()) return places[static_cast<std::size_t>(values[row])];
    const double at = place(values[row]);
    return when.empty() || distribution() != nullptr ? at : std::clamp(at, 0.0, 1.0);
}

std::vector<std::string> FactorColumn::seen_texts() const {
    std::vector<std::string> texts;
    for (const auto& value : seen) {
        const auto* word = std::get_if<std::string>(&value);
        const auto file = word == nullptr ? std::nullopt : file_word(*word);
        texts.push_back(word == nullptr ? fmt::format("{:.6g}", std::get<double>(value))
                        : file          ? std::filesystem::path(file->path).filename().string()
                                        : *word);
    }
    return texts;
}

std::vector<double> FactorColumn::seen_numbers() const {
    std::vector<double> numbers;
    for (const auto& value : seen) {
        const auto* word = std::get_if<std::string>(&value);
        const auto number = word == nullptr ? std::optional(std::get<double>(value)) : number_in(*word);
        if (!number) return {};
        numbers.push_back(*number);
    }
    return numbers;
}

std::string factor_text(const FactorColumn& factor, std::size_t row) {
    const double value = factor.values[row];
    if (factor.continuous()) return std::isnan(value) ? "" : fmt::format("{:.6g}", value);
    return factor.seen_texts()[static_cast<std::size_t>(value)];
}

double number_of(const Cell& cell) {
    if (const auto* real = std::get_if<double>(&cell)) return *real;
    if (const auto* whole = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*whole);
    return no_value;
}

bool has_final_outcome(const std::optional<campaign::Outcome>& outcome) {
    return outcome && *outcome != campaign::Outcome::abandoned;
}

bool has_failed(const std::optional<campaign::Outcome>& outcome) {
    using enum campaign::Outcome;
    return has_final_outcome(outcome) && *outcome != completed && *outcome != skipped;
}

std::size_t Responses::without_value(const ResponseColumn& response) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(judged(response), [](double x) { return !std::isfinite(x); }));
}

std::vector<RepeatedPlace> Responses::settled_repeats() const {
    std::vector<RepeatedPlace> places;
    for (const auto& place : repeated)
        if (place.row < settled && place.point < settled_points) places.push_back(place);
    return places;
}

std::int64_t Responses::counted_points() const {
    if (ordered_sample()) return settled_points;
    const auto judged = std::span(points).first(settled);
    return static_cast<std::int64_t>(std::set<std::int64_t>(judged.begin(), judged.end()).size());
}

const ResponseColumn* Responses::deciding_observable() const {
    std::vector<std::string> asked;
    if (campaign.convergence) asked.push_back(campaign.convergence->observable);
    if (asked.empty() && design().rests_on) asked = design().rests_on(campaign::request_of(campaign));
    for (const auto& name : asked)
        if (const auto named = std::ranges::find(observables, name, &ResponseColumn::name); named != observables.end())
            return &*named;
    return nullptr;
}

const ResponseColumn* Responses::main_observable() const {
    if (const auto* deciding = deciding_observable()) return deciding;
    const auto has_a_value = [](const ResponseColumn& response) {
        return std::ranges::any_of(response.values, [](double x) { return std::isfinite(x); });
    };
    for (const auto& name : campaign::observables_as_written(campaign.text)) {
        const auto written = std::ranges::find(observables, name, &ResponseColumn::name);
        if (written != observables.end() && has_a_value(*written)) return &*written;
    }
    const auto measured = std::ranges::find_if(observables, has_a_value);
    if (measured != observables.end()) return &*measured;
    return observables.empty() ? nullptr : &observables.front();
}

const ResponseColumn& named_observable(std::span<const ResponseColumn> observables, std::string_view name,
                                       const store::CampaignRecord& campaign) {
    if (name.empty()) throw campaign::input_error("campaign " + campaign.name, "", "its scene measures no scalar");
    const auto found = std::ranges::find(observables, name, &ResponseColumn::name);
    if (found != observables.end()) return *found;
    std::vector<std::string> names;
    for (const auto& response : observables) names.push_back(response.name);
    throw campaign::input_error("--observable", fmt::format("'{}'", name),
                                fmt::format("scene '{}' measures no such scalar; it measures {}",
                                            shown_scene(campaign.scene), campaign::listed(names)),
                                campaign::nearest_word(name, names));
}

const ResponseColumn& Responses::observable(std::string_view name) const {
    const auto* main = name.empty() ? main_observable() : nullptr;
    return main != nullptr ? *main : named_observable(observables, name, campaign);
}

bool Responses::measures(std::string_view name) const {
    return name.empty() ? !observables.empty()
                        : std::ranges::find(observables, name, &ResponseColumn::name) != observables.end();
}

bool Responses::ordered_sample() const {
    const auto beginning = design().beginning;
    return beginning == designs::Beginning::sample ||
           (beginning == designs::Beginning::listed && campaign.convergence.has_value());
}

const designs::DesignInfo& Responses::design() const {
    static const designs::DesignInfo unknown;  // of an archive that a newer program wrote
    const auto* found = designs::find_design(campaign.design);
    return found == nullptr ? unknown : *found;
}

std::size_t Responses::finished() const {
    return static_cast<std::size_t>(std::ranges::count_if(outcomes, has_final_outcome));
}

std::int64_t Responses::dropped() const {
    std::set<std::int64_t> kept(points.begin(), points.end());
    for (const auto& place : repeated) kept.insert(place.point);
    return candidates - static_cast<std::int64_t>(kept.size());
}

bool repeats(const Responses& responses) {
    const auto sequences = static_cast<std::size_t>(responses.campaign.sequences);
    return schedule::independent_sequences(responses.campaign.design, sequences) > 1;
}

namespace {

std::vector<store::ConvergenceRow> judged_checks(const store::Store& store, const store::CampaignRecord& record) {
    if (!record.convergence || !record.convergence->traits().of_model) return {};
    return store.convergence(record.name, record.convergence->observable);
}

}  // namespace

Responses read_responses(const store::Store& store, const store::CampaignRecord& record) {
    Responses responses;
    responses.campaign = record;
    responses.judged_checks = judged_checks(store, record);
    responses.repeats_weigh = campaign::repeats_weigh(record.factors);
    const auto scene = find_scene(record.scene);
    std::vector<FactorReader> factors;
    for (const auto& stated : record.factors) factors.emplace_back(stated, scene.get());
    const auto first_observable = first_factor + factors.size();
    const auto declare = [&](const std::vector<std::string>& columns) {
        for (std::size_t column = first_observable; column < columns.size(); ++column) {
            ResponseColumn response;
            response.name = observable_name(columns[column], scene.get());
            if (const auto* spec = scene == nullptr ? nullptr : scene->find_observable(response.name)) {
                response.unit = spec->unit;
                response.meaning = spec->meaning;
            }
            responses.observables.push_back(std::move(response));
        }
    };
    FirstPlaces<std::string> places;
    const auto add = [&](const std::vector<Cell>& row) {
        if (!places.is_first(std::get<std::string>(row[case_column]), integer(row[point_column]), responses)) return;
        responses.points.push_back(integer(row[point_column]));
        responses.replicates.push_back(integer(row[replicate_column]));
        responses.case_ids.push_back(std::get<std::string>(row[case_column]));
        responses.outcomes.push_back(outcome_of(row));
        for (std::size_t j = 0; j < factors.size(); ++j) factors[j].add(row[first_factor + j]);
        for (std::size_t k = first_observable; k < row.size(); ++k)
            responses.observables[k - first_observable].values.push_back(number_of(row[k]));
    };
    store.query(store.rows_of(record.name) + " ORDER BY point, replicate", {}, declare, add);
    for (auto& factor : factors) responses.factors.push_back(factor.take());
    responses.groups = campaign::groups_of(record.factors);
    responses.group_names = campaign::group_names(record.factors);
    responses.folds = std::ranges::any_of(
        record.factors, [](const auto& factor) { return factor.step || factor.share || !factor.when.empty(); });

    responses.candidates = std::max(record.stored.candidates, campaign::points_of(record).value_or(0));
    find_settled(responses);
    add_joint_shares(responses);
    if (!record.imported_into)
        for (const auto& other : store.campaigns())
            if (other.imported_into == record.name && campaign::asks_the_same(other, record))
                responses.imported.push_back(read_responses(store, other));
    return responses;
}

Responses read_response(const store::Store& store, const store::CampaignRecord& record, const std::string& observable) {
    Responses responses;
    responses.campaign = record;
    responses.judged_checks = judged_checks(store, record);
    responses.repeats_weigh = campaign::repeats_weigh(record.factors);
    responses.candidates = record.stored.candidates;
    ResponseColumn response;
    response.name = observable;
    FirstPlaces<std::int64_t> places;
    for (const auto& placed : store.values(record.name, observable)) {
        if (!places.is_first(placed.case_key, placed.point, responses)) continue;
        responses.points.push_back(placed.point);
        responses.replicates.push_back(placed.replicate);
        responses.outcomes.push_back(placed.outcome);
        response.values.push_back(placed.value);
    }
    responses.observables.push_back(std::move(response));
    find_settled(responses);
    return responses;
}

std::vector<store::CampaignRecord> find_campaigns(const store::Store& store, std::string_view name) {
    auto records = store.campaigns();
    if (records.empty()) throw campaign::input_error("", "", "the database holds no campaign yet");
    if (name.empty()) return records;
    std::vector<std::string> names;
    for (const auto& record : records) names.push_back(record.name);
    std::erase_if(records, [&](const auto& record) { return record.name != name; });
    if (!records.empty()) return records;
    throw campaign::input_error("--campaign", fmt::format("'{}'", name),
                                fmt::format("the database holds {}", campaign::listed(names)),
                                campaign::nearest_word(name, names));
}

std::vector<std::pair<std::string, std::int64_t>> count_outcomes(const Responses& responses) {
    std::vector<std::pair<std::string, std::int64_t>> counts;
    for (const auto outcome : campaign::outcomes)
        counts.emplace_back(campaign::to_string(outcome),
                            std::ranges::count(responses.outcomes, std::optional(outcome)));
    counts.emplace_back("not yet", std::ranges::count(responses.outcomes, std::optional<campaign::Outcome>{}));
    return counts;
}

}  // namespace grainsweep::study
