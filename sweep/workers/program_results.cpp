#include "sweep/workers/program_results.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/json_builder.hpp"
#include "sweep/workers/program_tables.hpp"
#include "sweep/workers/worker_state.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

namespace grainsweep::workers {
namespace {

using campaign::Program;
using campaign::ProgramObservable;
using Json = nlohmann::json;
using Kind = ProgramReply::Kind;

/// Error: the text is not JSON.
class NoJson : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/// Returns a value as a short printable text for messages.
std::string shown_json(const Json& value) {
    return shortened(value.dump(-1, ' ', true, Json::error_handler_t::replace), 60);
}

constexpr std::size_t deepest = 100;  // values are copied and shown by recursion

/// Reader of JSON that a program wrote. Refuses numbers outside double precision, repeated keys and too deep nesting,
/// with their place as a JSON pointer.
class ProgramJson final : public campaign::JsonBuilder {
public:
    ProgramJson(std::string_view text, const std::string& name) : JsonBuilder(deepest), text_(text), name_(name) {}

    bool parse_error(std::size_t position, const std::string& token, const Json::exception& error) override {
        constexpr int number_overflow = 406;
        if (error.id == number_overflow)
            throw std::invalid_argument(
                fmt::format("{}: {} is {}, which is no number", name_, here(), shortened(token, 60)));
        const auto near = text_.substr(std::min(text_.size(), position > 12 ? position - 12 : 0), 24);
        for (const char* word : {"NaN", "nan", "Infinity", "inf"})
            if (near.find(word) != std::string_view::npos)
                throw std::invalid_argument(
                    fmt::format("{}: {} is {}, which is no number (byte {})", name_, here(), word, position));
        throw NoJson(fmt::format("{} is no JSON at byte {}: {}", name_, position, shown_json(std::string(near))));
    }

private:
    void refuse_twice() const override {
        throw std::invalid_argument(fmt::format("{}: {} is there twice", name_, here()));
    }
    void refuse_depth() const override {
        throw std::invalid_argument(fmt::format("{} is nested deeper than {} levels", name_, deepest));
    }
    /// The JSON pointer of the value that comes next.
    [[nodiscard]] std::string here() const {
        std::string path;
        for (const auto& frame : frames())
            path += "/" + (frame.value.is_object() ? frame.key : std::to_string(frame.value.size()));
        return path.empty() ? "it" : shortened(path, 100);
    }

    std::string_view text_;
    const std::string& name_;
};

/// Returns the parsed text. `name` stands before the place in messages. Throws NoJson, or std::invalid_argument for
/// JSON that is refused.
Json program_json(std::string_view text, const std::string& name) {
    ProgramJson builder(text, name);
    Json::sax_parse(text.begin(), text.end(), &builder);
    return std::move(builder.result);
}

constexpr std::size_t largest_json = std::size_t{16} << 20U;

/// Error for a value that is missing or unusable, for which the case is rejected.
using Unusable = std::invalid_argument;

double number_in(const Json& value, const std::string& place) {
    if (value.is_null()) throw NoValue(fmt::format("{} is null, which is no number", place));
    if (!value.is_number()) throw Unusable(fmt::format("{} is {}, which is no number", place, shown_json(value)));
    const auto number = value.get<double>();
    if (!std::isfinite(number)) throw Unusable(fmt::format("{} is beyond double precision", place));
    return number;
}

/// Files read once for all that is found in them.
class Documents {
public:
    Documents(const ProgramFolder& folder, const Program& program) : folder_(folder), program_(program) {}
    const Json& json(const std::string& name) {
        if (const auto known = json_.find(name); known != json_.end()) return known->second;
        return json_.emplace(name, program_json(written(name, largest_json), name)).first->second;
    }
    ProgramTable& table(const std::string& name, const std::string& separator) {
        auto& known = tables_[{name, separator}];
        if (known) return *known;
        known = std::make_unique<ProgramTable>(name, written(name, largest_table), separator);
        return *known;
    }
    [[nodiscard]] const ProgramFolder& folder() const { return folder_; }

private:
    /// Returns the contents of a file of results. A file that was copied into the folder has results only once the
    /// program has changed it.
    [[nodiscard]] std::string written(const std::string& name, std::size_t most_bytes) const {
        std::string why;
        auto text = folder_.read(name, most_bytes, why);
        if (!text && !folder_.has(name)) throw NoValue(fmt::format("{} {}", name, why));
        if (!text) throw Unusable(fmt::format("{} {}", name, why));
        const auto copied = std::ranges::find(program_.files, name, &campaign::ProgramFile::name);
        if (copied != program_.files.end() && copied->hash == campaign::content_hash(*text))
            throw Unusable(fmt::format("{} was not written: it is the file that was copied into the folder", name));
        return std::move(*text);
    }

