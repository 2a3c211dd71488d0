// Expressions: the values of plain C++, refusals with a position, nothing of muParser beyond what is offered.
#include "sweep/campaign/formula.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <cmath>
#include <limits>
#include <locale>
#include <map>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::campaign_formula_test {

using campaign::Formula;
using testing::ElementsAre;
using testing::HasSubstr;

const std::map<std::string, double, std::less<>> values = {
    {"diameter", 6e-05}, {"gap", 9e-05}, {"speed", 0.1}, {"e", 7}, {"x1", 0.3}, {"layer_area", 2}};

std::vector<std::string> known_names() {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    return names;
}

double lookup(std::string_view name) {
    return values.find(name)->second;
}

double value_of(std::string_view text) {
    const auto names = known_names();
    const auto formula = Formula::parse(text, names);
    if (const auto* why = std::get_if<std::string>(&formula)) {
        ADD_FAILURE() << text << ": " << *why;
        return std::nan("");
    }
    return std::get<Formula>(formula)(lookup);
}

std::string refusal_of(std::string_view text) {
    const auto names = known_names();
    const auto formula = Formula::parse(text, names);
    if (const auto* why = std::get_if<std::string>(&formula)) return *why;
    ADD_FAILURE() << text << " is a formula";
    return {};
}

TEST(Formulas, HaveTheValuesOfPlainArithmetic) {
    EXPECT_EQ(value_of("3*diameter"), 3 * 6e-05);
    EXPECT_EQ(value_of("gap / diameter"), 9e-05 / 6e-05);
    EXPECT_EQ(value_of("1 + 2*3 - 4/8"), 6.5);
    EXPECT_EQ(value_of("(1 + 2)*3"), 9);
    EXPECT_EQ(value_of("10 - 3 - 2"), 5);
    EXPECT_EQ(value_of("2^3^2"), 512);
    EXPECT_EQ(value_of("-2^2"), -4);
    EXPECT_EQ(value_of("2^-1"), 0.5);
    EXPECT_EQ(value_of("- -+-3"), -3);
    EXPECT_EQ(value_of("2*-3"), -6);
    EXPECT_EQ(value_of("1.5e3 + .5 + 2."), 1502.5);
    EXPECT_EQ(value_of("1E-3"), 0.001);
    EXPECT_EQ(value_of("e + 1e1"), 17);
    EXPECT_EQ(value_of("x1"), 0.3);
    EXPECT_EQ(value_of("  pi "), std::numbers::pi);
}

/// An optimiser that merges terms would round otherwise.
TEST(Formulas, RoundEachStepAsWritten) {
    for (int k = 1; k < 200; ++k) {
        const double a = k / 7.0;
        const double b = k / 11.0;
        const double x = 0.3;
        EXPECT_EQ(value_of(fmt::format("{}*x1 + {}*x1", a, b)), a * x + b * x);
        EXPECT_EQ(value_of(fmt::format("x1*{}*{}", a, b)), x * a * b);
        EXPECT_EQ(value_of(fmt::format("x1 + {} + {} - x1", a, b)), x + a + b - x);
        EXPECT_EQ(value_of(fmt::format("x1/{}/{}", a, b)), x / a / b);
        EXPECT_EQ(value_of(fmt::format("(x1 + {})*{}", a, b)), (x + a) * b);
        EXPECT_EQ(value_of(fmt::format("pow(x1, {})", a)), std::pow(x, a));
        EXPECT_EQ(value_of(fmt::format("x1^{}", b)), std::pow(x, b));
    }
    EXPECT_EQ(value_of("x1 + x1 + x1"), 0.3 + 0.3 + 0.3);
}

TEST(Formulas, Compare) {
    EXPECT_EQ(value_of("gap > diameter"), 1);
    EXPECT_EQ(value_of("gap < diameter"), 0);
    EXPECT_EQ(value_of("gap >= 9e-5"), 1);
    EXPECT_EQ(value_of("gap <= 8e-5"), 0);
    EXPECT_EQ(value_of("e == 7"), 1);
    EXPECT_EQ(value_of("e != 7"), 0);
    EXPECT_EQ(value_of("e > 6 && e < 8"), 1);
    EXPECT_EQ(value_of("e > 8 || e < 6"), 0);
    EXPECT_EQ(value_of("e > 8 || e < 6 || e == 7 && 1"), 1);
    EXPECT_EQ(value_of("1 + 1 > 1"), 1);
    EXPECT_EQ(value_of("(1 < 2) == (2 < 3)"), 1);
    EXPECT_EQ(value_of("if(gap > diameter, 5, 1/0)"), 5);
    EXPECT_EQ(value_of("if(0, 5, 6)"), 6);
    EXPECT_EQ(value_of("if(-0.5, 5, 6)"), 5);
    EXPECT_EQ(value_of("if(e > 6 && e < 8, if(x1 > 1, 1, 2), 3)"), 2);
}

