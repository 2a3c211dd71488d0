#include "sweep/campaign/quantity.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/files/beside_program.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <vector>

namespace grainsweep::campaign {

namespace {

constexpr std::size_t longest_quantity = 100;  // characters

// Order in which units are suggested for one that does not exist or does not fit.
constexpr auto usual_units = std::to_array<std::string_view>(
    {"um",    "mm",  "m",    "nm",    "cm",    "km",   "mm/s",  "m/s", "cm/s",  "km/h",  "m/s2",  "mm/s2", "s",
     "ms",    "us",  "min",  "h",     "Hz",    "kHz",  "1/s",   "rpm", "1/min", "rad/s", "deg/s", "deg",   "rad",
     "kg",    "g",   "mg",   "kg/m3", "g/cm3", "Pa",   "kPa",   "MPa", "GPa",   "bar",   "J/m3",  "kJ/m3", "J/m2",
     "mJ/m2", "N/m", "mN/m", "N",     "mN",    "J",    "mJ",    "N m", "W",     "kg/s",  "g/s",   "kg/h",  "m3",
     "cm3",   "mm3", "m2",   "mm2",   "%",     "Pa s", "mPa s", "K",   "degC",  "m3/s"});

struct FreeUnit {
    void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
    void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;
using Converter = std::unique_ptr<cv_converter, FreeConverter>;

/// How often angle, time and anything else occur in a product of basic units.
struct Powers {
    const ut_unit* radian = nullptr;
    const ut_unit* second = nullptr;
    int angle = 0;
    int time = 0;
    bool others = false;

    [[nodiscard]] bool pure_number() const { return angle == 0 && time == 0 && !others; }
    [[nodiscard]] bool pure_angle() const { return angle == 1 && time == 0 && !others; }
    [[nodiscard]] bool frequency() const { return angle == 0 && time == -1 && !others; }
    [[nodiscard]] bool angular_speed() const { return angle == 1 && time == -1 && !others; }
};

ut_status add_basic(const ut_unit* unit, int power, Powers& powers) {
    if (ut_compare(unit, powers.radian) == 0)
        powers.angle += power;
    else if (ut_compare(unit, powers.second) == 0)
        powers.time += power;
    else
        powers.others = true;
    return UT_SUCCESS;
}

const ut_visitor& powers_visitor() {
    static const ut_visitor visitor = {
        [](const ut_unit* unit, void* powers) { return add_basic(unit, 1, *static_cast<Powers*>(powers)); },
        [](const ut_unit*, int count, const ut_unit* const* basic, const int* power, void* powers) {
            for (int k = 0; k < count; ++k) add_basic(basic[k], power[k], *static_cast<Powers*>(powers));
            return UT_SUCCESS;
        },
        [](const ut_unit*, double, const ut_unit* underlying, double, void* powers) {
            return ut_accept_visitor(underlying, &powers_visitor(), powers);
        },
        [](const ut_unit*, const ut_unit*, double, void*) { return UT_MEANINGLESS; },  // a date
        [](const ut_unit*, double, const ut_unit*, void*) { return UT_MEANINGLESS; },  // decibels
    };
    return visitor;
}

/// Sets a flag to false for a unit with a factor or an offset.
const ut_visitor& scale_visitor() {
    static const ut_visitor visitor = {
        [](const ut_unit*, void*) { return UT_SUCCESS; },
        [](const ut_unit*, int, const ut_unit* const*, const int*, void*) { return UT_SUCCESS; },
        [](const ut_unit*, double scale, const ut_unit*, double offset, void* plain) {
            *static_cast<bool*>(plain) = scale == 1 && offset == 0;
            return UT_SUCCESS;
        },
        [](const ut_unit*, const ut_unit*, double, void*) { return UT_MEANINGLESS; },  // a date
        [](const ut_unit*, double, const ut_unit*, void*) { return UT_MEANINGLESS; },  // decibels
    };
    return visitor;
}

/// value = factor * number + offset.
struct Conversion {
    double factor = 1;
    double offset = 0;
};

/// The units of UDUNITS-2. Its parser has a state of its own: one thread at a time.
class UnitDatabase {
public:
    UnitDatabase() {
        ut_set_error_message_handler(ut_ignore);
        // The user's own (a variable of the environment) or the system's; else that of the archive of the program.
        system_ = ut_read_xml(nullptr);
        for (const auto& file : {std::filesystem::path("/usr/share/xml/udunits/udunits2.xml"),
                                 files::beside_program("udunits/udunits2.xml")})
            if (system_ == nullptr) system_ = ut_read_xml(file.c_str());
        if (system_ == nullptr) return;
        name("deg", "degree");
        name("rev", "turn");
        name("‰", "0.001");
        radian_.reset(ut_get_unit_by_name(system_, "radian"));
        second_.reset(ut_get_unit_by_name(system_, "second"));
        kelvin_.reset(ut_get_unit_by_name(system_, "kelvin"));
        radian_per_second_.reset(ut_parse(system_, "rad/s", UT_UTF8));
    }

