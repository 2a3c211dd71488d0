// Films: what goes in comes out, to what their description promises, and small enough to send.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "stats/random.hpp"
#include "sweep/report/film.hpp"
#include "sweep/report/film_choice.hpp"
#include "sweep/report/packed_column.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/page_files.hpp"
#include "sweep/report/watch_page.hpp"
#include "tests/support/answered.hpp"
#include "tests/support/film_reader.hpp"

namespace grainsweep::tests::report_film_test {

using report::Film;
using report::pack_film_column;

using Numbers = std::vector<std::uint16_t>;

void expect_round_trip(const Numbers& values, std::size_t items) {
    EXPECT_EQ(tests::unpack_film_column(pack_film_column(values, items), values.size() / items, items), values);
}

std::string packed_film(const Film& film) {
    return film.bytes(report::Json::object());
}

/// Two particles, the second of which is gone in the second frame, a frozen third.
Film three_spheres() {
    Film film;
    Snapshot s;
    s.positions = {{0, 0, 0}, {1, 2, -3}, {0.5, 0.5, 0.5}};
    s.scalars = {{"id", {7, 9, 11}}, {"mobile", {1, 1, 0}}, {"diameter", {0.2, 0.1, 0.2}}, {"overlap", {0, 4, 9}}};
    s.vectors["velocity"] = {{3, 4, 0}, {0, 0, 1}, {0, 0, 0}};
    s.units = {{"velocity", "m/s"}, {"overlap", "m"}};
    film.add(s, 0.5);
    s.positions = {{0.25, 1, 0}, {0.5, 0.5, 0.5}};
    s.scalars = {{"id", {7, 11}}, {"mobile", {1, 0}}, {"diameter", {0.2, 0.2}}, {"overlap", {2, 9}}};
    s.vectors["velocity"] = {{0, 0, 5}, {0, 0, 0}};
    film.add(s, 0.75);
    return film;
}

TEST(FilmCodec, GivesBackWhatItWasGiven) {
    expect_round_trip({0}, 1);
    expect_round_trip({65535, 0, 65535, 0, 65535, 0}, 2);  // the steepest there is, and what follows it
    expect_round_trip(Numbers(1000, 42), 100);
    const stats::Stream random(3, 1);
    Numbers noise, walk;
    for (std::uint64_t i = 0; i < 70 * 40; ++i) noise.push_back(static_cast<std::uint16_t>(65536 * random.uniform(i)));
    for (std::uint64_t i = 0; i < 70 * 40; ++i)
        walk.push_back(static_cast<std::uint16_t>(30000 + 20000 * std::sin(0.01 * static_cast<double>(i / 70)) +
                                                  5 * random.uniform(i)));
    expect_round_trip(noise, 70);
    expect_round_trip(walk, 70);
    expect_round_trip({}, 1);
    EXPECT_THROW((void)pack_film_column(Numbers(7), 2), std::invalid_argument);
}

TEST(FilmCodec, CostsNothingForWhatRestsAndLittleMoreThanNoiseForNoise) {
    const std::size_t items = 3200, frames = 50;
    EXPECT_LT(pack_film_column(Numbers(items * frames, 1234), items).size(), items * frames / 40);
    Numbers noise;
    const stats::Stream random(5, 1);
    for (std::uint64_t i = 0; i < items * frames; ++i)
        noise.push_back(static_cast<std::uint16_t>(65536 * random.uniform(i)));
    EXPECT_LT(pack_film_column(noise, items).size(), noise.size() * 9 / 4);
}

TEST(Film, PositionsAreKnownToHalfAStepOfTheBox) {
    const stats::Stream random(1, 1);
    Film film;
    std::vector<Snapshot> frames(5);
    for (std::size_t f = 0; f < frames.size(); ++f) {
        for (std::uint64_t i = 0; i < 100; ++i) {
            const std::uint64_t draw = 3 * (100 * f + i);
            frames[f].positions.push_back({random.uniform(draw), 0.01 * random.uniform(draw + 1), -7});
        }
        film.add(frames[f], static_cast<double>(f));
    }
    const auto read = read_film(packed_film(film));
    const auto& positions = read.header.at("positions");
    const auto places = read.column(positions.at("block"), 5, 300);
    for (std::size_t f = 0; f < 5; ++f)
        for (std::size_t i = 0; i < 100; ++i)
            for (std::size_t a = 0; a < 3; ++a) {
                const double extent = std::array{1.0, 0.01, 0.0}[a], low = positions.at("low")[a];
                const double x = low + positions.at("step")[a].get<double>() * places[(3 * f + a) * 100 + i];
                EXPECT_NEAR(x, frames[f].positions[i][a], 0.5 * extent / 65535 + 1e-7);
            }
    EXPECT_FALSE(read.header.contains("present"));
    EXPECT_EQ(read.header.at("times"), (nlohmann::json{0, 1, 2, 3, 4}));
}

TEST(Film, KnowsParticlesByTheirIds) {
    const Film film = three_spheres();
    EXPECT_EQ(film.spheres(), 3U);
    const auto read = read_film(packed_film(film));
    EXPECT_EQ(read.column(read.header.at("present"), 2, 3), (Numbers{1, 1, 1, 1, 0, 1}));
    EXPECT_EQ(read.column(read.header.at("mobile"), 1, 3), (Numbers{1, 1, 0}));
    EXPECT_EQ(read.column(read.header.at("diameter").at("block"), 1, 3), (Numbers{65535, 32768, 65535}));
    EXPECT_EQ(read.header.at("diameter").at("largest"), 0.2);
    const auto& positions = read.header.at("positions");
    const auto places = read.column(positions.at("block"), 2, 9);
    EXPECT_EQ(places[0 + 9], std::lround(0.25 * 65535));  // x of the first in the second frame
    EXPECT_EQ(places[1 + 9], places[1]);                  // of the one that is gone: where it was
    EXPECT_EQ(places[3 + 2], places[9 + 3 + 2]);          // y of the frozen one
}

TEST(Film, ColoursAreMagnitudesOfMobileSpheresVelocityFirst) {
    const auto read = read_film(packed_film(three_spheres()));
    const auto& columns = read.header.at("columns");
    ASSERT_EQ(columns.size(), 2U);
    EXPECT_EQ(columns[0].at("name"), "velocity");
    EXPECT_EQ(columns[0].at("unit"), "m/s");
    EXPECT_EQ(columns[0].at("low"), 0);
    EXPECT_EQ(columns[0].at("high"), 5);
    EXPECT_EQ(read.column(columns[0].at("block"), 2, 3), (Numbers{255, 52, 0, 255, 0, 0}));  // 0: frozen, or gone
    EXPECT_EQ(columns[1].at("name"), "overlap");
    EXPECT_EQ(columns[1].at("high"), 4);  // what the frozen one bears does not count
    EXPECT_EQ(read.header.at("left_out").size(), 0U);
}

TEST(Film, ARareLargeValueDoesNotDarkenAllOthers) {
    Film film;
    Snapshot s;
    for (int i = 0; i < 1000; ++i) {
        s.positions.push_back({1.0 * i, 0, 0});
        s.scalars["force"].push_back(i == 500 ? 1000 : 0.001 * i);
        s.scalars["signed"].push_back(i % 2 == 0 ? -2 : 1);
        s.scalars["far"].push_back(300 + 0.01 * i);
    }
    film.add(s, 0);
    const auto read = read_film(packed_film(film));
    const auto& columns = read.header.at("columns");
    const auto named = [&](const char* name) {
        return *std::ranges::find_if(columns, [&](const auto& column) { return column.at("name") == name; });
    };
    EXPECT_EQ(named("far").at("low"), 300);
    EXPECT_FALSE(named("far").at("clipped"));
    EXPECT_NEAR(named("force").at("high").get<double>(), 0.995, 0.002);
    EXPECT_TRUE(named("force").at("clipped"));
    EXPECT_EQ(named("signed").at("low"), -2);
    EXPECT_EQ(named("signed").at("high"), 2);
}

TEST(Film, ForcesAreThoseBetweenShownParticles) {
    Film film(report::FilmLimits{.forces = true});
    Snapshot s;
    s.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    s.scalars = {{"id", {7, 9, 11}}};
    s.vectors["velocity"] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    s.contacts = ContactLines{.ends = {},
                              .scalars = {{"first", {11, 9, 7}}, {"second", {9, 7, -1}}, {"normal_force", {4, 2, 9}}},
                              .vectors = {},
                              .units = {},
                              .walls = {}};
    film.add(s, 0);
    s.contacts->scalars = {{"first", {}}, {"second", {}}, {"normal_force", {}}};
    film.add(s, 1);
    const auto read = read_film(packed_film(film));
    const auto& forces = read.header.at("forces");
    EXPECT_EQ(forces.at("counts"), (nlohmann::json{2, 0}));
    EXPECT_EQ(forces.at("low"), 0) << "the force on a wall, 9, does not count";
    EXPECT_EQ(forces.at("high"), 4);
    EXPECT_EQ(read.column(forces.at("first"), 1, 2), (Numbers{0, 1}));
    EXPECT_EQ(read.column(forces.at("between"), 1, 2), (Numbers{1, 1}));
    EXPECT_EQ(read.column(forces.at("shades"), 1, 2), (Numbers{128, 255}));
    EXPECT_FALSE(read_film(packed_film(three_spheres())).header.contains("forces")) << "only where requested";
}

TEST(Film, UndefinedValuesHaveNoColour) {
    Film film;
    Snapshot s;
    s.positions = {{0, 0, 0}, {1, 0, 0}};
    s.scalars["temperature"] = {std::numeric_limits<double>::quiet_NaN(), 2};
    film.add(s, 0);
    const auto read = read_film(packed_film(film));
    EXPECT_EQ(read.column(read.header.at("columns")[0].at("block"), 1, 2), (Numbers{0, 255}));
}

TEST(Film, WallsMoveStandAndVanish) {
    Film film;
    WallSurface base{"base", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {{0, 1}}};
    WallSurface blade = base, gate = base;
    blade.name = "blade";
    gate.name = "gate";
    for (const double t : {0.0, 1.0, 2.0}) {
        Snapshot s;
        s.positions = {{0, 0, 0}};
        for (auto& corner : blade.corners) corner[0] = corner[1] + t;
        s.walls = t == 0 ? std::vector{base, gate} : std::vector{base, blade};
        film.add(s, t);
    }
    const auto read = read_film(packed_film(film));
    const auto& walls = read.header.at("walls");
    ASSERT_EQ(walls.size(), 3U);
    EXPECT_EQ(walls[0].at("name"), "base");
    EXPECT_FALSE(walls[0].at("moves"));
    EXPECT_EQ(walls[0].at("frames"), 3);
    EXPECT_EQ(walls[1].at("name"), "gate");
    EXPECT_EQ(walls[1].at("frames"), 1);
    EXPECT_EQ(walls[2].at("name"), "blade");
    EXPECT_EQ(walls[2].at("first"), 1);
    EXPECT_TRUE(walls[2].at("moves"));
    const auto places = read.column(walls[2].at("places"), 2, 9);
    const auto x = [&](std::size_t frame, std::size_t corner) {
        return walls[2].at("low")[0].get<double>() + walls[2].at("step")[0].get<double>() * places[9 * frame + corner];
    };
    EXPECT_NEAR(x(0, 0), 1, 1e-4);
    EXPECT_NEAR(x(0, 2), 2, 1e-4);
    EXPECT_NEAR(x(1, 0), 2, 1e-4);
    EXPECT_EQ(read.column(walls[0].at("triangles"), 1, 3), (Numbers{0, 1, 2}));
    EXPECT_EQ(read.column(walls[0].at("edges"), 1, 2), (Numbers{0, 1}));
}

// Of more pictures than wanted some are kept: each wall as it was in those, also one that is in one of them only.
TEST(Film, KeptFramesKeepTheirWalls) {
    Film film;
    WallSurface blade{"blade", {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}, {{0, 1}}};
    WallSurface gate = blade;
    gate.name = "gate";
    for (int t = 0; t < 5; ++t) {
        Snapshot s;
        s.positions = {{0, 0, 0}};
        for (auto& corner : blade.corners) corner[0] = t;
        s.walls = {blade};
        if (t == 1) s.walls.push_back(gate);
        film.add(s, t);
    }
    film.keep({1, 2, 4});
    const auto read = read_film(packed_film(film));
    const auto& walls = read.header.at("walls");
    ASSERT_EQ(walls.size(), 2U);
    EXPECT_EQ(walls[0].at("frames"), 3);
    const auto places = read.column(walls[0].at("places"), 3, 9);
    constexpr std::array<double, 3> kept = {1, 2, 4};
    for (std::size_t frame = 0; frame < 3; ++frame)
        EXPECT_NEAR(walls[0].at("low")[0].get<double>() + walls[0].at("step")[0].get<double>() * places[9 * frame],
                    kept[frame], 1e-4)
            << frame;
    EXPECT_EQ(walls[1].at("name"), "gate");
    EXPECT_EQ(walls[1].at("first"), 0);
    EXPECT_EQ(walls[1].at("frames"), 1);
}

TEST(Film, AFlowIsCutThroughTheMiddle) {
    Film film;
    FlowField field;
    field.name = "flow";
    field.faces = {std::vector<double>{0, 1, 2}, {0, 1, 2, 3}, {0, 2}};  // two, three and one cells
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 2; ++i) field.scalars["temperature"].push_back(i + 10 * j);
    Snapshot s;
    s.fields = {field};
    EXPECT_FALSE(film.shows_anything());
    film.add(s, 0);
    film.add(s, 1);
    EXPECT_TRUE(film.shows_anything());
    const auto read = read_film(packed_film(film));
    ASSERT_EQ(read.header.at("slices").size(), 1U);
    const auto& slice = read.header.at("slices")[0];
    const double high = slice.at("high");
    EXPECT_EQ(high, 21);
    const auto shade = [&](double x) { return static_cast<std::uint16_t>(1 + std::lround(254 * x / high)); };
    // Across x: between the two cells; across y: the middle cell; across z: the only one.
    EXPECT_EQ(read.column(slice.at("planes")[0], 2, 3),
              (Numbers{shade(0.5), shade(10.5), shade(20.5), shade(0.5), shade(10.5), shade(20.5)}));
    EXPECT_EQ(read.column(slice.at("planes")[1], 2, 2), (Numbers{shade(10), shade(11), shade(10), shade(11)}));
    const Numbers across_z = read.column(slice.at("planes")[2], 2, 6);
    EXPECT_EQ(Numbers(across_z.begin(), across_z.begin() + 4), (Numbers{shade(0), shade(1), shade(10), shade(11)}));
}