TEST(Formulas, KnowTheFunctionsOfTheManual) {
    EXPECT_EQ(value_of("min(3, 1, 2)"), 1);
    EXPECT_EQ(value_of("max(3, 1, 2)"), 3);
    EXPECT_EQ(value_of("min(4)"), 4);
    EXPECT_EQ(value_of("abs(-3)"), 3);
    EXPECT_EQ(value_of("sqrt(2)"), std::sqrt(2.0));
    EXPECT_EQ(value_of("exp(1)"), std::exp(1.0));
    EXPECT_EQ(value_of("log(10)"), std::log(10.0));
    EXPECT_EQ(value_of("sin(1) + cos(1)"), std::sin(1.0) + std::cos(1.0));
    EXPECT_EQ(value_of("tan(pi/4)"), std::tan(std::numbers::pi / 4));
    EXPECT_EQ(value_of("atan2(-1, -2)"), std::atan2(-1.0, -2.0));
    EXPECT_EQ(value_of("pow(2, 0.5)"), std::pow(2.0, 0.5));
    EXPECT_EQ(value_of("asin(0.5) + acos(0.25)"), std::asin(0.5) + std::acos(0.25));
    EXPECT_EQ(value_of("atan(2)"), std::atan(2.0));
    EXPECT_EQ(value_of("log10(1000)"), 3);
    EXPECT_EQ(value_of("ceil(1.2) + 10*round(2.5)"), 32);
    EXPECT_EQ(value_of("floor(-1.5)"), -2);
    EXPECT_EQ(value_of("floor (2.5)"), 2);
}

TEST(Formulas, WithoutAValueAreNotFinite) {
    EXPECT_EQ(value_of("1/0"), std::numeric_limits<double>::infinity());
    EXPECT_EQ(value_of("log(0)"), -std::numeric_limits<double>::infinity());
    for (const char* text : {"0/0", "sqrt(-1)", "log(-1)", "min(1, 0/0)", "min(0/0, 1)", "max(0/0, 1, 2)",
                             "max(1, 0/0, 2)", "if(0/0, 1, 2)", "(-1)^0.5"})
        EXPECT_TRUE(std::isnan(value_of(text))) << text;
}

TEST(Formulas, NameWhatTheyNeed) {
    const auto names = known_names();
    const auto formula = std::get<Formula>(Formula::parse("gap*speed + gap*pi - min(e, 3)", names));
    EXPECT_THAT(formula.names(), ElementsAre("gap", "speed", "e"));
    const Formula copy = formula;
    EXPECT_EQ(copy(lookup), formula(lookup));
    EXPECT_EQ(formula([](std::string_view) { return 2.0; }), 2 * 2.0 + 2 * std::numbers::pi - 2.0);
    EXPECT_THAT(std::get<Formula>(Formula::parse("1 + pi", names)).names(), ElementsAre());
    const std::vector<std::string> odd = {"pi", "min", "_e"};
    EXPECT_EQ(std::get<Formula>(Formula::parse("pi + min + _e", odd))([](std::string_view) { return 1.0; }), 3);
}

