// --watch of solve and replay, through the real executable and a real browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "sweep/report/page_template.hpp"
#include "tests/support/browser.hpp"
#include "tests/support/process.hpp"

namespace grainsweep::tests::watch_test {

using nlohmann::json;

const char* cell = R"({"campaign": "c", "scene": "tpms_discharge", "factors": [{"name": "cohesion", "levels": [0]}],
  "fixed": {"edge": 8, "shell": 2, "gravity": 122.6, "end_time": 0.5}, "design": {"kind": "lattice"}})";
const char* bed = R"({"campaign": "b", "scene": "powder_spreading", "factors": [{"name": "gap", "levels": [0.008]}],
  "fixed": {"diameter": 0.004, "width": 3, "layer_area": 1e-4, "travel": 0.02, "settle_time": 0.02},
  "design": {"kind": "lattice"}})";
const char* cavity =
    R"({"campaign": "v", "scene": "thermovibration", "factors": [{"name": "rayleigh", "levels": [3e5]}],
  "fixed": {"frequency": 23300, "acceleration": 1.09e9, "particles": 50, "cells": 10, "steps_per_period": 16,
            "end_time": 0.01, "sampling_cells": 5}, "design": {"kind": "lattice"}})";

std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Stands before the page's program and collects every error.
const std::string listener = R"(<script>
window.errors = [];
window.addEventListener("error", (event) => errors.push(event.message));
window.addEventListener("unhandledrejection", (event) => errors.push(String(event.reason)));
</script>)";

/// Stands behind it: plays with the player, and writes what it drew into attributes of the root element.
const std::string self_test = R"(<script>
function pixels(player, moment) {
  const { gl, canvas } = player.painter, bytes = new Uint8Array(4 * canvas.width * canvas.height);
  player.moment = moment;
  player.paint();
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  return bytes;
}
function differing(a, b) {
  let count = 0;
  for (let i = 0; i < a.length; i += 4) count += a[i] !== b[i] || a[i + 1] !== b[i + 1] || a[i + 2] !== b[i + 2] ? 1 : 0;
  return count;
}
// Returns a function that tells how many lines of forces were drawn since.
function gl_draws({ painter: { gl } }) {
  let most = 0;
  const draw = gl.drawArraysInstanced.bind(gl);
  let calls = 0;
  gl.drawArraysInstanced = (mode, first, count, instances) => { if (++calls > 1) most = instances; draw(mode, first, count, instances); };
  return () => { gl.drawArraysInstanced = draw; return most; };
}
function places({ places, spheres, header }, frame) {
  const mean = [0, 0, 0];
  let count = 0;
  for (let at = 4 * frame * spheres; at < 4 * (frame + 1) * spheres; at += 4) {
    if (places[at + 3] === 0) continue;
    ++count;
    for (let a = 0; a < 3; ++a) mean[a] += header.positions.low[a] + header.positions.step[a] * places[at + a];
  }
  return { count, mean: mean.map((sum) => sum / Math.max(count, 1)) };
}
function tested(player) {
  const { film } = player, last = film.frames - 1, ground = player.ground.map((c) => Math.round(255 * c));
  const first = pixels(player, 0), end = pixels(player, last);
  let painted = 0;
  for (let i = 0; i < first.length; i += 4) painted += Math.abs(first[i] - ground[0]) + Math.abs(first[i + 1] - ground[1]) > 2 ? 1 : 0;
  const told = { frames: film.frames, spheres: film.spheres, pixels: first.length / 4, painted, differing: differing(first, end) };
  if (film.spheres > 0) {
    told.first = places(film, 0);
    told.last = places(film, last);
    const middle = Math.floor(last / 2), before = pixels(player, middle);
    told.colours = player.shadings.map((shading) => { player.colourBy(shading.key); return [shading.key, differing(before, pixels(player, middle))]; });
    player.colourBy(player.shadings[0].key);
    told.colour_range = [player.range.low, player.range.high, player.shading.low, player.shading.high];
    const fields = [...document.querySelectorAll(".watch-range input")];
    fields[1].value = Number(fields[1].value) / 3;
    fields[1].dispatchEvent(new Event("change"));
    told.narrower = differing(before, pixels(player, middle));
    fields[1].value = "";
    fields[1].dispatchEvent(new Event("change"));
    told.wrong = fields[1].classList.contains("watch-wrong");
    player.setRange(null);
    told.reset = differing(before, pixels(player, middle));
    player.painter.show.walls = false;
    told.walls = differing(before, pixels(player, middle));
    player.painter.show.walls = true;
  }
  if (film.forces) {
    const without = pixels(player, last), { show } = player.painter, draw = gl_draws(player);
    show.forces = true;
    told.forces = { differing: differing(without, pixels(player, last)), contacts: film.forces.first.length, drawn: draw() };
    show.forces = false;
    told.forces.off = differing(without, pixels(player, last));
  }
  told.slices = film.header.slices.map((slice, k) => {
    player.chooseSlice(-1);
    const without = pixels(player, last);
    player.chooseSlice(k);
    return differing(without, pixels(player, last));
  });
  player.camera.turn(0.7, 0.2);
  told.turned = differing(end, pixels(player, last));
  told.graphics = player.painter.gl.getError();
  told.keys = [...document.querySelectorAll(".watch-keys > span")].map((one) => one.textContent);
  return told;
}
async function compared() {
  await grainsweepWatch.compare(`id="watch-film">${document.getElementById("watch-film").textContent}<`);
  const { player } = grainsweepWatch, shown = player.film.frames - 1;
  pixels(player, shown);
  const { gl, canvas } = player.beside.painter, bytes = new Uint8Array(4 * canvas.width * canvas.height);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  return { stages: document.querySelectorAll(".watch-stage").length, moment: player.beside.moment - shown,
    painted: differing(bytes, bytes.map((_, i) => Math.round(255 * (player.ground[i % 4] ?? 1)))),
    captions: [...document.querySelectorAll(".watch-caption")].map((one) => one.textContent) };
}
(async () => {
  const told = document.documentElement.dataset;
  try {
    while (!window.grainsweepWatch) await new Promise((go) => setTimeout(go, 5));
    const seen = tested(grainsweepWatch.player);
    seen.pair = await compared();
    seen.stranger = await grainsweepWatch.compare("<p>no film</p>").then(() => "", (error) => error.message);
    told.selftest = JSON.stringify(seen);
  } catch (error) {
    errors.push(String(error.stack));
  }
  told.errors = JSON.stringify(errors);
})();
</script>)";

