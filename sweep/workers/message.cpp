#include "sweep/workers/message.hpp"

#include "sweep/campaign/overloaded.hpp"
#include "sweep/workers/message_form.hpp"

#include <nlohmann/json.hpp>

#include <limits>
#include <optional>
#include <stdexcept>

namespace grainsweep::workers {
namespace {

using Json = nlohmann::json;

using campaign::Overloaded;

Inputs to_inputs(const Json& object) {
    Inputs inputs;
    for (const auto& [name, value] : object.items()) {
        if (value.is_string()) {
            inputs.emplace(name, value.get<std::string>());
        } else if (value.is_number_integer()) {
            inputs.emplace(name, value.get<std::int64_t>());
        } else {
            inputs.emplace(name, value.get<double>());
        }
    }
    return inputs;
}

double number_or_nan(const Json& value) {
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Observations to_observations(const Json& object) {
    Observations observations;
    for (const auto& [name, value] : object.at("scalars").items()) observations.scalars[name] = number_or_nan(value);
    for (const auto& [name, rows] : object.at("series").items()) {
        auto& samples = observations.series[name];
        samples.reserve(rows.size());
        for (const auto& row : rows) {
            samples.push_back({number_or_nan(row.at(0)), number_or_nan(row.at(1)), number_or_nan(row.at(2))});
        }
    }
    return observations;
}

Json from_attempt(const campaign::Attempt& attempt) {
    return {{"id", attempt.case_id}, {"attempt", attempt.number}};
}

campaign::Attempt to_attempt(const Json& object) {
    return {object.at("id").get<std::string>(), object.at("attempt").get<std::int64_t>()};
}

Done to_done(const Json& object) {
    Done done;
    done.result.attempt = to_attempt(object);
    const auto outcome = campaign::outcome_named(object.at("outcome").get<std::string>());
    if (!outcome) throw std::invalid_argument("unknown outcome");
    done.result.outcome = *outcome;
    done.result.message = object.at("message").get<std::string>();
    done.result.observations = to_observations(object.at("observations"));
    const Json& cost = object.at("cost");
    done.result.cost = {number_or_nan(cost.at("wall")), number_or_nan(cost.at("cpu")), number_or_nan(cost.at("steps")),
                        cost.at("phases").get<std::map<std::string, double, std::less<>>>()};
    if (const auto threads = cost.find("threads"); threads != cost.end())
        done.result.cost.threads = number_or_nan(*threads);  // a spool may hold older answers, without
    done.checkpointed = object.at("checkpointed").get<bool>();
    if (const auto program = object.find("program"); program != object.end()) {
        auto& facts = done.result.program.emplace();
        facts.version = program->at("version").get<std::string>();
        facts.peak_memory = number_or_nan(program->at("memory"));
        if (!program->at("status").is_null()) facts.exit_status = program->at("status").get<std::int64_t>();
    }
    return done;
}

Threads to_threads(const Json& value) {
    if (!value.is_number_integer() || value < 1 || value > most_threads)
        throw std::invalid_argument("no number of threads");
    return {value.get<std::int64_t>()};
}

Json from_ready(const Ready& ready) {
    const auto& by = ready.computer;
    return {{"protocol", ready.protocol},  {"version", by.version},     {"commit", by.commit}, {"build", by.build},
            {"path", by.instruction_path}, {"processor", by.processor}, {"host", by.host}};
}

// Of another protocol's Ready enough is understood to say what is wrong with it.
Ready to_ready(const Json& object) {
    const auto text = [&](const char* key) { return object.value(key, std::string()); };
    return {object.value("protocol", std::int64_t{1}),
            {text("version"), text("commit"), text("build"), text("path"), text("processor"), text("host")}};
}

// Invalid UTF-8 in a message (from a library's error text, say) must not lose the result.
std::string line(const Json& object) {
    return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json parse(std::string_view text) {
    try {
        return Json::parse(text);
    } catch (const Json::exception& error) {
        throw std::invalid_argument(error.what());
    }
}

}  // namespace

std::string encode(const ToWorker& message) {
    return std::visit(Overloaded{[](const Run& run) { return in_form(run); },
                                 [](const Threads& threads) {
                                     return line({{"threads", threads.count}});
                                 },
                                 [](const Lease&) {
                                     return line({{"lease", true}});
                                 },
                                 [](const Stop&) {
                                     return line({{"stop", true}});
                                 }},
                      message);
}

std::string encode(const ToBoss& message) {
    return std::visit(Overloaded{[](const Ready& ready) {
                                     return line({{"ready", from_ready(ready)}});
                                 },
                                 [](const Begun& begun) { return in_form(begun); },
                                 [](const Alive& alive) {
                                     Json object = from_attempt(alive.attempt);
                                     object["progress"] = alive.progress;
                                     return line({{"alive", std::move(object)}});
                                 },
                                 [](const Done& done) { return in_form(done); },
                                 [](const GiveBack& back) {
                                     Json object = from_attempt(back.attempt);
                                     object["reason"] = back.reason;
                                     if (back.broken) object["broken"] = true;
                                     return line({{"give_back", std::move(object)}});
                                 }},
                      message);
}

ToWorker decode_to_worker(std::string_view text) {
    if (auto run = run_in_form(text)) return std::move(*run);
    const Json object = parse(text);
    try {
        if (object.contains("threads")) return to_threads(object.at("threads"));
        if (object.contains("lease")) return Lease{};
        if (object.contains("stop")) return Stop{};
        const Json& run = object.at("run");
        Run message;
        message.attempt = run.at("attempt").get<std::int64_t>();
        message.question = {run.at("id").get<std::string>(), run.at("scene").get<std::string>(),
                            run.at("revision").get<int>(), to_inputs(run.at("inputs")),
                            run.at("seed").get<std::uint64_t>()};
        return message;
    } catch (const Json::exception& error) {
        throw std::invalid_argument(error.what());
    }
}

ToBoss decode_to_boss(std::string_view text) {
    if (auto begun = begun_in_form(text)) return std::move(*begun);
    if (auto done = done_in_form(text)) return std::move(*done);
    const Json object = parse(text);
    try {
        if (object.contains("done")) return to_done(object.at("done"));
        if (object.contains("begun")) {
            return Begun{to_attempt(object.at("begun")), object.at("begun").at("resumed").get<bool>()};
        }
        if (object.contains("alive")) {
            return Alive{to_attempt(object.at("alive")), number_or_nan(object.at("alive").at("progress"))};
        }
        if (object.contains("give_back")) {
            const Json& back = object.at("give_back");
            return GiveBack{to_attempt(back), back.at("reason").get<std::string>(), back.value("broken", false)};
        }
        return to_ready(object.at("ready"));
    } catch (const Json::exception& error) {
        throw std::invalid_argument(error.what());
    }
}

}  // namespace grainsweep::workers
