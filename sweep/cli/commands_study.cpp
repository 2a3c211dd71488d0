// converge, sensitivity, report: what the stored answers say.
#include "sweep/cli/command.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/cli/report_films.hpp"
#include "sweep/report/bracket_tables.hpp"
#include "sweep/report/calibration_tables.hpp"
#include "sweep/report/convergence_tables.hpp"
#include "sweep/report/file_size.hpp"
#include "sweep/report/influence_tables.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/summary.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using report::Format;
using store::Store;
using study::Responses;

/// Which campaign and which observable of a database.
struct Subject {
    std::string database, campaign, observable;
    bool check = false;  ///< of `converge`: the exit code says whether everything shown has converged
};

void append(store::Table& all, store::Table more) {
    if (all.columns.empty()) all.columns = std::move(more.columns);
    for (auto& row : more.rows) all.rows.push_back(std::move(row));
}

void print_heading(const Responses& responses, const study::ResponseColumn& response) {
    const auto& record = responses.campaign;
    const std::string unit = response.unit.empty() || response.unit == "1" ? "" : fmt::format(" ({})", response.unit);
    std::cout << fmt::format(
        "{}: {}{} over {} points of a {} design{}; {}\n\n", record.name, response.name, unit,
        responses.counted_points(), record.design,
        record.sequences > 1 && study::repeats(responses) ? fmt::format(" of {} sequences", record.sequences) : "",
        report::outcome_line(responses));
}

void print_notes(const std::vector<std::string>& notes) {
    for (const auto& note : notes) std::cout << "note: " << note << '\n';
}

void print_history(const Responses& responses, const study::ResponseColumn& response, const study::History& history,
                   const std::vector<study::LatticeStep>& lattices) {
    print_heading(responses, response);
    if (!responses.campaign.condition.empty()) std::cout << "where: " << study::points_line(responses) << "\n\n";
    if (history.all.count > 0 || !history.provisional) {
        report::write(std::cout, report::statistics_table(history), Format::text);
        std::cout << '\n';
    }
    if (history.provisional) {
        std::cout << fmt::format("provisional: all {} finished cases, also behind gaps in the design; not judged\n",
                                 responses.finished());
        report::write(std::cout, report::provisional_table(history), Format::text);
        std::cout << '\n';
    }
    if (!history.checks.empty()) {
        const auto checks = report::checks_table(history);
        report::write(std::cout, checks, Format::text);
        if (checks.rows.size() < history.checks.size())
            std::cout << fmt::format("({} checks; --format csv has them all)\n", history.checks.size());
        std::cout << '\n';
    }
    if (!lattices.empty()) {
        report::write(std::cout, report::lattice_lines(lattices), Format::text);
        std::cout << '\n';
    }
    std::cout << history.verdict << '\n';
    print_notes(history.warnings);
}

/// Both estimates of the moments, where the design allows the second one.
void print_estimators(const study::Estimators& estimators) {
    std::cout << '\n';
    if (estimators.assisted) {
        std::cout << "moments with a response model beside the plain ones\n";
        report::write(std::cout, report::estimators_table(estimators), Format::text);
    }
    for (const auto& line : report::estimator_lines(estimators)) std::cout << line << '\n';
}

void print_model_influence(const study::ModelInfluence& influence) {
    if (influence.indices) {
        std::cout << "\nby a response model:\n";
        report::write(std::cout, report::model_influence_table(influence), Format::text);
        std::cout << '\n';
    }
    for (const auto& line : report::model_influence_lines(influence)) std::cout << line << '\n';
}

/// Calls `with` for every campaign the subject names; those whose scene has not the observable are passed over where
/// no campaign is named. `whole` answers for a campaign before its observable is looked for; true: it has answered.
template <class Whole, class With>
void for_each_campaign(const Store& store, const Subject& subject, Whole whole, With with) {
    const auto records = study::find_campaigns(store, subject.campaign);
    std::size_t found = 0;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto responses = study::read_responses(store, records[i]);
        const bool last_chance = i + 1 == records.size() && found == 0;
        const bool measures = responses.measures(subject.observable);
        if ((measures || subject.observable.empty()) && whole(responses, found == 0)) {
            ++found;
            continue;
        }
        if (!last_chance && !measures) continue;
        with(responses, responses.observable(subject.observable), found++ == 0);
    }
}

