// The page is one file: its data is well-formed and cannot break out, and nothing in it asks a network.
#include "sweep/report/figures.hpp"
#include "sweep/report/packed_column.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/page_template.hpp"
#include "sweep/report/summary.hpp"
#include "tests/support/answered.hpp"
#include "tests/support/drawings.hpp"
#include "tests/support/written.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::tests::report_page_test {

using Json = nlohmann::ordered_json;
using store::Store;
using testing::HasSubstr;
using testing::Not;

std::vector<std::uint8_t> bytes_of(const std::string& base64) {
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::uint8_t> bytes;
    std::uint32_t word = 0;
    int bits = 0;
    for (const char c : base64) {
        if (c == '=') break;
        word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
        if ((bits += 6) < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<std::uint8_t>(word >> bits));
    }
    return bytes;
}

template <class T>
std::vector<double> numbers_in(const std::string& base64) {
    const auto bytes = bytes_of(base64);
    std::vector<T> numbers(bytes.size() / sizeof(T));
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return {numbers.begin(), numbers.end()};
}

/// A packed column as the page's program reads it.
std::vector<double> unpacked(const Json& column) {
    if (column.contains("f32")) return numbers_in<float>(column["f32"]);
    if (column.contains("f64")) return numbers_in<double>(column["f64"]);
    std::vector<double> values;
    for (const auto index : bytes_of(column["u8"])) {
        const auto& value = column["of"][index];
        values.push_back(value.is_null() ? std::nan("") : value.get<double>());
    }
    return values;
}

const std::string evil = R"(</script><script>alert(1)</script> <!-- & "quoted" ]]>)";

struct Page : testing::Test {
    Folder folder;
    Store store{folder / "a.db", Store::Mode::create};

    void answer(const std::string& name, int points, const std::string& notes = "") {
        Json file = {
            {"campaign", name},
            {"notes", notes},
            {"scene", "rehearsal"},
            {"factors", Json::array({{{"name", "x1"}, {"between", {0, 1}}},
                                     {{"name", "response"}, {"levels", {"sum", "ishigami"}}}})},
            {"design", {{"kind", "halton"}, {"sequences", 8}, {"points", points}}},
            {"convergence", {{"observable", "y"}, {"tolerance", 0.5}, {"gates", {"mean", "sd", "g1"}}, {"block", 40}}}};
        answer_by(store, file.dump(), [](const Inputs& inputs) -> std::optional<double> {
            if (input(inputs, "x1") > 0.95) return std::nullopt;
            return 1 + input(inputs, "x1");
        });
    }
    [[nodiscard]] std::string page() const {
        std::ostringstream out;
        const report::PageSource source{&store, "a.db"};
        report::write_page(out, {&source, 1});
        return out.str();
    }
    [[nodiscard]] static std::string between(const std::string& text, const std::string& from, const std::string& to) {
        const auto begin = text.find(from) + from.size();
        return text.substr(begin, text.find(to, begin) - begin);
    }
};

TEST_F(Page, HoldsAllFiguresOfEveryCampaign) {
    answer("first", 160);
    answer("second", 80);
    const auto data = Json::parse(between(page(), R"(<script type="application/json" id="data">)", "</script>"));
    EXPECT_EQ(data["databases"], Json({"a.db"}));
    ASSERT_EQ(data["campaigns"].size(), 2u);
    const auto& campaign = data["campaigns"][0];
    EXPECT_EQ(campaign["name"], "first");
    EXPECT_EQ(campaign["rows"], 160);
    EXPECT_EQ(campaign["factors"][1]["levels"], Json({"sum", "ishigami"}));
    EXPECT_EQ(campaign["runs"][0]["compiler"], "g++ 12");

    const auto& y = campaign["observables"][campaign["main"].get<std::size_t>()];
    EXPECT_EQ(y["name"], "y");
    EXPECT_EQ(y["history"]["converged_at"], 120);  // g1 rests on 30 values from 80 points on
    EXPECT_EQ(unpacked(y["values"]).size(), 160u);
    EXPECT_EQ(y["order"], Json({"x1", "response"}));
    EXPECT_EQ(y["largest"].size(), 8u);
    EXPECT_GE(y["largest"][0]["value"], y["largest"][1]["value"]);
    EXPECT_LE(y["smallest"][0]["value"], y["smallest"][1]["value"]);

    const auto& failures = campaign["failures"];
    ASSERT_GT(failures["count"], 0);
    EXPECT_EQ(failures["listed"].size(), failures["count"]);
    EXPECT_EQ(failures["listed"][0]["reason"], "the formula has no answer");
    EXPECT_EQ(failures["count"], y["history"]["excluded"]);
}

