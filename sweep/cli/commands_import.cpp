// import: results of cases that were computed elsewhere.
#include "sweep/campaign/experiments.hpp"
#include "sweep/campaign/file_contents.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/old_results.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/cli/adopt.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/cli/run_campaign.hpp"
#include "sweep/report/document.hpp"
#include "sweep/report/next_command.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/runs.hpp"
#include "sweep/schedule/growth.hpp"
#include "sweep/store/campaign_name.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/corrected.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

namespace fs = std::filesystem;
using campaign::OldResult;
using report::Document;
using report::Format;
using store::Store;

struct ImportRequest {
    campaign::OldResultsRequest results;
    std::filesystem::path config;
    std::filesystem::path database;  ///< empty: NAME.db in the current folder
    std::string experiment;          ///< of a calibration with several
    std::string accuracy;            ///< setting of the numerics, for a campaign with an error goal
    bool network_disk = false;       ///< the database may lie on a network file system
};

struct ImportReport {
    std::string campaign;  ///< NAME; of an experiment or a setting of the numerics NAME_EXPERIMENT or NAME_SETTING
    std::string beside;    ///< campaign of the cases that the design does not place
    std::filesystem::path database;
    std::size_t placed = 0;      ///< imported cases of the design
    std::size_t others = 0;      ///< imported cases beside it
    std::size_t known = 0;       ///< cases that the database had with these values
    std::size_t unanswered = 0;  ///< lines without an answer, which are left out
};

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

std::string name_of_imports(const std::string& campaign) {
    return campaign + "_imported";
}

/// Case of a line.
struct ImportedCase {
    const OldResult* result = nullptr;
    campaign::Case question;
    bool of_design = false;
};

/// Stores the lines of a file as answers of the campaign. A case that the design places is settled by its line. The
/// others become the campaign NAME_imported beside it, whose cases models use and statistics do not. Nothing is stored
/// if a line contradicts another line, or an answer in the database: throws InputError with line and both values.
class Import {
public:
    explicit Import(const ImportRequest& request)
        : request_(request), campaign_(read_campaign()), file_(request.results.file.filename().string()) {
        database_ = request.database.empty() ? fs::path(name_in_file_ + ".db") : request.database;
        if (const auto folder = fs::absolute(database_).parent_path(); !fs::is_directory(folder))
            throw campaign::input_error("DB", database_.string(),
                                        fmt::format("there is no folder '{}'", folder.string()));
    }

