// A calibration as a campaign would run it: waves are answered by functions until nothing is asked any more.
#pragma once

#include "sweep/designs/calibration.hpp"
#include "sweep/designs/calibration_layout.hpp"
#include "tests/support/ask_design.hpp"

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::tests {

/// Of a point of the unit box; conditions are coordinates like the others.
using ResponseFunctions = std::map<std::string, std::function<double(std::span<const double>)>>;

/// Factors f0, f1, ... over [0, 1].
inline designs::DesignRequest calibration_request(std::size_t dimensions,
                                                  const std::vector<designs::MeasuredTarget>& targets,
                                                  Options options = {}, std::uint64_t seed = 1) {
    options.insert_or_assign("targets", designs::text_of(targets));
    designs::add_defaults(designs::design_named("calibration"), options);
    designs::DesignRequest request{
        .levels = std::vector<std::size_t>(dimensions, 0), .options = std::move(options), .seed = seed};
    for (std::size_t j = 0; j < dimensions; ++j) {
        request.factors.push_back({"f" + std::to_string(j), designs::Between{0, 1}});
    }
    return request;
}

inline void answer(designs::DesignRequest& request, const designs::PointSet& points,
                   const ResponseFunctions& responses) {
    for (const auto& [observable, response] : responses) {
        auto& answers = request.answers[observable];
        for (std::size_t p = answers.size(); p < points.size(); ++p) answers.emplace_back(response(points.point(p)));
    }
}

inline designs::Calibration answered(designs::DesignRequest& request, const ResponseFunctions& responses) {
    for (std::size_t asked = 0;;) {
        auto found = designs::calibration_of(request);
        if (found.points.size() == asked) return found;
        asked = found.points.size();
        answer(request, found.points, responses);
    }
}

/// Requests of one calibration over several experiments, named by their responses; all calibrate f0, f1, ...
inline std::vector<designs::DesignRequest> joint_requests(std::size_t dimensions,
                                                          const std::vector<designs::MeasuredTarget>& targets,
                                                          const std::map<std::string, ResponseFunctions>& responses,
                                                          const Options& options = {}, std::uint64_t seed = 1) {
    std::vector<designs::DesignRequest> requests;
    for (const auto& [experiment, functions] : responses) {
        auto& request = requests.emplace_back(calibration_request(dimensions, targets, options, seed));
        request.options.insert_or_assign("experiment", experiment);
        request.shared = request.factors;
    }
    return requests;
}

/// Answers the experiments in turn, as a run does, until none asks for more. Returns what the first has found.
inline designs::Calibration answered_in_turn(std::vector<designs::DesignRequest>& requests,
                                             const std::map<std::string, ResponseFunctions>& responses) {
    std::vector<std::size_t> asked(requests.size(), 0);
    for (bool news = true; news;) {
        news = false;
        for (std::size_t k = 0; k < requests.size(); ++k) {
            const auto found = designs::calibration_of(requests[k]);
            news = news || found.points.size() > asked[k];
            asked[k] = found.points.size();
            const auto experiment = designs::experiment_of(requests[k]);
            designs::DesignRequest own;
            for (const auto& [observable, response] : responses.at(experiment))
                own.answers[observable] = requests[k].answers[experiment + '/' + observable];
            answer(own, found.points, responses.at(experiment));
            for (const auto& [observable, answers] : own.answers)
                for (auto& request : requests) request.answers[experiment + '/' + observable] = answers;
        }
    }
    return designs::calibration_of(requests.front());
}

}  // namespace grainsweep::tests