TEST(Formulas, ThatAreNoneAreRefusedWithTheirPosition) {
    const std::vector<std::pair<std::string, std::string>> refusals = {
        {"", "a number or a name is missing at position 1"},
        {"3 *", "a number or a name is missing at position 4"},
        {"3 * diametre", "'diametre' is no name here (the nearest is 'diameter'), at position 5"},
        {"zzz", "'zzz' is no name here at position 1"},
        {"squrt(2)", "(the nearest is 'sqrt'), at position 1"},
        {"(1 + 2", "')' is missing at position 7"},
        {"1 + 2)", "')' closes nothing at position 6"},
        {"()", "a number or a name must stand where ')' is, at position 2"},
        {"min()", "a number or a name must stand where ')' is, at position 5"},
        {"sin(1, 2)", "'sin' takes 1 argument, which is not what stands at position 6"},
        {"pow(1)", "'pow' takes 2 arguments, which is not what stands at position 6"},
        {"if(1, 2)", "'if' takes 3 arguments, which is not what stands at position 8"},
        {"1, 2", "',' stands in no list of arguments, at position 2"},
        {"min((1, 2))", "',' stands in no list of arguments, at position 7"},
        {"sin", "'sin' is a function and needs arguments in parentheses at position 1"},
        {"sin * 2", "'sin' is a function and needs arguments in parentheses at position 1"},
        {"2 gap", "an operator must stand before 'gap' at position 3"},
        {"2(3)", "an operator must stand before '(' at position 2"},
        {"gap(3)", "an operator must stand before '(' at position 4"},
        {"gap = 3", "write '==' for '=' at position 5"},
        {"e > 1 and e < 2", "write '&&' for 'and' at position 7"},
        {"e > 1 or e < 2", "write '||' for 'or' at position 7"},
        {"e > 1 & e < 2", "write '&&' for '&' at position 7"},
        {"1 < e < 2", "comparisons are joined by && or ||, not chained, at position 7"},
        {"1 == e != 2", "comparisons are joined by && or ||, not chained, at position 8"},
        {"1e999", "a number is beyond double precision at position 1"},
        {".", "a digit is missing at position 1"},
        {"1.5.2", "an operator must stand before '.' at position 4"},
        {"2 ** 3", "must stand where '*' is, at position 4"},
        {"2 µ", "an operator must stand before 'µ' at position 3"},
        {"*2", "must stand where '*' is, at position 1"},
        {"3 %", "an operator must stand before '%' at position 3"}};
    for (const auto& [text, sentence] : refusals) EXPECT_THAT(refusal_of(text), HasSubstr(sentence)) << text;
}

TEST(Formulas, OfferNothingElseOfMuParser) {
    for (const char* text : {"_pi",       "_e",    "x = 2",   "gap = 1", "1 ? 2 : 3", "\"text\"", "sum(1, 2)",
                             "avg(1, 2)", "ln(2)", "log2(2)", "sign(2)", "rint(2)",   "sinh(1)",  "rnd(1)",
                             "0x10",      "0b1",   "!1",      "1 % 2",   "1;2",       "1 << 2",   "~1",
                             "1\t+1",     "1\n+1", "#1",      "gap[1]",  "{1}",       "a.b",      "Sin(1)"})
        EXPECT_FALSE(refusal_of(text).empty()) << text;
}

TEST(Formulas, HaveALimitedLengthAndDepth) {
    const auto nested = [](std::size_t depth) { return std::string(depth, '(') + "1" + std::string(depth, ')'); };
    EXPECT_EQ(value_of(nested(100)), 1);
    EXPECT_THAT(refusal_of(nested(101)), HasSubstr("more than 100 deep"));
    std::string sines = "1";
    for (int k = 0; k < 100; ++k) sines = "abs(" + sines + ")";
    EXPECT_EQ(value_of(sines), 1);
    std::string sum = "1";
    while (sum.size() < 9998) sum += "+1";
    EXPECT_EQ(value_of(sum), 5000);
    EXPECT_EQ(value_of(std::string(9999, '-') + "1"), -1);
    EXPECT_EQ(refusal_of(sum + "+1"), "a formula has at most 10000 characters");
    std::string arguments = "max(0";
    for (int k = 1; k < 1000; ++k) arguments += ",1";
    EXPECT_EQ(value_of(arguments + ")"), 1);
}

/// A decimal comma of the process must not be one of formulas.
TEST(Formulas, DoNotDependOnTheLocale) {
    struct Comma : std::numpunct<char> {
        [[nodiscard]] char do_decimal_point() const override { return ','; }
        [[nodiscard]] char do_thousands_sep() const override { return '.'; }
        [[nodiscard]] std::string do_grouping() const override { return "\3"; }
    };
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
    EXPECT_EQ(value_of("1.5 + 1000.25"), 1001.75);
    EXPECT_EQ(value_of("max(1.5,2)"), 2);
    std::locale::global(before);
}

TEST(Formulas, MayBeSharedByThreads) {
    const auto names = known_names();
    const auto formula = std::get<Formula>(Formula::parse("x1*x1 + e", names));
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
        threads.emplace_back([&formula, thread] {
            for (int k = 0; k < 2000; ++k) {
                const double x = thread * 10000 + k;
                EXPECT_EQ(formula([x](std::string_view) { return x; }), x * x + x);
            }
        });
    }
}

}  // namespace grainsweep::tests::campaign_formula_test
