// The report in a real browser, headless Chromium: no script fails, every figure is drawn and saved as vectors, and
// what a reader clicks does what the page says.
#include "sweep/report/page_template.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

namespace grainsweep::tests::report_browser_test {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr auto browser = "/usr/bin/chromium";

/// Stands before the page's program: every complaint counts.
constexpr std::string_view listener = R"(<script>
window.complaints = [];
window.addEventListener("error", (event) => complaints.push(String(event.message)));
window.addEventListener("unhandledrejection", (event) => complaints.push(String(event.reason)));
for (const level of ["error", "warn"]) console[level] = (...words) => complaints.push(words.join(" "));
</script>)";

/// Stands behind it. The browser prints the document when it has loaded, and it has not loaded while a document in a
/// frame of it is still open; so the readers below take the time that the browser's pictures take. (Virtual time is no
/// way: pictures come by the clock, and a loop that waits for one in virtual time can run out before it.)
constexpr std::string_view holder = R"(<iframe id="held" hidden></iframe><script>
const held = document.getElementById("held").contentDocument;
held.open();
held.write(" ");
const until = async (condition) => {
  const last = performance.now() + 60000;
  while (!condition() && performance.now() < last) await new Promise((go) => setTimeout(go, 5));
  if (!condition()) throw new Error("in vain for 60 s: " + condition);
};
const frame = async () => {
  let came = false;
  requestAnimationFrame(() => { came = true; });
  await until(() => came);
};
const chartOf = async (canvas) => {
  canvas.scrollIntoView();
  await until(() => Chart.getChart(canvas));
  await frame();
  await frame();
  return Chart.getChart(canvas);
};
const drawn = (canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let ink = 0;
  for (let i = 3; i < data.length; i += 4) ink += data[i] > 0;
  return ink;
};
// Painted figures: label, shapes and texts of each.
const drawings = () => [...document.querySelectorAll("figure .drawing")].map((one) => [one.getAttribute("aria-label"),
  one.querySelectorAll("svg path, svg circle").length, [...one.querySelectorAll("svg text")].map((text) => text.textContent)]);
const answer = (seen) => {
  seen.complaints = complaints;
  seen.intruder = window.intruder ?? "";
  document.documentElement.dataset.seen = JSON.stringify(seen);
  held.close();
};
</script>)";

/// What a text of a database would be that got out of its place.
constexpr std::string_view intruder = R"(<script>window.intruder = "a script";</script>
<img src="data:," onerror="window.intruder = 'an attribute'" onload="window.intruder = 'an attribute'">)";