TEST(Film, ThinsTooManySpheresAlwaysAlike) {
    Snapshot s;
    for (int i = 0; i < 5000; ++i) s.positions.push_back({1.0 * i, 0, 0});
    Film film({.spheres = 1000}), other({.spheres = 1000});
    film.add(s, 0);
    other.add(s, 0);
    EXPECT_NEAR(static_cast<double>(film.spheres()), 1000, 120);
    EXPECT_EQ(packed_film(film), packed_film(other));
    EXPECT_EQ(read_film(packed_film(film)).header.at("particles"), 5000);
}

TEST(Film, ColumnsOfAnotherLengthAreRefused) {
    Film film;
    Snapshot s;
    s.positions = {{0, 0, 0}};
    s.scalars["overlap"] = {1, 2};
    EXPECT_THROW(film.add(s, 0), std::invalid_argument);
}

/// So many spheres in free flight between impacts: every one moves in every frame, up to two diameters, and everything
/// that is measured of it jumps about. Nothing that powder does is harder to pack.
Film agitated(std::size_t spheres, std::size_t frames, std::size_t bytes) {
    const stats::Stream random(11, 1);
    std::uint64_t draw = 0;
    const auto jump = [&](double size) { return size * (2 * random.uniform(draw++) - 1); };
    Film film({.bytes = bytes});
    Snapshot s;
    std::vector<std::array<double, 3>> velocity(spheres);
    for (std::size_t i = 0; i < spheres; ++i) {
        s.positions.push_back({jump(0.5), jump(0.5), jump(0.5)});
        s.scalars["id"].push_back(static_cast<double>(i));
        s.scalars["diameter"].push_back(0.02 * (1 + 0.2 * random.uniform(draw++)));
    }
    for (std::size_t f = 0; f < frames; ++f) {
        for (const char* name : {"overlap", "largest_force", "coordination"}) s.scalars[name].assign(spheres, 0);
        for (const char* name : {"velocity", "angular_velocity", "force"}) s.vectors[name].assign(spheres, {});
        for (std::size_t i = 0; i < spheres; ++i) {
            const bool hit = random.uniform(draw++) < 0.3;
            for (std::size_t a = 0; a < 3; ++a) {
                if (hit) velocity[i][a] = jump(0.02);
                s.positions[i][a] = std::clamp(s.positions[i][a] + velocity[i][a], -0.5, 0.5);
                s.vectors["angular_velocity"][i][a] = jump(100);
                s.vectors["force"][i][a] = std::pow(jump(1), 3);
            }
            s.vectors["velocity"][i] = velocity[i];
            s.scalars["overlap"][i] = std::pow(random.uniform(draw++), 2);
            s.scalars["largest_force"][i] = -std::log(1 - random.uniform(draw++));
            s.scalars["coordination"][i] = std::floor(8 * random.uniform(draw++));
        }
        film.add(s, 0.001 * static_cast<double>(f));
    }
    return film;
}

