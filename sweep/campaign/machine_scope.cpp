#include "sweep/campaign/machine_scope.hpp"

#include "sweep/campaign/formula.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_parameters.hpp"
#include "sweep/campaign/plain_name.hpp"
#include "sweep/campaign/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <stdexcept>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>

namespace grainsweep::campaign {

using machine::Region;
using machine::Vec3;

bool is_quantity(std::string_view text) {
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    std::size_t at = text.find_first_not_of(" \t");
    if (at == std::string_view::npos) return false;
    if (text[at] == '-' || text[at] == '+') ++at;
    const std::size_t begin = at;
    while (at < text.size() && (digit(text[at]) || text[at] == '.')) ++at;
    if (at == begin) return false;
    if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
        std::size_t exponent = at + 1;
        if (exponent < text.size() && (text[exponent] == '-' || text[exponent] == '+')) ++exponent;
        if (exponent < text.size() && digit(text[exponent])) {
            at = exponent;
            while (at < text.size() && digit(text[at])) ++at;
        }
    }
    while (at < text.size() && text[at] == ' ') ++at;
    if (at == text.size()) return true;
    const auto c = static_cast<unsigned char>(text[at]);
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c >= 0x80 || c == '%' ||
           (c == '1' && text.substr(at, 2) == "1/");
}

/// A name alone keeps its unit, which must fit; units of longer expressions are not known.
void MachineScope::require_unit(const Cursor& place, const std::string& name, std::string_view unit) const {
    const auto of = units_.find(name);
    if (of == units_.end() || unit == "1" || of->second == unit) return;
    if (is_convertible(of->second, unit)) return;
    const bool turns = (of->second == "Hz" || of->second == "1/s") && unit == "rad/s";
    place.refuse(fmt::format("'{}' is in {}, and this is in {}{}", name, of->second, unit,
                             turns ? fmt::format(": write 2*pi*{}, or give it the unit rpm", name) : ""));
}

namespace {

/// Results by what they are made from. Every case reads every text of its machine, and texts repeat.
template <class Value>
class Memory {
public:
    template <class Make>
    std::shared_ptr<const Value> of(std::string key, const Make& make) {
        constexpr std::size_t most = 10'000;
        const std::lock_guard lock(guard_);
        if (const auto found = known_.find(key); found != known_.end()) return found->second;
        if (known_.size() == most) known_.clear();
        return known_.emplace(std::move(key), std::make_shared<const Value>(make())).first->second;
    }

private:
    std::mutex guard_;
    std::unordered_map<std::string, std::shared_ptr<const Value>> known_;
};

/// A quantity as in_si reads it.
std::shared_ptr<const std::variant<double, std::string>> quantity_in(const std::string& text, std::string_view unit) {
    static Memory<std::variant<double, std::string>> quantities;
    return quantities.of(std::string(text).append("\n").append(unit), [&] { return in_si(text, unit); });
}

/// Whether expressions calculate in a unit; bounds of a speed in rpm are in rpm.
bool calculates_in(std::string_view unit) {
    static Memory<bool> units;
    std::string name(unit);
    return unit == "1" || *units.of(name, [&] { return value_in_expressions(name, 1).empty(); });
}

}  // namespace

std::shared_ptr<const ValueText> value_text(const std::string& written, std::string_view unit) {
    static Memory<ValueText> texts;
    const bool si = calculates_in(unit);
    return texts.of(written + (si ? '1' : '0'), [&] {
        const std::string united = si ? with_si_numbers(written) : std::string();
        return ValueText{united.empty() ? written : united, unclear_quotient(written), with_decimal_point(written),
                         united.empty() && is_quantity(written)};
    });
}

/// An expression with the names in it; where it is wrong, with all, so that the sentence finds the nearest one.
std::variant<Formula, std::string> MachineScope::parsed_here(const std::string& text) const {
    auto parsed = Formula::of(text, [this](std::string_view name) { return numbers_.contains(name); });
    return std::holds_alternative<Formula>(parsed) ? parsed : Formula::parse(text, names());
}

/// A word in an expression is named as such.
void MachineScope::refuse_expression(const Cursor& place, const std::string& text, const std::string& why) const {
    for (const auto& [name, word] : words_)
        for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
            const std::size_t end = at + name.size();
            if ((at > 0 && is_name_sign(text[at - 1])) || (end < text.size() && is_name_sign(text[end]))) continue;
            place.refuse(fmt::format("'{}' is a word; expressions know {}_is_{}, which is 1 or 0", name, name, word));
        }
    place.refuse(why);
}

