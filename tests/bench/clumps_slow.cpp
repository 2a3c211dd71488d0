// Clumps against ensembles of LIGGGHTS: packings of dumbbells, tetrahedra and spheres, a turning drum and a silo; means
// over seeds within three pooled standard errors. Prints each figure; minutes: slow_clumps. References and definitions:
// tests/reference/clumps. With GRAINSWEEP_WRITE_DOCUMENTS the tables of docs/shapes.md are written to
// tests/reference/measured.
#include "sweep/campaign/csv_table.hpp"
#include "tests/support/machines.hpp"
#include "tests/support/measured.hpp"
#include "tests/support/places.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::clumps_slow_test {

using nlohmann::json;

std::string text_of_file(const std::string& path) {
    std::ifstream file(source(path));
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

struct ClumpReference {
    double mean = 0, sd = 0, tolerance = 0;  ///< tolerance: for the mean over as many seeds, absolute
    std::uint64_t seeds = 0;
};

ClumpReference clump_reference(const std::string& scene, const std::string& shape, const std::string& mu,
                               const std::string& quantity) {
    const std::string contents = text_of_file("tests/reference/clumps/ensembles.csv");
    campaign::CsvTable table(contents, [](const std::string& rule) { throw std::invalid_argument(rule); });
    while (const auto row = table.next()) {
        if ((*row)[0] != scene || (*row)[1] != shape || (*row)[2] != mu || (*row)[3] != quantity) continue;
        return {std::stod((*row)[5]), std::stod((*row)[6]), std::stod((*row)[11]),
                static_cast<std::uint64_t>(std::stoull((*row)[4]))};
    }
    throw std::invalid_argument(fmt::format("no reference of {} {} {} {}", scene, shape, mu, quantity));
}

/// Mean over the seeds of a reference, beside it; returns "0.7070 | 0.706 +- 0.002".
std::pair<std::string, std::string> expect_mean(const std::vector<double>& values, const ClumpReference& reference,
                                                const std::string& what) {
    double mean = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    std::printf("%-50s %8.4f   LIGGGHTS %8.4f +- %.4f, tolerance %.4f: %.2f of it\n", what.c_str(), mean,
                reference.mean, reference.sd, reference.tolerance,
                std::abs(mean - reference.mean) / reference.tolerance);
    std::fflush(stdout);
    EXPECT_NEAR(mean, reference.mean, reference.tolerance) << what;
    return {fmt::format("{:.4g}", mean), fmt::format("{:.4g} ± {:.2g}", reference.mean, reference.sd)};
}

/// Shape of a species; null: spheres.
json clump_shape(const std::string& name) {
    const json all = json::parse(text_of_file("tests/reference/clumps/shapes.json"));
    const json& shapes = all.contains("shapes") ? all["shapes"] : all;
    json spheres = json::array();
    for (const auto& [x, y, z, r] : shapes.at(name).at("spheres").get<std::vector<std::array<double, 4>>>())
        spheres.push_back({x, y, z, 2 * r});
    return {{"spheres", spheres}, {"damping_mass", "body"}};
}

/// 500 grains of 5 mm fall into a periodic box of 30 mm and settle for 0.9 s. Contacts count from 15 mm above the floor
/// to 15 mm below the reference's 95 % height of centres.
json packing(const std::string& shape, const std::string& mu) {
    json document = json::parse(R"({
      "name": "pack",
      "materials": {"grain": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.3}},
      "contacts": {"restitution": 0.5, "tangential_limit": "spring"},
      "species": {"grain": {"diameter": "5 mm"}},
      "domain": {"low": [0, 0, -0.005], "high": [0.03, 0.03, 0.25], "sides": ["periodic", "periodic", "open"]},
      "walls": {"floor": {"plane": {"normal": [0, 0, 1]}}},
      "fill": [{"species": "grain", "count": 500, "as": "random", "shaken": 0.05,
                "in": {"box": {"low": [0, 0, 0.0005], "high": [0.03, 0.03, 0.188105]}}}],
      "phases": [{"name": "settle", "for": 0.9}],
      "measure": {
        "phi_points": {"point_fraction": {"in": {"box": {"low": [0, 0, 0.015], "high": [0.03, 0.03, 0.2]}},
                                          "below_top": 0.015, "points": 200000}, "as": "last"},
        "contacts_per_clump": {"contacts": {}, "as": "last"},
        "touching_neighbours_per_clump": {"coordination": {}, "as": "last"}
      }
    })");
    const double top = clump_reference("pack", shape, mu, "top95_m").mean;
    const json inside = {{"box", {{"low", {0, 0, 0.015}}, {"high", {0.03, 0.03, top - 0.015}}}}};
    document["measure"]["contacts_per_clump"]["contacts"]["in"] = inside;
    document["measure"]["touching_neighbours_per_clump"]["coordination"]["in"] = inside;
    document["contacts"]["friction"] = std::stod(mu);
    if (shape != "sphere") document["species"]["grain"]["shape"] = clump_shape(shape);
    return document;
}