// A fifth of the spheres, which pack alike, must fit in a fifth of the room that the page leaves to its film.
TEST(WatchPage, TwentyThousandSpheresInSixtyFramesFitInTenMegabytes) {
    constexpr std::size_t share = 5, room = 10'000'000;
    const Film film = agitated(20'000 / share, 60, room / share);
    const std::string packed = film.bytes(report::Json::object());
    const std::size_t text = report::base64(packed).size();
    const std::size_t page = report::watch_page(film, report::Json::object()).size();
    ASSERT_GT(page, text);
    EXPECT_LT(share * text + (page - text), room);
    const auto read = read_film(packed);
    EXPECT_EQ(read.header.at("columns")[0].at("name"), "velocity");
    EXPECT_GE(read.header.at("columns").size(), 2U);  // the rest is named, not silently gone
    EXPECT_EQ(read.header.at("columns").size() + read.header.at("left_out").size(), 6U);
}

TEST(WatchPage, OfNothingIsRefused) {
    EXPECT_THROW((void)report::watch_page(Film(), report::Json::object()), std::invalid_argument);
}

TEST(WatchPage, AsksNothingOfAnyNetworkAndHoldsItsFilm) {
    const Film film = three_spheres();
    const std::string page = report::watch_page(film, {{"title", "</script><b>"}});
    EXPECT_EQ(page.find("{{"), std::string::npos) << page.substr(page.find("{{"), 40);
    EXPECT_TRUE(page.starts_with("<!doctype html>"));
    EXPECT_EQ(page.find("https://"), std::string::npos);
    EXPECT_EQ(page.find("http://"), std::string::npos);
    EXPECT_EQ(page.find("<b>"), std::string::npos);  // what the case is called is in the film, not in the markup
    EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
    EXPECT_NE(page.find(report::base64(film.bytes({{"title", "</script><b>"}}))), std::string::npos);
}

using ReportStore = store::Store;

const char* rehearsed = R"({"campaign": "one", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
  "design": {"kind": "halton", "points": 40}})";

