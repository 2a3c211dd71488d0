#include "sweep/workers/message_form.hpp"

#include "sweep/campaign/json_writer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

namespace grainsweep::workers {
namespace {

/// Neither ends a text nor begins an escape, and is one byte long.
bool is_plain(char c) {
    return c >= 0x20 && c < 0x7F && c != '"' && c != '\\';
}

class Writer {
public:
    explicit Writer(std::string_view start) : text_(start) { text_.reserve(512); }

    Writer& raw(std::string_view words) {
        text_ += words;
        return *this;
    }
    Writer& text(std::string_view words) {
        campaign::append_json(text_, words);  // invalid UTF-8 (of a library's error text, say) must not lose a result
        return *this;
    }
    template <std::integral Whole>
    Writer& whole(Whole number) {
        campaign::append_json(text_, std::conditional_t<std::is_signed_v<Whole>, std::int64_t, std::uint64_t>{number});
        return *this;
    }
    /// With a point or an exponent, so that the reader can tell a count from a real; what is not finite is null.
    Writer& real(double number) {
        campaign::append_json(text_, number);
        return *this;
    }
    Writer& value(const Value& held) {
        if (const auto* number = std::get_if<double>(&held)) return real(*number);
        if (const auto* count = std::get_if<std::int64_t>(&held)) return whole(*count);
        return text(std::get<std::string>(held));
    }
    Writer& flag(bool set) { return raw(set ? "true" : "false"); }
    /// {"name":..., ...}
    template <class Map, class Write>
    Writer& object(const Map& map, Write&& write) {
        text_ += '{';
        bool first = true;
        for (const auto& [name, held] : map) {
            if (!std::exchange(first, false)) text_ += ',';
            text(name);
            text_ += ':';
            write(held);
        }
        text_ += '}';
        return *this;
    }
    [[nodiscard]] std::string take() { return std::move(text_); }

private:
    std::string text_;
};

/// Every member returns whether the line goes on so, and steps over it where it does.
class Reader {
public:
    explicit Reader(std::string_view line) : rest_(line) {}

    bool raw(std::string_view words) {
        if (!rest_.starts_with(words)) return false;
        rest_.remove_prefix(words.size());
        return true;
    }
    [[nodiscard]] bool over() const { return rest_.empty(); }

    bool text(std::string& words) {
        if (!raw("\"")) return false;
        const auto end = std::ranges::find_if_not(rest_, is_plain);
        words.assign(rest_.begin(), end);
        rest_.remove_prefix(words.size());
        return raw("\"");
    }
    template <class Whole>
    bool whole(Whole& number) {
        return digits(number, token());
    }
    bool real(double& number) {
        const auto word = token();
        if (word.find_first_of(".eE") != std::string_view::npos) return digits(number, word);
        std::int64_t count = 0;  // as another program may write it
        if (!digits(count, word)) return false;
        number = static_cast<double>(count);
        return true;
    }
    bool real_or_null(double& number) {
        number = std::numeric_limits<double>::quiet_NaN();
        return raw("null") || real(number);
    }
    bool value(Value& held) {
        if (rest_.starts_with('"')) return text(held.emplace<std::string>());
        const auto word = token();
        if (word.find_first_of(".eE") != std::string_view::npos) return digits(held.emplace<double>(), word);
        return digits(held.emplace<std::int64_t>(), word);
    }
    bool flag(bool& set) {
        set = raw("true");
        return set || raw("false");
    }
    template <class Read>
    bool object(Read&& read) {
        if (!raw("{")) return false;
        if (raw("}")) return true;
        std::string name;
        do {
            if (!text(name) || !raw(":") || !read(name)) return false;
        } while (raw(","));
        return raw("}");
    }
    template <class Read>
    bool array(Read&& read) {
        if (!raw("[")) return false;
        if (raw("]")) return true;
        do {
            if (!read()) return false;
        } while (raw(","));
        return raw("]");
    }

private:
    /// The characters of a number, taken.
    std::string_view token() {
        constexpr std::string_view of_numbers = "0123456789+-.eE";
        const auto word = rest_.substr(0, rest_.find_first_not_of(of_numbers));
        rest_.remove_prefix(word.size());
        return word;
    }
    /// The whole word, as JSON writes numbers.
    template <class Number>
    static bool digits(Number& number, std::string_view word) {
        const std::string_view plain = word.starts_with('-') ? word.substr(1) : word;
        if (plain.empty() || plain.front() < '0' || plain.front() > '9') return false;
        if (plain.size() > 1 && plain[0] == '0' && plain[1] >= '0' && plain[1] <= '9') return false;
        if (const auto point = plain.find('.'); point != std::string_view::npos)
            if (point + 1 == plain.size() || plain[point + 1] < '0' || plain[point + 1] > '9') return false;
        const auto read = std::from_chars(word.data(), word.data() + word.size(), number);
        return read.ec == std::errc() && read.ptr == word.data() + word.size();
    }