    ImportReport operator()() {
        if (const auto store = Store::read_if_begun(database_)) {
            continue_stored(*store);
            gather(&*store);
        } else {
            gather(nullptr);
        }
        write();
        return {campaign_.name,
                name_of_imports(campaign_.name),
                database_,
                static_cast<std::size_t>(std::ranges::count(cases_, true, &ImportedCase::of_design)),
                static_cast<std::size_t>(std::ranges::count(cases_, false, &ImportedCase::of_design)),
                known_,
                old_.unanswered};
    }

private:
    [[nodiscard]] campaign::Campaign read_campaign() {
        const auto& config = request_.config;
        const bool goal = campaign::states_goal(config);
        if (!goal) refuse_needless("--accuracy", request_.accuracy, "the campaign has no error goal");
        const auto experiments = campaign::read_experiment_names(config);
        if (experiments.empty())
            refuse_needless("--experiment", request_.experiment, "the campaign is no calibration with experiments");
        else
            require_word("--experiment", request_.experiment, experiments, "lines belong to one of its experiments");
        auto read = read_with_program(config, request_.experiment);
        name_in_file_ = campaign::name_in_file(campaign::identity_of(read));
        return goal ? at_one_setting(read) : read;
    }
    static void refuse_needless(const char* option, const std::string& word, const std::string& why) {
        if (!word.empty()) throw campaign::input_error(option, word, why + "; leave the option out");
    }
    static void require_word(const char* option, const std::string& word, const std::vector<std::string>& words,
                             const std::string& why) {
        if (std::ranges::find(words, word) != words.end()) return;
        throw campaign::input_error(option, word, fmt::format("must be one of {}: {}", campaign::listed(words), why),
                                    campaign::nearest_word(word, words));
    }
    /// Returns the campaign of the first cases at a setting, which a run with the goal begins with. Later cases are the
    /// same as those beside it.
    [[nodiscard]] campaign::Campaign at_one_setting(const campaign::Campaign& asked) const {
        std::vector<std::string> settings;
        for (const auto& name : std::views::keys(asked.scene().accuracy)) settings.push_back(name);
        require_word("--accuracy", request_.accuracy, settings, "lines belong to one setting of the numerics");
        const auto points = pilot_rounds * designs::independent_sequences(asked.design, asked.request);
        return parse_with_program(
            campaign::at_setting(asked.text, {.name = study::name_at(asked.name, request_.accuracy),
                                              .setting = request_.accuracy,
                                              .points = points,
                                              .numerical = asked.common_random_numbers,
                                              .keeps_goal = false}),
            request_.config);
    }
    /// Continues the campaign as the database has it: order of its factors, points that follow from answers.
    void continue_stored(const Store& store) {
        campaign::asked_in(request_.config, [&] {
            refuse_another_program(store, campaign_, database_);
            return 0;
        });
        (void)campaign::reorder_factors(campaign_, store.factor_order(campaign_.name));
        if (designs::design_named(campaign_.design).calibrates)
            for (const auto& name : names_of_calibration())
                if (std::ranges::count(store.campaigns(), name, &store::CampaignRecord::name) > 0 &&
                    has_begun(store, name))
                    throw campaign::input_error(request_.config.string(), "",
                                                fmt::format("the calibration '{}' has begun, and old results would "
                                                            "change its points: import them into a campaign of "
                                                            "another name",
                                                            name));
        while (campaign::asked_in(request_.config, [&] { return schedule::grow(campaign_, store); })) {
        }
    }
    /// Returns this campaign and those of the other experiments.
    [[nodiscard]] std::vector<std::string> names_of_calibration() const {
        const auto identity = campaign::identity_of(campaign_);
        std::vector<std::string> names = {campaign_.name};
        for (const auto& experiment : campaign::experiments_of(identity))
            if (const auto name = campaign::name_beside(identity, experiment); name != campaign_.name)
                names.push_back(name);
        return names;
    }
    [[nodiscard]] static bool has_begun(const Store& store, const std::string& name) {
        return std::ranges::any_of(store.placement(name).states, [](const auto& state) { return state.attempts > 0; });
    }
    /// Reads the file, and finds the case of every line. `store`: nullptr without a database.
    void gather(const Store* store) {
        const auto filter = campaign::asked_in(request_.config, [&] {
            store::check_campaign_name(campaign_.name);
            return store::make_filter(campaign_.where, campaign::filter_names(campaign_));
        });
        design_ = campaign::asked_in(request_.config, [&] { return campaign::unfold(campaign_, filter); });
        old_ = campaign::read_old_results(request_.results, campaign_, filter);
        read_places();
        std::map<campaign::CaseId, const OldResult*> seen;
        for (const auto& result : old_.results) {
            auto one = case_of(result);
            const auto [earlier, fresh] = seen.try_emplace(one.question.id, &result);
            if (!fresh) {
                refuse_contradiction(*earlier->second, result);
                ++known_;
            } else if (store != nullptr && is_stored(*store, one)) {
                ++known_;
            } else {
                cases_.push_back(std::move(one));
            }
        }
    }
    /// Factor values at the places of the design.
    void read_places() {
        Inputs inputs;
        for (std::size_t i = 0; i < design_.size(); ++i) {
            design_.inputs(i, inputs);
            auto& row = places_.emplace_back();
            for (const auto& factor : campaign_.space.factors) row.push_back(inputs.at(factor.name));
        }
        for (std::size_t j = 0; j < campaign_.space.factors.size(); ++j) {
            auto sorted = sorted_by(j);
            const auto distinct = [](const auto& all) {
                std::size_t count = 0;
                for (std::size_t k = 0; k < all.size(); ++k) count += k == 0 || all[k].first != all[k - 1].first;
                return count;
            };
            if (distinct(sorted) > distinct(sorted_)) sorted_ = std::move(sorted), sorted_by_ = j;
        }
    }
    /// Returns the places with the numbers of a factor, ascending; none if it has words.
    [[nodiscard]] std::vector<std::pair<double, std::size_t>> sorted_by(std::size_t j) const {
        std::vector<std::pair<double, std::size_t>> sorted;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const auto number = campaign::coerced(places_[i][j], Value{0.0});
            if (!std::holds_alternative<double>(number)) return {};
            sorted.emplace_back(std::get<double>(number), i);
        }
        std::ranges::sort(sorted);
        return sorted;
    }
    [[nodiscard]] static bool is_same(const Value& a, const Value& b, double tolerance) {
        const auto x = campaign::coerced(a, Value{0.0}), y = campaign::coerced(b, Value{0.0});
        if (!std::holds_alternative<double>(x) || !std::holds_alternative<double>(y)) return a == b;
        return std::abs(std::get<double>(x) - std::get<double>(y)) <= tolerance;
    }
    [[nodiscard]] bool is_at(const OldResult& result, std::size_t i) const {
        if (design_.place(i).replicate != static_cast<std::uint32_t>(result.repeat.value_or(0))) return false;
        for (std::size_t j = 0; j < result.row.size(); ++j)
            if (!is_same(result.row[j], places_[i][j], result.tolerances[j])) return false;
        return true;
    }
    /// Returns the first place of the design with the inputs of a line.
    [[nodiscard]] std::optional<std::size_t> place_of(const OldResult& result) const {
        std::optional<std::size_t> first;
        const auto take = [&](std::size_t i) {
            if ((!first || i < *first) && is_at(result, i)) first = i;
        };
        if (sorted_.empty()) {
            for (std::size_t i = 0; i < design_.size(); ++i) take(i);
            return first;
        }
        const double number = std::get<double>(campaign::coerced(result.row[sorted_by_], Value{0.0}));
        const double tolerance = result.tolerances[sorted_by_];
        for (auto at = std::ranges::lower_bound(sorted_, std::pair(number - tolerance, std::size_t{0}));
             at != sorted_.end() && at->first <= number + tolerance; ++at)
            take(at->second);
        return first;
    }
    [[nodiscard]] ImportedCase case_of(const OldResult& result) const {
        if (const auto place = place_of(result)) return {&result, design_.question(*place), true};
        const auto inputs = campaign_.space.at(std::span<const Value>(result.row));
        const auto seed = campaign::case_seed(campaign_, inputs, result.repeat.value_or(0));
        return {&result, campaign::make_case(campaign_.scene(), inputs, seed), false};
    }
    [[noreturn]] void refuse_value(const OldResult& result, const std::string& name, const std::string& value,
                                   const std::string& other) const {
        throw campaign::input_error(fmt::format("{}: line {}, column '{}'", file_, result.line, name), value,
                                    other + "; a repeat of a case needs a number in a column 'replicate'");
    }
    void refuse_contradiction(const OldResult& first, const OldResult& second) const {
        if (first.outcome != second.outcome)
            refuse_value(second, "outcome", std::string(to_string(second.outcome)),
                         fmt::format("line {} has the same inputs and {}", first.line, to_string(first.outcome)));
        compare(second, [&](const std::string& name) {
            const auto found = first.scalars.find(name);
            return std::pair(found == first.scalars.end() ? not_measured : found->second.value,
                             fmt::format("line {} has the same inputs and", first.line));
        });
    }
    /// Refuses a value that differs from another value of its case by more than it is written with.
    template <class Other>
    void compare(const OldResult& result, const Other& other) const {
        for (const auto& observable : campaign_.scene().observables) {
            if (observable.shape != Shape::scalar) continue;
            const auto& name = observable.name;
            const auto found = result.scalars.find(name);
            const double value = found == result.scalars.end() ? not_measured : found->second.value;
            const auto [expected, words] = other(name);
            if (std::isnan(value) && std::isnan(expected)) continue;
            if (found != result.scalars.end() && std::abs(value - expected) <= found->second.tolerance) continue;
            const auto text = [](double x) { return std::isnan(x) ? std::string("no value") : campaign::shortest(x); };
            refuse_value(result, name, text(value), fmt::format("{} {}", words, text(expected)));
        }
    }
    /// Returns whether the database has this answer. Throws InputError if it has another.
    [[nodiscard]] bool is_stored(const Store& store, const ImportedCase& one) const {
        if (!store.is_settled(one.question.id)) return false;
        const auto stored = store.result(one.question.id);
        if (!stored) return false;
        const auto words = fmt::format("case {} in '{}', {}, has", one.question.id.substr(0, 12), database_.string(),
                                       stored->imported ? fmt::format("imported from '{}', line {}",
                                                                      stored->imported->file, stored->imported->line)
                                                        : "computed by a run");
        if (stored->outcome != one.result->outcome)
            refuse_value(*one.result, "outcome", std::string(to_string(one.result->outcome)),
                         fmt::format("{} {}", words, to_string(stored->outcome)));
        compare(*one.result, [&](const std::string& name) {
            const auto found = stored->observations.scalars.find(name);
            return std::pair(found == stored->observations.scalars.end() ? not_measured : found->second, words);
        });
        return true;
    }

    void write() {
        campaign::enter_contents(old_.text);
        const campaign::CampaignFile used{"import", file_, old_.hash, {}};
        campaign_.files.push_back(used);
        Store store(database_, Store::Mode::create,
                    request_.network_disk ? Store::Disk::network : Store::Disk::found_out);
        enrol(store, campaign_, design_);
        std::vector<campaign::PlacedCase> beside;
        for (const auto& one : cases_)
            if (!one.of_design) beside.push_back({one.question, 0, 0, one.result->repeat.value_or(0)});
        if (!beside.empty()) enrol_beside(store, std::move(beside), used);
        store.group([&] { finish(store, !beside_.empty()); }, Store::Origin::imported);
        store.remember_file();
    }
    void enrol(Store& store, const campaign::Campaign& campaign, const campaign::Cases& cases) const {
        campaign::asked_in(request_.config, [&] { return store.enrol(campaign, cases, provenance()); });
    }
    /// Enters the cases that no design places, after those of earlier imports.
    void enrol_beside(Store& store, std::vector<campaign::PlacedCase> fresh, const campaign::CampaignFile& used) {
        const auto name = name_of_imports(campaign_.name);
        const auto records = store.campaigns();
        const auto record = std::ranges::find(records, name, &store::CampaignRecord::name);
        if (record != records.end()) {
            // An import that was killed here has left its cases without results and unmarked.
            if (record->imported_into != campaign_.name && (record->imported_into || has_begun(store, name)))
                throw campaign::input_error("DB", database_.string(),
                                            fmt::format("it has a campaign '{}' that is no import", name));
            const auto placed = store.placement(name);
            for (std::size_t i = 0; i < placed.places.size(); ++i)
                beside_.push_back({store.find_case(campaign::id_of(placed.hashes[i])).value(), placed.places[i].point,
                                   0, placed.places[i].replicate});
        }
        std::map<std::vector<Value>, std::int64_t> points;  // of each setting
        std::vector<std::vector<Value>> rows;
        const auto row_of = [&](const campaign::PlacedCase& one) {
            std::vector<Value> row;
            for (const auto& factor : campaign_.space.factors) row.push_back(one.question.inputs.at(factor.name));
            return row;
        };
        const auto point_of = [&](const campaign::PlacedCase& one) {
            const auto [found, unknown] = points.try_emplace(row_of(one), static_cast<std::int64_t>(rows.size()));
            if (unknown) rows.push_back(found->first);
            return found->second;
        };
        for (const auto& one : beside_) (void)point_of(one);
        for (auto& one : fresh) {
            one.point = point_of(one);
            beside_.push_back(std::move(one));
        }
        std::ranges::sort(beside_, {}, [](const auto& one) { return std::pair(one.point, one.replicate); });
        auto campaign = campaign_;
        campaign.name = name;
        campaign.text = campaign::further_points(
            campaign_.text, name, fmt::format("Cases imported into '{}'; no run computes them.", campaign_.name), rows,
            0);
        campaign.design = "list";
        campaign.request.options = {{"rows", rows}};
        campaign.request.grown.reset();
        campaign.replicates = 1;
        for (const auto& one : beside_) campaign.replicates = std::max(campaign.replicates, one.replicate + 1);
        campaign.convergence.reset();
        campaign.files.push_back(used);
        enrol(store, campaign, campaign::Cases(beside_));
    }
    void finish(Store& store, bool has_others) const {
        for (const auto& one : cases_) {
            const auto logged = store.attempts(one.question.id);
            campaign::CaseResult result;
            result.attempt = {one.question.id, logged.empty() ? 1 : logged.back().number + 1};
            result.outcome = one.result->outcome;
            result.message = fmt::format("imported from {}, line {} (contents {})", file_, one.result->line,
                                         old_.hash.substr(0, 12));
            for (const auto& [name, number] : one.result->scalars)
                result.observations.scalars.emplace(name, number.value);
            result.cost.wall_seconds = result.cost.cpu_seconds = result.cost.particle_steps = not_measured;
            result.imported = campaign::ImportedLine{file_, old_.hash, static_cast<std::int64_t>(one.result->line)};
            store.begin(result.attempt);
            (void)store.finish(result);
        }
        if (has_others) store.mark_imported(name_of_imports(campaign_.name), campaign_.name);
    }

    const ImportRequest& request_;
    std::string name_in_file_;  ///< of the campaign, without experiment or setting
    campaign::Campaign campaign_;
    std::string file_;
    fs::path database_;
    campaign::Cases design_;
    std::vector<std::vector<Value>> places_;  ///< factor values at each place of the design
    /// The places by the numbers of the factor that has most of them; empty if all have words.
    std::vector<std::pair<double, std::size_t>> sorted_;
    std::size_t sorted_by_ = 0;
    campaign::OldResults old_;
    std::vector<ImportedCase> cases_;  ///< that are not in the database
    std::vector<campaign::PlacedCase> beside_;
    std::size_t known_ = 0;
};

