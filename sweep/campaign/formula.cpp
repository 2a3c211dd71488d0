#include "sweep/campaign/formula.hpp"

#include "sweep/campaign/plain_name.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <mutex>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>

namespace grainsweep::campaign {

namespace {

constexpr std::size_t longest_formula = 10000;  // characters
constexpr std::size_t deepest_formula = 100;    // parentheses within one another
constexpr int any_number = 1000;                // of arguments

struct FunctionRow {
    std::string_view name;
    int least, most;  ///< arguments
    void (*define)(mu::Parser&, const std::string&);
};

using OneArgument = double (*)(double);
using TwoArguments = double (*)(double, double);

template <OneArgument function>
void define_one(mu::Parser& parser, const std::string& name) {
    parser.DefineFun(name, function);
}
template <TwoArguments function>
void define_two(mu::Parser& parser, const std::string& name) {
    parser.DefineFun(name, function);
}

double chosen(double condition, double value, double otherwise) {
    if (std::isnan(condition)) return condition;
    return condition != 0 ? value : otherwise;
}

/// Returns the smallest (sign 1) or largest (sign -1) argument; NaN if any argument is NaN.
template <int sign>
double extreme(const double* arguments, int count) {
    double best = arguments[0];
    for (int k = 0; k < count; ++k) {
        if (std::isnan(arguments[k])) return arguments[k];
        if (sign * arguments[k] < sign * best) best = arguments[k];
    }
    return best;
}

constexpr auto functions = std::to_array<FunctionRow>({
    {"min", 1, any_number, [](mu::Parser& p, const std::string& name) { p.DefineFun(name, &extreme<1>); }},
    {"max", 1, any_number, [](mu::Parser& p, const std::string& name) { p.DefineFun(name, &extreme<-1>); }},
    {"abs", 1, 1, define_one<std::fabs>},
    {"sqrt", 1, 1, define_one<std::sqrt>},
    {"exp", 1, 1, define_one<std::exp>},
    {"log", 1, 1, define_one<std::log>},
    {"sin", 1, 1, define_one<std::sin>},
    {"cos", 1, 1, define_one<std::cos>},
    {"tan", 1, 1, define_one<std::tan>},
    {"asin", 1, 1, define_one<std::asin>},
    {"acos", 1, 1, define_one<std::acos>},
    {"atan", 1, 1, define_one<std::atan>},
    {"atan2", 2, 2, define_two<std::atan2>},
    {"pow", 2, 2, define_two<std::pow>},
    {"log10", 1, 1, define_one<std::log10>},
    {"floor", 1, 1, define_one<std::floor>},
    {"ceil", 1, 1, define_one<std::ceil>},
    {"round", 1, 1, define_one<std::round>},
    {"if", 3, 3, [](mu::Parser& p, const std::string& name) { p.DefineFun(name, &chosen); }},
});

constexpr std::array<std::string_view, 6> comparisons = {"<=", ">=", "==", "!=", "<", ">"};
// A longer one before its beginning.
constexpr std::array<std::string_view, 14> operators = {"<=", ">=", "==", "!=", "<", ">", "&&",
                                                        "||", "+",  "-",  "*",  "/", "^", ","};

/// Checks a text token by token, so that muParser receives only the functions and operators of this file.
class FormulaCheck {
public:
    FormulaCheck(std::string_view text, const WordList& names) : text_(text), names_(names) {}

    /// Returns why the text is no formula; empty: it is one.
    std::optional<std::string> reason() {
        if (text_.size() > longest_formula) return fmt::format("a formula has at most {} characters", longest_formula);
        levels_.emplace_back();
        while (skip_blanks(), here_ < text_.size() && why_.empty()) {
            if (wants_operand_)
                operand();
            else
                operation();
        }
        if (why_.empty() && wants_operand_) refuse("a number or a name is missing");
        if (why_.empty() && levels_.size() > 1) refuse("')' is missing");
        return why_.empty() ? std::nullopt : std::optional(why_);
    }

    std::vector<std::string> used;
    bool uses_pi = false;
    /// The formula as muParser takes it: no blank behind a function, at most one sign before an operand.
    std::string plain;

private:
    struct Level {
        const FunctionRow* function = nullptr;  ///< whose arguments these are
        int arguments = 1;
        bool compared = false;  ///< since the last && or ||
    };

    void refuse(std::string_view why) { why_ = fmt::format("{} at position {}", why, here_ + 1); }

    void skip_blanks() {
        while (here_ < text_.size() && text_[here_] == ' ') ++here_;
    }

    static bool digit(char c) { return c >= '0' && c <= '9'; }

    [[nodiscard]] std::string_view word() const {
        std::size_t end = here_;
        while (end < text_.size() && is_name_sign(text_[end])) ++end;
        return text_.substr(here_, end - here_);
    }

