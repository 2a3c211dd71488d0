// accuracy: error of a campaign's answers against their cost.
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/accuracy_run.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/figure_file.hpp"
#include "sweep/report/accuracy_figure.hpp"
#include "sweep/report/accuracy_tables.hpp"
#include "sweep/workers/end_requests.hpp"

#include <fmt/format.h>

#include <iostream>

namespace grainsweep::cli {
namespace {

struct AccuracyRequest : AccuracyRun {
    std::vector<std::string> observables;
    double tolerance = 0.01;
    FigureFile file;
};

/// The named observables, or the first one.
std::vector<std::string> drawn_observables(const AccuracyRequest& request, const AccuracyEnd& end) {
    if (!request.observables.empty() || end.costs.back().biases.empty()) return request.observables;
    return {end.costs.back().biases.front().observable};
}

int accuracy(const AccuracyRequest& request, report::Format format) {
    if (!(request.tolerance > 0 && request.tolerance < 1))
        throw campaign::wrong_question("--tolerance", fmt::format("{}", request.tolerance),
                                       "must be a number above 0 and below 1");
    const auto database = request.database.string();
    if (!request.file.output.empty()) (void)width_in_mm(request.file), (void)figure_type(request.file, database);
    workers::answer_end_requests();
    const auto end = run_accuracy(request);
    if (end.costs.empty()) {
        std::cerr << "interrupted; run it again to resume\n";
        return end.exit_code;
    }
    const auto document = report::accuracy_document(end.campaign, end.costs, request.observables, request.tolerance);
    if (!request.file.output.empty()) {
        const auto figure = report::accuracy_figure(end.costs, drawn_observables(request, end), request.tolerance);
        if (figure.panels.empty())
            throw campaign::wrong_question("-o", request.file.output,
                                           "there is nothing to draw: errors are shown relative to the mean, which is "
                                           "0 or missing; name another with --observable");
        write_figure(request.file, figure, database);
    }
    report::write(std::cout, document, format);
    return end.exit_code;
}

void declare_accuracy(Parser& parser, AccuracyRequest& request) {
    parser.add_option("CONFIG", request.config, "campaign file");
    parser
        .add_option("--points N", request.points, "points of the campaign's design that are computed at each setting")
        ->check(whole_number(2, 100'000))
        ->capture_default_str();
    parser.add_option("--against NAME", request.against, "the setting whose answers are the measure")
        ->capture_default_str();
    parser.add_option("--observable NAME", request.observables, "scalar to be judged, may be repeated; default: all")
        ->allow_extra_args(false);
    parser.add_option("--tolerance X", request.tolerance, "largest error, relative to the mean")->capture_default_str();
    parser.add_option("--db FILE", request.database, "database; default: NAME_accuracy.db in the current folder");
    parser.add_option("-j N", request.workers, "worker processes; 0: all cores; default: execution.workers")
        ->check(whole_number(0, 4096));
    parser.add_flag("--quiet", request.quiet, "print no progress");
    declare_figure_file(parser, request.file);
}

}  // namespace

std::vector<Command> accuracy_commands() {
    return {command<AccuracyRequest>("accuracy",
                                     "measures error against cost of each accuracy setting and numerical input",
                                     declare_accuracy, accuracy)};
}

}  // namespace grainsweep::cli
