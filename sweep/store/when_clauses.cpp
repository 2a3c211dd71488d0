#include "sweep/store/when_clauses.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/json_text.hpp"
#include "sweep/store/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace grainsweep::store {
namespace {

struct Waiting {
    std::string path, text;  ///< where the condition stands, and as it stands
    campaign::WhenClause clause;
    std::vector<std::string> reads;
};

void check_reads(const Waiting& one, const campaign::ParameterSpace& space) {
    const auto refuse = [&](const std::string& rule) { throw campaign::input_error(one.path, one.text, rule); };
    bool varies = false;
    for (const auto& name : one.reads) {
        if (name == one.clause.factor) refuse(fmt::format("'{}' cannot decide by itself whether it counts", name));
        if (std::ranges::find(space.expressions, name, &campaign::Expression::name) != space.expressions.end())
            refuse(fmt::format("'{}' follows from an expression, which is evaluated later: write what it needs", name));
        varies = varies || std::ranges::find(space.factors, name, &campaign::Factor::name) != space.factors.end();
    }
    if (!varies)
        refuse(fmt::format("it reads no other factor: '{}' would count everywhere or nowhere", one.clause.factor));
}

/// Refuses conditions that all wait for one another, at one of a ring.
[[noreturn]] void refuse_ring(const std::vector<Waiting>& waiting) {
    const auto of = [&](const std::string& name) {
        return std::ranges::find(waiting, name, [](const Waiting& one) { return one.clause.factor; });
    };
    std::vector<std::string> path;
    std::string next = waiting.front().clause.factor;
    while (std::ranges::find(path, next) == path.end()) {
        path.push_back(next);
        next = *std::ranges::find_if(of(next)->reads, [&](const auto& name) { return of(name) != waiting.end(); });
    }
    std::string ring = next;
    for (auto step = std::ranges::find(path, next) + 1; step != path.end(); ++step) ring += " needs " + *step;
    throw campaign::input_error(of(next)->path, of(next)->text,
                                fmt::format("conditions cannot need one another: {} needs {}", ring, next));
}

}  // namespace

std::vector<campaign::WhenClause> when_clauses(const campaign::ParameterSpace& space) {
    std::vector<std::string> names;
    for (const auto& parameter : space.scene->parameters) names.push_back(parameter.name);
    std::vector<Waiting> waiting;
    for (std::size_t j = 0; j < space.factors.size(); ++j) {
        const auto& factor = space.factors[j];
        if (factor.when.empty()) continue;
        const auto path = campaign::path_of("$.factors", j) + ".when";
        auto condition = make_condition(factor.when, names, path);
        waiting.push_back({path, factor.when, {factor.name, std::move(condition.holds)}, std::move(condition.reads)});
        check_reads(waiting.back(), space);
    }
    std::vector<campaign::WhenClause> ordered;
    while (!waiting.empty()) {
        const auto waits = [&](const std::string& name) {
            return std::ranges::any_of(waiting, [&](const Waiting& one) { return one.clause.factor == name; });
        };
        const auto ready =
            std::ranges::find_if(waiting, [&](const Waiting& one) { return std::ranges::none_of(one.reads, waits); });
        if (ready == waiting.end()) refuse_ring(waiting);
        ordered.push_back(std::move(ready->clause));
        waiting.erase(ready);
    }
    return ordered;
}

}  // namespace grainsweep::store