TEST(CasesToWatch, SpanWhatTheMainObservableDoes) {
    const tests::Folder folder;
    ReportStore archive(folder / "a.db", ReportStore::Mode::create);
    tests::answer_by(archive, rehearsed, [](const Inputs& inputs) -> std::optional<double> {
        const double x = tests::input(inputs, "x1");
        if (x > 0.9) return std::nullopt;  // unstable: nothing to watch
        return 10 - x;
    });
    const auto values = [&](std::size_t count) {
        std::vector<double> found;
        for (const auto& one : report::cases_to_watch(archive, count)) {
            EXPECT_EQ(one.campaign, "one");
            found.push_back(archive.result(one.case_id).value().observations.scalars.at("y"));
        }
        return found;
    };
    EXPECT_TRUE(values(0).empty());
    const auto all = archive.values("one", "y");
    std::vector<double> finite;
    for (const auto& one : all)
        if (std::isfinite(one.value)) finite.push_back(one.value);
    std::ranges::sort(finite);
    const auto three = values(3);
    ASSERT_EQ(three.size(), 3U);
    EXPECT_EQ(three[0], finite.front());
    EXPECT_EQ(three[2], finite.back());
    EXPECT_NEAR(three[1], finite[finite.size() / 2], 0.3);
    EXPECT_EQ(values(1).size(), 1U);
    EXPECT_EQ(values(1)[0], three[1]);
    EXPECT_EQ(values(5).size(), 5U);
    EXPECT_TRUE(std::ranges::is_sorted(values(5)));
    EXPECT_EQ(values(1000).size(), finite.size());  // each once
    const auto chosen = report::cases_to_watch(archive, 3);
    EXPECT_TRUE(chosen[0].says.starts_with("smallest y, "));
    EXPECT_TRUE(chosen[1].says.starts_with("median y, "));
    EXPECT_TRUE(chosen[2].says.starts_with("largest y, "));
}