    std::string_view rest_;
};

template <class Map, class Held>
bool add(Map& map, std::string name, Held&& held) {
    const std::size_t before = map.size();
    map.emplace_hint(map.end(), std::move(name), std::forward<Held>(held));
    return map.size() > before;  // a name that is there twice is another reader's
}

bool read_samples(Reader& line, std::vector<Sample>& samples) {
    return line.array([&] {
        Sample one;
        const bool read = line.raw("[") && line.real_or_null(one.time) && line.raw(",") && line.real_or_null(one.bin) &&
                          line.raw(",") && line.real_or_null(one.value) && line.raw("]");
        samples.push_back(one);
        return read;
    });
}

bool read_observations(Reader& line, Observations& observations) {
    const auto scalar = [&](std::string& name) {
        double value = 0;
        return line.real_or_null(value) && add(observations.scalars, std::move(name), value);
    };
    const auto series = [&](std::string& name) {
        std::vector<Sample> samples;
        return read_samples(line, samples) && add(observations.series, std::move(name), std::move(samples));
    };
    return line.raw(R"({"scalars":)") && line.object(scalar) && line.raw(R"(,"series":)") && line.object(series) &&
           line.raw("}");
}

bool read_cost(Reader& line, Cost& cost) {
    const auto phase = [&](std::string& name) {
        double seconds = 0;
        return line.real(seconds) && add(cost.phases, std::move(name), seconds);
    };
    return line.raw(R"({"cpu":)") && line.real(cost.cpu_seconds) && line.raw(R"(,"phases":)") && line.object(phase) &&
           line.raw(R"(,"steps":)") && line.real(cost.particle_steps) && line.raw(R"(,"threads":)") &&
           line.real_or_null(cost.threads) && line.raw(R"(,"wall":)") && line.real(cost.wall_seconds) && line.raw("}");
}

/// Of an attempt that a program answered; nothing where there is nothing.
bool read_program(Reader& line, std::optional<campaign::ProgramFacts>& program) {
    if (!line.raw(R"(,"program":{"memory":)")) return true;
    auto& facts = program.emplace();
    if (!line.real_or_null(facts.peak_memory) || !line.raw(R"(,"status":)")) return false;
    if (!line.raw("null") && !line.whole(facts.exit_status.emplace())) return false;
    return line.raw(R"(,"version":)") && line.text(facts.version) && line.raw("}");
}

}  // namespace

std::string in_form(const Run& run) {
    Writer line(R"({"run":{"attempt":)");
    line.whole(run.attempt).raw(R"(,"id":)").text(run.question.id).raw(R"(,"inputs":)");
    line.object(run.question.inputs, [&](const Value& held) { line.value(held); });
    line.raw(R"(,"revision":)").whole(run.question.revision).raw(R"(,"scene":)").text(run.question.scene);
    line.raw(R"(,"seed":)").whole(run.question.seed).raw("}}");
    return line.take();
}

std::optional<Run> run_in_form(std::string_view text) {
    Reader line(text);
    Run run;
    auto& asked = run.question;
    const auto input = [&](std::string& name) {
        Value held;
        return line.value(held) && add(asked.inputs, std::move(name), std::move(held));
    };
    const bool read = line.raw(R"({"run":{"attempt":)") && line.whole(run.attempt) && line.raw(R"(,"id":)") &&
                      line.text(asked.id) && line.raw(R"(,"inputs":)") && line.object(input) &&
                      line.raw(R"(,"revision":)") && line.whole(asked.revision) && line.raw(R"(,"scene":)") &&
                      line.text(asked.scene) && line.raw(R"(,"seed":)") && line.whole(asked.seed) && line.raw("}}") &&
                      line.over();
    return read ? std::optional(std::move(run)) : std::nullopt;
}

std::string in_form(const Begun& begun) {
    Writer line(R"({"begun":{"attempt":)");
    line.whole(begun.attempt.number).raw(R"(,"id":)").text(begun.attempt.case_id);
    return line.raw(R"(,"resumed":)").flag(begun.resumed).raw("}}").take();
}

std::optional<Begun> begun_in_form(std::string_view text) {
    Reader line(text);
    Begun begun;
    const bool read = line.raw(R"({"begun":{"attempt":)") && line.whole(begun.attempt.number) &&
                      line.raw(R"(,"id":)") && line.text(begun.attempt.case_id) && line.raw(R"(,"resumed":)") &&
                      line.flag(begun.resumed) && line.raw("}}") && line.over();
    return read ? std::optional(std::move(begun)) : std::nullopt;
}

std::string in_form(const Done& done) {
    const auto& [attempt, outcome, message, observations, cost, program] = done.result;
    Writer line(R"({"done":{"attempt":)");
    const auto real = [&](double number) { line.real(number); };
    line.whole(attempt.number).raw(R"(,"checkpointed":)").flag(done.checkpointed);
    line.raw(R"(,"cost":{"cpu":)").real(cost.cpu_seconds).raw(R"(,"phases":)").object(cost.phases, real);
    line.raw(R"(,"steps":)").real(cost.particle_steps).raw(R"(,"threads":)").real(cost.threads);
    line.raw(R"(,"wall":)").real(cost.wall_seconds);
    line.raw(R"(},"id":)").text(attempt.case_id).raw(R"(,"message":)").text(message);
    line.raw(R"(,"observations":{"scalars":)").object(observations.scalars, real);
    line.raw(R"(,"series":)").object(observations.series, [&](const std::vector<Sample>& samples) {
        line.raw("[");
        for (std::size_t k = 0; k < samples.size(); ++k) {
            line.raw(k == 0 ? "[" : ",[").real(samples[k].time).raw(",").real(samples[k].bin);
            line.raw(",").real(samples[k].value).raw("]");
        }
        line.raw("]");
    });
    line.raw(R"(},"outcome":)").text(campaign::to_string(outcome));
    if (program) {
        line.raw(R"(,"program":{"memory":)").real(program->peak_memory).raw(R"(,"status":)");
        if (program->exit_status)
            line.whole(*program->exit_status);
        else
            line.raw("null");
        line.raw(R"(,"version":)").text(program->version).raw("}");
    }
    return line.raw("}}").take();
}

std::optional<Done> done_in_form(std::string_view text) {
    Reader line(text);
    Done done;
    auto& [attempt, outcome, message, observations, cost, program] = done.result;
    std::string word;
    const bool read = line.raw(R"({"done":{"attempt":)") && line.whole(attempt.number) &&
                      line.raw(R"(,"checkpointed":)") && line.flag(done.checkpointed) && line.raw(R"(,"cost":)") &&
                      read_cost(line, cost) && line.raw(R"(,"id":)") && line.text(attempt.case_id) &&
                      line.raw(R"(,"message":)") && line.text(message) && line.raw(R"(,"observations":)") &&
                      read_observations(line, observations) && line.raw(R"(,"outcome":)") && line.text(word) &&
                      read_program(line, program) && line.raw("}}") && line.over();
    const auto known = campaign::outcome_named(word);
    if (!read || !known) return std::nullopt;
    outcome = *known;
    return done;
}

}  // namespace grainsweep::workers
