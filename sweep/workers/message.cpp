#include "sweep/workers/message.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace grainsweep::workers {
namespace {

using Json = nlohmann::json;

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};

// A whole-numbered double is written with its ".0", so the reader can tell a count from a real.
Json from_inputs(const Inputs& inputs) {
    Json object = Json::object();
    for (const auto& [name, value] : inputs) std::visit([&](const auto& x) { object[name] = x; }, value);
    return object;
}

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

Json from_observations(const Observations& observations) {
    Json object = {{"scalars", observations.scalars}};
    Json& series = object["series"] = Json::object();
    for (const auto& [name, samples] : observations.series) {
        Json& rows = series[name] = Json::array();
        for (const auto& s : samples) rows.push_back({s.time, s.bin, s.value});
    }
    return object;
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

Json from_done(const Done& done) {
    const auto& result = done.result;
    Json object = from_attempt(result.attempt);
    object["outcome"] = campaign::to_string(result.outcome);
    object["message"] = result.message;
    object["observations"] = from_observations(result.observations);
    object["cost"] = {{"wall", result.cost.wall_seconds},
                      {"cpu", result.cost.cpu_seconds},
                      {"steps", result.cost.particle_steps},
                      {"phases", result.cost.phases}};
    object["checkpointed"] = done.checkpointed;
    return object;
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
    done.result.cost = {cost.at("wall").get<double>(), cost.at("cpu").get<double>(), cost.at("steps").get<double>(),
                        cost.at("phases").get<std::map<std::string, double, std::less<>>>()};
    done.checkpointed = object.at("checkpointed").get<bool>();
    return done;
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

// Every case costs one `begun`, so the form it is written in is written and read without building a document.
constexpr std::string_view begun_start = R"({"begun":{"attempt":)", begun_id = R"(,"id":")",
                           begun_resumed = R"(","resumed":)";

std::string from_begun(const Begun& begun) {
    const bool plain = std::ranges::all_of(begun.attempt.case_id, [](unsigned char c) { return std::isalnum(c) != 0; });
    if (plain)
        return fmt::format("{}{}{}{}{}{}}}}}", begun_start, begun.attempt.number, begun_id, begun.attempt.case_id,
                           begun_resumed, begun.resumed);
    Json object = from_attempt(begun.attempt);
    object["resumed"] = begun.resumed;
    return Json{{"begun", std::move(object)}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// None where it is written in another form.
std::optional<Begun> to_begun(std::string_view text) {
    Begun begun;
    const auto skip = [&](std::string_view word) {
        if (!text.starts_with(word)) return false;
        text.remove_prefix(word.size());
        return true;
    };
    if (!skip(begun_start)) return std::nullopt;
    const auto number = std::from_chars(text.data(), text.data() + text.size(), begun.attempt.number);
    text.remove_prefix(static_cast<std::size_t>(number.ptr - text.data()));
    if (number.ec != std::errc() || !skip(begun_id)) return std::nullopt;
    const auto end = std::ranges::find_if(text, [](unsigned char c) { return std::isalnum(c) == 0; });
    begun.attempt.case_id.assign(text.begin(), end);
    text.remove_prefix(begun.attempt.case_id.size());
    if (!skip(begun_resumed)) return std::nullopt;
    begun.resumed = text == "true}}";
    return begun.resumed || text == "false}}" ? std::optional(std::move(begun)) : std::nullopt;
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
    return line(std::visit(Overloaded{[](const Run& run) -> Json {
                                          return {{"run",
                                                   {{"attempt", run.attempt},
                                                    {"id", run.question.id},
                                                    {"scene", run.question.scene},
                                                    {"revision", run.question.revision},
                                                    {"seed", run.question.seed},
                                                    {"inputs", from_inputs(run.question.inputs)}}}};
                                      },
                                      [](const Lease&) -> Json {
                                          return {{"lease", true}};
                                      },
                                      [](const Stop&) -> Json {
                                          return {{"stop", true}};
                                      }},
                           message));
}

std::string encode(const ToBoss& message) {
    if (const auto* begun = std::get_if<Begun>(&message)) return from_begun(*begun);
    return line(std::visit(Overloaded{[](const Ready& ready) -> Json {
                                          return {{"ready", from_ready(ready)}};
                                      },
                                      [](const Begun&) -> Json { return {}; },  // above
                                      [](const Alive& alive) -> Json {
                                          Json object = from_attempt(alive.attempt);
                                          object["progress"] = alive.progress;
                                          return {{"alive", std::move(object)}};
                                      },
                                      [](const Done& done) -> Json {
                                          return {{"done", from_done(done)}};
                                      },
                                      [](const GiveBack& back) -> Json {
                                          Json object = from_attempt(back.attempt);
                                          object["reason"] = back.reason;
                                          if (back.broken) object["broken"] = true;
                                          return {{"give_back", std::move(object)}};
                                      }},
                           message));
}

ToWorker decode_to_worker(std::string_view text) {
    const Json object = parse(text);
    try {
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
    if (auto begun = to_begun(text)) return std::move(*begun);
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