/// Reads and clicks as a reader would, and writes what it saw into an attribute of the document.
constexpr std::string_view reader = R"(<script>
(async () => {
  const seen = { events: [], saved: [] };
  document.addEventListener("grainsweep:case", (event) => seen.events.push(event.detail));
  const all = (selector) => [...document.querySelectorAll(selector)];
  const blobs = [];
  URL.createObjectURL = (blob) => { blobs.push(blob); return "data:,"; };
  HTMLAnchorElement.prototype.click = function () { seen.saved.push(this.download); };
  const write = (input, text) => { input.value = text; input.dispatchEvent(new Event("input")); };
  const choose = (select, text) => { select.value = [...select.options].find((one) => one.textContent === text).value; select.dispatchEvent(new Event("change")); };
  const click = (canvas, at) => {
    const box = canvas.getBoundingClientRect(), place = { clientX: box.left + at.x, clientY: box.top + at.y, bubbles: true };
    canvas.dispatchEvent(new MouseEvent("mousemove", place));
    canvas.dispatchEvent(new MouseEvent("click", place));
  };
  const rows = () => all(".rows tr[data-row]");
  try {
    await until(() => document.querySelector("figure"));
    for (const canvas of all("figure canvas")) await chartOf(canvas);
    seen.drawings = drawings();
    seen.titles = all("section h2").map((one) => one.textContent);
    seen.figures = all("figure canvas").map((canvas) => [canvas.getAttribute("aria-label"), drawn(canvas)]);
    seen.listed = rows().length;
    rows()[1].click();
    seen.panel = document.getElementById("case-panel").innerText;
    const count = document.querySelector(".cases .controls span");
    write(all(".filters input")[3], ">0.5");
    await until(() => count.textContent.includes(" of "));
    seen.filtered = count.textContent;
    write(all(".filters input")[3], ">many");
    seen.refused = document.querySelector("input.wrong").title;
    all("button.plain").find((one) => one.textContent === "Clear filters").click();
    all(".cases th button")[3].click();
    seen.lowest = Number(rows()[0].cells[3].textContent);
    all(".cases th button")[3].click();
    seen.highest = Number(rows()[0].cells[3].textContent);
    const cases = all("figure").find((one) => one.querySelector("h3").textContent === "Cases").querySelector("canvas");
    click(cases, (await chartOf(cases)).getDatasetMeta(0).data[0]);
    await until(() => seen.events.length === 2);
    const buttons = all("figure button.save");
    for (const button of buttons) button.click();
    await until(() => blobs.length === buttons.length);
    seen.svg = [];
    for (const blob of blobs.filter((one) => one.type === "image/svg+xml")) {
      const text = await blob.text(), parsed = new DOMParser().parseFromString(text, "image/svg+xml");
      seen.svg.push([parsed.querySelector("parsererror") === null && !/NaN|undefined|<image/.test(text), parsed.querySelectorAll("path").length, parsed.querySelectorAll("text").length]);
    }
    seen.png = blobs.filter((one) => one.type === "image/png").length;
    const names = all(".names .name");
    seen.curves = names.length;
    if (names.length > 0) {
      const chart = await chartOf(names[0].closest("figure").querySelector("canvas"));
      names[0].dispatchEvent(new MouseEvent("mouseenter"));
      seen.widest = Math.max(...chart.data.datasets.map((set) => set.borderWidth));
      names[0].click();
      seen.away = names.filter((name) => name.classList.contains("away")).length;
    }
    const other = document.getElementById("other");
    seen.others = [...other.options].map((one) => one.textContent);
    choose(other, seen.others[seen.others.length - 1]);
    await until(() => document.querySelector(".overlaid"));
    seen.overlaid = document.querySelector(".overlaid").textContent;
    seen.effects = all("#effects figure").map((one) => [...one.querySelectorAll(".drawing")].map((drawing) => drawing.getAttribute("aria-label")));
    choose(document.getElementById("campaign"), seen.others[1]);
    for (const canvas of all("figure canvas")) await chartOf(canvas);
    seen.second = document.querySelector("h1").textContent;
  } catch (error) {
    seen.failed = String(error.stack);
  }
  answer(seen);
})();
</script>)";

/// The same for the page of a process window: its figures and the numbers under its heads.
constexpr std::string_view window_reader = R"(<script>
(async () => {
  const seen = {};
  try {
    await until(() => document.querySelector("figure"));
    seen.drawings = drawings();
    seen.library = "Chart" in window;
    seen.titles = [...document.querySelectorAll("section h2")].map((one) => one.textContent);
    seen.set = document.querySelector("#setting table").innerText;
  } catch (error) {
    seen.failed = String(error.stack);
  }
  answer(seen);
})();
</script>)";

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

/// A script element without its tags.
std::string_view inside(std::string_view html) {
    constexpr std::string_view open = "<script>", close = "</script>";
    const auto begin = html.find(open) + open.size();
    return html.substr(begin, html.find(close) - begin);
}

