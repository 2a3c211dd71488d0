#include "sweep/workers/program_json.hpp"

#include "sweep/campaign/json_builder.hpp"
#include "sweep/workers/worker_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace grainsweep::workers {
namespace {

using Json = nlohmann::json;

constexpr std::size_t deepest = 100;  // values are copied and shown by recursion

/// Names places by JSON pointers.
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

}  // namespace

Json program_json(std::string_view text, const std::string& name) {
    ProgramJson builder(text, name);
    Json::sax_parse(text.begin(), text.end(), &builder);
    return std::move(builder.result);
}

std::string shown_json(const Json& value) {
    return shortened(value.dump(-1, ' ', true, Json::error_handler_t::replace), 60);
}

}  // namespace grainsweep::workers
