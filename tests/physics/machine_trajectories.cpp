// Single contacts of unlike materials, asked as machine files, against LIGGGHTS 3.8 (tests/reference/machines): what a
// machine file says of materials, pairs, walls, spheres and motions reaches the engine as it stands.
#include "tests/support/machines.hpp"
#include "tests/support/reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

namespace grainsweep::tests::machine_trajectories_test {

using nlohmann::json;

constexpr std::size_t cases = 16;

std::string text_in(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The STL files that a case needs, and the walls of the machine.
json walls_of(const json& c, FileTexts& files) {
    json walls = json::object();
    for (const json& wall : c["walls"]) {
        const bool floor = wall["kind"] == "zplane";
        const double side = c["bodies"][0]["x"][0] > 0 ? 1 : -1;
        walls[wall["kind"]] = {{"plane", {{"normal", floor ? json{0, 0, 1} : json{side, 0, 0}}}},
                               {"material", wall["material"]}};
    }
    for (const json& mesh : c["meshes"]) {
        const std::string name = mesh["stl"];
        files[name + ".stl"] = text_in(reference("walls/stl/" + name + ".stl"));
        json& wall = walls[name];
        wall = {{"stl", name + ".stl"}, {"material", mesh["material"]}, {"motion", json::array()}};
        for (const json& move : mesh["moves"]) wall["motion"].push_back({{"shift", {{"velocity", move["v"]}}}});
    }
    return walls;
}

/// A case of cases.json as a machine file.
json machine_of_case(const std::string& name, const json& c, FileTexts& files) {
    const double half = c["box"];
    json machine = {{"name", name},
                    {"gravity", c["g"]},
                    {"domain", {{"low", {-half, -half, -half}}, {"high", {half, half, half}}}},
                    {"contacts", {{"pairs", json::object()}, {"tangential_limit", "spring"}}},
                    {"fill", json::array()},
                    {"walls", walls_of(c, files)},
                    {"phases", {{{"name", "all"}, {"for", c["nsteps"].get<double>() * c["dt"].get<double>()}}}},
                    {"measure", {{"there", {{"count", json::object()}, {"as", "last"}}}}}};
    for (const auto& [material, elastic] : c["materials"].items())
        machine["materials"][material] = {{"youngs_modulus", elastic["E"]}, {"poisson_ratio", elastic["nu"]}};
    if (!c["rolling"].is_null()) machine["contacts"]["rolling_law"] = c["rolling"] == "cdt" ? "cdt" : "epsd_liggghts";
    for (const auto& [pair, values] : c["pairs"].items()) {
        json& given = machine["contacts"]["pairs"][pair.substr(0, 1) + " " + pair.substr(1)];
        given = {{"restitution", values["e"]}, {"friction", values["mu"]}};
        if (!c["rolling"].is_null())
            given["rolling_friction"] = values["mur"], given["rolling_damping"] = values["murv"];
    }
    for (const json& body : c["bodies"]) {
        const std::string material = body["material"];
        machine["materials"][material]["density"] = body["rho"];
        machine["species"]["of_" + material] = {{"material", material}, {"diameter", body["diameter"]}};
        machine["fill"].push_back(
            {{"species", "of_" + material},
             {"spheres",
              {{{"at", body["x"]}, {"velocity", body["v"]}, {"spin", body["w"]}, {"diameter", body["diameter"]}}}}});
    }
    return machine;
}

/// Largest difference over all bodies and rows: of positions over the largest diameter, of velocities and surface
/// speeds over the largest speed.
double difference(const std::string& name, const json& c) {
    const auto table = read_table(reference("machines/" + name + ".csv"));
    FileTexts files;
    const json document = machine_of_case(name, c, files);
    const double dt = c["dt"];
    machine::Run run(spec_of(document, {{"precision", std::string("double")}, {"time_step", dt}}, files), 1);
    double fastest = 0, diameter = 0, worst = 0;
    for (std::size_t r = 0; r < table.rows; ++r)
        fastest = std::max(fastest, std::hypot(table.at("vx", r), table.at("vy", r), table.at("vz", r)));
    for (const json& body : c["bodies"]) diameter = std::max(diameter, body["diameter"].get<double>());
    for (std::size_t r = 0; r < table.rows; ++r) {
        run.advance((table.at("step", r) - 0.5) * dt);
        const Snapshot picture = run.snapshot();
        const auto body = static_cast<std::size_t>(table.at("id", r)) - 1;
        if (picture.positions.size() <= body) return 1;
        const double radius = c["bodies"][body]["diameter"].get<double>() / 2;
        const auto compare = [&](const std::array<double, 3>& mine, const std::array<const char*, 3>& columns,
                                 double unit) {
            for (std::size_t k = 0; k < 3; ++k)
                worst = std::max(worst, std::abs(mine[k] - table.at(columns[k], r)) / unit);
        };
        compare(picture.positions[body], {"x", "y", "z"}, diameter);
        compare(picture.vectors.at("velocity")[body], {"vx", "vy", "vz"}, fastest);
        compare(picture.vectors.at("angular_velocity")[body], {"omegax", "omegay", "omegaz"}, fastest / radius);
    }
    EXPECT_EQ(run.health().reason, "") << name;
    return worst;
}

TEST(MachineTrajectories, EqualTheReferenceToRounding) {
    std::ifstream in(reference("machines/cases.json"));
    const json all = json::parse(in);
    EXPECT_EQ(all.size(), cases);
    for (const auto& [name, c] : all.items()) EXPECT_LT(difference(name, c), 1e-11) << name;
}

// On a slope of tangent 0.2 with friction enough a sphere rolls: it gains 5/7 of g sin(slope); the machine's gravity is
// tilted instead of the floor.
TEST(MachineTrajectories, ABallRollsDownASlope) {
    const double slope = std::atan(0.2);
    json machine = json::parse(R"({
      "name": "ball",
      "parameters": {"slope": {"unit": "rad", "default": 0}},
      "gravity": {"size": 9.81, "tilt": "slope"},
      "domain": {"low": [-1, -0.1, -0.01], "high": [1, 0.1, 0.1]},
      "materials": {"glass": {"density": 2500, "youngs_modulus": "50 MPa"}},
      "contacts": {"restitution": 0.2, "friction": 0.6},
      "species": {"a": {"diameter": "4 mm"}},
      "walls": {"floor": {"plane": {"normal": [0, 0, 1]}}},
      "fill": [{"species": "a", "spheres": [{"at": [-0.5, 0, 0.002]}]}],
      "phases": [{"name": "settle", "for": 0.05, "frames": 1}, {"name": "roll", "for": 0.2, "frames": 50}],
      "measure": {"speed": {"velocity": {"along": [1, 0, 0]}, "during": "roll", "as": "slope"},
                  "last": {"velocity": {"along": [1, 0, 0]}, "as": "last"},
                  "went": {"centre": {"along": [1, 0, 0], "from": [-0.5, 0, 0]}, "as": "last"}}
    })");
    const auto answer = answer_of(spec_of(machine, {{"slope", slope}, {"precision", std::string("double")}}));
    const double a = 5.0 / 7 * 9.81 * std::sin(slope);
    EXPECT_NEAR(answer.scalars.at("speed"), a, 2e-3 * a);
    EXPECT_NEAR(answer.scalars.at("last"), a * 0.25, 5e-3 * a * 0.25);
    EXPECT_NEAR(answer.scalars.at("went"), a * 0.25 * 0.25 / 2, 5e-3 * a * 0.25 * 0.25 / 2);
}

}  // namespace grainsweep::tests::machine_trajectories_test