    [[nodiscard]] bool found() const { return radian_ && second_ && kelvin_ && radian_per_second_; }

    /// Returns a unit; none: the text is none. Remembers it until `make_room`, because every case converts the same
    /// few.
    [[nodiscard]] const ut_unit* parsed(std::string_view text) {
        const auto known = units_.find(text);
        if (known != units_.end()) return known->second.get();
        std::string name(text);
        Unit unit(ut_parse(system_, name.c_str(), UT_UTF8));
        return units_.emplace(std::move(name), std::move(unit)).first->second.get();
    }

    void make_room() {
        constexpr std::size_t most = 1000;
        if (units_.size() > most) units_.clear();
    }

    /// None: a quantity in `from` is none in `to`.
    [[nodiscard]] std::optional<Conversion> conversion(const ut_unit* from, const ut_unit* to) const {
        const auto has = powers_of(from);
        const auto wants = powers_of(to);
        if (!has || !wants || has->pure_number() != wants->pure_number() || has->pure_angle() != wants->pure_angle())
            return std::nullopt;
        const Converter converter(ut_get_converter(const_cast<ut_unit*>(from), const_cast<ut_unit*>(to)));
        if (!converter) return std::nullopt;
        Conversion result;
        result.offset = cv_convert_double(converter.get(), 0);
        result.factor = cv_convert_double(converter.get(), 1) - result.offset;
        if (result.offset != 0 && ut_are_convertible(from, kelvin_.get()) == 0) return std::nullopt;
        if (has->angular_speed() && wants->frequency()) result.factor /= 2 * std::numbers::pi;
        if (has->frequency() && wants->angular_speed()) {
            if (in_radians(to)) return std::nullopt;
            result.factor *= 2 * std::numbers::pi;
        }
        return result;
    }

private:
    void name(const char* word, const char* meaning) const {
        if (const Unit unit{ut_parse(system_, meaning, UT_UTF8)}) ut_map_name_to_unit(word, UT_UTF8, unit.get());
    }

    [[nodiscard]] std::optional<Powers> powers_of(const ut_unit* unit) const {
        Powers powers{radian_.get(), second_.get()};
        if (ut_accept_visitor(unit, &powers_visitor(), &powers) != UT_SUCCESS) return std::nullopt;
        return powers;
    }

    [[nodiscard]] bool in_radians(const ut_unit* speed) const;

