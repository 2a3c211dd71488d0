// JSON on one line, in one form: members in the order in which `describe` names them. Reading and writing need no
// document tree, which makes them several times faster. The members of an object are described once for both
// directions: `describe(it, object)` calls it(name, value) for every member.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/campaign/json_writer.hpp"

#include <charconv>
#include <concepts>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace grainsweep::workers::json_line {

template <class T>
using ByName = std::map<std::string, T, std::less<>>;

class Writer {
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
    void put(const Value& value);
    void put(const Sample& sample);
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
class Reader {
public:
    explicit Reader(std::string_view line) : rest_(line) {}

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
    [[nodiscard]] bool takes_member(std::string_view name);

    void get(std::string& text);
    void get(double& number);  ///< NaN for null
    void get(Value& value);
    void get(Sample& sample);
    void get(bool& set);
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
    void expect(std::string_view word);
    /// Returns whether only blanks are left.
    [[nodiscard]] bool over();
    [[noreturn]] static void refuse(const char* what);

private:
    [[nodiscard]] bool takes(std::string_view word);
    /// Takes the comma between two values or members.
    void separate(char opening) {
        if (last_ != opening) expect(",");
    }
    [[nodiscard]] std::string_view number_word();
    template <class Number>
    static void number_in(std::string_view word, Number& number) {
        if (!is_number(word)) refuse("it is no number");
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size()) refuse("it is no such number");
    }
    [[nodiscard]] static bool is_number(std::string_view word);

    std::string_view rest_;
    char last_ = '\0';  ///< last character read
};

}  // namespace grainsweep::workers::json_line