/// What a design that brackets a passage has found, in place of moments; false: the campaign has another design.
bool show_brackets(const Store& store, const Responses& responses, Format format, bool first, Json& all,
                   store::Table& rows) {
    const auto brackets = study::brackets_of(store, responses.campaign);
    if (!brackets) return false;
    if (format == Format::json) {
        all.push_back({{"campaign", responses.campaign.name}});
        all.back().update(report::to_json(*brackets));
    } else if (format == Format::csv) {
        if (first) rows = report::brackets_rows(*brackets, responses.campaign.name);
    } else {
        if (!first) std::cout << '\n';
        std::cout << fmt::format("{}: {}; {}\n\n", responses.campaign.name, report::brackets_line(*brackets),
                                 report::outcome_line(responses));
        report::write(std::cout, report::brackets_table(*brackets), Format::text);
    }
    return true;
}

/// The same of a calibration.
bool show_calibration(const Store& store, const Responses& responses, Format format, bool first, Json& all,
                      store::Table& rows, bool& converged) {
    const auto calibration = study::calibration_report(store, responses.campaign);
    if (!calibration) return false;
    converged = converged && calibration->found.waves_end && calibration->found.posterior;
    if (format == Format::json) {
        all.push_back({{"campaign", responses.campaign.name}});
        all.back().update(report::to_json(*calibration));
    } else if (format == Format::csv) {
        if (first) rows = report::posterior_table(*calibration);
    } else {
        if (!first) std::cout << '\n';
        std::cout << responses.campaign.name << ": " << report::outcome_line(responses) << '\n'
                  << report::calibration_text(*calibration);
    }
    return true;
}

int converge(const Subject& subject, Format format) {
    const Store store(subject.database, Store::Mode::read);
    Json all = Json::array();
    store::Table rows;
    bool converged = true;
    const auto whole = [&](const Responses& responses, bool first) {
        return show_brackets(store, responses, format, first, all, rows) ||
               show_calibration(store, responses, format, first, all, rows, converged);
    };
    for_each_campaign(store, subject, whole,
                      [&](const Responses& responses, const study::ResponseColumn& response, bool first) {
                          const auto history = study::history_of(responses, response);
                          converged = converged && history.converged.value_or(false);
                          const auto lattices = study::lattice_family(store, responses, response);
                          if (format == Format::json) {
                              all.push_back(report::to_json(responses, response, history, lattices));
                              all.back()["estimators"] =
                                  report::estimators_json(history, study::estimators_of(store, responses, response));
                          } else if (format == Format::csv) {
                              const bool other = !rows.columns.empty() && rows.columns.front() != "campaign";
                              if (other || (!rows.columns.empty() && rows.columns.back() == "state")) return;
                              append(rows, report::checks_rows(responses, response, history));
                              append(rows, report::provisional_rows(responses, response, history));
                          } else {
                              if (!first) std::cout << '\n';
                              print_history(responses, response, history, lattices);
                              if (study::repeats(responses))
                                  print_estimators(study::estimators_of(store, responses, response));
                          }
                      });
    if (format == Format::json) report::write(std::cout, all);
    if (format == Format::csv) report::write(std::cout, rows, format);
    return subject.check && !converged ? 1 : 0;
}

int sensitivity(const Subject& subject, Format format) {
    const Store store(subject.database, Store::Mode::read);
    Json all = Json::array();
    store::Table rows;
    const auto nothing = [](const Responses&, bool) { return false; };
    for_each_campaign(
        store, subject, nothing, [&](const Responses& responses, const study::ResponseColumn& response, bool first) {
            const auto influence = study::influence_of(responses, response);
            if (format == Format::json) {
                all.push_back(report::to_json(responses, response, influence));
                all.back()["model"] = report::model_influence_json(study::model_influence_of(responses, response));
            } else if (format == Format::csv) {
                append(rows, report::influence_rows(responses, response, influence));
            } else {
                if (!first) std::cout << '\n';
                print_heading(responses, response);
                report::write(std::cout, report::influence_table(influence), Format::text);
                std::cout << '\n';
                if (const auto text = study::unexplained_text(influence); !text.empty()) std::cout << text << '\n';
                print_notes(influence.notes);
                print_model_influence(study::model_influence_of(responses, response));
            }
        });
    if (format == Format::json) report::write(std::cout, all);
    if (format == Format::csv) report::write(std::cout, rows, format);
    return 0;
}

