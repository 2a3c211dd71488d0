#include "sweep/workers/message.hpp"

#include "solver/scenes/values.hpp"
#include "sweep/campaign/json_writer.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace grainsweep::workers {
namespace {

using Json = nlohmann::json;

// ---- JSON on one line, in one form: members in the order in which `describe` names them
//
// Reading and writing need no document tree, which makes them several times faster. The members of an object are
// described once for both directions: `describe(it, object)` calls it(name, value) for every member.

template <class T>
using ByName = std::map<std::string, T, std::less<>>;

/// Neither ends a text nor begins an escape, and is one byte long.
bool is_plain(char c) {
    return c >= 0x20 && c < 0x7F && c != '"' && c != '\\';
}

bool begins_with_digit(std::string_view text) {
    return !text.empty() && text.front() >= '0' && text.front() <= '9';
}

bool is_real(std::string_view number) {
    return number.find_first_of(".eE") != std::string_view::npos;
}

class MessageWriter {
public:
    template <class T>
    void operator()(std::string_view name, const T& value) {
        separate();
        put(name);
        line += ':';
        put(value);
    }
    /// Writes a member if `there` is true.
    template <class T>
    void maybe(std::string_view name, const T& value, bool there) {
        if (there) (*this)(name, value);
    }

    /// Writes a member as the word of its value.
    template <class T, class ToWord>
    void word(std::string_view name, const T& value, ToWord to_word, const auto&) {
        (*this)(name, to_word(value));
    }

    /// Writes a text. Bytes that are not UTF-8, such as in a library's error text, are replaced.
    void put(std::string_view text) { campaign::append_json(line, text); }
    void put(const std::string& text) { put(std::string_view(text)); }
    /// Writes a real number: with ".0" if it is whole, so that a reader can distinguish it from a count; null if it is
    /// not finite.
    void put(double number) { campaign::append_json(line, number); }
    void put(std::integral auto number) { line += campaign::JsonText(number).text(); }
    void put(const Value& value) {
        std::visit([&](const auto& held) { put(held); }, value);
    }
    void put(const Sample& sample) {
        line += '[';
        for (const double number : {sample.time, sample.bin, sample.value}) separate(), put(number);
        line += ']';
    }
    template <class T>
    void put(const std::optional<T>& value) {
        value ? put(*value) : void(line += "null");
    }
    template <class T>
    void put(const std::vector<T>& list) {
        line += '[';
        for (const auto& value : list) separate(), put(value);
        line += ']';
    }
    template <class T>
    void put(const ByName<T>& values) {
        line += '{';
        for (const auto& [name, value] : values) (*this)(name, value);
        line += '}';
    }
    template <class T>
    requires std::is_class_v<T>
    void put(const T& object) {
        line += '{';
        describe(*this, object);
        line += '}';
    }

    std::string line;

private:
    void separate() {
        if (line.back() != '{' && line.back() != '[') line += ',';
    }
};

/// Reader of such a line. Blanks may stand between words. Every function throws std::invalid_argument at an unexpected
/// character.
class MessageReader {
public:
    explicit MessageReader(std::string_view line) : rest_(line) {}

    template <class T>
    void operator()(std::string_view name, T& into) {
        if (!takes_member(name)) refuse("a member is missing");
        get(into);
    }
    template <class T>
    void maybe(std::string_view name, T& into, bool) {
        if (takes_member(name)) get(into);
    }
    template <class T, class Named>
    void word(std::string_view name, T& into, const auto&, Named named) {
        std::string text;
        (*this)(name, text);
        const auto known = named(text);
        if (!known) refuse("it is an unknown word");
        into = *known;
    }
    [[nodiscard]] bool takes_member(std::string_view name) {
        const auto before = rest_;
        const char last = last_;
        if ((last_ == '{' || takes(",")) && takes("\"") && rest_.starts_with(name)) {
            rest_.remove_prefix(name.size());
            if (rest_.starts_with('"') && takes("\"") && takes(":")) return true;
        }
        rest_ = before;
        last_ = last;
        return false;
    }

