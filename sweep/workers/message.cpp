#include "sweep/workers/message.hpp"

#include "sweep/workers/json_line.hpp"

#include <charconv>
#include <concepts>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

// Members of each message, sorted by name; `it` writes or reads them.
namespace grainsweep::workers::json_line {

template <class T, class Message>
concept Of = std::same_as<std::remove_const_t<T>, Message>;

void describe(auto& it, Of<Run> auto& run) {
    it("attempt", run.attempt);
    it("id", run.question.id);
    it("inputs", run.question.inputs);
    it("revision", run.question.revision);
    it("scene", run.question.scene);
    it("seed", run.question.seed);
}

void describe(auto& it, Of<Ready> auto& ready) {
    auto& by = ready.computer;
    it("build", by.build);
    it("commit", by.commit);
    it("host", by.host);
    it("path", by.instruction_path);
    it("processor", by.processor);
    it("protocol", ready.protocol);
    it("version", by.version);
}

void describe(auto& it, Of<Begun> auto& begun) {
    it("attempt", begun.attempt.number);
    it("id", begun.attempt.case_id);
    it("resumed", begun.resumed);
}

void describe(auto& it, Of<Alive> auto& alive) {
    it("attempt", alive.attempt.number);
    it("id", alive.attempt.case_id);
    it("progress", alive.progress);
}

void describe(auto& it, Of<GiveBack> auto& back) {
    it("attempt", back.attempt.number);
    it.maybe("broken", back.broken, back.broken);
    it("id", back.attempt.case_id);
    it("reason", back.reason);
}

void describe(auto& it, Of<Cost> auto& cost) {
    it("cpu", cost.cpu_seconds);
    it("phases", cost.phases);
    it("steps", cost.particle_steps);
    it.maybe("threads", cost.threads, true);  // a spool may hold older answers, without
    it("wall", cost.wall_seconds);
}

void describe(auto& it, Of<Observations> auto& observations) {
    it("scalars", observations.scalars);
    it("series", observations.series);
}

void describe(auto& it, Of<campaign::ProgramFacts> auto& facts) {
    it("memory", facts.peak_memory);
    it("status", facts.exit_status);
    it("version", facts.version);
}

void describe(auto& it, Of<Done> auto& done) {
    auto& result = done.result;
    it("attempt", result.attempt.number);
    it("checkpointed", done.checkpointed);
    it("cost", result.cost);
    it("id", result.attempt.case_id);
    it("message", result.message);
    it("observations", result.observations);
    it.word("outcome", result.outcome, campaign::to_string, campaign::outcome_named);
    it.maybe("program", result.program, result.program.has_value());
}

}  // namespace grainsweep::workers::json_line

namespace grainsweep::workers {
namespace {

/// Contents of a message after its word.
template <class Message>
auto& body(Message& message) {
    if constexpr (requires { message.set; })
        return message.set;
    else if constexpr (requires { message.count; })
        return message.count;
    else
        return message;
}

template <class... Messages>
std::string encoded(const std::variant<Messages...>& message) {
    json_line::Writer to;
    to.line.reserve(512);
    to.line = '{';
    std::visit([&](const auto& one) { to(one.word, body(one)); }, message);
    to.line += '}';
    return std::move(to.line);
}

template <class... Messages>
void decode(std::string_view line, std::variant<Messages...>& into) {
    json_line::Reader from(line);
    from.expect("{");
    const auto takes = [&]<class Message>(std::in_place_type_t<Message>) {
        if (!from.takes_member(Message::word)) return false;
        from.get(body(into.template emplace<Message>()));
        return true;
    };
    if (!(takes(std::in_place_type<Messages>) || ...)) throw std::invalid_argument("it is none of the messages");
    from.expect("}");
    if (!from.over()) throw std::invalid_argument("more follows the message");
}

/// The number of the protocol in a Ready that has another form; before there was one, 1.
std::optional<std::int64_t> foreign_protocol(std::string_view line) {
    constexpr std::string_view ready = "{\"ready\":", protocol = "\"protocol\":";
    if (!line.starts_with(ready) || !line.ends_with("}}")) return std::nullopt;
    std::int64_t number = 1;
    if (const auto at = line.find(protocol); at != std::string_view::npos)
        std::from_chars(line.data() + at + protocol.size(), line.data() + line.size(), number);
    return number == protocol_number ? std::nullopt : std::optional(number);
}

}  // namespace

std::string encode(const ToWorker& message) {
    return encoded(message);
}

std::string encode(const ToBoss& message) {
    return encoded(message);
}

ToWorker decode_to_worker(std::string_view line) {
    ToWorker message;
    decode(line, message);
    if (const auto* threads = std::get_if<Threads>(&message))
        if (threads->count < 1 || threads->count > most_threads) throw std::invalid_argument("no number of threads");
    return message;
}

ToBoss decode_to_boss(std::string_view line) {
    ToBoss message;
    if (const auto other = foreign_protocol(line)) return Ready{*other, {}};
    decode(line, message);
    return message;
}

}  // namespace grainsweep::workers