    const ProgramFolder& folder_;
    const Program& program_;
    std::map<std::string, Json> json_;
    std::map<std::pair<std::string, std::string>, std::unique_ptr<ProgramTable>> tables_;
};

const Json& value_at(const Json& document, const std::string& file, const std::string& path) {
    try {
        return document.at(Json::json_pointer(path));
    } catch (const Json::exception&) {  // of an index too large for any list, too
        throw NoValue(fmt::format("{} has no {}", file, path));
    }
}

std::vector<double> numbers_at(const Json& document, const std::string& file, const std::string& path) {
    const auto& list = value_at(document, file, path);
    if (!list.is_array()) throw Unusable(fmt::format("{}: {} is {}, which is no list", file, path, shown_json(list)));
    std::vector<double> numbers;
    numbers.reserve(list.size());
    for (const auto& value : list)
        numbers.push_back(number_in(value, fmt::format("{}: {}/{}", file, path, numbers.size())));
    return numbers;
}

/// Where a scalar was found, for messages, and its value; or values and their places.
struct Found {
    double value = 0;
    std::vector<double> values, places;
};

Found find(const campaign::FromJson& from, bool scalar, Documents& documents) {
    const auto& document = documents.json(from.file);
    if (scalar)
        return {
            number_in(value_at(document, from.file, from.path), fmt::format("{}: {}", from.file, from.path)), {}, {}};
    Found found{0, numbers_at(document, from.file, from.path), numbers_at(document, from.file, from.over)};
    if (found.values.size() != found.places.size())
        throw Unusable(fmt::format("{}: {} has {} values and {} has {}", from.file, from.path, found.values.size(),
                                   from.over, found.places.size()));
    return found;
}

Found find(const campaign::FromCsv& from, bool scalar, Documents& documents) {
    auto& table = documents.table(from.file, from.separator);
    if (scalar) return {table.value(from.column, from.row), {}, {}};
    return {0, table.column(from.column), table.column(from.over)};
}

Found find(const campaign::FromOutput& from, bool, Documents& documents) {
    return {last_in_output(documents.folder(), from.pattern), {}, {}};
}

Found find(const campaign::FromReply&, bool, Documents&) {
    throw std::logic_error("a reply has no file");
}

void add_found(const ProgramObservable& declared, Found&& found, Observations& into) {
    const auto check = [&](double value, std::size_t k) {
        if (declared.bounds.contains(value)) return;
        const auto number = declared.shape == Shape::scalar ? "" : fmt::format(" number {}", k);
        throw Unusable(fmt::format("{}{} is {}, outside of its bounds {} to {}", declared.name, number, value,
                                   declared.bounds.low, declared.bounds.high));
    };
    if (declared.shape == Shape::scalar) {
        check(found.value, 0);
        into.scalars[declared.name] = found.value;
        return;
    }
    auto& samples = into.series[declared.name];
    samples.resize(found.values.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
        check(found.values[k], k);
        samples[k].value = found.values[k];
        (declared.shape == Shape::series ? samples[k].time : samples[k].bin) = found.places[k];
    }
}

/// "outcome" and "message" of an object that says what became of the case itself; nothing: it was measured.
std::optional<ProgramReply> said_in(const Json& object, const std::string& file) {
    if (!object.is_object() || !object.contains("outcome")) return std::nullopt;
    const auto& word = object["outcome"];
    std::string message = "the program says so";
    if (const auto why = object.find("message"); why != object.end() && why->is_string()) message = *why;
    if (word == "completed") return std::nullopt;
    if (word == "unstable") return ProgramReply{Kind::unstable, std::move(message), {}};
    if (word == "rejected") return ProgramReply{Kind::rejected, std::move(message), {}};
    throw Unusable(
        fmt::format("{}: /outcome is {}, and it may be completed, unstable or rejected", file, shown_json(word)));
}

/// Pairs [place, value].
Found pairs_in(const Json& list, const std::string& name) {
    if (!list.is_array()) throw Unusable(fmt::format("its {} is {}, which is no list", name, shown_json(list)));
    Found found;
    for (const auto& pair : list) {
        const auto place = fmt::format("its {} number {}", name, found.values.size());
        if (!pair.is_array() || pair.size() != 2)
            throw Unusable(fmt::format("{} is {}, which is no pair of place and value", place, shown_json(pair)));
        found.places.push_back(number_in(pair[0], place));
        found.values.push_back(number_in(pair[1], place));
    }
    return found;
}

ProgramReply measured_in(const Json& object, const Program& program) {
    const auto observables = object.find("observables");
    if (observables == object.end() || !observables->is_object())
        throw Unusable("it replied neither \"observables\" nor an \"outcome\"");
    for (const auto& [name, value] : observables->items())
        if (std::ranges::find(program.observables, name, &ProgramObservable::name) == program.observables.end())
            throw Unusable(fmt::format("it measured '{}', which is not declared", shortened(name, 100)));
    ProgramReply reply;
    for (const auto& declared : program.observables) {
        const auto value = observables->find(declared.name);
        if (declared.optional && (value == observables->end() || value->is_null())) continue;
        if (value == observables->end()) throw Unusable(fmt::format("it replied without {}", declared.name));
        if (declared.shape == Shape::scalar)
            add_found(declared, {number_in(*value, "its " + declared.name), {}, {}}, reply.observations);
        else
            add_found(declared, pairs_in(*value, declared.name), reply.observations);
    }
    return reply;
}

std::optional<ProgramReply> said_in_files(const Program& program, Documents& documents) {
    if (documents.folder().has("outcome.json")) {
        if (auto said = said_in(documents.json("outcome.json"), "outcome.json")) return said;
    }
    for (const auto& declared : program.observables) {
        const auto* from = std::get_if<campaign::FromJson>(&declared.from);
        if (from == nullptr || !documents.folder().has(from->file)) continue;
        if (auto said = said_in(documents.json(from->file), from->file)) return said;
    }
    return std::nullopt;
}

}  // namespace

ProgramReply results_in(const ProgramFolder& folder, const Program& program) {
    Documents documents(folder, program);
    try {
        if (auto said = said_in_files(program, documents)) return std::move(*said);
        ProgramReply reply;
        for (const auto& declared : program.observables) {
            const auto find_it = [&](const auto& from) {
                return find(from, declared.shape == Shape::scalar, documents);
            };
            try {
                add_found(declared, std::visit(find_it, declared.from), reply.observations);
            } catch (const NoValue&) {
                if (!declared.optional) throw;
            }
        }
        return reply;
    } catch (const Unusable& why) {
        return {Kind::rejected, why.what(), {}};
    }
}

ProgramReply results_in(std::string_view line, std::string_view case_id, const Program& program) {
    Json object;
    try {
        object = program_json(line, "its reply");
    } catch (const NoJson&) {
        object = nullptr;
    } catch (const Unusable& why) {
        return {Kind::rejected, why.what(), {}};
    }
    if (!object.is_object())
        throw Unusable(
            fmt::format("it replied what is no JSON object: {}", shown_json(std::string(line.substr(0, 200)))));
    const auto of = object.find("case");
    if (of != object.end() && *of != case_id)
        throw Unusable(fmt::format("it replied to case {}, which was not asked", shown_json(*of)));
    ProgramReply reply;
    try {
        auto said = said_in(object, "its reply");
        reply = said ? std::move(*said) : measured_in(object, program);
    } catch (const Unusable& why) {
        reply = {Kind::rejected, why.what(), {}};
    }
    reply.names_case = of != object.end();
    return reply;
}

}  // namespace grainsweep::workers
