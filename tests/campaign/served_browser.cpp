// The page of `grainsweep serve` in headless Chromium while a campaign runs.
#include "tests/support/driven_browser.hpp"
#include "tests/support/live_server.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::tests::served_browser_test {

using Json = nlohmann::json;

/// A text of the campaign that would be a script where it got out of its place.
const char* config = R"({"campaign": "a", "scene": "rehearsal", "fixed": {"wait_seconds": 0.05},
 "notes": "<img src=x onerror='window.intruder=1'></script><script>window.intruder=1</script>",
 "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
 "design": {"kind": "halton", "points": 4000}})";

struct ServedInABrowser : testing::Test {
    Folder folder;

    ServedInABrowser() {
        folder.write("a.json", config);
        const auto ended = run_program({"run", "a.json", "--quiet", "--max-cases", "20", "-j", "1"}, folder.path());
        EXPECT_EQ(ended.code, 1) << ended.err;
    }
    [[nodiscard]] std::vector<std::string> run() const {
        return program_command({"run", "a.json", "--quiet", "-j", "1"});
    }
};

/// Number of completed cases that the page shows.
const std::string known = R"(Number([...document.querySelectorAll('.outcomes .tile')]
    .find((one) => one.textContent.includes('completed')).querySelector('b').textContent))";
const std::string selected = "document.querySelector('tr.selected').lastElementChild.textContent";
const std::string figures = "document.querySelector('#response').innerText";

TEST_F(ServedInABrowser, PointsAppearAndWhatTheReaderChoseStays) {
    const LiveServer server(folder, "a.db");
    DrivenBrowser page(server.address(), folder, {});
    ASSERT_TRUE(page.until("document.querySelector('.cases .filters input') && document.querySelector('#now .card')"));
    // The reader filters by x1, sorts by x2, falling, opens a case and types on.
    page.value(R"((() => {
      const input = document.querySelector('input[aria-label="filter x1"]');
      input.value = '>0.5'; input.dispatchEvent(new Event('input'));
      const head = [...document.querySelectorAll('.cases th button')].find((one) => one.textContent.startsWith('x2'));
      head.click(); head.click();
    })())");
    ASSERT_TRUE(page.until("document.querySelector('.cases .controls span').textContent.includes(' of ')"));
    page.value("document.querySelectorAll('.rows tr[data-row]')[1].click()");
    const auto chosen = page.value(selected);
    page.value("document.querySelector('input[aria-label=\"filter x1\"]').focus()");
    const auto before = page.value(known).get<int>();
    // Beside a run only the first second of processor time for figures is given at once: these are of it.
    page.value("window.before = " + figures);
    {
        Process run_of_it(run(), folder.path());
        EXPECT_TRUE(page.until(known + " >= " + std::to_string(before + 10))) << "points appear";
        EXPECT_TRUE(page.until("document.querySelector('#now progress.whole')"));
        EXPECT_TRUE(page.until("document.querySelectorAll('#now tbody tr').length > 0")) << "running cases";
        EXPECT_TRUE(page.until("window.before !== " + figures)) << "newer figures";
        run_of_it.signal(SIGINT);
        EXPECT_EQ(run_of_it.wait().code, 130);
    }
    EXPECT_TRUE(page.until("document.querySelector('#now').innerText.includes('no run is under way')"));
    EXPECT_EQ(page.value("document.querySelector('input[aria-label=\"filter x1\"]').value"), ">0.5");
    EXPECT_EQ(page.value("document.activeElement.getAttribute('aria-label')"), "filter x1");
    EXPECT_EQ(page.value(selected), chosen);
    const auto shown = page.value(R"((() => {
      const at = (name) => [...document.querySelectorAll('.cases th button')].findIndex((one) => one.textContent.startsWith(name));
      return [...document.querySelectorAll('.rows tr[data-row]')].map((row) => ['x1', 'x2'].map((name) => Number(row.cells[at(name)].textContent)));
    })())");
    ASSERT_GT(shown.size(), 3u);
    for (std::size_t k = 0; k < shown.size(); ++k) {
        EXPECT_GT(shown[k][0], 0.5);
        EXPECT_LE(shown[k][1], shown[k == 0 ? 0 : k - 1][1]);
    }
    EXPECT_EQ(page.value("window.intruder ?? ''"), "");
    EXPECT_EQ(page.complaints(), std::vector<std::string>());
}

