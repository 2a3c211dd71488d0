// predict, window: predictions of a campaign's response models for settings that were not run.
#include "sweep/campaign/input_error.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/page_file.hpp"
#include "sweep/cli/settings.hpp"
#include "sweep/cli/window_run.hpp"
#include "sweep/report/model_tables.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/models.hpp"
#include "sweep/report/window_page.hpp"
#include "sweep/report/window_tables.hpp"
#include "sweep/store/campaign_name.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/response_models.hpp"
#include "sweep/workers/end_requests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <optional>
#include <sstream>
#include <stop_token>
#include <thread>
#include <utility>

namespace grainsweep::cli {
namespace {

using report::Format;
using store::Store;
using study::Setting;

struct PredictRequest {
    std::string database, campaign, observable;
    std::vector<std::string> at, left_out;
    std::filesystem::path points;
    bool extrapolate = false;
};

/// Outcomes of --leave-out.
std::vector<campaign::Outcome> outcomes_in(const std::vector<std::string>& words) {
    using enum campaign::Outcome;
    constexpr std::array failures = {unstable, rejected, crashed, timed_out};
    std::vector<campaign::Outcome> outcomes;
    std::vector<std::string_view> known;
    for (const auto outcome : failures) known.push_back(campaign::to_string(outcome));
    for (const auto& word : words) {
        const auto outcome = campaign::outcome_named(word);
        if (!outcome || std::ranges::find(failures, *outcome) == failures.end())
            throw campaign::input_error("--leave-out", word,
                                        fmt::format("must be an outcome of failed cases: {}", campaign::listed(known)),
                                        campaign::nearest_word(word, known));
        outcomes.push_back(*outcome);
    }
    return outcomes;
}

void declare_left_out(Parser& parser, std::vector<std::string>& words) {
    parser
        .add_option("--leave-out OUTCOME", words,
                    "outcome of failed cases that is no property of the process (a licence, a node, a bug): these "
                    "cases do not count; may be repeated")
        ->allow_extra_args(false);
}

/// Writes the step at which a window is to stderr, one line every ten seconds; nothing for a fast window.
class StepLines {
public:
    StepLines() : thread_([this](const std::stop_token& stop) { write_lines(stop); }) {}