struct ImportArguments : ImportRequest {
    std::string decimal;
};

std::string said(const ImportReport& report, const std::string& file) {
    const auto all = report.placed + report.others;
    std::string text = fmt::format("{}: {} case{} imported into '{}'", file, all, all == 1 ? "" : "s", report.campaign);
    if (report.placed > 0 || report.others > 0) text += fmt::format(": {} of its design", report.placed);
    if (report.others > 0)
        text +=
            fmt::format(", {} beside it in '{}', which models use and moments do not", report.others, report.beside);
    if (report.known > 0) text += fmt::format("; {} were there before", report.known);
    if (report.unanswered > 0) text += fmt::format("; {} lines without an answer are left out", report.unanswered);
    return text;
}

int import_file(ImportArguments& request, Format format) {
    if (!request.decimal.empty() && request.decimal != "comma" && request.decimal != "point")
        throw campaign::input_error("--decimal", request.decimal, "must be comma or point",
                                    campaign::nearest_word(request.decimal, std::array{"comma", "point"}));
    request.results.decimal_comma = request.decimal == "comma";
    request.results.folder = request.config.parent_path();
    const auto report = Import(request)();
    const auto count = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    Document shown{
        .rows = {report::columns_of(report::results::import),
                 {{report.campaign, report.database.string(), count(report.placed + report.others),
                   count(report.placed), count(report.others), count(report.known), count(report.unanswered)}}}};
    shown.value = report::to_json(shown.rows, 0);
    const auto file = report::shell_word(report.database.string());
    shown.say(said(report, request.results.file.filename().string()));
    shown.say(fmt::format(
        "\ndatabase {}\nnext: {}", report.database.string(),
        report::next_command(fmt::format("run {} --db {}", report::shell_word(request.config.string()), file))));
    shown.say("      " + report::next_command(fmt::format("sensitivity {}", file)));
    report::write(std::cout, shown, format);
    return 0;
}

void declare_import(Parser& parser, ImportArguments& request) {
    parser.add_option("FILE.csv", request.results.file,
                      "table with a line for each case; its header names the columns");
    parser.add_option("CONFIG", request.config, "campaign file whose cases they are");
    parser.add_option("[DB]", request.database, "database; default: NAME.db in the current folder");
    parser.add_option("--experiment NAME", request.experiment,
                      "experiment of the lines, for a calibration with several");
    parser.add_option("--accuracy WORD", request.accuracy,
                      "setting of the numerics of the lines, for a campaign with an error goal");
    parser.add_option("--decimal WORD", request.decimal, "comma: numbers have decimal commas; default: point");
    parser.add_option("--ignore COLUMN", request.results.ignored, "column that is not read; may be repeated")
        ->allow_extra_args(false);
    parser.add_flag("--partial", request.results.partial,
                    "accept a file that lacks columns of some scalar observables");
    parser.add_flag("--network-disk", request.network_disk,
                    "allow a database on a network file system; only one node may write it at a time");
}

}  // namespace

std::vector<Command> import_commands() {
    return {command<ImportArguments>("import", "stores results that were computed elsewhere, with their origin",
                                     declare_import, import_file)};
}

}  // namespace grainsweep::cli
