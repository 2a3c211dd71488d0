// converge, sensitivity, report: results from stored answers.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/cli/stored_case.hpp"
#include "sweep/report/convergence_tables.hpp"
#include "sweep/report/file_size.hpp"
#include "sweep/report/film.hpp"
#include "sweep/report/film_choice.hpp"
#include "sweep/report/findings.hpp"
#include "sweep/report/influence_tables.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/catalogues.hpp"
#include "sweep/report/watch_page.hpp"
#include "sweep/store/store.hpp"
#include "sweep/workers/compute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

using report::Document;
using report::Format;
using store::Store;
using study::Responses;
namespace fs = std::filesystem;

constexpr std::int64_t frames = 36;
constexpr report::FilmLimits limits{.spheres = 8000, .bytes = 2'500'000, .columns = false};

/// Returns at most `count` films of cases that span the results, computed again in this process. They are smaller than
/// the films of `replay --watch`: fewer frames and spheres, only velocity as colour. Prints on standard error which
/// case is computed, and which cases are left out and why.
std::vector<report::PageFilm> films_of(const store::Store& store, std::int64_t count) {
    std::vector<report::PageFilm> films;
    const auto chosen = report::cases_to_watch(store, static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const auto& [campaign, id, says] = chosen[k];
        const auto leave_out = [&, &name = campaign](std::string_view why) {
            std::cerr << fmt::format("grainsweep: no film of case {} of {}: it {}\n", id.substr(0, 10), name, why);
        };
        std::cerr << fmt::format("film {} of {}: {}, case {} of {}\n", k + 1, chosen.size(), says, id.substr(0, 10),
                                 campaign);
        const campaign::Case stored = store.find_case(id).value();
        if (const auto why = why_not_again(stored); !why.empty()) {
            leave_out(why);
            continue;
        }
        const campaign::Case question = as_asked_today(stored);
        store.enter_files_of(question);
        report::Film film(limits);
        const workers::Camera camera{frames, [&film](const Scene& scene) { film.add(scene.snapshot(), scene.time()); },
                                     [&film](const std::vector<std::size_t>& pictures) { film.keep(pictures); }};
        NoArtefacts artefacts;
        const auto result = workers::compute(
            question, 1, artefacts, std::nullopt, [](const Scene&) { return true; }, camera);
        if (film.shows_anything())
            films.push_back({campaign, id, says, film.bytes(report::about_case(question, result.value()))});
        else
            leave_out(fmt::format("belongs to scene '{}', which shows no particles and no flow",
                                  shown_scene(question.scene)));
    }
    return films;
}

/// Returns a drawing of the machine of each campaign that has one, with the inputs of its median case. `campaigns`:
/// number of campaigns of the store.
std::vector<report::PageFilm> machines_of(const store::Store& store, std::size_t campaigns) {
    constexpr std::int64_t pictures = 24;
    constexpr report::FilmLimits small{.spheres = 3000, .bytes = 300'000};
    std::vector<report::PageFilm> drawings;
    for (const auto& [campaign, id, says] : report::cases_to_watch(store, campaigns)) {
        const campaign::Case stored = store.find_case(id).value();
        const auto machine = campaign::known_machine(stored.scene);
        if (machine == nullptr) continue;
        store.enter_files_of(stored);
        report::Film film(small);
        try {
            const auto empty =
                campaign::draw_machine(*machine, stored.inputs, pictures,
                                       [&film](const Snapshot& picture, double time) { film.add(picture, time); });
            const auto about = report::about_machine(*find_scene(stored.scene), stored.inputs, empty);
            drawings.push_back({campaign, "", "the machine before it runs", film.bytes(about)});
        } catch (const campaign::InputError&) {  // a machine that this version reads otherwise
        }
    }
    return drawings;
}

/// Which campaign and which observable of a database.
struct Subject {
    std::string database, campaign, observable;
    std::vector<std::string> levels;  ///< of `converge`
    std::string without;              ///< of `converge`: above, below, or empty
    bool check = false;               ///< of `converge`: the exit code says whether everything shown has converged
};

/// Of every campaign the subject names; those whose scene has not the observable are passed over where no campaign is
/// named. `found_by` answers for a campaign whose design finds something of its own, before its observable is looked
/// for.
template <class FoundBy, class Study>
std::vector<Document> study_each(const Store& store, const Subject& subject, FoundBy found_by, Study answer) {
    std::vector<Document> documents;
    auto records = study::find_campaigns(store, subject.campaign);
    // Cases that were computed elsewhere are no sample of the ranges.
    if (subject.campaign.empty()) std::erase_if(records, [](const auto& one) { return one.imported_into.has_value(); });
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto responses = study::read_responses(store, records[i]);
        const bool measures = responses.measures(subject.observable);
        if (auto found = measures || subject.observable.empty() ? found_by(responses) : std::nullopt)
            documents.push_back(std::move(*found));
        else if (measures || (i + 1 == records.size() && documents.empty()))
            documents.push_back(answer(responses, responses.observable(subject.observable)));
    }
    return documents;
}

std::vector<stats::Level> levels_of(std::span<const std::string> words) {
    std::vector<stats::Level> levels;
    for (const auto& word : words) {
        const auto level = stats::level_named(word);
        if (!level)
            throw campaign::input_error(
                "--statistic", word,
                "must be quantile:P with P between 0 and 1, above:T or below:T, such as quantile:0.9");
        levels.push_back(*level);
    }
    return levels;
}