/// The same bytes as of the command `figure`.
TEST_F(Page, ItsFiguresAreThoseOfTheCommand) {
    answer("first", 160);
    const report::PageSource source{&store, "a.db"};
    const auto data = tests::parsed(report::page_data({&source, 1}));
    const auto figures = drawings_of(data["campaigns"][0]);
    std::vector<std::string> names;
    for (const auto& [name, svg] : figures["y"].items()) names.push_back(name);
    EXPECT_THAT(names,
                testing::ElementsAre("distribution", "convergence:mean", "convergence:sd", "convergence:skewness",
                                     "convergence:g1", "convergence:kurtosis", "effects:x1", "effects:response",
                                     "sensitivity", "variance", "model:x1", "model:response", "model-map:averaged"));
    const auto responses = study::read_responses(store, store.campaigns().front());
    const report::FigureSubject subject{store, responses, responses.observable("y")};
    names.resize(names.size() - 2);  // each figure of the model fits it: one of three is enough
    for (const auto& name : names)
        EXPECT_EQ(figures["y"][name].get<std::string>(),
                  plot::drawn(report::figure_named(subject, name), 85, plot::FileType::svg))
            << name;
    EXPECT_FALSE(figures["y"]["effects:x1"] == figures["y"]["effects:response"]);
    // Failed cases: crosses at the lower edge, with their entry of the legend.
    EXPECT_THAT(figures["y"]["model:x1"].get<std::string>(), HasSubstr("failed cases"));
}

TEST_F(Page, TextsOfTheDatabaseStayTextsInItsFigures) {
    answer_by(store,
              R"({"campaign": "words", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
                  {"name": "response", "levels": ["sum", "ishigami"]}], "design": {"kind": "halton", "points": 40}})",
              [](const Inputs& inputs) { return input(inputs, "x1"); });
    auto responses = study::read_responses(store, store.campaigns().front());
    responses.factors[1].seen[0] = evil + "\xff\x01";
    const report::FigureSubject subject{store, responses, responses.observable("y")};
    const auto svg = plot::drawn(report::figure_named(subject, "effects:response"), 85, plot::FileType::svg);
    EXPECT_THAT(svg, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;"));
    EXPECT_THAT(svg, Not(HasSubstr("<script")));
    EXPECT_THAT(svg, HasSubstr("\xEF\xBF\xBD\\x01</text>"));
}

TEST_F(Page, HoldsEveryCaseAsItIsStored) {
    answer("first", 160);
    const auto data = Json::parse(between(page(), R"(<script type="application/json" id="data">)", "</script>"));
    const auto& campaign = data["campaigns"][0];
    const auto view = store.query("SELECT point, case_id, outcome, x1, y FROM first ORDER BY point");
    const auto points = unpacked(campaign["points"]), x1 = unpacked(campaign["factors"][0]["values"]),
               y = unpacked(campaign["observables"][0]["values"]);
    const auto ids = bytes_of(campaign["ids"]), outcomes = bytes_of(campaign["outcome_of"]["u8"]);
    ASSERT_EQ(ids.size(), 16u * 160);
    for (std::size_t row = 0; row < 160; ++row) {
        const auto& stored = view.rows[row];
        EXPECT_EQ(points[row], static_cast<double>(row));
        std::string id;
        for (std::size_t k = 0; k < 16; ++k) id += fmt::format("{:02x}", ids[16 * row + k]);
        EXPECT_EQ(id, std::get<std::string>(stored[1]));
        EXPECT_EQ(campaign["outcome_of"]["of"][outcomes[row]], std::get<std::string>(stored[2]));
        EXPECT_NEAR(x1[row], std::get<double>(stored[3]), 1e-7);
        if (const auto* value = std::get_if<double>(&stored[4])) {
            EXPECT_NEAR(y[row], *value, 2e-7);
        } else {
            EXPECT_TRUE(std::isnan(y[row]));
        }
    }
}

TEST_F(Page, SaysWhereWhiskersComeFromAndWhatIsUnexplained) {
    answer("first", 160);
    const auto data = Json::parse(between(page(), R"(<script type="application/json" id="data">)", "</script>"));
    const auto& y = data["campaigns"][0]["observables"][0];
    EXPECT_THAT(y["whiskers"].get<std::string>(), HasSubstr("the 8 independent sequences"));
    EXPECT_TRUE(y["pure_error"].is_null());
    EXPECT_EQ(y["influence"]["factors"][0]["trend"], "rises");
    EXPECT_THAT(y["influence"]["unexplained"].get<std::string>(), HasSubstr("main effects together explain"));
}