    /// Returns the whole character at this place, which may have several bytes.
    [[nodiscard]] std::string_view character() const {
        std::size_t end = here_ + 1;
        while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0U) == 0x80U) ++end;
        return text_.substr(here_, end - here_);
    }

    /// Adds the text read since `start` to the plain text.
    void pass(std::size_t start) {
        if (negative_) plain += '-';
        negative_ = false;
        plain += text_.substr(start, here_ - start);
        plain += ' ';
    }

    void open(const FunctionRow* function) {
        if (levels_.size() > deepest_formula)
            return refuse(fmt::format("parentheses are more than {} deep", deepest_formula));
        if (negative_) plain += '-';
        negative_ = false;
        if (function != nullptr) plain += function->name;
        plain += '(';
        levels_.push_back({function});
        ++here_;
    }

    void number() {
        double x = 0;
        const auto [stop, error] = std::from_chars(text_.data() + here_, text_.data() + text_.size(), x);
        if (error == std::errc::result_out_of_range) return refuse("a number is beyond double precision");
        if (error != std::errc()) return refuse("a digit is missing");
        const std::size_t start = here_;
        here_ = static_cast<std::size_t>(stop - text_.data());
        pass(start);
        wants_operand_ = false;
    }

    void named() {
        const auto name = word();
        const auto function = std::ranges::find(functions, name, &FunctionRow::name);
        const bool known = std::ranges::find(names_, name) != names_.end();
        if (!known && function != functions.end()) {
            const std::size_t start = here_;
            here_ += name.size();
            skip_blanks();
            if (here_ < text_.size() && text_[here_] == '(') return open(&*function);
            here_ = start;
            return refuse(fmt::format("'{}' is a function and needs arguments in parentheses", name));
        }
        if (!known && name != "pi") return unknown(name);
        if (known && std::ranges::find(used, name) == used.end()) used.emplace_back(name);
        uses_pi = uses_pi || !known;
        here_ += name.size();
        pass(here_ - name.size());
        wants_operand_ = false;
    }

    void unknown(std::string_view name) {
        std::vector<std::string_view> words(names_.begin(), names_.end());
        for (const auto& function : functions) words.push_back(function.name);
        words.emplace_back("pi");
        const auto nearest = nearest_word(name, words);
        refuse(fmt::format("'{}' is no name here{}", name,
                           nearest.empty() ? "" : fmt::format(" (the nearest is '{}'),", nearest)));
    }

    void operand() {
        const char c = text_[here_];
        if (digit(c) || c == '.') return number();
        if (is_name_letter(c)) return named();
        if (c == '(') return open(nullptr);
        if (c != '-' && c != '+')
            return refuse(fmt::format("a number or a name must stand where '{}' is,", character()));
        negative_ = negative_ != (c == '-');
        ++here_;
    }

    void operation() {
        const auto rest = text_.substr(here_);
        const auto begins = [rest](std::string_view sign) { return rest.starts_with(sign); };
        if (rest[0] == ')') return close();
        const auto* sign = std::ranges::find_if(operators, begins);
        if (sign == operators.end()) return no_operator();
        Level& level = levels_.back();
        if (*sign == ",") {
            if (level.function == nullptr) return refuse("',' stands in no list of arguments,");
            if (++level.arguments > level.function->most) return wrong_count(*level.function);
        }
        const bool comparison = std::ranges::find(comparisons, *sign) != comparisons.end();
        if (comparison && level.compared) return refuse("comparisons are joined by && or ||, not chained,");
        if (comparison)
            level.compared = true;
        else if (*sign == "," || *sign == "&&" || *sign == "||")
            level.compared = false;
        here_ += sign->size();
        pass(here_ - sign->size());
        wants_operand_ = true;
    }

    void close() {
        const Level level = levels_.back();
        if (levels_.size() == 1) return refuse("')' closes nothing");
        if (level.function != nullptr && level.arguments < level.function->least) return wrong_count(*level.function);
        levels_.pop_back();
        ++here_;
        pass(here_ - 1);
    }

    void wrong_count(const FunctionRow& function) {
        refuse(fmt::format("'{}' takes {} argument{}, which is not what stands", function.name, function.least,
                           function.least == 1 ? "" : "s"));
    }

    void no_operator() {
        const auto name = word();
        const std::string_view instead = text_[here_] == '='   ? "=="
                                         : text_[here_] == '&' ? "&&"
                                         : text_[here_] == '|' ? "||"
                                         : name == "and"       ? "&&"
                                         : name == "or"        ? "||"
                                                               : "";
        if (!instead.empty())
            return refuse(fmt::format("write '{}' for '{}'", instead, name.empty() ? character() : name));
        refuse(fmt::format("an operator must stand before '{}'", name.empty() ? character() : name));
    }