study::WithoutValue without_value(const std::string& word) {
    if (word.empty()) return study::WithoutValue::left_out;
    if (word == "above") return study::WithoutValue::above;
    if (word == "below") return study::WithoutValue::below;
    throw campaign::input_error("--without-value", word, "must be above or below",
                                campaign::nearest_word(word, std::array{"above", "below"}));
}

int converge(const Subject& subject, Format format) {
    const auto levels = levels_of(subject.levels);
    const auto without = without_value(subject.without);
    const Store store(subject.database, Store::Mode::read);
    const auto found_by = [&](const Responses& responses) { return report::findings_document(store, responses); };
    const auto documents =
        study_each(store, subject, found_by, [&](const Responses& responses, const study::ResponseColumn& response) {
            return report::convergence_document(store, responses, response, format, levels, without);
        });
    report::write(std::cout, documents, format);
    return subject.check && !std::ranges::all_of(documents, &Document::converged) ? 1 : 0;
}

int sensitivity(const Subject& subject, Format format) {
    const Store store(subject.database, Store::Mode::read);
    const auto nothing = [](const Responses&) { return std::optional<Document>(); };
    const auto documents =
        study_each(store, subject, nothing, [&](const Responses& responses, const study::ResponseColumn& response) {
            return report::influence_document(responses, response, format);
        });
    report::write(std::cout, documents, format);
    return 0;
}

struct ReportRequest {
    std::string database, output;
    std::vector<std::string> others;
    std::int64_t watched = 0;
    report::PageModels models;
};

int write_report(const ReportRequest& request, Format format) {
    std::vector<std::string> databases = {request.database};
    databases.insert(databases.end(), request.others.begin(), request.others.end());
    auto output = request.output;
    std::vector<Store> stores;
    stores.reserve(databases.size());
    std::vector<report::PageSource> sources;
    for (const auto& name : databases) {
        stores.emplace_back(name, Store::Mode::read);
        sources.push_back({&stores.back(), fs::path(name).filename().string()});
    }
    const std::string& database = databases.front();
    const bool to_standard_output = output == "-";
    if (output.empty()) output = fs::path(database).filename().replace_extension(".html").string();
    if (!to_standard_output)
        for (const auto& name : databases) check_page_file("-o", output, name);
    auto films = films_of(stores.front(), request.watched);
    std::size_t film_bytes = 0;
    for (const auto& film : films) film_bytes += film.bytes.size() / 3 * 4;
    if (!films.empty())
        std::cerr << fmt::format("{} films: {} of the page\n", films.size(), report::size_text(film_bytes));
    for (const Store& store : stores)
        for (auto& drawing : machines_of(store, store.campaigns().size())) films.push_back(std::move(drawing));
    if (to_standard_output) {  // the page is the answer: nothing else goes there
        report::write_page(std::cout, sources, films, request.models);
        return 0;
    }
    std::ostringstream stream;
    report::write_page(stream, sources, films, request.models);
    const std::string page = std::move(stream).str();
    write_page_file(output, page);
    const auto size = static_cast<std::int64_t>(page.size());
    Document shown{.rows = {report::columns_of(report::results::report_file), {{output, size}}}};
    shown.value = report::to_json(shown.rows, 0);
    shown.say(fmt::format("{} ({}): open it in a browser", output, report::size_text(page.size())));
    report::write(std::cout, shown, format);
    return 0;
}

/// One observable of one campaign, or of all.
void declare_sensitivity(Parser& parser, Subject& subject) {
    parser.add_option("DB", subject.database, "the database");
    parser.add_option("--campaign NAME", subject.campaign, "name of a campaign; default: all");
    parser.add_option("--observable NAME", subject.observable,
                      "scalar observable; default: that of the convergence rule, else the scene's first");
}

void declare_converge(Parser& parser, Subject& subject) {
    declare_sensitivity(parser, subject);
    parser.add_option("--statistic WORD", subject.levels,
                      "quantile:P, or above:T or below:T: the probability to lie beyond T, in the unit of the "
                      "observable; default: the quantiles 0.05, 0.25, 0.5, 0.75, 0.95");
    parser.add_option("--without-value WORD", subject.without,
                      "above or below: in quantiles and probabilities a completed case without a value, such as the "
                      "flow time of a jam, counts as above or below every value; default: it is left out");
    parser.add_flag("--check", subject.check,
                    "exit with 1 unless everything shown has converged by its campaign's rule; without a rule a "
                    "campaign has not");
}

void declare_report(Parser& parser, ReportRequest& request) {
    parser.add_option("DB", request.database, "the database");
    parser.add_option("-o,--output FILE", request.output,
                      "the page; default: the database's name with .html, in the current folder; -: standard output");
    parser.add_option("--with DB", request.others,
                      "further databases, whose campaigns can be drawn with those of the first");
    parser
        .add_option("--watch N", request.watched,
                    "number of films in the page: cases from the smallest to the largest main observable, computed "
                    "again")
        ->check(whole_number(0, 100));
    parser.add_option("--model NAME", request.models.of,
                      "scalars whose response models are drawn; default: the main observable, for campaigns of at most "
                      "1000 cases");
}

}  // namespace

std::vector<Command> study_commands() {
    return {
        command<Subject>("converge", "shows moments with their errors, check by check, and the verdict",
                         declare_converge, converge),
        command<Subject>("sensitivity", "shows which factor moves the response: indices with their errors",
                         declare_sensitivity, sensitivity),
        verbatim(command<ReportRequest>("report", "writes one self-contained HTML page with tables and figures",
                                        declare_report, write_report)),
    };
}

}  // namespace grainsweep::cli