    ut_system* system_ = nullptr;  // lives as long as the process
    Unit radian_, second_, kelvin_, radian_per_second_;
    std::map<std::string, Unit, std::less<>> units_;
};

/// digits * 10^exponent.
struct Decimal {
    std::uint64_t digits = 1;
    int exponent = 0;
};

/// The decimal of up to nine digits that a factor is but for its rounding errors.
std::optional<Decimal> short_decimal(double factor) {
    constexpr double rounding = 1e-14;  // relative: products of ten factors, each rounded
    if (!(factor > 0) || !std::isfinite(factor)) return std::nullopt;
    for (int behind = 0; behind < 9; ++behind) {
        std::string text = fmt::format("{:.{}e}", factor, behind);
        double back = 0;
        std::from_chars(text.data(), text.data() + text.size(), back);
        if (std::abs(back - factor) > rounding * factor) continue;
        const auto e = text.find('e');
        Decimal decimal;
        decimal.exponent = std::atoi(text.c_str() + e + 1) - behind;
        text.resize(e);
        std::erase(text, '.');
        std::from_chars(text.data(), text.data() + text.size(), decimal.digits);
        return decimal;
    }
    return std::nullopt;
}

bool UnitDatabase::in_radians(const ut_unit* speed) const {
    const Converter converter(ut_get_converter(const_cast<ut_unit*>(speed), radian_per_second_.get()));
    const double factor = converter ? cv_convert_double(converter.get(), 1) : 0;
    return short_decimal(factor) || short_decimal(1 / factor);
}

/// Returns the double nearest to number * factor for a decimal text `number`; empty: out of range.
std::optional<double> product(std::string_view number, Decimal factor) {
    std::string digits;
    int exponent = factor.exponent;
    const auto e = std::min(number.find_first_of("eE"), number.size());
    bool behind_point = false;
    for (const char c : number.substr(0, e)) {
        if (c == '.')
            behind_point = true;
        else if (c != '-')
            digits += c, exponent -= behind_point ? 1 : 0;
    }
    if (e < number.size()) {
        const std::size_t start = e + (number[e + 1] == '+' ? 2 : 1);
        int written = 0;
        if (std::from_chars(number.data() + start, number.data() + number.size(), written).ec != std::errc())
            return std::nullopt;
        if (std::abs(written) > 1000) return std::nullopt;
        exponent += written;
    }
    std::uint64_t carry = 0;  // long multiplication, the last digit first
    for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit) {
        const std::uint64_t sum = factor.digits * static_cast<std::uint64_t>(*digit - '0') + carry;
        *digit = static_cast<char>('0' + sum % 10);
        carry = sum / 10;
    }
    const std::string text = fmt::format("{}{}{}e{}", number.starts_with('-') ? "-" : "", carry, digits, exponent);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::optional<double> converted(std::string_view number, double x, const Conversion& conversion) {
    if (conversion.offset == 0) {
        if (const auto factor = short_decimal(conversion.factor)) return product(number, *factor);
        if (const auto divisor = short_decimal(1 / conversion.factor)) {
            // 60, not 6 after a shift by ten, which would round once more.
            const auto whole = divisor->exponent > 0 && divisor->exponent < 7;
            const double by = static_cast<double>(divisor->digits) * (whole ? std::pow(10.0, divisor->exponent) : 1);
            const auto shifted = product(number, {1, whole ? 0 : -divisor->exponent});
            if (shifted) return *shifted / by;
        }
    }
    const double value = conversion.factor * x + conversion.offset;
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Returns whether the text is a unit. Texts that UDUNITS reads as a unit with a second number ("mm 3"), as a date or
/// as a logarithm are refused.
bool sound_unit(std::string_view unit) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    const auto at = [&](std::size_t k) { return k < unit.size() ? unit[k] : ' '; };
    if (unit == "1") return true;
    if (unit.find_first_of("@:,;\"'_\t\n") != std::string_view::npos) return false;
    std::size_t k = unit.starts_with("1/") ? 1 : 0;
    if (k == 0 && std::string_view(".+-*/^) ").find(at(0)) != std::string_view::npos) return false;
    for (; k < unit.size(); ++k) {
        if (!digit(unit[k])) continue;
        const char before = k > 0 ? at(k - 1) : ' ';
        const char further = k > 1 ? at(k - 2) : ' ';
        const bool power = letter(before) || digit(before) || before == '^' || before == ')' ||
                           ((before == '-' || before == '+') && (letter(further) || further == '^')) ||
                           (before == '*' && further == '*');
        if (!power) return false;
    }
    return true;
}

/// Returns ", the nearest that fits is 'um'" if a usual unit of this dimension has a similar name, else some usual
/// units of this dimension.
std::string advice(UnitDatabase& database, std::string_view unit, const ut_unit* place) {
    std::vector<std::string_view> fitting;
    for (const auto usual : usual_units) {
        const auto* parsed = database.parsed(usual);
        if (parsed != nullptr && database.conversion(parsed, place)) fitting.push_back(usual);
    }
    if (fitting.empty()) return {};
    // Every letter is near to every other.
    if (const auto nearest = unit.size() > 1 ? nearest_word(unit, fitting) : std::string(); !nearest.empty())
        return fmt::format(", the nearest that fits is '{}'", nearest);
    if (fitting.size() > 4) fitting.resize(4);
    return fmt::format(", these fit: {}", listed(fitting));
}

struct LockedUnits {
    std::unique_lock<std::mutex> lock;
    UnitDatabase& database;
};

LockedUnits locked_units() {
    static std::mutex one_at_a_time;
    std::unique_lock lock(one_at_a_time);
    static UnitDatabase database;
    database.make_room();
    return {std::move(lock), database};
}

std::variant<double, std::string> with_unit(std::string_view number, double x, std::string_view given,
                                            std::string_view unit) {
    const auto units = locked_units();
    auto& database = units.database;
    if (!database.found())
        return "no unit can be read without the file udunits2.xml (package libudunits2-data; UDUNITS2_XML_PATH can "
               "name the file)";
    if (given.starts_with(',')) return "the decimal sign is a point";
    const auto* place = unit.empty() ? nullptr : database.parsed(unit);
    if (place == nullptr || !sound_unit(unit)) {
        return unit.empty() ? fmt::format("the parameter has no unit, and '{}' is one", given)
                            : fmt::format("'{}' cannot be converted to '{}'", given, unit);
    }
    const auto* parsed = sound_unit(given) ? database.parsed(given) : nullptr;
    if (parsed == nullptr) return fmt::format("'{}' is no unit{}", given, advice(database, given, place));
    const auto conversion = database.conversion(parsed, place);
    if (!conversion) {
        return fmt::format("'{}' does not fit '{}'{}", given, unit, advice(database, given, place));
    }
    if (const auto value = converted(number, x, *conversion)) return *value == 0 ? 0.0 : *value;
    return fmt::format("the number in '{}' is beyond double precision", unit);
}

std::string_view without_blanks(std::string_view text) {
    const auto first = std::min(text.find_first_not_of(' '), text.size());
    return text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

/// A quantity as written: the digits of its number and its unit are parts of the text.
struct Written {
    explicit Written(std::string_view text) {
        text = without_blanks(text);
        const bool plus = text.starts_with('+');
        if (plus) text.remove_prefix(1);
        const std::size_t sign = !plus && text.starts_with('-') ? 1 : 0;
        number = text.size() > sign && (text[sign] == '.' || (text[sign] >= '0' && text[sign] <= '9'));
        const char* const end = text.data() + text.size();
        const auto [stop, failure] = std::from_chars(text.data(), end, value);
        error = failure;
        digits = text.substr(0, static_cast<std::size_t>(stop - text.data()));
        unit = without_blanks({stop, static_cast<std::size_t>(end - stop)});
    }

    bool number = false;  // whether it begins with one
    std::errc error{};
    double value = 0;
    std::string_view digits, unit;
};

}  // namespace

std::variant<double, std::string> in_si(std::string_view text, std::string_view unit) {
    if (text.size() > longest_quantity) return fmt::format("a quantity has at most {} characters", longest_quantity);
    const Written written(text);
    if (!written.number || written.error == std::errc::invalid_argument) return "it begins with no number";
    if (written.error != std::errc()) return "the number is beyond double precision";
    if (written.unit.empty() || written.unit == unit) return written.value == 0 ? 0.0 : written.value;
    return with_unit(written.digits, written.value, written.unit, unit);
}

bool is_convertible(std::string_view from, std::string_view to) {
    from = without_blanks(from);
    if (from.empty() || from == to) return true;
    if (from.size() > longest_quantity || !sound_unit(from) || !sound_unit(to)) return false;
    const auto units = locked_units();
    if (!units.database.found()) return false;
    const auto *given = units.database.parsed(from), *wanted = units.database.parsed(to);
    return given != nullptr && wanted != nullptr && units.database.conversion(given, wanted);
}

std::string with_decimal_point(std::string_view text) {
    const auto digit = [&](std::size_t k) { return k < text.size() && text[k] >= '0' && text[k] <= '9'; };
    if (text.find('(') != std::string_view::npos) return {};
    for (std::size_t k = 1; k < text.size(); ++k)
        if (text[k] == ',' && digit(k - 1) && digit(k + 1)) {
            std::string pointed(text);
            pointed[k] = '.';
            return pointed;
        }
    return {};
}

ColumnHead column_head(std::string_view head) {
    const std::string_view whole = trimmed(head);
    const ColumnHead plain{std::string(whole), {}};
    const char close = whole.empty() ? ' ' : whole.back();
    if (close != ')' && close != ']') return plain;
    const auto open = whole.rfind(close == ')' ? '(' : '[');
    if (open == std::string_view::npos || open == 0) return plain;
    std::string unit(trimmed(whole.substr(open + 1, whole.size() - open - 2)));
    if (unit == "\xC2\xB0") unit = "deg";
    return {std::string(trimmed(whole.substr(0, open))), unit};
}

std::string_view unit_of_quantity(std::string_view text) {
    const Written written(text);
    return written.number && written.error == std::errc() ? written.unit : std::string_view();
}

bool resembles_united_number(std::string_view text) {
    const Written written(text);
    if (!written.number || written.error != std::errc() || written.unit.empty()) return false;
    const bool blank = written.unit.data() != written.digits.data() + written.digits.size();
    if (std::ranges::find(usual_units, written.unit) != usual_units.end()) return blank || written.unit.size() > 1;
    if (!blank || !sound_unit(written.unit)) return false;
    const auto units = locked_units();
    return units.database.found() && units.database.parsed(written.unit) != nullptr;
}

bool is_si_unit(std::string_view unit) {
    if (unit.empty() || unit == "1" || !sound_unit(unit)) return true;
    const auto units = locked_units();
    const auto* parsed = units.database.found() ? units.database.parsed(unit) : nullptr;
    bool plain = true;
    return parsed == nullptr || (ut_accept_visitor(parsed, &scale_visitor(), &plain) == UT_SUCCESS && plain);
}

}  // namespace grainsweep::campaign
