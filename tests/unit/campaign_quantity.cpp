// Numbers with units: exact where the factor is decimal, angles as an engineer counts them, refusals that name a unit.
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/quantity.hpp"

#include "solver/scenes/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::campaign_quantity_test {

using campaign::in_si;
using testing::AllOf;
using testing::Eq;
using testing::HasSubstr;

double value_of(std::string_view text, std::string_view unit) {
    const auto answer = in_si(text, unit);
    if (const auto* why = std::get_if<std::string>(&answer)) {
        ADD_FAILURE() << text << " in " << unit << ": " << *why;
        return std::nan("");
    }
    return std::get<double>(answer);
}

std::string refusal_of(std::string_view text, std::string_view unit) {
    const auto answer = in_si(text, unit);
    if (const auto* why = std::get_if<std::string>(&answer)) return *why;
    ADD_FAILURE() << text << " in " << unit << " is " << std::get<double>(answer);
    return {};
}

TEST(Quantities, OfAnEngineerAreInTheUnitOfTheirPlace) {
    EXPECT_EQ(value_of("60 um", "m"), 6e-05);
    EXPECT_EQ(value_of("60 µm", "m"), 6e-05);       // micro sign
    EXPECT_EQ(value_of("60 \u03bcm", "m"), 6e-05);  // Greek mu
    EXPECT_EQ(value_of("60um", "m"), 6e-05);
    EXPECT_EQ(value_of("  60   um ", "m"), 6e-05);
    EXPECT_EQ(value_of("60 micron", "m"), 6e-05);
    EXPECT_EQ(value_of("+60 um", "m"), 6e-05);
    EXPECT_EQ(value_of("150 mm/s", "m/s"), 0.15);
    EXPECT_EQ(value_of("35 kJ/m3", "J/m3"), 35000);
    EXPECT_EQ(value_of("35 kJ/m^3", "J/m3"), 35000);
    EXPECT_EQ(value_of("35 kJ m-3", "J/m3"), 35000);
    EXPECT_EQ(value_of("35 kJ/m³", "J/m3"), 35000);
    EXPECT_EQ(value_of("0.1 kg/s", "kg/s"), 0.1);
    EXPECT_EQ(value_of("5 MPa", "Pa"), 5e6);
    EXPECT_EQ(value_of("10 %", "1"), 0.1);
    EXPECT_EQ(value_of("10%", "1"), 0.1);
    EXPECT_EQ(value_of("5 ‰", "1"), 0.005);
    EXPECT_EQ(value_of("3e-5 s", "s"), 3e-5);
    EXPECT_EQ(value_of("4.43 g/cm3", "kg/m3"), 4430);
    EXPECT_EQ(value_of("0.1 mJ/m2", "N/m"), 0.0001);
    EXPECT_EQ(value_of("0.1 mJ/m2", "J/m2"), 0.0001);
    EXPECT_EQ(value_of("-2.5 mm", "m"), -0.0025);
    EXPECT_EQ(value_of("1 in", "m"), 0.0254);
    EXPECT_EQ(value_of("0.7 h", "s"), 2520);
    EXPECT_EQ(value_of("3 L", "m3"), 0.003);
    EXPECT_EQ(value_of("20 N mm", "J"), 0.02);
    EXPECT_EQ(value_of("1 gravity", "m/s2"), 9.80665);
    EXPECT_EQ(value_of("20 degC", "K"), 293.15);
    EXPECT_EQ(value_of("36 km/h", "m/s"), 10);
}

TEST(Quantities, WithoutAUnitAreAlreadyInTheUnitOfTheirPlace) {
    EXPECT_EQ(value_of("10", "m"), 10);
    EXPECT_EQ(value_of("1e-5", "Pa"), 1e-5);
    EXPECT_EQ(value_of(".5", "1"), 0.5);
    EXPECT_EQ(value_of("0.4", ""), 0.4);
    EXPECT_FALSE(std::signbit(value_of("-0", "m")));
    EXPECT_FALSE(std::signbit(value_of("-0 um", "m")));
    EXPECT_EQ(value_of("5 L^2/alpha", "L^2/alpha"), 5);  // the place's own unit, whatever it is
    EXPECT_EQ(value_of("7 pieces", "pieces"), 7);
    EXPECT_EQ(value_of("60 um", "um"), 60);
    EXPECT_EQ(value_of("0.06 mm", "um"), 60);
}