TEST(CasesToWatch, AreInThePageWithThePlayerOnlyWhereThereAreSome) {
    const tests::Folder folder;
    ReportStore archive(folder / "a.db", ReportStore::Mode::create);
    tests::answer_by(archive, rehearsed, [](const Inputs&) -> std::optional<double> { return 1; });
    const report::PageSource source{&archive, "a.db"};
    const auto page = [&](const std::vector<report::PageFilm>& films) {
        std::ostringstream out;
        report::write_page(out, std::span(&source, 1), films);
        return out.str();
    };
    const std::string bytes = packed_film(three_spheres());
    const std::string with = page({{"one", "0123", "largest \"y\" <b>", bytes}}), without = page({});
    EXPECT_NE(with.find(R"(id="watch-0123" data-film data-campaign="one" data-case="0123" )"
                        R"(data-says="largest &quot;y&quot; &lt;b>">)"),
              std::string::npos);
    EXPECT_NE(with.find(report::base64(bytes) + "</script>"), std::string::npos);
    EXPECT_EQ(without.find("data-film data"), std::string::npos);
    EXPECT_EQ(without.find(report::page_files().films), std::string::npos);
    EXPECT_NE(with.find(report::page_files().films), std::string::npos);
}

}  // namespace grainsweep::tests::report_film_test
