// The page is one file: its data is well-formed and cannot break out, and nothing in it asks a network.
#include "sweep/report/page.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/summary.hpp"
#include "tests/support/answered.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>
#include <sstream>
#include <string>

namespace grainsweep::tests {
namespace {

using Json = nlohmann::ordered_json;
using store::Store;
using testing::HasSubstr;
using testing::Not;

const std::string evil = R"(</script><script>alert(1)</script> <!-- & "quoted" ]]>)";

struct Page : testing::Test {
    Folder folder;
    Store store{folder / "a.db", Store::Mode::create};

    void answer(const std::string& name, int points, const std::string& notes = "") {
        Json file = {{"campaign", name},
                     {"notes", notes},
                     {"scene", "rehearsal"},
                     {"factors", Json::array({{{"name", "x1"}, {"between", {0, 1}}},
                                              {{"name", "response"}, {"levels", {"sum", "ishigami"}}}})},
                     {"design", {{"kind", "halton"}, {"sequences", 8}, {"points", points}}},
                     {"convergence", {{"observable", "y"}, {"tolerance", 0.5}, {"block", 40}}}};
        answer_by(store, file.dump(), [](const Inputs& inputs) -> std::optional<double> {
            if (input(inputs, "x1") > 0.95) return std::nullopt;
            return 1 + input(inputs, "x1");
        });
    }
    [[nodiscard]] std::string page() const {
        std::ostringstream out;
        report::write_page(out, store, "a.db");
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
    EXPECT_EQ(data["database"], "a.db");
    ASSERT_EQ(data["campaigns"].size(), 2u);
    const auto& campaign = data["campaigns"][0];
    EXPECT_EQ(campaign["name"], "first");
    EXPECT_EQ(campaign["rows"], 160);
    EXPECT_EQ(campaign["factors"][1]["levels"], Json({"sum", "ishigami"}));
    EXPECT_EQ(campaign["runs"][0]["compiler"], "g++ 12");

    const auto& y = campaign["observables"][campaign["main"].get<std::size_t>()];
    EXPECT_EQ(y["name"], "y");
    EXPECT_EQ(y["history"]["points"], Json({40, 80, 120, 160}));
    EXPECT_EQ(y["history"]["statistics"]["mean"]["errors"].size(), 4u);
    EXPECT_EQ(y["history"]["converged_at"], 80);
    EXPECT_EQ(y["drawn"].size(), 160u);
    EXPECT_EQ(y["effects"].size(), 2u);
    EXPECT_EQ(y["effects"][1].size(), 2u);
    EXPECT_EQ(y["influence"]["factors"][0]["name"], "x1");
    EXPECT_GT(y["influence"]["factors"][0]["first"], 0.9);
    EXPECT_EQ(y["largest"].size(), 8u);
    EXPECT_GE(y["largest"][0]["value"], y["largest"][1]["value"]);
    EXPECT_LE(y["smallest"][0]["value"], y["smallest"][1]["value"]);

    const auto& failures = campaign["failures"];
    ASSERT_GT(failures["count"], 0);
    EXPECT_EQ(failures["listed"].size(), failures["count"]);
    EXPECT_EQ(failures["listed"][0]["reason"], "the formula has no answer");
    EXPECT_EQ(failures["count"], y["history"]["excluded"]);
    std::int64_t counted = 0;
    for (const auto& n : y["histogram"]["counts"]) counted += n.get<std::int64_t>();
    EXPECT_EQ(counted, y["history"]["count"]);
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
        EXPECT_EQ(report::page_files().program.find(door), std::string_view::npos) << door;
    }
}

TEST_F(Page, AsksNoNetwork) {
    answer("first", 40);
    const auto text = page();
    EXPECT_THAT(text, HasSubstr("default-src 'none'"));
    EXPECT_THAT(text, Not(HasSubstr("{{")));
    static const std::regex request(
        R"((src|href|srcset|action)\s*=\s*["']|url\(|@import|fetch\(|XMLHttpRequest|WebSocket|EventSource|sendBeacon|importScripts)");
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, request)) << found.str();
    EXPECT_THAT(report::page_files().library.substr(0, 60), HasSubstr("Chart.js v3"));
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
    EXPECT_THAT(report::closing_summary(store, "new", "a.db"), HasSubstr("new: 64 cases of rehearsal: 64 not yet"));
}

TEST_F(Page, ALargeCampaignStaysLight) {
    answer("large", 6000);
    const auto data = Json::parse(between(page(), R"(<script type="application/json" id="data">)", "</script>"));
    const auto& campaign = data["campaigns"][0];
    EXPECT_EQ(campaign["settled"], 6000);
    EXPECT_EQ(campaign["drawn_rows"], report::most_drawn_cases);
    EXPECT_EQ(campaign["observables"][0]["drawn"].size(), report::most_drawn_cases);
    EXPECT_EQ(campaign["factors"][0]["drawn"].size(), report::most_drawn_cases);
    EXPECT_EQ(campaign["failures"]["listed"].size(), report::most_listed_failures);
    EXPECT_GT(campaign["failures"]["count"], report::most_listed_failures);
    EXPECT_LE(campaign["observables"][0]["history"]["points"].size(), 151u);
    EXPECT_EQ(campaign["observables"][0]["history"]["points"].back(), 6000);
    EXPECT_LT(data.dump().size(), 250'000u);
}

TEST(PageData, CannotEndItsElement) {
    const Json value = {{"text", evil},
                        {"bytes", "\xff\xfe ok"},
                        {"lines",
                         "a\xE2\x80\xA8"
                         "b\xE2\x80\xA9"}};
    const auto text = report::safe_in_script(value);
    EXPECT_EQ(text.find('<'), std::string::npos);
    EXPECT_EQ(text.find("\xE2\x80\xA8"), std::string::npos);
    const auto back = Json::parse(text);
    EXPECT_EQ(back["text"], evil);
    EXPECT_EQ(back["lines"], value["lines"]);
}

}  // namespace
}  // namespace grainsweep::tests