TEST(Quantities, TurnAsAnEngineerCounts) {
    constexpr double turn = 2 * std::numbers::pi;
    for (const char* place : {"1/min", "rpm", "rev/min"}) {
        EXPECT_EQ(value_of("20 rpm", place), 20) << place;
        EXPECT_EQ(value_of("20 1/min", place), 20) << place;
        EXPECT_EQ(value_of("2 Hz", place), 120) << place;
        EXPECT_EQ(value_of("2 1/s", place), 120) << place;
        EXPECT_DOUBLE_EQ(value_of("1 rad/s", place), 60 / turn) << place;
        EXPECT_DOUBLE_EQ(value_of("6 deg/s", place), 1) << place;
    }
    EXPECT_DOUBLE_EQ(value_of("20 rpm", "rad/s"), 20 * turn / 60);
    EXPECT_DOUBLE_EQ(value_of("20 rev/min", "rad/s"), 20 * turn / 60);
    EXPECT_EQ(value_of("120 rpm", "Hz"), 2);
    EXPECT_EQ(value_of("30 rpm", "1/s"), 0.5);
    EXPECT_DOUBLE_EQ(value_of("3 rad/s", "Hz"), 3 / turn);
    EXPECT_DOUBLE_EQ(value_of("1 Hz", "deg/s"), 360);
    EXPECT_EQ(value_of("50 kHz", "Hz"), 50000);
    EXPECT_THAT(refusal_of("2 Hz", "rad/s"), AllOf(HasSubstr("'Hz' does not fit 'rad/s'"), HasSubstr("rpm")));
    EXPECT_THAT(refusal_of("2 1/s", "rad/s"), HasSubstr("'1/s' does not fit 'rad/s'"));
}

TEST(Quantities, OfAnglesAreNoPureNumbers) {
    EXPECT_EQ(value_of("30 deg", "deg"), 30);
    EXPECT_EQ(value_of("30 °", "deg"), 30);
    EXPECT_DOUBLE_EQ(value_of("30 deg", "rad"), std::numbers::pi / 6);
    EXPECT_DOUBLE_EQ(value_of("0.5 rad", "deg"), 90 / std::numbers::pi);
    EXPECT_DOUBLE_EQ(value_of("0.25 turn", "deg"), 90);
    EXPECT_THAT(refusal_of("30 deg", "1"), HasSubstr("'deg' does not fit '1'"));
    EXPECT_THAT(refusal_of("10 %", "deg"), HasSubstr("'%' does not fit 'deg'"));
    EXPECT_THAT(refusal_of("1 rad", "1"), HasSubstr("does not fit"));
}

/// A decimal with another point is the same number, to the last bit: so are the case ids.
TEST(Quantities, OfDecimalFactorsAreTheNearestDouble) {
    struct Scale {
        const char *given, *place;
        int exponent;
    };
    const std::vector<Scale> scales = {
        {"um", "m", -6},      {"mm", "m", -3},       {"nm", "m", -9},     {"cm", "m", -2},    {"km", "m", 3},
        {"mm/s", "m/s", -3},  {"ms", "s", -3},       {"us", "s", -6},     {"MPa", "Pa", 6},   {"kJ/m3", "J/m3", 3},
        {"mJ/m2", "N/m", -3}, {"g/cm3", "kg/m3", 3}, {"g", "kg", -3},     {"mm2", "m2", -6},  {"mm3", "m3", -9},
        {"%", "1", -2},       {"mPa", "MPa", -9},    {"um/us", "m/s", 0}, {"kHz", "Hz", 3},   {"mm/s2", "m/s2", -3},
        {"L", "m3", -3},      {"bar", "Pa", 5},      {"m", "um", 6},      {"mN/mm2", "Pa", 3}};
    std::uint64_t state = 1;
    for (int trial = 0; trial < 20000; ++trial) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        const auto& scale = scales[(state >> 33U) % scales.size()];
        const auto digits = (state >> 20U) % (trial % 2 == 0 ? 1000U : 1000000000U);
        const int point = static_cast<int>(state >> 50U) % 9;
        const std::string by_hand = fmt::format("{}e{}", digits, scale.exponent - point);
        double expected = 0;
        std::from_chars(by_hand.data(), by_hand.data() + by_hand.size(), expected);
        ASSERT_EQ(value_of(fmt::format("{}e-{} {}", digits, point, scale.given), scale.place), expected) << by_hand;
    }
    for (int thousandths = 1; thousandths < 3000; ++thousandths) {
        const std::string text = fmt::format("{}.{:03}", thousandths / 1000, thousandths % 1000);
        const std::string by_hand = text + "e-6";
        double expected = 0;
        std::from_chars(by_hand.data(), by_hand.data() + by_hand.size(), expected);
        ASSERT_EQ(value_of(text + " um", "m"), expected);
        ASSERT_EQ(value_of(text + " min", "s"), static_cast<double>(thousandths * 60) / 1000);
        ASSERT_EQ(value_of(text + " in", "m"), static_cast<double>(thousandths * 254) / 10000000);
        ASSERT_EQ(value_of(fmt::format("{} rpm", thousandths), "Hz"), thousandths / 60.0);
    }
}

