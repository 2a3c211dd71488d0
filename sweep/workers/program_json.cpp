#include "sweep/workers/program_json.hpp"

#include "sweep/workers/worker_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace grainsweep::workers {
namespace {

using Json = nlohmann::json;

constexpr std::size_t deepest = 100;  // values are copied and shown by recursion

class Builder final : public nlohmann::json_sax<Json> {
public:
    Builder(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    bool null() override { return place(nullptr); }
    bool boolean(bool value) override { return place(value); }
    bool number_integer(number_integer_t value) override { return place(value); }
    bool number_unsigned(number_unsigned_t value) override { return place(value); }
    bool number_float(number_float_t value, const string_t&) override { return place(value); }
    bool binary(binary_t&) override { return false; }
    bool string(string_t& value) override { return place(std::move(value)); }

    bool start_object(std::size_t) override { return open(Json::object()); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        const bool twice = stack_.back().value.contains(name);
        stack_.back().key = std::move(name);
        if (twice) throw std::invalid_argument(fmt::format("{}: {} is there twice", name_, here()));
        return true;
    }

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

    Json result;

private:
    struct Frame {
        Json value;
        std::string key;
    };

    bool place(Json value) {
        if (stack_.empty())
            result = std::move(value);
        else if (stack_.back().value.is_object())
            stack_.back().value[stack_.back().key] = std::move(value);
        else
            stack_.back().value.push_back(std::move(value));
        return true;
    }
    bool open(Json value) {
        if (stack_.size() == deepest)
            throw std::invalid_argument(fmt::format("{} is nested deeper than {} levels", name_, deepest));
        stack_.push_back({std::move(value), {}});
        return true;
    }
    bool close() {
        Json value = std::move(stack_.back().value);
        stack_.pop_back();
        return place(std::move(value));
    }
    /// The JSON pointer of the value that comes next.
    [[nodiscard]] std::string here() const {
        std::string path;
        for (const auto& frame : stack_)
            path += "/" + (frame.value.is_object() ? frame.key : std::to_string(frame.value.size()));
        return path.empty() ? "it" : shortened(path, 100);
    }

    std::string_view text_;
    const std::string& name_;
    std::vector<Frame> stack_;
};

}  // namespace

Json program_json(std::string_view text, const std::string& name) {
    Builder builder(text, name);
    Json::sax_parse(text.begin(), text.end(), &builder);
    return std::move(builder.result);
}

std::string shown_json(const Json& value) {
    return shortened(value.dump(-1, ' ', true, Json::error_handler_t::replace), 60);
}

}  // namespace grainsweep::workers
