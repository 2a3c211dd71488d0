// JSON that is written without a document has the bytes of nlohmann's.
#include "sweep/campaign/json_writer.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace grainsweep::tests::campaign_json_writer_test {

using campaign::JsonText;
using Reference = nlohmann::ordered_json;

std::string written(const Reference& value) {
    return value.dump(-1, ' ', false, Reference::error_handler_t::replace);
}

TEST(JsonWriter, NumbersHaveTheBytesOfNlohmann) {
    std::vector<double> numbers = {0.0,  -0.0,  1.0,    -1.0, 0.1, 1e15,    1e16, 123456789012345678.0, 1e-4,
                                   1e-5, 1e300, 5e-324, 1e21, 2.5, 1.0 / 3, 1e22, 9007199254740993.0};
    const auto limits = std::numeric_limits<double>();
    for (const double x :
         {limits.max(), limits.min(), limits.epsilon(), limits.infinity(), -limits.infinity(), limits.quiet_NaN()})
        numbers.push_back(x);
    std::mt19937_64 random(1);
    for (int k = 0; k < 20'000; ++k) {
        numbers.push_back(std::bit_cast<double>(random()));
        numbers.push_back(std::ldexp(static_cast<double>(random() >> 11U), -53));
        numbers.push_back(std::round(1e4 * std::ldexp(static_cast<double>(random() >> 11U), -53)) / 1e3);
    }
    for (const double x : numbers) ASSERT_EQ(JsonText(x).text(), written(Reference(x))) << x;
    EXPECT_EQ(JsonText(std::numeric_limits<std::int64_t>::min()).text(), "-9223372036854775808");
    EXPECT_EQ(JsonText(std::numeric_limits<std::uint64_t>::max()).text(), "18446744073709551615");
    EXPECT_EQ(JsonText(-7).text(), "-7");
    EXPECT_EQ(JsonText(std::size_t{0}).text(), "0");
}

TEST(JsonWriter, TextsHaveTheBytesOfNlohmann) {
    for (const std::string text : {"", "plain", "a \"b\" \\ / \b\f\n\r\t", "\x01\x1f\x7f", "grün ± µm", "\xff\xc3",
                                   "\xe2\x80\xa8", "\xf0\x9f\x98\x80", "\xed\xa0\x80 lone surrogate"})
        EXPECT_EQ(JsonText(text).text(), written(Reference(text)));
    for (int c = 0; c < 256; ++c) {
        const std::string text = {'a', static_cast<char>(c), 'b'};
        EXPECT_EQ(JsonText(text).text(), written(Reference(text))) << c;
    }
}

TEST(JsonWriter, ListsAndObjectsHaveTheBytesOfNlohmann) {
    const Reference reference = {{"none", nullptr},
                                 {"yes", true},
                                 {"list", {1, 2.0, "three"}},
                                 {"empty", Reference::array()},
                                 {"nothing", Reference::object()},
                                 {"inner", {{"key \"k\"", {0.5, nullptr}}, {"a", -1}}}};
    JsonText inner = {{"key \"k\"", std::vector{0.5, std::nan("")}}};
    inner.add("a", -1);
    const JsonText text = {{"none", JsonText()},
                           {"yes", true},
                           {"list", std::array<JsonText, 3>{1, 2.0, "three"}},
                           {"empty", std::vector<double>()},
                           {"nothing", JsonText::object()},
                           {"inner", inner}};
    EXPECT_EQ(text.text(), written(reference));
    EXPECT_EQ(JsonText({{"a", 1}}).add({{"b", 2}}).add(JsonText::object()).text(), R"({"a":1,"b":2})");
    EXPECT_EQ(JsonText::object().add({{"b", 2}}).text(), R"({"b":2})");
    EXPECT_EQ(JsonText(std::optional<int>()).text(), "null");
    EXPECT_EQ(JsonText(std::optional(false)).text(), "false");
    EXPECT_EQ(JsonText::list(std::vector{1, 2}, [](int x) { return 2 * x; }).text(), "[2,4]");
    EXPECT_TRUE(JsonText::array().empty() && JsonText::object().empty());
    EXPECT_FALSE(JsonText("").empty() || inner.empty() || JsonText(10).empty());
}

}  // namespace grainsweep::tests::campaign_json_writer_test