TEST(ClumpsAgainstLiggghts, PackAsDensely) {
    TableRows rows;
    for (const std::string shape : {"sphere", "dumbbell_1_5", "tetra_1_5"})
        for (const std::string mu : {"0.0", "0.4"}) {
            const auto spec = spec_of(packing(shape, mu));
            std::map<std::string, std::vector<double>> values;
            const auto seeds = clump_reference("pack", shape, mu, "phi_points").seeds;
            for (std::uint64_t seed = 1; seed <= seeds; ++seed)
                for (const auto& [name, value] : answer_of(spec, seed).scalars) values[name].push_back(value);
            std::vector<std::string> row = {fmt::format("{}, {}", shape, mu)};
            for (const std::string quantity : {"phi_points", "contacts_per_clump", "touching_neighbours_per_clump"}) {
                const auto [ours, theirs] =
                    expect_mean(values.at(quantity), clump_reference("pack", shape, mu, quantity),
                                fmt::format("{} {} {}", shape, mu, quantity));
                row.push_back(ours);
                row.push_back(theirs);
            }
            rows.push_back(row);
        }
    remember_measured(
        "clump_packings",
        {"grains, friction", "solid fraction", "LIGGGHTS", "contacts", "LIGGGHTS ", "neighbours", "LIGGGHTS  "}, rows,
        1);
}

TEST(ClumpsAgainstLiggghts, TurnInADrum) {
    TableRows rows;
    for (const std::string shape : {"sphere", "dumbbell_1_5", "dumbbell_2"}) {
        json document = json::parse(text_of_file("configs/machines/grain_drum.json"));
        document["contacts"]["tangential_limit"] = "spring";
        auto& grain = document["species"]["grain"];
        grain.erase("shape");
        if (shape != "sphere") grain["shape"] = clump_shape(shape);
        document["parameters"].erase("aspect_ratio");
        const auto spec = spec_of(document, {{"friction", 0.4}, {"length", 0.025}, {"revolutions", 1.5}});
        const auto reference = clump_reference("drum", shape, "0.4", "angle_cm_deg");
        std::vector<double> angles;
        for (std::uint64_t seed = 1; seed <= reference.seeds; ++seed)
            angles.push_back(answer_of(spec, seed).scalars.at("angle"));
        const auto [ours, theirs] = expect_mean(angles, reference, shape + " angle");
        rows.push_back({shape, ours, theirs});
    }
    remember_measured("clump_drum", {"grains", "angle, deg", "LIGGGHTS"}, rows, 1);
}

/// 600 grains settle for 0.4 s behind a gate in a cylinder of 50 mm with an opening of 25 mm, and run out for 1.2 s.
json silo(const std::string& shape) {
    json document = json::parse(R"({
      "name": "silo",
      "materials": {"grain": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.3}},
      "contacts": {"restitution": 0.5, "friction": 0.4, "tangential_limit": "spring"},
      "species": {"grain": {"diameter": "5 mm"}},
      "domain": {"low": [-0.04, -0.04, -0.06], "high": [0.04, 0.04, 0.125]},
      "walls": {"shell": {"cylinder": {"axis": [0, 0, 1], "radius": "25 mm"}},
                "floor": {"disc": {"centre": [0, 0, 0], "radius": "28 mm", "inner": "12.5 mm"}},
                "gate": {"plane": {"point": [0, 0, "0.1 mm"], "normal": [0, 0, 1]}, "during": ["settle"]}},
      "fill": [{"species": "grain", "count": 600, "as": "random", "shaken": 0.05,
                "in": {"cylinder": {"base": [0, 0, 0.0005], "radius": "24.7 mm", "length": 0.1045}}}],
      "phases": [{"name": "settle", "for": 0.4}, {"name": "flow", "for": 1.2, "frames": 60}],
      "measure": {
        "slope": {"mass": {"in": {"half_space": {"normal": [0, 0, 1]}}}, "during": "flow", "as": "slope",
                  "shares": [0.4, 0.9]},
        "rate_kg_s": {"expression": "-slope", "unit": "kg/s"},
        "first": {"mass": {"in": {"half_space": {"normal": [0, 0, 1]}}}, "during": "flow", "as": "first"},
        "left": {"mass": {"in": {"half_space": {"normal": [0, 0, 1]}}}, "during": "flow", "as": "last"},
        "discharged_at_end": {"expression": "1 - left/first"}
      }
    })");
    if (shape != "sphere") document["species"]["grain"]["shape"] = clump_shape(shape);
    return document;
}

TEST(ClumpsAgainstLiggghts, LeaveASilo) {
    TableRows rows;
    for (const std::string shape : {"sphere", "dumbbell_1_5"}) {
        const auto spec = spec_of(silo(shape));
        std::map<std::string, std::vector<double>> values;
        const auto seeds = clump_reference("silo", shape, "0.4", "rate_kg_s").seeds;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed)
            for (const auto& [name, value] : answer_of(spec, seed).scalars) values[name].push_back(value);
        std::vector<std::string> row = {shape};
        for (const std::string quantity : {"rate_kg_s", "discharged_at_end"}) {
            const auto [ours, theirs] = expect_mean(
                values.at(quantity), clump_reference("silo", shape, "0.4", quantity), shape + " " + quantity);
            row.push_back(ours);
            row.push_back(theirs);
        }
        rows.push_back(row);
    }
    remember_measured("clump_silo", {"grains", "rate, kg/s", "LIGGGHTS", "discharged after 1.2 s", "LIGGGHTS "}, rows,
                      1);
}

}  // namespace grainsweep::tests::clumps_slow_test