std::string inside(const std::string& element) {
    return element.substr(8, element.size() - 17);  // without <script> and </script>
}

/// Solves the case with --watch and tests the page.
json watched(const char* config, const char* frames, const Folder& folder, const std::vector<std::string>& more = {}) {
    folder.write("c.json", config);
    std::vector<std::string> words = {"solve", "c.json", "--watch", "case.html", "--frames", frames};
    words.insert(words.end(), more.begin(), more.end());
    const auto ended = run_program(words, folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(ended.out.find("case.html ("), std::string::npos) << ended.out;  // it says what it wrote
    std::string page = contents(folder / "case.html");
    const std::string policy = "script-src ";
    page.insert(page.find(policy) + policy.size(),
                grainsweep::report::script_sources({inside(listener), inside(self_test)}) + " ");
    page.insert(page.find("<style>"), listener);
    page.insert(page.rfind("</body>"), self_test);
    const Browsed seen = browse(folder.write("tested.html", page), "#t=0", folder.path());
    EXPECT_EQ(seen.data.count("errors"), 1U) << seen.said;
    EXPECT_EQ(seen.data.at("errors"), "[]");
    EXPECT_THAT(seen.console, testing::IsEmpty());
    const json told = json::parse(seen.data.at("selftest"));
    EXPECT_EQ(told.at("graphics"), 0) << "an error of WebGL";
    EXPECT_GT(told.at("painted"), told.at("pixels").get<double>() / 100) << told;
    EXPECT_GT(told.at("differing"), 100) << told;
    EXPECT_GT(told.at("turned"), 100) << told;
    EXPECT_EQ(told.at("pair").at("stages"), 2) << told;
    EXPECT_EQ(told.at("pair").at("moment"), 0) << told;
    EXPECT_GT(told.at("pair").at("painted"), 100) << told;
    EXPECT_EQ(told.at("pair").at("captions").size(), 2U) << told;
    EXPECT_EQ(told.at("stranger"), "the file is no page of --watch");
    EXPECT_THAT(told.at("keys").get<std::vector<std::string>>(),
                testing::IsSupersetOf({"space play or pause", "Home End first or last frame", "1 2 3 4 views"}));
    return told;
}

TEST(Watch, ACellIsPlayedInTheBrowser) {
    const Folder folder;
    const json told = watched(cell, "6", folder);
    EXPECT_EQ(told.at("frames"), 6);
    EXPECT_GT(told.at("walls"), 100);
    for (const auto& [column, pixels] : told.at("colours").get<std::vector<std::pair<std::string, int>>>())
        EXPECT_TRUE(pixels > 100 || column == "velocity") << column << told;
}

TEST(Watch, ABedIsPlayedWithItsBlade) {
    const Folder folder;
    const json told = watched(bed, "8", folder);
    EXPECT_GT(told.at("walls"), 100);
    const auto range = told.at("colour_range").get<std::vector<double>>();
    EXPECT_EQ(range[0], 0);
    EXPECT_LT(range[1], range[3]) << "the fall at the start darkens the rest";
    EXPECT_GT(told.at("narrower"), 100);
    EXPECT_EQ(told.at("wrong"), true);
    EXPECT_EQ(told.at("reset"), 0);
    EXPECT_LT(told.at("last").at("mean")[2], told.at("first").at("mean")[2]);  // the powder settles
}

TEST(Watch, ForcesAreDrawnWhereTheyAreRequested) {
    const Folder folder;
    EXPECT_FALSE(watched(bed, "4", folder).contains("forces"));
    const json forces = watched(bed, "4", folder, {"--forces"}).at("forces");
    EXPECT_GT(forces.at("contacts"), 10) << forces;
    EXPECT_GT(forces.at("drawn"), 5) << forces;
    EXPECT_GT(forces.at("differing"), 100) << forces;
    EXPECT_EQ(forces.at("off"), 0) << forces;
    EXPECT_NE(run_program({"solve", "c.json", "--forces"}, folder.path()).err.find("needs --watch"), std::string::npos);
}

TEST(Watch, AFlowIsSliced) {
    const Folder folder;
    const json told = watched(cavity, "5", folder);
    ASSERT_EQ(told.at("slices").size(), 5U);  // velocity and its three components, temperature
    for (const auto& pixels : told.at("slices")) EXPECT_GT(pixels, 1000) << told;
}

TEST(Watch, TheBrowserUnpacksTheVeryPositions) {
    const Folder folder;
    const json told = watched(cell, "3", folder);
    ASSERT_EQ(
        run_program({"solve", "c.json", "--vtk", "film", "--frames", "3", "--watch", "again.html"}, folder.path()).code,
        0);
    EXPECT_TRUE(std::filesystem::exists(folder / "again.html"));
    // Centres of mass, from the VTP files of the same moments.
    const std::string vtp = contents(folder / "film/tpms_discharge_0000.vtp");
    const std::string opening = "<AppendedData encoding=\"raw\">\n_";
    const std::size_t begin = vtp.find(opening) + opening.size();
    std::uint64_t length = 0;
    std::memcpy(&length, vtp.data() + begin, sizeof length);
    std::vector<float> places(length / sizeof(float));
    std::memcpy(places.data(), vtp.data() + begin + sizeof length, length);
    ASSERT_EQ(places.size() / 3, told.at("first").at("count").get<std::size_t>());
    for (std::size_t a = 0; a < 3; ++a) {
        double sum = 0;
        for (std::size_t i = a; i < places.size(); i += 3) sum += static_cast<double>(places[i]);
        const double mean = 3 * sum / static_cast<double>(places.size());
        EXPECT_NEAR(told.at("first").at("mean")[a].get<double>(), mean, 12 * 45e-6 / 65535);
    }
}

TEST(Watch, ChangesNoBitOfTheAnswer) {
    const Folder folder;
    folder.write("c.json", cavity);
    const auto plain = run_program({"solve", "c.json", "--format", "json"}, folder.path());
    const auto seen = run_program({"solve", "c.json", "--format", "json", "--watch", "w.html"}, folder.path());
    ASSERT_EQ(seen.code, 0) << seen.err;
    json a = json::parse(plain.out), b = json::parse(seen.out);
    a.erase("cost"), b.erase("cost");
    EXPECT_EQ(a, b);
}

TEST(Watch, OfAStoredCaseComparesAsBefore) {
    const Folder folder;
    folder.write("c.json", cell);
    ASSERT_EQ(run_program({"run", "c.json", "-j", "1"}, folder.path()).code, 0);
    const auto rows =
        json::parse(run_program({"query", "c.db", "SELECT case_id FROM c", "--format", "json"}, folder.path()).out);
    const std::string id = rows.at(0).at("case_id");
    const auto replayed = run_program({"replay", "c.db", id, "--watch", "w.html", "--frames", "3"}, folder.path());
    EXPECT_EQ(replayed.code, 0) << replayed.out << replayed.err;
    EXPECT_NE(replayed.out.find("equal to the last bit"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(folder / "w.html"));
}

TEST(Watch, IsRefusedBeforeAnythingIsComputed) {
    const Folder folder;
    folder.write("c.json", cell);
    const auto refused = [&](const std::string& page, const std::string& sentence) {
        const auto ended = run_program({"solve", "c.json", "--watch", page}, folder.path());
        EXPECT_EQ(ended.code, 2) << page;
        EXPECT_NE(ended.err.find("--watch"), std::string::npos) << ended.err;
        EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
        EXPECT_TRUE(ended.out.empty());
    };
    refused("c.json", "is not a page");
    refused("nowhere/case.html", "no such folder");
    refused(".", "this is a folder");
    const auto lonely = run_program({"solve", "c.json", "--frames", "5"}, folder.path());
    EXPECT_EQ(lonely.code, 2);
    EXPECT_NE(lonely.err.find("--watch"), std::string::npos) << lonely.err;
    folder.write("r.json", R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "halton", "points": 2}})");
    const auto nothing = run_program({"solve", "r.json", "--watch", "w.html"}, folder.path());
    EXPECT_EQ(nothing.code, 2);
    EXPECT_NE(nothing.err.find("shows no particles"), std::string::npos) << nothing.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "w.html"));
}

