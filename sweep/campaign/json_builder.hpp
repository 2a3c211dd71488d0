// Builder of a JSON document from a parser's events. It refuses repeated keys and too deep nesting at their place; the
// derived reader writes the messages.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::campaign {

class JsonBuilder : public nlohmann::json_sax<nlohmann::json> {
public:
    using Json = nlohmann::json;

    explicit JsonBuilder(std::size_t deepest) : deepest_(deepest) {}

    bool null() final { return place(nullptr); }
    bool boolean(bool value) final { return place(value); }
    bool number_integer(number_integer_t value) final { return place(value); }
    bool number_unsigned(number_unsigned_t value) final { return place(value); }
    bool number_float(number_float_t value, const string_t&) final { return place(value); }
    bool binary(binary_t&) final { return false; }
    bool string(string_t& value) override { return place(std::move(value)); }
    bool start_object(std::size_t) final { return open(Json::object()); }
    bool start_array(std::size_t) final { return open(Json::array()); }
    bool end_object() final { return close(); }
    bool end_array() final { return close(); }
    bool key(string_t& name) final {
        const bool twice = stack_.back().value.contains(name);
        stack_.back().key = std::move(name);
        if (twice) refuse_twice();
        return true;
    }

    Json result;

protected:
    struct Frame {
        Json value;       ///< incomplete object or list
        std::string key;  ///< in an object: key of the next value
    };
    /// Returns the open objects and lists, the outermost first.
    [[nodiscard]] const std::vector<Frame>& frames() const { return stack_; }
    /// Throws because the last key is repeated.
    virtual void refuse_twice() const = 0;
    /// Throws because the nesting is too deep.
    virtual void refuse_depth() const = 0;

private:
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
        if (stack_.size() == deepest_) refuse_depth();
        stack_.push_back({std::move(value), {}});
        return true;
    }
    bool close() {
        Json value = std::move(stack_.back().value);
        stack_.pop_back();
        return place(std::move(value));
    }

    std::size_t deepest_;
    std::vector<Frame> stack_;
};

}  // namespace grainsweep::campaign