/// What the reader saw on the page.
Json read_in_browser(const Folder& folder, const std::string& page, std::string_view script = reader) {
    std::string text = contents(folder / page);
    // Of what is added the policy of the page allows the scripts of this test and nothing else.
    const std::string_view policy = "script-src ";
    text.insert(text.find(policy) + policy.size(),
                grainsweep::report::script_sources({inside(listener), inside(holder), inside(script)}) + " ");
    text.insert(text.find("<style>"), listener);
    text.insert(text.rfind("</body>"), std::string(intruder) + std::string(holder) + std::string(script));
    const auto file = folder.write("read.html", text);
    const auto ended = Process({browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
                                "--no-first-run", "--disable-background-networking", "--disable-component-update",
                                "--disable-sync", "--user-data-dir=" + (folder / "profile").string(),
                                "--window-size=1400,12000", "--dump-dom", "file://" + file.string()},
                               folder.path())
                           .wait();
    constexpr std::string_view attribute = "data-seen=\"";
    const auto begin = ended.out.find(attribute);
    if (begin == std::string::npos) return {{"failed", "no answer: " + ended.err}};
    std::string seen = ended.out.substr(begin + attribute.size());
    seen.erase(seen.find('"'));
    for (const auto& [escaped, plain] :
         {std::pair{"&quot;", "\""}, {"&lt;", "<"}, {"&gt;", ">"}, {"&nbsp;", " "}, {"&amp;", "&"}})
        replace_all(seen, escaped, plain);
    return Json::parse(seen);
}

void expect_quiet(const Json& seen) {
    EXPECT_FALSE(seen.contains("failed")) << seen.value("failed", "");
    EXPECT_EQ(seen.value("complaints", Json::array()), Json::array());
    EXPECT_EQ(seen.value("intruder", "no answer"), "") << "a script ran that is not the page's";
}

/// Every painted figure has marks and the labels of two axes.
void expect_drawn(const Json& drawings) {
    for (const auto& one : drawings) {
        EXPECT_GT(one[1], 2) << one[0];
        EXPECT_GT(one[2].size(), 4u) << one[0];
    }
}

struct ReportInABrowser : ::testing::Test {
    Folder folder;

    void SetUp() override {
        ASSERT_TRUE(fs::exists(browser)) << "this test needs " << browser << "; ./bootstrap.sh test installs it";
    }
    void run(const std::string& config) {
        folder.write("c.json", config);
        const auto ended = run_program({"run", "c.json", "--quiet", "--db", "c.db"}, folder.path());
        ASSERT_EQ(ended.code, 0) << ended.err;
    }
    [[nodiscard]] std::string query(const std::string& sql) const {
        const auto ended = run_program({"query", "c.db", sql, "--format", "csv"}, folder.path());
        return ended.out.substr(ended.out.find('\n') + 1);
    }
};

TEST_F(ReportInABrowser, DrawsAProcessWindow) {
    run(R"({"campaign": "first", "scene": "rehearsal", "fixed": {"noise": 0.05},
            "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0.01, 1], "scale": "log"},
                        {"name": "x3", "levels": [0, 0.5]}], "design": {"kind": "halton", "points": 100}})");
    const auto ended = run_program(
        {"window", "c.db", "--where", "x1 < 0.5 and y > 0.3", "--maximize", "y", "--next", "2", "-o", "w.html"},
        folder.path());
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto seen = read_in_browser(folder, "w.html", window_reader);
    expect_quiet(seen);
    if (seen.contains("failed")) return;
    // Two maps; response and probability against each of three factors.
    EXPECT_EQ(seen["drawings"].size(), 8u);
    expect_drawn(seen["drawings"]);
    EXPECT_GT(seen["drawings"][0][1], 1681) << "41 x 41 cells";
    EXPECT_FALSE(seen["library"].get<bool>()) << "nothing is drawn by a script";
    EXPECT_EQ(seen["titles"], Json({"Setting", "Process window", "Along each factor", "To run next", "Basis"}));
    EXPECT_NE(seen["set"].get<std::string>().find("x1"), std::string::npos);
}