TEST(Watch, FilmsOfAReportPlayBesideTheirCase) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "b", "scene": "powder_spreading",
      "factors": [{"name": "gap", "levels": [0.006, 0.008, 0.01, 0.012]}],
      "fixed": {"diameter": 0.004, "width": 3, "layer_area": 1e-4, "travel": 0.02, "settle_time": 0.02},
      "design": {"kind": "lattice"}})");
    ASSERT_EQ(run_program({"run", "c.json", "-j", "1"}, folder.path()).code, 0);
    const auto plain = run_program({"report", "b.db", "-o", "plain.html"}, folder.path());
    const auto made = run_program({"report", "b.db", "-o", "r.html", "--watch", "3"}, folder.path());
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.err.find("film 3 of 3: largest mfr"), std::string::npos) << made.err;
    EXPECT_NE(made.err.find("3 films: "), std::string::npos) << made.err;
    EXPECT_EQ(plain.err, "");
    const std::string page = contents(folder / "r.html");
    const std::regex film("id=\"watch-([0-9a-f]{32})\" data-film data-campaign=\"b\"");
    const std::string unwatched = contents(folder / "plain.html");
    EXPECT_FALSE(std::regex_search(unwatched, film)) << "only the machine before it runs";
    std::vector<std::string> ids;
    for (std::sregex_iterator found(page.begin(), page.end(), film), end; found != end; ++found)
        ids.push_back((*found)[1]);
    ASSERT_EQ(ids.size(), 3U);
    const Browsed seen = browse(folder / "r.html", "#case=" + ids[1], folder.path());
    EXPECT_THAT(seen.console, testing::IsEmpty());
    const std::size_t panel = seen.document.find("id=\"case-panel\"");
    ASSERT_NE(panel, std::string::npos);
    const std::string shown = seen.document.substr(panel, seen.document.find("</aside>", panel) - panel);
    EXPECT_NE(shown.find("watch-canvas"), std::string::npos) << shown;
    EXPECT_NE(shown.find(" ms</output>"), std::string::npos) << shown;  // the clock is set when a frame is painted
    EXPECT_NE(seen.document.find("Cases to watch"), std::string::npos);
    std::string without;  // the case of the four that has no film
    const auto rows =
        json::parse(run_program({"query", "b.db", "SELECT case_id FROM b", "--format", "json"}, folder.path()).out);
    for (const auto& row : rows)
        if (std::ranges::find(ids, row.at("case_id").get<std::string>()) == ids.end()) without = row.at("case_id");
    const Browsed other = browse(folder / "r.html", "#case=" + without, folder.path());
    const std::size_t beside = other.document.find("id=\"case-panel\"");
    ASSERT_NE(beside, std::string::npos);
    EXPECT_EQ(other.document.substr(beside, other.document.find("</aside>", beside) - beside)
                  .find("<canvas class=\"watch-canvas\""),
              std::string::npos);
    EXPECT_THAT(other.console, testing::IsEmpty());
}

}  // namespace grainsweep::tests::watch_test