    void step(std::string_view name, double done) {
        const std::scoped_lock lock(mutex_);
        name_ = name;
        done_ = done;
    }

private:
    void write_lines(const std::stop_token& stop) {
        using namespace std::chrono_literals;
        const auto begun = std::chrono::steady_clock::now();
        std::unique_lock lock(mutex_);
        while (!wake_.wait_for(lock, stop, 10s, [] { return false; }) && !stop.stop_requested()) {
            if (name_.empty()) continue;
            const auto seconds =
                std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begun).count();
            std::cerr << fmt::format("window: {}{}, {} s\n", name_,
                                     done_ > 0 ? fmt::format(" {:.0f} %", 100 * done_) : std::string(), seconds);
        }
    }

    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::string name_;
    double done_ = 0;
    std::jthread thread_;
};

std::vector<Setting> settings_of(const PredictRequest& request, const study::ModelCases& cases) {
    if (request.at.empty() == request.points.empty())
        throw campaign::input_error("predict", "",
                                    "give one setting by --at NAME=VALUE for every factor, or several "
                                    "in a file by --points");
    if (!request.at.empty()) return {read_setting(cases.factors, request.at)};
    return read_settings_file(request.points, cases.factors);
}

/// Refuses settings outside of the box, and settings that the campaign's `where` clause excludes: no case is there.
void refuse_extrapolation(const Store& store, const study::ModelCases& cases, const std::vector<Setting>& settings) {
    const auto admits = study::admission(store, cases);
    for (const auto& setting : settings) {
        const auto outside = study::outside_text(cases.factors, setting);
        if (!outside.empty())
            throw campaign::input_error("", outside,
                                        "the model would extrapolate; --extrapolate predicts nevertheless");
        if (admits && !admits(setting))
            throw campaign::input_error("", study::setting_text(cases.factors, setting),
                                        fmt::format("the campaign has no case where its condition is not met: {}; "
                                                    "--extrapolate predicts nevertheless",
                                                    cases.campaign.condition));
    }
}

int predict(const PredictRequest& request, Format format) {
    const Store store(request.database, Store::Mode::read);
    const auto cases = study::read_model_cases(store, request.campaign, outcomes_in(request.left_out));
    const auto& observable = cases.observable(request.observable);
    auto settings = settings_of(request, cases);
    if (!request.extrapolate) refuse_extrapolation(store, cases, settings);
    auto model = study::learn_or_refuse(cases, observable);
    if (auto note = study::between_levels_text(cases.factors, settings); !note.empty())
        model.notes.push_back(std::move(note));
    const auto predicted = study::predict(cases, model, std::move(settings), request.extrapolate);
    report::write(std::cout, report::predictions_document(cases, model, predicted), format);
    return 0;
}

void declare_subject(Parser& parser, std::string& database, std::string& campaign) {
    parser.add_option("DB", database, "the database");
    parser.add_option(
        "--campaign NAME", campaign,
        "name of a campaign; default: the only one, or the first of those that differ only in their points");
}

void declare_predict(Parser& parser, PredictRequest& request) {
    declare_subject(parser, request.database, request.campaign);
    parser.add_option("--observable NAME", request.observable,
                      "scalar observable; default: that of the convergence rule, else the scene's first");
    parser
        .add_option("--at NAME=VALUE", request.at,
                    "value of a factor, a number with or without a unit, or a word; once for every factor")
        ->allow_extra_args(false);
    parser.add_option("--points FILE.csv", request.points,
                      "CSV file of settings: a header with every factor, one setting per line");
    declare_left_out(parser, request.left_out);
    parser.add_flag("--extrapolate", request.extrapolate,
                    "predict also outside the ranges of the factors and where a case is likelier to fail than not");
}

struct WindowArguments {
    std::string database, campaign;
    std::string next_file, output;
    std::vector<std::string> maximise, minimise, reference, hold, left_out;
    std::int64_t next = 0;
    bool single = false, run = false;
    double width = 0, tolerance = 0;
    std::optional<std::int64_t> max_cases, workers;
    study::WindowRequest request;
};

/// Writes the campaign file of the next cases. Returns the name of its campaign, which is new in the archive.
std::string write_next(const Store& store, const study::ModelCases& cases, const study::Window& window,
                       const std::string& file) {
    if (window.next.empty()) throw campaign::input_error("--next-file", file, "there is no case to run next");
    const auto [name, number] = name_of_next(store, cases.campaign.name);
    store::check_campaign_name(name);
    write_page_file(file, study::next_campaign(cases, window, name, number));
    return name;
}

void check_run(const WindowArguments& arguments, const study::WindowRequest& request) {
    if (!arguments.run) {
        for (const auto& [given, option] : {std::pair{arguments.width != 0, "--width"},
                                            {arguments.tolerance != 0, "--tolerance"},
                                            {arguments.max_cases.has_value(), "--max-cases"},
                                            {arguments.workers.has_value(), "-j"}})
            if (given) throw campaign::input_error(option, "", "needs --run");
        return;
    }
    if (request.objectives.empty())
        throw campaign::input_error("--run", "", "needs --maximize or --minimize: --width applies to its mean");
    const bool pair = request.objectives.size() == 2;
    const std::string option = pair ? "--tolerance" : "--width", other = pair ? "--width" : "--tolerance";
    const double end = pair ? arguments.tolerance : arguments.width;
    if ((pair ? arguments.width : arguments.tolerance) != 0)
        throw campaign::input_error(
            other, "",
            fmt::format("is for {}; here {} ends the run", pair ? "one objective" : "two objectives", option));
    if (end == 0)
        throw campaign::input_error(
            "--run", "",
            pair ? "needs --tolerance, the part of its hypervolume that the computed front may lack: 0.01"
                 : "needs --width, the 95 % half-width of the objective's mean at the best setting");
    if (!arguments.next_file.empty())
        throw campaign::input_error("--next-file", arguments.next_file, "--run runs the next cases itself");
    if (!(end > 0) || !std::isfinite(end))
        throw campaign::input_error(option, fmt::format("{}", end), "must be a positive number");
}

std::vector<study::Objective> objectives_of(const WindowArguments& arguments) {
    std::vector<study::Objective> objectives;
    for (const auto& name : arguments.maximise) objectives.push_back({name, true});
    for (const auto& name : arguments.minimise) objectives.push_back({name, false});
    if (objectives.size() > 2)
        throw campaign::input_error("--minimize", objectives.back().name,
                                    "at most two objectives: --maximize and --minimize together");
    if (!arguments.reference.empty() && objectives.size() < 2)
        throw campaign::input_error("--reference", arguments.reference.front(),
                                    "is for two objectives, by --maximize and --minimize");
    return objectives;
}

/// Batches of next cases until the best setting is known; then the window is answered from all of them.
std::optional<WindowRunEnd> run_first(const WindowArguments& arguments, const study::WindowRequest& request) {
    if (!arguments.run) return std::nullopt;
    std::signal(SIGPIPE, SIG_IGN);  // as run does: a campaign outlives the reader of its output
    workers::answer_end_requests();
    constexpr std::int64_t usual_batch = 8, usual_most = 100;
    return run_towards_window({.database = arguments.database,
                               .campaign = arguments.campaign,
                               .width = arguments.width,
                               .tolerance = arguments.tolerance,
                               .batch = arguments.next > 0 ? arguments.next : usual_batch,
                               .max_cases = arguments.max_cases.value_or(usual_most),
                               .workers = arguments.workers},
                              request);
}

int window(const WindowArguments& arguments, Format format) {
    if (!arguments.next_file.empty() && arguments.next == 0)
        throw campaign::input_error("--next-file", arguments.next_file, "needs --next N, the number of cases");
    if (!arguments.next_file.empty()) check_page_file("--next-file", arguments.next_file, arguments.database);
    if (!arguments.output.empty()) check_page_file("-o", arguments.output, arguments.database);
    auto request = arguments.request;
    request.objectives = objectives_of(arguments);
    request.judged = arguments.single ? stats::Judged::single_run : stats::Judged::mean;
    request.left_out = outcomes_in(arguments.left_out);
    StepLines lines;
    request.progress = [&](std::string_view step, double done) { lines.step(step, done); };
    check_run(arguments, request);
    if (!arguments.hold.empty() || !arguments.reference.empty()) {
        const Store store(arguments.database, Store::Mode::read);
        const auto cases = study::read_model_cases(store, arguments.campaign);
        request.held = read_held(cases.factors, arguments.hold);
        read_references(cases, arguments.reference, request.objectives);
    }
    const auto end = run_first(arguments, request);
    request.next = arguments.run ? 0 : static_cast<std::size_t>(arguments.next);
    const Store store(arguments.database, Store::Mode::read);
    const auto cases = study::read_model_cases(store, arguments.campaign, request.left_out);
    const auto found = study::window_of(store, cases, request);
    std::string written;
    if (!arguments.next_file.empty()) written = write_next(store, cases, found, arguments.next_file);
    if (!arguments.output.empty()) {
        std::ostringstream page;
        report::write_window_page(page, report::window_page_data(cases, request, found, study::admission(store, cases)),
                                  std::filesystem::path(arguments.database).filename().string());
        write_page_file(arguments.output, std::move(page).str());
    }
    auto shown = report::window_document(cases, request, found);
    if (!written.empty())
        shown.say(fmt::format("{}: campaign {}; grainsweep run {} --db {} computes its cases for the same model",
                              arguments.next_file, written, arguments.next_file, arguments.database));
    if (!arguments.output.empty()) shown.say(fmt::format("{}: open it in a browser, or print it", arguments.output));
    if (end) {
        shown.say(fmt::format("{} cases run in {} batches: {}", end->cases, end->batches, end->says));
        using report::Result, report::results::window, report::results::window_run;
        shown.value.add(Result<window>{
            {"run",
             Result<window_run>{
                 {"cases", end->cases}, {"batches", end->batches}, {"reached", end->reached}, {"says", end->says}}}});
    }
    report::write(std::cout, shown, format);
    return end ? end->exit_code : 0;
}

void declare_window(Parser& parser, WindowArguments& arguments) {
    declare_subject(parser, arguments.database, arguments.campaign);
    parser.add_option("--where CONDITION", arguments.request.where,
                      "condition over observables and factors: \"mfr >= 0.35 and empty_share <= 0.1\"; \"... for all "
                      "powder\": at every level of that factor");
    parser
        .add_option("--maximize NAME", arguments.maximise, "observable or factor to maximise; at most two objectives")
        ->allow_extra_args(false);
    parser
        .add_option("--minimize NAME", arguments.minimise, "observable or factor to minimise; at most two objectives")
        ->allow_extra_args(false);
    parser
        .add_option("--reference NAME=VALUE", arguments.reference,
                    "of two objectives: value of one at the reference point of the hypervolume; default: the worst "
                    "computed value")
        ->allow_extra_args(false);
    parser
        .add_option("--risk", arguments.request.risk,
                    "largest probability that a setting in the window violates the condition")
        ->capture_default_str();
    parser
        .add_option("--hold NAME=VALUE", arguments.hold,
                    "one value of a factor, which is then neither searched nor averaged over; may be repeated")
        ->allow_extra_args(false);
    declare_left_out(parser, arguments.left_out);
    parser.add_flag("--single", arguments.single,
                    "apply the condition to every single run; default: to the mean over seeds");
    parser.add_option("--next N", arguments.next, "number of cases to propose")->check(whole_number(0, 1000));
    parser.add_option("--next-file FILE.json", arguments.next_file,
                      "campaign file to write with the proposed cases; run it into the same database");
    parser.add_flag("--run", arguments.run,
                    "run batches of proposed cases (--next N each; default: 8) until the best setting is known to "
                    "--width, or the front of two objectives to --tolerance; run it again to resume");
    parser.add_option("--width WIDTH", arguments.width,
                      "with --run: wanted 95 % half-width of the objective's mean at the best setting");
    parser.add_option("--tolerance PART", arguments.tolerance,
                      "with --run, of two objectives: part of its hypervolume that the computed front may lack (95 %)");
    parser.add_option("--max-cases N", arguments.max_cases, "with --run: run at most N cases; default: 100")
        ->check(whole_number(1));
    parser.add_option("-j N", arguments.workers, "with --run: worker processes; 0: all cores")
        ->check(whole_number(0, 4096));
    parser.add_option("-o,--output FILE.html", arguments.output,
                      "HTML page with the window: best setting, maps, curves with their bands");
}

}  // namespace

std::vector<Command> decide_commands() {
    return {command<PredictRequest>("predict", "predicts a response, with its error, at settings that were not run",
                                    declare_predict, predict),
            command<WindowArguments>(
                "window", "finds the process window: where a condition holds, the best setting, the cases to run next",
                declare_window, window)};
}

}  // namespace grainsweep::cli