TEST_F(ServedInABrowser, FitsAPhoneAndTheDark) {
    const LiveServer server(folder, "a.db");
    DrivenBrowser page(server.address(), folder, {.width = 390, .height = 844, .dark = true});
    ASSERT_TRUE(page.until("document.querySelector('#sql textarea') && document.querySelector('#now .card')"));
    const auto wide = "document.documentElement.scrollWidth - document.documentElement.clientWidth";
    EXPECT_LE(page.value(wide), 0) << "nothing to scroll sideways";
    const auto ground = [&] { return page.value("getComputedStyle(document.body).backgroundColor"); };
    EXPECT_EQ(ground(), "rgb(18, 22, 26)");
    // Painted figures, too.
    ASSERT_TRUE(page.until("document.querySelector('.drawing text')"));
    const auto ink = "getComputedStyle(document.querySelector('.drawing text')).fill";
    EXPECT_EQ(page.value(ink), "rgb(230, 234, 238)");
    page.show({.width = 1600, .height = 1000, .dark = false});
    EXPECT_TRUE(page.until(ink + std::string(" === 'rgb(0, 0, 0)'")));
    EXPECT_TRUE(page.until("getComputedStyle(document.body).backgroundColor === 'rgb(245, 246, 248)'"));
    EXPECT_LE(page.value(wide), 0);
    page.value("[...document.querySelectorAll('#sql button')].find((one) => one.textContent === 'Run').click()");
    EXPECT_TRUE(page.until("document.querySelectorAll('#sql tbody tr').length === 20"));
    EXPECT_EQ(page.complaints(), std::vector<std::string>());
}

// Two databases of a folder hold a campaign of the same name. A film is of the case that the reader sees.
TEST_F(ServedInABrowser, FilmsAreOfTheChosenDatabase) {
    ASSERT_EQ(
        run_program({"run", "a.json", "--db", "b.db", "--quiet", "--max-cases", "3", "-j", "1"}, folder.path()).code,
        1);
    const LiveServer server(folder, ".");
    DrivenBrowser page(server.address(), folder, {});
    ASSERT_TRUE(page.until("document.getElementById('campaign').options.length === 2"));
    page.value(
        "window.asked = []; const send = window.fetch; window.fetch = (address, ...more) => {"
        " window.asked.push(String(address)); return send(address, ...more); }; 0");
    for (const std::string title : {"a (b.db)", "a (a.db)"}) {
        page.value("window.asked.length = 0");
        page.value(
            "(() => { const select = document.getElementById('campaign'); select.value = "
            "[...select.options].find((one) => one.textContent === '" +
            title +
            "').value; "
            "select.dispatchEvent(new Event('change')); })()");
        ASSERT_TRUE(page.until("document.querySelector('.rows tr[data-row]')"));
        page.value("document.querySelector('.rows tr[data-row]').click()");
        EXPECT_TRUE(page.until("document.querySelector('#case-panel .says').textContent.startsWith('" + title + "')"));
        page.value("document.querySelector('#case-panel .watch button').click()");
        EXPECT_TRUE(page.until("window.asked.some((one) => one.startsWith('film?'))"));
        EXPECT_EQ(
            page.value(
                "new URLSearchParams(window.asked.find((one) => one.startsWith('film?')).slice(5)).get('database')"),
            title.substr(3, 4));
    }
}

TEST_F(ServedInABrowser, SaysThatTheServerIsGone) {
    std::optional<LiveServer> server(std::in_place, folder, "a.db");
    DrivenBrowser page(server->address(), folder, {});
    ASSERT_TRUE(page.until("document.querySelector('#now .card')"));
    server.reset();
    EXPECT_TRUE(page.until("document.querySelector('#now').innerText.includes('The server does not answer')"));
}

}  // namespace grainsweep::tests::served_browser_test