TEST(Quantities, ThatDoNotFitAreRefusedWithUnitsThatDo) {
    EXPECT_EQ(refusal_of("60 um", "Pa"), "'um' does not fit 'Pa', these fit: Pa, kPa, MPa, GPa");
    EXPECT_THAT(refusal_of("60 mm", "m/s"), HasSubstr("'mm' does not fit 'm/s', these fit: mm/s, m/s, cm/s, km/h"));
    EXPECT_THAT(refusal_of("60 umm", "m"), HasSubstr("'umm' is no unit, the nearest that fits is 'um'"));
    EXPECT_THAT(refusal_of("60 Kg/m3", "kg/m3"), HasSubstr("the nearest that fits is 'kg/m3'"));
    EXPECT_THAT(refusal_of("5 psqi", "Pa"), HasSubstr("'psqi' is no unit, these fit: Pa, kPa, MPa, GPa"));
    EXPECT_THAT(refusal_of("100 mm/", "m/s"), HasSubstr("the nearest that fits is 'mm/s'"));
    EXPECT_THAT(refusal_of("5 Mpa", "Pa"), HasSubstr("the nearest that fits is 'MPa'"));
    EXPECT_THAT(refusal_of("5 kg", "N"), HasSubstr("'kg' does not fit 'N'"));
    EXPECT_THAT(refusal_of("3 m", "L^2/alpha"), HasSubstr("'m' cannot be converted to 'L^2/alpha'"));
    EXPECT_THAT(refusal_of("3 m", ""), HasSubstr("the parameter has no unit, and 'm' is one"));
    EXPECT_THAT(refusal_of("3 m", "1"), HasSubstr("'m' does not fit '1'"));
}

TEST(Quantities, NameTheirUnitAsWritten) {
    EXPECT_EQ(campaign::unit_of_quantity(" +60 um "), "um");
    EXPECT_EQ(campaign::unit_of_quantity("-1.5e3kg/m3"), "kg/m3");
    for (const char* text : {"60", "", "um", "1e999 m", "-"}) EXPECT_EQ(campaign::unit_of_quantity(text), "") << text;
}

TEST(Quantities, ThatAreNoneAreRefused) {
    for (const char* text :
         {"", " ", "um", "um 60", "abc", "-", "+", "+-3 m", "--3 m", "nan m", "inf m", "e5 m", "NaN", "."})
        EXPECT_THAT(refusal_of(text, "m"), Eq("it begins with no number")) << text;
    for (const char* text :
         {"60 mm 3", "60 m*3", "60 mm.3", "1.5.2 m",  "60 3 m",  "60 @ m", "60 m @ 3", "60 lg(re 1 m)",
          "60 *m",   "60 /m",  "60 m/",   "60 mm mm", "0x10 m",  "60 m;",  "60 \"m\"", "60 m since 2000-01-01",
          "60 ^2",   "60 -m",  "60 (m",   "60 \xff",  "1 000 m", "5 m_"})
        EXPECT_FALSE(refusal_of(text, "m").empty()) << text;
    EXPECT_THAT(refusal_of("5 s since 2000-01-01", "s"), HasSubstr("is no unit"));
    EXPECT_THAT(refusal_of("5 s @ 3", "s"), HasSubstr("is no unit"));
    EXPECT_EQ(refusal_of("1,5 mm", "m"), "the decimal sign is a point");
    EXPECT_EQ(refusal_of("1,5", ""), "the decimal sign is a point");
    EXPECT_EQ(refusal_of("1e400 m", "m"), "the number is beyond double precision");
    EXPECT_EQ(refusal_of("1e300 Gm", "um"), "the number in 'um' is beyond double precision");
    EXPECT_EQ(refusal_of("1e-400 m", "m"), "the number is beyond double precision");
    EXPECT_EQ(refusal_of("60 " + std::string(200, 'm'), "m"), "a quantity has at most 100 characters");
}

TEST(Quantities, ReadEveryUnitOfTheScenes) {
    std::set<std::string> units;
    for (const auto& scene : campaign::named_scenes())
        for (const auto& parameter : scene->parameters)
            if (!std::holds_alternative<std::string>(parameter.default_value)) units.insert(parameter.unit);
    ASSERT_GT(units.size(), 8U);
    for (const auto& unit : units) EXPECT_EQ(value_of("2 " + unit, unit), 2) << unit;
    for (const char* expected : {"1", "m", "m/s", "J/m3", "1/min", "deg", "kg/m3", "s", "Pa"})
        EXPECT_TRUE(units.contains(expected)) << expected;
}

TEST(Quantities, AreReadByManyThreads) {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
        threads.emplace_back([] {
            for (int k = 0; k < 200; ++k) {
                EXPECT_EQ(std::get<double>(in_si("60 um", "m")), 6e-5);
                EXPECT_EQ(in_si("60 um", "Pa").index(), 1U);
            }
        });
    }
}

}  // namespace grainsweep::tests::campaign_quantity_test