int write_report(const std::vector<std::string>& databases, std::string output, std::int64_t watched,
                 const report::PageModels& models, Format format) {
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
    const auto films = films_of(stores.front(), watched);
    std::size_t film_bytes = 0;
    for (const auto& film : films) film_bytes += film.bytes.size() / 3 * 4;
    if (!films.empty())
        std::cerr << fmt::format("{} films: {} of the page\n", films.size(), report::size_text(film_bytes));
    if (to_standard_output) {  // the page is the answer: nothing else goes there
        report::write_page(std::cout, sources, films, models);
        return 0;
    }
    std::ostringstream stream;
    report::write_page(stream, sources, films, models);
    const std::string page = std::move(stream).str();
    write_page_file(output, page);
    const auto size = static_cast<std::int64_t>(page.size());
    if (format == Format::text) {
        std::cout << fmt::format("{} ({}): open it in a browser\n", output,
                                 report::size_text(static_cast<std::uintmax_t>(size)));
    } else if (format == Format::json) {
        report::write(std::cout, Json{{"report", output}, {"bytes", size}});
    } else {
        report::write(std::cout, store::Table{{"report", "bytes"}, {{output, size}}}, format);
    }
    return 0;
}

/// A command about one observable of one campaign, or of all.
Command study(std::string command, std::string summary, int (*answer)(const Subject&, Format)) {
    return {
        std::move(command), std::move(summary),
        [answer](Parser& parser, const Format& format) -> Action {
            const auto subject = std::make_shared<Subject>();
            parser.add_option("DB", subject->database, "the database")->required();
            parser.add_option("--campaign", subject->campaign, "name of a campaign; default: all")->type_name("NAME");
            parser
                .add_option("--observable", subject->observable,
                            "scalar observable; default: that of the convergence rule, else the scene's first")
                ->type_name("NAME");
            if (answer == converge)
                parser.add_flag("--check", subject->check,
                                "exit with 1 unless everything shown has converged by its campaign's rule; "
                                "without a rule a campaign has not");
            return [subject, &format, answer] { return answer(*subject, format); };
        },
        false};
}

}  // namespace

std::vector<Command> study_commands() {
    return {
        study("converge", "shows moments with their errors, check by check, and the verdict", converge),
        study("sensitivity", "shows which factor moves the response: indices with their errors", sensitivity),
        {"report", "writes one self-contained HTML page with tables and figures",
         [](Parser& parser, const Format& format) -> Action {
             struct Request {
                 std::string database, output;
                 std::vector<std::string> others;
                 std::int64_t watched = 0;
                 report::PageModels models;
             };
             const auto request = std::make_shared<Request>();
             parser.add_option("DB", request->database, "the database")->required();
             parser
                 .add_option(
                     "-o,--output", request->output,
                     "the page; default: the database's name with .html, in the current folder; -: standard output")
                 ->type_name("FILE");
             parser
                 .add_option("--with", request->others,
                             "further databases, whose campaigns can be drawn with those of the first")
                 ->type_name("DB");
             parser
                 .add_option("--watch", request->watched,
                             "number of films in the page: cases from the smallest to the largest main "
                             "observable, computed again")
                 ->type_name("N")
                 ->check(whole_number(0, 100));
             parser
                 .add_option("--model", request->models.of,
                             "scalars whose response models are drawn; default: the main observable, for campaigns "
                             "of at most 1000 cases")
                 ->type_name("NAME");
             return [request, &format] {
                 std::vector<std::string> databases = {request->database};
                 databases.insert(databases.end(), request->others.begin(), request->others.end());
                 return write_report(databases, request->output, request->watched, request->models, format);
             };
         },
         false, true},
    };
}

}  // namespace grainsweep::cli