TEST_F(ReportInABrowser, DrawsSavesFiltersAndSelects) {
    run(R"({"campaign": "first", "scene": "rehearsal", "fixed": {"noise": 0.2}, "replicates": 2,
            "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0.01, 1], "scale": "log"},
                        {"name": "response", "levels": ["sum", "g_function"]}],
            "design": {"kind": "halton", "sequences": 8, "points": 160}})");
    run(R"({"campaign": "second", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
            "design": {"kind": "lattice", "levels": 5}})");
    ASSERT_EQ(run_program({"report", "c.db"}, folder.path()).code, 0);
    const auto seen = read_in_browser(folder, "c.html");
    expect_quiet(seen);
    if (seen.contains("failed")) return;
    for (const auto& [title, ink] : seen["figures"].get<std::vector<std::pair<std::string, int>>>())
        EXPECT_GT(ink, 500) << title;
    EXPECT_EQ(seen["figures"].size(), 5u)
        << "in which readers act: the cases, the map, three pictures against a factor";
    // A distribution, five moments, three effects, the shares, the parts of the variance; of the response model three
    // curves and two maps.
    EXPECT_EQ(seen["drawings"].size(), 16u);
    expect_drawn(seen["drawings"]);
    EXPECT_LT(seen["listed"], 60);  // of 320: the rows in view only

    const std::string row_1 = query("SELECT case_id FROM first ORDER BY point, replicate LIMIT 1 OFFSET 1");
    ASSERT_EQ(seen["events"].size(), 2u);
    EXPECT_EQ(seen["events"][0], Json({{"database", "c.db"}, {"campaign", "first"}, {"case_id", row_1.substr(0, 32)}}));
    EXPECT_EQ(seen["events"][1]["campaign"], "first");
    const std::string first_point = seen["events"][1]["case_id"];
    EXPECT_EQ(query("SELECT count(*) FROM first WHERE case_id = '" + first_point + "'"), "1\n");
    for (const auto* words : {"Point 0, replicate 1", "Inputs", "Responses", "grainsweep replay c.db"})
        EXPECT_NE(seen["panel"].get<std::string>().find(words), std::string::npos) << words;

    const auto above = query("SELECT count(*) FROM first WHERE x1 > 0.5");
    EXPECT_EQ(seen["filtered"], above.substr(0, above.find('\n')) + " of 320 cases");
    EXPECT_EQ(seen["refused"], "many is not a number");
    EXPECT_NEAR(seen["lowest"].get<double>(), std::stod(query("SELECT min(x1) FROM first")), 1e-5);
    EXPECT_NEAR(seen["highest"].get<double>(), std::stod(query("SELECT max(x1) FROM first")), 1e-5);

    ASSERT_EQ(seen["svg"].size(), 21u);
    for (const auto& picture : seen["svg"]) {
        EXPECT_TRUE(picture[0].get<bool>());
        EXPECT_GT(picture[1], 2);
        EXPECT_GT(picture[2], 4);
    }
    EXPECT_EQ(seen["png"], 21);
    EXPECT_EQ(seen["saved"].size(), 42u);

    EXPECT_EQ(seen["others"], Json({"nothing", "second"}));
    EXPECT_EQ(seen["overlaid"], "Blue: first; orange: second. Painted figures stand one below the other.");
    EXPECT_EQ(seen["effects"], Json({{"x1, first", "x1, second"}, {"x2"}, {"response"}}));
    EXPECT_EQ(seen["second"], "second");
}

TEST_F(ReportInABrowser, ShowsCurvesAndTheCampaignsOfAnotherDatabase) {
    const std::string factors =
        R"("factors": [{"name": "x1", "between": [0, 1]}], "design": {"kind": "halton", "points": 6})";
    run(R"({"campaign": "curves", "scene": "rehearsal", "fixed": {"behaviour": "huge"}, )" + factors + "}");
    fs::rename(folder / "c.db", folder / "other.db");
    run(R"({"campaign": "plain", "scene": "rehearsal", )" + factors + "}");
    ASSERT_EQ(run_program({"report", "other.db", "--with", "c.db", "-o", "both.html"}, folder.path()).code, 0);
    const auto seen = read_in_browser(folder, "both.html");
    expect_quiet(seen);
    if (seen.contains("failed")) return;
    EXPECT_EQ(seen["curves"], 6);
    EXPECT_GT(seen["widest"], 3);
    EXPECT_EQ(seen["away"], 5);
    EXPECT_EQ(seen["others"], Json({"nothing", "plain (c.db)"}));
    EXPECT_EQ(seen["overlaid"],
              "Blue: curves (other.db); orange: plain (c.db). Painted figures stand one below the other.");
    EXPECT_EQ(seen["second"], "plain");
}

}  // namespace grainsweep::tests::report_browser_test