    void get(std::string& text) {
        expect("\"");
        auto end = static_cast<std::size_t>(std::ranges::find_if_not(rest_, is_plain) - rest_.begin());
        const bool plain = end < rest_.size() && rest_[end] == '"';
        while (end < rest_.size() && rest_[end] != '"') end += rest_[end] == '\\' ? 2 : 1;
        if (end >= rest_.size()) refuse("a text has no end");
        text = rest_.substr(0, end);
        rest_.remove_prefix(end);
        expect("\"");
        if (plain) return;
        try {
            text = Json::parse("\"" + text + "\"").get<std::string>();
        } catch (const Json::exception& error) {
            refuse(error.what());
        }
    }
    /// NaN for null.
    void get(double& number) {
        number = std::numeric_limits<double>::quiet_NaN();
        if (takes("null")) return;
        const auto word = number_word();
        if (is_real(word)) return number_in(word, number);
        std::int64_t whole = 0;  // as another program may write it
        number_in(word, whole);
        number = static_cast<double>(whole);
    }
    void get(Value& value) {
        (void)takes("");
        if (rest_.starts_with('"')) return get(value.emplace<std::string>());
        const auto word = number_word();
        if (is_real(word))
            number_in(word, value.emplace<double>());
        else
            number_in(word, value.emplace<std::int64_t>());
    }
    void get(Sample& sample) {
        expect("[");
        get(sample.time);
        expect(",");
        get(sample.bin);
        expect(",");
        get(sample.value);
        expect("]");
    }
    void get(bool& set) {
        set = takes("true");
        if (!set) expect("false");
    }
    template <std::integral Whole>
    void get(Whole& number) {
        number_in(number_word(), number);
    }
    template <class T>
    void get(std::optional<T>& value) {
        if (!takes("null")) get(value.emplace());
    }
    template <class T>
    void get(std::vector<T>& list) {
        expect("[");
        while (!takes("]")) separate('['), get(list.emplace_back());
    }
    template <class T>
    void get(ByName<T>& values) {
        expect("{");
        std::string name;
        while (!takes("}")) {
            separate('{');
            get(name);
            expect(":");
            get(values.emplace_hint(values.end(), name, T{})->second);
        }
    }
    template <class T>
    requires std::is_class_v<T>
    void get(T& object) {
        expect("{");
        describe(*this, object);
        expect("}");
    }
    void expect(std::string_view word) {
        if (!takes(word)) refuse("it is no such JSON");
    }
    /// Returns whether only blanks are left.
    [[nodiscard]] bool over() {
        (void)takes("");
        return rest_.empty();
    }
    [[noreturn]] static void refuse(const char* what) { throw std::invalid_argument(what); }

private:
    [[nodiscard]] bool takes(std::string_view word) {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r"), rest_.size()));
        if (!rest_.starts_with(word)) return false;
        rest_.remove_prefix(word.size());
        if (!word.empty()) last_ = word.back();
        return true;
    }
    /// Takes the comma between two values or members.
    void separate(char opening) {
        if (last_ != opening) expect(",");
    }
    [[nodiscard]] std::string_view number_word() {
        (void)takes("");
        const auto found = rest_.substr(0, rest_.find_first_not_of("0123456789+-.eE"));
        rest_.remove_prefix(found.size());
        last_ = '0';
        return found;
    }
    template <class Number>
    static void number_in(std::string_view word, Number& number) {
        if (!is_number(word)) refuse("it is no number");
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size()) refuse("it is no such number");
    }
    [[nodiscard]] static bool is_number(std::string_view word) {
        const auto digits = word.starts_with('-') ? word.substr(1) : word;
        const auto point = digits.find('.');
        return begins_with_digit(digits) && !(digits.front() == '0' && begins_with_digit(digits.substr(1))) &&
               (point == std::string_view::npos || begins_with_digit(digits.substr(point + 1)));
    }

    std::string_view rest_;
    char last_ = '\0';  ///< last character read
};

// ---- members of each message, sorted by name; `it` writes or reads them

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

// ---- messages

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
    MessageWriter to;
    to.line.reserve(512);
    to.line = '{';
    std::visit([&](const auto& one) { to(one.word, body(one)); }, message);
    to.line += '}';
    return std::move(to.line);
}

template <class... Messages>
void decode(std::string_view line, std::variant<Messages...>& into) {
    MessageReader from(line);
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
