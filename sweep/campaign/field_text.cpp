#include "sweep/campaign/field_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace grainsweep::campaign {

std::string default_text(const Type& type, const Field& field) {
    if (!field.standard.empty() || field.required) return std::string(field.standard);
    if (type.initial == nullptr || field.at == nullptr || field.optional) return {};
    const void* value = field.at(const_cast<void*>(type.initial()));  // at() of these fields only takes an address
    switch (field.kind) {
        case Field::Kind::quantity: {
            const double number = *static_cast<const double*>(value);
            return std::isfinite(number) && field.bounds.contains(number) ? fmt::format("{}", number) : std::string();
        }
        case Field::Kind::vector:
        case Field::Kind::direction:
            return fmt::format("[{}]", fmt::join(*static_cast<const std::array<double, 3>*>(value), ", "));
        case Field::Kind::flag:
            return *static_cast<const bool*>(value) ? "true" : "false";
        default:
            return {};
    }
}

std::string meaning_text(const Field& field) {
    std::string text(field.meaning);
    if (field.unit.empty() || field.unit == "1") return text;
    if (text.empty()) return std::string(field.unit);
    return text.find(';') == std::string::npos ? fmt::format("{}, {}", text, field.unit)
                                               : fmt::format("{} [{}]", text, field.unit);
}

std::string_view kind_word(Field::Kind kind) {
    switch (kind) {
        case Field::Kind::text:
            return "text";
        case Field::Kind::word:
            return "word";
        case Field::Kind::words:
            return "words";
        case Field::Kind::whole:
        case Field::Kind::number:
            return "number";
        case Field::Kind::flag:
            return "true, false";
        case Field::Kind::vector:
            return "vector";
        case Field::Kind::direction:
            return "direction";
        case Field::Kind::region:
            return "region";
        case Field::Kind::species:
            return "species";
        case Field::Kind::particles:
            return "particles";
        case Field::Kind::walls:
            return "walls";
        case Field::Kind::quantity:
        case Field::Kind::value:
            return "value";
        case Field::Kind::object:
        case Field::Kind::named:
            return "object";
        case Field::Kind::array:
            return "list";
    }
    throw std::logic_error("a kind of field without a word");
}

}  // namespace grainsweep::campaign
