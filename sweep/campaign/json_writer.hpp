// Writer of JSON as text, joined from values and shorter texts. It writes the same bytes as nlohmann's dump() without
// spaces, and compiles faster. Keys keep their order. A double has a point or an exponent and reads back as the same
// double; infinities and NaN are null. Bytes that are no UTF-8 become U+FFFD.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <type_traits>

namespace grainsweep::campaign {

void append_json(std::string& to, double number);
void append_json(std::string& to, std::int64_t whole);
void append_json(std::string& to, std::uint64_t whole);
void append_json(std::string& to, std::string_view words);

template <class T>
concept WholeNumber = std::integral<T> && !std::same_as<T, bool>;

/// JSON value as text.
class JsonText {
public:
    struct Member;

    JsonText();  ///< null
    JsonText(const JsonText&);
    JsonText(JsonText&&) noexcept;
    JsonText& operator=(const JsonText&);
    JsonText& operator=(JsonText&&) noexcept;
    ~JsonText();

    JsonText(std::nullptr_t) : JsonText() {}
    JsonText(std::same_as<bool> auto flag) : text_(flag ? "true" : "false") {}
    JsonText(double number) { append_json(text_, number); }
    template <WholeNumber Whole>
    JsonText(Whole whole) {
        append_json(text_,
                    static_cast<std::conditional_t<std::signed_integral<Whole>, std::int64_t, std::uint64_t>>(whole));
    }
    JsonText(std::string_view words) { append_json(text_, words); }
    JsonText(const std::string& words) : JsonText(std::string_view(words)) {}
    JsonText(const char* words) : JsonText(std::string_view(words)) {}
    /// Makes null if there is no value.
    template <class T>
    JsonText(const std::optional<T>& value) : JsonText(value ? JsonText(*value) : JsonText()) {}
    /// Makes a list.
    template <std::ranges::input_range Values>
    requires(!std::convertible_to<const Values&, std::string_view> &&
             !std::same_as<std::remove_cvref_t<std::ranges::range_reference_t<const Values>>, Values>)
        JsonText(const Values& values)
        : JsonText(list(values, std::identity())) {}
    /// Makes an object.
    JsonText(std::initializer_list<Member> members);

    [[nodiscard]] static JsonText array();
    [[nodiscard]] static JsonText object();
    /// Returns the list of make(value) for each value.
    template <std::ranges::input_range Values, class Make>
    [[nodiscard]] static JsonText list(Values&& values, Make make) {
        JsonText all = array();
        for (auto&& value : values) all.push_back(std::invoke(make, value));
        return all;
    }

    /// Appends to a list.
    void push_back(const JsonText& value);
    /// Adds a member to an object without this key; null becomes an object.
    JsonText& add(std::string_view name, const JsonText& value);
    /// Adds every member of another object.
    JsonText& add(const JsonText& object);

    /// Returns whether it is an empty list or object.
    [[nodiscard]] bool empty() const { return text_ == "[]" || text_ == "{}"; }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_;
};

struct JsonText::Member {
    std::string_view name;
    JsonText value;
};

}  // namespace grainsweep::campaign
