// What accuracy costs where particles meet the fluid and one another.
//
//   bench_coupling_accuracy [--seeds N]
//
//   sub-steps     restitution of two spheres that collide head-on in vacuum, of four laws and sixteen phases of the
//                 sub-steps at the first touch: root mean square error over the approach speed; cost: of a collision
//   kernel width  run 29 of IAC-24-A1.2.3 two-way, kinetic energy of the fluid after 0.05 L^2/alpha, mean of N clouds,
//                 against the default width on 40 cells; the standard error of the difference beside it; cost: of a
//                 period. Widths on the default grid, and grids at the default width.
//
// One JSON line per setting.
#include "solver/coupling/drag.hpp"
#include "solver/coupling/spring_contacts.hpp"
#include "solver/scenes/scene.hpp"
#include "tests/support/trade_off.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

using namespace grainsweep;
using coupling::Vec3;

namespace {

double seconds_since(std::clock_t start) {
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

struct Vacuum {
    double vibration = 0;
    coupling::Surroundings operator()(std::size_t) const { return {}; }
    [[nodiscard]] Vec3 rotation(const Vec3&) const { return {}; }
};

/// Relative velocity after over before; the gap at the start shifts the sub-steps against the contact.
double restitution(double law, double steps_per_contact, double gap) {
    const coupling::Sphere sphere{4, 1e-4, 1e-9, 0, 1};
    const double dt = 1e-3, r = sphere.radius(), mass = 4.5 * sphere.volume();
    const flow::Axis axis = flow::Axis::uniform(4, -0.5, 0.5);
    const flow::Grid grid{{axis, axis, axis}};
    const coupling::Walls box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, r, 1};
    coupling::SpringContacts contacts(sphere, box, {mass * 1e6, law, 0}, 2, steps_per_contact);
    coupling::SolidsVolume solids(grid, {}, sphere.volume(), 0);
    coupling::Cloud cloud;
    cloud.position = {{-(1 + gap) * r, 0, 0}, {(1 + gap) * r, 0, 0}};
    cloud.velocity = {{1, 0, 0}, {-1, 0, 0}};
    std::vector<Vec3> handed(2);
    const coupling::Motion<coupling::StokesDrag> motion(sphere, dt);
    const int steps = static_cast<int>(2 * gap * r / dt) + 20;
    for (int s = 0; s < steps; ++s) contacts.move(cloud, motion, box, solids, 0, Vacuum{}, handed);
    return 0.5 * (cloud.velocity[1][0] - cloud.velocity[0][0]);
}

tests::Setting sub_steps(double per_contact) {
    tests::Setting s;
    s.scene = "collision";
    s.name = fmt::format("{} sub-steps a contact", per_contact);
    s.measured = "restitution";
    const std::vector<double> laws = {0.3, 0.6, 0.9, 1.0};
    constexpr int phases = 16;
    double square = 0;
    const std::clock_t start = std::clock();
    for (const double law : laws)
        for (int k = 0; k < phases; ++k) square += std::pow(restitution(law, per_contact, 0.2 + 0.0031 * k) - law, 2);
    const double runs = phases * static_cast<double>(laws.size());
    s.cost = seconds_since(start) / runs;
    s.error = std::sqrt(square / runs);
    return s;
}

struct TwoWayCase {
    double kernel_width;  // diameters
    std::int64_t cells;
};

/// Of one cloud: kinetic energy of the fluid, and the processor time of a period.
std::pair<double, double> two_way(const TwoWayCase& asked, std::uint64_t seed) {
    const SceneInfo& info = *find_scene("thermovibration");
    Inputs inputs = info.defaults();
    inputs["coupling"] = std::string("two_way");
    inputs["rayleigh"] = 3.04e5;
    inputs["frequency"] = 2.33e4;
    inputs["acceleration"] = 1.09e9;
    inputs["density_ratio"] = 3.49;
    inputs["kernel_width"] = asked.kernel_width;
    inputs["cells"] = asked.cells;
    inputs["end_time"] = 0.05;
    NoArtefacts none;
    const auto scene = info.make(inputs, seed, none);
    const std::clock_t start = std::clock();
    scene->advance(1);
    const double periods = 0.05 * std::get<double>(inputs.at("frequency")) / (2 * 3.14159265358979323846);
    const double cost = seconds_since(start) / periods;
    Observations found;
    scene->observe(found);
    return {found.scalars.at("kinetic_energy"), cost};
}

std::vector<tests::Setting> kernel_widths(int seeds) {
    const double usual = std::get<double>(find_scene("thermovibration")->defaults().at("kernel_width"));
    const std::vector<TwoWayCase> all = {{usual, 40}, {usual, 20},     {usual, 28},       {usual, 34},
                                         {0, 28},     {usual / 2, 28}, {usual * 1.5, 28}, {usual * 2, 28}};
    std::vector<double> reference;
    std::vector<tests::Setting> settings;
    for (const auto& asked : all) {
        tests::Setting s;
        s.scene = "kernel width";
        s.name = fmt::format("{} on {} cells", asked.kernel_width, asked.cells);
        s.measured = "kinetic energy";
        s.is_reference = settings.empty();
        double sum = 0, squares = 0, base = 0;
        for (int seed = 1; seed <= seeds; ++seed) {
            const auto [energy, cost] = two_way(asked, static_cast<std::uint64_t>(seed));
            if (s.is_reference) reference.push_back(energy);
            const double first = reference[static_cast<std::size_t>(seed - 1)];
            sum += energy - first, squares += (energy - first) * (energy - first), base += first;
            s.cost += cost / seeds;
        }
        const double n = seeds;
        s.error = sum / base;
        s.uncertainty = n > 1 ? std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1) / n) / (base / n) : 0;
        settings.push_back(s);
    }
    return settings;
}

}  // namespace

int main(int argc, char** argv) {
    int seeds = 4;
    for (int k = 1; k + 1 < argc; k += 2)
        if (std::string(argv[k]) == "--seeds") seeds = std::stoi(argv[k + 1]);
    std::vector<tests::Setting> settings;
    for (const double per_contact : {5.0, 10.0, 20.0, 40.0, 80.0}) settings.push_back(sub_steps(per_contact));
    for (auto& s : kernel_widths(seeds)) settings.push_back(std::move(s));
    tests::mark_dominated(settings);
    for (const auto& s : settings) std::printf("%s\n", tests::json_line(s).c_str());
    return 0;
}