double MachineScope::number(const Cursor& place, std::string_view unit, const Interval& bounds) const {
    const auto rule = [&](std::string_view more) {
        return fmt::format("must be a number{}{}{}", in_words(bounds), unit == "1" ? "" : fmt::format(", {}", unit),
                           more);
    };
    double value = 0;
    if (place.json().is_number()) {
        value = place.json().get<double>();
    } else if (place.json().is_string()) {
        const auto& written = place.json().get_ref<const std::string&>();
        const auto text = value_text(written, unit);
        const std::string& given = text->given;
        if (!text->unclear.empty()) place.refuse(fmt::format("a quotient and a unit need brackets: {}", text->unclear));
        if (text->quantity) {
            const auto read = quantity_in(given, unit);
            if (const auto* why = std::get_if<std::string>(&*read)) place.refuse(*why);
            value = std::get<double>(*read);
        } else if (const auto named = numbers_.find(given);
                   named != numbers_.end() && std::isfinite(named->second) && bounds.contains(named->second)) {
            require_unit(place, given, unit);
            value = named->second;
        } else {
            const auto parsed = parsed_here(given);
            if (!text->pointed.empty()) place.refuse(fmt::format("the decimal sign is a point: '{}'", text->pointed));
            if (const auto* why = std::get_if<std::string>(&parsed)) refuse_expression(place, written, *why);
            require_unit(place, given, unit);
            value = std::get<Formula>(parsed)([this](std::string_view name) { return numbers_.find(name)->second; });
            if (!std::isfinite(value)) place.refuse("the expression has no finite value here");
            if (!bounds.contains(value)) place.refuse(rule(fmt::format("; here it is {:.6g}", value)));
        }
    } else {
        place.refuse(rule(", a quantity or an expression"));
    }
    if (!std::isfinite(value) || !bounds.contains(value)) place.refuse(rule(""));
    return value == 0 ? 0 : value;
}

double MachineScope::number(const Section& section, std::string_view key, std::string_view unit, double standard,
                            const Interval& bounds) const {
    const auto place = section.find(key);
    return place ? number(*place, unit, bounds) : standard;
}

std::int64_t MachineScope::whole(const Cursor& place, const Interval& bounds) const {
    const double value = number(place, "1", bounds);
    if (place.json().is_number() && value != std::round(value)) place.refuse("must be a whole number");
    return std::llround(value);
}

bool MachineScope::present(const Section& section) const {
    return number(section, "when", "1", 1) != 0;
}

Vec3 MachineScope::vector(const Cursor& place, std::string_view unit) const {
    if (!place.json().is_array() || place.json().size() != 3) place.refuse("must be a list of three numbers: x, y, z");
    return {number(place[std::size_t{0}], unit), number(place[1], unit), number(place[2], unit)};
}

Vec3 MachineScope::vector(const Section& section, std::string_view key, std::string_view unit,
                          const Vec3& standard) const {
    const auto place = section.find(key);
    return place ? vector(*place, unit) : standard;
}

Vec3 MachineScope::direction(const Cursor& place) const {
    const Vec3 given = vector(place, "1");
    const double length = geometry::norm(given);
    if (!(length > 0)) place.refuse("a direction must not be 0");
    if (length == 1) return given;
    return geometry::operator*(1 / length, given);
}

Vec3 MachineScope::direction(const Section& section, std::string_view key, const Vec3& standard) const {
    const auto place = section.find(key);
    return place ? direction(*place) : standard;
}

namespace {

/// Returns the text with each "{NAME}" replaced by value_of(NAME).
std::string with_values(const Cursor& place, const std::function<std::string(const std::string&)>& value_of) {
    std::string text = place.text();
    for (std::size_t open = text.find('{'); open != std::string::npos; open = text.find('{', open)) {
        const std::size_t close = text.find('}', open);
        if (close == std::string::npos) place.refuse("a '{' without its '}'");
        const std::string value = value_of(text.substr(open + 1, close - open - 1));
        text.replace(open, close - open + 1, value);
        open += value.size();
    }
    return text;
}

}  // namespace

std::string MachineScope::text(const Cursor& place) const {
    return with_values(place, [&](const std::string& name) {
        const auto word = words_.find(name);
        if (word != words_.end()) return word->second;
        const WordList known(std::views::keys(words_));
        place.refuse(fmt::format("'{{{}}}' names no parameter that is a word", name), nearest_word(name, known));
    });
}

std::string_view MachineScope::contents(const Cursor& place) const {
    const std::string name = text(place);
    if (const auto found = files_.find(name); found != files_.end()) return found->second;
    place.refuse(file_word(name)        ? fmt::format("the contents of {} are not given", file_word(name)->path)
                 : name == place.text() ? fmt::format("there is no file '{}'", name)
                                        : fmt::format("the case names no file here, but '{}'", name));
}

std::string MachineScope::sentence(const Cursor& place) const {
    return with_values(place, [&](const std::string& name) {
        if (const auto word = words_.find(name); word != words_.end()) return word->second;
        const auto parsed = parsed_here(name);
        if (const auto* why = std::get_if<std::string>(&parsed)) place.refuse(*why);
        return fmt::format(
            "{:.4g}", std::get<Formula>(parsed)([this](std::string_view used) { return numbers_.find(used)->second; }));
    });
}

std::string MachineScope::word(const Cursor& place, const WordList& words) const {
    const auto rule = [&] { return fmt::format("must be {}", in_words(words)); };
    if (!place.json().is_string() || place.json().get_ref<const std::string&>().empty()) place.refuse(rule());
    auto word = text(place);
    if (std::ranges::find(words, word) == words.end()) place.refuse(rule(), nearest_word(word, words));
    return word;
}