    std::string_view text_;
    const WordList& names_;
    std::size_t here_ = 0;
    bool wants_operand_ = true;
    bool negative_ = false;  ///< the signs since the last operand
    std::vector<Level> levels_;
    std::string why_;
};

}  // namespace

struct Formula::Compiled {
    std::string text;
    std::vector<std::string> names;
    std::vector<double> values;  // of the names; muParser keeps their addresses
    mu::Parser parser;
    std::mutex mutex;

    explicit Compiled(const FormulaCheck& check) : text(check.plain), names(check.used), values(names.size()) {
        std::erase(text, ' ');  // no two words stand side by side
        parser.ClearFun();
        parser.ClearConst();
        parser.ClearOprt();
        parser.ClearPostfixOprt();
        parser.ClearInfixOprt();
        parser.EnableOptimizer(false);  // it would merge a*x + b*x: another rounding
        parser.DefineInfixOprt("-", [](double x) { return -x; });
        parser.DefineInfixOprt("+", [](double x) { return x; });
        for (const auto& function : functions) {
            const std::string name(function.name);
            if (std::ranges::find(names, name) == names.end()) function.define(parser, name);
        }
        if (check.uses_pi) parser.DefineConst("pi", std::numbers::pi);
        for (std::size_t k = 0; k < names.size(); ++k) parser.DefineVar(names[k], &values[k]);
        parser.SetExpr(check.plain);
        parser.Eval();  // compiles
    }
};

namespace {

/// Calls visit(word) for every run of letters, digits and _ that a name may be.
void each_word(std::string_view text, auto&& visit) {
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && is_name_sign(text[end])) ++end;
        if (end > at && is_name_letter(text[at])) visit(text.substr(at, end - at));
        at = std::max(end, at + 1);
    }
}

/// Formulas of this process by their texts, with the words in them and whether these were known.
class ReadFormulas {
public:
    std::optional<Formula> find(const std::string& text, const Formula::Known& known) {
        const std::scoped_lock lock(mutex_);
        const auto found = by_text_.find(text);
        if (found == by_text_.end()) return std::nullopt;
        for (const auto& [word, was_known] : found->second.words)
            if (known(word) != was_known) return std::nullopt;
        return found->second.formula;
    }
    void keep(std::string text, const Formula::Known& known, const Formula& formula) {
        Read read{{}, formula};
        each_word(text, [&](std::string_view word) { read.words.emplace_back(word, known(word)); });
        const std::scoped_lock lock(mutex_);
        if (by_text_.size() == most_kept) by_text_.clear();
        by_text_.insert_or_assign(std::move(text), std::move(read));
    }

private:
    static constexpr std::size_t most_kept = 10'000;
    struct Read {
        std::vector<std::pair<std::string, bool>> words;
        Formula formula;
    };
    std::mutex mutex_;
    std::unordered_map<std::string, Read> by_text_;
};

}  // namespace

Formula::Formula(std::shared_ptr<Compiled> compiled) : compiled_(std::move(compiled)) {}

std::variant<Formula, std::string> Formula::parse(std::string_view text, const WordList& names) {
    FormulaCheck check(text, names);
    if (const auto reason = check.reason()) return *reason;
    try {
        return Formula(std::make_shared<Compiled>(check));
    } catch (const mu::ParserError& error) {
        return fmt::format("it cannot be read at position {}: {}", error.GetPos() + 1, error.GetMsg());
    }
}

std::variant<Formula, std::string> Formula::of(std::string_view text, const Known& known) {
    static ReadFormulas all;
    std::string key(text);
    if (auto read = all.find(key, known)) return *std::move(read);
    auto parsed = parse(text, names_in(text, known));
    if (const auto* formula = std::get_if<Formula>(&parsed)) all.keep(std::move(key), known, *formula);
    return parsed;
}

std::vector<std::string> names_in(std::string_view text, const Formula::Known& known) {
    std::vector<std::string> names;
    each_word(text, [&](std::string_view word) {
        if (known(word)) names.emplace_back(word);
    });
    return names;
}

const std::vector<std::string>& Formula::names() const {
    return compiled_->names;
}

const std::string& Formula::text() const {
    return compiled_->text;
}

double Formula::operator()(const Lookup& value_of) const {
    std::vector<double> values;
    values.reserve(compiled_->names.size());
    for (const auto& name : compiled_->names) values.push_back(value_of(name));
    const std::scoped_lock lock(compiled_->mutex);
    std::ranges::copy(values, compiled_->values.begin());
    return compiled_->parser.Eval();
}

}  // namespace grainsweep::campaign