TEST_F(Page, HoldsSeveralDatabases) {
    answer("first", 40);
    Store second{folder / "b.db", Store::Mode::create};
    answer_by(second, R"({"campaign": "first", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "design": {"kind": "halton", "sequences": 8, "points": 16}})",
              [](const Inputs& inputs) { return input(inputs, "x1"); });
    const std::vector<report::PageSource> sources = {{&store, "a.db"}, {&second, "b.db"}};
    const auto data = tests::parsed(report::page_data(sources));
    EXPECT_EQ(data["databases"], Json({"a.db", "b.db"}));
    ASSERT_EQ(data["campaigns"].size(), 2u);
    EXPECT_EQ(data["campaigns"][0]["database"], "a.db");
    EXPECT_EQ(data["campaigns"][1]["database"], "b.db");
    EXPECT_EQ(data["campaigns"][1]["rows"], 16);
}

/// exp(-720 x) falls to 1e-313: numbers with few digits left, which no reader of text may refuse.
TEST_F(Page, HoldsTheSmallestNumbersThereAre) {
    answer_by(store,
              R"({"campaign": "small", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
                  "design": {"kind": "halton", "points": 300}})",
              [](const Inputs& inputs) { return std::exp(-745 * input(inputs, "x1")); });
    const auto data = Json::parse(between(page(), R"(<script type="application/json" id="data">)", "</script>"));
    const auto& y = data["campaigns"][0]["observables"][0];
    const auto values = unpacked(y["values"]);
    EXPECT_GT(std::ranges::count_if(values, [](double x) { return x > 0 && x < 2.2e-308; }), 3);
    EXPECT_LT(y["smallest"][0]["value"].get<double>(), 1e-310);
    EXPECT_GT(y["smallest"][0]["value"].get<double>(), 0);
}

Json packed(const std::vector<double>& values) {
    return Json::parse(report::packed(values).text());
}

TEST(PackedColumn, FewValuesAreExactAndManyHaveSevenDigits) {
    const double missing = std::nan("");
    const auto few = packed(std::vector<double>{0.1, missing, 1.0 / 3, 0.1, 1e300});
    EXPECT_EQ(few["u8"], "AAECAAM=");
    const auto back = unpacked(few);
    EXPECT_EQ(back[2], 1.0 / 3);
    EXPECT_EQ(back[4], 1e300);
    EXPECT_TRUE(std::isnan(back[1]));

    std::vector<double> many, whole;
    for (int i = 0; i < 300; ++i) {
        many.push_back(i == 7 ? missing : std::exp(0.1 * i));
        whole.push_back(1e9 + i);
    }
    const auto real = packed(many);
    ASSERT_TRUE(real.contains("f32"));
    for (std::size_t i = 0; i < 300; ++i) {
        const double x = unpacked(real)[i];
        if (i == 7)
            EXPECT_TRUE(std::isnan(x));
        else
            EXPECT_NEAR(x / many[i], 1, 1e-7);
    }
    EXPECT_EQ(unpacked(packed(whole)), whole);
    for (const double beyond : {1e-310, 4.9e-324, -1e-40, 1e300}) {
        auto wide = many;
        wide[0] = beyond;
        const auto column = packed(wide);
        ASSERT_TRUE(column.contains("f64")) << beyond;
        EXPECT_EQ(unpacked(column)[0], beyond);
    }
    EXPECT_EQ(unpacked(packed(std::vector<double>{})).size(), 0u);
}

TEST(PackedColumn, Base64AndIds) {
    EXPECT_EQ(report::base64(""), "");  // RFC 4648, section 10
    EXPECT_EQ(report::base64("f"), "Zg==");
    EXPECT_EQ(report::base64("fo"), "Zm8=");
    EXPECT_EQ(report::base64("foo"), "Zm9v");
    EXPECT_EQ(report::base64("foobar"), "Zm9vYmFy");
    const std::vector<std::string> ids = {"00ff10a5000000000000000000000001"};
    EXPECT_EQ(bytes_of(report::packed_ids(ids))[3], 0xa5);
    EXPECT_THROW((void)report::packed_ids(std::vector<std::string>{"12"}), std::invalid_argument);
    EXPECT_THROW((void)report::packed_ids(std::vector<std::string>{std::string(32, 'x')}), std::invalid_argument);
    EXPECT_THROW((void)report::packed([] {
                     std::vector<std::string> words;
                     for (int i = 0; i < 257; ++i) words.push_back(std::to_string(i));
                     return words;
                 }()),
                 std::length_error);
}