std::string MachineScope::word(const Section& section, std::string_view key, const WordList& words,
                               std::string_view standard) const {
    const auto place = section.find(key);
    return place ? word(*place, words) : std::string(standard);
}

std::size_t MachineScope::place_in(const Cursor& place, const std::vector<std::string>& names,
                                   std::string_view what) const {
    const WordList list(names);
    if (names.empty()) place.refuse(fmt::format("there is no {} that it could name", what));
    const std::string chosen = word(place, list);
    return static_cast<std::size_t>(std::ranges::find(names, chosen) - names.begin());
}

std::vector<std::size_t> MachineScope::places_in(const Cursor& place, const std::vector<std::string>& names,
                                                 std::string_view what) const {
    if (!place.json().is_array()) return {place_in(place, names, what)};
    std::vector<std::size_t> places;
    for (const auto& one : place.elements()) {
        const std::size_t at = place_in(one, names, what);
        if (std::ranges::find(places, at) != places.end()) one.refuse("it is there twice");
        places.push_back(at);
    }
    if (places.empty()) place.refuse(fmt::format("must name a {} or several", what));
    return places;
}

std::size_t MachineScope::wall(const Cursor& place) const {
    std::vector<std::string> names;
    for (const auto& [name, number] : walls_) names.push_back(name);
    for (const std::size_t one : places_in(place, names, "wall"))
        if (const auto number = walls_.find(names[one])->second) return *number;
    place.refuse("this case has no such wall");
}

std::vector<std::string> MachineScope::names() const {
    std::vector<std::string> names;
    for (const auto& [name, value] : numbers_) names.push_back(name);
    return names;
}

void MachineScope::read(const Section& section, std::span<const Field> fields, void* object) const {
    for (const Field& field : fields) {
        if (field.at == nullptr && field.choose == nullptr) continue;
        const auto place = section.find(field.name);
        if (!place) continue;
        const auto choose = [&](const Cursor& chosen) {
            const auto found = std::ranges::find(field.words, word(chosen, field.words));
            field.choose(object, static_cast<std::size_t>(found - field.words.begin()));
        };
        switch (field.kind) {
            case Field::Kind::quantity:
                *static_cast<double*>(field.at(object)) = number(*place, field.unit, field.bounds);
                break;
            case Field::Kind::vector:
                *static_cast<Vec3*>(field.at(object)) = vector(*place, field.unit);
                break;
            case Field::Kind::direction:
                *static_cast<Vec3*>(field.at(object)) = direction(*place);
                break;
            case Field::Kind::region:
                *static_cast<Region*>(field.at(object)) = region(*place);
                break;
            case Field::Kind::flag:
                *static_cast<bool*>(field.at(object)) = place->flag();
                break;
            case Field::Kind::word:
                choose(*place);
                break;
            case Field::Kind::words:
                for (const Cursor& one : place->elements()) choose(one);
                break;
            default:
                throw std::logic_error("no reader for the kind of field " + std::string(field.name));
        }
    }
}

std::optional<Section> MachineScope::read(const Section& section, std::string_view key, void* object) const {
    const auto place = section.find(key);
    if (!place) return std::nullopt;
    Section inner(*place, section.members(key));
    read(inner, section.members(key), object);
    return inner;
}

const Type* named_in(const Json& object, std::span<const Type> types) {
    const Type* found = nullptr;
    if (!object.is_object()) return nullptr;
    for (const Type& type : types)
        if (object.contains(std::string(type.name)) && std::exchange(found, &type) != nullptr) return nullptr;
    return found;
}

const Type& MachineScope::read_alternative(const Cursor& place, std::span<const Type> types, void* variant,
                                           std::string_view rule) const {
    const Type* type = named_in(place.json(), types);
    if (type == nullptr || place.json().size() != 1) {
        const WordList words(std::views::transform(types, &Type::name));
        const bool one = place.json().is_object() && place.json().size() == 1;
        place.refuse(fmt::format("{}: {}", rule, in_words(words)),
                     one ? nearest_word(place.json().begin().key(), words) : std::string());
    }
    void* object = type->make(variant);
    if (!type->fields.empty()) read(Section(place[type->name], type->fields), type->fields, object);
    return *type;
}

Region MachineScope::region(const Cursor& place) const {
    Region region;
    const Type& type =
        read_alternative(place, machine::region_types(), &region.is, "a region is an object with one key");
    const Cursor inner = place[type.name];
    std::visit(
        [&](auto& combined) {
            using Combined = std::remove_cvref_t<decltype(combined)>;
            if constexpr (std::is_same_v<Combined, machine::NotRegion>)
                combined.of = {this->region(inner)};
            else if constexpr (std::is_same_v<Combined, machine::MovingRegion>)
                combined.of = {this->region(inner["in"])}, combined.wall = wall(inner["with"]);
            else if constexpr (requires { combined.of; })
                for (const auto& one : inner.elements()) combined.of.push_back(this->region(one));
        },
        region.is);
    if (const std::string flaw = region.flaw(); !flaw.empty()) inner.refuse(flaw);
    return region;
}

}  // namespace grainsweep::campaign