TEST_F(Page, TextOfTheDatabaseStaysText) {
    answer("first", 40, evil);
    const auto text = page();
    EXPECT_THAT(text, Not(HasSubstr("alert(1)</script>")));
    const auto data = Json::parse(between(text, R"(<script type="application/json" id="data">)", "</script>"));
    EXPECT_EQ(data["campaigns"][0]["notes"], evil);
    // The program writes texts as text nodes: no way from a string to markup.
    for (const char* door :
         {"innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "new Function"}) {
        EXPECT_EQ(report::page_files().report.find(door), std::string_view::npos) << door;
    }
}

TEST_F(Page, AsksNoNetwork) {
    answer("first", 40);
    const auto text = page();
    EXPECT_THAT(text, HasSubstr("default-src 'none'"));
    EXPECT_THAT(text, Not(HasSubstr("{{")));
    static const std::regex request(
        R"((src|href|srcset|action)\s*=\s*["']|url\((?!#)|@import|fetch\(|XMLHttpRequest|WebSocket|EventSource|sendBeacon|importScripts)");
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, request)) << found.str();
    EXPECT_THAT(report::page_files().library.substr(0, 60), HasSubstr("Chart.js v3"));
}

TEST_F(Page, ItsPolicyNamesEveryScriptAndAllowsNoOther) {
    answer("first", 40, evil);
    const auto text = page();
    const auto policy = between(text, "script-src ", ";");
    EXPECT_THAT(policy, Not(HasSubstr("unsafe")));
    std::size_t scripts = 0;
    std::string_view rest = text;
    for (constexpr std::string_view open = "<script>"; rest.find(open) != std::string_view::npos; ++scripts) {
        rest.remove_prefix(rest.find(open) + open.size());
        EXPECT_THAT(policy, HasSubstr(report::script_sources({rest.substr(0, rest.find("</script>"))})));
    }
    EXPECT_EQ(scripts, 2u);
    EXPECT_EQ(std::ranges::count(policy, ' '), 1) << "one source each";
    EXPECT_FALSE(std::regex_search(text, std::regex(R"(<[a-z][^<>]*\son[a-z]+\s*=)"))) << "a handler in a tag";
}

TEST(PagePolicy, HashesAreThoseOfTheStandard) {
    // FIPS 180-4, examples; base64 of the digests.
    EXPECT_EQ(report::script_sources({""}), "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='");
    EXPECT_EQ(report::script_sources({"abc"}), "'sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0='");
    EXPECT_EQ(report::script_sources({"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"}),
              "'sha256-JI1qYdIGOLjlwCaTDD5gOaM85Flk/yFn9uzt1BnbBsE='");
    const std::string million(1'000'000, 'a');
    EXPECT_EQ(report::script_sources({million, ""}),
              "'sha256-zcduXJkU+5KBocfihNc+Z/GAmkiklyAOBG05zMcRLNA=' "
              "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='");
}

TEST_F(Page, ACampaignWithoutAnswersHasAPageToo) {
    answer_by(
        store, R"({"campaign": "new", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "design": {"kind": "halton", "sequences": 8, "points": 64}})",
        [](const Inputs&) { return 0; }, 0);
    const auto data = Json::parse(between(page(), R"(<script type="application/json" id="data">)", "</script>"));
    const auto& campaign = data["campaigns"][0];
    EXPECT_EQ(campaign["settled"], 0);
    EXPECT_EQ(campaign["observables"][0]["history"]["count"], 0);
    EXPECT_EQ(campaign["outcomes"].back(), Json({"not yet", 64}));
    EXPECT_THAT(tests::text_of(report::closing_summary(store, "new", "a.db", true)),
                HasSubstr("new: 64 cases of rehearsal: 64 not yet"));
}

TEST_F(Page, ALargeCampaignStaysLight) {
    answer("large", 6000);
    const auto data = Json::parse(between(page(), R"(<script type="application/json" id="data">)", "</script>"));
    const auto& campaign = data["campaigns"][0];
    EXPECT_EQ(campaign["settled"], 6000);
    EXPECT_EQ(unpacked(campaign["observables"][0]["values"]).size(), 6000u);
    EXPECT_EQ(unpacked(campaign["factors"][0]["values"]).size(), 6000u);
    EXPECT_EQ(campaign["failures"]["listed"].size(), report::most_listed_failures);
    EXPECT_GT(campaign["failures"]["count"], report::most_listed_failures);
    EXPECT_LT(data.dump().size(), 300'000u);
}

TEST(PageData, CannotEndItsElement) {
    const std::string lines =
        "a\xE2\x80\xA8"
        "b\xE2\x80\xA9";
    const auto text = report::safe_in_script({{"text", evil}, {"bytes", "\xff\xfe ok"}, {"lines", lines}});
    EXPECT_EQ(text.find('<'), std::string::npos);
    EXPECT_EQ(text.find("\xE2\x80\xA8"), std::string::npos);
    const auto back = Json::parse(text);
    EXPECT_EQ(back["text"], evil);
    EXPECT_EQ(back["lines"], lines);
}

}  // namespace grainsweep::tests::report_page_test
